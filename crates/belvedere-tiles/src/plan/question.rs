//! Questions about a city: those of `ask`, with what a plan must keep of them.

use crate::plan::Plan;
use crate::plan::side_files::SideFile;
use belvedere::apps::ask::scene::Whereabouts;
use belvedere::apps::ask::{
    Context, HowSure, IrradianceQuestion, Question, Radiation, ShadowQuestion, Standing, StandingObserver,
    SunHoursQuestion, Suns, ViewLimits,
};
use belvedere::apps::targets::Measure;
use belvedere::control::Control;
use belvedere::io::{Source, read_weather};
use belvedere::{Error, Parameter, Result};
use serde::{Deserialize, Serialize};
use std::path::Path;
use std::sync::Arc;

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

    /// Returns the topic of a question; `None` for one without values of cells.
    fn of(question: &Question) -> Option<Self> {
        Some(match question {
            Question::Shadow(_) => Self::Shadow,
            Question::SunHours(hours) if hours.days.is_empty() => Self::Rule,
            Question::SunHours(_) => Self::SunHours,
            Question::SkyView(_) => Self::SkyView,
            Question::Irradiance(_) => Self::Irradiance,
            Question::Viewshed(_) => Self::Viewshed,
            _ => return None,
        })
    }
}

/// Question with an answer for each cell of a survey.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TileQuestion {
    /// Name of the folder of its results.
    pub name: String,
    /// Question, without its observers and its weather.
    question: Question,
    /// Observers of a viewshed, or the target of a reverse one.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    observers: Vec<PlannedObserver>,
    /// File of weather.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    weather: Option<SideFile>,
    /// Names of the measures that results keep; empty for all.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    kept: Vec<String>,
}

/// Observer whose height is known.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct PlannedObserver {
    /// Local metres.
    eye: [f64; 3],
    limits: ViewLimits,
}

impl TileQuestion {
    /// Creates a question whose results lie in a folder of this name. Eyes of viewsheds must have heights
    /// ([`Plan::set_on_ground`]).
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a question without values of cells, and for eyes that are missing or not finite.
    /// Also those of reading the weather file.
    pub fn new(name: &str, question: Question) -> Result<Self> {
        let mut question = question;
        let (mut observers, mut weather) = (Vec::new(), None);
        match &mut question {
            Question::Viewshed(view) => {
                let planned = |one: StandingObserver| PlannedObserver { eye: one.standing.place, limits: one.limits };
                observers = std::mem::take(&mut view.observers).into_iter().map(planned).collect();
                let eyes = || observers.iter().map(|one: &PlannedObserver| one.eye);
                if observers.is_empty() || !eyes().flatten().all(f64::is_finite) {
                    let value = format!("{:?}", eyes().collect::<Vec<_>>());
                    return Err(Error::invalid(Parameter::Observer, value, "one or more places with a height"));
                }
            }
            Question::Irradiance(IrradianceQuestion {
                radiation: Radiation::Weather { file, weather: rows, .. },
                ..
            }) => {
                weather = Some(SideFile::new(Path::new(file))?);
                *rows = None;
            }
            Question::Shadow(_) | Question::SunHours(_) | Question::SkyView(_) | Question::Irradiance(_) => {}
            _ => {
                let expected = "shadow, sun hours, rules of sunlight, sky view, irradiance or viewsheds";
                return Err(Error::invalid(Parameter::Questions, "another", expected));
            }
        }
        Ok(Self { name: name.to_owned(), question, observers, weather, kept: Vec::new() })
    }

    /// Returns the question about all cells of a survey. Eyes of viewsheds are set on the ground.
    ///
    /// # Errors
    /// Those of [`TileQuestion::new`] and [`Plan::set_on_ground`].
    pub fn of_survey(question: &Question, plan: &Plan, control: &Control<'_>) -> Result<Self> {
        question.check()?;
        let mut question = question.clone();
        match &mut question {
            Question::Viewshed(view) => {
                let standing: Vec<([f64; 3], f64)> = view.standing().collect();
                for (one, (mut eye, height)) in view.observers.iter_mut().zip(standing) {
                    plan.set_on_ground(std::slice::from_mut(&mut eye), height, control)?;
                    one.standing = Standing { place: eye, height: None };
                }
                view.how_sure = summarised(view.how_sure);
            }
            Question::Shadow(shadow) => shadow.how_sure = summarised(shadow.how_sure),
            _ => {}
        }
        let name = Topic::of(&question).map_or("result", Topic::name);
        Self::new(name, question)
    }

