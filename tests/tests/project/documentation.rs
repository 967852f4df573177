//! README's commands exist, and the links of all Markdown pages lead somewhere.

use sinew_tests::{parse, workspace_root};
use std::fs;
use std::path::{Path, PathBuf};

/// Lines of the code blocks of a page, block by block.
fn code_blocks(page: &str) -> Vec<Vec<&str>> {
    let mut blocks = Vec::new();
    let mut inside = false;
    for line in page.lines() {
        if line.starts_with("```") {
            inside = !inside;
            if inside {
                blocks.push(Vec::new());
            }
        } else if inside && let Some(block) = blocks.last_mut() {
            block.push(line);
        }
    }
    blocks
}

fn readme() -> String {
    fs::read_to_string(workspace_root().join("README.md")).unwrap()
}

#[test]
fn the_first_block_of_the_readme_is_the_demo_and_all_tests() {
    let page = readme();
    assert_eq!(code_blocks(&page)[0], ["cargo run --release -- demo", "cargo test --release --workspace"]);
}

#[test]
fn every_sinew_command_of_the_readme_is_understood() {
    let page = readme();
    let mut count = 0;
    for line in code_blocks(&page).concat() {
        let Some(arguments) = line.strip_prefix("cargo run --release -- ") else { continue };
        let words = arguments.split_whitespace().take_while(|word| !matches!(*word, "#" | ">"));
        parse(words).unwrap_or_else(|error| panic!("{line}\n{error}"));
        count += 1;
    }
    assert!(count >= 6, "only {count} commands");
}

#[test]
fn every_sinew_command_of_the_pages_for_users_is_understood() {
    let pages = [
        ("coach.md", 5),
        ("batch.md", 1),
        ("keypoints.md", 5),
        ("report.md", 3),
        ("first_run.md", 7),
        ("track_arm.md", 3),
        ("tuning.md", 4),
        ("pictures.md", 8),
        ("viewer.md", 3),
        ("command.md", 4),
        ("interruptions.md", 2),
    ];
    for (name, least) in pages {
        let page = fs::read_to_string(workspace_root().join("docs").join(name)).unwrap();
        let commands: Vec<&str> = page.lines().filter_map(|line| line.strip_prefix("    sinew ")).collect();
        assert!(commands.len() >= least, "{name}: only {} commands", commands.len());
        for command in commands {
            let words = command.split_whitespace().take_while(|word| *word != "|");
            parse(words).unwrap_or_else(|error| panic!("{name}: {command}\n{error}"));
        }
    }
}

fn pages(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    entries.filter(|path| path.extension().is_some_and(|extension| extension == "md")).collect()
}

/// Targets of `[text](target)` and `![text](target)` that are neither web addresses nor anchors of
/// the same page.
fn links(page: &str) -> Vec<&str> {
    let targets = page.split("](").skip(1).filter_map(|rest| rest.split_once(')'));
    targets.map(|(target, _)| target).filter(|target| !target.contains("://") && !target.starts_with('#')).collect()
}

/// A heading's anchor, as hosts of Markdown form it.
fn anchor(heading: &str) -> String {
    let kept = heading.trim_start_matches('#').trim().to_lowercase();
    let kept = kept.chars().filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_'));
    kept.map(|c| if c == ' ' { '-' } else { c }).collect()
}

#[test]
fn links_between_pages_lead_somewhere() {
    let root = workspace_root();
    let mut checked = 0;
    for page in ["", "core", "docs"].iter().flat_map(|folder| pages(&root.join(folder))) {
        for link in links(&fs::read_to_string(&page).unwrap()) {
            let (path, wanted) = link.split_once('#').unwrap_or((link, ""));
            let target = page.parent().unwrap().join(path);
            assert!(target.exists(), "{}: `{link}` does not exist", page.display());
            if !wanted.is_empty() {
                let text = fs::read_to_string(&target).unwrap();
                let found = text.lines().filter(|line| line.starts_with('#')).any(|line| anchor(line) == wanted);
                assert!(found, "{}: `{link}` has no such heading", page.display());
            }
            checked += 1;
        }
    }
    assert!(checked > 30, "only {checked} links");
}

/// Whether a file of `folder`, or of those below, holds a compiled example.
fn has_example(folder: &Path) -> bool {
    let compiled = |path: &Path| {
        let text = fs::read_to_string(path).unwrap();
        text.lines().any(|line| matches!(line.trim_start(), "//! ```" | "/// ```"))
    };
    let mut entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    entries.any(|path| if path.is_dir() { has_example(&path) } else { compiled(&path) })
}

#[test]
fn every_public_module_of_the_core_has_a_compiled_example() {
    let core = workspace_root().join("core/src");
    let library = fs::read_to_string(core.join("lib.rs")).unwrap();
    let modules: Vec<&str> =
        library.lines().filter_map(|line| line.strip_prefix("pub mod ")?.strip_suffix(';')).collect();
    assert!(modules.len() > 10, "{modules:?}");
    let has = |name: &str| {
        let file = core.join(format!("{name}.rs"));
        let text = fs::read_to_string(file).unwrap_or_default();
        text.contains("/// ```\n")
            || text.contains("//! ```\n")
            || (core.join(name).is_dir() && has_example(&core.join(name)))
    };
    // The interface for C has its examples in C.
    let without: Vec<&str> = modules.into_iter().filter(|name| *name != "c_api" && !has(name)).collect();
    assert!(without.is_empty(), "without an example: {without:?}");
    for main in ["tracker/cyclic/mod", "tracker/body/mod", "tracker/arm/pair", "vision/front_end/mod"] {
        assert!(fs::read_to_string(core.join(format!("{main}.rs"))).unwrap().contains("//! ```\n"), "{main}");
    }
}

