//! The person: where the shoulders are, how long the limbs, which shapes body and arms are made of.
//!
//! The torso faces the camera: body left is camera +x, up is -y, front is -z.

use super::canvas::Surface;
use super::palette::Rgb;
use super::shape::Shape;
use crate::motion::anthropometry as fraction;
use crate::motion::{ArmDirections, ArmSide};
use sinew_core::math::{Mat3, Vec3};

/// A vector of torso axes (left, up, front) in camera axes.
#[must_use]
pub fn to_camera(torso: &Vec3) -> Vec3 {
    Vec3::new(torso.x, -torso.y, -torso.z)
}

/// Lengths of the person and the place of the shoulders.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Body {
    /// Height, metres.
    pub height_m: f32,
    /// Middle between the shoulder joints, camera axes, metres.
    pub shoulder_middle_m: Vec3,
}

/// Joints of one arm, camera axes, metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ArmJoints {
    /// Shoulder joint.
    pub shoulder_m: Vec3,
    /// Elbow.
    pub elbow_m: Vec3,
    /// Wrist.
    pub wrist_m: Vec3,
    /// Middle of the hand, on the forearm's extension.
    pub hand_m: Vec3,
}

impl Body {
    /// Length of the upper arm, metres.
    #[must_use]
    pub fn upper_arm_m(&self) -> f32 {
        fraction::UPPER_ARM * self.height_m
    }

    /// Elbow to the middle of the hand, metres.
    #[must_use]
    pub fn forearm_m(&self) -> f32 {
        fraction::ELBOW_TO_HAND_CENTRE * self.height_m
    }

    /// Shoulder joint of one side, camera axes, metres.
    #[must_use]
    pub fn shoulder_m(&self, side: ArmSide) -> Vec3 {
        let outwards = if side == ArmSide::Left { 1.0 } else { -1.0 };
        self.shoulder_middle_m + Vec3::x() * (outwards * fraction::SHOULDER_HALF_WIDTH * self.height_m)
    }

    /// The arm of one side in the pose `directions`.
    #[must_use]
    pub fn arm(&self, side: ArmSide, directions: &ArmDirections) -> ArmJoints {
        let shoulder_m = self.shoulder_m(side);
        let elbow_m = shoulder_m + to_camera(&directions.upper_arm) * self.upper_arm_m();
        let forearm = to_camera(&directions.forearm);
        ArmJoints {
            shoulder_m,
            elbow_m,
            wrist_m: elbow_m + forearm * (fraction::FOREARM * self.height_m),
            hand_m: elbow_m + forearm * self.forearm_m(),
        }
    }

    /// `point`, given in body heights to the left, up and to the front of the middle of the
    /// shoulders.
    fn at(&self, left: f32, up: f32, front: f32) -> Vec3 {
        self.shoulder_middle_m + to_camera(&Vec3::new(left, up, front)) * self.height_m
    }
}

/// Colours of the person.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Clothes {
    /// Skin of hands, face and neck.
    pub skin: Rgb,
    /// Hair.
    pub hair: Rgb,
    /// Shirt on the torso.
    pub shirt: Surface,
    /// Its long sleeves.
    pub sleeve: Surface,
    /// Hood over head and neck where the face does not show.
    pub hood: Rgb,
    /// Glove of a hidden hand.
    pub glove: Rgb,
}

/// An axis-aligned ellipsoid with torso axes left, up, front.
fn ellipsoid(centre: Vec3, radii: Vec3) -> Shape {
    Shape::Ellipsoid { centre, axes: Mat3::from_diagonal(&Vec3::new(1.0, -1.0, -1.0)), radii }
}

