//! `belvedere envelope`.

use super::check_output;
use super::heights::write_heights;
use super::mesh_targets::{is_mesh, mesh_of, start_of};
use super::shapes::{TypedAre, shapes, wrong_shape};
use super::sights::{Proving, blockers, ground, ground_cloud};
use crate::arguments::{Corners, Envelope, Global, Usage};
use crate::pipeline::{self, Points, Scene, is_file};
use crate::run::Run;
use crate::summary::{Summary, percent, rounded};
use anyhow::Result;
use belvedere::PointCloud;
use belvedere::apps::solar_envelope::{
    EnvelopeParams, Parcel, ProtectedPiece, SolarEnvelope, envelope_suns, existing_shade, protected_faces,
    protected_line, solar_envelope,
};
use belvedere::apps::sun::{Period, Zone};
use belvedere::apps::targets::Measure;
use belvedere::apps::viewshed::CELL;
use belvedere::figures::write_png;
use belvedere::ground::{Ground, MapGrid, highest_points};
use belvedere::io::{ReadReport, Shape, is_ball_file, write_mesh};
use belvedere::model::{ModelParts, SceneModel};
use belvedere::query::{MeshTargetParams, SurfacePieces};
use belvedere::results::georeference;
use belvedere::results::measure_map;
use belvedere::view::to_sun;
use std::path::Path;

/// Ground made around the parcel and what is protected, metres.
const MARGIN: f64 = 5.0;
/// Most lines of what binds.
const MOST_BINDING: usize = 3;

pub(crate) fn run(arguments: &Envelope, global: &Global) -> Result<Summary> {
    check_outputs(arguments)?;
    let mut run = Run::new(global);
    let mut scene = scene(arguments, &mut run)?;
    let suns = Suns::new(arguments, &scene, &mut run.summary)?;
    let parcel = parcel(arguments, &scene.cloud)?;
    let mut land = Land::read(arguments, &scene, &mut run)?;
    let (wide, narrow) = grids(&parcel, &land, arguments.cell.unwrap_or(CELL), &scene.cloud)?;
    let (cloud, points) = ground_cloud(&arguments.ground, &mut scene, &mut run)?;
    let around = run.aside(|run| ground(&cloud, points, wide, run)).0?;
    let below = ground(&cloud, points, narrow, &mut run)?;
    land.place(arguments, &around, &mut run.summary)?;
    let free = match arguments.credit_shade {
        false => None,
        true => {
            let mut section = Summary::default();
            let profile = arguments.scene.profile.into();
            let (blockers, _) =
                blockers(&scene, profile, &arguments.shell.giving_way(), Proving::Never, &mut run, &mut section)?;
            run.summary.add("lines_of_sight", section);
            let found = run.stage("testing existing shadow", land.pieces.len(), |control| {
                existing_shade(&blockers, &land.pieces, &suns.directions, control)
            });
            Some(found?)
        }
    };
    let params = EnvelopeParams::default().with_ceiling(arguments.ceiling);
    let found = run.stage("computing envelope", suns.directions.len(), |control| {
        solar_envelope(&parcel, &below, &land.pieces, &suns.directions, free.as_ref(), &params, control)
    });
    let found = found?;
    run.summary.add("envelope", told(&found, &land, &suns, arguments));
    for output in &arguments.output {
        run.stage("writing", 0, |_| write_one(output, &found, &below, &cloud))?;
    }
    if let Some(output) = &arguments.tops {
        let what = "height of the solar envelope";
        run.stage("writing", 0, |_| {
            let scale = cloud.frame.crs.metres_per_unit_xyz()[2];
            let mut tops = found.tops(cloud.frame.origin[2]);
            tops.values_mut().iter_mut().for_each(|top| *top = in_unit(*top, scale));
            write_heights(output, &tops, (&found.grid, &cloud.frame), what)
        })?;
    }
    let written = arguments.output.iter().chain(&arguments.tops).map(|path| path.display().to_string());
    run.summary.add("written", written.collect::<Vec<_>>());
    Ok(run.finish())
}

/// Heights of a cloud are in the unit of its file.
#[expect(clippy::cast_possible_truncation, reason = "a height")]
fn in_unit(height: f32, metres_per_unit: f64) -> f32 {
    (f64::from(height) / metres_per_unit) as f32
}

