//! Lengths and radii of a person, estimated while they are tracked.
//!
//! Each kind of bone (both sides alike) has two sizes: the logarithms of its length and its radius
//! over those that tracking began with, with a normal prior. A frame's points say something of pose
//! and lengths together: Gauss-Newton's normal equations about the tracked pose. The pose is
//! marginalised out of them, and what is left adds to what is known of the lengths (an information
//! filter). Depth says little of radii, since it is smoothed over neighbours; the width of a bone
//! across the line of sight says more.

use crate::body::BodySize;
use crate::body::body_size::lengths_times;
use nalgebra::{Cholesky, SMatrix, SVector};
use sinew_core::kinematics::forward::Posture;
use sinew_core::math::{Vec3, exp, ln};
use sinew_core::observation::body_surface::{BodySurface, SeenCapsule};
use sinew_core::observation::capsule::Capsule;
use sinew_core::observation::point_cloud::PointBlock;
use sinew_core::observation::point_pull::for_each_pull;
use sinew_core::pik::motion::BodyScene;
use sinew_core::skeleton::BodyMeasures;
use sinew_core::skeleton::full_body::{
    BODY_ANGLES, BODY_BONES, BODY_PARENTS, COLLARS, FEET, FOREARMS, HEAD, HIPS, SHANKS, THIGHS, TRUNK, UPPER_ARMS,
};

/// Kinds of bones: trunk, head, collar, upper arm, forearm, hip, thigh, shank, foot.
const KINDS: usize = 9;
/// Coordinates of the pose, then lengths.
const UNKNOWNS: usize = BODY_ANGLES + KINDS;
/// What a residual of one bone depends on: its twist (6) and its own length.
const LOCAL: usize = 7;

/// Standard deviation of the logarithm of an adult's stature.
/// Source: 9 to 10 cm of 1.70 m over both sexes (ANSUR II).
const STATURE_STD: f64 = 0.06;
/// Of each length in proportion to the stature. Chosen, and not searched.
const LENGTH_STD: f64 = 0.04;
/// Of what all radii share, and of what each has of its own. Chosen: 14 % in all.
const GIRTH_STD: f64 = 0.1;
const RADIUS_STD: f64 = 0.1;
/// How far the pose may be off about which lengths are estimated, metres and radians.
/// Chosen: far more than a tracked pose is.
const SHIFT_STD_M: f64 = 0.1;
const ANGLE_STD_RAD: f64 = 0.3;
/// Share of what points say of lengths that counts, since neighbours and frames in a row err alike.
/// Chosen: from 0.1 to 1 the joints are within 7 %, with 0.01 3 to 6 % farther off.
const POINT_SHARE: f64 = 0.1;
/// Share of what is known that is kept from one frame to the next. The first frames, whose pose is
/// not settled, have faded after some fifty. Chosen, and not searched.
const KEPT: f64 = 0.98;
/// Sizes stay within this of those at the start, as logarithms. Chosen: beyond any adult.
const MAX_LOG: f64 = 0.4;
/// Standard deviation of the logarithm of a radius that one bone shows in one frame. Chosen: with
/// 0.2 the joints are 3 % farther off.
const SEEN_RADIUS_STD: f64 = 0.1;
/// Fewest points of a bone that say something of its radius: their spread is known to a tenth.
const MIN_POINTS: usize = 20;
/// Least sine of the angle between a bone and the line of sight from which its width is seen.
/// Chosen: with 0.9 no difference.
const MIN_SINE: f32 = 0.7;
/// Where along a bone its sides are looked at, and how far inside of its rim, metres. Chosen: with
/// a rim 2 cm farther out the joints are 6 % farther off, thighs and heads are seldom seen alone.
const STATIONS: [f32; 2] = [0.5, 0.8];
const INSIDE_M: f32 = 0.01;

type Lengths = SVector<f64, KINDS>;
type LengthMatrix = SMatrix<f64, KINDS, KINDS>;

