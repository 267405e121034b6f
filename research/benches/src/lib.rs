//! A stopwatch for the benches: what they measure takes milliseconds to seconds, so that the median of a few runs says
//! enough.

use std::fmt::Display;
use std::hint::black_box;
use std::io::Write;
use std::time::{Duration, Instant};

/// Measurements under one title.
pub struct Group {
    title: String,
    /// Words of the command line: only what contains one of them is measured.
    wanted: Vec<String>,
    samples: usize,
    elements: usize,
}

impl Group {
    /// A group of measurements, ten runs each.
    pub fn new(title: impl Display) -> Self {
        // cargo passes `--bench`
        let wanted = std::env::args().skip(1).filter(|word| !word.starts_with("--")).collect();
        Self { title: title.to_string(), wanted, samples: 10, elements: 1 }
    }

    /// Sets the number of runs of each of the following measurements.
    pub fn sample_size(&mut self, samples: usize) -> &mut Self {
        self.samples = samples.max(1);
        self
    }

    /// Sets what each run of the following measurements handles: points, targets, lines.
    pub fn throughput(&mut self, elements: usize) -> &mut Self {
        self.elements = elements;
        self
    }

    /// Measures what `work` gives to [`Runs::iter`], and prints a line.
    pub fn bench_function(&mut self, label: impl Display, work: impl FnOnce(&mut Runs)) {
        let name = format!("{}: {label}", self.title);
        if !self.wanted.is_empty() && !self.wanted.iter().any(|word| name.contains(word.as_str())) {
            return;
        }
        let mut runs = Runs { samples: self.samples, times: Vec::new() };
        work(&mut runs);
        runs.times.sort_unstable();
        let Some((first, last)) = runs.times.first().zip(runs.times.last()) else { return };
        let median = runs.times[runs.times.len() / 2];
        let milliseconds = |time: Duration| time.as_secs_f64() * 1e3;
        let rate = self.elements as f64 / median.as_secs_f64();
        let _ = writeln!(
            std::io::stdout().lock(),
            "{name}: {:.3} ms ({:.3} to {:.3}), {rate:.4e} a second",
            milliseconds(median),
            milliseconds(*first),
            milliseconds(*last)
        );
    }
}

/// The runs of one measurement.
pub struct Runs {
    samples: usize,
    times: Vec<Duration>,
}

impl Runs {
    /// Runs `work` once to warm up, then as often as the group says.
    pub fn iter<T>(&mut self, mut work: impl FnMut() -> T) {
        black_box(work());
        for _ in 0..self.samples {
            let start = Instant::now();
            black_box(work());
            self.times.push(start.elapsed());
        }
    }
}
