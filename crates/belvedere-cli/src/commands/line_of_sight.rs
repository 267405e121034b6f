//! `belvedere line-of-sight`.

use super::far_terrain::set_terrain;
use super::sights::{Proving, blockers, enclosure_note, ground, ground_cloud};
use super::{check_output, extension};
use crate::arguments::{Global, GroundChoice, LineOfSight, Place, Usage};
use crate::pipeline::{self, Points, Scene};
use crate::run::Run;
use crate::summary::{Summary, percent, rounded};
use anyhow::{Result, bail};
use belvedere::apps::eyes::skip_unfit_eyes;
use belvedere::apps::profile::{SightProfile, sight_profile};
use belvedere::apps::targets::{grid_around, set_on_ground, set_on_terrain};
use belvedere::apps::viewshed::{OBSERVER_HEIGHT, TARGET_HEIGHT};
use belvedere::figures::{profile_picture, write_png};
use belvedere::ground::{Ground, MapGrid};
use belvedere::io::{Cells, GeojsonFeature, Shape, TextRows, read_geojson, read_table, with_columns_read, write_table};
use belvedere::query::{Answer, AnswerCounts, Blocker, EarthParams, MedialScene, UnprovenAs, random_pairs};
use std::path::Path;

const OUTSIDE_LINE: &str = "have an end outside the cloud, where nothing is known, and no answer";
const OUTSIDE_BOTH: &str =
    "have an end outside the cloud and the terrain, or below the cloud, where nothing is known, and no answer";
/// Columns of a table of pairs.
const ENDS: [&str; 6] = ["ax", "ay", "az", "bx", "by", "bz"];

pub(crate) fn run(arguments: &LineOfSight, global: &Global) -> Result<Summary> {
    if let Some(output) = &arguments.output {
        check_output("-o", output, &["csv"])?;
    }
    if let Some(profile) = &arguments.profile_out {
        check_output("--profile-out", profile, &["csv", "png"])?;
    }
    let earth = arguments.earth.params()?;
    let wave = arguments.radio.wave()?;
    if wave.is_some() && arguments.terrain.is_some() {
        let what = "--frequency-ghz cannot be used with --terrain: Fresnel zones are not tested over the terrain beyond the cloud. \
                    Test the line of sight with --terrain, and the zone within the cloud without it";
        return Err(Usage(what.to_owned()).into());
    }
    let mut run = Run::new(global);
    // ends may need the ground
    let points = if arguments.lines.random.is_some() { Points::LetGo } else { Points::Keep };
    let mut scene = pipeline::scene(&arguments.scene, points, &mut run)?;
    if let Some(path) = &arguments.terrain {
        set_terrain(path, &mut scene, &mut run)?;
    }
    let (mut pairs, rows) = pairs(arguments, &scene, &mut run)?;
    set_ends_on_ground(&mut pairs, arguments, &mut scene, &mut run)?;
    let mut section = Summary::default();
    let (blockers, unproven_as) = blockers(
        &scene,
        arguments.scene.profile.into(),
        &arguments.giving_way,
        Proving::IfItDecides,
        &mut run,
        &mut section,
    )?;
    if blockers.proof().is_none() {
        // nothing then says how much of a line no pulse came near to
        scene.model = scene.model.without_pulses();
    }
    let sights = run.stage("answering queries", 0, |control| blockers.lines_of_sight(&pairs, &earth, control))?;
    let fresnel = match wave {
        Some(wave) => Some(run.stage("testing Fresnel zones", pairs.len(), |control| {
            blockers.fresnel_clearances(&pairs, &sights, wave, &earth, control)
        })?),
        None => None,
    };
    let settled = |sight: &Option<belvedere::query::LineOfSight>| {
        sight.map_or(Answer::OutsideView, |sight| unproven_as.settle(sight.answer))
    };
    let answers: Vec<Answer> = sights.iter().map(settled).collect();
    let mut observers: Vec<[f64; 3]> = pairs.iter().map(|[observer, _]| *observer).collect();
    let fit = run.stage("testing observers", 0, |control| skip_unfit_eyes(&blockers, None, &mut observers, control))?;
    section.add("observers_inside_obstacle", fit.skipped_inside_obstacle);
    run.summary.add("lines_of_sight", counted(&answers, unproven_as, section));
    let outside = AnswerCounts::of(&answers).outside_cloud;
    let is_outside = if arguments.terrain.is_some() { OUTSIDE_BOTH } else { OUTSIDE_LINE };
    run.summary.warn_of_share(outside, answers.len(), "lines of sight", is_outside);
    if let ([[observer, _]], [sight]) = (&pairs[..], &sights[..]) {
        let mut one = Summary::default();
        if let Some(sight) = sight {
            one.add("answer", name(unproven_as.settle(sight.answer)));
            if let Some(block) = sight.first_block {
                one.add("first_block_range_m", rounded(block.range, 3)).add(
                    "block_position",
                    scene.cloud.frame.file_from_local(block.place).map(|v| rounded(v, 3)).to_vec(),
                );
                if let Some(ball) = block.blocker.ball() {
                    let source = scene.model.balls().source.get(ball).copied().unwrap_or_default();
                    one.add("block_ball", ball).add("block_source", source);
                }
                if let Some(name) = mesh_name(&blockers, block.blocker) {
                    one.add("block_mesh", name);
                }
                if block.blocker == Blocker::Terrain {
                    one.add("block_terrain", true);
                }
            }
            if scene.model.pulses().is_some() && sight.answer != Answer::OutsideCloud {
                one.add("unproven_m", rounded(sight.unproven_length, 3));
            }
        }
        if let Some(free) = fresnel.as_ref().and_then(|all| all.first()).filter(|free| free.is_finite()) {
            one.add("fresnel_free_percent", rounded(100.0 * free, 1));
        }
        one.add("note", enclosure_note(&blockers, *observer, "the observer").into_iter().collect::<Vec<_>>());
        run.summary.add("line", one);
    }
    if let Some(output) = &arguments.output {
        run.stage("writing", 0, |_| {
            let found = Found { sights: &sights, answers: &answers, fresnel: fresnel.as_deref() };
            write(output, (&scene, &blockers), &pairs, &rows, &found)
        })?;
        run.summary.add("written", output.display().to_string());
    }
    if let (Some(output), [pair]) = (&arguments.profile_out, &pairs[..]) {
        write_profile(output, arguments, &mut scene, &blockers, *pair, &earth, &mut run)?;
    }
    Ok(run.finish())
}

