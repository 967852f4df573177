//! The figure alone on a blank canvas, walking on the spot, as a GIF that plays at the recording's
//! own speed.

use super::figure::{measured, pixels};
use crate::cyclic::AngleTable;
use crate::cyclic::export::trc::JointPositions;
use crate::cyclic::image_joints::Point;
use crate::cyclic::report::body::Body;
use crate::cyclic::report::joints::Figure;
use crate::draw::stick_figure::{FigureStyle, caption, draw_figure};
use crate::error::Result;
use crate::output::write_atomically;
use image::codecs::gif::{GifEncoder, Repeat};
use image::{Delay, DynamicImage, Frame, Rgb, RgbImage};
use rayon::prelude::*;
use std::path::Path;

/// Size of the canvas, pixels.
const SIZE_PX: [u32; 2] = [360, 440];
/// Room around the figure's whole path, pixels.
const MARGIN_PX: f64 = 30.0;
/// Maximum rate, pictures a second.
const PICTURES_PER_S: f64 = 20.0;
/// Maximum duration, seconds; the rest is left out.
pub const LONGEST_S: f64 = 60.0;
/// Longest time that a picture stands, seconds: longer gaps between rows are cut.
const LONGEST_PICTURE_S: f64 = 1.0;
/// Unit of time in a GIF, seconds.
const TICK_S: f64 = 0.01;
/// Speed of the choice of colours, 1 to 30: few colours need no more.
const SPEED: i32 = 30;
/// The root: the figure stays where it is.
const ROOT: Option<Point> = Some([0.0, 0.0]);

/// A row that is shown, and for how many ticks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Picture {
    row: usize,
    ticks: u32,
}

/// Rows that are shown: each as long as it takes to the next one, rounded so that no rounding adds
/// up.
fn schedule(frames: &[u64], rate_hz: f64) -> Vec<Picture> {
    let mut shown = vec![(0, 0.0)];
    let (mut time, mut due) = (0.0, 1.0 / PICTURES_PER_S);
    for (row, pair) in frames.windows(2).enumerate() {
        time += ((pair[1] - pair[0]) as f64 / rate_hz).min(LONGEST_PICTURE_S);
        if time > LONGEST_S {
            break;
        }
        if time + 1.0e-9 >= due {
            shown.push((row + 1, time));
            due = (due + 1.0 / PICTURES_PER_S).max(time);
        }
    }
    let end = shown[shown.len() - 1].1 + 1.0 / PICTURES_PER_S;
    let ends = shown[1..].iter().map(|picture| picture.1).chain([end]);
    let tick = |time: f64| (time / TICK_S).round();
    shown
        .iter()
        .zip(ends)
        .map(|(picture, end)| Picture { row: picture.0, ticks: (tick(end) - tick(picture.1)).max(1.0) as u32 })
        .collect()
}

/// Scale and shift that take the path of all figures into the canvas.
struct Framing {
    scale: f64,
    middle: Point,
}

impl Framing {
    fn of<'a>(figures: impl Iterator<Item = &'a JointPositions>) -> Self {
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for point in figures.flatten().flatten() {
            for axis in 0..2 {
                low[axis] = low[axis].min(point[axis]);
                high[axis] = high[axis].max(point[axis]);
            }
        }
        let room = SIZE_PX.map(|size| f64::from(size) - 2.0 * MARGIN_PX);
        let scale = (0..2).map(|axis| room[axis] / (high[axis] - low[axis]).max(1.0e-9)).fold(f64::INFINITY, f64::min);
        if scale.is_finite() && low[0].is_finite() {
            Self { scale, middle: std::array::from_fn(|axis| 0.5 * (low[axis] + high[axis])) }
        } else {
            Self { scale: 1.0, middle: [0.0; 2] }
        }
    }

    fn place(&self, joints: &JointPositions) -> JointPositions {
        joints.map(|joint| {
            let point = joint?;
            Some(std::array::from_fn(|axis| {
                self.scale * (point[axis] - self.middle[axis]) + 0.5 * f64::from(SIZE_PX[axis])
            }))
        })
    }
}

/// Writes the animation of `figures` (one a row of `table`) to `path`: what was measured thin and
/// grey behind the estimate. Facing right, whichever way the person went.
///
/// # Errors
/// Names the path with what the operating system refused.
pub fn write(path: &Path, table: &AngleTable, figures: &[Figure], body: &Body, rate_hz: f64) -> Result<()> {
    let frames: Vec<u64> = figures.iter().map(|figure| figure.frame).collect();
    let pictures = schedule(&frames, rate_hz);
    let estimates: Vec<JointPositions> =
        pictures.iter().map(|picture| figures[picture.row].joints_about(ROOT)).collect();
    let framing = Framing::of(estimates.iter());
    let draw = |(picture, estimate): (&Picture, &JointPositions)| {
        let mut canvas = RgbImage::from_pixel(SIZE_PX[0], SIZE_PX[1], Rgb([255; 3]));
        let seen = measured(&table.rows()[picture.row], body, ROOT);
        draw_figure(&mut canvas, &pixels(&framing.place(&seen)), FigureStyle::Faint);
        draw_figure(&mut canvas, &pixels(&framing.place(estimate)), FigureStyle::OnCanvas);
        caption(&mut canvas, &[format!("frame {}", frames[picture.row])]);
        let delay = Delay::from_numer_denom_ms(10 * picture.ticks, 1);
        Frame::from_parts(DynamicImage::ImageRgb8(canvas).into_rgba8(), 0, 0, delay)
    };
    write_atomically(path, |writer| {
        let mut encoder = GifEncoder::new_with_speed(writer, SPEED);
        encoder.set_repeat(Repeat::Infinite)?;
        let all: Vec<(&Picture, &JointPositions)> = pictures.iter().zip(&estimates).collect();
        for some in all.chunks(64) {
            let drawn: Vec<Frame> = some.par_iter().map(|picture| draw(*picture)).collect();
            encoder.encode_frames(drawn)?;
        }
        Ok(())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_plays_at_the_speed_of_the_recording() {
        for rate_hz in [60.0, 25.0, 29.97, 7.0] {
            let frames: Vec<u64> = (5..305).collect();
            let pictures = schedule(&frames, rate_hz);
            let ticks: u32 = pictures.iter().map(|picture| picture.ticks).sum();
            let last = pictures[pictures.len() - 1].row as f64 / rate_hz + 1.0 / PICTURES_PER_S;
            assert!((f64::from(ticks) * TICK_S - last).abs() < 0.011, "{rate_hz}: {ticks} ticks for {last} seconds");
            assert!(pictures.windows(2).all(|pair| pair[0].row < pair[1].row && pair[0].ticks >= 3));
        }
        assert_eq!(schedule(&[9], 60.0), [Picture { row: 0, ticks: 5 }]);
    }

    #[test]
    fn gaps_are_cut_and_long_recordings_end() {
        let gap = schedule(&[0, 1, 2, 900, 901], 10.0);
        assert_eq!(gap.iter().map(|picture| picture.ticks).collect::<Vec<_>>(), [10, 10, 100, 10, 5]);
        let long: Vec<u64> = (0..100_000).collect();
        let pictures = schedule(&long, 60.0);
        assert!(pictures.len() <= (LONGEST_S * PICTURES_PER_S) as usize + 1 && pictures.len() > 1000);
    }
}
