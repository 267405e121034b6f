//! Sections of a report.

mod cameras;
mod light;
mod places;
mod sight;
mod view_targets;

pub(super) use cameras::{CamerasReport, ChoiceSection};
pub(super) use light::SunAt;
pub use light::{
    EnvelopeSection, ExposureSection, GlareSection, HeatSection, PeriodSection, PvSection, RadiationSection,
    RoofsSection, SunSection, TreesSection,
};
pub use places::{
    GroundSection, HeightFrom, LocationSection, MeasuresSection, NorthReport, ObserversSection, PlaceSection,
    PlacesReport, WindowsSection,
};
pub use sight::{
    CertaintySection, HorizonsSection, LandmarkSection, LineSection, LinesSection, NetworkSection, PictureSection,
    ProtectedViewSection, SeenSection, SurveyPlanSection, TowersSection, ViewSection, ViewsSection,
};
pub(super) use sight::{PairsSection, StationSection, TowerSection, ViewDirection};
pub(in crate::ask) use view_targets::AnsweredBy;
pub use view_targets::{FacesSection, TargetsSection};

use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};

/// Values by name, in order.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedValues<T>(pub Vec<(String, T)>);

impl<T> Default for NamedValues<T> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<T: Serialize> Serialize for NamedValues<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.0.len()))?;
        for (name, value) in &self.0 {
            map.serialize_entry(name, value)?;
        }
        map.end()
    }
}
