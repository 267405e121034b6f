//! Irradiance: the energy that sun and sky send to places, and to the planes of roofs.

use super::answers::{Answered, Answers, Ask};
use super::context::{Context, spread};
use super::how_sure::{check_interval, check_interval_scene};
use super::places::Places;
use super::remark::Remark;
use super::scene::{Scene, Whereabouts};
use super::sections::{LinesSection, MeasuresSection, PlacesReport, PvSection, RadiationSection, RoofsSection};
use super::sun_and_sky::{Light, OnTargets};
use super::sun_place::SunPlace;
use super::trees::{ThroughTrees, remark_on_leaves};
use super::weather::{remark_on_place_of, remark_on_wind};
use crate::irradiance::{
    ClearSky, IrradianceParams, PeriodReport, PeriodRow, PeriodRows, PlaneHour, PlaneYield, PvSystem, RadiationSource,
    RoofIrradiation, RoofRows, RoofsReport, SeasonRadiation, Surroundings, USUAL_TEMPERATURE, hour_columns, look_count,
    period_seasons, plane_hours, roof_irradiation, roof_yields, season_irradiation,
};
use crate::result_columns::ResultColumn;
use crate::roof_planes::{Buildings, GROUND_CELL, RoofPlane, RoofPlaneParams, RoofsFrom, roof_planes, roof_points};
use crate::rows::Obstacles;
use crate::sum_errors::Intervals;
use crate::sun::Site;
use crate::targets::Measure;
use crate::tree_light::CrownLight;
use belvedere_core::ground::{GroundPoints, MapGrid};
use belvedere_core::query::{MedialScene, UnprovenAs};
use belvedere_data::control::Control;
use belvedere_data::polygon::Footprint;
use belvedere_data::report::rounded;
use belvedere_data::weather::Weather;
use belvedere_data::{Error, Parameter, Result};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Minimum number of cells of a plane that is listed.
const MIN_CELLS: usize = 10;

/// Energy of sun and sky at places and on roofs over a period.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct IrradianceQuestion {
    /// Source of the radiation.
    pub radiation: Radiation,
    /// Parameters of gathering it.
    #[serde(default)]
    pub params: IrradianceParams,
    /// Location on earth.
    #[serde(default)]
    pub place: SunPlace,
    /// Light through trees.
    #[serde(default)]
    pub trees: ThroughTrees,
    /// The planes of roofs that are wanted beside places.
    #[serde(default)]
    pub roofs: Option<Roofs>,
    /// True to give the expected value of energies and an interval that holds 90 %. Only for opaque trees. Default:
    /// false.
    #[serde(default)]
    pub interval: bool,
}

/// Source of radiation.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Radiation {
    /// Rows of weather, each cut into parts.
    Weather {
        /// Name of the file that they are from.
        file: String,
        /// The rows; whoever reads a question from text reads them from the file.
        #[serde(skip)]
        weather: Option<Arc<Weather>>,
        /// Parts of each row; 4 is usual.
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

impl PartialEq for Radiation {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Weather { file, parts, .. }, Self::Weather { file: of_other, parts: other_parts, .. }) => {
                (file, parts) == (of_other, other_parts)
            }
            (Self::ClearSky { clear_sky, year }, Self::ClearSky { clear_sky: of_other, year: other_year }) => {
                (clear_sky, year) == (of_other, other_year)
            }
            _ => false,
        }
    }
}

/// Planes of roofs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default)]
pub struct Roofs {
    /// Smallest area of a plane, square metres; `None` for the default of [`RoofPlaneParams`].
    pub min_area: Option<f64>,
    /// Side of a panel, metres; `None` for the default of [`RoofPlaneParams`].
    pub panel: Option<f64>,
    /// Minimum number of cells of a plane that is listed; smaller ones are counted. `None` for 10: the panels of the
    /// smallest plant that is worth its inverter.
    pub min_cells: Option<usize>,
    /// Photovoltaic system on them.
    pub system: PvChoice,
    /// Outlines of buildings, local metres; `None` if planes that touch are a building.
    #[serde(skip)]
    pub footprints: Option<Arc<Vec<Footprint>>>,
    /// Source of ground points.
    #[serde(skip)]
    pub ground: GroundPoints,
}

