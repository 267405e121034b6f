//! Single places: where they lie if no height is given, and what was found there in a sentence each.

use super::observers::{Reach, Standing};
use super::places::cells_of;
use super::scene::Scene;
use super::shadow::{CASTER, UNPROVEN, caster_name};
use super::{Context, Remark};
use crate::shadow::LIT;
use crate::sum_errors::INTERVAL_MEASURES;
use crate::targets::{CellLevel, CellParams, Measure, Targets, grid_around, set_on_terrain};
use belvedere_core::ground::{Ground, GroundPoints};
use belvedere_data::control::Control;
use belvedere_data::crs::Crs;
use belvedere_data::report::{clock_time, rounded};
use belvedere_data::{Bounds, Error, Frame, Parameter, Result};
use serde::Serialize;

/// Places that have a sentence of their own.
const MAX_SENTENCES: usize = 5;
/// Figures of a sentence.
const MAX_FIGURES: usize = 5;
/// Maximum distance of a place from the box of the points, metres: that of targets of a scene.
const MARGIN: f64 = 1.0;

/// Maximum distance of an end of lines of sight from that box, metres: mountains on the horizon.
const END_MARGIN: f64 = 200e3;
/// Advice for degrees in the wrong order.
const SWAPPED: &str = "latitude before longitude: these are swapped";

/// A single place of a question.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PlaceSection {
    /// Position in the coordinates of the file; the height is NaN where none is known.
    pub position: [f64; 3],
    /// Source of the height.
    pub height_from: HeightFrom,
}

/// Source of the height of a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum HeightFrom {
    /// It was given.
    Given,
    /// The ground below.
    Ground,
    /// The roof, or another cover of the ground, below.
    Cover,
}

/// Coordinates of the file of a place that is given in them, or as latitude and longitude in degrees. `bounds` are the
/// south-west and north-east corner of the points, in the coordinates of the file.
///
/// # Errors
/// [`Error::InvalidParameter`] for a place beside the points, and those of [`Crs::geographic_projection`] for degrees.
pub fn position_on_map(given: [f64; 2], crs: &Crs, bounds: [[f64; 2]; 2]) -> Result<[f64; 2]> {
    let is_inside = |place: &[f64; 2]| is_within(*place, bounds, MARGIN / crs.metres_per_unit);
    if is_inside(&given) {
        return Ok(given);
    }
    let [latitude, longitude] = given;
    let mut way_out = "on the points of the cloud";
    if are_degrees(given) {
        crs.geographic_projection()?;
        if let Some(place) = projected(given, crs).filter(is_inside) {
            return Ok(place);
        }
        way_out = match projected([longitude, latitude], crs).filter(is_inside) {
            Some(_) => SWAPPED,
            None => {
                "on the points of the cloud, as latitude and longitude in degrees, or in the coordinates of the file"
            }
        };
    }
    let [[west, south], [east, north]] = bounds;
    Err(Error::InvalidParameter {
        parameter: Parameter::Position,
        value: format!(
            "{}, {} (the points reach from {west:.0}, {south:.0} to {east:.0}, {north:.0})",
            given[0], given[1]
        ),
        expected: way_out,
    })
}

/// Coordinates of the file of an end of lines of sight that is given in them, or as latitude and longitude in degrees.
/// `bounds` as in [`position_on_map`]; ends may lie far beside the points.
///
/// # Errors
/// [`Error::InvalidParameter`] for longitude before latitude.
pub fn end_on_map(given: [f64; 2], crs: &Crs, bounds: [[f64; 2]; 2]) -> Result<[f64; 2]> {
    let is_near = |place: &[f64; 2]| is_within(*place, bounds, END_MARGIN / crs.metres_per_unit);
    if is_near(&given) || !are_degrees(given) {
        return Ok(given);
    }
    if let Some(place) = projected(given, crs).filter(is_near) {
        return Ok(place);
    }
    let [latitude, longitude] = given;
    if projected([longitude, latitude], crs).is_some_and(|place| is_within(place, bounds, MARGIN / crs.metres_per_unit))
    {
        let value = format!("{latitude}, {longitude}");
        return Err(Error::InvalidParameter { parameter: Parameter::Position, value, expected: SWAPPED });
    }
    Ok(given)
}

