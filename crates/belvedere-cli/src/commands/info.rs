//! `belvedere info`.

use crate::arguments::{Global, Info, refuse};
use crate::pipeline::{self, is_file};
use crate::run::CommandContext;
use crate::summary::{Summary, rounded, sections, whole};
use anyhow::Result;
use belvedere::apps::ask;
use belvedere::crs::CrsKind;
use belvedere::io::{FileReport, is_ball_file, read_balls, read_cloud};
use belvedere::model::{ModelParts, SurveyFindings};
use belvedere::planes::{BuildingOutlines, median_sd};
use belvedere::pulses::{FoundBy, LocateParams, Means, ScannerReport, locate};
use belvedere::summary::{CloudSummary, FacadeSummary, SurveyKind, cloud_looks_y_up, unit_contradiction_of};
use belvedere::{Error, PatchKind, PointCloud, SurfacePatches};

pub(crate) fn run(arguments: &Info, global: &Global) -> Result<Summary> {
    let run = CommandContext::new(global);
    if let [path] = &arguments.input.clouds[..]
        && is_file(path)
        && is_ball_file(path)?
    {
        if arguments.input.bounds.is_some() {
            return refuse(format!("--bounds is for point clouds, but {} is a ball file", path.display()));
        }
        return Ok(of_balls(&run.stage("reading balls", 0, |_| read_balls(path))?));
    }
    let mut summary = Summary::default();
    let options = arguments.input.read_options();
    let read = run.stage("reading", 0, |control| read_cloud(&arguments.input.clouds, &options, control));
    let (cloud, report) = read.map_err(|error| pipeline::named_for_part(&arguments.input, error))?;
    pipeline::warn_of_files(&report, &mut summary);
    summary.add("file", report.files.iter().map(of_file).collect::<Vec<_>>());
    summary.add("points", cloud.len());
    let looks_y_up = run.stage("looking for the axis that is up", 0, |control| cloud_looks_y_up(&cloud, control))?;
    summary.remarks(ask::remark_on_axis(looks_y_up));
    if cloud.frame.crs.kind == CrsKind::Unknown {
        let unit = run.stage("looking for the unit", 0, |control| unit_contradiction_of(&cloud.positions, control))?;
        summary.remarks(unit.and_then(ask::Remark::of_contradiction));
    }
    summary.remarks(ask::remarks_on_survey(&SurveyFindings::of_cloud(&cloud), &cloud.frame));
    let statistics = run.stage("counting points", 0, |control| CloudSummary::of(&cloud, control))?;
    let (positions, scanner) = match run.stage("estimating scanner positions", 0, |control| {
        locate(&cloud, &Means::Automatic, &LocateParams::default(), control)
    }) {
        Ok(found) => found,
        Err(error @ Error::MissingAttribute { .. }) => {
            let remarks = vec![error.to_string()];
            (Vec::new(), ScannerReport { point_count: cloud.len(), remarks, ..ScannerReport::default() })
        }
        Err(error) => return Err(error.into()),
    };
    summary.add("survey", SurveyKind::of(&cloud, &statistics, &positions, &scanner).to_string());
    if let Some((low, high)) = statistics.bounds {
        summary.add("min_corner", low.map(|v| rounded(v, 3)).to_vec());
        summary.add("max_corner", high.map(|v| rounded(v, 3)).to_vec());
    }
    summary.add("metres_per_unit", cloud.frame.crs.metres_per_unit);
    if cloud.frame.crs.vertical_metres_per_unit != cloud.frame.crs.metres_per_unit {
        summary.add("metres_per_vertical_unit", cloud.frame.crs.vertical_metres_per_unit);
    }
    summary.add("crs", cloud.frame.crs.definition());
    summary.add("covered_ground_m2", rounded(statistics.occupied_area, 1));
    summary.add("points_per_m2_of_covered_ground", rounded(statistics.density, 2));
    if let Some(facades) = run.stage("measuring facades", 0, |control| FacadeSummary::of(&cloud, control))? {
        summary.add("facades", of_facades(&facades));
    }
    if let Some(pulses) = statistics.pulses {
        summary.add("pulses", whole(pulses.count));
        summary.add("pulses_with_several_returns_percent", rounded(100.0 * pulses.multi_return_share(), 2));
        if statistics.occupied_area > 0.0 {
            summary.add("pulses_per_m2_of_covered_ground", rounded(pulses.count / statistics.occupied_area, 2));
        }
    }
    summary.add("scanner", Summary::of(&scanner));
    summary.add("scanner_by_line", sections(&scanner.lines()));
    summary.add("reading", Summary::of(&report));
    summary.add("attributes", attributes(&cloud, &statistics));
    summary.add("missing", missing(&cloud, &statistics));
    summary.add("usable_for", can_serve(&cloud, &statistics, &scanner));
    summary.add("duplicate_points", statistics.duplicate_count);
    crate::device::list(&mut summary);
    add_headlines(&mut summary, &cloud, &statistics);
    Ok(summary)
}

