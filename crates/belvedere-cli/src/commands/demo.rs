//! `belvedere demo`: a simulated town, all computations on it, and the accuracy of the answers.

use crate::arguments::{CloudInput, Demo, Global, UpChoice};
use crate::outputs::formats::check_folder;
use crate::outputs::text::write_text;
use crate::pipeline;
use crate::run::CommandContext;
use crate::simulated::cloud_of;
use crate::summary::{Summary, percent};
use anyhow::Result;
use belvedere::Frame;
use belvedere::apps::heat::{saturation_pressure, sky_longwave};
use belvedere::apps::irradiance::{ClearSky, extraterrestrial};
use belvedere::apps::sun::{Date, Site, sun_position};
use belvedere::cloud::{PointCloud, to_local};
use belvedere::depth::{DepthMap, ItemBuffer, Profile, depth_map};
use belvedere::figures::{Canvas, Colors, class_color, depth_picture, in_shadow, ramp_colors, side_by_side, write_png};
use belvedere::io::{
    ExtraColumn, ExtraValues, Georeference, atomic, read_trajectory, write_balls, write_cloud, write_tif_f32,
};
use belvedere::medial::{CarvedParams, MedialBalls};
use belvedere::model::{BallParams, ModelParams, OrientBy};
use belvedere::query::{Answer, MedialScene, UnprovenAs, Viewer, Visibility};
use belvedere::raster::Raster;
use belvedere::vector::{cross, length, sub, to_f32, unit};
use belvedere::view::{View, default_pixel_size, to_sun};
use belvedere_scenes::{
    AirborneParams, PlanPlacement, Scan, TownParams, TriangleScene, Truth, extruded, scan_airborne, town,
};
use serde_json::json;
use std::borrow::Cow;
use std::collections::BTreeSet;
use std::f64::consts::{FRAC_PI_2, TAU};
use std::io::Write;
use std::path::Path;

/// Azimuth and elevation of the sun in the pictures: a summer afternoon, degrees.
const SUN_DEG: [f64; 2] = [235.0, 30.0];
/// Length, width and height of the planned building.
const PLANNED_M: [f64; 3] = [14.0, 10.0, 25.0];
/// Number of windows around the planned building.
const WINDOWS: usize = 4;
/// Cells of the raster of the terrain around the town, metres, and their number a side.
const TERRAIN_CELL_M: f64 = 25.0;
const TERRAIN_CELLS: usize = 480;
/// Names of look-outs, metres east and north of the middle of the town, and heights above the ground.
const LOOKOUTS_M: [(&str, f64, f64, f64); 5] = [
    ("square", 0.0, -15.0, 1.7),
    ("corner", -20.0, -30.0, 1.7),
    ("mast", 20.0, 30.0, 12.0),
    ("crane", -40.0, 40.0, 30.0),
    ("street", 0.0, 50.0, 1.7),
];
/// Metres east and north of that middle of a place in a street.
const STREET_M: [f64; 2] = [-20.0, -30.0];
/// Distance of the hills, width up to their crests, and height, metres.
const HILLS_M: [f64; 3] = [900.0, 2500.0, 260.0];
/// Towers on the hills: azimuth in degrees and distance from the town in metres, and scheme.
const TOWERS: [(f64, f64, &str); 5] = [
    (20.0, 2600.0, "north"),
    (28.0, 2900.0, "north"),
    (36.0, 3300.0, "north"),
    (150.0, 1900.0, "south"),
    (163.0, 2300.0, "south"),
];
/// Heights of the hub and of the tip of a tower, metres.
const TOWER_M: [f64; 2] = [115.0, 180.0];
/// Day of the weather, its dew point, °C, and its wind, m/s.
const HOT_DAY: &str = "2026-07-21";
const DEW_POINT: f64 = 14.0;
const WIND: f64 = 1.5;
/// Height of a pedestrian's chest above the ground, metres.
const PEDESTRIAN: f64 = 1.5;

