//! Memory of this process and of the computer, where the system tells it.

use std::fs;

/// Forgets the peak so far.
pub(crate) fn reset_peak() {
    // Linux: "5" resets the peak resident set; elsewhere there is no such file, and `peak_mib` has no answer either
    let _ = fs::write("/proc/self/clear_refs", "5");
}

/// Resident memory now and at its peak since [`reset_peak`], MiB; `None` where the system does not tell.
pub(crate) fn resident_and_peak_mib() -> Option<[f64; 2]> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let mib = |name: &str| Some(kib(&status, name)? as f64 / 1024.0);
    Some([mib("VmRSS:")?, mib("VmHWM:")?])
}

/// Memory that this process can still take without others losing theirs, with what can be swapped out; `None` where the
/// system does not tell.
pub(crate) fn available_bytes() -> Option<u64> {
    let computer = fs::read_to_string("/proc/meminfo").ok()?;
    Some((kib(&computer, "MemAvailable:")? + kib(&computer, "SwapFree:")?) * 1024)
}

/// A line of a table of Linux about memory, KiB.
fn kib(table: &str, name: &str) -> Option<u64> {
    table.lines().find(|line| line.starts_with(name))?.split_whitespace().nth(1)?.parse().ok()
}
