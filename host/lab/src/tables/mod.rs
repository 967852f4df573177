//! The tables of `docs/` that a command writes: name, page, cost, and what makes the rows.

mod arm;
mod body;
mod body_scenes;
mod cluster;
mod cyclic;
mod hands;
pub mod markdown;
pub mod page;
mod people;
mod recordings;
mod runners;
mod skin;

use anyhow::Result;
use markdown::Rows;
use std::path::Path;

/// How long a table takes to make.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cost {
    /// Less than ten seconds on two cores; `.ci/run` checks it.
    Cheap,
    /// From minutes to hours.
    Long,
}

impl Cost {
    /// Its word in lists.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Cheap => "cheap",
            Self::Long => "long",
        }
    }
}

/// A table of the book.
#[derive(Debug, Clone, Copy)]
pub struct Table {
    /// Its name in the marks.
    pub name: &'static str,
    /// The page in `docs/`.
    pub page: &'static str,
    /// How long it takes.
    pub cost: Cost,
    /// The folder of recordings that it is measured on; none where it is measured on built-in
    /// motions.
    pub recordings: Option<&'static str>,
    /// Makes the rows from the folder of all recordings.
    pub rows: fn(&Path) -> Result<Rows>,
}

/// All tables that have a maker.
pub const TABLES: [Table; 22] = [
    Table {
        name: "arm-hands",
        page: "measurements_arm.md",
        cost: Cost::Cheap,
        recordings: Some("video/handtracking"),
        rows: hands::in_boxes,
    },
    Table {
        name: "hand-likelihood",
        page: "hand_likelihood.md",
        cost: Cost::Cheap,
        recordings: Some("video/handtracking"),
        rows: hands::ranking,
    },
    Table {
        name: "people",
        page: "measurements_people.md",
        cost: Cost::Long,
        recordings: Some("video/asl"),
        rows: people::hands,
    },
    Table { name: "cluster-work", page: "cluster.md", cost: Cost::Cheap, recordings: None, rows: cluster::work },
    Table { name: "cluster-chunks", page: "cluster.md", cost: Cost::Cheap, recordings: None, rows: cluster::chunks },
    Table { name: "skin-scores", page: "skin.md", cost: Cost::Long, recordings: Some("skin"), rows: skin::scores },
    Table { name: "skin-faces", page: "skin.md", cost: Cost::Cheap, recordings: Some("skin"), rows: skin::faces },
    Table {
        name: "body-figure-2",
        page: "measurements_body.md",
        cost: Cost::Cheap,
        recordings: None,
        rows: body::figure_2,
    },
    Table {
        name: "body-hdm05",
        page: "measurements_hidden.md",
        cost: Cost::Long,
        recordings: Some("mocap"),
        rows: body::hdm05,
    },
    Table { name: "tuning-body", page: "tuning.md", cost: Cost::Long, recordings: None, rows: body::tuning },
    Table {
        name: "body-builtin",
        page: "measurements_body.md",
        cost: Cost::Long,
        recordings: None,
        rows: body::built_in,
    },
    Table {
        name: "body-smoothness",
        page: "measurements_body.md",
        cost: Cost::Long,
        recordings: Some("mocap"),
        rows: body::smoothness,
    },
    Table {
        name: "body-hard",
        page: "measurements_scenes.md",
        cost: Cost::Long,
        recordings: Some("mocap"),
        rows: body_scenes::hard,
    },
    Table {
        name: "body-deadband",
        page: "measurements_scenes.md",
        cost: Cost::Long,
        recordings: Some("mocap"),
        rows: body_scenes::deadband,
    },
    Table {
        name: "body-hidden",
        page: "measurements_hidden.md",
        cost: Cost::Long,
        recordings: Some("mocap"),
        rows: body::hidden,
    },
    Table {
        name: "body-runners",
        page: "measurements_runners.md",
        cost: Cost::Long,
        recordings: Some("mocap"),
        rows: runners::runners,
    },
    Table {
        name: "cyclic-errors",
        page: "measurements_cyclic.md",
        cost: Cost::Cheap,
        recordings: Some("cyclic-walking"),
        rows: cyclic::errors,
    },
    Table {
        name: "cyclic-smoothing",
        page: "measurements_cyclic.md",
        cost: Cost::Cheap,
        recordings: Some("cyclic-walking"),
        rows: cyclic::smoothing,
    },
    Table {
        name: "recordings-tempo",
        page: "measurements_recordings.md",
        cost: Cost::Cheap,
        recordings: Some("mocap"),
        rows: recordings::tempo,
    },
    Table {
        name: "recordings-after",
        page: "measurements_recordings.md",
        cost: Cost::Cheap,
        recordings: Some("mocap"),
        rows: recordings::after,
    },
    Table {
        name: "arm-variants",
        page: "measurements_arm.md",
        cost: Cost::Long,
        recordings: Some("mocap"),
        rows: arm::variants,
    },
    Table {
        name: "arm-options",
        page: "measurements_arm.md",
        cost: Cost::Long,
        recordings: Some("mocap"),
        rows: arm::options,
    },
];
