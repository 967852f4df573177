//! Figure 7 of the PIK paper: the visible surface of a bone and the points h of the data, drawn by
//! the core's own functions.

use sinew_core::math::Vec3;
use sinew_core::observation::capsule::Capsule;
use std::fmt::Write;

/// Radius of the drawn bone, metres. Chosen: an upper arm's.
const RADIUS_M: f32 = 0.05;
/// Directions round the bone that are tried.
const DIRECTIONS: u32 = 72;
/// Pixels of a metre in the drawing.
const SCALE_PX: f32 = 1000.0;
/// Farther apart than this are a point of the skin and its nearest visible one, where it is hidden,
/// metres.
const HIDDEN_M: f32 = 1.0e-4;
/// Places along the bone at which the skin is tried.
const PLACES: [f32; 5] = [0.1, 0.3, 0.5, 0.7, 0.9];

/// The bone of the figure, and the camera c.
#[must_use]
pub fn example() -> (Capsule, Vec3) {
    let capsule = Capsule { start_m: Vec3::new(-0.12, 0.0, 0.4), end_m: Vec3::new(0.12, 0.0, 0.4), radius_m: RADIUS_M };
    (capsule, Vec3::zeros())
}

/// Points of the cylinder round the bone at `share` of its length, and whether the camera sees
/// each: whether PIK (27) finds the point itself.
#[must_use]
pub fn skin((capsule, camera_m): (&Capsule, &Vec3), share: f32) -> Vec<(Vec3, bool)> {
    let along = capsule.end_m - capsule.start_m;
    let centre = capsule.start_m + along * share;
    let sight = (camera_m - centre).normalize();
    let up = sight.cross(&along).normalize();
    let front = along.cross(&up).normalize();
    let point = |index: u32| {
        let (sine, cosine) = sinew_core::math::sin_cos(std::f32::consts::TAU * index as f32 / DIRECTIONS as f32);
        let point = centre + (front * cosine + up * sine) * capsule.radius_m;
        let visible = capsule.nearest_visible(camera_m, &point);
        (point, (visible - point).norm() < HIDDEN_M)
    };
    (0..DIRECTIONS).map(point).collect()
}

/// Data points x_1 and x_2 of panel (b): one before the bone, one behind it.
#[must_use]
pub fn data_points(capsule: &Capsule) -> [Vec3; 2] {
    let middle = (capsule.start_m + capsule.end_m) * 0.5;
    [middle + Vec3::new(0.0, -0.07, -0.06), middle + Vec3::new(0.0, -0.03, 0.09)]
}

/// Both panels as an SVG document: (a) from above the camera's side, (b) across the bone.
#[must_use]
pub fn figure_7() -> String {
    let (capsule, camera_m) = example();
    format!(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 1000 640' font-family='sans-serif' font-size='16'>\
         <rect width='100%' height='100%' fill='white'/>\n<g transform='translate(250 60)'>{}</g>\n\
         <g transform='translate(720 60)'>{}</g>\n</svg>\n",
        panel_a(&capsule, &camera_m),
        panel_b(&capsule, &camera_m)
    )
}

fn text(x: f32, y: f32, words: &str) -> String {
    format!("<text x='{x:.1}' y='{y:.1}'>{words}</text>\n")
}

/// The bone from the side: dots are skin, filled where the camera sees it.
fn panel_a(capsule: &Capsule, camera_m: &Vec3) -> String {
    // Seen obliquely, so that the round of the bone shows: x to the right, y up, z down the page.
    let place = |point: &Vec3| (SCALE_PX * (point.x + 0.3 * point.y), SCALE_PX * (point.z + 0.35 * point.y));
    let mut svg = text(-200.0, -20.0, "(a) skin of a bone; filled where c sees it (PIK 26)");
    let (c, a, b) = (place(camera_m), place(&capsule.start_m), place(&capsule.end_m));
    for (end, name, beside) in [(a, "a", -20.0), (b, "b", 10.0)] {
        let _ = writeln!(svg, "<path d='M{:.1} {:.1}L{:.1} {:.1}' stroke='#999'/>", c.0, c.1, end.0, end.1);
        svg.push_str(&text(end.0 + beside, end.1 + 5.0, name));
    }
    let _ = writeln!(svg, "<path d='M{:.1} {:.1}L{:.1} {:.1}' stroke='black' stroke-width='3'/>", a.0, a.1, b.0, b.1);
    svg.push_str(&text(c.0 + 8.0, c.1 + 4.0, "c"));
    for (point, is_visible) in PLACES.into_iter().flat_map(|share| skin((capsule, camera_m), share)) {
        let (x, y) = place(&point);
        let fill = if is_visible { "#0072b2" } else { "white" };
        let _ = writeln!(svg, "<circle cx='{x:.1}' cy='{y:.1}' r='3' fill='{fill}' stroke='#0072b2'/>");
    }
    svg
}

