//! A made-up walk that several tests track.

use sinew::cyclic::angle_table::ANGLES;
use sinew::cyclic::{AngleRow, AngleTable, CyclicModel};

/// The shipped walk's mean pose at so many cycles a frame, from frame 0 at the start of a cycle on,
/// at 60 frames a second.
pub fn walk(frames: u64, cycles_per_frame: f64) -> AngleTable {
    let model = CyclicModel::from_option("walking").unwrap();
    let view = model.view();
    let row = |frame: u64| {
        let position = (frame as f64 * cycles_per_frame).fract() as f32;
        let pose = view.mean_pose_rad::<ANGLES>(view.point(position));
        AngleRow { frame, angles_rad: pose.map(|angle| Some(f64::from(angle))), extra: Vec::new() }
    };
    AngleTable::new((0..frames).map(row).collect(), Vec::new()).unwrap().at_rate(Some(60.0))
}
