//! Orientation of normals: their signs from up, scanners, a trajectory, a city model, or the file.

use rayon::prelude::*;
use serde::{Serialize, Serializer, ser::SerializeMap};

use super::Normals;
use super::oriented::{OrientedCloud, unit_or_zero};
use super::reference_mesh::{MeshVerdict, ReferenceMesh};
use super::surroundings::HighestPointGrid;
use belvedere_data::control::{Control, Stop};
use belvedere_data::report::percent;
use belvedere_data::trajectory::{ClockOffset, Trajectory};
use belvedere_data::vector::{dot, sub, to_f32};
use belvedere_data::{Error, Mesh, Parameter, PointCloud, Result};

/// Below this |n_z| a surface counts as steep, and up says nothing: a wall with normals that are 17° wrong.
const STEEP_NZ: f64 = 0.3;

/// Weight of the vote of roof and ground: right in most cases, never proven.
const VOTE_WEIGHT: f64 = 0.5;

/// Weight of the upward direction where a better method was requested but gave no result for a point.
const FALLBACK_WEIGHT: f64 = 0.25;

/// Confidence below which a sign is as good as unknown: the line of sight runs within 3° of the surface.
pub const LOW_CONFIDENCE: f32 = 0.05;

/// Cosine between normal and pulse below which the vote of roof and ground, or up, is more reliable than the pulse. On
/// sparse facades normals are tilted by ten degrees and more. On simulated towns (seeds 7 and 8) leaving such signs to
/// the vote gains 0.9 to 1.3 points of IoU in free air.
const GRAZING: f32 = 0.3;
/// Minimum vertical part of a pulse's direction for it to come from above: roofs and ground vote for such surveys.
/// Surfaces seen from the side, or from below as ceilings are, know neither.
const FROM_ABOVE: f64 = 0.3;

/// Source of the outward side of each normal.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Orientation<'a> {
    /// Upward; steep points away from the higher half of the points within 3 m.
    Up,
    /// Towards the scanner set-up that the file names for each point, the nearest where it names none.
    Scanner,
    /// Towards the nearest of these positions, in the metres of the cloud's reference system (not local), (S, 3).
    ScannerAt(Vec<[f64; 3]>),
    /// Towards where the scanner was at each point's GPS time, whatever the angle, as the paper has it.
    Trajectory(&'a Trajectory),
    /// Towards where the scanner was when it measured each point, (N, 3), local metres; NaN where that is unknown. As
    /// [`Orientation::Up`] where that is so, and where the pulse ran within 17° of the surface.
    Pulses(&'a [[f32; 3]]),
    /// Nearest face of this mesh, or the side of the point that is outside the mesh.
    Mesh(&'a Mesh),
    /// Normals of the file, which replace the estimated ones.
    Given,
}

/// Counts of normals by the source of their sign. The `by_` counts and `without_normal_count` add up to the points.
///
/// Serialised, counts become percentages of the points, those that are zero left out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OrientReport {
    /// Points in all.
    pub point_count: usize,
    /// Points whose normal is zero: nothing to orient.
    pub without_normal_count: usize,
    /// Number of signs given by the file.
    pub by_file_count: usize,
    /// Towards a scanner at a known place, set-up or trajectory.
    pub by_scanner_count: usize,
    /// Number of signs from an aligned face of the mesh.
    pub by_face_count: usize,
    /// Towards the side of the point that is outside the mesh.
    pub by_parity_count: usize,
    /// Away from the higher half of the surroundings.
    pub by_vote_count: usize,
    /// Upward.
    pub by_up_count: usize,
    /// Normals whose sign was changed.
    pub flipped_count: usize,
    /// Normals with a confidence below [`LOW_CONFIDENCE`].
    pub low_confidence_count: usize,
    /// Conversion of GPS times to those of the trajectory, if one was used.
    pub clock: Option<ClockOffset>,
}

impl OrientReport {
    /// Share of the points that `count` is, 0 to 1.
    #[must_use]
    pub fn share(&self, count: usize) -> f64 {
        count as f64 / self.point_count.max(1) as f64
    }
}

impl Serialize for OrientReport {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        let counts = [
            ("as_given_percent", self.by_file_count),
            ("towards_scanner_percent", self.by_scanner_count),
            ("as_aligned_face_percent", self.by_face_count),
            ("by_parity_percent", self.by_parity_count),
            ("by_vote_of_roof_and_ground_percent", self.by_vote_count),
            ("upward_percent", self.by_up_count),
            ("without_normal_percent", self.without_normal_count),
            ("low_confidence_percent", self.low_confidence_count),
        ];
        let mut map = serializer.serialize_map(None)?;
        for (key, count) in counts.into_iter().filter(|(_, count)| *count > 0) {
            map.serialize_entry(key, &percent(count, self.point_count))?;
        }
        if let Some(clock) = &self.clock {
            map.serialize_entry("points_on_trajectory", &clock.known_count)?;
        }
        map.end()
    }
}

