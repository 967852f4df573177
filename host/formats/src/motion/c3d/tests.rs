//! Files that the tests write, whole and damaged.

use super::*;
use proptest::prelude::*;

const POINTS: usize = 3;

/// A parameter of 16-bit numbers, characters or reals with its dimensions.
fn parameter(group: i8, name: &str, kind: i8, dimensions: &[u8], data: &[u8]) -> Vec<u8> {
    let mut bytes = vec![name.len() as u8, group as u8];
    bytes.extend(name.bytes());
    let size = 2 + 2 + dimensions.len() + data.len() + 1;
    bytes.extend((size as u16).to_le_bytes());
    bytes.extend([kind as u8, dimensions.len() as u8]);
    bytes.extend(dimensions.iter().chain(data).chain(&[0]));
    bytes
}

fn group(number: i8, name: &str) -> Vec<u8> {
    let mut bytes = vec![name.len() as u8, -number as u8];
    bytes.extend(name.bytes());
    bytes.extend([3, 0, 0]);
    bytes
}

/// A file of `frames` frames that promises `promised`, with `more` parameters; marker j of frame i
/// lies at (100 i + j + 1, 2, 3) mm.
fn file(frames: u16, promised: u16, more: &[Vec<u8>]) -> Vec<u8> {
    let mut bytes = vec![0; 2 * BLOCK_BYTES];
    (bytes[0], bytes[1]) = (2, MAGIC);
    for (at, word) in [(2, POINTS as u16), (6, 1), (8, promised), (16, 3)] {
        bytes[at..at + 2].copy_from_slice(&word.to_le_bytes());
    }
    bytes[12..16].copy_from_slice(&(-1.0_f32).to_le_bytes());
    bytes[20..24].copy_from_slice(&50.0_f32.to_le_bytes());
    let mut section = vec![1, MAGIC, 1, 84];
    section.extend(group(1, "POINT"));
    section.extend(parameter(1, "USED", 2, &[], &[POINTS as u8, 0]));
    section.extend(parameter(1, "FRAMES", 2, &[], &promised.to_le_bytes()));
    section.extend(parameter(1, "UNITS", -1, &[2], b"mm"));
    section.extend(parameter(1, "LABELS", -1, &[4, 3], b"LANKRANKLHIP"));
    section.extend(more.concat());
    bytes[BLOCK_BYTES..BLOCK_BYTES + section.len()].copy_from_slice(&section);
    for frame in 0..frames {
        for point in 0..POINTS {
            let x = 100.0 * f32::from(frame) + point as f32 + 1.0;
            bytes.extend([x, 2.0, 3.0, 0.0].iter().flat_map(|value| value.to_le_bytes()));
        }
    }
    bytes.resize(bytes.len().next_multiple_of(BLOCK_BYTES), 0);
    bytes
}

/// A file of `frames` frames, more than 16 bits can count, as [`file`] but for the counts.
fn long_file(frames: usize, short: u16, more: &[Vec<u8>]) -> Vec<u8> {
    let mut bytes = file(0, short, more);
    for frame in 0..frames {
        for point in 0..POINTS {
            let x = frame as f32 + 0.25 * (point as f32 + 1.0);
            bytes.extend([x, 2.0, 3.0, 0.0].iter().flat_map(|value| value.to_le_bytes()));
        }
    }
    bytes.resize(bytes.len().next_multiple_of(BLOCK_BYTES), 0);
    bytes
}

fn read_bytes_as(bytes: &[u8], partial: bool) -> Result<MarkerMotion, String> {
    let options = ReadOptions { partial, ..ReadOptions::default() };
    parse(bytes, Path::new("m.c3d"), &options).map_err(|error| error.to_string())
}

fn refusal(bytes: &[u8]) -> String {
    let message = read_bytes_as(bytes, true).unwrap_err();
    assert!(message.starts_with("m.c3d:") && message.len() < 1000, "{message}");
    message
}

#[test]
fn what_is_no_c3d_file_is_refused() {
    assert!(refusal(b"no").contains("no C3D file"));
    let mut damaged = vec![0_u8; 2048];
    (damaged[0], damaged[1]) = (2, MAGIC);
    assert!(refusal(&damaged).contains("no known processor"));
    let folder = tempfile::tempdir().unwrap();
    assert!(read(&folder.path().join("m.c3d")).unwrap_err().is_io());
}

