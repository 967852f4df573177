//! The estimated figure drawn on the person's own frames.

use super::figure::{measured, pixels};
use crate::cyclic::report::body::Body;
use crate::cyclic::report::joints::{Figure, in_image};
use crate::cyclic::tracking::Tracked;
use crate::cyclic::tracking::summary::cadence_per_min;
use crate::cyclic::{AngleTable, CyclicError};
use crate::draw::stick_figure::{FigureStyle, caption, draw_figure};
use crate::error::{Context, Result};
use crate::images::{InputError, list_images, load_rgb};
use crate::output::OutputDir;
use crate::track::pictures::overlay_names;
use image::RgbImage;
use rayon::prelude::*;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

/// Images of a recording in natural order: frame k of the table is image k, counted from 0.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct OverlayFrames {
    files: Vec<PathBuf>,
}

/// What came of the overlays.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Overlaid {
    /// Pictures that were written.
    pub written: usize,
    /// Why others were not, one sentence each, in the order of the frames.
    pub skipped: Vec<String>,
}

impl OverlayFrames {
    /// The images of `folder`.
    ///
    /// # Errors
    /// The folder is missing or holds no image.
    pub fn open(folder: &Path) -> Result<Self, InputError> {
        Ok(Self { files: list_images(folder)? })
    }

    /// File names in the order of frames.
    #[must_use]
    pub fn names(&self) -> Vec<String> {
        let name = |file: &PathBuf| file.file_name().unwrap_or_default().to_string_lossy().into_owned();
        self.files.iter().map(name).collect()
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

    /// Draws `figures` (one a row of `table`) on their images and writes them into `folder`. A
    /// frame without an image, an image that cannot be read, and one of another size than the
    /// first are skipped and reported. Nothing more is drawn once `stop` is set.
    ///
    /// # Errors
    /// A picture that cannot be written.
    pub fn draw(
        &self,
        (table, tracked): (&AngleTable, &Tracked),
        figures: &[Figure],
        body: &Body,
        folder: &OutputDir,
        stop: &AtomicBool,
    ) -> Result<Overlaid> {
        let names = overlay_names(&self.files);
        let image = |frame: u64| usize::try_from(frame).ok().and_then(|frame| self.files.get(frame));
        let rows: Vec<usize> = (0..figures.len()).filter(|row| image(figures[*row].frame).is_some()).collect();
        let size = rows.iter().find_map(|row| Some(load_rgb(image(figures[*row].frame)?).ok()?.dimensions()));
        let results: Vec<Result<Option<String>>> = rows
            .par_iter()
            .filter(|_| !stop.load(Ordering::Relaxed))
            .map(|row| {
                let figure = &figures[*row];
                let file = image(figure.frame).with_context(|| format!("frame {} has no image", figure.frame))?;
                let mut picture = match load_rgb(file) {
                    Ok(picture) => picture,
                    Err(error) => return Ok(Some(error.to_string())),
                };
                if let Some((width, height)) = size.filter(|size| *size != picture.dimensions()) {
                    let (other, name) = (picture.dimensions(), file.display());
                    return Ok(Some(format!(
                        "`{name}` has {} x {} pixels, the first image {width} x {height}",
                        other.0, other.1
                    )));
                }
                draw_row(&mut picture, table, tracked, *row, figure, body);
                folder.write_frame_png(&names[figure.frame as usize].1, &picture)?;
                Ok(None)
            })
            .collect();
        let mut overlaid = Overlaid::default();
        for result in results {
            match result? {
                Some(reason) => overlaid.skipped.push(reason),
                None => overlaid.written += 1,
            }
        }
        let without = figures.len() - rows.len();
        if without > 0 {
            let (count, last) = (self.files.len(), figures.last().map_or(0, |figure| figure.frame));
            overlaid.skipped.push(format!(
                "{without} rows have no image: the folder holds {count}, frame numbers go up to {last} (frame 0 is the first image)"
            ));
        }
        Ok(overlaid)
    }
}

/// The measured figure thin and grey, the estimated one on it, and position and cadence in words.
fn draw_row(picture: &mut RgbImage, table: &AngleTable, tracked: &Tracked, row: usize, figure: &Figure, body: &Body) {
    let measured_row = &table.rows()[row];
    let side = body.side(measured_row);
    let seen = measured(measured_row, body, body.root(measured_row));
    draw_figure(picture, &pixels(&in_image(&seen, side)), FigureStyle::Faint);
    draw_figure(picture, &pixels(&in_image(&figure.joints_about(figure.root), side)), FigureStyle::OnPicture);
    let position = tracked.frames[row].estimate.cycle_position;
    let (cadence, _) = cadence_per_min(tracked, row);
    caption(picture, &format!("frame {}  cycle {position:.2}  {cadence:.1} a minute", figure.frame));
}