    /// Returns the questions of a plan for many machines: one for each sun and each rule.
    ///
    /// # Errors
    /// Those of [`TileQuestion::of_survey`] and of suns.
    pub fn one_by_one(
        question: &Question,
        (plan, whereabouts): (&Plan, &Whereabouts<'_>),
        control: &Control<'_>,
    ) -> Result<Vec<Self>> {
        let of_one =
            |name: &str, question: Question| Self::of_survey(&question, plan, control).map(|one| one.named(name));
        match question {
            Question::Shadow(shadow) => {
                let each: Vec<Suns> = match &shadow.suns {
                    Suns::Directions(suns) => suns.iter().map(|sun| Suns::Directions(vec![*sun])).collect(),
                    Suns::Times(times) => times.iter().map(|time| Suns::Times(vec![time.clone()])).collect(),
                    days @ Suns::Days(_) => vec![days.clone()],
                };
                let of_sun = |suns: Suns| {
                    let named = suns.resolve(&shadow.place, whereabouts, &mut Context::default())?;
                    if let Some(low) = named.iter().find(|named| named.sun.to_sun[2] <= 0.0) {
                        let elevation = low.sun.to_sun[2].clamp(-1.0, 1.0).asin().to_degrees();
                        let value = format!("{elevation:.3} degrees");
                        return Err(Error::invalid(Parameter::SunElevation, value, "above the horizon"));
                    }
                    let label = named.first().map_or("", |sun| sun.label.as_str());
                    of_one(&format!("shadow_{label}"), ShadowQuestion { suns, ..shadow.clone() }.into())
                };
                each.into_iter().map(of_sun).collect()
            }
            Question::SunHours(hours) => {
                let mut questions = Vec::new();
                if !hours.days.is_empty() {
                    let days = SunHoursQuestion { rules: Vec::new(), ..hours.clone() };
                    questions.push(of_one("sun_hours", days.into())?);
                }
                for (text, (column, _)) in hours.rules.iter().zip(belvedere::apps::ask::rules(&hours.rules)?) {
                    let days = belvedere::apps::ask::Days { dates: Vec::new(), between: None, ..hours.days.clone() };
                    let rule = SunHoursQuestion { days, rules: vec![text.clone()], interval: false, ..hours.clone() };
                    questions.push(Self { kept: vec![column.to_owned()], ..of_one(column, rule.into())? });
                }
                Ok(questions)
            }
            Question::SkyView(_) => Ok(vec![of_one("sky_view_factor", question.clone())?]),
            Question::Irradiance(_) => Ok(vec![of_one("irradiance", question.clone())?]),
            _ => Ok(vec![of_one("viewshed", question.clone())?]),
        }
    }

    /// This with another name.
    #[must_use]
    pub fn named(self, name: &str) -> Self {
        Self { name: name.to_owned(), ..self }
    }

    /// Removes the measures that results do not keep.
    pub(crate) fn keep(&self, measures: &mut Vec<Measure>) {
        measures.retain(|measure| self.kept.is_empty() || self.kept.contains(&measure.name));
    }

    /// Returns the topic of the question.
    #[must_use]
    pub fn topic(&self) -> Topic {
        Topic::of(&self.question).unwrap_or(Topic::Viewshed)
    }

    /// Returns the question with its observers and its weather.
    ///
    /// # Errors
    /// Those of reading the weather.
    pub(crate) fn whole(&self) -> Result<Question> {
        let mut question = self.question.clone();
        match (&mut question, &self.weather) {
            (Question::Viewshed(view), _) => {
                let standing = |one: &PlannedObserver| StandingObserver {
                    standing: Standing { place: one.eye, height: None },
                    limits: one.limits,
                };
                view.observers = self.observers.iter().map(standing).collect();
            }
            (
                Question::Irradiance(IrradianceQuestion {
                    radiation: Radiation::Weather { weather: rows, .. }, ..
                }),
                Some(file),
            ) => *rows = Some(Arc::new(read_weather(Source::bytes(file.path(), &file.read()?))?)),
            _ => {}
        }
        Ok(question)
    }

    /// Returns the eyes of a viewshed, local metres.
    pub(crate) fn eyes(&self) -> Vec<[f64; 3]> {
        self.observers.iter().map(|one| one.eye).collect()
    }

    /// True if the answers use the proof by pulses.
    pub(crate) fn needs_proof(&self) -> bool {
        matches!(self.question, Question::Shadow(_) | Question::Viewshed(_))
    }
}

/// Returns the request for the certainty of answers whose summary needs probabilities, even if they are not written.
fn summarised(how_sure: HowSure) -> HowSure {
    HowSure { probability: how_sure.is_wanted(), ..how_sure }
}
