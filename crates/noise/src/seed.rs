//! From a seed to tables: the published permutation for seed 0, a shuffle of it for the others.

/// The permutation of [Perlin 2002], listing.
const PUBLISHED: [u8; 256] = [
    151, 160, 137, 91, 90, 15, 131, 13, 201, 95, 96, 53, 194, 233, 7, 225, 140, 36, 103, 30, 69, 142, 8, 99, 37, 240,
    21, 10, 23, 190, 6, 148, 247, 120, 234, 75, 0, 26, 197, 62, 94, 252, 219, 203, 117, 35, 11, 32, 57, 177, 33, 88,
    237, 149, 56, 87, 174, 20, 125, 136, 171, 168, 68, 175, 74, 165, 71, 134, 139, 48, 27, 166, 77, 146, 158, 231, 83,
    111, 229, 122, 60, 211, 133, 230, 220, 105, 92, 41, 55, 46, 245, 40, 244, 102, 143, 54, 65, 25, 63, 161, 1, 216,
    80, 73, 209, 76, 132, 187, 208, 89, 18, 169, 200, 196, 135, 130, 116, 188, 159, 86, 164, 100, 109, 198, 173, 186,
    3, 64, 52, 217, 226, 250, 124, 123, 5, 202, 38, 147, 118, 126, 255, 82, 85, 212, 207, 206, 59, 227, 47, 16, 58, 17,
    182, 189, 28, 42, 223, 183, 170, 213, 119, 248, 152, 2, 44, 154, 163, 70, 221, 153, 101, 155, 167, 43, 172, 9, 129,
    22, 39, 253, 19, 98, 108, 110, 79, 113, 224, 232, 178, 185, 112, 104, 218, 246, 97, 228, 251, 34, 242, 193, 238,
    210, 144, 12, 191, 179, 162, 241, 81, 51, 145, 235, 249, 14, 239, 107, 49, 192, 214, 31, 181, 199, 106, 157, 184,
    84, 204, 176, 115, 121, 50, 45, 127, 4, 150, 254, 138, 236, 205, 93, 222, 114, 67, 29, 24, 72, 243, 141, 128, 195,
    78, 66, 215, 61, 156, 180,
];

/// SplitMix64, a small generator that takes any seed and passes the usual tests.
/// Source: G. Steele, D. Lea, C. Flood, "Fast Splittable Pseudorandom Number Generators", OOPSLA 2014, figure 17 with
/// the constants of variant 13.
pub struct Random(u64);

impl Random {
    /// The sequence that belongs to `seed`.
    pub fn new(seed: u64) -> Self {
        Random(seed)
    }

    /// 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    /// A whole number below `bound`, which is small against 2⁶⁴ (so that the bias of this method is nil).
    fn below(&mut self, bound: usize) -> usize {
        ((u128::from(self.bits()) * bound as u128) >> 64) as usize
    }

    /// A number in [-1, 1), a multiple of 2⁻⁵².
    fn signed_unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 * (1.0 / (1u64 << 52) as f64) - 1.0
    }
}

/// The permutation of a seed: the published one for 0, a shuffle (Fisher and Yates) of it for the others.
pub fn permutation(seed: u64) -> [u8; 256] {
    let mut permutation = PUBLISHED;
    if seed != 0 {
        let mut random = Random::new(seed);
        for last in (1..256).rev() {
            permutation.swap(last, random.below(last + 1));
        }
    }
    permutation
}

/// 256 random unit vectors, the components apart, evenly spread over the sphere: points in the cube, those outside the
/// ball (or too close to its centre to have a direction) are drawn again, the others normalised.
pub fn unit_vectors<const D: usize>(seed: u64) -> [[f64; 256]; D] {
    let mut random = Random::new(seed ^ 0x6a73_7065_6772_6164);
    let mut components = [[0.0; 256]; D];
    for i in 0..256 {
        let (vector, length) = loop {
            let vector: [f64; D] = std::array::from_fn(|_| random.signed_unit());
            let square = vector.iter().fold(0.0, |sum, part| sum + part * part);
            if (0.0001..=1.0).contains(&square) {
                break (vector, square.sqrt());
            }
        };
        for (component, part) in components.iter_mut().zip(vector) {
            component[i] = part / length;
        }
    }
    components
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_seed_gives_a_permutation_and_its_own() {
        for seed in [0, 1, 2, u64::MAX] {
            let mut sorted = permutation(seed);
            sorted.sort_unstable();
            assert!((0..256).all(|i| usize::from(sorted[i]) == i), "seed {seed}");
        }
        assert_ne!(permutation(1), permutation(2));
    }

    #[test]
    fn the_generator_gives_its_published_sequence() {
        // The first values of SplitMix64 for the seed 1234567, as published with many implementations.
        let mut random = Random::new(1_234_567);
        assert_eq!(random.bits(), 6_457_827_717_110_365_317);
        assert_eq!(random.bits(), 3_203_168_211_198_807_973);
    }

    #[test]
    fn gradients_have_unit_length_and_no_preferred_direction() {
        let components = unit_vectors::<3>(0);
        for i in 0..256 {
            let square: f64 = components.iter().map(|component| component[i] * component[i]).sum();
            assert!((square - 1.0).abs() < 1e-15, "vector {i}: {square}");
        }
        for axis in components {
            // The mean of 256 components has the standard deviation sqrt(1/3/256) = 0.036.
            assert!(axis.iter().sum::<f64>().abs() / 256.0 < 0.11);
        }
    }
}
