//! The tiles of a survey around a place.

use std::path::Path;

use serde::Serialize;

use super::index::{ListPage, SurveyTile};
use super::table::{OpenSurvey, SurveyArea, TileIndex};
use crate::files::remote;
use crate::files::secrets::hidden;
use belvedere_data::control::Control;
use belvedere_data::crs::{Crs, GeographicProjection};
use belvedere_data::parameter::Parameter;
use belvedere_data::{Error, Result};

/// Maximum number of pages of a list, and of tiles: an area of a few kilometres has far fewer, and services err.
const MAX_PAGES: usize = 20;
const MAX_TILES: usize = 1000;
/// Places of a box a side at which tiles are looked for.
const PLACES: usize = 32;
/// Share of a tile from which newer tiles cover it.
const COVERED: f64 = 0.9;
/// Minimum share of an area whose tiles count as all of it, percent: boxes of tiles in degrees are rounded.
const WHOLE_PERCENT: f64 = 99.0;

/// A survey that may cover a place.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FoundSurvey {
    /// The survey.
    #[serde(flatten)]
    pub survey: OpenSurvey,
    /// Its tiles in the area; none where people choose them on its page.
    pub tiles: Vec<SurveyTile>,
    /// Share of the area that they cover, percent.
    pub covered_percent: f64,
    /// Reason why its tiles are not known, and advice.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub failure: Option<String>,
}

/// The tiles of `surveys` in `area`. Surveys without tiles there are left out.
///
/// # Errors
/// [`Error::Cancelled`].
pub fn find_surveys(surveys: &[OpenSurvey], area: &SurveyArea, control: &Control<'_>) -> Result<Vec<FoundSurvey>> {
    control.stage("asking for tiles", surveys.len(), || {
        let mut found = Vec::new();
        for survey in surveys {
            let own = match find_tiles(survey, area, control) {
                Err(Error::Cancelled) => return Err(Error::Cancelled),
                Err(error) => FoundSurvey { failure: Some(error.to_string()), ..FoundSurvey::without_tiles(survey) },
                Ok(own) => own,
            };
            if survey.index == TileIndex::Page || own.failure.is_some() || !own.tiles.is_empty() {
                found.push(own);
            }
            control.advance(1);
        }
        Ok(found)
    })
}

/// The surveys of a table that may cover `area`: all, or the one that is named.
///
/// # Errors
/// [`Error::InvalidParameter`] for names that the table does not have, and places that no survey may cover.
pub fn surveys_at(mut surveys: Vec<OpenSurvey>, name: Option<&str>, area: &SurveyArea) -> Result<Vec<OpenSurvey>> {
    if let Some(name) = name {
        let names: Vec<String> = surveys.iter().map(|survey| survey.name.clone()).collect();
        surveys.retain(|survey| survey.name == name);
        if surveys.is_empty() {
            let value = format!("{name:?}, which is none of {}", names.join(", "));
            return Err(Error::invalid(Parameter::OpenSurvey, value, "a survey of the table"));
        }
    }
    surveys.retain(|survey| survey.may_cover(area));
    if surveys.is_empty() {
        let [latitude, longitude] = area.middle_deg();
        if let Some(name) = name {
            return Err(Error::invalid(
                Parameter::OpenSurvey,
                format!("{name}, which does not cover {latitude}, {longitude}"),
                "one that covers the place (latitude first), or left out",
            ));
        }
        return Err(Error::invalid(
            Parameter::SurveyPlace,
            format!("{latitude}, {longitude}, where no survey of the table lies"),
            "in a survey of the table, latitude first; https://portal.opentopography.org/datasets lists others",
        ));
    }
    Ok(surveys)
}

/// The survey to take points of: the first that covers the whole area, else the one that covers the largest share.
///
/// # Errors
/// [`Error::NoSurvey`] where none has tiles, with what each lacks.
pub fn best_covering(found: &[FoundSurvey]) -> Result<&FoundSurvey> {
    let ready = || found.iter().filter(|found| !found.tiles.is_empty());
    let first = ready().find(|found| found.is_whole());
    // the first of those that cover as much
    let best = first.or_else(|| ready().rev().max_by(|a, b| a.covered_percent.total_cmp(&b.covered_percent)));
    if let Some(best) = best {
        return Ok(best);
    }
    let reason = |found: &FoundSurvey| match &found.failure {
        Some(failure) => format!("{}: {failure}", found.survey.title),
        None => format!("{}: choose tiles on {}", found.survey.title, found.survey.page),
    };
    let reasons: Vec<String> = found.iter().map(reason).collect();
    let what = if reasons.is_empty() { "no survey has a tile there".to_owned() } else { reasons.join("; ") };
    Err(Error::NoSurvey { what })
}

