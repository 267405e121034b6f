//! One cloud from the parts: a common origin, far points left out, attributes joined.

use rayon::prelude::*;

use crate::points::coordinates::{Coordinates, unquantise};
use crate::points::file_part::FilePart;
use crate::points::read_options::{DistantFiles, ReadOptions, RowNumbers};
use crate::points::read_report::ReadReport;
use belvedere_data::Frame;
use belvedere_data::cloud::{CloudFile, CloudFiles, FileRows, PointCloud, origin_of, to_local};
use belvedere_data::crs::{Crs, CrsKind};
use belvedere_data::{Error, Parameter, Result};

/// Points further than this from the median (or from a fixed origin) along an axis are no part of any scene, in metres.
const FARTHEST: f64 = 1e6;

/// Only points this near to the median influence the origin, in metres: f32 keeps a millimetre up to 16 km, and one
/// stray point must not coarsen all others.
const NEAR: f64 = 1e4;

/// The median is taken of about this many points, evenly spread: it only has to land among the points.
const SAMPLE: usize = 200_000;

/// Any position of the part, in the unit of its file; zero without points.
pub(crate) fn any_position(part: &FilePart) -> [f64; 3] {
    middle(std::slice::from_ref(part), |_| [1.0; 3])
}

/// Joins `parts`, in order, in the frame of `options` where that is given.
pub(crate) fn assemble(mut parts: Vec<FilePart>, options: &ReadOptions) -> Result<(PointCloud, ReadReport)> {
    let mut report = ReadReport::default();
    let fixed = options.frame.as_ref();
    adopt_common_crs(&mut parts, fixed, &mut report);
    // Whether a point is far away must not depend on which other points were read with it where the frame is fixed.
    let middle = fixed.map_or_else(|| middle(&parts, |part| part.crs.metres_per_unit_xyz()), |frame| frame.origin);

    let found: Vec<PartPass> = parts.iter().map(|part| look(part, middle)).collect();
    let bounds = found.iter().fold(PointExtent::default(), |bounds, one| bounds.join(one.bounds));
    let chosen = || origin_of([bounds.low, bounds.high].into_iter());
    let origin = fixed.map_or_else(chosen, |frame| frame.origin);

    let mut cloud = PointCloud::in_frame(Frame { origin, ..Frame::default() });
    name_system(&mut cloud.frame, &mut report, &parts, fixed);
    if cloud.frame.crs.kind == CrsKind::Unknown && bounds.looks_like_degrees() {
        report.notes.push(
            "the reference system is unknown; the coordinates are taken as metres, but look like degrees; if they are degrees, convert them to a projected system"
                .to_owned(),
        );
    }

    if fixed.is_none() && options.distant == DistantFiles::Refused {
        refuse_distant(&parts, &found)?;
    }
    let any_scanners = parts.iter().any(|part| part.attributes.scanner_index.is_some());
    for (mut part, found) in parts.into_iter().zip(found) {
        part.note_unnamed();
        part.leave_out(found.not_finite, "coordinates are not finite");
        part.leave_out(found.far, "more than 1000 km from the middle of the cloud");
        if found.coarse > 0 {
            part.note(format!("{} points lie more than 10 km from the middle and lose precision", found.coarse));
        }
        if any_scanners {
            join_scanners(&mut cloud, &mut part);
        }
        let scale = part.crs.metres_per_unit_xyz();
        if found.not_finite + found.far > 0 {
            let kept = kept_indices(&part, middle);
            part.keep(&kept);
        }
        add_file(&mut cloud.files, &mut part);
        if options.row_numbers == RowNumbers::Kept {
            report.rows.extend(part.rows.take().unwrap_or_else(|| (0..part.coordinates.len() as u64).collect()));
        }
        let (positions, attributes) = (localise(part.coordinates, scale, origin), part.attributes);
        part.report.points = positions.len();
        let dropped = cloud.attributes.append(cloud.positions.len(), attributes, positions.len());
        report.dropped_attributes.extend(dropped);
        if cloud.positions.is_empty() {
            cloud.positions = positions;
        } else {
            cloud.positions.extend(positions);
        }
        report.files.push(part.report);
    }
    if cloud.scanner_positions.is_empty() {
        cloud.attributes.scanner_index = None;
    }
    report.dropped_attributes.sort_unstable();
    report.dropped_attributes.dedup();
    if cloud.is_empty() {
        return Err(Error::NoPoints { what: nothing_left(&report) });
    }
    if u32::try_from(cloud.len()).is_err() {
        return Err(Error::invalid(Parameter::PointCount, cloud.len(), "at most 4294967295; read fewer files at once"));
    }
    cloud.validate()?;
    Ok((cloud, report))
}

