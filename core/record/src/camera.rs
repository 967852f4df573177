//! What a camera delivers: lines, and the end of each frame.

use crate::error::RecordError;
use crate::fields::{FieldReader, FieldWriter};
use crate::kind::Kind;
use crate::payload::Payload;
use heapless::Vec;
use sinew_core::error::ParameterError;
use sinew_core::vision::objects::head::HeadBox;
use sinew_core::vision::skin::GaussianSkin;

/// Most pixels of a line.
pub const LINE_PIXELS: usize = 320;

/// Begins the recording of a camera: size of its frames, and which colours are skin.
///
/// ```
/// use sinew_record::CameraSetup;
///
/// let setup = CameraSetup {
///     size_px: [320, 240],
///     skin_mean: [0.42, 0.31],
///     skin_covariance: [0.001, 0.0, 0.0004],
///     skin_threshold: 2.5,
///     skin_min_sum: 90,
/// };
/// let skin = setup.skin()?;
/// assert!(skin.distance([200, 150, 125]).is_some_and(|distance| distance < setup.skin_threshold));
/// assert_eq!(skin.distance([20, 15, 12]), None, "too dark to have a colour");
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CameraSetup {
    /// Width and height, pixels.
    pub size_px: [u16; 2],
    /// Mean chromaticity of skin, red and green.
    pub skin_mean: [f32; 2],
    /// Its covariance: rr, rg, gg.
    pub skin_covariance: [f32; 3],
    /// Mahalanobis distance up to which a colour is skin.
    pub skin_threshold: f32,
    /// Sum of the channels below which no colour is skin.
    pub skin_min_sum: u16,
}

impl CameraSetup {
    /// The skin model.
    ///
    /// # Errors
    /// Those of [`GaussianSkin::new`].
    pub fn skin(&self) -> Result<GaussianSkin, ParameterError> {
        let [red, green] = self.skin_mean;
        GaussianSkin::new(red, green, self.skin_covariance, self.skin_threshold, self.skin_min_sum)
    }
}

impl Payload for CameraSetup {
    const KIND: Kind = Kind::CameraSetup;
    const MAX_BYTES: usize = 2 * 2 + 6 * 4 + 2;

    fn write(&self, fields: &mut FieldWriter<'_>) {
        self.size_px.iter().for_each(|&side| fields.u16(side));
        fields.f32s(&self.skin_mean);
        fields.f32s(&self.skin_covariance);
        fields.f32(self.skin_threshold);
        fields.u16(self.skin_min_sum);
    }

    fn read(fields: &mut FieldReader<'_>) -> Result<Self, RecordError> {
        Ok(Self {
            size_px: [fields.u16()?, fields.u16()?],
            skin_mean: fields.f32s()?,
            skin_covariance: fields.f32s()?,
            skin_threshold: fields.f32()?,
            skin_min_sum: fields.u16()?,
        })
    }
}

/// One line of a frame in RGB565.
///
/// ```
/// use sinew_record::{CameraLine, LINE_PIXELS, decode, encode};
///
/// // A red line of a QVGA picture.
/// let mut line = CameraLine { row: 17, pixels: Default::default() };
/// line.pixels.extend([0xF800; LINE_PIXELS]);
/// let mut bytes = [0; 1024];
/// encode(&line, &mut bytes)?;
/// let received = decode(&bytes)?.0.read::<CameraLine>()?;
/// assert_eq!((received.row, received.pixels.len()), (17, 320));
/// # Ok::<(), sinew_record::RecordError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct CameraLine {
    /// Row from the top.
    pub row: u16,
    /// Pixels from the left.
    pub pixels: Vec<u16, LINE_PIXELS>,
}

impl Payload for CameraLine {
    const KIND: Kind = Kind::CameraLine;
    const MAX_BYTES: usize = 2 + 2 + 2 * LINE_PIXELS;

    fn write(&self, fields: &mut FieldWriter<'_>) {
        fields.u16(self.row);
        fields.u16(self.pixels.len() as u16);
        self.pixels.iter().for_each(|&pixel| fields.u16(pixel));
    }

    fn read(fields: &mut FieldReader<'_>) -> Result<Self, RecordError> {
        let row = fields.u16()?;
        let mut pixels = Vec::new();
        for _ in 0..fields.u16()? {
            pixels.push(fields.u16()?).map_err(|_| RecordError::Capacity { list: "pixels" })?;
        }
        Ok(Self { row, pixels })
    }
}

/// A face that a detector found; it counts from the next frame on.
///
/// ```
/// use sinew_core::vision::objects::head::HeadBox;
/// use sinew_record::{CameraFace, decode, encode};
///
/// let face = CameraFace { head: HeadBox { centre_px: [160.0, 52.0], width_px: 36.0 } };
/// let mut bytes = [0; 64];
/// encode(&face, &mut bytes)?;
/// assert_eq!(decode(&bytes)?.0.read::<CameraFace>()?, face);
/// # Ok::<(), sinew_record::RecordError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CameraFace {
    /// Its box.
    pub head: HeadBox,
}

impl Payload for CameraFace {
    const KIND: Kind = Kind::CameraFace;
    const MAX_BYTES: usize = 3 * 4;

    fn write(&self, fields: &mut FieldWriter<'_>) {
        fields.f32s(&self.head.centre_px);
        fields.f32(self.head.width_px);
    }

    fn read(fields: &mut FieldReader<'_>) -> Result<Self, RecordError> {
        Ok(Self { head: HeadBox { centre_px: fields.f32s()?, width_px: fields.f32()? } })
    }
}

/// What the front end answers to a frame.
///
/// ```
/// use sinew_record::VisionResult;
///
/// // Firmware's answer has to be the host's: the same blobs and edges bit for bit, and as few of them lost.
/// let expected = VisionResult { frame: 7, blobs: 2, edges: 310, checksum: 0x1234_5678, losses: [0; 6] };
/// let answered = VisionResult { edges: 298, losses: [0, 0, 0, 12, 0, 0], ..expected };
/// assert_ne!(answered, expected);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct VisionResult {
    /// Number of the frame.
    pub frame: u32,
    /// Number of blobs.
    pub blobs: u16,
    /// Number of temporal edge pixels.
    pub edges: u16,
    /// CRC-32 of the bits of the blobs as candidates, the edge pixels, and the candidates of both
    /// hands.
    pub checksum: u32,
    /// Components, blobs, edges and lines that were lost, as in
    /// [`sinew_core::vision::front_end::FrameLosses`].
    pub losses: [u32; 6],
}

impl Payload for VisionResult {
    const KIND: Kind = Kind::VisionResult;
    const MAX_BYTES: usize = 4 + 2 + 2 + 4 + 6 * 4;

    fn write(&self, fields: &mut FieldWriter<'_>) {
        fields.u32(self.frame);
        fields.u16(self.blobs);
        fields.u16(self.edges);
        fields.u32(self.checksum);
        self.losses.iter().for_each(|&lost| fields.u32(lost));
    }

    fn read(fields: &mut FieldReader<'_>) -> Result<Self, RecordError> {
        let (frame, blobs, edges, checksum) = (fields.u32()?, fields.u16()?, fields.u16()?, fields.u32()?);
        let mut losses = [0; 6];
        for lost in &mut losses {
            *lost = fields.u32()?;
        }
        Ok(Self { frame, blobs, edges, checksum, losses })
    }
}
