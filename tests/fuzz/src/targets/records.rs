//! Streams of records, and every kind of record.

use crate::Target;
use sinew_core::checksum::crc32;
use sinew_core::cyclic::AngleMeasurement;
use sinew_core::tracker::arm::example::hand_blob;
use sinew_core::tracker::cyclic::FirstPhase;
use sinew_record::{
    ArmInput, ArmResult, ArmSetup, BodyResult, CameraFace, CameraLine, CameraSetup, CandidateChunk, Cost, CyclicInput,
    CyclicResult, CyclicSetup, EdgeChunk, End, Failure, HEADER_BYTES, Kind, Payload, Record, RecordStream,
    VisionResult, decode, encode,
};

/// A stream, and the content of one record.
pub const TARGETS: &[Target] = &[
    Target { name: "record_stream", run: stream, seeds: streams },
    Target { name: "record", run: record, seeds: contents },
];

/// Largest record that the stream takes, bytes.
const ROOM: usize = 1024;

fn encoded<P: Payload>(payload: &P) -> Vec<u8> {
    let mut bytes = vec![0; HEADER_BYTES + P::MAX_BYTES];
    let length = encode(payload, &mut bytes).expect("there is room");
    bytes.truncate(length);
    bytes
}

fn all() -> Vec<Vec<u8>> {
    let angles = AngleMeasurement::new(&[Some(0.25); 13], 0.1).expect("it is legal");
    let first = FirstPhase { position: Some(0.5), velocity_per_frame: None };
    let candidates = [hand_blob(), hand_blob()].into_iter().collect();
    vec![
        encoded(&CyclicSetup { model_checksum: 7, first }),
        encoded(&CyclicInput { frame: 3, angles }),
        encoded(&CandidateChunk(candidates)),
        encoded(&Failure { frame: 3, code: 1 }),
        encoded(&Cost { part: 1, frames: 120, total: 4_000_000, worst: 70_000 }),
    ]
}

fn streams() -> Vec<Vec<u8>> {
    let end = |records| encoded(&End { records });
    let mut whole = all().concat();
    whole.extend(end(5));
    vec![whole, [all()[1].clone(), end(1)].concat()]
}

/// A number of a kind, and the payload.
fn contents() -> Vec<Vec<u8>> {
    let mut contents: Vec<Vec<u8>> = all()
        .iter()
        .map(|bytes| {
            let kind = u16::from_le_bytes([bytes[6], bytes[7]]);
            let index = Kind::ALL.iter().position(|known| *known as u16 == kind).unwrap_or_default();
            [&[index as u8], &bytes[HEADER_BYTES..]].concat()
        })
        .collect();
    // Kinds without an example: zeros of their length.
    for (kind, length) in [
        (Kind::ArmSetup, ArmSetup::MAX_BYTES),
        (Kind::ArmInput, ArmInput::MAX_BYTES),
        (Kind::CameraSetup, CameraSetup::MAX_BYTES),
        (Kind::ArmResult, ArmResult::MAX_BYTES),
        (Kind::BodyResult, BodyResult::MAX_BYTES),
    ] {
        let index = Kind::ALL.iter().position(|known| *known == kind).unwrap_or_default();
        contents.push([vec![index as u8], vec![0; length]].concat());
    }
    contents
}

/// Reads the record as its kind; what was read can be written and read again to the same.
fn read(record: &Record<'_>) {
    match record.kind {
        Kind::End => again::<End>(record),
        Kind::CyclicSetup => again::<CyclicSetup>(record),
        Kind::CyclicInput => again::<CyclicInput>(record),
        Kind::ArmSetup => {
            again::<ArmSetup>(record);
            let _ = record.read::<ArmSetup>().map(|setup| setup.model());
        }
        Kind::CandidateChunk => again::<CandidateChunk>(record),
        Kind::EdgeChunk => again::<EdgeChunk>(record),
        Kind::ArmInput => again::<ArmInput>(record),
        Kind::CameraSetup => {
            again::<CameraSetup>(record);
            let _ = record.read::<CameraSetup>().map(|setup| setup.skin());
        }
        Kind::CameraLine => again::<CameraLine>(record),
        Kind::CameraFace => again::<CameraFace>(record),
        Kind::CyclicResult => again::<CyclicResult>(record),
        Kind::ArmResult => again::<ArmResult>(record),
        Kind::VisionResult => again::<VisionResult>(record),
        Kind::BodyResult => again::<BodyResult>(record),
        Kind::Failure => again::<Failure>(record),
        Kind::Cost => again::<Cost>(record),
        _ => panic!("{:?} is read by nothing here", record.kind),
    }
}

fn again<P: Payload>(record: &Record<'_>) {
    let Ok(payload) = record.read::<P>() else { return };
    let written = encoded(&payload);
    let (found, _) = decode(&written).expect("it was written");
    let twice = found.read::<P>().expect("it was read from less");
    assert_eq!(encoded(&twice), written, "as it was written");
}

fn record(bytes: &[u8]) {
    let Some((index, payload)) = bytes.split_first() else { return };
    read(&Record { kind: Kind::ALL[usize::from(*index) % Kind::ALL.len()], payload });
}

/// As it is, and with sound checksums.
fn stream(bytes: &[u8]) {
    let mut sound = bytes.to_vec();
    let mut at = 0;
    while let Some(header) = sound.get(at..at + HEADER_BYTES) {
        let length = u32::from_le_bytes([header[8], header[9], header[10], header[11]]) as usize;
        let Some(payload) = sound.get(at + HEADER_BYTES..at + HEADER_BYTES + length) else { break };
        let sum = crc32(&[&header[..12], payload].concat());
        sound[at + 12..at + 16].copy_from_slice(&sum.to_le_bytes());
        at += HEADER_BYTES + length;
    }
    for bytes in [bytes, &sound] {
        let mut stream = RecordStream::<_, ROOM>::new(bytes);
        let mut answers = 0;
        while let Some(answer) = stream.next_record() {
            answers += 1;
            assert!(answers <= 2 + bytes.len(), "the stream does not end");
            if let Ok(record) = answer {
                read(&record);
            }
        }
    }
}
