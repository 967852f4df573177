//! `sinew report` as a user types it, over every kind of run directory, whole and broken.

use crate::cyclic_walk;

use serde_json::Value;
use sinew_tests::sinew_command;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use tempfile::TempDir;

fn sinew(args: &[&str]) {
    let output = sinew_command().args(args).output().unwrap();
    assert!(output.status.success(), "{args:?}\n{}", String::from_utf8_lossy(&output.stderr));
}

/// A demo that the tests share; none writes into it.
fn demo() -> &'static Path {
    static DEMO: OnceLock<TempDir> = OnceLock::new();
    let folder = DEMO.get_or_init(|| {
        let folder = tempfile::tempdir().unwrap();
        sinew(&["demo", "--out", folder.path().to_str().unwrap()]);
        folder
    });
    folder.path()
}

/// A copy of the demo's own files, with the pictures as links.
fn copy_of_demo(to: &Path) {
    fs::create_dir_all(to.join("overlay")).unwrap();
    for name in ["run.json", "track.csv", "error.json"] {
        fs::copy(demo().join(name), to.join(name)).unwrap();
    }
    for entry in fs::read_dir(demo().join("overlay")).unwrap() {
        let path = entry.unwrap().path();
        fs::copy(&path, to.join("overlay").join(path.file_name().unwrap())).unwrap();
    }
}

/// A page and what it holds.
struct Page {
    text: String,
    data: Value,
    _folder: TempDir,
}

impl Page {
    fn of(runs: &[&Path]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("page.html");
        let output = sinew_command().arg("report").args(runs).arg("--out").arg(&out).output().unwrap();
        assert!(output.status.success(), "{runs:?}\n{}", String::from_utf8_lossy(&output.stderr));
        let text = fs::read_to_string(&out).unwrap();
        let data = block(&text, "data").unwrap();
        let page = Self { text, data, _folder: folder };
        page.loads_nothing();
        page
    }

    fn loads_nothing(&self) {
        let scripts =
            self.text.split("<script type=\"application/json\"").map(|part| match part.split_once("</script>") {
                Some((json, rest)) if part.starts_with(" id=") && json.contains('>') => rest,
                _ => part,
            });
        // What is no data: the page's own markup, styles and script.
        let own: String = scripts.collect();
        let own = own.replace("http://www.w3.org/2000/svg", "");
        for sign in ["http:", "https:", "src=\"", "href=\"", "url(", "@import", "fetch(", "XMLHttpRequest"] {
            assert!(!own.contains(sign), "{sign}");
        }
        assert!(own.contains("default-src 'none'"));
    }

    fn run(&self, index: usize) -> &Value {
        &self.data["runs"][index]
    }

    /// Text of all notices of the first run.
    fn notices(&self) -> String {
        let notices = self.run(0)["notices"].as_array().unwrap();
        notices
            .iter()
            .map(|notice| format!("{}: {}\n", notice["level"].as_str().unwrap(), notice["text"].as_str().unwrap()))
            .collect()
    }

    fn table(&self, name: &str) -> Option<&Value> {
        self.run(0)["tables"].as_array().unwrap().iter().find(|table| table["name"] == name)
    }

    fn plots(&self) -> Vec<&str> {
        self.run(0)["plots"].as_array().unwrap().iter().map(|plot| plot["id"].as_str().unwrap()).collect()
    }

    /// Pictures of the player of a run.
    fn pictures(&self, run: usize) -> usize {
        let Some(name) = self.run(run)["player"]["pictures"].as_str() else { return 0 };
        block(&self.text, name).unwrap().as_array().unwrap().iter().filter(|picture| picture.is_string()).count()
    }

