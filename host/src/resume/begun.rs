//! How a run was begun, so that it is gone on with in the same way only.

use super::REMEDY;
use crate::error::{Context, Result, bail, ensure};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::time::UNIX_EPOCH;

/// Layout in which this is kept: of its own fields, and of the options. Options are named as in a
/// configuration file, so a new name of a key is a new layout.
const VERSION: u32 = 4;

/// Command, version, options and inputs of a run.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Begun {
    version: u32,
    sinew_version: String,
    /// The subcommand, as `track arm`.
    command: String,
    /// All options that change the results, but `input`.
    options: Value,
    /// What is worked on, absolute; none where that is among the options.
    input: Option<PathBuf>,
    /// What distinguishes its frames from others.
    frames: Vec<String>,
    /// CRC-32 of whatever else is read, by what it is called.
    read_crc32: BTreeMap<String, u32>,
}

impl Begun {
    /// A run of `command` with `options`, without those at the top that `leave_out` names.
    ///
    /// # Errors
    /// None for options that JSON can hold.
    pub fn new(command: &str, options: &impl Serialize, leave_out: &[&str]) -> Result<Self> {
        // By way of text, as what is read from a file.
        let mut options: Value = serde_json::from_str(&serde_json::to_string(options)?)?;
        if let Some(map) = options.as_object_mut() {
            leave_out.iter().for_each(|name| drop(map.remove(*name)));
        }
        Ok(Self {
            version: VERSION,
            sinew_version: env!("CARGO_PKG_VERSION").to_owned(),
            command: command.to_owned(),
            options,
            input: None,
            frames: Vec::new(),
            read_crc32: BTreeMap::new(),
        })
    }

    /// The same, working on the file or folder `input`.
    ///
    /// # Errors
    /// There is no such path.
    pub fn on(mut self, input: &Path) -> Result<Self> {
        self.input = Some(absolute(input)?);
        Ok(self)
    }

    /// The same with these frames.
    #[must_use]
    pub fn with_frames(mut self, frames: Vec<String>) -> Self {
        self.frames = frames;
        self
    }

    /// The same, having read what is called `name` and has this checksum.
    #[must_use]
    pub fn reading(mut self, name: impl Into<String>, crc32: u32) -> Self {
        self.read_crc32.insert(name.into(), crc32);
        self
    }

    /// The subcommand.
    pub(super) fn command(&self) -> &str {
        &self.command
    }

    /// Whether `value` is one of this version, whose fields can be relied on.
    ///
    /// # Errors
    /// It is not, or it belongs to another command; `path` is where it stands.
    pub(super) fn check_kind(value: &Value, command: &str, path: &Path) -> Result<()> {
        ensure!(
            value["version"] == VERSION,
            "`{}` has layout {} of options, and this sinew reads layout {VERSION}, in which `[tracker]` has sections; {REMEDY}",
            path.display(),
            value["version"]
        );
        ensure!(
            value["sinew_version"] == env!("CARGO_PKG_VERSION"),
            "`{}` was written by sinew {}, and this is {}; {REMEDY}",
            path.display(),
            value["sinew_version"].as_str().unwrap_or("of another version"),
            env!("CARGO_PKG_VERSION")
        );
        ensure!(
            value["command"] == command,
            "`{}` was left by `sinew {}`, not by `sinew {command}`; {REMEDY}",
            path.display(),
            value["command"].as_str().unwrap_or_default()
        );
        Ok(())
    }

    /// Refuses options and a place of the input that would give other results than the run in `out`
    /// was begun for.
    ///
    /// # Errors
    /// Names the first difference.
    pub fn check_options(&self, now: &Self, out: &Path) -> Result<()> {
        if let Some((name, before, now)) = first_difference(&self.options, &now.options, String::new()) {
            bail!(
                "the run in `{}` was begun with {name} = {before}, not {now}; give the same, or {REMEDY}",
                out.display()
            );
        }
        let name = |input: &Option<PathBuf>| input.clone().unwrap_or_default().display().to_string();
        ensure!(
            self.input == now.input,
            "the run in `{}` was begun on `{}`, not on `{}`; give the same, or {REMEDY}",
            out.display(),
            name(&self.input),
            name(&now.input)
        );
        Ok(())
    }

    /// Refuses frames and other inputs that are not as they were.
    ///
    /// # Errors
    /// Names the first that is another.
    pub fn check_inputs(&self, now: &Self) -> Result<()> {
        let (before, frames) = (&self.frames, &now.frames);
        if before != frames {
            let place = before.iter().zip(frames).position(|(a, b)| a != b).unwrap_or(before.len().min(frames.len()));
            let name = |files: &[String]| files.get(place).cloned().unwrap_or_else(|| "none".to_owned());
            bail!(
                "the frames of `{}` have changed: number {place} was {} and is {}; {REMEDY}",
                self.input.as_deref().unwrap_or(Path::new("")).display(),
                name(before),
                name(frames)
            );
        }
        let all = self.read_crc32.keys().chain(now.read_crc32.keys());
        match all.into_iter().find(|name| self.read_crc32.get(*name) != now.read_crc32.get(*name)) {
            Some(name) => bail!("{name} is not as it was when the run was begun; {REMEDY}"),
            None => Ok(()),
        }
    }
}

