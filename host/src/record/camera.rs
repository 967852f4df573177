//! What a camera would have delivered: the images of a run as lines of RGB565.

use super::StreamWriter;
use super::arm_run::ArmRun;
use crate::error::{Context, Result, bail};
use crate::skin::model::ModelNumbers;
use image::RgbImage;
use sinew_core::camera::Pixel;
use sinew_record::{ArmInput, ArmSetup, CameraLine, CameraSetup, LINE_PIXELS};

/// The stream of a run's images and their number. Wider ones than firmware's lines are made smaller
/// by the mean of square blocks. Skin is what the run's Gaussian says in the light of the first
/// image.
pub(super) fn camera_stream(run: &mut ArmRun) -> Result<(Vec<u8>, usize)> {
    let (width, _) = run.frames.size_px();
    let block = width.div_ceil(LINE_PIXELS as u32);
    let first = run.frames.first().1;
    let mut stream = StreamWriter::default();
    stream.push(&camera_setup(run, &smaller(first, block))?)?;
    stream.push(&arm_setup(&run.setup, block))?;
    let shoulder_m = run.setup.shoulder_m;
    let frames = run.each_frame(|frame, timestamp_us, image| {
        if let Some(image) = &image {
            for (row, pixels) in smaller(image, block).rows().enumerate() {
                let pixels = pixels.map(|pixel| rgb565(pixel.0)).collect();
                stream.push(&CameraLine { row: u16::try_from(row)?, pixels })?;
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

fn camera_setup(run: &ArmRun, first: &RgbImage) -> Result<CameraSetup> {
    let model = run.skin.for_image(first)?;
    let ModelNumbers::Gaussian(gaussian) = model.numbers() else {
        bail!("its skin model is a table; a camera's records hold a Gaussian: track with `--skin gaussian`")
    };
    let skin = gaussian.classifier()?;
    Ok(CameraSetup {
        size_px: [u16::try_from(first.width())?, u16::try_from(first.height())?],
        skin_mean: [skin.mean_r(), skin.mean_g()],
        skin_covariance: skin.covariance(),
        skin_threshold: skin.threshold(),
        skin_min_sum: skin.min_sum(),
    })
}

/// The same arm before a camera whose pixels are `block` times as wide.
fn arm_setup(setup: &ArmSetup, block: u32) -> ArmSetup {
    let scale = 1.0 / block as f32;
    let centre = |at: f32| (at + 0.5) * scale - 0.5;
    ArmSetup {
        focal_px: setup.focal_px.map(|focal| focal * scale),
        centre: Pixel::new(centre(setup.centre.u_px), centre(setup.centre.v_px)),
        image_size_px: setup.image_size_px.map(|side| side / block),
        ..*setup
    }
}

/// Means of blocks of `block` x `block` pixels; what is left at the right and at the bottom is cut
/// off.
fn smaller(image: &RgbImage, block: u32) -> RgbImage {
    RgbImage::from_fn(image.width() / block, image.height() / block, |u, v| {
        let mut sum = [0_u32; 3];
        for dv in 0..block {
            for du in 0..block {
                let pixel = image.get_pixel(block * u + du, block * v + dv);
                sum.iter_mut().zip(pixel.0).for_each(|(sum, channel)| *sum += u32::from(channel));
            }
        }
        image::Rgb(sum.map(|sum| ((sum + block * block / 2) / (block * block)) as u8))
    })
}

fn rgb565([red, green, blue]: [u8; 3]) -> u16 {
    u16::from(red >> 3) << 11 | u16::from(green >> 2) << 5 | u16::from(blue >> 3)
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
    let mut lines = RecordStream::<_, 1024>::new(camera);
    while let Some(record) = lines.next_record() {
        let record: Record<'_> = record?;
        match record.kind {
            Kind::CameraSetup => stream.push(&record.read::<CameraSetup>()?)?,
            Kind::ArmSetup => stream.push(&record.read::<ArmSetup>()?)?,
            Kind::CameraLine => stream.push(&record.read::<CameraLine>()?)?,
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
