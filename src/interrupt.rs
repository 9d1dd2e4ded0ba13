//! Stopped by ctrl-C: at once, whatever is being done, and with a word on what is complete.
//!
//! A watcher of its own ends the process, so that no solver and no writer has to look up from its work. Results appear
//! under their names when they are complete, and not before: what is there stays, what is half written is removed.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::Duration;

use crate::output;

/// Exit code of a command that was stopped.
const STOPPED: i32 = 130;
/// The last word is given this long: nobody may be listening.
const LAST_WORD: Duration = Duration::from_millis(500);

/// Most jobs that are named one by one.
const MOST_NAMES: usize = 5;

/// What is being done at the moment.
static UNDER_WAY: Mutex<RunState> =
    Mutex::new(RunState { partial: BTreeSet::new(), groups: Vec::new(), complete: Vec::new(), open: Vec::new() });

struct RunState {
    /// Files and folders that are worth nothing before they are complete.
    partial: BTreeSet<PathBuf>,
    /// Process groups that do not see the signal themselves.
    groups: Vec<Group>,
    /// Jobs that are done, and those that are not.
    complete: Vec<String>,
    open: Vec<String>,
}

/// Watches for ctrl-C from now on, and for being asked to end in another way.
///
/// Called once, by the program. If it cannot be, ctrl-C ends the process as it ends any other.
pub fn watch() {
    let _ = ctrlc::set_handler(stop);
}

/// Says what is to be done, in order, for the last word. What was said before is forgotten.
pub fn begin(jobs: impl IntoIterator<Item = String>) {
    let mut under_way = lock();
    under_way.complete.clear();
    under_way.open = jobs.into_iter().collect();
}

/// The first of the jobs that are open is done: its results are whole.
pub fn complete_one() {
    let mut under_way = lock();
    if !under_way.open.is_empty() {
        let done = under_way.open.remove(0);
        under_way.complete.push(done);
    }
}

/// A file or a folder that goes with the process as long as this is there.
pub struct Partial(PathBuf);

impl Partial {
    /// Of this path.
    pub fn new(path: &Path) -> Self {
        lock().partial.insert(path.to_owned());
        Self(path.to_owned())
    }
}

impl Drop for Partial {
    fn drop(&mut self) {
        lock().partial.remove(&self.0);
    }
}

/// A process group that ends with this process.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct Group(#[cfg(unix)] pub rustix::process::Pid);

impl Group {
    /// Ends everybody in it.
    pub fn end(self) {
        // An empty group is no error: everybody has gone already. Elsewhere only the command itself can be ended.
        #[cfg(unix)]
        let _ = rustix::process::kill_process_group(self.0, rustix::process::Signal::KILL);
    }

    /// From now on it ends with this process.
    pub fn enrol(self) {
        lock().groups.push(self);
    }

    /// It ends by itself.
    pub fn release(self) {
        lock().groups.retain(|group| *group != self);
    }
}

fn stop() {
    thread::spawn(|| {
        thread::sleep(LAST_WORD);
        std::process::exit(STOPPED);
    });
    let under_way = lock();
    under_way.groups.iter().for_each(|group| group.end());
    for partial in &under_way.partial {
        let _ = if partial.is_dir() { std::fs::remove_dir_all(partial) } else { std::fs::remove_file(partial) };
    }
    output::tell(&last_word(&under_way.complete, &under_way.open));
    std::process::exit(STOPPED);
}

/// What is complete and what is not.
fn last_word(complete: &[String], open: &[String]) -> String {
    let all = complete.len() + open.len();
    let Some((current, rest)) = open.split_first() else {
        return "\nstopped: nothing is half written".to_owned();
    };
    let done = if complete.is_empty() { String::new() } else { format!(": {}", some(complete)) };
    let not_begun = if rest.is_empty() { String::new() } else { format!("; not begun: {}", some(rest)) };
    format!(
        "\nstopped: {} of {all} are complete{done}\nnot complete: {current}, whose files are whole, but may be of two runs{not_begun}\n\
         the summaries are those of the run before",
        complete.len()
    )
}

/// The first few of many names, and how many more there are.
fn some(names: &[String]) -> String {
    let (named, others) = names.split_at(names.len().min(MOST_NAMES));
    let more = if others.is_empty() { String::new() } else { format!(" and {} more", others.len()) };
    format!("{}{more}", named.join(", "))
}

fn lock() -> MutexGuard<'static, RunState> {
    UNDER_WAY.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::last_word;

    #[test]
    fn the_last_word_tells_what_is_complete_and_what_is_not() {
        let jobs = ["a", "b", "c"].map(str::to_owned);
        let word = last_word(&jobs[..1], &jobs[1..]);
        assert!(word.contains("1 of 3 are complete: a\n"), "{word}");
        assert!(word.contains("not complete: b, ") && word.contains("; not begun: c\n"), "{word}");
        let many: Vec<String> = (0..9).map(|number| number.to_string()).collect();
        assert!(last_word(&[], &many).contains("not begun: 1, 2, 3, 4, 5 and 3 more\n"));
        assert!(last_word(&[], &jobs[..1]).contains("0 of 1 are complete\nnot complete: a,"));
        assert!(last_word(&[], &[]).contains("nothing is half written"));
    }
}