/// Source of a sign.
#[derive(Clone, Copy, PartialEq)]
enum SignSource {
    Nothing,
    File,
    Scanner,
    Face,
    Parity,
    Vote,
    Up,
}

/// A sign: non-negative where the normal is outward already; its size is the confidence.
#[derive(Clone, Copy)]
struct NormalSign {
    way: SignSource,
    outward: f32,
}

impl NormalSign {
    fn new(way: SignSource, outward: f64) -> Self {
        Self { way, outward: to_f32(outward) }
    }
}

/// The cloud with outward normals, and how they were found.
///
/// `normals` are unit vectors with quality, (N) each; lengths are corrected where they are off, and a normal that is
/// zero or not finite stays zero with zero confidence. The confidence is |n·v| for the unit vector v to the scanner or
/// up,
/// |n·n_f| for the normal n_f of an aligned face (half of that where the mesh itself could not be verified), 0.5 for
/// parity, 0.5·|n·h| for the vote (h horizontal), 0.25·|n_z| for the upward direction where another method was
/// requested but gave no result, 1 for given normals. For [`Orientation::Given`], `normals` may be empty; then the
/// quality is 1.
///
/// A mesh need not be consistently oriented or closed. Each of its faces is first turned to its open side if one side
/// is open and the other enclosed (parity of crossings straight up, which needs no orientation). Other faces keep their
/// turning sense, but are overruled by parity at the point.
///
/// A face counts as the point's own surface within 2 m, if their normals are within 60° of each other and the point
/// lies at most 0.25 m beside it. The result is the same for any number of threads.
///
/// # Errors
/// - [`Error::LengthMismatch`] if lengths differ.
/// - [`Error::MissingAttribute`] if the cloud lacks scanner positions, GPS times or normals that the source needs.
/// - [`Error::InvalidParameter`] for positions or scanners that are not finite, no scanner at all, a mesh without a
///   face, and a trajectory that knows a position at none of the cloud's times.
/// - [`Error::Cancelled`].
///
/// # Source
/// By scanner position and by city model: Peters, Ledoux & Biljecki 2015, section 4. The vote, the probing of faces and
/// the thresholds are this project's own.
pub fn orient(
    cloud: &PointCloud,
    normals: Normals,
    by: &Orientation<'_>,
    control: &Control<'_>,
) -> Result<(OrientedCloud, OrientReport)> {
    cloud.validate()?;
    let Normals { mut vectors, mut quality } = match by {
        Orientation::Given => given_normals(cloud, normals)?,
        _ => normals,
    };
    for (what, found) in [("normals", vectors.len()), ("quality of normals", quality.len())] {
        if found != cloud.len() {
            return Err(Error::LengthMismatch { what, expected: cloud.len(), found });
        }
    }
    vectors.par_iter_mut().for_each(|normal| *normal = unit_or_zero(*normal));
    let mut clock = None;
    let verdicts = match by {
        Orientation::Given => each(cloud, &vectors, control, |_, _, _| Some(NormalSign::new(SignSource::File, 1.0)))?,
        Orientation::Up => each(cloud, &vectors, control, |_, _, _| None)?,
        Orientation::Scanner => by_own_scanner(cloud, &vectors, control)?,
        Orientation::ScannerAt(scanners) => by_nearest_scanner(cloud, &vectors, scanners, control)?,
        Orientation::Trajectory(trajectory) => {
            let (scanner, offset) = trajectory.scanner_positions(cloud)?;
            clock = Some(offset);
            by_pulses(cloud, &vectors, &scanner, 0.0, control)?
        }
        Orientation::Pulses(scanner) => by_pulses(cloud, &vectors, scanner, GRAZING, control)?,
        Orientation::Mesh(mesh) => by_mesh(cloud, &vectors, mesh, control)?,
    };
    let mut report = OrientReport { point_count: cloud.len(), clock, ..OrientReport::default() };
    let verdicts = fall_back(cloud, &vectors, verdicts, by, control)?;
    for ((verdict, normal), quality) in verdicts.iter().zip(&mut vectors).zip(&mut quality) {
        let count = match verdict.way {
            SignSource::Nothing => &mut report.without_normal_count,
            SignSource::File => &mut report.by_file_count,
            SignSource::Scanner => &mut report.by_scanner_count,
            SignSource::Face => &mut report.by_face_count,
            SignSource::Parity => &mut report.by_parity_count,
            SignSource::Vote => &mut report.by_vote_count,
            SignSource::Up => &mut report.by_up_count,
        };
        *count += 1;
        if verdict.way == SignSource::Nothing {
            *quality = 0.0;
        } else if verdict.outward < 0.0 {
            *normal = normal.map(|v| -v);
            report.flipped_count += 1;
        }
    }
    let confidence: Vec<f32> = verdicts.iter().map(|verdict| verdict.outward.abs().min(1.0)).collect();
    report.low_confidence_count = verdicts
        .iter()
        .zip(&confidence)
        .filter(|(verdict, confidence)| verdict.way != SignSource::Nothing && **confidence < LOW_CONFIDENCE)
        .count();
    let oriented = OrientedCloud::new(cloud.positions.clone(), vectors, quality, confidence)?;
    Ok((oriented.with_place(cloud.frame.origin, cloud.frame.crs.clone()), report))
}

