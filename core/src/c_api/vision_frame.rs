//! The configuration of the front end, and its result for a frame.

use super::status::SinewStatus;
use crate::error::within;
use crate::vision::blobs::DEFAULT_MIN_AREA_FRACTION;
use crate::vision::candidate::HandCandidate;
use crate::vision::components::BoundingBox;
use crate::vision::edges::EdgePixel;
use crate::vision::front_end::FrameLines;
use crate::vision::front_end::edge_lines::{DEFAULT_KNOWN_STEP, DEFAULT_NEW_STEP, EdgeSteps};
use crate::vision::skin::GaussianSkin;

/// 5 bits of red (the highest), 6 of green, 5 of blue.
pub const SINEW_PIXEL_RGB565: u32 = 0;
/// The same with both bytes swapped, as cameras with an 8-bit port and a little-endian processor
/// have it.
pub const SINEW_PIXEL_RGB565_SWAPPED: u32 = 1;
/// Y in the low byte; in the high byte U of a pair of pixels in the left one, V in the right one.
pub const SINEW_PIXEL_YUYV: u32 = 2;

/// Skin as a normal distribution of chromaticity r = R / (R + G + B), g = G / (R + G + B).
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct SinewSkin {
    /// Means of r and g.
    pub mean: [f32; 2],
    /// Covariance: rr, rg, gg.
    pub covariance: [f32; 3],
    /// Mahalanobis distance within which a colour counts as skin.
    pub threshold: f32,
    /// Least R + G + B, 0 to 765: darker pixels have no usable colour.
    pub min_sum: u32,
}

/// A box of pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(C)]
pub struct SinewBox {
    /// Its first column.
    pub left_px: u32,
    /// Its first row.
    pub top_px: u32,
    /// Columns, at least 1.
    pub width_px: u32,
    /// Rows, at least 1.
    pub height_px: u32,
}

/// Frames and skin; see `sinew_vision_default_config`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct SinewVisionConfig {
    /// Bytes of this structure, as the function that fills it writes them; any other number is
    /// refused.
    pub struct_bytes: u32,
    /// Width of a frame, 1 to 320 pixels; to 640 with SINEW_VGA.
    pub width_px: u32,
    /// Height of a frame, 1 to 240 pixels; to 480 with SINEW_VGA.
    pub height_px: u32,
    /// `SINEW_PIXEL_RGB565`, `SINEW_PIXEL_RGB565_SWAPPED` or `SINEW_PIXEL_YUYV`.
    pub pixel_format: u32,
    /// Which colours count as skin.
    pub skin: SinewSkin,
    /// Least step of a new edge, grey levels, 5 to 255.
    pub new_step: f32,
    /// Least step of an edge of the last frame, grey levels, from 5 to `new_step`.
    pub known_step: f32,
    /// Least area of a blob, as a share of the image, 0 to 1.
    pub min_area_share: f32,
    /// Colours that are judged at the beginning of a frame while another skin is learned; 0 learns
    /// it at once, in the call that gives it.
    pub skin_colours_per_frame: u32,
}

/// What a frame showed; all losses zero means that it is exact.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct SinewVisionResult {
    /// Blobs that may be a hand, the most likely first; null where there are none.
    pub candidates: *const HandCandidate,
    /// Temporal edge pixels in the order of rows; null where there are none.
    pub edges: *const EdgePixel,
    /// Number of candidates.
    pub candidate_count: u32,
    /// Number of edge pixels.
    pub edge_count: u32,
    /// Components that found no room among those that grew at the same time.
    pub dropped_components: u32,
    /// Pixels of those, and of runs that found no room in their line.
    pub dropped_px: u32,
    /// Blobs less likely than all in the list.
    pub dropped_blobs: u32,
    /// Temporal edge pixels that were thinned out.
    pub dropped_edges: u32,
    /// Lines that did not come, or were too short.
    pub missing_lines: u32,
    /// Lines that came twice or too late.
    pub ignored_lines: u32,
}

