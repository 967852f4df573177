use super::*;

fn names(list: &str) -> Vec<String> {
    list.split_whitespace().map(str::to_owned).collect()
}

/// Each point is at (its number, 0, 0), so a joint's place shows its points.
fn found(list: &str) -> [Option<f32>; JOINTS] {
    let names = names(list);
    let sources = JointSources::find(&names, false, Path::new("m")).unwrap();
    let positions: Vec<_> = (0..names.len()).map(|i| Some(Vec3::new(i as f32, 0.0, 0.0))).collect();
    sources.joints(&positions).map(|joint| joint.map(|position| position.x))
}

#[test]
fn the_usual_skeletons_are_known() {
    let cmu = "root lhipjoint lfemur ltibia lfoot rhipjoint rfemur rtibia lowerback thorax lclavicle lhumerus lradius lhand rclavicle rhumerus rradius";
    let wanted = [0.0, 9.0, 10.0, 11.0, 12.0, 14.0, 15.0, 16.0, 1.0, 2.0, 3.0, 5.0, 6.0, 7.0].map(Some);
    assert_eq!(found(cmu), wanted);
    let exported = "Hips LHipJoint LeftUpLeg LeftLeg LeftFoot RHipJoint RightUpLeg RightLeg RightFoot Spine LeftShoulder LeftArm LeftForeArm \
        LeftHand RightShoulder RightArm RightForeArm RightHand";
    let wanted = [0.0, 12.0, 11.0, 12.0, 13.0, 15.0, 16.0, 17.0, 2.0, 3.0, 4.0, 6.0, 7.0, 8.0].map(Some);
    assert_eq!(found(exported), wanted);
    let pose = "LShoulder LElbow LWrist RShoulder RElbow RWrist L.Hip L.Knee L_Ankle x:RHip RKnee RAnkle Neck";
    let wanted = [7.5, 12.0, 0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 11.0].map(Some);
    assert_eq!(found(pose), wanted);
}

#[test]
fn missing_joints_are_listed_with_their_names() {
    let legs = names("LHip LKnee LAnkle RHip RKnee");
    let message = JointSources::find(&legs, false, Path::new("m.trc")).unwrap_err().to_string();
    for part in [
        "m.trc",
        "left shoulder (left_shoulder, leftarm",
        "right ankle (right_ankle, rightfoot",
        "--partial",
        "LHip, LKnee",
    ] {
        assert!(message.contains(part), "{message} lacks {part}");
    }
    assert!(!message.contains("left knee"));
    let sources = JointSources::find(&legs, true, Path::new("m.trc")).unwrap();
    let joints = sources.joints(&[Some(Vec3::x()); 5]);
    assert!(joints[8].is_some() && joints[HIP_CENTER].is_some() && joints[NECK].is_none() && joints[13].is_none());
    assert!(JointSources::find(&names("a b"), true, Path::new("m.trc")).is_err());
}

#[test]
fn hip_joints_follow_from_the_pelvis() {
    // Facing x, up z, left y: fronts at y = +-1, width 2.
    let front = [[1.0, 1.0, 1.0], [1.0, -1.0, 1.0]].map(|p| Some(Vec3::from(p)));
    let back = Some(Vec3::new(-1.0, 0.0, 1.0));
    let left = hip_centre(front, back, 1.0).unwrap();
    assert!((left - Vec3::new(1.0 - 0.44, 0.72, 0.4)).norm() < 1.0e-6, "{left:?}");
    assert!(hip_centre([None; 2], back, 1.0).is_none());
}

