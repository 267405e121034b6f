//! Prepares a cloud: cleaning, outward normals, and the space that its pulses prove empty.

use super::close_range_normals::CloseRange;
use super::estimate_statistics::WholeStatistics;
use super::findings::SurveyFindings;
use super::flight_days::FlightDays;
use super::in_space_order::{points_at, space_order};
use super::params::{Carving, ModelParams, OrientBy, StripHeights};
use super::report::{BuildReport, NormalsReport, PulsesReport, SmoothingReport};
use super::statistics::SurveyStatistics;
use crate::clean::clean;
use crate::ground::ground_in_blocks;
use crate::neighbors::{FARTHEST_NEIGHBOR, NeighborIndex};
use crate::normals::estimate::estimate_within;
use crate::normals::{Normals, Orientation, OrientedCloud, Scatter, orient};
use crate::pulses::{
    FoundBy, FreeSegmentColumns, FreeSegments, MIN_ASSUMED_SHARE, Pulses, ScannerReport, group, locate,
};
use crate::strips::{compare_strips, move_strips};
use crate::summary::{looks_y_up, unit_contradiction_of};
use belvedere_data::contradiction::FoundContradiction;
use belvedere_data::control::Control;
use belvedere_data::crs::CrsKind;
use belvedere_data::report::rounded;
use belvedere_data::vector::{cross, length, sub, unit};
use belvedere_data::{Attributes, Bounds, Error, Frame, PointCloud, Result};
use std::borrow::Cow;

/// Points no farther from a line than this lie on it, metres: the step of coordinates in most files.
const LINE_WIDTH: f64 = 1e-3;
/// Minimum memory of a model for each point, beside the cloud, bytes: two thirds of the use measured with large clouds.
const MIN_BYTES_OF_POINT: usize = 400;
/// Maximum accepted median angle between pulses with several returns and their trajectory, degrees. Returns 3 m apart
/// show a true one to 2°; one that is a second off in time misses by more than 3.
const MAX_MISS_DEG: f64 = 3.0;
/// Maximum distance before its return at which a pulse stops proving its path, in multiples of the range noise, if
/// nothing else is uncertain. One return in 30,000 lies that much too far away, and balls begin below the surface.
const NOISES_BEFORE_RETURNS: f32 = 4.0;

/// A cloud ready for balls: cleaned, with outward normals, an index, and the space that its pulses prove empty.
pub struct OrientedSurvey {
    /// The points that were kept, with outward normals; where they are to be carved, on the surface that they scatter
    /// about.
    pub oriented: OrientedCloud,
    /// Index of these points.
    pub index: NeighborIndex,
    /// Their rows in the cloud as it was given: ascending, or in the order of space where they are to be carved.
    pub kept: Vec<u32>,
    /// The smallest box around them: a stray point that was cleaned away does not widen a view.
    pub bounds: Bounds,
    /// The points before they were moved onto their surface, where they are to be carved; otherwise empty.
    pub(super) measured: Vec<[f32; 3]>,
    /// Classes of these points, where they have any.
    pub(super) classification: Option<Vec<u8>>,
    /// Days on which these points were measured.
    pub(super) flight_days: FlightDays,
    /// Input of carving, if it is wanted and possible.
    pub(super) carving: Option<CarvingInput>,
}

/// Input of carving beside an oriented cloud.
pub(super) struct CarvingInput {
    pub(super) free_segments: FreeSegments,
    /// Space that pulses prove empty between their returns; it proves, and does not carve.
    pub(super) between_returns: Option<FreeSegments>,
    /// Space that pulses without a return prove empty; it proves, and does not carve.
    pub(super) into_the_sky: Option<FreeSegments>,
    /// Classes, numbers and counts of returns.
    pub(super) attributes: Attributes,
    /// True if pulses are only assumed.
    pub(super) is_assumed: bool,
    /// The scanner at each point, (N, 3) local metres, NaN where unknown.
    pub(super) scanner: Vec<[f32; 3]>,
    /// Groups of returns that share a pulse, if known.
    pub(super) pulses: Option<Pulses>,
}

/// Positions of the scanner.
#[derive(Default)]
struct ScannerPositions {
    /// For each point, local metres, NaN where unknown.
    positions: Vec<[f32; 3]>,
    /// True if pulses are only assumed to fall straight down.
    is_assumed: bool,
    /// True if they are the poses of the file.
    are_poses: bool,
}

