//! `--rerun FILE.rrd`: the file is read back, and what it holds are the numbers of the run's
//! tables.

use re_chunk::external::arrow;
use re_chunk::{Chunk, TimelineName};
use re_log_types::LogMsg;
use sinew::viewer::numbers::Numbers;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;

/// Chunks of each entity.
fn entities(file: &Path) -> BTreeMap<String, Vec<Chunk>> {
    let bytes = fs::read(file).unwrap();
    let mut found: BTreeMap<String, Vec<Chunk>> = BTreeMap::new();
    for message in re_log_encoding::DecoderApp::decode_eager(bytes.as_slice()).unwrap() {
        if let LogMsg::ArrowMsg(_, message) = message.unwrap() {
            let chunk = Chunk::from_arrow_msg(&message).unwrap();
            found.entry(chunk.entity_path().to_string()).or_default().push(chunk);
        }
    }
    found
}

/// Frames of an entity.
fn frames(chunks: &[Chunk]) -> Vec<i64> {
    let name = TimelineName::from("frame");
    chunks.iter().flat_map(|chunk| chunk.timelines()[&name].times_raw().to_vec()).collect()
}

/// Numbers of a component, over all rows.
fn numbers(chunks: &[Chunk], component: &str) -> Vec<f64> {
    let mut found = Vec::new();
    for chunk in chunks {
        let column = chunk.components().values().find(|column| column.descriptor.component.as_str() == component);
        let list = &column.unwrap_or_else(|| panic!("{component} in {:?}", chunk.components().keys())).list_array;
        for row in list.iter().flatten() {
            let flat =
                row.as_any().downcast_ref::<arrow::array::FixedSizeListArray>().map(|list| list.values().clone());
            let flat = flat.unwrap_or(row);
            let wide = arrow::compute::cast(&flat, &arrow::datatypes::DataType::Float64).unwrap();
            found.extend(wide.as_any().downcast_ref::<arrow::array::Float64Array>().unwrap().values());
        }
    }
    found
}

/// Runs `sinew` in `folder`; its standard output.
fn sinew(folder: &Path, command: &str) -> String {
    let output =
        Command::new(env!("CARGO_BIN_EXE_sinew")).current_dir(folder).args(command.split(' ')).output().unwrap();
    assert!(output.status.success(), "{command}\n{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// A column of a table.
fn column(table: &Path, name: &str) -> Vec<f64> {
    let mut reader = csv::Reader::from_path(table).unwrap();
    let place = reader.headers().unwrap().iter().position(|header| header == name).unwrap();
    reader.records().map(|record| record.unwrap()[place].parse().unwrap()).collect()
}

#[test]
fn an_arms_run_has_its_frames_blobs_particles_and_curves() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    sinew(folder.path(), "simulate arm --motion builtin --frames 6 --out scene");
    fs::write(at("scene/frames/frame_0003.png"), b"no picture").unwrap();
    let track = "track arm scene/frames --config scene/camera.toml --particles 20 --out run --rerun run.rrd";
    let output = sinew(folder.path(), track);
    assert!(output.contains("6 frames: run.rrd"), "{output}");

    let found = entities(&at("run.rrd"));
    for constant in ["/world", "/world/camera"] {
        assert!(found[constant][0].is_static(), "{constant}");
    }
    for entity in ["/world/camera/blobs", "/world/camera/arm/right", "/world/arm/right", "/world/particles/right"] {
        assert_eq!(frames(&found[entity]), [0, 1, 2, 3, 4, 5], "{entity}");
    }
    // The broken picture is cleared, so that the one before is not shown in its place.
    assert_eq!(frames(&found["/world/camera/frame"]), [0, 1, 2, 4, 5, 3]);
    assert_eq!(numbers(&found["/world/particles/right"], "Points3D:positions").len(), 6 * 20 * 3);
    assert!(!numbers(&found["/world/camera/blobs"], "Points2D:positions").is_empty());

    let likelihood = column(&at("run/track.csv"), "hand_likelihood");
    assert_eq!(numbers(&found["/plots/hand_likelihood/right"], "Scalars:scalars"), likelihood);
    let samples = column(&at("run/track.csv"), "effective_sample_size");
    assert_eq!(numbers(&found["/plots/effective_sample_size/right"], "Scalars:scalars"), samples);
}

#[test]
fn a_bodys_run_has_its_points_and_its_skeleton() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    for name in ["points", "run"] {
        fs::create_dir(at(name)).unwrap();
    }
    // Three frames, the second without a cloud.
    fs::write(at("points/000000.csv"), "x,y,z\n0,0,3\n0.1,0.2,2.9\n").unwrap();
    fs::write(at("points/000002.csv"), "x,y,z\n0.5,0,3\n").unwrap();
    let track = "frame,pelvis_x_m,pelvis_y_m,pelvis_z_m,neck_x_m,neck_y_m,neck_z_m,effective_sample_size,log_evidence,\
        l_wrist_spread_m\n0,0,0,3,0,-0.5,3,30,-1.5,0.02\n1,0,0,3,0,-0.5,3,20,-2.5,0.04\n2,0,0,3,0,-0.5,3,10,-3.5,0.08\n";
    fs::write(at("run/track.csv"), track).unwrap();
    fs::write(at("run/particles.csv"), "frame,particle,weight,l_wrist_x_m,l_wrist_y_m,l_wrist_z_m\n2,0,0.5,1,2,3\n")
        .unwrap();
    let record = serde_json::json!({"rate_hz": 15.0, "body": {}, "inputs": {"clouds": at("points")}});
    fs::write(at("run/run.json"), record.to_string()).unwrap();

    let shown = sinew::viewer::write(&at("run"), &at("run.rrd")).unwrap();
    assert_eq!((shown.frames, shown.notes), (3, Vec::new()));
    let found = entities(&at("run.rrd"));
    for entity in ["/world/points", "/world/skeleton", "/world/particles/l_wrist"] {
        assert_eq!(frames(&found[entity]), [0, 1, 2], "{entity}");
    }
    let points = [0.0, 0.0, 3.0, 0.1, 0.2, 2.9, 0.5, 0.0, 3.0];
    assert_eq!(numbers(&found["/world/points"], "Points3D:positions"), points.map(|x: f32| f64::from(x)));
    assert_eq!(numbers(&found["/world/particles/l_wrist"], "Points3D:positions"), [1.0, 2.0, 3.0]);
    assert_eq!(numbers(&found["/plots/effective_sample_size"], "Scalars:scalars"), [30.0, 20.0, 10.0]);
    assert_eq!(numbers(&found["/plots/spread_m/l_wrist"], "Scalars:scalars"), [0.02, 0.04, 0.08]);
    let seconds = TimelineName::from("time");
    assert_eq!(found["/world/points"][0].timelines()[&seconds].times_raw(), [0, 66_666_667, 133_333_333]);

    fs::remove_file(at("run/particles.csv")).unwrap();
    fs::remove_dir_all(at("points")).unwrap();
    let shown = sinew::viewer::write(&at("run"), &at("run.rrd")).unwrap();
    assert_eq!(shown.notes.len(), 2, "{:?}", shown.notes);
}

