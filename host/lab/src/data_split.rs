//! Which recording serves for what: `data_split.csv`, by tracker, role and subject
//! (docs/data_split.md).

use crate::body::MotionChoice;
use anyhow::{Context, Result, bail, ensure};
use serde::Deserialize;
use std::path::Path;

/// The table as it stands in the repository.
const TABLE: &str = include_str!("../data_split.csv");

/// What a recording serves for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Role {
    /// A model was trained on it.
    Training,
    /// Numbers were chosen by it.
    Tuning,
    /// Results are reported on it.
    Reporting,
}

/// One row: a recording, or a part of it, with one role for one tracker.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
pub struct Entry {
    /// Whose numbers: `body-paper`, `cyclic`, ...
    pub tracker: String,
    /// The role.
    pub role: Role,
    /// Who is recorded, or the action where the source does not name the person.
    pub subject: String,
    /// File or folder below the folder of recordings, with `@START-END` seconds for a part.
    pub recording: String,
}

/// All rows of a table of this form.
///
/// # Errors
/// A row that is not of this form; a subject or recording that has two roles for one tracker.
pub fn parse(text: &str) -> Result<Vec<Entry>> {
    let rows = csv::Reader::from_reader(text.as_bytes()).into_deserialize();
    let entries: Vec<Entry> = rows.collect::<Result<_, _>>().context("data_split.csv")?;
    for (index, entry) in entries.iter().enumerate() {
        let same = |other: &&Entry| {
            other.tracker == entry.tracker && (other.subject == entry.subject || other.recording == entry.recording)
        };
        let clash = entries[..index].iter().filter(same).find(|other| other.role != entry.role);
        if let Some(other) = clash {
            bail!(
                "data_split.csv: `{}` of subject {} is {:?} of {}, and `{}` of subject {} is {:?}; give both one role",
                other.recording,
                other.subject,
                other.role,
                entry.tracker,
                entry.recording,
                entry.subject,
                entry.role
            );
        }
    }
    Ok(entries)
}

/// The rows of `tracker` with `role`.
///
/// # Errors
/// As [`parse`].
pub fn entries(tracker: &str, role: Role) -> Result<Vec<Entry>> {
    let mut all = parse(TABLE)?;
    all.retain(|entry| entry.tracker == tracker && entry.role == role);
    ensure!(!all.is_empty(), "data_split.csv has no {role:?} rows of {tracker}");
    Ok(all)
}

/// The motions of these rows below `data`.
///
/// # Errors
/// As [`entries`]; a row that names no motion.
pub fn motions(data: &Path, tracker: &str, role: Role) -> Result<Vec<MotionChoice>> {
    entries(tracker, role)?
        .iter()
        .map(|entry| format!("{}/{}", data.display(), entry.recording).parse().map_err(anyhow::Error::msg))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEAD: &str = "tracker,role,subject,recording\n";

    #[test]
    fn the_table_gives_every_subject_one_role() {
        let all = parse(TABLE).unwrap();
        assert!(all.len() > 50, "{}", all.len());
        for (tracker, role) in [("body-paper", Role::Tuning), ("body-paper", Role::Reporting), ("body", Role::Tuning)] {
            assert!(motions(Path::new("data"), tracker, role).unwrap().len() > 3, "{tracker} {role:?}");
        }
        assert!(entries("hands", Role::Reporting).unwrap_err().to_string().contains("no Reporting rows of hands"));
    }

    #[test]
    fn the_arms_clips_and_the_runners_are_in_the_table() {
        let all = parse(TABLE).unwrap();
        for clip in sinew::motion::clips::CLIPS {
            let file = format!("mocap/{}", clip.file);
            assert!(all.iter().any(|entry| entry.tracker == "arm" && entry.recording == file), "{file}");
        }
        let runners = entries(crate::body::runners::TRACKER, Role::Tuning).unwrap();
        assert_eq!(runners.len(), 3, "the clips of the table");
        let chosen = entries("modes", Role::Tuning).unwrap();
        for runner in &runners {
            assert!(chosen.iter().all(|entry| entry.recording != runner.recording), "{}", runner.recording);
            assert!(chosen.iter().any(|entry| entry.subject == runner.subject), "{}", runner.subject);
        }
    }

    #[test]
    fn a_subject_or_recording_in_two_roles_is_refused() {
        let read = |rows: &str| parse(&format!("{HEAD}{rows}")).map_err(|error| format!("{error:#}"));
        assert!(read("body,tuning,13,a.amc\nbody,tuning,13,b.amc\nbody,reporting,35,c.amc\n").is_ok());
        let subject = read("body,tuning,13,a.amc\nbody,reporting,13,b.amc\n").unwrap_err();
        assert!(
            subject.contains("`a.amc` of subject 13 is Tuning of body") && subject.contains("one role"),
            "{subject}"
        );
        let recording = read("body,tuning,13,a.amc\nbody,reporting,14,a.amc\n").unwrap_err();
        assert!(recording.contains("subject 14 is Reporting"), "{recording}");
        assert!(read("body,tuning,13,a.amc\ncyclic,reporting,13,a.amc\n").is_ok(), "roles are by tracker");
        assert!(read("body,testing,13,a.amc\n").unwrap_err().contains("unknown variant `testing`"));
    }

    #[test]
    fn every_recording_is_there() {
        let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
        if !data.is_dir() {
            eprintln!("skipped: without ../shared/data beside the project");
            return;
        }
        for entry in parse(TABLE).unwrap() {
            let file = entry.recording.split('@').next().unwrap_or_default();
            assert!(data.join(file).exists(), "{file} of {} is missing", entry.tracker);
        }
    }
}
