//! The pages of the book list the formats that are read, all of them and no other.

use sinew::registry::{Kind, MEASURABLE, MOTION, endings};
use std::collections::BTreeSet;
use std::path::Path;

fn page(name: &str) -> String {
    std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs").join(name)).unwrap()
}

/// The endings in backquotes: `` `.bvh` ``.
fn listed<'a>(lines: impl Iterator<Item = &'a str>) -> BTreeSet<&'a str> {
    let quoted = lines.flat_map(|line| line.split('`').skip(1).step_by(2));
    quoted.filter_map(|word| word.strip_prefix('.')).collect()
}

fn known(kinds: &[Kind]) -> BTreeSet<&'static str> {
    endings(kinds).collect()
}

#[test]
fn recordings_of_keypoints_and_motion() {
    let text = page("keypoints.md");
    let (_, section) = text.split_once("## What is read\n").unwrap();
    let rows =
        section.lines().skip_while(|line| !line.starts_with("| folder")).take_while(|line| line.starts_with('|'));
    let inputs = rows.map(|row| row.split('|').nth(1).unwrap());
    assert_eq!(listed(inputs), known(&[MOTION, &[Kind::Skeleton, Kind::Keypoints]].concat()));
}

#[test]
fn clouds_and_persons() {
    let text = page("track_body.md");
    let folder = text.lines().filter(|line| line.starts_with("`DIR` is a folder with one cloud"));
    assert_eq!(listed(folder), known(&[Kind::Cloud]));
    let person = text.lines().filter(|line| line.starts_with("| `body.json`"));
    assert_eq!(listed(person), known(MEASURABLE));
}

#[test]
fn images_and_videos() {
    let text = page("command.md").split_whitespace().collect::<Vec<_>>().join(" ");
    for (start, kind) in [("Images end in ", Kind::Image), ("Videos end in ", Kind::Video)] {
        let (_, list) = text.split_once(start).unwrap();
        let (list, _) = list.split_once("`. ").unwrap();
        assert_eq!(listed([format!("{list}`").as_str()].into_iter()), known(&[kind]), "{start}");
    }
}
