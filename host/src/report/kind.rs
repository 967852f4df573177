//! Which command made a run directory.

use super::folder::{RunFolder, names_in, read_regular};
use super::table::Table;
use serde_json::Value;
use std::path::Path;

/// What a directory holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// `sinew track arm`, `sinew demo`.
    Arm,
    /// `sinew track body`.
    Body,
    /// `sinew track cyclic`.
    Cyclic,
    /// `sinew evaluate arm`.
    EvaluateArm,
    /// `sinew evaluate body`.
    EvaluateBody,
    /// `sinew evaluate cyclic`.
    EvaluateCyclic,
    /// `sinew batch`, `sinew.sweep` of Python.
    Batch,
    /// Something with tables, records or pictures.
    Other,
}

impl Kind {
    /// By the files that are there; `None` if there is nothing to show.
    #[must_use]
    pub fn of(folder: &RunFolder) -> Option<Self> {
        let path = folder.path();
        let has = |names: &[&str]| names.iter().any(|name| folder.has(name));
        if has(&["arm.json", "arm.csv"]) {
            return Some(Self::EvaluateArm);
        }
        if has(&["cyclic.json", "cyclic.csv"]) {
            return Some(Self::EvaluateCyclic);
        }
        if has(&["summary.json", "estimates.csv", "anatomical.csv", "curves.csv"]) {
            return Some(Self::Cyclic);
        }
        let report_format = value(&path.join("report.json"))["format"].as_str().map(str::to_owned);
        let is_table = heading(&path.join("table.csv")).is_some_and(|table| table.has("joint_error_m"));
        if report_format.as_deref() == Some("sinew-evaluate-body") || is_table {
            return Some(Self::EvaluateBody);
        }
        let run = value(&path.join("run.json"));
        let track = heading(&path.join("track.csv")).unwrap_or_default();
        if track.has("pelvis_x_m") || !run["body"].is_null() || has(&["track.bvh"]) {
            return Some(Self::Body);
        }
        if track.has("hand_u_px") || !run["options"]["config"].is_null() || has(&["overlay", "scene/demo.json"]) {
            return Some(Self::Arm);
        }
        if heading(&path.join("status.csv")).is_some_and(|table| table.has("key") && table.has("attempts")) {
            return Some(Self::Batch);
        }
        let shown = |name: &String| [".csv", ".json", ".png", ".jpg"].iter().any(|end| name.ends_with(end));
        names_in(path).iter().any(shown).then_some(Self::Other)
    }
}

fn value(path: &Path) -> Value {
    read_regular(path).ok().and_then(|bytes| serde_json::from_slice(&bytes).ok()).unwrap_or_default()
}

fn heading(path: &Path) -> Option<Table> {
    let bytes = read_regular(path).ok()?;
    let line = bytes.split(|byte| *byte == b'\n').next()?;
    Some(Table::parse("", "", line).0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn a_run_is_known_by_what_is_left_of_it() {
        let cases: [(&str, &str, Option<Kind>); 13] = [
            ("arm.json", "{", Some(Kind::EvaluateArm)),
            ("cyclic.csv", "", Some(Kind::EvaluateCyclic)),
            ("summary.json", "{}", Some(Kind::Cyclic)),
            ("table.csv", "motion,model,joint_error_m\n", Some(Kind::EvaluateBody)),
            ("report.json", "{\"format\": \"sinew-evaluate-body\"}", Some(Kind::EvaluateBody)),
            ("run.json", "{\"body\": {}}", Some(Kind::Body)),
            ("track.csv", "frame,pelvis_x_m\n0,1\n", Some(Kind::Body)),
            ("track.csv", "frame,image,hand_u_px\n", Some(Kind::Arm)),
            ("run.json", "{\"options\": {\"config\": {}}}", Some(Kind::Arm)),
            ("run.json", "{\"rate_hz\": 15}", Some(Kind::Other)),
            ("status.csv", "id,key,status,class,message,seconds,attempts\n", Some(Kind::Batch)),
            ("scores.json", "{}", Some(Kind::Other)),
            ("notes.txt", "", None),
        ];
        for (name, text, kind) in cases {
            let folder = tempfile::tempdir().unwrap();
            fs::write(folder.path().join(name), text).unwrap();
            assert_eq!(Kind::of(&RunFolder::new(folder.path())), kind, "{name}: {text}");
        }
    }
}
