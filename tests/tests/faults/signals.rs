//! Signals at any moment.

use crate::kinds::Kind;
use sinew_core::random::Stream;
use std::os::unix::process::ExitStatusExt;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// How often each kind is killed by each signal, unless `SINEW_FAULTS` says otherwise.
const FEW: usize = 1;

fn times() -> usize {
    std::env::var("SINEW_FAULTS").map_or(FEW, |count| count.parse().expect("SINEW_FAULTS is a number"))
}

#[test]
fn an_arm_goes_on_after_any_signal() {
    survives(&Kind::arm());
}

#[test]
fn a_body_goes_on_after_any_signal() {
    survives(&Kind::body());
}

#[test]
fn rows_that_are_written_at_once_go_on_after_any_signal() {
    survives(&Kind::rows());
}

#[test]
fn rows_that_are_kept_go_on_after_any_signal() {
    survives(&Kind::motions());
}

#[test]
fn an_evaluation_goes_on_after_any_signal() {
    survives(&Kind::evaluation());
}

/// Sends each signal at random moments of a run, resumes, and compares every byte.
fn survives(kind: &Kind) {
    let start = Instant::now();
    assert_eq!(Kind::ends(kind.command("whole", &[])).0, Some(0));
    let duration_s = start.elapsed().as_secs_f32();
    let whole = kind.files("whole");
    let mut stream = Stream::new(34, 0, 0);
    for number in 0..times() {
        for (signal, name, code) in
            [(9, "KILL", None), (15, "TERM", Some(143)), (2, "INT", Some(130)), (1, "HUP", Some(129))]
        {
            let (out, share) = (format!("{name}{number}"), stream.uniform());
            let what = format!("{name} after {share} of {duration_s} s");
            let mut child = kind.command(&out, kind.often()).stderr(Stdio::null()).spawn().unwrap();
            std::thread::sleep(Duration::from_secs_f32(share * duration_s));
            let sent = Command::new("kill").args([&format!("-{name}"), &child.id().to_string()]).output().unwrap();
            let status = child.wait().unwrap();
            if status.success() {
                assert!(kind.files(&out) == whole, "{what}: it was over, and differs");
                continue;
            }
            assert!(sent.status.success(), "{what}: {status}");
            let is_early = !kind.is_unfinished(&out);
            // Before signals are handled, and before the first checkpoint, nothing can be lost.
            assert!(is_early || status.code() == code || status.signal() == Some(signal), "{what}: {status}");
            if is_early {
                assert_eq!(Kind::ends(kind.command(&out, &[])).0, Some(0), "{what}");
                assert!(kind.files(&out) == whole, "{what}: begun anew, it differs");
            } else {
                kind.assert_resumes(&out, &whole, &what);
            }
        }
    }
}