/// Verdict of `decide(index, position, normal)` on every point that has a normal.
fn each(
    cloud: &PointCloud,
    vectors: &[[f32; 3]],
    control: &Control<'_>,
    decide: impl Fn(usize, [f64; 3], [f64; 3]) -> Option<NormalSign> + Sync,
) -> Result<Vec<Option<NormalSign>>> {
    let stop = Stop::new(control);
    let decide_one = |(index, (p, n)): (usize, (&[f32; 3], &[f32; 3]))| {
        if *n == [0.0; 3] || stop.is_set() {
            return Some(NormalSign::new(SignSource::Nothing, 0.0));
        }
        decide(index, p.map(f64::from), n.map(f64::from))
    };
    let verdicts = cloud.positions.par_iter().zip(vectors).enumerate().map(decide_one).collect();
    stop.check()?;
    control.advance(cloud.len());
    Ok(verdicts)
}

/// Fills in signs without a verdict: by the vote where the surface is steep, else by up.
fn fall_back(
    cloud: &PointCloud,
    vectors: &[[f32; 3]],
    verdicts: Vec<Option<NormalSign>>,
    by: &Orientation<'_>,
    control: &Control<'_>,
) -> Result<Vec<NormalSign>> {
    let stop = Stop::new(control);
    let weight = if matches!(by, Orientation::Up) { 1.0 } else { FALLBACK_WEIGHT };
    let is_steep = |n: &[f32; 3]| f64::from(n[2]).abs() < STEEP_NZ;
    let vote_needed = verdicts.iter().zip(vectors).any(|(verdict, n)| verdict.is_none() && is_steep(n));
    let surroundings = vote_needed.then(|| HighestPointGrid::new(&cloud.positions));
    let decide = |((verdict, p), n): ((Option<NormalSign>, &[f32; 3]), &[f32; 3])| {
        verdict.unwrap_or_else(|| {
            if stop.is_set() {
                return NormalSign::new(SignSource::Nothing, 0.0);
            }
            let downhill = surroundings.as_ref().filter(|_| is_steep(n)).and_then(|around| around.downhill(*p));
            match downhill {
                Some([x, y]) => {
                    let along = f64::from(n[0]) * x + f64::from(n[1]) * y;
                    NormalSign::new(SignSource::Vote, VOTE_WEIGHT * along * weight)
                }
                None => NormalSign::new(SignSource::Up, f64::from(n[2]) * weight),
            }
        })
    };
    let verdicts = verdicts.into_par_iter().zip(&cloud.positions).zip(vectors).map(decide).collect();
    stop.check()?;
    Ok(verdicts)
}

fn given_normals(cloud: &PointCloud, estimated: Normals) -> Result<Normals> {
    let Some(vectors) = cloud.attributes.normals.clone() else {
        return Err(Error::MissingAttribute {
            attribute: "normals",
            needed_for: "orientation as given",
            advice: "orient by up, a scanner, a trajectory or a mesh",
        });
    };
    let quality = if estimated.quality.is_empty() { vec![1.0; vectors.len()] } else { estimated.quality };
    Ok(Normals { vectors, quality })
}

