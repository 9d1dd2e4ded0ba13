//! Temporary files of killed runs. Their names identify the process that wrote them.

use std::fs;
use std::path::Path;

/// First part of the name of every temporary file; no result has such a name.
const PARTIAL: &str = ".partial";

/// Name prefix of the temporary files of this process: `.partial-<host>-<process>-`.
pub fn prefix() -> String {
    format!("{PARTIAL}-{}-{}-", host(), std::process::id())
}

/// Removes the temporary files in `folder` whose process ran on this machine and no longer exists. Files that cannot be
/// removed are left: they do no harm.
pub fn remove(folder: &Path) {
    let host_prefix = format!("{PARTIAL}-{}-", host());
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        let process = name.strip_prefix(&host_prefix).and_then(|rest| rest.split('-').next()?.parse::<i32>().ok());
        if process.is_some_and(has_exited) {
            let _ = fs::remove_file(entry.path());
        }
    }
}

#[cfg(unix)]
fn host() -> String {
    let name = rustix::system::uname();
    name.nodename().to_string_lossy().chars().filter(char::is_ascii_alphanumeric).collect()
}

#[cfg(unix)]
fn has_exited(process: i32) -> bool {
    use rustix::process::{Pid, test_kill_process};
    Pid::from_raw(process).is_none_or(|pid| test_kill_process(pid) == Err(rustix::io::Errno::SRCH))
}

/// Other platforms do not report whether a process exists, so that no file is removed there.
#[cfg(not(unix))]
fn host() -> String {
    String::new()
}

#[cfg(not(unix))]
fn has_exited(_: i32) -> bool {
    false
}

#[cfg(test)]
mod tests {
    use super::{prefix, remove};

    #[cfg(unix)]
    #[test]
    fn only_files_of_processes_that_have_exited_are_removed() {
        let folder = tempfile::tempdir().unwrap();
        let mut child = std::process::Command::new("true").spawn().unwrap();
        let stale = prefix().replace(&std::process::id().to_string(), &child.id().to_string());
        child.wait().unwrap();
        let kept = [format!("{}x", prefix()), ".partial-elsewhere-1-x".into(), "report.json".into(), ".partial".into()];
        for name in kept.iter().chain([&format!("{stale}abc")]) {
            std::fs::write(folder.path().join(name), "half").unwrap();
        }
        remove(folder.path());
        let left: std::collections::BTreeSet<String> = std::fs::read_dir(folder.path())
            .unwrap()
            .map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned())
            .collect();
        assert_eq!(left, kept.into_iter().collect());
    }
}
