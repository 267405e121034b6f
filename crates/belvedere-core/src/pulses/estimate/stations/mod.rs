//! Locates tripod stations from the points alone.

mod floor_holes;
mod pulse_grid;

use crate::pulses::scanner_report::FoundStation;
use belvedere_data::cast::to_index;
use belvedere_data::cloud::to_local;
use belvedere_data::control::Control;
use belvedere_data::vector::to_f32;
use belvedere_data::{PointCloud, Result};
use floor_holes::floor_holes;
use pulse_grid::{StationFit, crowding, filled_share, fit};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::f64::consts::{FRAC_PI_2, TAU};
use std::sync::atomic::{AtomicU32, Ordering};

/// Points of a source id from which on a tripod is looked for.
const MIN_POINTS: usize = 3000;
/// Radii around the foot of a tripod within which its grid is searched, metres, tried in turn. A larger one has more
/// points, but also more points of other tripods.
const NEAR: [f64; 3] = [6.0, 3.5, 2.2];
/// Distance below which the scanner's own parts and rounded coordinates disturb the grid, metres.
const TOO_NEAR: f64 = 0.4;
/// Points by which heights are tried, and those that a station is fitted to, about; and the wedges that are left out
/// where there are more. A few wedges on all sides are kept of however many points: one side alone does not tell where
/// the station is.
const TRIED: f64 = 10_000.0;
const FITTED: f64 = 50_000.0;
const WEDGES: f64 = 36.0;
const MIN_WEDGES: f64 = 6.0;
/// Heights above the floor from which the search starts, metres.
const HEIGHTS: [f64; 5] = [0.5, 0.9, 1.3, 1.7, 2.3];
/// Pairs of directions that a station is fitted to, from each height and at last.
const FEW_PAIRS: usize = 2_500;
const MAX_PAIRS: usize = 12_000;
/// Heights above the floor that stations are found at, metres.
const ALLOWED_HEIGHTS: std::ops::RangeInclusive<f64> = 0.2..=4.0;
/// Holes that are no station's, after which the search ends; the roundest come first.
const MAX_FAILURES: usize = 12;
/// Stations on one floor are farther apart than that, metres: the floor about a tripod has other holes, but no other
/// tripod.
const APART: f64 = 2.0;
/// Maximum horizontal distance between a station and the centre of its hole, metres.
const MAX_BESIDE: f64 = 0.6;
/// Numbers of directions in a cell at which they must not be crowded, and how much they may be. Measured: stations of
/// simulated tripods have less than 0.05 and 0.5, other places of their clouds and of clouds from the air 0.5 to 50 and
/// 1 to 50.
const CROWDING: [(f64, f64); 2] = [(0.3, 0.25), (1.0, 0.7)];
/// Maximum crowding of directions in the larger cells, at the height that is tried first, some decimetres off the
/// station.
const START_CROWDING: f64 = 1.8;
/// Share of all directions that points near a station fill at least.
const MIN_FILLED: f64 = 0.15;
/// Largest standard deviation of a position, metres.
const MAX_SD: f64 = 0.03;
/// Side of the cells of an image of ranges, in steps of the grid, and most columns of it.
const IMAGE_STEPS: f64 = 1.5;
const MAX_COLUMNS: f64 = 4096.0;
/// Depth behind the nearest point of a cell up to which a point counts as seen, metres. It grows with the side of the
/// cell at its range: walls are seen at up to 80° from their normal.
const DEPTH: f64 = 0.05;
const DEPTH_IN_SIDES: f64 = 6.0;
/// Share of a group's points that may lie behind others seen from its only station: edges of things.
const MAX_HIDDEN: f64 = 0.05;