pub(crate) fn run(arguments: &Demo, global: &Global) -> Result<Summary> {
    let folder = &arguments.output;
    check_folder(folder)?;
    let mut run = CommandContext::new(global);
    atomic::make_folder(folder)?;

    let params = TownParams { extent: arguments.extent, seed: global.seed, ..TownParams::default() };
    let scene = run.compute("building town", || town(&params));
    let scan = run.compute("scanning town", || {
        scan_airborne(&scene, &AirborneParams { seed: global.seed, ..AirborneParams::default() })
    });
    run.summary.add("town", town_section(&scene, &scan));
    run.stage("writing town", 0, |_| write_town(folder, &scene, &scan))?;

    // from here on only what a survey would deliver: the LAZ file and the trajectory
    let clouds = vec![folder.join("town.laz")];
    let input = CloudInput {
        clouds,
        crs: None,
        crs_override: false,
        up: UpChoice::Z,
        skip_distant: false,
        bounds: None,
        flight_lines: Vec::new(),
        dates: None,
        flown: None,
        only_classes: Vec::new(),
    };
    let cloud = pipeline::read(&input, &mut run)?;
    let path = folder.join("trajectory.csv");
    let (trajectory, _) = run.stage("reading trajectory", 0, |_| read_trajectory(&path, &cloud.frame.crs))?;
    let params = ModelParams::default()
        .with_orient(OrientBy::Trajectory(trajectory))
        .with_balls(BallParams::Carved(CarvedParams::default()));
    let model = pipeline::model_of(Cow::Borrowed(&cloud), &params, &input, &mut run)?;
    let model = model.with_provenance("program", concat!("belvedere ", env!("CARGO_PKG_VERSION"), " demo"));
    let balls = model.balls();

    let [azimuth, elevation] = SUN_DEG.map(f64::to_radians);
    let sun = to_sun(azimuth, elevation);
    let bounds = pipeline::bounds_of(&cloud)?;
    let (site, _) = Site::of_scene(&cloud.frame, &bounds, None, None)?;
    write_text(&folder.join("weather.csv"), &hot_day(&site)?)?;
    let (low, high) = bounds.corners();
    let view = View::parallel(sun.map(|v| -v), low, high, default_pixel_size(low, high))?;
    let map = run.stage("drawing depth map", 0, |control| {
        model.depth_map(&view, Profile::Sphere, ItemBuffer::Without, control)
    })?;
    let blockers = model.scene(&model.rule(), UnprovenAs::Visible, &run.control())?;
    let answers = run.stage("querying", 0, |_| blockers.visible(Viewer::Direction(sun), &cloud.positions))?;
    let shadowed = answers.iter().filter(|&&a| a == Answer::Blocked).count();
    run.summary.add("points_in_shadow_percent", percent(shadowed, answers.len()));

    let agreement = run.stage("comparing with the mesh", 0, |_| agreement(&scene, &scan, &cloud, &blockers, sun))?;
    run.summary.add("sun_azimuth_elevation_deg", SUN_DEG.to_vec());
    run.summary.add("errors_by_ground_truth", agreement);

    run.stage("writing pictures", 0, |_| write_pictures(folder, &cloud, balls, &map, &answers, (low, high)))?;
    run.stage("writing results", 0, |_| -> Result<()> {
        write_lit(&folder.join("town_lit.laz"), &cloud, &answers)?;
        let description = Some("depth in metres from the sun");
        write_tif_f32(&folder.join("seen_from_the_sun.tif"), &map.depth, None, None, description)?;
        Ok(write_balls(&folder.join("balls.npz"), model.parts())?)
    })?;
    let mut summary = run.finish();
    write_summary(&folder.join("numbers.json"), &summary)?;
    summary
        .headline("A simulated town of <points> points from <town.pulses> pulses, with all results in its folder")
        .headline("in shadow, with the sun in the south-west at 30 degrees: <points_in_shadow_percent> % of the points")
        .headline("errors by the exact mesh, for pedestrians: <errors_by_ground_truth.pedestrians.false_blocked_percent> % falsely blocked, <errors_by_ground_truth.pedestrians.false_visible_percent> % falsely visible");
    summary.add("open", folder.join("shadows.png").display().to_string());
    Ok(summary)
}

fn write_summary(path: &Path, summary: &Summary) -> Result<()> {
    let report = serde_json::Value::from(summary.clone());
    atomic::write(path, |file| writeln!(file, "{report:#}").map_err(belvedere::Error::io(path)))?;
    Ok(())
}

/// The points with what the sun does to them.
fn write_lit(path: &Path, cloud: &PointCloud, answers: &[Answer]) -> Result<()> {
    let codes: Vec<u8> = answers.iter().map(|&answer| answer as u8).collect();
    let column =
        ExtraColumn { name: "answer", description: "0 blocked 1 visible 3 outside", values: ExtraValues::U8(&codes) };
    write_cloud(path, cloud, &[column])?;
    Ok(())
}

