//! Arms that go round: real arm circles of one person in two recordings, forwards and backwards.
//! Runs in release where `../shared/data` is at hand, and says so where not.

use crate::shared_data;

use crate::circles::{Circles, FORWARDS, trained, write_tables};
use sinew::cyclic::tracking::{FilterName, TrackingOptions, track};
use sinew::cyclic::{AngleRow, AngleTable, CyclicModel};
use sinew_lab::cyclic::Protocol;
use sinew_lab::cyclic::protocol::measurements;
use std::f64::consts::{PI, TAU};
use std::ops::Range;
use std::path::Path;

/// Cycles backwards in the same recordings.
const BACKWARDS: [(&str, Circles); 2] = [("13_29", &[(844, 914)]), ("13_31", &[(1186, 1252)])];

fn frames(folder: &Path, trial: &str, frames: Range<u64>) -> AngleTable {
    let table = AngleTable::read(&folder.join(format!("{trial}.csv"))).unwrap();
    let rows: Vec<AngleRow> = table.rows().iter().filter(|row| frames.contains(&row.frame)).cloned().collect();
    AngleTable::new(rows, table.extra_columns().to_vec()).unwrap()
}

/// Angles whose whole turns at the end are not those of the truth, and the mean error, degrees.
fn wrong_turns(model: &CyclicModel, truth: &AngleTable, protocol: Protocol, sigma_deg: f64, seed: u64) -> (usize, f64) {
    let sigma_rad = sigma_deg.to_radians();
    let options = TrackingOptions { filter: FilterName::Coupled, sigma_rad, ..TrackingOptions::default() };
    let tracked = track(&measurements(truth, protocol, sigma_rad, seed), model, &options).unwrap();
    let (mut wrong, mut sum, mut count) = (0, 0.0, 0);
    for angle in 0..13 {
        let apart = |(frame, row): (&sinew::cyclic::tracking::TrackedFrame, &AngleRow)| {
            frame.angles_rad[angle] - row.angles_rad[angle].unwrap()
        };
        let apart: Vec<f64> = tracked.frames.iter().zip(truth.rows()).map(apart).collect();
        wrong += usize::from((apart[apart.len() - 1] / TAU).round() != 0.0);
        assert!(apart[0].abs() < PI && apart[1].abs() < PI, "angle {angle} jumps after the first row: {apart:?}");
        sum += apart.iter().map(|apart| (apart - (apart / TAU).round() * TAU).abs()).sum::<f64>();
        count += apart.len();
    }
    (wrong, (sum / f64::from(count as u32)).to_degrees())
}

#[test]
fn turns_of_circling_arms_are_counted_both_ways() {
    let Some(data) = shared_data::in_release("mocap") else { return };
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    write_tables(&data, folder);
    let backwards = trained(folder, &BACKWARDS);
    assert_eq!(backwards.view().parts().turns_per_cycle[6], -1, "the right forearm goes round once");
    let [first, second] = FORWARDS.map(|recording| trained(folder, &[recording]));
    assert_eq!([&first, &second].map(|model| model.view().parts().turns_per_cycle[6]), [1, 1]);
    // Each recording by the model of the other one; of the way backwards there are two cycles in
    // all.
    let cases = [
        (&second, frames(folder, "13_29", 639..821)),
        (&first, frames(folder, "13_31", 1031..1124)),
        (&backwards, frames(folder, "13_29", 844..914)),
        (&backwards, frames(folder, "13_31", 1186..1252)),
    ];
    for (model, truth) in &cases {
        for (protocol, sigma_deg, most_deg) in [
            (Protocol::ExactMean, 6.0, 2.0),
            (Protocol::Noisy, 6.0, 6.0),
            (Protocol::ExactMean, 29.0, 14.0),
            (Protocol::Noisy, 29.0, 20.0),
        ] {
            for seed in 1..=5 {
                let (wrong, error_deg) = wrong_turns(model, truth, protocol, sigma_deg, seed);
                let first = truth.first_frame();
                println!("{first}: {protocol:?} {sigma_deg}, seed {seed}: {wrong} wrong, {error_deg:.1} degrees");
                assert!(error_deg > 0.1 && error_deg < most_deg, "{first}: {error_deg}");
                // With noise of half a radian a joint of an arm that points at the camera may go
                // round either way.
                assert!(wrong <= usize::from(sigma_deg > 10.0), "{first}: {wrong} angles");
            }
        }
    }
}
