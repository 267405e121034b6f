//! `belvedere surfaces`.

use crate::arguments::{Global, SurfacesArguments};
use crate::outputs::formats::{check_outputs, extension, warn_of_geojson};
use crate::pipeline::{self, params};
use crate::run::CommandContext;
use crate::summary::Summary;
use anyhow::{Result, bail};
use belvedere::apps::ask::{remark_on_axis, remark_on_roofs};
use belvedere::apps::roof_planes::MAX_LEVEL;
use belvedere::io::{ExtraColumn, ExtraValues, PathLine, Spot, WriteReport, write_cloud, write_places};
use belvedere::medial::CarvedParams;
use belvedere::model::{BallParams, OrientedSurvey};
use belvedere::planes::{BuildingSurfaces, PlaneParams, PointOnSurface, Surface, median_sd};
use belvedere::report::rounded;
use belvedere::vector::to_f32;
use belvedere::{Frame, PointCloud};
use serde_json::{Map, Value};
use std::path::Path;

pub(crate) fn run(arguments: &SurfacesArguments, global: &Global) -> Result<Summary> {
    check_outputs("-o", &arguments.output, &["geojson", "gpkg", "json", "laz", "las", "ply", "csv"])?;
    let parameters = arguments.points.parameters()?;
    let mut run = CommandContext::new(global);
    let cloud = pipeline::read(&arguments.points.input, &mut run)?;
    let balls = BallParams::Carved(CarvedParams::default());
    let params = params::model(&parameters, balls, &cloud.frame.crs, &mut run)?;
    let prepared = OrientedSurvey::prepare(&cloud, &params, &run.control());
    let (survey, report) = prepared.map_err(|error| pipeline::advised(&arguments.points.input, error))?;
    run.summary.add_report(&report);
    run.summary.remarks(remark_on_axis(survey.looks_y_up(&cloud.frame)));
    let found = survey.building_surfaces(&cloud.frame, &PlaneParams::default(), &run.control())?;
    let Some(found) = found else {
        bail!(
            "{}: surfaces are found from pulses that come from the air; give where the scanner was with --orient \
             trajectory=FILE if this is such a survey",
            arguments.points.input.clouds[0].display()
        )
    };
    run.summary.remarks(remark_on_roofs(found.outlines.planes.len()));
    for output in &arguments.output {
        let report = run.stage("writing", 0, |_| write(output, &found, &cloud))?;
        run.summary.add_writing(output, &report);
    }
    warn_of_geojson(&arguments.output, &cloud.frame.crs, &mut run.summary);
    let counts = [
        ("roofs", found.outlines.planes.len()),
        ("edges", found.outlines.edges.len()),
        ("ridges_and_valleys", found.outlines.ridges.len()),
        ("walls", found.outlines.walls.len()),
    ];
    for (name, count) in counts {
        run.summary.add(name, count);
    }
    run.summary.add("edge_deviation_m", median_sd(&found.outlines.edges).map(|v| rounded(v, 3)));
    run.summary
        .headline("<roofs> roofs, <edges> edges, <ridges_and_valleys> ridges and valleys, <walls> walls, cut to blocks of 64 m")
        .headline("an edge is known to <edge_deviation_m> m (standard deviation, median)");
    run.summary.add_paths("written", &arguments.output);
    Ok(run.finish())
}

fn write(output: &Path, found: &BuildingSurfaces, cloud: &PointCloud) -> Result<WriteReport> {
    if matches!(extension(output).as_str(), "geojson" | "json" | "gpkg") {
        let (roofs, lines) = features(found, &cloud.frame);
        write_places(output, &roofs, &lines, &cloud.frame.crs)?;
        return Ok(WriteReport::default());
    }
    write_points(output, found, cloud)
}