/// A photovoltaic system; values that are not given are those of [`PvSystem`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default)]
pub struct PvChoice {
    /// Peak power of a square metre of panels, kW/m².
    pub module_efficiency: Option<f64>,
    /// Change of the power with the temperature of the cells, share per °C.
    pub temperature_coefficient: Option<f64>,
    /// Share of the direct current lost without shading.
    pub system_losses: Option<f64>,
    /// Nominal efficiency of the inverter.
    pub inverter_efficiency: Option<f64>,
    /// Peak power of the panels for each power of the inverter.
    pub dc_ac_ratio: Option<f64>,
}

impl PvChoice {
    /// The system.
    ///
    /// # Errors
    /// Those of [`PvSystem::validate`].
    pub fn system(&self) -> Result<PvSystem> {
        let usual = PvSystem::default();
        let system = usual
            .with_module_efficiency(self.module_efficiency.unwrap_or(usual.module_efficiency))
            .with_temperature_coefficient(self.temperature_coefficient.unwrap_or(usual.temperature_coefficient))
            .with_system_losses(self.system_losses.unwrap_or(usual.system_losses))
            .with_inverter_efficiency(self.inverter_efficiency.unwrap_or(usual.inverter_efficiency))
            .with_dc_ac_ratio(self.dc_ac_ratio.unwrap_or(usual.dc_ac_ratio));
        system.validate().map(|()| system)
    }
}

impl Default for Roofs {
    fn default() -> Self {
        let system = PvChoice::default();
        Self { min_area: None, panel: None, min_cells: None, system, footprints: None, ground: GroundPoints::Auto }
    }
}

/// Results for places and roofs.
pub struct IrradianceResults {
    /// The places; `None` where only roofs are wanted.
    pub on: Option<OnTargets>,
    /// The roofs; `None` where they are not wanted.
    pub roofs: Option<RoofsResults>,
    /// Location of the scene on earth.
    pub site: Site,
}

/// The planes of roofs with their energy.
pub struct RoofsResults {
    /// The planes.
    pub planes: Vec<RoofPlane>,
    /// The building of each.
    pub buildings: Buildings,
    /// The energy of each.
    pub energies: Vec<RoofIrradiation>,
    /// Photovoltaic system on each.
    pub system: PvSystem,
    /// The electricity of each.
    pub yields: Vec<PlaneYield>,
    /// Radiation row by row.
    pub rows: PeriodRows,
    /// Source of the radiation, for people.
    pub radiation: String,
    /// Sums of them.
    pub report: RoofsReport,
    /// Obstacles to their light.
    pub blockers: Arc<MedialScene>,
}

impl RoofsResults {
    /// Returns the rows of tables of planes and of buildings.
    #[must_use]
    pub fn as_rows(&self) -> RoofRows<'_> {
        let Self { planes, buildings, energies, yields, radiation, .. } = self;
        RoofRows { planes, buildings, energies, yields, radiation }
    }

    /// Returns radiation and power of a plane, by its number from 0, in each row of the period, also as columns.
    ///
    /// # Errors
    /// Those of [`plane_hours`].
    pub fn hours(&self, plane: usize) -> Result<(Vec<PlaneHour>, Vec<ResultColumn>)> {
        let hours = plane_hours(&self.planes[plane], &self.energies[plane], &self.rows, &self.system)?;
        let columns = hour_columns(&self.rows, &hours, self.yields[plane].peak_power);
        Ok((hours, columns))
    }
}

impl Radiation {
    fn source(&self) -> Result<RadiationSource<'_>> {
        match self {
            Self::Weather { weather: Some(weather), parts, .. } => {
                Ok(RadiationSource::Weather { weather, parts: *parts })
            }
            Self::Weather { file, .. } => {
                Err(Error::invalid(Parameter::Weather, file.clone(), "read before the question is put"))
            }
            Self::ClearSky { clear_sky, year } => Ok(RadiationSource::ClearSky { clear_sky: *clear_sky, year: *year }),
        }
    }

    /// Returns the source in words, such as "EPW; delft.epw" or "clear sky of Haurwitz; 2026". Commas would part the
    /// cells of tables.
    #[must_use]
    pub fn in_words(&self) -> String {
        let text = match self {
            Self::Weather { file, weather, .. } => {
                let name = std::path::Path::new(file).file_name().map(|name| name.to_string_lossy());
                let format = weather.as_ref().map_or("weather", |weather| weather.format);
                format!("{format}, {}", name.unwrap_or_default())
            }
            Self::ClearSky { clear_sky, year } => format!("{clear_sky}, {year}"),
        };
        text.replace(", ", "; ")
    }

    /// The rows of weather, once they were read.
    #[must_use]
    pub fn weather(&self) -> Option<&Weather> {
        match self {
            Self::Weather { weather, .. } => weather.as_deref(),
            Self::ClearSky { .. } => None,
        }
    }
}

