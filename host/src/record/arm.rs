//! What an arm tracker was given: candidates and edges of every frame.

use super::StreamWriter;
use super::arm_run::ArmRun;
use crate::error::Result;
use crate::frames::FrameView;
use crate::track::{ArmStream, FaceSource, StreamOptions};
use sinew_core::math::Vec3;
use sinew_record::{ArmInput, CANDIDATES_A_RECORD, CandidateChunk, EDGES_A_RECORD, EdgeChunk};

/// The stream of a run and its number of frames: the host's vision, firmware's tracker.
pub(super) fn tracker_stream(run: &mut ArmRun) -> Result<(Vec<u8>, usize)> {
    let (config, face) = (run.config.clone(), FaceSource::Unknown);
    let options = StreamOptions { rate_hz: run.rate_hz, face, config, ..StreamOptions::default() };
    let mut arm = ArmStream::new(options, run.skin.clone(), run.frames.size_px())?;
    let mut stream = StreamWriter::default();
    stream.push(&run.setup)?;
    let shoulder_m = run.setup.shoulder_m;
    let frames = run.each_frame(|frame, timestamp_us, image| {
        let seen = arm.see(frame, image.as_ref(), None)?;
        push_frame(&mut stream, frame, timestamp_us, shoulder_m, seen.map(|(view, _)| view).as_ref())
    })?;
    Ok((stream.finish()?, frames))
}

fn push_frame(
    stream: &mut StreamWriter,
    frame: usize,
    timestamp_us: u64,
    shoulder_m: Vec3,
    view: Option<&FrameView>,
) -> Result<()> {
    let (candidates, edges) = view.map_or((&[][..], &[][..]), |view| (&view.candidates, &view.edges));
    for chunk in candidates.chunks(CANDIDATES_A_RECORD) {
        stream.push(&CandidateChunk(chunk.iter().copied().collect()))?;
    }
    for chunk in edges.chunks(EDGES_A_RECORD) {
        stream.push(&EdgeChunk(chunk.iter().copied().collect()))?;
    }
    stream.push(&ArmInput {
        frame: u32::try_from(frame)?,
        timestamp_us,
        has_image: view.is_some(),
        shoulder_m,
        candidates: u16::try_from(candidates.len())?,
        edges: u16::try_from(edges.len())?,
    })
}
