use super::*;
use crate::motion::reach::random_reaches;
use image::Rgb;

fn scene(change: impl FnOnce(&mut SceneOptions)) -> Scene {
    let mut options = SceneOptions { frames: 60, noise_std: 1.0, seed: 11, ..SceneOptions::default() };
    change(&mut options);
    Scene::new(&random_reaches(3, 15.0, 60).unwrap(), &options).unwrap()
}

/// Mean colour of the drawn skin, in chromaticity (r, g).
fn skin_chromaticity(scene: &Scene) -> [f32; 2] {
    let lit = scene.clothes.skin.component_mul(&scene.light.colour) * 0.8;
    let [r, g, b] = [lit.x, lit.y, lit.z].map(palette::encode);
    [r / (r + g + b), g / (r + g + b)]
}

/// Pixels within `radius_px` of `centre` whose chromaticity is that of the skin.
fn skin_pixels(scene: &Scene, image: &RgbImage, centre: [f32; 2], radius_px: f32) -> usize {
    let [r, g] = skin_chromaticity(scene);
    let like_skin = |Rgb([red, green, blue]): &Rgb<u8>| {
        let sum = f32::from(*red) + f32::from(*green) + f32::from(*blue) + 1.0;
        (f32::from(*red) / sum - r).abs() < 0.025 && (f32::from(*green) / sum - g).abs() < 0.02
    };
    let near = |x: u32, y: u32| (x as f32 - centre[0]).hypot(y as f32 - centre[1]) <= radius_px;
    image.enumerate_pixels().filter(|(x, y, pixel)| near(*x, *y) && like_skin(pixel)).count()
}

#[test]
fn the_hand_is_drawn_where_the_truth_says() {
    for seed in 0..6 {
        let scene = scene(|options| {
            options.seed = seed;
            options.false_blob_fraction = 0.0;
            options.hidden_fraction = 0.3;
            options.background = BackgroundStyle::Plain;
        });
        let mut shown = 0;
        for frame in (0..60).step_by(3) {
            let truth = scene.truth(frame).sides[0];
            let (Some(pixel), image) = (truth.hand_px(&scene.camera()), scene.render(frame)) else { continue };
            let radius_px = 0.09 * scene.camera().focal_px() / truth.joints.hand_m.z;
            let skin = skin_pixels(&scene, &image, [pixel.u_px, pixel.v_px], radius_px);
            let disc = core::f32::consts::PI * radius_px * radius_px;
            let share = skin as f32 / disc;
            if truth.hand_visible {
                shown += 1;
                assert!(share > 0.08, "seed {seed} frame {frame}: {share} of the disc is skin");
            } else if scene.arms[0].hidden[frame].is_some() {
                assert!(share < 0.03, "seed {seed} frame {frame}: a hidden hand shows {share}");
            }
        }
        assert!(shown >= 8, "seed {seed}: the hand shows in {shown} of 20 frames");
    }
}

#[test]
fn shares_of_face_and_hidden_hand_are_as_asked() {
    let scene = scene(|options| {
        options.frames = 200;
        options.hidden_fraction = 0.1;
    });
    let truths: Vec<FrameTruth> = (0..200).map(|frame| scene.truth(frame)).collect();
    assert_eq!(truths.iter().filter(|t| t.false_blob).count(), 100);
    assert_eq!(scene.arms[0].hidden.iter().flatten().count(), 20);
    let unseen = truths.iter().filter(|t| !t.sides[0].hand_visible).count();
    assert!((20..50).contains(&unseen), "{unseen} frames without a hand");
}

#[test]
fn the_face_shows_skin_only_in_its_frames() {
    let made = (0..50).map(|seed| {
        scene(|options| {
            options.seed = seed;
            options.hidden_fraction = 0.0;
            options.background = BackgroundStyle::Plain;
            options.away = Some(0..60);
        })
    });
    // Brown hair has the chromaticity of skin: take someone whose hair is nearly grey.
    let grey = |scene: &Scene| scene.clothes.hair.x < 1.3 * scene.clothes.hair.z;
    let scene = made.into_iter().find(grey).unwrap();
    let head_m = scene.body.shoulder_middle_m - Vec3::y() * (0.10 * scene.body.height_m);
    let head = scene.camera.project(&head_m).unwrap();
    for frame in [10, 20, 30, 40, 50] {
        let skin = skin_pixels(&scene, &scene.render(frame), [head.u_px, head.v_px], 25.0);
        if scene.truth(frame).false_blob {
            assert!(skin > 700, "frame {frame}: {skin} px of face");
        } else {
            assert!(skin < 200, "frame {frame}: {skin} px of face");
        }
    }
}

