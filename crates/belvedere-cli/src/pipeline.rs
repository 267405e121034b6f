//! From what was typed to clouds, oriented clouds, balls and views. Calls the core in order; computes nothing itself.

pub(crate) mod balls;
pub(crate) mod scanner;

pub(crate) use balls::{BallParams, Carving, Made, shrink_side};

use crate::arguments::{
    Cleaning, CloudInput, MethodChoice, NeighborChoice, OrientChoice, Orienting, ProfileChoice, SceneInput, SizeChoice,
    UnprovenChoice, Usage, ViewChoice,
};
use crate::progress::Stages;
use crate::summary::{Summary, percent, rounded};
use anyhow::{Result, bail};
use belvedere::apps::tree_light::{vegetation_of_classes, vegetation_of_transmission};
use belvedere::clean::{CleanParams, CleanReport, Treatment, clean};
use belvedere::depth::Profile;
use belvedere::io::{
    ReadOptions, ReadReport, SavedBalls, SavedPulses, is_ball_file, read_balls, read_cloud, read_mesh, read_trajectory,
};
use belvedere::medial::{MedialBalls, PULSE_TOUCH, Side};
use belvedere::neighbors::NeighborIndex;
use belvedere::normals::estimate::{Neighborhood, estimate};
use belvedere::normals::{Normals, OrientReport, Orientation, OrientedCloud, orient};
use belvedere::pulses::NeedleColumns;
use belvedere::query::UnprovenAs;
use belvedere::view::{View, default_pixel_size, to_sun};
use belvedere::{Attributes, Error, PointCloud};
use belvedere::{Bounds, Frame};
use scanner::Located;
use std::borrow::Cow;
use std::path::Path;

/// Picture of a camera that nobody gave a size: what screens show.
const DEFAULT_CAMERA: [usize; 2] = [1280, 720];
/// Field of view of a camera that nobody gave one, degrees: a little wider than what people look at.
const DEFAULT_FOV_DEG: f64 = 60.0;
/// Width of a panorama in pixels: 0.18 degrees each.
const DEFAULT_PANORAMA: usize = 2048;

/// Makes a parameter out of range an error about the flag that gave it, which is wrong usage.
pub(crate) fn flagged<T>(flag: &str, result: belvedere::Result<T>) -> Result<T> {
    result.map_err(|error| match error {
        Error::InvalidParameter { .. } => Usage(format!("{flag}: {error}")).into(),
        other => other.into(),
    })
}

/// Reads the cloud and reports on it.
pub(crate) fn read(input: &CloudInput, stages: &mut Stages, summary: &mut Summary) -> Result<PointCloud> {
    Ok(read_counted(input, stages, summary)?.0)
}

/// Reads the cloud for results whose rows belong to the rows of the file, which a point left out would shift.
pub(crate) fn read_every_row(input: &CloudInput, stages: &mut Stages, summary: &mut Summary) -> Result<PointCloud> {
    let (cloud, report) = read_counted(input, stages, summary)?;
    check_every_row(&report)?;
    Ok(cloud)
}

/// Refuses a cloud of which points were left out.
pub(crate) fn check_every_row(report: &ReadReport) -> Result<()> {
    let Some((file, left_out)) = report.files.iter().find_map(|file| Some((file, file.left_out.first()?))) else {
        return Ok(());
    };
    bail!(
        "{}: {} rows cannot be used ({}), so that results would not match the rows of the file; repair or remove them",
        file.path.display(),
        report.left_out_count(),
        left_out.reason
    )
}

fn read_counted(input: &CloudInput, stages: &mut Stages, summary: &mut Summary) -> Result<(PointCloud, ReadReport)> {
    let options = ReadOptions { crs: input.crs.clone() };
    let (cloud, report) = stages.run("reading", 0, |_| read_cloud(&input.clouds, &options))?;
    summary.add("points", cloud.len());
    let section = reading_section(&report);
    summary.add("reading", section);
    Ok((cloud, report))
}