/// `size` with lengths and radii times the exponentials of these logarithms.
fn scaled(size: &BodySize, log_lengths: &Lengths, log_radii: &Lengths) -> BodySize {
    let girth = size.measures.girth * exp(log_radii.mean() as f32);
    BodySize {
        measures: BodyMeasures { girth, ..lengths_times(&size.measures, |kind| exp(log_lengths[kind] as f32)) },
        radii_m: std::array::from_fn(|bone| {
            kind_of(bone).map_or(0.0, |kind| size.radii_m[bone] * exp(log_radii[kind] as f32))
        }),
    }
}

/// The kind of a bone; the pelvis has none.
const fn kind_of(bone: usize) -> Option<usize> {
    match bone {
        TRUNK => Some(0),
        HEAD => Some(1),
        _ if is_one_of(bone, COLLARS) => Some(2),
        _ if is_one_of(bone, UPPER_ARMS) => Some(3),
        _ if is_one_of(bone, FOREARMS) => Some(4),
        _ if is_one_of(bone, HIPS) => Some(5),
        _ if is_one_of(bone, THIGHS) => Some(6),
        _ if is_one_of(bone, SHANKS) => Some(7),
        _ if is_one_of(bone, FEET) => Some(8),
        _ => None,
    }
}

const fn is_one_of(bone: usize, sides: [usize; 2]) -> bool {
    bone == sides[0] || bone == sides[1]
}

/// A normal distribution of the logarithm of one size of each kind, as information.
#[derive(Debug, Clone)]
struct LogSizes {
    prior: LengthMatrix,
    information: LengthMatrix,
    vector: Lengths,
    mean: Lengths,
}

impl LogSizes {
    /// All kinds share a part with the standard deviation `common_std`; each has one of its own.
    fn new(common_std: f64, own_std: f64) -> Self {
        let covariance =
            LengthMatrix::from_element(common_std * common_std) + LengthMatrix::identity() * (own_std * own_std);
        Self {
            prior: Cholesky::new(covariance).map_or_else(LengthMatrix::identity, |factor| factor.inverse()),
            information: LengthMatrix::zeros(),
            vector: Lengths::zeros(),
            mean: Lengths::zeros(),
        }
    }

    /// Takes in information, and how it wants the mean to move times itself.
    fn add(&mut self, information: &LengthMatrix, slope: &Lengths) {
        self.vector = self.vector * KEPT + slope + information * self.mean;
        self.information = self.information * KEPT + information;
        if let Some(factor) = Cholesky::new(self.information + self.prior) {
            self.mean = factor.solve(&self.vector).map(|log| log.clamp(-MAX_LOG, MAX_LOG));
        }
    }
}

/// What is known of a person's sizes.
#[derive(Debug, Clone)]
pub struct SizeEstimate {
    start: BodySize,
    lengths: LogSizes,
    radii: LogSizes,
}

impl SizeEstimate {
    /// Nothing but a prior about `start`.
    #[must_use]
    pub fn new(start: BodySize) -> Self {
        Self { start, lengths: LogSizes::new(STATURE_STD, LENGTH_STD), radii: LogSizes::new(GIRTH_STD, RADIUS_STD) }
    }

    /// The likeliest size.
    #[must_use]
    pub fn size(&self) -> BodySize {
        scaled(&self.start, &self.lengths.mean, &self.radii.mean)
    }

    /// Forgets the points, but not the sizes about which the next ones are looked at.
    pub fn forget(&mut self) {
        for sizes in [&mut self.lengths, &mut self.radii] {
            (sizes.information, sizes.vector) = (LengthMatrix::zeros(), Lengths::zeros());
        }
    }

