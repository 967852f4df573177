//! Bodies as SVG: poses over each other, with points or a truth below them. The right side is
//! dashed, so that no body relies on colour alone.

use super::plot::escaped;
use sinew::draw::body_views::DrawnBone;
use sinew::draw::pose_fan::Look;
use sinew_core::math::Vec3;
use sinew_core::skeleton::Side;
use std::fmt::Write;

/// Width of a panel, and height of its drawing, units of the view box.
const PANEL: (f32, f32) = (360.0, 360.0);
/// Space between panels, and around what is drawn.
const GAP: f32 = 12.0;
/// Height of a line of letters.
const LINE: f32 = 18.0;
/// Metres of the scale bar.
const BAR_M: f32 = 0.5;

/// What one panel shows.
#[derive(Debug, Clone)]
pub struct BodyPanel<'a> {
    /// What stands above.
    pub title: String,
    /// From where the body is looked at.
    pub look: Look,
    /// The true pose: broad and grey.
    pub truth: &'a [DrawnBone],
    /// Poses over each other.
    pub poses: &'a [Vec<DrawnBone>],
    /// Points that the camera saw, metres.
    pub points_m: &'a [Vec3],
}

impl BodyPanel<'_> {
    const fn across(&self) -> usize {
        match self.look {
            Look::Front => 0,
            Look::Side => 2,
        }
    }

    /// Lowest and highest place of all bones along each axis.
    fn bounds(&self) -> Option<[Vec3; 2]> {
        let bones = self.poses.iter().flatten().chain(self.truth);
        bones.flat_map(|bone| [bone.start_m, bone.end_m]).fold(None, |bounds, place| {
            let [low, high] = bounds.unwrap_or([place, place]);
            Some([place.inf(&low), place.sup(&high)])
        })
    }

    /// The greatest scale at which all bones are inside, units a metre.
    fn fitting_scale(&self) -> f32 {
        let Some([low, high]) = self.bounds() else { return PANEL.0 };
        let size = high - low;
        let room = |room: f32, size_m: f32| (room - 2.0 * GAP) / size_m.max(0.1);
        room(PANEL.0, size[self.across()]).min(room(PANEL.1, size.y))
    }

    fn drawn(&self, scale: f32) -> String {
        let centre = self.bounds().map_or(Vec3::zeros(), |[low, high]| (low + high) * 0.5);
        let place = |point: &Vec3| {
            let off = (point - centre) * scale;
            (0.5 * PANEL.0 + off[self.across()], LINE + 0.5 * PANEL.1 + off.y)
        };
        let mut svg = format!(
            "<rect y='{LINE}' width='{}' height='{}' fill='none' stroke='#999'/><text x='2' y='13'>{}</text>\n",
            PANEL.0,
            PANEL.1,
            escaped(&self.title)
        );
        for (x, y) in self.points_m.iter().map(place) {
            if (0.0..PANEL.0).contains(&x) && (LINE..LINE + PANEL.1).contains(&y) {
                let _ = writeln!(svg, "<circle cx='{x:.1}' cy='{y:.1}' r='0.8' fill='#777'/>");
            }
        }
        let mut line = |bone: &DrawnBone, style: &str| {
            let ((x1, y1), (x2, y2)) = (place(&bone.start_m), place(&bone.end_m));
            let _ = writeln!(svg, "<path d='M{x1:.1} {y1:.1}L{x2:.1} {y2:.1}' {style}/>");
        };
        self.truth.iter().for_each(|bone| line(bone, TRUTH));
        // Ten poses can be told apart, a hundred show where they are dense.
        let opacity = (4.0 / self.poses.len().max(1) as f64).clamp(0.12, 1.0);
        for bone in self.poses.iter().flatten() {
            line(bone, &format!("{} stroke-opacity='{opacity:.2}'", style(bone.side)));
        }
        svg
    }
}

/// The stroke of a true bone.
const TRUTH: &str = "stroke='#bbb' stroke-width='7' stroke-linecap='round'";

