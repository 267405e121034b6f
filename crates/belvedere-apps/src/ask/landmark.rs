//! Landmark: from where one thing is seen, and how much of it.

use super::answers::{Answered, Answers, Ask};
use super::cells::cells_of;
use super::context::Context;
use super::how_sure::remark_from_ground;
use super::known_ground::KnownGround;
use super::observers::{check_height, skip_unfit};
use super::places::Places;
use super::scene::Scene;
use super::sections::{LandmarkSection, LinesSection};
use super::standing::{Reach, Standing};
use crate::landmark::{
    LandmarkParams, LandmarkPoints, LandmarkReport, LandmarkView, landmark_points, landmark_views, measures,
    observer_cell_for, spacing_for,
};
use crate::targets::{CellParams, Measure, set_on_ground};
use crate::viewshed::{OBSERVER_HEIGHT, cell_for};
use belvedere_core::ground::{Ground, GroundPoints, MapGrid};
use belvedere_core::query::{BackFaces, EarthParams, MedialScene, MeshTargetParams, SurfacePieces, UnprovenAs};
use belvedere_data::control::Control;
use belvedere_data::report::rounded;
use belvedere_data::vector::to_f32;
use belvedere_data::{Error, Mesh, Parameter, PointCloud, Result};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Views of a landmark, with its visible part.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LandmarkQuestion {
    /// The landmark.
    pub shape: LandmarkShape,
    /// Observers; `None` for one in the middle of each cell of a grid over the scene.
    #[serde(skip)]
    pub observers: Option<Vec<Standing>>,
    /// Height of observers above the ground, metres, 0 or more; `None` for 1.7.
    #[serde(default)]
    pub observer_height: Option<f64>,
    /// Side of the cells that observers stand in, metres, above 0; `None` for 2, doubled up to at most 40 000 cells.
    #[serde(default)]
    pub cell: Option<f64>,
    /// Source of ground points.
    #[serde(default)]
    pub ground: GroundPoints,
    /// Maximum distance to the landmark, metres, above 0; `None` for no limit.
    #[serde(default)]
    pub max_distance: Option<f64>,
    /// Treatment of faces that are turned away from the observer.
    #[serde(default)]
    pub back_faces: BackFaces,
    /// Curvature of the earth on lines of sight.
    #[serde(default)]
    pub earth: EarthParams,
    /// Treatment of unproven parts; `None` to report them if pulses are known.
    #[serde(default)]
    pub unproven: Option<UnprovenAs>,
    /// True to give the expected visible share, from the probability of each part; needs pulses. Default: false.
    #[serde(default)]
    pub probability: bool,
}

/// Shape of a landmark.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum LandmarkShape {
    /// A mesh, metres.
    Mesh {
        /// The mesh; whoever reads a question from text reads it from its file.
        #[serde(skip)]
        mesh: Option<Arc<Mesh>>,
        /// Longest side of the pieces that it is cut into, metres, above 0; `None` for about 1000 pieces, at least
        /// 0.25.
        spacing: Option<f64>,
        /// Seed of the places on them.
        seed: u64,
    },
    /// The points of an ASPRS class.
    Class(u8),
    /// The points above polygons that are not ground.
    Inside {
        /// Each an outer ring and holes of (x, y), local metres.
        #[serde(skip)]
        polygons: Vec<Vec<Vec<[f64; 2]>>>,
    },
}

impl PartialEq for LandmarkShape {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (
                Self::Mesh { mesh, spacing, seed },
                Self::Mesh { mesh: other_mesh, spacing: other_spacing, seed: other_seed },
            ) => {
                let place = |mesh: &Option<Arc<Mesh>>| mesh.as_ref().map(Arc::as_ptr);
                place(mesh) == place(other_mesh) && (spacing, seed) == (other_spacing, other_seed)
            }
            (Self::Class(class), Self::Class(of_other)) => class == of_other,
            (Self::Inside { polygons }, Self::Inside { polygons: of_other }) => polygons == of_other,
            _ => false,
        }
    }
}

