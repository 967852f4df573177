//! Cells of an evaluation: each is kept as it ends, so that an evaluation which was broken off goes
//! on with the missing ones.

use super::{Begun, Interrupted, REMEDY};
use crate::error::{Context, Error, Result, WriteContext};
use crate::file::read_text;
use crate::json_file::read_json;
use crate::output::{OutputDir, OutputLock};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use std::fmt::{self, Debug};
use std::fs;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

/// The folder of the cells, in that of the results.
pub const CELLS_FOLDER: &str = "unfinished";
/// How the evaluation was begun.
const BEGUN: &str = "begun.json";

/// Whether an evaluation is to end before its next cell.
pub type Stop<'a> = &'a (dyn Fn() -> bool + Sync);

/// The cells of one evaluation.
#[derive(Default)]
pub struct Cells<'a> {
    kept: Option<Kept<'a>>,
    finished: AtomicUsize,
}

struct Kept<'a> {
    out: PathBuf,
    _lock: OutputLock,
    folder: OutputDir,
    stop: Stop<'a>,
}

impl Debug for Cells<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let out = self.kept.as_ref().map(|kept| &kept.out);
        formatter.debug_struct("Cells").field("out", &out).field("finished", &self.finished).finish()
    }
}

/// A cell in its file.
#[derive(Debug, Serialize, Deserialize)]
struct Cell<K, T> {
    /// All that decides the value, beside how the evaluation was begun.
    key: K,
    value: T,
}

impl<'a> Cells<'a> {
    /// Cells that are not kept.
    #[must_use]
    pub fn not_kept() -> Self {
        Self::default()
    }

    /// Keeps cells below `out` until [`Cells::end`]; no more are measured once `stop` says so. With
    /// `resume` those that an evaluation begun in the same way left there are taken for
    /// measured. Without it they are removed.
    ///
    /// # Errors
    /// Nothing to resume in `out`, or it was begun with other options, by another command or
    /// version; a folder that cannot be written.
    pub fn keep(out: &OutputDir, begun: &Begun, resume: bool, stop: Stop<'a>) -> Result<Self> {
        let path = out.join(CELLS_FOLDER);
        if resume {
            Self::check(&path.join(BEGUN), begun, out.path())?;
        }
        let lock = OutputLock::of_folder(out.path(), begun.command())?;
        lock.sweep(&path);
        if !resume {
            remove(&path)?;
        }
        let folder = out.subfolder(CELLS_FOLDER)?;
        folder.write(BEGUN, |writer| Ok(serde_json::to_writer_pretty(writer, begun)?))?;
        let kept = Kept { out: out.path().to_path_buf(), _lock: lock, folder, stop };
        Ok(Self { kept: Some(kept), finished: AtomicUsize::new(0) })
    }

    fn check(path: &Path, now: &Begun, out: &Path) -> Result<()> {
        let text = read_text(path).with_context(|| {
            format!("`{}` holds no unfinished evaluation (no `{}`); {REMEDY}", out.display(), path.display())
        })?;
        let value: Value =
            serde_json::from_str(&text).with_context(|| format!("`{}` is not JSON; {REMEDY}", path.display()))?;
        Begun::check_kind(&value, now.command(), path)?;
        let before: Begun =
            serde_json::from_value(value).with_context(|| format!("`{}` is not whole; {REMEDY}", path.display()))?;
        before.check_options(now, out)?;
        before.check_inputs(now)
    }

    /// The value of a cell: that which was kept under `key`, or else what `measure` gives, which is
    /// then kept. A cell whose file cannot be used is measured.
    ///
    /// # Errors
    /// As `measure`; [`Interrupted`] once `stop` says so; a file that cannot be written.
    pub fn cell<T, E>(&self, key: &Value, measure: impl FnOnce() -> Result<T, E>) -> Result<T, E>
    where
        T: Serialize + DeserializeOwned,
        E: From<Error>,
    {
        let Some(kept) = &self.kept else { return measure() };
        let name = format!("{:016x}.json", hash(key));
        let known = || -> Option<T> {
            // As values: numbers are parsed exactly.
            let cell: Cell<Value, Value> = read_json(&kept.folder.join(&name)).ok()?;
            (cell.key == *key).then(|| serde_json::from_value(cell.value).ok())?
        };
        let value = match known() {
            Some(value) => value,
            None => {
                self.go_on()?;
                let value = measure()?;
                let cell = Cell { key, value: &value };
                kept.folder.write(&name, |writer| Ok(serde_json::to_writer(writer, &cell)?))?;
                value
            }
        };
        self.finished.fetch_add(1, Ordering::Relaxed);
        Ok(value)
    }

