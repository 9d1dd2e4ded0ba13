//! What a killed run leaves: files under temporary names, which no result has. They tell which process they belonged to.

use std::fs;
use std::path::Path;

const PARTIAL: &str = ".partial";

/// Beginning of the names of our own temporary files: `.partial-<host>-<process>-`.
pub fn prefix() -> String {
    format!("{PARTIAL}-{}-{}-", host(), std::process::id())
}

/// Removes the files that a process of this machine left in a folder and that will never be completed, since the process is
/// gone. What cannot be removed stays: it is in nobody's way.
pub fn remove(folder: &Path) {
    let ours = format!("{PARTIAL}-{}-", host());
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        let process = name.strip_prefix(&ours).and_then(|rest| rest.split('-').next()?.parse::<i32>().ok());
        if process.is_some_and(is_gone) {
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
fn is_gone(process: i32) -> bool {
    use rustix::process::{Pid, test_kill_process};
    Pid::from_raw(process).is_none_or(|pid| test_kill_process(pid) == Err(rustix::io::Errno::SRCH))
}

/// Elsewhere nobody can be asked who is gone.
#[cfg(not(unix))]
fn host() -> String {
    String::new()
}

#[cfg(not(unix))]
fn is_gone(_: i32) -> bool {
    false
}

#[cfg(test)]
mod tests {
    use super::{prefix, remove};

    #[cfg(unix)]
    #[test]
    fn what_a_process_left_that_is_gone_is_removed_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let mut child = std::process::Command::new("true").spawn().unwrap();
        let gone = prefix().replace(&std::process::id().to_string(), &child.id().to_string());
        child.wait().unwrap();
        let kept = [format!("{}x", prefix()), ".partial-elsewhere-1-x".into(), "report.json".into(), ".partial".into()];
        for name in kept.iter().chain([&format!("{gone}abc")]) {
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