/// The points that lie on roofs and walls, in the order of the cloud, with the numbers of these and how far outside
/// they lie. One on two walls is of the nearer.
fn write_points(output: &Path, found: &BuildingSurfaces, cloud: &PointCloud) -> Result<WriteReport> {
    let distance = |point: &PointOnSurface| {
        let place = cloud.positions.get(point.row as usize).map_or([f64::NAN; 3], |p| p.map(f64::from));
        found.distance(point.surface, place)
    };
    let mut points: Vec<(PointOnSurface, f64)> = found.points.iter().map(|point| (*point, distance(point))).collect();
    points.sort_by(|(a, far), (b, off)| a.row.cmp(&b.row).then(far.abs().total_cmp(&off.abs())));
    points.dedup_by_key(|(point, _)| point.row);
    let kinds: Vec<u8> =
        points.iter().map(|(on, _)| if matches!(on.surface, Surface::Roof(_)) { 1 } else { 2 }).collect();
    let number = |(on, _): &(PointOnSurface, f64)| match on.surface {
        Surface::Roof(number) | Surface::Wall(number) => u32::try_from(number).unwrap_or(u32::MAX),
    };
    let numbers: Vec<u32> = points.iter().map(number).collect();
    let distances: Vec<f32> = points.iter().map(|(_, distance)| to_f32(*distance)).collect();
    let column = |name, description, values| ExtraColumn { name, description, values };
    let columns = [
        column("kind", "1 roof 2 wall", ExtraValues::U8(&kinds)),
        column("number", "of the roof or wall", ExtraValues::U32(&numbers)),
        column("distance", "outside of its plane, metres", ExtraValues::F32(&distances)),
    ];
    let rows: Vec<u32> = points.iter().map(|(point, _)| point.row).collect();
    Ok(write_cloud(output, &cloud.select(&rows), &columns)?)
}

/// Roofs as points, everything else as lines.
fn features(found: &BuildingSurfaces, frame: &Frame) -> (Vec<Spot>, Vec<PathLine>) {
    let placed = |p: [f64; 3]| std::array::from_fn(|axis| p[axis] + frame.origin[axis]);
    let roofs = found.outlines.planes.iter().zip(0_u64..).map(|(plane, number)| {
        let [east, north, up] = plane.normal;
        let slope = east.hypot(north).atan2(up);
        let azimuth = (slope > MAX_LEVEL).then(|| east.atan2(north).to_degrees().rem_euclid(360.0));
        let properties = properties([
            ("kind", "roof".into()),
            ("roof", number.into()),
            ("slope_deg", rounded(slope.to_degrees(), 2).into()),
            ("azimuth_deg", azimuth.map(|v| rounded(v, 2)).into()),
            ("points", plane.count.into()),
            ("noise_m", rounded(plane.noise, 4).into()),
            ("sd_m", rounded(plane.sd, 4).into()),
        ]);
        Spot { place: placed(plane.center), properties }
    });
    let edges = found.outlines.edges.iter().map(|edge| PathLine {
        places: edge.ends.map(placed).to_vec(),
        properties: properties([
            ("kind", "edge".into()),
            ("roof", edge.plane.into()),
            ("sd_m", rounded(edge.sd, 4).into()),
            ("drop_m", rounded(edge.drop, 2).into()),
        ]),
    });
    let ridges = found.outlines.ridges.iter().map(|ridge| PathLine {
        places: ridge.ends.map(placed).to_vec(),
        properties: properties([
            ("kind", if ridge.is_convex { "ridge" } else { "valley" }.into()),
            ("roofs", ridge.planes.to_vec().into()),
        ]),
    });
    let walls = found.outlines.walls.iter().zip(0_u64..).map(|(wall, number)| {
        let [bottom, top] = wall.heights.map(|z| z + frame.origin[2]);
        PathLine {
            places: wall.ends.map(|[x, y]| placed([x, y, wall.heights[1]])).to_vec(),
            properties: properties([
                ("kind", "wall".into()),
                ("wall", number.into()),
                ("sd_m", rounded(wall.sd, 4).into()),
                ("bottom_m", rounded(bottom, 2).into()),
                ("top_m", rounded(top, 2).into()),
                ("eaves_m", rounded(wall.eaves, 2).into()),
                ("points", wall.count.into()),
                ("noise_m", rounded(wall.noise, 4).into()),
            ]),
        }
    });
    (roofs.collect(), edges.chain(ridges).chain(walls).collect())
}

fn properties<const N: usize>(entries: [(&str, Value); N]) -> Map<String, Value> {
    entries.into_iter().map(|(name, value)| (name.to_owned(), value)).collect()
}
