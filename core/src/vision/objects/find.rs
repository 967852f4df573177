//! Places that may be hands: ends of arms, and the thickest parts of objects.

use super::cells::CellBox;
use super::ends::{Ends, HAND_LENGTH, ends};
use super::geodesic::{Length, STRAIGHT, spread};
use super::grid::CellGrid;
use super::head::{HeadBox, distance, is_head, shoulder};
use super::labels::label;
use super::object_table::{Object, measure, measured};
use super::place::{ArmEnd, HandPlace};
use crate::math::max;
use crate::skeleton::Side;
use core::ops::RangeInclusive;
use heapless::Vec;

/// Most places of a frame before the likeliest are chosen.
pub(super) const MAX_FOUND: usize = 32;
/// Areas of objects that may hold a hand, squared widths of the face: from fingers to both arms.
const AREAS: RangeInclusive<f32> = 0.06..=8.0;
/// An object's nearest cell lies within this of a shoulder: an arm's length.
const REACH: f32 = 4.8;
/// Objects above this area are no single arm.
const MAX_AREA_OF_ARM: f32 = 5.0;
/// Half thickness of a hand in front of the face, where its own is not seen. Chosen: a hand's in
/// sight.
const THICKNESS_IN_FRONT_OF_FACE: f32 = 0.25;
/// Its fill, likewise. Chosen: 0.7 to 0.9 tried on the clips; with 0.7 it loses to the elbow, with
/// 0.9 faces are taken for hands.
const FILL_IN_FRONT_OF_FACE: f32 = 0.8;
/// A hand in front of the face is so far beyond the middle of the arm's last cells. Chosen: 0.8 and
/// 1.2 tried on the clips, both with a share of 0.01 less on a hand.
const BEYOND_END: f32 = 1.0;
/// Longer objects are more than a hand.
const MIN_LENGTH: f32 = 1.2;
/// Thickest parts of an object that are looked at.
const MAX_PEAKS: usize = 5;
/// Both ends, the thickest parts and the middle.
const MAX_SPOTS: usize = 2 + MAX_PEAKS + 1;
/// Least half thickness of a hand.
const MIN_THICKNESS: f32 = 0.1;
/// Two thickest parts are at least so far apart: half a hand.
const BETWEEN_PEAKS: f32 = 0.45;
/// Objects of less area have their middle as a place, too.
const MAX_AREA_OF_HAND: f32 = 1.2;
/// Places nearer than this are one.
const ONE_PLACE: f32 = 0.2;
/// Radius of a hand.
pub(super) const HAND_RADIUS: f32 = 0.4;
/// Radius of a hand and of what its motion covers and uncovers.
const AROUND: f32 = 0.6;

/// Relative to the centre of the face, in its widths.
type Position = [f32; 2];

/// Working memory of a frame.
#[derive(Debug, Clone)]
pub(super) struct Maps<const COLUMNS: usize, const ROWS: usize> {
    labels: [[u8; COLUMNS]; ROWS],
    /// Chamfer distance to what is no skin; beyond the border the picture goes on.
    depths: [[u8; COLUMNS]; ROWS],
    scratch: [[u16; COLUMNS]; ROWS],
}

impl<const COLUMNS: usize, const ROWS: usize> Maps<COLUMNS, ROWS> {
    pub(super) const EMPTY: Self =
        Self { labels: [[0; COLUMNS]; ROWS], depths: [[0; COLUMNS]; ROWS], scratch: [[0; COLUMNS]; ROWS] };
}

/// Those of a grid of any capacity.
struct Layers<'a> {
    labels: &'a mut [u8],
    depths: &'a mut [u8],
    /// The objects first, and then distances along each.
    scratch: &'a mut [u16],
}

/// Adds the places of the frame that `grid` holds to `found`.
#[inline(never)]
pub(super) fn places<const COLUMNS: usize, const ROWS: usize>(
    grid: &CellGrid<COLUMNS, ROWS>,
    head: HeadBox,
    maps: &mut Maps<COLUMNS, ROWS>,
    found: &mut Vec<HandPlace, MAX_FOUND>,
) {
    let mut maps = Layers {
        labels: maps.labels.as_flattened_mut(),
        depths: maps.depths.as_flattened_mut(),
        scratch: maps.scratch.as_flattened_mut(),
    };
    let view = View { grid, head, width: head.width_px / grid.cell_px() as f32 };
    let size = grid.size();
    let is_work = |cell: usize| grid.is_skin(cell) && (!is_head(view.of_cell(cell)) || grid.is_unusual(cell));
    let count = label(size, is_work, maps.labels);
    for (depth, label) in maps.depths.iter_mut().zip(maps.labels.iter()) {
        *depth = if *label == 0 { 0 } else { u8::UNREACHED };
    }
    spread(size, &CellBox::whole(size), |cell| maps.labels[cell] != 0, maps.depths);
    let mut objects: Vec<Object, MAX_FOUND> = Vec::new();
    measure(size, maps.labels, maps.scratch);
    for object in measured(count, maps.scratch) {
        // Each has a place, and more than have room are not looked for.
        if view.may_have_hand(&object, maps.labels) && objects.push(object).is_err() {
            break;
        }
    }
    objects.iter().for_each(|object| view.places_of(object, &mut maps, found));
}

