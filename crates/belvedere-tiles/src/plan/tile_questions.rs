//! Questions about tiles that a question about a survey becomes.

use crate::plan::Plan;
use crate::plan::question::{TileQuestion, TileRadiation};
use crate::plan::side_files::SideFile;
use belvedere::apps::ask::scene::Whereabouts;
use belvedere::apps::ask::{self, Context, SunHoursQuestion};
use belvedere::apps::irradiance::Grouping;
use belvedere::apps::shadow::Edges;
use belvedere::control::Control;
use belvedere::query::{EarthParams, UnprovenAs};
use belvedere::{Error, Parameter, Result};
use std::path::Path;

impl TileQuestion {
    /// Returns the questions about tiles for a question about the survey of `plan`, one for each result. Figures and
    /// remarks go into `context`.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for impossible parameters, and for a question that tiles do not answer. Also those
    /// of [`Plan::set_on_ground`].
    pub fn of(
        question: &ask::Question,
        (plan, whereabouts): (&Plan, &Whereabouts<'_>),
        context: &mut Context,
        control: &Control<'_>,
    ) -> Result<Vec<Self>> {
        question.check()?;
        if let Some(what) = Self::not_in_tiles(question) {
            let value = format!("with {what}");
            return Err(Error::invalid(Parameter::Questions, value, "without: runs in tiles do not give them"));
        }
        match question {
            ask::Question::Shadow(shadow) => {
                let suns = shadow.suns.resolve(&shadow.place, whereabouts, context)?;
                Ok(Self::of_suns(&suns, &shadow.how_sure))
            }
            ask::Question::SunHours(hours) => {
                let site = hours.place.site_at(whereabouts, context, None)?;
                context.add(hours.place.remark_on_border(&site, hours.days.times())?);
                let mut questions = Vec::new();
                if !hours.days.is_empty() {
                    let days = SunHoursQuestion { rules: Vec::new(), ..hours.clone() };
                    questions.push(Self::SunHours { site, days });
                }
                for (text, (column, _)) in hours.rules.iter().zip(ask::rules(&hours.rules)?) {
                    let days = ask::Days { dates: Vec::new(), between: None, ..hours.days.clone() };
                    let days = SunHoursQuestion { days, rules: vec![text.clone()], interval: false, ..hours.clone() };
                    questions.push(Self::SunRule { name: column.to_owned(), site, days });
                }
                Ok(questions)
            }
            ask::Question::SkyView(view) => Ok(vec![Self::SkyView { sky: view.sky, interval: view.interval }]),
            ask::Question::Irradiance(energy) => {
                let station = energy.radiation.weather().map(|weather| [weather.latitude, weather.longitude]);
                let site = energy.place.site_at(whereabouts, context, station)?;
                let radiation = match &energy.radiation {
                    ask::Radiation::Weather { file, parts, .. } => {
                        TileRadiation::Weather { file: SideFile::new(Path::new(file))?, parts: *parts }
                    }
                    ask::Radiation::ClearSky { clear_sky, year } => {
                        TileRadiation::ClearSky { clear_sky: *clear_sky, year: *year }
                    }
                };
                Ok(vec![Self::Irradiance { site, radiation, params: energy.params, interval: energy.interval }])
            }
            ask::Question::Viewshed(view) => {
                let mut eyes = Vec::new();
                for (mut eye, height) in view.standing() {
                    plan.set_on_ground(std::slice::from_mut(&mut eye), height, control)?;
                    eyes.push(eye);
                }
                let seen = Self::Viewshed { eyes, max_distance: view.limits.max_distance, is_reverse: view.reverse };
                Ok(seen.with_probability(&view.how_sure))
            }
            _ => Err(Error::invalid(
                Parameter::Questions,
                "another",
                "shadow, sun hours, rules of sunlight, sky view, irradiance or viewsheds",
            )),
        }
    }

    /// Returns this question, followed by the question about its probability if that is wanted.
    fn with_probability(self, how_sure: &ask::HowSure) -> Vec<Self> {
        let is_of_several = self.is_of_several();
        let likely = how_sure.is_wanted().then(|| Self::Probability {
            name: format!("{}_probability", self.name()),
            of: Box::new(self.clone()),
            certain: how_sure.certain.filter(|_| is_of_several),
        });
        [self].into_iter().chain(likely).collect()
    }

    /// Returns the questions about shadows of suns.
    pub(crate) fn of_suns<'a>(suns: impl IntoIterator<Item = &'a ask::NamedSun>, how_sure: &ask::HowSure) -> Vec<Self> {
        let question = |sun: &ask::NamedSun| Self::Shadow {
            name: format!("shadow_{}", sun.label),
            to_sun: sun.sun.to_sun,
            season: sun.sun.season,
        };
        suns.into_iter().map(question).flat_map(|sun| sun.with_probability(how_sure)).collect()
    }

    /// Returns the first part of a question that tiles do not support; `None` if they support all of it.
    #[must_use]
    pub fn not_in_tiles(question: &ask::Question) -> Option<&'static str> {
        let counts = |unproven: Option<UnprovenAs>| unproven.is_some_and(|choice| choice != UnprovenAs::Reported);
        let parts: &[(&str, bool)] = match question {
            ask::Question::Shadow(shadow) => &[
                ("soft edges", shadow.edges == Edges::Soft),
                ("unproven light that counts as lit or as blocked", counts(shadow.unproven)),
            ],
            ask::Question::Viewshed(view) => {
                let limits = &view.limits;
                let is_turned = [limits.azimuth_range_deg, limits.elevation_range_deg].iter().any(Option::is_some);
                let has_own = view.observers.iter().any(|one| one.limits != ask::ViewLimits::default());
                &[
                    ("ranges of azimuth or elevation, or a least distance", is_turned || limits.min_distance.is_some()),
                    ("limits of single observers", has_own),
                    ("another curvature or refraction", view.earth != EarthParams::default()),
                    ("unproven views that count as visible or as blocked", counts(view.unproven)),
                    ("targets other than cells", view.targets != [ask::ViewshedTargets::Cells]),
                    ("masks of observers", view.masks),
                    ("heights that are seen", view.max_height.is_some()),
                ]
            }
            ask::Question::Irradiance(energy) => {
                &[("roof planes", energy.roofs.is_some()), ("months", energy.params.grouping != Grouping::Whole)]
            }
            _ => &[],
        };
        parts.iter().find(|(_, is_wanted)| *is_wanted).map(|(what, _)| *what)
    }
}