/// What reading found, without what goes without saying.
pub(crate) fn reading_section(report: &ReadReport) -> Summary {
    let mut section = Summary::default();
    let crs = if report.crs.is_empty() { "unknown" } else { &report.crs };
    section.add("reference_system", crs);
    let left_out: Vec<String> = report
        .files
        .iter()
        .flat_map(|file| &file.left_out)
        .map(|left_out| format!("{} {}", left_out.count, left_out.reason))
        .collect();
    section.add("left_out", left_out);
    section.add("attributes_not_in_every_file", report.dropped_attributes.clone());
    let notes = report.files.iter().flat_map(|file| {
        let name = file.path.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
        file.notes.iter().map(move |note| format!("{name}: {note}"))
    });
    section.add("notes", report.notes.iter().cloned().chain(notes).collect::<Vec<_>>());
    section
}

impl Cleaning {
    /// Parameters as typed.
    pub(crate) fn params(&self) -> CleanParams {
        let mut params = CleanParams::default();
        if self.keep_noise {
            params.dropped_classes = Vec::new();
            params.withheld = Treatment::Keep;
        }
        if self.keep_duplicates {
            params.exact_duplicates = Treatment::Keep;
            params.near_duplicate_distance = None;
        }
        if self.keep_isolated {
            params.isolated = None;
        }
        params
    }

    /// Parameters that clean nothing away.
    pub(crate) fn nothing() -> Self {
        Self { keep_noise: true, keep_duplicates: true, keep_isolated: true }
    }
}

fn cleaning_section(report: &CleanReport) -> Summary {
    let mut section = Summary::default();
    section
        .add("noise_classes", report.class_count)
        .add("withheld", report.withheld_count)
        .add("exact_duplicates", report.exact_duplicate_count)
        .add("near_duplicates", report.near_duplicate_count)
        .add("isolated", report.isolated_count)
        .add("kept", report.kept_count);
    section
}

/// A cloud whose normals point outward, and its index.
pub(crate) struct Prepared {
    pub(crate) oriented: OrientedCloud,
    pub(crate) index: NeighborIndex,
    /// Which points of the cloud as read these are.
    pub(crate) kept: Vec<u32>,
    /// Lowest and highest local corner of these points: a stray point that was cleaned away must not widen a view.
    pub(crate) bounds: Bounds,
    /// Where carving was asked for.
    pub(crate) carving: Option<scanner::CarvingInput>,
    /// Classes of these points, where they have any.
    classification: Option<Vec<u8>>,
}

impl Prepared {
    /// Normals for the `count` points of the cloud as read, zero for those that were cleaned away.
    fn normals_of_rows(&self, count: usize) -> Vec<[f32; 3]> {
        let mut normals = vec![[0.0; 3]; count];
        for (&row, &normal) in self.kept.iter().zip(self.oriented.normals()) {
            normals[row as usize] = normal;
        }
        normals
    }

    /// What pulses proved empty, as ball files keep it, where carving was asked for and pulses are known rather than assumed.
    pub(crate) fn pulses(&self) -> Option<NeedleColumns> {
        self.carving.as_ref().filter(|input| !input.is_assumed).map(|input| input.needles.to_columns())
    }
}