    /// Every series names a table of its run and columns of that table.
    fn series_have_their_columns(&self) {
        for run in self.data["runs"].as_array().unwrap() {
            for series in run["plots"].as_array().unwrap().iter().flat_map(|plot| plot["series"].as_array().unwrap()) {
                let mut tables = run["tables"].as_array().unwrap().iter();
                let table = tables.find(|table| table["name"] == series["table"]).unwrap_or_else(|| panic!("{series}"));
                let columns: Vec<&str> = table["csv"].as_str().unwrap().lines().next().unwrap().split(',').collect();
                let mut wanted = vec![&series["x"], &series["y"]];
                wanted.extend(
                    ["half", "low", "high"].iter().map(|edge| &series["band"][edge]).filter(|edge| !edge.is_null()),
                );
                for column in wanted {
                    assert!(columns.contains(&column.as_str().unwrap()), "{column} of {series}");
                }
            }
        }
    }
}

fn block(page: &str, id: &str) -> Option<Value> {
    let start = page.split_once(&format!("id=\"{id}\">"))?.1;
    serde_json::from_str(start.split_once("</script>")?.0).ok()
}

#[test]
fn a_demo_becomes_one_page_with_its_frames_plots_and_tables() {
    let page = Page::of(&[demo()]);
    assert_eq!(page.notices(), "");
    assert_eq!(page.pictures(0), 120);
    page.series_have_their_columns();
    let plots = page.plots();
    for id in [
        "arm path",
        "arm space right",
        "arm error_m",
        "arm angles right",
        "arm hand_likelihood",
        "arm effective_sample_size",
    ] {
        assert!(plots.contains(&id), "{plots:?}");
    }
    let csv = page.table("track.csv").unwrap()["csv"].as_str().unwrap();
    assert_eq!(csv, fs::read_to_string(demo().join("track.csv")).unwrap(), "cells are those of the file");
    let facts = page.run(0)["facts"].to_string();
    assert!(facts.contains("\"Seed\",\"value\":\"1\"") && facts.contains(env!("CARGO_PKG_VERSION")), "{facts}");

    // The errors over time are those that the demo sums up.
    let error: Value = serde_json::from_slice(&fs::read(demo().join("error.json")).unwrap()).unwrap();
    let text = page.table("distance_from_truth.csv").unwrap()["csv"].as_str().unwrap();
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let scored = reader.records().skip(16).map(|row| row.unwrap()[3].parse::<f64>().unwrap());
    let values: Vec<f64> = scored.collect();
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    assert!((mean - error["mean_error_m"].as_f64().unwrap()).abs() < 1.0e-4, "{mean} {error}");
}

#[test]
fn a_run_of_500_frames_stays_below_25_megabytes() {
    let folder = tempfile::tempdir().unwrap();
    copy_of_demo(folder.path());
    let track = fs::read_to_string(demo().join("track.csv")).unwrap();
    let (heading, rows) = track.split_once('\n').unwrap();
    let rows: Vec<&str> = rows.lines().collect();
    let mut long = format!("{heading}\n");
    for frame in 0..500 {
        let row = rows[frame % rows.len()];
        let rest: Vec<&str> = row.split(',').skip(2).collect();
        long.push_str(&format!("{frame},frame_{frame:04}.png,{}\n", rest.join(",")));
        let picture = folder.path().join(format!("overlay/frame_{frame:04}.png"));
        if frame >= 120 {
            fs::hard_link(folder.path().join(format!("overlay/frame_{:04}.png", frame % 120)), picture).unwrap();
        }
    }
    fs::write(folder.path().join("track.csv"), long).unwrap();
    let page = Page::of(&[folder.path()]);
    assert_eq!(page.pictures(0), 500);
    assert!((5_000_000..25_000_000).contains(&page.text.len()), "{} bytes", page.text.len());
}

