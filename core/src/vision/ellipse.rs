//! The ellipse of a blob's area and perimeter, and how well it covers the blob: arm (9).
//!
//! ```
//! use sinew_core::vision::ellipse::semi_axes;
//! use std::f32::consts::PI;
//!
//! // A disc of radius 10.
//! let (a, b) = semi_axes(PI * 100.0, 2.0 * PI * 10.0);
//! assert!((a - 10.0).abs() < 0.05 && (b - 10.0).abs() < 0.05, "{a}, {b}");
//! ```

use super::distance::{CellRow, MAX_COLUMNS};
use crate::math::{clamp, floor, max, sin_cos, sqrt};
use core::f32::consts::PI;

/// Rotations that are tried first, evenly over half a turn.
const COARSE_ROTATIONS: usize = 8;
/// Halvings of the angle about the best rotation, two new rotations each.
const REFINEMENTS: usize = 3;

/// Semi-axes a >= b of the ellipse with the given area and perimeter, P = 2 pi sqrt((a^2 + b^2) /
/// 2).
///
/// The circle of that area where P^2 < 4 pi A, which no ellipse has but a digital perimeter may.
///
/// ```
/// use core::f32::consts::PI;
/// use sinew_core::math::sqrt;
/// use sinew_core::vision::ellipse::semi_axes;
///
/// // Area and perimeter of an ellipse of 12 by 5 give both back.
/// let (a, b) = semi_axes(PI * 12.0 * 5.0, 2.0 * PI * sqrt((144.0 + 25.0) / 2.0));
/// assert!((a - 12.0).abs() < 1e-3 && (b - 5.0).abs() < 1e-3);
/// // No outline is shorter than a circle's; a shorter digital one counts as a circle.
/// assert_eq!(semi_axes(PI * 4.0, 1.0), (2.0, 2.0));
/// ```
#[must_use]
pub fn semi_axes(area: f32, perimeter: f32) -> (f32, f32) {
    let square = perimeter * perimeter / (2.0 * PI * PI);
    let product = 2.0 * area / PI;
    if square <= product {
        let radius = sqrt(max(area, 0.0) / PI);
        return (radius, radius);
    }
    let (sum, difference) = (sqrt(square + product), sqrt(square - product));
    (0.5 * (sum + difference), 0.5 * (sum - difference))
}

/// Greatest intersection over union of the cells with an ellipse of semi-axes (`a`, `b`), and its
/// rotation.
///
/// The ellipse's centre is (`centre_u`, `centre_v`). The rotation is that of its long axis from the
/// u axis towards the v axis, in [0, pi). Rotations are refined from coarse to fine: 14 in all,
/// each with a square root and a bit count a row.
///
/// ```
/// use sinew_core::vision::ellipse::{best_overlap, semi_axes};
///
/// // A bar of twenty by six cells that stands upright.
/// let (area, perimeter) = (120.0, 52.0);
/// let (overlap, rotation_rad) =
///     best_overlap(&[0b11_1111; 20], area, (2.5, 9.5), semi_axes(area, perimeter));
/// assert!(overlap > 0.8, "an ellipse covers most of a bar: {overlap}");
/// assert!(
///     (rotation_rad - core::f32::consts::FRAC_PI_2).abs() < 0.1,
///     "its long axis is upright, too"
/// );
/// ```
#[must_use]
pub fn best_overlap(cells: &[CellRow], area: f32, (centre_u, centre_v): (f32, f32), (a, b): (f32, f32)) -> (f32, f32) {
    let overlap = |rotation_rad: f32| overlap(cells, area, (centre_u, centre_v), (a, b), rotation_rad);
    let step = PI / COARSE_ROTATIONS as f32;
    let mut best = (0.0, 0.0);
    let tries = if a - b < 1.0e-3 * a { 1 } else { COARSE_ROTATIONS };
    for i in 0..tries {
        let rotation_rad = i as f32 * step;
        let found = overlap(rotation_rad);
        if found > best.0 {
            best = (found, rotation_rad);
        }
    }
    let mut half = 0.5 * step;
    for _ in 0..if tries == 1 { 0 } else { REFINEMENTS } {
        let middle = best.1;
        for rotation_rad in [middle - half, middle + half] {
            let found = overlap(rotation_rad);
            if found > best.0 {
                best = (found, rotation_rad);
            }
        }
        half *= 0.5;
    }
    (best.0, crate::math::wrap_orientation(best.1))
}

