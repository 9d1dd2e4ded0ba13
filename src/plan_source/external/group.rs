//! Process groups: a process and everything that it starts.

use std::io;
use std::process::{Child, Command};

use crate::interrupt::ProcessGroup;

/// Terminates a process group when the harness is interrupted: a group of its own does not receive the signal of Ctrl-C.
pub(crate) struct Guard(ProcessGroup);

impl Guard {
    /// Starts `command` in a process group of its own.
    ///
    /// # Errors
    ///
    /// If the process cannot be started.
    pub(crate) fn start(command: &mut Command) -> io::Result<(Child, Self)> {
        apart(command);
        let (child, group) = ProcessGroup::register(|| {
            let child = command.spawn()?;
            let group = group(&child);
            Ok((child, group))
        })?;
        Ok((child, Self(group)))
    }

    /// Terminates and unregisters the group. The child itself still has to be waited for.
    pub(crate) fn end(&self, child: &mut Child) {
        self.0.end();
        let _ = child.kill();
        self.0.unregister();
    }

    /// Whether the child has ended. It is not reaped, so that its number, which is the group's, is not reused.
    #[cfg(unix)]
    pub(crate) fn has_exited(&self, _: &mut Child) -> bool {
        use rustix::process::{WaitId, WaitIdOptions, waitid};
        let options = WaitIdOptions::EXITED | WaitIdOptions::NOWAIT | WaitIdOptions::NOHANG;
        !matches!(waitid(WaitId::Pid(self.0.0), options), Ok(None))
    }

    #[cfg(not(unix))]
    pub(crate) fn has_exited(&self, child: &mut Child) -> bool {
        !matches!(child.try_wait(), Ok(None))
    }
}

/// Has the process started in a group of its own.
fn apart(command: &mut Command) {
    #[cfg(unix)]
    std::os::unix::process::CommandExt::process_group(command, 0);
    #[cfg(not(unix))]
    let _ = command;
}

#[cfg(unix)]
fn group(child: &Child) -> ProcessGroup {
    ProcessGroup(rustix::process::Pid::from_child(child))
}

#[cfg(not(unix))]
fn group(_: &Child) -> ProcessGroup {
    ProcessGroup()
}
