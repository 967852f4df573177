//! When cycles begin, and how long they take.
//!
//! A cycle may begin at any phase. Between position 0 and position 0 lie few of them in a short
//! recording, and each hangs on the phase of two frames. So cycles are timed from many phases on,
//! and the cadence is that of their mean.

use crate::cyclic::stops::longest_without_stop;
use crate::resume::{List, long_real};
use sinew_core::saved_state::{SavedState, StateVisitor};

/// Phases from which cycles are timed, evenly through the cycle: one is two frames of a walker at
/// 30 frames a second.
const PHASES: usize = 16;

/// Times that are kept one by one. Chosen: those of 64 cycles, so that a stop is found by the tempo
/// around it, and a stream of days needs no more memory.
const MAX_RECENT: usize = 64 * PHASES;

/// The times of a run's cycles so far.
#[derive(Debug, Clone)]
pub(in crate::cyclic) struct CycleTimes {
    /// What is passed next, phases from position 0 before the first row.
    next: f64,
    /// When each phase was passed last, seconds from the first row; NaN where it was not since the
    /// person was last lost.
    passed_s: [f64; PHASES],
    /// Cycles that were timed, from all phases, and the sum of their times, without stops.
    timed: u64,
    timed_s: f64,
    /// Times of the cycles after these.
    recent_s: Vec<f64>,
    starts_s: Vec<Start>,
}

/// Position 0 is passed.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Start {
    /// Seconds from the first row.
    at_s: f64,
    /// Whether the person was seen from the start before on.
    follows: bool,
}

impl CycleTimes {
    /// Begins at a position, in cycles.
    pub(in crate::cyclic) fn new(position: f64) -> Self {
        let mut times = Self {
            next: 0.0,
            passed_s: [0.0; PHASES],
            timed: 0,
            timed_s: 0.0,
            recent_s: Vec::new(),
            starts_s: Vec::new(),
        };
        times.lose(position);
        times
    }

    /// The person is found at `position`, and what was passed before is not known.
    pub(super) fn lose(&mut self, position: f64) {
        self.next = (position * PHASES as f64).floor() + 1.0;
        self.passed_s = [f64::NAN; PHASES];
    }

    /// Passes from one position to the next, in cycles and seconds from the first row, on a
    /// straight line. A phase that is taken back and passed again counts once. Of a step of more
    /// than a cycle, as where many frames were skipped, only the first cycle is looked at.
    pub(in crate::cyclic) fn pass(&mut self, [before, after]: [f64; 2], [from_s, to_s]: [f64; 2]) {
        if after <= before {
            return;
        }
        for _ in 0..PHASES {
            let position = self.next / PHASES as f64;
            if position > after {
                return;
            }
            let share = ((position - before) / (after - before)).clamp(0.0, 1.0);
            self.pass_next(from_s + share * (to_s - from_s));
        }
        if self.next <= after * PHASES as f64 {
            self.lose(after);
        }
    }

    fn pass_next(&mut self, at_s: f64) {
        let phase = self.next.rem_euclid(PHASES as f64) as usize;
        let before_s = std::mem::replace(&mut self.passed_s[phase], at_s);
        let follows = !before_s.is_nan();
        if follows {
            if self.recent_s.len() == MAX_RECENT {
                (self.timed, self.timed_s) = self.timed_without_stops();
                self.recent_s.clear();
            }
            self.recent_s.push(at_s - before_s);
        }
        if phase == 0 {
            self.starts_s.push(Start { at_s, follows });
        }
        self.next += 1.0;
    }

    /// Number and sum of the times of all cycles without a stop.
    fn timed_without_stops(&self) -> (u64, f64) {
        let longest_s = longest_without_stop(&self.recent_s);
        let recent_s = self.recent_s.iter().filter(|time_s| **time_s <= longest_s);
        recent_s.fold((self.timed, self.timed_s), |(count, sum_s), time_s| (count + 1, sum_s + time_s))
    }

    /// Mean time of a cycle without a stop; `None` where fewer were timed than one from each phase.
    pub(super) fn mean_s(&self) -> Option<f64> {
        let (timed, timed_s) = self.timed_without_stops();
        let all = self.timed + self.recent_s.len() as u64;
        (all >= PHASES as u64).then(|| timed_s / timed as f64)
    }

    /// When position 0 was passed, seconds from the first row.
    pub(super) fn starts_s(&self) -> Vec<f64> {
        self.starts_s.iter().map(|start| start.at_s).collect()
    }

