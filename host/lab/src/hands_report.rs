//! Scores of both hands on real frames over several seeds, and the project's floors for them.

use super::hand_ranking::{self, HandRanking};
use super::hands::{HandScores, MovingWindow, ReferenceBox, score};
use anyhow::Result;
use image::RgbImage;
use rayon::prelude::*;
use serde::Serialize;
use serde_json::json;
use sinew::config::Config;
use sinew::resume::Cells;
use sinew::skin::SkinModel;
use statrs::statistics::{Data, OrderStatistics};
use std::fmt::Write;

/// Smallest share of the boxes, on whole frames, with a hand inside.
pub const INSIDE_FLOOR: f64 = 0.95;
/// Smallest share of the boxes, through the moving window, with a hand near the centre.
pub const CENTRED_FLOOR: f64 = 0.85;
/// Largest share of confused frames, on whole frames and through the window.
pub const CONFUSED_CEILING: f64 = 0.05;

/// A share over seeds.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct SeedSpread {
    /// Median.
    pub median: f64,
    /// Lowest.
    pub lowest: f64,
    /// Highest.
    pub highest: f64,
}

impl SeedSpread {
    /// Of one value a seed; NaN where there is none.
    #[must_use]
    pub fn of(values: &[f64]) -> Self {
        Self {
            median: Data::new(values.to_vec()).median(),
            lowest: values.iter().copied().fold(f64::NAN, f64::min),
            highest: values.iter().copied().fold(f64::NAN, f64::max),
        }
    }
}

/// Scores of one way to see the frames.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct ViewScores {
    /// Boxes with the nearer hand inside.
    pub inside: SeedSpread,
    /// Boxes with the nearer hand near the centre.
    pub centred: SeedSpread,
    /// Frames in which the sides traded boxes or sat in one while two were there.
    pub confused: SeedSpread,
    /// Boxes that the best two constant points hit.
    pub constant_inside: f64,
    /// Boxes near whose centres the best two constant points are.
    pub constant_centred: f64,
    /// Boxes that counted.
    pub boxes: usize,
}

impl ViewScores {
    /// Of one run a seed; `None` where there is no run.
    #[must_use]
    pub fn of(runs: &[HandScores]) -> Option<Self> {
        let first = runs.first()?;
        let over = |part: fn(&HandScores) -> f64| SeedSpread::of(&runs.iter().map(part).collect::<Vec<_>>());
        Some(Self {
            inside: over(|run| run.inside),
            centred: over(|run| run.centred),
            confused: over(|run| run.confused),
            constant_inside: first.constant_inside,
            constant_centred: first.constant_centred,
            boxes: first.boxes,
        })
    }
}

/// How the frames are tracked.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct HandsOptions {
    /// Frames per second of the camera.
    pub rate_hz: f64,
    /// Seeds 1 to this one.
    pub seeds: u64,
    /// Width and height of the moving window, pixels.
    pub window_px: (u32, u32),
}

/// Those of `sinew evaluate hands` where it is not given others.
pub const DEFAULT_OPTIONS: HandsOptions = HandsOptions { rate_hz: 15.0, seeds: 5, window_px: (440, 360) };

/// All scores of one sequence.
#[derive(Debug, Clone, Serialize)]
pub struct HandsReport {
    /// What this is: `sinew-evaluate-hands`.
    pub format: &'static str,
    /// Version of the form.
    pub version: u32,
    /// Version of the project.
    pub sinew_version: &'static str,
    /// How the frames were tracked.
    pub options: HandsOptions,
    /// Number of frames.
    pub frames: usize,
    /// Scores on whole frames.
    pub whole: ViewScores,
    /// Scores through the moving window.
    pub window: ViewScores,
    /// Ranking of the blobs by the hand likelihood, on whole frames.
    pub ranking: HandRanking,
}

/// Tracks both hands with every seed, whole and through the window, and ranks the blobs. A cell is
/// one seed on the whole frames or through the window.
///
/// # Errors
/// As [`score`] and [`Cells::cell`]; zero seeds.
pub fn report(
    frames: &[Option<RgbImage>],
    boxes: &[ReferenceBox],
    options: HandsOptions,
    config: &Config,
    skin: &SkinModel,
    cells: &Cells<'_>,
) -> Result<HandsReport> {
    let view = |window: Option<MovingWindow>| -> Result<ViewScores> {
        let one = |seed| {
            let key = json!([if window.is_some() { "window" } else { "whole" }, seed]);
            cells.cell(&key, || score(frames, boxes, window, config, skin, (options.rate_hz, seed)))
        };
        let runs: Vec<HandScores> = (1..=options.seeds).into_par_iter().map(one).collect::<Result<_>>()?;
        ViewScores::of(&runs).ok_or_else(|| anyhow::anyhow!("zero seeds were asked for; give at least one"))
    };
    Ok(HandsReport {
        format: "sinew-evaluate-hands",
        version: 1,
        sinew_version: env!("CARGO_PKG_VERSION"),
        options,
        frames: frames.len(),
        whole: view(None)?,
        window: view(Some(MovingWindow { size_px: options.window_px }))?,
        ranking: hand_ranking::rank(frames, boxes, skin)?,
    })
}

