//! Clouds as tables: a header that names `x_m`, `y_m` and `z_m` (or `x`, `y` and `z`), then a row
//! for each point.

use super::point_cloud::PointCloud;
use csv::{ByteRecord, ReaderBuilder, Trim};
use sinew_core::math::Vec3;

/// Reads the points of a CSV file's content. Further columns are passed over; an empty or NaN cell
/// is a coordinate that was not measured, so its point is counted as skipped.
///
/// # Errors
/// The rule that the content breaks.
pub fn parse(bytes: &[u8]) -> Result<PointCloud, String> {
    let mut reader = ReaderBuilder::new().trim(Trim::All).from_reader(bytes);
    let headers = reader.headers().map_err(|error| error.to_string())?;
    let names: Vec<String> = headers.iter().map(str::to_ascii_lowercase).collect();
    let column = |wanted: String| names.iter().position(|name| *name == wanted);
    let columns = |unit: &str| match ["x", "y", "z"].map(|axis| column(format!("{axis}{unit}"))) {
        [Some(x), Some(y), Some(z)] => Some([x, y, z]),
        _ => None,
    };
    let columns = columns("_m").or_else(|| columns("")).ok_or_else(|| {
        let found = if names.is_empty() { "nothing".to_owned() } else { format!("`{}`", names.join(",")) };
        format!("its first line has to name the columns x_m, y_m and z_m, and it is {found}")
    })?;
    let mut cloud = PointCloud::default();
    let mut row = ByteRecord::new();
    while reader.read_byte_record(&mut row).map_err(|error| error.to_string())? {
        let mut point_m = Vec3::zeros();
        for (axis, &column) in columns.iter().enumerate() {
            let cell = row.get(column).unwrap_or_default();
            point_m[axis] = coordinate(cell).ok_or_else(|| {
                let line = row.position().map_or(0, csv::Position::line);
                format!("line {line}: a number was expected, found `{}`", String::from_utf8_lossy(cell))
            })?;
        }
        cloud.push(point_m);
    }
    Ok(cloud)
}

fn coordinate(cell: &[u8]) -> Option<f32> {
    if cell.is_empty() {
        return Some(f32::NAN);
    }
    std::str::from_utf8(cell).ok()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(text: &str) -> Vec<[f32; 3]> {
        parse(text.as_bytes()).unwrap().points_m.into_iter().map(Into::into).collect()
    }

    #[test]
    fn both_headers_any_order_and_further_columns() {
        assert_eq!(points("x_m,y_m,z_m\n1,2,3\n-1e-1, 0.5 ,2\n"), [[1.0, 2.0, 3.0], [-0.1, 0.5, 2.0]]);
        assert_eq!(points("Z,red,x,y\r\n3,255,1,2\r\n"), [[1.0, 2.0, 3.0]]);
        assert_eq!(points("\u{feff}x,y,z\n1,2,3"), [[1.0, 2.0, 3.0]]);
        assert_eq!(points("x_m,y_m,z_m\n"), [[0.0; 3]; 0]);
    }

    #[test]
    fn cells_that_were_not_measured_are_counted() {
        let cloud = parse(b"x,y,z\n1,2,nan\n,,\n1,inf,2\n0,0,0\n1,1,1\n").unwrap();
        assert_eq!((cloud.points_m.len(), cloud.skipped), (1, 4));
    }

    #[test]
    fn broken_tables_say_where() {
        let cases = [
            ("", "its first line has to name the columns x_m, y_m and z_m, and it is nothing"),
            ("1,2,3\n4,5,6\n", "it is `1,2,3`"),
            ("x_m,y,z\n", "it is `x_m,y,z`"),
            ("x,y,z\n1,2,3\n1,two,3\n", "line 3: a number was expected, found `two`"),
            ("x,y,z\n1,2\n", "line: 2"),
        ];
        for (text, message) in cases {
            let found = parse(text.as_bytes()).unwrap_err();
            assert!(found.contains(message), "{found} does not contain {message}");
        }
    }
}
