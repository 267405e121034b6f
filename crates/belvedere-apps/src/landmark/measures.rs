//! Visible part of a landmark, as named numbers.

use super::LandmarkView;

/// A number that a view of a landmark gives.
#[derive(Clone, Copy, Debug)]
pub struct LandmarkMeasure {
    /// Name of its column.
    pub name: &'static str,
    /// Description, with its unit.
    pub description: &'static str,
    /// Unit of its values; `1` for shares.
    pub unit: &'static str,
    /// Decimals in tables.
    pub decimals: usize,
    value: fn(&LandmarkView) -> f64,
}

impl LandmarkMeasure {
    /// The number of one view; NaN for an observer that cannot look.
    #[must_use]
    pub fn of(&self, view: &LandmarkView) -> f64 {
        if view.area > 0.0 { (self.value)(view) } else { f64::NAN }
    }
}

/// All measures of some views, the share first. The last one, the expected area, is there only if a view has it.
#[must_use]
pub fn measures(views: &[LandmarkView]) -> &'static [LandmarkMeasure] {
    let has_expected = views.iter().any(|view| view.expected_area.is_some());
    &MEASURES[..MEASURES.len() - usize::from(!has_expected)]
}

const MEASURES: [LandmarkMeasure; 10] = [
    LandmarkMeasure {
        name: "visible_share",
        description: "visible share of the surface of the landmark, 0 to 1",
        unit: "1",
        decimals: 5,
        value: LandmarkView::visible_share,
    },
    LandmarkMeasure {
        name: "visible_area_m2",
        description: "visible area of the landmark, square metres",
        unit: "m2",
        decimals: 3,
        value: |view| view.visible_area,
    },
    LandmarkMeasure {
        name: "unproven_area_m2",
        description: "area that nothing blocks but is not proven, square metres",
        unit: "m2",
        decimals: 3,
        value: |view| view.unproven_area,
    },
    LandmarkMeasure {
        name: "solid_angle_sr",
        description: "solid angle of the visible part, steradians",
        unit: "sr",
        decimals: 7,
        value: |view| view.solid_angle,
    },
    LandmarkMeasure {
        name: "horizon_share",
        description: "share of all azimuths in which a part is visible, 0 to 1",
        unit: "1",
        decimals: 6,
        value: |view| view.horizon_share,
    },
    LandmarkMeasure {
        name: "horizontal_extent_deg",
        description: "horizontal angle between the outermost visible parts, degrees",
        unit: "deg",
        decimals: 4,
        value: |view| view.horizontal_extent.to_degrees(),
    },
    LandmarkMeasure {
        name: "vertical_extent_deg",
        description: "vertical angle between the lowest and highest visible part, degrees",
        unit: "deg",
        decimals: 4,
        value: |view| view.vertical_extent.to_degrees(),
    },
    LandmarkMeasure {
        name: "nearest_m",
        description: "range of the nearest visible part, metres",
        unit: "m",
        decimals: 3,
        value: |view| view.ranges.map_or(f64::NAN, |ranges| ranges[0]),
    },
    LandmarkMeasure {
        name: "farthest_m",
        description: "range of the farthest visible part, metres",
        unit: "m",
        decimals: 3,
        value: |view| view.ranges.map_or(f64::NAN, |ranges| ranges[1]),
    },
    LandmarkMeasure {
        name: "expected_share",
        description: "expected visible share of the surface, 0 to 1",
        unit: "1",
        decimals: 5,
        value: |view| view.expected_area.map_or(f64::NAN, |area| area / view.area),
    },
];
