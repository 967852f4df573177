//! How much a C3D file promises and how much it holds, checked before a reader takes memory for it.

use super::parameters::Parameters;
use super::words::Words;

/// A C3D file is made of blocks of this size; the header is the first.
pub const BLOCK_BYTES: usize = 512;
/// More frames than this are no count of frames.
const MAX_FRAMES: f64 = 4.0e9;
/// Where the header gives the first and the last frame.
const FIRST_FRAME_AT: usize = 6;
const LAST_FRAME_AT: usize = 8;

/// Frames of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Layout {
    /// Whole frames for which there are bytes.
    pub held: usize,
    /// Frames by header and parameters; `None` where they do not say.
    pub promised: Option<usize>,
}

impl Layout {
    /// Checks the counts of the file's header and parameters.
    ///
    /// # Errors
    /// A section lies outside of the file, a frame has no points, or counts contradict each other.
    pub fn check(bytes: &[u8]) -> Result<Self, String> {
        let parameters_at = start(usize::from(bytes[0]), bytes).ok_or("its parameters lie outside of the file")?;
        let words = Words::of(bytes[parameters_at + 3]).ok_or("its parameters name no known processor")?;
        let word = |at: usize| words.u16(bytes, at).map_or(0, usize::from);
        let data_at = start(word(16), bytes).filter(|&at| at > parameters_at);
        let data_at = data_at.ok_or("its frames lie outside of the file")?;
        let parameters = Parameters::read(&bytes[BLOCK_BYTES..data_at], words)?;
        let (points, samples) = (word(2), word(4));
        if points == 0 {
            return Err("the file has no frame with labelled points".to_owned());
        }
        check_analog(&parameters, samples, word(18))?;
        // A scale greater than zero stands for numbers of 16 bits.
        let number_bytes = if words.f32(bytes, 12).is_some_and(|scale| scale > 0.0) { 2 } else { 4 };
        let frame_bytes = number_bytes * (4 * points + samples);
        let of_header = (word(LAST_FRAME_AT) + 1).checked_sub(word(FIRST_FRAME_AT)).filter(|&frames| frames > 0);
        Ok(Self { held: (bytes.len() - data_at) / frame_bytes, promised: promised(&parameters, of_header)? })
    }
}

/// The same file with one frame in its header's range. Readers take memory for the whole range, and
/// then go by the parameters.
pub fn with_short_range(mut bytes: Vec<u8>) -> Vec<u8> {
    let first = [bytes[FIRST_FRAME_AT], bytes[FIRST_FRAME_AT + 1]];
    bytes[LAST_FRAME_AT..LAST_FRAME_AT + 2].copy_from_slice(&first);
    bytes
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

/// Frames by the parameter that can count farthest: those of the trial or `LONG_FRAMES`, then the
/// fewer of `FRAMES` and the header.
fn promised(parameters: &Parameters, of_header: Option<usize>) -> Result<Option<usize>, String> {
    let count = |name: &str| match parameters.number("POINT", name) {
        Some(frames) if !(frames <= MAX_FRAMES) => Err(format!("its POINT:{name} is {frames}, which is no count")),
        frames => Ok(frames.map(|frames| frames as usize).filter(|&frames| frames > 0)),
    };
    let (frames, long_frames) = (count("FRAMES")?, count("LONG_FRAMES")?);
    let field = |name: &str| match parameters.all("TRIAL", name).next()? {
        [low, high] => Some((low + 65_536.0 * high) as usize),
        _ => None,
    };
    let of_trial = match (field("ACTUAL_START_FIELD"), field("ACTUAL_END_FIELD")) {
        (Some(first), Some(last)) if first > last => return Err(format!("its frames run from {first} to {last}")),
        (Some(first), Some(last)) => Some(last - first + 1),
        _ => None,
    };
    let short = [frames, of_header].into_iter().flatten().min();
    Ok(of_trial.max(long_frames).or(short))
}
