//! Frames of a video file, through a pipe from the installed `ffmpeg`: no frame is written to disk.

use crate::limits::MAX_SIDE_PX;
use crate::registry::{Kind, find};
use image::RgbImage;
use serde_json::Value;
use std::ffi::OsString;
use std::fs::File;
use std::io::{BufRead, BufReader, ErrorKind, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdout, Command, ExitStatus, Stdio};
use thiserror::Error;

/// A video that cannot be read.
#[derive(Debug, Error)]
pub enum VideoError {
    /// The program that reads videos is not there.
    #[error(
        "`{}` is a video, and `{program}`, which reads videos, cannot be started ({reason}); install ffmpeg (apt install ffmpeg, \
         brew install ffmpeg, winget install ffmpeg), or give a folder of images", .file.display()
    )]
    NoProgram {
        /// The video.
        file: PathBuf,
        /// `ffmpeg` or `ffprobe`.
        program: &'static str,
        /// What the operating system said.
        reason: String,
    },
    /// No frame can be read.
    #[error("`{}` cannot be read as a video: {reason}; play it to see whether it is whole", .file.display())]
    Unreadable {
        /// The video.
        file: PathBuf,
        /// What ffmpeg said.
        reason: String,
    },
    /// The video is broken after some frames.
    #[error("`{}` is broken after {frames} frames: {reason}", .file.display())]
    Broken {
        /// The video.
        file: PathBuf,
        /// Frames that were read.
        frames: usize,
        /// What ffmpeg said.
        reason: String,
    },
    /// The operating system refuses the file, or ended ffmpeg.
    #[error("`{}` cannot be read{}: {reason}", .file.display(), after(*.frames))]
    Io {
        /// The video.
        file: PathBuf,
        /// Frames that were read.
        frames: usize,
        /// What the operating system said.
        reason: String,
        /// The same for programs.
        kind: ErrorKind,
    },
}

impl VideoError {
    /// Whether the operating system refused the file or ended ffmpeg, whatever the content.
    #[must_use]
    pub fn is_io(&self) -> bool {
        matches!(self, Self::Io { .. })
    }

    /// The video's content cannot be read for `reason`, unless the file itself cannot.
    fn of_content(file: &Path, frames: usize, reason: String) -> Self {
        let file = file.to_path_buf();
        match (read_through(&file), frames) {
            (Err(error), _) => Self::Io { file, frames, reason: error.to_string(), kind: error.kind() },
            (Ok(_), 0) => Self::Unreadable { file, reason },
            (Ok(_), _) => Self::Broken { file, frames, reason },
        }
    }
}

fn after(frames: usize) -> String {
    if frames == 0 { String::new() } else { format!(" any more after {frames} frames") }
}

/// Whether `path` is a file that is named like a video.
#[must_use]
pub fn is_video(path: &Path) -> bool {
    find(path, &[Kind::Video]).is_some() && path.is_file()
}

/// File name for the picture of a frame: `clip_000012.png`.
#[must_use]
pub fn frame_name(video: &Path, frame: usize) -> String {
    format!("{}_{frame:06}.png", video.file_stem().unwrap_or_default().to_string_lossy())
}

/// Rate and length of a video, from its header and its packets.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VideoFacts {
    /// Frames per second, the mean.
    pub rate_hz: f64,
    /// Number of frames by header and packets; fewer may be decodable.
    pub frames: usize,
    /// Width of a pixel divided by its height; 1 where the header does not say.
    pub pixel_aspect: f64,
}

impl VideoFacts {
    /// Asks `ffprobe`.
    ///
    /// # Errors
    /// There is no ffprobe, or the file holds no video that it knows.
    pub fn read(file: &Path) -> Result<Self, VideoError> {
        let mut probe = Command::new("ffprobe");
        probe.args(["-v", "error", "-select_streams", "v:0", "-count_packets", "-of", "json", "-show_entries"]);
        probe
            .arg("stream=avg_frame_rate,r_frame_rate,nb_read_packets,sample_aspect_ratio:format=duration")
            .arg(address(file))
            .stdin(Stdio::null());
        let output = probe.output().map_err(|error| no_program(file, "ffprobe", &error))?;
        if let Some(reason) = stopped_from_outside(output.status) {
            let kind = ErrorKind::Interrupted;
            return Err(VideoError::Io { file: file.to_path_buf(), frames: 0, reason, kind });
        }
        let unreadable = |reason: String| VideoError::of_content(file, 0, reason);
        if !output.status.success() {
            return Err(unreadable(last_line(&String::from_utf8_lossy(&output.stderr))));
        }
        let json: Value = serde_json::from_slice(&output.stdout).map_err(|error| unreadable(error.to_string()))?;
        let stream = &json["streams"][0];
        let number = |value: &Value| value.as_str().and_then(|text| text.parse::<f64>().ok()).unwrap_or(0.0);
        let packets = number(&stream["nb_read_packets"]);
        let rate = |name: &str| stream[name].as_str().and_then(fraction).filter(|rate| rate.is_finite() && *rate > 0.0);
        match rate("avg_frame_rate").or_else(|| rate("r_frame_rate")) {
            Some(rate_hz) if packets > 0.0 => {
                // The header of a cut file still gives the full duration.
                let stated = (number(&json["format"]["duration"]) * rate_hz).round();
                let aspect = stream["sample_aspect_ratio"].as_str().and_then(fraction);
                let pixel_aspect = aspect.filter(|aspect| aspect.is_finite() && *aspect > 0.0).unwrap_or(1.0);
                Ok(Self { rate_hz, frames: packets.max(stated) as usize, pixel_aspect })
            }
            _ => Err(unreadable("it holds no frames".to_owned())),
        }
    }
}

