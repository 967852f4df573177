//! The camera: lines in, the left arm out.

use crate::layout::{HEIGHT, WIDTH};
use sinew_core::camera::Camera as Lens;
use sinew_core::error::ParameterError;
use sinew_core::math::Vec3;
use sinew_core::skeleton::{ArmGeometry, Side};
use sinew_core::slot::Slot;
use sinew_core::tracker::arm::{ArmEstimate, ArmFrame, ArmImage, ArmModel, ArmOptions, ArmTracker};
use sinew_core::vision::front_end::PersonLines;
use sinew_core::vision::front_end::pixel_format::Rgb565;
use sinew_core::vision::skin::GaussianSkin;

/// Most particles.
pub const PARTICLES: usize = 50;
/// Horizontal field of view, radians: 60 degrees, as small cameras have.
const FIELD_OF_VIEW_RAD: f32 = 1.047_197_6;
/// From shoulder to elbow and from there to the hand, metres: an adult of 1.75 m.
const LIMBS_M: [f32; 2] = [0.30, 0.33];
/// The left shoulder of a person who faces the camera at 1.25 m.
const SHOULDER_M: [f32; 3] = [0.19, -0.05, 1.25];

/// Front end and tracker; all zeros before they begin, so that they take no flash.
#[derive(Debug)]
pub struct Camera {
    lines: PersonLines<Rgb565>,
    model: Slot<ArmModel>,
    arm: Slot<ArmTracker<PARTICLES>>,
}

impl Camera {
    /// Before the first frame.
    #[must_use]
    pub const fn empty() -> Self {
        Self { lines: PersonLines::empty(), model: Slot::Empty, arm: Slot::Empty }
    }

    /// Begins with frames of `size_px` (width, height), so many particles, and at most so many
    /// pairs of edge pixels of a limb.
    ///
    /// # Errors
    /// A number out of its range.
    #[inline(never)]
    pub fn begin(&mut self, size_px: (u16, u16), particles: usize, max_pairs: usize) -> Result<(), ParameterError> {
        let (width, height) = size_px;
        // Skin of many people under many lights; the default of the interface for C.
        let skin = GaussianSkin::new(0.4518, 0.3157, [0.001_659, 0.000_035_8, 0.000_184_1], 2.25, 215)?;
        self.lines.begin((width.into(), height.into()), &skin)?;
        let lens = Lens::from_field_of_view(width.into(), height.into(), FIELD_OF_VIEW_RAD)?;
        let arm = ArmGeometry::new(Side::Left, LIMBS_M[0], LIMBS_M[1])?;
        let mut options = ArmOptions { particles, ..ArmOptions::default() };
        options.hough.max_pairs = max_pairs;
        let model = ArmModel::new(lens, (width.into(), height.into()), arm, options)?;
        self.arm.get_or_insert(ArmTracker::empty).begin(&model, Vec3::from(SHOULDER_M), 1)?;
        self.model = Slot::Full(model);
        Ok(())
    }

    /// The default options, and the frames that are recorded.
    ///
    /// # Errors
    /// None: the numbers are in their ranges.
    pub fn begin_recorded(&mut self) -> Result<(), ParameterError> {
        let max_pairs = ArmOptions::default().hough.max_pairs;
        self.begin((WIDTH as u16, HEIGHT as u16), PARTICLES, max_pairs)
    }

    /// Reads a line; the first one begins a frame.
    #[inline(never)]
    pub fn line(&mut self, row: usize, pixels: &[u16]) {
        if row == 0 {
            self.lines.begin_frame();
        }
        self.lines.line(row, pixels);
    }

    /// Ends the frame: blobs, edges and, in a call of its own, the arm. `None` before
    /// [`Self::begin`].
    #[inline(never)]
    pub fn end(&mut self, timestamp_us: u64) -> Option<ArmEstimate> {
        let seen = self.lines.end_frame()?;
        let image = ArmImage { candidates: seen.lines.candidates, edges: seen.lines.edges };
        let frame = ArmFrame { timestamp_us, image: Some(image), shoulder_m: Vec3::from(SHOULDER_M) };
        Some(self.arm.get_mut()?.step(self.model.get()?, &frame))
    }
}
