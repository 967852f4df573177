//! Both hands on real frames with reference boxes: are the tracked hands in the boxes, and do the
//! sides keep apart?

use anyhow::{Context, Result};
use image::{RgbImage, imageops};
use serde::{Deserialize, Serialize};
use sinew::cli::data_error;
use sinew::config::Config;
use sinew::frames::FrameReader;
use sinew::images::folder::load_rgb;
use sinew::skin::SkinModel;
use sinew::track::{ArmSet, FrameFolder, SideChoice};
use sinew_core::camera::Pixel;
use sinew_core::tracker::arm::Status;
use std::path::{Path, PathBuf};

/// A reference box, pixels from the top left corner.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
pub struct ReferenceBox {
    /// Number of the frame in natural order.
    pub frame: usize,
    /// Left edge.
    pub x: f32,
    /// Upper edge.
    pub y: f32,
    /// Width.
    pub w: f32,
    /// Height.
    pub h: f32,
}

/// A box counts as well met where the hand is this near to its centre, in widths and heights.
pub const CENTRED_SHARE: f32 = 0.35;

impl ReferenceBox {
    /// Whether `pixel` lies in the box.
    #[must_use]
    pub fn contains(&self, pixel: Pixel) -> bool {
        pixel.u_px >= self.x && pixel.u_px <= self.x + self.w && pixel.v_px >= self.y && pixel.v_px <= self.y + self.h
    }

    /// Centre of the box.
    #[must_use]
    pub fn centre(&self) -> Pixel {
        Pixel::new(self.x + 0.5 * self.w, self.y + 0.5 * self.h)
    }

    /// Whether `pixel` lies within [`CENTRED_SHARE`] of the width and height from the centre.
    #[must_use]
    pub fn is_centred(&self, pixel: Pixel) -> bool {
        let centre = self.centre();
        (pixel.u_px - centre.u_px).abs() <= CENTRED_SHARE * self.w
            && (pixel.v_px - centre.v_px).abs() <= CENTRED_SHARE * self.h
    }

    fn shifted(self, (left, top): (u32, u32)) -> Self {
        Self { x: self.x - left as f32, y: self.y - top as f32, ..self }
    }
}

/// Reads a table of boxes with the columns frame, x, y, w, h.
///
/// # Errors
/// Names the file and line that cannot be read.
pub fn read_boxes(path: &Path) -> Result<Vec<ReferenceBox>> {
    let mut reader = csv::Reader::from_path(path).with_context(|| {
        format!(
            "boxes `{}` cannot be read; check the path, and give a table with the columns frame,x,y,w,h",
            path.display()
        )
    })?;
    let boxes: Vec<ReferenceBox> = reader
        .deserialize()
        .collect::<Result<_, _>>()
        .with_context(|| format!("boxes `{}`: a row needs frame,x,y,w,h as numbers", path.display()))?;
    if boxes.is_empty() {
        let rule = "has no row; give a table with the columns frame,x,y,w,h";
        return Err(data_error(format!("boxes `{}` {rule}", path.display())));
    }
    Ok(boxes)
}

/// The frames of a folder as `sinew track arm` counts them, all of one size: a number that is
/// missing between those of two pictures is a frame without a picture.
///
/// # Errors
/// A picture that cannot be read or has another size, by name.
pub fn load_frames(folder: &Path) -> Result<Vec<Option<RgbImage>>> {
    let folder = FrameFolder::open(folder, false)?;
    let load = |(frame, file): (usize, &PathBuf)| (!folder.is_missing(frame)).then(|| load_rgb(file)).transpose();
    Ok(folder.files().iter().enumerate().map(load).collect::<Result<_, _>>()?)
}

/// Width and height of the first picture of `frames`, pixels; zero where there is none.
#[must_use]
pub fn size_px(frames: &[Option<RgbImage>]) -> (u32, u32) {
    frames.iter().flatten().next().map_or((0, 0), RgbImage::dimensions)
}

/// A window that moves over the frames, so that no constant answer can do well.
#[derive(Debug, Clone, Copy)]
pub struct MovingWindow {
    /// Width and height of the window, pixels.
    pub size_px: (u32, u32),
}

