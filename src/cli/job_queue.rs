//! Jobs side by side, with their results in order.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc;
use std::sync::{PoisonError, RwLock};
use std::thread;

/// Stack of a thread that runs jobs, bytes: more than the main thread has.
const STACK_BYTES: usize = 16 << 20;

/// Works on `items` on several threads, in their order, and hands over the results in the same order, each as soon as it and all
/// before it are there.
///
/// The threads are no workers of the thread pool: a pool worker that waits within one job would take up another one meanwhile,
/// whose time would count as that of the first.
///
/// - `runs_alone`: items beside which nothing else runs
/// - `work`: gets the index and the item
/// - `take`: receives index and result, on the calling thread
///
/// # Errors
///
/// The first of `work` in the order of the items, or the first of `take`; items that have not been started are then left out.
///
/// # Panics
///
/// If `work` or `take` panics, or no thread can be started.
pub fn in_order<T: Sync, R: Send, E: Send>(
    items: &[T],
    threads: usize,
    runs_alone: impl Fn(&T) -> bool + Sync,
    work: impl Fn(usize, &T) -> Result<R, E> + Sync,
    mut take: impl FnMut(usize, R) -> Result<(), E>,
) -> Result<(), E> {
    let threads = threads.min(items.len());
    if threads <= 1 {
        return items.iter().enumerate().try_for_each(|(index, item)| take(index, work(index, item)?));
    }
    let (next, is_stopped, gate) = (AtomicUsize::new(0), AtomicBool::new(false), RwLock::new(()));
    let run = |results: mpsc::Sender<(usize, Result<R, E>)>| {
        let _guard = StopOnPanic(&is_stopped);
        while !is_stopped.load(Ordering::SeqCst) {
            let index = next.fetch_add(1, Ordering::SeqCst);
            let Some(item) = items.get(index) else { return };
            let result = if runs_alone(item) {
                let _alone = gate.write().unwrap_or_else(PoisonError::into_inner);
                work(index, item)
            } else {
                let _beside = gate.read().unwrap_or_else(PoisonError::into_inner);
                work(index, item)
            };
            if result.is_err() {
                is_stopped.store(true, Ordering::SeqCst);
            }
            if results.send((index, result)).is_err() {
                return;
            }
        }
    };
    thread::scope(|scope| {
        let (sender, receiver) = mpsc::channel();
        for _ in 0..threads {
            let (sender, run) = (sender.clone(), &run);
            let thread = thread::Builder::new().stack_size(STACK_BYTES);
            thread.spawn_scoped(scope, move || run(sender)).expect("a thread can be started");
        }
        drop(sender);
        let _guard = StopOnPanic(&is_stopped);
        let taken = take_in_order(&receiver, &mut take);
        is_stopped.store(true, Ordering::SeqCst);
        taken
    })
}

fn take_in_order<R, E>(
    results: &mpsc::Receiver<(usize, Result<R, E>)>,
    take: &mut impl FnMut(usize, R) -> Result<(), E>,
) -> Result<(), E> {
    let mut waiting = BTreeMap::new();
    let mut expected = 0;
    for (index, result) in results {
        waiting.insert(index, result);
        while let Some(result) = waiting.remove(&expected) {
            take(expected, result?)?;
            expected += 1;
        }
    }
    // Of items that were left out after an error, the error is among those that wait.
    waiting.into_values().try_for_each(|result| result.map(|_| ()))
}

/// Keeps the other threads from starting more after a panic.
struct StopOnPanic<'a>(&'a AtomicBool);

impl Drop for StopOnPanic<'_> {
    fn drop(&mut self) {
        if thread::panicking() {
            self.0.store(true, Ordering::SeqCst);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};
    use std::time::Duration;

    use super::in_order;

    /// Later items are ready first.
    fn slow(index: usize) {
        std::thread::sleep(Duration::from_millis(20 - 2 * index as u64));
    }

    #[test]
    fn results_come_in_order_whatever_the_number_of_threads() {
        for threads in [1, 3, 20] {
            let mut taken = Vec::new();
            let work = |index, item: &usize| {
                slow(index);
                Ok::<_, ()>(item * item)
            };
            let items: Vec<usize> = (0..10).collect();
            in_order(
                &items,
                threads,
                |_| false,
                work,
                |index, result| {
                    taken.push((index, result));
                    Ok(())
                },
            )
            .unwrap();
            assert_eq!(taken, (0..10).map(|index| (index, index * index)).collect::<Vec<_>>());
        }
    }

    #[test]
    fn the_first_error_ends_it_and_earlier_results_are_kept() {
        for threads in [1, 4] {
            let started = AtomicUsize::new(0);
            let mut taken = Vec::new();
            let work = |index: usize, _: &usize| {
                started.fetch_add(1, Ordering::SeqCst);
                slow(index.min(9));
                if index >= 3 { Err(index) } else { Ok(index) }
            };
            let items: Vec<usize> = (0..100).collect();
            let error = in_order(
                &items,
                threads,
                |_| false,
                work,
                |index, _| {
                    taken.push(index);
                    Ok(())
                },
            );
            assert_eq!((error, taken), (Err(3), vec![0, 1, 2]));
            assert!(started.into_inner() < 20);
        }
        let refused = in_order(
            &[1, 2, 3, 4],
            2,
            |_| false,
            |_, item| Ok(*item),
            |_, item| if item == 2 { Err("no") } else { Ok(()) },
        );
        assert_eq!(refused, Err("no"));
    }

    #[test]
    fn some_items_run_alone() {
        let running = AtomicUsize::new(0);
        let work = |_: usize, item: &usize| {
            let before = running.fetch_add(1, Ordering::SeqCst);
            std::thread::sleep(Duration::from_millis(2));
            let after = running.fetch_sub(1, Ordering::SeqCst) - 1;
            if *item == 7 { Ok::<_, ()>(before + after) } else { Ok(0) }
        };
        let items: Vec<usize> = (0..40).map(|index| if index % 5 == 0 { 7 } else { index }).collect();
        let mut beside = 0;
        in_order(
            &items,
            4,
            |item| *item == 7,
            work,
            |_, others| {
                beside += others;
                Ok(())
            },
        )
        .unwrap();
        assert_eq!(beside, 0);
    }

    #[test]
    #[should_panic(expected = "panicked")]
    fn a_panic_is_passed_on() {
        let work = |index: usize, _: &usize| if index == 2 { panic!("a bug") } else { Ok::<_, ()>(()) };
        let _ = in_order(&[0; 50], 3, |_| false, work, |_, ()| Ok(()));
    }
}
