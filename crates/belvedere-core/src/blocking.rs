//! The rule by which a ball blocks a line of sight: one definition for rays, skylines, beams, depth maps and sweeps.
//!
//! Everything here is scalar arithmetic on one ball and one line, so that another device can repeat it operation by
//! operation. Lengths are metres, positions are local, directions are unit vectors. A line of sight runs from its
//! *target* (range 0) *towards* its viewer (range `reach`, infinite for a viewer infinitely far away).
//!
//! The rule: a ball blocks a line of sight if a piece of the line more than [`BlockRule::bias`] metres from either end
//! runs through it. A ball near an end counts with a smaller radius ([`BlockRule::radius_for`]), so that one wrong ball
//! neither blinds an observer on a surface nor hides a target on it. Both ends are treated alike: observer and target
//! can change places. An end that lies inside a ball even with the smaller radius is inside an obstacle
//! ([`BlockRule::holds_end`]), and all its lines of sight are blocked.
//!
//! A picture plane, or the near limit of a picture, is not an end of a line of sight: the part of a ball before it is
//! cut off ([`BlockRule::blocks_before_plane`]).
//!
//! # Source
//! Peters, Ledoux & Biljecki 2015, section 3 (balls that block, and the cone of [`Profile::PaperCone`]). Bias and shell
//! are this project's.

use belvedere_data::frame::FARTHEST;
use belvedere_data::vector::{dot, length, sub, to_f32};
use belvedere_data::{Error, Parameter, Result};

/// The largest part of its radius by which a ball gives way to a target: a wire must not vanish.
pub const SHELL_SHARE: f64 = 0.5;
/// Maximum distance of a point of an airborne scan from the surface of the balls around it, metres: 0.05 of noise, and
/// as much by which the default balls stand out over points.
pub(crate) const SURFACE_DEVIATION: f64 = 0.1;
/// Slope of a surface against the picture plane up to which its own points shall be visible: 63°, level ground under a
/// sun 27° high.
pub(crate) const SLOPE: f64 = 2.0;

/// A ball, local metres.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ball {
    /// Centre.
    pub center: [f32; 3],
    /// Radius.
    pub radius: f32,
}

/// The surface that represents a ball.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Profile {
    /// The sphere itself. In a depth map it is sampled at pixel centres at its exact sub-pixel place. Balls before the
    /// picture plane, or the near limit, are not seen; one that the plane cuts blocks from there on. Balls that hold
    /// the eye are left out.
    #[default]
    Sphere,
    /// Algorithm 1 of the paper to the letter: a cone with its tip where the line through the centre meets the ball. In
    /// a depth map it stands around the middle of the pixel that holds the centre, before and behind the picture plane
    /// alike, in parallel views only.
    PaperCone,
}

/// Rule by which balls block lines of sight.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BlockRule {
    /// Surface that represents a ball. Default the sphere.
    pub profile: Profile,
    /// Maximum depth of an end inside a ball, along its line of sight, for which the line is still free, metres, 0 or
    /// more. Default 0.
    pub bias: f64,
    /// Surface tolerance: the maximum reduction of a ball near an end of a line, metres, 0 or more; see
    /// [`BlockRule::radius_for`]. Balls bulge by centimetres between the points of a surface, and a target on that
    /// surface must stay visible. Default 0. Depth maps have no shell: the target is unknown when balls are drawn.
    pub shell: f64,
}

impl BlockRule {
    /// Returns the rule of carved balls: spheres with a shell of 0.2 m and no bias. It was measured on simulated towns
    /// of another seed than those of `research/notes/accuracy-tables.md`. A bias of 0.25 m instead costs 1.7 points on
    /// facades and gains 0.7 on roofs; a shell of 0.3 m gains 0.4 and costs 0.3.
    #[must_use]
    pub fn carved() -> Self {
        Self { profile: Profile::Sphere, bias: 0.0, shell: 0.2 }
    }

    /// For balls that no pulse cut, which are seen from outside only: spheres with the bias of [`surface_bias`] and no
    /// shell.
    #[must_use]
    pub fn uncarved() -> Self {
        Self { profile: Profile::Sphere, bias: surface_bias(), shell: 0.0 }
    }

    /// Checks the parameters.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a bias that is not finite and for a shell below zero.
    pub fn validate(&self) -> Result<()> {
        let invalid = |parameter, value: f64, expected| Err(Error::invalid(parameter, value, expected));
        if !self.bias.is_finite() {
            return invalid(Parameter::DepthBias, self.bias, "finite");
        }
        if !(self.shell >= 0.0) {
            return invalid(Parameter::Shell, self.shell, "0 metres or more");
        }
        Ok(())
    }

