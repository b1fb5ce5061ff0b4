//! The first root of a quartic within an interval.

/// Coefficients from the constant up.
pub(super) type Quartic = [f64; 5];

/// The smallest root between `low` and `high` at which the sign changes.
///
/// Between two neighbouring roots of its derivative a polynomial runs one way, and so has one root at most, which bisection
/// finds for certain and Newton's steps soon. The roots of the derivative come from those of its own, and so on down.
pub(super) fn first_root(quartic: &Quartic, low: f64, high: f64) -> Option<f64> {
    let mut turns = Turns { points: [low, high, 0.0, 0.0, 0.0], count: 2 };
    for order in [3, 2, 1] {
        turns = turns.refined(&derivative(quartic, order), high);
    }
    let slope = derivative(quartic, 1);
    turns.points[..turns.count].windows(2).find_map(|ends| root(quartic, &slope, ends[0], ends[1]))
}

/// Ends of the intervals on which a polynomial runs one way.
struct Turns {
    points: [f64; 5],
    count: usize,
}

impl Turns {
    /// The roots of `polynomial`, which runs one way between the present points, with the ends of all.
    fn refined(&self, polynomial: &Quartic, high: f64) -> Turns {
        let mut found = Turns { points: [self.points[0], 0.0, 0.0, 0.0, 0.0], count: 1 };
        let slope = derivative(polynomial, 1);
        for ends in self.points[..self.count].windows(2) {
            if let Some(root) = root(polynomial, &slope, ends[0], ends[1])
                && found.count < 4
            {
                found.points[found.count] = root;
                found.count += 1;
            }
        }
        found.points[found.count] = high;
        found.count += 1;
        found
    }
}

/// The derivative of that order.
fn derivative(polynomial: &Quartic, order: usize) -> Quartic {
    let mut result = *polynomial;
    for _ in 0..order {
        let [_, a, b, c, d] = result;
        result = [a, 2.0 * b, 3.0 * c, 4.0 * d, 0.0];
    }
    result
}

fn value(polynomial: &Quartic, t: f64) -> f64 {
    polynomial.iter().rev().fold(0.0, |sum, coefficient| sum * t + coefficient)
}

/// The root between two points, if the polynomial has opposite signs there.
fn root(polynomial: &Quartic, slope: &Quartic, mut low: f64, mut high: f64) -> Option<f64> {
    let (at_low, at_high) = (value(polynomial, low), value(polynomial, high));
    if !(at_low < 0.0 && at_high > 0.0 || at_low > 0.0 && at_high < 0.0) {
        return None;
    }
    let rises = at_low < 0.0;
    let precision = (high - low).abs() * 1e-15;
    let mut t = 0.5 * (low + high);
    // Bisection alone would be done after 52 steps.
    for _ in 0..64 {
        let at = value(polynomial, t);
        if (at < 0.0) == rises {
            low = t
        } else {
            high = t
        }
        let step = t - at / value(slope, t);
        if (step - t).abs() <= precision {
            return Some(step);
        }
        let next = if step > low && step < high { step } else { 0.5 * (low + high) };
        if high - low <= precision {
            return Some(next);
        }
        t = next;
    }
    Some(t)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// (t − a)(t − b)(t − c)(t − d).
    fn with_roots([a, b, c, d]: [f64; 4]) -> Quartic {
        let (p, q, r, s) = (-(a + b), a * b, -(c + d), c * d);
        [q * s, p * s + q * r, q + s + p * r, p + r, 1.0]
    }

    #[test]
    fn roots_are_found_in_order() {
        let quartic = with_roots([0.5, 1.25, 2.0, 7.5]);
        for (low, high, expected) in [
            (0.0, 10.0, Some(0.5)),
            (0.6, 10.0, Some(1.25)),
            (1.5, 2.5, Some(2.0)),
            (3.0, 7.0, None),
            (3.0, 9.0, Some(7.5)),
        ] {
            match (first_root(&quartic, low, high), expected) {
                (Some(root), Some(expected)) => assert!((root - expected).abs() < 1e-12, "{root} {expected}"),
                (found, expected) => assert_eq!(found, expected),
            }
        }
    }

    #[test]
    fn polynomials_of_lower_degree_are_quartics_too() {
        assert_eq!(first_root(&[-1.0, 2.0, 0.0, 0.0, 0.0], 0.0, 1.0), Some(0.5));
        let root = first_root(&[-2.0, 0.0, 1.0, 0.0, 0.0], 0.0, 2.0).expect("the square root of 2");
        assert!((root - std::f64::consts::SQRT_2).abs() < 1e-15);
        assert_eq!(first_root(&[0.0; 5], 0.0, 1.0), None);
        assert_eq!(first_root(&[f64::NAN; 5], 0.0, 1.0), None);
        assert_eq!(first_root(&[1.0, 0.0, 0.0, 0.0, 1.0], -10.0, 10.0), None);
    }
}
