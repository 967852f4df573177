//! Frames per second of the tables that a list cuts.

use anyhow::{Result, ensure};
use sinew::cyclic::rate::{is_same, of_recording};
use sinew::cyclic::{AngleTable, CutList};
use std::collections::BTreeSet;

/// The rate of tables that do not say theirs, where --rate is not given either: that of the
/// paper's cameras.
pub const DEFAULT_RATE_HZ: f64 = 60.0;

/// Frames per second of all tables of `list`; `given` is that of `--rate`.
///
/// # Errors
/// A table that cannot be read, one that contradicts `given`, or two that differ.
pub fn rate_of(list: &CutList, given: Option<f64>) -> Result<f64> {
    let paths: BTreeSet<_> = list.cuts().iter().map(|cut| list.table_path(cut)).collect();
    let mut all = given;
    for path in paths {
        let Some(of_table) = AngleTable::read(&path)?.rate_hz() else { continue };
        of_recording(&path, Some(of_table), given)?;
        let first = *all.get_or_insert(of_table);
        ensure!(
            is_same(of_table, first),
            "`{}` has {of_table} frames a second, another table of `{}` {first}; evaluate them one after the other",
            path.display(),
            list.path().display()
        );
    }
    Ok(all.unwrap_or(DEFAULT_RATE_HZ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs::write;

    #[test]
    fn tables_say_their_rate_and_are_not_contradicted() {
        let folder = tempfile::tempdir().unwrap();
        let file = |name: &str, text: &str| write(folder.path().join(name), text).unwrap();
        let poses = [[Some(0.1); 13]; 3];
        let table = AngleTable::from_angles(0, &poses).unwrap();
        file("silent.csv", &table.to_csv().unwrap());
        file("thirty.csv", &table.clone().at_rate(Some(30.0)).to_csv().unwrap());
        file("fifty.csv", &table.at_rate(Some(50.0)).to_csv().unwrap());
        let rate = |tables: &[&str], given: Option<f64>| {
            let rows: String = tables.iter().map(|table| format!("{table}.csv,0,3\n")).collect();
            file("cuts.csv", &format!("file,start_frame,end_frame\n{rows}"));
            let list = CutList::read(&folder.path().join("cuts.csv")).unwrap();
            rate_of(&list, given).map_err(|error| format!("{error:#}"))
        };
        assert_eq!(rate(&["silent"], None), Ok(DEFAULT_RATE_HZ));
        assert_eq!(rate(&["silent"], Some(25.0)), Ok(25.0));
        assert_eq!(rate(&["silent", "thirty"], None), Ok(30.0));
        assert!(rate(&["thirty"], Some(60.0)).unwrap_err().contains("say 30 frames a second, not the 60 of --rate"));
        assert!(rate(&["fifty", "thirty"], None).unwrap_err().contains("one after the other"));
    }
}
