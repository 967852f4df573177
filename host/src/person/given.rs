//! Hands and faces that another program found, as tables.

use crate::csv_text::headed_reader;
use crate::error::{Context, Result, ensure};
use crate::file::read_lines;
use serde::Deserialize;
use serde::de::DeserializeOwned;
use sinew_core::camera::Pixel;
use sinew_core::ranges::is_pixel;
use sinew_core::skeleton::Side;
use sinew_core::vision::candidate::HandCandidate;
use sinew_core::vision::objects::head::HeadBox;
use std::collections::BTreeMap;
use std::f32::consts::PI;
use std::path::Path;

/// Columns of a table of hands.
const HAND_COLUMNS: &str = "frame,u_px,v_px,size_px,probability and, if it is known, side (left or right)";
/// Columns of a table of faces.
const FACE_COLUMNS: &str = "frame,u_px,v_px,size_px";
/// A table all of whose places lie this near to the upper left corner, in both coordinates, is one
/// of shares of the picture. Chosen: detectors guess places up to half a picture outside of it, and
/// no hand or face keeps within two pixels of the corner.
const MAX_SHARE: f32 = 1.5;

#[derive(Debug, Deserialize)]
struct HandRow {
    frame: usize,
    u_px: f32,
    v_px: f32,
    size_px: f32,
    probability: f32,
    #[serde(default)]
    side: Option<GivenSide>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
enum GivenSide {
    Left,
    Right,
}

#[derive(Debug, Deserialize)]
struct FaceRow {
    frame: usize,
    u_px: f32,
    v_px: f32,
    size_px: f32,
}

/// A hand that another program found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GivenHand {
    /// Middle of the hand, pixels.
    pub centre: Pixel,
    /// Its diameter, pixels.
    pub size_px: f32,
    /// That it is a hand, 0..=1.
    pub probability: f32,
    /// Whose it is, where that is known.
    pub side: Option<Side>,
}

impl GivenHand {
    /// The candidate that a tracker takes in place of a blob.
    ///
    /// # Errors
    /// The rule that it breaks, after what `name` says.
    pub fn candidate(&self, name: &dyn Fn() -> String) -> Result<HandCandidate> {
        let Self { centre, size_px, probability, .. } = *self;
        check(centre, size_px, name)?;
        ensure!(
            (0.0..=1.0).contains(&probability),
            "{}: `probability` has to lie from 0 to 1, not {probability}",
            name()
        );
        let variance_px2 = size_px * size_px / 16.0;
        let area_px = 0.25 * PI * size_px * size_px;
        Ok(HandCandidate { centre, moments_px2: [variance_px2, 0.0, variance_px2], area_px, likelihood: probability })
    }
}

/// Hands of one frame.
#[derive(Debug, Clone, PartialEq)]
pub enum GivenHands {
    /// Their sides may be known: candidates of the left and of the right hand. A hand without a
    /// side is a candidate of both.
    OfSides([Vec<HandCandidate>; 2]),
    /// No side is.
    OfPerson(Vec<HandCandidate>),
}

impl GivenHands {
    /// The hands of a frame, each with its side.
    #[must_use]
    pub fn of_frame(hands: &[(Option<Side>, HandCandidate)], has_sides: bool) -> Self {
        let of = |wanted: Side| {
            let own = hands.iter().filter(|(side, _)| side.is_none_or(|side| side == wanted));
            own.map(|(_, candidate)| *candidate).collect()
        };
        match has_sides {
            true => Self::OfSides([of(Side::Left), of(Side::Right)]),
            false => Self::OfPerson(hands.iter().map(|(_, candidate)| *candidate).collect()),
        }
    }
}

/// A face that another program found: its middle and the width of its box, pixels.
///
/// # Errors
/// The rule that it breaks, after what `name` says.
pub fn given_head(centre: Pixel, width_px: f32, name: &dyn Fn() -> String) -> Result<HeadBox> {
    check(centre, width_px, name)?;
    Ok(HeadBox { centre_px: [centre.u_px, centre.v_px], width_px })
}

/// A table of hands, the candidates of a tracker in place of blobs.
#[derive(Debug, Clone, PartialEq)]
pub struct HandTable {
    has_sides: bool,
    frames: BTreeMap<usize, Vec<(Option<Side>, HandCandidate)>>,
}

