//! Numbers of frames from the names of their files.

/// Frame numbers of `stems`, file names without ending in natural order.
///
/// A name may hold several numbers (`take2_frame_000017_cam1`). Counted from the end of the name,
/// the first place whose numbers grow strictly from file to file is the frame's number. `None` if
/// there is no such place.
#[must_use]
pub fn frame_numbers(stems: &[&str]) -> Option<Vec<u64>> {
    let numbers: Vec<Vec<Option<u64>>> = stems.iter().map(|stem| numbers_from_the_end(stem)).collect();
    let places = numbers.iter().map(Vec::len).min()?;
    (0..places)
        .filter_map(|place| numbers.iter().map(|of_file| of_file[place]).collect::<Option<Vec<u64>>>())
        .find(|column| column.windows(2).all(|pair| pair[0] < pair[1]))
}

/// All runs of digits, the last one first; `None` for one beyond 64 bits.
fn numbers_from_the_end(stem: &str) -> Vec<Option<u64>> {
    let runs = stem.split(|c: char| !c.is_ascii_digit()).filter(|run| !run.is_empty());
    runs.rev().map(|run| run.parse().ok()).collect()
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
            assert_eq!(frame_numbers(stems).as_deref(), wanted, "{stems:?}");
        }
    }
}
