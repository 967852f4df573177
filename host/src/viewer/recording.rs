//! The file itself: rows of entities in chunks. Ids are counted and not taken from a clock, so the
//! same run gives the same ids.

use crate::error::{Context, Result};
use re_chunk::{Chunk, ChunkId, RowId, TimePoint, Timeline};
use re_log_encoding::{Encoder, EncodingOptions};
use re_log_types::{LogMsg, SetStoreInfo, StoreId, StoreInfo, StoreKind, StoreSource};
use re_sdk_types::AsComponents;
use std::io::Write;

/// Rows of a chunk, so that the viewer need not hold all pictures to show one.
const CHUNK_ROWS: usize = 64;
/// Name of the program as the viewer shows it.
pub const APPLICATION: &str = "sinew";

/// When a row holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moment {
    /// Number of the frame.
    pub frame: i64,
    /// Seconds since frame 0.
    pub time_s: f64,
}

impl Moment {
    fn point(self) -> TimePoint {
        let nanoseconds = (self.time_s * 1.0e9).round() as i64;
        TimePoint::default()
            .with(Timeline::new_sequence("frame"), self.frame)
            .with(Timeline::new_duration("time"), nanoseconds)
    }
}

/// A recording that is written.
pub struct Recording<'w> {
    encoder: Encoder<&'w mut dyn Write>,
    store: StoreId,
    /// Ids given away.
    ids: u128,
}

impl std::fmt::Debug for Recording<'_> {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.debug_struct("Recording").field("store", &self.store).finish_non_exhaustive()
    }
}

impl<'w> Recording<'w> {
    /// Begins a recording of the name, by which the viewer distinguishes recordings.
    ///
    /// # Errors
    /// What the writer refuses.
    pub fn begin(name: &str, writer: &'w mut dyn Write) -> Result<Self> {
        let version = re_build_info::CrateVersion::LOCAL;
        let mut encoder = Encoder::new_eager(version, EncodingOptions::PROTOBUF_COMPRESSED, writer)?;
        let store = StoreId::new(StoreKind::Recording, APPLICATION, name);
        let info = StoreInfo::new(store.clone(), StoreSource::Other(APPLICATION.to_owned()));
        encoder.append(&LogMsg::SetStoreInfo(SetStoreInfo { row_id: RowId::from_u128(1).as_tuid(), info }))?;
        Ok(Self { encoder, store, ids: 1 })
    }

    fn id(&mut self) -> u128 {
        self.ids += 1;
        self.ids
    }

    /// What holds of an entity in all frames.
    ///
    /// # Errors
    /// What the writer refuses.
    pub fn constant(&mut self, entity: &str, what: &dyn AsComponents) -> Result<()> {
        let id = ChunkId::from_u128(self.id());
        let row = RowId::from_u128(self.id());
        let chunk = Chunk::builder_with_id(id, entity).with_archetype(row, TimePoint::STATIC, what).build();
        self.append(entity, &chunk.with_context(|| entity.to_owned())?)
    }

    /// The rows of an entity, in the order of time.
    ///
    /// # Errors
    /// That of a row, or what the writer refuses.
    pub fn rows<T: AsComponents>(
        &mut self,
        entity: &str,
        rows: impl IntoIterator<Item = (Moment, Result<T>)>,
    ) -> Result<()> {
        let mut rows = rows.into_iter().peekable();
        while rows.peek().is_some() {
            let mut chunk = Chunk::builder_with_id(ChunkId::from_u128(self.id()), entity);
            for (moment, what) in rows.by_ref().take(CHUNK_ROWS) {
                chunk = chunk.with_archetype(RowId::from_u128(self.id()), moment.point(), &what?);
            }
            self.append(entity, &chunk.build().with_context(|| entity.to_owned())?)?;
        }
        Ok(())
    }

    fn append(&mut self, entity: &str, chunk: &Chunk) -> Result<()> {
        let message = chunk.to_arrow_msg().with_context(|| entity.to_owned())?;
        self.encoder.append(&LogMsg::ArrowMsg(self.store.clone(), message))?;
        Ok(())
    }

    /// Ends the recording.
    ///
    /// # Errors
    /// What the writer refuses.
    pub fn finish(mut self) -> Result<()> {
        Ok(self.encoder.finish()?)
    }
}
