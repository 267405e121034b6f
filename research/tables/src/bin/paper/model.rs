//! From a cloud to medial balls, stage by stage, with the time each takes.

use crate::Tables;
use belvedere::Bounds;
use belvedere::clean::{CleanParams, clean};
use belvedere::control::Control;
use belvedere::medial::{MedialBalls, ShrinkParams, ShrinkReport, Side, shrink};
use belvedere::neighbors::NeighborIndex;
use belvedere::normals::estimate::{Neighborhood, estimate};
use belvedere::normals::{Normals, OrientReport, Orientation, OrientedCloud, orient};
use belvedere::{Error, Mesh, PointCloud, Result};
use std::time::Instant;

/// How the normals of a scan are made: from `neighbors` nearest neighbours, signs from a city model.
#[derive(Clone, Copy)]
pub(crate) struct NormalMethod<'a> {
    pub(crate) neighbors: usize,
    pub(crate) mesh: &'a Mesh,
}

/// A cloud and its interior balls.
pub(crate) struct PaperModel {
    /// The points that were used.
    pub(crate) cloud: PointCloud,
    pub(crate) oriented: OrientedCloud,
    pub(crate) index: NeighborIndex,
    /// Balls that shrank; `source` and `touch` refer to `cloud`.
    pub(crate) balls: MedialBalls,
    pub(crate) low: [f32; 3],
    pub(crate) high: [f32; 3],
    orient_report: OrientReport,
    shrink_report: ShrinkReport,
    given_count: usize,
    /// Stages and seconds.
    times: Vec<(&'static str, f64)>,
}

/// Runs `work` and notes how long it took.
fn timed<T>(times: &mut Vec<(&'static str, f64)>, stage: &'static str, work: impl FnOnce() -> Result<T>) -> Result<T> {
    let start = Instant::now();
    let result = work();
    times.push((stage, start.elapsed().as_secs_f64()));
    result
}

/// The points of `cloud` within a window of its reference system: west, south, east, north.
pub(crate) fn within_window(cloud: &PointCloud, [west, south, east, north]: [f64; 4]) -> PointCloud {
    let inside: Vec<u32> = (0..)
        .zip(&cloud.positions)
        .filter(|&(_, &p)| {
            let [x, y, _] = cloud.frame.to_file_coordinates(p);
            (west..east).contains(&x) && (south..north).contains(&y)
        })
        .map(|(i, _)| i)
        .collect();
    cloud.select(&inside)
}

impl PaperModel {
    /// Of a cloud whose normals are given and outward. Nothing is cleaned away: the points are those the published
    /// method was run on.
    pub(crate) fn of_given_normals(cloud: PointCloud, params: ShrinkParams) -> Result<Self> {
        let mut times = Vec::new();
        let given_count = cloud.len();
        let index = timed(&mut times, "index", || NeighborIndex::new(&cloud.positions, &Control::none()))?;
        let oriented = timed(&mut times, "orientation", || {
            orient(&cloud, Normals::default(), &Orientation::Given, &Control::none())
        })?;
        Self::shrunk(cloud, oriented, index, params, given_count, times)
    }

    /// Of a scan, oriented with a city model.
    pub(crate) fn of_scan(cloud: &PointCloud, way: &NormalMethod<'_>, params: ShrinkParams) -> Result<Self> {
        Self::of_oriented_scan(cloud, way.neighbors, &Orientation::Mesh(way.mesh), params)
    }

    /// Of a scan, oriented by any means.
    pub(crate) fn of_oriented_scan(
        cloud: &PointCloud,
        neighbors: usize,
        by: &Orientation<'_>,
        params: ShrinkParams,
    ) -> Result<Self> {
        let mut times = Vec::new();
        let given_count = cloud.len();
        let (kept, _) = timed(&mut times, "cleaning", || clean(cloud, &CleanParams::default(), &Control::none()))?;
        let cloud = cloud.select(&kept);
        let index = timed(&mut times, "index", || NeighborIndex::new(&cloud.positions, &Control::none()))?;
        let neighborhood = Neighborhood::Fixed { k: neighbors };
        let normals =
            timed(&mut times, "normals", || estimate(&cloud.positions, &index, neighborhood, &Control::none()))?;
        let oriented = timed(&mut times, "orientation", || orient(&cloud, normals, by, &Control::none()))?;
        Self::shrunk(cloud, oriented, index, params, given_count, times)
    }

    fn shrunk(
        cloud: PointCloud,
        (oriented, orient_report): (OrientedCloud, OrientReport),
        index: NeighborIndex,
        params: ShrinkParams,
        given_count: usize,
        mut times: Vec<(&'static str, f64)>,
    ) -> Result<Self> {
        let Bounds { low, high } =
            cloud.bounds().ok_or_else(|| Error::NoPoints { what: "the data set is empty".to_owned() })?;
        let (balls, shrink_report) =
            timed(&mut times, "balls", || shrink(&oriented, &index, Side::Interior, &params, &Control::none()))?;
        Ok(Self {
            cloud,
            oriented,
            index,
            balls: balls.shrunk(),
            low,
            high,
            orient_report,
            shrink_report,
            given_count,
            times,
        })
    }

    /// ASPRS class of a point, 1 (unclassified) where the cloud has none.
    pub(crate) fn class(&self, point: u32) -> u8 {
        self.cloud.attributes.classification.as_ref().and_then(|c| c.get(point as usize)).copied().unwrap_or(1)
    }

    /// Points, balls and times.
    pub(crate) fn report(&self, tables: &mut Tables) {
        let r = &self.shrink_report;
        let size: Vec<String> = (0..3).map(|i| format!("{:.1}", self.high[i] - self.low[i])).collect();
        tables.line(&format!(
            "points {} (given {}), box {}; balls {}, never shrunk {} ({:.1} %), without normal {}",
            self.cloud.len(),
            self.given_count,
            size.join(" x "),
            r.shrunk,
            r.never_shrunk,
            100.0 * r.never_shrunk as f64 / self.cloud.len() as f64,
            r.without_normal
        ));
        let o = &self.orient_report;
        let ways = [
            ("file", o.by_file_count),
            ("scanner", o.by_scanner_count),
            ("aligned face", o.by_face_count),
            ("parity", o.by_parity_count),
            ("vote", o.by_vote_count),
            ("up", o.by_up_count),
        ];
        let ways = ways.iter().filter(|(_, count)| *count > 0);
        let signs: Vec<String> = ways.map(|(way, count)| format!("{way} {:.1} %", 100.0 * o.share(*count))).collect();
        tables.line(&format!("signs of normals by: {}", signs.join(", ")));
        let times: Vec<String> = self.times.iter().map(|(stage, s)| format!("{stage} {s:.3} s")).collect();
        tables.line(&format!("times: {}\n", times.join(", ")));
    }
}

/// Balls of bounded penetration without the limit of their radius that is the default.
pub(crate) fn unlimited_tau() -> ShrinkParams {
    ShrinkParams { max_radius: f32::INFINITY, ..ShrinkParams::tau() }
}
