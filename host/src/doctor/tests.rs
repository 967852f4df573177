use super::*;
use crate::config::DEFAULT_FILE;
use crate::cyclic::about::About;
use crate::cyclic::facing::Facing;
use crate::cyclic::synthetic_keypoints::{FilmedPerson, Filming};
use crate::cyclic::{CyclicModel, SyntheticPerson};
use crate::skin::model::DEFAULT_SKIN;
use image::{Rgb, RgbImage};
use std::fs;

fn texts(diagnosis: &Diagnosis) -> String {
    diagnosis.findings.iter().map(|finding| format!("{:?}: {}\n", finding.severity, finding.text)).collect()
}

fn frames(folder: &Path, names: &[&str], size: (u32, u32), colour: [u8; 3]) {
    for name in names {
        let mut image = RgbImage::from_pixel(size.0, size.1, Rgb(colour));
        for (x, y) in [(4, 4), (5, 4), (4, 5), (5, 5)] {
            image.put_pixel(x, y, Rgb([224, 172, 140]));
        }
        image.save(folder.join(name)).unwrap();
    }
}

#[test]
fn valid_frames_have_no_problem() {
    let folder = tempfile::tempdir().unwrap();
    frames(folder.path(), &["f_1.png", "f_2.png", "f_10.png"], (20, 16), [60, 90, 200]);
    fs::rename(folder.path().join("f_10.png"), folder.path().join("f_3.png")).unwrap();
    let diagnosis = examine(folder.path());
    assert_eq!(
        (diagnosis.worst(), diagnosis.what.as_str()),
        (Severity::Good, "folder of images"),
        "{}",
        texts(&diagnosis)
    );
}

#[test]
fn problems_of_frames_are_reported() {
    let folder = tempfile::tempdir().unwrap();
    frames(folder.path(), &["f_1.png", "f_2.png"], (20, 16), [10, 20, 30]);
    frames(folder.path(), &["f_9.png"], (22, 16), [10, 20, 30]);
    fs::write(folder.path().join("f_4.png"), "no picture").unwrap();
    let diagnosis = examine(folder.path());
    let found = texts(&diagnosis);
    for sentence in [
        "Warning: ",
        "f_4.png",
        "Problem: images differ in size (2 of 20x16, 1 of 22x16)",
        "5 numbers between 1 and 9",
        "are dark",
    ] {
        assert!(found.contains(sentence), "{sentence}\n{found}");
    }
    assert_eq!(diagnosis.worst(), Severity::Problem);
}

#[test]
fn configurations_models_and_tables_are_distinguished() {
    let folder = tempfile::tempdir().unwrap();
    let cases: [(&str, &str, Severity, &str); 10] = [
        ("arm.toml", DEFAULT_FILE, Severity::Good, "track arm"),
        ("body.toml", "[root]\npersistence = 0.4\n", Severity::Good, "track body"),
        ("typo.toml", "[tracker]\nparticle = 50\n", Severity::Problem, "particles"),
        ("cut.json", "{\"format\": \"sinew-", Severity::Problem, "no JSON"),
        ("model.json", "{\"format\": \"sinew-cyclic\", \"version\": 99}", Severity::Problem, "model.json"),
        ("other.json", "{\"a\": 1}", Severity::Problem, "neither a list of COCO results"),
        ("table.csv", "frame,neck_rad\n", Severity::Problem, "table.csv"),
        ("notes.md", "", Severity::Problem, "not known"),
        ("walk.bvh", "HIERARCHY", Severity::Problem, "walk.bvh"),
        ("nothing.csv", "", Severity::Problem, ""),
    ];
    for (name, text, severity, sentence) in cases {
        let path = folder.path().join(name);
        fs::write(&path, text).unwrap();
        let diagnosis = examine(&path);
        assert_eq!(diagnosis.worst(), severity, "{name}: {}", texts(&diagnosis));
        assert!(texts(&diagnosis).contains(sentence), "{name}: {}", texts(&diagnosis));
    }
    assert!(texts(&examine(&folder.path().join("gone"))).contains("no such file"));
    let empty = tempfile::tempdir().unwrap();
    assert_eq!(examine(empty.path()).worst(), Severity::Problem);
    assert!(["gaussian", "histogram"].contains(&DEFAULT_SKIN));
}

#[test]
fn recordings_are_told_by_what_they_hold_and_doubts_are_warnings() {
    let folder = tempfile::tempdir().unwrap();
    let model = CyclicModel::from_option("walking").unwrap();
    let person = SyntheticPerson::draw(&model, 30.0, 1).unwrap();
    let filming = Filming {
        frames: 180,
        rate_hz: 30.0,
        height_px: 400.0,
        facing: Facing::Right,
        noise_px: 1.0,
        missing_share: 0.0,
        seed: 1,
    };
    let points = folder.path().join("points.csv");
    fs::write(&points, FilmedPerson::film(&person, &filming).to_csv(&filming)).unwrap();
    let diagnosis = examine(&points);
    assert_eq!((diagnosis.what.as_str(), diagnosis.worst()), ("keypoints", Severity::Good), "{}", texts(&diagnosis));
    assert!(texts(&diagnosis).contains("Good: 30 frames a second"), "{}", texts(&diagnosis));

    let table = folder.path().join("walk.csv");
    person.measured(4, 0.01, 0.0, 1).unwrap().write(&table).unwrap();
    assert_eq!(examine(&table).worst(), Severity::Good, "{}", texts(&examine(&table)));
    let mut about = About::of_source(&points);
    about.doubts.push("the camera pans".to_owned());
    about.write_beside(&table).unwrap();
    assert!(texts(&examine(&table)).contains("Warning: doubt: the camera pans"), "{}", texts(&examine(&table)));
    person.measured(4, 0.01, 0.0, 1).unwrap().at_rate(None).write(&table).unwrap();
    assert!(texts(&examine(&table)).contains("give --rate HZ"), "{}", texts(&examine(&table)));
}

#[test]
fn shipped_models_are_good() {
    let models = Path::new(env!("CARGO_MANIFEST_DIR")).join("models");
    for (name, what) in [("walking.json", "motion model"), ("skin_gaussian.json", "skin model")] {
        let diagnosis = examine(&models.join(name));
        assert_eq!((diagnosis.worst(), diagnosis.what.as_str()), (Severity::Good, what), "{}", texts(&diagnosis));
    }
}
