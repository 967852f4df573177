//! Pictures that are missing from a folder, by the frame numbers in the names of the others.

use crate::cloud::frame_number::frame_numbers;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// A folder has gaps where more than these many of so many steps from number to number are alike.
/// Chosen: folders thinned to another rate have more of the longer steps, 25 of 30 pictures a
/// second one in five, 20 of 30 every second.
const REGULAR_STEPS: [usize; 2] = [5, 6];

/// The file of a frame.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum FrameFile {
    /// A picture of the folder.
    Present(PathBuf),
    /// None; the name that it would have.
    Missing(PathBuf),
}

impl FrameFile {
    /// Where it is, or would be.
    pub fn path(&self) -> &Path {
        match self {
            Self::Present(path) | Self::Missing(path) => path,
        }
    }
}

/// A frame for each of `files`, and for each number that is missing between two of them. Numbers
/// grow by the step that nearly all have, whichever that is. There are no gaps where names have no
/// numbers, steps are uneven, or more pictures would be missing than there are.
pub(crate) fn with_gaps(files: Vec<PathBuf>) -> Vec<FrameFile> {
    let Some((numbers, step)) = regular_numbers(&files) else {
        return files.into_iter().map(FrameFile::Present).collect();
    };
    let mut frames = Vec::with_capacity(files.len());
    for (index, file) in files.into_iter().enumerate() {
        let number = numbers[index];
        let next = numbers.get(index + 1).copied().unwrap_or(number);
        let missing = (number.saturating_add(step)..next).step_by(step as usize);
        let names: Vec<PathBuf> = missing.map(|missing| renumbered(&file, number, missing)).collect();
        frames.push(FrameFile::Present(file));
        frames.extend(names.into_iter().map(FrameFile::Missing));
    }
    frames
}

/// The number of each file and the step of nearly all; none where numbers are missing that are no
/// gaps.
fn regular_numbers(files: &[PathBuf]) -> Option<(Vec<u64>, u64)> {
    let stems: Vec<_> = files.iter().map(|file| file.file_stem().unwrap_or_default().to_string_lossy()).collect();
    let stems: Vec<&str> = stems.iter().map(AsRef::as_ref).collect();
    let numbers = frame_numbers(&stems)?;
    let steps: Vec<u64> = numbers.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let mut uses: BTreeMap<u64, usize> = BTreeMap::new();
    for step in &steps {
        *uses.entry(*step).or_default() += 1;
    }
    let (&step, &count) = uses.iter().max_by_key(|(_, count)| **count)?;
    let [part, of] = REGULAR_STEPS;
    let is_regular = of * count > part * steps.len() && steps.iter().all(|other| other % step == 0);
    let missing = steps.iter().fold(0_u64, |sum, other| sum.saturating_add(other / step - 1));
    (is_regular && missing < files.len() as u64).then_some((numbers, step))
}

/// The name of `file` with `wanted` in place of its last `number`, as many digits wide.
fn renumbered(file: &Path, number: u64, wanted: u64) -> PathBuf {
    let part = |part: Option<&std::ffi::OsStr>| part.unwrap_or_default().to_string_lossy().into_owned();
    let (name, stem) = (part(file.file_name()), part(file.file_stem()));
    let mut rest = stem.as_str();
    loop {
        rest = rest.trim_end_matches(|c: char| !c.is_ascii_digit());
        let before = rest.trim_end_matches(|c: char| c.is_ascii_digit());
        let (begin, end) = (before.len(), rest.len());
        if rest[begin..].parse() == Ok(number) {
            let width = end - begin;
            return file.with_file_name(format!("{before}{wanted:0width$}{}", &name[end..]));
        }
        if rest.is_empty() {
            return file.to_path_buf();
        }
        rest = before;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The names of the frames of a folder with these numbers; those that are missing in brackets.
    fn frames(numbers: impl IntoIterator<Item = u64>) -> Vec<String> {
        let files = numbers.into_iter().map(|number| PathBuf::from(format!("take2/f_{number:03}_cam1.png"))).collect();
        let name = |path: &Path| path.file_name().unwrap().to_string_lossy().into_owned();
        with_gaps(files)
            .iter()
            .map(|frame| match frame {
                FrameFile::Present(path) => name(path),
                FrameFile::Missing(path) => format!("({})", name(path)),
            })
            .collect()
    }

    #[test]
    fn missing_numbers_are_frames_by_their_names() {
        let found = frames((5..12).chain(14..20));
        assert_eq!(found.len(), 15);
        assert_eq!(found[6..10], ["f_011_cam1.png", "(f_012_cam1.png)", "(f_013_cam1.png)", "f_014_cam1.png"]);
        assert_eq!(frames((0..10).chain(29..65)).len(), 65);
        let fifth = frames((0..10).chain(12..20).map(|frame| 5 * frame));
        assert_eq!((fifth.len(), fifth[10].as_str()), (20, "(f_050_cam1.png)"));
    }

    #[test]
    fn thinned_folders_and_separate_takes_have_no_gaps() {
        for step in [1, 2, 5] {
            assert_eq!(frames((0..30).map(|frame| step * frame)).len(), 30, "step {step}");
        }
        for (kept, of) in [(20, 30), (24, 30), (25, 30), (12, 30)] {
            assert_eq!(frames((0..60).map(|frame| frame * of / kept)).len(), 60, "{kept} of {of}");
        }
        assert_eq!(frames((0..10).chain(800..820)).len(), 30, "more would be missing than there are");
        assert_eq!(frames([4]).len(), 1);
        let unnumbered = ["a.png", "b.png", "c.png"].map(PathBuf::from).to_vec();
        assert_eq!(with_gaps(unnumbered.clone()), unnumbered.into_iter().map(FrameFile::Present).collect::<Vec<_>>());
    }
}
