//! Options of the arm tracker, each with its default and its reason.

use super::variant::Variant;
use crate::error::{ParameterError, Rule, not_negative, positive, within};
use crate::math::exp;
use crate::observation::hough::HoughSettings;
use crate::skeleton::arm::ARM_ANGLES;

/// How the orientation densities of both limbs become one weight.
///
/// ```
/// use sinew_core::tracker::arm::{ArmOptions, options::LimbCombination};
///
/// // As in the arm paper: half of the sum.
/// let paper = ArmOptions { combination: LimbCombination::Mean, ..ArmOptions::default() };
/// assert!(paper.check().is_ok());
/// // A product without a floor would let one empty bin decide alone.
/// let wrong = ArmOptions { combination: LimbCombination::Product, product_floor: 0.0, ..paper };
/// assert_eq!(wrong.check().map_err(|error| error.parameter), Err("product_floor"));
/// // A guessed shoulder puts the edges elsewhere than expected: their mean counts, not their product.
/// let guessed = ArmOptions::default().for_shoulder(false);
/// assert_eq!(guessed.combination, LimbCombination::Mean);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum LimbCombination {
    /// The product where the shoulder's place is known, else the mean
    /// ([`ArmOptions::for_shoulder`]).
    #[default]
    Auto,
    /// Half of the sum, arm (3).
    Mean,
    /// Product of (density + floor); uniform is 1 + floor.
    Product,
}

/// Continuity gate: exp(-d^2 / 2 s^2) + floor, d from the corrected hand to the particle's own
/// prediction.
///
/// ```
/// use sinew_core::tracker::arm::{ArmOptions, options::{DEFAULT_GATE, Gate}};
///
/// // A camera of five pictures a second: hands go farther from one to the next.
/// let slow_camera = ArmOptions { gate: Some(Gate { std_m: 0.8, ..DEFAULT_GATE }), ..ArmOptions::default() };
/// assert!(slow_camera.check().is_ok());
/// // What a jump of any length keeps cannot be nothing.
/// let wrong = ArmOptions { gate: Some(Gate { floor: 0.0, ..DEFAULT_GATE }), ..ArmOptions::default() };
/// assert_eq!(wrong.check().map_err(|error| error.parameter), Err("gate.floor"));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct Gate {
    /// s while the hand is seen, metres.
    pub std_m: f32,
    /// Growth of s with the time since the hand was last seen, metres per second.
    pub growth_m_per_s: f32,
    /// What a jump of any length keeps.
    pub floor: f32,
    /// Share of visible hands that give no blob: what a particle that ignores the blobs keeps
    /// beside a blob that is surely the hand.
    pub missed_share: f32,
    /// Blobs are allotted particles by likelihood times nearness; nearness falls over this many s.
    pub allotment_reach: f32,
}

/// Area cue: the blob's area measures the hand's distance, since area times squared depth is about
/// constant.
///
/// ```
/// use sinew_core::tracker::arm::options::AreaCue;
///
/// // A hand of 194 square centimetres beside the forearm; it shows e^-0.85 of that when it points at the camera.
/// let cue = AreaCue { hand_area_m2: 0.0194, length_share: 0.65, foreshortening: 0.85, log_std: 0.3 };
/// assert_eq!(cue.expected_area_m2(0.0), 0.0194);
/// assert!((cue.expected_area_m2(1.0) / 0.0194 - 0.427).abs() < 1e-3);
/// assert_eq!(cue.expected_area_m2(-1.0), cue.expected_area_m2(1.0), "away from it is the same");
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct AreaCue {
    /// Length-weighted area of the image of a hand seen from the side of its forearm, times squared
    /// depth over squared focal length, square metres. For that area see
    /// [`crate::vision::candidate::HandCandidate::length_weighted_area_px`].
    #[cfg_attr(feature = "serde", serde(skip))]
    pub hand_area_m2: f32,
    /// Weight of the image's long axis in that area; the short axis has the rest.
    pub length_share: f32,
    /// How much smaller, in the area's logarithm, a hand is that points at the camera or away from
    /// it.
    pub foreshortening: f32,
    /// Standard deviation of the logarithm of the area.
    pub log_std: f32,
}

