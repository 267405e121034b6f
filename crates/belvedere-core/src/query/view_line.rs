//! Lines of sight of targets in the picture of a view.

use super::Viewer;
use crate::ray_index::Ray;
use belvedere_data::view::{Projection, View};

/// The line of sight of a target in a view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LineInView {
    /// All of it, from the target on where it ends at a plane.
    pub(super) sight: Ray,
    /// End of the line on the side of the viewer.
    pub(super) end: LineEnd,
}

/// End of the line of sight of a target in a view.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum LineEnd {
    /// End at the viewer.
    Viewer,
    /// End at the picture plane, or the near limit of a view from an eye.
    Plane,
}

impl LineInView {
    pub(super) fn to_viewer(sight: Ray) -> Self {
        Self { sight, end: LineEnd::Viewer }
    }
}

/// Returns the viewer of a view.
pub(super) fn viewer_of(view: &View) -> Viewer<'static> {
    if view.is_central() { Viewer::Eye(view.frame.eye) } else { Viewer::Direction(view.frame.forward.map(|v| -v)) }
}

/// Returns the line of sight of a target within the picture and limits of `view`, from the target towards the viewer.
/// It ends at the picture plane or at the near limit; without these at the eye. `None` for any other target.
pub(super) fn line_in_view(view: &View, target: [f32; 3]) -> Option<LineInView> {
    let place = view.project(target)?;
    view.pixel(place)?;
    let depth = place[2];
    if !depth.is_finite() {
        return None;
    }
    let to_plane = |direction: [f64; 3], range: f64| LineInView {
        sight: Ray { origin: target.map(f64::from), direction, ranges: [0.0, range] },
        end: LineEnd::Plane,
    };
    let to_near = |near: f64, range_per_depth: &dyn Fn(f64) -> f64| {
        if near > 0.0 {
            let (towards, range) = viewer_of(view).line_of_sight(0, target)?;
            return Some(to_plane(towards, range - near * range_per_depth(range)));
        }
        viewer_of(view).sight(0, target).map(LineInView::to_viewer)
    };
    match view.projection {
        Projection::Orthographic { .. } => Some(to_plane(view.frame.forward.map(|v| -v), depth)),
        Projection::Perspective { near, .. } => to_near(near, &|range| range / depth),
        Projection::Hemispherical { near, .. } => to_near(near, &|_| 1.0),
    }
}
