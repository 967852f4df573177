//! Distance transform of small masks: two passes of the 5-7-11 chamfer, and the cell where it is
//! greatest.

/// Columns of a [`CellRow`]: the bits of its integer.
pub const MAX_COLUMNS: usize = 128;
/// Distance of two cells side by side, in the unit of [`transform`].
pub const UNIT: i16 = 5;
/// Largest relative error of a distance against the Euclidean one (asserted by a test).
pub const MAX_RELATIVE_ERROR: f32 = 0.0204;

const DIAGONAL: i16 = 7;
const KNIGHT: i16 = 11;
/// Cells around each row that stand for what lies outside.
const BORDER: usize = 2;
/// Farther than any distance on the grid, and no sum with it overflows.
const FAR: i16 = 16_000;

/// A row of cells, cell 0 in the lowest bit.
///
/// ```
/// use sinew_core::vision::distance::{CellRow, EMPTY_ROW, at, transform};
///
/// // A plus of five cells; cell 0 is the lowest bit.
/// let plus: [CellRow; 3] = [0b010, 0b111, 0b010];
/// let mut distances = [EMPTY_ROW; 3];
/// transform(&plus, 3, true, &mut distances);
/// assert_eq!(
///     at(&distances, 1, 1),
///     7,
///     "from the middle to a corner: one diagonal, in fifths of a cell"
/// );
/// ```
pub type CellRow = u128;

/// Distances of one row of cells, with a border on both sides.
///
/// ```
/// use sinew_core::vision::distance::{
///     DistanceRow, EMPTY_ROW, MAX_COLUMNS, UNIT, at, transform,
/// };
///
/// // Working memory for a grid of twenty rows: a row of distances each, with a border.
/// let mut distances: [DistanceRow; 20] = [EMPTY_ROW; 20];
/// transform(&[1; 20], MAX_COLUMNS, false, &mut distances);
/// assert_eq!(at(&distances, 100, 19), 100 * UNIT, "from column 0 to column 100");
/// ```
pub type DistanceRow = [i16; MAX_COLUMNS + 2 * BORDER];

/// A row of distances before the transform.
pub const EMPTY_ROW: DistanceRow = [0; MAX_COLUMNS + 2 * BORDER];

/// Writes for each cell of the first `columns` of each row the distance to the nearest cell of the
/// other colour.
///
/// With `inside` the set cells get their distance to the nearest unset cell, without it the unset
/// cells get theirs to the nearest set cell. All cells outside of the grid count as unset. Cells of
/// the colour that is measured to get 0. The unit is a fifth of a cell. Rows beyond the shorter of
/// both slices are left out.
///
/// ```
/// use sinew_core::vision::distance::{EMPTY_ROW, UNIT, at, transform};
///
/// // A square of five by five cells; what lies outside of the grid is not set.
/// let mut distances = [EMPTY_ROW; 5];
/// transform(&[0b11111; 5], 5, true, &mut distances);
/// assert_eq!(at(&distances, 2, 2), 3 * UNIT);
/// assert_eq!(at(&distances, 0, 2), UNIT);
/// ```
pub fn transform(cells: &[CellRow], columns: usize, inside: bool, distances: &mut [DistanceRow]) {
    let columns = columns.min(MAX_COLUMNS);
    let outside = if inside { 0 } else { FAR };
    let edge = [outside; MAX_COLUMNS + 2 * BORDER];
    let len = cells.len().min(distances.len());
    let distances = &mut distances[..len];
    for (row, line) in cells.iter().zip(distances.iter_mut()) {
        *line = edge;
        let wanted = if inside { *row } else { !row };
        for (part, out) in line[BORDER..].chunks_mut(32).enumerate().take(columns.div_ceil(32)) {
            let bits = (wanted >> (32 * part)) as u32;
            for (i, d) in out.iter_mut().enumerate() {
                *d = FAR * (bits >> (i & 31) & 1) as i16;
            }
        }
        line[BORDER + columns..].fill(outside);
    }
    for v in 0..len {
        let (before, rest) = distances.split_at_mut(v);
        let Some(line) = rest.first_mut() else { break };
        let near = before.last().unwrap_or(&edge);
        let far = if v >= 2 { &before[v - 2] } else { &edge };
        relax_from_rows(line, near, far, columns);
        let mut last = outside;
        for d in &mut line[BORDER..BORDER + columns] {
            last = (*d).min(last + UNIT);
            *d = last;
        }
    }
    for v in (0..len).rev() {
        let (head, after) = distances.split_at_mut(v + 1);
        let Some(line) = head.last_mut() else { break };
        let near = after.first().unwrap_or(&edge);
        let far = after.get(1).unwrap_or(&edge);
        relax_from_rows(line, near, far, columns);
        let mut last = outside;
        for d in line[BORDER..BORDER + columns].iter_mut().rev() {
            last = (*d).min(last + UNIT);
            *d = last;
        }
    }
}

/// Lowers distances by what the rows one (`near`) and two (`far`) away allow.
#[inline]
fn relax_from_rows(line: &mut DistanceRow, near: &DistanceRow, far: &DistanceRow, columns: usize) {
    let out = &mut line[BORDER..BORDER + columns];
    let n = |shift: usize| &near[shift..shift + columns];
    let f = |shift: usize| &far[shift..shift + columns];
    let sides = n(0).iter().zip(n(1)).zip(n(2)).zip(n(3)).zip(n(4)).zip(f(1)).zip(f(3));
    for (d, ((((((l2, l1), m), r1), r2), f1), f3)) in out.iter_mut().zip(sides) {
        let knight = (*l2).min(*r2).min((*f1).min(*f3)) + KNIGHT;
        let diagonal = (*l1).min(*r1) + DIAGONAL;
        *d = (*d).min(knight).min(diagonal).min(*m + UNIT);
    }
}

