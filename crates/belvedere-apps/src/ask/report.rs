//! What is known of how answers came about. Sections that a question does not have are left out.

use super::cameras::CamerasReport;
use super::comfort::ExposureSection;
use super::depth_map::{PictureSection, ViewSection};
use super::envelope::EnvelopeSection;
use super::horizon::HorizonsSection;
use super::how_sure::CertaintySection;
use super::landmark::LandmarkSection;
use super::line_of_sight::LineSection;
use super::north::NorthReport;
use super::observers::ObserversSection;
use super::protected_view::ProtectedViewSection;
use super::sections::{
    GroundSection, LinesSection, LocationSection, MeasuresSection, NamedValues, PeriodSection, PlacesReport,
    RadiationSection, RoofsSection, SunSection, TreesSection,
};
use super::single_places::PlaceSection;
use super::survey_plan::SurveyPlanSection;
use super::viewshed::SeenSection;
use super::window_views::{ViewsSection, WindowsSection};
use crate::eyes::EyesReport;
use crate::landmark::LandmarkReport;
use crate::survey_reliability::SurveyReliability;
use serde::Serialize;

/// The sections of all questions.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Report {
    /// Where on earth the scene lies.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub location: Option<LocationSection>,
    /// From which north azimuths count.
    #[serde(flatten)]
    pub north: Option<NorthReport>,
    /// The days.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub period: Option<PeriodSection>,
    /// The suns.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sun: Option<SunSection>,
    /// What sun and sky send.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub radiation: Option<RadiationSection>,
    /// The landmark.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub landmark: Option<LandmarkSection>,
    /// The ground that cells stand on.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ground: Option<GroundSection>,
    /// Roofs that were found.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub roofs: Option<RoofsSection>,
    /// The windows.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub windows: Option<WindowsSection>,
    /// What became of the places.
    #[serde(flatten)]
    pub places: PlacesReport,
    /// The single places.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub at: Vec<PlaceSection>,
    /// Who looks.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub observers: Option<ObserversSection>,
    /// What is looked at from all cells.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub target: Option<ObserversSection>,
    /// Which of the given observers of a landmark cannot look.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub observers_given: Option<EyesReport>,
    /// What observers see of a landmark.
    #[serde(rename = "observers", skip_serializing_if = "Option::is_none")]
    pub landmark_views: Option<LandmarkReport>,
    /// What blocks.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lines_of_sight: Option<LinesSection>,
    /// How sure answers are.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub certainty: Option<CertaintySection>,
    /// How reliable answers on a survey are.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reliability: Option<SurveyReliability>,
    /// A single line of sight.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub line: Option<LineSection>,
    /// How high horizons are.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub horizons: Option<HorizonsSection>,
    /// The numbers of a single isovist.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub isovist: Option<NamedValues<f64>>,
    /// What is seen of cells.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cells: Option<SeenSection>,
    /// What is seen of points.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cloud_points: Option<SeenSection>,
    /// What is seen of the terrain beyond the cloud.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub far_cells: Option<SeenSection>,
    /// What trees let through.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub trees: Option<TreesSection>,
    /// What windows see.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub views: Option<ViewsSection>,
    /// What views of a landmark protect.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub protected_view: Option<ProtectedViewSection>,
    /// Which cameras were chosen.
    #[serde(flatten)]
    pub cameras: Option<CamerasReport>,
    /// Where to scan again.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub survey_plan: Option<SurveyPlanSection>,
    /// The view of a picture.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub view: Option<ViewSection>,
    /// What a picture shows.
    #[serde(flatten)]
    pub picture: Option<PictureSection>,
    /// What routes or windows get of sun and sky.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub exposure: Option<ExposureSection>,
    /// How high one may build.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub envelope: Option<EnvelopeSection>,
    /// How measures are spread.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub measures: Option<MeasuresSection>,
}
