//! Scanner position of each pulse, from a trajectory or from the pulses themselves.

use super::Pulses;
use super::estimate::paths_from_returns;
use super::flight_parts::{SensorEstimateParams, SensorPart};
use super::line_path::position_on;
use belvedere_data::control::Control;
use belvedere_data::trajectory::{ClockOffset, Trajectory};
use belvedere_data::{PointCloud, Result};

/// Scanner position of each pulse.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SensorPositions {
    /// Local metres, (P, 3); NaN where unknown.
    pub per_pulse: Vec<[f32; 3]>,
}

/// Report of the search for scanner positions.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SensorReport {
    /// Pulses in all.
    pub pulse_count: usize,
    /// Pulses whose scanner position is known.
    pub known_count: usize,
    /// Conversion of GPS times to those of the trajectory, if one was used.
    pub clock: Option<ClockOffset>,
    /// The parts of flight lines that were estimated, by line and time.
    pub parts: Vec<SensorPart>,
}

impl SensorPositions {
    /// Positions at the times of `pulses` on `trajectory`; unknown where it has no position.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`](belvedere_data::Error::InvalidParameter) where it has none at any of the times.
    pub fn from_trajectory(
        cloud: &PointCloud,
        pulses: &Pulses,
        trajectory: &Trajectory,
    ) -> Result<(Self, SensorReport)> {
        let (per_pulse, clock) = trajectory.scanner_positions_at(&pulses.times, cloud)?;
        let known_count = per_pulse.iter().filter(|p| is_known(p)).count();
        let report =
            SensorReport { pulse_count: pulses.len(), known_count, clock: Some(clock), ..SensorReport::default() };
        Ok((Self { per_pulse }, report))
    }

    /// Positions from the directions of pulses with several returns, by flight line.
    ///
    /// A line is cut where nothing was scanned for two seconds, and then into equal parts of at most
    /// [`SensorEstimateParams::part_s`]. In each part the scanner moves evenly, S + V t. S and V minimise the distance
    /// of the last return of each pulse from the line that joins the scanner and the first return. Outliers count less,
    /// and level flight is assumed where the pulses do not constrain it.
    ///
    /// A smoother with a limited acceleration joins the parts of a line to one path. It also places parts with too few
    /// pulses between or beside good ones, as long as its uncertainty is small enough. Parts whose estimate is refused
    /// are unknown; [`SensorReport::parts`] gives the reason.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`](belvedere_data::Error::InvalidParameter) for a parameter outside its range.
    ///
    /// # Source
    /// The idea: Gatziolis & McGaughey 2019; Roussel, Bourdon & Achim 2020. Weights: Huber 1964. One least-squares
    /// problem with velocity for each part instead of pairs of pulses is ours.
    pub fn from_returns(
        cloud: &PointCloud,
        pulses: &Pulses,
        params: &SensorEstimateParams,
        control: &Control<'_>,
    ) -> Result<(Self, SensorReport)> {
        let (paths, parts) = paths_from_returns(cloud, pulses, params, control)?;
        let position = |(&line, &time): (&u16, &f64)| match position_on(&paths, line, time) {
            Some((_, place)) => belvedere_data::cloud::to_local(place, [0.0; 3]),
            None => [f32::NAN; 3],
        };
        let per_pulse: Vec<[f32; 3]> = pulses.source_ids.iter().zip(&pulses.times).map(position).collect();
        let known_count = per_pulse.iter().filter(|p| is_known(p)).count();
        Ok((Self { per_pulse }, SensorReport { pulse_count: pulses.len(), known_count, clock: None, parts }))
    }

    /// Positions of `pulses` from those of their points, (N, 3), local metres; NaN where unknown.
    #[must_use]
    pub fn of_points(pulses: &Pulses, per_point: &[[f32; 3]]) -> Self {
        let of_pulse = |pulse| pulses.returns_of(pulse).first().and_then(|&row| per_point.get(row as usize)).copied();
        Self { per_pulse: (0..pulses.len()).map(|pulse| of_pulse(pulse).unwrap_or([f32::NAN; 3])).collect() }
    }

    /// Scanner position of each point of the cloud that `pulses` were grouped from, (N, 3), local metres; NaN where
    /// unknown.
    #[must_use]
    pub fn per_point(&self, pulses: &Pulses, point_count: usize) -> Vec<[f32; 3]> {
        let mut per_point = vec![[f32::NAN; 3]; point_count];
        for (pulse, position) in self.per_pulse.iter().enumerate() {
            for &row in pulses.returns_of(pulse) {
                if let Some(of_point) = per_point.get_mut(row as usize) {
                    *of_point = *position;
                }
            }
        }
        per_point
    }
}

fn is_known(position: &[f32; 3]) -> bool {
    position.iter().all(|v| v.is_finite())
}