impl OrientedSurvey {
    /// Cleans `cloud`, finds the scanner where [`ModelParams::balls`] or [`ModelParams::orient`] need it, estimates
    /// normals and turns them outward.
    ///
    /// # Errors
    /// [`Error::NoPoints`] where cleaning leaves none, [`Error::NoSurface`] where it leaves fewer than four or all on
    /// one line; those of [`clean`], [`locate`], [`estimate_within`] and [`orient()`]; [`Error::Cancelled`].
    pub fn prepare(cloud: &PointCloud, params: &ModelParams, control: &Control<'_>) -> Result<(Self, BuildReport)> {
        let whole = WholeStatistics::of_cloud(cloud, params, control)?;
        prepare(Cow::Borrowed(cloud), params, whole.as_ref(), control)
    }

    /// Normals for the `count` points of the cloud as it was given, (N, 3); zero for those that were cleaned away.
    #[must_use]
    pub fn normals_of_rows(&self, count: usize) -> Vec<[f32; 3]> {
        let mut normals = vec![[0.0; 3]; count];
        for (&row, &normal) in self.kept.iter().zip(self.oriented.normals()) {
            if let Some(of_row) = normals.get_mut(row as usize) {
                *of_row = normal;
            }
        }
        normals
    }

    /// Returns true if its cloud, in `frame`, looks as if y were up and not z ([`looks_y_up`]). Clouds with a reference
    /// system have z up.
    #[must_use]
    pub fn looks_y_up(&self, frame: &Frame) -> bool {
        frame.crs.kind == CrsKind::Unknown && looks_y_up(self.oriented.positions(), self.oriented.normals())
    }

    /// Returns the contradiction between the cloud and metres, the unit by assumption without a reference system.
    ///
    /// # Errors
    /// Those of [`unit_contradiction_of`].
    pub fn unit_contradiction(&self, frame: &Frame, control: &Control<'_>) -> Result<Option<FoundContradiction>> {
        let is_known = frame.crs.kind != CrsKind::Unknown;
        if is_known { Ok(None) } else { unit_contradiction_of(self.oriented.positions(), control) }
    }

    /// Returns the space that pulses prove empty, if carving was wanted and possible and pulses are known instead of
    /// assumed.
    #[must_use]
    pub fn pulses(&self) -> Option<FreeSegmentColumns> {
        let input = self.carving.as_ref().filter(|input| !input.is_assumed)?;
        let mut columns = input.free_segments.to_columns();
        for proving in [&input.between_returns, &input.into_the_sky].into_iter().flatten() {
            columns.append(proving.to_columns());
        }
        Some(columns.in_order())
    }
}

/// Refuses points for which the system has too little memory, before it is needed: later the process would end at once.
fn check_memory(count: usize) -> Result<()> {
    let bytes = count.saturating_mul(MIN_BYTES_OF_POINT);
    // nothing is written into it, so that this takes no memory
    let refused = |_| Error::TooLittleMemory { work: format!("making balls of {count} points"), bytes: bytes as u64 };
    Vec::<u8>::new().try_reserve_exact(bytes).map_err(refused)
}

