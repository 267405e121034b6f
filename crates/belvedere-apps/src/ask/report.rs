//! Report of how answers were found. Sections that a question does not have are left out.

use super::sections::{
    CamerasReport, CertaintySection, EnvelopeSection, ExposureSection, FacesSection, GlareSection, GroundSection,
    HeatSection, HorizonsSection, LandmarkSection, LineSection, LinesSection, LocationSection, MeasuresSection,
    NamedValues, NetworkSection, NorthReport, ObserversSection, PeriodSection, PictureSection, PlaceSection,
    PlacesReport, ProtectedViewSection, PvSection, RadiationSection, RoofsSection, SeenSection, SunSection,
    SurveyPlanSection, TargetsSection, TowersSection, TreesSection, ViewSection, ViewsSection, WindowsSection,
};
use crate::eyes::EyesReport;
use crate::landmark::LandmarkReport;
use crate::survey_reliability::SurveyReliability;
use serde::Serialize;

/// The sections of all questions.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Report {
    /// Location of the scene on earth.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub location: Option<LocationSection>,
    /// North of azimuths.
    #[serde(flatten)]
    pub north: Option<NorthReport>,
    /// The days.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub period: Option<PeriodSection>,
    /// The suns.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sun: Option<SunSection>,
    /// Radiation of sun and sky.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub radiation: Option<RadiationSection>,
    /// Weather and model of heat.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub heat: Option<HeatSection>,
    /// Glare of observers.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub glare: Option<GlareSection>,
    /// The landmark.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub landmark: Option<LandmarkSection>,
    /// Views of towers.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub towers: Option<TowersSection>,
    /// The ground that cells stand on.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ground: Option<GroundSection>,
    /// Roofs that were found.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub roofs: Option<RoofsSection>,
    /// Photovoltaic system on them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub photovoltaics: Option<PvSection>,
    /// The windows.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub windows: Option<WindowsSection>,
    /// Counts of places by outcome.
    #[serde(flatten)]
    pub places: PlacesReport,
    /// Single places of the question.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub at: Vec<PlaceSection>,
    /// Observers.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub observers: Option<ObserversSection>,
    /// Target that is observed from all cells.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub target: Option<ObserversSection>,
    /// Given observers of a landmark that cannot look.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub observers_given: Option<EyesReport>,
    /// Views of a landmark.
    #[serde(rename = "observers", skip_serializing_if = "Option::is_none")]
    pub landmark_views: Option<LandmarkReport>,
    /// Obstacles.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lines_of_sight: Option<LinesSection>,
    /// Certainty of answers.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub certainty: Option<CertaintySection>,
    /// Reliability of answers on a survey.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reliability: Option<SurveyReliability>,
    /// A single line of sight.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub line: Option<LineSection>,
    /// A network of lines of sight.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub network: Option<NetworkSection>,
    /// Statistics of horizons.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub horizons: Option<HorizonsSection>,
    /// The numbers of a single isovist.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub isovist: Option<NamedValues<f64>>,
    /// Visibility of cells.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cells: Option<SeenSection>,
    /// Visibility of points.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cloud_points: Option<SeenSection>,
    /// Visibility of the terrain beyond the cloud.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub far_cells: Option<SeenSection>,
    /// Light through trees.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub trees: Option<TreesSection>,
    /// Views from windows.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub views: Option<ViewsSection>,
    /// Protection of views of a landmark.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub protected_view: Option<ProtectedViewSection>,
    /// Selected cameras.
    #[serde(flatten)]
    pub cameras: Option<CamerasReport>,
    /// Stations for another scan.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub survey_plan: Option<SurveyPlanSection>,
    /// The view of a picture.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub view: Option<ViewSection>,
    /// Content of a picture.
    #[serde(flatten)]
    pub picture: Option<PictureSection>,
    /// Answers of points in a view.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub answers: Option<TargetsSection>,
    /// Visibility of the faces of a mesh.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub faces: Option<FacesSection>,
    /// Sun and sky along routes or at windows.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub exposure: Option<ExposureSection>,
    /// Height limits of an envelope.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub envelope: Option<EnvelopeSection>,
    /// Statistics of measures.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub measures: Option<MeasuresSection>,
}