impl FoundSurvey {
    fn without_tiles(survey: &OpenSurvey) -> Self {
        Self { survey: survey.clone(), tiles: Vec::new(), covered_percent: 0.0, failure: None }
    }

    /// A warning where the tiles cover a part of the area only.
    #[must_use]
    pub fn part_in_words(&self) -> Option<String> {
        let text = format!(
            "tiles of {} cover {:.0} % of the square: what stands in the rest is unknown; look whether another survey \
             covers more",
            self.survey.title, self.covered_percent
        );
        (!self.is_whole()).then_some(text)
    }

    /// A warning where the service was not reached.
    #[must_use]
    pub fn failure_in_words(&self) -> Option<String> {
        let failure = self.failure.as_ref()?;
        Some(format!("{} was not reached, and may have points there: {failure}", self.survey.title))
    }

    /// True if the tiles cover all of the area, but for its outermost metres.
    #[must_use]
    pub fn is_whole(&self) -> bool {
        self.covered_percent >= WHOLE_PERCENT
    }
}

/// The tiles of a survey in `area`: where several have the same place, the newest.
///
/// # Errors
/// [`Error::Io`] where the service is not reached, [`Error::Malformed`] where its answer is no list of tiles,
/// [`Error::InvalidParameter`] for places beyond the reference system of the survey, and [`Error::Cancelled`].
pub fn find_tiles(survey: &OpenSurvey, area: &SurveyArea, control: &Control<'_>) -> Result<FoundSurvey> {
    let (tiles, covered) = match &survey.index {
        TileIndex::Squares { side_m, address } => {
            squares_in(&box_in_crs(survey, area)?, *side_m, |corner| filled_corner(address, corner), control)?
        }
        TileIndex::List { address } => {
            let in_crs = address.contains("{x_min}");
            let area_box = if in_crs { box_in_crs(survey, area)? } else { area.box_deg() };
            newest_of(list_tiles(filled_box(address, &area_box), control)?, &area_box)
        }
        TileIndex::Page => (Vec::new(), 0.0),
    };
    let covered_percent = (1e4 * covered).round() / 100.0;
    Ok(FoundSurvey { tiles, covered_percent, ..FoundSurvey::without_tiles(survey) })
}

/// Lowest and highest x and y of `area` in the system of `survey`, metres.
fn box_in_crs(survey: &OpenSurvey, area: &SurveyArea) -> Result<[f64; 4]> {
    let crs = Crs::parse(survey.crs.as_deref().unwrap_or_default())?;
    let [x, y] = middle_in(&crs.geographic_projection()?, area)?;
    let radius = area.radius_m();
    Ok([x - radius, y - radius, x + radius, y + radius])
}

/// The middle of `area` in a projection, metres.
pub(super) fn middle_in(projection: &GeographicProjection, area: &SurveyArea) -> Result<[f64; 2]> {
    let [latitude, longitude] = area.middle_deg().map(f64::to_radians);
    projection.project(latitude, longitude)
}

/// The files of the squares that meet a box, of which servers say that they exist, and the share of it that they cover.
fn squares_in(
    &[x_min, y_min, x_max, y_max]: &[f64; 4],
    side: f64,
    address_of: impl Fn([f64; 2]) -> String,
    control: &Control<'_>,
) -> Result<(Vec<SurveyTile>, f64)> {
    let corners = |low: f64, high: f64| {
        let first = (low / side).floor() * side;
        std::iter::successors(Some(first), move |corner| Some(corner + side)).take_while(move |&corner| corner <= high)
    };
    let count = corners(x_min, x_max).take(MAX_TILES).count() * corners(y_min, y_max).take(MAX_TILES).count();
    if count > MAX_TILES {
        let what = format!("has squares of {side} m, more than {MAX_TILES} of them in the area: take a smaller radius");
        return Err(Error::malformed(&hidden(Path::new(&address_of([x_min, y_min]))), what));
    }
    let width = |corner: f64, low: f64, high: f64| (high.min(corner + side) - low.max(corner)) / (high - low);
    let (mut tiles, mut covered) = (Vec::new(), 0.0);
    for y in corners(y_min, y_max) {
        for x in corners(x_min, x_max) {
            control.check()?;
            let address = address_of([x, y]);
            let file = remote::find(&address).map_err(Error::io(&hidden(Path::new(&address))))?;
            if let Some(file) = file {
                covered += width(x, x_min, x_max) * width(y, y_min, y_max);
                tiles.push(SurveyTile { address, bytes: file.bytes, date: None });
            }
        }
    }
    Ok((tiles, covered))
}