/// Prepares a cloud as [`OrientedSurvey::prepare`], with statistics of the `whole` where these are known. A cloud that
/// is given away is freed as soon as nothing needs it.
pub(super) fn prepare(
    cloud: Cow<'_, PointCloud>,
    params: &ModelParams,
    whole: Option<&WholeStatistics>,
    control: &Control<'_>,
) -> Result<(OrientedSurvey, BuildReport)> {
    let mut report = BuildReport::default();
    let read_count = cloud.len();
    check_memory(read_count)?;
    let is_part = params.statistics.is_some();
    let statistics = params.statistics.as_deref().or(whole.map(|whole| &whole.statistics));
    let cleaning = statistics.map(|statistics| statistics.cleaning(&params.clean));
    let cleaning = cleaning.as_ref().unwrap_or(&params.clean);
    // where nothing carves, balls have the rows of their points
    let carving = params.balls.carving();
    let order = if carving == Carving::Unwanted { None } else { space_order(&cloud) };
    let mut cloud = match &order {
        Some(rows) => Cow::Owned(points_at(&cloud, rows)),
        None => cloud,
    };
    let (mut kept, cleaned) = control.stage("cleaning", read_count, || clean(&cloud, cleaning, control))?;
    report.removed_by_cleaning = cleaned;
    if kept.is_empty() {
        return Err(Error::NoPoints { what: format!("{read_count} were read, and cleaning removed all of them") });
    }
    // what is no surface on its own may be the edge of one
    if !is_part {
        check_surface(kept.iter().filter_map(|&row| cloud.positions.get(row as usize)))?;
    }
    if kept.len() < read_count {
        cloud = Cow::Owned(cloud.select(&kept));
    }
    if let Some(rows) = order {
        kept.iter_mut().for_each(|row| *row = rows.get(*row as usize).copied().unwrap_or(*row));
    }
    if !is_part {
        report.survey = findings(&cloud, params, whole, control)?;
    }
    let moved = match statistics {
        Some(statistics) => statistics.moved_strips().to_vec(),
        None => report.survey.moved_strips().to_vec(),
    };
    if !moved.is_empty() {
        move_strips(cloud.to_mut(), &moved);
    }
    let flight_days = FlightDays::of(&cloud.attributes);
    let wants_scanner = carving != Carving::Unwanted
        || matches!(params.orient, OrientBy::Pulses | OrientBy::ScannerOfEachPoint(_) | OrientBy::Stations(_));
    let scanner = if wants_scanner {
        let (scanner, found) = find_scanner(&cloud, (&kept, read_count), params, whole, control)?;
        let missed = found.height_offset.map(|offset| offset.miss_angle.to_degrees());
        report.survey.trajectory_miss_deg = missed.filter(|miss| *miss > MAX_MISS_DEG).map(|miss| rounded(miss, 1));
        report.scanner = Some(found);
        scanner
    } else {
        ScannerPositions::default()
    };
    let mut carving = match carving {
        Carving::Unwanted => None,
        carving => {
            let (input, pulses) = carving_input(&cloud, &scanner, (carving, statistics), params, control)?;
            report.pulses = Some(pulses);
            input
        }
    };
    let classification = cloud.attributes.classification.clone();
    if let Cow::Owned(owned) = &mut cloud {
        // only orientation needs attributes from here on, and they take more memory than the positions
        owned.attributes = for_orientation(std::mem::take(&mut owned.attributes), params);
    }
    let index = control.stage("indexing points", cloud.len(), || NeighborIndex::new(&cloud.positions, control))?;
    let by = orientation(&cloud, params, &scanner, wants_scanner, carving.is_some());
    let is_from_the_ground = carving.as_ref().is_some_and(|input| input.free_segments.are_from_the_ground());
    let mut noise = statistics.and_then(|statistics| statistics.noise);
    let (points, size) = (&cloud.positions, params.neighborhood);
    let (normals, scatter) = match by {
        Orientation::Given => (Normals::default(), Scatter::default()),
        _ if is_from_the_ground => control.stage("estimating normals", cloud.len(), || {
            let found = CloseRange::estimate(points, &index, &scanner.positions, size, control)?;
            noise = found.noise;
            Ok((found.normals, found.scatter))
        })?,
        _ => control.stage("estimating normals", cloud.len(), || {
            // points that nothing carves may be in any unit
            let is_flown = statistics.is_some() || carving.is_some();
            let farthest = if is_flown { FARTHEST_NEIGHBOR } else { f32::INFINITY };
            estimate_within(points, &index, size, farthest, control)
        })?,
    };
    let scatter = (carving.is_some() && params.balls.smooths() && !scatter.roughness.is_empty()).then_some(scatter);
    let (mut oriented, orientation) =
        control.stage("orienting normals", cloud.len(), || orient(&cloud, normals, &by, control))?;
    report.normals = NormalsReport::new(&by, orientation);
    if let (true, Some(noise), Some(input)) = (is_from_the_ground, noise, &mut carving) {
        input.lead_up_to(noise, &scanner, params, control)?;
    }
    let mut index = index;
    let measured = if carving.is_some() { oriented.positions().to_vec() } else { Vec::new() };
    if let Some(scatter) = scatter {
        if statistics.is_none() && !is_from_the_ground {
            noise = scatter.noise();
        }
        let (positions, moved) = scatter.smoothed_within(noise, oriented.positions());
        index = index.moved_to(&positions)?;
        oriented = oriented.moved_to(positions);
        report.smoothing = Some(SmoothingReport { noise: noise.unwrap_or_default(), moved });
    }
    if let Some(input) = &mut carving {
        input.scanner = scanner.positions;
    }
    let bounds = cloud.bounds().ok_or_else(|| Error::NoPoints { what: "none was read".to_owned() })?;
    Ok((OrientedSurvey { oriented, index, kept, bounds, measured, classification, flight_days, carving }, report))
}