fn town_section(scene: &TriangleScene, scan: &Scan) -> Summary {
    let mut section = Summary::default();
    section
        .add("ground_truth_triangles", scene.triangles.len())
        .add("points", scan.len())
        .add("pulses", scan.report.pulses);
    section
}

fn write_town(folder: &Path, scene: &TriangleScene, scan: &Scan) -> Result<()> {
    let cloud = cloud_of(scan)?;
    write_cloud(&folder.join("town.laz"), &cloud, &[])?;
    write_terrain(&folder.join("terrain.tif"), scene, &cloud.frame)?;
    let planned = planned_building(scene).to_obj();
    let texts = [
        ("trajectory.csv", scan.sensor_path.to_csv()),
        ("town.obj", scene.to_obj()),
        ("planned.obj", planned),
        ("neighbours.csv", windows_that_face(scene)),
        ("towers.csv", towers_on_hills(scene)),
        ("glass.csv", glass_of_planned(scene)),
        ("lookouts.csv", lookouts(scene)),
        ("question.json", question_in_street(scene)),
    ];
    for (name, text) in texts {
        write_text(&folder.join(name), &text)?;
    }
    Ok(())
}

/// The weather of a hot day without clouds, as PVGIS writes it.
fn hot_day(site: &Site) -> Result<String> {
    let [latitude, longitude] = [site.latitude, site.longitude].map(f64::to_degrees);
    let midnight = Date::parse(HOT_DAY)?.noon_utc() - 12.0 * 3600.0;
    let mut text = format!("Latitude (decimal degrees): {latitude:.4}\nLongitude (decimal degrees): {longitude:.4}\n");
    text += "time(UTC),T2m,RH,G(h),Gb(n),Gd(h),IR(h),WS10m\n";
    for hour in 0..24_u32 {
        let instant = midnight + f64::from(hour) * 3600.0;
        let zenith = FRAC_PI_2 - sun_position(site, instant)?.elevation;
        let light = ClearSky::default().irradiance(zenith, site.height, extraterrestrial(instant));
        // the warmest hour is two hours and a half after noon, in the mean time of the place
        let after_warmest = f64::from(hour) + longitude / 15.0 - 14.5;
        let temperature = 25.0 + 7.0 * (after_warmest / 24.0 * TAU).cos();
        let vapour = saturation_pressure(DEW_POINT);
        let humidity = 100.0 * vapour / saturation_pressure(temperature);
        let infrared = sky_longwave(temperature, vapour, 0.0);
        let day = HOT_DAY.replace('-', "");
        text += &format!(
            "{day}:{hour:02}00,{temperature:.2},{humidity:.1},{:.1},{:.1},{:.1},{infrared:.1},{WIND}\n",
            light.ghi, light.dni, light.dhi
        );
    }
    Ok(text)
}

/// Hills around the plain in which the town lies, as an elevation raster.
fn write_terrain(path: &Path, town: &TriangleScene, frame: &Frame) -> Result<()> {
    let Some((low, high)) = town.bounds() else { return Ok(()) };
    let half = TERRAIN_CELL_M * TERRAIN_CELLS as f64 / 2.0;
    let place = Georeference {
        upper_left: [f64::midpoint(low[0], high[0]) - half, f64::midpoint(low[1], high[1]) + half],
        column_step: [TERRAIN_CELL_M, 0.0],
        row_step: [0.0, -TERRAIN_CELL_M],
        crs: frame.crs.clone(),
    };
    let plain = town.mean_ground_height();
    let height = |i: usize| {
        let [east, south] = [i % TERRAIN_CELLS, i / TERRAIN_CELLS].map(|at| (at as f64 + 0.5) * TERRAIN_CELL_M - half);
        let [begin, width, top] = HILLS_M;
        let outward = ((east.hypot(south) - begin) / width).clamp(0.0, 2.0);
        // valleys part the ring of hills, and smaller ones its slopes
        let ridge = 0.55 + 0.3 * (5.0 * south.atan2(east)).sin() + 0.15 * (east / 310.0).sin() * (south / 270.0).sin();
        to_f32(plain + top * ridge * (outward * FRAC_PI_2).sin().powi(2))
    };
    let heights = (0..TERRAIN_CELLS * TERRAIN_CELLS).map(height).collect();
    let raster = Raster::from_values(TERRAIN_CELLS, TERRAIN_CELLS, heights)?;
    Ok(write_tif_f32(path, &raster, Some(&place), None, Some("height in metres"))?)
}

