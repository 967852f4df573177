//! In the place of `pictures` where the feature `plots` is off: a run that is to be drawn is
//! refused.

use crate::body::tracking::BodyFilter;
use crate::body::tracking::filter::WholeBodyEstimate;
use crate::error::{Result, bail};
use crate::output::{OutputDir, PendingFile};
use sinew_core::math::Vec3;

/// There is none.
#[derive(Debug)]
pub enum BodyPictures {}

impl BodyPictures {
    /// Refuses.
    ///
    /// # Errors
    /// Always.
    pub fn new(_: usize) -> Result<Self> {
        bail!("pictures are not part of this build; build the library with the feature `plots`")
    }

    /// There is none that wants something.
    #[must_use]
    pub fn wants(&self, _: usize) -> bool {
        match *self {}
    }

    /// There is none that takes something.
    pub fn add(&mut self, _: (usize, u64, f64), _: &[Vec3], _: (&BodyFilter, &WholeBodyEstimate), _: Option<f64>) {
        match *self {}
    }

    /// There is none of which there are files.
    ///
    /// # Errors
    /// None.
    pub fn files(&self, _: &OutputDir) -> Result<Vec<PendingFile>> {
        match *self {}
    }
}