/// Finds the properties of the survey of a whole cloud. Heights of lines are compared if they are flight lines.
fn findings(
    cloud: &PointCloud,
    params: &ModelParams,
    whole: Option<&WholeStatistics>,
    control: &Control<'_>,
) -> Result<SurveyFindings> {
    let mut findings = SurveyFindings::of_cloud(cloud);
    if let Some(whole) = whole {
        findings.strips = whole.statistics.strips.clone();
        return Ok(findings);
    }
    let is_flown = cloud.scanner_positions.is_empty()
        && cloud.attributes.gps_time.is_some()
        && !matches!(params.orient, OrientBy::Stations(_) | OrientBy::Scanner | OrientBy::ScannerAt(_));
    if is_flown {
        let compare = || compare_strips(cloud, params.strips.params(), control);
        let compared = control.stage("comparing flight lines", cloud.len(), compare)?;
        findings.strips = compared.filter(|strips| !strips.moved.is_empty());
    }
    if let (Some(strips), StripHeights::Kept(_)) = (&mut findings.strips, &params.strips) {
        strips.moved.clear();
    }
    Ok(findings)
}

/// The attributes that [`orient()`] reads.
fn for_orientation(attributes: Attributes, params: &ModelParams) -> Attributes {
    Attributes {
        normals: attributes.normals,
        scanner_index: attributes.scanner_index,
        gps_time: attributes.gps_time.filter(|_| matches!(params.orient, OrientBy::Trajectory(_))),
        gps_time_kind: attributes.gps_time_kind,
        ..Attributes::default()
    }
}

impl CarvingInput {
    /// Lets pulses that all come from one place prove their way up to a few times the `noise` of their ranges, metres,
    /// before their returns. Where they come from several, how well these places are known counts as well, which the
    /// cloud does not tell.
    fn lead_up_to(
        &mut self,
        noise: f32,
        scanner: &ScannerPositions,
        params: &ModelParams,
        control: &Control<'_>,
    ) -> Result<()> {
        let mut known = scanner.positions.iter().filter(|p| p.iter().all(|v| v.is_finite()));
        let first = known.next();
        let nearer = params.free_segments.end_margin - NOISES_BEFORE_RETURNS * noise;
        if nearer > 0.0 && known.all(|p| Some(p) == first) {
            self.free_segments = self.free_segments.extended(nearer, control)?;
        }
        Ok(())
    }
}

/// Refuses points that cannot lie on a surface: fewer than four, or all within a millimetre of one line.
fn check_surface<'a>(points: impl Iterator<Item = &'a [f32; 3]> + Clone) -> Result<()> {
    let count = points.clone().count();
    if count < 4 {
        return Err(Error::NoSurface { count, what: "fewer than four" });
    }
    let place = |p: &[f32; 3]| p.map(f64::from);
    let Some(first) = points.clone().next().map(place) else { return Ok(()) };
    let along = points.clone().map(|p| sub(place(p), first)).max_by(|a, b| length(*a).total_cmp(&length(*b)));
    let is_beside = match along.and_then(unit) {
        Some(along) => points.clone().any(|p| length(cross(sub(place(p), first), along)) > LINE_WIDTH),
        None => false,
    };
    if is_beside { Ok(()) } else { Err(Error::NoSurface { count, what: "all on one line or in one place" }) }
}

