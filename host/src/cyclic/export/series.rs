//! Anatomical angles as CSV.

use crate::cyclic::anatomy::{ANATOMICAL_ANGLES, AnatomicalSeries};
use std::fmt::Write as _;

/// `frame,time_s`, then each anatomical angle in degrees; an empty cell is a missing angle.
#[must_use]
pub fn to_csv(series: &AnatomicalSeries) -> String {
    let names = ANATOMICAL_ANGLES.map(|name| format!("{name}_deg"));
    let mut text = format!("frame,time_s,{}\n", names.join(","));
    for (frame, pose) in series.frames.iter().zip(&series.angles_deg) {
        let cells = pose.map(|angle| angle.map_or_else(String::new, |angle| format!("{angle:.4}")));
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{frame},{:.6},{}", *frame as f64 / series.rate_hz, cells.join(","));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cyclic::anatomy::COUNT;

    #[test]
    fn missing_angles_are_empty_cells() {
        let mut pose = [Some(1.5); COUNT];
        pose[1] = None;
        let series = AnatomicalSeries { frames: vec![30], angles_deg: vec![pose], rate_hz: 60.0 };
        let text = to_csv(&series);
        assert!(text.starts_with("frame,time_s,trunk_lean_deg,l_shoulder_flexion_deg"));
        assert!(text.ends_with("\n30,0.500000,1.5000,,1.5000,1.5000,1.5000,1.5000,1.5000,1.5000,1.5000\n"), "{text}");
    }
}