/// Observer and target of each line, local metres, and the rows of the table they are from.
fn pairs(arguments: &LineOfSight, scene: &Scene, run: &mut Run) -> Result<(Vec<[[f64; 3]; 2]>, TextRows)> {
    let lines = &arguments.lines;
    if let (Some(from), Some(to)) = (&lines.from, &lines.to) {
        let local = |&Place([x, y], z): &Place| scene.cloud.frame.local_from_file([x, y, z.unwrap_or(f64::NAN)]);
        return Ok((vec![[local(from), local(to)]], TextRows::default()));
    }
    if let Some(count) = lines.random {
        let pairs = random_pairs(scene.model.bounds().low, scene.model.bounds().high, count, run.seed);
        return Ok((pairs, TextRows::default()));
    }
    let Some(path) = &lines.pairs else {
        return Err(
            Usage("lines of sight are missing: give --pairs, --random, or --observer and --target".to_owned()).into()
        );
    };
    if ["geojson", "json"].contains(&extension(path).as_str()) {
        let features = run.stage("reading pairs", 0, |_| read_geojson(path, &scene.cloud.frame.crs))?;
        return Ok((ends_of_lines(path, &features, scene.cloud.frame.origin)?, TextRows::default()));
    }
    let table = run.stage("reading pairs", 0, |_| read_table(path))?;
    let mut columns: [&[f64]; 6] = [&[]; 6];
    for (column, name) in columns.iter_mut().zip(ENDS) {
        let is_height = name.ends_with('z');
        *column = if is_height { table.column(path, name)?.unwrap_or(&[]) } else { table.full_column(path, name)? };
    }
    let end = |row: usize, first: usize| {
        scene
            .cloud
            .frame
            .local_from_file(std::array::from_fn(|i| columns[first + i].get(row).copied().unwrap_or(f64::NAN)))
    };
    let pairs = (0..table.row_count()).map(|row| [end(row, 0), end(row, 3)]).collect();
    Ok((pairs, table.into_text()))
}

/// The first and the last corner of each line, local metres.
fn ends_of_lines(path: &Path, features: &[GeojsonFeature], origin: [f64; 3]) -> Result<Vec<[[f64; 3]; 2]>> {
    let local = |corner: &[f64; 3]| std::array::from_fn(|axis| corner[axis] - origin[axis]);
    let ends = |(number, feature): (usize, &GeojsonFeature)| match &feature.shape {
        Shape::Line(corners) if corners.len() > 1 => Ok([&corners[0], &corners[corners.len() - 1]].map(local)),
        _ => bail!("{}: feature {} is not a line; lines of sight need lines", path.display(), number + 1),
    };
    let pairs: Vec<_> = features.iter().enumerate().map(ends).collect::<Result<_>>()?;
    if pairs.is_empty() {
        bail!("{}: the file has no line", path.display());
    }
    Ok(pairs)
}

