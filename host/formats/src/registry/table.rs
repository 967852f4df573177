//! The table of formats.

use super::format::{Format, JointReader, MarkerReader, Reader, Signature};
use crate::cloud::point_cloud::PointCloud;
use crate::cloud::{csv, pcd, ply};
use crate::motion::{amc, bvh, c3d, exponential_map, trc};

/// All formats, in the order in which texts list them.
pub static FORMATS: [Format; 27] = [
    Format {
        name: "BVH",
        extensions: &["bvh"],
        note: "",
        signatures: &[at(0, b"HIERARCHY")],
        reader: Reader::Joints(JointReader {
            read: bvh::read_with,
            read_whole_body: None,
            needs_skeleton: false,
            has_rate: true,
            is_first_line: None,
        }),
    },
    Format {
        name: "AMC",
        extensions: &["amc"],
        note: "",
        signatures: &[],
        reader: Reader::Joints(JointReader {
            read: amc::read_with_skeleton,
            read_whole_body: None,
            needs_skeleton: true,
            has_rate: false,
            is_first_line: None,
        }),
    },
    Format { name: "ASF", extensions: &["asf"], note: "", signatures: &[at(0, b":version")], reader: Reader::Skeleton },
    Format {
        name: "exponential maps",
        extensions: &["txt"],
        note: "exponential maps",
        signatures: &[],
        reader: Reader::Joints(JointReader {
            read: |path, options| exponential_map::read(path, options.rate()),
            read_whole_body: Some(|path, options| exponential_map::read_whole_body(path, options.rate())),
            needs_skeleton: false,
            has_rate: false,
            is_first_line: Some(exponential_map::is_row),
        }),
    },
    Format {
        name: "TRC",
        extensions: &["trc"],
        note: "",
        signatures: &[at(0, b"PathFileType")],
        reader: Reader::Markers(MarkerReader { read: trc::read_with, is_on_skin: false }),
    },
    Format {
        name: "C3D",
        extensions: &["c3d"],
        note: "",
        signatures: &[at(1, &[c3d::MAGIC])],
        reader: Reader::Markers(MarkerReader { read: c3d::read_with, is_on_skin: true }),
    },
    keypoints("JSON", &["json"]),
    keypoints("CSV", &["csv"]),
    cloud("PLY", &["ply"], &[at(0, b"ply\n"), at(0, b"ply\r")], ply::parse),
    cloud("PCD", &["pcd"], &[at(0, b"# .PCD"), at(0, b"VERSION")], pcd::parse),
    cloud("CSV", &["csv"], &[], csv::parse),
    depth("PNG", &["png"], &[at(0, b"\x89PNG")]),
    depth("PGM", &["pgm"], &[at(0, b"P2"), at(0, b"P5")]),
    image("PNG", &["png"], &[at(0, b"\x89PNG")]),
    image("JPEG", &["jpg", "jpeg"], &[at(0, b"\xff\xd8\xff")]),
    image("PPM", &["ppm"], &[at(0, b"P3"), at(0, b"P6")]),
    image("PGM", &["pgm"], &[at(0, b"P2"), at(0, b"P5")]),
    image("PNM", &["pnm"], &[at(0, b"P7")]),
    image("PBM", &["pbm"], &[at(0, b"P1"), at(0, b"P4")]),
    video("MP4", &["mp4", "m4v", "mov"], &[at(4, b"ftyp")]),
    video("AVI", &["avi"], &[at(8, b"AVI ")]),
    video("Matroska", &["mkv", "webm"], &[at(0, b"\x1a\x45\xdf\xa3")]),
    video("MPEG", &["mpg", "mpeg"], &[at(0, b"\x00\x00\x01\xba")]),
    video("WMV", &["wmv"], &[at(0, b"\x30\x26\xb2\x75")]),
    video("AVCHD", &["mts"], &[at(4, b"\x47")]),
    video("Ogg", &["ogv"], &[at(0, b"OggS")]),
    video("GIF", &["gif"], &[at(0, b"GIF8")]),
];

const fn at(offset: usize, bytes: &'static [u8]) -> Signature {
    Signature { offset, bytes }
}

type Words = &'static [&'static str];
type Signatures = &'static [Signature];

const fn keypoints(name: &'static str, extensions: Words) -> Format {
    Format { name, extensions, note: "", signatures: &[], reader: Reader::Keypoints }
}

const fn cloud(
    name: &'static str,
    extensions: Words,
    signatures: Signatures,
    parse: fn(&[u8]) -> Result<PointCloud, String>,
) -> Format {
    Format { name, extensions, note: "", signatures, reader: Reader::Cloud(parse) }
}

const fn depth(name: &'static str, extensions: Words, signatures: Signatures) -> Format {
    Format { name, extensions, note: "", signatures, reader: Reader::Depth }
}

const fn image(name: &'static str, extensions: Words, signatures: Signatures) -> Format {
    Format { name, extensions, note: "", signatures, reader: Reader::Image }
}

const fn video(name: &'static str, extensions: Words, signatures: Signatures) -> Format {
    Format { name, extensions, note: "", signatures, reader: Reader::Video }
}
