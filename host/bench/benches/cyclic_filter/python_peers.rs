//! The same task in Python, in a process of its own: `benches/peers/particle_filter.py`.

use std::path::Path;
use std::process::Command;

/// Names, median and least milliseconds a step; nothing where Python or numpy is missing.
pub fn run(count: usize, frames: usize) -> Vec<(String, [f64; 2])> {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/peers/particle_filter.py");
    let python = std::env::var("PYTHON").unwrap_or_else(|_| "python3".into());
    let mut command = Command::new(&python);
    command.arg(script).args([count.to_string(), frames.to_string()]);
    // One thread for numpy's products as well.
    for name in ["OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"] {
        command.env(name, "1");
    }
    let output = match command.output() {
        Ok(output) if output.status.success() => output,
        Ok(output) => {
            eprintln!("no Python peers: {}", String::from_utf8_lossy(&output.stderr).trim());
            return Vec::new();
        }
        Err(error) => {
            eprintln!("no Python peers: `{python}`: {error}; set PYTHON to an interpreter with numpy");
            return Vec::new();
        }
    };
    eprint!("{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8_lossy(&output.stdout);
    let line = |line: &str| {
        let mut parts = line.split_whitespace();
        Some((parts.next()?.to_owned(), [parts.next()?.parse().ok()?, parts.next()?.parse().ok()?]))
    };
    text.lines().filter_map(line).collect()
}
