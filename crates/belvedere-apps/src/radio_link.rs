//! Fresnel zones of radio links: the space around a line of sight that must be free too.

use belvedere_core::query::{Answer, EarthParams, LineOfSight, MedialScene, Obstacle};
use belvedere_core::triangle_tree::Corners;
use belvedere_data::cast::to_index;
use belvedere_data::control::Control;
use belvedere_data::vector::{dot, length, sub, unit};
use belvedere_data::{Error, Parameter, Result};
use rayon::prelude::*;

/// Speed of light, metres a second.
const LIGHT_SPEED: f64 = 299_792_458.0;
/// Frequencies of radio links, GHz: below, the zone is wider than the links are long; above is infrared.
const FREQUENCIES_GHZ: [f64; 2] = [0.001, 1000.0];
/// Length of the pieces of a link whose boxes are searched for obstacles, metres: shorter ones search less air and more
/// often.
const PIECE: f64 = 16.0;
/// Maximum number of pieces of a link: longer ones have longer pieces.
const MAX_PIECES: f64 = 10_000.0;
/// Steps in which the narrowest place of a zone is found: each keeps two thirds of the range.
const STEPS: usize = 60;

/// The wave of a radio link.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RadioWave {
    /// Metres, above zero.
    wavelength: f64,
}

impl RadioWave {
    /// The wave of a frequency in GHz, 0.001 to 1000.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for another frequency.
    pub fn of_frequency(ghz: f64) -> Result<Self> {
        let [min, max] = FREQUENCIES_GHZ;
        if !(min..=max).contains(&ghz) {
            return Err(Error::InvalidParameter {
                parameter: Parameter::Frequency,
                value: format!("{ghz} GHz"),
                expected: "from 0.001 to 1000 GHz",
            });
        }
        Ok(Self { wavelength: LIGHT_SPEED / (1e9 * ghz) })
    }

    /// Radius of the first Fresnel zone at a place of the line that lies `from` and `to` metres from its ends, metres.
    ///
    /// # Source
    /// ITU-R P.526-15, equation 2: the square root of λ d₁ d₂ / (d₁ + d₂).
    #[must_use]
    pub fn zone_radius(&self, [from, to]: [f64; 2]) -> f64 {
        (self.wavelength * from * to / (from + to)).max(0.0).sqrt()
    }
}

/// A radio link, with the heights of obstacles raised by the sag of the link, so that it is straight.
struct Link {
    start: [f64; 3],
    /// Unit vector to the other end.
    axis: [f64; 3],
    length: f64,
    /// Its length on the map.
    span: f64,
    earth: EarthParams,
    is_bent: bool,
    wave: RadioWave,
}

impl Link {
    /// The link between two ends; over far terrain it is bent however short it is.
    fn new(ends: [[f64; 3]; 2], wave: RadioWave, earth: &EarthParams, is_far: bool) -> Option<Self> {
        let [start, end] = ends;
        let along = sub(end, start);
        let axis = unit(along).filter(|_| ends.as_flattened().iter().all(|v| v.is_finite()))?;
        let span = along[0].hypot(along[1]);
        let is_bent = is_far || earth.bends(start, end);
        Some(Self { start, axis, length: length(along), span, earth: *earth, is_bent, wave })
    }

    fn sag(&self, along: f64) -> f64 {
        if self.is_bent { self.earth.sag(self.span, (along / self.length).clamp(0.0, 1.0)) } else { 0.0 }
    }

    /// Returns the distance of a place along the straightened link, and its distance from the link, metres.
    fn position_along(&self, place: [f64; 3]) -> [f64; 2] {
        let [x, y, z] = sub(place, self.start);
        let raised = [x, y, z + self.sag(dot([x, y, z], self.axis))];
        let along = dot(raised, self.axis);
        let across = std::array::from_fn(|i| raised[i] - along * self.axis[i]);
        [along, length(across)]
    }

    /// Radius of the first zone, metres; 0 beyond the ends.
    fn radius(&self, along: f64) -> f64 {
        self.wave.zone_radius([along, self.length - along])
    }

