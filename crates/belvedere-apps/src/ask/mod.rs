//! Questions: the one way from a user's request to an answer, for the command line, Python, the page and cities.
//!
//! A face parses the user's input into a [`Question`] and [`Places`], puts it to a [`Scene`] with [`ask`], and shows
//! the [`Answers`]. Defaults, checks, warnings and the third state of an answer are made here, so that no face has its
//! own.
//!
//! | step | module |
//! |---|---|
//! | what there is to find | [`Question`], a module for each |
//! | places, and those without an answer | [`places`] |
//! | suns, days, clocks, north | [`sun`], [`north`] |
//! | who looks, and who cannot | [`observers`] |
//! | the scene, and what questions share | [`scene`] |
//! | warnings and notes | [`remark`] |
//! | figures beside the answer | [`report`] |

mod cameras;
mod comfort;
mod depth_map;
mod envelope;
mod glare;
mod heat;
mod horizon;
mod how_sure;
mod in_parts;
mod irradiance;
mod isovist;
mod landmark;
mod line_of_sight;
mod mesh_levels;
pub mod north;
pub mod observers;
pub mod places;
mod protected_view;
mod reliability;
pub mod remark;
pub mod report;
pub mod scene;
pub mod sections;
mod shadow;
mod shared;
mod sight_network;
mod single_places;
mod sky_view;
pub mod sun;
mod sun_and_sky;
mod sun_calendar;
mod sun_hours;
mod sun_place;
mod sun_position;
mod survey;
mod survey_plan;
mod terrain_heights;
mod towers;
mod trees;
mod view_targets;
mod viewer;
mod viewshed;
mod window_views;
pub mod windows;

pub use cameras::{
    CameraGoal, CameraLens, CameraTargets, CamerasQuestion, CamerasResults, Candidates, ChosenCamera, GivenCamera,
    PrivatePlaces,
};
pub use comfort::{ComfortQuestion, ComfortResults, ExposureSection, RoutesOrWindows};
pub use depth_map::{DepthMapQuestion, DepthMapResults, PictureSection, ViewFrom, ViewSection};
pub use envelope::{EnvelopeQuestion, EnvelopeResults, EnvelopeSection, Protected, ProtectedShape, ProtectedSuns};
pub use glare::{GlareQuestion, GlareResults, GlareSection, GlareSummary};
pub use heat::{HeatQuestion, HeatSection};
pub use horizon::{BelowLevel, HorizonQuestion, HorizonResults};
pub use how_sure::{
    BEING_FREE, CertaintySection, EXPECTED, EXPECTED_OBSERVERS, HowSure, PROBABILITY, UNCERTAIN, check_interval,
    knows_intervals, remark_from_ground,
};
pub use in_parts::summarise_parts;
pub use irradiance::{
    IrradianceQuestion, IrradianceResults, PvChoice, Radiation, Roofs, RoofsResults, remark_on_radiation,
};
pub use isovist::{IsovistColumn, IsovistsQuestion, IsovistsResults};
pub use landmark::{LandmarkQuestion, LandmarkResults, LandmarkSection, LandmarkShape};
pub use line_of_sight::{LinesOfSightQuestion, ProfileRows, SightColumns, SightsResults};
pub use mesh_levels::remarks_on_model;
pub use north::{AzimuthNorth, North};
pub use observers::{Eyes, Reach, Standing};
pub use places::{GridCells, NetworkPlaces, Places, Turned, remark_on_edge, remark_on_empty_areas};
pub use protected_view::{ProtectedViewQuestion, ProtectedViewResults};
pub use reliability::{calibrate, with_reliability};
pub use remark::{Remark, Severity, remark_on_left_out};
pub use report::Report;
pub use scene::Scene;
pub use shadow::{CASTER, ShadowQuestion, ShadowResults, UNPROVEN, caster_name};
pub use shared::SharedObject;
pub use sight_network::{NetworkSection, SightNetwork};
pub use single_places::{HeightFrom, PlaceSection, end_on_map, position_on_map, standing_on_map};
pub use sky_view::{SkyParts, SkyViewQuestion};
pub use sun::{Days, NamedSun, SunRange, Suns, check_sun, remark_on_sun};
pub use sun_and_sky::OnTargets;
pub use sun_calendar::{SunCalendarQuestion, SunCalendarResults};
pub use sun_hours::{HourlySun, SunHoursQuestion, rules};
pub use sun_place::{SOLAR, SunPlace};
pub use sun_position::{SunPositionQuestion, SunStands};
pub use survey::remarks_on_survey;
pub use survey_plan::{PlannedStation, SurveyPlanQuestion, SurveyPlanResults};
pub use terrain_heights::remark_on_terrain;
pub use towers::{FarTowers, GivenTower, MAX_WIRELINES, TowerWirelines, TowersQuestion, TowersResults, TowersSection};
pub use trees::{ThroughTrees, density_at, remark_on_leaves};
pub use view_targets::{FacesSection, TargetsSection, ViewTargetsQuestion, ViewTargetsResults};
pub use viewer::{
    remark_on_axis, remark_on_cleared, remark_on_doubt, remark_on_eye, remark_on_faces, remark_on_inside,
    remark_on_mesh, remark_on_outside, remark_on_roofs, remark_on_targets_beside, remark_on_targets_inside,
    remark_on_unused, remarks_on_reading,
};
pub use viewshed::{
    FarSeen, SeenSection, StandingObserver, ViewLimits, ViewshedQuestion, ViewshedResults, ViewshedTargets,
};
pub use window_views::{WindowViewsQuestion, WindowViewsResults};
pub use windows::{GivenWindow, GivenWindows};