/// Eight bones a side, from the collar to the toes; the neck lies between the collars.
#[test]
fn skeletons_of_other_programs_are_known() {
    let part = |pattern: &str, parts: &str, sides: [&str; 2]| -> String {
        let side = |side: &str| {
            parts.split(' ').map(|part| pattern.replace('<', side).replace('>', part) + "|").collect::<String>()
        };
        sides.map(side).concat()
    };
    let arms_and_legs = "collar upperarm forearm hand thigh calf foot ball";
    for (program, list) in [
        ("Unreal", part(">_<", "clavicle upperarm lowerarm hand thigh calf foot ball", ["l", "r"])),
        ("Rigify", part(">.<", "shoulder upper_arm forearm hand thigh shin foot toe", ["L", "R"])),
        ("Rigify", part("DEF->.<", "shoulder upper_arm forearm hand thigh shin foot toe", ["L", "R"])),
        ("Biped", part("Bip01 < >", "Clavicle UpperArm Forearm Hand Thigh Calf Foot Toe0", ["L", "R"])),
        ("Source", part("ValveBiped.Bip01_<_>", "Clavicle UpperArm Forearm Hand Thigh Calf Foot Toe0", ["L", "R"])),
        ("OptiTrack", part("<>", "Shoulder UArm FArm Hand Thigh Shin Foot Toe", ["L", "R"])),
        ("OptiTrack", part("Skeleton_001_<>", "Shoulder UArm FArm Hand Thigh Shin Foot Toe", ["L", "R"])),
        ("VRM", part("J_Bip_<_>", "Shoulder UpperArm LowerArm Hand UpperLeg LowerLeg Foot ToeBase", ["L", "R"])),
        ("Mixamo", part("mixamorig1:<>", "Shoulder Arm ForeArm Hand UpLeg Leg Foot ToeBase", ["Left", "Right"])),
        ("Mixamo", part("mixamorig_<>", "Shoulder Arm ForeArm Hand UpLeg Leg Foot ToeBase", ["Left", "Right"])),
        ("Mixamo", part("mixamorig<>", "Shoulder Arm ForeArm Hand UpLeg Leg Foot ToeBase", ["Left", "Right"])),
        ("lower case", part("xq<>", "shoulder arm forearm hand upleg leg foot toebase", ["left", "right"])),
        ("Reallusion", part("CC_Base_<_>", "Clavicle Upperarm Forearm Hand Thigh Calf Foot ToeBase", ["L", "R"])),
        ("DAZ", part("<>", "Collar ShldrBend ForearmBend Hand ThighBend Shin Foot Toe", ["l", "r"])),
        ("MakeHuman", part(">.<", "clavicle upperarm01 lowerarm01 wrist upperleg01 lowerleg01 foot toe", ["L", "R"])),
        ("Second Life", part("m><", "Collar Shoulder Elbow Wrist Hip Knee Ankle Toe", ["Left", "Right"])),
        ("Kinect", part(">_<", "CLAVICLE SHOULDER ELBOW WRIST HIP KNEE ANKLE TOE", ["LEFT", "RIGHT"])),
        ("short", part("<_>", "Collar Arm ForeArm Hand UpLeg Leg Foot Toe", ["L", "R"])),
        ("any", part("< >", arms_and_legs, ["left", "right"])),
    ] {
        let names: Vec<String> = list.split('|').filter(|name| !name.is_empty()).map(str::to_owned).collect();
        let sources = JointSources::find(&names, false, Path::new(program)).unwrap_or_else(|error| panic!("{error}"));
        let motion = line_of_points(&names);
        let joints = sources.of_motion(&motion)[0].map(|joint| joint.map(|position| position.x));
        let wanted = [8.0, 4.0, 1.0, 2.0, 3.0, 9.0, 10.0, 11.0, 4.0, 5.0, 6.0, 12.0, 13.0, 14.0].map(Some);
        assert_eq!(joints, wanted, "{program}: {names:?}");
        let toes = sources.feet_of_motion(&motion)[0].map(|[heel, toe]| (heel, toe.map(|toe| toe.x)));
        assert_eq!(toes, [(None, Some(7.0)), (None, Some(15.0))], "{program}");
    }
}

fn line_of_points(names: &[String]) -> MarkerMotion {
    let positions_m = vec![(0..names.len()).map(|i| Some(Vec3::new(i as f32, 0.0, 0.0))).collect()];
    MarkerMotion { names: names.to_vec(), positions_m, ..MarkerMotion::default() }
}

