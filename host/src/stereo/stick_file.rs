//! `stick.csv`: both ends of the stick in each frame, in space and in the picture.

use super::camera::StereoCamera;
use super::stick_wave::StickEnds;
use crate::error::{Context, Result, bail, ensure};
use crate::file::read_lines;
use sinew_core::camera::Pixel;
use sinew_core::math::Vec3;
use std::fmt::Write;
use std::path::Path;

/// Columns of the file.
pub const STICK_HEADER: &str = "frame,a_x_m,a_y_m,a_z_m,b_x_m,b_y_m,b_z_m,a_u_px,a_v_px,b_u_px,b_v_px";

/// The stick in one frame: what is not in the file is `None`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SeenStick {
    /// Number of the frame.
    pub frame: u64,
    /// Both ends, metres.
    pub ends_m: Option<[Vec3; 2]>,
    /// Images of both ends.
    pub ends_px: Option<[Pixel; 2]>,
}

/// The stick of each frame as CSV; `a` is the end on the side of the person's left hand.
#[must_use]
pub fn stick_csv(camera: &StereoCamera, stick_m: &[StickEnds]) -> String {
    let mut text = format!("{STICK_HEADER}\n");
    for (frame, ends) in stick_m.iter().enumerate() {
        let _ = write!(text, "{frame}");
        for end in ends {
            let _ = write!(text, ",{:.5},{:.5},{:.5}", end.x, end.y, end.z);
        }
        for end in ends {
            match camera.project(end) {
                // Writing to a string cannot fail.
                Some(pixel) => write!(text, ",{:.3},{:.3}", pixel.u_px, pixel.v_px).unwrap_or(()),
                None => text.push_str(",,"),
            }
        }
        text.push('\n');
    }
    text
}

/// Reads a stick.csv; cells may be empty where the stick, or one of both kinds of ends, was not
/// seen.
///
/// # Errors
/// Names the file, the line, and the columns or number that are wrong.
pub fn read_stick(path: &Path) -> Result<Vec<SeenStick>> {
    let text = read_lines(path).with_context(|| format!("stick `{}` cannot be read", path.display()))?;
    parse_stick(&text).with_context(|| format!("stick `{}` cannot be used", path.display()))
}

fn parse_stick(text: &str) -> Result<Vec<SeenStick>> {
    let mut lines = text.lines().enumerate();
    let (_, header) = lines.next().context("the file is empty")?;
    ensure!(header.trim_end() == STICK_HEADER, "line 1: the columns have to be `{STICK_HEADER}`");
    lines.filter(|(_, line)| !line.trim().is_empty()).map(|(index, line)| seen_stick(line, index + 1)).collect()
}

fn seen_stick(line: &str, number: usize) -> Result<SeenStick> {
    let cells: Vec<&str> = line.trim_end().split(',').collect();
    ensure!(cells.len() == 11, "line {number}: 11 columns are needed, found {}", cells.len());
    let mut values = [None; 10];
    for (slot, cell) in values.iter_mut().zip(&cells[1..]) {
        if cell.is_empty() {
            continue;
        }
        match cell.trim().parse::<f32>() {
            Ok(value) if value.is_finite() => *slot = Some(value),
            _ => bail!("line {number}: `{cell}` is no finite number"),
        }
    }
    let point = |at: usize| Some(Vec3::new(values[at]?, values[at + 1]?, values[at + 2]?));
    let pixel = |at: usize| Some(Pixel::new(values[at]?, values[at + 1]?));
    Ok(SeenStick {
        frame: cells[0].trim().parse().with_context(|| format!("line {number}: `{}` is no frame number", cells[0]))?,
        ends_m: point(0).zip(point(3)).map(|(a, b)| [a, b]),
        ends_px: pixel(6).zip(pixel(8)).map(|(a, b)| [a, b]),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_come_back_and_empty_cells_are_not_seen() {
        let camera = StereoCamera::default();
        let stick =
            [[Vec3::new(0.5, 0.1, 2.0), Vec3::new(-0.5, 0.2, 2.5)], [Vec3::new(0.4, 0.1, 2.0), Vec3::z() * -1.0]];
        let read = parse_stick(&stick_csv(&camera, &stick)).unwrap();
        assert_eq!((read.len(), read[1].frame), (2, 1));
        let [a, _] = read[0].ends_m.unwrap();
        assert!((a - stick[0][0]).norm() < 1.0e-5);
        let [pixel, _] = read[0].ends_px.unwrap();
        assert!(pixel.distance_px(camera.project(&stick[0][0]).unwrap()) < 1.0e-2);
        assert!(read[1].ends_px.is_none() && read[1].ends_m.is_some(), "an end behind the camera has no image");
        for (text, part) in [("x\n", "line 1"), ("", "empty")] {
            assert!(parse_stick(text).unwrap_err().to_string().contains(part));
        }
        let broken = format!("{STICK_HEADER}\n0,1,2,x,,,,,,,\n");
        assert!(parse_stick(&broken).unwrap_err().to_string().contains("line 2: `x`"));
    }
}