/// The stations of tripods in `cloud` and the one that each point was measured from, (N, 3) local metres, NaN where it
/// is unknown.
///
/// Points of different point source ids are looked at apart. A tripod leaves a round hole in the floor; seen from the
/// true place above it, the pulses near by form a grid, each direction one step from the next. A place is a station
/// only if that is so: seen from any other place some directions are crowded. Points belong to the nearest station of
/// their group from which no other point lies before them.
///
/// # Errors
/// [`Error::Cancelled`](belvedere_data::Error::Cancelled).
///
/// # Source
/// This project's own.
pub(in crate::pulses) fn stations_of_tripods(
    cloud: &PointCloud,
    control: &Control<'_>,
) -> Result<(Vec<[f32; 3]>, Vec<FoundStation>)> {
    let mut positions = vec![[f32::NAN; 3]; cloud.len()];
    let mut stations = Vec::new();
    for (id, rows) in groups(cloud) {
        control.check()?;
        let numbers = cloud.attributes.return_number.as_deref();
        let is_first = |row: &&usize| numbers.and_then(|numbers| numbers.get(**row)).is_none_or(|&number| number <= 1);
        let first: Vec<usize> = rows.iter().filter(is_first).copied().filter(|&row| is_finite(cloud, row)).collect();
        let points: Vec<[f32; 3]> = first.iter().filter_map(|&row| cloud.positions.get(row)).copied().collect();
        let (found, seen) = tripods(&points, control)?;
        // returns after the first belong to the first's station, which is known where there is only one
        let mut counts = vec![0; found.len()];
        let owned: Vec<(usize, usize)> = if found.len() == 1 && is_whole(&seen) {
            rows.iter().map(|&row| (row, 0)).collect()
        } else {
            first.iter().zip(&seen).filter_map(|(&row, number)| Some((row, (*number)?))).collect()
        };
        for (row, number) in owned {
            positions[row] = to_local(found[number].position, [0.0; 3]);
            counts[number] += 1;
        }
        stations.extend(found.iter().zip(counts).map(|(fit, point_count)| FoundStation {
            source_id: id,
            position: cloud.frame.file_from_local(fit.position),
            step_deg: fit.steps.map(f64::to_degrees),
            point_count,
        }));
    }
    Ok((positions, stations))
}

fn is_finite(cloud: &PointCloud, row: usize) -> bool {
    cloud.positions.get(row).is_some_and(|p| p.iter().all(|v| v.is_finite()))
}

/// Rows of each point source id, or all where there is only one.
fn groups(cloud: &PointCloud) -> Vec<(Option<u16>, Vec<usize>)> {
    let mut groups: BTreeMap<u16, Vec<usize>> = BTreeMap::new();
    for (row, &id) in cloud.attributes.point_source_id.iter().flatten().enumerate() {
        groups.entry(id).or_default().push(row);
    }
    let mut groups: Vec<(Option<u16>, Vec<usize>)> = if groups.len() > 1 {
        groups.into_iter().map(|(id, rows)| (Some(id), rows)).collect()
    } else {
        vec![(None, (0..cloud.len()).collect())]
    };
    groups.retain(|(_, rows)| rows.len() >= MIN_POINTS);
    groups
}

/// The stations among these points, and the nearest one from which each point is seen.
fn tripods(points: &[[f32; 3]], control: &Control<'_>) -> Result<(Vec<StationFit>, Vec<Option<usize>>)> {
    let mut found: Vec<StationFit> = Vec::new();
    let mut failures = 0;
    for hole in floor_holes(points) {
        control.check()?;
        let is_known = |fit: &StationFit| (fit.position[0] - hole[0]).hypot(fit.position[1] - hole[1]) < APART;
        if failures == MAX_FAILURES {
            break;
        }
        if found.iter().any(is_known) {
            continue;
        }
        let Some(station) = station_above(points, hole) else {
            failures += 1;
            continue;
        };
        found.push(station);
        // most groups have one station, and need no further search
        if found.len() == 1 && is_only(points, &station) {
            let seen = seen_from(points, &found, control)?;
            if is_whole(&seen) {
                return Ok((found, seen));
            }
        }
    }
    let seen = seen_from(points, &found, control)?;
    Ok((found, seen))
}

/// Returns true if one station has seen a group of points, apart from some behind the edges of others.
fn is_whole(seen: &[Option<usize>]) -> bool {
    let hidden_count = seen.iter().filter(|number| number.is_none()).count();
    hidden_count as f64 <= MAX_HIDDEN * seen.len() as f64
}