/// Gives ends without a height one above the ground.
fn set_ends_on_ground(
    pairs: &mut [[[f64; 3]; 2]],
    arguments: &LineOfSight,
    scene: &mut Scene,
    run: &mut Run,
) -> Result<()> {
    let coverage = scene.model.coverage();
    // ground is made where there are points: one end far away would make its cells large for all
    let over = |place: &[f64; 3]| coverage.is_none_or(|coverage| coverage.holds_on_map(*place));
    let heights = &arguments.heights;
    let heights = [heights.observer_height.unwrap_or(OBSERVER_HEIGHT), heights.target_height.unwrap_or(TARGET_HEIGHT)];
    let grid = grid_around(pairs.iter().flatten().copied().filter(over), scene.cloud.frame.origin);
    if let Some(grid) = grid? {
        let (cloud, points) = ground_cloud(&arguments.ground, scene, run)?;
        let ground = ground(&cloud, points, grid, run)?;
        if matches!(arguments.ground, GroundChoice::OfScene(_)) {
            // a profile needs it again
            scene.cloud = cloud;
        }
        set_on_ground(pairs.iter_mut().flat_map(|pair| pair.iter_mut().zip(heights)), &ground);
    }
    set_on_terrain(pairs.iter_mut().flat_map(|pair| pair.iter_mut().zip(heights)), &scene.model);
    let unknown = pairs.iter().flatten().filter(|end| end[2].is_nan()).count();
    run.summary.warn_of_share(unknown, 2 * pairs.len(), "ends of lines", "have no height and no known ground below");
    Ok(())
}

/// What is known of each pair.
struct Found<'a> {
    sights: &'a [Option<belvedere::query::LineOfSight>],
    answers: &'a [Answer],
    /// Free share of the first Fresnel zone.
    fresnel: Option<&'a [f64]>,
}

fn write(
    output: &Path,
    (scene, blockers): (&Scene, &MedialScene),
    pairs: &[[[f64; 3]; 2]],
    rows: &TextRows,
    &Found { sights, answers, fresnel }: &Found<'_>,
) -> Result<()> {
    let ends: [Vec<f64>; 6] = std::array::from_fn(|column| {
        pairs.iter().map(|pair| scene.cloud.frame.file_from_local(pair[column / 3])[column % 3]).collect()
    });
    let block = |i: usize| sights[i].and_then(|sight| sight.first_block);
    let count = sights.len();
    let place: [Vec<f64>; 3] = std::array::from_fn(|axis| {
        (0..count)
            .map(|i| block(i).map_or(f64::NAN, |block| scene.cloud.frame.file_from_local(block.place)[axis]))
            .collect()
    });
    let range: Vec<f64> = (0..count).map(|i| block(i).map_or(f64::NAN, |block| block.range)).collect();
    let unproven: Vec<f64> = sights
        .iter()
        .map(|sight| sight.filter(|s| s.first_block.is_none()).map_or(f64::NAN, |s| s.unproven_length))
        .collect();
    let codes: Vec<Option<u64>> = answers.iter().map(|&answer| Some(u64::from(answer as u8))).collect();
    let ball = |i: usize| block(i).and_then(|block| block.blocker.ball());
    let balls: Vec<Option<u64>> = (0..count).map(|i| ball(i).map(|ball| ball as u64)).collect();
    let sources: Vec<Option<u64>> =
        (0..count).map(|i| scene.model.balls().source.get(ball(i)?).map(|&row| u64::from(row))).collect();
    let mut columns: Vec<(&'static str, Cells<'_>)> =
        ENDS.iter().zip(&ends).map(|(&name, values)| (name, Cells::Real(values, 4))).collect();
    columns.push(("answer", Cells::Whole(&codes)));
    columns.push(("first_block_range_m", Cells::Real(&range, 3)));
    if scene.model.pulses().is_some() {
        columns.push(("unproven_m", Cells::Real(&unproven, 3)));
    }
    let free: Option<Vec<f64>> = fresnel.map(|all| all.iter().map(|free| 100.0 * free).collect());
    if let Some(free) = &free {
        columns.push(("fresnel_free_percent", Cells::Real(free, 1)));
    }
    columns.extend(["block_x", "block_y", "block_z"].into_iter().zip(&place).map(|(n, v)| (n, Cells::Real(v, 3))));
    columns.push(("block_ball", Cells::Whole(&balls)));
    columns.push(("block_source", Cells::Whole(&sources)));
    let meshes: Vec<&str> =
        (0..count).map(|i| block(i).and_then(|block| mesh_name(blockers, block.blocker)).unwrap_or_default()).collect();
    if blockers.added().is_some() {
        columns.push(("block_mesh", Cells::Words(&meshes)));
    }
    let terrain: Vec<Option<u64>> =
        (0..count).map(|i| block(i).map(|block| u64::from(block.blocker == Blocker::Terrain))).collect();
    if blockers.far_terrain().grid().is_some() {
        columns.push(("block_terrain", Cells::Whole(&terrain)));
    }
    let read = rows.columns(0..rows.row_count());
    Ok(write_table(output, &with_columns_read(&read, &ENDS, &columns))?)
}

