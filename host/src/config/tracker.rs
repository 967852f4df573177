//! Section `[tracker]`.

use serde::{Deserialize, Serialize};
use sinew_core::error::{ParameterError, Rule, not_negative, positive, within};
use sinew_core::observation::hough::HoughSettings;
use sinew_core::tracker::arm::options::{
    AreaCue, BlobMemoryOptions, DEFAULT_BLOB_MEMORY, DEFAULT_GATE, DEFAULT_RADIUS_PER_FOCAL, EstimateRule, Gate,
    LimbCombination,
};
use sinew_core::tracker::arm::{ArmOptions, Variant};

/// Most particles that the command tracks with.
pub const MAX_PARTICLES: usize = 5000;

/// How much less the area tells of the depth where the shoulders are guessed.
const GUESSED_AREA_DOUBT: f32 = 3.0;

/// Which tracker.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "command", derive(clap::ValueEnum))]
#[serde(rename_all = "kebab-case")]
pub enum VariantName {
    /// Blobs drive goals, inverse kinematics turns goals into poses.
    #[default]
    Pik,
    /// As pik, with a blob likelihood and every goal paid for exactly.
    PikPaid,
    /// Goals from the motion model only, blobs in the likelihood.
    Bootstrap,
    /// The arm paper: blobs correct hands.
    Corrected,
    /// The arm paper's baseline, without blobs.
    Standard,
}

impl From<VariantName> for Variant {
    fn from(name: VariantName) -> Self {
        match name {
            VariantName::Pik => Self::Pik,
            VariantName::PikPaid => Self::PikPaid,
            VariantName::Bootstrap => Self::Bootstrap,
            VariantName::Corrected => Self::Corrected,
            VariantName::Standard => Self::Standard,
        }
    }
}

/// How both limbs' orientations become one weight.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum CombinationName {
    /// `product` where the file says where both shoulders are, else `mean`.
    #[default]
    Auto,
    /// Eq. (3) of the arm paper.
    Mean,
    /// Product with a floor.
    Product,
}

/// What is reported.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum EstimateName {
    /// Mean of the heaviest cluster of particles.
    #[default]
    Cluster,
    /// Mean of all particles.
    Mean,
}

/// Options of the tracker; see [`ArmOptions`] for what each means.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
#[allow(missing_docs)]
pub struct TrackerConfig {
    pub variant: VariantName,
    pub particles: usize,
    pub combination: CombinationName,
    pub product_floor: f32,
    pub gate: bool,
    pub gate_std_m: f32,
    pub gate_growth_m_per_s: f32,
    pub gate_floor: f32,
    pub gate_missed_share: f32,
    pub gate_allotment_reach: f32,
    pub joint_limits: bool,
    pub area_cue: bool,
    pub area_length_share: f32,
    pub area_foreshortening: f32,
    pub area_log_std: f32,
    pub depth_from_area: bool,
    pub blob_memory: bool,
    pub blob_fall_time_s: f32,
    pub blob_rise_time_s: f32,
    pub blob_floor: f32,
    pub blob_rest_share: f32,
    pub blob_rest_time_s: f32,
    pub estimate: EstimateName,
    pub cluster_radius_per_focal: f32,
    pub velocity_persistence: f32,
    pub velocity_gain: f32,
    pub hand_std_m_per_sqrt_s: f32,
    pub elbow_std_m_per_sqrt_s: f32,
    pub ray_std_m_per_sqrt_s: f32,
    pub ray_std_per_path: f32,
    pub centre_std_per_focal: f32,
    pub reach_std_m: f32,
    pub reach_across_std_m: f32,
    pub angle_std_rad_per_sqrt_s: [f32; 4],
    pub solver_steps: usize,
    pub limb_band_m: f32,
    pub hough_bins: usize,
    pub hough_window: usize,
    pub hough_gamma: f32,
    pub hough_max_pairs: usize,
    pub hough_min_separation_px: f32,
    pub hough_min_pixels: usize,
    pub hough_doubt_pixels: f32,
    pub orientation_memory_s: f32,
    pub teleport_share: f32,
    pub clutter_share: f32,
    pub lost_after_s: f32,
}