/// Towards `scanner`, or nothing to say where the point lies on it.
fn towards(scanner: [f64; 3], position: [f64; 3], normal: [f64; 3]) -> Option<NormalSign> {
    let sight = sub(scanner, position);
    let length = dot(sight, sight).sqrt();
    (length > 1e-6).then(|| NormalSign::new(SignSource::Scanner, dot(normal, sight) / length))
}

fn nearest(scanners: &[[f64; 3]], position: [f64; 3]) -> Option<[f64; 3]> {
    let squared = |s: &[f64; 3]| (0..3).map(|i| (s[i] - position[i]).powi(2)).sum::<f64>();
    scanners.iter().copied().min_by(|a, b| squared(a).total_cmp(&squared(b)))
}

fn by_own_scanner(cloud: &PointCloud, vectors: &[[f32; 3]], control: &Control<'_>) -> Result<Vec<Option<NormalSign>>> {
    if cloud.scanner_positions.is_empty() {
        return Err(Error::MissingAttribute {
            attribute: "scanner position",
            needed_for: "orientation toward the scanner",
            advice: "give the position of the scanner, or orient by up",
        });
    }
    let scanners: Vec<[f64; 3]> = cloud.scanner_positions.iter().map(|s| s.map(f64::from)).collect();
    check_finite(&scanners)?;
    let own = cloud.attributes.scanner_index.as_deref();
    each(cloud, vectors, control, |index, position, normal| {
        let named = own.and_then(|own| scanners.get(usize::from(*own.get(index)?)).copied());
        towards(named.or_else(|| nearest(&scanners, position))?, position, normal)
    })
}

fn by_nearest_scanner(
    cloud: &PointCloud,
    vectors: &[[f32; 3]],
    scanners: &[[f64; 3]],
    control: &Control<'_>,
) -> Result<Vec<Option<NormalSign>>> {
    check_finite(scanners)?;
    let local: Vec<[f64; 3]> = scanners.iter().map(|s| std::array::from_fn(|i| s[i] - cloud.frame.origin[i])).collect();
    each(cloud, vectors, control, |_, position, normal| towards(nearest(&local, position)?, position, normal))
}

fn check_finite(scanners: &[[f64; 3]]) -> Result<()> {
    if scanners.is_empty() || scanners.iter().flatten().any(|v| !v.is_finite()) {
        let value = format!("{scanners:?}");
        return Err(Error::invalid(Parameter::ScannerPositions, value, "at least one, finite"));
    }
    Ok(())
}

/// Towards `scanner` where the cosine between normal and pulse is `min` or more, and wherever the pulse does not come
/// from above.
fn by_pulses(
    cloud: &PointCloud,
    vectors: &[[f32; 3]],
    scanner: &[[f32; 3]],
    min: f32,
    control: &Control<'_>,
) -> Result<Vec<Option<NormalSign>>> {
    if scanner.len() != cloud.len() {
        return Err(Error::LengthMismatch { what: "scanner positions", expected: cloud.len(), found: scanner.len() });
    }
    each(cloud, vectors, control, |index, position, normal| {
        let scanner = scanner.get(index)?.map(f64::from);
        let verdict = scanner.iter().all(|v| v.is_finite()).then(|| towards(scanner, position, normal))??;
        let [x, y, up] = sub(scanner, position);
        let is_from_above = up > FROM_ABOVE * (x * x + y * y + up * up).sqrt();
        (verdict.outward.abs() >= min || !is_from_above).then_some(verdict)
    })
}

fn by_mesh(
    cloud: &PointCloud,
    vectors: &[[f32; 3]],
    mesh: &Mesh,
    control: &Control<'_>,
) -> Result<Vec<Option<NormalSign>>> {
    let reference = ReferenceMesh::new(mesh, cloud.frame.origin, control)?.ok_or_else(|| {
        Error::invalid(
            Parameter::Mesh,
            format!("{} triangles without area", mesh.triangles.len()),
            "at least one triangle with an area",
        )
    })?;
    each(cloud, vectors, control, |_, position, normal| match reference.verdict(position, normal) {
        MeshVerdict::Face(outward) => Some(NormalSign::new(SignSource::Face, outward)),
        MeshVerdict::Parity(outward) => Some(NormalSign::new(SignSource::Parity, outward)),
        MeshVerdict::Silent => None,
    })
}
