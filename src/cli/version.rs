//! What `harness --version` prints.

use std::sync::LazyLock;

/// Features of Cargo.toml, and whether this build has them.
const FEATURES: [(&str, bool); 3] =
    [("rrd", cfg!(feature = "rrd")), ("mcap", cfg!(feature = "mcap")), ("parquet", cfg!(feature = "parquet"))];

static LONG: LazyLock<String> = LazyLock::new(|| {
    let built: Vec<&str> = FEATURES.iter().filter(|(_, is_built)| *is_built).map(|(name, _)| *name).collect();
    let features = if built.is_empty() { "none".to_owned() } else { built.join(", ") };
    format!("{}\ncommit {}\nfeatures {features}", env!("CARGO_PKG_VERSION"), env!("HARNESS_COMMIT"))
});

/// Version, commit and features, one per line.
pub fn long() -> &'static str {
    &LONG
}
