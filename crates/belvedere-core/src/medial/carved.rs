//! The model that Belvedere answers from: balls cut by pulses, and the rules for what balls alone represent badly.

use super::bounds::{Kind, KindBounds, RadiusBounds, kinds};
use super::carve::{CarveReport, carve};
use super::cells::{highest, lowest_near};
use super::close_range::{CloseRangeBalls, CloseRangeParams};
use super::crowns::{self, CrownParams, Crowns, Trees};
use super::data_voids::{DataVoidParams, DataVoids};
use super::prune::{PruneParams, prune_in_blocks_of};
use super::relief::{Relief, ReliefParams};
use super::roof_edges::{RoofEdgeParams, RoofEdges};
use super::roof_tops::RoofTops;
use super::shrinking_ball::{ShrinkMethod, ShrinkParams, ShrinkReport, shrink};
use super::slender::{Slender, SlenderParams};
use super::spacing::{pulse_counts, pulse_spacing};
use super::thin_surfaces::{self, ThinSurfaceParams, on_thin_surfaces, on_thin_surfaces_of_part};
use super::vegetation::{VegetationParams, tell_vegetation};
use super::whole_survey::{SurveyPart, WholeSurvey};
use crate::neighbors::NeighborIndex;
use crate::normals::OrientedCloud;
use crate::pulses::{FreeSegments, Pulses};
use belvedere_data::balls::{MedialBalls, Side};
use belvedere_data::control::Control;
use belvedere_data::{Attributes, Result};
use serde::Serialize;

/// Upward part of a normal below which a point lies on the face of a wall rather than on its edge: within 17° of upright.
const FACE_NORMAL_Z: f32 = 0.3;

/// How carved balls are made. Every rule that is `Some` is applied; [`CarvedParams::default`] applies those that the comparison
/// of docs/methods/carving.md shows to earn their place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CarvedParams {
    /// Depth to which a point may enter a ball, metres, above 0. Default 0.02: a penetration of 0.05 m costs 1.3 points on facades. Pulses
    /// enter none.
    pub penetration: f32,
    /// Radius every ball starts with, metres. Default 5: 15 m answer the same, cost 40 % more a query and bulge farther where
    /// no pulse passes; 3 m let 1.2 points more of the shade of streets through.
    pub initial_radius: f32,
    /// Most radius of any ball, metres, above 0; +∞, the default, for no limit but those that pulses and rules set.
    pub max_radius: f32,
    /// Whether points are moved onto the surface that they scatter about before balls are made ([`crate::normals::Scatter`]). The model does
    /// that, with the normals; [`carved_balls`] takes points as they are.
    pub smoothing: bool,
    /// Bounds by kind of point.
    pub kind_bounds: KindBounds,
    /// How vegetation is told in clouds without its classes.
    pub vegetation: Option<VegetationParams>,
    /// How crowns of trees are measured, limited and filled.
    pub crowns: Option<CrownParams>,
    /// How fences, wires and the like are limited and filled.
    pub slender: Option<SlenderParams>,
    /// Leaves out balls that others make superfluous.
    pub pruning: Option<PruneParams>,
    /// Small balls at surfaces that pulses run below.
    pub thin_surfaces: Option<ThinSurfaceParams>,
    /// Fills edges, ridges, chimneys and low walls down to the next lower level.
    pub relief: Option<ReliefParams>,
    /// Cuts balls below the edges of roofs, where walls stand that no pulse reached, and where they reach above the roof.
    pub roof_edges: Option<RoofEdgeParams>,
    /// Cuts balls where they reach over places without returns.
    pub data_voids: Option<DataVoidParams>,
    /// Sizes for scanners on the ground, which replace those above and leave none of these rules. `None` treats all scanners as
    /// if they flew.
    pub close_range: Option<CloseRangeParams>,
}

impl Default for CarvedParams {
    fn default() -> Self {
        Self {
            penetration: 0.02,
            initial_radius: 5.0,
            max_radius: f32::INFINITY,
            smoothing: true,
            kind_bounds: KindBounds::default(),
            vegetation: Some(VegetationParams::default()),
            crowns: Some(CrownParams::default()),
            slender: Some(SlenderParams::default()),
            pruning: Some(PruneParams::default()),
            thin_surfaces: Some(ThinSurfaceParams::default()),
            relief: Some(ReliefParams::default()),
            roof_edges: Some(RoofEdgeParams::default()),
            data_voids: Some(DataVoidParams::default()),
            close_range: Some(CloseRangeParams::default()),
        }
    }
}

