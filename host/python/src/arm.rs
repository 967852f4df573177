//! Tracking arms frame by frame.

use crate::arm_estimate::{estimate, particles};
use crate::arm_options::{ArmSetup, json, saved_setup};
use crate::errors::{exception, wrong};
use crate::pictures::{Image, picture};
use crate::process::detached;
use numpy::PyReadonlyArray2;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use sinew::person::{GivenHand, GivenHands, given_head, refuse_shares};
use sinew::track::{ArmStream, FrontEnd, StreamFrame};
use sinew_core::camera::Pixel;
use sinew_core::skeleton::Side;
use sinew_core::vision::objects::head::HeadBox;
use std::path::PathBuf;
use std::process::id;

/// A tracker of one arm or both.
#[pyclass(module = "sinew._sinew")]
#[derive(Debug)]
pub struct ArmTracker {
    setup: ArmSetup,
    /// Once the size of the images is known.
    stream: Option<ArmStream>,
    next: usize,
    last_us: Option<u64>,
    /// Whether frames come with their times.
    is_timed: bool,
    /// Whether a hand and a face were given whose places can only be in pixels.
    has_pixels: [bool; 2],
    /// The process that answered the last frame.
    process: u32,
}

#[pymethods]
impl ArmTracker {
    #[new]
    #[expect(clippy::too_many_arguments, reason = "the options of `sinew track arm`")]
    fn new(
        py: Python<'_>,
        side: &str,
        variant: Option<&str>,
        particles: Option<usize>,
        seed: u64,
        rate_hz: f64,
        skin: &str,
        calibrate: Option<[u32; 4]>,
        front_end: &str,
        face: &str,
        config_file: Option<PathBuf>,
        config_json: Option<&str>,
        size_px: Option<(u32, u32)>,
    ) -> PyResult<Self> {
        let config = ArmSetup::config(config_file.as_deref(), config_json, variant, particles)?;
        let rectangle = crate::pictures::rectangle(calibrate)?;
        let setup = ArmSetup::new([side, front_end, face], rate_hz, seed, rectangle, config)?;
        let setup = setup.with_skin(py, skin)?;
        let mut tracker = Self {
            setup,
            stream: None,
            next: 0,
            last_us: None,
            is_timed: false,
            has_pixels: [false; 2],
            process: id(),
        };
        if let Some(size_px) = size_px {
            tracker.stream = Some(tracker.setup.stream(size_px)?);
        }
        Ok(tracker)
    }