/// Gives a cloud the system that is fixed, or else that of the first of its parts that names one.
fn name_system(of_cloud: &mut Frame, report: &mut ReadReport, parts: &[FilePart], fixed: Option<&Frame>) {
    if let Some(frame) = fixed.filter(|frame| frame.crs.kind != CrsKind::Unknown) {
        *of_cloud = frame.clone();
        report.crs_source = "frame".to_owned();
    } else if let Some(part) = parts.iter().find(|part| part.crs.kind != CrsKind::Unknown) {
        of_cloud.crs = part.crs.clone();
        report.crs_source = part.report.crs_source.clone();
    } else if let Some(part) = parts.first() {
        // a file can tell its unit without naming a system
        of_cloud.crs = part.crs.clone();
    }
    if of_cloud.crs.doubt.is_none() {
        of_cloud.crs.doubt = parts.iter().find_map(|part| part.crs.doubt.clone());
    }
    report.doubt.clone_from(&of_cloud.crs.doubt);
    report.crs = of_cloud.crs.describe();
}

/// Refuses a file of several of which nothing is near the middle of all.
fn refuse_distant(parts: &[FilePart], found: &[PartPass]) -> Result<()> {
    let is_distant = |(part, one): &(&FilePart, &PartPass)| {
        one.far > 0 && one.far + one.not_finite == part.coordinates.len() && parts.len() > 1
    };
    match parts.iter().zip(found).find(is_distant) {
        Some((part, _)) => Err(Error::DistantFile { path: part.report.path.clone() }),
        None => Ok(()),
    }
}

/// Adds the file of `part` to those of a cloud.
fn add_file(files: &mut CloudFiles, part: &mut FilePart) {
    let count = part.coordinates.len() as u64;
    let before: u64 = files.files.iter().map(|file| file.row_count).sum();
    let is_whole = part.rows.is_none() && part.row_count == Some(count);
    files.rows = match (std::mem::take(&mut files.rows), part.row_count) {
        (FileRows::All, Some(_)) if is_whole => FileRows::All,
        (rows @ (FileRows::All | FileRows::Of(_)), Some(_)) => {
            let mut rows = if let FileRows::Of(rows) = rows { rows } else { (0..before).collect() };
            match &part.rows {
                Some(own) => rows.extend(own.iter().map(|row| before + row)),
                None => rows.extend(before..before + count),
            }
            FileRows::Of(rows)
        }
        _ => FileRows::Unknown,
    };
    files.files.push(CloudFile {
        path: part.report.path.clone(),
        row_count: part.row_count.unwrap_or(count),
        other_attributes: std::mem::take(&mut part.other_attributes),
        records: std::mem::take(&mut part.records),
    });
}

/// Gives the files without a system that of the frame, or else of the other files.
fn adopt_common_crs(parts: &mut [FilePart], fixed: Option<&Frame>, report: &mut ReadReport) {
    let of_frame = fixed.map(|frame| &frame.crs).filter(|crs| crs.kind != CrsKind::Unknown);
    let of_files = || parts.iter().map(|part| &part.crs).find(|crs| crs.kind != CrsKind::Unknown);
    let Some(known) = of_frame.or_else(of_files).cloned() else { return };
    for part in parts.iter_mut().filter(|part| part.crs == Crs::default() && part.coordinates.len() > 0) {
        report.notes.push(format!(
            "{} names no reference system; {} is used",
            part.report.path.display(),
            known.describe()
        ));
        part.crs = known.clone();
    }
}