/// The bone across, at the place p that two data points share.
fn panel_b(capsule: &Capsule, camera_m: &Vec3) -> String {
    let place = |point: &Vec3| (2.0 * SCALE_PX * point.y, 2.0 * SCALE_PX * (point.z - 0.22));
    let mut svg = text(-190.0, -20.0, "(b) h, the nearest visible skin of x (PIK 27, 28)");
    for (point, is_visible) in skin((capsule, camera_m), 0.5) {
        let (x, y) = place(&point);
        let fill = if is_visible { "#0072b2" } else { "white" };
        let _ = writeln!(svg, "<circle cx='{x:.1}' cy='{y:.1}' r='3' fill='{fill}' stroke='#0072b2'/>");
    }
    for (number, point) in (1..).zip(data_points(capsule)) {
        let (near_m, _) = capsule.nearest_on_axis(&point);
        let (p, x, h) = (place(&near_m), place(&point), place(&capsule.nearest_visible(camera_m, &point)));
        let _ = writeln!(svg, "<path d='M{:.1} {:.1}L{:.1} {:.1}' stroke='black'/>", p.0, p.1, h.0, h.1);
        let dashed = "stroke='#d55e00' stroke-dasharray='5 4'";
        let _ = writeln!(svg, "<path d='M{:.1} {:.1}L{:.1} {:.1}' {dashed}/>", x.0, x.1, h.0, h.1);
        for ((x, y), name) in [(x, "x"), (h, "h")] {
            let _ = writeln!(svg, "<circle cx='{x:.1}' cy='{y:.1}' r='5' fill='black'/>");
            svg.push_str(&text(x - 34.0, y - 6.0, &format!("{name}<tspan font-size='11'>{number}</tspan>")));
        }
        if number == 1 {
            svg.push_str(&text(p.0 + 8.0, p.1 + 4.0, "p"));
        }
    }
    svg.push_str(&text(-4.0, 4.0, "to c"));
    svg
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_camera_sees_the_half_that_faces_it() {
        let (capsule, camera_m) = example();
        for share in PLACES {
            for (point, is_visible) in skin((&capsule, &camera_m), share) {
                let centre = capsule.start_m + (capsule.end_m - capsule.start_m) * share;
                let faces = (point - centre).dot(&(camera_m - centre));
                assert!(is_visible == (faces >= -1.0e-6), "{share}: {faces}");
            }
        }
    }

    #[test]
    fn both_data_points_share_p_and_have_their_own_h() {
        let (capsule, camera_m) = example();
        let [before, behind] = data_points(&capsule);
        assert!((capsule.nearest_on_axis(&before).0 - capsule.nearest_on_axis(&behind).0).norm() < 1.0e-6);
        let [h1, h2] = [before, behind].map(|point| capsule.nearest_visible(&camera_m, &point));
        assert!((h1 - h2).norm() > 0.01);
        assert!((capsule.skin_distance_m(&before) - (before - h1).norm()).abs() < 1.0e-5, "the nearest skin is seen");
        assert!(capsule.skin_distance_m(&behind) < (behind - h2).norm() - 0.01, "the nearest skin is hidden");
        let svg = figure_7();
        assert_eq!(svg.matches("r='3'").count(), 6 * DIRECTIONS as usize);
        assert_eq!(svg.matches("r='5'").count(), 4);
    }
}
