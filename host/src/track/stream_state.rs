//! The state of a stream between two frames, as text.

use super::last_picture::LastPicture;
use super::options::StreamOptions;
use super::stream::ArmStream;
use crate::error::{Context, Result};
use crate::resume::text_crc32;
use crate::skin::{SkinModel, model_file};
use image::RgbImage;
use serde::{Deserialize, Serialize};

/// Everything that a stream remembers.
#[derive(Debug, Serialize, Deserialize)]
struct StreamState {
    trackers: String,
    /// The skin model: in the light of the first image, once there was one.
    skin: String,
    /// Of a stream that had an image.
    seeing: Option<SeeingState>,
}

#[derive(Debug, Serialize, Deserialize)]
struct SeeingState {
    vision: Option<String>,
    last: Option<LastPicture>,
}

impl ArmStream {
    /// The state after the last frame as text, which [`ArmStream::restored`] takes. Waits for a
    /// look at a face.
    ///
    /// # Errors
    /// None that a user can bring about.
    pub fn saved(&mut self) -> Result<String> {
        let trackers = self.arms.saved()?;
        let (skin, seeing) = match &mut self.seeing {
            Some(seeing) => {
                let state = SeeingState { vision: seeing.vision.saved()?, last: seeing.vision.last() };
                (&seeing.skin, Some(state))
            }
            None => (self.skin(), None),
        };
        let skin = model_file::to_json(skin)?;
        Ok(serde_json::to_string(&StreamState { trackers, skin, seeing })?)
    }

    /// A stream that goes on, bit for bit, where one with the same options and size was saved.
    ///
    /// # Errors
    /// The text is not whole, or of a stream with other options.
    pub fn restored(options: StreamOptions, size_px: (u32, u32), saved: &str) -> Result<Self> {
        let state: StreamState = serde_json::from_str(saved).context("the state of the trackers is not whole")?;
        let skin: SkinModel = model_file::parse(&state.skin).context("the skin model of the trackers")?;
        let mut stream = Self::new(options, skin.clone(), size_px)?;
        let Some(seeing) = state.seeing else {
            stream.arms.restore(&state.trackers)?;
            return Ok(stream);
        };
        stream.see_by(skin)?;
        let last = seeing.last.map(|last| last.picture()).transpose()?;
        stream.restore(&state.trackers, last, seeing.vision.as_deref())?;
        Ok(stream)
    }

    /// CRC-32 of the trackers' saved state: two runs with the same bits have the same number.
    ///
    /// # Errors
    /// None that a user can bring about.
    pub fn state_crc32(&mut self) -> Result<u32> {
        Ok(text_crc32(&self.arms.saved()?))
    }

    /// The states of the trackers and, if it remembers anything, of what reads the images.
    pub(super) fn saved_parts(&mut self) -> Result<(String, Option<String>)> {
        let vision = self.seeing.as_mut().map(|seeing| seeing.vision.saved()).transpose()?;
        Ok((self.arms.saved()?, vision.flatten()))
    }