impl Default for TrackerConfig {
    fn default() -> Self {
        let options = ArmOptions::default();
        let gate = options.gate.unwrap_or(DEFAULT_GATE);
        let memory = options.blob_memory.unwrap_or(DEFAULT_BLOB_MEMORY);
        Self {
            variant: VariantName::Pik,
            particles: options.particles,
            combination: CombinationName::Auto,
            product_floor: 0.1,
            gate: options.gate.is_some(),
            gate_std_m: gate.std_m,
            gate_growth_m_per_s: gate.growth_m_per_s,
            gate_floor: gate.floor,
            gate_missed_share: gate.missed_share,
            gate_allotment_reach: gate.allotment_reach,
            joint_limits: true,
            area_cue: options.area_cue.is_some(),
            area_length_share: options.area_cue.map_or(0.65, |cue| cue.length_share),
            area_foreshortening: options.area_cue.map_or(0.85, |cue| cue.foreshortening),
            area_log_std: options.area_cue.map_or(0.3, |cue| cue.log_std),
            depth_from_area: options.depth_from_area,
            blob_memory: options.blob_memory.is_some(),
            blob_fall_time_s: memory.fall_time_s,
            blob_rise_time_s: memory.rise_time_s,
            blob_floor: memory.floor,
            blob_rest_share: memory.rest_share,
            blob_rest_time_s: memory.rest_time_s,
            estimate: EstimateName::Cluster,
            cluster_radius_per_focal: match options.estimate {
                EstimateRule::HeaviestCluster { radius_per_focal } => radius_per_focal,
                EstimateRule::MeanOfAll => DEFAULT_RADIUS_PER_FOCAL,
            },
            velocity_persistence: options.velocity_persistence,
            velocity_gain: options.velocity_gain,
            hand_std_m_per_sqrt_s: options.hand_std_m_per_sqrt_s,
            elbow_std_m_per_sqrt_s: options.elbow_std_m_per_sqrt_s,
            ray_std_m_per_sqrt_s: options.ray_std_m_per_sqrt_s,
            ray_std_per_path: options.ray_std_per_path,
            centre_std_per_focal: options.centre_std_per_focal,
            reach_std_m: options.reach_std_m,
            reach_across_std_m: options.reach_across_std_m,
            angle_std_rad_per_sqrt_s: options.angle_std_rad_per_sqrt_s,
            solver_steps: options.solver_steps,
            limb_band_m: options.limb_band_m,
            hough_bins: options.hough.bins,
            hough_window: options.hough.window,
            hough_gamma: options.hough.gamma,
            hough_max_pairs: options.hough.max_pairs,
            hough_min_separation_px: options.hough.min_separation_px,
            hough_min_pixels: options.hough.min_pixels,
            hough_doubt_pixels: options.hough.doubt_pixels,
            orientation_memory_s: options.orientation_memory_s,
            teleport_share: options.teleport_share,
            clutter_share: options.clutter_share,
            lost_after_s: options.lost_after_s,
        }
    }
}

impl TrackerConfig {
    pub(super) fn check(&self) -> Result<(), ParameterError> {
        if !(1..=MAX_PARTICLES).contains(&self.particles) {
            let rule = Rule::Within { low: 1.0, high: MAX_PARTICLES as f32 };
            return Err(ParameterError::new("particles", rule));
        }
        // The options name some values otherwise than the file does: these are checked under the file's names.
        positive("gate_std_m", self.gate_std_m)?;
        not_negative("gate_growth_m_per_s", self.gate_growth_m_per_s)?;
        within("gate_floor", self.gate_floor, 1.0e-9, 1.0)?;
        within("gate_missed_share", self.gate_missed_share, 0.0, 1.0)?;
        positive("gate_allotment_reach", self.gate_allotment_reach)?;
        within("product_floor", self.product_floor, 1.0e-6, 10.0)?;
        within("area_length_share", self.area_length_share, 0.0, 1.0)?;
        not_negative("area_foreshortening", self.area_foreshortening)?;
        positive("area_log_std", self.area_log_std)?;
        positive("blob_fall_time_s", self.blob_fall_time_s)?;
        positive("blob_rise_time_s", self.blob_rise_time_s)?;
        within("blob_floor", self.blob_floor, 1.0e-6, 1.0)?;
        within("blob_rest_share", self.blob_rest_share, 0.0, 1.0)?;
        positive("blob_rest_time_s", self.blob_rest_time_s)?;
        positive("cluster_radius_per_focal", self.cluster_radius_per_focal)?;
        self.options(true, 0.01).check()
    }

