//! Small files, whole and broken.

use super::*;
use sinew_core::math::Vec3;

const TRC: &str = "PathFileType\t4\t(X/Y/Z)\tm.trc\nDataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames\n\
    60\t60\t2\t2\tmm\t60\t1\t2\nFrame#\tTime\tRHip\t\t\tLHip\t\t\n\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n\n\
    1\t0.0\t1000\t2000\t3000\t\t\t\n2\t0.016\tNaN\tNaN\tNaN\t4\t5\t6\t\n";

#[test]
fn positions_come_in_metres_and_empty_ones_are_missing() {
    let motion = parse(TRC, Path::new("m.trc")).unwrap();
    assert_eq!(
        (motion.frames_per_second, motion.names.as_slice()),
        (60.0, &["RHip".to_owned(), "LHip".to_owned()][..])
    );
    let near = |found: Option<Vec3>, wanted: [f32; 3]| (found.unwrap() - Vec3::from(wanted)).norm() < 1.0e-6;
    assert!(near(motion.positions_m[0][0], [1.0, 2.0, 3.0]) && motion.positions_m[0][1].is_none());
    assert!(near(motion.positions_m[1][1], [0.004, 0.005, 0.006]) && motion.positions_m[1][0].is_none());
}

#[test]
fn broken_files_name_file_line_and_rule() {
    let changes = [
        ("PathFileType", "Path", "m.trc:1: a TRC file has to begin"),
        ("DataRate\tCamera", "Rate\tCamera", "m.trc:3: the header has no value of `DataRate`"),
        ("60\t60\t2\t2\tmm", "0\t60\t2\t2\tmm", "m.trc:3: `DataRate` has to be"),
        ("\tmm\t", "\tfeet\t", "m.trc:3: `Units` is `feet`"),
        ("1000\t2000", "x\t2000", "m.trc:7: a number was expected, found `x`"),
        ("1000\t2000", "inf\t2000", "m.trc:7: `inf` is not finite; every value has to be (marker `RHip`)"),
        ("1000\t2000", "-1e30\t2000", "m.trc:7: `-1e30` is beyond 1e9"),
        ("\t4\t5\t6\t", "\t4\t5", "m.trc:8: a frame needs 8 columns, found 7"),
        ("\tRHip\t\t\tLHip\t\t", "", "m.trc:4: no marker"),
    ];
    for (from, to, message) in changes {
        let found = parse(&TRC.replacen(from, to, 1), Path::new("m.trc")).unwrap_err().to_string();
        assert!(found.starts_with(message), "{found} does not start with {message}");
    }
    let end = parse("PathFileType\n", Path::new("m.trc")).unwrap_err().to_string();
    assert!(end.contains("the file ends where"), "{end}");
}
#[test]
fn fewer_frames_than_promised_are_an_error_or_noted() {
    let text = TRC.replace("60\t60\t2\t2", "60\t60\t5.0\t2");
    let partial = ReadOptions { partial: true, ..ReadOptions::default() };
    for (cut, frames) in [(&text[..], 2), (&text[..text.len() - 4], 1)] {
        let message = parse(cut, Path::new("m.trc")).unwrap_err().to_string();
        let wanted = format!("m.trc:3: the recording ends early: {frames} of the 5 frames");
        assert!(message.starts_with(&wanted) && message.contains("--partial"), "{message}");
        let motion = parse_with(cut, Path::new("m.trc"), &partial).unwrap();
        assert_eq!((motion.positions_m.len(), motion.shortfall), (frames, Some(Shortfall { frames, promised: 5 })));
    }
    let more = TRC.replace("60\t60\t2\t2", "60\t60\t1\t2");
    assert_eq!(parse(&more, Path::new("m.trc")).unwrap().shortfall, None);
}

fn points(rows: &str) -> Result<MarkerMotion, String> {
    let text = TRC.replace("60\t60\t2\t2", "60\t60\t0\t2");
    let head: Vec<&str> = text.lines().take(HEADER_LINES).collect();
    parse(&format!("{}\n\n{rows}", head.join("\n")), Path::new("m.trc")).map_err(|error| error.to_string())
}

