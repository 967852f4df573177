//! What the arm tracker is given: the arm once, then candidates, edges and the frame that they
//! belong to.

use crate::error::RecordError;
use crate::fields::{FieldReader, FieldWriter};
use crate::kind::Kind;
use crate::payload::Payload;
use heapless::Vec;
use sinew_core::camera::{Camera, Pixel};
use sinew_core::error::ParameterError;
use sinew_core::math::Vec3;
use sinew_core::skeleton::Side;
use sinew_core::skeleton::arm::ArmGeometry;
use sinew_core::tracker::arm::options::{AreaCue, LimbCombination};
use sinew_core::tracker::arm::{ArmModel, ArmOptions};
use sinew_core::vision::candidate::HandCandidate;
use sinew_core::vision::edges::EdgePixel;

/// Candidates of a record.
pub const CANDIDATES_A_RECORD: usize = 8;
/// Edge pixels of a record.
pub const EDGES_A_RECORD: usize = 64;

/// Begins the recording of an arm: camera, lengths, seed, and the options that depend on what is
/// known of the person. All others are the defaults.
///
/// ```
/// use sinew_core::camera::Pixel;
/// use sinew_core::math::Vec3;
/// use sinew_record::ArmSetup;
/// use sinew_core::skeleton::Side;
///
/// let setup = ArmSetup {
///     focal_px: [554.0; 2],
///     centre: Pixel::new(319.5, 239.5),
///     image_size_px: [640, 480],
///     side: Side::Left,
///     lengths_m: [0.30, 0.35],
///     shoulder_m: Vec3::new(0.2, -0.1, 1.2),
///     particles: 50,
///     product_floor: None,
///     area_cue: None,
///     seed: 1,
/// };
/// // Firmware makes of it the model that the host tracked with.
/// let model = setup.model()?;
/// assert_eq!((model.side(), model.options().particles), (Side::Left, 50));
/// assert!(ArmSetup { lengths_m: [0.30, 0.0], ..setup }.model().is_err(), "a length is above zero");
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ArmSetup {
    /// Focal lengths, pixels.
    pub focal_px: [f32; 2],
    /// Principal point.
    pub centre: Pixel,
    /// Width and height of the image, pixels.
    pub image_size_px: [u32; 2],
    /// The person's own side.
    pub side: Side,
    /// Lengths of upper arm and forearm, metres.
    pub lengths_m: [f32; 2],
    /// Where the shoulder is at first, metres in camera axes.
    pub shoulder_m: Vec3,
    /// Number of particles.
    pub particles: u16,
    /// Floor of the product of both limbs' densities; `None` for their mean.
    pub product_floor: Option<f32>,
    /// What a blob's area says of its distance.
    pub area_cue: Option<AreaCue>,
    /// Seed of all that is random.
    pub seed: u64,
}

impl ArmSetup {
    /// The options that it stands for.
    #[must_use]
    pub fn options(&self) -> ArmOptions {
        let defaults = ArmOptions::default();
        ArmOptions {
            particles: usize::from(self.particles),
            combination: self.product_floor.map_or(LimbCombination::Mean, |_| LimbCombination::Product),
            product_floor: self.product_floor.unwrap_or(defaults.product_floor),
            area_cue: self.area_cue,
            ..defaults
        }
    }

    /// The model that it stands for.
    ///
    /// # Errors
    /// Names the first parameter that is out of its range.
    pub fn model(&self) -> Result<ArmModel, ParameterError> {
        let [focal_u_px, focal_v_px] = self.focal_px;
        let camera = Camera::new(focal_u_px, focal_v_px, self.centre)?;
        let [upper_arm_m, forearm_m] = self.lengths_m;
        let geometry = ArmGeometry::new(self.side, upper_arm_m, forearm_m)?;
        let [width, height] = self.image_size_px;
        ArmModel::new(camera, (width, height), geometry, self.options())
    }
}

impl Payload for ArmSetup {
    const KIND: Kind = Kind::ArmSetup;
    const MAX_BYTES: usize = 4 * 4 + 2 * 4 + 1 + 2 * 4 + 3 * 4 + 2 + 5 + 1 + 4 * 4 + 8;

