//! The tables and figures of the three papers, theirs beside ours: `sinew-lab reproduce`.

pub mod arm;
pub mod arm_figures;
pub mod body_panels;
pub mod cyclic;
pub mod film;
pub mod goals_against_angles;
pub mod matrix;
pub mod open_numbers;
pub mod page;
pub mod pik;
pub mod pik_geometry;
pub mod plot;
pub mod printed;
#[cfg(feature = "png")]
pub mod raster;
pub mod runs;

use page::Page;
use plot::Plot;
use std::path::Path;

/// What a reproduction is made with.
#[derive(Debug, Clone, Copy)]
pub struct Material<'a> {
    /// Folder of the recordings.
    pub data: &'a Path,
    /// Whether fewer seeds and particles are run.
    pub is_quick: bool,
    /// Larger numbers of particles are left out.
    pub max_particles: usize,
}

/// A page with the pictures that stand beside it.
#[derive(Debug, Default)]
pub struct Made {
    /// The page.
    pub page: Page,
    /// SVG plots with their file names.
    pub plots: Vec<(String, Plot)>,
    /// Other SVG documents with their file names.
    pub drawings: Vec<(String, String)>,
    /// Drawn pictures with their file names.
    pub pictures: Vec<(String, image::RgbImage)>,
}

/// Number of seeds of a run, from 1 on.
#[must_use]
pub const fn seeds(is_quick: bool, all: u64) -> u64 {
    if is_quick { 2 } else { all }
}

/// What stands beside a trend without numbers, by whether it comes out here.
fn of_trend(comes_out: bool) -> String {
    if comes_out { "none in the trend" } else { "the trend does not come out" }.to_owned()
}

/// `value` with its difference from `paper`, both as they are written.
fn compared(paper: f64, value: f64, decimals: usize) -> (String, String, String) {
    let text = |number: f64| format!("{number:.decimals$}");
    (text(paper), text(value), format!("{:+.decimals$}", value - paper))
}
