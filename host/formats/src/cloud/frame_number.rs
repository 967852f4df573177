//! Numbers of frames from the names of their files.

use std::ops::Range;

/// The number of a frame, and the bytes of the name that are its digits.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FrameNumber {
    /// The number.
    pub number: u64,
    /// Where its digits stand in the name.
    pub digits: Range<usize>,
}

/// Frame numbers of `stems`, file names without ending in natural order.
///
/// A name may hold several numbers (`take2_frame_000017_cam1`). Counted from the end of the name,
/// the first place whose numbers grow strictly from file to file is the frame's number. `None` if
/// there is no such place.
#[must_use]
pub fn frame_numbers(stems: &[&str]) -> Option<Vec<FrameNumber>> {
    let numbers: Vec<Vec<Option<FrameNumber>>> = stems.iter().map(|stem| numbers_from_the_end(stem)).collect();
    let places = numbers.iter().map(Vec::len).min()?;
    (0..places)
        .filter_map(|place| numbers.iter().map(|of_file| of_file[place].clone()).collect::<Option<Vec<_>>>())
        .find(|column| column.windows(2).all(|pair| pair[0].number < pair[1].number))
}

/// All runs of digits, the last one first; `None` for one beyond 64 bits.
fn numbers_from_the_end(stem: &str) -> Vec<Option<FrameNumber>> {
    let is_other = |c: char| !c.is_ascii_digit();
    let mut numbers = Vec::new();
    let mut rest = stem.trim_end_matches(is_other);
    while !rest.is_empty() {
        let digits = rest.trim_end_matches(|c: char| c.is_ascii_digit()).len()..rest.len();
        numbers.push(rest[digits.clone()].parse().ok().map(|number| FrameNumber { number, digits: digits.clone() }));
        rest = rest[..digits.start].trim_end_matches(is_other);
    }
    numbers
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_number_that_counts_is_found() {
        let cases: [(&[&str], Option<&[u64]>); 9] = [
            (&["frame_2", "frame_10", "frame_11"], Some(&[2, 10, 11])),
            (&["000017"], Some(&[17])),
            (&["take2_7_cam1", "take2_8_cam1"], Some(&[7, 8])),
            (&["1_2500points", "2_2431points"], Some(&[1, 2])),
            (&["a", "b"], None),
            (&["frame_1", "frame_01"], None),
            (&["1", "2", "extra"], None),
            (&["99999999999999999999", "100000000000000000000"], None),
            (&[], None),
        ];
        for (stems, wanted) in cases {
            let found = frame_numbers(stems).map(|found| found.iter().map(|found| found.number).collect::<Vec<_>>());
            assert_eq!(found.as_deref(), wanted, "{stems:?}");
        }
        let digits = frame_numbers(&["take2_007_cam1", "take2_008_cam1"]).unwrap()[1].digits.clone();
        assert_eq!(&"take2_008_cam1"[digits], "008");
    }
}
