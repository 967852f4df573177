//! The architecture page shows the arrows that the code has, and no two files import each other.

use sinew_tests::imports::Imports;
use sinew_tests::workspace_root;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// Crates, and how many circles of files each may have.
const MAX_CIRCLES: [(&str, usize); 9] = [
    ("core/src", 0),
    ("core/record/src", 0),
    ("host/formats/src", 0),
    ("host/face/src", 0),
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

/// What opens files beside the loader: outputs, checksums of any file, the first bytes of one whose
/// kind is unknown, what ffmpeg wrote, and tables that are read row by row.
const OPENING_FILES: [&str; 7] = [
    "host/formats/src/file.rs",
    "host/src/output/",
    "host/src/resume/begun.rs",
    "host/src/cli/batch/content.rs",
    "host/formats/src/motion/reading.rs",
    "host/formats/src/images/video.rs",
    "host/src/cyclic/",
];

#[test]
fn inputs_are_read_by_the_one_loader() {
    let mut found = Vec::new();
    for folder in ["host/src", "host/formats/src"] {
        for path in sources(&workspace_root().join(folder)) {
            let name = path.strip_prefix(workspace_root()).unwrap().to_string_lossy().into_owned();
            let text = fs::read_to_string(&path).unwrap();
            let code = text.split("#[cfg(test)]\nmod tests").next().unwrap_or_default();
            let opens = ["fs::read(", "read_to_string(", "File::open(", "from_path("];
            if name.ends_with("/tests.rs") || OPENING_FILES.iter().any(|other| name.starts_with(other)) {
                continue;
            }
            found.extend(opens.iter().filter(|call| code.contains(**call)).map(|call| format!("{name}: {call}")));
        }
    }
    assert!(found.is_empty(), "these read files without the limits of `sinew_formats::file`: {found:#?}");
}

fn sources(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files.extend(sources(&path));
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(path);
        }
    }
    files
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
