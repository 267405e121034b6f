//! Visible parts of a vertical line, such as a tower: exact for the union of balls, triangles and far terrain.

use super::vertical_plane::VerticalPlane;
use crate::query::far_terrain::TerrainGuess;
use crate::query::far_terrain::line::FarLine;
use crate::query::{EarthParams, MedialScene};
use crate::ray_index::{BoxReach, NodeParts, PARTS, RayIndex};
use belvedere_data::vector::to_f32;
use smallvec::SmallVec;

/// More than single precision rounds distances by, as a share of the distance of the line.
const ROUNDING: f32 = 1e-6;
/// Maximum number of obstacles that are tried first for the next eye.
const MAX_RECENT: usize = 24;

/// Intervals, from and to, sorted and apart.
pub type HeightSpans = SmallVec<[[f64; 2]; 3]>;

/// A vertical line that eyes look at, local metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VerticalLine {
    /// Its lower end.
    pub foot: [f64; 3],
    /// Its length, metres, above 0.
    pub height: f64,
}

/// Views of a vertical line from eyes. Obstacles of the last eye are tried first for the next one, which saves most of
/// the time for neighbouring eyes and changes no result.
pub struct VerticalSight<'a> {
    scene: &'a MedialScene,
    line: VerticalLine,
    earth: &'a EarthParams,
    recent: SmallVec<[Obstacle; MAX_RECENT]>,
    terrain: TerrainGuess,
}

/// A row of the balls or of the triangles in their trees.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Obstacle {
    Ball(u32),
    Triangle(u32),
}

/// Tangents of the elevations between two, and which of them something hides.
struct Hidden {
    all: [f64; 2],
    spans: HeightSpans,
}

impl MedialScene {
    /// Prepares views of a vertical line over the earth of `earth`.
    #[must_use]
    pub fn vertical_sight<'a>(&'a self, line: VerticalLine, earth: &'a EarthParams) -> VerticalSight<'a> {
        let (recent, terrain) = (SmallVec::new(), TerrainGuess::default());
        VerticalSight { scene: self, line, earth, recent, terrain }
    }

    /// The tangents that a ball of the tree hides, if any: it gives way to the eye.
    fn hidden_by_ball(&self, plane: &VerticalPlane, row: u32) -> Option<[f64; 2]> {
        let ball = *self.tree().balls().get(row as usize)?;
        // most balls of an open box lie beside the plane
        if !plane.meets(ball) {
            return None;
        }
        let (_, radius) = self.tree().rule().seen_from(ball, plane.eye)?;
        plane.hidden_by_ball(ball.center.map(f64::from), radius)
    }

    /// The tangents that a triangle of the tree hides, if any: its surface gives way to the eye.
    fn hidden_by_triangle(&self, plane: &VerticalPlane, row: u32) -> Option<[f64; 2]> {
        plane.hidden_by_triangle(self.triangles()?.corners_before(plane.eye, row as usize)?)
    }
}

impl VerticalLine {
    /// Its upper end, local metres.
    #[must_use]
    pub fn top(&self) -> [f64; 3] {
        [self.foot[0], self.foot[1], self.foot[2] + self.height]
    }
}

