//! The experiments as tables: text for people, CSV for tools.

use super::LongRun;
use super::experiments::{Cell, SIGMAS_DEG};
use serde::Serialize;
use sinew::cyclic::angle_table::{ANGLES, COLUMNS};
use sinew::cyclic::tracking::FilterName;
use std::fmt::Write;

/// Everything that `evaluate cyclic` measures.
#[derive(Debug, Serialize)]
pub struct CyclicReport {
    /// Marks the file.
    pub format: &'static str,
    /// Version of the file's layout.
    pub version: u32,
    /// Version of the program.
    pub sinew_version: &'static str,
    /// Where the model comes from.
    pub model: String,
    /// Name of the list of test cycles.
    pub test: String,
    /// Test cycles.
    pub cycles: usize,
    /// Frames of all test cycles.
    pub frames: usize,
    /// Repetitions where noise or particles are drawn.
    pub seeds: u64,
    /// Table 1 and what figure 4a shows.
    pub noise: Vec<Cell>,
    /// `coupled --smooth` under the conditions of table 1.
    pub smoothed: Vec<Cell>,
    /// Table 2.
    pub particles: Vec<Cell>,
    /// Figure 4b.
    pub sparse: Vec<Cell>,
    /// Figure 5a.
    pub sparse_particles: Vec<Cell>,
    /// Figure 5b.
    pub starts: Vec<Cell>,
    /// Recordings without a break.
    pub long_runs: Vec<LongRun>,
}

impl CyclicReport {
    /// All cells with the name of their table.
    pub fn cells(&self) -> impl Iterator<Item = (&'static str, &Cell)> {
        let tables = [
            ("table-1", &self.noise),
            ("smoothed", &self.smoothed),
            ("table-2", &self.particles),
            ("figure-4b", &self.sparse),
            ("figure-5a", &self.sparse_particles),
            ("figure-5b", &self.starts),
        ];
        tables.into_iter().flat_map(|(name, cells)| cells.iter().map(move |cell| (name, cell)))
    }

    /// One line a cell.
    #[must_use]
    pub fn to_csv(&self) -> String {
        let mut text = String::from(
            "table,protocol,filter,start,sigma_deg,particles,updates,error_deg,long_error_deg,late_error_deg,inside_90",
        );
        for name in &COLUMNS[1..] {
            let _ = write!(text, ",{}", name.replace("_rad", "_error_deg"));
        }
        text.push('\n');
        for (table, cell) in self.cells() {
            let particles = cell.particles.map_or_else(String::new, |count| count.to_string());
            let _ = write!(
                text,
                "{table},{},{},{},{:.0},{particles},{},{:.4},{:.4},{:.4},{:.4}",
                cell.protocol.name(),
                cell.filter.name(),
                format!("{:?}", cell.start).to_lowercase(),
                cell.sigma_deg,
                cell.updates,
                cell.error_deg,
                cell.long_error_deg,
                cell.late_error_deg,
                cell.inside_90
            );
            for angle in 0..ANGLES {
                let _ = write!(text, ",{:.4}", cell.each_deg[angle]);
            }
            text.push('\n');
        }
        text
    }

    /// Tables 1 and 2 and the sparse measurements, for a terminal.
    #[must_use]
    pub fn to_text(&self) -> String {
        let mut text = format!(
            "{} test cycles, {} frames ({}); model: {}; mean absolute error over 13 angles (nine long ones), degrees\n",
            self.cycles, self.frames, self.test, self.model
        );
        for row in self.noise.chunks(SIGMAS_DEG.len()) {
            let Some(first) = row.first() else { continue };
            if first.filter == FilterName::Paper {
                let sigmas: String =
                    SIGMAS_DEG.iter().map(|sigma| format!("{:>16}", format!("sigma {sigma}"))).collect();
                let _ = writeln!(text, "\n{:<12}{sigmas}", first.protocol.name());
            }
            let _ = writeln!(text, "{:<12}{}", first.filter.name(), errors_text(row));
            if first.filter == FilterName::Coupled {
                let same = |cell: &&[Cell]| cell.first().is_some_and(|cell| cell.protocol == first.protocol);
                for smoothed in self.smoothed.chunks(SIGMAS_DEG.len()).filter(same) {
                    let _ = writeln!(text, "{:<12}{}", "  --smooth", errors_text(smoothed));
                }
            }
        }
        let inside = |filter: FilterName| {
            let cells: Vec<f64> = self
                .noise
                .iter()
                .filter(|cell| cell.filter == filter && cell.protocol == super::Protocol::Noisy)
                .map(|cell| cell.inside_90)
                .collect();
            cells.iter().sum::<f64>() / cells.len().max(1) as f64
        };
        let _ = writeln!(text, "\ntruth inside the 90 % band (noisy, all sigmas):");
        for filter in super::experiments::FILTERS {
            let _ = writeln!(text, "{:<12}{:>15.1} %", filter.name(), 100.0 * inside(filter));
        }
        let _ = writeln!(text, "\ntwo updates a cycle, sigma 6:");
        for cell in self.sparse.iter().filter(|cell| cell.updates.starts_with("two")) {
            let _ = writeln!(text, "{:<12}{:<12}{:>8.2}", cell.filter.name(), cell.protocol.name(), cell.error_deg);
        }
        if !self.long_runs.is_empty() {
            text.push_str(&long_runs_text(&self.long_runs));
        }
        if !self.particles.is_empty() {
            let _ = writeln!(text, "\nparticle filter, exact-mean, sigma 29:");
            for cell in &self.particles {
                let _ = writeln!(text, "{:>12}{:>16.2}", cell.particles.unwrap_or(0), cell.error_deg);
            }
        }
        text
    }
}

fn errors_text(row: &[Cell]) -> String {
    let cell = |cell: &Cell| format!("{:>16}", format!("{:.2} ({:.2})", cell.error_deg, cell.long_error_deg));
    row.iter().map(cell).collect()
}

fn long_runs_text(runs: &[LongRun]) -> String {
    let mut text = format!(
        "\n{:<40}{:<12}{:>8}{:>9}{:>11}{:>12}{:>11}{:>10}\n",
        "without a break (noisy, sigma 6)",
        "filter",
        "cycles",
        "counted",
        "phase rms",
        "about mean",
        "phase max",
        "cadence"
    );
    for run in runs {
        let _ = writeln!(
            text,
            "{:<40}{:<12}{:>8.2}{:>9.2}{:>11.3}{:>12.3}{:>11.3}{:>8.1} %",
            run.name,
            run.filter.name(),
            run.cycles,
            run.counted_cycles,
            run.phase_rms,
            run.phase_spread,
            run.phase_max,
            100.0 * run.cadence_error
        );
    }
    text
}