/// The address of the square with a south-west corner, metres.
fn filled_corner(address: &str, [x, y]: [f64; 2]) -> String {
    let filled = address.replace("{x_m}", &format!("{x:06.0}")).replace("{y_m}", &format!("{y:06.0}"));
    filled.replace("{x_km}", &format!("{:.0}", x / 1000.0)).replace("{y_km}", &format!("{:.0}", y / 1000.0))
}

/// The address of the list of a box, in degrees or metres.
fn filled_box(address: &str, area_box: &[f64; 4]) -> String {
    let names = [["{west}", "{x_min}"], ["{south}", "{y_min}"], ["{east}", "{x_max}"], ["{north}", "{y_max}"]];
    let mut filled = address.to_owned();
    for ([in_degrees, in_metres], value) in names.into_iter().zip(area_box) {
        filled = filled.replace(in_degrees, &format!("{value:.6}")).replace(in_metres, &format!("{value:.1}"));
    }
    filled
}

/// All tiles of a list, page by page.
fn list_tiles(address: String, control: &Control<'_>) -> Result<Vec<(SurveyTile, Option<[f64; 4]>)>> {
    let (mut tiles, mut next, mut row_count) = (Vec::new(), Some(address), 0);
    for _ in 0..MAX_PAGES {
        let Some(address) = next.take() else { break };
        control.check()?;
        let path = &hidden(Path::new(&address));
        let text = remote::text(&address).map_err(Error::io(path))?;
        let page = ListPage::parse(&text).map_err(|what| Error::malformed(path, what))?;
        tiles.extend(page.tiles);
        row_count += page.row_count;
        next = page.next.filter(|next| *next != address);
        let is_cut = next.is_none() && page.total.is_some_and(|total| total > row_count);
        if tiles.len() > MAX_TILES || is_cut {
            let what = format!("lists {row_count} rows, and not all that there are: take a smaller radius");
            return Err(Error::malformed(path, what));
        }
    }
    match next {
        Some(address) => {
            let what = format!("has more than {MAX_PAGES} pages: take a smaller radius");
            Err(Error::malformed(&hidden(Path::new(&address)), what))
        }
        None => Ok(tiles),
    }
}

/// The tiles that meet the area, without those that newer ones cover; and the share of the area that they cover, as far
/// as boxes tell.
///
/// Surveys of several years in one cloud would contradict each other. Boxes in degrees reach beyond the squares of
/// their tiles, so that neighbours of one survey overlap: these stay.
fn newest_of(mut tiles: Vec<(SurveyTile, Option<[f64; 4]>)>, area_box: &[f64; 4]) -> (Vec<SurveyTile>, f64) {
    // dates in ISO 8601 sort as texts do; names end with the year where there is no date
    tiles.sort_by(|(a, _), (b, _)| b.date.cmp(&a.date).then_with(|| b.address.cmp(&a.address)));
    tiles.dedup_by(|(a, _), (b, _)| a.address == b.address);
    let mut kept: Vec<(SurveyTile, Option<[f64; 4]>)> = Vec::new();
    for (tile, bounds) in tiles {
        let part = bounds.map(|bounds| common_part(&bounds, area_box));
        if part.is_some_and(|part| part.is_none()) {
            continue;
        }
        let covers = |other: &&(SurveyTile, Option<[f64; 4]>)| other.0.date > tile.date || other.1 == bounds;
        let newer: Vec<[f64; 4]> = kept.iter().filter(covers).filter_map(|(_, bounds)| *bounds).collect();
        let is_covered = part.flatten().is_some_and(|part| covered_share(&part, &newer) >= COVERED);
        if !is_covered {
            kept.push((tile, bounds));
        }
    }
    let boxes: Option<Vec<[f64; 4]>> = kept.iter().map(|(_, bounds)| *bounds).collect();
    let share = boxes.map_or(1.0, |boxes| covered_share(area_box, &boxes));
    (kept.into_iter().map(|(tile, _)| tile).collect(), share)
}

