//! Loading of files while the page is open already: reading, building, and their progress.

use crate::reading::ReadingChoice;
use crate::results::{PointsOf, ResultFile};
use crate::scene::{PageScene, ShownCloud};
use belvedere::apps::ask::remarks_on_model;
use belvedere::cloud::to_local;
use belvedere::control::{Control, OpenStages, StageEnd, Watcher};
use belvedere::io::{PlacedRaster, Source, has_point_results, read_features, read_point_results, read_tif};
use belvedere::model::SceneModel;
use belvedere::{Bounds, Frame, Mesh, PointCloud, Result};
use serde::Serialize;
use serde_json::Value;
use std::path::Path;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Takes the data read and built, and shows them on the page. As a [`Watcher`] it shows progress there.
#[derive(Clone, Default)]
pub struct Loading(Arc<Mutex<LoadingState>>);

impl std::fmt::Debug for Loading {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Loading")
    }
}

/// Parts loaded so far.
#[derive(Clone, Default)]
pub(crate) struct LoadingState {
    pub(crate) stages: OpenStages,
    pub(crate) shown: Option<Arc<ShownCloud>>,
    pub(crate) scene: Option<Arc<PageScene>>,
    /// Corners of the triangles of meshes, local metres, nine f32 each, little endian.
    pub(crate) meshes: Vec<Arc<[u8]>>,
    /// Results of other commands.
    pub(crate) results: Vec<Arc<ResultFile>>,
    /// Remarks on the files and the scene, shown beside every answer.
    pub(crate) remarks: Vec<Value>,
    pub(crate) failure: Option<String>,
    /// Up axis, unit and reference system of the cloud, if the page may choose others.
    pub(crate) reading: Option<ReadingChoice>,
    /// A choice of the page that is not read yet.
    requested: Option<ReadingChoice>,
    /// True once a page has read it.
    is_failure_read: bool,
}

impl Loading {
    /// Shows a cloud whose balls are not built yet.
    pub fn show(&self, cloud: &Arc<PointCloud>) {
        let shown = Arc::new(ShownCloud::new(Arc::clone(cloud)));
        self.state().shown = Some(shown);
    }

    /// Shows a mesh, in metres, beside the cloud.
    pub fn show_mesh(&self, mesh: &Mesh, frame: &Frame) {
        let corners = (0..mesh.triangles.len()).filter_map(|index| mesh.corners(index)).flatten();
        let local = corners.flat_map(|corner| to_local(corner, frame.origin));
        let bytes: Vec<u8> = local.flat_map(f32::to_le_bytes).collect();
        self.state().meshes.push(bytes.into());
    }

    /// Shows results of another command over a scene of these bounds: a raster (`.tif`), shapes (`.geojson`), or points
    /// with columns of results.
    ///
    /// # Errors
    /// Those of reading; [`belvedere::Error::Malformed`] for a raster without a place and for results that lie beside
    /// the cloud as a whole, [`belvedere::Error::UnusableCrs`] for results in another reference system.
    pub fn show_results<'a>(
        &self,
        source: impl Into<Source<'a>>,
        points_of: PointsOf,
        frame: &Frame,
        bounds: &Bounds,
    ) -> Result<()> {
        let source = source.into();
        let path = source.name().to_owned();
        let file = match source.extension().as_str() {
            "tif" | "tiff" => ResultFile::of_raster(&path, read_tif(source)?, frame, bounds)?,
            "geojson" | "gpkg" | "shp" => {
                ResultFile::of_shapes(&path, read_features(source, &frame.crs)?, frame, bounds)?
            }
            _ => ResultFile::of_points(&path, (read_point_results(source)?, points_of), frame, bounds)?,
        };
        self.state().results.push(Arc::new(file));
        Ok(())
    }

    /// Shows a raster on the ground.
    ///
    /// # Errors
    /// [`belvedere::Error::Malformed`] for one without a place or beside the cloud, [`belvedere::Error::UnusableCrs`]
    /// for one in another system.
    pub fn show_raster(&self, path: &Path, raster: PlacedRaster, frame: &Frame, bounds: &Bounds) -> Result<()> {
        let file = ResultFile::of_raster(path, raster, frame, bounds)?;
        self.state().results.push(Arc::new(file));
        Ok(())
    }

    /// Adds remarks on the files and the scene, from the layer of questions.
    pub fn remark(&self, remarks: &[impl Serialize]) {
        // remarks are maps of texts and numbers, which JSON holds
        let values = remarks.iter().filter_map(|remark| serde_json::to_value(remark).ok());
        self.state().remarks.extend(values);
    }

    /// Says how the cloud is read, and that it can be read in another way: the page offers the choice.
    pub fn offer_reading(&self, reading: ReadingChoice) {
        self.state().reading = Some(reading);
    }

    /// Forgets all data, for a cloud to be read in another way. Returns false where that is not offered.
    pub fn read_again(&self, choice: ReadingChoice) -> bool {
        let mut state = self.state();
        if state.reading.is_none() {
            return false;
        }
        *state = LoadingState { reading: Some(choice.clone()), requested: Some(choice), ..LoadingState::default() };
        true
    }

    /// Takes the choice of the page, once.
    #[must_use]
    pub fn take_requested_reading(&self) -> Option<ReadingChoice> {
        self.state().requested.take()
    }

    /// Takes the model of the cloud shown, or of a ball file: questions are answered from now on.
    pub fn finish(&self, mut model: SceneModel) {
        let shown = self.state().shown.clone();
        // what cannot be indexed is said by the questions
        let _ = model.index(&Control::none());
        let shown =
            shown.unwrap_or_else(|| Arc::new(ShownCloud::new(Arc::new(PointCloud::in_frame(model.frame().clone())))));
        self.remark(&remarks_on_model(&model));
        let scene = Arc::new(PageScene::new(model, Arc::clone(&shown)));
        let mut state = self.state();
        state.shown = Some(shown);
        state.scene = Some(Arc::clone(&scene));
        drop(state);
        // what the first questions need is made while people still look
        scene.prepare_aside();
    }

    /// Reports why nothing can be shown and no question can be answered.
    pub fn fail(&self, message: String) {
        self.state().failure = Some(message);
    }

    /// Returns true if a page has read why nothing can be shown.
    #[must_use]
    pub fn is_failure_read(&self) -> bool {
        self.state().is_failure_read
    }

    /// The state for a page, which reads it four times a second.
    pub(crate) fn read(&self) -> LoadingState {
        let mut state = self.state();
        state.is_failure_read = state.failure.is_some();
        state.clone()
    }

    pub(crate) fn now(&self) -> LoadingState {
        self.state().clone()
    }

    fn state(&self) -> MutexGuard<'_, LoadingState> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Returns true if a file that `open` opens holds results of another command and no cloud. False for an unreadable
/// file.
pub fn are_results<'a>(open: impl Fn() -> Source<'a>) -> bool {
    match open().extension().as_str() {
        "tif" | "tiff" | "geojson" | "gpkg" | "shp" => true,
        "las" | "laz" => has_point_results(open()).unwrap_or(false),
        _ => false,
    }
}

impl Watcher for Loading {
    fn begin(&self, stage: &'static str, total: usize) {
        self.state().stages.begin(stage, total);
    }
    fn advance(&self, count: usize) {
        self.state().stages.advance(count);
    }
    fn end(&self, stage: &'static str, end: StageEnd) {
        self.state().stages.end(stage, end);
    }
}