    /// Goes on from these after a frame that was [seen](ArmStream::seen) as `last`.
    pub(super) fn restore(&mut self, trackers: &str, last: Option<RgbImage>, vision: Option<&str>) -> Result<()> {
        self.arms.restore(trackers)?;
        if let Some(seeing) = &mut self.seeing {
            seeing.vision.restore(last, vision)?;
            let shoulders_m = seeing.vision.shoulders_m();
            shoulders_m.iter().for_each(|shoulders_m| self.arms.place_shoulders(shoulders_m));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::super::arms::SideChoice;
    use super::super::options::{FaceSource, FrontEnd};
    use super::super::stream::{StreamAnswer, StreamFrame};
    use super::*;
    use crate::config::Config;
    use crate::motion::reach::random_reaches;
    use crate::person::FaceTable;
    use crate::pixels::PictureView;
    use crate::scene::{Scene, SceneOptions, Sides};
    use crate::skin::Rectangle;
    use sinew_core::vision::objects::head::HeadBox;

    const FRAMES: usize = 16;
    const SIZE_PX: (u32, u32) = (320, 240);

    fn scene() -> Scene {
        let (width_px, height_px) = SIZE_PX;
        let options =
            SceneOptions { width_px, height_px, frames: FRAMES, sides: Sides::Both, ..SceneOptions::default() };
        Scene::new(&random_reaches(2, 15.0, FRAMES).unwrap(), &options).unwrap()
    }

    /// Steps through frame `number`; the fifth one is missing, the seventh shows where the face is.
    fn step(stream: &mut ArmStream, scene: &Scene, number: usize) -> StreamAnswer {
        let image = scene.render(number);
        let view = PictureView::from_raw(image.width(), image.height(), image.as_raw().as_slice()).unwrap();
        let head = HeadBox { centre_px: [160.0, 70.0], width_px: 40.0 };
        let frame = StreamFrame {
            number,
            timestamp_us: 66_667 * number as u64,
            image: (number != 5).then_some(&view),
            hands: None,
            head: (number == 7).then_some(head),
        };
        stream.step(frame).unwrap()
    }

    #[test]
    fn a_stream_that_was_saved_goes_on_bit_for_bit() {
        let scene = scene();
        let config = Config::parse(&scene.config_toml()).unwrap();
        let rectangle = Rectangle { x_px: 100, y_px: 60, width_px: 30, height_px: 30 };
        let given = FaceSource::Given(FaceTable::default());
        let all = [
            (FrontEnd::Pictures, FaceSource::Found, None, "gaussian"),
            (FrontEnd::Pictures, given.clone(), None, "gaussian"),
            (FrontEnd::Pictures, FaceSource::Unknown, Some(rectangle), "histogram"),
            (FrontEnd::Lines, given, Some(rectangle), "gaussian"),
        ];
        for (front_end, face, calibrate, skin) in all {
            let side = SideChoice::Both;
            let options =
                StreamOptions { side, front_end, face, calibrate, config: config.clone(), ..StreamOptions::default() };
            let skin = SkinModel::from_option(skin).unwrap();
            let mut stream = ArmStream::new(options.clone(), skin, SIZE_PX).unwrap();
            for number in 0..FRAMES {
                let saved = stream.saved().unwrap();
                let mut again = ArmStream::restored(options.clone(), SIZE_PX, &saved).unwrap();
                assert_eq!(again.saved().unwrap(), saved, "{front_end:?}, before frame {number}");
                let answers = [&mut stream, &mut again].map(|stream| step(stream, &scene, number));
                let estimates = answers.map(|answer| answer.arms.iter().map(|arm| arm.estimate).collect::<Vec<_>>());
                assert_eq!(estimates[0], estimates[1], "{front_end:?}, frame {number}");
                assert_eq!(again.state_crc32().unwrap(), stream.state_crc32().unwrap());
                stream = again;
            }
        }
    }

    #[test]
    fn another_size_and_a_broken_state_are_refused() {
        let skin = SkinModel::from_option("gaussian").unwrap();
        let mut stream = ArmStream::new(StreamOptions::default(), skin, SIZE_PX).unwrap();
        let image = RgbImage::new(320, 200);
        let frame = StreamFrame { number: 0, timestamp_us: 0, image: Some(&image), hands: None, head: None };
        let message = stream.step(frame).unwrap_err().to_string();
        assert!(message.contains("320x200") && message.contains("320x240"), "{message}");
        let saved = stream.saved().unwrap();
        for broken in [&saved[..saved.len() / 2], "", "{}"] {
            assert!(ArmStream::restored(StreamOptions::default(), SIZE_PX, broken).is_err());
        }
        let both = StreamOptions { side: SideChoice::Both, ..StreamOptions::default() };
        assert!(ArmStream::restored(both, SIZE_PX, &saved).is_err(), "the state is of one arm");
    }
}
