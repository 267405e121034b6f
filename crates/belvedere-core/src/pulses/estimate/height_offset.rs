//! Estimates the vertical offset between a trajectory and its point cloud.

use nalgebra::Vector3;

use super::sensor_fit::{ReturnPair, median, trust};
use crate::pulses::Pulses;
use crate::pulses::flight_parts::HeightOffset;
use belvedere_data::PointCloud;

/// Rounds of improvement and reweighting; offsets of a tenth of the height settle in four.
const ROUNDS: usize = 8;
/// Minimum distance between first and last return for a pulse to give its direction, metres.
const MIN_LENGTH: f64 = 3.0;
/// Fewest such pulses.
const MIN_PAIRS: usize = 100;
/// Offsets up to this are left alone, metres.
const MIN_OFFSET: f64 = 1.0;
/// Offsets below so many deviations may be chance.
const MIN_DEVIATIONS: f64 = 4.0;
/// Share of the misses of single pulses that may be systematic: beams that graze edges miss to one side more than to
/// the other.
const SYSTEMATIC_SHARE: f64 = 0.5;

/// Estimates the offset that brings `positions` nearest to the lines of the pulses with several returns. `positions`
/// has a row for each pulse, (P, 3), local metres, NaN where unknown. `None` if too few pulses have returns far enough
/// apart.
///
/// # Source
/// The miss at the last return as in [`crate::pulses::SensorPositions::from_returns`], with Huber's weights and one
/// unknown for all lines; ours.
pub(in crate::pulses) fn height_offset(
    cloud: &PointCloud,
    pulses: &Pulses,
    positions: &[[f32; 3]],
) -> Option<HeightOffset> {
    let place = |row: &u32| cloud.positions.get(*row as usize).map(|p| Vector3::from(p.map(f64::from)));
    let pair = |(pulse, scanner): (usize, &[f32; 3])| {
        let returns = pulses.returns_of(pulse);
        let (first, last) = (place(returns.first()?)?, place(returns.last()?)?);
        let is_known = scanner.iter().all(|v| v.is_finite()) && (last - first).norm() >= MIN_LENGTH;
        is_known.then(|| (ReturnPair::new(first, last, 0.0), Vector3::from(scanner.map(f64::from))))
    };
    let pairs: Vec<(ReturnPair, Vector3<f64>)> = positions.iter().enumerate().filter_map(pair).collect();
    if pairs.len() < MIN_PAIRS {
        return None;
    }
    let misses = |offset: f64| -> Vec<_> {
        pairs.iter().map(|(pair, scanner)| pair.miss_from(&(scanner + Vector3::z() * offset))).collect()
    };
    let (mut offset, mut sd) = (0.0, f64::INFINITY);
    for _ in 0..ROUNDS {
        let misses = misses(offset);
        let trust = trust(&misses);
        let (mut normal, mut right, mut squares) = (0.0, 0.0, 0.0);
        for (miss, trust) in misses.iter().zip(&trust) {
            let slope = miss.across.column(2) * miss.slope;
            normal += trust * slope.norm_squared();
            right -= trust * slope.dot(&miss.offset);
            squares += trust * miss.offset.norm_squared();
        }
        if !(normal > 0.0) {
            return None;
        }
        offset += right / normal;
        sd = (squares / (2.0 * pairs.len() as f64) / normal).sqrt();
    }
    let found = misses(offset);
    let at_return =
        |(miss, (pair, _)): (&super::sensor_fit::Miss, &(ReturnPair, _))| miss.offset.norm() / pair.along.norm();
    let angle = median(found.iter().zip(&pairs).map(at_return).collect());
    let height = median(pairs.iter().map(|(pair, scanner)| scanner.z + offset - pair.first.z).collect());
    // sine of the angle from the vertical, which is what a change of height shows in
    let tilt = median(found.iter().map(|miss| miss.across.column(2).norm()).collect());
    let feigned = SYSTEMATIC_SHARE * height.abs() * angle / tilt;
    let is_applied = offset.is_finite() && offset.abs() > MIN_OFFSET.max(MIN_DEVIATIONS * sd).max(feigned);
    let used = if is_applied { found } else { misses(0.0) };
    let miss_angle = median(used.iter().zip(&pairs).map(at_return).collect());
    offset.is_finite().then_some(HeightOffset { offset, sd, pair_count: pairs.len(), is_applied, miss_angle })
}
