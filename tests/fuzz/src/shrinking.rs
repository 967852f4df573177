//! Makes an input that fails shorter, as long as it fails in the same way.

use crate::Target;
use crate::execution::{Failure, execute};
use std::time::{Duration, Instant};

/// Time for one input. Chosen: slow failures are shortened less.
const MAX_TIME: Duration = Duration::from_secs(10);

/// The shortest input found that fails as `failure`.
pub fn shrunk(target: &Target, input: &[u8], failure: &Failure) -> Vec<u8> {
    let start = Instant::now();
    let mut shortest = input.to_vec();
    let mut size = shortest.len() / 2;
    while size > 0 {
        let mut at = 0;
        while at < shortest.len() {
            if start.elapsed() > MAX_TIME {
                return shortest;
            }
            let mut shorter = shortest.clone();
            shorter.drain(at..(at + size).min(shortest.len()));
            if execute(target, &shorter).failure.is_some_and(|found| found.is_like(failure)) {
                shortest = shorter;
            } else {
                at += size;
            }
        }
        size /= 2;
    }
    shortest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_matters_is_left() {
        let run = |bytes: &[u8]| assert!(bytes.iter().filter(|byte| **byte == 7).count() < 2);
        let target = Target { name: "test", run, seeds: Vec::new };
        let input = [1, 2, 7, 3, 3, 3, 7, 7, 0, 1];
        let failure = execute(&target, &input).failure.unwrap();
        assert_eq!(shrunk(&target, &input, &failure), [7, 7]);
    }
}