impl MovingWindow {
    /// Upper left corner in frame `index` of `count`: one turn around the room that the window has.
    #[must_use]
    pub fn corner(&self, index: usize, count: usize, image: (u32, u32)) -> (u32, u32) {
        let turn = std::f32::consts::TAU * index as f32 / count.max(1) as f32;
        let room = |image: u32, window: u32| 0.5 * image.saturating_sub(window) as f32;
        let (u, v) = (room(image.0, self.size_px.0), room(image.1, self.size_px.1));
        let (sine, cosine) = sinew_core::math::sin_cos(turn);
        ((u + u * cosine) as u32, (v + v * sine) as u32)
    }
}

/// What one frame showed and what was answered.
#[derive(Debug, Clone)]
struct Answered {
    boxes: Vec<ReferenceBox>,
    hands: [Option<Pixel>; 2],
}

/// Scores of one run; shares from 0 to 1.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub struct HandScores {
    /// Boxes with the nearer side's hand inside.
    pub inside: f64,
    /// Boxes with the nearer side's hand near the centre.
    pub centred: f64,
    /// Of all frames, those in which the sides traded boxes or sat in one box while two were there.
    pub confused: f64,
    /// Boxes that counted.
    pub boxes: usize,
    /// What the best two constant points reach, as `inside`.
    pub constant_inside: f64,
    /// What the best two constant points reach, as `centred`.
    pub constant_centred: f64,
}

/// Tracks both hands of `frames`, seen whole or through a moving `window`, and scores the answers.
///
/// # Errors
/// As [`ArmSet::new`] and [`FrameReader::read`].
pub fn score(
    frames: &[Option<RgbImage>],
    boxes: &[ReferenceBox],
    window: Option<MovingWindow>,
    config: &Config,
    skin: &SkinModel,
    (rate_hz, seed): (f64, u64),
) -> Result<HandScores> {
    let whole = size_px(frames);
    let size = window.map_or(whole, |window| window.size_px);
    let mut arms = ArmSet::new(config, size, SideChoice::Both, seed)?;
    let mut reader = FrameReader::new(config.likelihood.build()?, config.edges.build()?)?;
    let camera = *arms.models()[0].camera();
    let mut answers = Vec::new();
    for (index, frame) in frames.iter().enumerate() {
        let corner = window.map_or((0, 0), |window| window.corner(index, frames.len(), whole));
        let view = match frame {
            Some(frame) => {
                let seen = imageops::crop_imm(frame, corner.0, corner.1, size.0, size.1).to_image();
                Some(reader.read(&seen, &*skin.for_image(&seen)?)?)
            }
            None => {
                reader.forget_last_frame();
                None
            }
        };
        let timestamp_us = (index as f64 * 1.0e6 / rate_hz) as u64;
        let arm_views = arms.step(timestamp_us, view.as_ref());
        let hand = |arm: usize| {
            let estimate = &arm_views[arm].estimate;
            if estimate.status == Status::Lost { None } else { camera.project(&estimate.joints.hand_m) }
        };
        let inside = |b: &ReferenceBox| {
            let centre = b.centre();
            centre.u_px >= 0.0 && centre.v_px >= 0.0 && centre.u_px < size.0 as f32 && centre.v_px < size.1 as f32
        };
        let own = boxes.iter().filter(|b| b.frame == index).map(|b| b.shifted(corner)).filter(inside).collect();
        answers.push(Answered { boxes: own, hands: [hand(0), hand(1)] });
    }
    Ok(summarise(&answers, size))
}

/// The hand nearest to the box's centre.
fn nearest(hands: &[Option<Pixel>; 2], target: &ReferenceBox) -> Option<Pixel> {
    let distance = |pixel: &Pixel| pixel.distance_px(target.centre());
    hands.iter().flatten().copied().min_by(|a, b| distance(a).total_cmp(&distance(b)))
}

fn summarise(answers: &[Answered], size: (u32, u32)) -> HandScores {
    let boxes: Vec<ReferenceBox> = answers.iter().flat_map(|answer| answer.boxes.iter().copied()).collect();
    let count = boxes.len();
    let share = |test: fn(&ReferenceBox, Pixel) -> bool| {
        let met = answers
            .iter()
            .flat_map(|answer| answer.boxes.iter().map(|b| (b, nearest(&answer.hands, b))))
            .filter(|(b, hand)| hand.is_some_and(|hand| test(b, hand)));
        met.count() as f64 / count.max(1) as f64
    };
    HandScores {
        inside: share(|b, hand| b.contains(hand)),
        centred: share(|b, hand| b.is_centred(hand)),
        confused: confused_share(answers),
        boxes: count,
        constant_inside: best_constants(&boxes, size, |b, point| b.contains(point)),
        constant_centred: best_constants(&boxes, size, |b, point| b.is_centred(point)),
    }
}