/// A building that is not there, in the middle of the town.
fn planned_building(town: &TriangleScene) -> TriangleScene {
    let mut planned = TriangleScene::default();
    let Some((low, high)) = town.bounds() else { return planned };
    let middle = std::array::from_fn(|axis| f64::midpoint(low[axis], high[axis]));
    let footprint = PlanPlacement { origin: middle, angle: 0.0 }.rectangle(PLANNED_M[0], PLANNED_M[1]);
    let ground = town.mean_ground_height();
    planned.add_object("planned", &[extruded(&footprint, ground - 1.0, ground + PLANNED_M[2])]);
    planned
}

/// The hours of sun of a place in a street, as a question in JSON.
fn question_in_street(town: &TriangleScene) -> String {
    let Some((low, high)) = town.bounds() else { return String::new() };
    let [east, north] = [0, 1].map(|axis| f64::midpoint(low[axis], high[axis]).round() + STREET_M[axis]);
    let question = json!({ "sun-hours": { "days": { "dates": ["2026-06-21"] } } });
    format!("{}\n", json!({ "question": question, "places": { "at": [[east, north]] } }))
}

/// A table of places that may see each other: people in streets, a mast and a crane.
fn lookouts(town: &TriangleScene) -> String {
    let Some((low, high)) = town.bounds() else { return String::new() };
    let mut text = "name,x,y,height\n".to_owned();
    for (name, east, north, height) in LOOKOUTS_M {
        let [x, y] = [east + f64::midpoint(low[0], high[0]), north + f64::midpoint(low[1], high[1])];
        text += &format!("{name},{x:.2},{y:.2},{height}\n");
    }
    text
}

/// A table of the glass of the planned building: its south and its west facade.
fn glass_of_planned(town: &TriangleScene) -> String {
    let Some((low, high)) = town.bounds() else { return String::new() };
    let [x, y] = [0, 1].map(|axis| f64::midpoint(low[axis], high[axis]));
    let [length, width, height] = PLANNED_M;
    let z = town.mean_ground_height() + height / 2.0;
    let row = |name: &str, [x, y]: [f64; 2], azimuth: f64, side: f64| {
        format!("{name},{x:.2},{y:.2},{z:.2},{azimuth},{side:.1},{:.1}\n", height - 2.0)
    };
    let south = row("south", [x, y - width / 2.0], 180.0, length - 1.0);
    let west = row("west", [x - length / 2.0, y], 270.0, width - 1.0);
    format!("name,x,y,z,azimuth,width,height\n{south}{west}")
}

/// A table of towers on the hills around the town.
fn towers_on_hills(town: &TriangleScene) -> String {
    let Some((low, high)) = town.bounds() else { return String::new() };
    let [x, y] = [0, 1].map(|axis| f64::midpoint(low[axis], high[axis]));
    let [hub, tip] = TOWER_M;
    let row = |(number, (azimuth, distance, scheme)): (usize, (f64, f64, &str))| {
        let (sin, cos) = azimuth.to_radians().sin_cos();
        format!("T{},{:.0},{:.0},{hub},{tip},{scheme}\n", number + 1, x + distance * sin, y + distance * cos)
    };
    let rows = TOWERS.into_iter().enumerate().map(row);
    std::iter::once("name,x,y,hub,tip,scheme\n".to_owned()).chain(rows).collect()
}

