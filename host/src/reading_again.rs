//! Files that cannot be read just now, as on a network folder that stumbles.

use crate::error::Error;
use std::fmt::Display;
use std::thread::sleep;
use std::time::Duration;

/// Pauses before each further try, milliseconds: a second in all, chosen so that a stumble passes
/// and a run does not hang.
const PAUSES_MS: [u64; 3] = [50, 200, 750];

/// Reads with `read`, again where the operating system refused it.
///
/// # Errors
/// [`Error::Unreadable`] if it still does after the last try; the inner error is one of the
/// content.
pub(crate) fn read_again<T, E: Display>(
    mut read: impl FnMut() -> Result<T, E>,
    is_io: impl Fn(&E) -> bool,
) -> Result<Result<T, E>, Error> {
    let mut pauses = PAUSES_MS.iter();
    loop {
        match (read(), pauses.next()) {
            (Err(error), Some(pause)) if is_io(&error) => sleep(Duration::from_millis(*pause)),
            (Err(error), None) if is_io(&error) => return Err(Error::Unreadable(error.to_string())),
            (ended, _) => return Ok(ended),
        }
    }
}

/// What was read before the first failure; if there is nothing, the failure.
///
/// # Errors
/// The first entry, if that is one.
pub(crate) fn until_failure<T>(read: Vec<Result<T, Error>>) -> Result<Vec<T>, Error> {
    let mut good = Vec::with_capacity(read.len());
    for entry in read {
        match entry {
            Ok(value) => good.push(value),
            Err(error) if good.is_empty() => return Err(error),
            Err(_) => break,
        }
    }
    Ok(good)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_can_be_read_later_is_read() {
        let mut tries = 0;
        let mut read = || {
            tries += 1;
            if tries < 3 { Err("no") } else { Ok(tries) }
        };
        assert_eq!(read_again(&mut read, |_| true).unwrap(), Ok(3));
        assert_eq!(read_again(|| Err::<u8, _>("bad"), |_| false).unwrap(), Err("bad"));
        assert!(
            matches!(read_again(|| Err::<u8, _>("gone"), |_| true), Err(Error::Unreadable(text)) if text == "gone")
        );
    }

    #[test]
    fn what_was_read_before_a_failure_counts() {
        let failed = || Err(Error::Unreadable("gone".to_owned()));
        assert_eq!(until_failure(vec![Ok(1), Ok(2), failed(), Ok(4)]).unwrap(), [1, 2]);
        assert!(until_failure::<u8>(vec![failed()]).is_err());
    }
}
