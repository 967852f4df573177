//! Each target on a few thousand inputs, and on those that failed once.

use sinew_fuzz::allocation::Counting;
use sinew_fuzz::campaign::Inputs;
use sinew_fuzz::execution::execute;
use sinew_fuzz::{regressions, targets};
use std::collections::BTreeSet;
use std::time::{Duration, Instant};

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Executions of each target.
const EXECUTIONS: u64 = 2000;
/// Time after which a costly target has had enough.
const MAX_TIME: Duration = Duration::from_millis(400);

// One test: memory is counted for the whole program.
#[test]
fn no_target_breaks_a_limit() {
    let mut failures = Vec::new();
    for target in targets::all() {
        for (path, input) in regressions::of(target.name).unwrap() {
            if let Some(failure) = execute(target, &input).failure {
                failures.push(format!("{}: {failure}", path.display()));
            }
        }
        let (inputs, start) = (Inputs::new(target, 1), Instant::now());
        for number in 0..EXECUTIONS {
            if let Some(failure) = execute(target, &inputs.input(number)).failure {
                failures.push(format!("{}, input {number}: {failure}", target.name));
                break;
            }
            if start.elapsed() > MAX_TIME {
                break;
            }
        }
    }
    // The hook of `execute` keeps what a panic says.
    failures.iter().for_each(|failure| println!("{failure}"));
    assert!(failures.is_empty());
    let names: BTreeSet<String> = targets::all().map(|target| target.name.to_owned()).collect();
    assert_eq!(names.len(), targets::all().count(), "two targets of one name");
    let folders: BTreeSet<String> = regressions::folders().unwrap().into_iter().collect();
    assert!(folders.is_subset(&names), "{folders:?} beside {names:?}");
}
