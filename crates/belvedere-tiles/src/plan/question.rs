//! Questions about a city.

use crate::plan::side_files::SideFile;
use belvedere::apps::ask::{self, Context, SkyParts, SunHoursQuestion};
use belvedere::apps::irradiance::{self, ClearSky, IrradianceParams, RadiationSource, SeasonRadiation, period_seasons};
use belvedere::apps::shadow::{self, ShadowSun};
use belvedere::apps::sky_view::{self, SkyDirections};
use belvedere::apps::sum_errors::{INTERVAL_MEASURES, Intervals};
use belvedere::apps::sun::Site;
use belvedere::apps::sun_hours::{self, SunPlan};
use belvedere::apps::tree_light::{CrownLight, Season};
use belvedere::apps::viewshed::{Observer, SightLimits};
use belvedere::control::Control;
use belvedere::io::{BandLabel, Source, read_weather};
use belvedere::query::Certainty;
use belvedere::results::{ResultKind, UNPROVEN_BAND, viewshed_words};
use belvedere::{Error, Parameter, Result};
use serde::{Deserialize, Serialize};

/// Folder of the balls of a run, which no question may have.
pub(crate) const BALLS: &str = "balls";

/// Topic of a result. Results on the same topic have cells of the same size.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Topic {
    /// Shadow of one sun.
    Shadow,
    /// Hours of sun.
    SunHours,
    /// Rules of sunlight.
    Rule,
    /// Energy of sun and sky.
    Irradiance,
    /// Sky view factor.
    SkyView,
    /// Viewsheds of observers.
    Viewshed,
}

impl Topic {
    /// All topics.
    pub const ALL: [Self; 6] =
        [Self::Shadow, Self::SunHours, Self::Rule, Self::Irradiance, Self::SkyView, Self::Viewshed];

    /// Returns the word for the topic on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Shadow => "shadow",
            Self::SunHours => "sun-hours",
            Self::Rule => "rule",
            Self::Irradiance => "irradiance",
            Self::SkyView => "sky-view",
            Self::Viewshed => "viewshed",
        }
    }
}

/// Question with an answer for each cell.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum TileQuestion {
    /// Cells lit by one sun: 1 lit, 0 in shadow.
    Shadow {
        /// Name of the folder of its results.
        name: String,
        /// Unit vector from the scene to the sun: x east, y grid north, z up.
        to_sun: [f64; 3],
        /// Season, which decides whether trees have leaves; `None` without a known date.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        season: Option<Season>,
    },
    /// Sky view factor of cells.
    SkyView {
        /// Division of the sky into parts.
        sky: SkyParts,
        /// True if results include an interval around the truth.
        #[serde(default, skip_serializing_if = "std::ops::Not::not")]
        interval: bool,
    },
    /// Hours of sun a day, mean of several days.
    SunHours {
        /// Location of the survey.
        site: Site,
        /// Days of the mean.
        days: SunHoursQuestion,
    },
    /// Compliance with a rule of sunlight on all of its days: 1 met, 0 not met.
    SunRule {
        /// Name of the folder of its results.
        name: String,
        /// Location of the survey.
        site: Site,
        /// Rule with its days.
        days: SunHoursQuestion,
    },
    /// Energy of sun and sky on level cells over a period, kWh/m².
    Irradiance {
        /// Location of the survey.
        site: Site,
        /// Source of the radiation.
        radiation: TileRadiation,
        /// Parameters of the sums of energy.
        params: IrradianceParams,
        /// True if results include an interval around the truth.
        #[serde(default, skip_serializing_if = "std::ops::Not::not")]
        interval: bool,
    },
    /// Visibility from observers. For one observer 1 is visible and 0 blocked; for several the number with a free line
    /// of sight to the cell.
    Viewshed {
        /// Eyes of the observers, local metres.
        eyes: Vec<[f64; 3]>,
        /// Maximum distance of sight on the map, metres; `None` for any distance.
        max_distance: Option<f64>,
        /// True for a reverse viewshed: the eyes are targets, which cells look at. Such a target may lie inside an
        /// obstacle.
        #[serde(default, skip_serializing_if = "std::ops::Not::not")]
        is_reverse: bool,
    },
    /// Probability that a sun lights a cell or that an observer sees it; for several observers the expected number.
    Probability {
        /// Name of the folder of its results.
        name: String,
        /// Question whose answers get probabilities: the shadow of a sun, or a viewshed.
        of: Box<Self>,
        /// Certainty of several observers, above 0.5 up to 1, below which their answers count as uncertain.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        certain: Option<f64>,
    },
}

