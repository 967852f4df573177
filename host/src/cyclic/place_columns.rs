//! Where a person was in the image, from the extra columns of an angle table: root, feet, lengths.

use super::angle_table::{ANGLES, AngleRow, AngleTable};
use super::facing::{FACING, Facing};
use super::feet::FOOT_POINTS;
use sinew_core::skeleton::stick_figure::HUMAN;

/// Places of columns in [`AngleRow::extra`].
#[derive(Debug, Clone, PartialEq)]
pub struct PlaceColumns {
    /// `px` or `m`.
    pub unit: &'static str,
    root: [usize; 2],
    lengths: [Option<usize>; ANGLES],
    feet: [Option<[usize; 2]>; 4],
    /// Column of which way the person faced.
    facing: Option<usize>,
}

impl PlaceColumns {
    /// `None` where the table does not say where the root was.
    #[must_use]
    pub fn find(table: &AngleTable) -> Option<Self> {
        let column = |name: &str| table.extra_columns().iter().position(|column| column == name);
        let point =
            |name: &str, unit: &str| Some([column(&format!("{name}_u_{unit}"))?, column(&format!("{name}_v_{unit}"))?]);
        ["px", "m"].into_iter().find_map(|unit| {
            let mut names = HUMAN.angle_names();
            Some(Self {
                unit,
                root: point("hip_center", unit)?,
                lengths: std::array::from_fn(|_| column(&format!("{}_length_{unit}", names.next()?))),
                feet: FOOT_POINTS.map(|name| point(name, unit)),
                facing: column(FACING),
            })
        })
    }

    /// Whether the table says which way the person faced.
    #[must_use]
    pub const fn has_facing(&self) -> bool {
        self.facing.is_some()
    }

    /// 1 where the image's x points forward, -1 where the person faced left.
    #[must_use]
    pub fn side(&self, row: &AngleRow) -> f64 {
        let cell = self.facing.and_then(|column| row.extra.get(column));
        if cell.is_some_and(|cell| cell == Facing::Left.name()) { Facing::Left.side() } else { Facing::Right.side() }
    }

    /// The root, forward and down.
    #[must_use]
    pub fn root(&self, row: &AngleRow) -> Option<[f64; 2]> {
        self.point(row, self.root)
    }

    /// A point of the foot from the root, forward and down; `foot_point` is a place in
    /// [`FOOT_POINTS`].
    #[must_use]
    pub fn foot_from_root(&self, row: &AngleRow, foot_point: usize) -> Option<[f64; 2]> {
        let [x, y] = self.point(row, self.feet[foot_point]?)?;
        let [root_x, root_y] = self.point(row, self.root)?;
        Some([x - root_x, y - root_y])
    }

    /// From the heel to the toe, forward and down; `side` is 0 for the left foot.
    #[must_use]
    pub fn heel_to_toe(&self, row: &AngleRow, side: usize) -> Option<[f64; 2]> {
        let [heel, toe] = [0, 1].map(|end| self.feet[2 * side + end]);
        let (heel, toe) = (self.point(row, heel?)?, self.point(row, toe?)?);
        Some([toe[0] - heel[0], toe[1] - heel[1]])
    }

    /// Length of a segment; `None` where it is missing or zero, which is no length.
    #[must_use]
    pub fn length(&self, row: &AngleRow, angle: usize) -> Option<f64> {
        number(row, self.lengths[angle]?).filter(|length| *length > 0.0)
    }

    /// A point, forward and down: x is turned for a person who faced left.
    fn point(&self, row: &AngleRow, columns: [usize; 2]) -> Option<[f64; 2]> {
        Some([self.side(row) * number(row, columns[0])?, number(row, columns[1])?])
    }
}

fn number(row: &AngleRow, column: usize) -> Option<f64> {
    row.extra.get(column)?.parse().ok().filter(|number: &f64| number.is_finite())
}
