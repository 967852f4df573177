//! The page about a run, from a folder of a run.

use crate::Target;
use crate::file::{file, folder};
use sinew::report::Page;
use std::fs;

/// `run.json`, and a table, of a run folder.
pub const TARGETS: &[Target] = &[
    Target { name: "report_json", run: |bytes| report("run.json", bytes), seeds: || vec![RUN.into(), BODY.into()] },
    Target { name: "report_table", run: |bytes| report("track.csv", bytes), seeds: || vec![TRACK.into()] },
];

const RUN: &str = r#"{"format": "sinew-arm-run", "report_version": 1, "sinew_version": "0.2.0", "complete": true,
"options": {"folder": "images", "side": "right", "seed": 1, "rate_hz": 15.0, "config": {"tracker": {"particles": 50}}},
"frames_finished": 2, "frames_in_all": 2, "image_size_px": [640, 480], "skipped": [{"frame": 1, "file": "b.png", "reason": "cut"}],
"frames_per_second": 30.5, "lost": 0, "files": ["a.png", "b.png"]}"#;
const BODY: &str = r#"{"format": "sinew-body-run", "report_version": 1, "complete": false, "options": {"folder": "clouds"},
"frames_finished": 2, "error_m": 0.01, "skipped": []}"#;
const TRACK: &str = "frame,time_s,side,status,hand_x_m,hand_y_m,hand_z_m,hand_u_px,hand_v_px,hand_std_m\n\
    0,0.000,right,tracking,0.1,0.2,1.1,300,200,0.02\n1,0.067,right,lost,,,,,,\n2,0.133,right,tracking,0.1,0.2,1.1,301,200,0.02\n";

fn report(name: &str, bytes: &[u8]) {
    let run = folder().join("run");
    fs::create_dir_all(&run).expect("a temporary folder");
    for (other, text) in [("run.json", RUN), ("track.csv", TRACK)] {
        let _ = file(&format!("run/{other}"), text.as_bytes());
    }
    let _ = file(&format!("run/{name}"), bytes);
    let Ok(page) = Page::read(&[&run]) else { return };
    page.write(&mut Vec::new()).expect("memory takes it");
}