#[test]
fn markers_are_read_in_metres() {
    let motion = read_bytes_as(&file(40, 40, &[]), false).unwrap();
    assert_eq!((motion.positions_m.len(), motion.frames_per_second, motion.shortfall), (40, 50.0, None));
    assert_eq!(motion.names, ["LANK", "RANK", "LHIP"]);
    assert!((motion.positions_m[39][2].unwrap() - Vec3::new(3.903, 0.002, 0.003)).norm() < 1.0e-5);
}

#[test]
fn fewer_frames_than_promised_are_an_error_or_noted() {
    let whole = file(40, 40, &[]);
    let cut = &whole[..1024 + 48 * 17 + 20];
    let message = read_bytes_as(cut, false).unwrap_err();
    assert!(message.contains("17 of the 40 frames") && message.contains("--partial"), "{message}");
    let motion = read_bytes_as(cut, true).unwrap();
    assert_eq!((motion.positions_m.len(), motion.shortfall), (17, Some(Shortfall { frames: 17, promised: 40 })));
    // Of two counts that differ the lower one is what a program may go by.
    let mut header = file(40, 90, &[]);
    header[8] = 40;
    assert!(read_bytes_as(&header, true).unwrap().shortfall.is_none());
    let end = parameter(2, "ACTUAL_END_FIELD", 2, &[2], &[0, 0, 1, 0]);
    let first = parameter(2, "ACTUAL_START_FIELD", 2, &[2], &[1, 0, 0, 0]);
    let long = file(40, 40, &[group(2, "TRIAL"), first, end]);
    assert!(read_bytes_as(&long, false).unwrap_err().contains("of the 65536 frames"));
}

#[test]
fn more_frames_than_16_bits_can_count_are_read_or_refused() {
    const FRAMES: usize = 70_000;
    let real = |frames: f32| parameter(1, "LONG_FRAMES", 4, &[], &frames.to_le_bytes());
    let trial = |first: [u8; 4], last: [u8; 4]| {
        let [first, last] = [("ACTUAL_START_FIELD", first), ("ACTUAL_END_FIELD", last)]
            .map(|(name, field)| parameter(2, name, 2, &[2], &field));
        vec![group(2, "TRIAL"), first, last]
    };
    // 70,000 = 65,536 + 4464; the second trial starts and ends after two and three times 65,536.
    let by_trial = trial([1, 0, 0, 0], [0x70, 0x11, 1, 0]);
    let late = trial([0, 0, 2, 0], [0x6f, 0x11, 3, 0]);
    for more in [by_trial, late, vec![real(FRAMES as f32)]] {
        for short in [u16::MAX, 4464] {
            let motion = read_bytes_as(&long_file(FRAMES, short, &more), false).unwrap();
            assert_eq!((motion.positions_m.len(), motion.shortfall), (FRAMES, None));
            for frame in [0, 65_534, 65_535, 65_536, FRAMES - 1] {
                let wanted = 0.001 * Vec3::new(frame as f32 + 0.75, 2.0, 3.0);
                assert!((motion.positions_m[frame][2].unwrap() - wanted).norm() < 1.0e-5, "frame {frame}");
            }
        }
    }
    let cut = long_file(FRAMES - 1000, u16::MAX, &[real(FRAMES as f32)]);
    assert!(read_bytes_as(&cut, false).unwrap_err().contains("69002 of the 70000 frames"));
    for (short, counted) in [(u16::MAX, "65535"), (4464, "4464")] {
        let message = refusal(&long_file(FRAMES, short, &[]));
        assert!(message.contains(&format!("counts {counted} frames in 16 bits and has room for 70005")), "{message}");
        assert!(message.contains("POINT:LONG_FRAMES"), "{message}");
    }
    assert_eq!(read_bytes_as(&long_file(65_535, u16::MAX, &[]), false).unwrap().positions_m.len(), 65_535);
}

