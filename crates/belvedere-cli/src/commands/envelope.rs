//! `belvedere envelope`.

use crate::arguments::{CornersArgument, EnvelopeArguments, Global, refuse};
use crate::inputs::map_shapes::{NamedShape, TypedAre, shapes, wrong_shape};
use crate::outputs::formats::{check_outputs, extension};
use crate::outputs::heights::write_heights;
use crate::pipeline::{self, KeepPoints, LoadedScene, is_file, mesh_in};
use crate::run::CommandContext;
use crate::summary::Summary;
use anyhow::Result;
use belvedere::Frame;
use belvedere::apps::ask::{
    self, Answers, Ask, EnvelopeResults, Places, Protected, ProtectedShape, ProtectedSuns, SharedObject,
};
use belvedere::apps::solar_envelope::EnvelopeParams;
use belvedere::apps::targets::Measure;
use belvedere::figures::write_png;
use belvedere::ground::highest_points;
use belvedere::io::{FeatureShape, MetadataTag, Source, is_ball_file, is_mesh, write_mesh};
use belvedere::model::{ModelParts, SceneModel};
use belvedere::results::{georeference, measure_map};
use belvedere::vector::to_f32;
use std::io::Read;
use std::path::Path;
use std::sync::Arc;

pub(crate) fn run(arguments: &EnvelopeArguments, global: &Global) -> Result<Summary> {
    check_formats(arguments)?;
    let mut question = question(arguments, global)?;
    question.check()?;
    let mut run = CommandContext::new(global);
    let scene = scene(arguments, &mut run)?;
    let scene = scene.into_question_scene(Some(&arguments.ground), arguments.shell.shell, &run)?;
    question.parcel = parcel(arguments, scene.frame())?;
    question.protect = protect(arguments, scene.frame(), &mut run)?;
    let answers = run.ask(&scene, &question, &Places::Scene)?;
    for output in &arguments.output {
        run.stage("writing", 0, |_| write_one(output, &answers, &scene, &run.tags))?;
    }
    if let Some(output) = &arguments.tops {
        let what = "height of the solar envelope";
        run.stage("writing", 0, |_| {
            let frame = scene.frame();
            let scale = frame.crs.metres_per_unit_xyz()[2];
            let envelope = &answers.found.envelope;
            let mut tops = envelope.tops(frame.origin[2]);
            tops.values_mut().iter_mut().for_each(|top| *top = in_unit(*top, scale));
            write_heights(output, &tops, (&envelope.grid, frame), what, &run.tags)
        })?;
    }
    run.summary.add_paths("written", arguments.output.iter().chain(&arguments.tops));
    Ok(run.finish())
}

/// Heights of a cloud are in the unit of its file.
fn in_unit(height: f32, metres_per_unit: f64) -> f32 {
    to_f32(f64::from(height) / metres_per_unit)
}

fn check_formats(arguments: &EnvelopeArguments) -> Result<()> {
    check_outputs("-o", &arguments.output, &["tif", "tiff", "npy", "png", "ply", "obj"])?;
    check_outputs("--tops", &arguments.tops, &["tif", "tiff", "npy"])?;
    if arguments.sun.is_empty() && !arguments.when.is_given() {
        return refuse("protected suns are missing: give --date DAY, --from and --to, or --sun AZ,EL");
    }
    if !arguments.credit_shade && arguments.shell.shell.is_some() {
        return refuse("--shell needs --credit-shade");
    }
    Ok(())
}

fn question(arguments: &EnvelopeArguments, global: &Global) -> Result<ask::EnvelopeQuestion> {
    let suns = match &arguments.sun[..] {
        [] => ProtectedSuns::Days { days: arguments.when.days(), hours: arguments.between.map(|hours| hours.0) },
        suns => ProtectedSuns::Directions(suns.iter().map(|sun| sun.0).collect()),
    };
    Ok(ask::EnvelopeQuestion {
        suns,
        place: arguments.place.place(&arguments.north)?,
        fence_height: arguments.fence.map_or(0.0, f64::from),
        spacing: arguments.spacing,
        cell: arguments.cell,
        params: EnvelopeParams::default().with_ceiling(arguments.ceiling),
        credit_shade: arguments.credit_shade,
        ground: arguments.ground.points(),
        seed: global.seed,
        ..ask::EnvelopeQuestion::default()
    })
}