impl HandsReport {
    /// What misses the project's floors, one sentence each; empty where all are met.
    #[must_use]
    pub fn misses(&self) -> Vec<String> {
        let [whole, window] = [&self.whole, &self.window];
        let least = |what: &str, value: f64, floor: f64| {
            // NaN misses, too.
            let met = value >= floor;
            (!met).then(|| format!("{what}: {value:.3}, at least {floor:.2} was wanted"))
        };
        let most = |what: &str, value: f64| {
            let met = value <= CONFUSED_CEILING;
            (!met).then(|| format!("{what}: {value:.3}, at most {CONFUSED_CEILING:.2} was wanted"))
        };
        let all = [
            least("boxes with a hand inside, whole frames", whole.inside.median, INSIDE_FLOOR),
            least("boxes with a hand near the centre, moving window", window.centred.median, CENTRED_FLOOR),
            most("confused frames, whole frames", whole.confused.median),
            most("confused frames, moving window", window.confused.median),
        ];
        all.into_iter().flatten().collect()
    }

    /// A row for each way to see the frames and each score, all shares.
    #[must_use]
    pub fn to_csv(&self) -> String {
        let mut text = String::from("frames_seen,score,median,lowest,highest,two_constants,boxes\n");
        for (seen, view) in [("whole", &self.whole), ("window", &self.window)] {
            let scores = [
                ("inside the box", view.inside, Some(view.constant_inside)),
                ("near its centre", view.centred, Some(view.constant_centred)),
                ("confused frames", view.confused, None),
            ];
            for (score, SeedSpread { median, lowest, highest }, constant) in scores {
                let constant = constant.map_or_else(String::new, |share| format!("{share:.4}"));
                let boxes = view.boxes;
                // Writing to a string cannot fail.
                let _ = writeln!(text, "{seen},{score},{median:.4},{lowest:.4},{highest:.4},{constant},{boxes}");
            }
        }
        text
    }

    /// The report as a table for people.
    #[must_use]
    pub fn table(&self) -> String {
        let HandsOptions { seeds, rate_hz, window_px: (width, height) } = self.options;
        let mut text =
            format!("{} frames at {rate_hz} Hz, seeds 1 to {seeds}: median (lowest to highest)\n", self.frames);
        let mut line = |cells: [&str; 4]| {
            let [a, b, c, d] = cells;
            let _ = writeln!(text, "{a:<16} {b:<22} {c:<22} {d}");
        };
        let spread = |s: SeedSpread| format!("{:.3} ({:.3} to {:.3})", s.median, s.lowest, s.highest);
        line(["", "inside the box", "near its centre", "confused frames"]);
        for (name, view) in [("whole".to_owned(), self.whole), (format!("window {width}x{height}"), self.window)] {
            line([&name, &spread(view.inside), &spread(view.centred), &spread(view.confused)]);
            let (inside, centred) = (format!("{:.3}", view.constant_inside), format!("{:.3}", view.constant_centred));
            line(["  two constants", &inside, &centred, &format!("({} boxes)", view.boxes)]);
        }
        let area = |area: Option<f64>| area.map_or("none".to_owned(), |area| format!("{area:.3}"));
        let HandRanking { hands, others, filled_area, paper_area } = self.ranking;
        let (filled, paper) = (area(filled_area), area(paper_area));
        let _ = writeln!(
            text,
            "hand likelihood, ROC area of {hands} hands against {others} other blobs: {filled}, as printed in the paper {paper}"
        );
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn view(inside: f64, centred: f64, confused: f64) -> ViewScores {
        let [inside, centred, confused] = [inside, centred, confused].map(|value| SeedSpread::of(&[value]));
        ViewScores { inside, centred, confused, constant_inside: 0.1, constant_centred: 0.1, boxes: 9 }
    }

    fn report_of(whole: ViewScores, window: ViewScores) -> HandsReport {
        let options = HandsOptions { rate_hz: 15.0, seeds: 1, window_px: (4, 3) };
        let ranking = HandRanking { hands: 1, others: 0, filled_area: None, paper_area: None };
        HandsReport {
            format: "sinew-evaluate-hands",
            version: 1,
            sinew_version: "0",
            options,
            frames: 1,
            whole,
            window,
            ranking,
        }
    }

    #[test]
    fn every_floor_is_checked_and_nan_misses() {
        assert!(report_of(view(0.95, 0.0, 0.05), view(0.0, 0.85, 0.05)).misses().is_empty());
        assert_eq!(report_of(view(0.94, 0.0, 0.06), view(0.0, 0.84, 0.06)).misses().len(), 4);
        assert_eq!(report_of(view(f64::NAN, 0.0, 0.0), view(0.0, f64::NAN, 0.0)).misses().len(), 2);
    }

    #[test]
    fn the_csv_has_a_row_for_each_score_of_each_view() {
        let text = report_of(view(0.5, 0.25, 0.0), view(1.0, 0.75, 0.125)).to_csv();
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len(), 7);
        assert_eq!(lines[1], "whole,inside the box,0.5000,0.5000,0.5000,0.1000,9");
        assert_eq!(lines[6], "window,confused frames,0.1250,0.1250,0.1250,,9");
    }

    #[test]
    fn a_spread_is_the_median_between_the_extremes() {
        assert_eq!(SeedSpread::of(&[0.9, 0.5, 0.7]), SeedSpread { median: 0.7, lowest: 0.5, highest: 0.9 });
    }
}
