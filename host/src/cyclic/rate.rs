//! Frames per second of a recording: what its table says, or what a user does.

use super::error::CyclicError;
use std::path::Path;

/// How far a rate may lie from that of the table: 30 for 29.97 is the same camera.
const MAX_RATE_ERROR: f64 = 0.002;

/// Whether two rates are those of one camera.
#[must_use]
pub fn is_same(one_hz: f64, other_hz: f64) -> bool {
    (one_hz / other_hz - 1.0).abs() <= MAX_RATE_ERROR
}

/// Frames per second of `table`, whose times say `of_table`; `given` is that of `--rate`.
///
/// # Errors
/// Both are unknown, or they contradict each other.
pub fn of_recording(table: &Path, of_table: Option<f64>, given: Option<f64>) -> Result<f64, CyclicError> {
    match (given, of_table) {
        (Some(given), Some(of_table)) if !is_same(given, of_table) => Err(CyclicError::unusable(
            table,
            format!(
                "its times say {of_table} frames a second, not the {given} of --rate; leave --rate out, or make the table anew by `sinew angles` with --input-rate {given}"
            ),
        )),
        (Some(rate), _) | (None, Some(rate)) => Ok(rate),
        (None, None) => Err(CyclicError::unusable(
            table,
            "does not say how many frames a second it has; give --rate HZ, or make it by `sinew angles` with --input-rate HZ",
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rate_is_known_once_and_never_twice() {
        let rate = |of_table, given| of_recording(Path::new("walk.csv"), of_table, given).map_err(|e| e.to_string());
        assert_eq!(rate(Some(29.97), None), Ok(29.97));
        assert_eq!(rate(Some(29.97), Some(30.0)), Ok(30.0));
        assert_eq!(rate(None, Some(25.0)), Ok(25.0));
        assert!(rate(Some(30.0), Some(60.0)).unwrap_err().contains("`walk.csv`: its times say 30 frames a second"));
        assert!(rate(None, None).unwrap_err().contains("give --rate HZ"));
    }
}
