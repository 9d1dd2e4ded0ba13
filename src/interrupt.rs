//! Interruption by ctrl-C or a termination signal: the process ends at once and says which jobs are complete.
//!
//! A watcher thread ends the process, so that neither solvers nor writers have to poll for the signal. Results appear
//! under their names only when they are complete: complete results stay, incomplete ones are removed.

use std::collections::BTreeSet;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::Duration;

use crate::console;

/// Exit code of an interrupted command: 128 + SIGINT.
const EXIT_CODE: i32 = 130;
/// Longest time from the signal to the exit: a command may be about to start, standard error may be blocked.
const STOP_TIMEOUT: Duration = Duration::from_secs(2);
/// Largest number of jobs that are listed by name.
const MAX_NAMES: usize = 5;

/// State of the running command.
static RUN_STATE: Mutex<RunState> =
    Mutex::new(RunState { incomplete: BTreeSet::new(), process_groups: Vec::new(), jobs: Vec::new() });

struct RunState {
    /// Files and folders that are of no use until they are complete.
    incomplete: BTreeSet<PathBuf>,
    /// Process groups that do not receive the signal themselves.
    process_groups: Vec<ProcessGroup>,
    jobs: Vec<(String, JobState)>,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum JobState {
    NotStarted,
    Running,
    Complete,
}

/// Installs the handler for ctrl-C and termination signals. Called once, by the program.
///
/// If it cannot be installed, ctrl-C ends the process in the default way of the operating system.
pub fn watch() {
    let _ = ctrlc::set_handler(stop);
}

/// Sets the list of jobs, in order, for the summary. Replaces an earlier list.
pub fn begin_jobs(jobs: impl IntoIterator<Item = String>) {
    lock().jobs = jobs.into_iter().map(|job| (job, JobState::NotStarted)).collect();
}

/// Marks the job of this index as running.
pub fn start_job(index: usize) {
    set_state(index, JobState::Running);
}

/// Marks the job of this index as complete.
pub fn complete_job(index: usize) {
    set_state(index, JobState::Complete);
}

fn set_state(index: usize, to: JobState) {
    if let Some((_, state)) = lock().jobs.get_mut(index) {
        *state = to;
    }
}

/// A guard: its file or folder is removed if the process is interrupted while the guard exists.
pub struct RemoveOnInterrupt(PathBuf);

impl RemoveOnInterrupt {
    /// Guards this path.
    pub fn new(path: &Path) -> Self {
        lock().incomplete.insert(path.to_owned());
        Self(path.to_owned())
    }
}

impl Drop for RemoveOnInterrupt {
    fn drop(&mut self) {
        lock().incomplete.remove(&self.0);
    }
}

/// A process group that is killed when this process is interrupted.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct ProcessGroup(#[cfg(unix)] pub rustix::process::Pid);

impl ProcessGroup {
    /// Kills every process in the group.
    pub fn end(self) {
        // An empty group is not an error: its processes have already exited. Without process groups (Windows) only the
        // command itself can be killed, by its owner.
        #[cfg(unix)]
        let _ = rustix::process::kill_process_group(self.0, rustix::process::Signal::KILL);
    }

    /// Starts a process that leads a group, and kills the group on interruption from now on. An interruption in the meantime
    /// waits for it, so that no process is left behind unknown.
    ///
    /// # Errors
    ///
    /// Those of `start`.
    pub fn register<T>(start: impl FnOnce() -> io::Result<(T, Self)>) -> io::Result<(T, Self)> {
        let mut state = lock();
        let (process, group) = start()?;
        state.process_groups.push(group);
        Ok((process, group))
    }

    /// Undoes [`register`](Self::register).
    pub fn unregister(self) {
        lock().process_groups.retain(|group| *group != self);
    }
}

fn stop() {
    thread::spawn(|| {
        thread::sleep(STOP_TIMEOUT);
        std::process::exit(EXIT_CODE);
    });
    let state = lock();
    state.process_groups.iter().for_each(|group| group.end());
    for path in &state.incomplete {
        let _ = if path.is_dir() { std::fs::remove_dir_all(path) } else { std::fs::remove_file(path) };
    }
    console::eprint(&interrupt_summary(&state.jobs));
    std::process::exit(EXIT_CODE);
}

/// Which jobs are complete and which are not.
fn interrupt_summary(jobs: &[(String, JobState)]) -> String {
    let names = |wanted: JobState| -> Vec<&str> {
        jobs.iter().filter(|(_, state)| *state == wanted).map(|(name, _)| name.as_str()).collect()
    };
    let [complete, running, waiting] = [JobState::Complete, JobState::Running, JobState::NotStarted].map(names);
    if running.is_empty() && waiting.is_empty() {
        return "\nstopped: no incomplete files are left".to_owned();
    }
    let mut lines = vec![format!("\nstopped: {} of {} are complete", complete.len(), jobs.len())];
    if !complete.is_empty() {
        lines[0] += &format!(": {}", first_names(&complete));
    }
    if !running.is_empty() {
        let folders = if running.len() == 1 { "its folder" } else { "their folders" };
        lines.push(format!("not complete: {}; {folders} may mix files from two runs", first_names(&running)));
    }
    if !waiting.is_empty() {
        lines.push(format!("not started: {}", first_names(&waiting)));
    }
    lines.push("the summaries are still those of the previous run".to_owned());
    lines.join("\n")
}

/// The first [`MAX_NAMES`] names, and the number of the others.
fn first_names(names: &[&str]) -> String {
    let (named, others) = names.split_at(names.len().min(MAX_NAMES));
    let more = if others.is_empty() { String::new() } else { format!(" and {} more", others.len()) };
    format!("{}{more}", named.join(", "))
}

fn lock() -> MutexGuard<'static, RunState> {
    RUN_STATE.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::{JobState, interrupt_summary};

    #[test]
    fn the_summary_lists_complete_and_incomplete_jobs() {
        let jobs = |states: &[JobState]| -> Vec<(String, JobState)> {
            states.iter().enumerate().map(|(index, state)| (format!("job-{index}"), *state)).collect()
        };
        let (done, runs, waits) = (JobState::Complete, JobState::Running, JobState::NotStarted);
        let text = interrupt_summary(&jobs(&[done, runs, waits]));
        assert!(text.contains("1 of 3 are complete: job-0\n"), "{text}");
        assert!(
            text.contains("not complete: job-1; its folder may") && text.contains("\nnot started: job-2\n"),
            "{text}"
        );
        let text = interrupt_summary(&jobs(&[runs, done, runs]));
        assert!(text.contains("1 of 3 are complete: job-1\nnot complete: job-0, job-2; their folders may"), "{text}");
        assert!(
            interrupt_summary(&jobs(&[waits; 9]))
                .contains("not started: job-0, job-1, job-2, job-3, job-4 and 4 more\n")
        );
        for all in [&[][..], &[done, done]] {
            assert!(interrupt_summary(&jobs(all)).contains("no incomplete files"));
        }
    }
}
