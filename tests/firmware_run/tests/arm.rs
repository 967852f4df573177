//! The images `arm` and `camera` answer what the host answers, bit for bit, and take bad input
//! without losing their state.

use sinew::record::StreamWriter;
use sinew::track::RunOutcome;
use sinew_core::camera::Pixel;
use sinew_core::math::Vec3;
use sinew_core::skeleton::Side;
use sinew_core::tracker::arm::Status;
use sinew_core::vision::candidate::HandCandidate;
use sinew_firmware_run::host_port::HostPort;
use sinew_firmware_run::{expected, inputs};
use sinew_firmware_sim::arm::{ArmApp, CANDIDATES};
use sinew_firmware_sim::camera::CameraApp;
use sinew_firmware_sim::player::{Application, play};
use sinew_record::{
    ArmInput, ArmResult, ArmSetup, CameraLine, CandidateChunk, Failure, Kind, RecordError, RecordStream, VisionResult,
};

/// What an image's code answers on this machine.
fn answers(input: &[u8], mut application: impl Application) -> Vec<u8> {
    let mut port = HostPort::new(input);
    play(&mut port, &mut application).unwrap();
    port.results.0
}

fn results_and_failures(answers: &[u8]) -> (Vec<ArmResult>, Vec<VisionResult>, Vec<u16>) {
    let mut stream = RecordStream::<_, 512>::new(answers);
    let (mut arms, mut vision, mut failures) = (Vec::new(), Vec::new(), Vec::new());
    while let Some(record) = stream.next_record() {
        let record = record.unwrap();
        match record.kind {
            Kind::ArmResult => arms.push(record.read().unwrap()),
            Kind::VisionResult => vision.push(record.read().unwrap()),
            Kind::Failure => failures.push(record.read::<Failure>().unwrap().code),
            _ => {}
        }
    }
    (arms, vision, failures)
}

#[test]
fn answers_are_those_of_the_command() {
    let folder = tempfile::tempdir().unwrap();
    let outcome = inputs::tracked_scene(folder.path()).unwrap();
    let input = inputs::of_image("arm").unwrap().unwrap();
    let bytes = answers(&input, ArmApp::new());
    expected::compare_records(&bytes, &expected::folder().join("arm.rec")).unwrap();
    let (results, _, failures) = results_and_failures(&bytes);
    assert!(failures.is_empty(), "{failures:?}");
    same(&results, &outcome);
    let tracking = results.iter().filter(|result| result.estimate.status == Status::Tracking).count();
    assert!(tracking > 30, "{tracking} of {} frames", results.len());
}

fn same(results: &[ArmResult], outcome: &RunOutcome) {
    assert_eq!(results.len(), outcome.samples.len());
    for (result, sample) in results.iter().zip(&outcome.samples) {
        let estimate = &result.estimate;
        assert_eq!((Some(estimate.joints.hand_m), estimate.status), (sample.hand_m, sample.status));
        assert_eq!(estimate.effective_sample_size.to_bits(), sample.effective_sample_size.to_bits());
    }
}

#[test]
fn from_lines_this_machine_answers_what_is_expected_of_the_board() {
    let bytes = answers(&inputs::of_image("camera").unwrap().unwrap(), CameraApp::new());
    expected::compare_records(&bytes, &expected::folder().join("camera.rec")).unwrap();
    let (arms, vision, failures) = results_and_failures(&bytes);
    assert_eq!((arms.len(), vision.len(), failures.as_slice()), (60, 59, &[][..]), "one image is broken");
    assert!(vision.iter().all(|seen| seen.losses[4..] == [0, 0]), "no line was lost");
    let folder = tempfile::tempdir().unwrap();
    same(&arms, &inputs::person_by_lines(folder.path()).unwrap());
    let tracking = arms.iter().filter(|result| result.estimate.status == Status::Tracking).count();
    assert!(tracking > 30, "{tracking} of {} frames", arms.len());
}