    /// Returns the free share of the radius of the zone for an obstacle `beside` metres from the line at `along`. It is
    /// infinite at the ends, where the zone is a point.
    fn share(&self, along: f64, beside: f64) -> f64 {
        let radius = self.radius(along);
        if radius > 0.0 { beside.max(0.0) / radius } else { f64::INFINITY }
    }

    /// The share of the zone that a ball of `radius` metres leaves free, if it is less than `max`.
    fn share_beside(&self, center: [f64; 3], radius: f64, max: f64) -> f64 {
        let [along, beside] = self.position_along(center);
        let [from, to] = [(along - radius).max(0.0), (along + radius).min(self.length)];
        if from >= to || beside - radius >= max * self.radius((self.length / 2.0).clamp(from, to)) {
            return f64::INFINITY;
        }
        // the gap is convex along the line and the radius of the zone concave, so that their quotient has one minimum
        let gap = |t: f64| beside - (radius * radius - (t - along) * (t - along)).max(0.0).sqrt();
        min(from, to, |t| self.share(t, gap(t)))
    }

    /// The share of the zone that a triangle leaves free, if it is less than `max`.
    fn share_before(&self, corners: &Corners, max: f64) -> f64 {
        let middle: [f64; 3] = std::array::from_fn(|i| corners.iter().map(|corner| corner[i]).sum::<f64>() / 3.0);
        let reach = corners.iter().map(|&corner| length(sub(corner, middle))).fold(0.0, f64::max);
        // it leaves at least what the sphere around it leaves; the sag raises its corners by less than this beside its
        // middle
        let around = reach * (1.0 + 4.0 * self.sag(self.length / 2.0) / self.length);
        if self.position_along(middle)[1] - around >= max * self.radius(self.length / 2.0) {
            return f64::INFINITY;
        }
        let beside_ends = self.between_ends(corners);
        let Some((&a, others)) = beside_ends.split_first() else { return f64::INFINITY };
        let between =
            |p: [f64; 3], q: [f64; 3], t: f64| -> [f64; 3] { std::array::from_fn(|i| p[i] + t * (q[i] - p[i])) };
        let of_triangle = |pair: &[[f64; 3]]| {
            // the distance to a line is convex over a triangle: one minimum along every line in it, and one across
            // these
            min(0.0, 1.0, |across| {
                let [from, to] = [pair[0], pair[1]].map(|corner| between(a, corner, across));
                min(0.0, 1.0, |t| {
                    let [along, beside] = self.position_along(between(from, to, t));
                    self.share(along, beside)
                })
            })
        };
        others.windows(2).map(of_triangle).fold(f64::INFINITY, f64::min)
    }

    /// Corners of the part of a triangle that lies between the planes across the two ends.
    fn between_ends(&self, corners: &Corners) -> Vec<[f64; 3]> {
        let mut part = corners.to_vec();
        for beyond in [|_: &Self, along: f64| -along, |link: &Self, along: f64| along - link.length] {
            let whole = std::mem::take(&mut part);
            let depths: Vec<f64> = whole.iter().map(|&corner| beyond(self, self.position_along(corner)[0])).collect();
            for i in 0..whole.len() {
                let next = (i + 1) % whole.len();
                if depths[i] <= 0.0 {
                    part.push(whole[i]);
                }
                if depths[i] * depths[next] < 0.0 {
                    let t = depths[i] / (depths[i] - depths[next]);
                    part.push(std::array::from_fn(|k| whole[i][k] + t * (whole[next][k] - whole[i][k])));
                }
            }
        }
        part
    }

