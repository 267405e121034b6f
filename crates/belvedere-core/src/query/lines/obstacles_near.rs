//! Obstacles near a line of sight, for what needs more room than the line itself.

use crate::blocking::Ball;
use crate::query::MedialScene;
use crate::query::triangles::LineEnds;
use crate::triangle_tree::Corners;
use belvedere_data::vector::{length, sub};

/// An obstacle near a line of sight, local metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Obstacle<'a> {
    /// A ball, as small as it counts for the nearer end of the line.
    Ball {
        /// Its centre.
        center: [f64; 3],
        /// Its radius.
        radius: f64,
    },
    /// A triangle of far terrain, of an added mesh or of a surface patch.
    Triangle(&'a Corners),
}

impl MedialScene {
    /// Visits the obstacles in `boxes`, given by their lowest and highest corner, that count for the line of sight
    /// between two ends, local metres. Those of several boxes may come several times.
    ///
    /// Balls that hold an end are left out and balls near an end give way to it, as to a target; so do triangles on
    /// which an end lies. A line that leaves the cloud has the terrain beyond it too: four triangles for each patch of
    /// the raster, which meet its bilinear surface at the nodes and in the middle.
    pub fn visit_obstacles_near(
        &self,
        ends: [[f64; 3]; 2],
        boxes: impl Iterator<Item = [[f64; 3]; 2]> + Clone,
        mut visit: impl FnMut(Obstacle<'_>),
    ) {
        let is_far = self.leaves_cloud(ends);
        for [low, high] in boxes.clone().filter(|_| is_far) {
            let on_map = [low, high].map(|[x, y, _]| [x, y]);
            self.far_terrain().each_triangle_near(on_map, |corners| visit(Obstacle::Triangle(corners)));
        }
        for [low, high] in boxes.clone() {
            self.tree().index().visit_near(low, high, |number| {
                let Ball { center, radius } = self.ball(number);
                let (center, whole) = (center.map(f64::from), f64::from(radius));
                let distances = ends.map(|end| length(sub(center, end)));
                let counted = distances.map(|distance| self.params().radius_for(whole, distance));
                if distances.into_iter().all(|distance| distance > whole) {
                    visit(Obstacle::Ball { center, radius: counted[0].min(counted[1]) });
                }
            });
        }
        if let Some(triangles) = self.triangles() {
            let ends = LineEnds { target: ends[0], viewer: Some(ends[1]) };
            triangles.triangles_near(boxes, &ends).for_each(|corners| visit(Obstacle::Triangle(corners)));
        }
    }
}