impl AreaCue {
    /// The area to expect where the forearm's direction and the line of sight have the cosine
    /// `pointing`, square metres.
    #[must_use]
    pub fn expected_area_m2(&self, pointing: f32) -> f32 {
        self.hand_area_m2 * exp(-self.foreshortening * pointing * pointing)
    }
}

/// Memory of blobs that were there and were not the hand.
///
/// ```
/// use sinew_core::tracker::arm::{ArmOptions, options::{BlobMemoryOptions, DEFAULT_BLOB_MEMORY}};
///
/// // A wooden door in the picture that looks like skin: what rests for long keeps a tenth of its likelihood only.
/// let memory = BlobMemoryOptions { rest_share: 0.1, ..DEFAULT_BLOB_MEMORY };
/// let options = ArmOptions { blob_memory: Some(memory), ..ArmOptions::default() };
/// assert!(options.check().is_ok());
/// // More than all of it cannot be kept.
/// let wrong = ArmOptions { blob_memory: Some(BlobMemoryOptions { rest_share: 1.5, ..memory }), ..options };
/// assert_eq!(wrong.check().map_err(|error| error.parameter), Err("blob_memory.rest_share"));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct BlobMemoryOptions {
    /// Time in which belief in a blob falls by 1/e while the hand is at another, seconds.
    pub fall_time_s: f32,
    /// Time in which it recovers, seconds.
    pub rise_time_s: f32,
    /// Belief that is never lost; it bounds how long a mistake can last.
    pub floor: f32,
    /// Share of its likelihood that a blob keeps that has long rested.
    pub rest_share: f32,
    /// Time in which a resting blob comes to that, seconds.
    pub rest_time_s: f32,
    /// A blob has moved when it is this far from where it last did, in cluster radii.
    pub moved_per_radius: f32,
}

/// What is reported as the estimate.
///
/// ```
/// use sinew_core::tracker::arm::example::{SHOULDERS_M, hand_blob, left_arm};
/// use sinew_core::tracker::arm::{ArmOptions, options::EstimateRule};
///
/// let (model, hand, shoulder_m) = (left_arm()?, hand_blob(), SHOULDERS_M[0]);
/// // Particles count to a blob within this many pixels of it; a large blob has its own radius.
/// assert!((model.least_cluster_radius_px() - 0.045 * model.camera().focal_px()).abs() < 1e-3);
/// assert!(model.cluster_radius_px(&hand) > model.least_cluster_radius_px());
/// // The plain mean of all particles lies between two hands where both are likely: this rule is for comparisons.
/// let plain = ArmOptions { estimate: EstimateRule::Mean, ..ArmOptions::default() };
/// assert!(plain.check().is_ok());
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum EstimateRule {
    /// Weighted mean of the heaviest cluster: the particles whose hand lies near one blob's centre,
    /// or near none.
    #[default]
    Cluster,
    /// Weighted mean of all particles.
    Mean,
}

/// Default of the share of the weights with which an estimate is sure.
///
/// Chosen on `sinew demo` with the seeds 1 to 20. Above it 1.8 % of the frames are more than 60
/// pixels off. Of all that have a likely blob it is 10 %.
pub const DEFAULT_SURE_SHARE: f32 = 0.96;
/// Default of the gate.
pub const DEFAULT_GATE: Gate =
    Gate { std_m: 0.4, growth_m_per_s: 1.0, floor: 0.02, missed_share: 0.1, allotment_reach: 3.0 };
/// Default of the memory of blobs.
pub const DEFAULT_BLOB_MEMORY: BlobMemoryOptions = BlobMemoryOptions {
    fall_time_s: 0.15,
    rise_time_s: 2.0,
    floor: 0.05,
    rest_share: 0.4,
    rest_time_s: 1.5,
    moved_per_radius: 0.25,
};
/// Default of the area cue: the hand of an adult of 1.75 m.
pub const DEFAULT_AREA_CUE: AreaCue =
    AreaCue { hand_area_m2: 0.0194, length_share: 0.65, foreshortening: 0.85, log_std: 0.3 };
