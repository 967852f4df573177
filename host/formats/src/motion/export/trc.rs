//! TRC files: places of named points over time, for OpenSim and similar programs.

use std::fmt::Write as _;

/// Length unit of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TrcUnit {
    /// `m`, six decimals.
    Metre,
    /// `mm`, three decimals; what most programs write.
    Millimetre,
}

/// The header of a file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrcHeading<'a> {
    /// Name of the motion.
    pub name: &'a str,
    /// Names of the points.
    pub markers: &'a [&'a str],
    /// Frames in a second.
    pub rate_hz: f64,
    /// Unit of the file.
    pub unit: TrcUnit,
}

/// The points at one time.
#[derive(Debug, Clone, PartialEq)]
pub struct TrcFrame {
    /// Number of the frame; its time is this over the rate.
    pub frame: u64,
    /// Place of each point in metres, in the order of the names; `None` where it is not known.
    pub positions_m: Vec<Option<[f64; 3]>>,
}

/// The text of a TRC file. Axes are those of the frames: y up is what OpenSim expects. Unknown
/// places are empty cells, so are the last ones of a frame with fewer places than there are names;
/// surplus places are left out.
#[must_use]
pub fn to_trc(heading: &TrcHeading<'_>, frames: &[TrcFrame]) -> String {
    let (unit, per_metre, decimals) = match heading.unit {
        TrcUnit::Metre => ("m", 1.0, 6),
        TrcUnit::Millimetre => ("mm", 1000.0, 3),
    };
    let (rate_hz, frame_count, marker_count) = (heading.rate_hz, frames.len(), heading.markers.len());
    let first_frame = frames.first().map_or(0, |frame| frame.frame);
    let cell = |text: &str| text.replace(['\n', '\r', '\t'], " ");
    let mut text = format!(
        "PathFileType\t4\t(X/Y/Z)\t{}\nDataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames\n\
        {rate_hz}\t{rate_hz}\t{frame_count}\t{marker_count}\t{unit}\t{rate_hz}\t{first_frame}\t{frame_count}\nFrame#\tTime",
        cell(heading.name)
    );
    for marker in heading.markers {
        text.push_str(&format!("\t{}\t\t", cell(marker)));
    }
    text.push_str("\n\t");
    for marker in 1..=marker_count {
        text.push_str(&format!("\tX{marker}\tY{marker}\tZ{marker}"));
    }
    text.push_str("\n\n");
    for frame in frames {
        // Writing to a string cannot fail.
        let _ = write!(text, "{}\t{:.6}", frame.frame, frame.frame as f64 / rate_hz);
        for marker in 0..marker_count {
            let _ = match frame.positions_m.get(marker).copied().flatten() {
                None => write!(text, "\t\t\t"),
                Some(place_m) => {
                    place_m.iter().try_for_each(|value| write!(text, "\t{:.decimals$}", value * per_metre))
                }
            };
        }
        text.push('\n');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::trc::parse;
    use proptest::prelude::*;
    use std::path::Path;

    proptest! {
        /// Half a unit of the last decimal, and the reader's rounding.
        #[test]
        fn what_is_written_is_read_back(
            places in prop::collection::vec(prop::option::of(prop::array::uniform3(-5.0_f64..5.0)), 12),
            unit in prop_oneof![Just(TrcUnit::Metre), Just(TrcUnit::Millimetre)],
        ) {
            let heading = TrcHeading { name: "a\tb", markers: &["Pelvis", "Left hand", "Head"], rate_hz: 15.0, unit };
            let frames: Vec<TrcFrame> =
                (7..).zip(places.chunks(3)).map(|(frame, row)| TrcFrame { frame, positions_m: row.to_vec() }).collect();
            let motion = parse(&to_trc(&heading, &frames), Path::new("m.trc")).unwrap();
            prop_assert_eq!(&motion.names, &heading.markers);
            prop_assert!((motion.frames_per_second - 15.0).abs() < 1.0e-6);
            for (found, wanted) in motion.positions_m.iter().zip(&frames) {
                for (found, wanted) in found.iter().zip(&wanted.positions_m) {
                    prop_assert_eq!(found.is_some(), wanted.is_some());
                    if let (Some(found), Some(wanted)) = (found, wanted) {
                        prop_assert!(found.iter().zip(wanted).all(|(a, b)| (f64::from(*a) - b).abs() < 2.0e-6));
                    }
                }
            }
        }
    }

    #[test]
    fn rows_have_a_cell_for_each_name_whatever_the_frames_hold() {
        let heading = TrcHeading { name: "m", markers: &["a", "b"], rate_hz: 50.0, unit: TrcUnit::Millimetre };
        let frames = [vec![Some([1.0, -0.5, 0.25])], vec![None, Some([0.0; 3]), Some([9.0; 3])]];
        let frames = (3..).zip(frames).map(|(frame, positions_m)| TrcFrame { frame, positions_m }).collect::<Vec<_>>();
        let text = to_trc(&heading, &frames);
        assert!(
            text.ends_with(
                "\n3\t0.060000\t1000.000\t-500.000\t250.000\t\t\t\n4\t0.080000\t\t\t\t0.000\t0.000\t0.000\n"
            )
        );
    }
}
