//! `belvedere shadow`.

use crate::arguments::{Global, ShadowArguments, refuse};
use crate::in_tiles::{TiledAnswers, TypedCells};
use crate::outputs::fading::{UNPROVEN_COLOR, fade, faded, mixed};
use crate::outputs::formats::{check_output, check_outputs, extension, warn_of_geojson};
use crate::outputs::targets::{HighestPoints, TargetOutput};
use crate::run::CommandContext;
use crate::summary::Summary;
use anyhow::Result;
use belvedere::apps::ask::{self, Answers, CASTER, NamedSun, ShadowResults, Suns, UNCERTAIN, UNPROVEN, caster_name};
use belvedere::apps::shadow::{Edges, HALF_LIGHT};
use belvedere::apps::targets::{Measure, Targets};
use belvedere::figures::{MapLegend, MapPicture, Picture, map_picture, write_apng, write_png};
use belvedere::ground::MapGrid;
use belvedere::io::{PolygonArea, atomic, is_mesh, outlines, write_areas};
use belvedere::query::UnprovenAs;
use belvedere::raster::Raster;
use std::path::Path;

const SHADE_COLOR: [u8; 3] = [38, 52, 96];
const HALF_COLOR: [u8; 3] = [147, 136, 93];
const LIT_COLOR: [u8; 3] = [255, 220, 90];

pub(crate) fn run(arguments: &ShadowArguments, global: &Global) -> Result<Summary> {
    let question = question(arguments)?;
    check(arguments, &question)?;
    let mut run = CommandContext::new(global);
    let cells = TypedCells::of_sky(
        (&arguments.scene, &arguments.tiles),
        &arguments.places,
        question.trees,
        &arguments.outputs,
        &[("--shell", arguments.giving_way.shell.is_some()), ("--casters", arguments.casters)],
    );
    let write_tiled = |tiled: &TiledAnswers, run: &mut CommandContext| {
        let maps = Maps::new(&tiled.answers.found.suns, &tiled.answers.measures);
        write(arguments, &tiled.shown(), &maps, &[], run)
    };
    if cells.answered(question.clone(), write_tiled, &mut run)? {
        return Ok(run.finish());
    }
    let places = (&arguments.places, arguments.giving_way.shell);
    let of_places = cells.scene_of_sky(question.clone(), places, &mut run)?;
    let scene = of_places.scene();
    let (places, source) = arguments.places.places(scene, &mut run)?;
    let answers = run.ask(scene, &question, &places)?;
    of_places.finish(&run)?;
    let shown = TargetOutput::new(&answers.found.on, source, scene);
    shown.write_edge_mask(arguments.places.edge_mask.as_deref(), &mut run)?;
    let meshes = scene.model().added().map(|added| added.names()).unwrap_or_default();
    write(arguments, &shown, &Maps::of(&answers), meshes, &mut run)?;
    Ok(run.finish())
}

/// Writes the light of suns on targets, their shadows as areas, and pictures of them. `meshes` are the names of added
/// ones.
fn write(
    arguments: &ShadowArguments,
    shown: &TargetOutput<'_>,
    maps: &Maps<'_>,
    meshes: &[String],
    run: &mut CommandContext,
) -> Result<()> {
    shown.write_with(&arguments.outputs, maps.all, &|relief| maps.draw(0, relief), run)?;
    let Some(ground) = shown.targets().ground() else { return Ok(()) };
    warn_of_other_suns(arguments, maps.suns.len(), run);
    if let Some(output) = &arguments.outlines {
        warn_of_geojson(std::slice::from_ref(output), &shown.targets().frame.crs, &mut run.summary);
        let casters: Vec<&Measure> = maps.all.iter().filter(|one| one.name.starts_with(CASTER)).collect();
        let shapes = ShadowShapes { suns: maps.measures, casters: &casters, meshes };
        run.stage("writing", 0, |_| shapes.write(output, (&ground.grid, shown.targets())))?;
    }
    films(arguments, shown, maps, run)
}

/// Shadows of suns as areas.
struct ShadowShapes<'a> {
    /// The light of each sun.
    suns: &'a [Measure],
    /// The casters of the shadow of each sun; empty where they are not wanted.
    casters: &'a [&'a Measure],
    /// Names of added meshes.
    meshes: &'a [String],
}