#[test]
fn a_frame_before_the_cameras_setup_is_out_of_order() {
    let mut stream = StreamWriter::default();
    stream.push(&setup()).unwrap();
    stream.push(&CameraLine { row: 0, pixels: [0; 320].into_iter().collect() }).unwrap();
    stream.push(&frame(0, 0)).unwrap();
    let (arms, vision, failures) = results_and_failures(&answers(&stream.finish().unwrap(), CameraApp::new()));
    assert_eq!((arms.len(), vision.len(), failures), (0, 0, vec![RecordError::OutOfOrder.code(); 2]));
}

fn setup() -> ArmSetup {
    ArmSetup {
        focal_px: [277.0; 2],
        centre: Pixel::new(159.5, 119.5),
        image_size_px: [320, 240],
        side: Side::Right,
        lengths_m: [0.3, 0.33],
        shoulder_m: Vec3::new(-0.2, 0.0, 1.3),
        particles: 50,
        product_floor: None,
        area_cue: None,
        seed: 3,
    }
}

fn frame(number: u32, candidates: u16) -> ArmInput {
    let timestamp_us = u64::from(number) * 66_667;
    ArmInput { frame: number, timestamp_us, has_image: true, shoulder_m: setup().shoulder_m, candidates, edges: 0 }
}

fn candidates(count: usize, u_px: f32) -> CandidateChunk {
    let one = HandCandidate {
        centre: Pixel::new(u_px, 150.0),
        moments_px2: [40.0, 0.0, 40.0],
        area_px: 500.0,
        likelihood: 0.9,
    };
    CandidateChunk((0..count).map(|_| one).collect())
}

#[test]
fn bad_input_gets_codes_and_the_tracker_goes_on() {
    let mut stream = StreamWriter::default();
    stream.push(&frame(0, 0)).unwrap();
    stream.push(&ArmSetup { particles: 51, ..setup() }).unwrap();
    stream.push(&ArmSetup { lengths_m: [f32::NAN, 0.3], ..setup() }).unwrap();
    stream.push(&setup()).unwrap();
    stream.push(&frame(0, 0)).unwrap();
    // Over capacity: the list is refused, and the frame that needs it.
    for _ in 0..=CANDIDATES / 8 {
        stream.push(&candidates(8, 100.0)).unwrap();
    }
    stream.push(&frame(1, 24)).unwrap();
    // Not a number: no hand, but a frame.
    stream.push(&candidates(1, f32::NAN)).unwrap();
    stream.push(&frame(2, 1)).unwrap();
    // Lost records, frames out of order, frames left out.
    stream.push(&frame(3, 1)).unwrap();
    stream.push(&frame(2, 0)).unwrap();
    stream.push(&frame(9, 0)).unwrap();
    let input = stream.finish().unwrap();
    let (results, _, failures) = results_and_failures(&answers(&input, ArmApp::new()));
    let [order, capacity, lost] =
        [RecordError::OutOfOrder, RecordError::Capacity { list: "" }, RecordError::Lost].map(RecordError::code);
    assert_eq!(failures, [order, Failure::REFUSED, Failure::REFUSED, capacity, lost, lost, order]);
    assert_eq!(results.iter().map(|result| result.frame).collect::<Vec<_>>(), [0, 2, 9]);
    assert_eq!(results[1].estimate.dropped_candidates, 1);
    let finite = |result: &ArmResult| result.estimate.joints.hand_m.iter().all(|metres| metres.is_finite());
    assert!(results.iter().all(finite));
}

#[test]
fn changed_lines_cost_lines_and_no_more() {
    let mut input = inputs::of_image("camera").unwrap().unwrap();
    let whole = results_and_failures(&answers(&input, CameraApp::new()));
    // Inside of lines of the first frames.
    for place in [40_000, 90_000, 120_000] {
        input[place] ^= 4;
    }
    let (arms, vision, failures) = results_and_failures(&answers(&input, CameraApp::new()));
    assert_eq!((arms.len(), vision.len()), (whole.0.len(), whole.1.len()));
    assert!(failures.len() >= 3 && failures.contains(&RecordError::Checksum.code()), "{failures:?}");
    let missing: u32 = vision.iter().map(|seen| seen.losses[4]).sum();
    assert_eq!(missing, 3);
    input.truncate(500_000);
    let (arms, _, failures) = results_and_failures(&answers(&input, CameraApp::new()));
    assert!(arms.len() >= 2 && failures.contains(&RecordError::Truncated.code()), "{failures:?}");
}
