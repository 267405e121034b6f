//! Random numbers that depend on a seed and a counter alone, so that no order of work changes them.

/// The `counter`-th number of the sequence of `seed`, from 0 inclusive to 1 exclusive.
///
/// # Source
/// SplitMix64: Steele, Lea & Flood 2014.
#[must_use]
pub fn uniform(seed: u64, counter: u64) -> f64 {
    let mut z = seed.wrapping_add(counter.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15));
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
}