    /// Boxes around pieces of the zone, by `share` of its radius: lowest and highest corner.
    fn boxes(&self, share: f64) -> impl Iterator<Item = [[f64; 3]; 2]> + Clone {
        let count = (self.length / PIECE).ceil().clamp(1.0, MAX_PIECES);
        (0..to_index(count)).map(move |piece| {
            let [from, to] = [piece as f64, (piece + 1) as f64].map(|i| self.length * i / count);
            let widest = self.radius((self.length / 2.0).clamp(from, to)) * share;
            let place = |t: f64| -> [f64; 3] {
                let [x, y, z] = std::array::from_fn(|i| self.start[i] + t * self.axis[i]);
                [x, y, z - self.sag(t)]
            };
            // a piece of a curve lies less below its chord than the whole below the highest of its ends
            let (a, b, room) = (place(from), place(to), widest + self.sag_within(to - from));
            [std::array::from_fn(|i| a[i].min(b[i]) - room), std::array::from_fn(|i| a[i].max(b[i]) + room)]
        })
    }

    /// Returns the maximum distance of a piece of this length from its chord, metres.
    fn sag_within(&self, piece: f64) -> f64 {
        if self.is_bent { self.earth.sag(self.span * piece / self.length, 0.5) } else { 0.0 }
    }
}

/// The least value of a function with one minimum between two numbers.
fn min(mut from: f64, mut to: f64, value: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..STEPS {
        let third = (to - from) / 3.0;
        let [a, b] = [from + third, to - third];
        let [of_a, of_b] = [value(a), value(b)];
        if of_a <= 0.0 || of_b <= 0.0 {
            return 0.0;
        }
        if of_a <= of_b { to = b } else { from = a }
    }
    value(f64::midpoint(from, to)).max(0.0)
}

impl RadioWave {
    /// Returns the free share of the radius of the first Fresnel zone of a radio link between two points, local metres.
    /// It is 0 if something touches the line itself, and at most `max`. A zone counts as free from 0.6 on (ITU-R
    /// P.530). NaN for points that are not finite, or coincide.
    ///
    /// The obstacles are those of [`MedialScene::visit_obstacles_near`]. Whether the line of sight is proven is another
    /// question. On a curved line the sag is that at the middle of each ball.
    #[must_use]
    pub fn zone_clearance(self, scene: &MedialScene, ends: [[f64; 3]; 2], earth: &EarthParams, max: f64) -> f64 {
        let Some(link) = Link::new(ends, self, earth, scene.leaves_cloud(ends)) else { return f64::NAN };
        let mut clearance = max;
        scene.visit_obstacles_near(ends, link.boxes(max), |obstacle| {
            if clearance > 0.0 {
                clearance = clearance.min(match obstacle {
                    Obstacle::Ball { center, radius } => link.share_beside(center, radius, clearance),
                    Obstacle::Triangle(corners) => link.share_before(corners, clearance),
                });
            }
        });
        clearance
    }

