//! The planes of all roofs of a scene, found once.

use belvedere::apps::irradiance::{
    CLEAR_SKY_YEAR, ClearSky, Grouping, IrradianceParams, RadiationSource, SeasonRadiation, period_seasons,
};
use belvedere::apps::roof_planes::{RoofPlane, RoofPlaneParams, roof_planes, roof_points};
use belvedere::apps::sun::Site;
use belvedere::control::Control;
use belvedere::ground::{Ground, GroundParams, MapGrid};
use belvedere::{Bounds, PointCloud, Result};

/// Cells of the ground that roofs are separated from, metres: those of the command line.
const GROUND_CELL: f64 = 1.0;
/// Maximum distance of a clicked place from the nearest point of a plane, metres.
const REACH: f64 = 1.0;

/// The planes of all roofs, and the radiation of sun and sky in a year.
pub(crate) struct RoofPlanes {
    pub(crate) planes: Vec<RoofPlane>,
    /// The points that the rows of planes belong to, local metres.
    pub(crate) points: Vec<[f32; 3]>,
    pub(crate) seasons: Vec<SeasonRadiation>,
}

impl RoofPlanes {
    pub(crate) fn new(cloud: &PointCloud, bounds: &Bounds, site: &Site, control: &Control<'_>) -> Result<Self> {
        let (low, high) = bounds.on_map();
        let grid = MapGrid::covering(low, high, GROUND_CELL, [cloud.frame.origin[0], cloud.frame.origin[1]])?;
        let (ground, _) = Ground::of_cloud(cloud, grid, &GroundParams::default(), control)?;
        let (rows, _) = roof_points(cloud, &ground)?;
        let points: Vec<[f32; 3]> = rows.iter().filter_map(|&row| cloud.positions.get(row as usize).copied()).collect();
        let planes = roof_planes(&points, &RoofPlaneParams::default(), control)?;
        let source = RadiationSource::ClearSky { clear_sky: ClearSky::default(), year: CLEAR_SKY_YEAR };
        let params = IrradianceParams::default().with_grouping(Grouping::Months);
        let (seasons, _) = period_seasons(&source, site, None, &params, control)?;
        Ok(Self { planes, points, seasons })
    }

    /// The plane with the point nearest to a place, and its number.
    pub(crate) fn at(&self, place: [f64; 3]) -> Option<(usize, &RoofPlane)> {
        let distance = |plane: &RoofPlane| {
            let away = |row: &u32| {
                let point = self.points.get(*row as usize)?;
                Some(point.iter().zip(place).map(|(&a, b)| (f64::from(a) - b).powi(2)).sum::<f64>())
            };
            plane.points.iter().filter_map(away).fold(f64::INFINITY, f64::min)
        };
        let all = self.planes.iter().enumerate().map(|(number, plane)| (distance(plane), number, plane));
        let (away, number, plane) = all.min_by(|a, b| a.0.total_cmp(&b.0))?;
        (away <= REACH * REACH).then_some((number, plane))
    }
}