#[test]
fn whole_numbers_are_scaled_and_negative_residuals_are_missing() {
    let mut bytes = file(0, 2, &[]);
    bytes[12..16].copy_from_slice(&0.5_f32.to_le_bytes());
    let rows: [[i16; 4]; 6] =
        [[200, -2, 4, 0], [2, 2, 2, -1], [1, 2, 3, 0x0101], [0, 0, 0, 0], [2, 4, 6, -0x7f00], [9, 9, 9, -128]];
    bytes.extend(rows.iter().flatten().flat_map(|word| word.to_le_bytes()));
    bytes.resize(bytes.len().next_multiple_of(BLOCK_BYTES), 0);
    let motion = read_bytes_as(&bytes, false).unwrap();
    let place = |x: f32, y: f32, z: f32| Some(Vec3::new(x, y, z) * 0.001);
    let wanted = [vec![place(100.0, -1.0, 2.0), None, place(0.5, 1.0, 1.5)], vec![None, place(1.0, 2.0, 3.0), None]];
    assert_eq!(motion.positions_m, wanted);
}

#[test]
fn counts_beyond_the_file_are_refused_before_memory_is_taken() {
    let with = |at: usize, word: u16| {
        let mut bytes = file(40, 40, &[]);
        bytes[at..at + 2].copy_from_slice(&word.to_le_bytes());
        bytes
    };
    // Points, and a range of frames: 65,535 times 65,535 points.
    let mut many = with(2, u16::MAX);
    (many[6], many[8], many[9]) = (0, 0xfe, 0xff);
    assert!(refusal(&many).contains("0 of the 40 frames"));
    assert_eq!(read_bytes_as(&with(8, u16::MAX), true).unwrap().positions_m.len(), 40);
    assert!(refusal(&with(2, 0)).contains("no frame with labelled points"));
    assert!(refusal(&with(16, 9999)).contains("frames lie outside"));
    assert!(refusal(&with(16, 0)).contains("frames lie outside"));
    let mut outside = with(0, 0x5000);
    assert!(refusal(&outside).contains("parameters lie outside"));
    outside[0] = 99;
    assert!(refusal(&outside).contains("parameters lie outside"));
    // Analog channels: 65,535 of 65,535 samples a frame.
    for analog in [group(2, "ANALOG"), Vec::new()] {
        let used = parameter(2, "USED", 2, &[], &[0xff, 0xff]);
        let mut channels = file(40, 40, &[analog, used]);
        channels[18..20].copy_from_slice(&[0xff, 0xff]);
        assert!(refusal(&channels).contains("65535 analog channels of 65535 samples are not the 0"));
    }
    for frames in [1.0e18_f32, f32::NAN] {
        let long = file(40, 40, &[parameter(1, "LONG_FRAMES", 4, &[], &frames.to_le_bytes())]);
        assert!(refusal(&long).contains("which is no count"));
    }
}

#[test]
fn parameters_that_overlap_are_refused() {
    let mut bytes = file(1, 1, &[]);
    // Each begins five bytes after the one before and holds 255 bytes.
    let section: Vec<u8> = [1, 1, 255, 2, 0].repeat(64 * BLOCK_BYTES / 5);
    bytes.splice(BLOCK_BYTES + 4..BLOCK_BYTES + 4, section);
    bytes[16] = 67;
    bytes.resize(80 * BLOCK_BYTES, 0);
    assert!(refusal(&bytes).contains("its parameters overlap"));
}

#[test]
fn numbers_that_are_none_are_named_or_missing() {
    let with = |value: f32, residual: f32| {
        let mut bytes = file(2, 2, &[]);
        let at = 1024 + 48 + 16;
        bytes[at + 4..at + 8].copy_from_slice(&value.to_le_bytes());
        bytes[at + 12..at + 16].copy_from_slice(&residual.to_le_bytes());
        bytes
    };
    for value in [f32::INFINITY, -3.0e38, 1.1e9] {
        let message = refusal(&with(value, 0.0));
        assert!(message.contains("frame 1, marker `RANK`") && message.contains("beyond 1e9"), "{message}");
        assert!(read_bytes_as(&with(value, -1.0), false).unwrap().positions_m[1][1].is_none());
    }
    assert!(read_bytes_as(&with(f32::NAN, 0.0), false).unwrap().positions_m[1][1].is_none());
}

/// A file as [`file`], whose parameters are those of `section`.
fn file_with(section: &[Vec<u8>], frames: u16) -> Vec<u8> {
    let mut bytes = file(frames, frames, &[]);
    bytes[BLOCK_BYTES + 4..2 * BLOCK_BYTES].fill(0);
    let section = section.concat();
    bytes[BLOCK_BYTES + 4..BLOCK_BYTES + 4 + section.len()].copy_from_slice(&section);
    bytes
}