/// Distance at a cell; 0 beyond the grid.
///
/// ```
/// use sinew_core::vision::distance::{EMPTY_ROW, UNIT, at, transform};
///
/// let mut distances = [EMPTY_ROW; 3];
/// transform(&[0b111; 3], 3, true, &mut distances);
/// assert_eq!(at(&distances, 1, 1), 2 * UNIT);
/// assert_eq!(at(&distances, 500, 1), 0, "beyond the grid");
/// ```
#[must_use]
pub fn at(distances: &[DistanceRow], u: usize, v: usize) -> i16 {
    if u >= MAX_COLUMNS {
        return 0;
    }
    distances.get(v).map_or(0, |line| line[BORDER + u])
}

/// The distances of one row's cells, without the border.
#[must_use]
pub(super) fn interior(line: &DistanceRow) -> &[i16; MAX_COLUMNS] {
    const EMPTY: &[i16; MAX_COLUMNS] = &[0; MAX_COLUMNS];
    line[BORDER..].first_chunk().unwrap_or(EMPTY)
}

/// The greatest distance and its cell (column, row); of several the one nearest to the point (`u`,
/// `v`).
///
/// ```
/// use sinew_core::vision::distance::{EMPTY_ROW, UNIT, greatest, transform};
///
/// // All of the middle row of a bar is as far from the outside; the cell nearest to (5.2, 0) is
/// // taken.
/// let mut distances = [EMPTY_ROW; 3];
/// transform(&[0x1ff; 3], 9, true, &mut distances);
/// assert_eq!(greatest(&distances, 9, 5.2, 0.0), (2 * UNIT, (5, 1)));
/// ```
#[must_use]
pub fn greatest(distances: &[DistanceRow], columns: usize, u: f32, v: f32) -> (i16, (usize, usize)) {
    let columns = columns.min(MAX_COLUMNS);
    let mut best = (0, f32::MAX, (0, 0));
    for (y, line) in distances.iter().enumerate() {
        let line = &line[BORDER..BORDER + columns];
        let top = line.iter().fold(0, |m, &d| if d > m { d } else { m });
        if top < best.0 || top == 0 {
            continue;
        }
        for (x, _) in line.iter().enumerate().filter(|&(_, &d)| d == top) {
            let (du, dv) = (x as f32 - u, y as f32 - v);
            let away = du * du + dv * dv;
            if top > best.0 || away < best.1 {
                best = (top, away, (x, y));
            }
        }
    }
    (best.0, best.2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn euclidean(cells: &[CellRow], columns: usize, u: usize, v: usize, inside: bool) -> Option<f32> {
        let (columns, rows) = (columns as i32, cells.len() as i32);
        let mut best: Option<f32> = None;
        for y in -1..=rows {
            for x in -1..=columns {
                let within = x >= 0 && y >= 0 && x < columns && y < rows;
                let set = within && cells[y as usize] >> x & 1 == 1;
                if set != inside {
                    let d = ((x - u as i32) as f32).hypot((y - v as i32) as f32);
                    best = Some(best.map_or(d, |b: f32| b.min(d)));
                }
            }
        }
        best
    }

    proptest! {
        #[test]
        fn distances_stay_within_the_stated_error(
            cells in prop::collection::vec(any::<[u32; 5]>(), 1..30), columns in 1_usize..32, sparse: bool, inside: bool,
        ) {
            let sparse = sparse == inside;
            let rows: Vec<CellRow> = cells.iter().map(|w| {
                let few = w[0] & w[1] & w[2] & w[3] & w[4];
                u128::from(if sparse { !few } else { few }) & ((1 << columns) - 1)
            }).collect();
            let mut distances = vec![EMPTY_ROW; rows.len()];
            transform(&rows, columns, inside, &mut distances);
            for v in 0..rows.len() {
                for u in 0..columns {
                    let d = f32::from(at(&distances, u, v)) / f32::from(UNIT);
                    match euclidean(&rows, columns, u, v, inside) {
                        Some(exact) => prop_assert!((d - exact).abs() <= MAX_RELATIVE_ERROR * exact + 1.0e-5, "{d} {exact}"),
                        None => prop_assert!(d > 300.0),
                    }
                }
            }
        }
    }

    #[test]
    fn the_stated_error_is_reached() {
        let mut distances = vec![EMPTY_ROW; 100];
        let mut rows = vec![0; 100];
        rows[0] = 1;
        transform(&rows, 100, false, &mut distances);
        let cells = (0..100).flat_map(|v| (0..100).map(move |u| (u, v))).skip(1);
        let errors = cells
            .map(|(u, v)| (f32::from(at(&distances, u, v)) / f32::from(UNIT) / (u as f32).hypot(v as f32) - 1.0).abs());
        let worst = errors.fold(0.0, f32::max);
        assert!((0.0198..=MAX_RELATIVE_ERROR).contains(&worst), "{worst}");
    }

    #[test]
    fn of_equal_maxima_the_one_nearest_to_the_point_is_taken() {
        let rows = [0x1ff; 3];
        let mut distances = vec![EMPTY_ROW; 3];
        transform(&rows, 9, true, &mut distances);
        assert_eq!(greatest(&distances, 9, 5.2, 0.0), (2 * UNIT, (5, 1)));
    }
}