/// Adds the lines that matter to most people; all figures follow with `--verbose`.
fn add_headlines(summary: &mut Summary, cloud: &PointCloud, statistics: &CloudSummary) {
    summary.headline("<points> points");
    if let Some((low, high)) = statistics.bounds {
        let [width, depth] = [0, 1].map(|axis| high[axis] - low[axis]);
        let unit = if cloud.frame.crs.metres_per_unit == 1.0 { "m" } else { "units" };
        let heights = format!("heights {:.1} to {:.1}", low[2], high[2]);
        let [x, y] = [0, 1].map(|axis| format!("{:.0} to {:.0}", low[axis], high[axis]));
        summary.answer(&format!("{width:.0} x {depth:.0} {unit} on the map: x {x}, y {y}; {heights}"));
    }
    summary.headline("reference system: <reading.reference_system>");
    summary.headline(
        "<points_per_m2_of_covered_ground> points[ and <pulses_per_m2_of_covered_ground> pulses] per m² of covered \
         ground[, <facades.points_per_m2_of_wall> points per m² of wall]",
    );
    summary.headline("survey: <survey>");
    if !statistics.classes.is_empty() && !cloud.is_empty() {
        let percent = |count: usize| 100.0 * count as f64 / cloud.len() as f64;
        let classes = statistics.classes.iter().map(|(class, &count)| format!("{class}: {:.1} %", percent(count)));
        summary.answer(&format!("classes: {}", classes.collect::<Vec<_>>().join(", ")));
    }
    if !missing(cloud, statistics).is_empty() {
        summary.headline("missing: <missing>");
    }
    if statistics.duplicate_count > 0 {
        summary.headline("<duplicate_points> points share their place with another one");
    }
    summary.answer("attributes, scanner, uses, devices: -v, or --json");
}

fn of_file(file: &FileReport) -> serde_json::Value {
    let mut section = Summary::default();
    section.add("path", file.path.display().to_string()).add("format", file.format.clone()).add("points", file.points);
    if !file.crs_source.is_empty() {
        section.add("reference_system", format!("{} ({})", file.crs, file.crs_source));
    }
    section.into()
}

fn of_facades(facades: &FacadeSummary) -> Summary {
    let mut section = Summary::default();
    section.add("steep_points", facades.steep_point_count).add("building_points", facades.building_point_count);
    match facades.walls {
        Some(walls) => section
            .add("estimated_wall_area_m2", whole(walls.area))
            .add("points_per_m2_of_wall", rounded(walls.density, 2)),
        None => section.add("walls", "not estimable: too few points on them"),
    };
    section
}

/// Summarises a ball file.
fn of_balls(model: &ModelParts) -> Summary {
    let mut summary = Summary::default();
    let (low, high) = model.bounds.corners();
    let corner = |place| model.frame.file_from_local(place).map(|v| rounded(v, 3)).to_vec();
    let mut made = Summary::default();
    model.provenance.iter().for_each(|(name, value)| {
        made.add(name, value.clone());
    });
    summary
        .add("balls", model.balls.len())
        .add("surface_patches", of_patches(&model.patches))
        .add("building_surfaces", of_outlines(&model.outlines))
        .add("pulses", model.pulses.as_ref().map_or(0, |pulses| pulses.starts.len()))
        .add("min_corner", corner(low))
        .add("max_corner", corner(high))
        .add("metres_per_unit", model.frame.crs.metres_per_unit)
        .add("crs", model.frame.crs.definition())
        .add("reference_system", model.frame.crs.describe())
        .add("made", made);
    summary
}

/// Summarises the outlines of buildings, with the accuracy of the median edge.
fn of_outlines(outlines: &BuildingOutlines) -> Summary {
    let mut section = Summary::default();
    section
        .add("roofs", outlines.planes.len())
        .add("edges", outlines.edges.len())
        .add("ridges_and_valleys", outlines.ridges.len())
        .add("walls", outlines.walls.len())
        .add("edge_deviation_m", median_sd(&outlines.edges).map(|v| rounded(v, 3)));
    section
}

