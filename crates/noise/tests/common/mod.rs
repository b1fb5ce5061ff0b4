//! What several tests share.

/// Random bits, the same in every run (xorshift64, [Marsaglia 2003] "Xorshift RNGs").
pub fn random_bits() -> impl FnMut() -> u64 {
    let mut state = 88_172_645_463_325_252u64;
    move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        state
    }
}
