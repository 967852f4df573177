//! `truth.csv`: the true joints and markers of each frame.

use super::markers::MARKERS;
use super::scene::StereoScene;
use crate::body::BodyJoints;
use crate::error::{Context, Result, bail, ensure};
use crate::file::read_lines;
use sinew_core::math::Vec3;
use sinew_core::skeleton::full_body::{BODY_BONES, BODY_JOINT_NAMES};
use std::fmt::Write;
use std::path::Path;

/// What is true in one frame; camera axes, metres.
#[derive(Debug, Clone, PartialEq)]
pub struct TrueFrame {
    /// Number of the frame.
    pub frame: u64,
    /// The ends of the bones.
    pub joints_m: BodyJoints,
    /// The markers.
    pub markers_m: Vec<Option<Vec3>>,
}

/// Names of the columns after `frame`: `pelvis_x_m` and on, then `m00_x_m` and on.
#[must_use]
pub fn columns() -> Vec<String> {
    let markers = (0..MARKERS).map(|marker| format!("m{marker:02}"));
    let points = BODY_JOINT_NAMES.iter().map(|name| (*name).to_owned()).chain(markers);
    points.flat_map(|point| ["x", "y", "z"].map(|axis| format!("{point}_{axis}_m"))).collect()
}

/// Truth of a scene as CSV, to a hundredth of a millimetre; a joint that was not recorded is three
/// empty cells.
#[must_use]
pub fn truth_csv(scene: &StereoScene) -> String {
    let mut text = format!("frame,{}\n", columns().join(","));
    for frame in 0..scene.len() {
        let _ = write!(text, "{frame}");
        for point in scene.joints_m(frame).iter().copied().chain(scene.markers_m(frame)) {
            match point {
                // Writing to a string cannot fail.
                Some(point) => write!(text, ",{:.5},{:.5},{:.5}", point.x, point.y, point.z).unwrap_or(()),
                None => text.push_str(",,,"),
            }
        }
        text.push('\n');
    }
    text
}

/// Reads a truth.csv.
///
/// # Errors
/// Names the file, the line, and the column or number that is wrong.
pub fn read_truth(path: &Path) -> Result<Vec<TrueFrame>> {
    let text = read_lines(path).with_context(|| format!("truth `{}` cannot be read", path.display()))?;
    parse_truth(&text).with_context(|| format!("truth `{}` cannot be used", path.display()))
}

fn parse_truth(text: &str) -> Result<Vec<TrueFrame>> {
    let mut lines = text.lines().enumerate();
    let header = format!("frame,{}", columns().join(","));
    let (_, found) = lines.next().context("the file is empty")?;
    ensure!(found.trim_end() == header, "line 1: the columns have to be `{header}`");
    lines.filter(|(_, line)| !line.trim().is_empty()).map(|(index, line)| true_frame(line, index + 1)).collect()
}

fn true_frame(line: &str, number: usize) -> Result<TrueFrame> {
    let cells: Vec<&str> = line.trim_end().split(',').collect();
    let wanted = 1 + 3 * (BODY_BONES + MARKERS);
    ensure!(cells.len() == wanted, "line {number}: {wanted} columns are needed, found {}", cells.len());
    let mut points = Vec::with_capacity(BODY_BONES + MARKERS);
    for cells in cells[1..].chunks(3) {
        if cells.iter().all(|cell| cell.is_empty()) {
            points.push(None);
            continue;
        }
        let mut point = Vec3::zeros();
        for (slot, cell) in point.iter_mut().zip(cells) {
            match cell.trim().parse::<f32>() {
                Ok(value) if value.is_finite() => *slot = value,
                _ => bail!("line {number}: `{cell}` is no finite number"),
            }
        }
        points.push(Some(point));
    }
    let frame = cells[0].trim().parse().with_context(|| format!("line {number}: `{}` is no frame number", cells[0]))?;
    let markers_m = points.split_off(BODY_BONES);
    Ok(TrueFrame { frame, joints_m: std::array::from_fn(|bone| points[bone]), markers_m })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stereo::{StereoOptions, stick_wave};

    #[test]
    fn truth_comes_back_and_missing_joints_stay_missing() {
        let mut recording = stick_wave(1, 15.0, 1.0, 3.0).unwrap().recording;
        recording.joints_m.truncate(3);
        recording.joints_m[1][5] = None;
        let scene = StereoScene::new(recording, StereoOptions::default()).unwrap();
        let read = parse_truth(&truth_csv(&scene)).unwrap();
        assert_eq!((read.len(), read[2].frame), (3, 2));
        assert!(read[1].joints_m[5].is_none() && read[1].markers_m.iter().any(Option::is_none));
        for (truth, joints) in read.iter().zip(&scene.recording().joints_m) {
            for (found, wanted) in truth.joints_m.iter().zip(joints) {
                assert!(
                    found.is_some() == wanted.is_some() && found.is_none_or(|p| (p - wanted.unwrap()).norm() < 2.0e-5)
                );
            }
        }
        assert_eq!(read[0].markers_m.len(), MARKERS);
    }

    #[test]
    fn a_broken_table_names_its_line() {
        let header = format!("frame,{}", columns().join(","));
        let cells = ",0.1".repeat(columns().len());
        for (text, part) in [
            ("frame,x\n".to_owned(), "line 1"),
            (format!("{header}\n0,1\n"), "line 2: 142 columns"),
            (format!("{header}\nx{cells}\n"), "line 2: `x`"),
            (format!("{header}\n0{}\n", cells.replacen("0.1", "NaN", 1)), "line 2: `NaN`"),
        ] {
            let message = format!("{:#}", parse_truth(&text).unwrap_err());
            assert!(message.contains(part), "{message}");
        }
    }
}