/// Cleans, estimates normals and orients them. A cloud that is given away is let go as soon as it has served.
pub(crate) fn prepare(
    cloud: Cow<'_, PointCloud>,
    cleaning: &Cleaning,
    orienting: &Orienting,
    carving: Carving,
    stages: &mut Stages,
    summary: &mut Summary,
) -> Result<Prepared> {
    let (kept, report) = stages.run("cleaning", 0, |_| clean(&cloud, &cleaning.params()))?;
    summary.add("removed_by_cleaning", cleaning_section(&report));
    if kept.is_empty() {
        let what = format!("{} were read and cleaning removed all; see --keep-noise, --keep-isolated", cloud.len());
        return Err(Error::NoPoints { what }.into());
    }
    let mut cloud = if kept.len() == cloud.len() { cloud } else { Cow::Owned(cloud.select(&kept)) };
    let wants_pulses = carving != Carving::Unwanted || matches!(orienting.orient, OrientChoice::Pulses);
    let Located { positions: scanner, trajectory, is_assumed } =
        if wants_pulses { scanner::of_each_point(&cloud, orienting, stages, summary)? } else { Located::default() };
    let carving = match carving {
        Carving::Unwanted => None,
        _ => scanner::carving_input(&cloud, (&scanner, is_assumed), carving, stages, summary)?,
    };
    let classification = cloud.attributes.classification.clone();
    if let Cow::Owned(owned) = &mut cloud {
        // nothing but orientation asks for attributes from here on, and they weigh more than the positions
        let attributes = std::mem::take(&mut owned.attributes);
        owned.attributes = Attributes {
            normals: attributes.normals,
            scanner_index: attributes.scanner_index,
            gps_time: attributes.gps_time.filter(|_| matches!(orienting.orient, OrientChoice::Trajectory(_))),
            gps_time_kind: attributes.gps_time_kind,
            ..Attributes::default()
        };
    }
    let index = stages.run("indexing", 0, |_| NeighborIndex::new(&cloud.positions))?;
    let choice = match &orienting.orient {
        OrientChoice::Auto if wants_pulses && !is_assumed => OrientChoice::Pulses,
        OrientChoice::Auto if cloud.attributes.normals.is_some() => OrientChoice::Given,
        OrientChoice::Auto if !cloud.scanner_positions.is_empty() => OrientChoice::Scanner,
        OrientChoice::Auto => OrientChoice::Up,
        other => other.clone(),
    };
    let normals = match choice {
        OrientChoice::Given => Normals::default(),
        _ => {
            let neighborhood = match orienting.neighbors {
                NeighborChoice::Fixed(k) => Neighborhood::Fixed { k },
                NeighborChoice::Adaptive => Neighborhood::adaptive(),
            };
            let normals = stages.run("estimating normals", 0, |_| estimate(&cloud.positions, &index, neighborhood));
            flagged("--neighbors", normals)?
        }
    };
    let (mesh, read);
    let by = match choice {
        OrientChoice::Auto | OrientChoice::Up => Orientation::Up,
        OrientChoice::Given => Orientation::Given,
        OrientChoice::Scanner => Orientation::Scanner,
        OrientChoice::ScannerAt(position) => {
            let scale = cloud.frame.crs.metres_per_unit_xyz();
            Orientation::ScannerAt(vec![std::array::from_fn(|i| position[i] * scale[i])])
        }
        OrientChoice::Trajectory(_) if carving.is_some() => Orientation::Pulses(&scanner),
        OrientChoice::Trajectory(path) => {
            read = match trajectory {
                Some(read) => read,
                None => stages.run("reading trajectory", 0, |_| read_trajectory(&path, &cloud.frame.crs))?.0,
            };
            Orientation::Trajectory(&read)
        }
        OrientChoice::Pulses => Orientation::Pulses(&scanner),
        OrientChoice::Mesh(path) => {
            let (model, _) = stages.run("reading mesh", 0, |_| read_mesh(&path))?;
            // like every position that is typed or read, in the unit of the cloud's file
            mesh = model.scaled_to_metres(&cloud.frame.crs);
            Orientation::Mesh(&mesh)
        }
    };
    let (oriented, report) = stages.run("orienting normals", 0, |_| orient(&cloud, normals, &by))?;
    summary.add("normals", orientation_section(&by, &report));
    let bounds = bounds_of(&cloud)?;
    Ok(Prepared { oriented, index, kept, bounds, carving, classification })
}

fn orientation_section(by: &Orientation<'_>, report: &OrientReport) -> Summary {
    let mut section = Summary::default();
    let way = match by {
        Orientation::Up => "up (facades are guesswork: give a trajectory, a scanner or a mesh if you can)",
        Orientation::Given => "as given",
        Orientation::Scanner | Orientation::ScannerAt(_) => "scanner position",
        Orientation::Trajectory(_) => "trajectory",
        Orientation::Pulses(_) => "pulses",
        Orientation::Mesh(_) => "mesh",
        _ => "other",
    };
    section.add("oriented_by", way);
    let shares = [
        ("as_given_percent", report.by_file_count),
        ("towards_scanner_percent", report.by_scanner_count),
        ("as_aligned_face_percent", report.by_face_count),
        ("by_parity_percent", report.by_parity_count),
        ("by_vote_of_roof_and_ground_percent", report.by_vote_count),
        ("upward_percent", report.by_up_count),
        ("without_normal_percent", report.without_normal_count),
        ("low_confidence_percent", report.low_confidence_count),
    ];
    for (name, count) in shares {
        if count > 0 {
            section.add(name, percent(count, report.point_count));
        }
    }
    if let Some(clock) = &report.clock {
        section.add("points_served_by_trajectory", clock.served_count);
    }
    section
}