/// Torso, neck and head; face and neck show skin if `face_shown`, else the person wears a hood.
#[must_use]
pub fn trunk(body: &Body, clothes: &Clothes, face_shown: bool) -> Vec<(Shape, Surface)> {
    let h = body.height_m;
    let chin = fraction::SHOULDER_TO_CHIN;
    let half_head = 0.5 * fraction::HEAD_HEIGHT;
    let head = ellipsoid(body.at(0.0, chin + half_head, 0.008), Vec3::new(0.046, half_head, 0.057) * h);
    let (face, neck) = if face_shown {
        (Surface::Head { skin: clothes.skin, hair: clothes.hair }, Surface::Plain(clothes.skin))
    } else {
        (Surface::Plain(clothes.hood), Surface::Plain(clothes.hood))
    };
    let shoulder = |left: f32| body.at(left * (fraction::SHOULDER_HALF_WIDTH - 0.012), -0.004, 0.0);
    vec![
        (head, face),
        (
            Shape::Capsule { start: body.at(0.0, 0.0, 0.0), end: body.at(0.0, chin + 0.02, 0.006), radius: 0.031 * h },
            neck,
        ),
        (Shape::Capsule { start: shoulder(1.0), end: shoulder(-1.0), radius: 0.034 * h }, clothes.shirt),
        (ellipsoid(body.at(0.0, -0.10, 0.0), Vec3::new(0.116, 0.125, 0.066) * h), clothes.shirt),
        (ellipsoid(body.at(0.0, -0.28, 0.0), Vec3::new(0.112, 0.29, 0.072) * h), clothes.shirt),
    ]
}

/// Sleeve of an arm, up to the wrist.
#[must_use]
pub fn sleeve(body: &Body, joints: &ArmJoints, clothes: &Clothes) -> [(Shape, Surface); 2] {
    let h = body.height_m;
    let cuff = joints.wrist_m + (joints.elbow_m - joints.wrist_m) * 0.13;
    [
        (Shape::Capsule { start: joints.shoulder_m, end: joints.elbow_m, radius: 0.029 * h }, clothes.sleeve),
        (Shape::Capsule { start: joints.elbow_m, end: cuff, radius: 0.022 * h }, clothes.sleeve),
    ]
}

/// Pose of an arm that hangs with its hand in a pocket.
#[must_use]
pub fn hanging(side: ArmSide) -> ArmDirections {
    let outwards = if side == ArmSide::Left { 1.0 } else { -1.0 };
    ArmDirections {
        upper_arm: Vec3::new(0.24 * outwards, -0.96, -0.14).normalize(),
        forearm: Vec3::new(-0.20 * outwards, -0.96, 0.20).normalize(),
    }
}

/// Pose of an arm whose hand is behind the back.
#[must_use]
pub fn behind_the_back(side: ArmSide) -> ArmDirections {
    let outwards = if side == ArmSide::Left { 1.0 } else { -1.0 };
    ArmDirections {
        upper_arm: Vec3::new(0.20 * outwards, -0.84, -0.50).normalize(),
        forearm: Vec3::new(-0.94 * outwards, -0.20, -0.28).normalize(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limbs_keep_their_lengths_and_left_is_right_of_the_image() {
        let body = Body { height_m: 1.75, shoulder_middle_m: Vec3::new(0.1, -0.1, 1.4) };
        for side in [ArmSide::Left, ArmSide::Right] {
            let joints = body.arm(side, &hanging(side));
            assert!(((joints.elbow_m - joints.shoulder_m).norm() - 0.186 * 1.75).abs() < 1.0e-5);
            assert!(((joints.wrist_m - joints.elbow_m).norm() - 0.146 * 1.75).abs() < 1.0e-5);
            assert!(((joints.hand_m - joints.elbow_m).norm() - 0.200 * 1.75).abs() < 1.0e-5);
            assert!(joints.elbow_m.y > joints.shoulder_m.y, "a hanging arm points down, which is +y");
        }
        assert!(body.shoulder_m(ArmSide::Left).x > body.shoulder_m(ArmSide::Right).x);
        let front = ArmDirections { upper_arm: Vec3::z(), forearm: Vec3::z() };
        assert!(body.arm(ArmSide::Left, &front).hand_m.z < 0.8, "the front is towards the camera");
    }
}
