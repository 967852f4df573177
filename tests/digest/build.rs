//! Linker scripts for the program that runs on an emulated Cortex-M.

use std::env;
use std::fs;
use std::path::Path;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rerun-if-changed=memory.x");
    println!("cargo:rerun-if-changed=memory_secure.x");
    if env::var("CARGO_CFG_TARGET_OS")? == "none" && env::var("CARGO_CFG_TARGET_ARCH")? == "arm" {
        let out = env::var("OUT_DIR")?;
        let memory = if env::var("TARGET")?.starts_with("thumbv8m") { "memory_secure.x" } else { "memory.x" };
        fs::copy(memory, Path::new(&out).join("memory.x"))?;
        println!("cargo:rustc-link-search={out}");
        println!("cargo:rustc-link-arg-examples=-Tlink.x");
    }
    Ok(())
}