/// Coordinates of the file of a latitude and longitude in degrees; `None` without a known projection.
fn projected([latitude, longitude]: [f64; 2], crs: &Crs) -> Option<[f64; 2]> {
    // a projection keeps the step between datums of its first place: each place has one of its own
    let projection = crs.geographic_projection().ok()?;
    let place = projection.project(latitude.to_radians(), longitude.to_radians()).ok()?;
    Some(place.map(|v| v / crs.metres_per_unit))
}

fn is_within(place: [f64; 2], [low, high]: [[f64; 2]; 2], margin: f64) -> bool {
    (0..2).all(|i| (low[i] - margin..=high[i] + margin).contains(&place[i]))
}

/// True for numbers that can be latitude and longitude in degrees.
fn are_degrees([latitude, longitude]: [f64; 2]) -> bool {
    latitude.abs() <= 90.0 && longitude.abs() <= 180.0
}

/// Returns places on the map, each with its height where that is known, as single places of a scene that stand `height`
/// metres above what is below. Lines of sight of this extent may begin beyond the cloud.
///
/// # Errors
/// Those of [`position_on_map`], and of places that lie beyond the terrain too.
pub fn standing_on_map(
    places: impl IntoIterator<Item = ([f64; 2], Option<f64>)>,
    height: Option<f64>,
    reach: Reach,
    scene: &Scene,
) -> Result<Vec<Standing>> {
    let frame = scene.frame();
    let bounds = bounds_in_file(frame, &scene.model().bounds());
    let one = |(place, given): ([f64; 2], Option<f64>)| {
        let on_cloud = position_on_map(place, &frame.crs, bounds);
        let [x, y] = if reach == Reach::Cloud { on_cloud? } else { on_cloud.or_else(|_| on_terrain(place, scene))? };
        Ok(Standing { place: frame.local_from_file([x, y, given.unwrap_or(f64::NAN)]), height })
    };
    places.into_iter().map(one).collect()
}

/// Coordinates of the file of a place on the terrain beyond the cloud, given as for [`position_on_map`].
fn on_terrain(given: [f64; 2], scene: &Scene) -> Result<[f64; 2]> {
    let frame = scene.frame();
    let terrain = scene.model().far_terrain().grid();
    let is_known = |[x, y]: &[f64; 2]| {
        let [x, y, _] = frame.local_from_file([*x, *y, 0.0]);
        terrain.is_some_and(|terrain| terrain.height_at([x, y]).is_some())
    };
    let [latitude, longitude] = given;
    let in_degrees = |degrees| if are_degrees(given) { projected(degrees, &frame.crs).filter(is_known) } else { None };
    if let Some(place) = Some(given).filter(is_known).or_else(|| in_degrees(given)) {
        return Ok(place);
    }
    let expected = match in_degrees([longitude, latitude]) {
        Some(_) => SWAPPED,
        None => "on the points of the cloud, or on the terrain beyond it",
    };
    let value = format!("{latitude}, {longitude}");
    Err(Error::InvalidParameter { parameter: Parameter::Position, value, expected })
}

impl Standing {
    /// Creates an end of lines of sight at a place on the map, of coordinates of the file or of degrees
    /// ([`end_on_map`]), with its height where that is known. `bounds` are those of the points, local metres.
    ///
    /// # Errors
    /// Those of [`end_on_map`].
    pub fn on_map(place: [f64; 2], height: Option<f64>, frame: &Frame, bounds: &Bounds) -> Result<Self> {
        let [x, y] = end_on_map(place, &frame.crs, bounds_in_file(frame, bounds))?;
        Ok(Self { place: frame.local_from_file([x, y, height.unwrap_or(f64::NAN)]), height: None })
    }
}

/// South-west and north-east corner of points, in the coordinates of the file.
fn bounds_in_file(frame: &Frame, bounds: &Bounds) -> [[f64; 2]; 2] {
    let (low, high) = bounds.on_map();
    [low, high].map(|[x, y]| {
        let [x, y, _] = frame.file_from_local([x, y, 0.0]);
        [x, y]
    })
}

