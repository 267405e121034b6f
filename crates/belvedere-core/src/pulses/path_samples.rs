//! Found paths as a trajectory that can be written.

use super::line_path::{LinePath, Stretch};
use belvedere_data::trajectory::{TrajectoryQuality, TrajectorySample};
use belvedere_data::{Error, Parameter, Result};

/// Maximum distance between two simultaneous scanner positions of one scanner, metres: several times the error of a
/// path.
const SAME_PLACE: f64 = 100.0;

/// The positions that `paths` know, of a cloud at `origin` (metres), every `step` seconds and at both ends of each
/// stretch, in order of time. Where several lines are known at one time, such as the channels of one scanner, the one
/// surest of its position counts.
///
/// # Errors
/// [`Error::InvalidParameter`] for a step outside 0.01 to 2 s, and for lines that are at different places at one time:
/// times of the week from different weeks.
pub fn path_samples(paths: &[LinePath], origin: [f64; 3], step: f64) -> Result<Vec<TrajectorySample>> {
    if !(0.01..=2.0).contains(&step) {
        return Err(Error::invalid(Parameter::TimeStep, step, "0.01 to 2 s"));
    }
    let mut samples = Vec::new();
    for (own, path) in paths.iter().enumerate() {
        for stretch in &path.stretches {
            for time in times(stretch.times, step) {
                let Some(place) = path.position_at(time) else { continue };
                if has_better(paths, own, stretch, time, place)? {
                    continue;
                }
                samples.push(TrajectorySample {
                    time,
                    position: std::array::from_fn(|i| place[i] + origin[i]),
                    quality: TrajectoryQuality {
                        sd: stretch.position_sd,
                        residual: stretch.median_angle,
                        line: path.source_id,
                    },
                });
            }
        }
    }
    samples.sort_by(|a, b| a.time.total_cmp(&b.time));
    samples.dedup_by(|later, earlier| later.time <= earlier.time);
    Ok(samples)
}

/// Multiples of `step` within a stretch of time, and its ends.
fn times([from, to]: [f64; 2], step: f64) -> impl Iterator<Item = f64> {
    let first = (from / step).floor() + 1.0;
    let multiples = (0_u32..).map(move |i| (first + f64::from(i)) * step).take_while(move |time| *time < to);
    std::iter::once(from).chain(multiples).chain(std::iter::once(to))
}

/// Returns true if another path knows this `time` better than `stretch` of path number `own`, which puts the scanner at
/// `place`. The first path of a line is the best.
fn has_better(paths: &[LinePath], own: usize, stretch: &Stretch, time: f64, place: [f64; 3]) -> Result<bool> {
    let sd = |stretch: &Stretch| stretch.position_sd.iter().sum::<f64>();
    let line = paths.get(own).map(|path| path.source_id);
    for (other, path) in paths.iter().enumerate().filter(|(other, _)| *other != own) {
        let (Some(there), Some(its)) = (path.stretch_at(time), path.position_at(time)) else { continue };
        let is_better = if line == Some(path.source_id) {
            other < own
        } else {
            let apart = (0..3).map(|i| (its[i] - place[i]).powi(2)).sum::<f64>().sqrt();
            if apart > SAME_PLACE {
                return Err(Error::invalid(
                    Parameter::Trajectory,
                    format!("two lines {apart:.0} m apart at {time} s"),
                    "of one flight: process flight lines of different days separately",
                ));
            }
            (sd(there), other) < (sd(stretch), own)
        };
        if is_better {
            return Ok(true);
        }
    }
    Ok(false)
}
