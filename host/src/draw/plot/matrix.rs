//! A matrix of signed numbers as coloured squares.

use super::axis::plottable;
use super::figure::{INK, px, render, text};
use crate::error::{Result, ensure};
use image::RgbImage;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// Room left of the rows and above the columns for names, pixels.
const NAMES_PX: u32 = 170;
/// Side of the squares together, pixels.
const SQUARES_PX: u32 = 560;
/// Title and margin, pixels.
const TITLE_PX: u32 = 40;
/// Maximum number of rows of a plot.
const MAX_ROWS: usize = 100;
/// Colour of +1; white is zero.
const POSITIVE: [f64; 3] = [0.0, 72.0, 160.0];
/// Colour of -1.
const NEGATIVE: [f64; 3] = [200.0, 80.0, 0.0];

/// Plots `rows`, a square matrix with entries in [-1, 1], with `names` of rows and columns. Blue is
/// positive, orange negative, white zero. An entry beyond has the colour of its end, one that is
/// not finite is grey. Thick lines are drawn where a block of `blocks` rows each ends.
///
/// # Errors
/// There have to be 1 to 100 rows, each with a name and an entry for every column, and blocks that
/// cover no more.
pub fn matrix_plot(title: &str, names: &[&str], rows: &[Vec<f64>], blocks: &[usize]) -> Result<RgbImage> {
    let count = names.len();
    ensure!((1..=MAX_ROWS).contains(&count), "plot `{title}`: {count} rows; give 1 to {MAX_ROWS}");
    let square = rows.len() == count && rows.iter().all(|row| row.len() == count);
    ensure!(square, "plot `{title}`: the matrix has to have {count} rows and columns, one a name");
    ensure!(blocks.iter().sum::<usize>() <= count, "plot `{title}`: the blocks have more than {count} rows");
    let margin = 14;
    render(NAMES_PX + SQUARES_PX + margin, TITLE_PX + NAMES_PX + SQUARES_PX + margin, |area| {
        let corner = (px(NAMES_PX) as i32, px(TITLE_PX + NAMES_PX) as i32);
        let edge = |index: usize| (px(SQUARES_PX) as usize * index / count) as i32;
        let middle = |index: usize| (edge(index) + edge(index + 1)) / 2;
        area.draw(&Text::new(title, (px(8) as i32, px(8) as i32), text(19)))?;
        let size = (SQUARES_PX / count as u32).clamp(5, 13);
        for (index, name) in names.iter().enumerate() {
            let row = text(size).pos(Pos::new(HPos::Right, VPos::Center));
            area.draw(&Text::new(*name, (corner.0 - px(5) as i32, corner.1 + middle(index)), row))?;
            let column = text(size).transform(FontTransform::Rotate270).pos(Pos::new(HPos::Left, VPos::Center));
            area.draw(&Text::new(*name, (corner.0 + middle(index), corner.1 - px(5) as i32), column))?;
        }
        for (i, row) in rows.iter().enumerate() {
            for (j, &value) in row.iter().enumerate() {
                let (from, to) = ((edge(j), edge(i)), (edge(j + 1), edge(i + 1)));
                let place = |(x, y): (i32, i32)| (corner.0 + x, corner.1 + y);
                area.draw(&Rectangle::new([place(from), place(to)], colour(value).filled()))?;
            }
        }
        let mut end = 0;
        for &block in [0].iter().chain(blocks).chain([&count.saturating_sub(blocks.iter().sum())]) {
            end += block;
            let (at, far) = (edge(end), edge(count));
            for line in [[(at, 0), (at, far)], [(0, at), (far, at)]] {
                let line = line.map(|(x, y)| (corner.0 + x, corner.1 + y));
                area.draw(&PathElement::new(line, INK.stroke_width(px(1))))?;
            }
        }
        Ok(())
    })
}

fn colour(value: f64) -> RGBColor {
    if !plottable(value) {
        return RGBColor(160, 160, 160);
    }
    let (full, share) = (if value < 0.0 { NEGATIVE } else { POSITIVE }, value.abs().min(1.0));
    let [r, g, b] = full.map(|channel| (255.0 + share * (channel - 255.0)).round() as u8);
    RGBColor(r, g, b)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn squares_have_the_colour_of_their_sign() {
        let rows = [vec![1.0, -1.0], vec![0.0, 1.0]];
        let image = matrix_plot("two", &["a", "b"], &rows, &[1]).unwrap();
        let at = |row: u32, column: u32| {
            let place = |index: u32| SQUARES_PX * (2 * index + 1) / 4;
            image.get_pixel(NAMES_PX + place(column), TITLE_PX + NAMES_PX + place(row)).0
        };
        assert_eq!(at(0, 0), [0, 72, 160]);
        assert_eq!(at(0, 1), [200, 80, 0]);
        assert_eq!(at(1, 0), [255, 255, 255]);
    }

    #[test]
    fn what_is_no_square_matrix_is_refused() {
        let message = matrix_plot("odd", &["a", "b"], &[vec![1.0]], &[]).unwrap_err().to_string();
        assert!(message.contains("2 rows and columns"), "{message}");
        assert!(matrix_plot("none", &[], &[], &[]).is_err());
        assert!(matrix_plot("blocks", &["a"], &[vec![0.0]], &[2]).is_err());
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(16))]
        #[test]
        fn no_numbers_make_it_panic(values in prop::collection::vec(any::<f64>(), 9), name in ".{0,40}") {
            let rows: Vec<Vec<f64>> = values.chunks(3).map(<[f64]>::to_vec).collect();
            prop_assert!(matrix_plot(&name, &[name.as_str(); 3], &rows, &[1, 1]).is_ok());
        }
    }
}