/// Frames of a video, one after the other, at a constant rate.
#[derive(Debug)]
pub struct VideoFrames {
    file: PathBuf,
    child: Child,
    pipe: BufReader<ChildStdout>,
    complaints: File,
    /// The first frame until it is taken.
    first: Option<RgbImage>,
    /// Frames that came through the pipe.
    read: usize,
    expected: usize,
}

impl VideoFrames {
    /// Opens a video and decodes its first frame. Frame k is the picture at time k / `rate_hz`. For
    /// this, frames are repeated or dropped where the video's own rate differs or varies.
    ///
    /// # Errors
    /// There is no ffmpeg, or no frame can be decoded.
    pub fn open(file: &Path, rate_hz: f64) -> Result<Self, VideoError> {
        let facts = VideoFacts::read(file)?;
        let complaints = tempfile::tempfile().map_err(|error| no_program(file, "ffmpeg", &error))?;
        let stderr = complaints.try_clone().map_err(|error| no_program(file, "ffmpeg", &error))?;
        let mut command = Command::new("ffmpeg");
        command.args(["-nostdin", "-v", "error", "-i"]).arg(address(file)).args(["-map", "0:v:0", "-vf"]);
        // Square pixels, of 8 bits also where a phone writes 10.
        let square = if facts.pixel_aspect == 1.0 { "" } else { ",scale=iw*sar:ih,setsar=1" };
        command.arg(format!("fps={rate_hz}{square}")).args([
            "-f",
            "image2pipe",
            "-c:v",
            "ppm",
            "-pix_fmt",
            "rgb24",
            "-",
        ]);
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::from(stderr));
        #[cfg(unix)]
        {
            use std::os::unix::process::CommandExt;
            // Ctrl-C goes to this program only, which stops ffmpeg.
            command.process_group(0);
        }
        let mut child = command.spawn().map_err(|error| no_program(file, "ffmpeg", &error))?;
        let unreadable = |reason: &str| VideoError::of_content(file, 0, reason.to_owned());
        let pipe = child.stdout.take().ok_or_else(|| unreadable("ffmpeg has no output"))?;
        let expected = (facts.frames as f64 * rate_hz / facts.rate_hz).round() as usize;
        let mut frames = Self {
            file: file.to_path_buf(),
            child,
            pipe: BufReader::with_capacity(1 << 16, pipe),
            complaints,
            first: None,
            read: 0,
            expected: expected.max(1),
        };
        frames.first = frames.take_from_pipe()?;
        match frames.first {
            Some(_) => Ok(frames),
            None => Err(unreadable("it holds no frame that can be decoded")),
        }
    }

    /// The file.
    #[must_use]
    pub fn file(&self) -> &Path {
        &self.file
    }

    /// Number of frames by the video's header, at the requested rate.
    #[must_use]
    pub fn expected(&self) -> usize {
        self.expected
    }

    /// The first frame, until it is taken.
    #[must_use]
    pub fn first(&self) -> Option<&RgbImage> {
        self.first.as_ref()
    }

    /// The next frame; none where the video ends.
    ///
    /// # Errors
    /// [`VideoError::Broken`] or [`VideoError::Io`] once all frames before the break were given.
    pub fn next_frame(&mut self) -> Result<Option<RgbImage>, VideoError> {
        match self.first.take() {
            Some(first) => Ok(Some(first)),
            None => self.take_from_pipe(),
        }
    }

    fn take_from_pipe(&mut self) -> Result<Option<RgbImage>, VideoError> {
        match read_ppm(&mut self.pipe) {
            Ok(Some(image)) => {
                self.read += 1;
                Ok(Some(image))
            }
            Ok(None) => self.end(None),
            Err(error) => self.end(Some(error)),
        }
    }

    /// Handles the end of the pipe: the video's end, or an error.
    fn end(&mut self, failure: Option<std::io::Error>) -> Result<Option<RgbImage>, VideoError> {
        let (file, frames) = (self.file.clone(), self.read);
        // After a frame that cannot be understood, ffmpeg may still be waiting with the next one.
        let has_ended = failure.as_ref().is_none_or(|error| error.kind() == ErrorKind::UnexpectedEof);
        let status = if has_ended { self.child.wait().ok() } else { None };
        if let Some(reason) = status.and_then(stopped_from_outside) {
            return Err(VideoError::Io { file, frames, reason, kind: ErrorKind::Interrupted });
        }
        let mut text = String::new();
        let _ = self.complaints.seek(SeekFrom::Start(0)).and_then(|_| self.complaints.read_to_string(&mut text));
        let succeeded = failure.is_none() && status.is_some_and(|status| status.success());
        // Messages about a video of full length are about minor defects.
        if succeeded && (text.trim().is_empty() || self.read >= self.expected) {
            return Ok(None);
        }
        let reason = match failure {
            _ if !text.trim().is_empty() => last_line(&text),
            Some(failure) => failure.to_string(),
            None => "ffmpeg failed and says nothing".to_owned(),
        };
        Err(VideoError::of_content(&file, frames, reason))
    }
}

