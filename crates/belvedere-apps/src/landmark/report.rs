//! Summary of the views of a landmark.

use super::LandmarkView;
use belvedere_data::report::{percent, rounded};
use serde::Serialize;

/// Number of observers that see a landmark, and the best view.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct LandmarkReport {
    /// Observers that stand somewhere.
    pub count: usize,
    /// Observers inside a ball.
    pub observers_inside_obstacles: usize,
    /// Observers that see some of it.
    pub observers_with_view: usize,
    /// The same as a share of all.
    pub observers_with_view_percent: f64,
    /// Best view.
    #[serde(flatten)]
    pub best: Option<BestView>,
}

/// The observer that sees the greatest share of a landmark.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct BestView {
    /// The share, 0 to 1.
    pub max_visible_share: f64,
    /// Number of the observer, from 1.
    pub max_visible_share_observer: usize,
    /// Solid angle of the visible parts from there, steradians.
    pub max_visible_share_solid_angle_sr: f64,
}

impl LandmarkReport {
    /// Summarises `views`, one for each of `eyes`; `enclosed_count` of the eyes are inside a ball.
    #[must_use]
    pub fn new(views: &[LandmarkView], eyes: &[[f64; 3]], enclosed_count: usize) -> Self {
        let count = eyes.iter().filter(|eye| eye[2].is_finite()).count();
        let seeing = || views.iter().enumerate().filter(|(_, view)| view.visible_area > 0.0);
        let best = seeing().max_by(|a, b| a.1.visible_share().total_cmp(&b.1.visible_share()));
        let see = seeing().count();
        Self {
            count,
            observers_inside_obstacles: enclosed_count,
            observers_with_view: see,
            observers_with_view_percent: percent(see, count),
            best: best.map(|(row, view)| BestView {
                max_visible_share: rounded(view.visible_share(), 4),
                max_visible_share_observer: row + 1,
                max_visible_share_solid_angle_sr: rounded(view.solid_angle, 5),
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_best_view_is_the_one_with_the_greatest_share() {
        let view = |visible_area| LandmarkView { area: 4.0, visible_area, solid_angle: 0.5, ..LandmarkView::default() };
        let eyes = [[0.0; 3], [f64::NAN; 3], [1.0; 3], [2.0; 3]];
        let report = LandmarkReport::new(&[view(0.0), LandmarkView::default(), view(3.0), view(1.0)], &eyes, 1);
        assert_eq!((report.count, report.observers_with_view, report.observers_inside_obstacles), (3, 2, 1));
        assert_eq!(report.observers_with_view_percent, 66.67);
        let best = report.best.unwrap();
        assert_eq!(
            (best.max_visible_share_observer, best.max_visible_share, best.max_visible_share_solid_angle_sr),
            (3, 0.75, 0.5)
        );
        assert_eq!(LandmarkReport::new(&[view(0.0)], &eyes[..1], 0).best, None);
    }
}
