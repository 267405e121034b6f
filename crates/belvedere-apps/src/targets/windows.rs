//! Windows as targets: planes with a size, or the faces of a mesh.

use super::{Facing, MeshParams, TARGET_LIFT, TargetLayout, Targets};
use crate::exposure::{plane_normal, window_places};
use belvedere_core::query::SurfacePiece;
use belvedere_data::frame::Frame;
use belvedere_data::vector::to_f32;
use belvedere_data::{Mesh, Result};

/// A window as studies know it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    /// Its middle, local metres.
    pub center: [f64; 3],
    /// Azimuth that it looks to, clockwise from grid north, radians; NaN for a window that looks straight up or down.
    pub azimuth: f64,
    /// Angle between the direction that it looks to and the zenith, radians: 0 looks up, π/2 is upright.
    pub tilt: f64,
    /// Width and height, metres; `None` for one whose only target is its middle.
    pub size: Option<[f64; 2]>,
    /// Its area, m², where it is a face.
    pub area: Option<f64>,
    /// The face of a mesh that it is.
    pub face: Option<u32>,
}

impl Window {
    /// A window of which no face is known.
    #[must_use]
    pub fn new(center: [f64; 3], azimuth: f64, tilt: f64, size: Option<[f64; 2]>) -> Self {
        Self { center, azimuth, tilt, size, area: None, face: None }
    }

    /// Its targets, and its unit normal.
    ///
    /// # Errors
    /// Those of [`window_places`].
    pub fn places(&self) -> Result<(Vec<[f64; 3]>, [f64; 3])> {
        let normal = plane_normal(self.azimuth, self.tilt);
        Ok((window_places(self.center, normal, self.size)?, normal))
    }
}

/// The object of `mesh` that each of `windows` is a face of, by its name; empty where the mesh names none.
#[must_use]
pub fn objects_of_windows(windows: &[Window], mesh: &Mesh) -> Vec<String> {
    if mesh.object_names.is_empty() {
        return Vec::new();
    }
    let name = |window: &Window| {
        let object = window.face.and_then(|face| mesh.objects.get(face as usize));
        object.and_then(|&object| mesh.object_names.get(object as usize)).cloned().unwrap_or_default()
    };
    windows.iter().map(name).collect()
}

impl Targets {
    /// The places of `windows`, one group each, all of a window counting alike.
    ///
    /// # Errors
    /// Those of [`window_places`], beside the number of the window, from 0.
    pub fn of_windows(windows: &[Window], frame: Frame) -> std::result::Result<Self, (usize, belvedere_data::Error)> {
        let (mut positions, mut normals, mut weights, mut groups) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for (number, window) in windows.iter().enumerate() {
            let (places, normal) = window.places().map_err(|error| (number, error))?;
            groups.push(positions.len()..positions.len() + places.len());
            weights.extend(places.iter().map(|_| 1.0 / places.len() as f64));
            normals.extend(places.iter().map(|_| normal.map(to_f32)));
            positions.extend(places.iter().map(|place| place.map(to_f32)));
        }
        Ok(Self { weights, groups, ..Self::at(frame, positions, Some(normals), TargetLayout::Points) })
    }

    /// The faces of `mesh`, metres, as windows: the targets, in pieces of `spacing` metres at most, and the properties
    /// of each window.
    ///
    /// # Errors
    /// Those of [`Targets::of_mesh`].
    pub fn of_window_faces(mesh: &Mesh, frame: &Frame, spacing: f64, seed: u64) -> Result<(Self, Vec<Window>)> {
        let params = MeshParams { spacing, seed, facing: Facing::Normals, lift: TARGET_LIFT };
        let targets = Self::of_mesh(mesh, frame, &params)?;
        let TargetLayout::Surface(surface) = &targets.layout else { return Ok((targets, Vec::new())) };
        let windows = surface.pieces.chunk_by(|a, b| a.face == b.face).filter_map(window_of_face).collect();
        Ok((targets, windows))
    }
}

/// Below this share of the normal that is level, a face looks straight up or down and has no azimuth.
const MIN_LEVEL_SHARE: f64 = 1e-6;

fn window_of_face(pieces: &[SurfacePiece]) -> Option<Window> {
    let first = pieces.first()?;
    let area: f64 = pieces.iter().map(|piece| f64::from(piece.area)).sum();
    let middle = |axis: usize| {
        let of_piece = |piece: &SurfacePiece| {
            f64::from(piece.area) * piece.corners.iter().map(|corner| f64::from(corner[axis])).sum::<f64>() / 3.0
        };
        pieces.iter().map(of_piece).sum::<f64>() / area
    };
    let [nx, ny, nz] = first.normal.map(f64::from);
    let level = nx.hypot(ny);
    let azimuth = if level > MIN_LEVEL_SHARE { nx.atan2(ny) } else { f64::NAN };
    Some(Window {
        center: [middle(0), middle(1), middle(2)],
        azimuth,
        tilt: level.atan2(nz),
        size: None,
        area: Some(area),
        face: Some(first.face),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, PI};

    #[test]
    fn windows_with_a_size_have_nine_places_that_share_their_weight() {
        let windows = [
            Window::new([0.0, 0.0, 2.0], PI, FRAC_PI_2, Some([1.2, 1.5])),
            Window::new([5.0, 0.0, 2.0], 0.0, FRAC_PI_2, None),
        ];
        let targets = Targets::of_windows(&windows, Frame::default()).unwrap();
        assert_eq!(targets.groups, [0..9, 9..10]);
        assert!(targets.group_weights().iter().all(|weight| (weight - 1.0).abs() < 1e-12));
        // south of the wall that looks south, north of the one that looks north
        assert!(targets.positions[..9].iter().all(|p| p[1] < 0.0) && targets.positions[9][1] > 0.0);
        let bad = Window::new([f64::NAN; 3], 0.0, 0.0, None);
        assert_eq!(Targets::of_windows(&[windows[0], bad], Frame::default()).unwrap_err().0, 1);
    }

    #[test]
    fn a_face_is_a_window_with_its_middle_azimuth_tilt_and_area() {
        // a wall of 3 m by 2 m that looks east, and a level roof
        let mesh = Mesh {
            vertices: vec![
                [1.0, 0.0, 0.0],
                [1.0, 3.0, 0.0],
                [1.0, 0.0, 4.0],
                [0.0, 0.0, 4.0],
                [1.0, 0.0, 4.0],
                [1.0, 1.0, 4.0],
            ],
            triangles: vec![[0, 1, 2], [3, 4, 5]],
            ..Mesh::default()
        };
        let (targets, windows) = Targets::of_window_faces(&mesh, &Frame::default(), 0.5, 1).unwrap();
        let [wall, roof] = windows[..] else { panic!("{windows:?}") };
        assert!((wall.azimuth - FRAC_PI_2).abs() < 1e-6 && (wall.tilt - FRAC_PI_2).abs() < 1e-6);
        assert!(wall.center.iter().zip([1.0, 1.0, 4.0 / 3.0]).all(|(a, b)| (a - b).abs() < 1e-5), "{wall:?}");
        assert!((wall.area.unwrap() - 6.0).abs() < 1e-5 && wall.face == Some(0));
        assert!(roof.azimuth.is_nan() && roof.tilt.abs() < 1e-6 && roof.face == Some(1));
        assert_eq!(targets.groups.len(), 2);
    }
}