fn nothing_left(report: &ReadReport) -> String {
    let files = report.files.iter().map(|file| {
        let lost: Vec<String> = file.left_out.iter().map(|l| format!("{} left out: {}", l.count, l.reason)).collect();
        let lost: Vec<String> =
            lost.into_iter().chain(file.contradictions.iter().map(|found| found.text.clone())).collect();
        let why = if lost.is_empty() { "holds none".to_owned() } else { lost.join(", ") };
        format!("{} ({}): {why}", file.path.display(), file.format)
    });
    files.collect::<Vec<_>>().join("; ")
}

/// Component-wise median of a sample of the finite points, scaled by `scale`.
fn middle(parts: &[FilePart], scale: impl Fn(&FilePart) -> [f64; 3]) -> [f64; 3] {
    let total: usize = parts.iter().map(|part| part.coordinates.len()).sum();
    let step = total.div_ceil(SAMPLE).max(1);
    let mut sample: [Vec<f64>; 3] = Default::default();
    for part in parts {
        let scale = scale(part);
        let metres = |p: [f64; 3]| -> [f64; 3] { std::array::from_fn(|i| p[i] * scale[i]) };
        for p in part.coordinates.positions().step_by(step).map(metres) {
            if p.iter().all(|v| v.is_finite()) {
                for (column, v) in sample.iter_mut().zip(p) {
                    column.push(v);
                }
            }
        }
    }
    sample.map(|mut column| {
        let middle = column.len() / 2;
        if column.is_empty() { 0.0 } else { *column.select_nth_unstable_by(middle, f64::total_cmp).1 }
    })
}

/// Result of a pass over a part.
#[derive(Clone, Copy, Default)]
struct PartPass {
    bounds: PointExtent,
    not_finite: usize,
    far: usize,
    coarse: usize,
}

#[derive(Clone, Copy)]
struct PointExtent {
    low: [f64; 3],
    high: [f64; 3],
}

impl Default for PointExtent {
    fn default() -> Self {
        Self { low: [f64::INFINITY; 3], high: [f64::NEG_INFINITY; 3] }
    }
}

impl PointExtent {
    fn join(self, other: Self) -> Self {
        Self {
            low: std::array::from_fn(|i| self.low[i].min(other.low[i])),
            high: std::array::from_fn(|i| self.high[i].max(other.high[i])),
        }
    }

    /// Within the range of longitude and latitude, and many times higher than wide, which no scene in metres is.
    fn looks_like_degrees(&self) -> bool {
        let extent: [f64; 3] = std::array::from_fn(|i| self.high[i] - self.low[i]);
        let width = extent[0].max(extent[1]);
        let in_range = |axis: usize, limit: f64| self.low[axis] >= -limit && self.high[axis] <= limit;
        in_range(0, 180.0) && in_range(1, 90.0) && width > 0.0 && width < 2.0 && extent[2] > 20.0 * width
    }
}

#[derive(PartialEq)]
enum PointFate {
    Near,
    Coarse,
    Far,
    NotFinite,
}

fn fate(p: [f64; 3], middle: [f64; 3]) -> PointFate {
    if !p.iter().all(|v| v.is_finite()) {
        return PointFate::NotFinite;
    }
    let distance = (0..3).map(|i| (p[i] - middle[i]).abs()).fold(0.0, f64::max);
    if distance > FARTHEST {
        PointFate::Far
    } else if distance > NEAR {
        PointFate::Coarse
    } else {
        PointFate::Near
    }
}

