//! What images have to answer: files of the folder `firmware-sim/expected`, one an image.

use anyhow::{Context, Result, bail, ensure};
use sinew_record::{ArmResult, BodyResult, CyclicResult, Failure, Kind, Record, RecordStream, VisionResult};
use std::fs;
use std::path::{Path, PathBuf};

/// What a file of the folder asks for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Expected {
    /// `NAME.rec`: these records, and success.
    Records(PathBuf),
    /// `NAME.txt`: this text on standard output, and success.
    Text(PathBuf),
    /// `NAME.failure`: a failure, and this text in what is printed.
    Failure(PathBuf),
}

/// The folder of the workspace.
#[must_use]
pub fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../firmware-sim/expected")
}

/// Whether what is answered now is to be the expected from now on.
#[must_use]
pub fn regenerates() -> bool {
    std::env::var_os("SINEW_REGENERATE").is_some_and(|value| value == "1")
}

/// All images with what they have to answer, by name.
///
/// # Errors
/// A folder that cannot be read, or a file of another kind in it.
pub fn all() -> Result<Vec<(String, Expected)>> {
    let folder = folder();
    let mut list = Vec::new();
    for entry in fs::read_dir(&folder).with_context(|| format!("`{}` cannot be read", folder.display()))? {
        let path = entry?.path();
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let expected = match path.extension().and_then(|extension| extension.to_str()) {
            Some("rec") => Expected::Records(path),
            Some("txt") => Expected::Text(path),
            Some("failure") => Expected::Failure(path),
            _ => bail!("`{}` is no expected output: it has to end in .rec, .txt or .failure", path.display()),
        };
        list.push((name, expected));
    }
    list.sort_by(|a, b| a.0.cmp(&b.0));
    Ok(list)
}

/// What the image `name` has to answer.
///
/// # Errors
/// There is no such file (where nothing is regenerated).
pub fn of_image(name: &str) -> Result<Expected> {
    if let Some((_, expected)) = all()?.into_iter().find(|(other, _)| other == name) {
        return Ok(expected);
    }
    ensure!(
        regenerates(),
        "there is no file of the image `{name}` in `{}`; SINEW_REGENERATE=1 writes it",
        folder().display()
    );
    Ok(Expected::Records(folder().join(format!("{name}.rec"))))
}

/// Compares bytes of records with a file, or writes it where `SINEW_REGENERATE=1`.
///
/// # Errors
/// Names the first record that differs.
pub fn compare_records(found: &[u8], path: &Path) -> Result<()> {
    if regenerates() {
        return fs::write(path, found).with_context(|| format!("`{}` cannot be written", path.display()));
    }
    let wanted = fs::read(path).with_context(|| format!("`{}` cannot be read", path.display()))?;
    if found == wanted {
        return Ok(());
    }
    let place = difference(found, &wanted);
    bail!("other answers than in `{}`: {place}; after a wanted change: SINEW_REGENERATE=1", path.display())
}

/// In words, where two streams differ first.
fn difference(found: &[u8], wanted: &[u8]) -> String {
    let [mut found, mut wanted] = [found, wanted].map(RecordStream::<_, 1024>::new);
    for index in 0.. {
        let now = found.next_record().map(|record| record.map(|record| described(&record)));
        let then = wanted.next_record().map(|record| record.map(|record| described(&record)));
        if now.is_none() && then.is_none() {
            break;
        }
        if now != then {
            return format!("record {index} is {now:?} in place of {then:?}");
        }
    }
    "the bytes between the records differ".to_owned()
}

/// A record in words.
fn described(record: &Record<'_>) -> String {
    match record.kind {
        Kind::CyclicResult => format!("{:?}", record.read::<CyclicResult>()),
        Kind::ArmResult => format!("{:?}", record.read::<ArmResult>()),
        Kind::BodyResult => format!("{:?}", record.read::<BodyResult>()),
        Kind::VisionResult => format!("{:?}", record.read::<VisionResult>()),
        Kind::Failure => format!("{:?}", record.read::<Failure>()),
        kind => format!("{kind:?} {:02x?}", record.payload),
    }
}