/// Returns the orientation of normals for the requested method and the data of the cloud.
fn orientation<'a>(
    cloud: &PointCloud,
    params: &'a ModelParams,
    scanner: &'a ScannerPositions,
    wants_scanner: bool,
    is_carved: bool,
) -> Orientation<'a> {
    match &params.orient {
        OrientBy::Auto if wants_scanner && !scanner.is_assumed => Orientation::Pulses(&scanner.positions),
        OrientBy::Auto if cloud.attributes.normals.is_some() => Orientation::Given,
        OrientBy::Auto if !cloud.scanner_positions.is_empty() => Orientation::Scanner,
        OrientBy::Auto | OrientBy::Up => Orientation::Up,
        OrientBy::Given => Orientation::Given,
        OrientBy::Scanner => Orientation::Scanner,
        OrientBy::ScannerAt(position) => {
            let scale = cloud.frame.crs.metres_per_unit_xyz();
            Orientation::ScannerAt(vec![std::array::from_fn(|i| position[i] * scale[i])])
        }
        OrientBy::ScannerOfEachPoint(_) | OrientBy::Stations(_) | OrientBy::Pulses => {
            Orientation::Pulses(&scanner.positions)
        }
        // heights of the trajectory were checked by the pulses where these carve
        OrientBy::Trajectory(_) if is_carved => Orientation::Pulses(&scanner.positions),
        OrientBy::Trajectory(trajectory) => Orientation::Trajectory(trajectory),
        OrientBy::Mesh(mesh) => Orientation::Mesh(mesh),
    }
}

/// Locates the scanner for each point of `cloud`, whose points are the rows `kept` of `read_count` that were given.
fn find_scanner(
    cloud: &PointCloud,
    (kept, read_count): (&[u32], usize),
    params: &ModelParams,
    whole: Option<&WholeStatistics>,
    control: &Control<'_>,
) -> Result<(ScannerPositions, ScannerReport)> {
    if let Some(whole) = whole {
        let positions = whole.statistics.scanner(cloud, control)?;
        return Ok((ScannerPositions { positions, ..ScannerPositions::default() }, whole.scanner.clone()));
    }
    if let Some(statistics) = &params.statistics {
        let positions = statistics.scanner(cloud, control)?;
        let known_count = positions.iter().filter(|p| p.iter().all(|v| v.is_finite())).count();
        let mut report = ScannerReport { point_count: cloud.len(), ..ScannerReport::default() };
        let found_by = if statistics.are_pulses_assumed() { FoundBy::Assumed } else { FoundBy::Trajectory };
        report.found.insert(found_by, known_count);
        let is_assumed = statistics.are_pulses_assumed();
        return Ok((ScannerPositions { positions, is_assumed, ..ScannerPositions::default() }, report));
    }
    let means = match &params.orient {
        OrientBy::ScannerOfEachPoint(given) => {
            if given.len() != read_count {
                let (expected, found) = (read_count, given.len());
                return Err(Error::LengthMismatch { what: "scanner positions", expected, found });
            }
            let positions: Vec<[f32; 3]> = kept.iter().filter_map(|&row| given.get(row as usize).copied()).collect();
            let known_count = positions.iter().filter(|p| p.iter().all(|v| v.is_finite())).count();
            let mut report = ScannerReport { point_count: cloud.len(), ..ScannerReport::default() };
            report.found.insert(FoundBy::Position, known_count);
            return Ok((ScannerPositions { positions, ..ScannerPositions::default() }, report));
        }
        orient => orient.means(&cloud.frame),
    };
    let (positions, report) =
        control.stage("estimating scanner positions", 0, || locate(cloud, &means, &params.locate, control))?;
    let (is_assumed, are_poses) = (report.is_assumed(), report.found.contains_key(&FoundBy::Pose));
    Ok((ScannerPositions { positions, is_assumed, are_poses }, report))
}