    fn write(&self, fields: &mut FieldWriter<'_>) {
        fields.f32s(&self.focal_px);
        fields.f32s(&[self.centre.u_px, self.centre.v_px]);
        self.image_size_px.iter().for_each(|&side| fields.u32(side));
        fields.u8(u8::from(self.side == Side::Right));
        fields.f32s(&self.lengths_m);
        fields.f32s(self.shoulder_m.as_slice());
        fields.u16(self.particles);
        fields.optional_f32(self.product_floor);
        fields.u8(u8::from(self.area_cue.is_some()));
        let cue =
            self.area_cue.map_or([0.0; 4], |cue| [cue.hand_area_m2, cue.length_share, cue.foreshortening, cue.log_std]);
        fields.f32s(&cue);
        fields.u64(self.seed);
    }

    fn read(fields: &mut FieldReader<'_>) -> Result<Self, RecordError> {
        let focal_px = fields.f32s()?;
        let [u_px, v_px] = fields.f32s()?;
        let image_size_px = [fields.u32()?, fields.u32()?];
        let side = if fields.flag("side")? { Side::Right } else { Side::Left };
        let lengths_m = fields.f32s()?;
        let shoulder_m = Vec3::from(fields.f32s::<3>()?);
        let particles = fields.u16()?;
        let product_floor = fields.optional_f32("product_floor")?;
        let has_cue = fields.flag("area_cue")?;
        let [hand_area_m2, length_share, foreshortening, log_std] = fields.f32s()?;
        let area_cue = has_cue.then_some(AreaCue { hand_area_m2, length_share, foreshortening, log_std });
        let centre = Pixel::new(u_px, v_px);
        let seed = fields.u64()?;
        Ok(Self {
            focal_px,
            centre,
            image_size_px,
            side,
            lengths_m,
            shoulder_m,
            particles,
            product_floor,
            area_cue,
            seed,
        })
    }
}

/// Some of a frame's candidates; their [`ArmInput`] follows.
///
/// ```
/// use sinew_core::vision::candidate::HandCandidate;
/// use sinew_record::{CANDIDATES_A_RECORD, CandidateChunk, decode, encode};
///
/// // As many of a frame's candidates as a record holds; more of them take another one.
/// let mut chunk = CandidateChunk::default();
/// chunk.0.extend([HandCandidate { likelihood: 0.8, ..HandCandidate::default() }; CANDIDATES_A_RECORD]);
/// let mut bytes = [0; 256];
/// encode(&chunk, &mut bytes)?;
/// assert_eq!(decode(&bytes)?.0.read::<CandidateChunk>()?.0.len(), CANDIDATES_A_RECORD);
/// # Ok::<(), sinew_record::RecordError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CandidateChunk(pub Vec<HandCandidate, CANDIDATES_A_RECORD>);

impl Payload for CandidateChunk {
    const KIND: Kind = Kind::CandidateChunk;
    const MAX_BYTES: usize = 2 + 7 * 4 * CANDIDATES_A_RECORD;

    fn write(&self, fields: &mut FieldWriter<'_>) {
        fields.u16(self.0.len() as u16);
        for candidate in &self.0 {
            fields.f32s(&[candidate.centre.u_px, candidate.centre.v_px]);
            fields.f32s(&candidate.moments_px2);
            fields.f32s(&[candidate.area_px, candidate.likelihood]);
        }
    }

    fn read(fields: &mut FieldReader<'_>) -> Result<Self, RecordError> {
        let mut list = Vec::new();
        for _ in 0..fields.u16()? {
            let [u_px, v_px] = fields.f32s()?;
            let moments_px2 = fields.f32s()?;
            let [area_px, likelihood] = fields.f32s()?;
            let candidate = HandCandidate { centre: Pixel::new(u_px, v_px), moments_px2, area_px, likelihood };
            list.push(candidate).map_err(|_| RecordError::Capacity { list: "candidates" })?;
        }
        Ok(Self(list))
    }
}

