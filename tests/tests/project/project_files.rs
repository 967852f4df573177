//! What a well-kept project has at its root, and what its published packages contain.

use sinew_tests::workspace_root;
use std::fs;
use std::path::{Path, PathBuf};

/// Largest length of README, lines.
const MAX_README_LINES: usize = 120;
/// Largest length of an entry of CHANGELOG, characters.
const MAX_ENTRY_CHARACTERS: usize = 120;
/// Greatest width of a line of comment, characters.
const MAX_COMMENT_COLUMNS: usize = 100;
/// A line without a space from here on, as one that ends in a link, is free.
const LAST_WORD_COLUMN: usize = 40;
/// What README, the core's front page and docs/architecture.md say alike.
const UNSAFE_CLAIM: &str = "`sinew-core` has `unsafe` code in two places: the interface for C (feature `c-api`), and one \
                            square-root instruction in `math/elementary.rs` on Arm with a floating-point unit.";

fn read(path: impl AsRef<Path>) -> String {
    let path = workspace_root().join(path);
    fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Files of a folder of the workspace and of those below.
fn files(folder: &str, ending: &str) -> Vec<PathBuf> {
    let mut folders = vec![workspace_root().join(folder)];
    let mut found = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.to_str().unwrap().ends_with(ending) {
                found.push(path);
            }
        }
    }
    found
}

#[test]
fn readme_is_short() {
    let lines = read("README.md").lines().count();
    assert!(lines <= MAX_README_LINES, "{lines} lines");
}

#[test]
fn entries_of_the_changelog_are_short_and_sorted_by_kind() {
    let text = read("CHANGELOG.md");
    assert!(text.contains("\n## [Unreleased]\n"), "there is no section for what is not released");
    let version = format!("\n## [{}] - ", env!("CARGO_PKG_VERSION"));
    assert!(text.contains(&version), "there is no section of this version");
    for line in text.lines() {
        if let Some(kind) = line.strip_prefix("### ") {
            assert!(["Added", "Changed", "Deprecated", "Removed", "Fixed", "Security"].contains(&kind), "{line}");
        }
        if line.starts_with("- ") {
            assert!(line.chars().count() <= MAX_ENTRY_CHARACTERS, "{line}");
        }
        assert!(!line.starts_with("  "), "an entry is one line: {line}");
    }
}

/// Lines of comment that are too wide, with their numbers. Tables and code in comments are free.
fn wide_comments(text: &str) -> Vec<usize> {
    let mut in_code = false;
    let mut wide = Vec::new();
    for (index, line) in text.lines().enumerate() {
        let Some(comment) = line.trim_start().strip_prefix("//") else {
            in_code = false;
            continue;
        };
        let comment = comment.trim_start_matches(['/', '!']);
        if comment.trim_start().starts_with("```") {
            in_code = !in_code;
        }
        let free = in_code || comment.starts_with("     ") || comment.trim_start().starts_with('|');
        let has_break = line.chars().skip(LAST_WORD_COLUMN).any(|c| c == ' ');
        if !free && has_break && line.chars().count() > MAX_COMMENT_COLUMNS {
            wide.push(index + 1);
        }
    }
    wide
}

#[test]
fn comments_end_at_column_100() {
    let mut wide = Vec::new();
    for path in ["core", "host", "firmware-sim", "tests"].iter().flat_map(|folder| files(folder, ".rs")) {
        let name = path.strip_prefix(workspace_root()).unwrap().display();
        let lines = wide_comments(&fs::read_to_string(&path).unwrap());
        wide.extend(lines.into_iter().map(|line| format!("{name}:{line}")));
    }
    assert!(wide.is_empty(), "{} lines of comment are too wide:\n{}", wide.len(), wide.join("\n"));
}

#[test]
fn the_claim_about_unsafe_code_is_true_and_the_same_everywhere() {
    for page in ["README.md", "core/README.md", "docs/architecture.md"] {
        let text = read(page).split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(text.contains(UNSAFE_CLAIM), "{page}");
    }
    for path in files("core/src", ".rs") {
        let text = fs::read_to_string(&path).unwrap();
        let blocks = text.lines().filter(|line| line.contains("unsafe {") || line.contains("unsafe fn")).count();
        let allowed = if path.ends_with("core/src/math/elementary.rs") { 1 } else { 0 };
        assert!(path.components().any(|part| part.as_os_str() == "c_api") || blocks == allowed, "{}", path.display());
    }
}

#[test]
fn every_published_package_has_its_licences_and_says_where_it_comes_from() {
    let mut published = 0;
    for folder in ["core", "host"] {
        for manifest in files(folder, "Cargo.toml") {
            let text = fs::read_to_string(&manifest).unwrap();
            if text.contains("publish = false") {
                continue;
            }
            published += 1;
            for licence in ["LICENSE-MIT", "LICENSE-APACHE"] {
                let own = fs::read_to_string(manifest.with_file_name(licence));
                assert_eq!(own.ok().as_ref(), Some(&read(licence)), "{licence} of {}", manifest.display());
            }
            assert!(manifest.with_file_name("README.md").exists(), "{} has no README.md", manifest.display());
            for key in ["description", "license.workspace", "repository.workspace", "documentation", "categories"] {
                assert!(text.contains(&format!("\n{key}")), "{} lacks `{key}`", manifest.display());
            }
        }
    }
    assert!(published >= 2, "{published} packages");
}

#[test]
fn every_example_of_the_library_crates_says_how_to_run_it() {
    let examples: Vec<PathBuf> = ["core/examples", "host/examples"].iter().flat_map(|f| files(f, ".rs")).collect();
    assert!(examples.len() >= 6, "{examples:?}");
    for path in examples {
        let (text, name) = (fs::read_to_string(&path).unwrap(), path.file_stem().unwrap().to_str().unwrap());
        assert!(text.lines().count() <= 80, "{} has more than 80 lines", path.display());
        let command = text.lines().find_map(|line| line.strip_prefix("//!     cargo run --release "));
        assert!(command.is_some_and(|words| words.ends_with(&format!("--example {name}"))), "{}", path.display());
    }
}