use crate::targets::Measure;
use belvedere_core::ground::{GroundReport, GroundShift, ShiftEvidence};
use belvedere_data::control::Control;
use belvedere_data::report::rounded;
use belvedere_data::{Frame, Result};
use scene::KnownGround;
use sections::GroundSection;
use serde::{Deserialize, Serialize};

/// All questions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
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
    ($($name:ident: $question:ty),* $(,)?) => {
        $(impl From<$question> for Question {
            fn from(question: $question) -> Self {
                Self::$name(question)
            }
        })*

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
        }
    };
}

one_of_all! {
    Shadow: ShadowQuestion,
    SunHours: SunHoursQuestion,
    SunCalendar: SunCalendarQuestion,
    Glare: GlareQuestion,
    SkyView: SkyViewQuestion,
    Irradiance: IrradianceQuestion,
    Heat: HeatQuestion,
    SunPosition: SunPositionQuestion,
    LineOfSight: LinesOfSightQuestion,
    Horizon: HorizonQuestion,
    Isovist: IsovistsQuestion,
    Viewshed: ViewshedQuestion,
    Towers: TowersQuestion,
    Landmark: LandmarkQuestion,
    WindowViews: WindowViewsQuestion,
    ProtectedView: ProtectedViewQuestion,
    Cameras: CamerasQuestion,
    SurveyPlan: SurveyPlanQuestion,
    DepthMap: DepthMapQuestion,
    ViewTargets: ViewTargetsQuestion,
    Comfort: ComfortQuestion,
    Envelope: EnvelopeQuestion,
}

/// The answers to a question.
#[derive(Clone, Debug)]
pub struct Answers<F> {
    /// Results beside measures.
    pub found: F,
    /// A value for each target, of each thing that was measured.
    pub measures: Vec<Measure>,
    /// The answer in a few lines: the quantity computed, and its main figures.
    pub headline: Vec<String>,
    /// Warnings and notes.
    pub remarks: Vec<Remark>,
    /// All figures.
    pub report: Report,
}

/// Report, headline and remarks gathered on the way to an answer.
#[derive(Clone, Debug, Default)]
pub struct Context {
    /// All figures.
    pub report: Report,
    headline: Vec<String>,
    remarks: Vec<Remark>,
}

/// A question.
pub trait Ask {
    /// Type of the results beside measures.
    type Found;

    /// Checks all that does not depend on a scene: hours of work may go into one.
    ///
    /// # Errors
    /// [`InvalidParameter`](belvedere_data::Error::InvalidParameter) for values that are not possible.
    fn check(&self) -> Result<()>;

    /// Finds the answers; remarks and further results go into `context`. Call [`ask`].
    ///
    /// # Errors
    /// Those of the question.
    fn answer(
        &self,
        scene: &Scene,
        places: &Places,
        context: &mut Context,
        control: &Control<'_>,
    ) -> Result<Answers<Self::Found>>;
}

/// Puts a question about places to a scene.
///
/// # Errors
/// Those of the question: [`InvalidParameter`](belvedere_data::Error::InvalidParameter) for values that are not
/// possible, and [`Cancelled`](belvedere_data::Error::Cancelled).
pub fn ask<Q: Ask>(scene: &Scene, question: &Q, places: &Places, control: &Control<'_>) -> Result<Answers<Q::Found>> {
    question.check()?;
    let mut context = Context::default();
    scene.whereabouts().remark(&mut context);
    context.add(scene.remark_on_terrain());
    context.add(scene.remark_on_ground_cloud());
    remarks_on_model(scene.model()).into_iter().for_each(|remark| context.add(Some(remark)));
    for remark in remarks_on_survey(&scene.model().findings(), scene.frame()) {
        context.add(Some(remark));
    }
    context.add(reliability::remark_on_reliability(scene.model().parts()));
    let answers = question.answer(scene, places, &mut context, control)?;
    for sentence in single_places::sentences(&context.report.at, &answers.measures) {
        context.headline(sentence);
    }
    Ok(answers.with(context))
}