/// Default of the cluster's radius: 25 pixels of a 640 pixel image with 60 degrees.
pub const DEFAULT_RADIUS_PER_FOCAL: f32 = 0.045;
/// Multiple of the area cue's standard deviation where the shoulder is guessed. The depth that fits
/// the arm may be far from the one that the area gives. Chosen: the cue still orders near and far.
const GUESSED_AREA_DOUBT: f32 = 3.0;

impl Default for Gate {
    fn default() -> Self {
        DEFAULT_GATE
    }
}

impl Default for AreaCue {
    fn default() -> Self {
        DEFAULT_AREA_CUE
    }
}

impl Default for BlobMemoryOptions {
    fn default() -> Self {
        DEFAULT_BLOB_MEMORY
    }
}

/// All options of one arm tracker.
///
/// ```
/// use sinew_core::tracker::arm::ArmOptions;
///
/// // A slow processor: fewer particles and steps, and no orientation of the limbs beyond 200 pairs of pixels.
/// let mut small = ArmOptions { particles: 20, solver_steps: 2, ..ArmOptions::default() };
/// small.hough.max_pairs = 200;
/// assert!(small.check().is_ok());
/// small.velocity_gain = 2.0;
/// assert_eq!(small.check().map_err(|error| error.parameter), Err("velocity_gain"));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct ArmOptions {
    /// Which tracker.
    pub variant: Variant,
    /// Number of particles.
    pub particles: usize,
    /// Combination of both limbs' orientation densities.
    pub combination: LimbCombination,
    /// What keeps one empty bin from deciding a product of both limbs' densities alone.
    pub product_floor: f32,
    /// Continuity gate, or none.
    #[cfg_attr(feature = "serde", serde(with = "super::switch"))]
    pub gate: Option<Gate>,
    /// Area cue, or none.
    #[cfg_attr(feature = "serde", serde(with = "super::switch"))]
    pub area_cue: Option<AreaCue>,
    /// Whether a goal of a weight without correction is drawn along the ray from prediction and
    /// area together. This needs the area cue, which then does not stand in the weight again.
    pub depth_from_area: bool,
    /// Memory of blobs that are not the hand, or none.
    #[cfg_attr(feature = "serde", serde(with = "super::switch"))]
    pub blob_memory: Option<BlobMemoryOptions>,
    /// What is reported.
    pub estimate: EstimateRule,
    /// Radius around a blob's centre of its cluster, as a share of the focal length.
    pub cluster_radius_per_focal: f32,
    /// Whether the pose keeps the arm's joint limits; without them it may bend as no arm does, for
    /// comparisons.
    pub joint_limits: bool,
    /// Share of the estimated velocity that goes on.
    pub velocity_persistence: f32,
    /// Share of a new velocity in the running one.
    pub velocity_gain: f32,
    /// Spread of the hand's goal after one second, metres along each axis.
    pub hand_std_m_per_sqrt_s: f32,
    /// Spread of the predicted elbow after one second (`corrected` and `standard`), metres along
    /// each axis.
    pub elbow_std_m_per_sqrt_s: f32,
    /// Spread along the ray of a hand that a blob corrected, after one second, metres.
    pub ray_std_m_per_sqrt_s: f32,
    /// What a frame's path adds to that spread, as a share of the path: a fast hand may turn
    /// towards the camera.
    pub ray_std_per_path: f32,
    /// Error of a blob's centre as the hand's place, as a share of the focal length.
    pub centre_std_per_focal: f32,
    /// Standard deviation of reaching a goal, W^(-1/2) of PIK (12); metres.
    pub reach_std_m: f32,
    /// The same across the ray, for goals that a blob drives.
    pub reach_across_std_m: f32,
    /// Spread of each angle after one second, lambda^(-1/2) of PIK (12); radians.
    pub angle_std_rad_per_sqrt_s: [f32; ARM_ANGLES],
    /// Steps of the pose solver.
    pub solver_steps: usize,
    /// Band around a limb within which edge pixels belong to it, metres at the limb's depth.
    pub limb_band_m: f32,
    /// Settings of the dynamic Hough transform.
    pub hough: HoughSettings,
    /// Time in which a limb's old orientation density fades by 1/e while the limb shows no moving
    /// edges, seconds.
    pub orientation_memory_s: f32,
    /// Share of the goal process that is uniform over the reachable space (`pik-weighted`).
    pub teleport_share: f32,
    /// Share of the blob likelihood that is uniform over the image (`pik-weighted`, `bootstrap`).
    pub clutter_share: f32,
    /// Without a blob for longer than this the arm counts as lost, seconds.
    pub lost_after_s: f32,
    /// Likelihood below which a blob leaves the estimate uncertain.
    pub sure_likelihood: f32,
    /// A blob leaves the estimate uncertain below this share of the particles' weights that are at
    /// any blob. The share is the blob's posterior probability against all others. It keeps a hand
    /// and a face apart where the likelihood does not.
    pub sure_share: f32,
}