/// Points of the left side by marker set; `1+2` is the middle of two. Hips come from the pelvis
/// where they are not given.
#[test]
fn marker_sets_are_known() {
    let opensim = "R.ASIS L.ASIS V.Sacral {}.Thigh.Upper {}.Shank.Front {}.Heel {}.Toe.Tip {}.Acromium {}.Bicep {}.Elbow \
        {}.Wrist.Med {}.Wrist.Lat {}.Knee.Lat {}.Knee.Med {}.Ankle.Lat {}.Ankle.Med {}.Forearm {}.Clavicle";
    let vicon = "S:LASI S:RASI S:LPSI S:RPSI S:{}THI S:{}KNE S:{}TIB S:{}ANK S:{}HEE S:{}TOE S:{}SHO S:{}UPA S:{}ELB S:{}FRM \
        S:{}WRA S:{}WRB S:C7 S:CLAV";
    let cast = "L_IAS R_IAS L_IPS R_IPS {}_FLE {}_FME {}_FAL {}_TAM {}_FCC {}_FM2 {}_SAE {}_HLE {}_HME {}_RSP {}_USP";
    let helen_hayes =
        "R.ASIS L.ASIS V.Sacral {}.Thigh {}.Knee {}.Shank {}.Ankle {}.Heel {}.Toe {}.Shoulder {}.Elbow {}.Wrist";
    let opencap = "r.ASIS_study L.ASIS_study r.PSIS_study L.PSIS_study {}_knee_study {}_mknee_study {}_ankle_study \
        {}_mankle_study {}_toe_study {}_calc_study {}_shoulder_study {}_lelbow_study {}_melbow_study {}_lwrist_study \
        {}_mwrist_study {}HJC_study {}_thigh1_study {}_sh1_study";
    let pose = "{}Hip {}Knee {}Ankle {}BigToe {}SmallToe {}Heel Neck Nose {}Shoulder {}Elbow {}Wrist";
    for (set, list, joints, foot) in [
        (
            "OpenSim",
            opensim,
            ["Acromium", "Elbow", "Wrist.Lat+Wrist.Med", "", "Knee.Lat+Knee.Med", "Ankle.Lat+Ankle.Med"],
            ["Heel", "Toe.Tip"],
        ),
        ("Vicon", vicon, ["SHO", "ELB", "WRA+WRB", "", "KNE", "ANK"], ["HEE", "TOE"]),
        ("CAST", cast, ["SAE", "HLE+HME", "RSP+USP", "", "FLE+FME", "FAL+TAM"], ["FCC", "FM2"]),
        ("Helen Hayes", helen_hayes, ["Shoulder", "Elbow", "Wrist", "", "Knee", "Ankle"], ["Heel", "Toe"]),
        (
            "OpenCap",
            opencap,
            ["shoulder", "lelbow+melbow", "lwrist+mwrist", "HJC", "knee+mknee", "ankle+mankle"],
            ["calc", "toe"],
        ),
        ("Pose2Sim", pose, ["Shoulder", "Elbow", "Wrist", "Hip", "Knee", "Ankle"], ["Heel", "BigToe"]),
    ] {
        let sided = |name: &str| {
            if name.contains("{}") {
                vec![name.replace("{}", "L"), name.replace("{}", "R")]
            } else {
                vec![name.to_owned()]
            }
        };
        let names: Vec<String> = list.split_whitespace().flat_map(sided).collect();
        let sources = JointSources::find(&names, false, Path::new(set)).unwrap_or_else(|error| panic!("{error}"));
        let place = |side: &str, name: &str| {
            let is_it = |other: &String| {
                let plain = |text: &str| text.replace(['.', '_'], "").replace("study", "").replace("S:", "");
                plain(other) == plain(&format!("{side}{name}"))
            };
            names.iter().position(is_it).unwrap_or_else(|| panic!("{set}: {side}{name}")) as f32
        };
        let found = sources.joints(&line_of_points(&names).positions_m[0]);
        let feet = sources.feet_of_motion(&line_of_points(&names))[0];
        for (side, letter) in ["L", "R"].into_iter().enumerate() {
            for (limb, name) in joints.iter().enumerate().filter(|(_, name)| !name.is_empty()) {
                let parts: Vec<f32> = name.split('+').map(|name| place(letter, name)).collect();
                let wanted = parts.iter().sum::<f32>() / parts.len() as f32;
                let joint = found[limb_joint(limb, side)].map(|position| position.x);
                assert_eq!(joint, Some(wanted), "{set}: {letter} {name}");
            }
            assert_eq!(feet[side].map(|point| point.unwrap().x), foot.map(|name| place(letter, name)), "{set}");
            assert!(sources.sources[HIPS[side]].is_some(), "{set}");
        }
    }
}

#[test]
fn markers_that_are_never_seen_do_not_count() {
    let list = "LHip RHip LKnee LKneeMed RKnee LAnkle RAnkle LShoulder RShoulder LElbow RElbow LWrist RWrist";
    let mut motion = line_of_points(&names(list));
    let knee = |motion: &MarkerMotion| {
        let sources = JointSources::of_seen(motion, false, Path::new("m")).unwrap();
        sources.of_motion(motion)[0][HIPS[0] + 1].map(|place| place.x)
    };
    assert_eq!(knee(&motion), Some(2.5));
    motion.positions_m[0][3] = None;
    assert_eq!(knee(&motion), Some(2.0));
}

#[test]
fn a_missing_joint_has_a_line_with_the_nearest_name() {
    let list = "LHip RHip LKnie RKnee LAnkle RAnkle LShoulder RShoulder LElbow RElbow LWrist Qq";
    let message = JointSources::find(&names(list), false, Path::new("m.trc")).unwrap_err().to_string();
    let lines: Vec<&str> = message.lines().collect();
    assert_eq!(lines[0], "motion `m.trc` lacks 2 of 12 limb joints:");
    assert!(lines[1].starts_with("  left knee (left_knee, ") && lines[1].ends_with("the nearest name is `LKnie`"));
    assert!(lines[2].starts_with("  right wrist (") && lines[3].contains("--names FILE"), "{message}");
    assert!(lines.iter().all(|line| line.len() < 200), "{message}");
}