/// Source of radiation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum TileRadiation {
    /// Rows of weather, each divided into parts.
    Weather {
        /// Weather file.
        file: SideFile,
        /// Number of parts of each row.
        parts: usize,
    },
    /// Year without clouds.
    ClearSky {
        /// Radiation of the clear sky.
        clear_sky: ClearSky,
        /// Calendar year.
        year: i16,
    },
}

/// Question with all data derived from its parameters.
pub(crate) enum PreparedQuestion {
    Light(LightQuestion),
    Viewshed { observers: Vec<Observer>, is_reverse: bool },
    Probability { of: Box<Self>, certainty: Option<Certainty> },
}

/// Question about light from given directions.
pub(crate) enum LightQuestion {
    Shadow(ShadowSun),
    Sky(SkyDirections, Intervals),
    SunHours { plan: Box<SunPlan>, site: Site, intervals: Intervals },
    SunRule { plan: Box<SunPlan>, site: Site },
    Irradiance { seasons: Vec<SeasonRadiation>, directions: Vec<[f64; 3]>, intervals: Intervals },
}

impl PreparedQuestion {
    /// Returns the factors of crowns in the seasons of the question ([`CrownLight::known_factors`]).
    pub(crate) fn known_factors(&self, crowns: CrownLight) -> Vec<f64> {
        let on = |plan: &SunPlan, site: &Site| {
            crowns.known_factors(plan.dates().map(|date| Some(Season::on(date, site)))).collect()
        };
        match self {
            Self::Light(LightQuestion::Shadow(sun)) => crowns.known_factors([sun.season]).collect(),
            Self::Light(LightQuestion::Sky(..)) => crowns.known_factors([None]).collect(),
            Self::Light(LightQuestion::SunHours { plan, site, .. } | LightQuestion::SunRule { plan, site }) => {
                on(plan, site)
            }
            Self::Light(LightQuestion::Irradiance { seasons, .. }) => {
                seasons.iter().map(|season| season.factor).collect()
            }
            Self::Viewshed { .. } | Self::Probability { .. } => Vec::new(),
        }
    }
}

impl LightQuestion {
    /// Returns the directions of the light as unit vectors.
    pub(crate) fn directions(&self) -> &[[f64; 3]] {
        match self {
            Self::Shadow(sun) => std::slice::from_ref(&sun.to_sun),
            Self::Sky(sky, _) => &sky.directions,
            Self::SunHours { plan, .. } | Self::SunRule { plan, .. } => plan.directions(),
            Self::Irradiance { directions, .. } => directions,
        }
    }
}

impl TileRadiation {
    fn seasons(
        &self,
        site: &Site,
        crowns: Option<CrownLight>,
        params: &IrradianceParams,
        context: &mut Context,
        control: &Control<'_>,
    ) -> Result<Vec<SeasonRadiation>> {
        params.validate()?;
        let weather;
        let (source, weather) = match self {
            Self::Weather { file, parts } => {
                weather = read_weather(Source::bytes(file.path(), &file.read()?))?;
                (RadiationSource::Weather { weather: &weather, parts: *parts }, Some(&weather))
            }
            Self::ClearSky { clear_sky, year } => {
                (RadiationSource::ClearSky { clear_sky: *clear_sky, year: *year }, None)
            }
        };
        let (seasons, report) = period_seasons(&source, site, crowns, params, control)?;
        ask::remark_on_radiation(weather, site, &report, context);
        Ok(seasons)
    }
}

impl TileQuestion {
    /// Returns the name of the folder of its results.
    #[must_use]
    pub fn name(&self) -> &str {
        match self {
            Self::Shadow { name, .. } | Self::SunRule { name, .. } | Self::Probability { name, .. } => name,
            Self::SkyView { .. } => "sky_view_factor",
            Self::SunHours { .. } => "sun_hours",
            Self::Irradiance { .. } => "irradiance",
            Self::Viewshed { .. } => "viewshed",
        }
    }

