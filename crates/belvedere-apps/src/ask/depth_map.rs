//! Depth map: the distance to the first surface for each pixel of a view.

use super::answers::{Answered, Answers, Ask};
use super::context::Context;
use super::places::Places;
use super::remark::Remark;
use super::scene::Scene;
use super::sections::{PictureSection, ViewDirection, ViewSection};
use super::viewer::remark_on_eye;
use belvedere_core::depth::{ItemBuffer, Profile};
use belvedere_core::query::Coverage;
use belvedere_data::control::Control;
use belvedere_data::raster::Raster;
use belvedere_data::report::{percent, rounded};
use belvedere_data::view::View;
use belvedere_data::{Error, Parameter, Result};
use serde::{Deserialize, Serialize};

/// The distance to the first surface for each pixel of a view.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default)]
pub struct DepthMapQuestion {
    /// Position and projection of the picture; must be set by whoever reads a question from text.
    #[serde(skip)]
    pub from: Option<ViewFrom>,
    /// True to keep the index of the ball in each pixel. Default: false.
    pub ball_ids: bool,
}

/// Position and projection of a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ViewFrom {
    /// One view.
    View(View),
    /// All around an eye.
    Panorama {
        /// The eye, local metres.
        eye: [f64; 3],
        /// Width, pixels, even; the picture is half as high.
        width: usize,
    },
}

/// A picture of depths.
#[derive(Clone, Debug)]
pub struct DepthMapResults {
    /// Distances, metres: along the axis of a view, from the eye of a panorama; infinite where nothing is hit.
    pub depth: Raster<f32>,
    /// The row of the ball that each pixel shows, where that was wanted.
    pub balls: Option<Raster<u32>>,
}

impl ViewFrom {
    /// Refuses a question without a view.
    pub(super) fn given(from: Option<Self>) -> Result<Self> {
        let expected = "given: the sun, a direction, a camera or a panorama";
        from.ok_or_else(|| Error::invalid(Parameter::View, "missing", expected))
    }

    /// Returns the position of the eye, local metres; `None` for parallel views.
    #[must_use]
    pub fn eye(&self) -> Option<[f64; 3]> {
        match self {
            Self::View(view) => view.is_central().then_some(view.frame.eye),
            Self::Panorama { eye, .. } => Some(*eye),
        }
    }

    /// Returns a remark on its eye.
    #[must_use]
    pub fn remark(&self, coverage: Option<&Coverage>) -> Option<Remark> {
        self.eye().and_then(|eye| remark_on_eye(coverage, eye))
    }

    /// Describes it for reports.
    #[must_use]
    pub fn section(&self) -> ViewSection {
        match self {
            Self::View(view) => {
                let pixels_per_metre = view.pixels_per_metre();
                ViewSection {
                    width_px: view.size_px[0],
                    height_px: view.size_px[1],
                    pixel_m: pixels_per_metre.map(|count| rounded(1.0 / count, 4)),
                    pixel_m_at_100_m: pixels_per_metre.is_none().then(|| rounded(view.pixel_width(100.0), 4)),
                    view_direction: ViewDirection::Along(view.frame.forward.map(|v| rounded(v, 4)).to_vec()),
                }
            }
            Self::Panorama { width, .. } => {
                let width = width.next_multiple_of(2);
                ViewSection {
                    width_px: width,
                    height_px: width / 2,
                    pixel_m: None,
                    pixel_m_at_100_m: None,
                    view_direction: ViewDirection::Around("all around"),
                }
            }
        }
    }
}

impl Ask for DepthMapQuestion {
    type Found = DepthMapResults;

    fn check(&self) -> Result<()> {
        Ok(())
    }

    fn answer(&self, scene: &Scene, _: &Places, context: &mut Context, control: &Control<'_>) -> Answered<Self> {
        let from = ViewFrom::given(self.from)?;
        context.add(from.remark(scene.model().coverage().as_ref()));
        let view = from.section();
        let (items, profile) =
            (if self.ball_ids { ItemBuffer::With } else { ItemBuffer::Without }, scene.rule().profile);
        let (depth, balls, around_eye_count) = control.stage("drawing depth map", 0, || match from {
            ViewFrom::View(view) => {
                let map = scene.model().depth_map(&view, profile, items, control)?;
                Ok((map.depth, map.balls, map.around_eye_count))
            }
            ViewFrom::Panorama { .. } if profile != Profile::Sphere => Err(Error::invalid(
                Parameter::BallProfile,
                "the paper's cone",
                "sphere: the cone is for parallel views only",
            )),
            ViewFrom::Panorama { eye, width } => {
                let map = scene.model().panorama(eye, width, items, control)?;
                Ok((map.range, map.balls, map.around_eye_count))
            }
        })?;
        let hit = depth.values().iter().filter(|depth| depth.is_finite()).count();
        let pixels_hit_percent = percent(hit, depth.values().len());
        let (width, height) = (view.width_px, view.height_px);
        context.headline(format!("{width} x {height} pixels, {pixels_hit_percent} % of them show a surface"));
        match (view.pixel_m, view.pixel_m_at_100_m) {
            (Some(side), _) => context.headline(format!("side of a pixel: {side} m")),
            (None, Some(side)) => context.headline(format!("side of a pixel at a distance of 100 m: {side} m")),
            (None, None) => {}
        }
        context.report.view = Some(view);
        let balls_around_eye_ignored = from.eye().map(|_| around_eye_count);
        context.report.picture = Some(PictureSection { pixels_hit_percent, balls_around_eye_ignored });
        Ok(Answers::new(DepthMapResults { depth, balls }, Vec::new()))
    }
}