impl Default for ArmOptions {
    fn default() -> Self {
        Self {
            variant: Variant::Pik,
            particles: 50,
            combination: LimbCombination::Auto,
            product_floor: 0.1,
            gate: Some(DEFAULT_GATE),
            area_cue: Some(DEFAULT_AREA_CUE),
            depth_from_area: false,
            blob_memory: Some(DEFAULT_BLOB_MEMORY),
            estimate: EstimateRule::Cluster,
            cluster_radius_per_focal: DEFAULT_RADIUS_PER_FOCAL,
            joint_limits: true,
            velocity_persistence: 0.9,
            velocity_gain: 0.8,
            hand_std_m_per_sqrt_s: 0.15,
            elbow_std_m_per_sqrt_s: 0.2,
            ray_std_m_per_sqrt_s: 1.0,
            ray_std_per_path: 1.0,
            centre_std_per_focal: 0.01,
            reach_std_m: 0.05,
            reach_across_std_m: 0.008,
            angle_std_rad_per_sqrt_s: [0.4, 0.4, 0.4, 0.4],
            solver_steps: 4,
            limb_band_m: 0.12,
            hough: HoughSettings::default(),
            orientation_memory_s: 0.7,
            teleport_share: 0.05,
            clutter_share: 0.1,
            lost_after_s: 1.0,
            sure_likelihood: 0.7,
            sure_share: DEFAULT_SURE_SHARE,
        }
    }
}

impl ArmOptions {
    /// The options for a shoulder whose place is known, or only guessed: settles
    /// [`LimbCombination::Auto`] and widens the area cue of a guessed one.
    #[must_use]
    pub fn for_shoulder(mut self, is_known: bool) -> Self {
        if self.combination == LimbCombination::Auto {
            self.combination = if is_known { LimbCombination::Product } else { LimbCombination::Mean };
        }
        if let Some(cue) = self.area_cue.as_mut().filter(|_| !is_known) {
            cue.log_std *= GUESSED_AREA_DOUBT;
        }
        self
    }

    /// The same for candidates whose likelihoods are a posterior over time and whose areas are not
    /// measured, as those of [`HandFinder`](crate::vision::objects::hands::HandFinder). There is no
    /// gate and no memory, which would count the past twice, and no depth from the area. The
    /// estimate is sure with half of the weights, since the likelihood says the rest.
    ///
    /// ```
    /// use sinew_core::tracker::arm::ArmOptions;
    ///
    /// let options = ArmOptions::default().for_hands_over_time();
    /// assert!(options.blob_memory.is_none() && options.gate.is_none() && options.area_cue.is_none());
    /// ```
    #[must_use]
    pub fn for_hands_over_time(self) -> Self {
        Self { gate: None, blob_memory: None, area_cue: None, depth_from_area: false, sure_share: 0.5, ..self }
    }

