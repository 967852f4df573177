//! What firmware in Rust calls and no C function does, so that the link-time proof of
//! `prove-no-panic` covers it too. In no other library, and in no header.
#![allow(missing_docs, improper_ctypes_definitions, reason = "only linked, never called")]

use crate::cyclic::recognition::bank::MotionBank;
use crate::cyclic::{AngleMeasurement, MotionModel};
use crate::error::ParameterError;
use crate::skeleton::stick_figure::{HUMAN, ImagePoint};
use crate::tracker::cyclic::{CyclicFrame, CyclicFrameInput, CyclicTracker, CyclicTrackerOptions, FirstPhase};
use crate::vision::front_end::calibration::SkinSample;
use crate::vision::front_end::pixel_format::{Rgb565, Yuyv};
use crate::vision::skin::GaussianSkin;

type Tracker = CyclicTracker<13>;
type Input = CyclicFrameInput<13>;

#[unsafe(no_mangle)]
pub extern "C" fn sinew_proof_cyclic_new(
    model: &MotionModel<'_>,
    options: &CyclicTrackerOptions,
    first: &Input,
    phase: &FirstPhase,
    tracker: &mut Result<Tracker, ParameterError>,
) {
    *tracker = Tracker::new(model, *options, first, *phase);
}

#[unsafe(no_mangle)]
pub extern "C" fn sinew_proof_cyclic_step(
    tracker: &mut Tracker,
    model: &MotionModel<'_>,
    input: &Input,
    frame: &mut CyclicFrame<13>,
) {
    *frame = tracker.step(model, input);
}

#[unsafe(no_mangle)]
pub extern "C" fn sinew_proof_from_joints(
    joints_px: &[Option<ImagePoint>; 14],
    std_px: f32,
    input: &mut Result<Input, ParameterError>,
) {
    *input = Input::from_joints(&HUMAN, joints_px, std_px);
}

#[unsafe(no_mangle)]
pub extern "C" fn sinew_proof_joints(
    tracker: &Tracker,
    frame: &CyclicFrame<13>,
    joints_px: &mut [Option<ImagePoint>; 14],
) {
    tracker.joints_px(&HUMAN, &frame.estimate, joints_px);
}

#[unsafe(no_mangle)]
pub extern "C" fn sinew_proof_motion_bank(
    bank: &mut MotionBank<4, 13>,
    models: &[MotionModel<'_>; 4],
    measurement: &AngleMeasurement<13>,
    cycle_positions: &[f32; 4],
) -> usize {
    bank.add(models, measurement, cycle_positions);
    bank.likeliest().unwrap_or(bank.best())
}

#[unsafe(no_mangle)]
pub extern "C" fn sinew_proof_skin_sample(
    samples: &mut (SkinSample<Rgb565, 256>, SkinSample<Yuyv, 256>),
    v: usize,
    line: &&[u16],
) {
    samples.0.line(v, line);
    samples.1.line(v, line);
}

#[unsafe(no_mangle)]
pub extern "C" fn sinew_proof_skin_adapted(
    samples: &(SkinSample<Rgb565, 256>, SkinSample<Yuyv, 256>),
    trained: &GaussianSkin,
    adapted: &mut [Result<GaussianSkin, ParameterError>; 2],
) {
    *adapted = [samples.0.adapted(trained), samples.1.adapted(trained)];
}
