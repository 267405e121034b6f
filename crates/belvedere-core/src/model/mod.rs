//! The scene model, made from a cloud in one step, from which Belvedere answers.
//!
//! [`SceneModel::build`] decides how a cloud becomes a scene: the points kept, the place of the scanner, the sign of
//! the normals, the use of pulses for carving, and the vegetation. [`ModelParams`] overrides each decision. A saved
//! model ([`SceneModel::parts`], [`SceneModel::from_parts`]) is a ball file.
//!
//! The stages are public functions of the modules below; [`OrientedSurvey::prepare`] stops before the balls are made.

mod blocked_pulses;
mod build;
mod clear;
mod cleared_area;
mod clearing;
mod close_range_normals;
mod estimate_statistics;
mod findings;
mod flight_days;
mod in_space_order;
mod params;
mod pictures;
mod prepare;
mod questions;
mod report;
mod statistics;
mod surfaces;
mod survey_sample;
mod terrain;

pub use belvedere_data::model::{DerivedParts, ModelParts};
pub use clear::ClearReport;
pub use cleared_area::ClearedArea;
pub use clearing::Clearing;
pub use estimate_statistics::SurveyExtremes;
pub use findings::{DatedSurvey, SurveyChange, SurveyFindings};
pub use flight_days::FlightDays;
pub use params::{BallParams, ModelParams, OrientBy, StripHeights};
pub use prepare::OrientedSurvey;
pub use report::{BallsReport, BlockedPulses, BuildReport, NormalsReport, PulsesReport, SurfacesReport};
pub use statistics::SurveyStatistics;
pub use survey_sample::{SampledRows, SurveyBlock, SurveyCounts, SurveySampler, is_counted};
pub use terrain::{TerrainReport, check_terrain};

use crate::medial::{MedialBalls, PULSE_TOUCH, vegetation_of_transmission};
use crate::medium::Medium;
use crate::planes::BuildingOutlines;
use crate::pulses::FreeSegmentColumns;
use crate::query::{Backend, BallTree, BlockingTriangles, FarTerrain, FreedSpace, Proof};
use belvedere_data::horizon::HorizonProfile;
use belvedere_data::{Bounds, ElevationGrid, Error, Frame, Mesh, Parameter, Result, SurfacePatches};
use std::sync::{Arc, OnceLock};

/// A scene for queries of visibility: balls that block lines of sight, and the pulses that prove others free.
///
/// Rows of points ([`MedialBalls::source`], [`MedialBalls::touch`]) are those of the cloud that the model was built
/// from, also where points were cleaned away.
#[derive(Clone, Debug, Default)]
pub struct SceneModel {
    parts: ModelParts,
    /// True for balls that are vegetation, (B); empty if that is not known.
    vegetation: Vec<bool>,
    /// Outward unit normals of the points, (N, 3); zero where a point has none.
    normals: Option<Vec<[f32; 3]>>,
    /// The balls in a tree, where something has needed them so already.
    tree: Option<BallTree>,
    /// Proof by its pulses, once something has needed it.
    proof: OnceLock<Proof>,
    /// Its crowns, where something has needed them so already.
    medium: OnceLock<Arc<Medium>>,
    /// Triangles that block beside the balls: patches and added meshes.
    triangles: Option<BlockingTriangles>,
    /// Space that was cleared.
    freed: Vec<FreedSpace>,
    /// Terrain beyond the cloud.
    far_terrain: FarTerrain,
    /// Backend that settles lines of sight in bulk; `None` for the processor.
    backend: Option<Arc<dyn Backend>>,
}

/// Entry in the provenance of a model whose cloud looks as if y were up.
const LOOKS_UP: [&str; 2] = ["axis_that_looks_up", "y"];

/// Key of the survey findings in the provenance of a model.
const FINDINGS: &str = "survey_findings";

/// Key of the days of the flight in the provenance of a model.
const FLIGHT_DAYS: &str = "flight_days";

impl SceneModel {
    /// Returns the findings about its survey beside surfaces.
    #[must_use]
    pub fn findings(&self) -> SurveyFindings {
        self.parts.provenance.get(FINDINGS).map(|text| SurveyFindings::from_text(text)).unwrap_or_default()
    }

    /// Returns the days on which its points were measured; none if they are not known.
    #[must_use]
    pub fn flight_days(&self) -> FlightDays {
        self.parts.provenance.get(FLIGHT_DAYS).map(|text| FlightDays::from_text(text)).unwrap_or_default()
    }

    /// Returns true if its cloud, which has no reference system, looks as if y were up and not z
    /// ([`crate::summary::looks_y_up`]).
    #[must_use]
    pub fn looks_y_up(&self) -> bool {
        self.parts.provenance.get(LOOKS_UP[0]).is_some_and(|axis| axis == LOOKS_UP[1])
    }