/// One frame seen from the head.
struct View<'a, const COLUMNS: usize, const ROWS: usize> {
    grid: &'a CellGrid<COLUMNS, ROWS>,
    head: HeadBox,
    /// Of the head, cells.
    width: f32,
}

/// Where a hand may be in an object.
#[derive(Clone, Copy)]
struct Spot {
    /// Where its fill, thickness and motion are seen.
    seen: Position,
    /// The end of an arm that it is, if it is one.
    end: Option<ArmEnd>,
    /// Where the hand is, if that is in front of the face.
    in_front_of_face: Option<Position>,
}

/// Where the hand is whose arm ends at `end`, if it is in front of the face: no cell is its own
/// there, since those of the head belong to no object. Then it is beyond the end, away from the
/// `other`.
#[inline(never)]
fn in_front_of_face(end: Position, other: Position) -> Option<Position> {
    let per_width = 1.0 / max(distance(end, other), ONE_PLACE);
    let direction = [per_width * (end[0] - other[0]), per_width * (end[1] - other[1])];
    let beyond = |by: f32| [end[0] + by * direction[0], end[1] + by * direction[1]];
    is_head(beyond(HAND_LENGTH)).then(|| beyond(BEYOND_END))
}

/// Shares around a place.
#[derive(Default)]
struct Around {
    cells: f32,
    moving: f32,
    near: f32,
    objects: f32,
    skin: f32,
    new: f32,
    depth: u8,
}