fn check_outputs(arguments: &Envelope) -> Result<()> {
    for output in &arguments.output {
        check_output("-o", output, &["tif", "tiff", "npy", "png", "ply", "obj"])?;
    }
    if let Some(output) = &arguments.tops {
        check_output("--tops", output, &["tif", "tiff", "npy"])?;
    }
    if arguments.sun.is_empty() && !arguments.when.is_given() {
        return Err(
            Usage("protected suns are missing: give --date DAY, --from and --to, or --sun AZ,EL".to_owned()).into()
        );
    }
    if !arguments.credit_shade && arguments.shell.shell.is_some() {
        return Err(Usage("--shell needs --credit-shade".to_owned()).into());
    }
    Ok(())
}

/// The scene, with balls only where these are asked.
fn scene(arguments: &Envelope, run: &mut Run) -> Result<Scene> {
    let is_balls = matches!(&arguments.scene.input.clouds[..], [path] if is_file(path) && is_ball_file(path)?);
    if arguments.credit_shade || is_balls {
        return pipeline::scene(&arguments.scene, Points::Keep, run);
    }
    let cloud = pipeline::read(&arguments.scene.input, run)?;
    let bounds = pipeline::bounds_of(&cloud)?;
    let parts = ModelParts { frame: cloud.frame.clone(), bounds, ..ModelParts::default() };
    let (model, profile) = (SceneModel::from_parts(parts)?, arguments.scene.profile.into());
    Ok(Scene { model, cloud, left_out: ReadReport::default(), profile })
}

/// Directions, and what to call each.
struct Suns {
    directions: Vec<[f64; 3]>,
    names: Vec<String>,
}

impl Suns {
    fn new(arguments: &Envelope, scene: &Scene, summary: &mut Summary) -> Result<Self> {
        if !arguments.sun.is_empty() {
            let mut suns = Self { directions: Vec::new(), names: Vec::new() };
            let north = arguments.north.of_scene(scene);
            north.report(summary);
            for [azimuth, elevation] in arguments.sun.iter().map(|sun| sun.0) {
                if !(elevation > 0.0 && elevation <= 90.0) {
                    let what =
                        format!("--sun {azimuth},{elevation}: the elevation must be above 0 and at most 90 degrees");
                    return Err(Usage(what).into());
                }
                suns.directions.push(to_sun(azimuth.to_radians() - north.of_grid, elevation.to_radians()));
                suns.names.push(format!("azimuth {azimuth}, elevation {elevation}"));
            }
            return Ok(suns);
        }
        let site = arguments.place.site(scene, summary)?;
        let zone: Zone = arguments.place.zone(&site, &arguments.when.times())?;
        let Some(Period::Days(dates)) = arguments.when.period(&arguments.place, &site, &zone)? else {
            let what = "--from and --to must be days; --between limits their hours";
            return Err(Usage(what.to_owned()).into());
        };
        let params = arguments.when.params(&arguments.place)?;
        let between = arguments.between.map_or([0.0, 24.0], |hours| hours.0);
        let (suns, low) = envelope_suns(&site, &zone, &dates, between, &params)?;
        let mut section = Summary::default();
        section
            .add("days", dates.len())
            .add("time_zone", zone.name())
            .add("suns", suns.len())
            .add("suns_below_horizon", low)
            .add("time_step_min", rounded(params.step / 60.0, 3));
        summary.add("period", section);
        Ok(Self {
            directions: suns.iter().map(|sun| sun.direction).collect(),
            names: suns.iter().map(|sun| zone.display(sun.unix_s)).collect(),
        })
    }
}

fn parcel(arguments: &Envelope, cloud: &PointCloud) -> Result<Parcel> {
    let mut rings: Vec<Vec<[f64; 2]>> = Vec::new();
    for named in shapes("--parcel", &arguments.parcel, TypedAre::Polygon, cloud)? {
        match named.shape {
            Shape::Polygon(polygon) => {
                rings.extend(polygon.iter().map(|ring| ring.iter().map(|&[x, y, _]| [x, y]).collect::<Vec<_>>()));
            }
            _ => {
                return wrong_shape(
                    "--parcel",
                    &arguments.parcel,
                    "a parcel is a polygon, but this file has a line or a point",
                );
            }
        }
    }
    Ok(Parcel::new(&rings)?)
}

/// What is protected: pieces that are there already, and shapes that wait for the ground.
struct Land {
    shapes: Vec<(Shape, u32)>,
    pieces: Vec<ProtectedPiece>,
    /// What each source is called.
    names: Vec<String>,
}