impl IrradianceQuestion {
    /// Gathers the radiation of a period at a site, in parts by the transmissivity of crowns, and reports it.
    fn gather(
        &self,
        site: &Site,
        crowns: Option<CrownLight>,
        context: &mut Context,
        control: &Control<'_>,
    ) -> Result<Vec<SeasonRadiation>> {
        let source = self.radiation.source()?;
        let (seasons, report) =
            control.stage("computing radiation", 0, || period_seasons(&source, site, crowns, &self.params, control))?;
        let mut section = RadiationSection {
            global_kwh_m2: rounded(report.ghi, 1),
            direct_normal_kwh_m2: rounded(report.dni, 1),
            diffuse_kwh_m2: rounded(report.dhi, 1),
            sun_directions: report.sun_direction_count,
            diffuse_model: self.params.sky.to_string(),
            obstacle_reflection: match self.params.surroundings {
                Surroundings::Dark => "nothing",
                Surroundings::LikeGround => "like the ground",
            },
            ..RadiationSection::default()
        };
        match &self.radiation {
            Radiation::ClearSky { clear_sky, year } => {
                section.source = clear_sky.to_string();
                section.year = Some(*year);
            }
            Radiation::Weather { .. } => {}
        }
        if let Some(weather) = self.radiation.weather() {
            section.source = weather.format.to_owned();
            section.weather_rows = Some(weather.steps.len());
            section.weather_hours = Some(rounded(weather.hours(), 2));
        }
        context.report.radiation = Some(section);
        remark_on_radiation(self.radiation.weather(), site, &report, context);
        Ok(seasons)
    }
}

/// Adds remarks on radiation that was gathered for a site, from weather or from a clear sky.
pub fn remark_on_radiation(weather: Option<&Weather>, site: &Site, report: &PeriodReport, context: &mut Context) {
    if let Some(weather) = weather {
        remark_on(weather, site, context);
    }
    if report.night_hours > 0.0 {
        let text = format!(
            "the weather has radiation in {:.1} hours of the night, with the sun more than 12 degrees below the horizon: are its location and time zone correct?",
            report.night_hours
        );
        context.add(Some(Remark::warning("weather-at-night", text).with("hours", report.night_hours)));
    }
    if report.is_doubtful() {
        let lost = report.dni_without_sun;
        let text = format!(
            "{lost:.0} kWh/m² of direct radiation have the sun below the horizon and are ignored: are the location and the time zone of the weather correct?"
        );
        context.add(Some(Remark::warning("weather-below-horizon", text).with("kwh_m2", lost)));
    }
}

/// Adds remarks on weather.
fn remark_on(weather: &Weather, site: &Site, context: &mut Context) {
    let rows = weather.left_out_count + weather.steps.len();
    let so = "of the weather have no radiation and are left out";
    context.add(Remark::of_share("weather-rows-left-out", weather.left_out_count, rows, "rows", so));
    let period = weather.period_remark();
    context.add(period.map(|text| Remark::warning("weather-period", text).with("hours", weather.hours())));
    remark_on_place_of(weather, site, context);
}

impl Roofs {
    fn params(&self) -> RoofPlaneParams {
        let usual = RoofPlaneParams::default();
        usual.with_min_area(self.min_area.unwrap_or(usual.min_area)).with_cell(self.panel.unwrap_or(usual.cell))
    }

