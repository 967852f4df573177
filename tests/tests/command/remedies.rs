//! Every refusal names what was wrong and how to put it right, once.

use sinew_tests::sinew_command;
use std::fs;
use std::path::Path;

/// Commands that read something, with `INPUT` in its place.
const READERS: [&str; 30] = [
    "batch INPUT --out o",
    "angles INPUT --out o.csv",
    "cut INPUT --out o.csv",
    "track cyclic INPUT --model walking --out o.csv",
    "track cyclic walk.csv --model INPUT --out o.csv",
    "track cyclic walk.csv --model walking --overlay INPUT --out o.csv",
    "train cyclic --cuts INPUT --out o.json",
    "evaluate cyclic --model INPUT --out o",
    "evaluate cyclic --train INPUT --out o",
    "evaluate cyclic --test INPUT --seeds 1 --out o",
    "export INPUT --out o.c",
    "record INPUT --out o.stream",
    "report INPUT --out o.html",
    "segment INPUT --out o",
    "segment in --skin INPUT --out o",
    "blobs INPUT",
    "track arm INPUT --out o",
    "track arm in --config INPUT --out o",
    "track body INPUT --out o",
    "track body in --config INPUT --out o",
    "track body in --camera INPUT --out o",
    "evaluate hands INPUT --boxes boxes.csv",
    "evaluate hands in --boxes INPUT",
    "train skin --images INPUT --masks INPUT --out o.json",
    "train skin --pixels INPUT --out o.json",
    "evaluate skin --images INPUT --masks INPUT",
    "simulate arm --motion INPUT --out o",
    "simulate stereo --motion INPUT --out o",
    "evaluate arm --mocap INPUT --clips 1 --seeds 1 --out o",
    "evaluate body --motion INPUT --trials 1 --particles 5 --out o",
];

/// Words of which every remedy has one.
const REMEDIES: [&str; 10] = [
    "give ",
    "check ",
    "make one",
    "put ",
    "writes one",
    "needs ",
    "begins with",
    "has to be",
    "a row is",
    "not valid TOML",
];

fn message(folder: &Path, words: &str) -> (Option<i32>, String) {
    let output = sinew_command().current_dir(folder).args(words.split_whitespace()).output().unwrap();
    assert!(output.stdout.is_empty(), "{words}: {}", String::from_utf8_lossy(&output.stdout));
    (output.status.code(), String::from_utf8(output.stderr).unwrap())
}

#[test]
fn missing_empty_and_wrong_inputs_are_reported_with_the_remedy() {
    let root = tempfile::tempdir().unwrap();
    let folder = root.path();
    fs::create_dir(folder.join("empty")).unwrap();
    fs::create_dir(folder.join("in")).unwrap();
    image::RgbImage::new(8, 8).save(folder.join("in/0.png")).unwrap();
    fs::write(folder.join("boxes.csv"), "frame,x,y,w,h\n0,1,1,4,4\n").unwrap();
    fs::write(folder.join("words.txt"), "words").unwrap();
    let made =
        sinew_command().current_dir(folder).args("simulate cyclic --model walking --out walk.csv".split(' ')).output();
    assert!(made.unwrap().status.success());
    for reader in READERS {
        for input in ["missing", "empty", "words.txt"] {
            let words = reader.replace("INPUT", input);
            let (code, text) = message(folder, &words);
            assert!(
                matches!(code, Some(64..=66)) && text.starts_with("error: ") && text.contains(input),
                "{words}: {code:?} {text}"
            );
            assert!(REMEDIES.iter().any(|remedy| text.contains(remedy)), "{words}: no remedy in {text}");
            assert!(text.matches("os error").count() <= 1 && !text.contains("panicked"), "{words}: {text}");
        }
    }
}

#[test]
fn a_slip_of_the_finger_gets_the_right_word() {
    let root = tempfile::tempdir().unwrap();
    for (words, right) in [
        ("trakc arm in", "track"),
        ("track bodi in", "body"),
        ("track arm in --ovrlay", "--overlay"),
        ("track arm in --out o --partciles 9", "--particles"),
        ("track arm in --out o --side rigth", "right"),
        ("evaluate boddy", "body"),
        ("completions bsh", "bash"),
        ("blobs in --jsno", "--json"),
    ] {
        let (code, text) = message(root.path(), words);
        assert!(code == Some(64) && text.contains(right) && text.contains("similar"), "{words}: {text}");
    }
}

/// The tests are built without the feature `rerun`.
#[test]
fn a_build_without_the_viewer_says_how_to_get_one() {
    let root = tempfile::tempdir().unwrap();
    fs::create_dir(root.path().join("in")).unwrap();
    for words in [
        "track arm in --out run --rerun run.rrd",
        "track body in --out run --rerun run.rrd",
        "track cyclic walk.csv --model walking --out est.csv --report run --rerun run.rrd",
    ] {
        let (code, text) = message(root.path(), words);
        assert!(code == Some(64) && text.contains("`--rerun` is not part of this build"), "{words}: {text}");
        assert!(text.contains("`cargo install --locked --path host --features rerun` has it"), "{words}: {text}");
        assert_eq!(fs::read_dir(root.path()).unwrap().count(), 1, "{words} wrote something");
    }
}
