//! The colour cube of 32 x 32 x 32 cells: counting, smoothing, and its projection to chromaticity.

use sinew_core::vision::skin::CUBE_SIDE;

/// Cells of the cube; cell (R, G, B) has index (R * 32 + G) * 32 + B.
pub const CELLS: usize = CUBE_SIDE * CUBE_SIDE * CUBE_SIDE;
/// Cells along one side of the chromaticity plane.
const PLANE_SIDE: usize = 64;

/// Index of the cell that holds `rgb`.
#[must_use]
pub fn cell_of(rgb: [u8; 3]) -> usize {
    let [r, g, b] = rgb.map(|channel| usize::from(channel >> 3));
    (r * CUBE_SIDE + g) * CUBE_SIDE + b
}

/// The colour in the middle of a cell, 0 to 255 each.
#[must_use]
pub fn centre_of(cell: usize) -> [f64; 3] {
    let [r, g, b] = [cell / (CUBE_SIDE * CUBE_SIDE), cell / CUBE_SIDE % CUBE_SIDE, cell % CUBE_SIDE];
    [r, g, b].map(|channel| channel as f64 * 8.0 + 3.5)
}

/// `rgb` under light that is `gain` times as strong, with a `tint` for each channel; `None` where a
/// channel would be clipped that was not before.
#[must_use]
pub fn relit(rgb: [u8; 3], gain: f64, tint: [f64; 3]) -> Option<[u8; 3]> {
    let scaled = [0, 1, 2].map(|i| f64::from(rgb[i]) * gain * tint[i]);
    let clips = scaled.iter().any(|&channel| channel > 255.5) && !rgb.contains(&255);
    (!clips).then(|| scaled.map(|channel| channel.round().min(255.0) as u8))
}

/// Weights of a Gaussian of `std` cells at offsets 0 to 3, so that the whole kernel sums to 1.
fn kernel(std: f64) -> [f64; 4] {
    let raw = [0.0_f64, 1.0, 2.0, 3.0].map(|offset| (-0.5 * (offset / std).powi(2)).exp());
    let sum = raw[0] + 2.0 * (raw[1] + raw[2] + raw[3]);
    raw.map(|weight| weight / sum)
}

/// Smooths `values` along the axis whose neighbours are `stride` apart and which is `side` long;
/// what leaves is lost.
fn smooth_axis(values: &[f64], stride: usize, side: usize, kernel: [f64; 4]) -> Vec<f64> {
    let at = |index: usize| {
        let place = index / stride % side;
        let mut sum = kernel[0] * values[index];
        for (offset, weight) in kernel.iter().enumerate().skip(1) {
            if place >= offset {
                sum += weight * values[index - offset * stride];
            }
            if place + offset < side {
                sum += weight * values[index + offset * stride];
            }
        }
        sum
    };
    (0..values.len()).map(at).collect()
}

/// Smooths a cube by a Gaussian of `std` cells (cut at three cells).
#[must_use]
pub fn smooth(cube: &[f64], std: f64) -> Vec<f64> {
    let kernel = kernel(std);
    let along_b = smooth_axis(cube, 1, CUBE_SIDE, kernel);
    let along_g = smooth_axis(&along_b, CUBE_SIDE, CUBE_SIDE, kernel);
    smooth_axis(&along_g, CUBE_SIDE * CUBE_SIDE, CUBE_SIDE, kernel)
}

/// For each cell of the cube the (smoothed) mass of all cells of about its chromaticity, bright or
/// dark.
#[must_use]
pub fn over_brightness(cube: &[f64]) -> Vec<f64> {
    let plane_cell = |cell: usize| {
        let [r, g, b] = centre_of(cell);
        let index = |channel: f64| ((channel / (r + g + b) * PLANE_SIDE as f64) as usize).min(PLANE_SIDE - 1);
        index(r) * PLANE_SIDE + index(g)
    };
    let mut plane = vec![0.0; PLANE_SIDE * PLANE_SIDE];
    for (cell, mass) in cube.iter().enumerate() {
        plane[plane_cell(cell)] += mass;
    }
    let kernel = kernel(1.0);
    let plane = smooth_axis(&smooth_axis(&plane, 1, PLANE_SIDE, kernel), PLANE_SIDE, PLANE_SIDE, kernel);
    (0..cube.len()).map(|cell| plane[plane_cell(cell)]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use sinew_core::vision::skin::HistogramSkin;

    proptest! {
        #[test]
        fn cells_are_numbered_as_in_the_core(rgb in any::<[u8; 3]>()) {
            let (word, bit) = HistogramSkin::bit_of(rgb);
            prop_assert_eq!(cell_of(rgb), word * 32 + bit as usize);
            let centre = centre_of(cell_of(rgb));
            prop_assert!((0..3).all(|i| (centre[i] - f64::from(rgb[i])).abs() <= 4.0));
        }
    }

    #[test]
    fn smoothing_keeps_the_mass_inside_and_is_even() {
        let mut cube = vec![0.0; CELLS];
        let middle = cell_of([128, 128, 128]);
        cube[middle] = 1.0;
        let smoothed = smooth(&cube, 0.7);
        assert!((smoothed.iter().sum::<f64>() - 1.0).abs() < 1e-9);
        assert_eq!(smoothed[middle + 1], smoothed[middle - 1]);
        assert_eq!(smoothed[middle + 32], smoothed[middle - 1024]);
    }

    #[test]
    fn chromaticity_is_shared_by_bright_and_dark() {
        let mut cube = vec![0.0; CELLS];
        cube[cell_of([200, 120, 80])] = 1.0;
        let shared = over_brightness(&cube);
        assert!(shared[cell_of([100, 60, 40])] > 10.0 * shared[cell_of([100, 100, 100])]);
    }

    #[test]
    fn relighting_scales_and_drops_what_would_clip() {
        assert_eq!(relit([100, 50, 200], 1.1, [1.0; 3]), Some([110, 55, 220]));
        assert_eq!(relit([100, 50, 250], 1.1, [1.0; 3]), None);
        assert_eq!(relit([100, 50, 255], 1.1, [1.0; 3]), Some([110, 55, 255]));
        assert_eq!(relit([100, 50, 200], 1.0, [1.1, 1.0, 0.9]), Some([110, 50, 180]));
    }
}