/// Balls that block, where they lie, and the cloud they came from unless they were read from a file.
pub(crate) struct Scene {
    pub(crate) balls: MedialBalls,
    /// Local frame, unit and reference system: a cloud, without points where the balls came from a file.
    pub(crate) cloud: PointCloud,
    /// Lowest and highest local corner of the points that balls were made from.
    pub(crate) bounds: Bounds,
    /// Outward unit normals of the points that are kept, (N, 3): zero where a point has none.
    pub(crate) normals: Option<Vec<[f32; 3]>>,
    /// What pulses proved empty, where balls were carved and the file kept it.
    pub(crate) pulses: Option<NeedleColumns>,
    /// Share of the pulses that got through the piece of crown that a ball is part of, (B), NaN for one that is no vegetation; empty
    /// where that was not measured.
    pub(crate) transmission: Vec<f32>,
    /// Which balls are vegetation, (B), empty where that is not known.
    pub(crate) vegetation: Vec<bool>,
    /// Rows of the files that reading left out.
    pub(crate) left_out: ReadReport,
}

impl Scene {
    /// Local metres of a place in the coordinates and unit of the file.
    pub(crate) fn local_from_file(&self, place: [f64; 3]) -> [f64; 3] {
        let scale = self.cloud.frame.crs.metres_per_unit_xyz();
        std::array::from_fn(|i| place[i] * scale[i] - self.cloud.frame.origin[i])
    }

    /// Whether pulses cut the balls.
    pub(crate) fn is_carved(&self) -> bool {
        self.pulses.is_some() || self.balls.touch.contains(&PULSE_TOUCH)
    }
}

/// Whether a scene keeps the points that its balls were made from.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Points {
    Keep,
    LetGo,
}

/// Reads a ball file, or a cloud and makes its interior balls.
pub(crate) fn scene(
    arguments: &SceneInput,
    points: Points,
    stages: &mut Stages,
    summary: &mut Summary,
) -> Result<Scene> {
    if let [path] = &arguments.input.clouds[..]
        && path.is_file()
        && is_ball_file(path)?
    {
        refuse_flags_of_clouds(arguments, path)?;
        let saved = stages.run("reading balls", 0, |_| read_balls(path))?;
        summary.add("balls_read", saved.radii.len());
        return scene_of_saved(saved, path);
    }
    let params = arguments.shrinking.params(MethodChoice::Carved)?;
    let (mut cloud, left_out) = read_counted(&arguments.input, stages, summary)?;
    let given = match points {
        Points::Keep => Cow::Borrowed(&cloud),
        Points::LetGo => {
            let frame = PointCloud::in_frame(cloud.frame.clone());
            Cow::Owned(std::mem::replace(&mut cloud, frame))
        }
    };
    let prepared = prepare(given, &arguments.cleaning, &arguments.orienting, params.carving(), stages, summary)?;
    // as in a ball file, so that rows of balls mean the same
    let Made { balls, transmission } = shrink_side(&prepared, Side::Interior, params, stages, summary)?;
    let balls = balls.shrunk();
    let vegetation = match &prepared.classification {
        _ if !transmission.is_empty() => vegetation_of_transmission(&transmission),
        Some(classes) => vegetation_of_classes(&balls, classes),
        None => Vec::new(),
    };
    let pulses = prepared.pulses();
    let normals = (points == Points::Keep).then(|| prepared.normals_of_rows(cloud.len()));
    Ok(Scene { balls, cloud, bounds: prepared.bounds, normals, pulses, transmission, vegetation, left_out })
}

