//! How far a person's joints move, against the model's mean cycle.

use super::anatomy::{AnatomicalSeries, COUNT};
use super::angle_table::{ANGLES, SPACE_ANGLES};
use super::model::CyclicModel;

/// Poses of the mean cycle that are compared.
const POSES: u64 = 100;

/// Standard deviation of the flexions of a recording, over that of the same flexions in the model's
/// mean cycle. `None` where no flexion is known, the model holds still, or an angle of it winds.
#[must_use]
pub fn share_of_model(series: &AnatomicalSeries, model: &CyclicModel) -> Option<f64> {
    if model.numbers().turns_per_cycle.iter().any(|turns| *turns != 0) {
        return None;
    }
    let of_model = mean_cycle(model);
    let [mut found, mut usual] = [0.0; 2];
    for angle in 0..COUNT {
        if let Some(variance) = variance(series, angle) {
            found += variance;
            usual += self::variance(&of_model, angle)?;
        }
    }
    (usual > 0.0).then(|| (found / usual).sqrt())
}

fn variance(series: &AnatomicalSeries, angle: usize) -> Option<f64> {
    let values = || series.angles_deg.iter().filter_map(|pose| pose[angle]);
    let count = values().count() as f64;
    let mean = values().sum::<f64>() / count;
    (count > 0.0).then(|| values().map(|value| (value - mean).powi(2)).sum::<f64>() / count)
}

fn mean_cycle(model: &CyclicModel) -> AnatomicalSeries {
    let poses: Vec<[Option<f64>; ANGLES]> = (0..POSES)
        .map(|pose| pose_rad(model, pose as f32 / POSES as f32).map(|angle_rad| Some(f64::from(angle_rad))))
        .collect();
    AnatomicalSeries::of_poses((0..POSES).collect(), &poses, f64::from(model.numbers().rate_hz))
}

/// The angles in the plane of the mean cycle.
fn pose_rad(model: &CyclicModel, phase: f32) -> [f32; ANGLES] {
    let view = model.view();
    if model.numbers().angle_count == ANGLES {
        return view.mean_pose_rad(view.point(phase));
    }
    let pose_rad: [f32; SPACE_ANGLES] = view.mean_pose_rad(view.point(phase));
    std::array::from_fn(|angle| pose_rad[angle])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cyclic::model_file::shipped;

    #[test]
    fn the_share_is_that_of_the_range_whatever_the_posture() {
        let model = shipped("walking").unwrap();
        let usual = mean_cycle(model);
        for share in [0.4, 1.0, 1.3] {
            let mut series = usual.clone();
            for pose in &mut series.angles_deg {
                *pose = pose.map(|angle| angle.map(|deg| 12.0 + share * deg));
                pose[2] = None;
            }
            let found = share_of_model(&series, model).unwrap();
            assert!((found - share).abs() < 1.0e-6, "{found} instead of {share}");
        }
        assert_eq!(share_of_model(&usual, shipped("arm-circles").unwrap()), None);
        let unseen = AnatomicalSeries { angles_deg: vec![[None; COUNT]; 9], ..usual };
        assert_eq!(share_of_model(&unseen, model), None);
    }
}