/// Largest number of lines of a page of the book.
const MAX_PAGE_LINES: usize = 200;
/// Largest width of a line of prose, characters.
const MAX_PROSE_COLUMNS: usize = 100;
/// Private metaphors, and words of a diary, which the book does without.
const AVOIDED_WORDS: [&str; 15] = [
    "tells",
    "told",
    "lean on",
    "leans on",
    "let loose",
    "laid onto",
    "pays for",
    "nobody",
    "from afar",
    "otherwise",
    "at first it",
    "since then",
    "as it was",
    "no longer",
    "used to be",
];

/// Pages of the book with their names; the list of pages is left out.
fn book() -> Vec<(String, String)> {
    let pages = pages(&workspace_root().join("docs")).into_iter();
    let named =
        pages.map(|path| (path.file_name().unwrap().to_str().unwrap().to_owned(), fs::read_to_string(&path).unwrap()));
    named.filter(|(name, _)| name != "SUMMARY.md").collect()
}

/// Lines of a page outside of code blocks and of what commands write, with their numbers.
fn prose(page: &str) -> Vec<(usize, &str)> {
    let (mut in_code, mut in_marks) = (false, false);
    let mut kept = Vec::new();
    for (index, line) in page.lines().enumerate() {
        if line.starts_with("```") {
            in_code = !in_code;
        } else if line.starts_with("<!-- ") {
            in_marks = !line.starts_with("<!-- end of ");
        } else if !in_code && !in_marks && !line.starts_with("    ") {
            kept.push((index + 1, line));
        }
    }
    kept
}

#[test]
fn every_page_of_the_book_is_short() {
    for (name, page) in book() {
        let lines = page.lines().count();
        assert!(lines <= MAX_PAGE_LINES, "{name} has {lines} lines");
    }
}

/// Pages beside the book. Entries of CHANGELOG have a rule of their own, notices are quoted.
const OTHER_PAGES: [&str; 6] =
    ["README.md", "CONTRIBUTING.md", "SECURITY.md", "CODE_OF_CONDUCT.md", "core/README.md", "host/README.md"];

/// Tables, headings, marks and pictures are free, and so is a line of one word, which no break
/// makes shorter.
#[test]
fn prose_of_all_pages_is_wrapped() {
    let read = |name: &str| (name.to_owned(), fs::read_to_string(workspace_root().join(name)).unwrap());
    for (name, page) in book().into_iter().chain(OTHER_PAGES.map(read)) {
        for (number, line) in prose(&page) {
            let free = line.trim_start().starts_with(['|', '#', '<', '!']) || !line.trim().contains(' ');
            let width = line.chars().count();
            assert!(free || width <= MAX_PROSE_COLUMNS, "{name}:{number} has {width} columns");
        }
    }
}

#[test]
fn the_book_uses_the_terms_of_the_field_and_the_present() {
    for (name, page) in book() {
        let text = prose(&page).iter().map(|(_, line)| line.trim()).collect::<Vec<_>>().join(" ").to_lowercase();
        let text: String = text.chars().map(|c| if c.is_alphanumeric() || c == '_' { c } else { ' ' }).collect();
        let words = format!(" {} ", text.split_whitespace().collect::<Vec<_>>().join(" "));
        let found: Vec<&str> = AVOIDED_WORDS.into_iter().filter(|word| words.contains(&format!(" {word} "))).collect();
        assert!(found.is_empty(), "{name}: {found:?}");
    }
}

/// Tables that a command writes stand between `<!-- table NAME -->` and `<!-- end of NAME -->`.
#[test]
fn marks_of_tables_come_in_pairs_with_a_table_between() {
    let mut names = std::collections::BTreeSet::new();
    for (file, page) in book() {
        let mut rest = page.as_str();
        while let Some((_, after)) = rest.split_once("\n<!-- table ") {
            let (name, after) = after.split_once(" -->\n").unwrap_or_else(|| panic!("{file}: an open mark"));
            let end = format!("\n<!-- end of {name} -->\n");
            let (table, after) = after.split_once(&end).unwrap_or_else(|| panic!("{file}: {name} has no end"));
            let lines = table.lines().filter(|line| !line.is_empty());
            assert!(lines.clone().count() > 2 && lines.clone().all(|line| line.starts_with('|')), "{file}: {name}");
            assert!(names.insert(name.to_owned()), "{file}: {name} stands twice");
            rest = after;
        }
    }
    assert!(names.len() >= 15, "only {names:?}");
}

/// Names and values of the filter's chosen numbers, in the order of its file.
#[test]
fn the_book_has_each_constant_of_the_phase_coupled_filter() {
    let read = |path: &str| fs::read_to_string(workspace_root().join(path)).unwrap();
    let source = read("core/src/cyclic/coupled/constants.rs");
    let declared = source.lines().filter_map(|line| {
        let (name, value) = line.strip_prefix("pub(super) const ")?.strip_suffix(';')?.split_once(" = ")?;
        Some((name.split_once(':')?.0.to_owned(), value.to_owned()))
    });
    let page = read("docs/cyclic_coupled_constants.md");
    let listed = page.lines().filter_map(|line| {
        let (name, rest) = line.strip_prefix("| `")?.split_once("` | ")?;
        Some((name.to_owned(), rest.split_once(" | ")?.0.to_owned()))
    });
    let declared: Vec<_> = declared.collect();
    assert!(declared.len() > 20 && page.contains(&format!("{} numbers are", declared.len())));
    assert_eq!(listed.collect::<Vec<_>>(), declared);
}
