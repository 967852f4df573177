//! Names and rate of the markers of a C3D file.

use super::parameters::Parameters;

/// Most parameters of names. Chosen: each of them has at most 255, and a file at most 65,535
/// points.
const MAX_LISTS: usize = 257;

/// Names of the first points, at most `points`. They are those of `LABELS`, then `LABELS2` and so
/// on, each of which goes on where the one before was full.
pub fn read(parameters: &Parameters, points: usize) -> Vec<String> {
    let name = |number: usize| if number == 1 { "LABELS".to_owned() } else { format!("LABELS{number}") };
    let list = |number: usize| parameters.texts("POINT", &name(number));
    (1..=MAX_LISTS).map(list).take_while(|list| !list.is_empty()).flatten().take(points).collect()
}

/// Frames per second by the parameter; those of the header where it has none.
pub fn rate_hz(parameters: &Parameters, of_header: f32) -> f32 {
    let rate = parameters.number("POINT", "RATE").map(|rate| rate as f32);
    rate.filter(|rate| *rate > 0.0 && rate.is_finite()).unwrap_or(of_header)
}
