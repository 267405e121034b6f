//! Comfort: sun and sky of walkers on routes, and of windows.

use super::answers::{Answered, Answers, Ask};
use super::context::Context;
use super::places::{Places, test_edge};
use super::remark::Remark;
use super::scene::Scene;
use super::sections::{ExposureSection, LinesSection, NamedValues, PeriodSection};
use super::sky_view::SkyParts;
use super::sun::{Days, missing_days, sun_days_above};
use super::sun_hours::days_in_words;
use super::sun_place::SunPlace;
use super::windows::{GivenWindows, WindowTargets};
use crate::exposure::{Exposure, ROUTE_STEP, ShadeAtEachSun, WALKER_HEIGHT, scene_exposure};
use crate::sun::{Binning, SunSchedule, Zone};
use crate::targets::{Route, Targets, Window, grid_around, set_on_ground};
use crate::viewshed::{CELL, places_along};
use belvedere_core::ground::GroundPoints;
use belvedere_core::query::UnprovenAs;
use belvedere_data::control::Control;
use belvedere_data::report::rounded;
use belvedere_data::{Error, Parameter, Result};
use serde::{Deserialize, Serialize};

/// Sun and sky along routes and at windows.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default)]
pub struct ComfortQuestion {
    /// The days.
    pub days: Days,
    /// Location on earth, clock, and the north of azimuths of windows and suns.
    pub place: SunPlace,
    /// The directions of the sky.
    pub sky: SkyParts,
    /// Metres between places along a route, above 0; `None` for 2.
    pub distance_step_m: Option<f64>,
    /// Height of places on routes above the ground, metres, 0 or more; `None` for 1.1.
    pub target_height: Option<f64>,
    /// Longest side of the pieces that windows of a mesh are cut into, metres, above 0; `None` for 0.5.
    pub spacing: Option<f64>,
    /// Seed of the places on these pieces.
    pub seed: u64,
    /// True to keep the share of each route in shade for each sun. Each sun then has a direction of its own.
    pub shade: ShadeAtEachSun,
    /// Source of ground points.
    #[serde(skip)]
    pub ground: GroundPoints,
    /// The routes or windows.
    #[serde(skip)]
    pub along: RoutesOrWindows,
}

/// Places at which sun and sky are evaluated.
#[derive(Clone, Debug, PartialEq)]
pub enum RoutesOrWindows {
    /// The corners of each route, local metres; a height that is NaN follows from the ground.
    Routes(Vec<Vec<[f64; 3]>>),
    /// Windows.
    Windows(GivenWindows),
}

impl Default for RoutesOrWindows {
    fn default() -> Self {
        Self::Routes(Vec::new())
    }
}

/// Results along routes or at windows.
#[derive(Clone, Debug)]
pub struct ComfortResults {
    /// The places, a group for each route or window.
    pub targets: Targets,
    /// True near the edge of the cloud; `None` if that is not known.
    pub near_edge: Vec<Option<bool>>,
    /// Exposure of each place, and the aggregate of a whole route or window.
    pub exposure: Exposure,
    /// The routes, at their height above the ground; empty for windows.
    pub routes: Vec<Route>,
    /// The windows, with azimuths from grid north; empty for routes.
    pub windows: Vec<Window>,
    /// Name of the object that each window is a face of; empty where that is not known.
    pub names: Vec<String>,
    /// The suns.
    pub schedule: SunSchedule,
    /// Azimuth of grid north from the north of the question, clockwise, radians.
    pub grid_north: f64,
}

impl ComfortQuestion {
    fn targets(
        &self,
        grid_north: f64,
        scene: &Scene,
        context: &mut Context,
        control: &Control<'_>,
    ) -> Result<(WindowTargets, Vec<Route>)> {
        let frame = scene.frame();
        match &self.along {
            RoutesOrWindows::Routes(routes) => {
                let routes = self.routes(routes, scene, context, control)?;
                let targets = Targets::along_routes(&routes, frame.clone());
                Ok((WindowTargets { targets, windows: Vec::new(), names: Vec::new() }, routes))
            }
            RoutesOrWindows::Windows(windows) => {
                let pieces = (self.spacing.unwrap_or(CELL), self.seed);
                let found = control.stage("sampling windows", 0, || windows.targets(frame, grid_north, pieces))?;
                Ok((found, Vec::new()))
            }
        }
    }

    /// Places along routes, on the ground where corners have no height.
    fn routes(
        &self,
        corners: &[Vec<[f64; 3]>],
        scene: &Scene,
        context: &mut Context,
        control: &Control<'_>,
    ) -> Result<Vec<Route>> {
        let step = self.distance_step_m.unwrap_or(ROUTE_STEP);
        let along = |corners: &Vec<[f64; 3]>| Ok(Route { places: places_along(corners, step)? });
        let mut routes = corners.iter().map(along).collect::<Result<Vec<_>>>()?;
        let places = || routes.iter().flat_map(|route| route.places.iter().copied());
        let count = places().count();
        let Some(grid) = grid_around(places(), scene.frame().origin)? else { return Ok(routes) };
        let known = scene.ground(grid, self.ground, control)?;
        context.ground(scene.frame(), &known);
        let height = self.target_height.unwrap_or(WALKER_HEIGHT);
        let all = routes.iter_mut().flat_map(|route| &mut route.places).map(|place| (place, height));
        let unknown = set_on_ground(all, &known.ground).len();
        if unknown == count {
            let what = "the ground below the route is unknown; is the route in the coordinates of the cloud?";
            return Err(Error::NoPoints { what: what.to_owned() });
        }
        let so = "have no known ground below them, and no answer";
        context.add(Remark::of_share("targets-without-ground", unknown, count, "targets on routes", so));
        Ok(routes)
    }

