//! The features that the host's dependencies turn on, such as `std` of the linear algebra, do not
//! change a bit of the trackers.

use sinew_digest::{FRAMES, Line, Subject};
use std::path::Path;

#[test]
fn the_trackers_built_for_the_host_give_the_expected_digests() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/digest/expected.txt");
    let expected = std::fs::read_to_string(path).unwrap();
    let lines = Subject::ALL.map(|subject| {
        let digest = subject.digest(FRAMES).unwrap();
        format!("{}\n", Line { subject, digest })
    });
    assert_eq!(
        lines.concat(),
        expected,
        "after a wanted change: SINEW_REGENERATE=1 cargo test --release -p sinew-digest"
    );
}