/// Collects the input of carving from a cloud, with a report. `None` if pulses are only assumed, too few, and need not
/// carve.
fn carving_input(
    cloud: &PointCloud,
    scanner: &ScannerPositions,
    (carving, statistics): (Carving, Option<&SurveyStatistics>),
    params: &ModelParams,
    control: &Control<'_>,
) -> Result<(Option<CarvingInput>, PulsesReport)> {
    let (free_segments, report) = control.stage("indexing pulses", cloud.len(), || {
        let top = statistics.map(|statistics| statistics.top);
        FreeSegments::of_cloud_below(cloud, &scanner.positions, top, &params.free_segments, control)
    })?;
    let mut report = PulsesReport { free_segments: report, ..PulsesReport::default() };
    let used = report.free_segments.used as f64;
    if statistics.is_some_and(|statistics| !statistics.carves) {
        return Ok((None, report));
    }
    // of a part it was decided with the whole
    let carving = if statistics.is_some() { Carving::Wanted } else { carving };
    if scanner.is_assumed && used < MIN_ASSUMED_SHARE * cloud.len() as f64 && carving == Carving::IfPossible {
        report.remark = Some(format!(
            "pulses do not carve here: they are only assumed to be vertical, and {:.0} % of the points have something above them; give \
             the positions of the scanner",
            100.0 * (1.0 - used / cloud.len() as f64)
        ));
        return Ok((None, report));
    }
    let finds_ground = match statistics {
        Some(statistics) => statistics.finds_ground,
        None => !free_segments.are_from_the_ground() && !tell_ground(cloud),
    };
    let found = if finds_ground { Some(found_classes(cloud, control)?) } else { None };
    report.found_ground = found.as_ref().map_or(0, |classes| classes.iter().filter(|class| **class == 2).count());
    let attributes = Attributes {
        classification: found.or_else(|| cloud.attributes.classification.clone()),
        return_number: cloud.attributes.return_number.clone(),
        return_count: cloud.attributes.return_count.clone(),
        ..Attributes::default()
    };
    let pulses = match control.stage("grouping pulses", 0, || group(cloud, control)) {
        _ if params.statistics.as_ref().is_some_and(|statistics| !statistics.measures_crowns) => None,
        Ok((pulses, _)) => Some(pulses),
        // here and now none, which says nothing of the whole
        Err(Error::MissingAttribute { .. }) if params.statistics.is_some() => Some(Pulses::default()),
        // without pulses nothing is known of what gets through crowns, and all else is
        Err(error @ Error::MissingAttribute { .. }) => {
            report.crowns_not_measured = Some(error.to_string());
            None
        }
        Err(error) => return Err(error),
    };
    // scanners on the ground see stems from the side; parts of a survey are seen from the air
    let is_from_air = statistics.is_some() || !free_segments.are_from_the_ground();
    let may_prove = !scanner.is_assumed && is_from_air;
    let between_returns = match pulses.as_ref().filter(|_| may_prove) {
        Some(pulses) => Some(free_segments.between_returns(cloud, pulses, &params.free_segments, control)?),
        None => None,
    };
    report.between_returns = between_returns.as_ref().map_or(0, FreeSegments::len);
    let sees_sky = scanner.are_poses && params.statistics.is_none() && !cloud.sky_regions.is_empty();
    let into_the_sky = sees_sky.then(|| free_segments.into_the_sky(cloud, control)).transpose()?;
    report.into_the_sky = into_the_sky.as_ref().map(FreeSegments::len);
    let input = CarvingInput {
        free_segments,
        between_returns,
        into_the_sky,
        attributes,
        is_assumed: scanner.is_assumed,
        scanner: Vec::new(),
        pulses,
    };
    Ok((Some(input), report))
}

/// Returns true if a cloud has classes of ground or vegetation.
fn tell_ground(cloud: &PointCloud) -> bool {
    cloud.attributes.classification.as_ref().is_some_and(|classes| classes.iter().any(|class| matches!(class, 2..=5)))
}

/// Classes of a cloud without a class of ground: 2 for the ground found, and otherwise unchanged.
fn found_classes(cloud: &PointCloud, control: &Control<'_>) -> Result<Vec<u8>> {
    let is_ground = control.stage("finding ground", cloud.len(), || ground_in_blocks(cloud, control))?;
    let mut classes = cloud.attributes.classification.clone().unwrap_or_else(|| vec![1; cloud.len()]);
    for (class, _) in classes.iter_mut().zip(is_ground).filter(|(class, found)| *found && matches!(**class, 0 | 1 | 12))
    {
        *class = 2;
    }
    Ok(classes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_that_no_computer_can_hold_are_refused_in_a_sentence() {
        assert!(check_memory(1_000_000).is_ok());
        for count in [1 << 48, usize::MAX] {
            let error = check_memory(count).unwrap_err().to_string();
            assert!(error.starts_with(&format!("making balls of {count} points takes about")), "{error}");
            assert!(error.contains("use a smaller part") && error.contains("ulimit -v"), "{error}");
        }
    }
}