    /// The planes of a scene that are listed, and their buildings.
    fn find(&self, scene: &Scene, context: &mut Context, control: &Control<'_>) -> Result<(Vec<RoofPlane>, Buildings)> {
        let (low, high) = scene.model().bounds().on_map();
        let [x, y, _] = scene.frame().origin;
        let known = scene.ground(MapGrid::covering(low, high, GROUND_CELL, [x, y])?, self.ground, control)?;
        let cloud = scene.ground_cloud()?;
        let (rows, from) = roof_points(cloud, &known.ground)?;
        let places: Vec<[f32; 3]> = rows.iter().filter_map(|&row| cloud.positions.get(row as usize).copied()).collect();
        let planes = control.stage("detecting roof planes", 0, || roof_planes(&places, &self.params(), control))?;
        let min_cells = self.min_cells.unwrap_or(MIN_CELLS);
        let is_listed = |plane: &RoofPlane| plane.cells.count() >= min_cells;
        // small planes join large ones to a building
        let buildings = match &self.footprints {
            None => Buildings::of_touching(&planes).of_kept(planes.iter().map(is_listed)),
            Some(footprints) => {
                let large: Vec<RoofPlane> = planes.iter().filter(|plane| is_listed(plane)).cloned().collect();
                Buildings::of_footprints(&large, footprints)
            }
        };
        remark_on_buildings(&buildings, context);
        let (listed, small): (Vec<RoofPlane>, Vec<RoofPlane>) = planes.into_iter().partition(is_listed);
        let small_area = rounded(small.iter().map(|plane| plane.area).sum(), 1);
        context.report.roofs = Some(RoofsSection {
            source: match from {
                RoofsFrom::Class => "class 6",
                RoofsFrom::Height => "height above the ground (no class 6)",
            },
            points: places.len(),
            points_on_planes: listed.iter().chain(&small).map(|plane| plane.points.len()).sum(),
            planes: listed.len(),
            buildings: buildings.count(),
            area_m2: rounded(listed.iter().map(|plane| plane.area).sum(), 1),
            small_planes: small.len(),
            small_planes_area_m2: small_area,
        });
        if !small.is_empty() {
            let (count, area) = (small.len(), small_area);
            let text = format!(
                "{count} planes of roofs ({area} m²) have fewer than {min_cells} cells for panels and are not listed"
            );
            let remark = Remark::note("small-roof-planes", text).with("count", count as f64).with("area_m2", area);
            context.add(Some(remark));
        }
        Ok((listed, buildings))
    }
}

/// Adds remarks on planes that footprints do not hold well.
fn remark_on_buildings(buildings: &Buildings, context: &mut Context) {
    let count = buildings.of_plane.len();
    let outside = buildings.of_plane.iter().filter(|number| number.is_none()).count();
    let so = "of roofs lie in no footprint, and belong to no building";
    context.add(Remark::of_share("planes-outside-footprints", outside, count, "planes", so));
    let so = "of roofs reach over several footprints, and count for the one with most of them";
    context.add(Remark::of_share("planes-over-footprints", buildings.reaching_over, count, "planes", so));
}

impl Ask for IrradianceQuestion {
    type Found = IrradianceResults;

    fn check(&self) -> Result<()> {
        self.params.validate()?;
        check_interval(self.interval, &self.trees)?;
        self.roofs.as_ref().map(|roofs| roofs.system.system()).transpose()?;
        self.place.check().map(|_| ())
    }

    fn answer(&self, scene: &Scene, places: &Places, context: &mut Context, control: &Control<'_>) -> Answered<Self> {
        check_interval_scene(self.interval, scene, control)?;
        let intervals = Intervals::wanted(self.interval);
        let station = self.radiation.weather().map(|weather| [weather.latitude, weather.longitude]);
        let site = self.place.site(scene, context, station)?;
        let trees = match scene.parts() {
            Some(_) => None,
            None => self.trees.of((scene, Some(site.latitude)), context, control)?,
        };
        let crowns = match scene.parts() {
            Some(parts) => parts.crowns(),
            None => trees.as_ref().map(|trees| trees.crowns),
        };
        let seasons = self.gather(&site, crowns, context, control)?;
        context.add(crowns.and_then(|crowns| remark_on_leaves(crowns, seasons.iter().map(|season| season.factor))));
        let planes = self.roofs.as_ref().map(|roofs| roofs.find(scene, context, control)).transpose()?;
        let mut measures = Vec::new();
        let on = match places {
            Places::Scene => {
                let directions = seasons.iter().map(|season| season.radiation.directions().len()).sum();
                let blockers = scene.blockers(UnprovenAs::Visible, control)?;
                context.report.lines_of_sight = Some(LinesSection::of(&blockers, Some(directions)));
                None
            }
            _ => {
                let directions: Vec<[f64; 3]> =
                    seasons.iter().flat_map(|season| season.radiation.directions()).collect();
                let trees = (&self.trees, Some(site.latitude), UnprovenAs::Visible);
                let light = Light::resolve(places, &directions, trees, scene, context, control)?;
                let looks = light.targets.len() * look_count(&light.obstacles(), &seasons);
                let energies = control.stage("testing sun and sky", looks, || {
                    season_irradiation(light.obstacles(), &light.targets, &seasons, intervals, control)
                })?;
                measures = energies.into_measures();
                measures.iter_mut().for_each(|measure| light.targets.clear_unasked(&mut measure.values));
                context.report.measures = Some(MeasuresSection::of(&light.targets, &measures));
                summarise(&measures, &self.radiation, &PlacesReport::in_words(&light.targets), context);
                Some(light.titled(title(&scene.whereabouts())))
            }
        };
        let roofs = match planes {
            Some((planes, buildings)) => {
                let blockers = scene.blockers(UnprovenAs::Visible, control)?;
                let obstacles = Obstacles { scene: &blockers, trees: trees.as_ref() };
                let energies = control.stage("testing sun and sky", planes.len(), || {
                    roof_irradiation(obstacles, &planes, &seasons, intervals, control)
                })?;
                Some(self.roofs_found((planes, buildings, energies, blockers), &site, crowns, context, control)?)
            }
            None => None,
        };
        Ok(Answers::new(IrradianceResults { on, roofs, site }, measures))
    }
}