impl SinewSkin {
    pub(super) fn of(model: &GaussianSkin) -> Self {
        Self {
            mean: [model.mean_r(), model.mean_g()],
            covariance: model.covariance(),
            threshold: model.threshold(),
            min_sum: u32::from(model.min_sum()),
        }
    }

    pub(super) fn model(&self) -> Result<GaussianSkin, SinewStatus> {
        let [mean_r, mean_g] = self.mean;
        let min_sum = u16::try_from(self.min_sum).map_err(|_| SinewStatus::OutOfRange)?;
        Ok(GaussianSkin::new(mean_r, mean_g, self.covariance, self.threshold, min_sum)?)
    }
}

impl SinewVisionConfig {
    /// Width and height.
    pub(super) const fn size(&self) -> (usize, usize) {
        (self.width_px as usize, self.height_px as usize)
    }

    /// The thresholds of edges.
    pub(super) fn steps(&self) -> Result<EdgeSteps, SinewStatus> {
        Ok(EdgeSteps::new(self.new_step, self.known_step)?)
    }

    /// The least area of a blob.
    pub(super) fn min_area_share(&self) -> Result<f32, SinewStatus> {
        Ok(within("min_area_share", self.min_area_share, 0.0, 1.0)?)
    }
}

impl SinewBox {
    /// The box, if it lies inside of a frame of `width_px` x `height_px` pixels.
    pub(super) fn inside(&self, width_px: u32, height_px: u32) -> Result<BoundingBox, SinewStatus> {
        let side = |first: u32, length: u32, room: u32| {
            let last = first.checked_add(length.checked_sub(1)?).filter(|&last| last < room)?;
            Some((u16::try_from(first).ok()?, u16::try_from(last).ok()?))
        };
        let (min_u, max_u) = side(self.left_px, self.width_px, width_px).ok_or(SinewStatus::OutOfRange)?;
        let (min_v, max_v) = side(self.top_px, self.height_px, height_px).ok_or(SinewStatus::OutOfRange)?;
        Ok(BoundingBox { min_u, min_v, max_u, max_v })
    }
}

fn start<T>(list: &[T]) -> *const T {
    if list.is_empty() { core::ptr::null() } else { list.as_ptr() }
}

impl SinewVisionResult {
    pub(super) fn of(seen: &FrameLines<'_>) -> Self {
        let losses = seen.losses;
        Self {
            candidates: start(seen.candidates),
            edges: start(seen.edges),
            candidate_count: seen.candidates.len() as u32,
            edge_count: seen.edges.len() as u32,
            dropped_components: losses.dropped_components,
            dropped_px: losses.dropped_px,
            dropped_blobs: losses.dropped_blobs,
            dropped_edges: losses.dropped_edges,
            missing_lines: losses.missing_lines,
            ignored_lines: losses.ignored_lines,
        }
    }
}

/// Writes a configuration: 320 x 240 pixels of RGB565, skin of many people under many lights.
///
/// `config_bytes` is `sizeof *config`: SINEW_STATUS_STRUCT_SIZE says that the program was compiled
/// with the header of another version.
///
/// # Safety
/// `config` points at room of the size that is said.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_vision_default_config(
    config: *mut SinewVisionConfig,
    config_bytes: usize,
) -> SinewStatus {
    // SAFETY: the caller's duty.
    let room = unsafe { super::object::config_room(config, config_bytes) };
    super::status::status(room.map(|room| {
        // The host's shipped Gaussian model, rounded.
        let skin = SinewSkin {
            mean: [0.4518, 0.3157],
            covariance: [0.001_659, 0.000_035_8, 0.000_184_1],
            threshold: 2.25,
            min_sum: 215,
        };
        room.write(SinewVisionConfig {
            struct_bytes: size_of::<SinewVisionConfig>() as u32,
            width_px: 320,
            height_px: 240,
            pixel_format: SINEW_PIXEL_RGB565,
            skin,
            new_step: DEFAULT_NEW_STEP,
            known_step: DEFAULT_KNOWN_STEP,
            min_area_share: DEFAULT_MIN_AREA_FRACTION,
            skin_colours_per_frame: 0,
        });
    }))
}
