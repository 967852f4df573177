//! The book: every page of docs/ has a place in SUMMARY.md and every entry a page, pictures exist
//! and say where they come from.

use sinew_tests::workspace_root;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// Largest size of all pictures together, bytes.
const MAX_PICTURES_BYTES: u64 = 600_000;

fn docs() -> PathBuf {
    workspace_root().join("docs")
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Files below `folder` with one of the endings, by their path relative to docs/. The built book is
/// left out.
fn files(folder: &Path, endings: &[&str], found: &mut BTreeSet<String>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            if path != docs().join("book") {
                files(&path, endings, found);
            }
        } else if endings.iter().any(|ending| path.extension().is_some_and(|extension| extension == *ending)) {
            found.insert(path.strip_prefix(docs()).unwrap().to_str().unwrap().replace('\\', "/"));
        }
    }
}

/// Targets of links and pictures.
fn targets(page: &str) -> impl Iterator<Item = &str> {
    page.split("](").skip(1).filter_map(|rest| Some(rest.split_once(')')?.0))
}

#[test]
fn every_page_is_in_the_summary_once_and_every_entry_is_a_page() {
    let summary = read(&docs().join("SUMMARY.md"));
    let entries: Vec<&str> = targets(&summary).collect();
    let listed: BTreeSet<String> = entries.iter().map(|&entry| entry.to_owned()).collect();
    assert_eq!(listed.len(), entries.len(), "an entry of SUMMARY.md stands there twice");

    let mut pages = BTreeSet::new();
    files(&docs(), &["md"], &mut pages);
    assert!(pages.remove("SUMMARY.md"));
    assert_eq!(listed.difference(&pages).collect::<Vec<_>>(), Vec::<&String>::new(), "entries without a page");
    assert_eq!(pages.difference(&listed).collect::<Vec<_>>(), Vec::<&String>::new(), "pages without an entry");
    assert!(pages.len() > 30, "only {} pages", pages.len());
}

#[test]
fn the_book_begins_with_the_first_run_and_comes_to_firmware_after_the_limits() {
    let summary = read(&docs().join("SUMMARY.md"));
    let place = |page: &str| summary.find(page).unwrap_or_else(|| panic!("{page} is not in SUMMARY.md"));
    let order =
        ["first_run.md", "report.md", "tuning.md", "limits.md", "comparison.md", "firmware.md", "architecture.md"];
    assert!(order.windows(2).all(|pair| place(pair[0]) < place(pair[1])), "{order:?}");
}

#[test]
fn every_page_has_one_title_and_it_comes_first() {
    let mut pages = BTreeSet::new();
    files(&docs(), &["md"], &mut pages);
    for page in pages {
        let text = read(&docs().join(&page));
        assert!(text.starts_with("# "), "{page} does not begin with a title");
    }
}

#[test]
fn every_picture_is_shown_with_its_command() {
    let mut pictures = BTreeSet::new();
    files(&docs(), &["png", "jpg", "jpeg", "gif", "svg"], &mut pictures);
    assert!(pictures.len() >= 8, "only {} pictures", pictures.len());
    let bytes: u64 = pictures.iter().map(|picture| fs::metadata(docs().join(picture)).unwrap().len()).sum();
    assert!(bytes < MAX_PICTURES_BYTES, "the pictures have {bytes} bytes together");

    let mut pages = BTreeSet::new();
    files(&docs(), &["md"], &mut pages);
    let text = read(&docs().join("pictures.md"));
    let mut shown = BTreeSet::new();
    for page in &pages {
        let text = read(&docs().join(page));
        let folder = Path::new(page).parent().unwrap().to_path_buf();
        shown.extend(targets(&text).map(|target| folder.join(target).to_str().unwrap().to_owned()));
    }
    for picture in pictures {
        assert!(shown.contains(&picture), "no page shows {picture}");
        let name = picture.strip_prefix("pictures/").unwrap_or_else(|| panic!("{picture} lies outside of pictures/"));
        assert!(text.contains(&format!("`{name}`")), "pictures.md does not name what makes {name}");
    }
}

#[test]
fn links_stay_inside_of_the_book() {
    let mut pages = BTreeSet::new();
    files(&docs(), &["md"], &mut pages);
    for page in &pages {
        for target in targets(&read(&docs().join(page))).filter(|target| !target.contains("://")) {
            assert!(!target.starts_with(".."), "{page}: `{target}` would lead nowhere in the built book");
        }
    }
}

#[test]
fn the_settings_of_the_book_leave_the_pages_where_they_are() {
    let settings = read(&docs().join("book.toml"));
    assert!(settings.contains("\nsrc = \".\"\n"), "{settings}");
    // A summary with an entry too many would make an empty page.
    assert!(settings.contains("\ncreate-missing = false\n"), "{settings}");
}