    /// Checks every value.
    ///
    /// # Errors
    /// Names the first value that is out of its range.
    pub fn check(&self) -> Result<(), ParameterError> {
        if self.particles == 0 {
            return Err(ParameterError::new("particles", Rule::NotEmpty));
        }
        within("product_floor", self.product_floor, 1.0e-6, 10.0)?;
        if let Some(gate) = self.gate {
            positive("gate.std_m", gate.std_m)?;
            not_negative("gate.growth_m_per_s", gate.growth_m_per_s)?;
            within("gate.floor", gate.floor, 1.0e-9, 1.0)?;
            within("gate.missed_share", gate.missed_share, 0.0, 1.0)?;
            positive("gate.allotment_reach", gate.allotment_reach)?;
        }
        if let Some(cue) = self.area_cue {
            positive("area_cue.hand_area_m2", cue.hand_area_m2)?;
            within("area_cue.length_share", cue.length_share, 0.0, 1.0)?;
            not_negative("area_cue.foreshortening", cue.foreshortening)?;
            positive("area_cue.log_std", cue.log_std)?;
        }
        if let Some(memory) = self.blob_memory {
            positive("blob_memory.fall_time_s", memory.fall_time_s)?;
            positive("blob_memory.rise_time_s", memory.rise_time_s)?;
            within("blob_memory.rest_share", memory.rest_share, 0.0, 1.0)?;
            positive("blob_memory.rest_time_s", memory.rest_time_s)?;
            positive("blob_memory.moved_per_radius", memory.moved_per_radius)?;
            within("blob_memory.floor", memory.floor, 1.0e-6, 1.0)?;
        }
        positive("cluster_radius_per_focal", self.cluster_radius_per_focal)?;
        within("velocity_persistence", self.velocity_persistence, 0.0, 1.0)?;
        within("velocity_gain", self.velocity_gain, 0.0, 1.0)?;
        positive("hand_std_m_per_sqrt_s", self.hand_std_m_per_sqrt_s)?;
        positive("elbow_std_m_per_sqrt_s", self.elbow_std_m_per_sqrt_s)?;
        positive("ray_std_m_per_sqrt_s", self.ray_std_m_per_sqrt_s)?;
        not_negative("ray_std_per_path", self.ray_std_per_path)?;
        positive("centre_std_per_focal", self.centre_std_per_focal)?;
        positive("reach_std_m", self.reach_std_m)?;
        positive("reach_across_std_m", self.reach_across_std_m)?;
        for std in self.angle_std_rad_per_sqrt_s {
            positive("angle_std_rad_per_sqrt_s", std)?;
        }
        if !(1..=100).contains(&self.solver_steps) {
            return Err(ParameterError::new("solver_steps", Rule::Within { low: 1.0, high: 100.0 }));
        }
        positive("limb_band_m", self.limb_band_m)?;
        self.hough.check()?;
        positive("orientation_memory_s", self.orientation_memory_s)?;
        within("teleport_share", self.teleport_share, 1.0e-6, 1.0)?;
        within("clutter_share", self.clutter_share, 1.0e-6, 1.0)?;
        positive("lost_after_s", self.lost_after_s)?;
        within("sure_likelihood", self.sure_likelihood, 0.0, 1.0)?;
        within("sure_share", self.sure_share, 0.0, 1.0)?;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_defaults_are_legal_and_a_wrong_value_is_named() {
        ArmOptions::default().check().unwrap();
        let none = ArmOptions { particles: 0, ..ArmOptions::default() };
        assert_eq!(none.check().unwrap_err().parameter, "particles");
        let gate = Gate { std_m: -1.0, ..DEFAULT_GATE };
        let wrong = ArmOptions { gate: Some(gate), ..ArmOptions::default() };
        assert_eq!(wrong.check().unwrap_err(), ParameterError::new("gate.std_m", Rule::Positive));
    }
}