#[test]
fn frames_without_a_row_are_a_doubt() {
    let folder = tempfile::tempdir().unwrap();
    copy_of_demo(folder.path());
    let path = folder.path().join("track.csv");
    let track = fs::read_to_string(&path).unwrap();
    let is_kept = |line: &&str| !["40,", "41,", "42,", "90,"].iter().any(|frame| line.starts_with(frame));
    fs::write(&path, track.lines().filter(is_kept).map(|line| format!("{line}\n")).collect::<String>()).unwrap();
    let page = Page::of(&[folder.path()]);
    assert!(page.notices().contains("warning: doubt: track.csv jumps over frames"), "{}", page.notices());
    let items = page.run(0)["notices"].to_string();
    assert!(items.contains("\"frames 40 to 42\",\"frame 90\""), "{items}");
}

#[test]
fn two_runs_stand_side_by_side() {
    let folder = tempfile::tempdir().unwrap();
    copy_of_demo(folder.path());
    let page = Page::of(&[demo(), folder.path()]);
    assert_eq!((page.pictures(0), page.pictures(1)), (120, 120));
    assert_eq!(page.run(1)["name"], folder.path().to_str().unwrap());
    page.series_have_their_columns();
}

#[test]
fn a_tracked_motion_shows_its_cycles() {
    let folder = tempfile::tempdir().unwrap();
    let [table, out, run] =
        ["walk.csv", "estimate.csv", "run"].map(|name| folder.path().join(name).to_str().unwrap().to_owned());
    cyclic_walk::walk(260, 0.0152).write(Path::new(&table)).unwrap();
    sinew(&["track", "cyclic", &table, "--model", "walking", "--out", &out, "--report", &run, "--seed", "7"]);
    assert_eq!(fs::read(&out).unwrap(), fs::read(Path::new(&run).join("estimates.csv")).unwrap());
    let page = Page::of(&[Path::new(&run)]);
    assert_eq!(page.notices(), "");
    page.series_have_their_columns();
    let plots = page.plots();
    for id in ["cyclic cadence", "cyclic likelihood", "cyclic angles left leg", "cycle knee_flexion", "cycle tempo"] {
        assert!(plots.contains(&id), "{plots:?}");
    }
    let player = &page.run(0)["player"];
    assert_eq!(player["frames"].as_array().unwrap().len(), 260);
    assert_eq!(player["figures"][0]["bones"].as_array().unwrap().len(), 13);
    assert!(page.run(0)["facts"].to_string().contains("\"Seed\",\"value\":\"7\""));

    // A run of an earlier version has no table of estimates.
    fs::remove_file(Path::new(&run).join("estimates.csv")).unwrap();
    fs::write(Path::new(&run).join("joints.trc"), "PathFileType\t4\n").unwrap();
    let page = Page::of(&[Path::new(&run)]);
    let notices = page.notices();
    assert!(
        notices.contains("missing: estimates.csv is not there") && notices.contains("draws no figure"),
        "{notices}"
    );
    assert!(page.plots().contains(&"cycle knee_flexion") && !page.plots().contains(&"cyclic cadence"));
}

#[test]
fn a_tracked_body_shows_its_joints_and_their_errors() {
    let folder = tempfile::tempdir().unwrap();
    let [scene, run] = ["scene", "run"].map(|name| folder.path().join(name).to_str().unwrap().to_owned());
    sinew(&["simulate", "stereo", "--motion", "stick-wave", "--points", "300", "--out", &scene]);
    for frame in 40..300 {
        fs::remove_file(Path::new(&scene).join(format!("points/{frame:06}.ply"))).ok();
    }
    fs::write(Path::new(&scene).join("points/000020.ply"), "ply\nbroken").unwrap();
    sinew(&["track", "body", &scene, "--out", &run, "--particles", "20", "--pictures"]);
    let page = Page::of(&[Path::new(&run)]);
    page.series_have_their_columns();
    let notices = page.notices();
    assert!(notices.contains("skipped: 1 clouds could not be read"), "{notices}");
    assert!(
        ["body path", "body error", "body angles left arm", "body effective_sample_size"]
            .iter()
            .all(|id| page.plots().contains(id))
    );
    assert_eq!(page.run(0)["player"]["figures"].as_array().unwrap().len(), 2);
    assert_eq!(page.run(0)["pictures"][0]["name"], "contact_sheet.png");
    // The mean of the errors over time is that of the run, from the second frame on.
    let report: Value = serde_json::from_slice(&fs::read(Path::new(&run).join("run.json")).unwrap()).unwrap();
    let mut reader =
        csv::Reader::from_reader(page.table("joint_error.csv").unwrap()["csv"].as_str().unwrap().as_bytes());
    let values: Vec<f64> = reader.records().skip(1).map(|row| row.unwrap()[1].parse().unwrap()).collect();
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    assert!((mean - report["joint_error_m"].as_f64().unwrap()).abs() < 1.0e-4, "{mean}");
}