#[test]
fn what_programs_write_for_a_missing_marker_is_missing() {
    for cells in [
        "0\t0\t0",
        "0.00000\t-0.0\t0",
        "-1.#QNAN\t-1.#QNAN\t-1.#QNAN",
        "1.#IND\t-1.#IND0\t1.#SNAN",
        "-1.#J\t-1.#J\t-1.#J",
        "nan\t-nan(ind)\tNaN",
        "NA\tn/a\t--",
        "9999999.000\t9999999.000\t9999999.000",
        "1\t\t3",
    ] {
        let motion = points(&format!("1\t0.0\t{cells}\t4\t5\t6\r\n")).unwrap_or_else(|error| panic!("{error}"));
        assert!(motion.positions_m[0][0].is_none() && motion.positions_m[0][1].is_some(), "{cells}");
    }
    assert!(points("1\t0.0\t1.#INF\t2\t3\t4\t5\t6\n").unwrap_err().contains("`1.#INF`"));
}

#[test]
fn markers_at_the_end_of_a_row_may_be_left_out() {
    for (row, seen) in [("1\t0.0\t1\t2\t3", 1), ("1\t0.0", 0), ("1\t0.0\t1\t2\t3\t4\t5\t6\t\t", 2)] {
        let motion = points(&format!("{row}\n")).unwrap();
        assert_eq!(motion.positions_m[0].iter().flatten().count(), seen, "{row}");
    }
    for row in ["1\t0.0\t1\t2\n", "1\n", "1\t0.0\t1\t2\t3"] {
        assert!(points(row).unwrap_err().contains("a frame needs 8 columns"), "{row}");
    }
}

#[test]
fn frames_that_are_left_out_are_frames_without_points() {
    let rows = |frames: &[(&str, f32)]| -> String {
        frames.iter().map(|(frame, time)| format!("{frame}\t{time}\t1\t2\t3\t4\t5\t6\n")).collect()
    };
    let time = |frame: u16| f32::from(frame) / 60.0;
    for (given, wanted) in [
        (vec![("7", 0.0), ("8", time(1)), ("12", time(5)), ("13", time(6))], vec![0, 1, 5, 6]),
        // Rows are counted.
        (vec![("1", 0.0), ("2", time(1)), ("3", time(4)), ("4", time(5))], vec![0, 1, 4, 5]),
        (vec![("", 0.0), ("", time(1)), ("", time(4))], vec![0, 1, 4]),
        // Every second frame of a recording; the times of another clock; times with two decimals.
        (vec![("1", 0.0), ("3", time(1)), ("5", time(2))], vec![0, 1, 2]),
        (vec![("1", 0.0), ("2", 0.5), ("3", 1.0)], vec![0, 1, 2]),
        (vec![("1", 0.0), ("2", 0.02), ("3", 0.03), ("4", 0.05), ("5", 0.07)], vec![0, 1, 2, 3, 4]),
        // Numbers that fall, no times.
        (vec![("5", 0.0), ("4", 0.0), ("9", 0.0)], vec![0, 1, 2]),
    ] {
        let motion = points(&rows(&given)).unwrap();
        let seen: Vec<usize> = (0..motion.positions_m.len()).filter(|&i| motion.positions_m[i][0].is_some()).collect();
        assert_eq!(seen, wanted, "{given:?}");
        assert_eq!(motion.notes.len(), usize::from(wanted.len() < wanted[wanted.len() - 1] + 1));
    }
    let far = points(&rows(&[("1", 0.0), ("2", 0.0), ("900000000", 0.0)])).unwrap_err();
    assert!(far.contains("more than a file of"), "{far}");
}

#[test]
fn pixels_and_missing_units_have_the_size_of_a_person() {
    let rows = "1\t0.0\t100\t200\t0\t100\t1000\t0\n";
    let text = TRC.replace("60\t60\t2\t2", "60\t60\t0\t2").replace("\tmm\t", "\tpx\t");
    let head: Vec<&str> = text.lines().take(HEADER_LINES).collect();
    let motion = parse(&format!("{}\n{rows}", head.join("\n")), Path::new("m.trc")).unwrap();
    let [low, high] = [0, 1].map(|point| motion.positions_m[0][point].unwrap());
    assert!(motion.is_scale_assumed && ((high - low).norm() - 1.6).abs() < 1.0e-5, "{low} {high}");
    let without = head.join("\n").replace("\tUnits\t", "\tQ\t");
    let motion = parse(&format!("{without}\n{rows}"), Path::new("m.trc")).unwrap();
    assert!(motion.notes[0].contains("mm is assumed") && !motion.is_scale_assumed, "{:?}", motion.notes);
}
