//! The front end.

use super::saved::{Damage, damage};
use super::{Memory, cases, is_refusal, mostly};
use proptest::prelude::*;
use sinew_core::c_api::status::SinewStatus;
use sinew_core::c_api::vision::*;
use sinew_core::c_api::vision_frame::*;
use std::mem::MaybeUninit;
use std::ptr::null_mut;

#[derive(Debug, Clone)]
enum Call {
    Begin,
    Line { row: u32, len: usize, stripes: u16, colours: [u16; 2] },
    Frame { stripes: u16, colours: [u16; 2] },
    End,
    Learn { mean: [f32; 2], covariance: [f32; 3], threshold: f32, min_sum: u32 },
    Calibrate(SinewBox),
    EndCalibration,
    Restore(Damage),
    Reset,
}

fn call() -> impl Strategy<Value = Call> {
    let colours = prop_oneof![Just([0xcc6c_u16, 0x39c7]), any::<[u16; 2]>()];
    let row = prop_oneof![8 => 0_u32..240, 1 => any::<u32>()];
    let len = prop_oneof![8 => 0_usize..=320, 1 => 0_usize..400];
    let mean = [mostly(0.2..0.6), mostly(0.2..0.4)];
    let covariance = [mostly(0.0005..0.01), mostly(-0.0001..0.0001), mostly(0.0001..0.001)];
    prop_oneof![
        2 => Just(Call::Begin),
        4 => (row, len, any::<u16>(), colours.clone())
            .prop_map(|(row, len, stripes, colours)| Call::Line { row, len, stripes, colours }),
        3 => (any::<u16>(), colours).prop_map(|(stripes, colours)| Call::Frame { stripes, colours }),
        2 => Just(Call::End),
        1 => (mean, covariance, mostly(1.0..4.0), 0_u32..1000).prop_map(|(mean, covariance, threshold, min_sum)| {
            Call::Learn { mean, covariance, threshold, min_sum }
        }),
        1 => prop::array::uniform4(prop_oneof![8 => 0_u32..160, 1 => any::<u32>()]).prop_map(|[left_px, top_px, width_px, height_px]| {
            Call::Calibrate(SinewBox { left_px, top_px, width_px, height_px })
        }),
        1 => Just(Call::EndCalibration),
        1 => damage().prop_map(Call::Restore),
        1 => Just(Call::Reset),
    ]
}

struct Camera {
    handle: *mut SinewVision,
    _memory: Memory,
}

fn config(width_px: u32, height_px: u32, pixel_format: u32) -> SinewVisionConfig {
    let mut config = MaybeUninit::uninit();
    // SAFETY: there is room for one, and it is written.
    let config = unsafe {
        assert_eq!(sinew_vision_default_config(config.as_mut_ptr(), size_of::<SinewVisionConfig>()), SinewStatus::Ok);
        config.assume_init()
    };
    SinewVisionConfig { width_px, height_px, pixel_format, ..config }
}

fn init(config: &SinewVisionConfig) -> (SinewStatus, Camera) {
    let mut memory = Memory::new(SINEW_VISION_MAX_BYTES);
    let mut handle = null_mut();
    // SAFETY: the memory is as large as is said.
    let status = unsafe { sinew_vision_init(memory.start(), SINEW_VISION_MAX_BYTES, config, &raw mut handle) };
    (status, Camera { handle, _memory: memory })
}

/// Stripes of two colours whose widths follow from the bits of `stripes` and from the row.
fn line(row: u32, len: usize, stripes: u16, colours: [u16; 2]) -> Vec<u16> {
    (0..len)
        .map(|u| {
            let bit = stripes.rotate_left(row / 7) >> (u / 3 % 16) & 1;
            colours[usize::from(bit)]
        })
        .collect()
}

impl Camera {
    fn saved(&self) -> Vec<u8> {
        let (mut bytes, mut written) = (vec![0; SINEW_VISION_STATE_MAX_BYTES], 0);
        // SAFETY: the buffer is as large as is said.
        let status = unsafe { sinew_vision_save(self.handle, bytes.as_mut_ptr(), bytes.len(), &raw mut written) };
        assert_eq!(status, SinewStatus::Ok);
        bytes.truncate(written);
        bytes
    }

    fn read(&self, row: u32, pixels: &[u16]) -> SinewStatus {
        // SAFETY: the pixels are there.
        unsafe { sinew_vision_line(self.handle, row, pixels.as_ptr(), pixels.len()) }
    }

