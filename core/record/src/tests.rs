use super::*;
use proptest::prelude::*;
use sinew_core::cyclic::AngleMeasurement;
use sinew_core::tracker::cyclic::FirstPhase;

fn input(frame: u32, angles: [f32; 13], seen: u16, std: f32) -> CyclicInput {
    let angles_rad = core::array::from_fn(|i| Some(angles[i]).filter(|_| seen >> i & 1 == 1));
    CyclicInput { frame, angles: AngleMeasurement::new(&angles_rad, std).unwrap().after(1.5).unwrap() }
}

fn append<P: Payload>(bytes: &mut Vec<u8>, payload: &P) {
    let mut room = vec![0; HEADER_BYTES + P::MAX_BYTES];
    let length = encode(payload, &mut room).unwrap();
    bytes.extend_from_slice(&room[..length]);
}

/// A stream of `count` frames, and where each record begins.
fn stream(count: u32) -> (Vec<u8>, Vec<usize>) {
    let (mut bytes, mut starts) = (Vec::new(), Vec::new());
    for frame in 0..count {
        starts.push(bytes.len());
        append(&mut bytes, &input(frame, [0.25; 13], 0x1fff, 0.1));
    }
    starts.push(bytes.len());
    append(&mut bytes, &End { records: count });
    (bytes, starts)
}

/// Frames that a reader finds, and its errors.
fn read_all(bytes: &[u8]) -> (Vec<u32>, Vec<RecordError>) {
    let mut reader = RecordStream::<_, 256>::new(bytes);
    let (mut frames, mut errors) = (Vec::new(), Vec::new());
    while let Some(record) = reader.next_record() {
        match record.and_then(|record| record.read::<CyclicInput>()) {
            Ok(input) => frames.push(input.frame),
            Err(error) => errors.push(error),
        }
    }
    (frames, errors)
}

proptest! {
    #[test]
    fn a_record_comes_back_bit_for_bit(
        frame in any::<u32>(), angles in any::<[f32; 13]>(), seen in 0_u16..1 << 13, std in 1.0e-6_f32..10.0,
    ) {
        let written = input(frame, angles, seen, std);
        let mut bytes = Vec::new();
        append(&mut bytes, &written);
        let (record, length) = decode(&bytes).unwrap();
        prop_assert_eq!(length, bytes.len());
        prop_assert_eq!(record.read::<CyclicInput>().unwrap(), written);
        prop_assert_eq!(record.read::<End>(), Err(RecordError::OutOfOrder));
    }

    #[test]
    fn arbitrary_bytes_give_errors_and_an_end(bytes in prop::collection::vec(any::<u8>(), 0..if cfg!(miri) { 300 } else { 2000 })) {
        let (frames, errors) = read_all(&bytes);
        prop_assert!(frames.is_empty() && !errors.is_empty() && errors.len() <= 2 + bytes.len());
        prop_assert!(decode(&bytes).is_err());
    }

    #[test]
    fn a_changed_byte_costs_one_record_and_is_reported(place in 0_usize..5 * 132, change in 1_u8..) {
        let (mut bytes, starts) = stream(5);
        prop_assert_eq!(starts[1], 132);
        bytes[place] ^= change;
        let (frames, errors) = read_all(&bytes);
        let hit = (place / starts[1]) as u32;
        prop_assert_eq!(frames, (0..5).filter(|&frame| frame != hit).collect::<Vec<_>>());
        prop_assert!(!errors.is_empty() && errors.contains(&RecordError::Lost), "{:?}", errors);
    }

    #[test]
    fn what_lies_between_records_is_skipped(noise in prop::collection::vec(any::<u8>(), 1..300), at in 0_usize..5) {
        let (mut bytes, starts) = stream(5);
        let later = bytes.split_off(starts[at]);
        bytes.extend(noise);
        bytes.extend(later);
        let (frames, errors) = read_all(&bytes);
        prop_assert_eq!(frames, (0..5).collect::<Vec<_>>());
        prop_assert!(!errors.is_empty());
    }

    #[test]
    fn a_stream_that_is_cut_says_so(part in 0_usize..5 * 132 + 20) {
        let (bytes, starts) = stream(5);
        let (frames, errors) = read_all(&bytes[..part]);
        prop_assert_eq!(frames.len(), part / starts[1]);
        prop_assert!(errors.iter().all(|error| *error == RecordError::Truncated) && !errors.is_empty(), "{:?}", errors);
    }
}

#[test]
fn a_whole_stream_has_no_error() {
    // Miri takes a minute for all.
    let frames = if cfg!(miri) { 10 } else { 300 };
    assert_eq!(read_all(&stream(frames).0), ((0..frames).collect(), Vec::new()));
}