/// A table of windows, one in each of the buildings nearest to the planned one, in a wall that faces it and gets sun.
fn windows_that_face(town: &TriangleScene) -> String {
    let mut found: Vec<(f64, u32, String)> = Vec::new();
    let Some((low, high)) = town.bounds() else { return String::new() };
    for (corners, &object) in town.triangles.iter().zip(&town.objects) {
        let [a, b, c] = corners.map(|corner| town.vertices[corner as usize]);
        let turned = cross(sub(b, a), sub(c, a));
        let (twice_area, Some(normal)) = (length(turned), unit(turned)) else { continue };
        let middle: [f64; 3] = std::array::from_fn(|axis| (a[axis] + b[axis] + c[axis]) / 3.0);
        let [east, north] = [0, 1].map(|axis| f64::midpoint(low[axis], high[axis]) - middle[axis]);
        let distance = east.hypot(north);
        let is_wall = twice_area > 16.0 && normal[2].abs() < 0.05 && normal[1] < 0.2;
        if is_wall && normal[0] * east + normal[1] * north > 0.3 * distance {
            let azimuth = normal[0].atan2(normal[1]).to_degrees().rem_euclid(360.0);
            let [x, y, z] = std::array::from_fn(|axis| middle[axis] + 0.05 * normal[axis]);
            let name = town.object_names.get(object as usize).map_or("", String::as_str);
            found.push((distance, object, format!("{x:.2},{y:.2},{z:.2},{azimuth:.1},{name}\n")));
        }
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut objects = BTreeSet::new();
    let rows = found.into_iter().filter(|(_, object, _)| objects.insert(*object)).take(WINDOWS).map(|(.., row)| row);
    std::iter::once("x,y,z,azimuth,name\n".to_owned()).chain(rows).collect()
}

/// Counts the answers that the exact mesh contradicts, for each kind of error.
fn agreement(
    scene: &TriangleScene,
    scan: &Scan,
    cloud: &PointCloud,
    blockers: &MedialScene,
    sun: [f64; 3],
) -> Result<Summary> {
    let truth = Truth::new(scene);
    let ground = scan.exact_positions.iter().zip(&scan.classification).filter(|(_, class)| **class == 2);
    let pedestrians: Vec<[f64; 3]> = ground.map(|(p, _)| [p[0], p[1], p[2] + PEDESTRIAN]).collect();
    let mut section = Summary::default();
    for (name, exact) in [("pedestrians", &pedestrians), ("cloud_points", &scan.exact_positions)] {
        let shadowed = truth.occluded_towards_each(exact, sun);
        let queried: Vec<[f32; 3]> = exact.iter().map(|&p| to_local(p, cloud.frame.origin)).collect();
        let answers = blockers.visible(Viewer::Direction(sun), &queried)?;
        let lit_count = shadowed.iter().filter(|s| !**s).count();
        let wrong = |answer: Answer, truly_shadowed: bool| {
            answers.iter().zip(&shadowed).filter(|&(a, s)| *a == answer && *s == truly_shadowed).count()
        };
        let mut scores = Summary::default();
        scores
            .add("targets", queried.len())
            .add("ground_truth_in_shadow_percent", percent(queried.len() - lit_count, queried.len()))
            .add("false_blocked_percent", percent(wrong(Answer::Blocked, false), lit_count))
            .add("false_visible_percent", percent(wrong(Answer::Visible, true), queried.len() - lit_count));
        section.add(name, scores);
    }
    Ok(section)
}

fn write_pictures(
    folder: &Path,
    cloud: &PointCloud,
    balls: &MedialBalls,
    map: &DepthMap,
    answers: &[Answer],
    (low, high): ([f64; 3], [f64; 3]),
) -> Result<()> {
    let classes = cloud.attributes.classification.as_deref().unwrap_or_default();
    let colors: Vec<[u8; 3]> = answers
        .iter()
        .enumerate()
        .map(|(i, answer)| {
            let color = class_color(classes.get(i).copied().unwrap_or(0));
            if *answer == Answer::Blocked { in_shadow(color) } else { color }
        })
        .collect();
    let from_above = View::parallel([0.0, 0.0, -1.0], low, high, 0.125)?;
    let mut shadows = Canvas::new(&from_above, [255; 3]);
    // half a metre wide, so that the ground closes between returns 0.3 m apart
    shadows.draw_points(&cloud.positions, Colors::Each(&colors), 4)?;
    let caption = "The town from above, with the shadows of a sun in the south-west at an elevation of 30 degrees";
    write_png(&folder.join("shadows.png"), &side_by_side(&[shadows.into_picture()], &[caption]))?;

    let depth = depth_picture(&map.depth, "Seen from the sun: depth in metres");
    write_png(&folder.join("seen_from_the_sun.png"), &depth)?;

    let oblique = View::parallel([0.5, 0.7, -0.6], low, high, 0.125)?;
    let heights: Vec<f32> = balls.centers.iter().map(|c| c[2]).collect();
    let mut union = Canvas::new(&oblique, [255; 3]);
    let seen = depth_map(balls, &oblique, Profile::Sphere, ItemBuffer::With, &belvedere::control::Control::none())?;
    if let Some(items) = &seen.balls {
        let colors = ramp_colors(&heights);
        union.draw_seen_balls((&seen.depth, items), (&balls.centers, &balls.radii), Colors::Each(&colors))?;
    }
    let caption = "The medial balls, coloured by height, seen from the south-west";
    write_png(&folder.join("balls.png"), &side_by_side(&[union.into_picture()], &[caption]))?;
    Ok(())
}
