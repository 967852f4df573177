//! Clouds in PLY files (Turk, The PLY polygon file format, 1994): the `x`, `y` and `z` of the
//! element `vertex`.

use super::point_cloud::PointCloud;
use ply_rs_bw::parser::{ParseError, Parser, Reader};
use ply_rs_bw::ply::{ElementDef, Encoding, Header, Property, PropertyAccess, PropertyAccessResult, PropertyType};
use sinew_core::math::Vec3;
use std::io::{self, Write};

/// A vertex of which nothing but its place is kept.
struct Vertex(Vec3);

impl PropertyAccess for Vertex {
    fn new() -> Self {
        Self(Vec3::zeros())
    }

    fn set_property(&mut self, name: &str, value: Property) -> PropertyAccessResult {
        let axis = match name {
            "x" => 0,
            "y" => 1,
            "z" => 2,
            _ => return PropertyAccessResult::Ignored,
        };
        // Lists of other elements come here too.
        value.to_f32_lossy().map_or(PropertyAccessResult::Ignored, |coordinate| {
            self.0[axis] = coordinate;
            PropertyAccessResult::Set
        })
    }
}

/// Reads the points of a PLY file's content: ascii, little or big endian. Further properties and
/// elements are passed over.
///
/// # Errors
/// The rule that the content breaks.
pub fn parse(bytes: &[u8]) -> Result<PointCloud, String> {
    let parser = Parser::<Vertex>::new();
    let mut reader = Reader::new(bytes);
    let header = parser.read_header(&mut reader).map_err(|error| one_line(&error))?;
    check_header(&header, bytes.len())?;
    let numbers;
    if header.encoding == Encoding::Ascii
        && let Some(spelled) = spell_numbers(bytes, bytes.len() - reader.get_ref().len())
    {
        numbers = spelled;
        reader = Reader::new(&numbers);
        // The header again, so that line numbers in errors are right.
        parser.read_header(&mut reader).map_err(|error| one_line(&error))?;
    }
    for element in header.elements.values() {
        let vertices =
            parser.read_payload_for_element(&mut reader, element, &header).map_err(|error| one_line(&error))?;
        if element.name == "vertex" {
            return Ok(PointCloud::from_points(vertices.into_iter().map(|vertex| vertex.0)));
        }
    }
    Err("it has no element `vertex`".to_owned())
}

/// Replaces words like `nan` and `inf` from the byte `start` on by a number out of range. Most
/// programs write these words for points that were not measured, but the parser knows digits only.
/// `None` if there is no such word.
fn spell_numbers(bytes: &[u8], start: usize) -> Option<Vec<u8>> {
    let (header, body) = bytes.split_at(start);
    if !body.iter().any(|byte| byte.eq_ignore_ascii_case(&b'n')) {
        return None;
    }
    let mut spelled = header.to_vec();
    for line in String::from_utf8_lossy(body).lines() {
        for word in line.split_ascii_whitespace() {
            let is_number = word.parse().is_ok_and(f32::is_finite) || word.parse::<f32>().is_err();
            spelled.extend(if is_number { word } else { "1e999" }.bytes().chain([b' ']));
        }
        spelled.push(b'\n');
    }
    Some(spelled)
}

fn check_header(header: &Header, bytes: usize) -> Result<(), String> {
    let vertex = header.elements.get("vertex").ok_or("it has no element `vertex`")?;
    for axis in ["x", "y", "z"] {
        if !matches!(vertex.properties.get(axis).map(|p| &p.data_type), Some(PropertyType::Scalar(_))) {
            return Err(format!("its element `vertex` has no number `{axis}`"));
        }
    }
    // Each property takes at least a byte, so a larger count is false. A count of elements without
    // properties would have no bound.
    let is_false = |element: &&ElementDef| {
        element.count > 0 && (element.properties.is_empty() || element.count > bytes / element.properties.len())
    };
    header.elements.values().find(is_false).map_or(Ok(()), |element| {
        let (name, count) = (&element.name, element.count);
        Err(format!("its header promises {count} of element `{name}`, and its {bytes} bytes cannot hold them"))
    })
}

