//! A million recordings on a cluster: work by kind, and the time that chunks of each size waste.

use super::markdown::{Rows, line, named};
use crate::cluster::{Cluster, Outcome};
use anyhow::Result;
use std::path::Path;

/// Recordings of the plan.
const RECORDINGS: usize = 1_000_000;
/// Frames of each.
const FRAMES: usize = 3000;
/// Workers of the plan, a core each.
const WORKERS: usize = 512;
/// Seeds of each simulation.
const SEEDS: u64 = 9;
/// Recordings in a chunk.
const CHUNKS: [usize; 4] = [1, 10, 100, 1000];

/// A kind of recording.
struct Kind {
    name: &'static str,
    /// Processor time of a frame, milliseconds: measured as `docs/cluster.md` says.
    frame_ms: f64,
    /// Bytes of a frame's rows as CSV and as Parquet: measured as `docs/cluster.md` says.
    frame_bytes: [f64; 2],
}

/// Measured on a shared two-core x86-64 virtual machine.
const KINDS: [Kind; 4] = [
    Kind { name: "cyclic, finished recording", frame_ms: 0.022, frame_bytes: [307.0, 121.0] },
    Kind { name: "cyclic, online", frame_ms: 0.011, frame_bytes: [307.0, 121.0] },
    Kind { name: "arms, both sides, 640x480", frame_ms: 5.5, frame_bytes: [429.0, 351.0] },
    Kind { name: "bodies, 2000 points", frame_ms: 34.0, frame_bytes: [1004.0, 592.0] },
];

impl Kind {
    fn recording_s(&self) -> f64 {
        1.0e-3 * self.frame_ms * FRAMES as f64
    }

    /// Work, hours of one core.
    fn core_hours(&self) -> f64 {
        self.recording_s() * RECORDINGS as f64 / 3600.0
    }
}

/// Work and storage of each kind.
pub fn work(_recordings: &Path) -> Result<Rows> {
    let mut rows = vec![line(["kind", "a recording, s", "core-hours", "hours on 512 cores", "CSV, TB", "Parquet, TB"])];
    for kind in &KINDS {
        let terabytes = kind.frame_bytes.map(|bytes| bytes * (RECORDINGS * FRAMES) as f64 / 1.0e12);
        let numbers = [kind.recording_s(), kind.core_hours(), kind.core_hours() / WORKERS as f64];
        let [recording, hours, on_all] = numbers.map(three_digits);
        rows.push(named(
            kind.name,
            [recording, hours, on_all].into_iter().chain(terabytes.map(|tb| format!("{tb:.2}"))),
        ));
    }
    Ok(rows)
}

/// A number with three digits, without an exponent.
fn three_digits(value: f64) -> String {
    let decimals = (2.0 - value.abs().log10().floor()).clamp(0.0, 3.0) as usize;
    format!("{value:.decimals$}")
}

/// Seconds beyond the ideal end, by chunk.
pub fn chunks(_recordings: &Path) -> Result<Rows> {
    let header =
        ["recordings in a chunk", "a chunk, s", "even nodes: excess, s", "1 % slow nodes", "and losses", "lost"];
    let mut rows = vec![line(header)];
    for chunk in CHUNKS {
        let even = plan(&KINDS[0], chunk);
        let slow = Cluster { slow_share: 0.01, slow_factor: 4.0, ..even };
        let lossy = Cluster { loss_s: 4.0 * 3600.0, restart_s: 60.0, ..slow };
        let [even_s, slow_s] = [even, slow].map(|cluster| excess(&outcomes(&cluster)));
        let lost = outcomes(&lossy);
        let mean_losses = lost.iter().map(|outcome| outcome.losses as f64).sum::<f64>() / SEEDS as f64;
        rows.push(line([
            chunk.to_string(),
            three_digits(chunk as f64 * even.recording_s),
            even_s,
            slow_s,
            excess(&lost),
            format!("{mean_losses:.1}"),
        ]));
    }
    Ok(rows)
}

/// A million recordings of `kind` whose lengths differ by a half.
fn plan(kind: &Kind, chunk: usize) -> Cluster {
    Cluster {
        workers: WORKERS,
        recordings: RECORDINGS,
        chunk,
        recording_s: kind.recording_s(),
        recording_log_std: 0.5,
        slow_share: 0.0,
        slow_factor: 1.0,
        dispatch_s: 0.03,
        loss_s: f64::INFINITY,
        restart_s: 0.0,
    }
}

fn outcomes(cluster: &Cluster) -> Vec<Outcome> {
    (1..=SEEDS).map(|seed| cluster.simulate(seed)).collect()
}

/// Median and largest excess of the runs.
fn excess(outcomes: &[Outcome]) -> String {
    let mut all: Vec<f64> = outcomes.iter().map(Outcome::excess_s).collect();
    all.sort_by(f64::total_cmp);
    format!("{:.0} ({:.0})", all[all.len() / 2], all[all.len() - 1])
}