impl<const COLUMNS: usize, const ROWS: usize> View<'_, COLUMNS, ROWS> {
    /// A place in cells, relative to the head.
    #[inline(always)]
    fn relative(&self, place: [f32; 2]) -> [f32; 2] {
        self.head.relative(place.map(|at| at * self.grid.cell_px() as f32))
    }

    #[inline(always)]
    fn of_cell(&self, cell: usize) -> [f32; 2] {
        let (column, row) = self.grid.size().place(cell);
        self.relative([column as f32 + 0.5, row as f32 + 0.5])
    }

    /// Area of an object, squared widths of the face.
    fn area(&self, object: &Object) -> f32 {
        f32::from(object.cells) / (self.width * self.width)
    }

    /// Where the cells of an object are.
    fn positions(&self, object: &Object, labels: &[u8]) -> impl Iterator<Item = [f32; 2]> {
        let (size, label) = (self.grid.size(), object.label);
        object.within().cells(size).filter(move |cell| labels[*cell] == label).map(|cell| self.of_cell(cell))
    }

    /// Whether an object has the size of hands and arms, and is within reach.
    fn may_have_hand(&self, object: &Object, labels: &[u8]) -> bool {
        let is_near = |at| [Side::Left, Side::Right].iter().any(|side| distance(at, shoulder(*side)) <= REACH);
        AREAS.contains(&self.area(object)) && self.positions(object, labels).any(is_near)
    }

    #[inline(never)]
    fn places_of(&self, object: &Object, maps: &mut Layers<'_>, found: &mut Vec<HandPlace, MAX_FOUND>) {
        let (label, first) = (object.label, found.len());
        let mut spots = Vec::new();
        self.spots_of(object, maps, &mut spots);
        for &Spot { seen, end, in_front_of_face } in &spots {
            let position = in_front_of_face.unwrap_or(seen);
            if found.iter().skip(first).all(|other| distance(other.position, position) >= ONE_PLACE) {
                let mut place = self.place(seen, label, end, maps.labels, maps.depths);
                if in_front_of_face.is_some() {
                    (place.thickness, place.fill) = (THICKNESS_IN_FRONT_OF_FACE, FILL_IN_FRONT_OF_FACE);
                }
                // What finds no room is the last of many specks.
                let _ = found.push(HandPlace { position, ..place });
            }
        }
    }

    /// Both ends of an object, its thickest parts, and its middle; there is room for all.
    #[inline(never)]
    fn spots_of(&self, object: &Object, maps: &mut Layers<'_>, spots: &mut Vec<Spot, MAX_SPOTS>) {
        let (size, within, area) = (self.grid.size(), object.within(), self.area(object));
        let Layers { labels, depths, scratch } = maps;
        let inside = |cell: usize| labels[cell] == object.label;
        if area < MAX_AREA_OF_ARM {
            let start = (usize::from(object.first), self.width);
            self.add_ends(&ends(size, &within, inside, start, scratch), spots);
        }
        let inner = |seen| Spot { seen, end: None, in_front_of_face: None };
        let (ends, least) = (spots.len(), (MIN_THICKNESS * self.width * f32::from(STRAIGHT)) as u8);
        for _ in 0..MAX_PEAKS {
            let mut best = (None, least);
            for cell in within.cells(size).filter(|cell| inside(*cell)) {
                let is_free = |at| spots.iter().skip(ends).all(|peak| distance(peak.seen, at) > BETWEEN_PEAKS);
                if depths[cell] > best.1 && is_free(self.of_cell(cell)) {
                    best = (Some(cell), depths[cell]);
                }
            }
            let Some(cell) = best.0 else { break };
            let _ = spots.push(inner(self.of_cell(cell)));
        }
        if area < MAX_AREA_OF_HAND {
            let sum = self.positions(object, labels).fold([0.0; 2], |[u, v], at| [u + at[0], v + at[1]]);
            let _ = spots.push(inner(sum.map(|sum| sum / f32::from(object.cells))));
        }
    }

    /// Both ends, if the object is longer than a hand. An arm whose hand is in front of the face is
    /// longer by a hand than what is seen of it.
    fn add_ends(&self, found: &Ends, spots: &mut Vec<Spot, MAX_SPOTS>) {
        let mut length = found.length / self.width;
        if length <= MIN_LENGTH {
            return;
        }
        let [a, b] = found.places.map(|place| self.relative(place));
        let hidden = [in_front_of_face(a, b), in_front_of_face(b, a)];
        for _ in hidden.iter().flatten() {
            length += HAND_LENGTH;
        }
        for (index, seen) in [a, b].into_iter().enumerate() {
            let end = ArmEnd { length, other: hidden[1 - index].unwrap_or([b, a][index]) };
            let _ = spots.push(Spot { seen, end: Some(end), in_front_of_face: hidden[index] });
        }
    }

    #[inline(never)]
    fn place(&self, position: [f32; 2], object: u8, end: Option<ArmEnd>, labels: &[u8], depths: &[u8]) -> HandPlace {
        let around = self.around(position, labels, depths);
        let share = |part: f32, of: f32| if of > 0.0 { part / of } else { 0.0 };
        HandPlace {
            position,
            object,
            thickness: f32::from(around.depth) / f32::from(STRAIGHT) / self.width,
            fill: share(around.objects, around.near),
            moving: share(around.moving, around.cells),
            new: share(around.new, around.skin),
            end,
        }
    }

    #[inline(never)]
    fn around(&self, position: [f32; 2], labels: &[u8], depths: &[u8]) -> Around {
        let size = self.grid.size();
        let centre = self.head.place_px(position).map(|at| at / self.grid.cell_px() as f32 - 0.5);
        let [reach, near] = [AROUND, HAND_RADIUS].map(|radius| radius * self.width);
        let range = |middle: f32, end: usize| {
            (max(middle - reach, 0.0) as usize).min(end)..(max(middle + reach + 1.0, 0.0) as usize).min(end)
        };
        let cells = CellBox { columns: range(centre[0], size.columns), rows: range(centre[1], size.rows) };
        let count = |it: bool| if it { 1.0 } else { 0.0 };
        let mut around = Around::default();
        for cell in cells.cells(size) {
            let (column, row) = size.place(cell);
            let (du, dv) = (column as f32 - centre[0], row as f32 - centre[1]);
            let squared = du * du + dv * dv;
            if squared > reach * reach {
                continue;
            }
            around.cells += 1.0;
            around.moving += count(self.grid.is_moving(cell));
            if squared <= near * near {
                around.near += 1.0;
                around.objects += count(labels[cell] != 0);
                around.skin += count(self.grid.is_skin(cell));
                around.new += count(self.grid.is_new(cell));
            }
            if squared <= 0.5 {
                around.depth = around.depth.max(depths[cell]);
            }
        }
        around
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Places of a forearm below the face, from row `top` on; each pixel is a cell.
    fn places_of_forearm(top: usize) -> Vec<HandPlace, MAX_FOUND> {
        let mut grid = CellGrid::<80, 60>::new(80, 60).unwrap();
        grid.begin();
        for row in 0..60 {
            let columns = if (8..25).contains(&row) {
                35..45
            } else if row >= top {
                37..43
            } else {
                0..0
            };
            let mut bits = [0_u32; 3];
            columns.for_each(|column: usize| bits[column / 32] |= 1 << (column % 32));
            grid.line(row, &bits, &[100; 80], 1);
        }
        grid.end();
        let (mut maps, mut found) = (Maps::EMPTY, Vec::new());
        places(&grid, HeadBox { centre_px: [40.0, 15.0], width_px: 12.0 }, &mut maps, &mut found);
        found
    }

    #[test]
    fn a_hand_whose_arm_ends_at_the_face_is_before_it() {
        let found = places_of_forearm(27);
        let hidden = found.iter().find(|place| is_head(place.position)).unwrap();
        assert!(hidden.position[0].abs() < 0.05 && (0.2..0.6).contains(&hidden.position[1]), "{hidden:?}");
        let end = hidden.end.unwrap();
        assert!(end.length > (60.0 - 27.0 - 2.0) / 12.0 + HAND_LENGTH && end.other[1] > 3.0, "{end:?}");
        assert_eq!((hidden.fill, hidden.thickness), (FILL_IN_FRONT_OF_FACE, THICKNESS_IN_FRONT_OF_FACE));
        // One that ends before the chin is where it is seen.
        assert!(places_of_forearm(36).iter().all(|place| !is_head(place.position)));
    }
}
