//! What a page holds, as its script reads it.

use super::table::Table;
use serde::Serialize;

/// Value of the field `format`.
pub const FORMAT: &str = "sinew-report";

/// Everything of a page but its pictures' bytes.
#[derive(Debug, Clone, Serialize)]
pub struct Document {
    /// Always [`FORMAT`].
    pub format: &'static str,
    /// Version of the program that made the page.
    pub sinew_version: &'static str,
    /// The runs, side by side in this order.
    pub runs: Vec<Run>,
}

/// How much a notice matters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Level {
    /// Something that belongs to such a run is not there.
    Missing,
    /// Something may mislead.
    Warning,
    /// An input that the run left out.
    Skipped,
    /// Something that is good to know.
    Note,
}

/// What the reader has to know before looking at numbers.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Notice {
    /// How much it matters.
    pub level: Level,
    /// One sentence.
    pub text: String,
    /// The things it is about, one a line.
    pub items: Vec<String>,
}

/// A name and what it is.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Fact {
    /// The name.
    pub label: String,
    /// The value with its unit.
    pub value: String,
}

impl Fact {
    /// A fact.
    pub fn new(label: impl Into<String>, value: impl Into<String>) -> Self {
        Self { label: label.into(), value: value.into() }
    }
}

/// One run directory.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Run {
    /// The folder as it was given.
    pub name: String,
    /// What made it.
    pub kind: String,
    /// What is missing, was skipped, or may mislead; the weightiest first.
    pub notices: Vec<Notice>,
    /// The few numbers that sum it up.
    pub highlights: Vec<Fact>,
    /// What was run.
    pub facts: Vec<Fact>,
    /// Frames one after the other.
    pub player: Option<Player>,
    /// Plots, in the order of the page.
    pub plots: Vec<Plot>,
    /// Tables; plots take their values from them.
    pub tables: Vec<Table>,
    /// Pictures that stand still.
    pub pictures: Vec<StillPicture>,
}

/// Where a run's frames are shown.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Player {
    /// Number of each frame, in the order of time.
    pub frames: Vec<String>,
    /// Name of the table whose rows belong to the frames by their column `frame`.
    pub table: Option<String>,
    /// Frames in a second.
    pub rate_hz: Option<f64>,
    /// Block of the page that holds a picture, or nothing, for each frame.
    pub pictures: Option<String>,
    /// Skeletons that are drawn from numbers.
    pub figures: Vec<Figure>,
    /// Columns of the table that are shown beside the frame.
    pub shown: Vec<String>,
}

/// A skeleton drawn from columns of a table.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Figure {
    /// What is seen, and from where.
    pub title: String,
    /// Smallest x, smallest y, largest x, largest y of the drawing; from the places where there are
    /// none.
    pub bounds: Option<[f64; 4]>,
    /// Whether y points down.
    pub y_down: bool,
    /// The bones.
    pub bones: Vec<Bone>,
}

/// A line of a [`Figure`].
#[derive(Debug, Clone, Serialize)]
pub struct Bone {
    /// Table of the ends.
    pub table: String,
    /// What rows have to hold.
    pub only: Vec<[String; 2]>,
    /// Columns of the first end's x and y.
    pub from: [String; 2],
    /// Columns of the second end's x and y.
    pub to: [String; 2],
    /// Colour.
    pub colour: Colour,
    /// Whether it is what is true, not what was estimated.
    pub truth: bool,
}

/// Colours of the page by what they stand for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Colour {
    /// The person's left side.
    Left,
    /// The person's right side.
    #[default]
    Right,
    /// Neither side.
    Middle,
    /// First of several that belong to no side.
    C0,
    /// Second.
    C1,
    /// Third.
    C2,
    /// Fourth.
    C3,
    /// Fifth.
    C4,
    /// Sixth.
    C5,
    /// Seventh.
    C6,
}

impl Colour {
    /// The colour of the `index`-th of several; they repeat after seven.
    #[must_use]
    pub const fn nth(index: usize) -> Self {
        const ALL: [Colour; 7] = [Colour::C0, Colour::C1, Colour::C2, Colour::C3, Colour::C4, Colour::C5, Colour::C6];
        ALL[index % ALL.len()]
    }

    /// The colour of the side `left` or `right`, or of what begins with `l_` or `r_`; of neither
    /// for any other word.
    #[must_use]
    pub fn of_side(word: &str) -> Self {
        match word {
            "left" => Self::Left,
            "right" => Self::Right,
            _ if word.starts_with("l_") => Self::Left,
            _ if word.starts_with("r_") => Self::Right,
            _ => Self::Middle,
        }
    }
}

/// How a series is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Style {
    /// A line.
    #[default]
    Line,
    /// A line with its points.
    Points,
    /// A broken line: the truth, or what is compared with.
    Dashes,
    /// Points alone: what was measured.
    Dots,
    /// Bars, one for each row, named by x.
    Bars,
}

/// Axes with series.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Plot {
    /// Same for the same plot of another run; they stand beside each other with the same axes.
    pub id: String,
    /// Heading of the plots around it.
    pub group: String,
    /// What it shows.
    pub title: String,
    /// How to read it, one sentence.
    pub reading: String,
    /// Name and unit of x.
    pub x_label: String,
    /// Name and unit of y.
    pub y_label: String,
    /// Whether x is logarithmic.
    pub x_log: bool,
    /// Whether both axes have one scale and y points down, as in an image.
    pub image_axes: bool,
    /// Whether a point is a pair of values: the pointer finds it by both.
    pub pairs: bool,
    /// Whether zero belongs to the y axis.
    pub from_zero: bool,
    /// Whether x is the frame that the player shows.
    pub over_frames: bool,
    /// Smallest x, smallest y, largest x, largest y that are shown; from the values where there are
    /// none.
    pub bounds: Option<[f64; 4]>,
    /// What is drawn.
    pub series: Vec<Series>,
    /// Rows over which the ground is shaded.
    pub shades: Vec<Shade>,
}

/// One line of a plot: columns of a table.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Series {
    /// Name in the legend.
    pub name: String,
    /// The table.
    pub table: String,
    /// What rows have to hold.
    pub only: Vec<[String; 2]>,
    /// Column of x.
    pub x: String,
    /// Column of y.
    pub y: String,
    /// What an x of the table is multiplied by, 1 if it is zero.
    pub x_times: f64,
    /// What a y of the table is multiplied by, 1 if it is zero.
    pub y_times: f64,
    /// The band about the line.
    pub band: Option<Band>,
    /// How it is drawn.
    pub style: Style,
    /// Its colour.
    pub colour: Colour,
    /// A step of y at which the line breaks, as an angle's that wraps.
    pub breaks: Option<f64>,
}

/// A band about a line.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Band {
    /// So many of a column to each side.
    Around {
        /// The column.
        half: String,
        /// How many.
        times: f64,
    },
    /// From one column to another.
    Between {
        /// Column of the lower edge.
        low: String,
        /// Column of the upper edge.
        high: String,
    },
}

/// Rows over which the ground of a plot is shaded.
#[derive(Debug, Clone, Serialize)]
pub struct Shade {
    /// What they are.
    pub name: String,
    /// The table.
    pub table: String,
    /// Column of x.
    pub x: String,
    /// What an x of the table is multiplied by, 1 if it is zero.
    pub x_times: f64,
    /// What rows have to hold.
    pub only: Vec<[String; 2]>,
}

/// A picture that belongs to no frame.
#[derive(Debug, Clone, Serialize)]
pub struct StillPicture {
    /// Its file.
    pub name: String,
    /// Block of the page that holds it.
    pub block: String,
}
