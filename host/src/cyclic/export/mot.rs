//! MOT motion files: a short header, then a tab-separated table of time and angles in degrees.

use crate::cyclic::anatomy::{ANATOMICAL_ANGLES, AnatomicalSeries};
use std::fmt::Write as _;

/// The text of a MOT file called `name` inside. Programs that read MOT know no missing value: NaN
/// stands there.
#[must_use]
pub fn to_mot(series: &AnatomicalSeries, name: &str) -> String {
    let columns = ANATOMICAL_ANGLES.len() + 1;
    let mut text = format!(
        "{}\nversion=1\nnRows={}\nnColumns={columns}\ninDegrees=yes\nendheader\ntime\t{}\n",
        name.replace(['\n', '\r'], " "),
        series.frames.len(),
        ANATOMICAL_ANGLES.join("\t")
    );
    for (frame, pose) in series.frames.iter().zip(&series.angles_deg) {
        let cells = pose.map(|angle| angle.map_or_else(|| "NaN".to_owned(), |angle| format!("{angle:.6}")));
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
        assert!(lines[6].starts_with("time\ttrunk_lean\tl_shoulder_flexion"));
        assert_eq!(lines[8].split('\t').next(), Some("0.020000"));
        assert!(lines[8].ends_with("\tNaN"));
        assert!(lines[6..].iter().all(|line| line.split('\t').count() == 10));
    }
}