impl HandTable {
    /// Reads a table with the columns frame, u_px, v_px, size_px, probability and side. Frames
    /// count from 0. The middle of the hand is u_px, v_px, and its diameter is size_px. The
    /// probability is that it is a hand, 0 to 1, and the side is left, right or empty.
    ///
    /// # Errors
    /// Names the file, the row and the rule that it broke. Places are shares of the picture.
    pub fn read(path: &Path) -> Result<Self> {
        let mut table = Self { has_sides: false, frames: BTreeMap::new() };
        let rows = rows::<HandRow>(path, "hands", HAND_COLUMNS)?;
        refuse_shares(rows.iter().map(|row| [row.u_px, row.v_px]), &format!("hands `{}`", path.display()))?;
        for row in rows {
            let name = || format!("hands `{}`, frame {}", path.display(), row.frame);
            let side = row.side.map(|side| if side == GivenSide::Left { Side::Left } else { Side::Right });
            let (centre, size_px, probability) = (Pixel::new(row.u_px, row.v_px), row.size_px, row.probability);
            let candidate = GivenHand { centre, size_px, probability, side }.candidate(&name)?;
            table.has_sides |= side.is_some();
            table.frames.entry(row.frame).or_default().push((side, candidate));
        }
        Ok(table)
    }

    /// Refuses a table that counts the frames of a run over `frames` of them from 1; `path` is the
    /// file.
    ///
    /// # Errors
    /// Names the file and the frames.
    pub fn check_frames(&self, frames: usize, path: &Path) -> Result<()> {
        check_origin(&self.frames, frames, path, "hands")
    }

    /// The hands of a frame.
    #[must_use]
    pub fn at(&self, frame: usize) -> GivenHands {
        let hands = self.frames.get(&frame).map_or(&[][..], Vec::as_slice);
        GivenHands::of_frame(hands, self.has_sides)
    }
}

/// A table of faces; without a row by default.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FaceTable(BTreeMap<usize, HeadBox>);

impl FaceTable {
    /// Reads a table with the columns frame (from 0), u_px, v_px (the middle of the face), size_px
    /// (the width of its box). A frame has one row at most.
    ///
    /// # Errors
    /// Names the file, the row and the rule that it broke. Places are shares of the picture.
    pub fn read(path: &Path) -> Result<Self> {
        let rows = rows::<FaceRow>(path, "head", FACE_COLUMNS)?;
        refuse_shares(rows.iter().map(|row| [row.u_px, row.v_px]), &format!("head `{}`", path.display()))?;
        let mut faces = BTreeMap::new();
        for row in rows {
            let name = || format!("head `{}`, frame {}", path.display(), row.frame);
            let head = given_head(Pixel::new(row.u_px, row.v_px), row.size_px, &name)?;
            let is_only = faces.insert(row.frame, head).is_none();
            ensure!(is_only, "{}: it has several rows; keep that of the person who is tracked", name());
        }
        Ok(Self(faces))
    }

    /// Refuses a table that counts the frames of a run over `frames` of them from 1; `path` is the
    /// file.
    ///
    /// # Errors
    /// Names the file and the frames.
    pub fn check_frames(&self, frames: usize, path: &Path) -> Result<()> {
        check_origin(&self.0, frames, path, "head")
    }

    /// The face of a frame.
    #[must_use]
    pub fn at(&self, frame: usize) -> Option<HeadBox> {
        self.0.get(&frame).copied()
    }
}

/// All rows, at least one.
fn rows<R: DeserializeOwned>(path: &Path, what: &str, columns: &str) -> Result<Vec<R>> {
    let text =
        read_lines(path).with_context(|| format!("{what} `{}` cannot be read; check the path", path.display()))?;
    let rows: Vec<R> = headed_reader(&text).deserialize().collect::<Result<_, _>>().with_context(|| {
        format!("{what} `{}` cannot be read; give a table with the columns {columns}", path.display())
    })?;
    ensure!(!rows.is_empty(), "{what} `{}` has no row; give the columns {columns}", path.display());
    Ok(rows)
}

/// Refuses places that are shares of the picture: in pixels all would be in its corner.
///
/// # Errors
/// They are; the message begins with `what`.
pub fn refuse_shares(mut places: impl Iterator<Item = [f32; 2]>, what: &str) -> Result<()> {
    let are_shares = places.all(|place| place.iter().all(|coordinate| coordinate.abs() <= MAX_SHARE));
    ensure!(
        !are_shares,
        "{what} holds shares of the picture (no place is beyond {MAX_SHARE}), and pixels are wanted; multiply \
         `u_px` and `size_px` by the picture's width, `v_px` by its height"
    );
    Ok(())
}