    /// The most by which a ball of `radius` gives way to any end of a line, metres.
    #[must_use]
    #[inline]
    pub fn shell_of(&self, radius: f64) -> f64 {
        self.shell.min(SHELL_SHARE * radius)
    }

    /// The least radius that a ball of `radius` counts with, however near its surface an end lies.
    #[must_use]
    #[inline]
    pub fn min_radius(&self, radius: f64) -> f64 {
        radius - self.shell_of(radius)
    }

    /// [`BlockRule::min_radius`] in single precision, in which depth maps are drawn.
    #[must_use]
    #[inline]
    pub fn min_radius_f32(&self, radius: f32) -> f32 {
        radius - to_f32(self.shell).min(to_f32(SHELL_SHARE) * radius)
    }

    /// The radius that a ball of `radius` counts with for an end `distance` metres from its centre; between two ends
    /// the lesser of both counts.
    ///
    /// Let s be the smaller of the shell and half the radius. The result is r − s for an end less than s inside the
    /// surface, r − (s − (distance − r)) for one less than s outside, and r for all others.
    #[must_use]
    #[inline]
    pub fn radius_for(&self, radius: f64, distance: f64) -> f64 {
        let shell = self.shell_of(radius);
        let outside = distance - radius;
        if outside.abs() < shell { radius - (shell - outside.max(0.0)) } else { radius }
    }

    /// Returns true if an end of a line of sight lies so deep in a ball that the ball does not give way: it blocks
    /// every line from there.
    #[must_use]
    #[inline]
    pub fn holds_end(&self, ball: Ball, end: [f64; 3]) -> bool {
        ball.depth_of(end) > self.shell_of(f64::from(ball.radius)) + self.bias.max(0.0)
    }

    /// Returns the distance from the target at which the line of sight from `target` along `towards` leaves a ball that
    /// blocks it, metres, at most `reach`. `None` for a ball that does not block. The line ends at the viewer, `reach`
    /// metres from the target.
    #[must_use]
    #[inline]
    pub fn blocks_line(&self, ball: Ball, target: [f64; 3], towards: [f64; 3], reach: f64) -> Option<f64> {
        self.blocked_piece(ball, target, towards, reach).map(|[_, leaves]| leaves.min(reach))
    }

    /// Returns the interval of the line of sight from `target` along `towards` to `reach` metres that a ball blocks:
    /// entry and exit, which may lie beyond the ends, metres from the target. `None` for a ball that does not block.
    /// Exchanging the ends changes the answer by rounding only, and not at all for lines from
    /// [`Ray::between`](crate::ray_index::Ray::between).
    #[must_use]
    #[inline]
    pub fn blocked_piece(&self, ball: Ball, target: [f64; 3], towards: [f64; 3], reach: f64) -> Option<[f64; 2]> {
        let whole = f64::from(ball.radius);
        let LinePassing { along, beside_square, origin_square } = LinePassing::new(ball.center, target, towards);
        if beside_square >= whole * whole {
            return None;
        }
        let before_viewer = reach - along;
        let viewer_square = beside_square + before_viewer * before_viewer;
        let radius = self.radius_for(whole, origin_square.sqrt()).min(self.radius_for(whole, viewer_square.sqrt()));
        if radius < whole && (radius <= 0.0 || beside_square >= radius * radius) {
            return None;
        }
        let half = self.half_chord(radius, beside_square);
        (half + along > self.bias && half + before_viewer > self.bias).then_some([along - half, along + half])
    }

    /// Returns the result of [`BlockRule::blocks_line`] for a line that a picture plane or a near limit cuts `reach`
    /// metres from the target: balls that reach past it block nothing.
    #[must_use]
    #[inline]
    pub fn blocks_before_plane(&self, ball: Ball, target: [f64; 3], towards: [f64; 3], reach: f64) -> Option<f64> {
        let whole = f64::from(ball.radius);
        let LinePassing { along, beside_square, .. } = LinePassing::new(ball.center, target, towards);
        if beside_square >= whole * whole || along + (whole * whole - beside_square).sqrt() >= reach {
            return None;
        }
        self.blocks_line(ball, target, towards, f64::INFINITY)
    }

