//! The architecture page shows the arrows that the code has, and no two files import each other.

use sinew_tests::imports::Imports;
use sinew_tests::workspace_root;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;

/// Crates, and how many circles of files each may have.
const MAX_CIRCLES: [(&str, usize); 8] = [
    ("core/src", 0),
    ("core/record/src", 0),
    ("host/formats/src", 0),
    ("host/src", 3),
    ("host/lab/src", 0),
    ("host/live/src", 0),
    ("host/live/page/src", 0),
    ("firmware-sim/src", 0),
];

#[test]
fn files_do_not_import_each_other_in_circles() {
    for (folder, max_circles) in MAX_CIRCLES {
        let circles = Imports::of_crate(&workspace_root().join(folder)).circles();
        let names: Vec<Vec<String>> =
            circles.iter().map(|circle| circle.iter().map(|module| module.join("::")).collect()).collect();
        assert!(circles.len() <= max_circles, "{folder}: at most {max_circles} circles, but these: {names:#?}");
    }
}

#[test]
fn the_architecture_page_has_the_arrows_of_the_core() {
    let page = fs::read_to_string(workspace_root().join("docs/architecture.md")).unwrap();
    let (_, block) = page.split_once("```rooms\n").expect("the page has a block of rooms");
    let (block, _) = block.split_once("```").expect("the block ends");
    let mut drawn: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for line in block.lines() {
        let (room, targets) = line.split_once("->").expect("a line is ROOM -> ROOM, ROOM");
        let targets = targets.split(',').map(|name| name.trim().to_owned()).filter(|name| !name.is_empty());
        drawn.insert(room.trim().to_owned(), targets.collect());
    }
    let in_code = Imports::of_crate(&workspace_root().join("core/src")).between_rooms();
    let lines: Vec<String> = in_code
        .iter()
        .map(|(room, targets)| format!("{room} -> {}", targets.iter().cloned().collect::<Vec<_>>().join(", ")))
        .collect();
    assert_eq!(drawn, in_code, "docs/architecture.md has other arrows than the code, which has\n{}", lines.join("\n"));
    assert!(in_code.values().map(BTreeSet::len).sum::<usize>() > 50, "the reader finds arrows");
}
