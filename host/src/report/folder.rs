//! A run directory, read with patience: what cannot be read becomes a notice.

use super::document::{Level, Notice};
use super::table::Table;
use crate::file::read_bytes;
use crate::limits::MAX_FILE_BYTES;
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};

/// Text of a table that a page takes; of a longer one only every n-th frame is kept.
const TABLE_BYTES: usize = 6 << 20;

/// A run directory and what was noticed while it was read.
#[derive(Debug)]
pub struct RunFolder {
    path: PathBuf,
    notices: Vec<Notice>,
}

impl RunFolder {
    /// Of the folder `path`.
    #[must_use]
    pub fn new(path: &Path) -> Self {
        Self { path: path.to_path_buf(), notices: Vec::new() }
    }

    /// The folder.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Whether there is a file or folder of this name.
    #[must_use]
    pub fn has(&self, name: &str) -> bool {
        self.path.join(name).exists()
    }

    /// Names of the entries, in natural order.
    #[must_use]
    pub fn names(&self) -> Vec<String> {
        names_in(&self.path)
    }

    /// Adds a notice.
    pub fn notice(&mut self, level: Level, text: impl Into<String>) {
        self.notices.push(Notice { level, text: text.into(), items: Vec::new() });
    }

    /// Adds a notice about several things, if there are any.
    pub fn notice_of(&mut self, level: Level, text: impl Into<String>, items: Vec<String>) {
        if !items.is_empty() {
            self.notices.push(Notice { level, text: text.into(), items });
        }
    }

    /// All notices so far, the weightiest first.
    #[must_use]
    pub fn into_notices(mut self) -> Vec<Notice> {
        self.notices.sort_by_key(|notice| notice.level);
        self.notices
    }

    /// Reads the JSON file `name`, which such a run has.
    pub fn json(&mut self, name: &str) -> Option<Value> {
        let path = self.path.join(name);
        if !path.exists() {
            self.notice(
                Level::Missing,
                format!("{name} is not there: the run ended early, or the file was taken away"),
            );
            return None;
        }
        let parsed = read_regular(&path);
        match parsed.and_then(|bytes| serde_json::from_slice(&bytes).map_err(|error| error.to_string())) {
            Ok(value) => Some(value),
            Err(reason) => {
                self.notice(Level::Missing, format!("{name} cannot be read ({reason}); what it says is missing here"));
                None
            }
        }
    }

    /// Reads the CSV file `name`, which such a run has.
    pub fn table(&mut self, name: &str, title: &str) -> Option<Table> {
        if !self.has(name) {
            self.notice(
                Level::Missing,
                format!("{name} is not there: the run ended early, or the file was taken away"),
            );
            return None;
        }
        self.table_at(&self.path.join(name), name, title)
    }

    /// Reads the CSV file `name` if it is there.
    pub fn optional_table(&mut self, name: &str, title: &str) -> Option<Table> {
        if self.has(name) { self.table(name, title) } else { None }
    }

    /// Reads the CSV file `name`, which such a run has with a row for each frame, and says so where
    /// frames have none.
    pub fn table_of_all_frames(&mut self, name: &str, title: &str) -> Option<Table> {
        if !self.has(name) {
            return self.table(name, title);
        }
        let read = self.read_at(&self.path.join(name), name, title)?;
        let gaps = read.0.frame_gaps();
        let items = gaps.iter().map(|[first, last]| match last - first {
            0 => format!("frame {first}"),
            _ => format!("frames {first} to {last}"),
        });
        let what = format!("doubt: {name} jumps over frames, which are drawn as gaps; the file is not the whole track");
        self.notice_of(Level::Warning, what, items.collect());
        Some(self.shortened(read))
    }

    /// Reads a CSV file that may lie elsewhere, as the table `name`.
    pub fn table_at(&mut self, path: &Path, name: &str, title: &str) -> Option<Table> {
        let read = self.read_at(path, name, title)?;
        Some(self.shortened(read))
    }

    /// The table with the length of its text, bytes.
    fn read_at(&mut self, path: &Path, name: &str, title: &str) -> Option<(Table, usize)> {
        let bytes = match read_regular(path) {
            Ok(bytes) => bytes,
            Err(reason) => {
                self.notice(Level::Missing, format!("{name} cannot be read ({reason})"));
                return None;
            }
        };
        let (table, odd) = Table::parse(name, title, &bytes);
        if odd.not_text {
            self.notice(Level::Warning, format!("{name} holds bytes that are no UTF-8; they are shown as \u{fffd}"));
        }
        if odd.ragged_rows > 0 {
            let rows = odd.ragged_rows;
            self.notice(
                Level::Missing,
                format!("{name}: {rows} rows have another number of cells than the heading and are left out"),
            );
        }
        if table.rows.is_empty() {
            self.notice(Level::Missing, format!("{name} has no rows"));
            return None;
        }
        Some((table, bytes.len()))
    }

    /// The table, or of a long one every n-th frame.
    fn shortened(&mut self, (mut table, bytes): (Table, usize)) -> Table {
        let every = bytes.div_ceil(TABLE_BYTES);
        if every > 1 {
            table.thin(every);
            let name = &table.name;
            let text = format!("{name} is long; the page shows one frame of {every}, the file holds them all");
            self.notice(Level::Note, text);
        }
        table
    }

