//! All questions in one type.

use super::answers::{Answers, Ask, ask};
use super::cameras::CamerasQuestion;
use super::comfort::ComfortQuestion;
use super::depth_map::DepthMapQuestion;
use super::envelope::EnvelopeQuestion;
use super::glare::GlareQuestion;
use super::heat::HeatQuestion;
use super::horizon::HorizonQuestion;
use super::irradiance::IrradianceQuestion;
use super::isovist::IsovistsQuestion;
use super::landmark::LandmarkQuestion;
use super::line_of_sight::LinesOfSightQuestion;
use super::places::Places;
use super::protected_view::ProtectedViewQuestion;
use super::scene::Scene;
use super::shadow::ShadowQuestion;
use super::sky_view::SkyViewQuestion;
use super::sun_calendar::SunCalendarQuestion;
use super::sun_hours::SunHoursQuestion;
use super::sun_position::SunPositionQuestion;
use super::survey_plan::SurveyPlanQuestion;
use super::towers::TowersQuestion;
use super::view_targets::ViewTargetsQuestion;
use super::viewshed::ViewshedQuestion;
use super::window_views::WindowViewsQuestion;
use belvedere_data::Result;
use belvedere_data::control::Control;
use serde::{Deserialize, Serialize};

/// All questions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Question {
    /// Places in the sun.
    Shadow(ShadowQuestion),
    /// Hours of sun at places.
    SunHours(SunHoursQuestion),
    /// Sun and shade at windows or places, from when to when.
    SunCalendar(SunCalendarQuestion),
    /// Sun that panels and glass reflect to observers.
    Glare(GlareQuestion),
    /// Visible part of the sky.
    SkyView(SkyViewQuestion),
    /// Energy of sun and sky.
    Irradiance(IrradianceQuestion),
    /// Radiant temperature and thermal stress of people.
    Heat(HeatQuestion),
    /// Position of the sun.
    SunPosition(SunPositionQuestion),
    /// Visibility between observers and targets, pair by pair.
    LineOfSight(LinesOfSightQuestion),
    /// Above which elevation the sky is free.
    Horizon(HorizonQuestion),
    /// The space that observers see.
    Isovist(IsovistsQuestion),
    /// Places visible from observers, or from which a target is visible.
    Viewshed(ViewshedQuestion),
    /// Visible metres of towers.
    Towers(TowersQuestion),
    /// Views of a landmark, with its visible part.
    Landmark(LandmarkQuestion),
    /// Views from windows.
    WindowViews(WindowViewsQuestion),
    /// Maximum building height outside the view of a landmark.
    ProtectedView(ProtectedViewQuestion),
    /// Selection of cameras to install.
    Cameras(CamerasQuestion),
    /// Stations for another scan.
    SurveyPlan(SurveyPlanQuestion),
    /// The distance to the first surface for each pixel of a view.
    DepthMap(DepthMapQuestion),
    /// Targets of one view.
    ViewTargets(ViewTargetsQuestion),
    /// Sun and sky along routes and at windows.
    Comfort(ComfortQuestion),
    /// Maximum building height that keeps protected sun.
    Envelope(EnvelopeQuestion),
}

/// Makes any question one of all.
macro_rules! one_of_all {
    ($($name:ident: $question:ty = $command:literal),* $(,)?) => {
        $(impl From<$question> for Question {
            fn from(question: $question) -> Self {
                Self::$name(question)
            }
        })*

        /// Results of any question beside measures.
        #[non_exhaustive]
        pub enum Found {
            $(#[doc = concat!("Those of [`", stringify!($question), "`].")] $name(<$question as Ask>::Found),)*
        }

        impl Question {
            /// Checks all that does not depend on a scene.
            ///
            /// # Errors
            /// Those of the question.
            pub fn check(&self) -> Result<()> {
                match self {
                    $(Self::$name(question) => question.check(),)*
                }
            }

            /// Puts the question to a scene, as [`ask`] does.
            ///
            /// # Errors
            /// Those of [`ask`].
            pub fn ask(&self, scene: &Scene, places: &Places, control: &Control<'_>) -> Result<Answers<Found>> {
                match self {
                    $(Self::$name(question) => Ok(ask(scene, question, places, control)?.map(Found::$name)),)*
                }
            }

            /// Returns the command of the program that asks such a question.
            #[must_use]
            pub fn command(&self) -> &'static str {
                match self {
                    $(Self::$name(_) => $command,)*
                }
            }
        }
    };
}

one_of_all! {
    Shadow: ShadowQuestion = "shadow",
    SunHours: SunHoursQuestion = "sun-hours",
    SunCalendar: SunCalendarQuestion = "sun-calendar",
    Glare: GlareQuestion = "glare",
    SkyView: SkyViewQuestion = "sky-view",
    Irradiance: IrradianceQuestion = "irradiance",
    Heat: HeatQuestion = "heat",
    SunPosition: SunPositionQuestion = "sun-position",
    LineOfSight: LinesOfSightQuestion = "line-of-sight",
    Horizon: HorizonQuestion = "horizon",
    Isovist: IsovistsQuestion = "isovist",
    Viewshed: ViewshedQuestion = "viewshed",
    Towers: TowersQuestion = "towers",
    Landmark: LandmarkQuestion = "landmark",
    WindowViews: WindowViewsQuestion = "window-views",
    ProtectedView: ProtectedViewQuestion = "protected-view",
    Cameras: CamerasQuestion = "cameras",
    SurveyPlan: SurveyPlanQuestion = "survey-plan",
    DepthMap: DepthMapQuestion = "depth-map",
    ViewTargets: ViewTargetsQuestion = "query",
    Comfort: ComfortQuestion = "comfort",
    Envelope: EnvelopeQuestion = "envelope",
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ask::sky_view::SkyParts;

    #[test]
    fn questions_come_back_from_text_as_they_were() {
        let questions = [
            Question::LineOfSight(LinesOfSightQuestion { target_height: Some(2.0), ..LinesOfSightQuestion::default() }),
            Question::Viewshed(ViewshedQuestion { reverse: true, cell: Some(0.5), ..ViewshedQuestion::default() }),
            Question::Horizon(HorizonQuestion { angle_step_deg: Some(5.0), ..HorizonQuestion::default() }),
            Question::Isovist(IsovistsQuestion { min_jump: Some(0.5), ..IsovistsQuestion::default() }),
            Question::SkyView(SkyViewQuestion { sky: SkyParts::Reinhart, ..SkyViewQuestion::default() }),
            Question::SunHours(SunHoursQuestion {
                rules: vec!["bre-equinox".to_owned()],
                ..SunHoursQuestion::default()
            }),
            Question::DepthMap(DepthMapQuestion { ball_ids: true, ..DepthMapQuestion::default() }),
            Question::SunPosition(SunPositionQuestion {
                times: vec!["2026-06-21T13:00Z".to_owned()],
                ..SunPositionQuestion::default()
            }),
        ];
        for question in questions {
            let text = serde_json::to_string(&question).unwrap();
            assert_eq!(serde_json::from_str::<Question>(&text).unwrap(), question, "{text}");
            // the command has the name of the question
            assert_eq!(text.split('"').nth(1), Some(question.command()), "{text}");
        }
    }
}
