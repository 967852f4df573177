//! Readers of angle tables and cut lists.

use crate::Target;
use crate::file::{file, folder};
use sinew::cyclic::cutting::{CuttingOptions, cycles};
use sinew::cyclic::{AngleTable, CutList, cuts};
use std::path::Path;

/// Angle tables and cut lists.
pub const TARGETS: &[Target] = &[
    Target { name: "angle_table", run: table, seeds: || vec![swing(3).into_bytes(), swing(150).into_bytes()] },
    Target { name: "cut_list", run: list, seeds: || vec![CUTS.into()] },
];

const CUTS: &str = "file,start_frame,end_frame\nt.csv,3,70\n'=u.csv,0,1\n\"a b.csv\",5,60\n";

/// A table of `rows` in which every angle swings.
pub fn swing(rows: u32) -> String {
    let columns: Vec<_> =
        sinew::cyclic::angle_table::angle_columns().take(sinew::cyclic::angle_table::ANGLES).collect();
    let mut text = format!("frame,{}\n", columns.join(","));
    for frame in 0..rows {
        text += &frame.to_string();
        for column in 0..columns.len() {
            let angle = (f64::from(frame) * 0.12 + column as f64).sin() * 0.4;
            text += &if (frame + column as u32) % 17 == 5 { ",".to_owned() } else { format!(",{angle:.3}") };
        }
        text.push('\n');
    }
    text
}

fn table(bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    let Ok(table) = AngleTable::parse(&text, Path::new("t.csv")) else { return };
    let angles = table.rows().iter().flat_map(|row| row.angles_rad).flatten();
    assert!(angles.into_iter().all(f64::is_finite), "an angle");
    let written = table.to_csv().expect("memory takes it");
    let again = AngleTable::parse(&written, Path::new("t.csv")).expect("it was written");
    assert_eq!(again.to_csv().expect("memory takes it"), written, "as it was written");
    let _ = cycles(&table, "t.csv", CuttingOptions::default());
}

fn list(bytes: &[u8]) {
    let Ok(list) = CutList::read(&file("cuts.csv", bytes)) else { return };
    let path = folder().join("again.csv");
    cuts::write(&path, list.cuts()).expect("a temporary file");
    let again = CutList::read(&path).expect("it was written");
    let names = |list: &CutList| -> Vec<_> {
        list.cuts().iter().map(|cut| (cut.file.clone(), cut.start_frame, cut.end_frame)).collect()
    };
    assert_eq!(names(&again), names(&list), "as it was written");
}