    /// Start and end of each cycle from position 0 to position 0 in which the person was seen and
    /// did not stop.
    pub(super) fn whole_s(&self) -> Vec<[f64; 2]> {
        let longest_s =
            longest_without_stop(&self.followed_s().map(|[start_s, end_s]| end_s - start_s).collect::<Vec<_>>());
        self.followed_s().filter(|[start_s, end_s]| end_s - start_s <= longest_s).collect()
    }

    /// Start and end of each cycle in which the person was seen.
    pub(in crate::cyclic) fn followed_s(&self) -> impl Iterator<Item = [f64; 2]> {
        self.starts_s.windows(2).filter(|pair| pair[1].follows).map(|pair| [pair[0].at_s, pair[1].at_s])
    }
}

impl SavedState for CycleTimes {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        long_real(&mut self.next, visitor);
        self.passed_s.iter_mut().for_each(|passed_s| long_real(passed_s, visitor));
        visitor.long(&mut self.timed);
        long_real(&mut self.timed_s, visitor);
        let mut recent_s = List::new(std::mem::take(&mut self.recent_s).into_iter().map(Time).collect(), Time(0.0));
        recent_s.visit(visitor);
        self.recent_s = recent_s.entries.into_iter().map(|time| time.0).collect();
        let mut starts_s = List::new(std::mem::take(&mut self.starts_s), Start { at_s: 0.0, follows: false });
        starts_s.visit(visitor);
        self.starts_s = starts_s.entries;
    }
}

/// A time in a saved state.
#[derive(Debug, Clone, Copy)]
struct Time(f64);

impl SavedState for Time {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        long_real(&mut self.0, visitor);
    }
}

impl SavedState for Start {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        long_real(&mut self.at_s, visitor);
        visitor.flag(&mut self.follows);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Passes through these positions, a second each.
    fn through(positions: &[f64]) -> CycleTimes {
        let mut times = CycleTimes::new(positions[0]);
        for (at_s, pair) in positions.windows(2).enumerate() {
            times.pass([pair[0], pair[1]], [at_s as f64, at_s as f64 + 1.0]);
        }
        times
    }

    #[test]
    fn an_even_tempo_is_exact_wherever_the_recording_begins() {
        for begin in [0.0, 0.03, 0.5, 0.97] {
            let positions: Vec<f64> = (0..30).map(|row| begin + 0.07 * f64::from(row)).collect();
            let mean_s = through(&positions).mean_s().unwrap();
            assert!((mean_s - 1.0 / 0.07).abs() < 1.0e-9, "{begin}: {mean_s}");
        }
    }

    #[test]
    fn a_stop_is_in_no_time_and_no_whole_cycle() {
        for stop in [30, 300] {
            let phase = |row: i32| 0.1 * f64::from(row.min(38) + (row - 38 - stop).max(0));
            let times = through(&(0..80 + stop).map(phase).collect::<Vec<f64>>());
            assert!((times.mean_s().unwrap() - 10.0).abs() < 1.0e-9, "{:?}", times.mean_s());
            assert!(times.whole_s().iter().all(|[start_s, end_s]| end_s - start_s < 11.0));
            assert_eq!((times.starts_s().len(), times.whole_s().len()), (7, 5));
        }
    }

    #[test]
    fn less_than_two_cycles_have_no_mean() {
        assert_eq!(through(&[0.0, 0.5, 1.0, 1.5, 1.9]).mean_s(), None);
    }

    #[test]
    fn a_cycle_that_is_taken_back_counts_once() {
        let times = through(&[0.1, 0.75, 1.25, 0.75, 1.25, 2.0, 2.5]);
        assert_eq!(times.starts_s(), [1.5, 5.0]);
        assert_eq!(times.whole_s(), [[1.5, 5.0]]);
    }

    #[test]
    fn a_cycle_in_which_the_person_was_lost_is_none() {
        let mut times = through(&[0.25, 0.75, 1.25]);
        times.lose(1.5);
        times.pass([1.5, 2.5], [3.0, 5.0]);
        assert_eq!((times.starts_s(), times.whole_s()), (vec![1.5, 4.0], vec![]));
    }

    #[test]
    fn a_step_of_many_cycles_times_none() {
        let times = through(&[0.5, 7.5, 8.5]);
        assert_eq!((times.whole_s().len(), times.mean_s()), (0, None));
    }
}
