//! A period in parts of equal transmission of crowns, and the energy of places and planes over all of them.

use super::ClearSky;
use super::instants::{clear_instants, weather_instants};
use super::intervals::EnergyOutlines;
use super::irradiation::{Irradiation, irradiation_through_crowns};
use super::measures::{ENERGY_NAME, irradiation_measures};
use super::period::{Instant, IrradianceParams, PeriodRadiation, PeriodReport};
use crate::rows::{SkyObstacles, check_normals, fold_rows, normals_of};
use crate::sum_errors::{Intervals, SumKind, expected_measures};
use crate::sun::{Date, Site, Zone};
use crate::targets::{Measure, Targets};
use crate::tree_light::{CrownLight, Season};
use belvedere_data::control::Control;
use belvedere_data::weather::Weather;
use belvedere_data::{Error, Result};

/// Year of a clear sky where none is given; the sun's way differs by less than half a degree from year to year.
pub const CLEAR_SKY_YEAR: i16 = 2026;
/// Steps of a clear sky, seconds.
const CLEAR_STEP: f64 = 600.0;

/// Source of the radiation of a period.
#[derive(Clone, Copy, Debug)]
pub enum RadiationSource<'a> {
    /// Rows of weather, each cut into parts.
    Weather {
        /// The rows.
        weather: &'a Weather,
        /// Parts of each row; [`PARTS`](super::PARTS) is usual.
        parts: usize,
    },
    /// A year without clouds.
    ClearSky {
        /// Clear-sky model.
        clear_sky: ClearSky,
        /// The year.
        year: i16,
    },
}

/// Radiation of the days with the same transmissivity of crowns.
#[derive(Clone, Debug)]
pub struct SeasonRadiation {
    /// Radiation of the days.
    pub radiation: PeriodRadiation,
    /// [`CrownLight::factor`] of these days; 0 where trees are opaque.
    pub factor: f64,
}

/// A period in parts of equal transmission of crowns; one part where they let nothing through. The report is that of
/// all parts.
///
/// # Errors
/// Those of [`weather_instants`], [`clear_instants`] and [`PeriodRadiation::gather`], and [`Error::Cancelled`].
pub fn period_seasons(
    source: &RadiationSource<'_>,
    site: &Site,
    crowns: Option<CrownLight>,
    params: &IrradianceParams,
    control: &Control<'_>,
) -> Result<(Vec<SeasonRadiation>, PeriodReport)> {
    let mut seasons = Vec::new();
    let mut report = PeriodReport::default();
    for (share, instants) in &season_instants(source, site, crowns, control)? {
        control.check()?;
        let radiation = PeriodRadiation::gather(instants, params)?;
        report.add(&radiation.report);
        seasons.push(SeasonRadiation { radiation, factor: *share });
    }
    Ok((seasons, report))
}

/// Returns the instants of a period with the [`CrownLight::factor`] that they share, for each season.
///
/// # Errors
/// Those of [`weather_instants`] and [`clear_instants`], and [`Error::Cancelled`].
pub(super) fn season_instants(
    source: &RadiationSource<'_>,
    site: &Site,
    crowns: Option<CrownLight>,
    control: &Control<'_>,
) -> Result<Vec<(f64, Vec<Instant>)>> {
    let zone = Zone::mean_solar(site);
    let share = |date: Date| crowns.map_or(0.0, |crowns| crowns.factor(Some(Season::on(date, site))));
    let mut parts: Vec<(f64, Vec<Instant>)> = Vec::new();
    let mut put = |share: f64, instants: Vec<Instant>| match parts.iter_mut().find(|(own, _)| *own == share) {
        Some((_, part)) => part.extend(instants),
        None => parts.push((share, instants)),
    };
    match *source {
        RadiationSource::Weather { weather, parts } => {
            let by_share = match crowns {
                None => vec![(0.0, weather.clone())],
                Some(_) => split_weather(weather, |instant| Ok(share(zone.date_at(instant)?)))?,
            };
            for (share, weather) in by_share {
                control.check()?;
                put(share, weather_instants(&weather, site, parts)?);
            }
        }
        RadiationSource::ClearSky { clear_sky, year } => {
            for (share, span) in split_year(year, &zone, share)? {
                control.check()?;
                put(share, clear_instants(&clear_sky, site, span, CLEAR_STEP, &zone)?);
            }
        }
    }
    Ok(parts)
}

/// The rows of `weather`, those together whose instants have the same share; in the order in which shares come first.
fn split_weather(weather: &Weather, share: impl Fn(f64) -> Result<f64>) -> Result<Vec<(f64, Weather)>> {
    let mut parts: Vec<(f64, Weather)> = Vec::new();
    for step in &weather.steps {
        let share = share(step.instant)?;
        match parts.iter_mut().find(|(own, _)| *own == share) {
            Some((_, part)) => part.steps.push(*step),
            None => parts.push((share, Weather { steps: vec![*step], ..weather.clone() })),
        }
    }
    Ok(parts)
}

