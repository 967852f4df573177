//! The front end: a camera's lines in, blobs that may be hands and moving edges out, without a
//! frame buffer.

use super::cyclic::SINEW_ALIGN;
use super::object::{Handle, Object, given, given_config, list, object, place, room};
use super::stateful::{Stateful, size_functions, state_functions};
use super::status::{Answer, SinewStatus, status};
use super::vision_frame::{
    SINEW_PIXEL_RGB565, SINEW_PIXEL_RGB565_SWAPPED, SINEW_PIXEL_YUYV, SinewBox, SinewSkin, SinewVisionConfig,
    SinewVisionResult,
};
use crate::saved_state::{SavedState, StateKind, StateVisitor};
use crate::slot::Slot;
#[cfg(not(feature = "vga"))]
use crate::vision::front_end::QvgaFrontEnd as FrontEnd;
#[cfg(feature = "vga")]
use crate::vision::front_end::VgaFrontEnd as FrontEnd;
use crate::vision::front_end::calibration::SkinSample;
use crate::vision::front_end::pixel_format::{PixelFormat, Rgb565, SwappedRgb565, Yuyv};
use crate::vision::front_end::skin_table::{SkinTable, TABLE_WORDS};
use crate::vision::hand_likelihood::HandLikelihood;
use crate::vision::skin::GaussianSkin;
use core::ffi::c_void;
use core::mem::offset_of;
use core::ops::Range;

/// Bytes that always suffice for a front end, on every target.
#[cfg(not(feature = "vga"))]
pub const SINEW_VISION_MAX_BYTES: usize = 20480;
/// Bytes that always suffice for a front end, on every target, in a library with the feature `vga`.
#[cfg(feature = "vga")]
pub const SINEW_VISION_MAX_BYTES: usize = 28672;
/// Bytes that always suffice for the saved state of a front end.
pub const SINEW_VISION_STATE_MAX_BYTES: usize = 8320;

const _: () = assert!(size_of::<SinewVision>() <= SINEW_VISION_MAX_BYTES && align_of::<SinewVision>() <= SINEW_ALIGN);
const _: () = assert!(offset_of!(SinewVision, 0) == 0);

/// A front end; see `sinew_vision_init`. Saved states hold the skin table, no frames, and fit the
/// same pixel format.
#[derive(Debug)]
pub struct SinewVision(Object<Vision>);

/// What a front end holds.
#[derive(Debug)]
pub(super) struct Vision {
    config: SinewVisionConfig,
    /// The last model that the caller gave.
    trained: GaussianSkin,
    is_in_frame: bool,
    learning: Slot<Learning>,
    skin: Skin,
    front_end: FrontEnd,
}

/// A model that the table learns frame by frame.
#[derive(Debug, Clone, Copy)]
struct Learning {
    model: GaussianSkin,
    /// The word of the table to go on with.
    next: usize,
}

/// Skin of one of the formats, whose number is the first word.
#[derive(Debug)]
#[repr(u32)]
#[expect(dead_code, reason = "made in place, from zeros and its number")]
pub(super) enum Skin {
    Rgb565(SkinOf<Rgb565>) = SINEW_PIXEL_RGB565,
    Swapped(SkinOf<SwappedRgb565>) = SINEW_PIXEL_RGB565_SWAPPED,
    Yuyv(SkinOf<Yuyv>) = SINEW_PIXEL_YUYV,
}

/// Words of the skin table that are learned: all, and under Miri, which would take a minute for
/// them, those of some bright reds.
const LEARNED_WORDS: Range<usize> = if cfg!(miri) { 1632..1640 } else { 0..TABLE_WORDS };

/// Pixels of a box that are looked at to calibrate.
const SAMPLE_PIXELS: usize = 256;

/// The table, and what was seen of the box that is to adapt it.
#[derive(Debug)]
pub(super) struct SkinOf<F> {
    table: SkinTable<F>,
    sample: Slot<SkinSample<F, SAMPLE_PIXELS>>,
}

impl<F: PixelFormat> SkinOf<F> {
    fn line(&mut self, row: usize, line: &[u16], front_end: &mut FrontEnd) {
        if let Some(sample) = self.sample.get_mut() {
            sample.line(row, line);
        }
        front_end.line(row, line, &self.table);
    }

    /// `trained` adapted to the sample.
    fn adapt(&mut self, trained: &GaussianSkin) -> Result<GaussianSkin, SinewStatus> {
        let sample = self.sample.get().filter(|sample| !sample.is_empty()).ok_or(SinewStatus::NoSample)?;
        let adapted = sample.adapted(trained)?;
        self.sample = Slot::Empty;
        Ok(adapted)
    }

    /// Learns until `max_colours` were judged. Returns the word to go on with.
    fn learn(&mut self, learning: &Learning, max_colours: usize) -> usize {
        self.table.learn_some(&learning.model, learning.next..LEARNED_WORDS.end, max_colours)
    }
}