impl<'a> VerticalSight<'a> {
    /// The visible heights above the foot for `eye`, local metres: intervals from and to, metres. Empty if nothing is
    /// visible, or if the eye is straight above or below the line.
    ///
    /// Each ball, triangle and patch hides one interval of elevations in the vertical plane of the eye and the line, in
    /// closed form. The result is what their union leaves open. Balls give way to the eye as for every line of sight,
    /// and those that hold it even so are left out. They do not give way to places of the line: it is an object of its
    /// own. Pulses are not considered. The earth is a plane for lines within the cloud that
    /// [`EarthParams::bends`] calls straight.
    #[must_use]
    pub fn seen_from(&mut self, eye: [f64; 3]) -> HeightSpans {
        let Some((plane, mut hidden)) = self.plane(eye) else { return HeightSpans::new() };
        self.hide_behind_recent(&plane, &mut hidden);
        if !hidden.is_whole()
            && let Some(line) = FarLine::new(eye, self.line.top(), self.earth)
            && let Some(tangent) = self.scene.far_terrain.highest_before(&line, hidden.all, &mut self.terrain)
        {
            hidden.add(Some([f64::NEG_INFINITY, tangent]));
        }
        if !hidden.is_whole() {
            let (scene, recent) = (self.scene, &mut self.recent);
            let mut note = |obstacle: Obstacle| {
                if recent.len() == MAX_RECENT {
                    recent.remove(0);
                }
                recent.push(obstacle);
            };
            // meshes first: they are few and large
            if let Some(triangles) = scene.triangles() {
                each_hiding(triangles.index(), &plane, &mut hidden, |row, hidden| {
                    if hidden.add(scene.hidden_by_triangle(&plane, row)) {
                        note(Obstacle::Triangle(row));
                    }
                });
            }
            each_hiding(scene.tree().index(), &plane, &mut hidden, |row, hidden| {
                if hidden.add(scene.hidden_by_ball(&plane, row)) {
                    note(Obstacle::Ball(row));
                }
            });
        }
        let VerticalLine { foot, height } = self.line;
        let above_foot = |tangent: f64| match tangent {
            // both ends exactly, so that a visible tip is one
            lowest if lowest == hidden.all[0] => 0.0,
            highest if highest == hidden.all[1] => height,
            between => (plane.height_at(between) - foot[2]).clamp(0.0, height),
        };
        hidden.open().into_iter().map(|span| span.map(above_foot)).collect()
    }

    /// The vertical plane from `eye` to the line, and the tangents of the line; `None` where there is none.
    fn plane(&self, eye: [f64; 3]) -> Option<(VerticalPlane, Hidden)> {
        let (foot, top) = (self.line.foot, self.line.top());
        let is_far = [eye, foot].into_iter().any(|end| self.scene.is_on_far_terrain(end));
        let plane = VerticalPlane::new(eye, foot, self.earth, is_far || self.earth.bends(eye, top))?;
        let all = [foot[2], top[2]].map(|height| plane.tangent_of(height));
        (all[0] < all[1]).then(|| (plane, Hidden { all, spans: HeightSpans::new() }))
    }

    fn hide_behind_recent(&mut self, plane: &VerticalPlane, hidden: &mut Hidden) {
        let scene = self.scene;
        self.recent.retain(|obstacle| {
            hidden.add(match *obstacle {
                Obstacle::Ball(row) => scene.hidden_by_ball(plane, row),
                Obstacle::Triangle(row) => scene.hidden_by_triangle(plane, row),
            })
        });
    }
}

/// Calls `visit` with each row of an index whose box may hide tangents that nothing hides yet, nearest boxes first.
fn each_hiding(index: &RayIndex, plane: &VerticalPlane, hidden: &mut Hidden, mut visit: impl FnMut(u32, &mut Hidden)) {
    let plane_of_boxes = BoxPlane::new(plane);
    index.visit_nearest_first(
        hidden,
        |hidden, parts, slack| plane_of_boxes.reaches(hidden, parts, slack),
        |hidden, reach| !hidden.holds(reach.tangents.map(f64::from)),
        |hidden, row| {
            visit(row, hidden);
            !hidden.is_whole()
        },
    );
}

/// A [`VerticalPlane`] in single precision, which boxes are measured in eight at a time.
struct BoxPlane {
    eye: [f32; 3],
    along: [f32; 2],
    span: f32,
    fall: f32,
}

impl BoxPlane {
    fn new(plane: &VerticalPlane) -> Self {
        let VerticalPlane { eye, along, span, fall } = *plane;
        Self { eye: eye.map(to_f32), along: along.map(to_f32), span: to_f32(span).next_up(), fall: to_f32(fall) }
    }