/// Some of a frame's edge pixels; their [`ArmInput`] follows.
///
/// ```
/// use sinew_record::{EdgeChunk, HEADER_BYTES, encode};
/// use sinew_core::vision::edges::EdgePixel;
///
/// let mut chunk = EdgeChunk::default();
/// chunk.0.extend([EdgePixel { u: 310, v: 200 }, EdgePixel { u: 311, v: 200 }]);
/// // Four bytes an edge pixel, two for their number.
/// let mut bytes = [0; 64];
/// assert_eq!(encode(&chunk, &mut bytes), Ok(HEADER_BYTES + 2 + 2 * 4));
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct EdgeChunk(pub Vec<EdgePixel, EDGES_A_RECORD>);

impl Payload for EdgeChunk {
    const KIND: Kind = Kind::EdgeChunk;
    const MAX_BYTES: usize = 2 + 4 * EDGES_A_RECORD;

    fn write(&self, fields: &mut FieldWriter<'_>) {
        fields.u16(self.0.len() as u16);
        for edge in &self.0 {
            fields.u16(edge.u);
            fields.u16(edge.v);
        }
    }

    fn read(fields: &mut FieldReader<'_>) -> Result<Self, RecordError> {
        let mut list = Vec::new();
        for _ in 0..fields.u16()? {
            let edge = EdgePixel { u: fields.u16()?, v: fields.u16()? };
            list.push(edge).map_err(|_| RecordError::Capacity { list: "edges" })?;
        }
        Ok(Self(list))
    }
}

/// Ends a frame of an arm: what came before it belongs to it.
///
/// ```
/// use sinew_core::math::Vec3;
/// use sinew_record::{ArmInput, CandidateChunk, Kind, RecordStream, encode};
///
/// // A frame with one candidate: first the candidate, then the frame that it belongs to.
/// let input = ArmInput {
///     frame: 3,
///     timestamp_us: 200_000,
///     has_image: true,
///     shoulder_m: Vec3::new(0.2, -0.1, 1.2),
///     candidates: 1,
///     edges: 0,
/// };
/// let chunk = CandidateChunk(core::iter::once(Default::default()).collect());
/// let mut bytes = [0; 256];
/// let length = encode(&chunk, &mut bytes)?;
/// let length = length + encode(&input, &mut bytes[length..])?;
///
/// let mut stream = RecordStream::<_, 256>::new(&bytes[..length]);
/// assert!(stream.next_record().is_some_and(|first| first.is_ok_and(|first| first.kind == Kind::CandidateChunk)));
/// let last = stream.next_record().expect("there is another")?;
/// assert_eq!(last.read::<ArmInput>()?, input);
/// # Ok::<(), sinew_record::RecordError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ArmInput {
    /// Number of the frame; rises from record to record.
    pub frame: u32,
    /// When it was taken, microseconds.
    pub timestamp_us: u64,
    /// Whether there was an image.
    pub has_image: bool,
    /// Where the shoulder is, metres in camera axes.
    pub shoulder_m: Vec3,
    /// Candidates that came before.
    pub candidates: u16,
    /// Edge pixels that came before.
    pub edges: u16,
}

impl Payload for ArmInput {
    const KIND: Kind = Kind::ArmInput;
    const MAX_BYTES: usize = 4 + 8 + 1 + 3 * 4 + 2 * 2;

    fn write(&self, fields: &mut FieldWriter<'_>) {
        fields.u32(self.frame);
        fields.u64(self.timestamp_us);
        fields.u8(u8::from(self.has_image));
        fields.f32s(self.shoulder_m.as_slice());
        fields.u16(self.candidates);
        fields.u16(self.edges);
    }

    fn read(fields: &mut FieldReader<'_>) -> Result<Self, RecordError> {
        let frame = fields.u32()?;
        let timestamp_us = fields.u64()?;
        let has_image = fields.flag("has_image")?;
        let shoulder_m = Vec3::from(fields.f32s::<3>()?);
        if !shoulder_m.iter().all(|metres| metres.is_finite()) {
            return Err(RecordError::Value { field: "shoulder_m" });
        }
        Ok(Self { frame, timestamp_us, has_image, shoulder_m, candidates: fields.u16()?, edges: fields.u16()? })
    }
}