/// The name of an added mesh that blocks.
fn mesh_name(blockers: &MedialScene, blocker: Blocker) -> Option<&str> {
    blockers.added()?.names().get(blocker.mesh()?).map(String::as_str)
}

fn write_profile(
    output: &Path,
    arguments: &LineOfSight,
    scene: &mut Scene,
    blockers: &MedialScene,
    pair: [[f64; 3]; 2],
    earth: &EarthParams,
    run: &mut Run,
) -> Result<()> {
    let ground = profile_ground(arguments, scene, run)?;
    let profile = run.stage("computing profile", 0, |control| {
        sight_profile(blockers, ground.as_ref(), pair, earth, arguments.profile_step, control)
    })?;
    let up = scene.cloud.frame.crs.vertical_metres_per_unit;
    let height = |local: f64| (local + scene.cloud.frame.origin[2]) / up;
    let ground: Vec<f64> = profile.ground.iter().map(|&v| height(v)).collect();
    let line: Vec<f64> = profile.line.iter().map(|&v| height(v)).collect();
    if extension(output) == "png" {
        let solid: Vec<Vec<[f64; 2]>> =
            profile.solid.iter().map(|pieces| pieces.iter().map(|piece| piece.map(height)).collect()).collect();
        let title = match profile.blocked_at {
            Some(at) => format!("Line of sight, {:.1} m: blocked after {at:.1} m", span(&profile)),
            None => format!("Line of sight, {:.1} m: nothing blocks", span(&profile)),
        };
        let picture = profile_picture(&belvedere::figures::Profile {
            distances: &profile.distances,
            ground: &ground,
            line: &line,
            solid: &solid,
            blocked_at: profile.blocked_at,
            title: &title,
        });
        run.stage("writing", 0, |_| write_png(output, &picture))?;
    } else {
        let blocked: Vec<Option<u64>> = profile.blocked.iter().map(|&blocked| Some(u64::from(blocked))).collect();
        let blocks: Vec<String> = profile
            .solid
            .iter()
            .map(|pieces| {
                let pieces: Vec<String> =
                    pieces.iter().map(|piece| piece.map(|v| format!("{:.2}", height(v))).join("..")).collect();
                pieces.join(" ")
            })
            .collect();
        let blocks: Vec<&str> = blocks.iter().map(String::as_str).collect();
        run.stage("writing", 0, |_| {
            write_table(
                output,
                &[
                    ("distance_m", Cells::Real(&profile.distances, 3)),
                    ("ground", Cells::Real(&ground, 3)),
                    ("line", Cells::Real(&line, 3)),
                    ("blocked", Cells::Whole(&blocked)),
                    ("blocks", Cells::Words(&blocks)),
                ],
            )
        })?;
    }
    run.summary.add("profile_written", output.display().to_string());
    Ok(())
}

fn span(profile: &SightProfile) -> f64 {
    profile.distances.last().copied().unwrap_or(0.0)
}

/// The ground below a profile; none for a ball file without a cloud beside it.
fn profile_ground(arguments: &LineOfSight, scene: &mut Scene, run: &mut Run) -> Result<Option<Ground>> {
    if scene.cloud.is_empty() && matches!(arguments.ground, GroundChoice::OfScene(_)) {
        return Ok(None);
    }
    let (low, high) = scene.model.bounds().on_map();
    let origin = [scene.cloud.frame.origin[0], scene.cloud.frame.origin[1]];
    let grid = MapGrid::covering(low, high, belvedere::apps::viewshed::cell_for(low, high), origin)?;
    let (cloud, points) = ground_cloud(&arguments.ground, scene, run)?;
    Ok(Some(ground(&cloud, points, grid, run)?))
}

fn counted(answers: &[Answer], unproven_as: UnprovenAs, how: Summary) -> Summary {
    let counts = AnswerCounts::of(answers);
    let mut section = Summary::default();
    section.add("pairs", answers.len()).add("visible", counts.visible).add("blocked", counts.blocked);
    if unproven_as == UnprovenAs::Reported {
        section.add("unproven", counts.unproven);
    }
    section
        .add("no_line", counts.outside_view)
        .add("outside_cloud", counts.outside_cloud)
        .add("visible_percent", percent(counts.visible, answers.len()))
        .add_all(how);
    section
}

fn name(answer: Answer) -> &'static str {
    match answer {
        Answer::Visible => "visible",
        Answer::Blocked => "blocked",
        Answer::Unproven => "unproven",
        Answer::OutsideCloud => "outside the cloud",
        _ => "no line",
    }
}