#[test]
fn evaluations_show_errors_against_particles() {
    let folder = tempfile::tempdir().unwrap();
    let [arm, body] = ["arm", "body"].map(|name| folder.path().join(name).to_str().unwrap().to_owned());
    sinew(&[
        "evaluate",
        "arm",
        "--clips",
        "1",
        "--seeds",
        "1",
        "--frames",
        "110",
        "--particles",
        "10,20",
        "--variants",
        "pik",
        "--out",
        &arm,
    ]);
    sinew(&[
        "evaluate",
        "body",
        "--motion",
        "stick-wave",
        "--models",
        "guided",
        "--particles",
        "10,20",
        "--trials",
        "1",
        "--out",
        &body,
    ]);
    let page = Page::of(&[Path::new(&arm), Path::new(&body)]);
    page.series_have_their_columns();
    assert_eq!(page.notices(), "");
    assert!(
        page.plots().contains(&"evaluate arm m") && page.plots().contains(&"evaluate arm options px"),
        "{:?}",
        page.plots()
    );
    let plots = page.run(1)["plots"].to_string();
    assert!(plots.contains("evaluate body error_m stick-wave") && plots.contains("truth_smoothness_m"));
}

#[test]
fn what_is_left_of_an_evaluation_is_shown() {
    let folder = tempfile::tempdir().unwrap();
    let heading = "table,protocol,filter,start,sigma_deg,particles,updates,error_deg\n";
    let rows = "table-1,noisy,coupled,standard,1,,every 1,0.6\ntable-1,noisy,coupled,standard,6,,every 1,2.0\n\
        figure-5b,noisy,particle,uniform,29,100,every 1,12.8\nfigure-5b,noisy,parti";
    fs::write(folder.path().join("cyclic.csv"), format!("{heading}{rows}")).unwrap();
    fs::write(folder.path().join("cyclic.json"), "{\"format\": \"sinew-evaluate-cyclic\", \"versi").unwrap();
    let page = Page::of(&[folder.path()]);
    page.series_have_their_columns();
    assert_eq!(page.plots(), ["evaluate cyclic noise noisy", "evaluate cyclic particles"]);
    let notices = page.notices();
    assert!(
        notices.contains("missing: cyclic.json cannot be read") && notices.contains("cyclic.csv: 1 rows"),
        "{notices}"
    );
}

/// A broken demo: what is done to it, what is said.
type Breakage = (fn(&Path), &'static [&'static str]);