impl Land {
    fn read(arguments: &Envelope, scene: &Scene, run: &mut Run) -> Result<Self> {
        let mut land = Self { shapes: Vec::new(), pieces: Vec::new(), names: Vec::new() };
        for protect in &arguments.protect {
            if let Corners::File(path) = protect
                && super::extension(path) != "geojson"
                && is_mesh(path)
                && !is_geojson(path)
            {
                land.add_mesh(path, arguments, scene, run)?;
                continue;
            }
            for named in shapes("--protect", protect, TypedAre::Line, &scene.cloud)? {
                let source = land.source(named.name);
                land.shapes.push((named.shape, source));
            }
        }
        Ok(land)
    }

    fn source(&mut self, name: String) -> u32 {
        self.names.push(name);
        u32::try_from(self.names.len() - 1).unwrap_or(u32::MAX)
    }

    fn add_mesh(&mut self, path: &Path, arguments: &Envelope, scene: &Scene, run: &mut Run) -> Result<()> {
        let mesh = mesh_of(path, scene, run)?;
        let spacing = arguments.spacing.unwrap_or(CELL);
        let surface = SurfacePieces::of_mesh(&mesh, scene.cloud.frame.origin, spacing, run.seed)?;
        let first = self.source(path.display().to_string());
        let objects = u32::try_from(mesh.object_names.len()).unwrap_or(0);
        mesh.object_names.iter().for_each(|name| {
            self.source(name.clone());
        });
        let lift = MeshTargetParams::default().lift;
        for mut piece in protected_faces(&surface, lift) {
            let object = mesh.objects.get(piece.source as usize).filter(|object| **object < objects);
            piece.source = object.map_or(first, |object| first + 1 + object);
            self.pieces.push(piece);
        }
        Ok(())
    }

    /// Sets lines and points on the ground.
    fn place(&mut self, arguments: &Envelope, ground: &Ground, summary: &mut Summary) -> Result<()> {
        let fence = arguments.fence.map_or(0.0, f64::from);
        let spacing = arguments.spacing.unwrap_or(CELL);
        let mut unknown = 0;
        for (shape, source) in std::mem::take(&mut self.shapes) {
            let lines: Vec<Vec<[f64; 3]>> = match shape {
                Shape::Line(corners) => vec![corners],
                Shape::Polygon(rings) => rings,
                Shape::Point([x, y, z]) => {
                    let height = if z.is_nan() { ground.height_at([x, y]) } else { Some(z) };
                    match height {
                        Some(z) => self.pieces.push(ProtectedPiece::point([x, y, z + fence], source)),
                        None => unknown += 1,
                    }
                    continue;
                }
            };
            for line in lines {
                let (pieces, without) = protected_line(&line, fence, spacing, ground, source)?;
                self.pieces.extend(pieces);
                unknown += without;
            }
        }
        if unknown > 0 {
            let note = format!("{unknown} protected parts have no known ground, and were ignored");
            summary.add("notes", vec![note]);
        }
        if self.pieces.is_empty() {
            let what = "nothing is protected, because the ground is unknown there; is the protected geometry in the coordinates of the cloud?";
            return Err(Usage(format!("--protect: {what}")).into());
        }
        Ok(())
    }

    /// Low and high corner on the map of all that is protected.
    fn bounds(&self) -> [[f64; 2]; 2] {
        let mut bounds = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
        let mut add = |place: &[f64; 3]| {
            for axis in 0..2 {
                bounds[0][axis] = bounds[0][axis].min(place[axis]);
                bounds[1][axis] = bounds[1][axis].max(place[axis]);
            }
        };
        for (shape, _) in &self.shapes {
            match shape {
                Shape::Point(place) => add(place),
                Shape::Line(corners) => corners.iter().for_each(&mut add),
                Shape::Polygon(rings) => rings.iter().flatten().for_each(&mut add),
            }
        }
        bounds
    }
}

/// Whether a .json is GeoJSON rather than CityJSON.
fn is_geojson(path: &Path) -> bool {
    super::extension(path) == "json" && start_of(path).is_some_and(|start| !start.contains("CityJSON"))
}

