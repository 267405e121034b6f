//! `belvedere shadow`.

use super::sights::{Proving, blockers};
use super::targets::{Asked, Relief};
use super::{check_output, extension};
use crate::arguments::{Global, Shadow, Usage};
use crate::pipeline::{self, Points, Scene, flagged};
use crate::run::Run;
use crate::summary::{Summary, rounded};
use anyhow::Result;
use belvedere::apps::rows::Obstacles;
use belvedere::apps::shadow::{Edges, LIT, ShadowSun, scene_shadow, sun_directions, unproven_light};
use belvedere::apps::sun::{Site, SunPosition, Zone, sun_days, sun_position_with};
use belvedere::apps::targets::Measure;
use belvedere::apps::tree_light::Season;
use belvedere::figures::{MapLegend, MapPicture, Picture, map_picture, write_apng, write_png};
use belvedere::io::atomic;
use belvedere::query::UnprovenAs;
use belvedere::results::{ResultKind, UNPROVEN_BAND};

const SHADE_COLOR: [u8; 3] = [38, 52, 96];
const HALF_COLOR: [u8; 3] = [147, 136, 93];
const UNPROVEN_COLOR: [u8; 3] = [90, 150, 240];
const LIT_COLOR: [u8; 3] = [255, 220, 90];
/// Most suns told one by one.
const MOST_TOLD: usize = 5;

pub(crate) fn run(arguments: &Shadow, global: &Global) -> Result<Summary> {
    check(arguments)?;
    let mut run = Run::new(global);
    let points = if arguments.places.needs_points() { Points::Keep } else { Points::LetGo };
    let mut scene = pipeline::scene(&arguments.scene, points, &mut run)?;
    arguments.places.far.set(&mut scene, &mut run)?;
    let mut suns = suns(arguments, &scene, &mut run.summary)?;
    suns.iter_mut().for_each(|sun| sun.title = arguments.places.far.titled(&sun.title));
    let asked = arguments.places.targets(&mut scene, &mut run)?;
    let edges = if arguments.suns.soft { Edges::Soft } else { Edges::Hard };
    // pulses are asked about one sun that is a point: of many it would take long
    let proving = if suns.len() == 1 && edges == Edges::Hard { Proving::IfItDecides } else { Proving::Never };
    if proving == Proving::Never && arguments.giving_way.unproven.is_some() {
        return Err(Usage("--unproven applies only to one sun with hard edges".to_owned()).into());
    }
    let mut section = Summary::default();
    let profile = arguments.scene.profile.into();
    let (blockers, unproven) = blockers(&scene, profile, &arguments.giving_way, proving, &mut run, &mut section)?;
    let kinds: Vec<ShadowSun> = suns.iter().map(|sun| sun.sun).collect();
    let to_suns: Vec<[f64; 3]> = kinds.iter().map(|sun| sun.to_sun).collect();
    asked.report_edge(&arguments.places, &scene, &to_suns, &mut run)?;
    section.add("directions", kinds.iter().map(|sun| sun_directions(sun.to_sun, edges).len()).sum::<usize>());
    run.summary.add("lines_of_sight", section);
    let trees = arguments.trees.of(&scene, blockers.params(), &mut run.summary)?;
    let obstacles = Obstacles { scene: &blockers, trees: trees.as_ref() };
    let looks = asked.targets.len() * obstacles.matrix_count();
    let lit =
        run.stage("testing sun", looks, |control| scene_shadow(obstacles, &asked.targets, &kinds, edges, control))?;
    let doubts = match (&kinds[..], &lit[..]) {
        ([sun], [lit]) if unproven != UnprovenAs::Visible && blockers.proof().is_some() => {
            run.stage("testing pulses", 0, |control| unproven_light(&blockers, &asked.targets, *sun, lit, control))?
        }
        _ => None,
    };
    let decimals = if edges == Edges::Soft { 4 } else { 2 };
    let kind = if edges == Edges::Hard && trees.is_none() { ResultKind::Answer } else { ResultKind::Number };
    let of_sun = |(sun, values): (&Sun, &Vec<f32>)| {
        let measure = Measure::new(&sun.column, values.clone()).with_description(LIT);
        // one raster, a band for each sun
        measure.with_decimals(decimals).with_range(Some([0.0, 1.0])).with_kind(kind).as_further_band()
    };
    let mut measures: Vec<Measure> = suns.iter().zip(&lit).map(of_sun).collect();
    if let Some(doubts) = &doubts {
        let measure = Measure::new(UNPROVEN_BAND, doubts.clone()).with_description("1: lit, but unproven");
        measures.push(measure.with_decimals(0).with_range(Some([0.0, 1.0])).with_kind(kind).as_further_band());
    }
    run.summary.add("shadow", asked.statistics(&measures[..measures.len().min(MOST_TOLD)]));
    let has_parts = lit.iter().flatten().any(|&share| share > 0.0 && share < 1.0);
    let legend = if has_parts { Legend::WithParts } else { Legend::WithoutParts };
    let picture = |number: usize, relief: &Relief| {
        frame(&suns[number], &lit[number], doubts.as_deref().filter(|_| number == 0), legend, relief)
    };
    let pictured = |relief: &Relief| picture(0, relief);
    asked.write_with(&arguments.outputs, &measures, &pictured, &mut run)?;
    let map = arguments.outputs.output.iter().find(|output| extension(output) == "png" && asked.relief().is_some());
    if let (Some(map), 2.., None, None) = (map, suns.len(), &arguments.film, &arguments.frames) {
        let (map, count) = (map.display(), suns.len());
        run.summary.warn(format!("{map}: the map shows only the first of {count} suns; --film OUT shows them all"));
    }
    films(arguments, &asked, &suns, &picture, &mut run)?;
    Ok(run.finish())
}