#[test]
fn a_broken_run_shows_what_there_is_and_says_what_is_missing() {
    fn edit(path: &Path, change: impl Fn(String) -> String) {
        fs::write(path, change(fs::read_to_string(path).unwrap())).unwrap();
    }
    let cases: [Breakage; 7] = [
        (|run| fs::remove_file(run.join("run.json")).unwrap(), &["missing: run.json is not there"]),
        (|run| edit(&run.join("run.json"), |text| text[..200].to_owned()), &["missing: run.json cannot be read"]),
        (
            |run| fs::remove_file(run.join("track.csv")).unwrap(),
            &["missing: track.csv is not there", "without numbers"],
        ),
        (
            |run| edit(&run.join("track.csv"), |text| text[..5000].to_owned()),
            &["track.csv: 1 rows have another number of cells"],
        ),
        (
            |run| {
                edit(&run.join("run.json"), |text| {
                    text.replacen("\"version\": 1", "\"version\": 7", 1)
                        .replace("\"complete\": true", "\"complete\": false")
                });
            },
            &[
                "warning: run.json has version 7 of its form, this program knows 1",
                "missing: the run ended after 120 of 120",
            ],
        ),
        (
            |run| {
                fs::write(run.join("overlay/frame_0003.png"), "half").unwrap();
                fs::remove_file(run.join("overlay/frame_0007.png")).unwrap();
            },
            &["missing: 1 pictures cannot be read", "skipped: 1 frames have no picture"],
        ),
        (
            |run| {
                fs::remove_dir_all(run.join("overlay")).unwrap();
                edit(&run.join("track.csv"), |text| text.replace("hand_likelihood", "other"));
            },
            &["note: there are no pictures of the frames", "missing: track.csv has no column hand_likelihood"],
        ),
    ];
    for (break_it, sentences) in cases {
        let folder = tempfile::tempdir().unwrap();
        copy_of_demo(folder.path());
        break_it(folder.path());
        let page = Page::of(&[folder.path()]);
        let notices = page.notices();
        for sentence in sentences {
            assert!(notices.contains(sentence), "{sentence}\n{notices}");
        }
        page.series_have_their_columns();
        let player = &page.run(0)["player"];
        assert!(player["frames"].as_array().unwrap().len() > 10, "{notices}");
    }
}

#[test]
fn names_from_files_cannot_become_markup() {
    const EVIL: &str = "</script><script>alert(1)</script><img src=x onerror=alert(2)>";
    let root = tempfile::tempdir().unwrap();
    let folder = root.path().join("<b>&amp;'run");
    copy_of_demo(&folder);
    let track = fs::read_to_string(folder.join("track.csv")).unwrap();
    fs::write(
        folder.join("track.csv"),
        track.replace("frame_0005.png", EVIL).replace("hand_x_m", &format!("\"{EVIL}\"")),
    )
    .unwrap();
    let report = fs::read_to_string(folder.join("run.json")).unwrap();
    fs::write(folder.join("run.json"), report.replace("scene/frames", EVIL)).unwrap();
    let page = Page::of(&[&folder]);
    assert!(!page.text.contains(EVIL) && !page.text.contains("<b>&amp;") && !page.text.contains("<img src"));
    assert_eq!(page.text.matches("<script").count(), page.text.matches("</script>").count());
    assert_eq!(page.run(0)["name"], folder.to_str().unwrap());
    assert!(page.table("track.csv").unwrap()["csv"].as_str().unwrap().contains(EVIL));
}

#[test]
fn a_folder_of_anything_shows_its_tables() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scores.json"), "{\"rows\": [{\"f1\": 0.5}, {\"f1\": 0.6}], \"model\": \"gaussian\"}")
        .unwrap();
    fs::write(folder.path().join("empty.csv"), "").unwrap();
    let page = Page::of(&[folder.path()]);
    assert_eq!(page.table("scores.json: rows").unwrap()["csv"], "f1\n0.5\n0.6\n");
    assert!(page.notices().contains("missing: empty.csv has no rows"), "{}", page.notices());
}

#[test]
fn what_is_no_run_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| -> PathBuf { folder.path().join(name) };
    fs::create_dir(path("empty")).unwrap();
    fs::write(path("file"), "").unwrap();
    let refused = |run: PathBuf, out: &str, sentence: &str| {
        let output = sinew_command().arg("report").arg(run).arg("--out").arg(path(out)).output().unwrap();
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(matches!(output.status.code(), Some(64..=66)) && message.contains(sentence), "{message}");
        assert!(!path(out).exists());
    };
    refused(path("nowhere"), "page.html", "is no folder");
    refused(path("file"), "page.html", "is no folder");
    refused(path("empty"), "page.html", "holds nothing of a run");
    refused(demo().to_path_buf(), "page.pdf", "has to end in .html");
}
