//! MOT motion files: a short header, then a tab-separated table of time and angles in degrees,
//! under the names of OpenSim's coordinates.

use crate::cyclic::anatomy::{AnatomicalSeries, COUNT};
use std::fmt::Write as _;

/// Name and sign of each anatomical angle as a coordinate of OpenSim's models since 2016 (Rajagopal
/// et al., IEEE Transactions on Biomedical Engineering 63). There the pelvis tilts backwards, and
/// the trunk here has no joint between pelvis and chest.
const COORDINATES: [(&str, f64); COUNT] = [
    ("pelvis_tilt", -1.0),
    ("arm_flex_l", 1.0),
    ("elbow_flex_l", 1.0),
    ("hip_flexion_l", 1.0),
    ("knee_angle_l", 1.0),
    ("arm_flex_r", 1.0),
    ("elbow_flex_r", 1.0),
    ("hip_flexion_r", 1.0),
    ("knee_angle_r", 1.0),
];

/// The text of a MOT file called `name` inside. Programs that read MOT know no missing value: NaN
/// stands there.
#[must_use]
pub fn to_mot(series: &AnatomicalSeries, name: &str) -> String {
    let columns = COORDINATES.len() + 1;
    let mut text = format!(
        "{}\nversion=1\nnRows={}\nnColumns={columns}\ninDegrees=yes\nendheader\ntime\t{}\n",
        name.replace(['\n', '\r'], " "),
        series.frames.len(),
        COORDINATES.map(|(name, _)| name).join("\t")
    );
    for (frame, pose) in series.frames.iter().zip(&series.angles_deg) {
        let cell = |(angle, (_, sign)): (&Option<f64>, (&str, f64))| {
            angle.map_or_else(|| "NaN".to_owned(), |angle| format!("{:.6}", sign * angle))
        };
        let cells: Vec<String> = pose.iter().zip(COORDINATES).map(cell).collect();
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{:.6}\t{}", *frame as f64 / series.rate_hz, cells.join("\t"));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cyclic::anatomy::COUNT;

    #[test]
    fn the_header_counts_rows_and_columns() {
        let mut pose = [Some(2.0); COUNT];
        pose[8] = None;
        let series = AnatomicalSeries { frames: vec![0, 1], angles_deg: vec![[Some(1.0); COUNT], pose], rate_hz: 50.0 };
        let text = to_mot(&series, "walk");
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[..6], ["walk", "version=1", "nRows=2", "nColumns=10", "inDegrees=yes", "endheader"]);
        assert!(lines[6].starts_with("time\tpelvis_tilt\tarm_flex_l"));
        assert_eq!(lines[8].split('\t').next(), Some("0.020000"));
        assert!(lines[8].ends_with("\tNaN"));
        assert!(lines[6..].iter().all(|line| line.split('\t').count() == 10));
    }
}
