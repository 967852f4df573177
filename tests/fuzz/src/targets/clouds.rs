//! Readers of point clouds.

use crate::Target;
use crate::file::file;
use image::{DynamicImage, ImageBuffer, ImageFormat, Luma};
use sinew_core::math::Vec3;
use sinew_formats::cloud::{DepthCamera, MAX_DISTANCE_M, blocks_of, depth_image, ply, read, write_ply};
use std::io::Cursor;

/// CSV, PLY and PCD; depth images and their cameras.
pub const TARGETS: &[Target] = &[
    Target { name: "cloud_csv", run: |bytes| cloud("c.csv", bytes), seeds: || vec![CSV.into()] },
    Target { name: "cloud_ply", run: |bytes| cloud("c.ply", bytes), seeds: plys },
    Target { name: "cloud_pcd", run: |bytes| cloud("c.pcd", bytes), seeds: pcds },
    Target { name: "depth_image", run: depth_image, seeds: depth_images },
    Target { name: "depth_camera", run: depth_camera, seeds: || CAMERAS.map(Vec::from).to_vec() },
];

const CSV: &str = "x_m,y_m,z_m,red\n0.1,0.2,2.5,9\n-0.3, 1e-1,2.25,9\nnan,,1,9\n";
const PLY: &str = "ply\nformat ascii 1.0\ncomment made by hand\nelement face 1\nproperty list uchar int vertex_indices\n\
    element vertex 3\nproperty float x\nproperty double y\nproperty float z\nproperty uchar red\nend_header\n3 0 1 2\n\
    0.1 0.2 2.5 7\n0.3 nan 2.5 7\n-1 -2 3 255\n";
const PCD: &str = "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F U\nCOUNT 1 1 1 1\nWIDTH 2\nHEIGHT 1\n\
    VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA ascii\n0.1 0.2 2.5 7\nnan nan nan 7\n";

const CAMERAS: [&str; 3] = [
    r#"{"fx": 580.0, "fy": 570, "ppx": 320, "ppy": 240.5, "coeffs": [0, 0], "depth_scale": 0.001, "width": 640}"#,
    r#"{"K": [580, 0, 320, 0, 570, 240.5, 0, 0, 1], "D": [], "depth_scale": 1000}"#,
    r#"{"intrinsic_matrix": [580, 0, 0, 0, 570, 0, 320, 240.5, 1], "width": 640, "height": 480}"#,
];

fn depth_images() -> Vec<Vec<u8>> {
    let image: ImageBuffer<Luma<u16>, _> = ImageBuffer::from_fn(7, 5, |u, v| Luma([(300 * (u + v)) as u16]));
    [ImageFormat::Png, ImageFormat::Pnm]
        .map(|format| {
            let mut bytes = Cursor::new(Vec::new());
            DynamicImage::from(image.clone()).write_to(&mut bytes, format).expect("memory takes it");
            bytes.into_inner()
        })
        .to_vec()
}

fn depth_image(bytes: &[u8]) {
    let camera = DepthCamera { focal_px: [500.0; 2], centre_px: [3.0, 2.0], unit_m: 0.001, size_px: None };
    let Ok(cloud) = depth_image::parse(bytes, &camera) else { return };
    assert!(cloud.points_m.iter().all(|point_m| point_m.norm() <= MAX_DISTANCE_M), "a point without bounds");
}

fn depth_camera(bytes: &[u8]) {
    let Ok(camera) = DepthCamera::read(&file("c.json", bytes)) else { return };
    assert!(camera.focal_px.iter().all(|focal_px| *focal_px > 0.0) && camera.unit_m > 0.0 && camera.unit_m <= 1.0);
}

fn plys() -> Vec<Vec<u8>> {
    let points: Vec<Vec3> = (0..5).map(|i| Vec3::new(i as f32, 0.5, 2.0)).collect();
    let mut written = Vec::new();
    write_ply(&points, &mut written).expect("memory takes it");
    let mut binary = PLY.split("end_header\n").next().unwrap_or_default().replace("ascii", "binary_big_endian");
    binary = binary.replace("element face 1\nproperty list uchar int vertex_indices\n", "");
    let mut binary = (binary + "end_header\n").into_bytes();
    for point in &points[..3] {
        binary.extend(point.x.to_be_bytes().iter().chain(&f64::from(point.y).to_be_bytes()));
        binary.extend(point.z.to_be_bytes().iter().chain(&[1]));
    }
    vec![written, PLY.into(), binary]
}

fn pcds() -> Vec<Vec<u8>> {
    let header = PCD.split("ascii\n").next().unwrap_or_default();
    let mut binary = format!("{header}binary\n").into_bytes();
    for value in [0.1_f32, 0.2, 2.5, 7.0, 1.0, f32::NAN, 2.0, 3.0] {
        binary.extend(value.to_le_bytes());
    }
    let mut compressed = format!("{header}binary_compressed\n").into_bytes();
    // LZF: 32 bytes as they are.
    compressed.extend([33, 0, 0, 0, 32, 0, 0, 0, 31]);
    compressed.extend([0.5_f32, 1.5, 0.25, 1.25, 2.0, 3.0, 0.0, 0.0].iter().flat_map(|value| value.to_le_bytes()));
    vec![PCD.into(), binary, compressed]
}

fn cloud(name: &str, bytes: &[u8]) {
    let Ok(cloud) = read(&file(name, bytes)) else { return };
    assert!(cloud.points_m.len() + cloud.skipped <= FREE_POINTS + 8 * bytes.len(), "more points than bytes");
    assert!(cloud.points_m.iter().all(|point_m| point_m.norm() <= MAX_DISTANCE_M), "a point without bounds");
    let mut written = Vec::new();
    write_ply(&cloud.points_m, &mut written).expect("memory takes it");
    assert_eq!(ply::parse(&written).expect("it was written").points_m, cloud.points_m, "as it was written");
    let mut fewer = cloud;
    fewer.limit(MAX_WEIGHED, 1, 1);
    assert!(blocks_of(&mut fewer.points_m, None).len() <= MAX_WEIGHED);
}

/// Points that are sorted into blocks.
const MAX_WEIGHED: usize = 1000;
/// Points that a small compressed file may have.
const FREE_POINTS: usize = 100_000;
