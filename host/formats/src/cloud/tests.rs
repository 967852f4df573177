//! What holds for all kinds of files.

use super::point_cloud::CENTRE_RADIUS_M;
use super::*;
use proptest::prelude::*;
use sinew_core::math::Vec3;
use std::fs;
use std::path::Path;

fn written(points: &[Vec3]) -> Vec<u8> {
    let mut bytes = Vec::new();
    write_ply(points, &mut bytes).unwrap();
    bytes
}

fn read_as(name: &str, bytes: &[u8]) -> Result<PointCloud, CloudError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    fs::write(&path, bytes).unwrap();
    read(&path)
}

const PCD: &[u8] =
    b"VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA binary\n\
    \x00\x00\x80\x3f\x00\x00\x80\x3f\x00\x00\x80\x3f";

#[test]
fn empty_clouds_and_single_points_are_read() {
    let point = Vec3::new(1.0, 1.0, 1.0);
    assert_eq!(read_as("a.ply", &written(&[])).unwrap(), PointCloud::default());
    assert_eq!(read_as("a.PLY", &written(&[point])).unwrap().points_m, [point]);
    assert_eq!(read_as("a.pcd", PCD).unwrap().points_m, [point]);
    assert_eq!(read_as("a.Csv", b"x,y,z\n1,1,1\n").unwrap().points_m, [point]);
    let none = String::from_utf8_lossy(&PCD[..PCD.len() - 12]).replace("POINTS 1", "POINTS 0");
    assert_eq!(read_as("a.pcd", none.as_bytes()).unwrap(), PointCloud::default());
}

#[test]
fn points_that_cannot_be_are_left_out_and_counted() {
    let at = |x: f32| Vec3::new(x, 0.0, 0.0);
    let points = [at(f32::NAN), at(f32::INFINITY), at(0.0), at(0.0099), at(0.0101), at(-999.0), at(1001.0), at(3.0e38)];
    let cloud = PointCloud::from_points(points);
    assert_eq!(cloud, PointCloud { points_m: vec![at(0.0101), at(-999.0)], skipped: 6, far: 1, outside: 0 });
}

#[test]
fn errors_name_the_file_and_the_remedy() {
    for (name, bytes, wanted) in [
        ("a.ply", &b"ply\n"[..], "write the file again"),
        ("a.pcd", b"", "write the file again"),
        ("a.csv", b"1,2,3\n", "write the file again"),
        ("a.obj", b"", "files that end in .ply, .pcd, .csv are"),
    ] {
        let found = read_as(name, bytes).unwrap_err().to_string();
        assert!(found.contains(name) && found.contains(wanted), "{found}");
    }
    let missing = read(Path::new("nowhere/a.ply")).unwrap_err().to_string();
    assert!(missing.contains("check the path"), "{missing}");
    assert!(read(Path::new("nowhere/a.ply")).unwrap_err().is_io() && !read_as("a.ply", b"ply\n").unwrap_err().is_io());
    let long = read_as("a.csv", format!("x,y,z\n1,{},3\n", "2".repeat(90_000) + "a").as_bytes()).unwrap_err();
    assert!(long.to_string().len() < 500, "{long}");
}

#[test]
fn millions_of_points_are_cut_to_the_stated_number() {
    let points: Vec<Vec3> =
        (0..1_200_000_u32).map(|i| Vec3::new((i % 1000) as f32, (i / 1000) as f32, 2.0) * 0.1).collect();
    let mut cloud = read_as("many.ply", &written(&points)).unwrap();
    assert_eq!(cloud.limit(MAX_POINTS, 3, 0), points.len());
    assert_eq!(cloud.points_m.len(), MAX_POINTS);
    let header = String::from_utf8_lossy(&PCD[..PCD.len() - 12]).replace("POINTS 1", "POINTS 1200000");
    let values = points.iter().flat_map(|point| point.iter().flat_map(|value| value.to_le_bytes()));
    let mut same = read_as("many.pcd", &header.bytes().chain(values).collect::<Vec<u8>>()).unwrap();
    same.limit(MAX_POINTS, 3, 0);
    assert_eq!(same, cloud);
}

proptest! {
    /// Cut anywhere and with bytes changed, a file is read or refused; what is read keeps the
    /// cloud's invariant.
    #[test]
    fn damaged_files_never_panic(
        kind in 0_usize..3,
        cut in 0_usize..300,
        changes in prop::collection::vec((0_usize..300, any::<u8>()), 0..4),
    ) {
        let good = [written(&[Vec3::new(1.0, 2.0, 3.0); 3]), PCD.to_vec(), b"x_m,y_m,z_m\n1,2,3\n4,5,6\n".to_vec()];
        let mut bytes = good[kind].clone();
        for (at, value) in changes {
            let at = at % bytes.len();
            bytes[at] = value;
        }
        bytes.truncate(cut);
        let parsers = [ply::parse, pcd::parse, csv::parse];
        if let Ok(cloud) = parsers[kind](&bytes) {
            prop_assert!(cloud.points_m.iter().all(|point| (CENTRE_RADIUS_M..=MAX_DISTANCE_M).contains(&point.norm())));
        }
    }
}
