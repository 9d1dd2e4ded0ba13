//! Tells the program its commit, for `harness --version`: that of the checkout, or `HARNESS_COMMIT` where there is none.

use std::path::{Path, PathBuf};
use std::process::Command;

const VARIABLE: &str = "HARNESS_COMMIT";

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-env-changed={VARIABLE}");
    let commit = std::env::var(VARIABLE).ok().or_else(of_checkout);
    println!("cargo::rustc-env={VARIABLE}={}", commit.as_deref().unwrap_or("unknown"));
}

/// The commit of the repository that this folder is the root of; `None` for the sources without one.
fn of_checkout() -> Option<String> {
    let root = PathBuf::from(std::env::var("CARGO_MANIFEST_DIR").ok()?);
    if !root.join(".git").exists() {
        return None;
    }
    // The log of HEAD grows with every commit and every checkout.
    println!("cargo::rerun-if-changed={}", git(&root, &["rev-parse", "--git-path", "logs/HEAD"])?);
    git(&root, &["rev-parse", "--short=10", "HEAD"])
}

fn git(folder: &Path, arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").args(arguments).current_dir(folder).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    output.status.success().then(|| text.trim().to_owned())
}
