//! The image `cyclic` answers what the host's tracker answers, bit for bit, and takes bad input
//! without losing its state.

use sinew::cyclic::CyclicModel;
use sinew::cyclic::tracking::{TrackingOptions, track};
use sinew::record::StreamWriter;
use sinew_core::cyclic::AngleMeasurement;
use sinew_core::cyclic::model::walking::{WALKING, WALKING_COUPLED};
use sinew_core::tracker::cyclic::FirstPhase;
use sinew_firmware_run::host_port::HostPort;
use sinew_firmware_run::{expected, inputs};
use sinew_firmware_sim::cyclic::CyclicApp;
use sinew_firmware_sim::player::play;
use sinew_record::{CyclicInput, CyclicResult, CyclicSetup, Failure, Kind, RecordError, RecordStream, model_checksum};

/// What the image's code answers on this machine.
fn answers(input: &[u8]) -> Vec<u8> {
    let mut port = HostPort::new(input);
    play(&mut port, &mut CyclicApp::new()).unwrap();
    port.results.0
}

fn results_and_failures(answers: &[u8]) -> (Vec<CyclicResult>, Vec<(u32, u16)>) {
    let mut stream = RecordStream::<_, 512>::new(answers);
    let (mut results, mut failures) = (Vec::new(), Vec::new());
    while let Some(record) = stream.next_record() {
        let record = record.unwrap();
        match record.kind {
            Kind::CyclicResult => results.push(record.read().unwrap()),
            _ => {
                let Failure { frame, code } = record.read().unwrap();
                failures.push((frame, code));
            }
        }
    }
    (results, failures)
}

#[test]
fn the_model_in_flash_is_the_shipped_one() {
    let shipped = CyclicModel::from_option("walking").unwrap();
    let (in_flash, shipped) = (WALKING.model().unwrap(), shipped.view());
    assert_eq!(in_flash, shipped);
    let bits = |table: &[f32]| table.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
    let tables = |parts: &sinew_core::cyclic::ModelParts<'_>| {
        [parts.mean_acceleration, parts.acceleration_covariance, parts.mean_pose_rad, parts.mean_velocity].map(bits)
    };
    assert_eq!(tables(&in_flash.parts()), tables(&shipped.parts()));
    assert_eq!(model_checksum(&WALKING_COUPLED.model().unwrap()), model_checksum(&shipped));
}

#[test]
fn this_machine_answers_what_is_expected_of_the_board() {
    let input = inputs::of_image("cyclic").unwrap().unwrap();
    expected::compare_records(&answers(&input), &expected::folder().join("cyclic.rec")).unwrap();
}

#[test]
fn answers_are_those_of_the_command() {
    let model = CyclicModel::from_option("walking").unwrap();
    let table = inputs::synthetic_walk(&model).unwrap();
    let tracked = track(&table, &model, &TrackingOptions::default()).unwrap();
    let (results, failures) = results_and_failures(&answers(&inputs::of_image("cyclic").unwrap().unwrap()));
    assert_eq!(failures, []);
    assert_eq!(results.len() + 1, tracked.frames.len());
    for (result, frame) in results.iter().zip(&tracked.frames[1..]) {
        assert_eq!(u64::from(result.frame), frame.frame);
        assert_eq!(result.estimate, frame.estimate);
    }
}

fn frame(number: u32) -> CyclicInput {
    CyclicInput { frame: number, angles: AngleMeasurement::new(&[Some(0.1); 13], 0.1).unwrap() }
}

fn setup() -> CyclicSetup {
    let model_checksum = model_checksum(&WALKING_COUPLED.model().unwrap());
    CyclicSetup { model_checksum, first: FirstPhase::default() }
}

#[test]
fn bad_input_gets_codes_and_the_tracker_goes_on() {
    let mut stream = StreamWriter::default();
    stream.push(&frame(0)).unwrap();
    stream.push(&CyclicSetup { model_checksum: 1, ..setup() }).unwrap();
    let refused = FirstPhase { velocity_per_frame: Some(3.0), ..FirstPhase::default() };
    stream.push(&CyclicSetup { first: refused, ..setup() }).unwrap();
    stream.push(&frame(0)).unwrap();
    stream.push(&setup()).unwrap();
    for number in [0, 1, 1, 0, 2, 9] {
        stream.push(&frame(number)).unwrap();
    }
    let (results, failures) = results_and_failures(&answers(&stream.finish().unwrap()));
    let order = RecordError::OutOfOrder.code();
    assert_eq!(failures, [(0, order), (0, Failure::OTHER_MODEL), (0, Failure::REFUSED), (1, order), (1, order)]);
    assert_eq!(results.iter().map(|result| result.frame).collect::<Vec<_>>(), [1, 2, 9]);
}

#[test]
fn a_changed_byte_loses_one_frame() {
    let mut stream = StreamWriter::default();
    stream.push(&setup()).unwrap();
    for number in 0..6 {
        stream.push(&frame(number)).unwrap();
    }
    let mut bytes = stream.finish().unwrap();
    let size = 16 + 12 + 8 * 13;
    let start = 16 + 14;
    bytes[start + 2 * size + 40] ^= 1;
    let (results, failures) = results_and_failures(&answers(&bytes));
    assert_eq!(results.iter().map(|result| result.frame).collect::<Vec<_>>(), [1, 3, 4, 5]);
    assert_eq!(failures, [(1, RecordError::Checksum.code()), (5, RecordError::Lost.code())]);
    bytes.truncate(start + 4 * size + 40);
    let (results, failures) = results_and_failures(&answers(&bytes));
    assert_eq!(results.last().unwrap().frame, 3);
    assert_eq!(failures.last(), Some(&(3, RecordError::Truncated.code())));
}