/// A rule that can be left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rule {
    /// [`CarvedParams::smoothing`].
    Smoothing,
    /// [`CarvedParams::vegetation`].
    Vegetation,
    /// [`CarvedParams::crowns`].
    Crowns,
    /// [`CarvedParams::slender`].
    Slender,
    /// [`CarvedParams::thin_surfaces`].
    ThinSurfaces,
    /// [`CarvedParams::relief`].
    Relief,
    /// [`CarvedParams::roof_edges`].
    RoofEdges,
    /// [`CarvedParams::data_voids`].
    DataVoids,
    /// [`CarvedParams::pruning`].
    Pruning,
}

impl Rule {
    /// Every rule.
    pub const ALL: [Self; 9] = [
        Self::Smoothing,
        Self::Vegetation,
        Self::Crowns,
        Self::Slender,
        Self::ThinSurfaces,
        Self::Relief,
        Self::RoofEdges,
        Self::DataVoids,
        Self::Pruning,
    ];

    /// Name on the command line and in tables: lower case and hyphens.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Smoothing => "smoothing",
            Self::Vegetation => "vegetation",
            Self::Crowns => "crowns",
            Self::Slender => "slender",
            Self::ThinSurfaces => "thin-surfaces",
            Self::Relief => "relief",
            Self::RoofEdges => "roof-edges",
            Self::DataVoids => "data-voids",
            Self::Pruning => "pruning",
        }
    }
}

impl CarvedParams {
    /// The same with crowns taken for `trees`, unless their rule is left out.
    #[must_use]
    pub fn with_trees(mut self, trees: Trees) -> Self {
        self.crowns = self.crowns.map(|crowns| CrownParams { trees, ..crowns });
        self
    }

    /// The same without one rule.
    #[must_use]
    pub fn without(mut self, rule: Rule) -> Self {
        match rule {
            Rule::Smoothing => self.smoothing = false,
            Rule::Vegetation => self.vegetation = None,
            Rule::Crowns => self.crowns = None,
            Rule::Slender => self.slender = None,
            Rule::ThinSurfaces => self.thin_surfaces = None,
            Rule::Relief => self.relief = None,
            Rule::RoofEdges => self.roof_edges = None,
            Rule::DataVoids => self.data_voids = None,
            Rule::Pruning => self.pruning = None,
        }
        self
    }

    /// How balls shrink before they are carved.
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

/// What carved balls are made from. All columns have a row for each point.
#[derive(Clone, Copy)]
pub struct CarvedInput<'a> {
    /// Points and outward normals.
    pub oriented: &'a OrientedCloud,
    /// Index of the same points.
    pub index: &'a NeighborIndex,
    /// Class, return number and return count are used where present.
    pub attributes: &'a Attributes,
    /// What the pulses prove empty.
    pub needles: &'a FreeSegments,
    /// Which returns share a pulse, rows as in the cloud; without it no crown is measured.
    pub pulses: Option<&'a Pulses>,
}

/// What became of the balls in [`carved_balls`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct CarvedReport {
    /// By the points.
    #[serde(flatten)]
    pub shrinking: ShrinkReport,
    /// By the pulses.
    #[serde(flatten)]
    pub carving: CarveReport,
    /// Points told to be vegetation in a cloud without its classes.
    #[serde(rename = "points_found_to_be_vegetation")]
    pub told_vegetation: usize,
    /// Points in crowns with gaps.
    #[serde(rename = "points_in_crowns_with_gaps")]
    pub in_crowns_with_gaps: usize,
    /// Balls about returns within crowns.
    #[serde(rename = "balls_centred_in_crowns")]
    pub centred: usize,
    /// Balls that fill solid crowns.
    #[serde(rename = "balls_in_crowns")]
    pub crown_fills: usize,
    /// Points of fences, wires and the like.
    #[serde(rename = "points_on_thin_objects")]
    pub slender: usize,
    /// Balls that fill fences and the like.
    #[serde(rename = "balls_in_thin_objects")]
    pub slender_fills: usize,
    /// Balls left out because others make them superfluous.
    #[serde(rename = "balls_superfluous")]
    pub pruned: usize,
    /// Points found on thin surfaces.
    #[serde(rename = "points_on_thin_surfaces")]
    pub thin: usize,
    /// Balls midway between them.
    #[serde(rename = "balls_in_thin_surfaces")]
    pub thin_fills: usize,
    /// Points of thin relief.
    #[serde(rename = "points_on_thin_relief")]
    pub relief: usize,
    /// Balls that fill it.
    #[serde(rename = "balls_in_thin_relief")]
    pub relief_fills: usize,
    /// Balls cut below the edges of roofs, and where they reached above a roof.
    #[serde(rename = "balls_cut_at_roof_edges")]
    pub cut_at_edges: usize,
    /// Balls cut where they reached over places without returns.
    #[serde(rename = "balls_cut_at_data_voids")]
    pub cut_at_voids: usize,
    /// Balls that close floors below tripods.
    #[serde(rename = "balls_below_tripods")]
    pub below_tripods: usize,
}