fn style(side: Option<Side>) -> &'static str {
    match side {
        None => "stroke='black' stroke-width='1.5'",
        Some(Side::Left) => "stroke='#0072b2' stroke-width='1.5'",
        Some(Side::Right) => "stroke='#d55e00' stroke-width='1.5' stroke-dasharray='5 2'",
    }
}

/// Panels beside each other, all at the scale at which each of them fits, without perspective, with
/// a legend and a scale bar below.
#[must_use]
pub fn body_panels(panels: &[BodyPanel<'_>]) -> String {
    let scale = panels.iter().map(BodyPanel::fitting_scale).fold(f32::INFINITY, f32::min);
    let count = panels.len().max(1) as f32;
    let (width, height) = (count * (PANEL.0 + GAP) - GAP, PANEL.1 + 2.5 * LINE);
    let mut svg = format!(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='-1 0 {} {height}' font-family='sans-serif' font-size='12' \
         fill='none'>\
         <rect x='-1' width='100%' height='100%' fill='white'/>\n<g fill='black'>",
        width + 2.0
    );
    for (index, panel) in panels.iter().enumerate() {
        let left = index as f32 * (PANEL.0 + GAP);
        let _ = writeln!(svg, "<g transform='translate({left} 0)'>{}</g>", panel.drawn(scale));
    }
    let y = PANEL.1 + 1.9 * LINE;
    let mut x = 2.0;
    let mut named = Vec::new();
    if panels.iter().any(|panel| !panel.poses.is_empty()) {
        named.push(("left", style(Some(Side::Left))));
        named.push(("right", style(Some(Side::Right))));
        named.push(("trunk, head", style(None)));
    }
    if panels.iter().any(|panel| !panel.truth.is_empty()) {
        named.push(("truth", TRUTH));
    }
    for (name, style) in named {
        let _ = writeln!(svg, "<path d='M{x} {y}h26' {style}/><text x='{}' y='{}'>{name}</text>", x + 32.0, y + 4.0);
        x += 52.0 + 7.0 * name.len() as f32;
    }
    let bar = BAR_M * scale;
    let _ = writeln!(
        svg,
        "<path d='M{x} {0}v8m0 -4h{bar:.1}m0 -4v8' stroke='black'/><text x='{1:.1}' y='{2}'>{BAR_M} m</text></g>\n</svg>",
        y - 4.0,
        x + bar + 6.0,
        y + 4.0
    );
    svg
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bone(x: f32, side: Option<Side>) -> DrawnBone {
        DrawnBone { start_m: Vec3::new(x, -0.5, 3.0), end_m: Vec3::new(x, 0.5, 3.0), radius_m: 0.05, side }
    }

    #[test]
    fn panels_share_a_scale_that_fits_and_sides_differ_by_dash() {
        let poses = [vec![bone(-0.4, Some(Side::Left)), bone(0.4, Some(Side::Right))]];
        let truth = [bone(0.0, None)];
        let wide = [vec![bone(-2.0, None), bone(2.0, None)]];
        let point = [Vec3::new(0.1, 0.0, 3.0)];
        let panel =
            |poses, truth| BodyPanel { title: "a & b".into(), look: Look::Front, truth, poses, points_m: &point };
        let alone = body_panels(&[panel(&poses, &truth)]);
        let scale = (PANEL.1 - 2.0 * GAP) / 1.0;
        assert!(alone.contains(&format!("h{:.1}m0 -4v8", BAR_M * scale)), "{alone}");
        assert!(alone.contains("a &amp; b") && alone.contains(">truth<") && alone.contains("stroke-dasharray"));
        assert_eq!(alone.matches("<circle").count(), 1);
        let both = body_panels(&[panel(&poses, &[]), panel(&wide, &[])]);
        let scale = (PANEL.0 - 2.0 * GAP) / 4.0;
        assert!(both.contains(&format!("h{:.1}m0 -4v8", BAR_M * scale)), "{both}");
        assert!(!both.contains(">truth<"));
    }
}