    /// Returns the interval of a chord of a curved line of sight that a ball blocks: entry and exit, which may lie
    /// beyond its ends, metres from its start. `None` for a ball that does not block. Viewer and target are those of
    /// the whole line.
    #[must_use]
    #[inline]
    pub fn blocks_chord(&self, ball: Ball, chord: &Chord) -> Option<[f64; 2]> {
        let whole = f64::from(ball.radius);
        let [to_target, to_observer] = [chord.target, chord.observer].map(|end| ball.distance_to(end));
        let radius = self.radius_for(whole, to_target).min(self.radius_for(whole, to_observer));
        let LinePassing { along, beside_square, .. } = LinePassing::new(ball.center, chord.start, chord.towards);
        if radius <= 0.0 || beside_square >= radius * radius {
            return None;
        }
        let half = self.half_chord(radius, beside_square);
        let [from, to] = chord.ranges;
        (along - half < to && along + half > from).then_some([along - half, along + half])
    }

    /// Returns the distance at which a viewer at `eye` who looks along `direction` meets a ball, metres. `None` for a
    /// ball that the ray misses or that holds the eye. No ball gives way, since there is no target.
    #[must_use]
    #[inline]
    pub fn meets_ray(&self, ball: Ball, eye: [f64; 3], direction: [f64; 3]) -> Option<f64> {
        let radius = f64::from(ball.radius);
        let LinePassing { along, beside_square, origin_square } = LinePassing::new(ball.center, eye, direction);
        if along <= 0.0 || origin_square <= radius * radius || beside_square >= radius * radius {
            return None;
        }
        let entry = along - self.half_chord(radius, beside_square);
        Some(match self.profile {
            Profile::Sphere => entry,
            Profile::PaperCone => entry.max(0.0),
        })
    }

    /// Returns the vector from `place` to the centre of a ball, and the radius of the ball for a target at `place`.
    /// `None` if `place` lies inside the reduced ball.
    #[must_use]
    #[inline]
    pub fn seen_from(&self, ball: Ball, place: [f64; 3]) -> Option<([f64; 3], f64)> {
        let offset = sub(ball.center.map(f64::from), place);
        let distance = length(offset);
        let radius = self.radius_for(f64::from(ball.radius), distance);
        (radius > 0.0 && !holds_at(radius, distance)).then_some((offset, radius))
    }

    /// The part of the sky over `target` that a ball covers, by the radius that it counts with.
    #[must_use]
    #[inline]
    pub fn cover(&self, ball: Ball, target: [f64; 3]) -> Cover {
        let offset = sub(ball.center.map(f64::from), target);
        let distance = length(offset);
        let radius = self.radius_for(f64::from(ball.radius), distance);
        if holds_at(radius, distance) {
            return Cover { towards: [0.0, 0.0, 1.0], cosine: -2.0, highest: 1.0 };
        }
        let (sine, up) = (radius / distance, offset[2] / distance);
        let cosine = (1.0 - sine * sine).sqrt();
        let highest = if up >= cosine { 1.0 } else { up * cosine + (1.0 - up * up).max(0.0).sqrt() * sine };
        Cover { towards: offset.map(|v| v / distance), cosine, highest }
    }

    /// Returns the distance from the point of a line nearest to the centre to the exit of the line from the profile,
    /// metres.
    #[inline]
    fn half_chord(&self, radius: f64, beside_square: f64) -> f64 {
        match self.profile {
            Profile::Sphere => (radius * radius - beside_square).sqrt(),
            Profile::PaperCone => radius - beside_square.sqrt(),
        }
    }
}

/// Maximum distance between the plane of a triangle and an end of a line of sight that lies on it, metres. Targets are
/// f32, which is off by 0.1 mm a kilometre from the origin, and a target on a triangle must not be hidden by it.
pub const CONTACT: f64 = 1e-3;
/// Maximum depth of an end of a line of sight behind a surface patch for which it lies on that surface, metres: the
/// measurement noise, since points lie on both sides of the fitted plane.
pub const PATCH_DEPTH: f64 = 0.15;

/// The plane of a triangle that blocks lines of sight, and how deep behind it ends still lie on it.
///
/// The rule: a triangle blocks every line of sight that passes through it, edges included, unless an end of the line
/// lies on its surface. Both ends are treated alike. An end farther in front of the plane than [`CONTACT`] is never on
/// it: seen through the triangle it is hidden.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sheet {
    /// Unit normal, which points to the front.
    pub normal: [f64; 3],
    /// A place in the plane.
    pub corner: [f64; 3],
    /// Maximum depth of an end behind the plane for which it lies on the surface, metres, at least [`CONTACT`].
    pub depth: f64,
}

impl Sheet {
    /// Returns true if an end of a line of sight lies on the surface, so that it does not block the line.
    #[must_use]
    #[inline]
    pub fn gives_way_to(&self, end: [f64; 3]) -> bool {
        let behind = self.depth_of(end);
        -CONTACT <= behind && behind <= self.depth
    }

