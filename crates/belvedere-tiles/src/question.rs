//! What is asked of a city.

use crate::cell_sizes::Topic;
use crate::planned::SideFile;
use belvedere::apps::irradiance::{self, ClearSky, IrradianceParams, RadiationSource, SeasonRadiation, period_seasons};
use belvedere::apps::shadow::{self, ShadowSun};
use belvedere::apps::sky_view::{self, SkyDirections};
use belvedere::apps::sun::{Binning, Date, DayParams, Period, Site, SunSchedule, Zone, sun_days};
use belvedere::apps::sun_hours::{self, SunPlan, SunRule};
use belvedere::apps::tree_light::{Crowns, Season};
use belvedere::apps::viewshed::{Observer, SightLimits};
use belvedere::control::Control;
use belvedere::io::{Source, read_weather};
use belvedere::results::{ResultKind, UNPROVEN_BAND, viewshed_words};
use belvedere::{Error, Result};
use serde::{Deserialize, Serialize};

/// A question that has an answer for each cell on top of what stands there.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Question {
    /// Which cells a sun lights: 1 lit, 0 in shadow, 2 unproven.
    Shadow {
        /// Name of the folder of its results.
        name: String,
        /// Unit vector from the scene to the sun: x east, y grid north, z up.
        to_sun: [f64; 3],
        /// The season, by which trees have leaves; `None` where no date is known.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        season: Option<Season>,
    },
    /// The sky view factor of cells.
    SkyView {
        /// Number of directions that stand for the sky.
        directions: usize,
    },
    /// Hours of sun a day, the mean over some days.
    SunHours(SunQuestion),
    /// Whether a rule of sunlight is met on all of its days: 1 met, 0 not, 2 unproven.
    SunRule {
        /// Name of the folder of its results.
        name: String,
        /// The rule, as [`SunRule::parse`] reads it.
        rule: String,
        /// Its days.
        days: SunQuestion,
    },
    /// Energy of sun and sky on level cells over a period, kWh/m².
    Irradiance {
        /// Where the survey lies.
        site: Site,
        /// Where the radiation comes from.
        radiation: Radiation,
        /// How it is gathered.
        params: IrradianceParams,
    },
    /// What observers see: of one 1 visible, 0 blocked, 2 unproven; of several how many see a cell.
    Viewshed {
        /// Their eyes, local metres.
        eyes: Vec<[f64; 3]>,
        /// How far they look on the map, metres; `None` for any distance.
        max_distance: Option<f64>,
    },
}

/// Days of the sun, as parameters that its directions follow from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SunQuestion {
    site: Site,
    /// Name of the zone; `None` for the mean solar time of the site.
    zone: Option<String>,
    days: Days,
    params: DayParams,
    binning: Binning,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Days {
    On(Vec<String>),
    Between([f64; 2]),
}

/// Where radiation comes from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Radiation {
    /// Rows of weather, each cut into parts.
    Weather {
        /// The file.
        file: SideFile,
        /// Parts of each row.
        parts: usize,
    },
    /// A year without clouds.
    ClearSky {
        /// What it sends.
        clear_sky: ClearSky,
        /// The year.
        year: i16,
    },
}

/// A question with all that follows from its parameters.
pub(crate) enum Asked {
    Light(Light),
    Viewshed(Vec<Observer>),
}

/// What of the light of some directions is asked for.
pub(crate) enum Light {
    Shadow(ShadowSun),
    Sky(SkyDirections),
    SunHours { plan: Box<SunPlan>, site: Site },
    SunRule { plan: Box<SunPlan>, site: Site },
    Irradiance { seasons: Vec<SeasonRadiation>, directions: Vec<[f64; 3]> },
}

impl Light {
    /// Where it comes from, unit vectors.
    pub(crate) fn directions(&self) -> &[[f64; 3]] {
        match self {
            Self::Shadow(sun) => std::slice::from_ref(&sun.to_sun),
            Self::Sky(sky) => &sky.directions,
            Self::SunHours { plan, .. } | Self::SunRule { plan, .. } => plan.directions(),
            Self::Irradiance { directions, .. } => directions,
        }
    }
}

impl SunQuestion {
    /// The days of `period` at a site.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a zone whose name says nothing to others.
    pub fn new(site: Site, zone: &Zone, period: &Period, params: DayParams, binning: Binning) -> Result<Self> {
        let is_solar = *zone == Zone::mean_solar(&site);
        let zone = (!is_solar).then(|| zone.name().to_owned());
        zone.as_deref().map(Zone::parse).transpose()?;
        let days = match period {
            Period::Days(dates) => Days::On(dates.iter().map(Date::to_string).collect()),
            Period::Between(instants) => Days::Between(*instants),
        };
        Ok(Self { site, zone, days, params, binning })
    }

    /// The suns of these days.
    pub(crate) fn schedule(&self) -> Result<SunSchedule> {
        let zone = match &self.zone {
            Some(name) => Zone::parse(name)?,
            None => Zone::mean_solar(&self.site),
        };
        let period = match &self.days {
            Days::On(dates) => Period::Days(dates.iter().map(|date| Date::parse(date)).collect::<Result<_>>()?),
            Days::Between(instants) => Period::Between(*instants),
        };
        SunSchedule::new(&sun_days(&self.site, &zone, &period, &self.params)?, self.binning)
    }
}

