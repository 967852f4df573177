//! Every public type, trait and function of the core has an example in its own documentation, which
//! `cargo test` compiles and runs.
//!
//! Constants are shown in the examples of what uses them, methods in those of their types; the
//! interface for C has its examples in C.

use sinew_tests::workspace_root;
use std::fs;
use std::path::{Path, PathBuf};

/// Items of a module, as they begin a line.
const ITEMS: [&str; 6] = ["pub struct ", "pub enum ", "pub trait ", "pub fn ", "pub const fn ", "pub type "];
/// Fewest items that the core has: a search that finds none of them is broken.
const MIN_ITEMS: usize = 280;

fn rust_files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() && !path.ends_with("c_api") {
            rust_files(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
}

/// Whether users can name `item` of the module in `path`: its module is public, or the item is
/// handed on by the one above.
fn is_reachable(path: &Path, item: &str) -> bool {
    let name = |path: &Path| path.file_stem().unwrap().to_str().unwrap().to_owned();
    if ["mod", "lib"].contains(&name(path).as_str()) {
        return true;
    }
    let folder = path.parent().unwrap();
    let above = ["mod.rs", "lib.rs"].map(|file| folder.join(file)).into_iter().find(|file| file.exists());
    let above = fs::read_to_string(above.unwrap_or_else(|| folder.with_extension("rs"))).unwrap();
    let module = name(path);
    let handed_on = above.split("pub use ").skip(1).filter_map(|rest| rest.split_once(';'));
    let is_public = above.contains(&format!("pub mod {module};"));
    let is_of_tests = above.contains(&format!("#[cfg(test)]\npub mod {module};"));
    (is_public && !is_of_tests)
        || handed_on.into_iter().any(|(list, _)| list.starts_with(&format!("{module}::")) && list.contains(item))
}

/// The documentation and attributes right above line `index`.
fn above<'a>(lines: &'a [&str], index: usize) -> impl Iterator<Item = &'a str> {
    let belongs =
        |line: &&str| line.starts_with("///") || line.starts_with("#[") || line.starts_with("    ") || *line == ")]";
    lines[..index].iter().rev().copied().take_while(move |line| belongs(line))
}

#[test]
fn every_public_item_of_the_core_has_an_example() {
    let mut files = Vec::new();
    rust_files(&workspace_root().join("core/src"), &mut files);
    // What an `example.rs` holds is the set-up of other items' examples.
    files.retain(|path| !path.ends_with("example.rs"));
    let (mut count, mut without) = (0, Vec::new());
    for path in files {
        let text = fs::read_to_string(&path).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        for (index, line) in lines.iter().enumerate() {
            let Some(rest) = ITEMS.iter().find_map(|item| line.strip_prefix(item)) else { continue };
            let item = rest.split(|c: char| !c.is_alphanumeric() && c != '_').next().unwrap();
            if is_reachable(&path, item) {
                count += 1;
                if !above(&lines, index).any(|line| line.starts_with("/// ```")) {
                    without.push(format!("{}: {item}", path.display()));
                }
            }
        }
    }
    assert!(count >= MIN_ITEMS, "only {count} items were found");
    assert!(without.is_empty(), "without an example:\n{}", without.join("\n"));
}