impl<F> Answers<F> {
    /// Returns the zone of the clock that times and days were read by; `None` where there was none.
    #[must_use]
    pub fn time_zone(&self) -> Option<&str> {
        let of_suns = self.report.sun.as_ref().and_then(|sun| sun.time_zone.as_deref());
        of_suns.or_else(|| self.report.period.as_ref().map(|period| period.time_zone.as_str()))
    }

    /// Creates answers without the contents of a [`Context`].
    fn new(found: F, measures: Vec<Measure>) -> Self {
        Self { found, measures, headline: Vec::new(), remarks: Vec::new(), report: Report::default() }
    }

    /// This with the contents of `context`.
    #[must_use]
    pub fn with(self, context: Context) -> Self {
        let Context { report, headline, remarks } = context;
        Self { report, headline, remarks, ..self }
    }
}

impl Context {
    /// Adds a remark, if there is one.
    pub fn add(&mut self, remark: Option<Remark>) {
        // what is found on two ways is said once
        self.remarks.extend(remark.filter(|remark| !self.remarks.contains(remark)));
    }

    /// Adds a line of the answer.
    pub fn headline(&mut self, line: String) {
        self.headline.push(line);
    }

    /// Converts the report, headline and remarks into answers without anything else.
    #[must_use]
    pub fn into_answers(self) -> Answers<()> {
        Answers::new((), Vec::new()).with(self)
    }

    /// Reports on the ground of a scene, and warns of points that say they are ground and contradict others.
    fn ground(&mut self, scene: &Scene, known: &KnownGround) {
        self.report.ground = Some(GroundSection::of(known));
        let GroundReport { doubted_count, point_count, .. } = known.report;
        let so = "lie metres below or above the ground around, and are not believed";
        let count = doubted_count + point_count;
        let is_new = self.remarks.iter().all(|remark| remark.key != "ground-not-believed");
        self.add(
            Remark::of_share("ground-not-believed", doubted_count, count, "points of class 2", so).filter(|_| is_new),
        );
        self.add(known.report.shift.map(|shift| remark_on_shift(&shift, scene.frame())));
    }

    fn north(&mut self, north: &AzimuthNorth) {
        self.report.north = Some(north.report());
        self.add(north.remark());
    }
}

/// A warning of ground points that lie off over an area.
fn remark_on_shift(shift: &GroundShift, frame: &Frame) -> Remark {
    let GroundShift { point_count, rise, low, high, against } = *shift;
    let corner = |[x, y]: [f32; 2]| {
        let [x, y, _] = frame.file_from_local([f64::from(x), f64::from(y), 0.0]);
        [x, y].map(|v| rounded(v, 1))
    };
    let [[west, south], [east, north]] = [low, high].map(corner);
    let rise = rounded(f64::from(rise), 2);
    let lie = format!("lie {:.2} m {}", rise.abs(), if rise < 0.0 { "below" } else { "above" });
    let which = match against {
        ShiftEvidence::SecondLevel => format!("{lie} others of class 2 at the same places"),
        ShiftEvidence::Strips { shifted, other } => {
            format!("(point source {shifted}) {lie} those of point source {other} where the two meet")
        }
    };
    let text = format!(
        "{point_count} points of class 2 {which}, between {west}, {south} and {east}, {north}: heights of the ground \
         are wrong there; correct the heights or the class of these points"
    );
    let remark = Remark::warning("ground-shifted", text).with("count", point_count as f64).with("rise_m", rise);
    remark.with("west", west).with("south", south).with("east", east).with("north", north)
}

/// Describes the statistics of values, such as "mean 5.3 hours (0 to 11.2)"; values that are not finite do not count.
fn spread(values: &[f32], digits: i32, unit: &str) -> String {
    let known = || values.iter().filter(|value| value.is_finite()).map(|&value| f64::from(value));
    let count = known().count();
    if count == 0 {
        return "no target has an answer".to_owned();
    }
    let figures = [
        known().sum::<f64>() / count as f64,
        known().fold(f64::INFINITY, f64::min),
        known().fold(f64::NEG_INFINITY, f64::max),
    ];
    let [mean, low, high] = figures.map(|value| rounded(value, digits));
    let space = if unit.is_empty() || unit == "%" { "" } else { " " };
    match low < high {
        true => format!("mean {mean}{space}{unit} ({low} to {high})"),
        false => format!("{mean}{space}{unit}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
        }
    }

    #[test]
    fn one_value_has_no_spread() {
        assert_eq!(spread(&[5.25, f32::NAN], 1, "hours"), "5.3 hours");
        assert_eq!(spread(&[5.0, 6.0], 1, "%"), "mean 5.5% (5 to 6)");
        assert_eq!(spread(&[f32::NAN], 1, "%"), "no target has an answer");
    }
}