    /// Returns the topic of the question.
    #[must_use]
    pub fn topic(&self) -> Topic {
        match self {
            Self::Shadow { .. } => Topic::Shadow,
            Self::SkyView { .. } => Topic::SkyView,
            Self::SunHours { .. } => Topic::SunHours,
            Self::SunRule { .. } => Topic::Rule,
            Self::Irradiance { .. } => Topic::Irradiance,
            Self::Viewshed { .. } => Topic::Viewshed,
            Self::Probability { of, .. } => of.topic(),
        }
    }

    /// Returns a description of the values, in the same words as rasters of one scene.
    #[must_use]
    pub fn description(&self) -> &'static str {
        match self {
            Self::Shadow { .. } => shadow::LIT,
            Self::SkyView { .. } => sky_view::SKY_VIEW_FACTOR,
            Self::SunHours { .. } => sun_hours::SUN_HOURS,
            Self::SunRule { .. } => sun_hours::RULE_IS_MET,
            Self::Irradiance { .. } => irradiance::ENERGY,
            Self::Viewshed { eyes, .. } => viewshed_words(eyes.len())[1],
            Self::Probability { of, .. } if of.is_of_several() => ask::EXPECTED_OBSERVERS,
            Self::Probability { .. } => ask::BEING_FREE,
        }
    }

    /// True if the question has several observers.
    pub(crate) fn is_of_several(&self) -> bool {
        matches!(self, Self::Viewshed { eyes, .. } if eyes.len() > 1)
    }

    /// Returns the kind of the values; with `shares` shadows are shares of light instead of yes or no.
    pub(crate) fn kind(&self, shares: bool) -> ResultKind {
        match self {
            Self::Shadow { .. } if shares => ResultKind::Number,
            Self::Shadow { .. } | Self::SunRule { .. } => ResultKind::Answer,
            Self::Viewshed { eyes, .. } if eyes.len() == 1 => ResultKind::Answer,
            Self::Viewshed { .. } => ResultKind::Count,
            Self::SkyView { .. } | Self::SunHours { .. } | Self::Irradiance { .. } | Self::Probability { .. } => {
                ResultKind::Number
            }
        }
    }

    /// True if the answers use the proof by pulses.
    pub(crate) fn needs_proof(&self) -> bool {
        matches!(self, Self::Shadow { .. } | Self::Viewshed { .. } | Self::Probability { .. })
    }

    /// Refuses probabilities and intervals for a survey without known pulses.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`].
    pub(crate) fn check_pulses(&self, are_known: bool) -> Result<()> {
        let parameter = match self {
            Self::Probability { .. } => Parameter::Certainty,
            others if others.has_interval() => Parameter::Interval,
            _ => return Ok(()),
        };
        let expected = "left out for surveys whose pulses are not known, or of which something is cleared";
        let refused = || Err(Error::invalid(parameter, "given", expected));
        if are_known { Ok(()) } else { refused() }
    }

    /// True if the values have an interval around the truth.
    fn has_interval(&self) -> bool {
        match self {
            Self::SkyView { interval, .. } | Self::Irradiance { interval, .. } => *interval,
            Self::SunHours { days, .. } => days.interval,
            _ => false,
        }
    }

    /// Returns the names of the bands of a result. Answers and counts have a second band for unproven cells.
    #[must_use]
    pub fn band_names(&self, kind: ResultKind) -> Vec<String> {
        if let Self::Probability { of, certain, .. } = self {
            let first = if of.is_of_several() { ask::EXPECTED } else { ask::PROBABILITY };
            let second = certain.map(|_| ask::UNCERTAIN);
            return [first].into_iter().chain(second).map(str::to_owned).collect();
        }
        let first = match self {
            Self::Shadow { .. } => "lit",
            Self::Viewshed { eyes, .. } => viewshed_words(eyes.len())[0],
            Self::Irradiance { .. } => irradiance::ENERGY_NAME,
            others => others.name(),
        };
        let second = (kind != ResultKind::Number).then(|| UNPROVEN_BAND.to_owned());
        let stem = match self {
            Self::SkyView { .. } => "factor",
            Self::Irradiance { .. } => irradiance::ENERGY_NAME,
            _ => "hours",
        };
        let ends = INTERVAL_MEASURES.iter().filter(|_| self.has_interval()).map(|(end, _)| format!("{stem}_{end}"));
        [first.to_owned()].into_iter().chain(second).chain(ends).collect()
    }

    /// Returns the labels of the bands of results of a kind.
    #[must_use]
    pub fn band_labels(&self, kind: ResultKind) -> Vec<BandLabel> {
        let label = |name: &String| BandLabel::new(name, if name == UNPROVEN_BAND { "1" } else { self.unit() });
        self.band_names(kind).iter().map(label).collect()
    }

    /// Returns the unit of the values, `1` for those without.
    #[must_use]
    pub fn unit(&self) -> &'static str {
        match self {
            Self::SunHours { .. } => "h",
            Self::Irradiance { .. } => "kWh/m2",
            _ => "1",
        }
    }

    /// Returns the question with all data derived from its parameters and from the light through crowns. Remarks on
    /// radiation go into `context`.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for parameters out of range, a sun that is not above the horizon, and missing or
    /// non-finite eyes. Also those of reading weather.
    pub(crate) fn prepare(
        &self,
        crowns: Option<CrownLight>,
        context: &mut Context,
        control: &Control<'_>,
    ) -> Result<PreparedQuestion> {
        let invalid = |parameter, value: String, expected| Err(Error::invalid(parameter, value, expected));
        let gives_shares = crowns.is_some_and(|crowns| crowns.gives_shares());
        if self.has_interval() && gives_shares {
            return invalid(Parameter::Interval, self.name().to_owned(), "left out where light gets through trees");
        }
        match self {
            Self::Shadow { to_sun, season, .. } if to_sun[2] > 0.0 => {
                Ok(PreparedQuestion::Light(LightQuestion::Shadow(ShadowSun { to_sun: *to_sun, season: *season })))
            }
            Self::Shadow { to_sun, .. } => {
                let elevation = to_sun[2].clamp(-1.0, 1.0).asin().to_degrees();
                invalid(Parameter::SunElevation, format!("{elevation:.3} degrees"), "above the horizon")
            }
            Self::SkyView { sky, interval } => {
                let (sky, intervals) = (sky.directions()?, Intervals::wanted(*interval));
                Ok(PreparedQuestion::Light(LightQuestion::Sky(sky, intervals)))
            }
            Self::SunHours { site, days } => Ok(PreparedQuestion::Light(LightQuestion::SunHours {
                plan: Box::new(days.plan(site)?.0),
                site: *site,
                intervals: Intervals::wanted(days.interval),
            })),
            Self::SunRule { site, days, .. } => {
                Ok(PreparedQuestion::Light(LightQuestion::SunRule { plan: Box::new(days.plan(site)?.0), site: *site }))
            }
            Self::Irradiance { site, radiation, params, interval } => {
                let seasons = radiation.seasons(&site.validate()?, crowns, params, context, control)?;
                let directions = seasons.iter().flat_map(|season| season.radiation.directions()).collect();
                let intervals = Intervals::wanted(*interval);
                Ok(PreparedQuestion::Light(LightQuestion::Irradiance { seasons, directions, intervals }))
            }
            Self::Viewshed { eyes, .. } if eyes.is_empty() || !eyes.iter().flatten().all(|v| v.is_finite()) => {
                invalid(Parameter::Observer, format!("{eyes:?}"), "one or more places with a height")
            }
            Self::Viewshed { eyes, max_distance, is_reverse } => {
                let limits =
                    SightLimits { distance: [0.0, max_distance.unwrap_or(f64::INFINITY)], ..SightLimits::default() };
                limits.validate()?;
                let observers = eyes.iter().map(|&eye| Observer { eye, limits }).collect();
                Ok(PreparedQuestion::Viewshed { observers, is_reverse: *is_reverse })
            }
            Self::Probability { of, certain, .. } => match of.prepare(crowns, context, control)? {
                PreparedQuestion::Light(light) if !matches!(light, LightQuestion::Shadow(_)) || gives_shares => {
                    let expected = "that of a sun with opaque trees, or of observers";
                    invalid(Parameter::Certainty, of.name().to_owned(), expected)
                }
                PreparedQuestion::Probability { .. } => {
                    invalid(Parameter::Certainty, of.name().to_owned(), "that of answers")
                }
                of => Ok(PreparedQuestion::Probability {
                    of: Box::new(of),
                    certainty: certain.map(Certainty::new).transpose()?,
                }),
            },
        }
    }
}