/// Does the same with the skin of each format.
macro_rules! of_any_format {
    ($skin:expr, $of:ident => $work:expr) => {
        match $skin {
            Skin::Rgb565($of) => $work,
            Skin::Swapped($of) => $work,
            Skin::Yuyv($of) => $work,
        }
    };
}

impl Skin {
    fn learn(&mut self, learning: &Learning, max_colours: usize) -> usize {
        of_any_format!(self, of => of.learn(learning, max_colours))
    }
}

// SAFETY: that is its only field.
unsafe impl Handle for SinewVision {
    type Content = Vision;
    const KIND: [u8; 4] = *b"SNvi";
}

size_functions!(SinewVision, sinew_vision_size, sinew_vision_align);

/// Makes a front end in `memory`, which it needs as long as it is used; there is nothing to free.
/// `config` is copied.
///
/// Fills the skin table, one decision for each of 65536 colours, which takes some time. `vision` is
/// written only if the status is SINEW_STATUS_OK. Returns SINEW_STATUS_OVER_CAPACITY for frames
/// larger than 320 x 240, or 640 x 480 in a library with the feature `vga`.
///
/// # Safety
/// `memory` has the size that is said.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_vision_init(
    memory: *mut c_void,
    memory_bytes: usize,
    config: *const SinewVisionConfig,
    vision: *mut *mut SinewVision,
) -> SinewStatus {
    // SAFETY: the caller's duty.
    status(unsafe {
        (|| {
            let (handle, config) = (room(vision)?, *given_config(config)?);
            let mut place = place::<SinewVision>(memory, memory_bytes)?;
            place.is_apart(vision, 1)?;
            let trained = config.skin.model()?;
            if config.pixel_format > SINEW_PIXEL_YUYV {
                return Err(SinewStatus::OutOfRange);
            }
            FrontEnd::check_size(config.size())?;
            config.steps()?;
            config.min_area_share()?;
            // Zeros are a front end that did not begin, an empty table and no sample.
            let vision = place.clear();
            (&raw mut (*vision).config).write(config);
            (&raw mut (*vision).trained).write(trained);
            (&raw mut (*vision).skin).cast::<u32>().write(config.pixel_format);
            place.install(handle, Stateful::begin)
        })()
    })
}

/// Takes over another skin model, from the next line on, or over some frames where the
/// configuration has `skin_colours_per_frame`.
///
/// # Safety
/// `vision` comes from `sinew_vision_init`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_vision_learn_skin(vision: *mut SinewVision, skin: *const SinewSkin) -> SinewStatus {
    // SAFETY: the caller's duty.
    status(unsafe {
        (|| {
            let mut vision = object(vision)?;
            vision.is_apart(skin, 1)?;
            let trained = given(skin)?.model()?;
            vision.trained = trained;
            vision.take_over(&trained);
            Ok(())
        })()
    })
}

/// Begins to calibrate: from the next line on, until `sinew_vision_end_calibration`, the pixels
/// inside of `box_px` are looked at, 256 of them, evenly. It has to show nothing but skin, a hand
/// held into it; the lines of one frame suffice.
///
/// A calibration that was begun before is given up. Returns SINEW_STATUS_OUT_OF_RANGE for a box
/// that is empty or reaches beyond the frame.
///
/// # Safety
/// `vision` comes from `sinew_vision_init`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_vision_begin_calibration(
    vision: *mut SinewVision,
    box_px: *const SinewBox,
) -> SinewStatus {
    // SAFETY: the caller's duty.
    status(unsafe {
        (|| {
            let mut vision = object(vision)?;
            vision.is_apart(box_px, 1)?;
            let box_px = given(box_px)?;
            let bounds = box_px.inside(vision.config.width_px, vision.config.height_px)?;
            of_any_format!(&mut vision.skin, of => of.sample = Slot::Full(SkinSample::new(bounds)));
            Ok(())
        })()
    })
}

/// Ends a calibration: adapts the skin of the configuration, or the last one of
/// `sinew_vision_learn_skin`, to what the box showed, takes it over as that function does, and
/// writes it into `skin`, which may be null.
///
/// Returns SINEW_STATUS_NO_SAMPLE where no calibration was begun or no line of the box came since,
/// SINEW_STATUS_OUT_OF_RANGE where all of its pixels were black; the skin is as before then.
///
/// # Safety
/// `vision` comes from `sinew_vision_init`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_vision_end_calibration(vision: *mut SinewVision, skin: *mut SinewSkin) -> SinewStatus {
    // SAFETY: the caller's duty.
    status(unsafe {
        (|| {
            let mut vision = object(vision)?;
            vision.is_apart(skin, 1)?;
            let answer = if skin.is_null() { None } else { Some(room(skin)?) };
            let trained = vision.trained;
            let adapted = of_any_format!(&mut vision.skin, of => of.adapt(&trained))?;
            vision.take_over(&adapted);
            if let Some(answer) = answer {
                answer.write(SinewSkin::of(&adapted));
            }
            Ok(())
        })()
    })
}