/// A table whose first row is not of frame 0, and whose last is of the frame behind the last one,
/// counts from 1. Rows farther behind are of a longer recording, and are not used.
fn check_origin<T>(table: &BTreeMap<usize, T>, frames: usize, path: &Path, what: &str) -> Result<()> {
    let [first, last] = [table.keys().next(), table.keys().next_back()].map(|frame| frame.copied().unwrap_or(0));
    ensure!(
        first == 0 || last != frames,
        "{what} `{}` has rows for frames {first} to {last}, and the last of {frames} frames is {}; count frames from 0",
        path.display(),
        frames.saturating_sub(1)
    );
    Ok(())
}

fn check(centre: Pixel, size_px: f32, name: &dyn Fn() -> String) -> Result<()> {
    let (u_px, v_px) = (centre.u_px, centre.v_px);
    ensure!(is_pixel(u_px) && is_pixel(v_px), "{}: ({u_px}, {v_px}) is no place near a picture", name());
    ensure!(is_pixel(size_px) && size_px > 0.0, "{}: `size_px` has to be above zero, not {size_px}", name());
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hands(text: &str) -> Result<HandTable> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("hands.csv");
        std::fs::write(&path, text).unwrap();
        HandTable::read(&path)
    }

    #[test]
    fn hands_come_by_frame_and_by_side() {
        let table = hands("frame,u_px,v_px,size_px,probability\n3,10,20,8,0.9\n3,50,20,8,0.4\n").unwrap();
        let GivenHands::OfPerson(of_3) = table.at(3) else { panic!("it has no sides") };
        assert_eq!((of_3[0].centre, of_3[1].likelihood), (Pixel::new(10.0, 20.0), 0.4));
        assert!((of_3[0].area_px - 16.0 * PI).abs() < 1e-3);
        assert_eq!(table.at(2), GivenHands::OfPerson(Vec::new()));
        let rows = "side,probability,frame,u_px,v_px,size_px\nleft,1,0,1,2,3\n,1,0,4,5,6\nright,1,0,7,8,9\n";
        let GivenHands::OfSides(of_0) = hands(rows).unwrap().at(0) else { panic!("it has sides") };
        let u_px = of_0.map(|hand| hand.iter().map(|candidate| candidate.centre.u_px).collect::<Vec<_>>());
        assert_eq!(u_px, [vec![1.0, 4.0], vec![4.0, 7.0]]);
    }

    #[test]
    fn a_table_that_breaks_a_rule_is_refused_by_it() {
        let refused = |row: &str, part: &str| {
            let text = format!("frame,u_px,v_px,size_px,probability\n{row}\n");
            let message = hands(&text).unwrap_err().to_string();
            assert!(message.contains(part), "{message}");
        };
        refused("0,1,2,0,1", "`size_px` has to be above zero, not 0");
        refused("4,1,2,3,1.5", "frame 4: `probability` has to lie from 0 to 1, not 1.5");
        refused("0,inf,2,3,1", "(inf, 2) is no place near a picture");
        refused("-1,1,2,3,1", "frame,u_px,v_px,size_px,probability");
        refused("", "has no row");
        refused("0,0.66,0.98,0.09,1\n1,1.2,-0.1,0.09,1", "multiply `u_px` and `size_px` by the picture's width");
        assert!(hands("frame,u_px\n0,1\n").unwrap_err().to_string().contains("size_px"));
    }

    #[test]
    fn frames_count_from_0() {
        let table = hands("frame,u_px,v_px,size_px,probability\n11,10,20,8,0.9\n3,0.5,0.5,8,0.4\n").unwrap();
        let path = Path::new("hands.csv");
        table.check_frames(12, path).unwrap();
        table.check_frames(5, path).unwrap();
        let message = table.check_frames(11, path).unwrap_err().to_string();
        assert!(
            message.contains("`hands.csv` has rows for frames 3 to 11, and the last of 11 frames is 10"),
            "{message}"
        );
    }

    #[test]
    fn a_frame_has_one_face() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("head.csv");
        let read = |rows: &str| {
            std::fs::write(&path, format!("frame,u_px,v_px,size_px\n{rows}")).unwrap();
            FaceTable::read(&path)
        };
        read("0,200,100,50\n2,200,100,50\n").unwrap().check_frames(3, &path).unwrap();
        for (rows, part) in [
            ("0,200,100,50\n0,300,100,50\n", "frame 0: it has several rows"),
            ("0,0.5,0.25,0.1\n", "multiply `u_px` and `size_px`"),
        ] {
            let message = read(rows).unwrap_err().to_string();
            assert!(message.contains(part) && message.contains("head.csv"), "{message}");
        }
        assert!(read("3,200,100,50\n").unwrap().check_frames(3, &path).is_err());
    }
}
