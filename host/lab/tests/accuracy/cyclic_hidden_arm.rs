//! An arm that is hidden for a cycle, after two cycles in which it was seen: walkers of other
//! sources. Runs in release where `../shared/data` is at hand, and says so where not.

use crate::shared_data;
use crate::walk_cuts::list;
use sinew::cyclic::cuts::Cut;
use sinew::cyclic::tracking::{TrackingOptions, track};
use sinew::cyclic::turns::least_angle;
use sinew::cyclic::{AngleRow, AngleTable, CyclicModel};
use sinew_lab::cyclic::Protocol;
use sinew_lab::cyclic::other_sources::WALKS;
use sinew_lab::cyclic::protocol::measurements;

/// Noise, degrees, with the mean error of upper arm and forearm while they are hidden, degrees.
const HIDDEN: [(f64, f64); 3] = [(1.0, 3.03), (3.0, 2.98), (6.0, 3.09)];
/// Relative room of these numbers.
const ROOM: f64 = 0.07;
/// Upper arm and forearm of each side.
const ARMS: [[usize; 2]; 2] = [[2, 3], [5, 6]];

/// Error of an arm, degrees, in the last of three cycles, in which it is not seen.
fn hidden_error_deg(table: &AngleTable, cuts: &[Cut], arm: [usize; 2], sigma_deg: f64) -> f64 {
    let inside = |row: &&AngleRow| (cuts[0].start_frame..cuts[2].end_frame).contains(&row.frame);
    let truth: Vec<AngleRow> =
        table.rows().iter().filter(inside).map(|row| AngleRow { extra: Vec::new(), ..row.clone() }).collect();
    let hidden_from = cuts[2].start_frame;
    let truth_table = AngleTable::new(truth.clone(), Vec::new()).unwrap();
    let options =
        TrackingOptions { sigma_rad: sigma_deg.to_radians(), rate_hz: Some(60.0), ..TrackingOptions::default() };
    let mut rows = measurements(&truth_table, Protocol::Noisy, options.sigma_rad, cuts[0].start_frame).rows().to_vec();
    for row in rows.iter_mut().filter(|row| row.frame >= hidden_from) {
        arm.iter().for_each(|&angle| row.angles_rad[angle] = None);
    }
    let seen = AngleTable::new(rows, Vec::new()).unwrap();
    let tracked = track(&seen, &CyclicModel::from_option("walking").unwrap(), &options).unwrap();
    let hidden = tracked.frames.iter().zip(&truth).filter(|(_, row)| row.frame >= hidden_from);
    let errors: Vec<f64> = hidden
        .flat_map(|(frame, row)| arm.map(|angle| least_angle(frame.angles_rad[angle] - row.angles_rad[angle].unwrap())))
        .collect();
    errors.iter().map(|error| error.abs()).sum::<f64>().to_degrees() / errors.len() as f64
}

#[test]
fn a_hidden_arm_goes_on_as_the_person_swings_it() {
    let Some(data) = shared_data::in_release("mocap") else { return };
    let folder = tempfile::tempdir().unwrap();
    let list = list(&data, folder.path(), &WALKS);
    let mut found_deg = Vec::new();
    for (sigma_deg, expected_deg) in HIDDEN {
        let mut errors = Vec::new();
        for cuts in list.cuts().chunk_by(|before, after| before.file == after.file) {
            let table = AngleTable::read(&list.table_path(&cuts[0])).unwrap();
            for cuts in cuts.windows(3).filter(|cuts| cuts.windows(2).all(|two| two[0].end_frame == two[1].start_frame))
            {
                errors.extend(ARMS.map(|arm| hidden_error_deg(&table, cuts, arm, sigma_deg)));
            }
        }
        let mean_deg = errors.iter().sum::<f64>() / errors.len() as f64;
        println!("sigma {sigma_deg}: a hidden arm is {mean_deg:.2} degrees off, {} runs", errors.len());
        found_deg.push((sigma_deg, mean_deg, expected_deg));
    }
    for (sigma_deg, mean_deg, expected_deg) in found_deg {
        assert!((mean_deg / expected_deg - 1.0).abs() < ROOM, "sigma {sigma_deg}: {mean_deg}");
    }
}
