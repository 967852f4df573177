//! Clouds in PCD files, the format of the Point Cloud Library: the fields `x`, `y` and `z`; ascii,
//! binary or compressed.

use super::point_cloud::PointCloud;
use crate::limits::MAX_FILE_BYTES;
use pcd_rs::{DataKind, DynReader, DynRecord, Field, PcdMeta};
use sinew_core::math::Vec3;

/// Reads the points of a PCD file's content. Further fields are passed over.
///
/// # Errors
/// The rule that the content breaks.
pub fn parse(bytes: &[u8]) -> Result<PointCloud, String> {
    let mut data = bytes;
    let meta = PcdMeta::from_reader(&mut data).map_err(|error| error.to_string())?;
    let fields = place_of_coordinates(&meta)?;
    check_size(&meta, data)?;
    let reader = DynReader::from_bytes(bytes).map_err(|error| error.to_string())?;
    let mut cloud = PointCloud::default();
    for (index, record) in reader.enumerate() {
        let DynRecord(values) =
            record.map_err(|error| format!("point {} of {}: {error}", index + 1, meta.num_points))?;
        let [x, y, z] = fields.map(|field| values.get(field).map_or(f32::NAN, coordinate));
        cloud.push(Vec3::new(x, y, z));
    }
    Ok(cloud)
}

/// Where in a record x, y and z stand. Padding (a field called `_`) is not part of a record.
fn place_of_coordinates(meta: &PcdMeta) -> Result<[usize; 3], String> {
    let mut places = [0; 3];
    for (place, axis) in places.iter_mut().zip(["x", "y", "z"]) {
        let mut fields = meta.field_defs.iter().filter(|field| !field.is_padding());
        *place = fields
            .position(|field| field.name == axis && field.count == 1)
            .ok_or_else(|| format!("its FIELDS have no number `{axis}`"))?;
    }
    Ok(places)
}

/// Refuses a header whose counts exceed the file, before memory is allocated. `data` is what
/// follows the header.
fn check_size(meta: &PcdMeta, data: &[u8]) -> Result<(), String> {
    let is_ascii = meta.data == DataKind::Ascii;
    let record_bytes = meta.field_defs.iter().try_fold(0_u64, |sum, field| {
        // A number of an ascii file takes a digit and a space.
        let value_bytes = if is_ascii { 2 } else { field.kind.byte_size() as u64 };
        sum.checked_add(field.count.checked_mul(value_bytes)?)
    });
    let promised = record_bytes.and_then(|bytes| bytes.checked_mul(meta.num_points));
    let held = if meta.data == DataKind::BinaryCompressed { compressed_content(data)? } else { data.len() as u64 };
    // The last line of an ascii file may lack its end. A file without points may hold anything.
    let suffices = |promised: u64| promised <= held + u64::from(is_ascii);
    if record_bytes.is_some_and(|bytes| bytes <= MAX_FILE_BYTES) && promised.is_some_and(suffices) {
        return Ok(());
    }
    Err(format!("its header promises {} points, and {held} bytes of data cannot hold them", meta.num_points))
}

/// Uncompressed size by the header of the compressed `data`. LZF makes at most 264 bytes of 3.
fn compressed_content(data: &[u8]) -> Result<u64, String> {
    let word = |at: usize| data.get(at..at + 4).and_then(|four| four.try_into().ok()).map(u32::from_le_bytes);
    let (Some(packed), Some(content)) = (word(0), word(4)) else {
        return Err("it ends where the sizes of its compressed data were expected".to_owned());
    };
    let (packed, content) = (u64::from(packed), u64::from(content));
    if packed > data.len() as u64 - 8 || content > packed * 88 || content > MAX_FILE_BYTES {
        return Err(format!(
            "it says that {packed} compressed bytes hold {content}, and {} bytes are there",
            data.len() - 8
        ));
    }
    Ok(content)
}

