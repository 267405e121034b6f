//! Shadow maps of a model: the depth of the first triangle per pixel, looked up instead of traced.

use crate::lines_of_sight::{check_clearance, check_min, check_positive};
use crate::mesh_rays::{MeshRays, MeshRaysParams};
use belvedere::cast::to_index;
use belvedere::query::{Answer, Sight, Viewer, Visibility};
use belvedere::ray_index::Ray;
use belvedere::vector::{cross, dot, sub, unit};
use belvedere::view::View;
use belvedere::{Error, Mesh, Parameter, Result};
use rayon::prelude::*;

/// How a [`ShadowMap`] is drawn and looked up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShadowMapParams {
    /// Side of a pixel of a parallel view, metres, above 0. Default 0.25: half the spacing of airborne scans, as the
    /// depth maps of medial balls have it.
    pub pixel_size: f64,
    /// Pixels along each side of the six faces around an eye, 1 to 16 384. Default 1024: 0.15 m at a range of 100 m.
    pub face_px: usize,
    /// Constant depth bias: how far behind the depth of its pixel a target may lie and still be visible, metres, 0 or
    /// more. Default 0.05: with the slope bias, any value to 0.1 does as well on a simulated town (seed 7, not one that
    /// is reported).
    pub depth_bias: f64,
    /// Slope-scaled depth bias, 0 or more: this many pixels along the surface drawn in a pixel, seen as depth, are
    /// added to the bias. Default 0.71, half the diagonal of a pixel: just what a flat surface needs in order not to
    /// shade itself, because the target may lie in a corner of the pixel and the depth is that of its middle. Without
    /// it, 5 instead of 1.5 % of that town's sunlit roof points are dark.
    pub slope_bias: f64,
    /// Most that `slope_bias` adds, metres, 0 or more. Default 0.5: a wall seen edge-on would otherwise reveal all
    /// behind it; 1 misses half a percent more of the roofs an observer cannot see.
    pub max_slope_bias: f64,
}

impl Default for ShadowMapParams {
    fn default() -> Self {
        Self { pixel_size: 0.25, face_px: 1024, depth_bias: 0.05, slope_bias: 0.71, max_slope_bias: 0.5 }
    }
}

/// A model of which depth maps are drawn.
///
/// A target beside the picture of a parallel view is visible, since the picture holds the whole model. An eye inside a
/// solid sees its inside.
pub struct ShadowMap {
    mesh: MeshRays,
    params: ShadowMapParams,
}

impl ShadowMap {
    /// Indexes `mesh`, metres of its reference system, for local positions relative to `origin`.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a parameter out of its range.
    pub fn new(mesh: &Mesh, origin: [f64; 3], params: &ShadowMapParams) -> Result<Self> {
        check_positive("pixel size", params.pixel_size)?;
        check_clearance(params.depth_bias)?;
        check_min("slope bias", params.slope_bias, 0.0, "finite and not negative")?;
        check_min("maximum slope bias", params.max_slope_bias, 0.0, "finite and not negative, metres")?;
        if !(1..=16_384).contains(&params.face_px) {
            return Err(Error::InvalidParameter {
                parameter: Parameter::MethodSetting,
                value: format!("{} for the pixels along a face", params.face_px),
                expected: "1 to 16384",
            });
        }
        Ok(Self { mesh: MeshRays::new(mesh, origin, &MeshRaysParams::default())?, params: *params })
    }

    /// Depth beyond which the pixel of `ray` is dark: where the ray meets the first triangle, as depth along `forward`,
    /// plus the bias of a pixel that is `footprint` metres wide per metre of depth or, for `PixelWidth::Metres`,
    /// everywhere.
    fn dark_beyond(&self, ray: &Ray, forward: [f64; 3], footprint: PixelWidth) -> f64 {
        let Some((range, [a, b, c])) = self.mesh.first(ray) else { return f64::INFINITY };
        let depth = range * dot(ray.direction, forward);
        let width = match footprint {
            PixelWidth::Metres(width) => width,
            PixelWidth::PerMetre(width) => width * depth,
        };
        let steepness = unit(cross(sub(b, a), sub(c, a))).map_or(f64::INFINITY, |normal| {
            let cosine = dot(normal, forward).abs();
            (1.0 - cosine * cosine).max(0.0).sqrt() / cosine
        });
        // zero times the infinite steepness of a triangle seen edge-on is no bias
        let slope_bias = self.params.slope_bias * width * steepness;
        depth + self.params.depth_bias + if slope_bias > 0.0 { slope_bias.min(self.params.max_slope_bias) } else { 0.0 }
    }