fn look(part: &FilePart, middle: [f64; 3]) -> PartPass {
    let units = part.crs.metres_per_unit_xyz();
    let add = |mut found: PartPass, p: [f64; 3]| {
        let p: [f64; 3] = std::array::from_fn(|i| p[i] * units[i]);
        match fate(p, middle) {
            PointFate::NotFinite => found.not_finite += 1,
            PointFate::Far => found.far += 1,
            PointFate::Coarse => found.coarse += 1,
            PointFate::Near => found.bounds = found.bounds.join(PointExtent { low: p, high: p }),
        }
        found
    };
    // Counts, minima and maxima do not depend on how the points are split among threads.
    let join = |a: PartPass, b: PartPass| PartPass {
        bounds: a.bounds.join(b.bounds),
        not_finite: a.not_finite + b.not_finite,
        far: a.far + b.far,
        coarse: a.coarse + b.coarse,
    };
    match &part.coordinates {
        Coordinates::Real(values) => values
            .par_iter()
            .with_min_len(1 << 14)
            .fold(PartPass::default, |f, &p| add(f, p))
            .reduce(PartPass::default, join),
        Coordinates::Quantised { values, scale, offset } => values
            .par_iter()
            .with_min_len(1 << 14)
            .fold(PartPass::default, |f, &q| add(f, unquantise(q, *scale, *offset)))
            .reduce(PartPass::default, join),
    }
}

fn kept_indices(part: &FilePart, middle: [f64; 3]) -> Vec<u32> {
    let units = part.crs.metres_per_unit_xyz();
    let kept = |p: [f64; 3]| {
        let p: [f64; 3] = std::array::from_fn(|i| p[i] * units[i]);
        matches!(fate(p, middle), PointFate::Near | PointFate::Coarse)
    };
    (0..).zip(part.coordinates.positions()).filter(|&(_, p)| kept(p)).map(|(index, _)| index).collect()
}

fn localise(coordinates: Coordinates, units: [f64; 3], origin: [f64; 3]) -> Vec<[f32; 3]> {
    let local = |p: [f64; 3]| to_local(std::array::from_fn(|i| p[i] * units[i]), origin);
    match coordinates {
        // A sequential collect reuses the memory of the integers.
        Coordinates::Quantised { values, scale, offset } => {
            values.into_iter().map(|q| local(unquantise(q, scale, offset))).collect()
        }
        Coordinates::Real(values) => values.par_iter().with_min_len(1 << 14).map(|&p| local(p)).collect(),
    }
}

/// Moves the scanner positions of `part` into `cloud` and lets its indices point there.
///
/// A scanner more than 10 km from the middle of the cloud is a header left at zero, and taken as unknown.
fn join_scanners(cloud: &mut PointCloud, part: &mut FilePart) {
    let units = part.crs.metres_per_unit_xyz();
    let mut new_indices: Vec<u16> = Vec::new();
    for scanner in std::mem::take(&mut part.scanners) {
        let metres: [f64; 3] = std::array::from_fn(|i| scanner[i] * units[i]);
        let far = (0..3).any(|i| !metres[i].is_finite() || (metres[i] - cloud.frame.origin[i]).abs() > NEAR);
        let index = u16::try_from(cloud.scanner_positions.len()).ok().filter(|&index| !far && index != u16::MAX);
        if far {
            part.note(format!("the scanner position {scanner:?} is far from the cloud and taken as unknown"));
        }
        if index.is_some() {
            cloud.scanner_positions.push(to_local(metres, cloud.frame.origin));
        }
        new_indices.push(index.unwrap_or(u16::MAX));
    }
    let (regions, notes) = std::mem::take(&mut part.skies).placed(&new_indices, units);
    cloud.sky_regions.extend(regions);
    part.report.notes.extend(notes);
    let count = part.coordinates.len();
    let indices = part.attributes.scanner_index.get_or_insert_with(|| vec![u16::MAX; count]);
    for index in indices {
        *index = new_indices.get(usize::from(*index)).copied().unwrap_or(u16::MAX);
    }
}
