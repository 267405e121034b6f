//! Displayed cloud and scene of the questions. Slow parts are made once.

use crate::chunks::Chunks;
use crate::roof_planes::RoofPlanes;
use crate::scene_text::named_for_maps;
use crate::target_points::{SAMPLE, TargetPoints};
use belvedere::apps::ask::scene::KnownGround;
use belvedere::apps::ask::{self, GridCells, North, SunPlace};
use belvedere::apps::eyes::fault_of;
use belvedere::apps::sun::{Site, ZoneOfPlace};
use belvedere::control::Control;
use belvedere::crs::CrsKind;
use belvedere::ground::{Ground, GroundPoints};
use belvedere::model::{ClearReport, ClearedArea, SceneModel};
use belvedere::query::{MedialScene, UnprovenAs};
use belvedere::{Bounds, Error, Mesh, PointCloud, Result};
use serde::Deserialize;
use serde_json::{Value, json};
use std::sync::{Arc, Mutex, PoisonError};

/// A cloud, and its points as the page gets them.
pub(crate) struct ShownCloud {
    pub(crate) cloud: Arc<PointCloud>,
    pub(crate) chunks: Chunks,
    /// Description that the page needs before it draws.
    pub(crate) description: Value,
}

/// The scene that questions are put to, with the parts of it that the page shows.
pub(crate) struct PageScene {
    pub(crate) inner: ask::Scene,
    pub(crate) shown: Arc<ShownCloud>,
    /// For each point that is shown its row among those that are there; `None` where no plan clears any.
    rows_there: Option<Vec<u32>>,
    points: LazyResult<TargetPoints>,
    sample: LazyResult<TargetPoints>,
    roofs: LazyResult<RoofPlanes>,
}

/// Something that is made when first needed, and can fail.
struct LazyResult<T>(Mutex<Option<Arc<T>>>);

impl<T> LazyResult<T> {
    fn new() -> Self {
        Self(Mutex::new(None))
    }

    fn get(&self, make: impl FnOnce() -> Result<T>) -> Result<Arc<T>> {
        let mut kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(made) = &*kept {
            return Ok(Arc::clone(made));
        }
        let made = Arc::new(make()?);
        *kept = Some(Arc::clone(&made));
        Ok(made)
    }
}

impl ShownCloud {
    pub(crate) fn new(cloud: Arc<PointCloud>) -> Self {
        let chunks = Chunks::new(&cloud);
        Self::of(cloud, chunks)
    }

    /// A cloud of which these chunks are shown.
    pub(crate) fn of(cloud: Arc<PointCloud>, chunks: Chunks) -> Self {
        let description = Self::describe(&cloud, &chunks);
        Self { cloud, chunks, description }
    }

    fn describe(cloud: &PointCloud, chunks: &Chunks) -> Value {
        let frame = &cloud.frame;
        let bounds = cloud.bounds().unwrap_or_default();
        let size = bounds.size().map(f64::from);
        let chunks: Vec<Value> = chunks.chunks.iter().map(|chunk| {
            json!({ "low": chunk.low, "step": chunk.step, "count": chunk.points.len(), "first": chunk.points.start })
        }).collect();
        let mut classes = [0_usize; 256];
        cloud.attributes.classification.iter().flatten().for_each(|&class| classes[usize::from(class)] += 1);
        let classes: Vec<[usize; 2]> = classes
            .into_iter()
            .enumerate()
            .filter(|(_, count)| *count > 0)
            .map(|(class, count)| [class, count])
            .collect();
        json!({
            "point_count": cloud.len(),
            "origin": frame.origin,
            "metres_per_unit": frame.crs.metres_per_unit_xyz(),
            "crs": frame.crs.describe(),
            "crs_name": named_for_maps(&frame.crs),
            "tells_unit": frame.crs.kind != CrsKind::Unknown,
            "low": bounds.low,
            "high": bounds.high,
            // as if points lay evenly on the map
            "spacing": (size[0] * size[1] / cloud.len().max(1) as f64).sqrt(),
            "chunks": chunks,
            "classes": classes,
            "has_intensity": cloud.attributes.intensity.is_some(),
            "has_color": cloud.attributes.color.is_some(),
            // answers for fewer points are there at once
            "samples_first": cloud.len() > 2 * SAMPLE,
        })
    }
}

