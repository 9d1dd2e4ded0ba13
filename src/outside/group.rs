//! A process and everything that it starts, as one thing that can be ended.

use std::process::{Child, Command};
use std::sync::{Mutex, MutexGuard, Once, PoisonError};

/// The process group that runs at the moment, to be ended with us when somebody presses ctrl-C: it does not see the
/// signal itself, being a group of its own.
static RUNNING: Mutex<Option<Group>> = Mutex::new(None);

/// Exit code of a run that was stopped.
const STOPPED: i32 = 130;

/// Watches over the process group that is running.
pub(super) struct Guard(Group);

impl Guard {
    /// Watches over the process group of `child`, which was started [`apart`].
    pub(super) fn of(child: &Child) -> Self {
        static HANDLER: Once = Once::new();
        HANDLER.call_once(|| {
            let stop = || {
                if let Some(group) = running().as_ref() {
                    group.end();
                }
                std::process::exit(STOPPED);
            };
            // without a handler, ctrl-C still stops us; only the command would live on until its own end
            let _ = ctrlc::set_handler(stop);
        });
        let group = Group::of(child);
        *running() = Some(group);
        Self(group)
    }

    /// Ends the group, and the watch. The child itself still has to be waited for.
    pub(super) fn end(&self, child: &mut Child) {
        self.0.end();
        let _ = child.kill();
        *running() = None;
    }

    /// Has the child ended? It is not reaped: as long as it is there, nobody else gets its number, which is the group's.
    #[cfg(unix)]
    pub(super) fn has_exited(&self, _: &mut Child) -> bool {
        use rustix::process::{WaitId, WaitIdOptions, waitid};
        let options = WaitIdOptions::EXITED | WaitIdOptions::NOWAIT | WaitIdOptions::NOHANG;
        !matches!(waitid(WaitId::Pid(self.0.0), options), Ok(None))
    }

    #[cfg(not(unix))]
    pub(super) fn has_exited(&self, child: &mut Child) -> bool {
        !matches!(child.try_wait(), Ok(None))
    }
}

fn running() -> MutexGuard<'static, Option<Group>> {
    RUNNING.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Makes the process the first of a group of its own.
pub(super) fn apart(command: &mut Command) {
    #[cfg(unix)]
    std::os::unix::process::CommandExt::process_group(command, 0);
    #[cfg(not(unix))]
    let _ = command;
}

#[cfg(unix)]
#[derive(Clone, Copy)]
struct Group(rustix::process::Pid);

#[cfg(unix)]
impl Group {
    fn of(child: &Child) -> Self {
        Self(rustix::process::Pid::from_child(child))
    }

    fn end(self) {
        // an empty group is no error: everybody has gone already
        let _ = rustix::process::kill_process_group(self.0, rustix::process::Signal::KILL);
    }
}

/// Elsewhere only the command itself is ended.
#[cfg(not(unix))]
#[derive(Clone, Copy)]
struct Group;

#[cfg(not(unix))]
impl Group {
    fn of(_: &Child) -> Self {
        Self
    }

    fn end(self) {}
}