    /// Where a path of a run's record leads: as it stands, or as seen from a folder above the run
    /// directory.
    #[must_use]
    pub fn find(&self, recorded: &str) -> Option<PathBuf> {
        let recorded = Path::new(recorded);
        let absolute = self.path.canonicalize().unwrap_or_else(|_| self.path.clone());
        let above = absolute.ancestors().map(|folder| folder.join(recorded));
        std::iter::once(recorded.to_path_buf()).chain(above.take(6)).find(|path| path.exists())
    }

    /// Says so if the version of a record is not the one that is known.
    pub fn check_version(&mut self, name: &str, record: &Value, known: u64) {
        let version = &record["version"];
        if version.as_u64() != Some(known) {
            let text = format!(
                "{name} has version {version} of its form, this program knows {known}; what can be understood is shown"
            );
            self.notice(Level::Warning, text);
        }
        let (made_by, own) = (record["sinew_version"].as_str(), env!("CARGO_PKG_VERSION"));
        if let Some(other) = made_by.filter(|made_by| *made_by != own) {
            self.notice(Level::Note, format!("the run was made by sinew {other}, the page by sinew {own}"));
        }
    }
}

/// Bytes of a regular file. A link could bring any file of this machine into a page that is sent
/// away.
pub(super) fn read_regular(path: &Path) -> Result<Vec<u8>, String> {
    let facts = fs::symlink_metadata(path).map_err(|error| error.to_string())?;
    if !facts.is_file() {
        return Err("it is a link, or no regular file".to_owned());
    }
    read_bytes(path, MAX_FILE_BYTES).map_err(|error| error.to_string())
}

/// Names of the entries of a folder, in natural order; none of a folder that cannot be read.
#[must_use]
pub fn names_in(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut names: Vec<String> = entries.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    names.sort_by(|a, b| natord::compare(a, b).then_with(|| a.cmp(b)));
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder_with(files: &[(&str, &[u8])]) -> (tempfile::TempDir, RunFolder) {
        let folder = tempfile::tempdir().unwrap();
        for (name, bytes) in files {
            fs::write(folder.path().join(name), bytes).unwrap();
        }
        let run = RunFolder::new(folder.path());
        (folder, run)
    }

    #[test]
    fn whatever_is_wrong_with_a_file_becomes_a_notice() {
        let files: [(&str, &[u8]); 4] =
            [("run.json", b"{\"a\": 1"), ("empty.csv", b""), ("cut.csv", b"a,b\n1,2\n3"), ("b.csv", b"a\n\xff\n")];
        let (_folder, mut run) = folder_with(&files);
        assert!(run.json("run.json").is_none() && run.json("error.json").is_none());
        assert!(run.table("track.csv", "").is_none() && run.table("empty.csv", "").is_none());
        assert_eq!(run.table("cut.csv", "").unwrap().rows.len(), 1);
        assert_eq!(run.table("b.csv", "").unwrap().rows.len(), 1);
        assert!(run.optional_table("truth.csv", "").is_none());
        let notices = run.into_notices();
        let texts: Vec<&str> = notices.iter().map(|notice| notice.text.as_str()).collect();
        assert_eq!(texts.len(), 6, "{texts:?}");
        for (text, start) in
            texts.iter().zip(["run.json cannot", "error.json is not", "track.csv is not", "empty.csv has"])
        {
            assert!(text.starts_with(start), "{texts:?}");
        }
        assert_eq!(notices[5].level, Level::Warning);
    }

    #[cfg(unix)]
    #[test]
    fn a_link_is_left_out() {
        let (folder, mut run) = folder_with(&[("secret.csv", b"a\n1\n")]);
        std::os::unix::fs::symlink("secret.csv", folder.path().join("track.csv")).unwrap();
        assert!(run.table("track.csv", "").is_none() && run.table("secret.csv", "").is_some());
        assert!(run.into_notices()[0].text.contains("it is a link"));
    }

    #[test]
    fn a_recorded_path_is_found_from_a_folder_above() {
        let root = tempfile::tempdir().unwrap();
        fs::create_dir_all(root.path().join("out/run")).unwrap();
        fs::create_dir_all(root.path().join("scene")).unwrap();
        fs::write(root.path().join("scene/truth.csv"), "frame\n").unwrap();
        let run = RunFolder::new(&root.path().join("out/run"));
        let found = run.find("scene/truth.csv").unwrap().canonicalize().unwrap();
        assert_eq!(found, root.path().join("scene/truth.csv").canonicalize().unwrap());
        assert!(run.find("scene/other.csv").is_none());
    }

    #[test]
    fn another_version_is_reported() {
        let (_folder, mut run) = folder_with(&[]);
        run.check_version("run.json", &serde_json::json!({"version": 9, "sinew_version": "9.0"}), 1);
        run.check_version("run.json", &serde_json::json!({"version": 1}), 1);
        let notices = run.into_notices();
        assert_eq!(notices.len(), 2);
        assert!(notices[0].text.contains("version 9") && notices[1].text.contains("sinew 9.0"));
    }
}