#[test]
fn a_cyclic_run_has_its_figure_and_its_cadence() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    sinew(folder.path(), "simulate cyclic --model walking --out walk.csv");
    sinew(folder.path(), "track cyclic walk.csv --model walking --out est.csv --report run --rerun run.rrd");
    let found = entities(&at("run.rrd"));
    let cadence = column(&at("run/estimates.csv"), "cadence_per_min");
    assert_eq!(numbers(&found["/plots/cadence_per_min"], "Scalars:scalars"), cadence);
    assert_eq!(frames(&found["/world/figure"]).len(), cadence.len());
    assert!(found.contains_key("/plots/angles_deg/l_knee"), "{:?}", found.keys());
}

#[test]
fn what_cannot_be_written_is_refused_before_the_run() {
    let folder = tempfile::tempdir().unwrap();
    let refused = |command: &str, what: &str| {
        let mut program = Command::new(env!("CARGO_BIN_EXE_sinew"));
        let output = program.current_dir(folder.path()).args(command.split(' ')).output().unwrap();
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(!output.status.success() && error.contains(what), "{error}");
    };
    refused("track arm frames --out run --rerun run.html", ".rrd");
    refused("track cyclic walk.csv --model walking --out est.csv --rerun run.rrd", "--report");
    assert!(!folder.path().join("run").exists());
}

#[test]
fn what_is_no_number_is_not_there() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("track.csv");
    let text = "frame,side,status,hand_x_m,hand_y_m\n3,left,lost,,1\n3,right,tracking,0.5,-2\n4,left,lost,NaN,\n";
    fs::write(&path, text).unwrap();
    let numbers = Numbers::read(&path, |name| name != "status").unwrap();
    assert_eq!(numbers.len(), 3);
    assert_eq!(numbers.place(0, "hand", ["x_m", "y_m"]), None);
    assert_eq!(numbers.place(1, "hand", ["x_m", "y_m"]), Some([0.5, -2.0]));
    assert_eq!((numbers.get(1, "status"), numbers.get(2, "hand_x_m")), (None, None));
    assert_eq!(numbers.distinct_sides(), ["left", "right"]);
    assert_eq!(numbers.by_frame(), BTreeMap::from([(3, vec![0, 1]), (4, vec![2])]));
}