#[test]
fn a_hand_that_is_away_is_not_seen_and_returns_to_its_path() {
    let with = scene(|options| options.away = Some(20..50));
    let without = scene(|_| {});
    for frame in 0..60 {
        let (here, there) = (with.truth(frame).sides[0], without.truth(frame).sides[0]);
        if (20..50).contains(&frame) {
            assert!(!here.hand_visible);
        } else {
            assert_eq!(here, there);
        }
    }
    assert!(with.truth(35).sides[0].joints.hand_m.z > with.body.shoulder_middle_m.z, "the hand is behind the body");
}

#[test]
fn a_seed_fixes_every_byte_and_frames_do_not_depend_on_each_other() {
    let (one, two) = (scene(|_| {}), scene(|_| {}));
    let _ = one.render(3);
    assert_eq!(one.render(17), two.render(17));
    assert_eq!(one.truth_csv(), two.truth_csv());
    assert_ne!(one.render(17), scene(|options| options.seed = 12).render(17));
    assert_ne!(one.render(17), one.render(18));
}

/// FNV-1a of a frame: the same in debug and release, on every machine.
#[test]
fn the_bytes_of_a_frame_are_the_same_in_every_build() {
    let image = scene(|options| options.sides = Sides::Both).render(5);
    let hash = image
        .as_raw()
        .iter()
        .fold(0xcbf2_9ce4_8422_2325_u64, |hash, &byte| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3));
    assert_eq!(hash, 0x3284_1dc2_49e5_cc90, "{hash:#018x}");
}

#[test]
fn limbs_keep_the_body_s_lengths() {
    let scene = scene(|options| {
        options.sides = Sides::Both;
        options.body_height_m = 1.6;
    });
    for frame in 0..60 {
        let truth = scene.truth(frame);
        assert_eq!(truth.sides.iter().map(|s| s.side).collect::<Vec<_>>(), [ArmSide::Left, ArmSide::Right]);
        for side in truth.sides {
            let joints = side.joints;
            assert_eq!(joints.shoulder_m, scene.body.shoulder_m(side.side));
            assert!(((joints.elbow_m - joints.shoulder_m).norm() - 0.186 * 1.6).abs() < 1.0e-4);
            assert!(((joints.hand_m - joints.elbow_m).norm() - 0.200 * 1.6).abs() < 1.0e-4);
        }
    }
}

#[test]
fn every_option_out_of_range_is_named() {
    type Change = fn(&mut SceneOptions);
    let cases: [(Change, &str); 9] = [
        (|o| o.width_px = 0, "width_px"),
        (|o| o.frames = 0, "frames"),
        (|o| o.frames_per_second = 0.0, "frames_per_second"),
        (|o| o.body_height_m = f32::NAN, "body_height_m"),
        (|o| o.false_blob_fraction = 1.5, "false_blob_fraction"),
        (|o| o.hidden_fraction = -0.1, "hidden_fraction"),
        (|o| o.noise_std = f32::INFINITY, "noise_std"),
        (|o| o.away = Some(5..100), "away"),
        (|o| o.field_of_view_rad = 4.0, "field_of_view_rad"),
    ];
    let motion = random_reaches(1, 15.0, 10).unwrap();
    for (change, name) in cases {
        let mut options = SceneOptions { frames: 20, ..SceneOptions::default() };
        change(&mut options);
        assert_eq!(Scene::new(&motion, &options).unwrap_err().parameter, name);
    }
}

#[test]
fn a_picture_of_one_pixel_is_drawn() {
    let scene = scene(|options| {
        options.width_px = 1;
        options.height_px = 1;
    });
    assert_eq!(scene.render(0).dimensions(), (1, 1));
}