#[test]
fn versions_kinds_and_lengths_are_distinguished() {
    let (mut bytes, _) = stream(1);
    bytes[4] = VERSION as u8 + 1;
    assert_eq!(read_all(&bytes), (vec![], vec![RecordError::WrongVersion { found: VERSION + 1 }, RecordError::Lost]));
    assert_eq!(decode(&bytes).unwrap_err().code(), 3);
    let (mut bytes, _) = stream(1);
    bytes[8..12].copy_from_slice(&300_u32.to_le_bytes());
    assert_eq!(read_all(&bytes).1[0], RecordError::TooLong);
    let (whole, _) = stream(1);
    assert_eq!(decode(&whole[..131]), Err(RecordError::Truncated));
    let short = Record { kind: Kind::CyclicInput, payload: &whole[16..131] };
    assert_eq!(short.read::<CyclicInput>(), Err(RecordError::WrongLength));
    let long = Record { kind: Kind::End, payload: &[0; 5] };
    assert_eq!(long.read::<End>(), Err(RecordError::WrongLength));
}

#[test]
fn a_sound_record_of_an_unknown_kind_is_left_out() {
    let (bytes, starts) = stream(2);
    let mut foreign = bytes[..starts[1]].to_vec();
    foreign[6..8].copy_from_slice(&9_u16.to_le_bytes());
    let checksum = sinew_core::checksum::crc32(&[&foreign[..12], &foreign[16..]].concat());
    foreign[12..16].copy_from_slice(&checksum.to_le_bytes());
    let mut all = bytes[..starts[1]].to_vec();
    all.extend(foreign);
    append(&mut all, &End { records: 2 });
    assert_eq!(read_all(&all), (vec![0], vec![RecordError::UnknownKind { found: 9 }]));
}

#[test]
fn fields_with_values_that_they_cannot_have_are_named() {
    let mut bytes = Vec::new();
    append(&mut bytes, &input(0, [0.0; 13], 1, 0.1));
    let with = |at: usize, value: &[u8]| {
        let mut payload = bytes[16..].to_vec();
        payload[at..at + value.len()].copy_from_slice(value);
        Record { kind: Kind::CyclicInput, payload: &payload }.read::<CyclicInput>().unwrap_err()
    };
    assert_eq!(with(4, &f32::NAN.to_le_bytes()), RecordError::Value { field: "step_frames" });
    assert_eq!(with(8, &[0xff; 4]), RecordError::Value { field: "seen" });
    assert_eq!(with(12 + 52, &(-1.0_f32).to_le_bytes()), RecordError::Value { field: "std_rad" });
    let setup = CyclicSetup { model_checksum: 7, first: FirstPhase { position: Some(0.5), velocity_per_frame: None } };
    let mut bytes = Vec::new();
    append(&mut bytes, &setup);
    assert_eq!(decode(&bytes).unwrap().0.read::<CyclicSetup>().unwrap(), setup);
    let record = Record { kind: Kind::CyclicSetup, payload: &[2; 14] };
    assert_eq!(record.read::<CyclicSetup>(), Err(RecordError::Value { field: "position" }));
}

#[test]
fn a_nan_measurement_counts_as_missing_and_every_nan_is_written_alike() {
    let mut bytes = Vec::new();
    append(&mut bytes, &input(0, [1.0; 13], 0x1fff, 0.1));
    let mut payload = bytes[16..].to_vec();
    payload[12..16].copy_from_slice(&(-f32::NAN).to_le_bytes());
    let found = Record { kind: Kind::CyclicInput, payload: &payload }.read::<CyclicInput>().unwrap();
    assert_eq!(found.angles.angle_rad(0), None);
    assert_eq!(found.angles.present(13), 12);
    let mut room = [0; 8];
    let mut fields = FieldWriter::new(&mut room);
    fields.f32s(&[f32::NAN, -f32::NAN]);
    assert_eq!(fields.finish(), Some(8));
    assert_eq!(room[..4], room[4..]);
}

#[test]
fn results_and_costs_come_back() {
    let mut cost = Cost { part: 3, ..Cost::default() };
    for amount in [5, 9, 7] {
        cost.add(amount);
    }
    let mut bytes = Vec::new();
    append(&mut bytes, &cost);
    assert_eq!(decode(&bytes).unwrap().0.read::<Cost>().unwrap(), Cost { part: 3, frames: 3, total: 21, worst: 9 });
    let result = CyclicResult {
        frame: 4,
        estimate: sinew_core::cyclic::CyclicEstimate {
            angles_rad: [0.5; 13],
            turns: [-3; 13],
            angle_variance_rad2: [0.1; 13],
            cycle_position: 0.25,
            cycle_position_variance: 0.01,
            cycle_velocity_per_frame: 0.02,
            cycle_velocity_variance: 0.03,
            log_likelihood: -7.0,
            outlier: true,
            misfit: false,
        },
        cycles_completed: -2,
        cadence_per_min: [50.0, 1.0],
    };
    let mut bytes = Vec::new();
    append(&mut bytes, &result);
    assert_eq!(bytes.len(), HEADER_BYTES + CyclicResult::MAX_BYTES);
    assert_eq!(decode(&bytes).unwrap().0.read::<CyclicResult>().unwrap(), result);
    assert!(encode(&result, &mut [0; 100]).is_err());
}
