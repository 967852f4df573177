//! Whether the angles of a table are in degrees, where radians are read.

use super::angle_table::{ANGLES, AngleTable};
use crate::signal::median::median;

/// No joint is as fast for half of the time, radians per second. Chosen: a sprinter's knee has as
/// much for a moment, and a stroll in degrees has 30.
const MAX_MEDIAN_SPEED_RAD_PER_S: f64 = 20.0;

/// The doubt about a table whose angles change faster than a person's.
#[must_use]
pub fn in_degrees(table: &AngleTable, rate_hz: f64) -> Option<String> {
    let mut speeds = Vec::new();
    for pair in table.rows().windows(2) {
        let time_s = (pair[1].frame - pair[0].frame) as f64 / rate_hz;
        for angle in 0..ANGLES {
            if let (Some(before), Some(after)) = (pair[0].angles_rad[angle], pair[1].angles_rad[angle]) {
                speeds.push((after - before).abs() / time_s);
            }
        }
    }
    let speed = median(&mut speeds).filter(|speed| *speed > MAX_MEDIAN_SPEED_RAD_PER_S)?;
    Some(format!(
        "the angles change by {speed:.0} radians a second in the median, and no person moves as fast: are they degrees? Columns that end in `_rad` are radians"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_walk_in_degrees_is_doubted_and_a_sprint_in_radians_is_not() {
        let swing = |range: f64, cycles_per_s: f64| {
            let angle = |frame: usize| range * (std::f64::consts::TAU * cycles_per_s * frame as f64 / 30.0).sin();
            let rows: Vec<_> = (0..90).map(|frame| [Some(angle(frame)); ANGLES]).collect();
            in_degrees(&AngleTable::from_angles(0, &rows).unwrap(), 30.0)
        };
        let doubt = swing(10.0, 0.7).unwrap();
        assert!(doubt.starts_with("the angles change by 3") && doubt.contains("are they degrees?"), "{doubt}");
        assert_eq!(swing(1.2, 2.2), None);
        assert_eq!(swing(0.0, 1.0), None);
    }
}
