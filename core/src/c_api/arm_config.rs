//! Camera, body and options of the arm trackers.

use super::arm_frame::{SINEW_ARM_PARTICLES, shoulder};
use super::object::config_room;
use super::status::{Answer, SinewStatus, status};
use crate::camera::{Camera, Pixel};
use crate::checksum::Crc32;
use crate::error::within;
use crate::math::Vec3;
use crate::ranges::MAX_PX;
use crate::skeleton::{ArmGeometry, Side};
use crate::tracker::arm::options::{AreaCue, Gate};
use crate::tracker::arm::{ArmModel, ArmOptions, Variant};
use core::mem::MaybeUninit;

/// Blobs drive goals, inverse kinematics turns goals into poses; weights are not corrected.
pub const SINEW_ARM_PIK: u32 = 0;
/// As `SINEW_ARM_PIK`, with a blob likelihood and exact importance weights.
pub const SINEW_ARM_PIK_WEIGHTED: u32 = 1;
/// Goals from the motion model only, blobs in the likelihood.
pub const SINEW_ARM_BOOTSTRAP: u32 = 2;
/// The arm paper: blobs correct hands, the elbow goes to the nearest point of its circle.
pub const SINEW_ARM_CORRECTED: u32 = 3;
/// The arm paper's baseline: sequential Monte Carlo without blobs.
pub const SINEW_ARM_STANDARD: u32 = 4;

/// Camera, body, seed and options of an arm tracker; see `sinew_arm_default_config`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct SinewArmConfig {
    /// Bytes of this structure, as the function that fills it writes them; any other number is
    /// refused.
    pub struct_bytes: u32,
    /// Particles, 1 to `SINEW_ARM_PARTICLES`. The time of a step grows with them.
    pub particles: u32,
    /// All random numbers follow from it: the same seed and frames give the same bits.
    pub seed: u64,
    /// Width of the image, pixels.
    pub image_width_px: u32,
    /// Height of the image, pixels.
    pub image_height_px: u32,
    /// Focal lengths along columns and rows, pixels.
    pub focal_px: [f32; 2],
    /// Column and row of the principal point, pixels.
    pub principal_point_px: [f32; 2],
    /// From shoulder to elbow, metres.
    pub upper_arm_m: f32,
    /// From elbow to the middle of the hand, metres.
    pub forearm_m: f32,
    /// Left and right shoulder, metres in camera axes: x to the right of the image, y down, z along
    /// the line of sight. A tracker of one arm looks at its own side only.
    pub shoulders_m: [[f32; 3]; 2],
    /// Which tracker: `SINEW_ARM_PIK` or another one.
    pub variant: u32,
    /// Most pairs of edge pixels of a limb whose orientation is looked at, 10 to 65535.
    pub max_pairs: u32,
    /// Steps of the pose solver, 1 to 100.
    pub solver_steps: u32,
    /// 1 where the shoulders are guessed and not measured; else 0.
    pub has_guessed_shoulders: u32,
    /// Spread of the hand's goal after one second, metres along each axis, 0.001 to 10.
    pub hand_std_m_per_sqrt_s: f32,
    /// Spread along the ray of a hand that a blob corrected, after one second, metres, 0.001 to 10.
    pub ray_std_m_per_sqrt_s: f32,
    /// Spread of each angle after one second, radians, 0.001 to 10.
    pub angle_std_rad_per_sqrt_s: f32,
    /// Area of the image of a hand seen from the side of its forearm, times squared depth over
    /// squared focal length, square metres, 0.0001 to 1.
    pub hand_area_m2: f32,
    /// Standard deviation of the logarithm of that area, 0.01 to 10: how little it says of the
    /// distance.
    pub area_log_std: f32,
    /// How far a hand may be from where it is expected, metres (standard deviation), 0.01 to 10.
    pub gate_std_m: f32,
    /// Growth of that with the time since the hand was last seen, metres per second, 0 to 100.
    pub gate_growth_m_per_s: f32,
    /// What a jump of any length keeps of its weight, 1e-9 to 1.
    pub gate_floor: f32,
    /// Without a blob for longer than this the arm counts as lost, seconds, 0.01 to 3600.
    pub lost_after_s: f32,
    /// Zero.
    pub reserved: u32,
}