/// Returns true if the directions of all these points form the grid of this station.
fn is_only(points: &[[f32; 3]], station: &StationFit) -> bool {
    let places: Vec<[f64; 3]> = points.par_iter().map(|p| p.map(f64::from)).collect();
    let [(fine, max_fine), _] = CROWDING;
    // enough wedges that other stations are in some of them
    let max = FITTED.max(places.len() as f64 / 4.0);
    crowding(&in_wedges(&places, station.position, max), station.position, fine) <= max_fine
}

/// The station above a hole in the floor, if pulses near by prove that there is one.
fn station_above(points: &[[f32; 3]], hole: [f64; 3]) -> Option<StationFit> {
    let is_near = |p: &[f64; 3], max: f64| {
        let [x, y, z] = [0, 1, 2].map(|i| p[i] - hole[i]);
        let level = x.hypot(y);
        level > TOO_NEAR && level.hypot(z) < max
    };
    let places = points.par_iter().map(|p| p.map(f64::from));
    let around: Vec<[f64; 3]> = places.filter(|p| is_near(p, NEAR[0])).collect();
    NEAR.iter().find_map(|&max| {
        let near: Vec<[f64; 3]> = around.iter().copied().filter(|p| is_near(p, max)).collect();
        if near.len() < MIN_POINTS { None } else { station_by_grid(&near, hole) }
    })
}

/// The station above a hole in the floor by points near by, if they prove that there is one.
fn station_by_grid(near: &[[f64; 3]], hole: [f64; 3]) -> Option<StationFit> {
    let [(fine, max_fine), (coarse, max_coarse)] = CROWDING;
    let few = in_wedges(near, hole, TRIED);
    let at = |height: f64| [hole[0], hole[1], hole[2] + height];
    let is_open = |height: &&f64| crowding(&few, at(**height), coarse) <= START_CROWDING;
    // from a wrong height, the floor alone looks as regular as from the right one, and walls do not
    let fits: Vec<StationFit> =
        HEIGHTS.par_iter().filter(is_open).filter_map(|&height| fit(&few, at(height), FEW_PAIRS)).collect();
    let start = fits.into_iter().min_by(|a, b| a.sd.total_cmp(&b.sd))?;
    let kept = in_wedges(near, hole, FITTED);
    let fit = fit(&kept, start.position, MAX_PAIRS)?;
    let off = [0, 1, 2].map(|i| fit.position[i] - hole[i]);
    let is_above_hole = off[0].hypot(off[1]) <= MAX_BESIDE && ALLOWED_HEIGHTS.contains(&off[2]);
    let is_proven = is_above_hole
        && fit.sd <= MAX_SD
        && crowding(&kept, fit.position, fine) <= max_fine
        && crowding(&kept, fit.position, coarse) <= max_coarse
        && filled_share(&kept, fit.position) * near.len() as f64 >= MIN_FILLED * kept.len() as f64;
    is_proven.then_some(fit)
}

/// Selects about `max` of these points, or a sixth of all if that is more. They lie in wedges around the centre of the
/// hole, since the grid is complete within a wedge.
fn in_wedges(near: &[[f64; 3]], hole: [f64; 3], max: f64) -> Vec<[f64; 3]> {
    let share = (max / near.len() as f64).clamp(MIN_WEDGES / WEDGES, 1.0);
    let is_kept = |p: &&[f64; 3]| {
        let wedge = ((p[1] - hole[1]).atan2(p[0] - hole[0]).rem_euclid(TAU) / TAU * WEDGES).floor();
        ((wedge + 1.0) * share).floor() > (wedge * share).floor()
    };
    near.iter().filter(is_kept).copied().collect()
}

