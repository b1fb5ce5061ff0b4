//! Times of several works, taken in turn so that the machine's moods touch all of them alike.

use std::time::Instant;

/// A work by the name of who does it.
pub struct Work<'a> {
    pub name: &'static str,
    pub run: Box<dyn FnMut() + 'a>,
}

/// How long a work takes, and how many times as long as the first one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Time {
    pub seconds: f64,
    pub ratio: f64,
}

/// Rounds in which every work has its turn.
const ROUNDS: usize = 15;

/// A turn takes as many runs as fill this time.
const TURN_SECONDS: f64 = 2e-3;

/// The median times of the works, and the medians of their ratios to the first one within each round.
pub fn time_in_turn(works: &mut [Work]) -> Vec<Time> {
    let repeats: Vec<u32> = works.iter_mut().map(|work| repeats(&mut work.run)).collect();
    let mut rounds = vec![Vec::with_capacity(ROUNDS); works.len()];
    for _ in 0..ROUNDS {
        for ((work, &repeats), times) in works.iter_mut().zip(&repeats).zip(&mut rounds) {
            times.push(time(&mut work.run, repeats));
        }
    }
    let first = rounds.first().cloned().unwrap_or_default();
    let ratios = |times: &[f64]| times.iter().zip(&first).map(|(time, first)| time / first).collect();
    rounds.iter().map(|times| Time { seconds: median(times.clone()), ratio: median(ratios(times)) }).collect()
}

/// How many runs fill a turn; also the first run, which warms up.
fn repeats(run: &mut impl FnMut()) -> u32 {
    let mut repeats = 1;
    while time(run, repeats) * f64::from(repeats) < TURN_SECONDS && repeats < 1 << 20 {
        repeats *= 2;
    }
    repeats
}

/// The time of one of so many runs.
fn time(run: &mut impl FnMut(), repeats: u32) -> f64 {
    let start = Instant::now();
    for _ in 0..repeats {
        run();
    }
    start.elapsed().as_secs_f64() / f64::from(repeats)
}

/// The middle of the numbers; of none, no number.
pub fn median(mut numbers: Vec<f64>) -> f64 {
    numbers.sort_by(f64::total_cmp);
    numbers.get(numbers.len() / 2).copied().unwrap_or(f64::NAN)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn longer_works_take_longer() {
        let spin =
            |count: u64| move || _ = std::hint::black_box((0..count).fold(0, |a, b| std::hint::black_box(a ^ b)));
        let mut works =
            [Work { name: "short", run: Box::new(spin(1_000)) }, Work { name: "long", run: Box::new(spin(20_000)) }];
        let times = time_in_turn(&mut works);
        assert_eq!(times[0].ratio, 1.0);
        assert!(times[1].ratio > 2.0 && times[1].seconds > times[0].seconds, "{times:?}");
    }

    #[test]
    fn the_median_is_the_middle() {
        assert_eq!(median(vec![3.0, 1.0, 2.0]), 2.0);
        assert!(median(Vec::new()).is_nan());
    }
}
