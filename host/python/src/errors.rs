//! Errors of the library as exceptions of Python.

use crate::names_of_body::OF_BODY;
use pyo3::exceptions::{PyBlockingIOError, PyFileNotFoundError, PyKeyboardInterrupt, PyOSError, PyValueError};
use pyo3::{PyErr, create_exception};
use sinew::cloud::CloudError;
use sinew::cyclic::CyclicError;
use sinew::error::{Error, ErrorKind};
use sinew::keypoints::KeypointError;
use sinew::motion::MotionError;
use std::io;

create_exception!(
    sinew,
    SinewError,
    PyValueError,
    "A recording, table or model that cannot be used.\n\nThe message names the file, the rule and the remedy."
);

/// The command's options in messages, and what Python calls them. Longer ones are first.
const NAMES: [(&str, &str); 29] = [
    ("`sinew angles --min-confidence`", "`min_confidence` of `sinew.angles`"),
    ("`sinew angles --input-rate HZ`", "`fps` of `sinew.angles`"),
    ("`sinew angles` with --input-rate ", "`sinew.angles` with fps="),
    ("`--image-size WIDTH,HEIGHT`", "`image_size_px=(WIDTH, HEIGHT)`"),
    ("`--input-rate HZ`", "`fps`"),
    ("`--input-rate ", "`fps="),
    ("--input-rate", "fps"),
    ("`--rate ", "`rate_hz="),
    ("give --rate HZ", "give rate_hz"),
    ("--rate", "rate_hz"),
    ("`--model ", "`model="),
    ("`--model`", "`model`"),
    ("--model running", "model=\"running\""),
    ("--model walking", "model=\"walking\""),
    ("--facing", "facing"),
    ("`--person`", "`person`"),
    ("--person", "person"),
    ("--online", "online=True"),
    ("`--skin ", "`skin="),
    (
        "what the run left is not whole; leave --resume out to begin anew",
        "the saved state is of another tracker, or cut",
    ),
    ("`sigma` ", "`sigma_deg` "),
    ("`rate` ", "`rate_hz` "),
    ("`height-px` ", "`height_px` "),
    ("`sigma-px` ", "`sigma_px` "),
    ("`rows` ", "`angles` "),
    ("`sinew angles`", "`sinew.angles`"),
    ("see `sinew.angles fps`", "see `fps` of `sinew.angles`"),
    ("the table has no angle in any row", "`angles` has no angle in any frame"),
    ("give a .csv table with the points' names", "give another `layout`"),
];

/// The same of `sinew batch`.
const BATCH_NAMES: [(&str, &str); 4] = [
    ("standard input:", "manifest:"),
    ("choose another --out", "choose another `out`"),
    ("--retry-failed", "retry_failed=True"),
    ("give the same command again", "call it again"),
];

/// Sentences about keypoints of a file, and what they are of an array, which has one person.
const OF_ARRAY: [(&str, &str); 3] = [
    ("choose with --person, or cut there", "cut there"),
    ("y points up in this file (", "y points up ("),
    ("minus the file's", "minus the array's"),
];

/// Sentences about keypoints of a file as they are of an array.
pub fn of_array(sentences: &[String]) -> Vec<String> {
    let plain = |text: &String| OF_ARRAY.iter().fold(text.clone(), |text, (file, array)| text.replace(file, array));
    sentences.iter().map(plain).collect()
}

/// A message of the library with the names of Python's parameters.
pub fn in_python(message: &str) -> String {
    NAMES.iter().chain(&OF_BODY).fold(message.to_owned(), |text, (command, python)| text.replace(command, python))
}

/// The exception for an error of the library: `ValueError` for a parameter, `OSError` for a file
/// that the operating system refuses, else [`SinewError`].
pub fn exception(error: &Error) -> PyErr {
    let message = in_python(&error.chain());
    match (refused(error.innermost()), error.kind()) {
        (Some(kind), _) => io::Error::new(kind, message).into(),
        (None, ErrorKind::NoInput | ErrorKind::CannotCreate | ErrorKind::Io) => PyOSError::new_err(message),
        (None, ErrorKind::Usage) => PyValueError::new_err(message),
        _ => SinewError::new_err(message),
    }
}

/// The exception for an error of the command line.
pub fn of_command(error: &anyhow::Error) -> PyErr {
    of_kind(sinew::cli::kind_of(error).name(), format!("{error:#}"))
}

/// The exception for what the command calls an error of this kind.
pub fn of_kind(kind: &str, message: String) -> PyErr {
    let message = BATCH_NAMES.iter().fold(message, |text, (command, python)| text.replace(command, python));
    match kind {
        "usage" => PyValueError::new_err(message),
        "no-input" => PyFileNotFoundError::new_err(message),
        "cannot-create" | "io" => PyOSError::new_err(message),
        "try-again" => PyBlockingIOError::new_err(message),
        "interrupted" => PyKeyboardInterrupt::new_err(message),
        _ => SinewError::new_err(message),
    }
}

/// Why the operating system refused a file, if it did.
fn refused(error: &Error) -> Option<io::ErrorKind> {
    match error {
        Error::Io(reason)
        | Error::Cyclic(CyclicError::Unreadable { reason, .. })
        | Error::Keypoints(KeypointError::Unreadable { reason, .. })
        | Error::Cloud(CloudError::Unreadable { reason, .. })
        | Error::Motion(MotionError::Unreadable { reason, .. }) => Some(reason.kind()),
        Error::ImageFile(error) => error.io,
        _ => None,
    }
}

/// A parameter that breaks its rule.
pub fn wrong(parameter: &str, rule: &str) -> PyErr {
    PyValueError::new_err(format!("`{parameter}` {rule}"))
}
