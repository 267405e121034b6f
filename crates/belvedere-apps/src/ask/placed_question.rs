//! A question with its places, as JSON has them.

use super::answers::Answers;
use super::given_places::GivenPlaces;
use super::irradiance::Radiation;
use super::landmark::LandmarkShape;
use super::places::Places;
use super::question::{Found, Question};
use super::scene::Scene;
use super::viewshed::{StandingObserver, ViewLimits};
use belvedere_data::control::Control;
use belvedere_data::weather::Weather;
use belvedere_data::{Error, Parameter, Result};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// A question about places.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct PlacedQuestion {
    /// The question.
    pub question: Question,
    /// Its places.
    #[serde(default)]
    pub places: GivenPlaces,
}

impl PlacedQuestion {
    /// Checks all that does not depend on a scene.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for places of another kind than the question is about; those of the question.
    pub fn check(&self) -> Result<()> {
        use GivenPlaces::{Eyes, Pairs};
        use Question::{Horizon, Isovist, Landmark, LineOfSight, SurveyPlan, Viewshed};
        let expected = match (&self.question, &self.places) {
            (Horizon(_) | Isovist(_) | Viewshed(_) | Landmark(_), Eyes(_)) => None,
            (LineOfSight(_) | SurveyPlan(_), Pairs(_)) => None,
            (Horizon(_) | Isovist(_) | Viewshed(_), _) => Some(r#"given as places {"eyes": [[x, y], [x, y, z]]}"#),
            (LineOfSight(_), _) => Some(r#"given with a target each, as places {"pairs": [[[x, y], [x, y, z]]]}"#),
            (_, Eyes(_) | Pairs(_)) => Some("left out: the question is about other places, such as cells"),
            _ => None,
        };
        if let Some(expected) = expected {
            let value = if matches!(self.places, Eyes(_) | Pairs(_)) { "given" } else { "missing" };
            return Err(Error::invalid(Parameter::Observer, value, expected));
        }
        self.question.check()
    }

    /// Puts the question about its places to a scene.
    ///
    /// # Errors
    /// Those of [`GivenPlaces::of_scene`] and of [`ask`](super::ask).
    pub fn ask(&self, scene: &Scene, control: &Control<'_>) -> Result<Answers<Found>> {
        match (&self.question, self.places.of_scene(scene)?) {
            (Question::Viewshed(question), Places::Eyes(eyes)) => {
                let limits = ViewLimits::default();
                let observers = eyes.into_iter().map(|standing| StandingObserver { standing, limits }).collect();
                let mut question = question.clone();
                question.observers = observers;
                Question::Viewshed(question).ask(scene, &Places::Scene, control)
            }
            (Question::Landmark(question), Places::Eyes(eyes)) => {
                let mut question = question.clone();
                question.observers = Some(eyes);
                Question::Landmark(question).ask(scene, &Places::Scene, control)
            }
            (question, places) => question.ask(scene, &places, control),
        }
    }
}

impl Question {
    /// Returns the objects of the question that JSON does not hold; `None` if JSON holds all of it.
    #[must_use]
    pub fn beyond_json(&self) -> Option<&'static str> {
        match self {
            Self::Glare(_) => Some("reflectors"),
            Self::Towers(_) => Some("towers"),
            Self::WindowViews(_) => Some("windows"),
            Self::ProtectedView(_) => Some("a landmark"),
            Self::DepthMap(_) | Self::ViewTargets(_) => Some("a view"),
            Self::Comfort(_) => Some("routes or windows"),
            Self::Envelope(_) => Some("a parcel"),
            Self::Landmark(question) => match question.shape {
                LandmarkShape::Class(_) => None,
                LandmarkShape::Mesh { .. } | LandmarkShape::Inside { .. } => Some("the shape of a landmark"),
            },
            _ => None,
        }
    }

    /// Returns the weather of the question, as the name of its file and its rows; `None` if it has no weather.
    pub fn weather_mut(&mut self) -> Option<(&str, &mut Option<Arc<Weather>>)> {
        match self {
            Self::Heat(question) => Some((&question.file, &mut question.weather)),
            Self::Irradiance(question) => match &mut question.radiation {
                Radiation::Weather { file, weather, .. } => Some((file, weather)),
                Radiation::ClearSky { .. } => None,
            },
            _ => None,
        }
    }
}