    /// One dictionary an arm, left first. `hands` are rows of u, v, size, probability and side (0
    /// left, 1 right, NaN unknown); `head` is u, v, size.
    fn update<'py>(
        &mut self,
        py: Python<'py>,
        image: Option<Image<'py>>,
        hands: Option<PyReadonlyArray2<'py, f64>>,
        has_sides: bool,
        head: Option<[f64; 3]>,
        time_s: Option<f64>,
    ) -> PyResult<Vec<Bound<'py, PyDict>>> {
        self.check_process()?;
        let timestamp_us = self.timestamp_us(time_s)?;
        let view = image.as_ref().map(picture).transpose()?;
        let rows = hands.as_ref().map(|rows| rows.as_array());
        let places: Vec<_> = rows.iter().flat_map(|rows| rows.outer_iter()).map(|row| [row[0], row[1]]).collect();
        let face = head.map(|[u_px, v_px, _]| [u_px, v_px]);
        let hands = hands.map(|rows| given_hands(&rows, has_sides)).transpose()?;
        let head = head.map(|head| self.given_head(head, view.is_some())).transpose()?;
        self.refuse_shares(0, "`hands`", &places)?;
        self.refuse_shares(1, "`head`", face.as_slice())?;
        if hands.is_some() && self.setup.options.front_end == FrontEnd::Lines {
            return Err(wrong("hands", "take the place of what is seen, and front_end=\"lines\" is a way to see"));
        }
        let size_px = view.as_ref().map(|view| view.dimensions());
        if let (Some(stream), Some(size_px)) = (&self.stream, size_px)
            && size_px != stream.size_px()
        {
            let ((width, height), (wanted_width, wanted_height)) = (size_px, stream.size_px());
            let rule = format!("has {width}x{height} pixels, and this tracker's have {wanted_width}x{wanted_height}");
            return Err(wrong("image", &rule));
        }
        let stream = match (&mut self.stream, size_px) {
            (Some(stream), _) => stream,
            (none, Some(size_px)) => none.insert(self.setup.stream(size_px)?),
            (None, None) => return Err(wrong("size_px", "has to be given where the first frame has no image")),
        };
        let frame = StreamFrame { number: self.next, timestamp_us, image: view.as_ref(), hands, head };
        let answer =
            detached(py, || stream.step(frame))?.map_err(|error| exception(&crate::pictures::calibration(error)))?;
        self.is_timed = time_s.is_some();
        self.last_us = Some(timestamp_us);
        self.process = id();
        let number = self.next;
        self.next += 1;
        let time_s = time_s.unwrap_or(number as f64 / self.setup.options.rate_hz);
        answer
            .arms
            .iter()
            .map(|arm| estimate(py, (number, time_s), arm, answer.view.as_ref(), stream.camera()))
            .collect()
    }

    /// Side, and arrays of weights, angles, elbows, hands and drivers (-1 without) of each arm;
    /// none before the first frame.
    fn particles<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let stream = self.stream.as_ref().filter(|_| self.next > 0);
        let arms = stream.into_iter().flat_map(|stream| stream.arms().models().iter().zip(stream.arms().particles()));
        arms.map(|(model, arm)| particles(py, model.side(), &arm)).collect()
    }

    #[getter]
    fn state_crc32(&mut self, py: Python<'_>) -> PyResult<Option<u32>> {
        self.check_process()?;
        let stream = &mut self.stream;
        let crc = detached(py, || stream.as_mut().map(ArmStream::state_crc32).transpose())?;
        crc.map_err(|error| exception(&error))
    }

    #[getter]
    fn frame(&self) -> Option<usize> {
        self.next.checked_sub(1)
    }

    #[getter]
    fn side(&self) -> &'static str {
        self.setup.options.side.name()
    }

    #[getter]
    fn rate_hz(&self) -> f64 {
        self.setup.options.rate_hz
    }

    #[getter]
    fn size_px(&self) -> Option<(u32, u32)> {
        self.stream.as_ref().map(ArmStream::size_px)
    }

    /// The configuration with all that is set, as JSON.
    #[getter]
    fn config_json(&self) -> PyResult<String> {
        serde_json::to_string(&self.setup.options.config).map_err(|error| exception(&error.into()))
    }

    /// Everything as text, which `restored` takes.
    fn saved(&mut self, py: Python<'_>) -> PyResult<String> {
        self.check_process()?;
        let Self { setup, stream, next, last_us, is_timed, has_pixels, .. } = self;
        let state =
            detached(py, || stream.as_mut().map(ArmStream::saved).transpose())?.map_err(|error| exception(&error))?;
        let size_px = stream.as_ref().map(ArmStream::size_px);
        let frames = (*next, *last_us, *is_timed, *has_pixels);
        saved_setup(setup, size_px, state.as_deref(), frames).map_err(|error| exception(&error))
    }

    #[staticmethod]
    fn restored(py: Python<'_>, saved: &str) -> PyResult<Self> {
        let json = json(saved)?;
        let setup = ArmSetup::restored(&json)?;
        let size_px = json["size_px"].as_array().and_then(|sides| {
            let side = |index: usize| sides.get(index)?.as_u64().and_then(|side| u32::try_from(side).ok());
            Some((side(0)?, side(1)?))
        });
        let state = json["state"].as_str();
        let options = setup.options.clone();
        let restored = || size_px.zip(state).map(|(size_px, state)| ArmStream::restored(options, size_px, state));
        let stream = detached(py, restored)?.transpose().map_err(|error| exception(&error))?;
        let next = json["next"].as_u64().and_then(|next| usize::try_from(next).ok()).unwrap_or_default();
        let is_timed = json["is_timed"].as_bool().unwrap_or_default();
        let has_pixels = [0, 1].map(|of| json["has_pixels"][of].as_bool().unwrap_or_default());
        Ok(Self { setup, stream, next, last_us: json["last_us"].as_u64(), is_timed, has_pixels, process: id() })
    }
}