    /// The model of saved parts, as [`SceneModel::parts`] gave them.
    ///
    /// # Errors
    /// Those of [`ModelParts::validate`], and [`Error::InvalidParameter`] for exterior balls, which lie in free space
    /// and block nothing.
    pub fn from_parts(parts: ModelParts) -> Result<Self> {
        parts.validate()?;
        if let Some(side) = parts.provenance.get("side").filter(|side| *side == "exterior") {
            return Err(Error::invalid(Parameter::BallSide, side, "interior, because exterior balls block nothing"));
        }
        let vegetation = vegetation_of_transmission(&parts.transmission);
        let triangles = BlockingTriangles::of_patches(&parts.patches, None)?;
        Ok(Self { parts, vegetation, triangles, ..Self::default() })
    }

    /// Returns the parts that were made or found beside [`SceneModel::parts`], for [`SceneModel::from_kept`].
    #[must_use]
    pub fn derived(&self) -> DerivedParts {
        let tree = self.tree.as_ref().map(BallTree::to_parts);
        let proof = self.proof.get().and_then(Proof::to_parts);
        DerivedParts { vegetation: self.vegetation.clone(), normals: self.normals.clone(), tree, proof }
    }

    /// The model of the parts and the derived data of another one: nothing is computed again.
    ///
    /// # Errors
    /// Those of [`SceneModel::from_parts`]; [`Error::LengthMismatch`] and [`Error::InvalidParameter`] where the two do
    /// not belong together.
    pub fn from_kept(parts: ModelParts, derived: DerivedParts) -> Result<Self> {
        let mut model = Self::from_parts(parts)?;
        let (expected, found) = (model.balls().len(), derived.vegetation.len());
        if !(found == 0 || found == expected) {
            return Err(Error::LengthMismatch { what: "balls that are vegetation or not", expected, found });
        }
        let (tree, proof) = rayon::join(
            || derived.tree.map(|tree| BallTree::from_parts(tree, model.balls(), &model.rule())).transpose(),
            || derived.proof.map(|parts| Ok(model.new_proof()?.map(|proof| proof.with_parts(parts)))).transpose(),
        );
        model.proof = proof?.flatten().map(OnceLock::from).unwrap_or_default();
        (model.vegetation, model.normals, model.tree) = (derived.vegetation, derived.normals, tree?);
        Ok(model)
    }

    /// The same model with the triangles of `mesh`, metres of the reference system of the model
    /// ([`Mesh::scaled_to_metres`]), which `name` names in answers. They block as they are, beside the balls. Called
    /// again, it adds another mesh.
    ///
    /// # Errors
    /// Those of [`BlockingTriangles::new`].
    pub fn with_added(mut self, mesh: &Mesh, name: &str) -> Result<Self> {
        let coverage = self.coverage();
        let origin = self.frame().origin;
        let triangles = BlockingTriangles::new(mesh, name, origin, coverage.as_ref(), self.triangles.as_ref())?;
        self.triangles = Some(triangles);
        Ok(self)
    }

    /// Returns the triangles that block beside the balls, if any meshes were added. These are not saved.
    #[must_use]
    pub fn added(&self) -> Option<&BlockingTriangles> {
        self.triangles.as_ref().filter(|triangles| triangles.has_meshes())
    }

    /// The same model with `patches` of surfaces instead of its own. They block beside the balls, and are saved.
    ///
    /// # Errors
    /// Those of [`SurfacePatches::validate`].
    pub fn with_patches(mut self, patches: SurfacePatches) -> Result<Self> {
        self.triangles = BlockingTriangles::of_patches(&patches, self.triangles.as_ref())?;
        self.parts.patches = patches;
        Ok(self)
    }

    /// Patches of surfaces of the survey, which block beside the balls.
    #[must_use]
    pub fn patches(&self) -> &SurfacePatches {
        &self.parts.patches
    }

    /// Planes, edges, ridges and walls of buildings, as far as they are known.
    #[must_use]
    pub fn outlines(&self) -> &BuildingOutlines {
        &self.parts.outlines
    }

    /// All triangles that block beside the balls: of patches, and of meshes that were added.
    #[must_use]
    pub fn triangles(&self) -> Option<&BlockingTriangles> {
        self.triangles.as_ref()
    }

    /// The same model before far terrain: directions below `horizon`, azimuths from grid north, are blocked for all
    /// targets alike. It is not saved.
    #[must_use]
    pub fn with_horizon(mut self, horizon: HorizonProfile) -> Self {
        self.far_terrain = self.far_terrain.with_profile(horizon);
        self
    }

