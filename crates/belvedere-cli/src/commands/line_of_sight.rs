//! `belvedere line-of-sight`.

use crate::arguments::{Global, LineOfSightArguments, refuse};
use crate::inputs::far_terrain::set_terrain;
use crate::inputs::line_pairs::{ENDS, pairs};
use crate::inputs::observers::{ObserverUse, observer_rows};
use crate::outputs::formats::{check_output, extension};
use crate::outputs::formats::{check_outputs, warn_of_geojson};
use crate::pipeline::{self, KeepPoints};
use crate::run::CommandContext;
use crate::summary::Summary;
use anyhow::{Result, bail};
use belvedere::apps::ask::{
    Ask, LinesOfSightQuestion, NetworkPlaces, Places, ProfileRows, Scene, SightNetwork, SightsResults, Standing,
};
use belvedere::apps::profile::SightProfile;
use belvedere::apps::result_columns::ResultColumn;
use belvedere::figures::{DistanceProfile, profile_picture, write_png};
use belvedere::io::{
    PathLine, RowsAre, TextRows, row_properties, with_columns_read, write_graphml, write_places, write_table,
};
use belvedere::query::{Answer, UnprovenAs};
use std::path::Path;

pub(crate) fn run(arguments: &LineOfSightArguments, global: &Global) -> Result<Summary> {
    let question = question(arguments)?;
    check(arguments, &question)?;
    let mut run = CommandContext::new(global);
    // ends may need the ground
    let points = if arguments.lines.random.is_some() { KeepPoints::LetGo } else { KeepPoints::Keep };
    let ends: Vec<[f64; 2]> = arguments.lines.from.iter().chain(&arguments.lines.to).map(|end| end.0).collect();
    let part = (arguments.terrain.is_none() && !ends.is_empty()).then_some((&ends[..], 0.0));
    let mut scene = pipeline::scene_in_reach(&arguments.scene, part, points, &mut run)?;
    if let Some(path) = &arguments.terrain {
        set_terrain(path, &mut scene, &mut run)?;
    }
    let scene = scene.into_question_scene(Some(&arguments.ground), arguments.giving_way.shell, &run)?;
    let (places, rows) = match &arguments.among {
        Some(path) => (Places::Network(network(path, arguments.max_distance, &scene, &mut run)?), TextRows::default()),
        None => {
            let (pairs, rows) = pairs(&arguments.lines, &scene, &run)?;
            (Places::Pairs(pairs), rows)
        }
    };
    let answers = run.ask(&scene, &question, &places)?;
    let found = &answers.found;
    for output in &arguments.outputs {
        run.stage("writing", 0, |_| write(output, found, &scene, &rows))?;
    }
    match &arguments.outputs[..] {
        [] => {}
        [one] => drop(run.summary.add("written", one.display().to_string())),
        several => drop(run.summary.add_paths("written", several)),
    }
    warn_of_geojson(&arguments.outputs, &scene.frame().crs, &mut run.summary);
    if let (Some(output), Some(profile)) = (&arguments.profile_out, &found.profile) {
        run.stage("writing", 0, |_| write_profile(output, profile, &scene, unproven_length(found, &scene)))?;
        run.summary.add("profile_written", output.display().to_string());
    }
    Ok(run.finish())
}

fn question(arguments: &LineOfSightArguments) -> Result<LinesOfSightQuestion> {
    Ok(LinesOfSightQuestion {
        observer_height: arguments.heights.observer_height,
        target_height: arguments.heights.target_height,
        ground: arguments.ground.points(),
        earth: arguments.earth.params()?,
        frequency_ghz: arguments.radio.frequency,
        unproven: arguments.giving_way.unproven.map(UnprovenAs::from),
        how_sure: arguments.how_sure.choice(),
        profile: arguments.profile_out.as_ref().map(|_| ProfileRows { step: arguments.profile_step }),
    })
}

fn check(arguments: &LineOfSightArguments, question: &LinesOfSightQuestion) -> Result<()> {
    if arguments.max_distance.is_some() && arguments.among.is_none() {
        return refuse("--max-distance limits the pairs of --among, which is missing");
    }
    for output in &arguments.outputs {
        check_output("-o", output, &["csv", "geojson", "gpkg", "graphml"])?;
        if extension(output) == "graphml" && arguments.among.is_none() {
            return refuse(format!(
                "-o {}: a network is one of places that may see each other: give --among",
                output.display()
            ));
        }
    }
    check_outputs("--profile-out", &arguments.profile_out, &["csv", "png"])?;
    question.check()?;
    Ok(())
}

/// The places of a network from a file.
fn network(path: &Path, max_distance: Option<f64>, scene: &Scene, run: &mut CommandContext) -> Result<NetworkPlaces> {
    let frame = scene.frame();
    let mut network = NetworkPlaces { max_distance, ..NetworkPlaces::default() };
    for row in observer_rows(path, frame, RowsAre::Places, ObserverUse::Places, run)? {
        let &[place] = &row.corners[..] else {
            bail!("{}: a line or an area is no place of a network; give points", path.display());
        };
        network.places.push(Standing { place, height: row.height });
        network.names.push(row.name);
    }
    Ok(network)
}