impl ArmTracker {
    /// A look for the face may be under way on a thread of the process that answered the last
    /// frame.
    fn check_process(&self) -> PyResult<()> {
        if self.next == 0 || self.process == id() {
            return Ok(());
        }
        Err(PyValueError::new_err(
            "the tracker is in use in the process that this one was forked from: pickle it there and unpickle it \
             here, or make a new one",
        ))
    }

    /// When the next frame is, microseconds.
    fn timestamp_us(&self, time_s: Option<f64>) -> PyResult<u64> {
        if self.next > 0 && time_s.is_some() != self.is_timed {
            return Err(wrong("time_s", "has to be given for all frames, or for none"));
        }
        let Some(time_s) = time_s else {
            return Ok((self.next as f64 * 1.0e6 / self.setup.options.rate_hz).round() as u64);
        };
        // A century, for times from 1970.
        if !(0.0..4.0e9).contains(&time_s) {
            return Err(wrong("time_s", &format!("has to lie from 0 to 4e9 seconds, not {time_s}")));
        }
        let timestamp_us = (time_s * 1.0e6).round() as u64;
        match self.last_us {
            Some(last_us) if timestamp_us <= last_us => {
                let last_s = last_us as f64 * 1.0e-6;
                Err(wrong("time_s", &format!("has to rise from frame to frame: {time_s} comes after {last_s}")))
            }
            _ => Ok(timestamp_us),
        }
    }

    /// Refuses hands or faces whose places are shares of the picture. Once one can only be in
    /// pixels, the others are, too.
    fn refuse_shares(&mut self, of: usize, what: &str, places: &[[f64; 2]]) -> PyResult<()> {
        if !self.has_pixels[of] && !places.is_empty() {
            let places = places.iter().map(|place| place.map(|coordinate| coordinate as f32));
            refuse_shares(places, what).map_err(|error| exception(&crate::pictures::calibration(error)))?;
            self.has_pixels[of] = true;
        }
        Ok(())
    }

    fn given_head(&self, [u_px, v_px, size_px]: [f64; 3], has_image: bool) -> PyResult<HeadBox> {
        if !has_image {
            return Err(wrong("head", "needs `image`, which shows the colour of the skin"));
        }
        if !self.setup.knows_faces() {
            return Err(wrong("head", "needs face=True or face=\"given\", and no `calibrate`"));
        }
        let head = given_head(Pixel::new(u_px as f32, v_px as f32), size_px as f32, &|| "`head`".to_owned());
        head.map_err(|error| exception(&crate::pictures::calibration(error)))
    }
}

/// The hands of a frame.
fn given_hands(rows: &PyReadonlyArray2<'_, f64>, has_sides: bool) -> PyResult<GivenHands> {
    let rows = rows.as_array();
    let hand = |(index, row): (usize, numpy::ndarray::ArrayView1<'_, f64>)| {
        let side = match row[4] {
            0.0 => Some(Side::Left),
            1.0 => Some(Side::Right),
            _ => None,
        };
        let [u_px, v_px, size_px, probability] = [0, 1, 2, 3].map(|column| row[column] as f32);
        let hand = GivenHand { centre: Pixel::new(u_px, v_px), size_px, probability, side };
        Ok((side, hand.candidate(&|| format!("`hands`, row {index}"))?))
    };
    let hands: Result<Vec<_>, sinew::Error> = rows.rows().into_iter().enumerate().map(hand).collect();
    let hands = hands.map_err(|error| exception(&crate::pictures::calibration(error)))?;
    Ok(GivenHands::of_frame(&hands, has_sides))
}