    /// The same model, whose scenes have lines of sight settled in bulk by `backend`. Answers stay the same. It is not
    /// saved.
    #[must_use]
    pub fn with_backend(mut self, backend: Arc<dyn Backend>) -> Self {
        self.backend = Some(backend);
        self
    }

    /// Returns the backend that settles the lines of sight of its scenes in bulk, if not the processor.
    #[must_use]
    pub fn backend(&self) -> Option<&Arc<dyn Backend>> {
        self.backend.as_ref()
    }

    /// The same model before the terrain of an elevation raster, local metres, which `name` names in errors: directions
    /// below the horizon of a target are blocked for it. Within the box of the cloud on the map, and a cell of the
    /// raster around it, terrain blocks nothing: there the cloud decides. It is not saved.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for terrain that does not reach the cloud, or lies far above or below it.
    pub fn with_terrain(mut self, terrain: ElevationGrid, name: &str) -> Result<Self> {
        let coverage = self.coverage();
        if let Some(coverage) = &coverage {
            check_terrain(&terrain, name, coverage.bounds(), self.frame())?;
        }
        self.far_terrain = self.far_terrain.with_grid(terrain, coverage.map(|coverage| coverage.bounds().on_map()));
        Ok(self)
    }

    /// The same model before far terrain. It is not saved.
    #[must_use]
    pub fn with_far_terrain(self, far_terrain: FarTerrain) -> Self {
        Self { far_terrain, ..self }
    }

    /// Returns the terrain beyond the cloud, as far as it was given.
    #[must_use]
    pub fn far_terrain(&self) -> &FarTerrain {
        &self.far_terrain
    }

    /// The saved parts of a model, as in a ball file.
    #[must_use]
    pub fn parts(&self) -> &ModelParts {
        &self.parts
    }

    /// Converts a model that is no longer needed into [`SceneModel::parts`].
    #[must_use]
    pub fn into_parts(self) -> ModelParts {
        self.parts
    }

    /// The same model with a further note on how it was made, such as the name of the input.
    #[must_use]
    pub fn with_provenance(mut self, name: &str, value: impl Into<String>) -> Self {
        self.parts = self.parts.with_provenance(name, value);
        self
    }

    /// The same model without its pulses: nothing is then unproven, and saving it takes less room.
    #[must_use]
    pub fn without_pulses(mut self) -> Self {
        (self.parts.pulses, self.proof) = (None, OnceLock::new());
        self
    }

    /// Local coordinates of the model.
    #[must_use]
    pub fn frame(&self) -> &Frame {
        &self.parts.frame
    }

    /// The smallest box around the points of the balls: a view must hold it to show the scene.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        self.parts.bounds
    }

    /// The balls that block lines of sight.
    #[must_use]
    pub fn balls(&self) -> &MedialBalls {
        &self.parts.balls
    }

    /// The pulses that prove lines of sight free, where they are known.
    #[must_use]
    pub fn pulses(&self) -> Option<&FreeSegmentColumns> {
        self.parts.pulses.as_ref()
    }

    /// Returns the share of the pulses that passed the part of a crown that a ball belongs to, (B), 0 to 1, NaN for
    /// other balls. Empty if it was not measured.
    #[must_use]
    pub fn transmission(&self) -> &[f32] {
        &self.parts.transmission
    }

    /// Returns true for balls that are vegetation, (B); empty if that is not known.
    #[must_use]
    pub fn vegetation(&self) -> &[bool] {
        &self.vegetation
    }

    /// Crowns as a medium, which with the balls that are no vegetation takes the place of all balls; `None` where they
    /// were not measured, and where there are none.
    #[must_use]
    pub fn medium(&self) -> Option<Arc<Medium>> {
        let voxels = self.parts.medium.as_ref().filter(|voxels| !voxels.is_empty())?;
        let is_known = self.vegetation.contains(&true);
        is_known.then(|| Arc::clone(self.medium.get_or_init(|| Arc::new(Medium::new(voxels, self.frame().origin)))))
    }

    /// Outward unit normals of the points that the model was built from, (N, 3); zero for points without one and for
    /// those that were cleaned away. `None` for a model that was read from a file, or whose cloud was given away
    /// ([`SceneModel::build_owned`]).
    #[must_use]
    pub fn normals(&self) -> Option<&[[f32; 3]]> {
        self.normals.as_deref()
    }

    /// Returns true if pulses cut the balls.
    #[must_use]
    pub fn is_carved(&self) -> bool {
        self.parts.pulses.is_some() || self.parts.balls.touch.contains(&PULSE_TOUCH)
    }
}
