//! The accuracy of the default arm tracker that the book states, on rendered scenes that real
//! motion drives. Runs in release where `../shared/data` is at hand, and says so where not.

use crate::shared_data;

use sinew::config::Config;
use sinew::resume::Cells;
use sinew::scene::SceneOptions;
use sinew::skin::SkinModel;
use sinew::skin::model::DEFAULT_SKIN;
use sinew_core::tracker::arm::ArmOptions;
use sinew_lab::clips;
use sinew_lab::observed::{FrontEnd, Reading, observe_all};
use sinew_lab::score::{Spread, run_all};

/// Largest median 3D error of the hand with 50 particles, metres.
const LARGEST_ERROR_M: f64 = 0.12;
/// Largest median 2D error, pixels of 640.
const LARGEST_ERROR_PX: f64 = 20.0;

#[test]
fn the_default_tracker_is_as_accurate_as_the_book_says() {
    let Some(folder) = shared_data::in_release("mocap") else { return };
    let clips = clips::recorded(&folder).unwrap();
    assert!(clips.len() >= 6, "{} clips", clips.len());
    let skin = SkinModel::from_option(DEFAULT_SKIN).unwrap();
    let front_end = FrontEnd { config: &Config::default(), skin: &skin, reading: Reading::OverTime };
    let scenes = observe_all(&clips, &[1, 2], &SceneOptions::default(), &front_end, &Cells::not_kept()).unwrap();
    let runs = run_all(&scenes, &ArmOptions::default(), &Cells::not_kept()).unwrap();
    let metres = Spread::of(&runs.iter().map(|run| run.mean_m).collect::<Vec<_>>()).median;
    let pixels = Spread::of(&runs.iter().map(|run| run.mean_px).collect::<Vec<_>>()).median;
    println!("{metres:.3} m, {pixels:.1} px over {} runs", runs.len());
    assert!((0.03..=LARGEST_ERROR_M).contains(&metres), "{metres} m");
    assert!((3.0..=LARGEST_ERROR_PX).contains(&pixels), "{pixels} px");
}
