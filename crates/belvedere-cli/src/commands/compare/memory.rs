//! Peak memory of this process, where the system tells it.

use std::fs;

/// Forgets the peak so far.
pub(super) fn reset_peak() {
    // Linux: "5" resets the peak resident set; elsewhere there is no such file, and `peak_mib` has no answer either
    let _ = fs::write("/proc/self/clear_refs", "5");
}

/// Resident memory now and at its peak since [`reset_peak`], MiB; `None` where the system does not tell.
pub(super) fn resident_and_peak_mib() -> Option<[f64; 2]> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let mib = |name: &str| {
        let line = status.lines().find(|line| line.starts_with(name))?;
        let kib: f64 = line.split_whitespace().nth(1)?.parse().ok()?;
        Some(kib / 1024.0)
    };
    Some([mib("VmRSS:")?, mib("VmHWM:")?])
}
