//! Memory of this process, on systems that report it.

use std::fs;

/// Forgets the peak so far.
pub(crate) fn reset_peak() {
    // Linux: "5" resets the peak resident set; elsewhere there is no such file, and no peak is reported either
    let _ = fs::write("/proc/self/clear_refs", "5");
}

/// Resident memory now and at its peak since [`reset_peak`], MiB; `None` where the system does not report it.
pub(crate) fn resident_and_peak_mib() -> Option<[f64; 2]> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let kib = |name: &str| -> Option<f64> {
        status.lines().find(|line| line.starts_with(name))?.split_whitespace().nth(1)?.parse().ok()
    };
    Some([kib("VmRSS:")? / 1024.0, kib("VmHWM:")? / 1024.0])
}
