//! How honest the standard deviation of an arm's hand is, on rendered scenes. Runs in release where
//! `../shared/data` is at hand, and says so where not.

use crate::shared_data;

use rayon::prelude::*;
use sinew::config::Config;
use sinew::resume::Cells;
use sinew::scene::SceneOptions;
use sinew::skin::SkinModel;
use sinew::skin::model::DEFAULT_SKIN;
use sinew_core::tracker::arm::{ArmOptions, Status};
use sinew_lab::clips::{Clip, builtin, recorded};
use sinew_lab::observed::{FrontEnd, Reading, observe_all};
use sinew_lab::score::{FrameError, track};
use std::ops::RangeInclusive;

/// Squared radius of the sphere that holds 90 % of a normal distribution in space, variances.
const NINE_TENTHS: f64 = 6.251;
/// Share of frames with a status whose true hand lies inside that sphere.
const INSIDE: RangeInclusive<f64> = 0.80..=0.97;

#[test]
fn the_spread_of_a_hand_holds_its_error() {
    let Some(folder) = shared_data::in_release("mocap") else { return };
    for (source, clips) in [("recorded", recorded(&folder).unwrap()), ("reaches", builtin(10))] {
        let frames = frames(&clips);
        for status in [Status::Tracking, Status::Uncertain, Status::Predicted] {
            let share = inside(source, &frames, status);
            assert!(INSIDE.contains(&share), "{source}, {status:?}: {share}");
        }
    }
}

fn frames(clips: &[Clip]) -> Vec<FrameError> {
    let skin = SkinModel::from_option(DEFAULT_SKIN).unwrap();
    let front_end = FrontEnd { config: &Config::default(), skin: &skin, reading: Reading::OverTime };
    let scenes = observe_all(clips, &[1, 2], &SceneOptions::default(), &front_end, &Cells::not_kept()).unwrap();
    scenes.par_iter().flat_map_iter(|scene| track(scene, &ArmOptions::default(), scene.seed).unwrap()).collect()
}

fn inside(source: &str, frames: &[FrameError], status: Status) -> f64 {
    let of: Vec<&FrameError> = frames.iter().filter(|frame| frame.status == status).collect();
    let count = of.len().max(1) as f64;
    let inside = of.iter().filter(|f| f.error_m.powi(2) <= NINE_TENTHS * f.hand_std_m.powi(2)).count() as f64 / count;
    let rms = |value: fn(&FrameError) -> f64| (of.iter().map(|f| value(f).powi(2)).sum::<f64>() / count).sqrt();
    let (off_m, said_m) = (rms(|f| f.error_m / 3.0_f64.sqrt()), rms(|f| f.hand_std_m));
    println!("{source}, {status:?}: {count} frames, {inside:.3} inside, {off_m:.3} m an axis off, {said_m:.3} m said");
    inside
}