/// Who ended ffmpeg, if it was neither ffmpeg nor the video.
fn stopped_from_outside(status: ExitStatus) -> Option<String> {
    /// What ffmpeg ends with after a signal that it handles.
    const AFTER_SIGNAL: i32 = 255;
    #[cfg(unix)]
    {
        use std::os::unix::process::ExitStatusExt;
        // SIGHUP, SIGINT, SIGKILL as for lack of memory, SIGTERM.
        if let Some(signal @ (1 | 2 | 9 | 15)) = status.signal() {
            return Some(format!("its reader was ended by signal {signal}"));
        }
    }
    (status.code() == Some(AFTER_SIGNAL)).then(|| "its reader was ended by a signal".to_owned())
}

/// Reads all of a file, as ffmpeg does without saying why it failed.
fn read_through(file: &Path) -> std::io::Result<u64> {
    std::io::copy(&mut File::open(file)?, &mut std::io::sink())
}

impl Drop for VideoFrames {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// One binary PPM of 8 bits from a stream of them; none where the stream ends before it.
fn read_ppm(pipe: &mut impl BufRead) -> std::io::Result<Option<RgbImage>> {
    if pipe.fill_buf()?.is_empty() {
        return Ok(None);
    }
    let wrong = |what: &str| std::io::Error::new(ErrorKind::InvalidData, format!("ffmpeg sent {what}"));
    let mut word = || -> std::io::Result<String> {
        let mut word = String::new();
        for byte in pipe.by_ref().bytes().take(16) {
            match byte? {
                space if space.is_ascii_whitespace() => break,
                other => word.push(char::from(other)),
            }
        }
        Ok(word)
    };
    let [magic, width, height, most] = [word()?, word()?, word()?, word()?];
    let side = |text: &str| text.parse().ok().filter(|side| (1..=MAX_SIDE_PX).contains(side));
    let (Some(width), Some(height)) = (side(&width), side(&height)) else {
        return Err(wrong(&format!("a frame of {width}x{height} pixels; each side may be 1 to {MAX_SIDE_PX}")));
    };
    if magic != "P6" || most != "255" {
        return Err(wrong("something that is no picture"));
    }
    let mut pixels = vec![0; 3 * width as usize * height as usize];
    pipe.read_exact(&mut pixels)?;
    Ok(RgbImage::from_raw(width, height, pixels))
}

/// A name that ffmpeg takes for a file, whatever it begins with.
fn address(file: &Path) -> OsString {
    let mut address = OsString::from("file:");
    address.push(file);
    address
}

fn no_program(file: &Path, program: &'static str, error: &std::io::Error) -> VideoError {
    VideoError::NoProgram { file: file.to_path_buf(), program, reason: error.to_string() }
}

fn last_line(text: &str) -> String {
    text.lines().rev().map(str::trim).find(|line| !line.is_empty()).unwrap_or("ffmpeg says nothing").to_owned()
}

/// `30000/1001`.
fn fraction(text: &str) -> Option<f64> {
    let (over, under) = text.split_once(['/', ':'])?;
    Some(over.parse::<f64>().ok()? / under.parse::<f64>().ok()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_follow_each_other_in_a_stream() {
        let stream = [&b"P6\n2 1\n255\nabcdef"[..], b"P6 1 1 255 \n\n\n"].concat();
        let mut pipe = BufReader::with_capacity(4, &stream[..]);
        assert_eq!(read_ppm(&mut pipe).unwrap().unwrap().into_raw(), b"abcdef");
        assert_eq!(read_ppm(&mut pipe).unwrap().unwrap().into_raw(), b"\n\n\n");
        assert!(read_ppm(&mut pipe).unwrap().is_none());
        for broken in ["P6\n2 1\n255\nabc", "P6\n0 1\n255\n", "P6\n99999999 1\n255\n", "P5\n1 1\n255\na", "noise"] {
            assert!(read_ppm(&mut broken.as_bytes()).is_err(), "{broken}");
        }
    }

    #[test]
    fn a_video_is_a_file_with_its_ending() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a.MP4");
        assert!(!is_video(&file));
        std::fs::write(&file, "").unwrap();
        assert!(is_video(&file) && !is_video(folder.path()));
        assert_eq!(frame_name(&file, 12), "a_000012.png");
        assert_eq!(fraction("30000/1001").map(f64::round), Some(30.0));
    }
}
