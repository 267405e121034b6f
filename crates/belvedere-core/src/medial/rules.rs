//! The rules of carving, in the order in which they are applied: a rule is a file, and a line here.

use super::close_range::CloseRangeParams;
use super::crowns::{CrownParams, Trees};
use super::data_voids::DataVoidParams;
use super::kinds::KindCaps;
use super::marking_rule::MarkingRule;
use super::prune::PruneParams;
use super::relief::ReliefParams;
use super::roof_edges::RoofEdgeParams;
use super::shrinking_ball::{ShrinkMethod, ShrinkParams};
use super::slender::SlenderParams;
use super::thin_surfaces::ThinSurfaceParams;
use super::vegetation::VegetationParams;
use crate::planes::PlaneParams;

/// Points are moved onto the surface that they scatter about before balls are made ([`crate::normals::Scatter`]). The
/// model does that, with the normals; [`super::carved_balls`] takes points as they are.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SmoothingParams;

impl MarkingRule for SmoothingParams {}
// the model finds surfaces when the balls are there, because what closes them is no ball
impl MarkingRule for PlaneParams {}
impl MarkingRule for VegetationParams {}

macro_rules! rules {
    ($($(#[$doc:meta])* $name:literal $rule:ident $field:ident: $params:ty,)*) => {
        /// A rule that can be left out.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Rule {
            $($(#[$doc])* $rule,)*
        }

        impl Rule {
            /// Every rule, in the order in which they are applied.
            pub const ALL: [Self; [$($name),*].len()] = [$(Self::$rule),*];

            /// Name on the command line and in tables: lower case and hyphens.
            #[must_use]
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$rule => $name,)*
                }
            }
        }

        /// Parameters of carved balls. Every rule that is `Some` is applied. [`CarvedParams::default`] applies all;
        /// docs/methods/carving.md compares their benefit.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct CarvedParams {
            /// Depth to which a point may enter a ball, metres, above 0. Default 0.02: a penetration of 0.05 m costs
            /// 1.3 points on facades. Pulses enter none.
            pub penetration: f32,
            /// Initial radius of every ball, metres. Default 5. Balls of 15 m answer the same, cost 40 % more a query,
            /// and bulge farther where no pulse passes. With 3 m, 1.2 points more of the shade of streets are lost.
            pub initial_radius: f32,
            /// Largest radius of any ball, metres, above 0; +∞, the default, for no limit but those that pulses and
            /// rules set.
            pub max_radius: f32,
            /// Largest radii by kind of point.
            pub kind_caps: KindCaps,
            /// Sizes for scanners on the ground, which replace those above and leave none of the rules. `None` treats
            /// all scanners as if they flew.
            pub close_range: Option<CloseRangeParams>,
            $($(#[$doc])* pub $field: Option<$params>,)*
        }

        impl Default for CarvedParams {
            fn default() -> Self {
                Self {
                    penetration: 0.02,
                    initial_radius: 5.0,
                    max_radius: f32::INFINITY,
                    kind_caps: KindCaps::default(),
                    close_range: Some(CloseRangeParams::default()),
                    $($field: Some(<$params>::default()),)*
                }
            }
        }

        impl CarvedParams {
            /// These parameters without one rule.
            #[must_use]
            pub fn without(mut self, rule: Rule) -> Self {
                match rule {
                    $(Rule::$rule => self.$field = None,)*
                }
                self
            }

            /// The rules that are applied, in order.
            pub(super) fn rules(&self) -> Vec<&dyn MarkingRule> {
                let rules = [$(self.$field.as_ref().map(|params| params as &dyn MarkingRule)),*];
                rules.into_iter().flatten().collect()
            }
        }
    };
}

rules! {
    /// Moves points onto the surface that they scatter about.
    "smoothing" Smoothing smoothing: SmoothingParams,
    /// Finds vegetation in clouds without its classes.
    "vegetation" Vegetation vegetation: VegetationParams,
    /// Measures, caps, centres and fills crowns of trees.
    "crowns" Crowns crowns: CrownParams,
    /// Caps and fills fences, wires and the like.
    "slender" Slender slender: SlenderParams,
    /// Caps and fills surfaces that pulses run below.
    "thin-surfaces" ThinSurfaces thin_surfaces: ThinSurfaceParams,
    /// Cuts below the edges of roofs, where walls stand that no pulse reached, and above roofs.
    "roof-edges" RoofEdges roof_edges: RoofEdgeParams,
    /// Cuts where balls reach over places without returns.
    "data-voids" DataVoids data_voids: DataVoidParams,
    /// Fills edges, ridges, chimneys and low walls down to the next lower level.
    "relief" Relief relief: ReliefParams,
    /// Leaves out balls that others make superfluous.
    "pruning" Pruning pruning: PruneParams,
    /// Closes roofs and walls where many points show their planes, and caps balls that reach out of them.
    "planes" Planes planes: PlaneParams,
}

impl CarvedParams {
    /// These parameters with crowns treated as `trees`, unless their rule is left out.
    #[must_use]
    pub fn with_trees(mut self, trees: Trees) -> Self {
        self.crowns = self.crowns.map(|crowns| CrownParams { trees, ..crowns });
        self
    }

    /// Returns the parameters of shrinking before carving.
    #[must_use]
    pub fn shrinking(&self) -> ShrinkParams {
        ShrinkParams {
            method: ShrinkMethod::Tau { penetration: self.penetration },
            initial_radius: self.initial_radius,
            max_radius: self.max_radius,
            max_spacings: f32::INFINITY,
        }
    }
}