impl ShadowShapes<'_> {
    /// Writes the shadow of each sun as an area, or that of each of its casters.
    fn write(&self, output: &Path, (grid, targets): (&MapGrid, &Targets)) -> belvedere::Result<()> {
        let mut areas = Vec::new();
        for (number, sun) in self.suns.iter().enumerate() {
            match self.casters.get(number) {
                None => areas.push(area_of(sun, None, (grid, targets), |row| sun.values[row] < HALF_LIGHT)?),
                Some(casters) => {
                    for caster in 1..=u8::MAX {
                        let is_of = |row: usize| casters.values[row] == f32::from(caster);
                        if (0..casters.values.len()).any(is_of) {
                            let name = caster_name(caster, self.meshes);
                            areas.push(area_of(sun, Some(name), (grid, targets), is_of)?);
                        }
                    }
                }
            }
        }
        write_areas(output, &areas, &targets.frame.crs)?;
        Ok(())
    }
}

/// The area of those cells that are `in_shadow` of a sun.
fn area_of(
    sun: &Measure,
    caster: Option<&str>,
    (grid, targets): (&MapGrid, &Targets),
    in_shadow: impl Fn(usize) -> bool,
) -> belvedere::Result<PolygonArea> {
    let origin = targets.frame.origin;
    let corner = |[column, row]: [usize; 2]| {
        let [east, south] = [column, row].map(|v| v as f64 * grid.cell);
        [origin[0] + grid.corner[0] + east, origin[1] + grid.corner[1] - south]
    };
    let shade = (0..sun.values.len()).map(in_shadow).collect();
    let polygons = outlines(&Raster::from_values(grid.width, grid.height, shade)?);
    let cells: usize = polygons.iter().map(|polygon| polygon.cell_count).sum();
    let mut area = PolygonArea::default();
    area.properties.insert("sun".to_owned(), sun.name.trim_start_matches("lit_").into());
    if let Some(caster) = caster {
        area.properties.insert("caster".to_owned(), caster.into());
    }
    area.properties.insert("area_m2".to_owned(), (cells as f64 * grid.cell * grid.cell).into());
    for (name, text) in &sun.tags {
        area.properties.insert(name.to_ascii_lowercase(), text.as_str().into());
    }
    area.polygons = polygons.iter().map(|polygon| polygon.rings(corner)).collect();
    Ok(area)
}

/// Warns of a map that shows one of several suns.
fn warn_of_other_suns(arguments: &ShadowArguments, count: usize, run: &mut CommandContext) {
    let map = arguments.outputs.output.iter().find(|output| extension(output) == "png");
    if let (Some(map), 2.., None, None) = (map, count, &arguments.film, &arguments.frames) {
        let map = map.display();
        run.summary.warn(
            "map-of-first-sun",
            format!("{map}: the map shows only the first of {count} suns; --film OUT shows them all"),
        );
    }
}

fn question(arguments: &ShadowArguments) -> Result<ask::ShadowQuestion> {
    let ShadowArguments { suns, when, sun, .. } = arguments;
    let chosen = match (&suns.direction[..], &suns.time[..]) {
        ([], []) => Suns::Days(when.days()),
        ([], times) => Suns::Times(times.to_vec()),
        (directions, _) => Suns::Directions(directions.iter().map(|direction| direction.0).collect()),
    };
    Ok(ask::ShadowQuestion {
        suns: chosen,
        place: sun.place(&suns.north)?,
        edges: if suns.soft { Edges::Soft } else { Edges::Hard },
        trees: arguments.trees.choice()?,
        unproven: arguments.giving_way.unproven.map(UnprovenAs::from),
        how_sure: arguments.how_sure.choice(),
        casters: arguments.casters,
    })
}

fn check(arguments: &ShadowArguments, question: &ask::ShadowQuestion) -> Result<()> {
    arguments.places.check(&arguments.outputs)?;
    if matches!(&question.suns, Suns::Days(days) if days.is_empty()) {
        return refuse("suns are missing: give --time TIME, --date DAY, --from and --to, or --sun AZ,EL");
    }
    ask::Ask::check(question)?;
    check_outputs("--film", &arguments.film, &["png", "apng"])?;
    if let Some(output) = &arguments.outlines {
        check_output("--outlines", output, &["geojson", "gpkg"])?;
    }
    if arguments.casters && arguments.places.places.targets.as_deref().is_some_and(is_mesh) {
        return refuse("--casters applies only to cells and points");
    }
    let needs_grid = arguments.film.is_some() || arguments.frames.is_some() || arguments.outlines.is_some();
    if needs_grid && !arguments.places.is_grid() {
        return refuse("--film, --frames and --outlines apply only to a grid");
    }
    Ok(())
}

