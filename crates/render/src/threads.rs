//! Threads that wait for the next rendering, since starting them takes as long as a small picture's first tiles.

use std::sync::{Mutex, PoisonError};

use rayon::{ThreadPool, ThreadPoolBuilder};

/// Threads that nobody uses, and how many were asked for. A process that is the copy of another has none of its threads, so
/// they remember where they are.
struct Idle {
    process: u32,
    threads: usize,
    pool: ThreadPool,
}

static IDLE: Mutex<Option<Idle>> = Mutex::new(None);

/// Runs work on so many threads, or as many as the machine has.
pub(crate) fn run<T: Send>(threads: Option<usize>, work: impl FnOnce() -> T + Send) -> T {
    let (threads, process) = (threads.unwrap_or(0), std::process::id());
    let idle = IDLE.lock().unwrap_or_else(PoisonError::into_inner).take();
    let pool = match idle {
        Some(idle) if (idle.threads, idle.process) == (threads, process) => Ok(idle.pool),
        Some(idle) if idle.process != process => {
            // There are no threads to say good-bye to.
            std::mem::forget(idle);
            ThreadPoolBuilder::new().num_threads(threads).build()
        }
        _ => ThreadPoolBuilder::new().num_threads(threads).build(),
    };
    match pool {
        Ok(pool) => {
            let result = pool.install(work);
            *IDLE.lock().unwrap_or_else(PoisonError::into_inner) = Some(Idle { process, threads, pool });
            result
        }
        // No threads to be had: work goes on in this one's own pool.
        Err(_) => work(),
    }
}
