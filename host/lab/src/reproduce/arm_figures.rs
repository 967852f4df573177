//! Figures 2 and 3 of the arm paper: temporal edges, the particles' hands and the three best arms,
//! and how many particles are at the hand.

use super::plot::escaped;
use crate::observed::{Footage, ObservedScene};
use crate::score::FIRST_SCORED_FRAME;
use anyhow::{Context, Result};
use serde::{Deserialize, Serialize};
use sinew::frames::FrameView;
use sinew::track::ArmSet;
use sinew_core::camera::Pixel;
use sinew_core::math::Vec3;
use sinew_core::tracker::arm::{ArmOptions, Particle};
use std::fmt::Write;

/// Width of a hand, metres.
/// Chosen: the breadth across the knuckles of an adult, 8 to 9 cm.
const HAND_WIDTH_M: f32 = 0.085;
/// Room left of and below a panel for its axes, pixels.
const MARGIN_PX: (u32, u32) = (48, 56);
/// Pixels from one tick to the next.
const TICK_PX: usize = 100;
/// Signs of what every panel shows.
const BLOB: (&str, &str) = ("<circle r='10' fill='#e8c39e' stroke='#a0703c'/>", "blob, by its area");
const HAND: (&str, &str) = ("<path d='M-10 0h20m-10 -10v20' stroke='#d55e00' stroke-width='3'/>", "true hand");
/// Strokes of the three best arms, the heaviest first and below the others, so that each shows
/// where they coincide.
const BEST: [&str; 3] = [
    "stroke='black' stroke-width='8'",
    "stroke='#56b4e9' stroke-width='4' stroke-dasharray='8 4'",
    "stroke='#d55e00' stroke-width='1.5'",
];

/// What the particles of a tracker show in one frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Shown {
    /// The particles' hands.
    pub hands_px: Vec<Pixel>,
    /// Shoulder, elbow and hand of the three heaviest, the heaviest first.
    pub best_px: Vec<[Pixel; 3]>,
}

/// Shares of particles, mean over the scored frames of one scene.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct AtHand {
    /// Of the particles whose hand is within a hand's width of the true one in the image.
    pub share: f64,
}

/// Tracks `footage` and calls `each` with the frame, the trackers, and shoulder of the estimate.
fn tracked(footage: &Footage<'_>, tracker: &ArmOptions, mut each: impl FnMut(usize, &ArmSet, Vec3)) -> Result<()> {
    let mut config = footage.config.clone();
    config.tracker = *tracker;
    let mut arms = ArmSet::new(&config, footage.size_px, footage.side, footage.seed)?;
    for (index, view) in footage.views.iter().enumerate() {
        let estimate = arms.step(index as u64 * footage.frame_us, Some(view))[0].estimate;
        each(index, &arms, estimate.joints.shoulder_m);
    }
    Ok(())
}

/// What the particles show in `frame`.
///
/// # Errors
/// Names the parameter that cannot be used; footage without that frame.
pub fn shown_in(footage: &Footage<'_>, tracker: &ArmOptions, frame: usize) -> Result<Shown> {
    let mut shown = None;
    tracked(footage, tracker, |index, arms, shoulder_m| {
        if index != frame {
            return;
        }
        let mut heaviest = arms.particles().swap_remove(0);
        let hands_px = hands_px(arms, &heaviest);
        heaviest.sort_by(|a, b| b.1.total_cmp(&a.1));
        let arm = |(particle, _): &(Particle, f32)| arms.joints_px([shoulder_m, particle.elbow_m, particle.hand_m]);
        shown = Some(Shown { hands_px, best_px: heaviest.iter().take(BEST.len()).filter_map(arm).collect() });
    })?;
    shown.with_context(|| format!("the footage has no frame {frame}"))
}

fn hands_px(arms: &ArmSet, particles: &[(Particle, f32)]) -> Vec<Pixel> {
    let camera = *arms.models()[0].camera();
    particles.iter().filter_map(|(particle, _)| camera.project(&particle.hand_m)).collect()
}

/// How many particles are at the hand of `scene`, over the scored frames.
///
/// # Errors
/// Names the parameter that cannot be used.
pub fn at_hand(scene: &ObservedScene, tracker: &ArmOptions) -> Result<AtHand> {
    let (mut sum, mut count) = (0.0, 0.0);
    tracked(&scene.footage(), tracker, |index, arms, _| {
        if index < FIRST_SCORED_FRAME {
            return;
        }
        let (truth, particles) = (&scene.truth[index], arms.particles().swap_remove(0));
        let across = arms.models()[0].camera().project(&(truth.hand_m + Vec3::x() * HAND_WIDTH_M));
        let width_px = across.map_or(0.0, |pixel| pixel.distance_px(truth.hand_px));
        let hands_px = hands_px(arms, &particles);
        let near = hands_px.iter().filter(|pixel| pixel.distance_px(truth.hand_px) <= width_px).count();
        sum += near as f64 / particles.len().max(1) as f64;
        count += 1.0;
    })?;
    Ok(AtHand { share: if count > 0.0 { sum / count } else { 0.0 } })
}

/// What is drawn of one frame.
#[derive(Debug, Clone)]
pub struct Panel<'a> {
    /// Image size.
    pub size_px: (u32, u32),
    /// Blobs and edges.
    pub view: &'a FrameView,
    /// Where hands truly are.
    pub hands_px: Vec<Pixel>,
}

impl<'a> Panel<'a> {
    /// A frame of a rendered scene, with the hand that is tracked.
    #[must_use]
    pub fn of_scene(scene: &'a ObservedScene, frame: usize) -> Self {
        Self { size_px: scene.size_px, view: &scene.views[frame], hands_px: vec![scene.truth[frame].hand_px] }
    }
}

