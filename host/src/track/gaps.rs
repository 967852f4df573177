//! Pictures that are missing from a folder, by the frame numbers in the names of the others.

use crate::cloud::frame_number::{FrameNumber, frame_numbers};
use std::collections::BTreeMap;
use std::ops::Range;
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

/// The numbers in the names of a folder's pictures.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Numbering {
    /// The number of each file.
    numbers: Vec<FrameNumber>,
    /// The step that nearly all numbers grow by; none where missing numbers are no gaps.
    step: Option<u64>,
}

impl Numbering {
    /// Of `files` in natural order; `None` where the names do not number them.
    pub fn of(files: &[PathBuf]) -> Option<Self> {
        let stems: Vec<_> = files.iter().map(|file| file.file_stem().unwrap_or_default().to_string_lossy()).collect();
        let stems: Vec<&str> = stems.iter().map(AsRef::as_ref).collect();
        let numbers = frame_numbers(&stems)?;
        let step = regular_step(&numbers);
        Some(Self { numbers, step })
    }

    /// The first and the last number.
    pub fn ends(&self) -> [u64; 2] {
        [self.numbers.first(), self.numbers.last()].map(|end| end.map_or(0, |end| end.number))
    }

    /// How many numbers between the first and the last one have no picture.
    pub fn unused(&self) -> u64 {
        let [first, last] = self.ends();
        last - first - (self.numbers.len() as u64 - 1)
    }

    /// The numbers of missing pictures that follow the picture at `index`.
    fn missing_after(&self, index: usize) -> impl Iterator<Item = u64> {
        let number = self.numbers[index].number;
        let next = self.numbers.get(index + 1).map_or(number, |next| next.number);
        let step = self.step.unwrap_or(next - number).max(1);
        (number.saturating_add(step)..next).step_by(step as usize)
    }

    /// How many pictures are missing, whose frames get a prediction.
    pub fn missing(&self) -> usize {
        (0..self.numbers.len()).map(|index| self.missing_after(index).count()).sum()
    }
}

/// A frame for each of `files`, and for each number that is missing between two of them. Numbers
/// grow by the step that nearly all have, whichever that is. There are no gaps where names have no
/// numbers, steps are uneven, or more pictures would be missing than there are.
pub(crate) fn with_gaps(files: Vec<PathBuf>) -> Vec<FrameFile> {
    let Some(numbering) = Numbering::of(&files) else {
        return files.into_iter().map(FrameFile::Present).collect();
    };
    let mut frames = Vec::with_capacity(files.len());
    for (index, file) in files.into_iter().enumerate() {
        let digits = &numbering.numbers[index].digits;
        let name = |missing| FrameFile::Missing(renumbered(&file, digits, missing));
        let names: Vec<FrameFile> = numbering.missing_after(index).map(name).collect();
        frames.push(FrameFile::Present(file));
        frames.extend(names);
    }
    frames
}

/// The step of nearly all `numbers`; none where numbers are missing that are no gaps.
fn regular_step(numbers: &[FrameNumber]) -> Option<u64> {
    let steps: Vec<u64> = numbers.windows(2).map(|pair| pair[1].number - pair[0].number).collect();
    let mut uses: BTreeMap<u64, usize> = BTreeMap::new();
    for step in &steps {
        *uses.entry(*step).or_default() += 1;
    }
    let (&step, &count) = uses.iter().max_by_key(|(_, count)| **count)?;
    let [part, of] = REGULAR_STEPS;
    let is_regular = of * count > part * steps.len() && steps.iter().all(|other| other % step == 0);
    let missing = steps.iter().fold(0_u64, |sum, other| sum.saturating_add(other / step - 1));
    (is_regular && missing < numbers.len() as u64).then_some(step)
}

/// The name of `file` with `wanted` in place of its `digits`, as many wide.
fn renumbered(file: &Path, digits: &Range<usize>, wanted: u64) -> PathBuf {
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    let width = digits.len();
    file.with_file_name(format!("{}{wanted:0width$}{}", &name[..digits.start], &name[digits.end..]))
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
