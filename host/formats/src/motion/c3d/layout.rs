//! How much a C3D file promises and how much it holds, checked before memory is taken for it.

use super::parameters::Parameters;
use super::words::Words;

/// A C3D file is made of blocks of this size; the header is the first.
pub const BLOCK_BYTES: usize = 512;
/// More frames than this are no count of frames.
const MAX_FRAMES: f64 = 4.0e9;
/// The most that a count of 16 bits can say.
const MAX_SHORT_FRAMES: usize = 65_535;
/// First and last frame of a trial.
const TRIAL_FIELDS: [&str; 2] = ["ACTUAL_START_FIELD", "ACTUAL_END_FIELD"];
/// Where the header gives the first and the last frame.
const FIRST_FRAME_AT: usize = 6;
const LAST_FRAME_AT: usize = 8;

/// Frames of a file, and how they lie in it.
#[derive(Debug, Clone, PartialEq)]
pub struct Layout {
    /// Whole frames for which there are bytes.
    pub held: usize,
    /// Frames by header and parameters; `None` where they do not say.
    pub promised: Option<usize>,
    /// Frames that are read, at most `held`.
    pub frames: usize,
    /// Points of a frame.
    pub points: usize,
    /// The byte at which frames begin.
    pub data_at: usize,
    /// Bytes of a frame.
    pub frame_bytes: usize,
    /// Bytes of a number.
    pub number_bytes: usize,
    /// The header's scale: greater than zero for numbers of 16 bits.
    pub scale: f32,
    /// Byte order.
    pub words: Words,
    /// The header's frames per second.
    pub rate_hz: f32,
}

impl Layout {
    /// Checks the counts of the file's header and parameters.
    ///
    /// # Errors
    /// A section lies outside of the file, a frame has no points, or counts contradict each other.
    pub fn check(bytes: &[u8]) -> Result<(Self, Parameters), String> {
        let parameters_at = start(usize::from(bytes[0]), bytes).ok_or("its parameters lie outside of the file")?;
        let words = Words::of(bytes[parameters_at + 3]).ok_or("its parameters name no known processor")?;
        let word = |at: usize| words.u16(bytes, at).map_or(0, usize::from);
        let data_at = start(word(16), bytes).filter(|&at| at > parameters_at);
        let data_at = data_at.ok_or("its frames lie outside of the file")?;
        let parameters = Parameters::read(&bytes[parameters_at..data_at], words)?;
        let (points, samples) = (word(2), word(4));
        if points == 0 {
            return Err("the file has no frame with labelled points".to_owned());
        }
        check_analog(&parameters, samples, word(18))?;
        let scale = words.f32(bytes, 12).unwrap_or(0.0);
        let number_bytes = if scale > 0.0 { 2 } else { 4 };
        let frame_bytes = number_bytes * (4 * points + samples);
        let held = (bytes.len() - data_at) / frame_bytes;
        let of_header = (word(LAST_FRAME_AT) + 1).checked_sub(word(FIRST_FRAME_AT)).filter(|&frames| frames > 0);
        let counts = Counts::read(&parameters, of_header)?;
        counts.check_saturated(held, BLOCK_BYTES / frame_bytes)?;
        let layout = Self {
            held,
            promised: counts.promised(),
            frames: counts.to_read().min(held),
            points,
            data_at,
            frame_bytes,
            number_bytes,
            scale,
            words,
            rate_hz: words.f32(bytes, 20).unwrap_or(0.0),
        };
        Ok((layout, parameters))
    }
}

/// The first byte of a block, counted from 1, if it is in the file and not the header.
fn start(block: usize, bytes: &[u8]) -> Option<usize> {
    let at = block.checked_sub(1)? * BLOCK_BYTES;
    (at >= BLOCK_BYTES && at + BLOCK_BYTES <= bytes.len()).then_some(at)
}

/// Refuses analog channels that are not those of the header.
fn check_analog(parameters: &Parameters, samples: usize, per_channel: usize) -> Result<(), String> {
    // Readers give the groups that are missing numbers of their own choice.
    let channels = ["ANALOG", ""].into_iter().flat_map(|group| parameters.all(group, "USED"));
    for channels in channels.filter_map(|used| used.first()) {
        if *channels > 0.0 && *channels * per_channel as f64 != samples as f64 {
            return Err(format!(
                "{channels} analog channels of {per_channel} samples are not the {samples} of its header"
            ));
        }
    }
    Ok(())
}

/// How many frames there are by each place that says so; none of zero.
struct Counts {
    of_header: Option<usize>,
    frames: Option<usize>,
    long_frames: Option<usize>,
    of_trial: Option<usize>,
}

impl Counts {
    fn read(parameters: &Parameters, of_header: Option<usize>) -> Result<Self, String> {
        let count = |name: &str| match parameters.number("POINT", name) {
            Some(frames) if !(frames <= MAX_FRAMES) => Err(format!("its POINT:{name} is {frames}, which is no count")),
            frames => Ok(frames.map(|frames| frames as usize).filter(|&frames| frames > 0)),
        };
        let field = |name: &str| match parameters.all("TRIAL", name).next()? {
            [low, high] => Some((low + 65_536.0 * high) as usize),
            _ => None,
        };
        let of_trial = match TRIAL_FIELDS.map(field) {
            [Some(first), Some(last)] if first > last => {
                return Err(format!("its frames run from {first} to {last}"));
            }
            [Some(first), Some(last)] => Some(last - first + 1),
            _ => None,
        };
        Ok(Self { of_header, frames: count("FRAMES")?, long_frames: count("LONG_FRAMES")?, of_trial })
    }

    /// By the parameter that can count farthest: those of the trial or `LONG_FRAMES`, then the
    /// fewer of `FRAMES` and the header.
    fn promised(&self) -> Option<usize> {
        self.of_trial.max(self.long_frames).or([self.frames, self.of_header].into_iter().flatten().min())
    }

    fn to_read(&self) -> usize {
        self.of_trial.or(self.frames).or(self.of_header).max(self.long_frames).unwrap_or(0)
    }

    /// Refuses a file with more frames than its counts can say. Its last block may have room for
    /// `padding` more.
    fn check_saturated(&self, held: usize, padding: usize) -> Result<(), String> {
        let (counted, is_long) = (self.to_read(), self.of_trial.or(self.long_frames).is_some());
        if is_long || held <= counted.max(MAX_SHORT_FRAMES) + padding {
            return Ok(());
        }
        Err(format!(
            "it counts {counted} frames in 16 bits and has room for {held}; export it with TRIAL:ACTUAL_END_FIELD or \
             POINT:LONG_FRAMES, or in parts"
        ))
    }
}