/// Begins a frame; what was read of one that did not end is dropped.
///
/// # Safety
/// `vision` comes from `sinew_vision_init`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_vision_begin_frame(vision: *mut SinewVision) -> SinewStatus {
    // SAFETY: the caller's duty.
    status(unsafe { object(vision) }.map(|mut vision| {
        let max_colours = vision.config.skin_colours_per_frame as usize;
        vision.learn_some(max_colours);
        vision.front_end.begin_frame();
        vision.is_in_frame = true;
    }))
}

/// Reads a line of the frame: `row` from 0 at the top, `pixel_count` pixels of 16 bits from the
/// left.
///
/// Lines come in order. A line that is left out or too short counts as without skin where pixels
/// are missing, one that comes twice or too late is ignored; the frame's result says how many.
/// Returns SINEW_STATUS_NO_FRAME before `sinew_vision_begin_frame`, and SINEW_STATUS_OUT_OF_RANGE
/// for a row or pixels beyond the frame, which change nothing.
///
/// # Safety
/// `vision` comes from `sinew_vision_init`, `pixels` points at as many as is said.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_vision_line(
    vision: *mut SinewVision,
    row: u32,
    pixels: *const u16,
    pixel_count: usize,
) -> SinewStatus {
    // SAFETY: the caller's duty.
    status(unsafe {
        (|| {
            let mut vision = object(vision)?;
            vision.is_apart(pixels, pixel_count)?;
            vision.line(row, list(pixels, pixel_count)?)
        })()
    })
}

/// Ends the frame, and writes what it showed. The lists of the result lie in the front end's memory
/// and are good until the next frame begins.
///
/// Returns SINEW_STATUS_NO_FRAME before `sinew_vision_begin_frame`.
///
/// # Safety
/// `vision` comes from `sinew_vision_init`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_vision_end_frame(
    vision: *mut SinewVision,
    result: *mut SinewVisionResult,
) -> SinewStatus {
    // SAFETY: the caller's duty.
    status(unsafe {
        (|| {
            let mut vision = object(vision)?;
            vision.is_apart(result, 1)?;
            let result = room(result)?;
            if !vision.is_in_frame {
                return Err(SinewStatus::NoFrame);
            }
            vision.is_in_frame = false;
            result.write(SinewVisionResult::of(&vision.front_end.end_frame()));
            Ok(())
        })()
    })
}

state_functions!(SinewVision, vision, sinew_vision_reset, sinew_vision_save, sinew_vision_restore);

impl Stateful for Vision {
    type Memory = Skin;
    const KIND: StateKind = StateKind::Vision;

    fn fingerprint(&self) -> u32 {
        self.config.pixel_format
    }

    fn memory(&mut self) -> &mut Skin {
        &mut self.skin
    }

    fn reset(&mut self) -> Answer {
        self.forget_frames();
        Ok(())
    }

    fn begin(&mut self) -> Answer {
        self.front_end.begin(self.config.size(), HandLikelihood::default(), self.config.steps()?)?;
        self.front_end.set_min_area_fraction(self.config.min_area_share()?);
        self.is_in_frame = false;
        self.take_over(&self.config.skin.model()?);
        self.learn_some(usize::MAX);
        Ok(())
    }

    fn before_save(&mut self) {
        self.learn_some(usize::MAX);
    }

    fn after_restore(&mut self) {
        self.learning = Slot::Empty;
        self.forget_frames();
    }
}

impl Vision {
    /// Learns `model`: at once, or frame by frame from now on.
    fn take_over(&mut self, model: &GaussianSkin) {
        self.learning = Slot::Full(Learning { model: *model, next: LEARNED_WORDS.start });
        if self.config.skin_colours_per_frame == 0 {
            self.learn_some(usize::MAX);
        }
    }

    /// Goes on with what is learned, until so many colours were judged.
    fn learn_some(&mut self, max_colours: usize) {
        let Slot::Full(learning) = &mut self.learning else { return };
        learning.next = self.skin.learn(learning, max_colours);
        if learning.next >= LEARNED_WORDS.end {
            self.learning = Slot::Empty;
        }
    }

    fn line(&mut self, row: u32, line: &[u16]) -> Answer {
        if !self.is_in_frame {
            return Err(SinewStatus::NoFrame);
        }
        if row >= self.config.height_px || line.len() > self.config.width_px as usize {
            return Err(SinewStatus::OutOfRange);
        }
        of_any_format!(&mut self.skin, of => of.line(row as usize, line, &mut self.front_end));
        Ok(())
    }

    fn forget_frames(&mut self) {
        self.front_end.begin_frame();
        self.front_end.forget_last_frame();
        self.is_in_frame = false;
    }
}

impl SavedState for Skin {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        let words = of_any_format!(self, of => of.table.words_mut());
        words.iter_mut().for_each(|word| visitor.word(word));
    }
}
