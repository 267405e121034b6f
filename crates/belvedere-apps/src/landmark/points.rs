//! Landmarks that are points of a cloud.

use belvedere_core::ground::{GroundParams, ground_points};
use belvedere_core::neighbors::NeighborIndex;
use belvedere_core::normals::estimate::{Neighborhood, estimate};
use belvedere_core::query::SurfacePieces;
use belvedere_data::control::Control;
use belvedere_data::polygon::is_inside;
use belvedere_data::{Error, PointCloud, Result};

/// Maximum radius of the surface that a point represents, metres: walls that few pulses reach have points a metre
/// apart.
const MAX_RADIUS: f64 = 1.0;

/// Selection of the points of a landmark.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LandmarkPoints<'a> {
    /// Points of an ASPRS class.
    Class(u8),
    /// Points above one of several polygons that are not ground. Each polygon is an outline and holes of (x, y), local
    /// metres, closed or not.
    Inside(&'a [Vec<Vec<[f64; 2]>>]),
}

/// Returns the rows of the points of `cloud` that are the landmark, ascending, and their surface
/// ([`SurfacePieces::of_points`]). Normals come from 16 neighbours; a point represents a disc of 1 m radius at most.
///
/// # Errors
/// [`Error::MissingAttribute`] for a class where the cloud has none, [`Error::NoPoints`] where no point is meant, and
/// errors of estimating normals and finding the ground.
pub fn landmark_points(cloud: &PointCloud, which: &LandmarkPoints<'_>) -> Result<(Vec<u32>, SurfacePieces)> {
    let rows: Vec<u32> = match which {
        LandmarkPoints::Class(class) => {
            let Some(classes) = &cloud.attributes.classification else {
                return Err(Error::MissingAttribute {
                    attribute: "classification",
                    needed_for: "a landmark of a class",
                    advice: "give a polygon or a mesh instead",
                });
            };
            (0_u32..).zip(classes).filter(|(_, own)| *own == class).map(|(row, _)| row).collect()
        }
        LandmarkPoints::Inside(polygons) => {
            let (ground, _) = ground_points(cloud, &GroundParams::default(), &Control::none())?;
            let mut is_ground = vec![false; cloud.len()];
            ground.iter().filter_map(|&row| is_ground.get_mut(row as usize).map(|own| *own = true)).count();
            let inside = |p: &[f32; 3]| {
                let place = [f64::from(p[0]), f64::from(p[1])];
                polygons.iter().any(|polygon| is_inside(polygon, place))
            };
            (0_u32..)
                .zip(&cloud.positions)
                .zip(&is_ground)
                .filter(|((_, p), is_ground)| !**is_ground && inside(p))
                .map(|((row, _), _)| row)
                .collect()
        }
    };
    if rows.is_empty() {
        let what = match which {
            LandmarkPoints::Class(class) => format!("no point has class {class}, which is the class of the landmark"),
            LandmarkPoints::Inside(_) => {
                "only ground points lie in the polygon of the landmark; is it in the coordinates of the cloud?"
                    .to_owned()
            }
        };
        return Err(Error::NoPoints { what });
    }
    let points: Vec<[f32; 3]> = rows.iter().filter_map(|&row| cloud.positions.get(row as usize).copied()).collect();
    let index = NeighborIndex::new(&points, &Control::none())?;
    let normals = estimate(&points, &index, Neighborhood::default(), &Control::none())?;
    let surface = SurfacePieces::of_points(&points, &normals.vectors, MAX_RADIUS, &Control::none())?;
    Ok((rows, surface))
}