/// The days of a year from one change of their share to the next: share, begin and end.
fn split_year(year: i16, zone: &Zone, share: impl Fn(Date) -> f64) -> Result<Vec<(f64, [f64; 2])>> {
    let (first, last) = (Date::new(year, 1, 1)?, Date::new(year, 12, 31)?);
    let end = zone.instant_of(Date::new(year.saturating_add(1), 1, 1)?, 0.0)?;
    let mut spans: Vec<(f64, [f64; 2])> = Vec::new();
    for date in first.to(last) {
        let share = share(date);
        if spans.last().is_none_or(|(own, _)| *own != share) {
            let start = zone.instant_of(date, 0.0)?;
            if let Some((_, span)) = spans.last_mut() {
                span[1] = start;
            }
            spans.push((share, [start, end]));
        }
    }
    Ok(spans)
}

/// Energies of targets.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TargetEnergies {
    /// (M) rows of `group_count` sums each; NaN for a target without a position.
    pub sums: Vec<Irradiation>,
    /// Groups of the period, such as months: 1 or more.
    pub group_count: usize,
    /// Error classes; empty if not requested.
    pub classes: Vec<u8>,
}

impl TargetEnergies {
    /// All as measures: those of [`irradiation_measures`], and how far the energy may be from the truth.
    #[must_use]
    pub fn into_measures(self) -> Vec<Measure> {
        let mut measures = irradiation_measures(&self.sums, self.group_count);
        if let (Some(energy), false) = (measures.first().cloned(), self.classes.is_empty()) {
            let unshaded = |row: usize| {
                let groups = self.sums.chunks(self.group_count.max(1)).nth(row).unwrap_or_default();
                groups.iter().map(|group| group.unshaded).sum::<f64>()
            };
            measures.extend(expected_measures(ENERGY_NAME, &energy, unshaded, SumKind::Energy, &self.classes));
        }
        measures
    }
}

/// The energy of `targets` over all of `seasons` among `obstacles`. Progress counts targets, [`look_count`] times each.
///
/// # Errors
/// Those of [`fold_rows`] and [`irradiation_through_crowns`]; [`Error::NoPoints`] without any season.
pub fn season_irradiation<'a>(
    obstacles: impl Into<SkyObstacles<'a>>,
    targets: &Targets,
    seasons: &[SeasonRadiation],
    intervals: Intervals,
    control: &Control<'_>,
) -> Result<TargetEnergies> {
    let obstacles = obstacles.into();
    let normals = targets.normals.as_deref();
    check_normals(normals, targets.len())?;
    let group_count = group_count(seasons)?;
    let mut sums = vec![Irradiation::default(); targets.len() * group_count];
    let are_inside = intervals.are_inside(obstacles, targets, control)?;
    let mut classes = vec![0; if are_inside.is_some() { targets.len() } else { 0 }];
    for season in seasons {
        let outlines = are_inside.as_ref().map(|inside| (inside, EnergyOutlines::new(&season.radiation)));
        fold_rows(obstacles, &targets.positions, &season.radiation.directions(), control, |block| {
            if let Some((are_inside, outlines)) = &outlines {
                let of_block = classes.get_mut(block.rows.clone()).unwrap_or_default();
                let own = outlines.classes((&block, season.factor), are_inside, normals)?;
                of_block.iter_mut().zip(own).for_each(|(class, own)| *class = own.max(*class));
            }
            let normals = normals_of(normals, &block.rows);
            let own = irradiation_through_crowns(&block, normals, &season.radiation, season.factor)?;
            let rows = block.rows.start * group_count..block.rows.end * group_count;
            add(sums.get_mut(rows).unwrap_or_default(), &own);
            Ok(())
        })?;
    }
    for (_, sums) in sums.chunks_mut(group_count).enumerate().filter(|(row, _)| !targets.is_target(*row)) {
        sums.fill(Irradiation::unknown());
    }
    Ok(TargetEnergies { sums, group_count, classes })
}

/// Returns the number of tests of each target: one for each of `seasons`, or two if trees let light through.
#[must_use]
pub fn look_count(obstacles: &SkyObstacles<'_>, seasons: &[SeasonRadiation]) -> usize {
    seasons.len() * obstacles.matrix_count()
}

/// Sums kept of each target.
///
/// # Errors
/// [`Error::NoPoints`] without any season.
pub(super) fn group_count(seasons: &[SeasonRadiation]) -> Result<usize> {
    let first = seasons.first().ok_or_else(|| Error::NoPoints { what: "the period has no season".to_owned() })?;
    Ok(first.radiation.group_count())
}

/// Adds the sums of a season to those of the others.
pub(super) fn add(sums: &mut [Irradiation], own: &[Irradiation]) {
    for (sum, own) in sums.iter_mut().zip(own) {
        *sum = Irradiation::sum(&[*sum, *own]);
    }
}