fn labels() -> Vec<u8> {
    parameter(1, "LABELS", -1, &[4, 3], b"LANKRANKLHIP")
}

#[test]
fn a_list_without_items_may_end_the_section() {
    let units = parameter(1, "UNITS", -1, &[2], b"mm");
    let head = [group(1, "POINT"), labels(), units, group(2, "PAD")];
    let mut tail = [group(3, "ANALYSIS"), parameter(3, "NAMES", -1, &[80, 0], &[])].concat();
    // Without the comment's length the section ends with the dimensions, at the end of its block.
    tail.pop();
    let used = head.concat().len() + tail.len() + 4;
    let pad = vec![0; BLOCK_BYTES - used - parameter(2, "X", 1, &[1], &[]).len()];
    let pad = parameter(2, "X", 1, &[pad.len() as u8], &pad);
    let bytes = file_with(&[head.concat(), pad, tail], 3);
    assert_eq!(read_bytes_as(&bytes, false).unwrap().names, ["LANK", "RANK", "LHIP"]);
}

#[test]
fn parameters_that_are_not_needed_may_be_missing_or_of_any_kind() {
    let float = parameter(2, "USED", 4, &[], &2.0_f32.to_le_bytes());
    let events = [group(2, "EVENT"), float].concat();
    let bytes = file_with(&[group(1, "POINT"), labels(), parameter(1, "UNITS", -1, &[4], b"cm  "), events], 3);
    let motion = read_bytes_as(&bytes, false).unwrap();
    assert!((motion.positions_m[2][0].unwrap() - 0.01 * Vec3::new(201.0, 2.0, 3.0)).norm() < 1.0e-5);
}

#[test]
fn without_units_the_points_have_the_size_of_a_person() {
    let of_height = |height: f32| {
        let mut bytes = file_with(&[group(1, "POINT"), labels()], 2);
        let numbers = [1.0, 2.0, 0.1 * height, 0.0, 1.0, 0.1 * height, 3.0, 0.0, 1.0, 2.0, 1.1 * height, 0.0];
        let frame: Vec<u8> = numbers.into_iter().flat_map(f32::to_le_bytes).collect();
        bytes[2 * BLOCK_BYTES..2 * BLOCK_BYTES + 96].copy_from_slice(&frame.repeat(2));
        bytes
    };
    for (height, unit) in [(1800.0, "mm is assumed"), (180.0, "cm is assumed"), (1.8, ": m is assumed")] {
        let motion = read_bytes_as(&of_height(height), false).unwrap();
        assert!(motion.notes[0].contains(unit), "{:?}", motion.notes);
        assert!((motion.positions_m[0][2].unwrap().z - 1.98).abs() < 0.01, "{unit}");
    }
    assert!(refusal(&of_height(30.0)).contains("the size of no person"));
}

#[test]
fn names_go_on_in_further_lists() {
    let lists = [("LABELS", "LANK"), ("LABELS2", "RANK"), ("LABELS3", "LHIP")];
    let lists = lists.map(|(name, label)| parameter(1, name, -1, &[4, 1], label.as_bytes()));
    let bytes = file_with(&[group(1, "POINT"), parameter(1, "UNITS", -1, &[2], b"mm"), lists.concat()], 2);
    assert_eq!(read_bytes_as(&bytes, false).unwrap().names, ["LANK", "RANK", "LHIP"]);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    /// Cut anywhere and with bytes changed, a file is read or refused, and never holds more frames
    /// than it has bytes for.
    #[test]
    fn damaged_files_never_panic(
        cut in 0_usize..3500,
        changes in prop::collection::vec((0_usize..1200, any::<u8>()), 0..6),
        partial: bool,
    ) {
        let mut bytes = file(40, 40, &[group(2, "ANALOG"), parameter(2, "USED", 2, &[], &[0, 0])]);
        for (at, value) in changes {
            bytes[at] = value;
        }
        bytes.truncate(cut.max(1));
        if let Ok(motion) = read_bytes_as(&bytes, partial) {
            let values: usize = motion.positions_m.iter().map(Vec::len).sum();
            prop_assert!(8 * values <= bytes.len());
        }
    }
}
