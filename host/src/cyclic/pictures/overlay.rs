//! The estimated figure drawn on the person's own frames.

use super::figure::{measured, pixels};
use crate::cyclic::anatomy::{PAIRS, of_pose};
use crate::cyclic::report::body::Body;
use crate::cyclic::report::joints::{Figure, in_image};
use crate::cyclic::tracking::Tracked;
use crate::cyclic::tracking::summary::cadence_per_min;
use crate::cyclic::{AngleTable, CyclicError};
use crate::draw::stick_figure::{FigureStyle, caption, draw_figure};
use crate::error::Result;
use crate::output::OutputDir;
use crate::track::pictures::overlay_names;
use crate::track::{FrameSource, SkippedImage};
use image::RgbImage;
use rayon::prelude::*;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

/// Pictures that are held at once.
const HELD: usize = 8;

/// Pictures of a recording: a folder of images in natural order, or a video. Frame k of the table
/// is picture k, counted from 0.
#[derive(Debug)]
pub struct OverlayFrames {
    source: FrameSource,
    /// Names of the overlays of a folder's images.
    overlays: Vec<(String, String)>,
}

/// What came of the overlays.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Overlaid {
    /// Pictures that were written.
    pub written: usize,
    /// Why others were not, one sentence each, in the order of the frames.
    pub skipped: Vec<String>,
}

/// What is drawn: one figure a row of the table.
#[derive(Debug, Clone, Copy)]
pub struct Drawn<'a> {
    /// The table that was tracked.
    pub table: &'a AngleTable,
    /// What came of it.
    pub tracked: &'a Tracked,
    /// The estimated figures.
    pub figures: &'a [Figure],
    /// The person's lengths.
    pub body: &'a Body,
}

impl OverlayFrames {
    /// The pictures at `path`, a folder or a video; of a video `rate_hz` frames per second.
    ///
    /// # Errors
    /// What is there is neither, cannot be read, or has images of different sizes.
    pub fn open(path: &Path, rate_hz: f64) -> Result<Self> {
        let source = FrameSource::open(path, false, rate_hz)?;
        Ok(Self { overlays: overlay_names(source.files()), source })
    }

    /// File names of the pictures in the order of frames.
    #[must_use]
    pub fn names(&self) -> Vec<String> {
        (0..self.source.count()).map(|frame| self.source.name(frame)).collect()
    }

    /// Checks that `table` has the place of the person in the picture.
    ///
    /// # Errors
    /// It does not: it comes from a motion in space, or from nowhere.
    pub fn check(table: &AngleTable) -> Result<(), CyclicError> {
        if super::figure::has_pixels(table) {
            return Ok(());
        }
        let rule = "needs a table with the place of the person in the picture (hip_center_u_px and so on), as `sinew angles` writes \
            it from 2D keypoints; this one has angles only: use --animation";
        Err(CyclicError::parameter("overlay", rule))
    }

    /// Draws the figures on their pictures and writes them into `folder`. A frame without a picture
    /// and one that cannot be read are skipped and reported. Nothing more is drawn once `stop` is
    /// set.
    ///
    /// # Errors
    /// A picture that cannot be written, a video that breaks off.
    pub fn draw(&mut self, drawn: &Drawn<'_>, folder: &OutputDir, stop: &AtomicBool) -> Result<Overlaid> {
        let numbers: Vec<Option<usize>> =
            drawn.figures.iter().map(|figure| usize::try_from(figure.frame).ok()).collect();
        let (mut overlaid, mut row, mut count) = (Overlaid::default(), 0, self.source.count());
        while let Some(begin) = numbers.get(row).copied().flatten().filter(|begin| *begin < count) {
            if stop.load(Ordering::Relaxed) {
                return Ok(overlaid);
            }
            let pictures = self.source.load(begin, HELD)?;
            if pictures.is_empty() {
                count = begin;
            }
            let end = row
                + numbers[row..]
                    .iter()
                    .take_while(|number| number.is_some_and(|number| number < begin + pictures.len()))
                    .count();
            let written: Vec<Result<Option<String>>> = (row..end)
                .into_par_iter()
                .map(|row| self.draw_row(drawn, row, &pictures[drawn.figures[row].frame as usize - begin], folder))
                .collect();
            for reason in written {
                match reason? {
                    Some(reason) => overlaid.skipped.push(reason),
                    None => overlaid.written += 1,
                }
            }
            row = end;
        }
        if let Some(last) = drawn.figures[row..].last() {
            let (without, last) = (drawn.figures.len() - row, last.frame);
            overlaid.skipped.push(format!(
                "{without} rows have no image: there are {count}, frame numbers go up to {last} (frame 0 is the first image)"
            ));
        }
        Ok(overlaid)
    }

    /// Why the row's picture was not drawn, if it was not.
    fn draw_row(
        &self,
        drawn: &Drawn<'_>,
        row: usize,
        picture: &Result<RgbImage, SkippedImage>,
        folder: &OutputDir,
    ) -> Result<Option<String>> {
        let mut picture = match picture {
            Ok(picture) => picture.clone(),
            Err(skipped) => return Ok(Some(format!("`{}`: {}", skipped.file, skipped.reason))),
        };
        draw_figures(&mut picture, drawn, row);
        let frame = drawn.figures[row].frame as usize;
        let name = self.overlays.get(frame).map_or_else(|| self.source.name(frame), |(_, overlay)| overlay.clone());
        folder.write_frame_png(&name, &picture)?;
        Ok(None)
    }
}

/// The measured figure thin and grey, the estimated one on it, and position, cadence and flexion
/// angles in words.
fn draw_figures(picture: &mut RgbImage, drawn: &Drawn<'_>, row: usize) {
    let (measured_row, figure, body) = (&drawn.table.rows()[row], &drawn.figures[row], drawn.body);
    let side = body.side(measured_row);
    let seen = measured(measured_row, body, body.root(measured_row));
    draw_figure(picture, &pixels(&in_image(&seen, side)), FigureStyle::Faint);
    draw_figure(picture, &pixels(&in_image(&figure.joints_about(figure.root), side)), FigureStyle::OnPicture);
    let position = drawn.tracked.frames[row].estimate.cycle_position;
    let (cadence, _) = cadence_per_min(drawn.tracked, row);
    let mut lines = vec![format!("frame {}  cycle {position:.2}  {cadence:.1} a minute", figure.frame)];
    lines.extend(angle_lines(figure));
    caption(picture, &lines);
}

/// One line for each joint: its flexion left and right, whole degrees; `-` where it is not known.
fn angle_lines(figure: &Figure) -> impl Iterator<Item = String> {
    let angles_deg = of_pose(&figure.angles_rad);
    let cell = move |angle: usize| angles_deg[angle].map_or_else(|| "-".to_owned(), |angle| format!("{angle:.0}"));
    PAIRS.into_iter().map(move |(name, left, right)| {
        let joint = name.trim_end_matches("_flexion");
        format!("{joint:<8}  left {:>4}  right {:>4}", cell(left), cell(right))
    })
}
