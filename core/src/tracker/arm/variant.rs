//! The variants of the arm tracker: one table says what each does and how it is called.

/// Which tracker.
///
/// ```
/// use sinew_core::tracker::arm::{ArmOptions, PoseRule, Variant};
///
/// // The arm paper's own tracker, and its baseline that does not look at blobs.
/// let paper = ArmOptions { variant: Variant::Corrected, ..ArmOptions::default() };
/// assert!(paper.check().is_ok());
/// let traits = paper.variant.traits();
/// assert!(traits.drives_hands && traits.pose == PoseRule::NearestElbow);
/// assert!(!Variant::Standard.traits().drives_hands);
/// // Names of the command line and of files.
/// assert_eq!(Variant::from_name("bootstrap"), Some(Variant::Bootstrap));
/// assert_eq!(Variant::from_name("pik-paid"), Some(Variant::PikWeighted), "the name of older files");
/// assert_eq!(Variant::default().traits().name, "pik");
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Variant {
    /// Blobs drive goals, PIK turns goals into poses; weights are not corrected for the proposal.
    #[default]
    Pik,
    /// As `Pik`, with a blob likelihood and exact importance weights.
    PikWeighted,
    /// Goals from the goal process only, blobs in the likelihood.
    Bootstrap,
    /// The arm paper: blobs correct hands, the elbow goes to the circle's nearest point.
    Corrected,
    /// The arm paper's baseline: sequential Monte Carlo without blobs.
    Standard,
}

/// How a particle's pose follows from where its hand goes.
///
/// ```
/// use sinew_core::tracker::arm::{PoseRule, Variant};
///
/// let by_circle = Variant::ALL.iter().filter(|variant| variant.traits().pose == PoseRule::NearestElbow);
/// assert_eq!(by_circle.count(), 2, "both trackers of the arm paper");
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PoseRule {
    /// The arm paper: the elbow on its circle's point nearest to the predicted one.
    NearestElbow,
    /// PIK: a draw from the Laplace proposal about the goal's pose.
    InverseKinematics,
}

/// What one variant does.
///
/// ```
/// use sinew_core::tracker::arm::Variant;
///
/// let exact = Variant::PikWeighted.traits();
/// assert!(exact.corrects_weight && !exact.has_gate, "the transition density says what a jump costs");
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct VariantTraits {
    /// Name on the command line and in files.
    pub name: &'static str,
    /// Another name that is read too.
    pub alias: Option<&'static str>,
    /// One line for help texts.
    pub summary: &'static str,
    /// Whether blobs send some particles' hands somewhere.
    pub drives_hands: bool,
    /// How poses follow from hands.
    pub pose: PoseRule,
    /// Whether the weight has the importance ratio of the goal and of the pose; goals then stay as
    /// drawn.
    pub corrects_weight: bool,
    /// Whether the likelihood has the blob term p(blobs | hand), with the area cue as a factor.
    pub has_blob_term: bool,
    /// Whether the weight has the area cue on its own.
    pub has_area_cue: bool,
    /// Whether the continuity gate weighs jumps to a blob.
    pub has_gate: bool,
}

impl Variant {
    /// All variants, in the order of the documentation.
    pub const ALL: [Self; 5] = [Self::Pik, Self::PikWeighted, Self::Bootstrap, Self::Corrected, Self::Standard];

    /// What the variant does: the table.
    #[must_use]
    pub const fn traits(self) -> VariantTraits {
        match self {
            Self::Pik => VariantTraits {
                name: "pik",
                alias: None,
                summary: "Blobs drive goals, inverse kinematics turns goals into poses",
                drives_hands: true,
                pose: PoseRule::InverseKinematics,
                corrects_weight: false,
                has_blob_term: false,
                has_area_cue: true,
                has_gate: true,
            },
            Self::PikWeighted => VariantTraits {
                name: "pik-weighted",
                alias: Some("pik-paid"),
                summary: "As pik, with a blob likelihood and exact importance weights",
                drives_hands: true,
                pose: PoseRule::InverseKinematics,
                corrects_weight: true,
                has_blob_term: true,
                has_area_cue: false,
                has_gate: false,
            },
            Self::Bootstrap => VariantTraits {
                name: "bootstrap",
                alias: None,
                summary: "Goals from the motion model only, blobs in the likelihood",
                drives_hands: false,
                pose: PoseRule::InverseKinematics,
                corrects_weight: false,
                has_blob_term: true,
                has_area_cue: false,
                has_gate: false,
            },
            Self::Corrected => VariantTraits {
                name: "corrected",
                alias: None,
                summary: "The arm paper: blobs correct hands",
                drives_hands: true,
                pose: PoseRule::NearestElbow,
                corrects_weight: false,
                has_blob_term: false,
                has_area_cue: true,
                has_gate: true,
            },
            Self::Standard => VariantTraits {
                name: "standard",
                alias: None,
                summary: "The arm paper's baseline, without blobs",
                drives_hands: false,
                pose: PoseRule::NearestElbow,
                corrects_weight: false,
                has_blob_term: false,
                has_area_cue: false,
                has_gate: false,
            },
        }
    }

    /// The variant of a name or alias.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|variant| {
            let traits = variant.traits();
            traits.name == name || traits.alias == Some(name)
        })
    }
}

#[cfg(feature = "serde")]
impl serde::Serialize for Variant {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.traits().name)
    }
}

#[cfg(feature = "serde")]
impl<'de> serde::Deserialize<'de> for Variant {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ByName;
        impl serde::de::Visitor<'_> for ByName {
            type Value = Variant;

            fn expecting(&self, formatter: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
                formatter.write_str("one of")?;
                Variant::ALL.iter().try_for_each(|variant| write!(formatter, " `{}`", variant.traits().name))
            }

            fn visit_str<E: serde::de::Error>(self, name: &str) -> Result<Variant, E> {
                Variant::from_name(name).ok_or_else(|| E::invalid_value(serde::de::Unexpected::Str(name), &self))
            }
        }
        deserializer.deserialize_str(ByName)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_of_variants_is_that_of_the_documentation() {
        let row = |v: Variant| {
            let t = v.traits();
            (t.drives_hands, t.pose == PoseRule::InverseKinematics, t.has_blob_term, t.has_area_cue, t.corrects_weight)
        };
        assert_eq!(row(Variant::Standard), (false, false, false, false, false));
        assert_eq!(row(Variant::Corrected), (true, false, false, true, false));
        assert_eq!(row(Variant::Bootstrap), (false, true, true, false, false));
        assert_eq!(row(Variant::Pik), (true, true, false, true, false));
        assert_eq!(row(Variant::PikWeighted), (true, true, true, false, true));
    }

    #[test]
    fn a_gate_needs_driven_hands_and_uncorrected_weights() {
        for variant in Variant::ALL {
            let traits = variant.traits();
            assert_eq!(traits.has_gate, traits.drives_hands && !traits.corrects_weight, "{variant:?}");
            assert_eq!(Variant::from_name(traits.name), Some(variant));
        }
    }
}
