//! Flexion angles of what was measured: the angles of a table, filtered, without a model of the
//! motion.

use super::angles::{ANATOMICAL_ANGLES, AnatomicalSeries};
use crate::cyclic::angle_table::{ANGLES, AngleTable};
use crate::cyclic::even_rows::EvenRows;
use crate::cyclic::place_columns::PlaceColumns;
use crate::cyclic::turns::wrapped;
use crate::error::{Context, Result};
use crate::signal::{FilterOptions, filtered_angles};
use std::f64::consts::FRAC_PI_2;
use std::fmt::Write as _;

/// Angles of the feet, after [`ANATOMICAL_ANGLES`]:
///
/// | angle | positive |
/// |---|---|
/// | ankle dorsiflexion | the foot, from heel to toe, is turned up from square to the shank |
/// | foot pitch | the toe is above the heel |
pub const FOOT_ANGLES: [&str; 4] = ["l_ankle_dorsiflexion", "l_foot_pitch", "r_ankle_dorsiflexion", "r_foot_pitch"];

/// Shank of each side among the table's angles.
const SHANKS: [usize; 2] = [9, 12];

/// Measured angles over time, one entry a frame, also for frames that the table leaves out.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredAngles {
    /// The angles of [`ANATOMICAL_ANGLES`].
    pub series: AnatomicalSeries,
    /// The angles of [`FOOT_ANGLES`], degrees; `None` where heel or toe was not seen.
    pub feet_deg: Vec<[Option<f64>; 4]>,
}

impl MeasuredAngles {
    /// The angles of `table`, whose person faces right, filtered at `rate_hz`.
    ///
    /// Filtered are the directions of the segments, so that an outlier of one joint stays with its
    /// segments.
    ///
    /// # Errors
    /// The filter refuses the rate, or frame numbers leave out so many frames that they are wrong.
    pub fn of_table(table: &AngleTable, rate_hz: f64, options: &FilterOptions) -> Result<Self> {
        let even = EvenRows::new(table).context(
            "frame numbers jump over more than a hundred frames for each row; cut the recording where it jumps",
        )?;
        let mut segments_rad = vec![[None; ANGLES]; even.count()];
        for angle in 0..ANGLES {
            let smooth = filtered_angles(&even.series(|row| row.angles_rad[angle]), rate_hz, options)?;
            segments_rad.iter_mut().zip(smooth).for_each(|(pose, value)| pose[angle] = value);
        }
        let columns = PlaceColumns::find(table);
        let mut feet_deg = vec![[None; 4]; even.count()];
        for (side, shank) in SHANKS.into_iter().enumerate() {
            let direction = even.series(|row| {
                let [forward, down] = columns.as_ref()?.heel_to_toe(row, side)?;
                (forward != 0.0 || down != 0.0).then(|| down.atan2(forward))
            });
            let smooth = filtered_angles(&direction, rate_hz, options)?;
            for ((feet, pose), foot) in feet_deg.iter_mut().zip(&segments_rad).zip(smooth) {
                let ankle = pose[shank].zip(foot).map(|(shank, foot)| wrapped(shank - foot - FRAC_PI_2));
                let pitch = foot.map(|foot| wrapped(-foot));
                (feet[2 * side], feet[2 * side + 1]) = (ankle.map(f64::to_degrees), pitch.map(f64::to_degrees));
            }
        }
        let frames = (even.first_frame..even.first_frame + even.count() as u64).collect();
        Ok(Self { series: AnatomicalSeries::of_poses(frames, &segments_rad, rate_hz), feet_deg })
    }

    /// As CSV: `frame,time_s`, then each angle in degrees; an empty cell is a missing angle. The
    /// angles of the feet are there if any was measured.
    #[must_use]
    pub fn to_csv(&self) -> String {
        let has_feet = self.feet_deg.as_flattened().iter().any(Option::is_some);
        let feet: &[&str] = if has_feet { &FOOT_ANGLES } else { &[] };
        let mut text = "frame,time_s".to_owned();
        ANATOMICAL_ANGLES.iter().chain(feet).for_each(|name| text.push_str(&format!(",{name}_deg")));
        text.push('\n');
        let rows = self.series.frames.iter().zip(&self.series.angles_deg).zip(&self.feet_deg);
        for ((frame, pose), feet_deg) in rows {
            // Writing to a string cannot fail.
            let _ = write!(text, "{frame},{:.6}", *frame as f64 / self.series.rate_hz);
            for angle in pose.iter().chain(&feet_deg[..feet.len()]) {
                let cell = angle.map_or_else(String::new, |angle| format!("{angle:.4}"));
                let _ = write!(text, ",{cell}");
            }
            text.push('\n');
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::super::angles::COUNT;
    use super::*;
    use crate::cyclic::angle_table::AngleRow;
    use crate::cyclic::feet;
    use crate::signal::FilterKind;

    /// A person who stands with the left knee bent by 30 degrees and the left toe 3 up and 4 ahead.
    fn table(frames: impl Iterator<Item = u64>) -> AngleTable {
        let row = |frame: u64| {
            let mut angles_rad = [Some(FRAC_PI_2); ANGLES];
            angles_rad[0] = Some(-FRAC_PI_2);
            angles_rad[9] = Some(FRAC_PI_2 + 30.0_f64.to_radians());
            let cells = ["100", "50", "96", "90", "100", "87", "", "", "104", "90"].map(str::to_owned);
            AngleRow { frame, angles_rad, extra: cells.to_vec() }
        };
        let columns = ["hip_center_u_px", "hip_center_v_px"].map(str::to_owned).into_iter().chain(feet::columns("px"));
        AngleTable::new(frames.map(row).collect(), columns.collect()).unwrap()
    }

    #[test]
    fn angles_of_knee_ankle_and_foot_are_those_of_the_points() {
        let measured = MeasuredAngles::of_table(&table(0..30), 60.0, &FilterOptions::default()).unwrap();
        assert!((measured.series.angles_deg[10][4].unwrap() - 30.0).abs() < 1.0e-6, "the knee");
        let [ankle, pitch, right_ankle, _] = measured.feet_deg[10];
        let up_deg = 3.0_f64.atan2(4.0).to_degrees();
        assert!((pitch.unwrap() - up_deg).abs() < 1.0e-6 && (ankle.unwrap() - 30.0 - up_deg).abs() < 1.0e-6);
        assert_eq!(right_ankle, None);
        let csv = measured.to_csv();
        assert!(csv.starts_with("frame,time_s,trunk_lean_deg,l_shoulder_flexion_deg"));
        assert!(csv.lines().all(|line| line.split(',').count() == 2 + COUNT + FOOT_ANGLES.len()));
    }

    #[test]
    fn left_out_frames_have_rows_which_are_filled_up_to_the_limit() {
        let gaps = (0..60).filter(|frame| !(20..23).contains(frame) && !(40..50).contains(frame));
        let options = FilterOptions { filter: FilterKind::None, ..FilterOptions::default() };
        let measured = MeasuredAngles::of_table(&table(gaps), 30.0, &options).unwrap();
        let is_seen = |frame: usize| measured.series.angles_deg[frame][4].is_some();
        assert_eq!((measured.series.frames.len(), is_seen(21), is_seen(45)), (60, true, false));
    }
}