/// Local metres of `places`. One without a height lies above the ground, or above what covers the ground there.
pub(super) fn positions(
    places: &[Standing],
    points: GroundPoints,
    scene: &Scene,
    context: &mut Context,
    control: &Control<'_>,
) -> Result<Vec<[f32; 3]>> {
    let mut positions: Vec<[f64; 3]> = places.iter().map(|place| place.place).collect();
    let mut sources = vec![HeightFrom::Given; places.len()];
    let coverage = scene.model().coverage();
    // ground is made where there are points: one place far away would make its cells large for all
    let is_over = |place: &[f64; 3]| coverage.is_none_or(|coverage| coverage.holds_on_map(*place));
    if let Some(grid) = grid_around(positions.iter().copied().filter(is_over), scene.frame().origin)? {
        let known = scene.ground(grid, points, control)?;
        context.ground(scene, &known);
        let usual = CellParams::default().with_height(0.0);
        // what cells leave out is no matter of single places
        let cells = |level| {
            let params = usual.with_level(level);
            cells_of(scene, known.ground.clone(), &params, &mut Context::default(), control)
        };
        let open = cells(CellLevel::Ground)?;
        let mut covers: Option<Targets> = None;
        for ((position, source), place) in positions.iter_mut().zip(&mut sources).zip(places) {
            if !position[2].is_nan() || !is_over(position) {
                continue;
            }
            let above = place.height.unwrap_or(CellParams::default().height);
            let on_map = [position[0], position[1]];
            if height_of_cell(&open, &known.ground, on_map).is_some() {
                *source = HeightFrom::Ground;
                position[2] = known.ground.height_at(on_map).unwrap_or(f64::NAN) + above;
                continue;
            }
            *source = HeightFrom::Cover;
            let covers = match &mut covers {
                Some(covers) => covers,
                none => none.insert(cells(CellLevel::Surface)?),
            };
            position[2] = height_of_cell(covers, &known.ground, on_map).map_or(f64::NAN, |height| height + above);
        }
    }
    let usual = CellParams::default().height;
    for ((position, source), place) in positions.iter_mut().zip(&mut sources).zip(places) {
        if position[2].is_nan() && !is_over(position) {
            *source = HeightFrom::Ground;
            set_on_terrain([(position, place.height.unwrap_or(usual))], scene.model());
        }
    }
    let unknown = positions.iter().filter(|position| position[2].is_nan()).count();
    context.add(Remark::of_share(
        "places-without-ground",
        unknown,
        positions.len(),
        "places",
        "have neither ground nor a roof below that is known: give their height as a third coordinate",
    ));
    let in_file = |position: &[f64; 3]| scene.frame().file_from_local(*position).map(|v| rounded(v, 3));
    context.report.at = positions
        .iter()
        .zip(sources)
        .map(|(position, height_from)| PlaceSection { position: in_file(position), height_from })
        .collect();
    #[expect(clippy::cast_possible_truncation, reason = "local metres")]
    Ok(positions.iter().map(|position| position.map(|v| v as f32)).collect())
}

/// Height of the cell at a position on the map; `None` for one that is no target.
fn height_of_cell(cells: &Targets, ground: &Ground, on_map: [f64; 2]) -> Option<f64> {
    let [column, row] = ground.grid.cell_of(on_map)?;
    let height = f64::from(cells.positions.get(row * ground.grid.width + column)?[2]);
    height.is_finite().then_some(height)
}

/// A sentence for each of few places.
pub(super) fn sentences(places: &[PlaceSection], measures: &[Measure]) -> Vec<String> {
    if places.len() > MAX_SENTENCES {
        return Vec::new();
    }
    places.iter().enumerate().map(|(row, place)| sentence(place, measures, row)).collect()
}

