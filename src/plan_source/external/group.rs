//! A process and everything that it starts, as one thing that can be ended.

use std::process::{Child, Command};

use crate::interrupt::ProcessGroup;

/// Watches over the process group that is running: with us it ends too, when somebody presses ctrl-C. Being a group of its
/// own, it does not see the signal itself.
pub(crate) struct Guard(ProcessGroup);

impl Guard {
    /// Watches over the process group of `child`, which was started [`apart`].
    pub(crate) fn of(child: &Child) -> Self {
        let group = group(child);
        group.register();
        Self(group)
    }

    /// Ends the group, and the watch. The child itself still has to be waited for.
    pub(crate) fn end(&self, child: &mut Child) {
        self.0.end();
        let _ = child.kill();
        self.0.unregister();
    }

    /// Has the child ended? It is not reaped: as long as it is there, nobody else gets its number, which is the group's.
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

/// Makes the process the first of a group of its own.
pub(crate) fn apart(command: &mut Command) {
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
