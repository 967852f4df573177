//! Anatomical angles of recorded walks lie where textbooks have them.

use sinew::cyclic::anatomy::repetition::repetitions;
use sinew::cyclic::anatomy::symmetry::symmetries;
use sinew::cyclic::anatomy::{AnatomicalSeries, CycleCurves};
use sinew::cyclic::{AngleTable, CutList};
use sinew_tests::shared_data;

/// Sagittal ranges of healthy walking: knee about 60 degrees, hip 40 to 70 (brisk walkers), elbow
/// and shoulder less than 90. One side is half a cycle after the other. Ranges agree to 35 %, since
/// some people speed up.
#[test]
fn walking_has_the_ranges_of_healthy_gait() {
    let Some(folder) = shared_data("cyclic-walking") else { return };
    for cut in CutList::read(&folder.join("test_cuts.csv")).unwrap().cuts() {
        let table = AngleTable::read(&folder.join(&cut.file)).unwrap();
        let series = AnatomicalSeries::of_table(&table, 60.0);
        let cycles = [[cut.start_frame as f64, cut.end_frame as f64]];
        let found = repetitions(&series, &cycles);
        assert!((40.0..70.0).contains(&found[0].tempo_per_min), "{cut:?}");
        for symmetry in symmetries(&found, &CycleCurves::new(&series, &cycles), 0.0) {
            let bounds = match symmetry.angle {
                "knee_flexion" => 45.0..80.0,
                "hip_flexion" => 35.0..72.0,
                _ => 4.0..90.0,
            };
            for range in [symmetry.left_range_deg, symmetry.right_range_deg] {
                assert!(bounds.contains(&range.unwrap()), "{cut:?}: {symmetry:?}");
            }
            if ["knee_flexion", "hip_flexion"].contains(&symmetry.angle) {
                assert!((symmetry.right_lag_cycles.unwrap() - 0.5).abs() < 0.06, "{cut:?}: {symmetry:?}");
                assert!(symmetry.symmetry_index_percent.unwrap().abs() < 35.0, "{cut:?}: {symmetry:?}");
            }
        }
        // A knee does not bend forwards, apart from the few degrees by which marker joints are off.
        assert!(found[0].ranges[4].unwrap().min_deg > -12.0, "{cut:?}: {:?}", found[0].ranges[4]);
    }
}
