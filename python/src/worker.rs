//! Long calls: on a thread of their own, without the interpreter's lock, with progress, and interruptible.
//!
//! ```text
//! caller  --- waits, shows progress, looks for Ctrl-C -----------------> result or exception
//! worker  --- plans, flies, judges; at every report of progress it ends if it has been stopped
//! ```
//!
//! A stopped worker unwinds from its next report of progress. A panic becomes the exception `Bug`.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use pyo3::prelude::*;

use crate::error::Bug;

/// Time between two looks for Ctrl-C, and between two messages of progress.
const INTERVAL: Duration = Duration::from_millis(50);
/// Stack of the worker, bytes: that of a main thread.
const STACK_BYTES: usize = 8 << 20;

/// What a worker unwinds with when it has been stopped.
struct Stopped;

enum Message<T> {
    Progress(String),
    End(Result<T, Box<dyn Any + Send>>),
}

/// The worker's connection to its caller.
pub struct Reporter {
    send: Box<dyn Fn(String) + Send>,
    stopped: Arc<AtomicBool>,
    last: Instant,
}

impl Reporter {
    /// Reports progress, unless it did a moment ago. Does not return if the worker has been stopped.
    pub fn report(&mut self, text: impl FnOnce() -> String) {
        if self.stopped.load(Ordering::Relaxed) {
            resume_unwind(Box::new(Stopped));
        }
        if self.last.elapsed() >= INTERVAL {
            self.last = Instant::now();
            (self.send)(text());
        }
    }
}

/// The first exception of a Python function that a worker called.
#[derive(Clone, Default)]
pub struct Failure(Arc<Mutex<Option<PyErr>>>);

impl Failure {
    /// Keeps the exception, and ends the worker.
    pub fn end_with(&self, error: PyErr) -> ! {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
        resume_unwind(Box::new(Stopped))
    }

    fn take(&self) -> Option<PyErr> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).take()
    }
}

/// Runs `work` on a thread, and waits for it.
///
/// - `progress`: a Python function, which is called with lines of text
/// - `failure`: where Python functions that `work` calls put their exception
///
/// # Errors
///
/// What `failure` holds, an exception of `progress`, `KeyboardInterrupt`, or `Bug` after a panic.
pub fn run<T: Send + 'static>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    failure: &Failure,
    work: impl FnOnce(&mut Reporter) -> T + Send + 'static,
) -> PyResult<T> {
    let (sender, receiver) = channel();
    let stopped = Arc::new(AtomicBool::new(false));
    let reporter = reporter(sender.clone(), &stopped);
    let body = move || {
        let mut reporter = reporter;
        let result = catch_unwind(AssertUnwindSafe(|| work(&mut reporter)));
        let _ = sender.send(Message::End(result));
    };
    thread::Builder::new().stack_size(STACK_BYTES).spawn(body)?;
    let end = wait(py, progress, receiver);
    stopped.store(true, Ordering::Relaxed);
    match end? {
        Ok(result) => Ok(result),
        Err(payload) => Err(failure.take().unwrap_or_else(|| Bug::new_err(panic_text(payload.as_ref())))),
    }
}

fn reporter<T: Send + 'static>(sender: Sender<Message<T>>, stopped: &Arc<AtomicBool>) -> Reporter {
    // Nobody listens any more after an interruption.
    let send = move |text| drop(sender.send(Message::Progress(text)));
    Reporter { send: Box::new(send), stopped: Arc::clone(stopped), last: Instant::now() }
}

/// The result of the worker, or what it unwound with.
fn wait<T: Send>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    mut receiver: Receiver<Message<T>>,
) -> PyResult<Result<T, Box<dyn Any + Send>>> {
    loop {
        let message;
        (message, receiver) = py.detach(move || (receiver.recv_timeout(INTERVAL), receiver));
        match message {
            Ok(Message::End(result)) => return Ok(result),
            Ok(Message::Progress(text)) => {
                if let Some(progress) = progress {
                    progress.call1((text,))?;
                }
            }
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => return Err(Bug::new_err("the worker ended without a result")),
        }
        py.check_signals()?;
    }
}

fn panic_text(payload: &(dyn Any + Send)) -> String {
    let text = payload.downcast_ref::<String>().map(String::as_str).or(payload.downcast_ref::<&str>().copied());
    text.unwrap_or("a panic without a message").to_owned()
}