/// Views of a landmark.
pub struct LandmarkResults {
    /// View of each observer.
    pub views: Vec<LandmarkView>,
    /// Position of each observer, local metres; NaN for a cell in which nobody can stand.
    pub places: Vec<[f64; 3]>,
    /// The ground; its grid is that of the observers unless they were given.
    pub ground: Arc<KnownGround>,
    /// The middle of the landmark on the map, local metres.
    pub middle: [f64; 2],
}

/// Observers of a landmark.
struct Lookers {
    places: Vec<[f64; 3]>,
    /// NaN for those who cannot look.
    eyes: Vec<[f64; 3]>,
    /// Number of places inside an obstacle.
    inside: usize,
}

impl LandmarkShape {
    /// The surface of the landmark about the local origin `origin`, metres, with a report on it. `cloud` has the points
    /// of the scene.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a mesh that was not read and for a cloud without points; those of
    /// [`SurfacePieces::of_mesh`] and [`landmark_points`].
    pub fn surface(
        &self,
        cloud: &PointCloud,
        origin: [f64; 3],
        control: &Control<'_>,
    ) -> Result<(SurfacePieces, LandmarkSection)> {
        let invalid = |value: &str, expected| Err(Error::invalid(Parameter::Targets, value, expected));
        let mut section = LandmarkSection::default();
        let which = match self {
            Self::Mesh { mesh: Some(mesh), spacing, seed } => {
                let spacing = spacing.unwrap_or_else(|| spacing_for(mesh.area()));
                let surface =
                    control.stage("sampling mesh", 0, || SurfacePieces::of_mesh(mesh, origin, spacing, *seed))?;
                section.triangles = Some(mesh.triangles.len());
                section.spacing_m = Some(rounded(spacing, 3));
                return Ok(section.with_surface(surface));
            }
            Self::Mesh { mesh: None, .. } => {
                return invalid("a mesh that is missing", "read before the question is put");
            }
            Self::Class(class) => LandmarkPoints::Class(*class),
            Self::Inside { polygons } => LandmarkPoints::Inside(polygons),
        };
        if cloud.is_empty() {
            return invalid("the points of a ball file", "points: a ball file has none; give its cloud, or a mesh");
        }
        let (rows, surface) = control.stage("selecting landmark", 0, || landmark_points(cloud, &which))?;
        section.points = Some(rows.len());
        Ok(section.with_surface(surface))
    }
}

impl LandmarkSection {
    fn with_surface(self, surface: SurfacePieces) -> (SurfacePieces, Self) {
        let (sample_points, area_m2) = (surface.pieces.len(), rounded(surface.area(), 2));
        (surface, Self { sample_points, area_m2, ..self })
    }
}

impl LandmarkQuestion {
    fn params(&self) -> LandmarkParams {
        let usual = LandmarkParams::default();
        usual
            .with_faces(MeshTargetParams { back_faces: self.back_faces, ..usual.faces })
            .with_unproven(self.unproven())
            .with_earth(self.earth)
            .with_max_range(self.max_distance.unwrap_or(usual.max_range))
            .with_expected(self.probability)
    }

    fn unproven(&self) -> UnprovenAs {
        self.unproven.unwrap_or(UnprovenAs::Reported)
    }

    /// The cells that observers stand in, or of the ground below those that were given.
    fn grid(&self, scene: &Scene) -> Result<MapGrid> {
        let (low, high) = scene.model().bounds().on_map();
        let cell = match &self.observers {
            Some(_) => cell_for(low, high),
            None => self.cell.unwrap_or_else(|| observer_cell_for(low, high)),
        };
        let [x, y, _] = scene.frame().origin;
        MapGrid::covering(low, high, cell, [x, y])
    }