fn check(arguments: &Shadow) -> Result<()> {
    arguments.places.check(&arguments.outputs)?;
    let is_given = !arguments.suns.time.is_empty() || !arguments.suns.direction.is_empty() || arguments.when.is_given();
    if !is_given {
        return Err(Usage(
            "suns are missing: give --time TIME, --date DAY, --from and --to, or --sun AZ,EL".to_owned(),
        )
        .into());
    }
    arguments.when.check(&arguments.sun)?;
    for time in &arguments.suns.time {
        arguments.sun.instant("--time", time)?;
    }
    for direction in &arguments.suns.direction {
        if !(-90.0..=90.0).contains(&direction.0[1]) {
            return Err(Usage(format!("--sun: the elevation {} must be -90 to 90 degrees", direction.0[1])).into());
        }
    }
    if let Some(film) = &arguments.film {
        check_output("--film", film, &["png", "apng"])?;
    }
    if (arguments.film.is_some() || arguments.frames.is_some()) && !arguments.places.is_grid() {
        return Err(Usage("--film and --frames apply only to a grid".to_owned()).into());
    }
    Ok(())
}

/// A sun that is asked about.
struct Sun {
    sun: ShadowSun,
    /// Name of its column.
    column: String,
    title: String,
}

/// The suns that were typed, in their order.
fn suns(arguments: &Shadow, scene: &Scene, summary: &mut Summary) -> Result<Vec<Sun>> {
    let mut section = Summary::default();
    let mut suns = Vec::new();
    let mut below = 0;
    let typed = &arguments.suns.direction;
    let north = arguments.suns.north.of_scene(scene);
    if !typed.is_empty() {
        north.report(summary);
    }
    for (number, direction) in (1..).zip(typed) {
        let [azimuth, elevation] = direction.0;
        let column = if typed.len() == 1 { "lit".to_owned() } else { format!("lit_{number}") };
        let title = format!("Shadow, sun at azimuth {azimuth}, elevation {elevation} degrees");
        below += usize::from(elevation <= 0.0);
        suns.push(Sun {
            sun: ShadowSun::at(azimuth.to_radians() - north.of_grid, elevation.to_radians()),
            column,
            title,
        });
    }
    if typed.is_empty() {
        let site = arguments.sun.site(scene, summary)?;
        let mut times: Vec<&str> = arguments.suns.time.iter().map(String::as_str).collect();
        times.extend(arguments.when.times());
        let zone = arguments.sun.zone(&site, &times)?;
        let refraction = arguments.sun.refraction()?;
        let instants = instants(arguments, &site, &zone)?;
        for &instant in &instants {
            let position = flagged("--time", sun_position_with(&site, instant, refraction))?;
            let column = if instants.len() == 1 { "lit".to_owned() } else { format!("lit_{}", moment(&zone, instant)) };
            below += usize::from(position.elevation <= 0.0);
            if instants.len() <= MOST_TOLD {
                section.add(&zone.display(instant), told(&position));
            }
            let season = zone.date_at(instant).ok().map(|date| Season::on(date, &site));
            let title = format!("Shadow, {}", zone.display(instant));
            suns.push(Sun { sun: ShadowSun { to_sun: position.to_sun(&site), season }, column, title });
        }
        section.add("time_zone", zone.name());
    }
    section.add("suns", suns.len());
    if below > 0 {
        section.add("suns_below_horizon", below);
    }
    summary.add("sun", section);
    Ok(suns)
}

