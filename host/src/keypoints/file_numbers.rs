//! The number of the frame in a file's name.

use std::path::Path;

/// Files in the order of their frames.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Numbered {
    /// For each frame its number and the index of its name.
    pub frames: Vec<(u64, usize)>,
    /// No number in the names rises, and frames are counted from 0.
    pub is_counted: bool,
}

/// Finds the frame of each name. Of several numbers in the names it is one that rises from name to
/// name in natural order, else one that differs in all names. Of several such numbers it is the one
/// with the smallest span, which a time or a date exceeds. Names that have none are counted.
#[must_use]
pub fn frames(names: &[String]) -> Numbered {
    let mut order: Vec<usize> = (0..names.len()).collect();
    order.sort_by(|&a, &b| natord::compare(&names[a], &names[b]).then_with(|| names[a].cmp(&names[b])));
    let numbers: Vec<Vec<Option<u64>>> = order.iter().map(|&index| numbers(&names[index])).collect();
    let runs = numbers.iter().map(Vec::len).min().unwrap_or(0);
    // From the end: what stands before the frame's number may differ more.
    let column = |from_end: usize| -> Option<Vec<u64>> {
        numbers.iter().map(|numbers| numbers[numbers.len() - 1 - from_end]).collect()
    };
    let columns: Vec<Vec<u64>> = (0..runs).filter_map(column).collect();
    let span = |column: &&Vec<u64>| column.iter().max().unwrap_or(&0) - column.iter().min().unwrap_or(&0);
    let rising = columns.iter().filter(|column| column.windows(2).all(|pair| pair[0] < pair[1])).min_by_key(span);
    let found = rising.or_else(|| columns.iter().filter(|column| is_distinct(column)).min_by_key(span));
    let is_counted = found.is_none();
    let mut frames: Vec<(u64, usize)> = match found {
        Some(column) => column.iter().copied().zip(order).collect(),
        None => (0..).zip(order).collect(),
    };
    frames.sort_unstable();
    Numbered { frames, is_counted }
}

fn is_distinct(column: &[u64]) -> bool {
    let mut sorted = column.to_vec();
    sorted.sort_unstable();
    sorted.windows(2).all(|pair| pair[0] < pair[1])
}

/// The numbers in a name without its ending; `None` for one that is too large.
fn numbers(name: &str) -> Vec<Option<u64>> {
    let stem = Path::new(name).file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let runs = stem.split(|letter: char| !letter.is_ascii_digit()).filter(|run| !run.is_empty());
    runs.map(|run| run.parse().ok()).collect()
}

/// The number at the end of a name without its ending.
#[must_use]
pub fn last_number(name: &str) -> Option<u64> {
    numbers(name).pop()?
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(names: &[&str]) -> (Vec<u64>, bool) {
        let names: Vec<String> = names.iter().map(|name| (*name).to_owned()).collect();
        let numbered = frames(&names);
        (numbered.frames.iter().map(|frame| frame.0).collect(), numbered.is_counted)
    }

    #[test]
    fn the_number_that_rises_is_the_frame() {
        assert_eq!(found(&["clip_9_keypoints.json", "clip_10_keypoints.json"]), (vec![9, 10], false));
        assert_eq!(found(&["frame000001_cam1.json", "frame000004_cam1.json"]), (vec![1, 4], false));
        assert_eq!(found(&["2024-05-01_7_1714550000123.json", "2024-05-01_8_1714550000156.json"]), (vec![7, 8], false));
        assert_eq!(found(&["cam2_f3.json", "cam1_f5.json", "cam2_f9.json"]), (vec![3, 5, 9], false));
        assert_eq!(found(&["a.json", "b.json"]), (vec![0, 1], true));
        assert!(found(&["a_1_cam1.json", "a_1_cam2.json", "a_2_cam1.json", "a_2_cam2.json"]).1);
        assert_eq!(found(&["99999999999999999999999_1.json", "99999999999999999999999_2.json"]), (vec![1, 2], false));
    }

    #[test]
    fn names_follow_their_frames() {
        let names = ["b_2.json", "a_3.json", "c_1.json"].map(str::to_owned);
        assert_eq!(frames(&names).frames, [(1, 2), (2, 0), (3, 1)]);
        assert_eq!(last_number("labeled/img0042.png"), Some(42));
        assert_eq!(last_number("x.png"), None);
    }
}