/// Flags that say how to make balls are of no use where they are made already.
fn refuse_flags_of_clouds(arguments: &SceneInput, path: &Path) -> Result<()> {
    let (cleaning, orienting, shrinking) = (&arguments.cleaning, &arguments.orienting, &arguments.shrinking);
    let given = [
        ("--crs", arguments.input.crs.is_some()),
        ("--keep-noise", cleaning.keep_noise),
        ("--keep-duplicates", cleaning.keep_duplicates),
        ("--keep-isolated", cleaning.keep_isolated),
        ("--orient", !matches!(orienting.orient, OrientChoice::Auto)),
        ("--method", shrinking.method.is_some()),
        ("--trees", shrinking.trees.is_some()),
        ("--without", !shrinking.without.is_empty()),
        ("--initial-radius", shrinking.initial_radius.is_some()),
        ("--max-radius", shrinking.max_radius.is_some()),
        ("--penetration", shrinking.penetration.is_some()),
        ("--first-angle", shrinking.first_angle.is_some()),
        ("--next-angle", shrinking.next_angle.is_some()),
    ];
    match given.into_iter().find(|(_, given)| *given) {
        Some((flag, _)) => {
            let path = path.display();
            Err(Usage(format!("{flag} says how to make balls from a cloud, but {path} holds balls already")).into())
        }
        None => Ok(()),
    }
}

fn scene_of_saved(saved: SavedBalls, path: &Path) -> Result<Scene> {
    if saved.provenance.get("side").is_some_and(|side| side == "exterior") {
        bail!(
            "{}: these balls lie in free space (--side exterior) and block nothing; give the interior ones",
            path.display()
        );
    }
    let bounds = saved.bounds;
    let cloud = PointCloud::in_frame(saved.frame);
    let balls = MedialBalls {
        centers: saved.centers,
        radii: saved.radii,
        source: saved.source,
        touch: saved.touch,
        separation_angles: saved.separation_angles,
    };
    let pulses =
        saved.pulses.map(|SavedPulses { starts, slopes, lengths, top }| NeedleColumns { starts, slopes, lengths, top });
    let transmission = saved.transmission.unwrap_or_default();
    let vegetation = vegetation_of_transmission(&transmission);
    let left_out = ReadReport::default();
    Ok(Scene { balls, cloud, bounds, normals: None, pulses, transmission, vegetation, left_out })
}

/// Lowest and highest corner of a cloud that has points.
pub(crate) fn bounds_of(cloud: &PointCloud) -> Result<Bounds> {
    Ok(cloud.bounds().ok_or_else(|| Error::NoPoints { what: "none was read".to_owned() })?)
}

impl From<UnprovenChoice> for UnprovenAs {
    fn from(choice: UnprovenChoice) -> Self {
        match choice {
            UnprovenChoice::Report => Self::Reported,
            UnprovenChoice::AsVisible => Self::Visible,
            UnprovenChoice::AsBlocked => Self::Blocked,
        }
    }
}

impl From<ProfileChoice> for Profile {
    fn from(choice: ProfileChoice) -> Self {
        match choice {
            ProfileChoice::Sphere => Self::Sphere,
            ProfileChoice::PaperCone => Self::PaperCone,
        }
    }
}

impl ViewChoice {
    /// The views on a scene, reported: one, or the two halves of a panorama.
    pub(crate) fn views(&self, scene: &Scene, summary: &mut Summary) -> Result<Vec<View>> {
        let views = match self.kind.panorama {
            Some(eye) => {
                let eye = scene.local_from_file(eye.0);
                flagged("--panorama, --size", View::panorama(eye, self.panorama_width()?))?.to_vec()
            }
            None => vec![self.view(scene, summary)?],
        };
        let mut section = Summary::default();
        if let [view] = &views[..] {
            section.add("width_px", view.size_px[0]).add("height_px", view.size_px[1]);
            if let Some(pixels_per_metre) = view.pixels_per_metre() {
                section.add("pixel_m", rounded(1.0 / pixels_per_metre, 4));
            } else {
                section.add("pixel_m_at_100_m", rounded(view.pixel_width(100.0), 4));
            }
            section.add("looks_along", view.frame.forward.map(|v| rounded(v, 4)).to_vec());
        } else {
            let width = self.panorama_width()?.next_multiple_of(2);
            section.add("width_px", width).add("height_px", width / 2).add("looks_along", "all around");
        }
        summary.add("view", section);
        Ok(views)
    }