/// The instants typed, or the middles of the steps of the days typed during which the sun is up.
fn instants(arguments: &Shadow, site: &Site, zone: &Zone) -> Result<Vec<f64>> {
    if !arguments.suns.time.is_empty() {
        return arguments.suns.time.iter().map(|time| arguments.sun.instant("--time", time)).collect();
    }
    let Some(period) = arguments.when.period(&arguments.sun, site, zone)? else {
        return Err(Usage("suns are missing: give --time, --date, --from and --to, or --sun".to_owned()).into());
    };
    let params = arguments.when.params(&arguments.sun)?;
    let days = flagged("--time-step-min, --min-sun-elevation or --from", sun_days(site, zone, &period, &params))?;
    let steps: Vec<f64> =
        days.iter().flat_map(|day| &day.steps).map(|step| f64::midpoint(step.start, step.end)).collect();
    if steps.is_empty() {
        let from_horizon = sun_days(site, zone, &period, &params.with_least_elevation(0.0))?;
        let rises = from_horizon.iter().any(|day| !day.steps.is_empty());
        let least = params.least_elevation.to_degrees();
        return Err(Usage(if rises {
            format!("--min-sun-elevation: the sun stays below {least} degrees there in this period")
        } else {
            "the sun does not rise there in this period".to_owned()
        })
        .into());
    }
    Ok(steps)
}

/// Azimuth and elevation for people.
fn told(position: &SunPosition) -> Summary {
    let mut section = Summary::default();
    section
        .add("azimuth_deg", rounded(position.azimuth.to_degrees(), 4))
        .add("elevation_deg", rounded(position.elevation.to_degrees(), 4));
    section
}

/// An instant in names: its date and time by the clocks of the zone.
pub(super) fn moment(zone: &Zone, instant: f64) -> String {
    let text: String = zone.display(instant).chars().filter(|c| c.is_ascii_digit() || matches!(c, 'T' | ' ')).collect();
    text.replace(['T', ' '], "_").chars().take(15).collect()
}

/// Whether places see parts of the sun: said of all frames alike, so that they are of one size.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Legend {
    WithParts,
    WithoutParts,
}

/// A map of the shadow of one sun.
fn frame(
    sun: &Sun,
    lit: &[f32],
    doubts: Option<&[f32]>,
    legend: Legend,
    relief: &Relief,
) -> belvedere::Result<Picture> {
    let color = |(row, &share): (usize, &f32)| match share {
        _ if doubts.and_then(|doubts| doubts.get(row)).is_some_and(|&doubt| doubt > 0.0) => Some(UNPROVEN_COLOR),
        share if share.is_finite() => {
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between two colours")]
            let mixed =
                |i: usize| (f32::from(SHADE_COLOR[i]) * (1.0 - share) + f32::from(LIT_COLOR[i]) * share).round() as u8;
            Some(std::array::from_fn(mixed))
        }
        _ => None,
    };
    let colors: Vec<Option<[u8; 3]>> = lit.iter().enumerate().map(color).collect();
    let mut meanings = vec![(LIT_COLOR, "lit"), (SHADE_COLOR, "in shadow")];
    if legend == Legend::WithParts {
        meanings.insert(1, (HALF_COLOR, "in part"));
    }
    if doubts.is_some() {
        meanings.push((UNPROVEN_COLOR, "lit, unproven"));
    }
    let Relief { heights, cell, place } = relief;
    map_picture(&MapPicture::of_colors(heights, *cell, Some(place), &colors, &sun.title, MapLegend::Colors(&meanings)))
}

/// Draws the shadow of the sun of that number over a relief.
type Drawing<'a> = dyn Fn(usize, &Relief) -> belvedere::Result<Picture> + 'a;

/// Writes a picture of each sun, after each other or apart.
fn films(arguments: &Shadow, asked: &Asked, suns: &[Sun], picture: &Drawing<'_>, run: &mut Run) -> Result<()> {
    let Some(relief) = asked.relief() else { return Ok(()) };
    if let Some(folder) = &arguments.frames {
        atomic::make_folder(folder)?;
        for (number, sun) in suns.iter().enumerate() {
            let picture = picture(number, &relief)?;
            run.stage("writing", 0, |_| write_png(&folder.join(format!("{}.png", sun.column)), &picture))?;
        }
    }
    if let Some(film) = &arguments.film {
        let frames: belvedere::Result<Vec<Picture>> = (0..suns.len()).map(|number| picture(number, &relief)).collect();
        run.stage("writing film", 0, |_| write_apng(film, &frames?, arguments.seconds))?;
    }
    Ok(())
}