/// Balls of a survey.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CarvedBalls {
    /// Those that are of use. [`MedialBalls::source`] and [`MedialBalls::touch`] are rows of the cloud; several balls may have
    /// the same source.
    pub balls: MedialBalls,
    /// Share of the pulses that got through the piece of crown that a ball is part of, (B), 0 to 1; NaN for balls that are not
    /// vegetation. Empty where nothing was measured.
    pub transmission: Vec<f32>,
    /// What became of them.
    pub report: CarvedReport,
}

/// The interior balls of a survey as far as its pulses leave them, and those that rules add.
///
/// # Errors
/// Those of [`shrink`] and [`carve`]. Each rule is a stage of `control`.
pub fn carved_balls(input: &CarvedInput<'_>, params: &CarvedParams, control: &Control<'_>) -> Result<CarvedBalls> {
    Ok(carve_survey(input, None, params, control)?.0)
}

/// The same for a part of a survey. The balls of points that lie far enough from its edge are those of any other part that holds them
/// so, bit by bit; how far that is follows from the rules ([`crate::model::SurveyStatistics::buffer`]).
///
/// # Errors
/// Those of [`carved_balls`].
pub fn carved_balls_of_part(
    input: &CarvedInput<'_>,
    part: &SurveyPart<'_>,
    params: &CarvedParams,
    control: &Control<'_>,
) -> Result<CarvedBalls> {
    Ok(carve_survey(input, Some(part), params, control)?.0)
}

