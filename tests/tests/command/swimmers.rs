//! Swimmers of whom a pose detector saw few joints: keypoints to angles to a track, as a user types
//! it.

use assert_cmd::Command;
use sinew::cyclic::AngleTable;
use sinew::cyclic::angle_table::COLUMNS;
use sinew_tests::{shared_data, sinew_command};
use std::f64::consts::{PI, TAU};
use std::path::Path;

/// Half the width of a 90 % band, standard deviations.
const BAND_90: f64 = 1.645;
/// Noise of an angle of keypoints, degrees: the command's default.
const SIGMA_DEG: f64 = 6.0;
/// Share of withheld measurements in the 90 % band: of each recording with more than a few.
const INSIDE: (f64, f64) = (0.75, 0.99);
const A_FEW: usize = 30;

fn run(folder: &Path, arguments: &[&str]) {
    let mut command = Command::from_std(sinew_command());
    command.current_dir(folder).args(arguments).assert().success();
}

/// For each measurement that was withheld, how many standard deviations it lies from the estimate.
fn withheld(folder: &Path) -> Vec<f64> {
    let table = AngleTable::read(&folder.join("t.csv")).unwrap();
    let mut reader = csv::Reader::from_path(folder.join("est.csv")).unwrap();
    let header = reader.headers().unwrap().clone();
    let column = |name: &str| header.iter().position(|other| other == name).unwrap();
    let mut deviations = Vec::new();
    for (row, estimate) in table.rows().iter().zip(reader.records()) {
        let estimate = estimate.unwrap();
        if (row.frame - table.first_frame()).is_multiple_of(2) {
            continue;
        }
        for (angle, name) in row.angles_rad.iter().zip(&COLUMNS[1..]) {
            let Some(measured) = angle else { continue };
            let number = |name: &str| estimate[column(name)].parse::<f64>().unwrap();
            let apart = (measured - number(name) + PI).rem_euclid(TAU) - PI;
            let std_rad = number(&name.replace("_rad", "_std_rad")).hypot(SIGMA_DEG.to_radians());
            assert!(std_rad.is_finite() && std_rad > 0.0, "{name}");
            deviations.push(apart / std_rad);
        }
    }
    deviations
}

/// Every second measurement is withheld; the band of the estimate, widened by the measurement's own
/// noise, holds nine of ten.
#[test]
fn bands_hold_the_truth_with_most_joints_missing() {
    let Some(data) = shared_data("swim2d/swimfix") else { return };
    let mut all = Vec::new();
    for (file, confidence) in [
        ("example_ml.csv", "0.3"),
        ("ml_2021-03-12-17-36-11.csv", "0.3"),
        ("ml_2021-03-12-17-36-13.csv", "0.3"),
        ("feedback_2021-03-12-17-36-11.csv", "0.3"),
        ("sample2_skeletons.json", "0.1"),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let path = data.join(file);
        let from = ["angles", path.to_str().unwrap(), "--input-rate", "30"];
        run(folder.path(), &[&from[..], &["--min-confidence", confidence, "--out", "t.csv"]].concat());
        let options = ["--model", "arm-circles", "--rate", "30", "--update-every", "2", "--out", "est.csv"];
        run(folder.path(), &[&["track", "cyclic", "t.csv", "--online"], &options[..]].concat());
        let found = withheld(folder.path());
        let share = |of: &[f64]| of.iter().filter(|one| one.abs() <= BAND_90).count() as f64 / of.len() as f64;
        println!("{file}: {} withheld, {:.3} of them inside", found.len(), share(&found));
        assert!(found.len() > 5, "{file}");
        assert!(
            found.len() <= A_FEW || (INSIDE.0..=INSIDE.1).contains(&share(&found)),
            "{file}: {} of {}",
            share(&found),
            found.len()
        );
        all.extend(found);
        println!("all so far: {} withheld, {:.3} of them inside", all.len(), share(&all));
    }
    let share = all.iter().filter(|one| one.abs() <= BAND_90).count() as f64 / all.len() as f64;
    assert!((INSIDE.0..=INSIDE.1).contains(&share), "{share} of {}", all.len());
}
