//! Likelihoods of poses given a frame: orientations of limbs, and clouds of 3D points.
//!
//! ```
//! use sinew_core::math::Vec3;
//! use sinew_core::observation::capsule::Capsule;
//! use sinew_core::observation::hough::{HoughSettings, dynamic_hough};
//! use sinew_core::observation::point_cloud::PointCloud;
//! use sinew_core::random::Stream;
//! use sinew_core::vision::edges::EdgePixel;
//!
//! // Edge pixels along a line: the orientation of a limb.
//! let pixels: Vec<EdgePixel> =
//!     (0..60_u16).map(|i| EdgePixel { u: 100 + i, v: 80 + i / 2 }).collect();
//! let found = dynamic_hough(&pixels, &HoughSettings::default(), &mut Stream::new(1, 0, 0))
//!     .expect("enough pixels");
//! let along_rad = 0.5_f32.atan();
//! assert!(found.density.at(along_rad) > 3.0 * found.density.at(along_rad + 1.57));
//!
//! // A bone as a capsule, and a point before it: the nearest skin that the camera sees.
//! let forearm = Capsule {
//!     start_m: Vec3::new(0.0, 0.0, 2.0),
//!     end_m: Vec3::new(0.3, 0.0, 2.0),
//!     radius_m: 0.04,
//! };
//! let point_m = Vec3::new(0.15, 0.0, 1.9);
//! let skin_m = forearm.nearest_visible(&Vec3::zeros(), &point_m);
//! assert!((skin_m.z - 1.96).abs() < 1e-3);
//!
//! // Points become blocks of neighbours; invalid points are left out and counted.
//! let mut points_m = [point_m, skin_m, Vec3::new(f32::NAN, 0.0, 1.0)];
//! let mut cloud = PointCloud::<4>::new();
//! let left_out = cloud.set(&mut points_m, &Vec3::zeros());
//! assert_eq!((cloud.len(), left_out.not_finite), (2, 1));
//! ```

pub mod body_surface;
pub mod capsule;
pub mod hough;
pub mod limb_likelihood;
pub mod limbs;
pub mod orientation;
pub mod point_cloud;
pub mod point_likelihood;
pub mod point_pull;
pub mod range_smoothing;
pub mod self_penetration;
