//! Tables as they are read and written.

use super::*;
use crate::cyclic::error::CyclicError;
use proptest::prelude::*;
use std::path::Path;

fn parsed(rows: &str) -> Result<AngleTable, CyclicError> {
    AngleTable::parse(&format!("{}\n{rows}", COLUMNS.join(",")), Path::new("t.csv"))
}

#[test]
fn empty_cells_and_left_out_frames_are_missing() {
    let table = parsed("3,1,,3,4,5,6,7,8,9,10,11,12,13\n7,1,2,3,4,5,6,7,8,9,10,11,12,-13.5\n").unwrap();
    assert_eq!((table.first_frame(), table.end_frame()), (3, 8));
    assert_eq!(table.row(3).unwrap().angles_rad[1], None);
    assert_eq!(table.row(7).unwrap().angles_rad[12], Some(-13.5));
    assert!(table.row(4).is_none());
}

#[test]
fn extra_columns_are_kept() {
    let text = format!("\u{feff}{},hip_center_u_px\r\n0,1,2,3,4,5,6,7,8,9,10,11,12,13,320.5\r\n", COLUMNS.join(","));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("t.csv");
    std::fs::write(&path, text).unwrap();
    let table = AngleTable::read(&path).unwrap();
    assert_eq!(
        (table.extra_columns(), table.rows()[0].extra.as_slice()),
        (&["hip_center_u_px".to_owned()][..], &["320.5".to_owned()][..])
    );
    table.write(&path).unwrap();
    assert_eq!(AngleTable::read(&path).unwrap(), table);
}

#[test]
fn two_angles_a_joint_are_read_and_written_and_all_or_none() {
    let header = [&COLUMNS[..], &SIDE_COLUMNS[..], &["speed"]].concat().join(",");
    let row = (1..=26).map(|i| format!("{:.6}", f64::from(i))).collect::<Vec<_>>().join(",");
    let text = format!("{header}\n5,{row},9.5\n");
    let table = AngleTable::parse(&text, Path::new("t.csv")).unwrap();
    assert_eq!((table.angle_count(), table.extra_columns()), (26, &["speed".to_owned()][..]));
    assert_eq!(
        (table.angle_rad(5, 0), table.angle_rad(5, 13), table.angle_rad(5, 25)),
        (Some(1.0), Some(14.0), Some(26.0))
    );
    assert_eq!((table.angle_rad(5, 26), table.angle_rad(4, 0)), (None, None));
    assert_eq!(table.to_csv().unwrap(), text);
    let broken = text.replace(",20.000000,", ",x,");
    let message = AngleTable::parse(&broken, Path::new("t.csv")).unwrap_err().to_string();
    assert!(message.starts_with("t.csv:2: `r_wrist_side_rad` has to be a number"), "{message}");
    let some = text.replace("neck_side_rad,", "");
    let message = AngleTable::parse(&some, Path::new("t.csv")).unwrap_err().to_string();
    assert!(message.starts_with("t.csv:1: side angles have to be all 13"), "{message}");
}

#[test]
fn broken_tables_name_file_line_and_rule() {
    let row = "0,1,2,3,4,5,6,7,8,9,10,11,12,13\n";
    let cases = [
        (format!("{row}1,NaN,2,3,4,5,6,7,8,9,10,11,12,13"), "t.csv:3: `neck_rad` is `NaN`, but has to be finite"),
        ("0,1,2,3,4,5,6,7,inf,9,10,11,12,13".into(), "t.csv:2: `l_hip_rad` is `inf`"),
        ("0,1,2,3,4,5,6,7,x,9,10,11,12,13".into(), "t.csv:2: `l_hip_rad` has to be a number, found `x`"),
        ("0,1,2,3".into(), "t.csv:2: a row needs 14 columns as the header has, found 4"),
        (
            format!("{row}1,1,2,3,4,5,6,7,8,9,10,11,12,13,14"),
            "t.csv:3: a row needs 14 columns as the header has, found 15",
        ),
        (format!("{row}{row}"), "t.csv:3: frame 0 follows frame 0"),
        ("-1,1,2,3,4,5,6,7,8,9,10,11,12,13".into(), "t.csv:2: `frame` has to be a whole number"),
        ("18446744073709551615,1,2,3,4,5,6,7,8,9,10,11,12,13".into(), "t.csv:2: `frame` has to be a whole number"),
        (String::new(), "t.csv:2: the table is empty"),
    ];
    for (rows, message) in cases {
        let found = parsed(&rows).unwrap_err().to_string();
        assert!(found.starts_with(message), "{found} does not start with {message}");
    }
    let header = AngleTable::parse("frame,neck\n", Path::new("t.csv")).unwrap_err().to_string();
    assert!(header.starts_with("t.csv:1: column 2 has to be `neck_rad`, found `neck`"), "{header}");
    let empty = AngleTable::parse("", Path::new("t.csv")).unwrap_err().to_string();
    assert!(empty.starts_with("t.csv:1: the table is empty"), "{empty}");
}

proptest! {
    #[test]
    fn a_table_survives_its_file(
        frames in prop::collection::btree_set(0_u64..1_000_000, 1..20),
        angle in -100.0..100.0_f64,
        missing in 0..ANGLES,
    ) {
        let mut angles_rad = [Some((angle * 1.0e6).round() / 1.0e6); ANGLES];
        angles_rad[missing] = None;
        let rows = frames.into_iter().map(|frame| AngleRow { frame, angles_rad, extra: Vec::new() }).collect();
        let table = AngleTable::new(rows, Vec::new()).unwrap();
        prop_assert_eq!(AngleTable::parse(&table.to_csv().unwrap(), Path::new("t.csv")).unwrap(), table);
    }
}

/// A table of version 0.2.0 of a person who faced left: left and right were exchanged.
#[test]
fn old_tables_get_their_own_sides_back() {
    let angles: Vec<String> = (1..=ANGLES).map(|angle| format!("0.{angle:02}")).collect();
    let text = format!(
        "{},l_knee_length_px,r_knee_length_px,mirrored\n0,{},80.0,90.0,1\n1,{},80.0,90.0,0\n",
        COLUMNS.join(","),
        angles.join(","),
        angles.join(",")
    );
    let table = AngleTable::parse(&text, Path::new("old.csv")).unwrap();
    let [exchanged, plain] = table.rows() else { panic!("{table:?}") };
    assert_eq!(exchanged.extra, ["90.0", "80.0", "left"]);
    assert_eq!(plain.extra, ["80.0", "90.0", "right"]);
    assert_eq!((exchanged.angles_rad[8], exchanged.angles_rad[11]), (plain.angles_rad[11], plain.angles_rad[8]));
    assert_eq!(exchanged.angles_rad[0], plain.angles_rad[0]);
}

#[test]
fn times_give_the_rate_and_are_written() {
    let table = AngleTable::from_angles(3, &[[Some(0.5); ANGLES]; 4]).unwrap().at_rate(Some(29.97));
    let text = table.to_csv().unwrap();
    assert!(text.lines().next().unwrap().ends_with("r_ankle_rad,time_s"));
    let read = AngleTable::parse(&text, Path::new("t.csv")).unwrap();
    assert_eq!((read.rate_hz(), read.extra_columns().len()), (Some(29.97), 0));
    let uneven = text.replace("4,0.5", "9,0.5");
    assert!(AngleTable::parse(&uneven, Path::new("t.csv")).is_err());
}