/// One panel in the image's pixels, y down: blobs as circles, true hands as crosses, and marks.
fn panel(shown: &Panel<'_>, title: &str, marks: &str) -> String {
    let (width, height) = shown.size_px;
    let mut svg = format!(
        "<rect width='{width}' height='{height}' fill='#f4f4f4' stroke='black'/><text x='8' y='22' font-size='18'>{}</text>\n",
        escaped(title)
    );
    for blob in &shown.view.candidates {
        let radius = (blob.area_px / std::f32::consts::PI).sqrt();
        let _ = writeln!(
            svg,
            "<circle cx='{:.1}' cy='{:.1}' r='{radius:.1}' fill='#e8c39e' stroke='#a0703c'/>",
            blob.centre.u_px, blob.centre.v_px
        );
    }
    svg.push_str(marks);
    for hand in &shown.hands_px {
        let _ = writeln!(
            svg,
            "<path d='M{:.1} {:.1}h20m-10 -10v20' stroke='#d55e00' stroke-width='3'/>",
            hand.u_px - 10.0,
            hand.v_px
        );
    }
    svg
}

/// Panels, two in a row, each with axes, and a legend below; a legend's sign stands at (0, 0).
fn sheet((width, height): (u32, u32), panels: &[String], legend: &[(&str, &str)]) -> String {
    let (columns, rows) = (panels.len().clamp(1, 2) as u32, panels.len().div_ceil(2) as u32);
    let (step, step_down) = (width + MARGIN_PX.0, height + MARGIN_PX.1);
    let (total, total_down) = (columns * step + 14, rows * step_down + 40);
    let mut svg = format!(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {total} {total_down}' font-family='sans-serif' \
         font-size='16'>\n<rect width='100%' height='100%' fill='white'/>\n"
    );
    for (index, panel) in (0..).zip(panels) {
        let corner = (MARGIN_PX.0 + index % 2 * step, 8 + index / 2 * step_down);
        let axes = axes((width, height));
        let _ = writeln!(svg, "<g transform='translate({} {})'>{panel}{axes}</g>", corner.0, corner.1);
    }
    let mut x = MARGIN_PX.0 + 30;
    for (sign, name) in legend {
        let y = total_down - 20;
        let _ = writeln!(svg, "<g transform='translate({x} {y})'>{sign}<text x='28' y='5'>{name}</text></g>");
        x += 60 + 8 * name.len() as u32;
    }
    svg.push_str("</svg>\n");
    svg
}

/// Numbers of pixels along the left and the lower edge.
fn axes((width, height): (u32, u32)) -> String {
    let mut svg = String::new();
    for u in (0..=width).step_by(TICK_PX) {
        let _ = write!(
            svg,
            "<path d='M{u} {height}v6' stroke='black'/><text x='{u}' y='{}' text-anchor='middle'>{u}</text>",
            height + 22
        );
    }
    for v in (0..=height).step_by(TICK_PX) {
        let _ =
            write!(svg, "<path d='M0 {v}h-6' stroke='black'/><text x='-9' y='{}' text-anchor='end'>{v}</text>", v + 5);
    }
    let _ = write!(svg, "<text x='{}' y='{}' text-anchor='end'>u, v in pixels</text>", width, height + 40);
    svg
}

/// Figure 2 B: the temporal edge pixels.
#[must_use]
pub fn figure_2(shown: &Panel<'_>) -> String {
    let edges = &shown.view.edges;
    let dots: String =
        edges.iter().map(|edge| format!("<rect x='{}' y='{}' width='2' height='2'/>", edge.u, edge.v)).collect();
    let panels = [panel(shown, &format!("B: {} temporal edge pixels", edges.len()), &dots)];
    sheet(shown.size_px, &panels, &[("<rect x='-3' y='-3' width='6' height='6'/>", "temporal edge pixel"), BLOB, HAND])
}

/// Figure 3: particles (A, B) and the three best arms (C, D) of `standard` and `corrected`.
#[must_use]
pub fn figure_3(frame: &Panel<'_>, standard: &Shown, corrected: &Shown) -> String {
    let dots = |shown: &Shown| -> String {
        let dot =
            |pixel: &Pixel| format!("<circle cx='{:.1}' cy='{:.1}' r='4' fill='#0072b2'/>", pixel.u_px, pixel.v_px);
        let (width, height) = frame.size_px;
        let is_inside =
            |pixel: &&Pixel| (0.0..width as f32).contains(&pixel.u_px) && (0.0..height as f32).contains(&pixel.v_px);
        shown.hands_px.iter().filter(is_inside).map(dot).collect()
    };
    let arms = |shown: &Shown| -> String {
        let line = |(joints, style): (&[Pixel; 3], &&str)| {
            let places: Vec<String> =
                joints.iter().map(|pixel| format!("{:.1},{:.1}", pixel.u_px, pixel.v_px)).collect();
            format!("<polyline points='{}' fill='none' {style}/>", places.join(" "))
        };
        shown.best_px.iter().zip(&BEST).map(line).collect()
    };
    let signs = BEST.map(|style| format!("<path d='M-12 0h30' {style}/>"));
    let [first, second, third] = &signs;
    sheet(
        frame.size_px,
        &[
            panel(frame, "A: standard, hands of all particles", &dots(standard)),
            panel(frame, "B: corrected, hands of all particles", &dots(corrected)),
            panel(frame, "C: standard, three best arms", &arms(standard)),
            panel(frame, "D: corrected, three best arms", &arms(corrected)),
        ],
        &[
            ("<circle r='4' fill='#0072b2'/>", "a particle's hand"),
            BLOB,
            HAND,
            (first, "heaviest arm"),
            (second, "second"),
            (third, "third"),
        ],
    )
}
