//! The surface of one bone: a capsule, and the part of it that a camera sees; PIK (26) to (28).
//!
//! ```
//! use sinew_core::math::Vec3;
//! use sinew_core::observation::capsule::Capsule;
//!
//! let forearm = Capsule {
//!     start_m: Vec3::new(0.0, 0.0, 2.0),
//!     end_m: Vec3::new(0.3, 0.0, 2.0),
//!     radius_m: 0.04,
//! };
//! let point_m = Vec3::new(0.1, 0.1, 2.0);
//! let (axis_m, _) = forearm.nearest_on_axis(&point_m);
//! assert!((axis_m - Vec3::new(0.1, 0.0, 2.0)).norm() < 1e-6);
//! assert!((forearm.skin_distance_m(&point_m) - 0.06).abs() < 1e-6);
//! ```

use crate::math::{Vec3, clamp, length, max, unit};

/// All points within a radius of a line segment. A segment without length is a sphere.
///
/// ```
/// use sinew_core::math::Vec3;
/// use sinew_core::observation::capsule::Capsule;
///
/// // Two metres away, across the line of sight. The camera does not see its back:
/// // the nearest skin that it sees to a point behind is the edge.
/// let bone = Capsule {
///     start_m: Vec3::new(-0.2, 0.0, 2.0),
///     end_m: Vec3::new(0.2, 0.0, 2.0),
///     radius_m: 0.05,
/// };
/// let skin_m = bone.nearest_visible(&Vec3::zeros(), &Vec3::new(0.0, 0.1, 2.2));
/// assert!((skin_m - Vec3::new(0.0, 0.05, 2.0)).norm() < 1e-5);
/// // A second one crosses it six centimetres behind: they penetrate by four centimetres.
/// let other = Capsule {
///     start_m: Vec3::new(0.0, -0.2, 2.06),
///     end_m: Vec3::new(0.0, 0.2, 2.06),
///     radius_m: 0.05,
/// };
/// assert!((bone.depth_m(&other) - 0.04).abs() < 1e-5);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Capsule {
    /// One end of the segment, metres.
    pub start_m: Vec3,
    /// The other end, metres.
    pub end_m: Vec3,
    /// Distance of the skin from the segment, metres.
    pub radius_m: f32,
}

impl Capsule {
    /// The point p of the segment that is nearest to `point_m`, and where it lies: 0 at the start,
    /// 1 at the end.
    #[must_use]
    pub fn nearest_on_axis(&self, point_m: &Vec3) -> (Vec3, f32) {
        let along = self.end_m - self.start_m;
        let squared = along.dot(&along);
        if !(squared > 0.0) {
            return (self.start_m, 0.0);
        }
        let share = clamp((point_m - self.start_m).dot(&along) / squared, 0.0, 1.0);
        (self.start_m + along * share, share)
    }

    /// Distance D of `point_m` from the whole skin, on either side of it, metres; PIK (34).
    #[must_use]
    pub fn skin_distance_m(&self, point_m: &Vec3) -> f32 {
        let (near_m, _) = self.nearest_on_axis(point_m);
        crate::math::abs(length(&(point_m - near_m)) - self.radius_m)
    }

    /// Whether `point_m` is inside.
    #[must_use]
    pub fn holds(&self, point_m: &Vec3) -> bool {
        let away_m = point_m - self.nearest_on_axis(point_m).0;
        away_m.dot(&away_m) <= self.radius_m * self.radius_m
    }

    /// Penetration depth of two capsules, metres: the sum of their radii less the distance of their
    /// segments.
    ///
    /// Negative where they are apart.
    #[must_use]
    pub fn depth_m(&self, other: &Self) -> f32 {
        self.radius_m + other.radius_m - self.axis_distance_m(other)
    }

    /// Smallest distance between both segments, metres.
    #[must_use]
    pub fn axis_distance_m(&self, other: &Self) -> f32 {
        let (u, v) = (self.end_m - self.start_m, other.end_m - other.start_m);
        let between = self.start_m - other.start_m;
        let (uu, uv, vv) = (u.dot(&u), u.dot(&v), v.dot(&v));
        let (ub, vb) = (u.dot(&between), v.dot(&between));
        let share = |value: f32, per: f32| if per > 0.0 { clamp(value / per, 0.0, 1.0) } else { 0.0 };
        // The nearest places of both lines; any place of the first where they are parallel.
        let s = share(uv * vb - vv * ub, max(uu * vv - uv * uv, 0.0));
        let t = share(uv * s + vb, vv);
        // The place of the first that is nearest to the second's, which may have been cut to its
        // end.
        let s = share(uv * t - ub, uu);
        length(&(between + u * s - v * t))
    }