fn sentence(place: &PlaceSection, measures: &[Measure], row: usize) -> String {
    let [x, y, z] = place.position;
    let on = match place.height_from {
        HeightFrom::Given => "",
        HeightFrom::Ground => ", on the ground",
        HeightFrom::Cover => ", on what stands there",
    };
    let value = |measure: &Measure| measure.values.get(row).copied().map(f64::from).filter(|value| value.is_finite());
    let named = |name: &str| measures.iter().find(|measure| measure.name == name).and_then(value);
    if let (Some(metres), Some(share)) = (named("metres"), named("share")) {
        let mut text = format!("{metres:.0} visible metres of towers ({:.1} %)", 100.0 * share);
        if metres > 0.0 {
            for (name, what) in [("towers", "towers with a visible part"), ("tips", "tips"), ("hubs", "hubs")] {
                text += &named(name).map_or(String::new(), |count| format!(", {what}: {count:.0}"));
            }
            if let (Some(angle), Some(nearest)) = (named("angle_deg"), named("nearest_m")) {
                text += &format!(", up to {angle:.2}° high, the nearest {nearest:.0} m away");
            }
        }
        let unproven =
            if named(UNPROVEN) == Some(1.0) { "; no pulse proves that the largest part is visible" } else { "" };
        return format!("at {x:.1}, {y:.1} (height {z:.1}{on}): {text}{unproven}");
    }
    let found = match (named("sun_hours"), named("hours_low"), named("hours_high")) {
        (Some(hours), low, high) => {
            let mut text = format!("{hours:.1} h of sun a day");
            if let (Some(low), Some(high)) = (low, high) {
                text += &format!(", with 90 % {low:.1} to {high:.1} h");
            }
            for (name, what) in [("first_light", "first"), ("last_light", "last")] {
                if let Some(hour) = named(name) {
                    text += &format!(", {what} {}", clock_time(hour));
                }
            }
            for measure in measures.iter().filter(|measure| measure.description == crate::sun_hours::RULE_IS_MET) {
                let is_met = value(measure).is_some_and(|met| met > 0.5);
                text += &format!(", {}: {}", measure.name, if is_met { "met" } else { "not met" });
            }
            text
        }
        _ => {
            let of_suns: Vec<(&Measure, f64)> = measures
                .iter()
                .filter(|measure| measure.description == LIT)
                .filter_map(|measure| Some((measure, value(measure)?)))
                .collect();
            let has_several_suns = of_suns.len() > 1;
            let is_end =
                |measure: &Measure| INTERVAL_MEASURES[1..].iter().any(|(_, text)| *text == measure.description);
            let ends: Vec<String> = measures
                .iter()
                .filter(|measure| is_end(measure))
                .filter_map(|end| Some(format!("{:.*}", end.decimals.min(3), value(end)?)))
                .collect();
            let others =
                measures.iter().filter(|measure| !(is_end(measure) || has_several_suns && measure.description == LIT));
            let words = others.filter_map(|measure| Some(figure(measure, value(measure)?)));
            let light = has_several_suns.then(|| light_of_suns(&of_suns));
            let figures = light.into_iter().chain(words).filter(|text| !text.is_empty());
            let interval = <[String; 2]>::try_from(ends).ok().map(|[low, high]| format!("with 90 % {low} to {high}"));
            let figures: Vec<String> = figures.take(MAX_FIGURES).chain(interval).collect();
            if figures.is_empty() { "no answer".to_owned() } else { figures.join(", ") }
        }
    };
    format!("at {x:.1}, {y:.1} (height {z:.1}{on}): {found}")
}

/// Light of several suns in their order: equal ones together, from the first to the last time.
fn light_of_suns(suns: &[(&Measure, f64)]) -> String {
    let mut stretches: Vec<(String, [String; 2])> = Vec::new();
    let mut date = String::new();
    for (measure, value) in suns {
        let time =
            measure.tags.iter().find(|(name, _)| name == "TIME").and_then(|(_, time)| time.get(..16)?.split_once('T'));
        let label = match time {
            Some((day, clock)) if day == date => clock.to_owned(),
            Some((day, clock)) => {
                day.clone_into(&mut date);
                format!("{day} {clock}")
            }
            None => measure.name.clone(),
        };
        let words = light_in_words(*value);
        match stretches.last_mut() {
            Some((same, [_, last])) if *same == words => *last = label,
            _ => stretches.push((words, [label.clone(), label])),
        }
    }
    let in_words = |(words, [first, last]): &(String, [String; 2])| match first == last {
        true => format!("{first} {words}"),
        false => format!("{first} to {last} {words}"),
    };
    stretches.iter().map(in_words).collect::<Vec<_>>().join(", ")
}

fn light_in_words(share: f64) -> String {
    match share {
        0.0 => "in shadow".to_owned(),
        1.0 => "lit".to_owned(),
        share => format!("{:.0} % of the sun", 100.0 * share),
    }
}

