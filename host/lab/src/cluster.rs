//! Simulation of many recordings on a cluster: each worker takes the next chunk until none is left.

use sinew_core::random::Stream;
use std::cmp::Ordering;
use std::collections::{BinaryHeap, VecDeque};

/// Recordings, workers, and what delays them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cluster {
    /// Workers, each with one processor core.
    pub workers: usize,
    /// Recordings.
    pub recordings: usize,
    /// Recordings in a chunk.
    pub chunk: usize,
    /// Mean time of a recording on an undisturbed core, seconds.
    pub recording_s: f64,
    /// Standard deviation of the logarithm of that time.
    pub recording_log_std: f64,
    /// Share of the workers that are slow.
    pub slow_share: f64,
    /// How many times as long a slow one takes.
    pub slow_factor: f64,
    /// Time from one chunk to the next, seconds.
    pub dispatch_s: f64,
    /// Mean time after which a worker is lost, seconds.
    pub loss_s: f64,
    /// Time until a lost worker has a successor, seconds.
    pub restart_s: f64,
}

/// How a run went.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outcome {
    /// Time of the last result, seconds.
    pub end_s: f64,
    /// The same if all workers were undisturbed and ended together, seconds.
    pub ideal_s: f64,
    /// Workers that were lost, each with the recording at hand, which is begun again.
    pub losses: usize,
}

impl Outcome {
    /// Time beyond the ideal, seconds.
    #[must_use]
    pub fn excess_s(&self) -> f64 {
        self.end_s - self.ideal_s
    }
}

/// Random numbers of a run.
const FIRST: u64 = 0;

/// When a worker has time; the heap gives the earliest.
#[derive(Debug, PartialEq)]
struct Free {
    at_s: f64,
    worker: usize,
}

impl Eq for Free {}

impl PartialOrd for Free {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Free {
    fn cmp(&self, other: &Self) -> Ordering {
        other.at_s.total_cmp(&self.at_s).then(other.worker.cmp(&self.worker))
    }
}

impl Cluster {
    /// Plays a run; the same seed gives the same one.
    ///
    /// # Panics
    /// Without workers, recordings, or with empty chunks.
    #[must_use]
    pub fn simulate(&self, seed: u64) -> Outcome {
        assert!(self.workers > 0 && self.recordings > 0 && self.chunk > 0, "needs workers, recordings and chunks");
        let mut stream = Stream::new(seed, FIRST, 0);
        let times_s: Vec<f64> = (0..self.recordings).map(|_| self.draw_time_s(&mut stream)).collect();
        let ideal_s = times_s.iter().sum::<f64>() / self.workers as f64;
        let slow = (self.slow_share * self.workers as f64).round() as usize;
        let mut chunks: VecDeque<&[f64]> = times_s.chunks(self.chunk).collect();
        let mut free: BinaryHeap<Free> = (0..self.workers).map(|worker| Free { at_s: 0.0, worker }).collect();
        let mut outcome = Outcome { end_s: 0.0, ideal_s, losses: 0 };
        while let Some(chunk) = chunks.pop_front() {
            let Some(Free { at_s, worker }) = free.pop() else { break };
            let speed = if worker < slow { self.slow_factor } else { 1.0 };
            let alive_s = -self.loss_s * f64::from(stream.open_uniform()).ln();
            let (done, spent_s) = self.work(chunk, speed, alive_s);
            let mut free_at_s = at_s + spent_s;
            if done < chunk.len() {
                // What it finished is kept; the rest is tried again.
                outcome.losses += 1;
                chunks.push_back(&chunk[done..]);
                free_at_s += self.restart_s;
            }
            outcome.end_s = outcome.end_s.max(at_s + spent_s);
            free.push(Free { at_s: free_at_s, worker });
        }
        outcome
    }

    /// Recordings of `chunk` that a worker finishes before it is lost after `alive_s`, and the time
    /// that it spends.
    fn work(&self, chunk: &[f64], speed: f64, alive_s: f64) -> (usize, f64) {
        let mut spent_s = self.dispatch_s;
        for (index, time_s) in chunk.iter().enumerate() {
            let after_s = spent_s + speed * time_s;
            if after_s > alive_s {
                return (index, alive_s.max(spent_s));
            }
            spent_s = after_s;
        }
        (chunk.len(), spent_s)
    }

    /// A log-normal time whose mean is `recording_s`.
    fn draw_time_s(&self, stream: &mut Stream) -> f64 {
        let std = self.recording_log_std;
        self.recording_s * (std * f64::from(stream.normal()) - 0.5 * std * std).exp()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const EVEN: Cluster = Cluster {
        workers: 8,
        recordings: 800,
        chunk: 10,
        recording_s: 0.5,
        recording_log_std: 0.0,
        slow_share: 0.0,
        slow_factor: 1.0,
        dispatch_s: 0.0,
        loss_s: f64::INFINITY,
        restart_s: 0.0,
    };

    #[test]
    fn even_work_ends_at_the_ideal_time() {
        let outcome = EVEN.simulate(1);
        assert!((outcome.end_s - 50.0).abs() < 1.0e-9 && outcome.excess_s().abs() < 1.0e-9, "{outcome:?}");
        assert_eq!(outcome.losses, 0);
        // A chunk too many waits for all others.
        let outcome = Cluster { recordings: 801, ..EVEN }.simulate(1);
        assert!((outcome.end_s - 50.5).abs() < 1.0e-9, "{outcome:?}");
    }

    #[test]
    fn a_slow_worker_delays_the_end_by_about_a_chunk() {
        let slow = Cluster { slow_share: 0.125, slow_factor: 3.0, ..EVEN };
        let fine = slow.simulate(1).excess_s();
        let coarse = Cluster { chunk: 50, ..slow }.simulate(1).excess_s();
        assert!(fine < 20.0 && coarse > 1.5 * fine, "{fine} and {coarse}");
        assert!(coarse < 3.0 * 50.0 * 0.5, "at most a slow chunk");
    }

    #[test]
    fn what_a_lost_worker_leaves_is_done_by_others() {
        let lossy = Cluster { loss_s: 40.0, restart_s: 5.0, recording_log_std: 0.5, ..EVEN };
        let outcome = lossy.simulate(3);
        assert!(outcome.losses > 2, "{outcome:?}");
        assert!(outcome.excess_s() > 0.0 && outcome.end_s < 2.0 * outcome.ideal_s, "{outcome:?}");
        assert_eq!(outcome, lossy.simulate(3));
        assert_ne!(outcome, lossy.simulate(4));
    }
}