impl SinewArmConfig {
    /// Writes camera, arm of one side and options where they stay, or only checks them.
    #[inline(never)]
    pub(super) fn write_model(&self, side: Side, place: Option<&mut MaybeUninit<ArmModel>>) -> Answer {
        let [focal_u, focal_v] = self.focal_px;
        let [u_px, v_px] = self.principal_point_px;
        for length_px in [focal_u, focal_v] {
            within("focal_px", length_px, 1.0, 16.0 * MAX_PX)?;
        }
        for coordinate in [u_px, v_px] {
            within("principal_point_px", coordinate, -MAX_PX, MAX_PX)?;
        }
        for length_m in [self.upper_arm_m, self.forearm_m] {
            within("length of a limb", length_m, 0.01, 2.0)?;
        }
        let camera = Camera::new(focal_u, focal_v, Pixel::new(u_px, v_px))?;
        for side_px in [self.image_width_px, self.image_height_px] {
            within("image size", side_px as f32, 1.0, MAX_PX)?;
        }
        let geometry = ArmGeometry::new(side, self.upper_arm_m, self.forearm_m)?;
        let size_px = (self.image_width_px, self.image_height_px);
        ArmModel::write_into(place, camera, size_px, &geometry, &self.options()?)?;
        Ok(())
    }

    /// The tracker's options; the model checks their ranges.
    fn options(&self) -> Result<ArmOptions, SinewStatus> {
        if self.particles as usize > SINEW_ARM_PARTICLES {
            return Err(SinewStatus::OverCapacity);
        }
        if self.has_guessed_shoulders > 1 || self.reserved != 0 {
            return Err(SinewStatus::OutOfRange);
        }
        for (name, value, (low, high)) in self.ranges() {
            within(name, value, low, high)?;
        }
        let mut options = ArmOptions {
            variant: variant(self.variant)?,
            particles: self.particles as usize,
            solver_steps: self.solver_steps as usize,
            hand_std_m_per_sqrt_s: self.hand_std_m_per_sqrt_s,
            ray_std_m_per_sqrt_s: self.ray_std_m_per_sqrt_s,
            angle_std_rad_per_sqrt_s: [self.angle_std_rad_per_sqrt_s; _],
            area_cue: Some(AreaCue {
                hand_area_m2: self.hand_area_m2,
                log_std: self.area_log_std,
                ..AreaCue::default()
            }),
            gate: Some(Gate {
                std_m: self.gate_std_m,
                growth_m_per_s: self.gate_growth_m_per_s,
                floor: self.gate_floor,
                ..Gate::default()
            }),
            lost_after_s: self.lost_after_s,
            ..ArmOptions::default()
        };
        options.hough.max_pairs = self.max_pairs as usize;
        Ok(options.for_shoulder(self.has_guessed_shoulders == 0))
    }