    /// Width of a panorama in pixels.
    pub(crate) fn panorama_width(&self) -> Result<usize> {
        match self.size {
            None => Ok(DEFAULT_PANORAMA),
            Some(SizeChoice::Width(width)) => Ok(width),
            Some(SizeChoice::WidthAndHeight([width, height])) if height * 2 == width => Ok(width),
            Some(SizeChoice::WidthAndHeight(_)) => {
                Err(Usage("--size: a panorama is twice as wide as high; give its width alone".to_owned()).into())
            }
        }
    }

    fn camera(&self, eye: [f64; 3], scene: &Scene) -> Result<View> {
        let Some(look_at) = self.look_at else { return Err(Usage("--eye needs --look-at".to_owned()).into()) };
        let size = match self.size {
            None => DEFAULT_CAMERA,
            Some(SizeChoice::WidthAndHeight(size)) => size,
            Some(SizeChoice::Width(_)) => {
                return Err(Usage("--size: --eye needs width and height, such as 1280x720".to_owned()).into());
            }
        };
        let fov = self.fov.unwrap_or(DEFAULT_FOV_DEG).to_radians();
        let (near, far) = (self.near.map_or(0.0, f64::from), self.far.unwrap_or(f64::INFINITY));
        let [eye, look_at] = [eye, look_at.0].map(|place| scene.local_from_file(place));
        flagged("--eye, --look-at, --fov, --size, --near, --far", View::perspective(eye, look_at, fov, size, near, far))
    }

    fn view(&self, scene: &Scene, summary: &mut Summary) -> Result<View> {
        let (low, high) = scene.bounds.corners();
        let pixel = self.pixel.unwrap_or_else(|| default_pixel_size(low, high));
        let view = if let Some(sun) = &self.kind.sun {
            if !(0.0..=90.0).contains(&sun.0[1]) {
                let elevation = sun.0[1];
                return Err(Usage(format!("--sun: the elevation is {elevation}, but must be 0 to 90 degrees")).into());
            }
            let [azimuth, elevation] = sun.0.map(f64::to_radians);
            let north = self.north.of_scene(scene);
            north.report(summary);
            let sun = to_sun(azimuth - north.of_grid, elevation);
            flagged("--sun, --pixel", View::parallel(sun.map(|v| -v), low, high, pixel))?
        } else if let Some(direction) = &self.kind.direction {
            flagged("--direction, --pixel", View::parallel(direction.0, low, high, pixel))?
        } else if let Some(viewport) = &self.kind.viewport {
            let scale = scene.cloud.frame.crs.metres_per_unit_xyz();
            let metres = |v: [f64; 3]| std::array::from_fn(|i| v[i] * scale[i]);
            let view = View::from_viewport(
                scene.local_from_file(viewport.p0),
                metres(viewport.vx),
                metres(viewport.vy),
                viewport.pixels_per_unit / scale[0],
            );
            flagged("--viewport", view)?
        } else if let Some(eye) = &self.kind.eye {
            self.camera(eye.0, scene)?
        } else {
            return Err(
                Usage("say what to look at: --viewport, --sun, --direction, --eye or --panorama".to_owned()).into()
            );
        };
        Ok(view)
    }
}

/// What a ball file says of how it was made.
pub(crate) fn saved(
    Made { balls, transmission }: Made,
    frame: &Frame,
    bounds: Bounds,
    pulses: Option<NeedleColumns>,
    provenance: impl IntoIterator<Item = (&'static str, String)>,
) -> SavedBalls {
    SavedBalls {
        frame: frame.clone(),
        bounds,
        centers: balls.centers,
        radii: balls.radii,
        source: balls.source,
        touch: balls.touch,
        separation_angles: balls.separation_angles,
        transmission: (!transmission.is_empty()).then_some(transmission),
        pulses: pulses.map(|NeedleColumns { starts, slopes, lengths, top }| SavedPulses {
            starts,
            slopes,
            lengths,
            top,
        }),
        provenance: provenance.into_iter().map(|(name, value)| (name.to_owned(), value)).collect(),
    }
}

/// Local positions as f32 in file coordinates, which is what masbcpp's folders hold.
#[expect(clippy::cast_possible_truncation, reason = "the layout is f32")]
pub(crate) fn file_coordinates(cloud: &PointCloud, local: &[[f32; 3]]) -> Vec<[f32; 3]> {
    local.iter().map(|&p| cloud.frame.to_file_coordinates(p).map(|v| v as f32)).collect()
}