impl PageScene {
    pub(crate) fn new(model: SceneModel, shown: Arc<ShownCloud>) -> Self {
        let cloud = Arc::clone(&shown.cloud);
        Self::of(ask::Scene::new(model, cloud), shown)
    }

    fn of(inner: ask::Scene, shown: Arc<ShownCloud>) -> Self {
        Self {
            inner,
            shown,
            rows_there: None,
            points: LazyResult::new(),
            sample: LazyResult::new(),
            roofs: LazyResult::new(),
        }
    }

    pub(crate) fn model(&self) -> &SceneModel {
        self.inner.model()
    }

    /// The scene with a plan: areas are cleared, then meshes in metres are added.
    pub(crate) fn planned(
        &self,
        areas: &[ClearedArea],
        meshes: &[(String, Arc<Mesh>)],
        control: &Control<'_>,
    ) -> Result<(Self, ClearReport)> {
        // the pulses are indexed once for all plans
        self.blockers(UnprovenAs::Reported, control)?;
        let (mut model, mut report) = (self.model().clone(), ClearReport::default());
        let own = self.inner.cloud();
        let mut cloud = Arc::clone(own);
        for area in areas {
            let (cleared, kept, of_area) = model.without(area, &cloud, control)?;
            report.points_cleared += of_area.points_cleared;
            (model, cloud) = (cleared, Arc::new(kept));
        }
        for (name, mesh) in meshes {
            model = model.with_added(mesh, name)?;
        }
        model.index(control)?;
        let rows_there = (cloud.len() < own.len()).then(|| rows_there(own, &cloud));
        let inner = ask::Scene::new(model, cloud);
        Ok((Self { rows_there, ..Self::of(inner, Arc::clone(&self.shown)) }, report))
    }

    /// A byte for each point in the order in which points are sent: 1 for one that the plan clears.
    pub(crate) fn cleared_in_order(&self) -> Vec<u8> {
        let is_cleared = |&row: &u32| {
            self.rows_there.as_ref().is_some_and(|rows| rows.get(row as usize).is_none_or(|&row| row == NOT_THERE))
        };
        self.shown.chunks.rows().iter().map(|row| u8::from(is_cleared(row))).collect()
    }

    /// Makes the data that most questions need. A failure here is reported by the question that needs them.
    pub(crate) fn prepare(&self) {
        let control = Control::none();
        let _ = self.blockers(UnprovenAs::Visible, &control);
        if !self.inner.cloud().is_empty() {
            let _ = self.ground(&control);
            let _ = self.points(PointChoice::Sample, &control);
            let _ = self.points(PointChoice::All, &control);
        }
        self.index_proof();
    }

    /// Indexes the pulses that prove lines of sight free. A failure here is reported by the question that needs them.
    pub(crate) fn index_proof(&self) {
        let control = Control::none();
        let _ = self.blockers(UnprovenAs::Reported, &control);
        let _ = self.model().index_proof(&control);
    }

    /// [`Self::prepare`] on a thread of its own: not on one of the pool, which must not wait for locks. Where the
    /// system has none, the first question makes its own data; in a browser the owner of the session calls `prepare`.
    pub(crate) fn prepare_aside(self: &Arc<Self>) {
        #[cfg(feature = "server")]
        {
            let scene = Arc::clone(self);
            let _ = std::thread::Builder::new().spawn(move || scene.prepare());
        }
    }