/// Summarises the number and area of the patches of each kind.
fn of_patches(patches: &SurfacePatches) -> Summary {
    let mut section = Summary::default();
    section.add("triangles", patches.len()).add("area_m2", rounded(patches.area_m2(), 1));
    for (kind, count) in PatchKind::ALL.into_iter().zip(patches.counts()).filter(|(_, count)| count.count > 0) {
        let mut of_kind = Summary::default();
        of_kind.add("triangles", count.count).add("area_m2", rounded(count.area_m2, 1));
        section.add(kind.name(), of_kind);
    }
    section
}

fn attributes(cloud: &PointCloud, statistics: &CloudSummary) -> Summary {
    let mut section = Summary::default();
    for (name, _) in cloud.attributes.columns() {
        section.add(name, "yes");
    }
    let counts = |entries: Vec<(String, usize)>| {
        let mut counts = Summary::default();
        entries.into_iter().for_each(|(name, count)| {
            counts.add(&name, count);
        });
        counts
    };
    if !statistics.classes.is_empty() {
        section.add(
            "classification",
            counts(statistics.classes.iter().map(|(c, &n)| (format!("class {c}"), n)).collect()),
        );
    }
    if !statistics.flight_lines.is_empty() {
        section.add(
            "point_source_id",
            counts(statistics.flight_lines.iter().map(|(l, &n)| (format!("line {l}"), n)).collect()),
        );
    }
    if let Some(share) = statistics.multi_return_share {
        section
            .add("return_count", format!("{:.1} % of the points belong to pulses with several returns", 100.0 * share));
    }
    if let Some([min, max]) = statistics.scan_angle_deg {
        section.add("scan_angle", format!("{min:.1} to {max:.1} degrees"));
    }
    if let Some(times) = statistics.gps_time {
        let mut text = format!("{:.3} to {:.3} s, {} different values", times.first, times.last, times.distinct_count);
        if times.missing_count > 0 {
            text.push_str(&format!(", {} missing", times.missing_count));
        }
        if !times.can_separate_pulses(cloud.len()) {
            text.push_str(": too few to separate pulses");
        }
        section.add("gps_time", text);
    }
    if !cloud.scanner_positions.is_empty() {
        section.add("scanner_positions", cloud.scanner_positions.len());
    }
    section
}

/// Attributes that would make more possible.
fn missing(cloud: &PointCloud, statistics: &CloudSummary) -> Vec<&'static str> {
    let a = &cloud.attributes;
    // LAS files always have these fields; 0 says that nobody filled them, class 1 that the point was not classified
    let classes_say_nothing = statistics.classes.keys().all(|&class| class <= 1);
    let lines_say_nothing = statistics.flight_lines.keys().all(|&line| line == 0);
    let wanted = [
        (a.classification.is_none() || classes_say_nothing, "classes (noise cannot be detected by its class)"),
        (a.gps_time.is_none(), "GPS time (a trajectory cannot orient normals)"),
        (a.return_number.is_none(), "return numbers"),
        (a.scan_angle.is_none(), "scan angles"),
        (a.point_source_id.is_none() || lines_say_nothing, "flight lines"),
        (
            cloud.frame.crs.wkt.is_none() && cloud.frame.crs.epsg.is_none(),
            "reference system (metres are assumed; see --crs)",
        ),
    ];
    wanted.into_iter().filter_map(|(is_missing, name)| is_missing.then_some(name)).collect()
}

fn can_serve(cloud: &PointCloud, statistics: &CloudSummary, scanner: &ScannerReport) -> Summary {
    let mut section = Summary::default();
    let enough = cloud.len() >= 4;
    let yes_if = |able: bool, why_not: &str| if able { "yes".to_owned() } else { format!("no: {why_not}") };
    for command in ["normals", "balls", "depth-map", "query"] {
        section.add(command, yes_if(enough, "fewer than 4 points"));
    }
    section.add("--orient given", yes_if(cloud.attributes.normals.is_some(), "the file has no normals"));
    section.add("--orient scanner", yes_if(!cloud.scanner_positions.is_empty(), "the file has no scanner positions"));
    let times = statistics.gps_time.is_some_and(|t| t.can_separate_pulses(cloud.len()));
    section.add("--orient trajectory=FILE", yes_if(times, "the file has no usable GPS times"));
    let by_pulses = [FoundBy::Returns, FoundBy::ScanAngle].iter().any(|means| scanner.found.contains_key(means));
    section.add("--orient pulses", yes_if(by_pulses, "the pulses do not determine the scanner positions"));
    section.add("--orient mesh=FILE", "yes");
    let carved = if !enough {
        "no: fewer than 4 points"
    } else if scanner.found.is_empty() {
        "no: the scanner positions are unknown"
    } else if scanner.is_assumed() {
        "yes, with pulses assumed to be vertical"
    } else {
        "yes"
    };
    section.add("--method carved", carved);
    section
}