    /// The point h of the skin that the camera at `camera_m` sees and that is nearest to `point_m`;
    /// PIK (27), (28).
    ///
    /// PIK (28) leaves the sign open: it is that of (x - p)'v here. On the round ends, and where v
    /// vanishes, the part of x - p across the line of sight is taken. A point whose direction is
    /// undefined (on the axis, or straight behind it) takes any direction: its distance is right
    /// nevertheless.
    #[must_use]
    pub fn nearest_visible(&self, camera_m: &Vec3, point_m: &Vec3) -> Vec3 {
        let (near_m, share) = self.nearest_on_axis(point_m);
        let out = point_m - near_m;
        let sight = camera_m - near_m;
        let along = self.end_m - self.start_m;
        let direction = if out.dot(&sight) >= 0.0 {
            unit(out).or_else(|| unit(sight))
        } else {
            let across = unit(sight.cross(&along)).filter(|_| share > 0.0 && share < 1.0);
            match across {
                Some(v) => Some(if out.dot(&v) >= 0.0 { v } else { -v }),
                None => unit(out - sight * (out.dot(&sight) / max(sight.dot(&sight), f32::MIN_POSITIVE))),
            }
        };
        let any = unit(along.cross(&sight)).unwrap_or_else(Vec3::x);
        near_m + direction.unwrap_or(any) * self.radius_m
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Nearest of many points of the visible skin, cylinder and both caps: of those round the axis'
    /// place nearest to the point, and of all.
    fn brute_force(capsule: &Capsule, camera: &Vec3, point: &Vec3) -> [f32; 2] {
        let along = capsule.end_m - capsule.start_m;
        let u = unit(along).unwrap_or_else(Vec3::x);
        let side = unit(u.cross(&Vec3::new(0.3, 0.5, 0.8))).unwrap();
        let other = u.cross(&side);
        let (own, share) = capsule.nearest_on_axis(point);
        let mut best = [f32::INFINITY; 2];
        let mut look = |near: Vec3, direction: Vec3| {
            if direction.dot(&(camera - near)) >= -1.0e-4 {
                let distance = (point - near - direction * capsule.radius_m).norm();
                best[1] = best[1].min(distance);
                if (near - own).norm() < 1.0e-6 {
                    best[0] = best[0].min(distance);
                }
            }
        };
        let turns = 480;
        for turn in 0..turns {
            let angle = core::f32::consts::TAU * turn as f32 / turns as f32;
            let round = side * angle.cos() + other * angle.sin();
            for step in 0..=100 {
                look(capsule.start_m + along * (step as f32 / 100.0), round);
            }
            for step in -60..=60 {
                let lift = core::f32::consts::FRAC_PI_2 * step as f32 / 60.0;
                let direction = round * lift.cos() + u * lift.sin();
                // On a round end the whole sphere counts as its skin.
                if step >= 0 || share >= 1.0 {
                    look(capsule.end_m, direction);
                }
                if step <= 0 || share <= 0.0 {
                    look(capsule.start_m, direction);
                }
            }
            look(own, round);
        }
        best
    }

    fn place(range: f32) -> impl Strategy<Value = Vec3> {
        prop::array::uniform3(-range..range).prop_map(Vec3::from)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn no_visible_point_of_the_skin_is_nearer(start in place(0.3), end in place(0.3), point in place(0.6), radius in 0.03_f32..0.12) {
            prop_assume!((end - start).norm() > 0.05);
            let camera = Vec3::new(0.1, 0.2, -3.0);
            let capsule = Capsule { start_m: start, end_m: end, radius_m: radius };
            let found = (point - capsule.nearest_visible(&camera, &point)).norm();
            let [own, all] = brute_force(&capsule, &camera, &point);
            prop_assert!((found - own).abs() < 0.005, "{} found, {} is there round the axis' nearest place", found, own);
            // PIK (28) asks per place of the axis: another place may see a nearer point, by less
            // than the radius.
            prop_assert!(found <= all + radius && found >= all - 0.005, "{} found, {} is there", found, all);
        }

        #[test]
        fn no_places_of_two_axes_are_nearer(a in place(0.3), b in place(0.3), c in place(0.3), d in place(0.3), kind in 0..4) {
            let (b, d) = match kind {
                0 => (a, d),
                1 => (b, c + (b - a) * 0.7),
                2 => (a, c),
                _ => (b, d),
            };
            let of = |start_m, end_m| Capsule { start_m, end_m, radius_m: 0.05 };
            let (one, other) = (of(a, b), of(c, d));
            let mut least = f32::INFINITY;
            for step in 0..=500 {
                let at = a + (b - a) * (step as f32 / 500.0);
                least = least.min((other.nearest_on_axis(&at).0 - at).norm());
            }
            let found = one.axis_distance_m(&other);
            prop_assert!(found <= least + 1.0e-5 && found > least - 0.003, "{} {}", found, least);
            prop_assert!((found - other.axis_distance_m(&one)).abs() < 1.0e-4);
            prop_assert!((one.depth_m(&other) - (0.1 - found)).abs() < 1.0e-6);
        }

        #[test]
        fn seen_points_are_nearest_as_on_the_whole_skin(start in place(0.3), end in place(0.3), point in place(0.6)) {
            let camera = Vec3::new(0.0, 0.0, -4.0);
            let capsule = Capsule { start_m: start, end_m: end, radius_m: 0.08 };
            let (near, _) = capsule.nearest_on_axis(&point);
            prop_assume!((point - near).dot(&(camera - near)) > 0.0);
            let found = (point - capsule.nearest_visible(&camera, &point)).norm();
            prop_assert!((found - capsule.skin_distance_m(&point)).abs() < 1.0e-5);
        }
    }

    #[test]
    fn what_has_no_direction_still_has_its_distance() {
        let camera = Vec3::zeros();
        let along_sight = Capsule { start_m: Vec3::new(0.0, 0.0, 2.0), end_m: Vec3::new(0.0, 0.0, 2.5), radius_m: 0.1 };
        // On the axis; straight behind the far end; a sphere's middle.
        for point in [Vec3::new(0.0, 0.0, 2.2), Vec3::new(0.0, 0.0, 2.5)] {
            let found = (point - along_sight.nearest_visible(&camera, &point)).norm();
            assert!((found - 0.1).abs() < 1.0e-6, "{found}");
        }
        let behind = Vec3::new(0.0, 0.0, 2.9);
        let found = (behind - along_sight.nearest_visible(&camera, &behind)).norm();
        assert!((found - (0.16_f32 + 0.01).sqrt()).abs() < 1.0e-5, "{found}");
        let sphere = Capsule { start_m: Vec3::z(), end_m: Vec3::z(), radius_m: 0.2 };
        assert!((sphere.skin_distance_m(&Vec3::zeros()) - 0.8).abs() < 1.0e-6);
    }
}
