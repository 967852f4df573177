//! Places that may be hands: ends of arms, and the thickest parts of objects.

use super::cells::{CellBox, GridSize, MAX_CELLS};
use super::ends::{Ends, ends};
use super::geodesic::{STRAIGHT, UNREACHED, spread};
use super::grid::CellGrid;
use super::head::{HeadBox, distance, is_head, shoulder};
use super::labels::{MAX_LABELS, label};
use super::place::{ArmEnd, HandPlace};
use crate::math::{max, min};
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
/// Longer objects are more than a hand.
const MIN_LENGTH: f32 = 1.2;
/// Thickest parts of an object that are looked at.
const MAX_PEAKS: usize = 5;
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

/// Working memory of a frame.
#[derive(Debug, Clone)]
pub(super) struct Maps {
    labels: [u8; MAX_CELLS],
    /// Chamfer distance to what is no skin; beyond the border the picture goes on.
    depths: [u16; MAX_CELLS],
    scratch: [u16; MAX_CELLS],
}

impl Maps {
    pub(super) const EMPTY: Self = Self { labels: [0; MAX_CELLS], depths: [0; MAX_CELLS], scratch: [0; MAX_CELLS] };
}

/// What is known of an object.
#[derive(Debug, Clone)]
struct Object {
    cells: u16,
    first: u16,
    within: [u8; 4],
    /// Of the places of its cells.
    sum: [f32; 2],
    to_shoulder: f32,
}

impl Object {
    const NONE: Self =
        Self { cells: 0, first: 0, within: [u8::MAX, u8::MAX, 0, 0], sum: [0.0; 2], to_shoulder: f32::INFINITY };

    fn add(&mut self, cell: usize, size: GridSize, at: [f32; 2]) {
        let (column, row) = size.place(cell);
        let [min_u, min_v, max_u, max_v] = &mut self.within;
        (*min_u, *max_u) = ((*min_u).min(column as u8), (*max_u).max(column as u8));
        (*min_v, *max_v) = ((*min_v).min(row as u8), (*max_v).max(row as u8));
        self.first = if self.cells == 0 { cell as u16 } else { self.first };
        self.cells += 1;
        self.sum = [self.sum[0] + at[0], self.sum[1] + at[1]];
        let to = |side| distance(at, shoulder(side));
        self.to_shoulder = min(self.to_shoulder, min(to(Side::Left), to(Side::Right)));
    }

    fn within(&self) -> CellBox {
        let [min_u, min_v, max_u, max_v] = self.within.map(usize::from);
        CellBox { columns: min_u..max_u + 1, rows: min_v..max_v + 1 }
    }
}

/// Finds the places of the frame that `grid` holds.
pub(super) fn places(grid: &CellGrid, head: HeadBox, maps: &mut Maps) -> Vec<HandPlace, MAX_FOUND> {
    let view = View { grid, head, width: head.width_px / grid.cell_px() as f32 };
    let size = grid.size();
    let is_work = |cell: usize| grid.is_skin(cell) && (!is_head(view.of_cell(cell)) || grid.is_unusual(cell));
    let count = label(size, is_work, &mut maps.labels);
    let mut objects = [const { Object::NONE }; MAX_LABELS + 1];
    for cell in 0..size.cells() {
        let label = maps.labels[cell];
        maps.depths[cell] = if label == 0 { 0 } else { UNREACHED };
        if label != 0 {
            objects[usize::from(label)].add(cell, size, view.of_cell(cell));
        }
    }
    spread(size, &CellBox::whole(size), |cell| maps.labels[cell] != 0, &mut maps.depths);
    let mut found = Vec::new();
    for (label, object) in objects.iter().enumerate().take(usize::from(count) + 1) {
        let area = f32::from(object.cells) / (view.width * view.width);
        if AREAS.contains(&area) && object.to_shoulder <= REACH {
            view.places_of(object, label as u8, area, maps, &mut found);
        }
    }
    found
}

/// One frame seen from the head.
struct View<'a> {
    grid: &'a CellGrid,
    head: HeadBox,
    /// Of the head, cells.
    width: f32,
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
    depth: u16,
}

impl View<'_> {
    /// A place in cells, relative to the head.
    fn relative(&self, place: [f32; 2]) -> [f32; 2] {
        self.head.relative(place.map(|at| at * self.grid.cell_px() as f32))
    }

    fn of_cell(&self, cell: usize) -> [f32; 2] {
        let (column, row) = self.grid.size().place(cell);
        self.relative([column as f32 + 0.5, row as f32 + 0.5])
    }

    fn places_of(&self, object: &Object, label: u8, area: f32, maps: &mut Maps, found: &mut Vec<HandPlace, MAX_FOUND>) {
        let (size, within, first) = (self.grid.size(), object.within(), found.len());
        let Maps { labels, depths, scratch } = maps;
        let inside = |cell: usize| labels[cell] == label;
        let mut add = |position: [f32; 2], end: Option<ArmEnd>| {
            if found.iter().skip(first).all(|other| distance(other.position, position) >= ONE_PLACE) {
                // What finds no room is the last of many specks.
                let _ = found.push(self.place(position, label, end, labels, depths));
            }
        };
        if area < MAX_AREA_OF_ARM {
            let start = (usize::from(object.first), self.width);
            let found = ends(size, &within, inside, start, scratch);
            self.places_at(&found).into_iter().flatten().for_each(|(position, end)| add(position, Some(end)));
        }
        let mut peaks: Vec<[f32; 2], MAX_PEAKS> = Vec::new();
        while !peaks.is_full() {
            let mut best = (None, (MIN_THICKNESS * self.width * f32::from(STRAIGHT)) as u16);
            for cell in within.cells(size).filter(|cell| inside(*cell)) {
                let is_free = |at| peaks.iter().all(|peak| distance(*peak, at) > BETWEEN_PEAKS);
                if depths[cell] > best.1 && is_free(self.of_cell(cell)) {
                    best = (Some(cell), depths[cell]);
                }
            }
            let Some(cell) = best.0 else { break };
            let _ = peaks.push(self.of_cell(cell));
            add(self.of_cell(cell), None);
        }
        if area < MAX_AREA_OF_HAND {
            add(object.sum.map(|sum| sum / f32::from(object.cells)), None);
        }
    }

    /// Both ends, if the object is longer than a hand.
    fn places_at(&self, found: &Ends) -> Option<[([f32; 2], ArmEnd); 2]> {
        let length = found.length / self.width;
        let [a, b] = found.places.map(|place| self.relative(place));
        (length > MIN_LENGTH).then_some([(a, ArmEnd { length, other: b }), (b, ArmEnd { length, other: a })])
    }

    fn place(&self, position: [f32; 2], object: u8, end: Option<ArmEnd>, labels: &[u8], depths: &[u16]) -> HandPlace {
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

    fn around(&self, position: [f32; 2], labels: &[u8], depths: &[u16]) -> Around {
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
