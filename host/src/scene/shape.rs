//! Ellipsoids, capsules and cards, and where rays from the camera meet them.
//!
//! A ray is t * (x, y, 1), so t is the depth along the line of sight in metres.

use sinew_core::math::{Mat3, Vec3, abs, sqrt};

/// Nothing nearer than this is seen, metres.
pub const NEAREST_DEPTH_M: f32 = 0.05;

/// A surface in camera axes, metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Shape {
    /// An ellipsoid.
    Ellipsoid {
        /// Its centre.
        centre: Vec3,
        /// Unit axes, one a row.
        axes: Mat3,
        /// Half lengths along the axes.
        radii: Vec3,
    },
    /// All points within `radius` of a line segment.
    Capsule {
        /// First end of the segment.
        start: Vec3,
        /// Second end of the segment.
        end: Vec3,
        /// Radius.
        radius: f32,
    },
    /// A rectangle that faces the camera.
    Card {
        /// Its centre.
        centre: Vec3,
        /// Half width and half height.
        half: [f32; 2],
    },
}

/// Where a ray meets a surface first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
    /// Depth along the line of sight, metres.
    pub depth_m: f32,
    /// Unit normal, towards the camera's side.
    pub normal: Vec3,
    /// Place on the surface: unit-sphere coordinates of an ellipsoid; metres along a capsule (x);
    /// metres from a card's centre (x, y).
    pub place: Vec3,
}

/// A shape with everything computed that all rays share.
#[derive(Debug, Clone, Copy)]
pub struct Prepared(Kind);

#[derive(Debug, Clone, Copy)]
enum Kind {
    Ellipsoid {
        to_sphere: Mat3,
        centre: Vec3,
        offset: f32,
    },
    Capsule {
        start: Vec3,
        end: Vec3,
        radius: f32,
        axis: Vec3,
        length: f32,
        start_along: f32,
        across: Vec3,
        offset: f32,
    },
    Card {
        centre: Vec3,
        half: [f32; 2],
    },
}

impl Shape {
    /// Middle and radius of a ball that holds the shape.
    #[must_use]
    pub fn bounding_ball(&self) -> (Vec3, f32) {
        match *self {
            Self::Ellipsoid { centre, radii, .. } => (centre, radii.max()),
            Self::Capsule { start, end, radius } => ((start + end) * 0.5, (end - start).norm() * 0.5 + radius),
            Self::Card { centre, half } => (centre, sqrt(half[0] * half[0] + half[1] * half[1])),
        }
    }

    /// Balls whose hull holds the shape.
    #[must_use]
    pub fn bounding_balls(&self) -> [(Vec3, f32); 2] {
        match *self {
            Self::Capsule { start, end, radius } => [(start, radius), (end, radius)],
            _ => [self.bounding_ball(); 2],
        }
    }

    /// Computes what all rays share.
    #[must_use]
    pub fn prepare(&self) -> Prepared {
        Prepared(match *self {
            Self::Ellipsoid { centre, axes, radii } => {
                let to_sphere = Mat3::from_fn(|row, column| axes[(row, column)] / radii[row]);
                let centre = to_sphere * centre;
                Kind::Ellipsoid { to_sphere, centre, offset: centre.dot(&centre) - 1.0 }
            }
            Self::Capsule { start, end, radius } => {
                let span = end - start;
                let length = span.norm();
                let axis = if length > 1.0e-9 { span / length } else { Vec3::x() };
                let start_along = start.dot(&axis);
                let across = start - axis * start_along;
                let offset = across.dot(&across) - radius * radius;
                Kind::Capsule { start, end, radius, axis, length, start_along, across, offset }
            }
            Self::Card { centre, half } => Kind::Card { centre, half },
        })
    }
}

/// Smaller root of a t^2 - 2 b t + c = 0.
fn first_root(a: f32, b: f32, c: f32) -> Option<f32> {
    let discriminant = b * b - a * c;
    if discriminant > 0.0 { Some((b - sqrt(discriminant)) / a) } else { None }
}

