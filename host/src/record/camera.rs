//! What a camera would have delivered: the images of a run as lines of RGB565.

use super::StreamWriter;
use super::arm_run::ArmRun;
use crate::camera_lines::{block_of, lines, of_blocks};
use crate::error::{Context, Result, bail};
use crate::skin::model::ModelNumbers;
use sinew_core::camera::Camera;
use sinew_record::{ArmInput, ArmSetup, CameraFace, CameraLine, CameraSetup};

/// The stream of a run's images and their number. Larger ones than firmware's frames are made
/// smaller by the mean of square blocks. Skin is what the run's Gaussian says in the light of the
/// first image; the faces are those that counted in the run.
pub(super) fn camera_stream(run: &mut ArmRun) -> Result<(Vec<u8>, usize)> {
    let block = block_of(run.frames.size_px());
    let mut stream = StreamWriter::default();
    stream.push(&camera_setup(run, block)?)?;
    stream.push(&arm_setup(&run.setup, block)?)?;
    let (shoulder_m, mut faces) = (run.setup.shoulder_m, run.faces(block)?);
    let frames = run.each_frame(|frame, timestamp_us, image| {
        if let Some(image) = &image {
            let seen = of_blocks(image, block);
            if let Some(face) = faces.as_mut().and_then(|faces| faces.look(frame, &seen, None)) {
                stream.push(&CameraFace { head: face.head })?;
            }
            for (row, pixels) in lines(&seen).enumerate() {
                stream.push(&CameraLine { row: u16::try_from(row)?, pixels: pixels.collect() })?;
            }
        }
        stream.push(&ArmInput {
            frame: u32::try_from(frame)?,
            timestamp_us,
            has_image: image.is_some(),
            shoulder_m,
            candidates: 0,
            edges: 0,
        })
    })?;
    Ok((stream.finish()?, frames))
}

fn camera_setup(run: &ArmRun, block: u32) -> Result<CameraSetup> {
    let (width, height) = run.frames.size_px();
    let model = run.skin.for_image(run.frames.first().1)?;
    let ModelNumbers::Gaussian(gaussian) = model.numbers() else {
        bail!("its skin model is a table; a camera's records hold a Gaussian: track with `--skin gaussian`")
    };
    let skin = gaussian.classifier()?;
    Ok(CameraSetup {
        size_px: [u16::try_from(width / block)?, u16::try_from(height / block)?],
        skin_mean: [skin.mean_r(), skin.mean_g()],
        skin_covariance: skin.covariance(),
        skin_threshold: skin.threshold(),
        skin_min_sum: skin.min_sum(),
    })
}

/// The same arm before a camera whose pixels are `block` times as wide.
fn arm_setup(setup: &ArmSetup, block: u32) -> Result<ArmSetup> {
    let [focal_u_px, focal_v_px] = setup.focal_px;
    let camera = Camera::new(focal_u_px, focal_v_px, setup.centre)?.of_blocks(block);
    Ok(ArmSetup {
        focal_px: [camera.focal_px(); 2],
        centre: camera.centre(),
        image_size_px: setup.image_size_px.map(|side| side / block),
        ..*setup
    })
}

/// Puts the angles of a cyclic recording into a camera's: before each frame of the arm, one of the
/// cyclic tracker.
///
/// # Errors
/// A stream that is broken.
pub fn interleaved(camera: &[u8], cyclic: &[u8]) -> Result<Vec<u8>> {
    use sinew_record::{CyclicInput, CyclicSetup, Kind, Record, RecordStream};
    let mut stream = StreamWriter::default();
    let mut angles = RecordStream::<_, 1024>::new(cyclic);
    let mut next = || -> Result<Option<Result<CyclicSetup, CyclicInput>>> {
        let Some(record) = angles.next_record() else { return Ok(None) };
        let record = record?;
        Ok(Some(if record.kind == Kind::CyclicSetup { Ok(record.read()?) } else { Err(record.read()?) }))
    };
    if let Some(Ok(setup)) = next()? {
        stream.push(&setup)?;
    }
    let mut delivered = RecordStream::<_, 1024>::new(camera);
    while let Some(record) = delivered.next_record() {
        let record: Record<'_> = record?;
        match record.kind {
            Kind::CameraSetup => stream.push(&record.read::<CameraSetup>()?)?,
            Kind::ArmSetup => stream.push(&record.read::<ArmSetup>()?)?,
            Kind::CameraLine => stream.push(&record.read::<CameraLine>()?)?,
            Kind::CameraFace => stream.push(&record.read::<CameraFace>()?)?,
            _ => {
                if let Some(Err(input)) = next()? {
                    stream.push(&input)?;
                }
                stream.push(&record.read::<ArmInput>().context("it is not the stream of a camera")?)?;
            }
        }
    }
    stream.finish()
}
