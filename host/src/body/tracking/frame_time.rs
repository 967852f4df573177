//! When a frame of a stream was taken.

use crate::error::{Result, ensure_option};
use serde::{Deserialize, Serialize};

/// How long is looked before where a body is or faces is decided, seconds, and in how many frames
/// at least. Chosen: of 207 starts of twelve tuning clips 33 face the wrong way by the first frame,
/// 23 by five frames at 15 a second, 16 by eight, 16 by fifteen.
const DECISION_S: f32 = 0.5;
const MIN_DECISION_FRAMES: usize = 8;

/// How many frames with points decide where a body is or faces, of `rate_hz` in a second.
#[must_use]
pub fn decision_frames(rate_hz: f32) -> usize {
    ((DECISION_S * rate_hz).ceil() as usize).max(MIN_DECISION_FRAMES)
}

/// When a frame was taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FrameTime {
    /// One frame after the one before.
    Next,
    /// The frame of this number: time is the number over the rate.
    Number(u64),
    /// Seconds on a clock of the caller's. Numbers of frames follow from the rate.
    Seconds(f64),
}

/// A frame among those before it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(super) struct Moment {
    pub frame: u64,
    #[serde(with = "bits")]
    pub time_s: f64,
    /// Time since the frame before, seconds; zero in the first one.
    #[serde(skip)]
    pub dt_s: f32,
}

impl FrameTime {
    /// The frame at this time after `before`.
    ///
    /// # Errors
    /// The time does not rise.
    pub(super) fn after(self, before: Option<&Moment>, rate_hz: f64) -> Result<Moment> {
        let Some(before) = before else { return self.first(rate_hz) };
        let frames_later = |frames: u64| (frames as f64 / rate_hz) as f32;
        match self {
            Self::Next => Ok(Moment {
                frame: before.frame.saturating_add(1),
                time_s: before.time_s + 1.0 / rate_hz,
                dt_s: frames_later(1),
            }),
            Self::Number(frame) => {
                let last = before.frame;
                ensure_option!(frame > last, "`frame` has to rise from frame to frame; {frame} follows {last}");
                Ok(Moment { frame, time_s: frame as f64 / rate_hz, dt_s: frames_later(frame - last) })
            }
            Self::Seconds(time_s) => {
                let last = before.time_s;
                let is_later = time_s > last && time_s.is_finite();
                ensure_option!(
                    is_later,
                    "`time_s` has to be finite and to rise from frame to frame; {time_s} follows {last}"
                );
                let frames = ((time_s - last) * rate_hz).round().max(1.0) as u64;
                Ok(Moment { frame: before.frame.saturating_add(frames), time_s, dt_s: (time_s - last) as f32 })
            }
        }
    }

    fn first(self, rate_hz: f64) -> Result<Moment> {
        let (frame, time_s) = match self {
            Self::Next => (0, 0.0),
            Self::Number(frame) => (frame, frame as f64 / rate_hz),
            Self::Seconds(time_s) => (0, time_s),
        };
        ensure_option!(time_s.is_finite(), "`time_s` has to be finite, not {time_s}");
        Ok(Moment { frame, time_s, dt_s: 0.0 })
    }
}

/// A number as its bits: text of JSON does not hold each one.
mod bits {
    use serde::{Deserialize, Deserializer, Serializer};

    #[expect(clippy::trivially_copy_pass_by_ref, reason = "serde asks for it")]
    pub fn serialize<S: Serializer>(value: &f64, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_u64(value.to_bits())
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
        Ok(f64::from_bits(u64::deserialize(deserializer)?))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_count_frames_and_have_to_rise() {
        let first = FrameTime::Seconds(7.5).after(None, 15.0).unwrap();
        assert_eq!((first.frame, first.time_s), (0, 7.5));
        let later = FrameTime::Seconds(7.7).after(Some(&first), 15.0).unwrap();
        assert_eq!((later.frame, later.dt_s), (3, 0.2));
        let next = FrameTime::Next.after(Some(&later), 15.0).unwrap();
        assert_eq!((next.frame, next.dt_s), (4, 1.0 / 15.0));
        assert_eq!(FrameTime::Number(9).after(Some(&next), 15.0).unwrap().dt_s, 5.0 / 15.0);
        for wrong in [FrameTime::Seconds(7.5), FrameTime::Seconds(f64::NAN), FrameTime::Number(4)] {
            let message = wrong.after(Some(&next), 15.0).unwrap_err().to_string();
            assert!(message.contains("rise from frame to frame"), "{message}");
        }
        assert!(FrameTime::Seconds(f64::INFINITY).after(None, 15.0).is_err());
    }

    #[test]
    fn half_a_second_is_at_least_eight_frames() {
        assert_eq!([2.0, 15.0, 30.0, 60.0].map(decision_frames), [8, 8, 15, 30]);
    }
}