    fn end(&self) -> SinewStatus {
        let mut result = MaybeUninit::<SinewVisionResult>::uninit();
        // SAFETY: there is room for a result, and it is looked at only if it was written.
        unsafe {
            let status = sinew_vision_end_frame(self.handle, result.as_mut_ptr());
            if status == SinewStatus::Ok {
                let result = result.assume_init();
                for index in 0..result.candidate_count as usize {
                    let candidate = &*result.candidates.add(index);
                    assert!((0.0..=1.0).contains(&candidate.likelihood) && candidate.area_px > 0.0, "{candidate:?}");
                    assert!(candidate.centre.u_px.is_finite() && candidate.centre.v_px.is_finite(), "{candidate:?}");
                }
                for index in 0..result.edge_count as usize {
                    let edge = &*result.edges.add(index);
                    assert!(edge.u < 320 && edge.v < 240, "{edge:?}");
                }
            }
            status
        }
    }

    fn call(&self, call: &Call) {
        // SAFETY: the front end was initialised.
        let status = unsafe {
            match call {
                Call::Begin => sinew_vision_begin_frame(self.handle),
                Call::Line { row, len, stripes, colours } => {
                    self.read(*row, &line(*row % 240, *len, *stripes, *colours))
                }
                Call::Frame { stripes, colours } => {
                    assert_eq!(sinew_vision_begin_frame(self.handle), SinewStatus::Ok);
                    for row in 0..24 {
                        self.read(10 * row, &line(row, 160, *stripes, *colours));
                    }
                    self.end()
                }
                Call::End => self.end(),
                Call::Learn { mean, covariance, threshold, min_sum } => {
                    let skin =
                        SinewSkin { mean: *mean, covariance: *covariance, threshold: *threshold, min_sum: *min_sum };
                    sinew_vision_learn_skin(self.handle, &raw const skin)
                }
                Call::Calibrate(box_px) => sinew_vision_begin_calibration(self.handle, &raw const *box_px),
                Call::EndCalibration => sinew_vision_end_calibration(self.handle, null_mut()),
                Call::Restore(damage) => {
                    let before = self.saved();
                    let bytes = damage.applied(&before);
                    let status = sinew_vision_restore(self.handle, bytes.as_ptr(), bytes.len());
                    assert!(damage.allows(status), "{damage:?}: {status:?}");
                    assert!(matches!(damage, Damage::Forged { .. }) || self.saved() == before, "{damage:?}");
                    SinewStatus::Ok
                }
                Call::Reset => sinew_vision_reset(self.handle),
            }
        };
        assert!(status == SinewStatus::Ok || is_refusal(status), "{call:?}: {status:?}");
    }
}

proptest! {
    #![proptest_config(cases(24))]

    #[test]
    fn any_calls_leave_a_front_end_that_can_be_used(
        calls in prop::collection::vec(call(), 1..30), format in 0_u32..3, width in 1_u32..=320, height in 1_u32..=240,
        skin_colours_per_frame in prop_oneof![Just(0_u32), 1_u32..30_000],
    ) {
        let (status, camera) = init(&SinewVisionConfig { skin_colours_per_frame, ..config(width, height, format) });
        prop_assert_eq!(status, SinewStatus::Ok);
        for call in &calls {
            camera.call(call);
        }
        camera.call(&Call::Reset);
        prop_assert_eq!(camera.end(), SinewStatus::NoFrame);
        prop_assert_eq!(camera.read(0, &[0]), SinewStatus::NoFrame);
        camera.call(&Call::Begin);
        prop_assert_eq!(camera.read(0, &[0]), SinewStatus::Ok);
        prop_assert_eq!(camera.end(), SinewStatus::Ok);
    }
}

/// A hand of bluish skin, which the configured skin does not hold, before a green wall.
fn hand_line(row: u32) -> Vec<u16> {
    (0..320_u32)
        .map(|u| {
            let is_hand = (100..150).contains(&u) && (60..120).contains(&row);
            if is_hand { (15 + u as u16 % 2) << 11 | 26 << 5 | (17 + row as u16 % 2) } else { 5 << 11 | 40 << 5 | 6 }
        })
        .collect()
}