    /// Describes the scene for the page.
    pub(crate) fn describe(&self) -> Value {
        let bounds: Bounds = self.model().bounds();
        let site = self.site().ok();
        let of_place = site.as_ref().and_then(ZoneOfPlace::of);
        let zones = of_place.map(|found| [found.zone].into_iter().chain(found.others));
        let zones: Vec<String> = zones.into_iter().flatten().map(|zone| zone.name().to_owned()).collect();
        json!({
            "ball_count": self.model().balls().len(),
            "low": bounds.low,
            "high": bounds.high,
            "tells_unproven": self.model().pulses().is_some(),
            "roof_count": self.model().outlines().planes.len(),
            "has_vegetation": self.model().vegetation().contains(&true),
            "latitude_deg": site.map(|site| site.latitude.to_degrees()),
            "zones": zones,
            "longitude_deg": site.map(|site| site.longitude.to_degrees()),
            "grid_north_deg": self.grid_north(None).to_degrees(),
        })
    }

    /// Returns the obstacles to lines of sight. Pulses are left out if they make no difference.
    pub(crate) fn blockers(&self, unproven: UnprovenAs, control: &Control<'_>) -> Result<Arc<MedialScene>> {
        self.inner.blockers(unproven, control)
    }

    /// The points of the cloud, which the questions about all of it need.
    pub(crate) fn cloud(&self) -> Result<&PointCloud> {
        let cloud = self.inner.cloud();
        if cloud.is_empty() {
            return Err(Error::NoPoints { what: "a ball file has none; open it together with its cloud".to_owned() });
        }
        Ok(cloud)
    }

    /// The points that a question about all of the cloud asks about.
    pub(crate) fn points(&self, points: PointChoice, control: &Control<'_>) -> Result<Arc<TargetPoints>> {
        let cloud = self.cloud()?;
        let chunks = &self.shown.chunks;
        let place = |row: u32| match &self.rows_there {
            Some(rows) => rows.get(row as usize).copied().filter(|&row| row != NOT_THERE),
            None => Some(row),
        };
        match points {
            PointChoice::All => self.points.get(|| Ok(TargetPoints::all(cloud, chunks, place))),
            PointChoice::Sample => self.sample.get(|| TargetPoints::sample(cloud, chunks, place, control)),
        }
    }

    /// The ground of the cloud on the grid that the command line takes.
    pub(crate) fn ground(&self, control: &Control<'_>) -> Result<Arc<KnownGround>> {
        self.inner.ground(GridCells::default().grid(&self.inner)?, GroundPoints::Auto, control)
    }

    /// The planes of roofs.
    pub(crate) fn roofs(&self, control: &Control<'_>) -> Result<Arc<RoofPlanes>> {
        self.roofs.get(|| RoofPlanes::new(self.cloud()?, &self.model().bounds(), &self.site()?, control))
    }

    /// Returns the location of the scene on earth.
    pub(crate) fn site(&self) -> Result<Site> {
        Ok(SunPlace::default().site_of(self.inner.frame(), &self.model().bounds(), None)?.0)
    }

    /// Azimuth of grid north from true north at a local place, or at the middle of the scene; grid north counts where
    /// true north is unknown.
    pub(crate) fn grid_north(&self, place: Option<[f64; 3]>) -> f64 {
        let place = place.map_or_else(|| self.inner.middle(), |place| [place[0], place[1]]);
        North::True.at(&self.inner, place).of_grid
    }

    /// Refuses an eye that cannot look, in words.
    pub(crate) fn check_eye(
        &self,
        blockers: &MedialScene,
        ground: &Ground,
        eye: [f64; 3],
    ) -> std::result::Result<(), String> {
        match fault_of(blockers, Some(ground), eye) {
            None => Ok(()),
            Some(fault) => Err(format!("Nobody can look from this place: {fault}.")),
        }
    }
}

/// Row of a point that a plan clears.
const NOT_THERE: u32 = u32::MAX;

/// For each point of a cloud its row among those of it that were kept, in their order.
fn rows_there(cloud: &PointCloud, kept: &PointCloud) -> Vec<u32> {
    let mut kept = (0..).zip(&kept.positions).peekable();
    let row = |position: &[f32; 3]| kept.next_if(|(_, own)| *own == position).map_or(NOT_THERE, |(row, _)| row);
    cloud.positions.iter().map(row).collect()
}

/// Choice of the points of the cloud that are targets.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum PointChoice {
    #[default]
    All,
    /// A fair sample, which answers for its neighbours.
    Sample,
}
