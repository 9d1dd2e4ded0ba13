//! The report page: `index.html`, one file that needs neither network nor server.
//!
//! | part | content | read by |
//! |---|---|---|
//! | data | `summary.json`, every `report.json`, campaigns, the comparison with a baseline | `results`, `campaigns` |
//! | scenes | every `scene.json`, compressed, unpacked by the browser when a result is opened | `results` |
//! | scripts, styles | `assets/` and uPlot 1.6.32 (MIT, `vendor/uplot/LICENSE`) | here |
//!
//! The page computes nothing: every figure is one of the judge's, and every line one of the scene's.

mod campaigns;
mod json_file;
mod results;

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use serde::Serialize;

use crate::campaign::comparison::Comparison;
use crate::error::Error;
use crate::output;
use results::{Results, Scene};

/// Name of the page in a result folder.
pub const FILE_NAME: &str = "index.html";
/// Name of the comparison with a baseline in a result folder.
const COMPARISON: &str = "comparison.json";

const STYLES: [&str; 2] = [include_str!("page/vendor/uplot/uPlot.min.css"), include_str!("page/assets/page.css")];
const CHART_LIBRARY: &str = include_str!("page/vendor/uplot/uPlot.iife.min.js");
const SCRIPTS: [&str; 15] = [
    include_str!("page/assets/elements.js"),
    include_str!("page/assets/numbers.js"),
    include_str!("page/assets/colours.js"),
    include_str!("page/assets/data.js"),
    include_str!("page/assets/projection.js"),
    include_str!("page/assets/labels.js"),
    include_str!("page/assets/shapes.js"),
    include_str!("page/assets/scene.js"),
    include_str!("page/assets/player.js"),
    include_str!("page/assets/plots.js"),
    include_str!("page/assets/checks.js"),
    include_str!("page/assets/budget.js"),
    include_str!("page/assets/campaigns.js"),
    include_str!("page/assets/job.js"),
    include_str!("page/assets/main.js"),
];

/// Writes `comparison.json` into the result folder `out`, from which the page shows `old` beside the results; without a
/// comparison, removes that of an earlier run.
///
/// - `old`: the reference, a result folder or a baseline file
///
/// # Errors
///
/// [`Error::Write`] if the file cannot be written or removed.
pub fn write_comparison(out: &Path, compared: Option<(&Path, &Comparison)>) -> Result<(), Error> {
    let path = out.join(COMPARISON);
    let Some((old, comparison)) = compared else { return output::remove_stale(&path) };
    let counts = comparison.counts_line();
    output::write_json(&path, &ComparisonFile { old: &old.to_string_lossy(), counts, comparison })
}

/// The content of `comparison.json`.
#[derive(Serialize)]
struct ComparisonFile<'a> {
    old: &'a str,
    counts: String,
    #[serde(flatten)]
    comparison: &'a Comparison,
}

/// Writes the page about everything in the result folder `out`, and returns its path.
///
/// # Errors
///
/// [`Error::Results`] if the folder has no results or one of them cannot be read, [`Error::Write`] if the page cannot be
/// written.
pub fn write(out: &Path) -> Result<PathBuf, Error> {
    let (results, scenes) = Results::read(out)?;
    let path = out.join(FILE_NAME);
    output::write_file(&path, |writer| write_page(writer, &results, &scenes))?;
    Ok(path)
}

fn write_page(writer: &mut dyn Write, results: &Results, scenes: &[Scene]) -> io::Result<()> {
    writeln!(writer, "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">")?;
    writeln!(writer, "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">")?;
    writeln!(writer, "<meta name=\"color-scheme\" content=\"dark light\">\n<link rel=\"icon\" href=\"data:,\">")?;
    writeln!(writer, "<title>{}</title>", escaped(&results.title()))?;
    for style in STYLES {
        writeln!(writer, "<style>\n{style}\n</style>")?;
    }
    writeln!(writer, "</head>\n<body>\n<noscript>This page needs JavaScript; summary.md has the verdicts.</noscript>")?;
    writeln!(writer, "<div id=\"page\"></div>")?;
    writeln!(writer, "<script type=\"application/json\" id=\"data\">{}</script>", script_json(results)?)?;
    for Scene { id, base64 } in scenes {
        writeln!(writer, "<script type=\"application/gzip\" id=\"{id}\">{base64}</script>")?;
    }
    writeln!(writer, "<script>{CHART_LIBRARY}</script>\n<script type=\"module\">")?;
    for script in SCRIPTS {
        writeln!(writer, "{script}")?;
    }
    writeln!(writer, "</script>\n</body>\n</html>")
}

/// JSON in which nothing ends the script element.
fn script_json(value: &impl Serialize) -> io::Result<String> {
    Ok(serde_json::to_string(value)?.replace('<', "\\u003c"))
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::{escaped, script_json};

    #[test]
    fn no_name_ends_an_element() {
        assert_eq!(script_json(&["</script><!--"]).unwrap(), r#"["\u003c/script>\u003c!--"]"#);
        assert_eq!(escaped("a<b>&c"), "a&lt;b&gt;&amp;c");
    }
}