    fn schedule(&self, scene: &Scene, context: &mut Context) -> Result<(SunSchedule, Zone)> {
        let site = self.place.site(scene, context, None)?;
        let zone = self.place.clock(&site, self.days.times(), context)?;
        let params = self.days.params(&self.place);
        let Some(period) = self.days.period(&self.place, &site, &zone)? else { return missing_days() };
        let binning = match self.shade {
            ShadeAtEachSun::Kept => Binning::Exact,
            ShadeAtEachSun::NotKept => Binning::Auto,
        };
        let schedule = SunSchedule::new(&sun_days_above(&site, &zone, &period, &params)?, binning)?;
        context.report.period = Some(PeriodSection::of(&schedule, &zone, &params));
        Ok((schedule, zone))
    }
}

impl Ask for ComfortQuestion {
    type Found = ComfortResults;

    fn check(&self) -> Result<()> {
        if self.days.is_empty() {
            return missing_days();
        }
        self.days.check(&self.place)?;
        self.sky.directions()?;
        places_along(&[], self.distance_step_m.unwrap_or(ROUTE_STEP))?;
        if let RoutesOrWindows::Windows(windows) = &self.along {
            windows.check()?;
        }
        match self.target_height {
            Some(height) if !(height >= 0.0 && height.is_finite()) => {
                Err(Error::invalid(Parameter::HeightAboveGround, height, "0 metres or more"))
            }
            _ => Ok(()),
        }
    }

    fn answer(&self, scene: &Scene, _places: &Places, context: &mut Context, control: &Control<'_>) -> Answered<Self> {
        let sky = self.sky.directions()?;
        let (schedule, zone) = self.schedule(scene, context)?;
        let north = self.place.north.of_scene(scene);
        if self.shade == ShadeAtEachSun::Kept || !matches!(self.along, RoutesOrWindows::Routes(_)) {
            context.north(&north);
        }
        let (mut found, routes) = self.targets(north.of_grid, scene, context, control)?;
        if found.targets.is_empty() {
            return Err(Error::invalid(Parameter::Targets, "missing", "routes or windows"));
        }
        found.leave_out_outside(scene, context)?;
        let WindowTargets { targets, windows, names } = found;
        let directions = [sky.directions.as_slice(), &schedule.directions].concat();
        let near_edge = test_edge(scene, &targets, &directions, context, control)?;
        let blockers = scene.blockers(UnprovenAs::Visible, control)?;
        context.report.lines_of_sight = Some(LinesSection::of(&blockers, Some(directions.len())));
        let exposure = control.stage("testing sky and sun", 2 * targets.len(), || {
            scene_exposure(&blockers, &targets, &sky, &schedule, self.shade, control)
        })?;
        let measures = exposure.measures.iter().map(|(measure, _)| measure.clone()).collect();
        let grid_north = north.of_grid;
        let found = ComfortResults { targets, near_edge, exposure, routes, windows, names, schedule, grid_north };
        found.summarise(sky.directions.len(), &zone, context);
        Ok(Answers::new(found, measures))
    }
}

impl ComfortResults {
    fn summarise(&self, sky_directions: usize, zone: &Zone, context: &mut Context) {
        let count = self.targets.groups.len();
        let kind = if self.windows.is_empty() { "route" } else { "window" };
        let kinds = format!("{kind}s");
        let means = self.exposure.means(&self.targets);
        let mean = |name: &str| means.iter().find(|(measure, _)| measure.name == name).map(|(_, mean)| *mean);
        context.headline(format!(
            "sun and sky of {count} {} with {} places, {}",
            if count == 1 { kind } else { &kinds },
            self.targets.target_count(),
            days_in_words(&self.schedule, zone)
        ));
        if let Some(factor) = mean("sky_view_factor") {
            context.headline(format!("sky view factor: mean {factor:.2}"));
        }
        if let Some(hours) = mean("sun_hours") {
            let possible = self.schedule.possible_hours() / self.schedule.days.len().max(1) as f64;
            let longest = mean("longest").unwrap_or(0.0);
            context.headline(format!(
                "sun: mean {hours:.2} of {possible:.2} possible hours a day, {longest:.2} without a break"
            ));
        }
        let digits = |decimals: usize| i32::try_from(decimals).unwrap_or(3);
        let named = means
            .iter()
            .map(|(measure, mean)| (format!("mean_{}", measure.name), rounded(*mean, digits(measure.decimals))));
        let means = NamedValues(named.collect());
        let groups = NamedValues(vec![(kinds, count)]);
        context.report.exposure = Some(ExposureSection { groups, targets: self.targets.len(), sky_directions, means });
    }
}