/// A grid around everything that needs the ground, and one over the parcel.
fn grids(parcel: &Parcel, land: &Land, cell: f64, cloud: &PointCloud) -> Result<(MapGrid, MapGrid)> {
    let origin = [cloud.frame.origin[0], cloud.frame.origin[1]];
    let [low, high] = parcel.bounds();
    let narrow = MapGrid::covering(low, high, cell, origin)?;
    let protected = land.bounds();
    let wide = [0, 1].map(|axis| {
        let (low, high) = (low[axis].min(protected[0][axis]), high[axis].max(protected[1][axis]));
        [low - MARGIN, high + MARGIN]
    });
    let (low, high) = (wide.map(|span| span[0]), wide.map(|span| span[1]));
    let coarse = belvedere::apps::viewshed::cell_for(low, high).max(cell);
    let wide = MapGrid::covering(low, high, coarse, origin)?;
    Ok((wide, narrow))
}

fn told(found: &SolarEnvelope, land: &Land, suns: &Suns, arguments: &Envelope) -> Summary {
    let mut section = Summary::default();
    let report = found.report;
    let unbounded = found.unbounded_count();
    section
        .add("columns", found.columns.len())
        .add("cell_m", rounded(found.grid.cell, 4))
        .add("area_m2", rounded(found.area(), 2));
    if unbounded == 0 {
        section
            .add("volume_m3", rounded(found.volume(), 1))
            .add("mean_height_m", rounded(found.volume() / found.area(), 2))
            .add("max_height_m", rounded(found.greatest_height(), 2));
    } else {
        section.add("columns_unlimited", unbounded);
        section.add("notes", vec!["volume and solids need --max-height: some columns have no limit".to_owned()]);
    }
    let no_room = found.columns.iter().filter(|column| column.height() <= 0.0).count();
    let at_ceiling = found.columns.iter().filter(|column| column.binding.is_none()).count();
    section.add("columns_of_zero_height", no_room);
    if arguments.ceiling.is_some() {
        section.add("columns_at_max_height", at_ceiling);
    }
    section.add("cells_without_ground", report.without_ground_count).add("protected_pieces", land.pieces.len());
    if report.turned_away_count > 0 {
        section.add("facing_away_percent", percent(report.turned_away_count, report.pair_count));
    }
    if arguments.credit_shade {
        section.add("existing_shadow_percent", percent(report.shaded_already_count, report.pair_count));
    }
    let by_sun = found.bound_areas(suns.names.len(), |binding| binding.sun);
    section.add("limiting_suns", ranked(&by_sun, &suns.names));
    let source = |piece: usize| land.pieces.get(piece).map_or(usize::MAX, |piece| piece.source as usize);
    let by_source = found.bound_areas(land.names.len(), |binding| source(binding.piece));
    section.add("limiting_places", ranked(&by_source, &land.names));
    section
}

/// What binds the largest areas.
fn ranked(areas: &[f64], names: &[String]) -> Vec<String> {
    let mut order: Vec<usize> = (0..areas.len()).filter(|&i| areas[i] > 0.0).collect();
    order.sort_by(|&a, &b| areas[b].total_cmp(&areas[a]).then(a.cmp(&b)));
    order.truncate(MOST_BINDING);
    order.iter().map(|&i| format!("{}: {:.1} m2", names.get(i).map_or("", String::as_str), areas[i])).collect()
}

fn write_one(output: &Path, found: &SolarEnvelope, ground: &Ground, cloud: &PointCloud) -> Result<()> {
    match super::extension(output).as_str() {
        "ply" | "obj" => {
            let mut mesh = found.to_mesh(cloud.frame.origin)?;
            mesh.crs = cloud.frame.crs.clone();
            Ok(write_mesh(output, &mesh, cloud.frame.crs.metres_per_unit_xyz())?)
        }
        "png" => {
            let mut heights = found.heights();
            heights.values_mut().iter_mut().filter(|h| h.is_infinite()).for_each(|h| *h = f32::NAN);
            let relief = highest_points(&cloud.positions, ground);
            let measure = Measure::new("height", heights.values().to_vec()).with_description("metres above the ground");
            let place = georeference(&ground.grid, &cloud.frame);
            Ok(write_png(output, &measure_map(&measure, &relief, ground.grid.cell, &place, "Solar envelope")?)?)
        }
        _ => write_heights(
            output,
            &found.heights(),
            (&found.grid, &cloud.frame),
            "height of the solar envelope above the ground, metres",
        ),
    }
}