impl Radiation {
    fn seasons(
        &self,
        site: &Site,
        crowns: Option<Crowns>,
        params: &IrradianceParams,
        control: &Control<'_>,
    ) -> Result<Vec<SeasonRadiation>> {
        params.validate()?;
        let gather = |source: &RadiationSource<'_>| Ok(period_seasons(source, site, crowns, params, control)?.0);
        match self {
            Self::Weather { file, parts } => {
                let weather = read_weather(Source::bytes(file.path(), &file.read()?))?;
                gather(&RadiationSource::Weather { weather: &weather, parts: *parts })
            }
            Self::ClearSky { clear_sky, year } => {
                gather(&RadiationSource::ClearSky { clear_sky: *clear_sky, year: *year })
            }
        }
    }
}

impl Question {
    /// Name of the folder of its results.
    #[must_use]
    pub fn name(&self) -> &str {
        match self {
            Self::Shadow { name, .. } | Self::SunRule { name, .. } => name,
            Self::SkyView { .. } => "sky_view_factor",
            Self::SunHours { .. } => "sun_hours",
            Self::Irradiance { .. } => "irradiance",
            Self::Viewshed { .. } => "viewshed",
        }
    }

    /// What it is about.
    #[must_use]
    pub fn topic(&self) -> Topic {
        match self {
            Self::Shadow { .. } => Topic::Shadow,
            Self::SkyView { .. } => Topic::SkyView,
            Self::SunHours(_) => Topic::SunHours,
            Self::SunRule { .. } => Topic::Rule,
            Self::Irradiance { .. } => Topic::Irradiance,
            Self::Viewshed { .. } => Topic::Viewshed,
        }
    }

    /// What its values are, in the words of the rasters of the same question to one scene.
    #[must_use]
    pub fn description(&self) -> &'static str {
        match self {
            Self::Shadow { .. } => shadow::LIT,
            Self::SkyView { .. } => sky_view::SKY_VIEW_FACTOR,
            Self::SunHours(_) => sun_hours::SUN_HOURS,
            Self::SunRule { .. } => sun_hours::RULE_IS_MET,
            Self::Irradiance { .. } => irradiance::ENERGY,
            Self::Viewshed { eyes, .. } => viewshed_words(eyes.len())[1],
        }
    }

    /// What its values are, where trees are `opaque` or let light through.
    pub(crate) fn kind(&self, opaque: bool) -> ResultKind {
        match self {
            Self::Shadow { .. } if !opaque => ResultKind::Number,
            Self::Shadow { .. } | Self::SunRule { .. } => ResultKind::Answer,
            Self::Viewshed { eyes, .. } if eyes.len() == 1 => ResultKind::Answer,
            Self::Viewshed { .. } => ResultKind::Count,
            Self::SkyView { .. } | Self::SunHours { .. } | Self::Irradiance { .. } => ResultKind::Number,
        }
    }

    /// Names of the bands of a result of a kind: answers and counts have a second one, of what missing tiles may change.
    pub(crate) fn bands(&self, kind: ResultKind) -> Vec<String> {
        let first = match self {
            Self::Shadow { .. } => "lit",
            Self::Viewshed { eyes, .. } => viewshed_words(eyes.len())[0],
            Self::Irradiance { .. } => irradiance::ENERGY_NAME,
            others => others.name(),
        };
        let second = (kind != ResultKind::Number).then_some(UNPROVEN_BAND);
        [first].into_iter().chain(second).map(str::to_owned).collect()
    }

    /// What follows from its parameters, where crowns of trees let light through or not.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for parameters outside their range, a sun that is not above the horizon and eyes that are nowhere; those of
    /// reading weather.
    pub(crate) fn prepare(&self, crowns: Option<Crowns>, control: &Control<'_>) -> Result<Asked> {
        let invalid = |name, value: String, expected| Err(Error::InvalidParameter { name, value, expected });
        match self {
            Self::Shadow { to_sun, season, .. } if to_sun[2] > 0.0 => {
                Ok(Asked::Light(Light::Shadow(ShadowSun { to_sun: *to_sun, season: *season })))
            }
            Self::Shadow { to_sun, .. } => {
                let elevation = to_sun[2].clamp(-1.0, 1.0).asin().to_degrees();
                invalid("elevation of the sun", format!("{elevation:.3} degrees"), "above the horizon")
            }
            Self::SkyView { directions } => Ok(Asked::Light(Light::Sky(SkyDirections::even(*directions)?))),
            Self::SunHours(days) => {
                let plan = SunPlan::new(days.schedule()?, Vec::new());
                Ok(Asked::Light(Light::SunHours { plan: Box::new(plan), site: days.site }))
            }
            Self::SunRule { name, rule, days } => {
                let schedule = days.schedule()?;
                let rules = vec![(name.clone(), SunRule::parse(rule)?, schedule.clone())];
                Ok(Asked::Light(Light::SunRule { plan: Box::new(SunPlan::new(schedule, rules)), site: days.site }))
            }
            Self::Irradiance { site, radiation, params } => {
                let seasons = radiation.seasons(&site.validate()?, crowns, params, control)?;
                let directions = seasons.iter().flat_map(|season| season.radiation.directions()).collect();
                Ok(Asked::Light(Light::Irradiance { seasons, directions }))
            }
            Self::Viewshed { eyes, .. } if eyes.is_empty() || !eyes.iter().flatten().all(|v| v.is_finite()) => {
                invalid("observers", format!("{eyes:?}"), "one or more places with a height")
            }
            Self::Viewshed { eyes, max_distance } => {
                let limits =
                    SightLimits { distance: [0.0, max_distance.unwrap_or(f64::INFINITY)], ..SightLimits::default() };
                limits.validate()?;
                Ok(Asked::Viewshed(eyes.iter().map(|&eye| Observer { eye, limits }).collect()))
            }
        }
    }
}
