//! Memory, processor and times of this computer and this process, on systems that report them.

use crate::arguments::MemoryArgument;
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

/// Memory that a command may use, bytes: as typed, or half of what is free. `None` where that is not known.
pub(crate) fn limit(typed: &MemoryArgument) -> Option<u64> {
    typed.memory.map(|memory| memory.0).or_else(|| available_bytes().map(|bytes| bytes / 2))
}

/// Returns the maximum memory that this process had at once, bytes.
pub(crate) fn peak_bytes() -> Option<u64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some(line.split_whitespace().next()?.parse::<u64>().ok()? * 1024)
}

/// Processor time of all threads of this process so far, seconds.
pub(crate) fn processor_seconds() -> Option<f64> {
    /// Ticks a second: what Linux reports in, whatever its own clock.
    const TICKS: f64 = 100.0;
    let status = fs::read_to_string("/proc/self/stat").ok()?;
    // the name of the program stands in brackets and may hold anything
    let (_, behind) = status.rsplit_once(')')?;
    let mut ticks = behind.split_whitespace().skip(11).map(str::parse::<f64>);
    Some((ticks.next()?.ok()? + ticks.next()?.ok()?) / TICKS)
}

/// Name of the processor.
pub(crate) fn processor_name() -> Option<String> {
    let computer = fs::read_to_string("/proc/cpuinfo").ok()?;
    let line = computer.lines().find(|line| line.starts_with("model name"))?;
    Some(line.split_once(':')?.1.trim().to_owned())
}
