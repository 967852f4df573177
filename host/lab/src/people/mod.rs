//! Tracked hands of recorded people, against reference palms: on the recordings as they are, and in
//! other light, cut, and at length.

pub mod changes;
pub mod clips;
pub mod reference;
pub mod score;
pub mod track;
