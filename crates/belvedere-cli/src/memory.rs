//! Memory of this computer, on systems that report it.

use std::fs;

/// Memory that this process can still take without others losing theirs, with what can be swapped out; `None` where the
/// system does not report it.
pub(crate) fn available_bytes() -> Option<u64> {
    let computer = fs::read_to_string("/proc/meminfo").ok()?;
    let kib = |name: &str| -> Option<u64> {
        computer.lines().find(|line| line.starts_with(name))?.split_whitespace().nth(1)?.parse().ok()
    };
    Some((kib("MemAvailable:")? + kib("SwapFree:")?) * 1024)
}