    /// Takes in a frame's points about a pose; `scene` has the present size.
    pub fn observe(
        &mut self,
        scene: &BodyScene<BODY_BONES, BODY_ANGLES>,
        pose: &[f32; BODY_ANGLES],
        blocks: &[PointBlock],
    ) {
        let posture = scene.posture(pose);
        let (matrix, vector) = normal_equations(scene, &posture, blocks);
        let pose_part = matrix.fixed_view::<BODY_ANGLES, BODY_ANGLES>(0, 0).into_owned();
        let Some(factor) = Cholesky::new(pose_part) else { return };
        let cross = matrix.fixed_view::<BODY_ANGLES, KINDS>(0, BODY_ANGLES).into_owned();
        let solved = factor.solve(&cross);
        let information = matrix.fixed_view::<KINDS, KINDS>(BODY_ANGLES, BODY_ANGLES) - cross.transpose() * solved;
        let slope = vector.fixed_rows::<KINDS>(BODY_ANGLES) - solved.transpose() * vector.fixed_rows::<BODY_ANGLES>(0);
        self.lengths.add(&(information * POINT_SHARE), &(slope * POINT_SHARE));
        let logs = log_radii_seen(scene, &posture, blocks);
        let weight = 1.0 / SEEN_RADIUS_STD.powi(2);
        let (mut information, mut slope) = (LengthMatrix::zeros(), Lengths::zeros());
        for (bone, log) in logs.into_iter().enumerate() {
            if let (Some(kind), Some(log)) = (kind_of(bone), log) {
                information[(kind, kind)] += weight;
                slope[kind] += weight * log;
            }
        }
        self.radii.add(&information, &slope);
    }
}

/// Logarithms of the radii that the points show over those of the scene; `None` where no width is
/// seen.
///
/// Of a cylinder that is seen from one side, points lie evenly across its axis: their standard
/// deviation is the radius over the root of three.
fn log_radii_seen(
    scene: &BodyScene<BODY_BONES, BODY_ANGLES>,
    posture: &Posture<BODY_BONES, BODY_ANGLES>,
    blocks: &[PointBlock],
) -> [Option<f64>; BODY_BONES] {
    let surface = scene.surface(posture);
    let mut across: [Option<Vec3>; BODY_BONES] = [None; BODY_BONES];
    for seen in &surface.capsules {
        across[seen.bone] = Some(seen.across).filter(|across| is_clear(&surface, seen, across));
    }
    // Count, sum and sum of squares of the points' places across the axis, in radii.
    let mut of_bone = [(0_usize, 0.0_f64, 0.0_f64); BODY_BONES];
    for_each_pull(&scene.likelihood, &surface, blocks.iter(), 1.0, |pull| {
        let Some(across) = across[pull.bone] else { return };
        if pull.axis_share > 0.0 && pull.axis_share < 1.0 {
            let point_m = pull.skin_m + pull.normal * pull.residual_m;
            let off = f64::from((point_m - pull.axis_m).dot(&across) / scene.radii_m[pull.bone]);
            let (count, sum, squares) = &mut of_bone[pull.bone];
            *count += 1;
            *sum += off;
            *squares += off * off;
        }
    });
    of_bone.map(|(count, sum, squares)| {
        let mean = sum / count as f64;
        (count >= MIN_POINTS).then(|| 0.5 * f64::from(ln((3.0 * (squares / count as f64 - mean * mean)) as f32)))
    })
}

/// Whether a capsule is seen from the side, and nothing else is beside it in the picture.
fn is_clear(surface: &BodySurface<BODY_BONES>, seen: &SeenCapsule, across: &Vec3) -> bool {
    let capsule = &seen.capsule;
    let sine = capsule.start_m.cross(&seen.along_m).norm() / (capsule.start_m.norm() * seen.along_m.norm());
    sine >= MIN_SINE
        && STATIONS.iter().all(|station| {
            let axis_m = capsule.start_m + seen.along_m * *station;
            [-1.0, 1.0].iter().all(|side| {
                let beside_m = axis_m + across * (side * (capsule.radius_m - INSIDE_M));
                !surface.capsules.iter().any(|other| other.bone != seen.bone && covers(&other.capsule, &beside_m))
            })
        })
}

/// Whether a capsule lies over a place in the picture.
fn covers(capsule: &Capsule, place_m: &Vec3) -> bool {
    let pixel = |place_m: &Vec3| Vec3::new(place_m.x / place_m.z, place_m.y / place_m.z, 0.0);
    let (start, end, place) = (pixel(&capsule.start_m), pixel(&capsule.end_m), pixel(place_m));
    let along = end - start;
    let share = ((place - start).dot(&along) / along.dot(&along).max(f32::MIN_POSITIVE)).clamp(0.0, 1.0);
    let depth_m = capsule.start_m.z + share * (capsule.end_m.z - capsule.start_m.z);
    (place - start - along * share).norm() * depth_m < capsule.radius_m
}