/// The path of what is read, from the root.
///
/// # Errors
/// There is no such file or folder.
pub fn absolute(input: &Path) -> Result<PathBuf> {
    input.canonicalize().with_context(|| format!("`{}` cannot be found; give what is to be read", input.display()))
}

/// The name of the first option that differs, and its two values.
fn first_difference(before: &Value, now: &Value, name: String) -> Option<(String, Value, Value)> {
    let (Some(old), Some(new)) = (before.as_object(), now.as_object()) else {
        return (before != now).then(|| (name, before.clone(), now.clone()));
    };
    let below = |key: &str| if name.is_empty() { key.to_owned() } else { format!("{name}.{key}") };
    let keys = old.keys().chain(new.keys().filter(|key| !old.contains_key(*key)));
    let value = |map: &serde_json::Map<String, Value>, key: &str| map.get(key).cloned().unwrap_or(Value::Null);
    keys.into_iter().find_map(|key| first_difference(&value(old, key), &value(new, key), below(key)))
}

/// What tells the content of `file` from another without reading it: name, size and time of the
/// last change.
#[must_use]
pub fn identity(file: &Path) -> String {
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    let facts = std::fs::metadata(file).ok();
    let changed = facts.as_ref().and_then(|facts| facts.modified().ok()?.duration_since(UNIX_EPOCH).ok());
    let (bytes, changed_s) = (facts.map_or(0, |facts| facts.len()), changed.unwrap_or_default().as_secs_f64());
    format!("{name} ({bytes} bytes, changed {changed_s:.3} s after 1970)")
}

/// CRC-32 of a file's bytes.
///
/// # Errors
/// The file cannot be read.
pub fn file_crc32(path: &Path) -> Result<u32> {
    let inner = || -> Result<u32> {
        let (mut file, mut hasher, mut buffer) = (File::open(path)?, crc32fast::Hasher::new(), vec![0; 1 << 16]);
        loop {
            let count = file.read(&mut buffer)?;
            if count == 0 {
                return Ok(hasher.finalize());
            }
            hasher.update(&buffer[..count]);
        }
    };
    inner().with_context(|| format!("`{}` cannot be read; {REMEDY}", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn a_layout_with_flat_options_is_refused_by_name() {
        let begun = Begun::new("track arm", &json!({ "config": { "tracker": { "gate_std_m": 0.8 } } }), &[]).unwrap();
        let mut value = serde_json::to_value(begun).unwrap();
        let check = |value: &Value| Begun::check_kind(value, "track arm", Path::new("resume.json"));
        check(&value).unwrap();
        value["version"] = json!(2);
        let message = check(&value).unwrap_err().to_string();
        assert!(
            message.contains("has layout 2 of options")
                && message.contains("`[tracker]` has sections")
                && message.contains(REMEDY),
            "{message}"
        );
    }

    #[test]
    fn the_first_difference_is_named_with_its_section() {
        let old = json!({ "a": 1, "b": { "c": 0.5, "d": [1, 2] } });
        let difference = |new: Value| first_difference(&old, &new, String::new());
        assert_eq!(difference(old.clone()), None);
        let (name, before, now) = difference(json!({ "a": 1, "b": { "c": 0.5, "d": [1, 3] } })).unwrap();
        assert_eq!((name.as_str(), before, now), ("b.d", json!([1, 2]), json!([1, 3])));
        let (name, before, now) = difference(json!({ "a": 1, "b": { "c": 0.5 } })).unwrap();
        assert_eq!((name.as_str(), before, now), ("b.d", json!([1, 2]), Value::Null));
        assert_eq!(difference(json!({ "a": 1, "b": { "c": 0.5, "d": [1, 2] }, "e": true })).unwrap().0, "e");
    }

    #[test]
    fn what_was_read_is_compared_by_name() {
        let new = || Begun::new("track body", &json!({ "seed": 1, "threads": 2 }), &["threads"]).unwrap();
        let checked = |now: &Begun| new().reading("the stick", 7).check_inputs(now).map_err(|error| error.to_string());
        assert_eq!(checked(&new().reading("the stick", 7)), Ok(()));
        assert!(checked(&new().reading("the stick", 8)).unwrap_err().contains("the stick is not as it was"));
        assert!(checked(&new()).unwrap_err().contains("the stick is not as it was"));
        assert!(
            checked(&new().reading("the stick", 7).with_frames(vec!["0.ply".into()])).unwrap_err().contains("0.ply")
        );
        let other = Begun::new("track body", &json!({ "seed": 1, "threads": 3 }), &["threads"]).unwrap();
        new().check_options(&other, Path::new("out")).unwrap();
    }
}
