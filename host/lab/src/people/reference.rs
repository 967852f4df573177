//! Where a person's palms, nose and wrists are in each frame of a clip, by another program.

use anyhow::{Context, Result};
use sinew_core::camera::Pixel;
use std::collections::BTreeMap;
use std::path::Path;

/// A hand is on a palm within this of its centre, sizes of the palm.
pub const NEAR_PALM: f32 = 0.35;
/// A place is on the face within this of the nose, distances of the ears.
pub const NEAR_NOSE: f32 = 0.8;
/// The least distance of the ears that is used, pixels: of a face from the side it is too small.
const MIN_EARS_PX: f32 = 20.0;

/// A palm: mean of wrist and four knuckles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Palm {
    /// Its centre.
    pub centre: Pixel,
    /// The larger side of the hand's box, pixels.
    pub size_px: f32,
}

impl Palm {
    /// Distance of a place from its centre, sizes of the palm.
    #[must_use]
    pub fn distance(&self, place: Pixel) -> f32 {
        place.distance_px(self.centre) / self.size_px
    }

    /// Whether a place is on it.
    #[must_use]
    pub fn holds(&self, place: Pixel) -> bool {
        self.distance(place) <= NEAR_PALM
    }
}

/// What is known of one frame; what was not found is missing.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Reference(BTreeMap<String, f32>);

impl Reference {
    /// The point of this name.
    #[must_use]
    pub fn point(&self, name: &str) -> Option<Pixel> {
        Some(Pixel::new(*self.0.get(&format!("{name}_u_px"))?, *self.0.get(&format!("{name}_v_px"))?))
    }

    /// The palms that were found, in no order.
    pub fn palms(&self) -> impl Iterator<Item = Palm> {
        [1, 2].into_iter().filter_map(|number| {
            let size_px = *self.0.get(&format!("size{number}_px"))?;
            Some(Palm { centre: self.point(&format!("palm{number}"))?, size_px })
        })
    }

    /// Distance of the ears, pixels.
    #[must_use]
    pub fn ears_px(&self) -> Option<f32> {
        self.0.get("ears_px").copied()
    }

    /// Whether a place is on the face.
    #[must_use]
    pub fn is_on_face(&self, place: Pixel) -> bool {
        let ears_px = self.ears_px().unwrap_or_default().max(MIN_EARS_PX);
        self.point("nose").is_some_and(|nose| place.distance_px(nose) <= NEAR_NOSE * ears_px)
    }

    /// Whether a place is at a wrist that does not belong to `palm`.
    #[must_use]
    pub fn is_at_wrist_off(&self, place: Pixel, palm: &Palm) -> bool {
        let ears_px = self.ears_px().unwrap_or_default().max(MIN_EARS_PX);
        let wrists = ["l_wrist", "r_wrist"].into_iter().filter_map(|name| self.point(name));
        wrists.into_iter().any(|wrist| palm.distance(wrist) > 1.0 && place.distance_px(wrist) <= ears_px)
    }

    /// Without the palms from this row of the picture on.
    #[must_use]
    pub fn above(mut self, row_px: f32) -> Self {
        for palm in ["palm1", "palm2"] {
            if self.point(palm).is_some_and(|centre| centre.v_px >= row_px) {
                self.0.remove(&format!("{palm}_v_px"));
            }
        }
        self
    }
}

/// Reads the table of a clip, a row a frame.
///
/// # Errors
/// The file cannot be read, or is no table.
pub fn read(path: &Path) -> Result<Vec<Reference>> {
    let mut reader = csv::Reader::from_path(path).with_context(|| format!("reference {}", path.display()))?;
    reader
        .deserialize()
        .map(|row| {
            let row: BTreeMap<String, String> = row.with_context(|| format!("reference {}", path.display()))?;
            Ok(Reference(row.into_iter().filter_map(|(name, value)| Some((name, value.parse().ok()?))).collect()))
        })
        .collect()
}