/// The parser's sentence, without the structure that it prints behind it.
fn one_line(error: &ParseError) -> String {
    let text = error.to_string();
    let sentence = match text.split_once("Error: ") {
        Some((sentence, cause)) if cause.contains('{') => sentence,
        _ => &text,
    };
    sentence.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Writes points in metres as a PLY file: little endian, `float` x, y and z.
///
/// # Errors
/// What `out` refuses.
pub fn write_ply(points_m: &[Vec3], out: &mut (impl Write + ?Sized)) -> io::Result<()> {
    write!(
        out,
        "ply\nformat binary_little_endian 1.0\ncomment metres\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\nend_header\n",
        points_m.len()
    )?;
    points_m.iter().flat_map(|point_m| point_m.iter()).try_for_each(|value| out.write_all(&value.to_le_bytes()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const ASCII: &str = "ply\nformat ascii 1.0\nelement camera 1\nproperty list uchar float x\nelement vertex 3\nproperty double z\n\
        property uchar red\nproperty float x\nproperty short y\nelement face 1\nproperty list uchar int vertex_index\nend_header\n\
        2 7 8\n3.5 255 1.25 -2\nnan 0 1 1\n-inf 0 NaN 7\n3 0 1 0\n";

    proptest! {
        #[test]
        fn what_is_written_is_read_back(points in prop::collection::vec((-9.0_f32..9.0, -9.0_f32..9.0, 0.02_f32..9.0), 0..50)) {
            let points: Vec<Vec3> = points.into_iter().map(|(x, y, z)| Vec3::new(x, y, z)).collect();
            let mut bytes = Vec::new();
            write_ply(&points, &mut bytes).unwrap();
            prop_assert_eq!(parse(&bytes).unwrap(), PointCloud { points_m: points, ..PointCloud::default() });
        }
    }

    #[test]
    fn other_types_properties_and_elements_do_no_harm() {
        let cloud = parse(ASCII.as_bytes()).unwrap();
        assert_eq!(cloud, PointCloud { points_m: vec![Vec3::new(1.25, -2.0, 3.5)], skipped: 2, far: 0, outside: 0 });
        assert_eq!(parse(ASCII.replace('\n', "\r\n").as_bytes()).unwrap(), cloud);
    }

    #[test]
    fn big_endian_is_read() {
        let mut bytes =
            b"ply\nformat binary_big_endian 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty double z\nend_header\n".to_vec();
        bytes.extend(1.0_f32.to_be_bytes().into_iter().chain(2.0_f32.to_be_bytes()).chain(3.0_f64.to_be_bytes()));
        assert_eq!(parse(&bytes).unwrap().points_m, [Vec3::new(1.0, 2.0, 3.0)]);
    }

    #[test]
    fn broken_files_say_the_rule() {
        let changes = [
            ("ply\n", "plx\n", "magic number"),
            ("element vertex", "element point", "no element `vertex`"),
            ("property float x", "property float u", "no number `x`"),
            ("property double z", "property list uchar double z", "no number `z`"),
            ("end_header\n", "", "Line 12"),
            ("vertex 3", "vertex 4000000000", "promises 4000000000 of element `vertex`"),
            ("camera 1\nproperty list uchar float x", "camera 99999999999", "promises 99999999999 of element `camera`"),
            ("vertex 3", "vertex 9", "Line"),
            ("3.5 255", "three 255", "three"),
            ("nan 0 1 1", "nan 0 1", "Line"),
            ("property float x", "property real x", "Couldn't parse line. String: 'property real x"),
        ];
        for (from, to, message) in changes {
            let found = parse(ASCII.replacen(from, to, 1).as_bytes()).unwrap_err();
            assert!(found.contains(message) && !found.contains(['\n', '{']), "{found} does not contain {message}");
        }
    }
}