fn write(output: &Path, found: &SightsResults, scene: &Scene, rows: &TextRows) -> belvedere::Result<()> {
    let frame = scene.frame();
    let mut columns = found.table(scene);
    if found.network.is_none() && extension(output) == "csv" {
        columns.retain(|column| column.name != "length_m");
    }
    let read = rows.columns(0..rows.row_count());
    match (extension(output).as_str(), &found.network) {
        ("geojson" | "gpkg", _) => {
            let columns = with_columns_read(&read, &ENDS, columns);
            let of_line = |row: usize| {
                let places = found.pairs[row].map(|end| std::array::from_fn(|axis| end[axis] + frame.origin[axis]));
                let mut properties = row_properties(&columns, row);
                properties.retain(|name, _| !ENDS.contains(&&name[..]));
                PathLine { places: places.to_vec(), properties }
            };
            // an end without a height is nowhere
            let has_place = |&row: &usize| found.pairs[row].iter().all(|end| end[2].is_finite());
            let lines: Vec<PathLine> = (0..found.pairs.len()).filter(has_place).map(of_line).collect();
            write_places(output, &[], &lines, &frame.crs).map(|_| ())
        }
        ("graphml", Some(network)) => {
            columns.retain(|ResultColumn { name, .. }| {
                let name = &name[..];
                !ENDS.contains(&name) && !name.starts_with("block") && !["a", "b"].contains(&name)
            });
            write_network(output, found, network, &columns, scene)
        }
        (_, Some(_)) => write_table(output, &columns),
        (_, None) => write_table(output, &with_columns_read(&read, &ENDS, columns)),
    }
}

/// Writes the places as nodes, and the visible and unproven pairs as edges.
fn write_network(
    output: &Path,
    found: &SightsResults,
    network: &SightNetwork,
    edges: &[ResultColumn],
    scene: &Scene,
) -> belvedere::Result<()> {
    let mut nodes = vec![ResultColumn::words("name", &network.names)];
    nodes.extend(ResultColumn::coordinates(scene.frame(), &network.places));
    nodes.push(ResultColumn::whole("links", network.link_counts.iter().copied()));
    nodes.push(ResultColumn::whole("group", network.groups.iter().copied()));
    let is_edge = |answer: Answer| [Answer::Visible, Answer::Unproven].contains(&answer);
    let ends: Vec<Option<[usize; 2]>> =
        network.pairs.iter().zip(&found.answers).map(|(&pair, &answer)| is_edge(answer).then_some(pair)).collect();
    write_graphml(output, network.places.len(), &nodes, &ends, edges)
}

/// Returns the length of the first line that no pulse came near to, metres, if that makes its answer unproven.
fn unproven_length(found: &SightsResults, scene: &Scene) -> Option<f64> {
    let is_unproven = found.answers.first() == Some(&Answer::Unproven);
    found.columns(scene).unproven.and_then(|lengths| lengths.first().copied()).filter(|_| is_unproven)
}

fn write_profile(output: &Path, profile: &SightProfile, scene: &Scene, unproven: Option<f64>) -> belvedere::Result<()> {
    let frame = scene.frame();
    let up = frame.crs.vertical_metres_per_unit;
    let height = |local: f64| (local + frame.origin[2]) / up;
    let ground: Vec<f64> = profile.ground.iter().map(|&v| height(v)).collect();
    let line: Vec<f64> = profile.line.iter().map(|&v| height(v)).collect();
    let solid: Vec<Vec<[f64; 2]>> =
        profile.solid.iter().map(|pieces| pieces.iter().map(|piece| piece.map(height)).collect()).collect();
    if extension(output) == "png" {
        let length = profile.distances.last().copied().unwrap_or(0.0);
        let title = match (profile.blocked_at, unproven) {
            (Some(at), _) => format!("Line of sight, {length:.1} m: blocked after {at:.1} m"),
            (None, Some(unproven)) => format!("Line of sight, {length:.1} m: unproven on {unproven:.1} m"),
            (None, None) => format!("Line of sight, {length:.1} m: nothing blocks"),
        };
        let picture = profile_picture(&DistanceProfile {
            distances: &profile.distances,
            ground: &ground,
            line: &line,
            solid: &solid,
            blocked_at: profile.blocked_at,
            title: &title,
        });
        return write_png(output, &picture);
    }
    let in_words = |piece: &[f64; 2]| piece.map(|v| format!("{v:.2}")).join("..");
    let blocks = solid.iter().map(|pieces| pieces.iter().map(in_words).collect::<Vec<_>>().join(" "));
    let columns = [
        ResultColumn::real("distance_m", profile.distances.iter().copied(), 3),
        ResultColumn::real("ground", ground, 3),
        ResultColumn::real("line", line, 3),
        ResultColumn::whole("blocked", profile.blocked.iter().map(|&blocked| usize::from(blocked))),
        ResultColumn::words("blocks", blocks),
    ];
    write_table(output, &columns)
}
