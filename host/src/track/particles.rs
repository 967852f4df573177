//! The rows of `particles.csv`: every particle of every frame.

use super::arms::ArmView;
use crate::wording::side_name;
use sinew_core::camera::Camera;

/// Column names of `particles.csv`.
pub const PARTICLE_HEADER: [&str; 17] = [
    "frame",
    "side",
    "particle",
    "weight",
    "elevation_rad",
    "deviation_rad",
    "rotation_rad",
    "flexion_rad",
    "elbow_x_m",
    "elbow_y_m",
    "elbow_z_m",
    "hand_x_m",
    "hand_y_m",
    "hand_z_m",
    "hand_u_px",
    "hand_v_px",
    "driver_blob",
];

/// One row a particle, in the order of [`PARTICLE_HEADER`].
///
/// The driving blob is counted from 0, the most likely first; the cell is empty for a particle that
/// no blob drives. With both sides tracked it counts among the blobs that this side was given, its
/// own first.
pub fn particle_rows<'a>(
    frame: usize,
    view: &'a ArmView,
    camera: &'a Camera,
) -> impl Iterator<Item = Vec<String>> + 'a {
    let side = side_name(view.estimate.side);
    view.particles.iter().enumerate().map(move |(index, (particle, weight))| {
        let mut cells = vec![frame.to_string(), side.to_owned(), index.to_string(), format!("{weight:.7}")];
        let (elbow, hand) = (particle.elbow_m, particle.hand_m);
        let metres = elbow.iter().chain(hand.iter());
        cells.extend(particle.angles_rad.iter().chain(metres).map(|value| format!("{value:.5}")));
        let hand_px = camera.project(&hand);
        cells.extend(
            [hand_px.map(|pixel| pixel.u_px), hand_px.map(|pixel| pixel.v_px)]
                .map(|coordinate| coordinate.map_or_else(String::new, |coordinate| format!("{coordinate:.2}"))),
        );
        cells.push(particle.driver.map_or_else(String::new, |driver| driver.to_string()));
        cells
    })
}