    fn seen_in_direction<'a>(&'a self, to_viewer: [f64; 3]) -> Result<Sight<'a>> {
        let Some([low, high]) = self.mesh.bounds() else {
            return Ok(Box::new(|targets| Ok(targets.iter().map(|t| nothing_blocks(*t)).collect())));
        };
        let view = View::parallel(to_viewer.map(|v| -v), low, high, self.params.pixel_size)?;
        let frame = view.frame;
        let [width, height] = view.size_px;
        let mut dark_beyond = vec![f64::INFINITY; width * height];
        dark_beyond.par_chunks_mut(width).enumerate().for_each(|(row, depths)| {
            for (column, depth) in depths.iter_mut().enumerate() {
                let middle = |index: usize| (index as f64 + 0.5) * self.params.pixel_size;
                let origin = frame.local_from_view([middle(column), middle(row), 0.0]);
                // the plane of the picture touches the model: rounding must not put the model before it
                let Some(ray) = Ray::new(origin, frame.forward, [-1.0, f64::INFINITY]) else { continue };
                *depth = self.dark_beyond(&ray, frame.forward, PixelWidth::Metres(self.params.pixel_size));
            }
        });
        Ok(Box::new(move |targets| {
            let answer = |target: &[f32; 3]| {
                let [x, y, depth] = frame.view_from_local(*target);
                let pixel = |v: f64| pixel_at(v / self.params.pixel_size);
                let dark_beyond = match (pixel(x), pixel(y)) {
                    (Some(column), Some(row)) if column < width => dark_beyond.get(row * width + column),
                    _ => None,
                };
                match dark_beyond {
                    Some(&dark_beyond) if depth >= dark_beyond => Answer::Blocked,
                    _ => nothing_blocks(*target),
                }
            };
            Ok(targets.par_iter().with_min_len(CHUNK).map(answer).collect())
        }))
    }

    fn seen_by_eye<'a>(&'a self, eye: [f64; 3]) -> Sight<'a> {
        let size = self.params.face_px;
        let mut dark_beyond = vec![f64::INFINITY; 6 * size * size];
        dark_beyond.par_chunks_mut(size).enumerate().for_each(|(line, depths)| {
            let (face, row) = (line / size, line % size);
            for (column, depth) in depths.iter_mut().enumerate() {
                let middle = |index: usize| (2 * index + 1) as f64 / size as f64 - 1.0;
                let Some(ray) = Ray::new(eye, face_direction(face, middle(column), middle(row)), [0.0, f64::INFINITY])
                else {
                    continue;
                };
                let forward = face_direction(face, 0.0, 0.0);
                *depth = self.dark_beyond(&ray, forward, PixelWidth::PerMetre(2.0 / size as f64));
            }
        });
        Box::new(move |targets| {
            let answer = |&target: &[f32; 3]| {
                let Some((face, x, y, depth)) = face_of(sub(target.map(f64::from), eye)) else {
                    return Answer::OutsideView;
                };
                // the farther edge of a face belongs to its last pixel
                let pixel = |v: f64| pixel_at((v + 1.0) / 2.0 * size as f64).unwrap_or(0).min(size - 1);
                let dark = dark_beyond.get((face * size + pixel(y)) * size + pixel(x));
                if dark.is_some_and(|&dark_beyond| depth >= dark_beyond) { Answer::Blocked } else { Answer::Visible }
            };
            Ok(targets.par_iter().with_min_len(CHUNK).map(answer).collect())
        })
    }
}

impl Visibility for ShadowMap {
    fn seen_from<'a>(&'a self, viewer: Viewer<'a>) -> Result<Sight<'a>> {
        viewer.validate()?;
        match viewer {
            Viewer::Direction(to_viewer) => self.seen_in_direction(to_viewer),
            Viewer::Eye(eye) => Ok(self.seen_by_eye(eye)),
            Viewer::Each(_) => Err(Error::UnsupportedViewer {
                method: "shadow mapping",
                what: "from one direction or one eye; a map for every target would cost more than a ray",
            }),
        }
    }
}

/// Targets handed to a thread at once.
const CHUNK: usize = 16_384;

/// Width of a pixel.
#[derive(Clone, Copy)]
enum PixelWidth {
    Metres(f64),
    /// Metres per metre of depth.
    PerMetre(f64),
}

fn nothing_blocks(target: [f32; 3]) -> Answer {
    if target.iter().all(|v| v.is_finite()) { Answer::Visible } else { Answer::OutsideView }
}

/// The pixel that holds a coordinate in pixels, or `None` below zero and for NaN.
fn pixel_at(coordinate: f64) -> Option<usize> {
    (coordinate >= 0.0).then_some(to_index(coordinate))
}

/// Direction through a face of the cube around an eye: faces 0 to 5 look along +x, −x, +y, −y, +z, −z; `x` and `y` run
/// from −1 to 1 along the two other axes in cyclic order.
fn face_direction(face: usize, x: f64, y: f64) -> [f64; 3] {
    let axis = face / 2;
    let mut direction = [0.0; 3];
    direction[axis] = if face.is_multiple_of(2) { 1.0 } else { -1.0 };
    direction[(axis + 1) % 3] = x;
    direction[(axis + 2) % 3] = y;
    direction
}

/// Face, coordinates within it and depth of a position relative to the eye; `None` at the eye and where it is not
/// finite.
fn face_of(position: [f64; 3]) -> Option<(usize, f64, f64, f64)> {
    let longer = |a: usize, b: usize| if position[b].abs() > position[a].abs() { b } else { a };
    let axis = longer(longer(0, 1), 2);
    let depth = position[axis].abs();
    if !(depth > 0.0 && position.iter().all(|v| v.is_finite())) {
        return None;
    }
    let face = 2 * axis + usize::from(position[axis] < 0.0);
    Some((face, position[(axis + 1) % 3] / depth, position[(axis + 2) % 3] / depth, depth))
}