    /// [`RadioWave::zone_clearance`] up to the whole zone of each of `pairs`, (N, two ends), local metres, whose lines
    /// of sight are `sights`, (N,), of [`MedialScene::lines_of_sight`]. A link that is blocked has none free, and one
    /// with an end outside the cloud, or without a line, is NaN. Progress counts pairs.
    ///
    /// # Errors
    /// [`Error::LengthMismatch`] for another number of lines of sight, and [`Error::Cancelled`].
    pub fn zone_clearances(
        self,
        scene: &MedialScene,
        pairs: &[[[f64; 3]; 2]],
        sights: &[Option<LineOfSight>],
        earth: &EarthParams,
        control: &Control<'_>,
    ) -> Result<Vec<f64>> {
        let (expected, found) = (pairs.len(), sights.len());
        if expected != found {
            return Err(Error::LengthMismatch { what: "lines of sight of the links", expected, found });
        }
        let of_pair = |(&ends, sight): (&[[f64; 3]; 2], &Option<LineOfSight>)| {
            control.check()?;
            let clearance = match sight.map(|sight| sight.answer) {
                Some(Answer::Visible | Answer::Unproven) => self.zone_clearance(scene, ends, earth, 1.0),
                Some(Answer::Blocked | Answer::InsideObstacle) => 0.0,
                _ => f64::NAN,
            };
            control.advance(1);
            Ok(clearance)
        };
        pairs.par_iter().zip(sights).map(of_pair).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use belvedere_core::query::{BlockRule, BlockingTriangles};
    use belvedere_data::Mesh;
    use belvedere_data::balls::MedialBalls;
    use belvedere_data::random::uniform;
    use belvedere_data::vector::to_f32;

    fn scene(balls: &[([f32; 3], f32)]) -> MedialScene {
        let balls = MedialBalls {
            centers: balls.iter().map(|ball| ball.0).collect(),
            radii: balls.iter().map(|ball| ball.1).collect(),
            source: vec![0; balls.len()],
            touch: vec![0; balls.len()],
            separation_angles: vec![1.0; balls.len()],
        };
        MedialScene::new(&balls, &BlockRule { shell: 0.0, ..BlockRule::carved() }).unwrap()
    }

    #[test]
    fn the_zone_has_the_radius_of_the_handbooks() {
        // 17.32 m times the root of d1 d2 / (f D), kilometres and GHz
        let wave = RadioWave::of_frequency(2.4).unwrap();
        let expected = 17.32 * (4.0 * 6.0 / (2.4 * 10.0_f64)).sqrt();
        assert!((wave.zone_radius([4000.0, 6000.0]) - expected).abs() < 0.01);
        for frequency in [0.0, -1.0, f64::NAN, 1e4] {
            assert!(RadioWave::of_frequency(frequency).is_err());
        }
    }

    #[test]
    fn what_a_ball_leaves_free_is_what_the_points_on_it_leave() {
        let wave = RadioWave::of_frequency(0.9).unwrap();
        let ends = [[3.0, -2.0, 4.0], [90.0, 40.0, 12.0]];
        let axis = unit(sub(ends[1], ends[0])).unwrap();
        let whole = length(sub(ends[1], ends[0]));
        for i in 0..40 {
            let random = |k: u64| uniform(7, 16 * i + k);
            let along = 5.0 + 85.0 * random(0);
            let center: [f32; 3] =
                std::array::from_fn(|k| to_f32(ends[0][k] + along * axis[k] + 8.0 * (random(1 + k as u64) - 0.5)));
            let radius = to_f32(0.2 + 3.0 * random(5));
            let found = wave.zone_clearance(&scene(&[(center, radius)]), ends, &EarthParams::flat(), 9.0);
            // random points of the ball: none leaves less, and the best leaves hardly more. About 100 000 lie 3 cm
            // apart on the largest ball, a fiftieth of the zone and more near its ends; a ball that the line crosses
            // has points as near to it
            let mut min = 9.0_f64;
            for n in 0..200_000 {
                let offset: [f64; 3] = std::array::from_fn(|k| 2.0 * uniform(3, 4 * n + k as u64) - 1.0);
                if length(offset) > 1.0 {
                    continue;
                }
                let offset = unit(offset).unwrap();
                let place: [f64; 3] = std::array::from_fn(|k| f64::from(center[k]) + f64::from(radius) * offset[k]);
                let from = dot(sub(place, ends[0]), axis);
                let beside = length(std::array::from_fn(|k| place[k] - ends[0][k] - from * axis[k]));
                if from > 0.0 && from < whole {
                    min = min.min(beside / wave.zone_radius([from, whole - from]));
                }
            }
            let crosses = found == 0.0 && min < 0.2;
            assert!(crosses || found <= min + 1e-9 && min - found < 0.02 * (1.0 + min), "{found} {min}");
        }
    }

    #[test]
    fn a_wall_below_a_link_leaves_the_share_of_its_gap() {
        // a wall across the link, its edge 2 m below the line, 30 m from one end and 70 m from the other
        let mesh = Mesh {
            vertices: vec![[30.0, -50.0, -9.0], [30.0, 50.0, -9.0], [30.0, 50.0, 8.0], [30.0, -50.0, 8.0]],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            ..Mesh::default()
        };
        let added = BlockingTriangles::new(&mesh, "wall", [0.0; 3], None, None).unwrap();
        let wave = RadioWave::of_frequency(2.4).unwrap();
        let ends = [[0.0, 0.0, 10.0], [100.0, 0.0, 10.0]];
        let scene = scene(&[]).with_triangles(Some(added));
        let found = wave.zone_clearance(&scene, ends, &EarthParams::flat(), 9.0);
        let expected = 2.0 / wave.zone_radius([30.0, 70.0]);
        assert!((found - expected).abs() < 1e-6, "{found} {expected}");
        // beyond its end, in its own direction, a wall does not matter
        let before = [[0.0, 0.0, 7.0], [29.0, 0.0, 7.0]];
        assert!(wave.zone_clearance(&scene, before, &EarthParams::flat(), 9.0) >= 9.0);
        let through = [[0.0, 0.0, 7.0], [100.0, 0.0, 7.0]];
        assert!(wave.zone_clearance(&scene, through, &EarthParams::flat(), 9.0) < 1e-6);
    }

    #[test]
    fn what_a_triangle_leaves_free_is_what_the_points_on_it_leave() {
        let wave = RadioWave::of_frequency(0.9).unwrap();
        let ends = [[3.0, -2.0, 4.0], [90.0, 40.0, 12.0]];
        let axis = unit(sub(ends[1], ends[0])).unwrap();
        let whole = length(sub(ends[1], ends[0]));
        let mut narrowed = 0;
        for i in 0..40 {
            let random = |k: u64| uniform(11, 32 * i + k);
            let along = whole * random(0);
            let corner = |n: u64| -> [f64; 3] {
                std::array::from_fn(|k| ends[0][k] + along * axis[k] + 24.0 * (random(1 + 3 * n + k as u64) - 0.5))
            };
            let corners = [corner(0), corner(1), corner(2)];
            let mesh = Mesh { vertices: corners.to_vec(), triangles: vec![[0, 1, 2]], ..Mesh::default() };
            let added = BlockingTriangles::new(&mesh, "sheet", [0.0; 3], None, None).unwrap();
            let scene = scene(&[]).with_triangles(Some(added));
            let found = wave.zone_clearance(&scene, ends, &EarthParams::flat(), 9.0);
            let mut min = 9.0_f64;
            // a grid of 300 by 300: points lie 10 cm apart or less, a thirtieth of the zone and more near its ends
            for (u, v) in (0..=300_u16).flat_map(|u| (0..=300 - u).map(move |v| (u, v))) {
                let [u, v] = [u, v].map(|share| f64::from(share) / 300.0);
                let place: [f64; 3] = std::array::from_fn(|k| {
                    corners[0][k] + u * (corners[1][k] - corners[0][k]) + v * (corners[2][k] - corners[0][k])
                });
                let from = dot(sub(place, ends[0]), axis);
                let beside = length(std::array::from_fn(|k| place[k] - ends[0][k] - from * axis[k]));
                if from > 0.0 && from < whole {
                    min = min.min(beside / wave.zone_radius([from, whole - from]));
                }
            }
            assert!(found <= min + 1e-6 && min - found < 0.05 * (1.0 + min), "{found} {min}");
            narrowed += usize::from(min > 0.1 && min < 9.0);
        }
        assert!(narrowed > 20, "{narrowed}");
    }

    #[test]
    fn the_curved_earth_lifts_what_stands_in_the_middle() {
        let wave = RadioWave::of_frequency(5.8).unwrap();
        let ends = [[0.0, 0.0, 50.0], [10_000.0, 0.0, 50.0]];
        let scene = scene(&[([5000.0, 0.0, 20.0], 5.0)]);
        let [flat, curved] =
            [EarthParams::flat(), EarthParams::default()].map(|earth| wave.zone_clearance(&scene, ends, &earth, 9.0));
        let sag = EarthParams::default().sag(10_000.0, 0.5);
        let radius = wave.zone_radius([5000.0, 5000.0]);
        assert!((flat - 25.0 / radius).abs() < 1e-3 && (curved - (25.0 - sag) / radius).abs() < 1e-3);
        assert!(wave.zone_clearance(&scene, [ends[0]; 2], &EarthParams::flat(), 1.0).is_nan());
    }
}
