//! Writes a scene as a folder: frames, camera and truth.

use super::{Scene, truth};
use crate::config::Config;
use crate::error::Result;
use crate::motion::ArmSide;
use crate::output::OutputDir;
use rayon::prelude::*;

impl Scene {
    /// The configuration that describes this camera and this body, as `track arm --config` reads
    /// it.
    #[must_use]
    pub fn config_toml(&self) -> String {
        let (camera, body, options) = (self.camera(), self.body(), self.options());
        let point = |side| {
            let p = body.shoulder_m(side);
            format!("[{:?}, {:?}, {:?}]", p.x, p.y, p.z)
        };
        format!(
            "[camera]\nwidth_px = {}\nheight_px = {}\nfocal_u_px = {focal:?}\nfocal_v_px = {focal:?}\n\
             centre_u_px = {:?}\ncentre_v_px = {:?}\n[body]\nupper_arm_m = {:?}\nforearm_m = {:?}\n\
             left_shoulder_m = {}\nright_shoulder_m = {}\n",
            options.width_px,
            options.height_px,
            camera.centre().u_px,
            camera.centre().v_px,
            body.upper_arm_m(),
            body.forearm_m(),
            point(ArmSide::Left),
            point(ArmSide::Right),
            focal = camera.focal_px(),
        )
    }

    /// The same as it is read.
    ///
    /// # Errors
    /// None in practice: the scene was checked.
    pub fn config(&self) -> Result<Config> {
        Config::parse(&self.config_toml())
    }

    /// All frames, one after the other: lines from the top of RGB pixels.
    #[must_use]
    pub fn pixels(&self) -> Vec<u8> {
        let frame_bytes = 3 * self.options().width_px as usize * self.options().height_px as usize;
        let mut pixels = vec![0; frame_bytes * self.len()];
        let frames = pixels.par_chunks_mut(frame_bytes).enumerate();
        frames.for_each(|(frame, pixels)| pixels.copy_from_slice(self.render(frame).as_raw()));
        pixels
    }

    /// The truth of all frames as CSV, one line per frame and moving arm.
    #[must_use]
    pub fn truth_csv(&self) -> String {
        let mut text = format!("{}\n", truth::HEADER);
        for frame in 0..self.len() {
            text.push_str(&self.truth(frame).csv_lines(&self.camera()));
        }
        text
    }

    /// Writes `frames/frame_0000.png` and on, `truth.csv` and `camera.toml` into `output`.
    ///
    /// # Errors
    /// A file that cannot be written, by name.
    pub fn write_folder(&self, output: &OutputDir) -> Result<()> {
        let frames = output.begin_series("frames")?;
        (0..self.len()).into_par_iter().try_for_each(|frame| {
            frames.folder().write_frame_png(format!("frame_{frame:04}.png"), &self.render(frame))
        })?;
        frames.finish()?;
        output.write("truth.csv", |writer| Ok(writer.write_all(self.truth_csv().as_bytes())?))?;
        output.write("camera.toml", |writer| Ok(writer.write_all(self.config_toml().as_bytes())?))
    }
}