/// The balls of a survey or of a part of one, and what rules took from the whole of it.
pub(crate) fn carve_survey(
    input: &CarvedInput<'_>,
    part: Option<&SurveyPart<'_>>,
    params: &CarvedParams,
    control: &Control<'_>,
) -> Result<(CarvedBalls, WholeSurvey)> {
    let CarvedInput { oriented, index, attributes, needles, pulses } = *input;
    let positions = oriented.positions();
    let mut report = CarvedReport::default();
    if let Some(sizes) = params.close_range.filter(|_| needles.are_from_the_ground()) {
        let CloseRangeBalls { balls, shrinking, carving, below_tripods } = sizes.balls(input, control)?;
        let carved = CarvedBalls {
            balls: balls.shrunk(),
            transmission: Vec::new(),
            report: CarvedReport { shrinking, carving, below_tripods, ..report },
        };
        return Ok((carved, WholeSurvey::default()));
    }
    let mut kinds = kinds(attributes, oriented.len());
    let given = part.map(|part| part.whole);
    let mut whole = given.copied().unwrap_or_else(|| WholeSurvey {
        has_ground: kinds.contains(&Kind::Ground),
        has_vegetation: kinds.contains(&Kind::Vegetation),
        ..WholeSurvey::default()
    });
    let measured = part.map_or(positions, |part| part.measured);
    let farthest = part.map_or(f32::INFINITY, |part| part.farthest);
    // with its classes, vegetation need not be told
    if let Some(vegetation) = params.vegetation.as_ref().filter(|_| !whole.has_vegetation) {
        report.told_vegetation = control.stage("finding vegetation", oriented.len(), || {
            tell_vegetation(&mut kinds, oriented, index, attributes, vegetation, farthest, control)
        })?;
    }
    let counts = pulse_counts(positions, attributes);
    let spacing = pulse_spacing(positions, &counts);
    let mut bounds = RadiusBounds::by_kind(&kinds, attributes, &spacing, &params.kind_bounds);
    let lowest = lowest_near(positions);
    let through = match (&params.crowns, pulses) {
        (Some(crowns), Some(pulses)) => control.stage("measuring crowns", 0, || {
            let (through, share) = crowns::transmission(positions, &kinds, &lowest, pulses, crowns, given, control)?;
            whole.transmission = share;
            Ok(through)
        })?,
        _ => Vec::new(),
    };
    let crowns = params.crowns.as_ref().map(|params| Crowns {
        positions,
        kinds: &kinds,
        attributes,
        transmission: &through,
        params,
    });
    let find_slender = |params| {
        control.stage("finding thin objects", oriented.len(), || {
            Slender::find(positions, &kinds, attributes, (&lowest, &spacing), needles, params, control)
        })
    };
    let slender = params.slender.as_ref().map(find_slender).transpose()?;
    report.in_crowns_with_gaps = crowns.as_ref().map_or(0, |crowns| crowns.limit(&mut bounds));
    report.slender = slender.as_ref().map_or(0, |slender| slender.limit(&mut bounds));
    let mut thin = Vec::new();
    if let Some(params) = &params.thin_surfaces {
        thin = control.stage("finding thin surfaces", 0, || {
            if part.is_some() {
                on_thin_surfaces_of_part((positions, measured), &kinds, index, needles, params, control)
            } else {
                on_thin_surfaces(positions, &kinds, index, needles, params, control)
            }
        })?;
        for row in (0..thin.len()).filter(|&row| thin[row]) {
            bounds.limit(row, params.radius_spacings * spacing[row]);
            report.thin += 1;
        }
    }

    let mut balls;
    (balls, report.shrinking) = control.stage("shrinking balls", oriented.len(), || {
        shrink(oriented, index, Side::Interior, &params.shrinking(), control)
    })?;
    report.carving =
        control.stage("carving balls", oriented.len(), || carve(&mut balls, oriented, needles, &bounds, control))?;
    // what is only found to be vegetation may be anything that is not flat: better neither centred nor filled
    let known_crowns = crowns.as_ref().filter(|_| report.told_vegetation == 0);
    if let Some(crowns) = known_crowns {
        (report.centred, whole.crown_spacing) = control
            .stage("centring balls in crowns", 0, || crowns.centre(&mut balls, index, needles, given, control))?;
    }
    let highest = highest(positions);
    if let Some(params) = &params.roof_edges {
        report.cut_at_edges = control.stage("cutting at roof edges", 0, || {
            let edges = RoofEdges::find(oriented, &kinds, index, (&lowest, &spacing), params, control)?;
            let at_edges = edges.cut(&mut balls, oriented, params, control)?;
            Ok(at_edges + RoofTops::find(oriented, &highest).cut(&mut balls, oriented, params, control)?)
        })?;
    }
    if let Some(params) = &params.data_voids {
        report.cut_at_voids = control.stage("cutting at data voids", 0, || {
            DataVoids::find(&highest, &lowest, &counts, needles).cut(&mut balls, oriented, params, control)
        })?;
    }
    if let Some(pruning) = &params.pruning {
        report.pruned = control.stage("pruning balls", oriented.len(), || {
            prune_in_blocks_of(measured, &mut balls, oriented, index, pruning, control)
        })?;
    }
    // before anything is added: the ball of a point is still in its row
    let find_relief = |params| {
        // below thin surfaces is air, what is slender is filled by its own rule, and balls hung on the face of a wall would stand
        // out of it where no pulse says how far
        let is_left_out = |row: usize| {
            thin.get(row) == Some(&true)
                || slender.as_ref().is_some_and(|slender| slender.stands(row))
                || oriented.normals()[row][2].abs() < FACE_NORMAL_Z
        };
        control.stage("finding thin relief", oriented.len(), || {
            Relief::find(positions, &kinds, is_left_out, (&balls, &spacing), index, params, control)
        })
    };
    let relief = params.relief.as_ref().map(find_relief).transpose()?;
    report.relief = relief.as_ref().map_or(0, Relief::len);
    control.stage("filling", 0, || {
        if let Some(crowns) = known_crowns {
            report.crown_fills = crowns.fill(&mut balls, needles, control)?;
        }
        if let Some(relief) = &relief {
            report.relief_fills = relief.fill(&mut balls, needles, control)?;
        }
        if let Some(params) = &params.thin_surfaces {
            let at = (&thin[..], &spacing[..]);
            report.thin_fills = thin_surfaces::fill(&mut balls, positions, at, needles, params, control)?;
        }
        if let Some(slender) = &slender {
            report.slender_fills = slender.fill(&mut balls, needles, control)?;
        }
        Ok(())
    })?;

    let balls = balls.shrunk();
    let of = |&source: &u32| through.get(source as usize).copied();
    let transmission = balls.source.iter().filter_map(of).collect();
    Ok((CarvedBalls { balls, transmission, report }, whole))
}