    /// The least height at or above that of `place` at which the surface gives way to an end straight above it; `None`
    /// where there is none.
    #[must_use]
    pub fn height_of_giving_way(&self, place: [f64; 3]) -> Option<f64> {
        let behind = self.depth_of(place);
        if self.gives_way_to(place) {
            return Some(place[2]);
        }
        // upward an end comes nearer to a plane that faces up from behind, and to one that faces down from its front
        let up = self.normal[2];
        let rise = (behind - if up > 0.0 { self.depth } else { -CONTACT }) / up;
        (rise >= 0.0 && rise.is_finite()).then_some(place[2] + rise)
    }

    /// Returns the depth of a place behind the plane, metres; negative in front of it.
    #[inline]
    fn depth_of(&self, place: [f64; 3]) -> f64 {
        dot(self.normal, sub(self.corner, place))
    }
}

/// A piece of a curved line of sight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chord {
    /// Its end on the side of the target.
    pub start: [f64; 3],
    /// Direction from there to the observer's side.
    pub towards: [f64; 3],
    /// Ranges that count, from and to, metres from the start: at an end of the whole line less the bias.
    pub ranges: [f64; 2],
    /// Target of the whole line.
    pub target: [f64; 3],
    /// Observer of the whole line.
    pub observer: [f64; 3],
}

/// The part of the sky that a ball covers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cover {
    /// Direction to the centre of the ball.
    pub towards: [f64; 3],
    /// Cosine of the angle between that direction and those that just touch the ball; −2 where the ball covers the
    /// whole sky.
    pub cosine: f64,
    /// Sine of the highest elevation that is covered.
    pub highest: f64,
}

/// Position of the centre of a ball relative to a line.
#[derive(Clone, Copy)]
struct LinePassing {
    /// Distance from the start of the line to its point nearest to the centre, metres.
    along: f64,
    /// Square of the distance between that point and the centre, m².
    beside_square: f64,
    /// Square of the distance between the start and the centre, m².
    origin_square: f64,
}

impl LinePassing {
    #[inline]
    fn new(center: [f32; 3], origin: [f64; 3], direction: [f64; 3]) -> Self {
        let offset = sub(center.map(f64::from), origin);
        let (along, origin_square) = (dot(offset, direction), dot(offset, offset));
        Self { along, beside_square: (origin_square - along * along).max(0.0), origin_square }
    }
}

impl Ball {
    /// Returns true if the radius is above zero, and centre and radius are at most [`FARTHEST`], whose squares are
    /// still exact enough.
    #[must_use]
    pub fn is_usable(&self) -> bool {
        self.radius > 0.0 && self.radius <= FARTHEST && self.center.iter().all(|v| v.abs() <= FARTHEST)
    }

    /// Lowest and highest corner of a box that holds the ball, rounded outward.
    #[must_use]
    pub fn bounds(&self) -> [[f32; 3]; 2] {
        let Self { center, radius } = *self;
        [center.map(|c| (c - radius).next_down()), center.map(|c| (c + radius).next_up())]
    }

    /// Distance of the centre to `point`, metres.
    #[must_use]
    #[inline]
    pub fn distance_to(&self, point: [f64; 3]) -> f64 {
        length(sub(self.center.map(f64::from), point))
    }

    /// Returns the depth of `point` below the surface, metres; negative outside.
    #[must_use]
    #[inline]
    pub fn depth_of(&self, point: [f64; 3]) -> f64 {
        f64::from(self.radius) - self.distance_to(point)
    }

    /// Returns the interval of the line from `origin` along `direction` inside the whole ball, however it blocks: from
    /// and to, metres, negative before the origin. `None` for a line that misses it.
    #[must_use]
    #[inline]
    pub fn interval(&self, origin: [f64; 3], direction: [f64; 3]) -> Option<[f64; 2]> {
        let LinePassing { along, beside_square, .. } = LinePassing::new(self.center, origin, direction);
        let half_square = f64::from(self.radius).powi(2) - beside_square;
        let half = half_square.max(0.0).sqrt();
        (half_square > 0.0).then_some([along - half, along + half])
    }
}

/// Returns true if a ball of `radius` holds a point `distance` metres from its centre.
#[must_use]
#[inline]
pub fn holds_at(radius: f64, distance: f64) -> bool {
    distance <= radius
}

/// Returns the bias, metres: the depth inside a ball, along the line of sight, up to which a target counts as visible.
/// Only noise and balls separate such a point from its surface. It equals
/// [`DepthMap::default_depth_bias`](crate::depth::DepthMap::default_depth_bias) for pixels without extent, 0.22 m.
#[must_use]
pub fn surface_bias() -> f64 {
    SURFACE_DEVIATION * (1.0 + SLOPE * SLOPE).sqrt()
}