impl Camera {
    /// Candidates of a frame with that hand, each pixel coded by `code`.
    fn hands(&self, code: fn(u16) -> u16) -> u32 {
        self.call(&Call::Begin);
        for row in 0..240 {
            let line: Vec<u16> = hand_line(row).into_iter().map(code).collect();
            assert_eq!(self.read(row, &line), SinewStatus::Ok);
        }
        let mut result = MaybeUninit::<SinewVisionResult>::uninit();
        // SAFETY: there is room for a result, which is written where a frame was begun.
        unsafe {
            assert_eq!(sinew_vision_end_frame(self.handle, result.as_mut_ptr()), SinewStatus::Ok);
            result.assume_init().candidate_count
        }
    }

    fn calibrate(&self, box_px: SinewBox) -> SinewStatus {
        // SAFETY: the front end was initialised, the box is there.
        unsafe { sinew_vision_begin_calibration(self.handle, &raw const box_px) }
    }

    fn end_calibration(&self) -> Result<SinewSkin, SinewStatus> {
        let mut skin = MaybeUninit::uninit();
        // SAFETY: the front end was initialised; the skin is looked at only if it was written.
        unsafe {
            let status = sinew_vision_end_calibration(self.handle, skin.as_mut_ptr());
            if status == SinewStatus::Ok { Ok(skin.assume_init()) } else { Err(status) }
        }
    }
}

#[test]
fn a_box_of_skin_teaches_the_front_end_a_person_s_colour() {
    let inside = SinewBox { left_px: 105, top_px: 65, width_px: 40, height_px: 50 };
    for (format, code) in
        [(SINEW_PIXEL_RGB565, (|p| p) as fn(u16) -> u16), (SINEW_PIXEL_RGB565_SWAPPED, u16::swap_bytes)]
    {
        let (_, camera) = init(&config(320, 240, format));
        assert_eq!(camera.hands(code), 0);
        assert_eq!(camera.calibrate(inside), SinewStatus::Ok);
        assert_eq!(camera.hands(code), 0, "nothing is learned yet");
        let learned = camera.end_calibration().unwrap();
        assert_eq!(camera.hands(code), 1);
        let before = camera.saved();
        // SAFETY: the front end was initialised, the skin is there.
        assert_eq!(unsafe { sinew_vision_learn_skin(camera.handle, &raw const learned) }, SinewStatus::Ok);
        assert!(camera.saved() == before, "the skin that is written is the one that was learned");
    }
}

#[test]
fn calibrations_that_cannot_be_are_refused() {
    let (_, camera) = init(&config(320, 240, 0));
    let before = camera.saved();
    let whole = SinewBox { left_px: 0, top_px: 0, width_px: 320, height_px: 240 };
    for wrong in [
        SinewBox { width_px: 0, ..whole },
        SinewBox { height_px: 0, ..whole },
        SinewBox { left_px: 1, ..whole },
        SinewBox { top_px: 1, ..whole },
        SinewBox { left_px: u32::MAX, width_px: 2, ..whole },
    ] {
        assert_eq!(camera.calibrate(wrong), SinewStatus::OutOfRange, "{wrong:?}");
    }
    assert_eq!(camera.end_calibration(), Err(SinewStatus::NoSample), "none was begun");
    assert_eq!(camera.calibrate(whole), SinewStatus::Ok);
    assert_eq!(camera.end_calibration(), Err(SinewStatus::NoSample), "no line came");
    camera.call(&Call::Begin);
    assert_eq!(camera.read(0, &[0; 320]), SinewStatus::Ok);
    assert_eq!(camera.end_calibration(), Err(SinewStatus::OutOfRange), "black has no colour");
    assert!(camera.saved() == before);
}

#[test]
fn configurations_are_checked() {
    assert_eq!(init(&config(321, 240, 0)).0, SinewStatus::OverCapacity);
    assert_eq!(init(&config(320, 241, 0)).0, SinewStatus::OverCapacity);
    assert_eq!(init(&config(0, 240, 0)).0, SinewStatus::OutOfRange);
    assert_eq!(init(&config(320, 240, 3)).0, SinewStatus::OutOfRange);
    let mut nan = config(320, 240, 0);
    nan.skin.mean[0] = f32::NAN;
    assert_eq!(init(&nan).0, SinewStatus::NotFinite);
    assert_eq!(init(&config(320, 240, 2)).0, SinewStatus::Ok);
}
