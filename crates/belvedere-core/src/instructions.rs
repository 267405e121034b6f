//! Choice of the processor instructions of the indexes. Answers are the same bits on all of them.

use std::sync::atomic::{AtomicBool, Ordering};

/// True if AVX2 was turned off.
static IS_SCALAR: AtomicBool = AtomicBool::new(false);

/// Instructions that a search runs on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Instructions {
    /// Eight lanes one after the other: every machine.
    Scalar,
    /// Eight lanes at once (AVX2), with fused products (FMA) and instructions on single bits: nearly all machines with
    /// AVX2 have these too.
    #[cfg(target_arch = "x86_64")]
    Avx2,
}

impl Instructions {
    /// Disables AVX2 for the rest of the process, to find faults of a processor or of a virtual machine. Answers are
    /// the same bits. For programs, before any other call.
    pub fn turn_avx2_off() {
        IS_SCALAR.store(true, Ordering::Relaxed);
    }

    /// The fastest set this machine has, unless it was turned off.
    #[must_use]
    pub fn detect() -> Self {
        if IS_SCALAR.load(Ordering::Relaxed) {
            return Self::Scalar;
        }
        #[cfg(target_arch = "x86_64")]
        if std::arch::is_x86_feature_detected!("avx2")
            && std::arch::is_x86_feature_detected!("fma")
            && std::arch::is_x86_feature_detected!("bmi1")
            && std::arch::is_x86_feature_detected!("bmi2")
            && std::arch::is_x86_feature_detected!("lzcnt")
            && std::arch::is_x86_feature_detected!("popcnt")
        {
            return Self::Avx2;
        }
        Self::Scalar
    }
}