    /// The reaches of the boxes of a node that may hide a tangent that nothing hides yet. They are `slack` metres
    /// larger, which is more than is rounded.
    #[inline]
    fn reaches(&self, hidden: &Hidden, parts: &NodeParts, slack: f32) -> [Option<BoxReach>; PARTS] {
        let slack = slack + ROUNDING * self.span;
        let [east, north] = self.along;
        let (mut from, mut to) = ([0.0_f32; PARTS], [0.0_f32; PARTS]);
        let (mut beside, mut low, mut high) = ([0.0_f32; PARTS], [0.0_f32; PARTS], [0.0_f32; PARTS]);
        for i in 0..PARTS {
            let [x, y, z] = [0, 1, 2].map(|axis| parts.centers[axis][i] - self.eye[axis]);
            let half = [0, 1, 2].map(|axis| parts.half_sizes[axis][i] + slack);
            let along = x * east + y * north;
            let reach = half[0] * east.abs() + half[1] * north.abs();
            from[i] = (along - reach).max(0.0);
            to[i] = (along + reach).min(self.span);
            beside[i] = (y * east - x * north).abs() - (half[0] * north.abs() + half[1] * east.abs());
            (low[i], high[i]) = (z - half[2], z + half[2]);
        }
        std::array::from_fn(|i| {
            if !(beside[i] <= 0.0 && from[i] <= to[i]) {
                return None;
            }
            let lowest = low[i] / if low[i] > 0.0 { to[i] } else { from[i] } - self.fall * to[i];
            let highest = high[i] / if high[i] > 0.0 { from[i] } else { to[i] } - self.fall * from[i];
            // 0 / 0 beside the eye says nothing
            let lowest = if lowest.is_nan() { f32::NEG_INFINITY } else { lowest };
            let highest = if highest.is_nan() { f32::INFINITY } else { highest };
            let tangents = [lowest, highest];
            (!hidden.holds(tangents.map(f64::from))).then_some(BoxReach { distance: from[i], tangents })
        })
    }
}

impl Hidden {
    /// Returns true if nothing is left.
    fn is_whole(&self) -> bool {
        matches!(self.spans[..], [span] if span == self.all)
    }

    /// Returns true if an interval holds nothing that is still open.
    fn holds(&self, [from, to]: [f64; 2]) -> bool {
        let [from, to] = [from.max(self.all[0]), to.min(self.all[1])];
        !(from < to) || self.spans.iter().any(|span| span[0] <= from && to <= span[1])
    }

    /// Adds an interval; true if it hides something new.
    fn add(&mut self, span: Option<[f64; 2]>) -> bool {
        let Some(span) = span.filter(|span| !self.holds(*span)) else { return false };
        let mut joined = [span[0].max(self.all[0]), span[1].min(self.all[1])];
        let first = self.spans.partition_point(|other| other[1] < joined[0]);
        let end = self.spans.partition_point(|other| other[0] <= joined[1]);
        for other in &self.spans[first..end] {
            joined = [joined[0].min(other[0]), joined[1].max(other[1])];
        }
        self.spans.drain(first..end);
        self.spans.insert(first, joined);
        true
    }

    /// The intervals between those that are hidden.
    fn open(&self) -> HeightSpans {
        let mut from = self.all[0];
        let mut open = HeightSpans::new();
        for &[start, end] in self.spans.iter().chain([&[self.all[1]; 2]]) {
            if from < start {
                open.push([from, start]);
            }
            from = from.max(end);
        }
        open
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hidden_intervals_join_whatever_their_order() {
        let spans = [[0.1, 0.2], [0.5, 0.6], [0.2, 0.3], [0.25, 0.55], [-9.0, 0.05], [0.9, 2.0]];
        for turn in 0..spans.len() {
            let mut hidden = Hidden { all: [0.0, 1.0], spans: HeightSpans::new() };
            for i in 0..spans.len() {
                assert!(hidden.add(Some(spans[(i + turn) % spans.len()])) || i > 0);
            }
            assert_eq!(hidden.open().as_slice(), [[0.05, 0.1], [0.6, 0.9]]);
            assert!(!hidden.add(Some([0.11, 0.59])) && !hidden.add(None) && !hidden.add(Some([1.0, 3.0])));
            assert!(!hidden.is_whole() && hidden.add(Some([-1.0, 7.0])) && hidden.is_whole());
            assert!(hidden.open().is_empty());
        }
    }
}