    fn gate_options(&self) -> Gate {
        Gate {
            std_m: self.gate_std_m,
            growth_m_per_s: self.gate_growth_m_per_s,
            floor: self.gate_floor,
            missed_share: self.gate_missed_share,
            allotment_reach: self.gate_allotment_reach,
        }
    }

    fn memory_options(&self) -> BlobMemoryOptions {
        BlobMemoryOptions {
            fall_time_s: self.blob_fall_time_s,
            rise_time_s: self.blob_rise_time_s,
            floor: self.blob_floor,
            rest_share: self.blob_rest_share,
            rest_time_s: self.blob_rest_time_s,
            ..DEFAULT_BLOB_MEMORY
        }
    }

    /// The options of the core's tracker.
    #[must_use]
    pub fn options(&self, shoulders_known: bool, hand_area_m2: f32) -> ArmOptions {
        // With guessed shoulders the depth that fits the arm may be far from the one that the area tells.
        let doubt = if shoulders_known { 1.0 } else { GUESSED_AREA_DOUBT };
        let is_product = match self.combination {
            CombinationName::Auto => shoulders_known,
            CombinationName::Mean => false,
            CombinationName::Product => true,
        };
        ArmOptions {
            variant: self.variant.into(),
            particles: self.particles,
            combination: if is_product {
                LimbCombination::Product { floor: self.product_floor }
            } else {
                LimbCombination::Mean
            },
            gate: self.gate.then_some(self.gate_options()),
            area_cue: self.area_cue.then_some(AreaCue {
                hand_area_m2,
                length_share: self.area_length_share,
                foreshortening: self.area_foreshortening,
                log_std: self.area_log_std * doubt,
            }),
            depth_from_area: self.depth_from_area,
            blob_memory: self.blob_memory.then_some(self.memory_options()),
            estimate: match self.estimate {
                EstimateName::Cluster => {
                    EstimateRule::HeaviestCluster { radius_per_focal: self.cluster_radius_per_focal }
                }
                EstimateName::Mean => EstimateRule::MeanOfAll,
            },
            velocity_persistence: self.velocity_persistence,
            velocity_gain: self.velocity_gain,
            hand_std_m_per_sqrt_s: self.hand_std_m_per_sqrt_s,
            elbow_std_m_per_sqrt_s: self.elbow_std_m_per_sqrt_s,
            ray_std_m_per_sqrt_s: self.ray_std_m_per_sqrt_s,
            ray_std_per_path: self.ray_std_per_path,
            centre_std_per_focal: self.centre_std_per_focal,
            reach_std_m: self.reach_std_m,
            reach_across_std_m: self.reach_across_std_m,
            angle_std_rad_per_sqrt_s: self.angle_std_rad_per_sqrt_s,
            solver_steps: self.solver_steps,
            limb_band_m: self.limb_band_m,
            hough: self.hough(),
            orientation_memory_s: self.orientation_memory_s,
            teleport_share: self.teleport_share,
            clutter_share: self.clutter_share,
            lost_after_s: self.lost_after_s,
        }
    }

    fn hough(&self) -> HoughSettings {
        HoughSettings {
            bins: self.hough_bins,
            window: self.hough_window,
            gamma: self.hough_gamma,
            max_pairs: self.hough_max_pairs,
            min_separation_px: self.hough_min_separation_px,
            min_pixels: self.hough_min_pixels,
            doubt_pixels: self.hough_doubt_pixels,
        }
    }
}
