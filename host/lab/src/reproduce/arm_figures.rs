//! Figures 2 and 3 of the arm paper: temporal edges, the particles' hands and the three best arms,
//! and how many particles are at the hand.

use super::plot::escaped;
use crate::observed::ObservedScene;
use crate::score::FIRST_SCORED_FRAME;
use anyhow::{Context, Result};
use serde::{Deserialize, Serialize};
use sinew::track::ArmSet;
use sinew_core::camera::Pixel;
use sinew_core::tracker::arm::ArmOptions;
use std::fmt::Write;

/// Width of a hand, metres.
/// Chosen: the breadth across the knuckles of an adult, 8 to 9 cm.
const HAND_WIDTH_M: f32 = 0.085;
/// Strokes of the three best arms, the heaviest first: the paper's black, white and thin black.
const BEST: [&str; 3] = [
    "stroke='black' stroke-width='4'",
    "stroke='black' stroke-width='3' stroke-dasharray='8 4'",
    "stroke='black' stroke-width='1'",
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

/// Tracks `scene`; what the particles show in `frame`, and how many are at the hand.
///
/// # Errors
/// Names the parameter that cannot be used; a scene without that frame.
pub fn follow(scene: &ObservedScene, tracker: &ArmOptions, frame: usize) -> Result<(Shown, AtHand)> {
    let mut config = scene.config.clone();
    config.tracker = *tracker;
    let mut arms = ArmSet::new(&config, scene.size_px, scene.side, scene.seed)?;
    let camera = *arms.models()[0].camera();
    let (mut shown, mut sum, mut count) = (None, 0.0, 0.0);
    for (index, (view, truth)) in scene.views.iter().zip(&scene.truth).enumerate() {
        let estimate = arms.step(index as u64 * scene.frame_us, Some(view))[0].estimate;
        if index < FIRST_SCORED_FRAME {
            continue;
        }
        let particles = arms.particles().swap_remove(0);
        let hands_px: Vec<Pixel> =
            particles.iter().filter_map(|(particle, _)| camera.project(&particle.hand_m)).collect();
        let across = camera.project(&(truth.hand_m + sinew_core::math::Vec3::x() * HAND_WIDTH_M));
        let width_px = across.map_or(0.0, |pixel| pixel.distance_px(truth.hand_px));
        let near = hands_px.iter().filter(|pixel| pixel.distance_px(truth.hand_px) <= width_px).count();
        sum += near as f64 / particles.len().max(1) as f64;
        count += 1.0;
        if index == frame {
            let mut heaviest = particles;
            heaviest.sort_by(|a, b| b.1.total_cmp(&a.1));
            let shoulder_m = estimate.joints.shoulder_m;
            let arm = |(particle, _): &(_, f32)| {
                let particle: &sinew_core::tracker::arm::Particle = particle;
                arms.joints_px([shoulder_m, particle.elbow_m, particle.hand_m])
            };
            shown = Some(Shown { hands_px, best_px: heaviest.iter().take(BEST.len()).filter_map(arm).collect() });
        }
    }
    let shown = shown.with_context(|| format!("scene `{}` has no frame {frame}", scene.clip))?;
    Ok((shown, AtHand { share: if count > 0.0 { sum / count } else { 0.0 } }))
}

/// One panel in the image's pixels, y down: blobs as circles, the true hand as a cross, and marks.
fn panel(scene: &ObservedScene, frame: usize, title: &str, marks: &str) -> String {
    let (width, height) = scene.size_px;
    let mut svg = format!(
        "<rect width='{width}' height='{height}' fill='#f4f4f4' stroke='black'/><text x='8' y='22' font-size='18'>{}</text>\n",
        escaped(title)
    );
    for blob in &scene.views[frame].candidates {
        let radius = (blob.area_px / std::f32::consts::PI).sqrt();
        let _ = writeln!(
            svg,
            "<circle cx='{:.1}' cy='{:.1}' r='{radius:.1}' fill='#e8c39e' stroke='#a0703c'/>",
            blob.centre.u_px, blob.centre.v_px
        );
    }
    svg.push_str(marks);
    let hand = scene.truth[frame].hand_px;
    let _ = writeln!(
        svg,
        "<path d='M{:.1} {:.1}h20m-10 -10v20' stroke='#d55e00' stroke-width='3'/>",
        hand.u_px - 10.0,
        hand.v_px
    );
    svg
}

/// Panels beside each other.
fn sheet(scene: &ObservedScene, panels: &[String]) -> String {
    let (width, height) = scene.size_px;
    let total = panels.len() as u32 * (width + 10);
    let mut svg = format!(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {total} {height}' font-family='sans-serif'>\
         <rect width='100%' height='100%' fill='white'/>\n"
    );
    for (index, panel) in panels.iter().enumerate() {
        let _ = writeln!(svg, "<g transform='translate({} 0)'>{panel}</g>", index as u32 * (width + 10));
    }
    svg.push_str("</svg>\n");
    svg
}

/// Figure 2 B: the temporal edge pixels.
#[must_use]
pub fn figure_2(scene: &ObservedScene, frame: usize) -> String {
    let edges = &scene.views[frame].edges;
    let dots: String =
        edges.iter().map(|edge| format!("<rect x='{}' y='{}' width='2' height='2'/>", edge.u, edge.v)).collect();
    sheet(scene, &[panel(scene, frame, &format!("B: {} temporal edge pixels", edges.len()), &dots)])
}

/// Figure 3: particles (A, B) and the three best arms (C, D) of `standard` and `corrected`.
#[must_use]
pub fn figure_3(scene: &ObservedScene, frame: usize, standard: &Shown, corrected: &Shown) -> String {
    let dots = |shown: &Shown| -> String {
        let dot =
            |pixel: &Pixel| format!("<circle cx='{:.1}' cy='{:.1}' r='4' fill='#0072b2'/>", pixel.u_px, pixel.v_px);
        shown.hands_px.iter().map(dot).collect()
    };
    let arms = |shown: &Shown| -> String {
        let line = |(joints, style): (&[Pixel; 3], &&str)| {
            let places: Vec<String> =
                joints.iter().map(|pixel| format!("{:.1},{:.1}", pixel.u_px, pixel.v_px)).collect();
            format!("<polyline points='{}' fill='none' {style}/>", places.join(" "))
        };
        shown.best_px.iter().zip(&BEST).map(line).collect()
    };
    sheet(
        scene,
        &[
            panel(scene, frame, "A: standard, hands of all particles", &dots(standard)),
            panel(scene, frame, "B: corrected, hands of all particles", &dots(corrected)),
            panel(scene, frame, "C: standard, three best arms", &arms(standard)),
            panel(scene, frame, "D: corrected, three best arms", &arms(corrected)),
        ],
    )
}