/// A measure in words; empty where it adds nothing.
fn figure(measure: &Measure, value: f64) -> String {
    if measure.name == UNPROVEN {
        return if value > 0.0 { "unproven".to_owned() } else { String::new() };
    }
    if measure.name.starts_with(CASTER) {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a number of a caster")]
        let number = value as u8;
        return if number == 0 { String::new() } else { format!("shaded by: {}", caster_name(number, &[])) };
    }
    if measure.description == LIT {
        return light_in_words(value);
    }
    let name = if measure.description.is_empty() { &measure.name } else { measure.description };
    format!("{name} {value:.*}", measure.decimals.min(3))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_of_lines_may_lie_beside_the_points_in_degrees_too() {
        let crs = Crs::parse("EPSG:28992").unwrap();
        let bounds = [[154_000.0, 462_000.0], [156_000.0, 464_000.0]];
        // the Dom tower of Utrecht, 20 km to the west
        let [x, y] = end_on_map([52.0907, 5.1214], &crs, bounds).unwrap();
        assert!((x - 136_800.0).abs() < 200.0 && (y - 455_900.0).abs() < 200.0, "{x} {y}");
        for given in [[136_800.0, 455_900.0], [-33.86, 151.2], [1.0, 2.0]] {
            assert_eq!(end_on_map(given, &crs, bounds).unwrap(), given);
        }
        assert!(end_on_map([5.387_2, 52.155_2], &crs, bounds).unwrap_err().to_string().contains("swapped"));
        // without a known system they are coordinates
        assert_eq!(end_on_map([52.0907, 5.1214], &Crs::default(), bounds).unwrap(), [52.0907, 5.1214]);
    }

    #[test]
    fn degrees_and_coordinates_name_the_same_place() {
        // the tower of Amersfoort, origin of the Dutch grid, in ETRS89 as its surveyors publish it; a Helmert
        // transformation is right to half a metre there
        let crs = Crs::parse("EPSG:28992").unwrap();
        let bounds = [[154_000.0, 462_000.0], [156_000.0, 464_000.0]];
        let by_degrees = position_on_map([52.155_174_40, 5.387_206_21], &crs, bounds).unwrap();
        assert!((by_degrees[0] - 155_000.0).abs() < 0.5 && (by_degrees[1] - 463_000.0).abs() < 0.5, "{by_degrees:?}");
        assert_eq!(position_on_map([155_100.0, 463_200.0], &crs, bounds).unwrap(), [155_100.0, 463_200.0]);
        for (wrong, is_swapped) in
            [([136_000.0, 455_000.0], false), ([5.387_2, 52.155_2], true), ([f64::NAN, 0.0], false)]
        {
            let error = position_on_map(wrong, &crs, bounds).unwrap_err().to_string();
            assert!(error.contains("154000, 462000"), "{error}");
            assert_eq!(error.contains("swapped"), is_swapped, "{error}");
        }
        // without a reference system, small coordinates are those of the file
        let unknown = Crs::default();
        assert_eq!(position_on_map([3.0, 4.0], &unknown, [[0.0; 2], [9.0; 2]]).unwrap(), [3.0, 4.0]);
        assert!(position_on_map([52.0, 4.0], &unknown, [[0.0; 2], [9.0; 2]]).is_err());
    }

    #[test]
    fn a_sentence_says_hours_with_their_interval_and_clocks() {
        let place = PlaceSection { position: [1.0, 2.0, 3.25], height_from: HeightFrom::Ground };
        let measures: Vec<Measure> = [
            ("sun_hours", 4.91),
            ("hours_low", 4.3),
            ("hours_high", 5.4),
            ("first_light", 9.669),
            ("last_light", 15.16),
        ]
        .map(|(name, value)| Measure::new(name, vec![value]))
        .into();
        assert_eq!(
            sentences(&[place], &measures),
            [
                "at 1.0, 2.0 (height 3.2, on the ground): 4.9 h of sun a day, with 90 % 4.3 to 5.4 h, first 09:40, last 15:10"
            ]
        );
        let sun = |clock: &str, lit: f32| {
            let tags = [("TIME".to_owned(), format!("2026-03-21T{clock}:00+01:00"))];
            Measure::new("lit", vec![lit]).with_description(LIT).with_tags(&tags)
        };
        let day = [sun("07:00", 0.0), sun("08:00", 1.0), sun("09:00", 1.0), sun("10:00", 0.25), sun("11:00", 0.0)];
        assert!(
            sentences(&[place], &day)[0]
                .ends_with(": 2026-03-21 07:00 in shadow, 08:00 to 09:00 lit, 10:00 25 % of the sun, 11:00 in shadow")
        );
        let sky = |name, description, value| Measure::new(name, vec![value]).with_description(description);
        let view = [
            sky("sky_view", "sky view factor", 0.5),
            sky("sky_low", INTERVAL_MEASURES[1].1, 0.25),
            sky("sky_high", INTERVAL_MEASURES[2].1, 0.75),
        ];
        let sentence = &sentences(&[place], &view)[0];
        assert!(sentence.contains("sky view factor 0.5") && sentence.contains(", with 90 % 0.25"), "{sentence}");
        let nothing = [Measure::new("sky", vec![f32::NAN])];
        assert!(sentences(&[place], &nothing)[0].ends_with("no answer"));
    }
}