    /// Whether there is still work to be done.
    ///
    /// # Errors
    /// [`Interrupted`] once `stop` says so.
    pub fn go_on(&self) -> Result<()> {
        match &self.kept {
            Some(kept) if (kept.stop)() => {
                let finished = self.finished.load(Ordering::Relaxed);
                Err(Interrupted { finished, all: None, unit: "cells", out: kept.out.clone() }.into())
            }
            _ => Ok(()),
        }
    }

    /// Takes the kept cells away: what they were measured for is written.
    ///
    /// # Errors
    /// A file that cannot be removed.
    pub fn end(self) -> Result<()> {
        self.kept.map_or(Ok(()), |kept| remove(kept.folder.path()))
    }
}

/// Removes a folder of cells, if there is one; other files stay, and their folder.
fn remove(folder: &Path) -> Result<()> {
    let Ok(files) = fs::read_dir(folder) else { return Ok(()) };
    let inner = || -> std::io::Result<()> {
        for file in files {
            let path = file?.path();
            let name = path.file_stem().unwrap_or_default().to_string_lossy();
            let is_cell = name.len() == 16 && name.bytes().all(|byte| byte.is_ascii_hexdigit());
            if is_cell || path.ends_with(BEGUN) {
                fs::remove_file(&path)?;
            }
        }
        Ok(())
    };
    inner().writing(|| format!("`{}` cannot be emptied; remove it", folder.display()))?;
    // What is not from here stays.
    let _ = fs::remove_dir(folder);
    Ok(())
}

fn hash(key: &Value) -> u64 {
    let mut hasher = DefaultHasher::new();
    key.to_string().hash(&mut hasher);
    hasher.finish()
}

/// A key's part that stands for data: CRC-32 of how they are written for programmers, which differs
/// for any two numbers.
#[must_use]
pub fn crc32_of(data: &impl Debug) -> Value {
    json!(super::text_crc32(&format!("{data:?}")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::AtomicBool;

    #[test]
    fn cells_are_measured_once_and_kept_exactly() {
        let folder = tempfile::tempdir().unwrap();
        let out = OutputDir::create(folder.path()).unwrap();
        let ended = AtomicBool::new(false);
        let stop = || ended.load(Ordering::Relaxed);
        let begun = |seed: u64| Begun::new("evaluate arm", &json!({ "seed": seed }), &[]).unwrap();
        let never = || -> Result<f64> { panic!("it is known") };
        let third: f64 = 1.0 / 3.0;
        let cells = Cells::keep(&out, &begun(1), false, &stop).unwrap();
        assert_eq!(cells.cell(&json!(["a", 1]), || -> Result<f64> { Ok(third) }).unwrap(), third);
        assert_eq!(cells.cell(&json!(["a", 1]), never).unwrap().to_bits(), third.to_bits());
        assert!(cells.cell(&json!(["b", 1]), || -> Result<f64> { Ok(f64::NAN) }).unwrap().is_nan());
        ended.store(true, Ordering::Relaxed);
        let error = cells.cell(&json!(["a", 2]), never).unwrap_err();
        assert_eq!(error.interrupted().unwrap().finished, 3);
        assert_eq!(cells.cell(&json!(["a", 1]), never).unwrap(), third, "a known cell is returned");
        ended.store(false, Ordering::Relaxed);
        drop(cells);

        // As a process leaves it that is killed while it writes.
        let left = out.join(CELLS_FOLDER).join(".sinew-cell.json-abc");
        fs::write(&left, "{").unwrap();
        let again = Cells::keep(&out, &begun(1), true, &stop).unwrap();
        assert!(!left.exists());
        assert_eq!(again.cell(&json!(["a", 1]), never).unwrap().to_bits(), third.to_bits());
        assert_eq!(
            again.cell(&json!(["b", 1]), || -> Result<f64> { Ok(2.0) }).unwrap(),
            2.0,
            "what JSON cannot hold is measured again"
        );
        let message = Cells::keep(&out, &begun(2), true, &stop).unwrap_err().to_string();
        assert!(message.contains("begun with seed = 1, not 2") && message.contains(REMEDY), "{message}");
        fs::write(out.join("unfinished/notes.txt"), "mine").unwrap();
        again.end().unwrap();
        assert_eq!(fs::read_dir(out.join(CELLS_FOLDER)).unwrap().count(), 1);
        let message = Cells::keep(&out, &begun(1), true, &stop).unwrap_err().to_string();
        assert!(message.contains("holds no unfinished evaluation"), "{message}");
        assert_eq!(Cells::not_kept().cell(&json!(1), || -> Result<u8> { Ok(3) }).unwrap(), 3);
    }
}
