//! Errors print their causes and can be told apart.

use super::{Context, Error, ErrorKind, Result, WriteContext, bail, ensure};
use crate::output::OutputDir;
use crate::resume::Interrupted;
use sinew_core::error::positive;

fn refused() -> std::io::Error {
    std::io::Error::new(std::io::ErrorKind::PermissionDenied, "permission denied")
}

fn interrupted() -> Interrupted {
    Interrupted { finished: 3, all: None, unit: "rows", out: "run".into() }
}

#[test]
fn a_chain_is_printed_cause_by_cause() {
    let failed: Result<()> = Err(refused()).context("`a` cannot be read").with_context(|| "run `b`");
    let error = failed.unwrap_err();
    assert_eq!(error.to_string(), "run `b`");
    assert_eq!(format!("{error:#}"), "run `b`: `a` cannot be read: permission denied");
    assert_eq!(error.chain(), format!("{error:#}"));
    let unfinished = Error::Unfinished { error: Box::new(error), kept: "2 frames are kept".into() };
    assert_eq!(unfinished.to_string(), "run `b`: `a` cannot be read: permission denied; 2 frames are kept");
    assert_eq!(unfinished.chain(), unfinished.to_string());
    let missing: Result<u8> = None.context("there is none");
    assert_eq!(missing.unwrap_err().chain(), "there is none");
}

#[cfg(feature = "command")]
#[test]
fn the_command_prints_the_same_chain() {
    let failed = || -> Result<()> { Err(refused()).context("`a` cannot be read").writing(|| "`b` cannot be written") };
    let error = anyhow::Error::from(failed().unwrap_err());
    assert_eq!(format!("{error:#}"), failed().unwrap_err().chain());
    let anyhow_only = anyhow::Error::from(refused()).context("`a` cannot be read").context("`b` cannot be written");
    assert_eq!(format!("{error:#}"), format!("{anyhow_only:#}"));
    // With RUST_BACKTRACE set, a trace of each error's own place follows the causes.
    let [printed, expected] = [&error, &anyhow_only].map(|error| format!("{error:?}"));
    let causes = |text: &str| text.split("\n\nStack backtrace").next().unwrap().to_owned();
    assert_eq!(causes(&printed), causes(&expected));
    let error = anyhow::Error::from(Error::from(interrupted())).context("walking");
    assert_eq!(crate::cli::interrupted(&error), Some(&interrupted()));
}

#[test]
fn kinds_can_be_told_apart() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    std::fs::write(&file, b"").unwrap();
    let unwritable = OutputDir::create(&file.join("inside")).unwrap_err();
    assert!(matches!(unwritable.innermost(), Error::Io(_)), "{unwritable:?}");
    assert_eq!((unwritable.kind(), unwritable.is_output()), (ErrorKind::CannotCreate, true));
    let bad = Error::from(positive("rate_hz", -1.0).unwrap_err());
    assert!(matches!(bad, Error::Parameter(_)));
    assert_eq!(bad.kind(), ErrorKind::Data);
    let slow = crate::body::tracking::stream_options::check_rate("--rate", 0.0).unwrap_err();
    assert_eq!(slow.kind(), ErrorKind::Usage);
    let stopped = Err::<(), _>(interrupted()).writing(|| "`cells` cannot be written").unwrap_err();
    assert_eq!((stopped.kind(), stopped.interrupted()), (ErrorKind::Interrupted, Some(&interrupted())));
}

#[test]
fn a_broken_rule_is_invalid_with_its_text() {
    let check = |count: usize| -> Result<usize> {
        ensure!(count > 0, "{count} frames: give one or more");
        if count > 9 {
            bail!("{} frames are too many", count);
        }
        Ok(count)
    };
    assert_eq!(check(3).unwrap(), 3);
    assert!(matches!(check(0).unwrap_err(), Error::Invalid(text) if text == "0 frames: give one or more"));
    assert!(matches!(check(10).unwrap_err(), Error::Invalid(text) if text == "10 frames are too many"));
}