/// Intersection over union of the cells with one ellipse.
fn overlap(
    cells: &[CellRow],
    area: f32,
    (centre_u, centre_v): (f32, f32),
    (a, b): (f32, f32),
    rotation_rad: f32,
) -> f32 {
    if !(a > 0.0 && b > 1.0e-3 && area > 0.0) {
        return 0.0;
    }
    let (s, c) = sin_cos(rotation_rad);
    let (a2, b2) = (1.0 / (a * a), 1.0 / (b * b));
    // (x y) (p q; q r) (x y)' <= 1
    let (p, q, r) = (c * c * a2 + s * s * b2, s * c * (a2 - b2), s * s * a2 + c * c * b2);
    let (slope, bend) = (-q / p, (q * q - p * r) / (p * p));
    let mut shared = 0;
    for (v, &row) in cells.iter().enumerate() {
        let y = v as f32 - centre_v;
        let square = 1.0 / p + bend * y * y;
        if row == 0 || square < 0.0 {
            continue;
        }
        let (middle, half) = (centre_u + slope * y, sqrt(square));
        shared += (row & columns_between(middle - half, middle + half)).count_ones();
    }
    let shared = shared as f32;
    clamp(shared / max(area + PI * a * b - shared, 1.0), 0.0, 1.0)
}

/// The cells whose centres lie in `low..=high`.
fn columns_between(low: f32, high: f32) -> CellRow {
    let limit = MAX_COLUMNS as f32;
    let first = clamp(-floor(-low), 0.0, limit) as u32;
    let end = clamp(floor(high) + 1.0, 0.0, limit) as u32;
    below(end) & !below(first)
}

fn below(column: u32) -> CellRow {
    1_u128.checked_shl(column).map_or(u128::MAX, |bit| bit - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drawn(centre: (f32, f32), a: f32, b: f32, rotation_rad: f32) -> (Vec<CellRow>, f32) {
        let (s, c) = rotation_rad.sin_cos();
        let mut area = 0.0;
        let rows = (0..100).map(|v| {
            (0..100).fold(0, |row, u| {
                let (x, y) = (u as f32 - centre.0, v as f32 - centre.1);
                let inside = ((c * x + s * y) / a).powi(2) + ((c * y - s * x) / b).powi(2) <= 1.0;
                area += f32::from(u8::from(inside));
                row | u128::from(inside) << u
            })
        });
        (rows.collect(), area)
    }

    #[test]
    fn semi_axes_give_back_area_and_perimeter() {
        let (a, b) = semi_axes(PI * 12.0 * 5.0, 2.0 * PI * ((144.0_f32 + 25.0) / 2.0).sqrt());
        assert!((a - 12.0).abs() < 1.0e-3 && (b - 5.0).abs() < 1.0e-3, "{a} {b}");
        assert_eq!(semi_axes(PI * 4.0, 1.0), (2.0, 2.0));
    }

    #[test]
    fn an_ellipse_covers_itself_at_any_rotation() {
        let mut worst = 1.0_f32;
        for degrees in (0..180).step_by(7) {
            let rotation_rad = (degrees as f32).to_radians();
            let (rows, area) = drawn((51.3, 47.6), 30.0, 12.0, rotation_rad);
            let (overlap, found_rad) = best_overlap(&rows, area, (51.3, 47.6), (30.0, 12.0));
            worst = worst.min(overlap);
            let turn = (found_rad - rotation_rad).sin().abs();
            assert!(turn < 0.06, "{degrees} degrees: found {found_rad} rad");
        }
        assert!((0.93..0.9999).contains(&worst), "{worst}");
    }

    #[test]
    fn a_ring_is_covered_by_less_than_half() {
        let (outer, _) = drawn((50.0, 50.0), 40.0, 40.0, 0.0);
        let (inner, _) = drawn((50.0, 50.0), 32.0, 32.0, 0.0);
        let ring: Vec<CellRow> = outer.iter().zip(&inner).map(|(o, i)| o & !i).collect();
        let area = ring.iter().map(|row| row.count_ones() as f32).sum::<f32>();
        let (overlap, _) = best_overlap(&ring, area, (50.0, 50.0), semi_axes(area, 2.0 * PI * 72.0));
        assert!((0.0..0.3).contains(&overlap), "{overlap}");
    }

    #[test]
    fn degenerate_ellipses_cover_nothing() {
        assert_eq!(best_overlap(&[1], 1.0, (0.0, 0.0), (5.0, 0.0)).0, 0.0);
        assert_eq!(best_overlap(&[1], 0.0, (0.0, 0.0), semi_axes(0.0, 0.0)).0, 0.0);
        assert_eq!(best_overlap(&[1], 1.0, (f32::NAN, 0.0), (1.0, 1.0)).0, 0.0);
    }
}