/// The scene, with balls only where these are needed.
fn scene(arguments: &EnvelopeArguments, run: &mut CommandContext) -> Result<LoadedScene> {
    let is_balls = matches!(&arguments.scene.input.clouds[..], [path] if is_file(path) && is_ball_file(path)?);
    if arguments.credit_shade || is_balls {
        return pipeline::scene(&arguments.scene, KeepPoints::Keep, run);
    }
    let cloud = pipeline::read(&arguments.scene.input, run)?;
    let bounds = pipeline::bounds_of(&cloud)?;
    let parts = ModelParts { frame: cloud.frame.clone(), bounds, ..ModelParts::default() };
    let profile = arguments.scene.balls.parameters()?.profile();
    let bare = LoadedScene::without_points(SceneModel::from_parts(parts)?, profile);
    Ok(LoadedScene { cloud: Arc::new(cloud), ..bare })
}

/// Rings of the parcel, local metres.
fn parcel(arguments: &EnvelopeArguments, frame: &Frame) -> Result<Vec<Vec<[f64; 2]>>> {
    let mut rings: Vec<Vec<[f64; 2]>> = Vec::new();
    for named in shapes("--parcel", &arguments.parcel, TypedAre::Polygon, frame)? {
        let FeatureShape::Polygon(polygon) = named.shape else {
            let what = "a parcel is a polygon, but this file has a line or a point";
            return wrong_shape("--parcel", &arguments.parcel, what);
        };
        rings.extend(polygon.iter().map(|ring| ring.iter().map(|&[x, y, _]| [x, y]).collect::<Vec<_>>()));
    }
    Ok(rings)
}

/// Returns the objects that keep their sun.
fn protect(arguments: &EnvelopeArguments, frame: &Frame, run: &mut CommandContext) -> Result<Vec<Protected>> {
    let mut all = Vec::new();
    for protect in &arguments.protect {
        if let CornersArgument::File(path) = protect
            && extension(path) != "geojson"
            && is_mesh(path)
            && !is_geojson(path)
        {
            let shape = ProtectedShape::Faces(SharedObject::new(mesh_in(path, &frame.crs, run)?));
            all.push(Protected { name: path.display().to_string(), shape });
            continue;
        }
        let on_map = |NamedShape { shape, name }: NamedShape| {
            let shape = match shape {
                FeatureShape::Point(place) => ProtectedShape::Point(place),
                FeatureShape::Line(corners) => ProtectedShape::Lines(vec![corners]),
                FeatureShape::Polygon(rings) => ProtectedShape::Lines(rings),
            };
            Protected { name, shape }
        };
        all.extend(shapes("--protect", protect, TypedAre::Line, frame)?.into_iter().map(on_map));
    }
    Ok(all)
}

/// Returns true if a .json is GeoJSON and not CityJSON, by its first bytes.
fn is_geojson(path: &Path) -> bool {
    let mut start = Vec::new();
    let read = Source::path(path).into_reader().map(|(file, _)| file.take(1 << 16).read_to_end(&mut start));
    let is_read = matches!(read, Ok(Ok(_)));
    extension(path) == "json" && is_read && !String::from_utf8_lossy(&start).contains("CityJSON")
}

fn write_one(
    output: &Path,
    answers: &Answers<EnvelopeResults>,
    scene: &ask::Scene,
    tags: &[MetadataTag],
) -> Result<()> {
    let (frame, EnvelopeResults { envelope, ground }) = (scene.frame(), &answers.found);
    match extension(output).as_str() {
        "ply" | "obj" => {
            let mut mesh = envelope.to_mesh(frame.origin)?;
            mesh.crs = frame.crs.clone();
            Ok(write_mesh(output, &mesh, frame.crs.metres_per_unit_xyz())?)
        }
        "png" => {
            let ground = &ground.ground;
            let mut heights = envelope.heights();
            heights.values_mut().iter_mut().filter(|h| h.is_infinite()).for_each(|h| *h = f32::NAN);
            let relief = highest_points(&scene.ground_cloud()?.positions, ground);
            let measure = Measure::new("height", heights.values().to_vec()).with_description("metres above the ground");
            let place = georeference(&ground.grid, frame);
            Ok(write_png(output, &measure_map(&measure, &relief, ground.grid.cell, &place, "Solar envelope")?)?)
        }
        _ => {
            let what = answers.measures.first().map_or("", |height| height.description);
            write_heights(output, &envelope.heights(), (&envelope.grid, frame), what, tags)
        }
    }
}