/// Gauss-Newton's matrix and vector of all residuals by the coordinates of the pose, then the
/// sizes; the pose has a prior about where it is.
fn normal_equations(
    scene: &BodyScene<BODY_BONES, BODY_ANGLES>,
    posture: &Posture<BODY_BONES, BODY_ANGLES>,
    blocks: &[PointBlock],
) -> (SMatrix<f64, UNKNOWNS, UNKNOWNS>, SVector<f64, UNKNOWNS>) {
    let about_m = posture.joints[0];
    let mut of_bone = [(SMatrix::<f64, LOCAL, LOCAL>::zeros(), SVector::<f64, LOCAL>::zeros()); BODY_BONES];
    for_each_pull(&scene.likelihood, &scene.surface(posture), blocks.iter(), 1.0, |pull| {
        let moment = (pull.skin_m - about_m).cross(&pull.normal);
        let own = pull.normal.dot(&(posture.ends[pull.bone] - posture.joints[pull.bone])) * pull.axis_share;
        let (n, m) = (&pull.normal, &moment);
        let row = SVector::<f64, LOCAL>::from([n.x, n.y, n.z, m.x, m.y, m.z, own].map(f64::from));
        let (matrix, vector) = &mut of_bone[pull.bone];
        let weighted = row * f64::from(pull.weight);
        *matrix += weighted * row.transpose();
        *vector += weighted * f64::from(pull.residual_m);
    });
    let mut matrix = SMatrix::<f64, UNKNOWNS, UNKNOWNS>::zeros();
    let mut vector = SVector::<f64, UNKNOWNS>::zeros();
    for (bone, (local_matrix, local_vector)) in of_bone.iter().enumerate() {
        let slopes = slopes_of_bone(scene, posture, bone);
        matrix += slopes.transpose() * local_matrix * slopes;
        vector += slopes.transpose() * local_vector;
    }
    for index in 0..BODY_ANGLES {
        let std = if scene.skeleton.is_shift(index) { SHIFT_STD_M } else { ANGLE_STD_RAD };
        matrix[(index, index)] += 1.0 / (std * std);
    }
    (matrix, vector)
}

/// How the twist of a bone, its own length and its radius follow from all unknowns.
fn slopes_of_bone(
    scene: &BodyScene<BODY_BONES, BODY_ANGLES>,
    posture: &Posture<BODY_BONES, BODY_ANGLES>,
    bone: usize,
) -> SMatrix<f64, LOCAL, UNKNOWNS> {
    let about_m = posture.joints[0];
    let mut slopes = SMatrix::<f64, LOCAL, UNKNOWNS>::zeros();
    let mut add = |first: usize, column: usize, value: &Vec3| {
        for axis in 0..3 {
            slopes[(first + axis, column)] += f64::from(value[axis]);
        }
    };
    for coordinate in 0..BODY_ANGLES {
        let moved = scene.skeleton.bone_of_angle(coordinate);
        let axis = posture.axes[coordinate];
        if !scene.skeleton.angle_moves(coordinate, bone) {
            continue;
        }
        if scene.skeleton.is_shift(coordinate) {
            add(0, coordinate, &axis);
        } else {
            add(0, coordinate, &(posture.joints[moved] - about_m).cross(&axis));
            add(3, coordinate, &axis);
        }
    }
    let mut ancestor = BODY_PARENTS[bone].map(usize::from);
    while let Some(above) = ancestor {
        if let Some(kind) = kind_of(above) {
            add(0, BODY_ANGLES + kind, &(posture.ends[above] - posture.joints[above]));
        }
        ancestor = BODY_PARENTS[above].map(usize::from);
    }
    if let Some(kind) = kind_of(bone) {
        slopes[(6, BODY_ANGLES + kind)] = 1.0;
    }
    slopes
}