pub(super) fn title(whereabouts: &Whereabouts<'_>) -> String {
    format!("Energy of sun and sky, kWh/m²{}", whereabouts.far_in_words())
}

/// Reports the measures of places.
pub(super) fn summarise(measures: &[Measure], radiation: &Radiation, places: &str, context: &mut Context) {
    if let Some(first) = measures.first() {
        // with weather, remarks say of which hours it is
        let period = radiation.weather().is_none().then(|| format!(", {}", radiation.period_in_words()));
        let period = period.unwrap_or_default();
        context.headline(format!("energy on {places}{period}: {}", spread(&first.values, 0, "kWh/m²")));
    }
}

impl IrradianceQuestion {
    /// The electricity of planes of roofs, with what is reported of them.
    fn roofs_found(
        &self,
        (planes, buildings, energies, blockers): (Vec<RoofPlane>, Buildings, Vec<RoofIrradiation>, Arc<MedialScene>),
        site: &Site,
        crowns: Option<CrownLight>,
        context: &mut Context,
        control: &Control<'_>,
    ) -> Result<RoofsResults> {
        let system = self.roofs.as_ref().map(|roofs| roofs.system).unwrap_or_default().system()?;
        let source = self.radiation.source()?;
        let (rows, yields) = control.stage("computing yields", planes.len(), || {
            let rows = PeriodRows::gather(&source, site, crowns, &self.params, control)?;
            let yields = roof_yields(&planes, &energies, &rows, &system, control)?;
            Ok((rows, yields))
        })?;
        remark_on_air(&rows.rows, context);
        context.report.photovoltaics = Some(PvSection::of(&system));
        let report = RoofsReport::new(&planes, &energies, &yields);
        let area: f64 = planes.iter().map(|plane| plane.area).sum();
        let on = match buildings.count() {
            0 => String::new(),
            1 => " on 1 building".to_owned(),
            count => format!(" on {count} buildings"),
        };
        context.headline(format!("{} roof planes{on}, {area:.0} m²", planes.len()));
        if !planes.is_empty() {
            context.headline(format!(
                "panels of {:.1} kWp give {} to {} MWh of alternating current {}",
                report.peak_power_kwp,
                report.string_ac_mwh,
                report.ac_mwh,
                self.radiation.period_in_words()
            ));
        }
        let radiation = self.radiation.in_words();
        Ok(RoofsResults { planes, buildings, energies, system, yields, rows, radiation, report, blockers })
    }
}

impl Radiation {
    fn period_in_words(&self) -> String {
        match self.weather().map(|weather| (weather.period_remark(), weather.hours())) {
            None => "in a year without clouds".to_owned(),
            Some((None, _)) => "a year".to_owned(),
            Some((Some(_), hours)) => format!("in {hours:.0} hours of weather"),
        }
    }
}

/// Adds remarks on air that is assumed.
fn remark_on_air(rows: &[PeriodRow], context: &mut Context) {
    let missing = |known: &dyn Fn(&PeriodRow) -> bool| rows.iter().filter(|row| !known(row)).count();
    let so = format!("of the weather have no air temperature: {USUAL_TEMPERATURE} °C is assumed");
    let temperature = Remark::of_share(
        "rows-without-temperature",
        missing(&|row| row.temperature.is_some()),
        rows.len(),
        "rows",
        &so,
    );
    let wind = remark_on_wind(missing(&|row| row.wind_speed.is_some()), rows.len());
    [temperature, wind].into_iter().for_each(|remark| context.add(remark.map(Remark::into_note)));
}
