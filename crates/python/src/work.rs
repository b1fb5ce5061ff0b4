//! Long work outside of the interpreter's lock, which Ctrl-C stops.

use std::panic::resume_unwind;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use jaspe_render::Observer;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use rayon::ThreadPool;

/// How often signals are looked for: well below the fifth of a second after which people press Ctrl-C again.
const BEAT: Duration = Duration::from_millis(25);

/// How long stopped work is waited for.
const GRACE: Duration = Duration::from_millis(100);

/// Follows work from another thread, and stops it.
#[derive(Debug, Default)]
pub struct Watch {
    stopped: AtomicBool,
    done: AtomicU64,
    total: AtomicU64,
}

impl Observer for Watch {
    fn progress(&self, done: u64, total: u64) {
        self.total.store(total, Ordering::Relaxed);
        self.done.fetch_max(done, Ordering::Relaxed);
    }

    fn cancelled(&self) -> bool {
        self.stopped.load(Ordering::Relaxed)
    }
}

/// Does work in a thread of its own. Meanwhile `progress`, if there is one, is called with what is done and the total, from
/// the calling thread, and so are Python's signal handlers. What they raise ends the call at once: the work is told to stop,
/// and may take its time about it.
pub fn interruptible<T: Send + 'static>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(&Watch) -> T + Send + 'static,
) -> PyResult<T> {
    let watch = Arc::new(Watch::default());
    let (sender, mut receiver) = channel();
    let body = {
        let watch = Arc::clone(&watch);
        // Nobody listens any more after an interruption.
        move || drop(sender.send(work(&watch)))
    };
    let thread = thread::Builder::new().name("jaspe".to_owned()).spawn(body);
    let thread = thread.map_err(|error| PyRuntimeError::new_err(format!("cannot start a thread: {error}")))?;
    let report = |last: bool| -> PyResult<()> {
        py.check_signals()?;
        let (done, total) = (watch.done.load(Ordering::Relaxed), watch.total.load(Ordering::Relaxed));
        match progress {
            Some(progress) if total > 0 => {
                progress.call1((if last { total } else { done.min(total) }, total))?;
            }
            _ => {}
        }
        Ok(())
    };
    loop {
        let beat = match wait(py, &mut receiver, BEAT) {
            Ok(result) => return report(true).map(|()| result),
            Err(RecvTimeoutError::Timeout) => report(false),
            Err(RecvTimeoutError::Disconnected) => match thread.join() {
                Err(panic) => resume_unwind(panic),
                Ok(()) => return Err(PyRuntimeError::new_err("the work ended without a result")),
            },
        };
        if let Err(raised) = beat {
            watch.stopped.store(true, Ordering::Relaxed);
            // Most work ends within this, and leaves nothing behind.
            let _ = wait(py, &mut receiver, GRACE);
            return Err(raised);
        }
    }
}

/// Does work that borrows from the caller, in a thread of its own; meanwhile Python's signal handlers are called. What they
/// raise ends the call as soon as the work has heeded `stopped`.
pub fn watched(py: Python<'_>, work: impl FnOnce(&AtomicBool) + Send) -> PyResult<()> {
    let stopped = AtomicBool::new(false);
    thread::scope(|scope| {
        let (sender, mut receiver) = channel();
        let shared = &stopped;
        let thread = thread::Builder::new().name("jaspe".to_owned()).spawn_scoped(scope, move || {
            work(shared);
            let _ = sender.send(());
        });
        let thread = thread.map_err(|error| PyRuntimeError::new_err(format!("cannot start a thread: {error}")))?;
        loop {
            match wait(py, &mut receiver, BEAT) {
                Ok(()) => return py.check_signals(),
                Err(RecvTimeoutError::Disconnected) => match thread.join() {
                    Err(panic) => resume_unwind(panic),
                    Ok(()) => return Ok(()),
                },
                Err(RecvTimeoutError::Timeout) => {
                    if let Err(raised) = py.check_signals() {
                        stopped.store(true, Ordering::Relaxed);
                        let _ = py.detach(|| thread.join());
                        return Err(raised);
                    }
                }
            }
        }
    })
}

/// Waits for a result without the interpreter's lock.
fn wait<T: Send>(py: Python<'_>, receiver: &mut Receiver<T>, time: Duration) -> Result<T, RecvTimeoutError> {
    // (A receiver may be lent to another thread, but not shared with it.)
    py.detach(move || receiver.recv_timeout(time))
}

/// The threads of this process. A process that was forked off has none of its parent's and gets its own.
pub fn pool() -> PyResult<Arc<ThreadPool>> {
    static POOL: Mutex<Option<(u32, Arc<ThreadPool>)>> = Mutex::new(None);
    let mut pool = POOL.lock().unwrap_or_else(PoisonError::into_inner);
    let process = std::process::id();
    match &*pool {
        Some((owner, threads)) if *owner == process => return Ok(Arc::clone(threads)),
        _ => {}
    }
    let threads = rayon::ThreadPoolBuilder::new().thread_name(|i| format!("jaspe-{i}")).build();
    let threads = Arc::new(threads.map_err(|error| PyRuntimeError::new_err(format!("cannot start threads: {error}")))?);
    // The parent's pool must not be dropped: its threads are not there to be told.
    std::mem::forget(pool.replace((process, Arc::clone(&threads))));
    Ok(threads)
}