/// The nearest station from which each point is seen.
fn seen_from(points: &[[f32; 3]], stations: &[StationFit], control: &Control<'_>) -> Result<Vec<Option<usize>>> {
    let mut nearest: Vec<Option<(f32, usize)>> = vec![None; points.len()];
    for (number, station) in stations.iter().enumerate() {
        control.check()?;
        let side = (IMAGE_STEPS * station.steps[0].max(station.steps[1])).max(TAU / MAX_COLUMNS);
        let size = [TAU / side, 2.0 * FRAC_PI_2 / side].map(|count| to_index(count) + 1);
        let image: Vec<AtomicU32> = (0..size[0] * size[1]).map(|_| AtomicU32::new(u32::MAX)).collect();
        let seen = |p: &[f32; 3]| {
            let [x, y, z] = [0, 1, 2].map(|i| f64::from(p[i]) - station.position[i]);
            let level = x.hypot(y);
            let column = to_index(y.atan2(x).rem_euclid(TAU) / side).min(size[0] - 1);
            let row = to_index((z.atan2(level) + FRAC_PI_2) / side).min(size[1] - 1);
            (row * size[0] + column, to_f32(level.hypot(z)))
        };
        points.par_iter().for_each(|p| {
            let (cell, range) = seen(p);
            // bits of positive numbers have their order
            image[cell].fetch_min(range.to_bits(), Ordering::Relaxed);
        });
        nearest.par_iter_mut().zip(points).for_each(|(nearest, p)| {
            let (cell, range) = seen(p);
            let first = f64::from(f32::from_bits(image[cell].load(Ordering::Relaxed)));
            let is_seen = f64::from(range) <= first * (1.0 + DEPTH_IN_SIDES * side) + DEPTH;
            if is_seen && nearest.is_none_or(|(min, _)| range < min) {
                *nearest = Some((range, number));
            }
        });
    }
    Ok(nearest.into_iter().map(|own| own.map(|(_, number)| number)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use belvedere_data::Attributes;
    use belvedere_data::random::uniform;

    /// Length, width and height of a room, metres, and a tripod at either end.
    const ROOM: [f64; 3] = [10.0, 6.0, 3.0];
    const STATIONS: [[f64; 3]; 2] = [[2.5, 3.2, 1.5], [7.4, 2.1, 1.7]];

    /// Simulates a scan of the room in steps of `step` degrees, down to 65° below the horizon. The scanner is levelled
    /// to a thousandth and turned by `turn` radians. Ranges have 3 mm of noise; coordinates are rounded to a
    /// millimetre.
    fn scanned(eye: [f64; 3], step: f64, turn: f64) -> Vec<[f32; 3]> {
        let steps = |degrees: f64| (0..).map(move |i| f64::from(i) * step).take_while(move |v| *v < degrees);
        let mut points = Vec::new();
        for (azimuth, elevation) in steps(360.0).flat_map(|a| steps(155.0).map(move |e| (a, e - 65.0))) {
            let [azimuth, elevation] = [azimuth.to_radians() + turn, elevation.to_radians()];
            let level = elevation.cos();
            let [x, y, z] = [level * azimuth.sin(), level * azimuth.cos(), elevation.sin()];
            let ahead = [x + 1e-3 * z, y, z - 1e-3 * x];
            let to_face = |axis: usize| {
                let face = if ahead[axis] > 0.0 { ROOM[axis] } else { 0.0 };
                if ahead[axis] == 0.0 { f64::INFINITY } else { (face - eye[axis]) / ahead[axis] }
            };
            let noise = 0.003 * (2.0 * uniform(points.len() as u64, 0) - 1.0);
            let range = (0..3).map(to_face).fold(f64::INFINITY, f64::min) + noise;
            let place = [0, 1, 2].map(|i| ((eye[i] + range * ahead[i]) * 1e3).round() / 1e3);
            points.push(to_local(place, [0.0; 3]));
        }
        points
    }

    /// Both scans of the room, with other steps each, and whose points are which.
    fn both() -> (Vec<[f32; 3]>, Vec<u16>) {
        let scans = [scanned(STATIONS[0], 0.9, 0.1), scanned(STATIONS[1], 1.0, 0.3)];
        let ids = (1..).zip(&scans).flat_map(|(id, scan)| vec![id; scan.len()]).collect();
        (scans.concat(), ids)
    }

    fn searched(positions: Vec<[f32; 3]>, ids: Option<Vec<u16>>) -> (Vec<[f32; 3]>, Vec<FoundStation>) {
        let attributes = Attributes { point_source_id: ids, ..Attributes::default() };
        let cloud = PointCloud { positions, attributes, ..PointCloud::default() };
        stations_of_tripods(&cloud, &Control::none()).unwrap()
    }

    fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
        (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt()
    }

    #[test]
    fn tripods_are_found_where_they_stand_with_ids_and_without() {
        let (positions, ids) = both();
        let (scanner, found) = searched(positions.clone(), Some(ids.clone()));
        assert_eq!(found.len(), 2);
        for (station, truth) in found.iter().zip(STATIONS) {
            // rounding to a millimetre, over thousands of directions
            assert!(distance(station.position, truth) < 0.02, "{station:?}");
        }
        for (place, id) in scanner.iter().zip(&ids) {
            let truth = STATIONS[usize::from(*id) - 1];
            assert!(distance(place.map(f64::from), truth) < 0.02, "{place:?} of {id}");
        }
        let (scanner, found) = searched(positions, None);
        assert_eq!(found.len(), 2, "{found:?}");
        for truth in STATIONS {
            assert!(found.iter().any(|station| distance(station.position, truth) < 0.02), "{found:?}");
        }
        // in an empty room both see everything, and the nearer one has most points of a place
        let known_count = scanner.iter().filter(|place| place[0].is_finite()).count();
        assert!(known_count as f64 > 0.98 * scanner.len() as f64, "{known_count}");
    }

    #[test]
    fn a_tripod_with_a_fine_grid_is_found_by_some_wedges_of_it() {
        let (_, found) = searched(scanned(STATIONS[0], 0.3, 0.1), None);
        assert_eq!(found.len(), 1);
        assert!(distance(found[0].position, STATIONS[0]) < 0.02, "{found:?}");
    }

    #[test]
    fn stations_do_not_depend_on_the_order_of_the_points() {
        let mut positions = scanned(STATIONS[0], 1.2, 0.1);
        let (scanner, found) = searched(positions.clone(), None);
        positions.reverse();
        let (mut other_scanner, other) = searched(positions, None);
        other_scanner.reverse();
        assert_eq!(found.len(), 1);
        assert_eq!(found, other);
        // NaN differs from itself
        assert_eq!(format!("{scanner:?}"), format!("{other_scanner:?}"));
    }

    #[test]
    fn holes_in_floors_alone_are_no_stations() {
        let at = |i: u64, k: u64, size: f64| size * uniform(i, k);
        let is_off_hole = |p: &[f64; 3]| (p[0] - 5.0).hypot(p[1] - 3.0) > 0.8;
        // denser towards a round hole, as near a tripod, but by chance
        let by_chance = (0..60_000_u64).map(|i| {
            let (angle, range) = (at(i, 0, TAU), 0.8 + at(i, 1, 1.0).powi(3) * 4.0);
            [5.0 + range * angle.cos(), 3.0 + range * angle.sin(), at(i, 2, 0.005)]
        });
        // a floor and walls in steps of 4 cm, as a filter leaves them
        let filtered = (0..250 * 150).map(|i| [f64::from(i % 250) * 0.04, f64::from(i / 250) * 0.04, 0.0]);
        let wall = (0..250 * 75).map(|i| [f64::from(i % 250) * 0.04, 0.0, f64::from(i / 250) * 0.04]);
        for cloud in [by_chance.collect::<Vec<_>>(), filtered.chain(wall).filter(is_off_hole).collect()] {
            let positions = cloud.iter().map(|p| to_local(*p, [0.0; 3])).collect();
            let (scanner, found) = searched(positions, None);
            assert!(found.is_empty(), "{found:?}");
            assert!(scanner.iter().all(|place| place[0].is_nan()));
        }
    }

    #[test]
    fn odd_clouds_have_no_stations() {
        let spread = (0..5000_u16).map(|i| [f32::from(i).powi(9), -f32::from(i).powi(9), f32::MAX * f32::from(i % 2)]);
        let line = (0..5000_u16).map(|i| [f32::from(i), 0.0, 0.0]);
        let odd: [Vec<[f32; 3]>; 6] = [
            Vec::new(),
            vec![[1.0, 2.0, 3.0]],
            vec![[1.0, 2.0, 3.0]; 20_000],
            vec![[f32::NAN; 3]; 5000],
            spread.collect(),
            line.collect(),
        ];
        for positions in odd {
            let count = positions.len();
            let (scanner, found) = searched(positions, None);
            assert_eq!((scanner.len(), found.len()), (count, 0));
        }
    }
}
