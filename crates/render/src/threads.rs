//! Threads that wait for the next rendering, since starting them takes as long as a small picture's first tiles.

use std::sync::{Mutex, PoisonError};

use rayon::prelude::*;
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

/// Deals items out to the threads of this pool, one by one and in order, so that all end together, however long each item
/// takes. `work` is called with the items of one thread; what its calls return comes in no order.
pub(crate) fn deal<I: Send, T: Send>(
    items: impl Iterator<Item = I> + Send,
    work: impl Fn(&mut dyn Iterator<Item = I>) -> T + Sync,
) -> Vec<T> {
    let items = Mutex::new(items);
    let next = || items.lock().unwrap_or_else(PoisonError::into_inner).next();
    let hands = (0..rayon::current_num_threads()).into_par_iter().with_max_len(1);
    hands.map(|_| work(&mut std::iter::from_fn(next))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_item_is_dealt_once_and_in_order() {
        for threads in [1, 2, 5] {
            let hands = run(Some(threads), || deal(0..1000, |items| items.collect::<Vec<u32>>()));
            assert_eq!(hands.len(), threads);
            assert!(hands.iter().all(|hand| hand.is_sorted()));
            let mut all = hands.concat();
            all.sort_unstable();
            assert!(all.into_iter().eq(0..1000));
        }
    }
}