/// Share of all frames in which the hands are confused. Both are in one box while two are there, or
/// each is in the box that the other had.
fn confused_share(answers: &[Answered]) -> f64 {
    let mut confused = 0_u32;
    // Whether the left hand was in the box further to the right, when that was last clear.
    let mut order: Option<bool> = None;
    for answer in answers {
        let ([first, second], [Some(left), Some(right)]) = (answer.boxes.as_slice(), answer.hands) else { continue };
        let (west, east) = if first.centre().u_px < second.centre().u_px { (first, second) } else { (second, first) };
        let same = (west.contains(left) && west.contains(right)) || (east.contains(left) && east.contains(right));
        let now = if east.contains(left) && west.contains(right) {
            Some(true)
        } else if west.contains(left) && east.contains(right) {
            Some(false)
        } else {
            None
        };
        let traded = now.is_some() && order.is_some() && now != order;
        confused += u32::from(same || traded);
        order = now.or(order);
    }
    f64::from(confused) / answers.len().max(1) as f64
}

/// Share of the boxes that the best pair of fixed points meets, on a grid of ten pixels.
fn best_constants(boxes: &[ReferenceBox], (width, height): (u32, u32), met: fn(&ReferenceBox, Pixel) -> bool) -> f64 {
    let points: Vec<Vec<bool>> = (0..width)
        .step_by(10)
        .flat_map(|u| (0..height).step_by(10).map(move |v| Pixel::new(u as f32, v as f32)))
        .map(|point| boxes.iter().map(|b| met(b, point)).collect::<Vec<bool>>())
        .filter(|hits| hits.iter().any(|hit| *hit))
        .collect();
    let both = |a: &[bool], b: &[bool]| a.iter().zip(b).filter(|(a, b)| **a || **b).count();
    let best = points.iter().enumerate().flat_map(|(i, a)| points[i..].iter().map(move |b| both(a, b))).max();
    best.unwrap_or(0) as f64 / boxes.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(frame: usize, x: f32) -> ReferenceBox {
        ReferenceBox { frame, x, y: 10.0, w: 20.0, h: 20.0 }
    }

    fn answered(left: f32, right: f32) -> Answered {
        let hands = [Some(Pixel::new(left, 20.0)), Some(Pixel::new(right, 20.0))];
        Answered { boxes: vec![at(0, 0.0), at(0, 100.0)], hands }
    }

    #[test]
    fn hands_in_their_boxes_score_fully_and_trades_are_seen() {
        let good = [answered(110.0, 10.0), answered(112.0, 12.0)];
        let scores = summarise(&good, (200, 50));
        assert_eq!((scores.inside, scores.centred, scores.confused), (1.0, 1.0, 0.0));
        let traded = [answered(110.0, 10.0), answered(10.0, 110.0), answered(10.0, 110.0)];
        assert!((summarise(&traded, (200, 50)).confused - 1.0 / 3.0).abs() < 1.0e-9);
        let same = [answered(110.0, 110.0)];
        assert_eq!(summarise(&same, (200, 50)).confused, 1.0);
        assert_eq!(summarise(&same, (200, 50)).inside, 0.5);
    }

    #[test]
    fn resting_boxes_are_met_by_constants_and_moving_ones_are_not() {
        let resting: Vec<_> = (0..10).map(|frame| at(frame, 40.0)).collect();
        assert_eq!(best_constants(&resting, (300, 50), ReferenceBox::contains_ref), 1.0);
        let moving: Vec<_> = (0..10).map(|frame| at(frame, 28.0 * frame as f32)).collect();
        assert!(best_constants(&moving, (300, 50), ReferenceBox::contains_ref) <= 0.2);
    }

    impl ReferenceBox {
        fn contains_ref(&self, pixel: Pixel) -> bool {
            self.contains(pixel)
        }
    }

    #[test]
    fn the_window_moves_over_all_the_room_it_has() {
        let window = MovingWindow { size_px: (440, 360) };
        let corners: Vec<_> = (0..40).map(|i| window.corner(i, 40, (600, 472))).collect();
        let length: f32 = corners
            .windows(2)
            .map(|pair| (pair[0].0 as f32 - pair[1].0 as f32).hypot(pair[0].1 as f32 - pair[1].1 as f32))
            .sum();
        assert!(length > 100.0, "path of {length} pixels");
        assert!(corners.iter().all(|(u, v)| *u <= 160 && *v <= 112));
    }
}