/// The part of a box that lies in another; `None` if they do not meet.
fn common_part(a: &[f64; 4], b: &[f64; 4]) -> Option<[f64; 4]> {
    let part = [a[0].max(b[0]), a[1].max(b[1]), a[2].min(b[2]), a[3].min(b[3])];
    (part[0] < part[2] && part[1] < part[3]).then_some(part)
}

/// The share of a box that others cover, at places of a grid.
fn covered_share(&[west, south, east, north]: &[f64; 4], others: &[[f64; 4]]) -> f64 {
    let place = |index: usize| (index as f64 + 0.5) / PLACES as f64;
    let is_covered = |number: &usize| {
        let x = west + (east - west) * place(number % PLACES);
        let y = south + (north - south) * place(number / PLACES);
        others.iter().any(|&[left, low, right, high]| (left..=right).contains(&x) && (low..=high).contains(&y))
    };
    (0..PLACES * PLACES).filter(is_covered).count() as f64 / (PLACES * PLACES) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tile(address: &str, date: Option<&str>) -> SurveyTile {
        SurveyTile { address: address.to_owned(), bytes: None, date: date.map(str::to_owned) }
    }

    #[test]
    fn newest_tiles_stay_and_older_ones_fill_what_they_leave_open() {
        let old = |name: &str, bounds| (tile(name, Some("2016-01-01")), Some(bounds));
        let new = |name: &str, bounds| (tile(name, Some("2024-01-01")), Some(bounds));
        let area = [0.0, 0.0, 2.0, 2.0];
        let names = |tiles| {
            let (kept, share) = newest_of(tiles, &area);
            let mut names: Vec<_> = kept.into_iter().map(|tile| tile.address).collect();
            names.sort();
            (names, share)
        };
        let (west, east) = ([-3.0, -3.0, 1.01, 5.0], [0.99, -3.0, 5.0, 5.0]);
        // neighbours overlap by a margin
        let (found, share) = names(vec![old("a", west), old("b", east), new("c", west), new("d", east)]);
        assert_eq!((found, share), (vec!["c".to_owned(), "d".to_owned()], 1.0));
        // the new survey ends in the area
        let (found, share) = names(vec![old("a", west), old("b", east), new("c", west)]);
        assert_eq!((found, share), (vec!["b".to_owned(), "c".to_owned()], 1.0));
        assert_eq!(names(vec![new("c", west)]).1, 0.5);
        // an old tile below a new one that covers a part of it
        assert_eq!(names(vec![old("a", [-3.0, -3.0, 5.0, 5.0]), new("c", west)]).0, ["a", "c"]);
        // neighbours of one date, of which the area has a narrow strip within the box of the other
        let (wide, strip) = ([-3.0, -3.0, 1.99, 5.0], [1.96, -3.0, 5.0, 5.0]);
        assert_eq!(names(vec![new("a", wide), new("b", strip)]).0, ["a", "b"]);
        assert_eq!(names(vec![new("a", [-3.0, -3.0, 2.0, 5.0]), new("b", strip)]).0, ["a", "b"]);
        // tiles beside the area, twice the same, and without a box
        let beside = new("e", [3.0, 3.0, 4.0, 4.0]);
        let (found, _) = names(vec![beside, new("c", west), new("c", west), new("b", west), (tile("f", None), None)]);
        assert_eq!(found, ["c", "f"]);
    }

    #[test]
    fn addresses_have_corners_and_boxes() {
        assert_eq!(filled_corner("a_{x_m}_{y_m}.laz", [85_000.0, 446_000.0]), "a_085000_446000.laz");
        assert_eq!(filled_corner("a_{x_km}_{y_km}.laz", [690_000.0, 5_334_000.0]), "a_690_5334.laz");
        let box_deg = [4.35, 52.0, 4.36, 52.01];
        assert_eq!(
            filled_box("a?b={west},{south},{east},{north}", &box_deg),
            "a?b=4.350000,52.000000,4.360000,52.010000"
        );
        assert_eq!(filled_box("{x_min} {y_max}", &[1.0, 2.0, 3.0, 4.04]), "1.0 4.0");
    }
}