/// A map of the shadow of each sun.
struct Maps<'a> {
    suns: &'a [NamedSun],
    measures: &'a [Measure],
    /// All measures, also those that follow.
    all: &'a [Measure],
    /// Unproven light of the one sun.
    doubts: Option<&'a [f32]>,
    /// Flags of the uncertain answers of each sun; empty if not wanted.
    uncertain: Vec<&'a [f32]>,
    /// True if places see parts of the sun; the same for all frames, so that they have one size.
    has_parts: bool,
}

impl<'a> Maps<'a> {
    fn of(answers: &'a Answers<ShadowResults>) -> Self {
        Self::new(&answers.found.suns, &answers.measures)
    }

    /// Splits measures into those of each sun and those that follow.
    fn new(suns: &'a [NamedSun], all: &'a [Measure]) -> Self {
        let (measures, rest) = all.split_at(suns.len().min(all.len()));
        let doubts = rest.iter().find(|measure| measure.name == UNPROVEN).map(|measure| &measure.values[..]);
        let uncertain = rest.iter().filter(|measure| measure.name.starts_with(UNCERTAIN));
        let uncertain = uncertain.map(|measure| &measure.values[..]).collect();
        let mut shares = measures.iter().flat_map(|measure| &measure.values);
        let has_parts = shares.any(|&share| share > 0.0 && share < 1.0);
        Self { suns, measures, all, doubts, uncertain, has_parts }
    }

    /// The map of the sun of that number.
    fn draw(&self, number: usize, relief: &HighestPoints) -> belvedere::Result<Picture> {
        let doubts = self.doubts.filter(|_| number == 0);
        let color = |(row, &share): (usize, &f32)| match share {
            _ if doubts.and_then(|doubts| doubts.get(row)).is_some_and(|&doubt| doubt > 0.0) => Some(UNPROVEN_COLOR),
            share if share.is_finite() => Some(mixed(SHADE_COLOR, LIT_COLOR.map(f32::from), share)),
            _ => None,
        };
        let lit = self.measures.get(number).map_or(&[][..], |measure| &measure.values[..]);
        let mut colors: Vec<Option<[u8; 3]>> = lit.iter().enumerate().map(color).collect();
        let mut meanings = vec![(LIT_COLOR, "lit"), (SHADE_COLOR, "in shadow")];
        if self.has_parts {
            meanings.insert(1, (HALF_COLOR, "in part"));
        }
        if doubts.is_some() {
            meanings.push((UNPROVEN_COLOR, "lit, unproven"));
        }
        if let Some(uncertain) = self.uncertain.get(number) {
            fade(&mut colors, uncertain);
            meanings.extend([(faded(LIT_COLOR), "lit, uncertain"), (faded(SHADE_COLOR), "in shadow, uncertain")]);
        }
        let title = self.suns.get(number).map_or("", |sun| &sun.title);
        let HighestPoints { heights, cell, place } = relief;
        map_picture(&MapPicture::of_colors(heights, *cell, Some(place), &colors, title, MapLegend::Colors(&meanings)))
    }
}

/// Writes a picture of each sun, after each other or apart.
fn films(
    arguments: &ShadowArguments,
    shown: &TargetOutput<'_>,
    maps: &Maps<'_>,
    run: &mut CommandContext,
) -> Result<()> {
    if arguments.frames.is_none() && arguments.film.is_none() {
        return Ok(());
    }
    let Some(relief) = shown.relief(run)? else { return Ok(()) };
    if let Some(folder) = &arguments.frames {
        atomic::make_folder(folder)?;
        for (number, sun) in maps.suns.iter().enumerate() {
            let picture = maps.draw(number, &relief)?;
            run.stage("writing", 0, |_| write_png(&folder.join(format!("{}.png", sun.column)), &picture))?;
        }
    }
    if let Some(film) = &arguments.film {
        let frames: belvedere::Result<Vec<Picture>> =
            (0..maps.suns.len()).map(|number| maps.draw(number, &relief)).collect();
        run.stage("writing film", 0, |_| write_apng(film, &frames?, arguments.seconds))?;
        run.summary.add("film_written", film.display().to_string());
    }
    Ok(())
}
