//! Times in the cells of a table.

use super::sheet::Sheet;

/// Steps longer than this are no seconds: a video has more than one frame a second.
const MAX_STEP_S: f64 = 1.0;

/// A time in a cell: a number, or hours, minutes and seconds, after a date or not.
///
/// # Errors
/// The cell is neither.
pub fn time(cell: &str, sheet: Sheet) -> Result<Option<f64>, ()> {
    if let Ok(number) = sheet.number(cell) {
        return Ok(number);
    }
    let clock = cell.rsplit(['T', ' ']).next().unwrap_or(cell).trim_end_matches('Z').replace(',', ".");
    let parts = clock.split(':').map(str::parse::<f64>).collect::<Result<Vec<f64>, _>>().map_err(|_| ())?;
    let is_clock = (2..=3).contains(&parts.len()) && parts.iter().all(|part| part.is_finite() && *part >= 0.0);
    if is_clock { Ok(Some(parts.iter().fold(0.0, |sum, part| 60.0 * sum + part))) } else { Err(()) }
}

/// The unit of times whose column does not say it, by their median step: its seconds and name.
/// Video has 1 to 1000 frames a second, so a step above 1 is milliseconds or finer.
#[must_use]
pub fn unit(times: &[f64]) -> (f64, &'static str) {
    let mut steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).filter(|step| *step > 0.0).collect();
    steps.sort_by(f64::total_cmp);
    let step = steps.get(steps.len() / 2).copied().unwrap_or(0.0);
    [(1.0, "seconds"), (1.0e-3, "milliseconds"), (1.0e-6, "microseconds")]
        .into_iter()
        .find(|(seconds, _)| step * seconds <= MAX_STEP_S)
        .unwrap_or((1.0e-9, "nanoseconds"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_numbers_or_clocks() {
        let sheet = Sheet { separator: b',', has_decimal_comma: false };
        assert_eq!(time("1.5", sheet), Ok(Some(1.5)));
        assert_eq!(time("", sheet), Ok(None));
        assert_eq!(time("00:01:02.5", sheet), Ok(Some(62.5)));
        assert_eq!(time("2024-05-01T00:01:02.5Z", sheet), Ok(Some(62.5)));
        assert_eq!(time("01:02,5", sheet), Ok(Some(62.5)));
        assert_eq!((time("x", sheet), time("1:x", sheet)), (Err(()), Err(())));
    }

    #[test]
    fn the_unit_follows_from_the_step() {
        let names = [0.033, 33.3, 33_333.0, 3.3e7].map(|step| unit(&[0.0, step, 2.0 * step]).1);
        assert_eq!(names, ["seconds", "milliseconds", "microseconds", "nanoseconds"]);
    }
}