    /// Options and their ranges. Chosen: wide about the defaults; with any of them every number of
    /// a tracker stays finite (`tests/c_interface/tests/fuzz/arm.rs`).
    const fn ranges(&self) -> [(&'static str, f32, (f32, f32)); 8] {
        [
            ("hand_std_m_per_sqrt_s", self.hand_std_m_per_sqrt_s, (0.001, 10.0)),
            ("ray_std_m_per_sqrt_s", self.ray_std_m_per_sqrt_s, (0.001, 10.0)),
            ("angle_std_rad_per_sqrt_s", self.angle_std_rad_per_sqrt_s, (0.001, 10.0)),
            ("hand_area_m2", self.hand_area_m2, (0.0001, 1.0)),
            ("area_log_std", self.area_log_std, (0.01, 10.0)),
            ("gate_std_m", self.gate_std_m, (0.01, 10.0)),
            ("gate_growth_m_per_s", self.gate_growth_m_per_s, (0.0, 100.0)),
            ("lost_after_s", self.lost_after_s, (0.01, 3600.0)),
        ]
    }

    /// Whether a tracker can begin with it, before anything is written.
    pub(super) fn check(&self) -> Answer {
        self.write_model(Side::Left, None)?;
        self.write_model(Side::Right, None)
    }

    /// Where the shoulder of `side` is to begin with.
    pub(super) fn shoulder(&self, side: Side) -> Result<Vec3, SinewStatus> {
        shoulder(&self.shoulders_m, side)
    }

    /// A checksum of what a saved state belongs to: all but seed and shoulders.
    pub(super) fn fingerprint(&self, kind: u32) -> u32 {
        let counts = [
            kind,
            self.particles,
            self.image_width_px,
            self.image_height_px,
            self.variant,
            self.max_pairs,
            self.solver_steps,
            self.has_guessed_shoulders,
        ];
        let pairs = [self.focal_px, self.principal_point_px, [self.upper_arm_m, self.forearm_m]];
        let options = [
            self.hand_std_m_per_sqrt_s,
            self.ray_std_m_per_sqrt_s,
            self.angle_std_rad_per_sqrt_s,
            self.hand_area_m2,
            self.area_log_std,
            self.gate_std_m,
            self.gate_growth_m_per_s,
            self.gate_floor,
            self.lost_after_s,
        ];
        let reals = pairs.into_iter().flatten().chain(options);
        counts.into_iter().chain(reals.map(f32::to_bits)).fold(Crc32::new(), Crc32::and_word).value()
    }
}

fn variant(number: u32) -> Result<Variant, SinewStatus> {
    match number {
        SINEW_ARM_PIK => Ok(Variant::Pik),
        SINEW_ARM_PIK_WEIGHTED => Ok(Variant::PikWeighted),
        SINEW_ARM_BOOTSTRAP => Ok(Variant::Bootstrap),
        SINEW_ARM_CORRECTED => Ok(Variant::Corrected),
        SINEW_ARM_STANDARD => Ok(Variant::Standard),
        _ => Err(SinewStatus::OutOfRange),
    }
}

/// Writes a configuration: a camera with square pixels, an adult who faces it at 1.25 metres, seed
/// 1, `SINEW_ARM_PARTICLES` particles, and the options that the host's command has.
///
/// `config_bytes` is `sizeof *config`: SINEW_STATUS_STRUCT_SIZE says that the program was compiled
/// with the header of another version. Returns SINEW_STATUS_OUT_OF_RANGE for a field of view that
/// does not lie between 0 and pi.
///
/// # Safety
/// `config` points at room of the size that is said.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_arm_default_config(
    image_width_px: u32,
    image_height_px: u32,
    horizontal_field_of_view_rad: f32,
    config: *mut SinewArmConfig,
    config_bytes: usize,
) -> SinewStatus {
    let camera = Camera::from_field_of_view(image_width_px, image_height_px, horizontal_field_of_view_rad);
    // SAFETY: the caller's duty.
    let room = unsafe { config_room(config, config_bytes) };
    status((|| {
        let (room, camera) = (room?, camera?);
        let middle = |side_px: u32| 0.5 * (side_px as f32 - 1.0);
        let options = ArmOptions::default();
        let (area, gate) = (AreaCue::default(), Gate::default());
        let [angle_std, ..] = options.angle_std_rad_per_sqrt_s;
        room.write(SinewArmConfig {
            struct_bytes: size_of::<SinewArmConfig>() as u32,
            particles: SINEW_ARM_PARTICLES as u32,
            seed: 1,
            image_width_px,
            image_height_px,
            focal_px: [camera.focal_px(); 2],
            principal_point_px: [middle(image_width_px), middle(image_height_px)],
            upper_arm_m: 0.30,
            forearm_m: 0.33,
            shoulders_m: [[0.19, -0.05, 1.25], [-0.19, -0.05, 1.25]],
            variant: SINEW_ARM_PIK,
            max_pairs: options.hough.max_pairs as u32,
            solver_steps: options.solver_steps as u32,
            has_guessed_shoulders: 0,
            hand_std_m_per_sqrt_s: options.hand_std_m_per_sqrt_s,
            ray_std_m_per_sqrt_s: options.ray_std_m_per_sqrt_s,
            angle_std_rad_per_sqrt_s: angle_std,
            hand_area_m2: area.hand_area_m2,
            area_log_std: area.log_std,
            gate_std_m: gate.std_m,
            gate_growth_m_per_s: gate.growth_m_per_s,
            gate_floor: gate.floor,
            lost_after_s: options.lost_after_s,
            reserved: 0,
        });
        Ok(())
    })())
}