fn coordinate(field: &Field) -> f32 {
    fn first<T: Copy>(values: &[T], to_f32: impl Fn(T) -> f32) -> f32 {
        values.first().map_or(f32::NAN, |&value| to_f32(value))
    }
    match field {
        Field::F32(values) => first(values, |value| value),
        Field::F64(values) => first(values, |value| value as f32),
        Field::I8(values) => first(values, f32::from),
        Field::I16(values) => first(values, f32::from),
        Field::I32(values) => first(values, |value| value as f32),
        Field::I64(values) => first(values, |value| value as f32),
        Field::U8(values) => first(values, f32::from),
        Field::U16(values) => first(values, f32::from),
        Field::U32(values) => first(values, |value| value as f32),
        Field::U64(values) => first(values, |value| value as f32),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::fmt::Write as _;

    /// Points with a field before and padding between, so that places matter.
    fn header(points: usize, data: &str) -> String {
        format!(
            "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS rgb x _ y z\nSIZE 4 4 1 4 8\nTYPE U F U F F\n\
            COUNT 1 1 3 1 1\nWIDTH {points}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {points}\nDATA {data}\n"
        )
    }

    fn ascii(points: &[Vec3]) -> Vec<u8> {
        let mut text = header(points.len(), "ascii");
        for point in points {
            let _ = writeln!(text, "4278190080 {} 0 0 0 {} {}", point.x, point.y, point.z);
        }
        text.into_bytes()
    }

    fn binary(points: &[Vec3]) -> Vec<u8> {
        let mut bytes = header(points.len(), "binary").into_bytes();
        for point in points {
            bytes.extend([7, 7, 7, 7].iter().chain(&point.x.to_le_bytes()).chain(&[9, 9, 9]));
            bytes.extend(point.y.to_le_bytes().iter().chain(&f64::from(point.z).to_le_bytes()));
        }
        bytes
    }

    /// Field after field, in runs of literals: a control byte of n - 1 and then n bytes.
    fn compressed(points: &[Vec3]) -> Vec<u8> {
        let mut content = vec![7; 4 * points.len()];
        content.extend(points.iter().flat_map(|point| point.x.to_le_bytes()));
        content.extend(vec![9; 3 * points.len()]);
        content.extend(points.iter().flat_map(|point| point.y.to_le_bytes()));
        content.extend(points.iter().flat_map(|point| f64::from(point.z).to_le_bytes()));
        let mut packed = Vec::new();
        for run in content.chunks(32) {
            packed.push(run.len() as u8 - 1);
            packed.extend(run);
        }
        let mut bytes = header(points.len(), "binary_compressed").into_bytes();
        bytes.extend((packed.len() as u32).to_le_bytes().iter().chain(&(content.len() as u32).to_le_bytes()));
        bytes.extend(packed);
        bytes
    }

    proptest! {
        #[test]
        fn all_three_kinds_of_data_are_read(points in prop::collection::vec((-9.0_f32..9.0, -9.0_f32..9.0, 0.02_f32..9.0), 0..40)) {
            let points: Vec<Vec3> = points.into_iter().map(|(x, y, z)| Vec3::new(x, y, z)).collect();
            for bytes in [ascii(&points), binary(&points), compressed(&points)] {
                prop_assert_eq!(parse(&bytes).unwrap(), PointCloud { points_m: points.clone(), ..PointCloud::default() });
            }
        }
    }

    #[test]
    fn points_that_were_not_measured_are_counted() {
        let points = [Vec3::new(f32::NAN, f32::NAN, f32::NAN), Vec3::zeros(), Vec3::new(0.0, 0.0, 1.0)];
        for bytes in [ascii(&points), binary(&points), compressed(&points)] {
            assert_eq!(
                parse(&bytes).unwrap(),
                PointCloud { points_m: vec![points[2]], skipped: 2, far: 0, outside: 0 }
            );
        }
    }

    #[test]
    fn broken_files_say_the_rule() {
        let points = [Vec3::new(1.0, 2.0, 3.0); 2];
        let text = String::from_utf8(ascii(&points)).unwrap();
        let changes = [
            ("VERSION 0.7\n", "", "VERSION"),
            ("rgb x", "rgb u", "no number `x`"),
            ("COUNT 1 1 3", "COUNT 1 2 3", "no number `x`"),
            ("COUNT 1 1 3", "COUNT 1 1 9999999999999999999", "promises 2 points"),
            ("POINTS 2", "POINTS 9999999", "promises 9999999 points"),
            ("POINTS 2", "POINTS 3", "point 3 of 3"),
            ("1 0 0 0 2 3", "one 0 0 0 2 3", "point 1 of 2"),
            ("1 0 0 0 2 3", "1 0 0 0 2", "point 1 of 2"),
        ];
        for (from, to, message) in changes {
            let found = parse(text.replacen(from, to, 1).as_bytes()).unwrap_err();
            assert!(found.contains(message), "{found} does not contain {message}");
        }
    }

    #[test]
    fn sizes_that_cannot_be_are_refused_before_memory_is_asked_for() {
        let good = compressed(&[Vec3::new(1.0, 2.0, 3.0); 2]);
        let sizes = header(2, "binary_compressed").len();
        for (at, message) in [(sizes, "compressed bytes hold"), (sizes + 4, "compressed bytes hold")] {
            let mut bytes = good.clone();
            bytes[at..at + 4].copy_from_slice(&u32::MAX.to_le_bytes());
            assert!(parse(&bytes).unwrap_err().contains(message));
        }
        assert!(parse(&good[..sizes + 5]).unwrap_err().contains("it ends where"));
        let more = String::from_utf8_lossy(&good[..sizes]).replace("POINTS 2", "POINTS 3");
        let bytes: Vec<u8> = more.bytes().chain(good[sizes..].iter().copied()).collect();
        assert!(parse(&bytes).unwrap_err().contains("promises 3 points"));
    }
}
