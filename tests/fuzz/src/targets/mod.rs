//! All targets, by topic.

mod arm;
mod body;
mod body_files;
mod clouds;
mod configuration;
mod cyclic;
mod cyclic_files;
mod keypoints;
mod models;
mod motion;
mod pictures;
mod records;
mod reports;
mod resume;
mod saved_states;
mod scene_files;
mod vision;

use crate::Target;

/// The topics' targets.
const TOPICS: [&[Target]; 17] = [
    motion::TARGETS,
    clouds::TARGETS,
    pictures::TARGETS,
    keypoints::TARGETS,
    cyclic_files::TARGETS,
    models::TARGETS,
    body_files::TARGETS,
    scene_files::TARGETS,
    configuration::TARGETS,
    resume::TARGETS,
    reports::TARGETS,
    saved_states::TARGETS,
    records::TARGETS,
    vision::TARGETS,
    arm::TARGETS,
    cyclic::TARGETS,
    body::TARGETS,
];

/// All targets.
pub fn all() -> impl Iterator<Item = &'static Target> {
    TOPICS.into_iter().flatten()
}

/// The target called `name`.
#[must_use]
pub fn find(name: &str) -> Option<&'static Target> {
    all().find(|target| target.name == name)
}
