//! The rate of a table, from the times of its rows.

/// How far a time may lie from where the rate puts it, frames: a row belongs to the frame whose
/// time is nearest.
const MAX_OFF_FRAMES: f64 = 0.5;

/// Digits of a rate that are kept: times have nine decimals, so that two rows of a fast camera give
/// seven digits.
const RATE_DIGITS: i32 = 6;

/// Times of rows, which have to be even.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Clock {
    /// Frame and time of the first row.
    first: Option<(u64, f64)>,
    /// Frames per second of the first and the last row.
    rate_hz: Option<f64>,
}

impl Clock {
    /// Frames per second; `None` before the second row.
    #[must_use]
    pub fn rate_hz(&self) -> Option<f64> {
        self.rate_hz.map(rounded)
    }

    /// Adds the time of `frame`, which follows the last one.
    ///
    /// # Errors
    /// Says which rule the time breaks.
    pub fn add(&mut self, frame: u64, time_s: f64) -> Result<(), String> {
        let Some((first_frame, first_s)) = self.first else {
            self.first = Some((frame, time_s));
            return Ok(());
        };
        let (frames, seconds) = ((frame - first_frame) as f64, time_s - first_s);
        if seconds <= 0.0 {
            return Err(format!(
                "frame {frame} is at {time_s} s, frame {first_frame} at {first_s} s; times have to rise"
            ));
        }
        let rate_hz = frames / seconds;
        let expected_s = self.rate_hz.map_or(seconds, |rate_hz| frames / rate_hz);
        if (seconds - expected_s).abs() * rate_hz > MAX_OFF_FRAMES {
            return Err(format!(
                "frame {frame} is at {time_s} s, but the rows before it put it at {:.3} s; frames have to be even in \
                 time: leave frame numbers out where frames are missing",
                first_s + expected_s
            ));
        }
        self.rate_hz = Some(rate_hz);
        Ok(())
    }
}

/// A rate without the rounding of the times that it was taken from.
fn rounded(rate_hz: f64) -> f64 {
    let scale = 10.0_f64.powi(RATE_DIGITS - 1 - rate_hz.log10().floor() as i32);
    (rate_hz * scale).round() / scale
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rate_is_that_of_the_times() {
        for rate_hz in [12.0, 25.0, 29.97, 59.94, 240.0] {
            let mut clock = Clock::default();
            for frame in [3_u64, 4, 9, 200] {
                let time_s = format!("{:.9}", frame as f64 / rate_hz).parse().unwrap();
                clock.add(frame, time_s).unwrap();
                let found = clock.rate_hz();
                assert!(frame == 3 || found == Some(rate_hz), "{found:?}");
            }
        }
    }

    #[test]
    fn times_that_are_not_even_are_refused() {
        let mut clock = Clock::default();
        clock.add(0, 0.0).unwrap();
        clock.add(1, 0.04).unwrap();
        assert!(clock.add(2, 0.12).unwrap_err().contains("leave frame numbers out"));
        assert!(clock.add(2, 0.0).unwrap_err().contains("times have to rise"));
    }
}
