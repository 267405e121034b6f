//! Visibility analysis directly on point clouds.
//!
//! A scene is modelled as a union of medial balls (Peters, Ledoux & Biljecki 2015); the balls block lines of sight, and a
//! depth map says what is visible. The stages are plain functions:
//!
//! ```
//! use belvedere::clean::{CleanParams, clean};
//! use belvedere::depth::{ItemBuffer, Profile, depth_map};
//! use belvedere::medial::{ShrinkParams, Side, shrink};
//! use belvedere::neighbors::NeighborIndex;
//! use belvedere::normals::estimate::{Neighborhood, estimate};
//! use belvedere::normals::{Orientation, orient};
//! use belvedere::control::Control;
//! use belvedere::query::{Answer, query_points};
//! use belvedere::view::{View, to_sun};
//! use belvedere::PointCloud;
//!
//! # fn main() -> belvedere::Result<()> {
//! // a flat roof 10 m up over sloping ground; real clouds come from `io::read_cloud`
//! let at = |i: u32, side: f64| [f64::from(i % 60) * side / 60.0, f64::from(i / 60) * side / 60.0];
//! let roof = (0..3600).map(|i| { let [x, y] = at(i, 12.0); [x + 14.0, y + 14.0, 10.0 + 0.01 * (x * 7.0).sin()] });
//! let ground = (0..3600).map(|i| { let [x, y] = at(i, 40.0); [x, y, 0.02 * x] });
//! let (cloud, _left_out) = PointCloud::from_coordinates(&roof.chain(ground).collect::<Vec<_>>());
//!
//! let (kept, _report) = clean(&cloud, &CleanParams::default(), &Control::none())?;
//! let cloud = cloud.select(&kept);
//! let index = NeighborIndex::new(&cloud.positions, &Control::none())?;
//! let normals = estimate(&cloud.positions, &index, Neighborhood::default(), &Control::none())?;
//! let (oriented, _report) = orient(&cloud, normals, &Orientation::Up, &Control::none())?;
//! let (balls, _report) = shrink(&oriented, &index, Side::Interior, &ShrinkParams::tau(), &Control::none())?;
//!
//! let sun = to_sun(180f64.to_radians(), 60f64.to_radians());
//! let Bounds { low, high } = cloud.bounds().unwrap();
//! let view = View::parallel(sun.map(|v| -v), low.map(f64::from), high.map(f64::from), 0.1)?;
//! let map = depth_map(&balls, &view, Profile::Sphere, ItemBuffer::Without)?;
//!
//! // on the ground north of the roof, where its shadow falls, and south of it
//! let targets = [[20.0, 26.0, 1.0], [20.0, 5.0, 1.0]].map(|p| cloud.frame.from_file_coordinates(p));
//! let answers = query_points(&map, &targets, map.default_depth_bias());
//! assert_eq!(answers, [Answer::Blocked, Answer::Visible]);
//! # Ok(())
//! # }
//! ```
//!
//! Units are metres and radians; positions are local f32 on an f64 origin ([`PointCloud`]). Every parallel result is the same,
//! bit by bit, for any number of threads. The crate prints nothing and reads no clock or environment.

#[cfg(feature = "apps")]
pub use belvedere_apps as apps;
pub use belvedere_core::{
    blocking, clean, depth, ground, medial, model, neighbors, normals, pulses, query, ray_index, summary,
};
pub use belvedere_data::{Attributes, Bounds, Error, Frame, GpsTimeKind, Mesh, PointCloud, Result, cloud};
pub use belvedere_data::{control, crs, error, frame, mesh, random, raster, report, trajectory, vector, view, weather};
#[cfg(feature = "figures")]
pub use belvedere_figures as figures;
#[cfg(feature = "io")]
pub use belvedere_io as io;
#[cfg(all(feature = "apps", feature = "io"))]
pub mod results;
