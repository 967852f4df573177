//! The one list of names that are read, by joint.
//!
//! Each entry is an alternative: the first one that is in the file is taken. `+` is the middle of
//! two points, and what stands after `&` has to be there too. `{L}` is left or right, and `{l}` is
//! l or r. `{s}` is any of these before or behind the rest. All are written as
//! [`plain`](super::name_forms::plain) gives them.

/// Names of one limb joint.
#[derive(Debug)]
pub struct Limb {
    /// The joint.
    pub name: &'static str,
    /// Skeletons and markers that leave no doubt.
    pub usual: &'static [&'static str],
    /// The joint's word on the skin: `knee` is the middle of `kneelat` and `kneemed` where both are
    /// there, and `kneelat` or `knee` alone if not.
    pub skin: &'static [&'static str],
    /// Pairs and single markers of biomechanical marker sets.
    pub markers: &'static [&'static str],
    /// Segments that begin at the joint. In a marker set they are markers in their middle, so that
    /// they count in skeletons only.
    pub segments: &'static [&'static str],
}

/// Shoulder, elbow, wrist, hip, knee and ankle.
///
/// Order matters. Beside `LeftArm`, `LeftShoulder` is where the collar bone begins. Beside
/// `LeftUpLeg`, `LHipJoint` is the middle of the pelvis.
pub const LIMBS: [Limb; 6] = [
    Limb {
        name: "shoulder",
        usual: &["{L}arm", "upperarm{l}", "{L}upperarm"],
        skin: &[],
        markers: &[
            "{s}shoulder",
            "{l}sjc",
            "{l}sho",
            "{s}acromion",
            "{s}acromium",
            "{l}acr",
            "{l}sae",
            "{l}ac",
            "{l}clavicle",
        ],
        segments: &["{s}upperarm", "{s}uarm", "{s}upperarm01", "{s}shldr", "{s}arm&{s}forearm", "{s}arm&{s}lowerarm"],
    },
    Limb {
        name: "elbow",
        usual: &["{L}forearm", "lowerarm{l}", "{L}lowerarm", "{l}humerus"],
        skin: &["elbow", "elb"],
        markers: &["{l}ejc", "{l}lel+{l}mel", "{l}hle+{l}hme", "{l}hle", "{l}lel", "{s}olecranon"],
        segments: &["{s}lowerarm", "{s}forearm", "{s}farm", "{s}lowerarm01"],
    },
    Limb {
        name: "wrist",
        usual: &["{L}hand", "hand{l}", "{l}radius"],
        skin: &["wrist", "wri"],
        markers: &[
            "{l}wjc",
            "{l}wra+{l}wrb",
            "{l}rsp+{l}usp",
            "{l}faradius+{l}faulna",
            "{l}wra",
            "{l}wrb",
            "{l}rsp",
            "{l}faradius",
        ],
        segments: &["{s}hand"],
    },
    Limb {
        name: "hip",
        usual: &["{L}upleg", "upperleg{l}", "{L}upperleg", "{L}thigh", "{l}hipjoint", "{s}hip", "{l}hjc"],
        skin: &[],
        markers: &[],
        segments: &["{s}upleg", "{s}upperleg", "{s}upperleg01", "{s}thigh", "{s}femur"],
    },
    Limb {
        name: "knee",
        usual: &["{L}leg", "lowerleg{l}", "{L}lowerleg", "{L}shin", "{l}femur"],
        skin: &["knee", "kne"],
        markers: &["{l}kjc", "{l}lfc+{l}mfc", "{l}fle+{l}fme", "{l}le+{l}me", "{l}lfc", "{l}fle"],
        segments: &[
            "{s}lowerleg",
            "{s}calf",
            "{s}shin",
            "{s}shank",
            "{s}lowerleg01",
            "{s}leg&{s}upleg",
            "{s}leg&{s}upperleg",
            "{s}leg&{s}thigh",
        ],
    },
    Limb {
        name: "ankle",
        usual: &["{L}foot", "foot{l}", "{l}tibia"],
        skin: &["ankle", "ank"],
        markers: &["{l}ajc", "{l}lmal+{l}mmal", "{l}fal+{l}tam", "{l}lm+{l}mm", "{l}lmal", "{l}fal", "{s}malleolus"],
        segments: &["{s}foot"],
    },
];

/// Markers of the outer and the inner side of a joint, around its word on the skin.
pub const LATERAL: [&str; 5] = ["{s}*lat", "{s}*lateral", "{s}lat*", "{s}l*", "{s}*"];
/// See [`LATERAL`].
pub const MEDIAL: [&str; 5] = ["{s}*med", "{s}*medial", "{s}med*", "{s}m*", "{s}*m"];

/// The root.
pub const ROOT: &[&str] = &["hips", "pelvis", "root", "midhip", "hipcenter", "spinebase", "hip", "chip"];
/// The neck, before the middle of the collars.
pub const NECKS: &[&str] = &["neck", "thorax", "c7+clav", "spineshoulder", "shouldercenter"];
/// The neck, after it.
pub const NECK_MARKERS: &[&str] = &["c7"];
/// Where a collar bone begins, in a skeleton.
pub const COLLARS: &[&str] = &["{s}collar", "{s}clavicle", "{s}shoulder"];

/// Front of the pelvis of one side (ASIS): Vicon, Helen Hayes, CMU, CAST.
pub const PELVIS_FRONT: &[&str] = &["{l}asi", "{s}asis", "{l}fwt", "{l}ias"];
/// Back of the pelvis of one side (PSIS).
pub const PELVIS_BACK: &[&str] = &["{l}psi", "{s}psis", "{l}bwt", "{l}ips"];
/// Middle of the back of the pelvis, in place of both.
pub const SACRUM: &[&str] = &["sacr", "vsacral", "vsacrum", "sacral", "sacrum", "msacral", "s1", "s2"];
/// The greater trochanter, where nothing else shows the hip.
pub const TROCHANTER: &[&str] = &["{s}trochanter", "{l}gtr", "{l}gt", "{l}tro"];

/// The back of a foot.
pub const HEELS: &[&str] =
    &["{s}heel", "{l}hee", "{l}cal", "{l}calc", "{s}calcaneus", "{l}fcc", "{l}ca", "{s}heellow", "{s}footheel"];
/// The front of a foot.
pub const TOES: &[&str] = &[
    "{s}toe",
    "{s}toetip",
    "{s}bigtoe",
    "{s}toebase",
    "{s}toes",
    "{s}ball",
    "{s}toe0",
    "{s}footindex",
    "{s}hallux",
    "{l}fm2",
    "{l}mt2",
    "{l}sm",
];