impl Prepared {
    /// First point where the ray through `direction` (its z is 1) meets the shape, beyond
    /// [`NEAREST_DEPTH_M`].
    #[must_use]
    #[inline]
    pub fn hit(&self, direction: &Vec3) -> Option<Hit> {
        let hit = match &self.0 {
            Kind::Ellipsoid { to_sphere, centre, offset } => {
                let d = to_sphere * direction;
                let depth_m = first_root(d.dot(&d), d.dot(centre), *offset)?;
                let place = d * depth_m - centre;
                let normal = to_sphere.transpose() * place;
                Hit { depth_m, normal: normal / sqrt(normal.dot(&normal)), place }
            }
            Kind::Capsule { start, end, radius, axis, length, start_along, across, offset } => {
                let along = direction.dot(axis);
                let d = direction - axis * along;
                let depth_m = first_root(d.dot(&d), d.dot(across), *offset)?;
                let place = depth_m * along - start_along;
                if place >= 0.0 && place <= *length {
                    let normal = (d * depth_m - across) / *radius;
                    Hit { depth_m, normal, place: Vec3::new(place, 0.0, 0.0) }
                } else {
                    let cap = if place < 0.0 { start } else { end };
                    let offset = cap.dot(cap) - radius * radius;
                    let depth_m = first_root(direction.dot(direction), direction.dot(cap), offset)?;
                    let normal = (direction * depth_m - cap) / *radius;
                    Hit { depth_m, normal, place: Vec3::new(if place < 0.0 { 0.0 } else { *length }, 0.0, 0.0) }
                }
            }
            Kind::Card { centre, half } => {
                let place = direction * centre.z - centre;
                if abs(place.x) > half[0] || abs(place.y) > half[1] {
                    return None;
                }
                Hit { depth_m: centre.z, normal: -Vec3::z(), place }
            }
        };
        (hit.depth_m > NEAREST_DEPTH_M).then_some(hit)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use sinew_core::math::axis_rotation;

    fn distance_to_segment(p: Vec3, a: Vec3, b: Vec3) -> f32 {
        let share = ((p - a).dot(&(b - a)) / (b - a).norm_squared()).clamp(0.0, 1.0);
        (p - a - (b - a) * share).norm()
    }

    proptest! {
        #[test]
        fn a_capsule_is_hit_on_its_surface(
            ax in -0.3_f32..0.3, ay in -0.3_f32..0.3, az in 0.8_f32..1.6, bx in -0.3_f32..0.3, by in -0.3_f32..0.3, bz in 0.8_f32..1.6,
            share in 0.0_f32..1.0,
        ) {
            let (a, b) = (Vec3::new(ax, ay, az), Vec3::new(bx, by, bz));
            prop_assume!((a - b).norm() > 0.05);
            let shape = Shape::Capsule { start: a, end: b, radius: 0.05 };
            let inside = a + (b - a) * share;
            let hit = shape.prepare().hit(&(inside / inside.z)).unwrap();
            let point = inside / inside.z * hit.depth_m;
            prop_assert!((distance_to_segment(point, a, b) - 0.05).abs() < 1.0e-3);
            prop_assert!(hit.depth_m < inside.z && hit.normal.dot(&point) < 1.0e-3);
            prop_assert!((hit.normal.norm() - 1.0).abs() < 1.0e-2);
        }

        #[test]
        fn an_ellipsoid_is_hit_on_its_surface(x in -0.3_f32..0.3, y in -0.3_f32..0.3, turn in -3.0_f32..3.0) {
            let centre = Vec3::new(x, y, 1.2);
            let axes = axis_rotation(&Vec3::new(0.6, 0.0, 0.8), turn);
            let radii = Vec3::new(0.1, 0.05, 0.2);
            let hit = Shape::Ellipsoid { centre, axes, radii }.prepare().hit(&(centre / centre.z)).unwrap();
            let own = axes * (centre / centre.z * hit.depth_m - centre);
            let sphere = own.component_div(&radii);
            prop_assert!((sphere.norm() - 1.0).abs() < 1.0e-3);
            prop_assert!((sphere - hit.place).norm() < 1.0e-3);
            prop_assert!(hit.normal.dot(&centre) < 0.0);
        }
    }

    #[test]
    fn a_ray_beside_a_shape_misses_it() {
        let ball = Shape::Capsule { start: Vec3::z(), end: Vec3::z(), radius: 0.1 };
        assert!(ball.prepare().hit(&Vec3::new(0.2, 0.0, 1.0)).is_none());
        assert!((ball.prepare().hit(&Vec3::z()).unwrap().depth_m - 0.9).abs() < 1.0e-5);
        let card = Shape::Card { centre: Vec3::z(), half: [0.1, 0.2] };
        assert!(card.prepare().hit(&Vec3::new(0.05, 0.15, 1.0)).is_some());
        assert!(card.prepare().hit(&Vec3::new(0.15, 0.05, 1.0)).is_none());
        let behind = Shape::Card { centre: -Vec3::z(), half: [0.1, 0.2] };
        assert!(behind.prepare().hit(&Vec3::z()).is_none());
    }
}
