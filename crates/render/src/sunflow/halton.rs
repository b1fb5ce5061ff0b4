//! Halton's sequence with Faure's permutations, as Sunflow draws its numbers (format reference, §3.16): where so few
//! photons make a picture that their places are seen, they lie where Sunflow's lie.

use std::sync::LazyLock;

/// A base and the order in which its digits are taken.
struct Base {
    base: u32,
    digits: Vec<u32>,
}

/// Dimensions there are; beyond them they repeat.
const DIMENSIONS: usize = 64;

static BASES: LazyLock<Vec<Base>> = LazyLock::new(|| {
    let is_prime = |n: &u32| (2..*n).take_while(|d| d * d <= *n).all(|d| !n.is_multiple_of(d));
    let base = |(dimension, base): (usize, u32)| {
        // The second dimension is plain.
        let digits = if dimension == 1 { (0..base).collect() } else { faure(base) };
        Base { base, digits }
    };
    (2..).filter(is_prime).take(DIMENSIONS).enumerate().map(base).collect()
});

/// The permutation of a base ([Faure 1992] "Good permutations for extreme discrepancy").
fn faure(base: u32) -> Vec<u32> {
    if base == 2 {
        return vec![0, 1];
    }
    if base.is_multiple_of(2) {
        let half = faure(base / 2);
        return half.iter().map(|digit| 2 * digit).chain(half.iter().map(|digit| 2 * digit + 1)).collect();
    }
    let middle = (base - 1) / 2;
    let mut digits: Vec<u32> =
        faure(base - 1).into_iter().map(|digit| if digit >= middle { digit + 1 } else { digit }).collect();
    digits.insert(middle as usize, middle);
    digits
}

/// Number `index` of a dimension, from 0 to 1, the end excluded.
pub(super) fn halton(dimension: u32, mut index: u32) -> f32 {
    let Base { base, digits } = &BASES[dimension as usize % DIMENSIONS];
    let (mut value, mut place) = (0.0, 1.0);
    while index > 0 {
        place /= f64::from(*base);
        value += f64::from(digits[(index % base) as usize]) * place;
        index /= base;
    }
    (value as f32).min(1.0 - f32::EPSILON / 2.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn permutations_are_faures() {
        assert_eq!(faure(5), [0, 3, 2, 1, 4]);
        assert_eq!(faure(7), [0, 2, 5, 3, 1, 4, 6]);
    }

    #[test]
    fn the_first_dimensions_are_radical_inverses() {
        assert_eq!([1, 2, 3, 4].map(|i| halton(0, i)), [0.5, 0.25, 0.75, 0.125]);
        assert_eq!([1, 2, 3].map(|i| halton(1, i)), [1.0 / 3.0, 2.0 / 3.0, 1.0 / 9.0]);
        assert_eq!(halton(2, 1), 0.6);
    }
}