    /// The observers that were given.
    fn given_observers(
        &self,
        standing: &[Standing],
        (blockers, ground): (&Arc<MedialScene>, &Ground),
        scene: &Scene,
        context: &mut Context,
        control: &Control<'_>,
    ) -> Result<Lookers> {
        let usual = self.observer_height.unwrap_or(OBSERVER_HEIGHT);
        let mut places: Vec<[f64; 3]> = standing.iter().map(|one| one.place).collect();
        let heights = standing.iter().map(|one| one.height.unwrap_or(usual));
        set_on_ground(places.iter_mut().zip(heights), ground);
        let (who, ground) = (("observer", Reach::Cloud), Some(ground));
        let found = skip_unfit(places, who, (blockers, ground), (scene, context), control)?;
        let inside = found.report.skipped_inside_obstacle;
        context.report.observers_given = Some(found.report);
        Ok(Lookers { places: found.places, eyes: found.eyes, inside })
    }

    /// An observer in each cell, but for those inside obstacles.
    fn in_cells(
        &self,
        (blockers, ground): (&MedialScene, &Ground),
        scene: &Scene,
        context: &mut Context,
        control: &Control<'_>,
    ) -> Result<Lookers> {
        let height = self.observer_height.unwrap_or(OBSERVER_HEIGHT);
        let cells = CellParams::default().with_height(height);
        let mut targets = cells_of(scene, ground.clone(), &cells, context, control)?;
        control.stage("testing observers", 0, || {
            let inside = targets.leave_out_enclosed(blockers, control)?;
            let eyes: Vec<[f64; 3]> = targets.positions.iter().map(|eye| eye.map(f64::from)).collect();
            Ok(Lookers { places: eyes.clone(), eyes, inside })
        })
    }
}

impl Ask for LandmarkQuestion {
    type Found = LandmarkResults;

    fn check(&self) -> Result<()> {
        check_height(self.observer_height)?;
        self.params().validate()
    }

    fn answer(&self, scene: &Scene, _: &Places, context: &mut Context, control: &Control<'_>) -> Answered<Self> {
        if self.unproven.is_some_and(|unproven| unproven != UnprovenAs::Visible) {
            scene.check_proof()?;
        }
        if self.probability {
            scene.check_pulses(Parameter::Certainty)?;
        }
        let (surface, section) = self.shape.surface(scene.cloud(), scene.frame().origin, control)?;
        let area = section.area_m2;
        context.report.landmark = Some(section);
        let known = scene.ground(self.grid(scene)?, self.ground, control)?;
        context.ground(scene.frame(), &known);
        let blockers = scene.blockers(self.unproven(), control)?;
        context.add(remark_from_ground(&blockers).filter(|_| self.probability));
        context.report.lines_of_sight = Some(LinesSection::of(&blockers, None));
        let ground = &known.ground;
        let Lookers { places, eyes, inside } = match &self.observers {
            Some(standing) => self.given_observers(standing, (&blockers, ground), scene, context, control)?,
            None => self.in_cells((&blockers, ground), scene, context, control)?,
        };
        let params = self.params();
        let views = control
            .stage("testing landmark", eyes.len(), || landmark_views(&blockers, &surface, &eyes, &params, control))?;
        let report = LandmarkReport::new(&views, &eyes, inside);
        context.headline(format!(
            "seen from {} % of {} places ({})",
            report.observers_with_view_percent, report.count, report.observers_with_view
        ));
        if let Some(best) = &report.best {
            let (share, number) = (rounded(100.0 * best.max_visible_share, 2), best.max_visible_share_observer);
            context.headline(format!("at most {share} % of its surface is visible, from place {number}"));
        }
        context.headline(format!("surface: {area} m²"));
        context.report.landmark_views = Some(report);
        let middle = surface.middle_on_map();
        let measures = measures_of(&views);
        Ok(Answers::new(LandmarkResults { views, places, ground: known, middle }, measures))
    }
}

/// Every number of every view; NaN for observers that cannot look.
fn measures_of(views: &[LandmarkView]) -> Vec<Measure> {
    let measure = |of: &crate::landmark::LandmarkMeasure| {
        let values = views.iter().map(|view| to_f32(of.of(view))).collect();
        Measure::new(of.name, values).with_description(of.description).with_unit(of.unit).with_decimals(of.decimals)
    };
    measures(views).iter().map(measure).collect()
}
