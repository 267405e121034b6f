//! A small town, scanned, and the tests' own arithmetic.

pub(crate) mod place;

use belvedere::Bounds;
use belvedere::query::{Answer, Viewer, Visibility};
use belvedere::{Mesh, PointCloud};
use belvedere_scenes::{AirborneParams, TownParams, TriangleScene, scan_airborne, town};

/// Small generator of the tests' own.
pub(crate) struct TestRandom(pub(crate) u64);

impl TestRandom {
    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * ((self.0 >> 11) as f64 / (1_u64 << 53) as f64)
    }

    pub(crate) fn point(&mut self, low: [f64; 3], high: [f64; 3]) -> [f32; 3] {
        std::array::from_fn(|i| self.between(low[i], high[i]) as f32)
    }

    pub(crate) fn direction(&mut self) -> [f64; 3] {
        loop {
            let d: [f64; 3] = std::array::from_fn(|_| self.between(-1.0, 1.0));
            if (0.01..1.0).contains(&dot(d, d)) {
                return d.map(|v| v / dot(d, d).sqrt());
            }
        }
    }
}

pub(crate) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(crate) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// A town of 100 m with its mesh.
pub(crate) fn small_town() -> (TriangleScene, Mesh) {
    let scene = town(&TownParams { extent: 100.0, seed: 3, ..TownParams::default() });
    let mesh = Mesh { vertices: scene.vertices.clone(), triangles: scene.triangles.clone(), ..Mesh::default() };
    (scene, mesh)
}

/// A thin scan of a scene.
pub(crate) fn scan(scene: &TriangleScene) -> PointCloud {
    let scan = scan_airborne(scene, &AirborneParams { pulses_per_m2: 1.0, ..AirborneParams::default() });
    let coordinates: Vec<[f64; 3]> = (0..scan.len()).map(|i| [scan.x[i], scan.y[i], scan.z[i]]).collect();
    let (mut cloud, left_out) = PointCloud::from_coordinates(&coordinates);
    assert_eq!(left_out, 0);
    cloud.attributes.return_number = Some(scan.return_number);
    cloud
}

/// Random positions in the box of a cloud and somewhat beyond.
pub(crate) fn targets(cloud: &PointCloud, count: usize, seed: u64) -> Vec<[f32; 3]> {
    let Bounds { low, high } = cloud.bounds().unwrap();
    let mut random = TestRandom(seed);
    (0..count).map(|_| random.point(low.map(|v| f64::from(v) - 3.0), high.map(|v| f64::from(v) + 3.0))).collect()
}

/// Whether each target is blocked; none may lie outside the view.
pub(crate) fn blocked(method: &dyn Visibility, viewer: Viewer<'_>, targets: &[[f32; 3]]) -> Vec<bool> {
    let answers = method.visible(viewer, targets).unwrap();
    assert!(answers.iter().all(|&a| a != Answer::OutsideView));
    answers.iter().map(|&a| a == Answer::Blocked).collect()
}

pub(crate) fn count_true(values: &[bool]) -> usize {
    values.iter().filter(|&&v| v).count()
}

/// A cloud of local positions.
pub(crate) fn cloud_of(positions: Vec<[f32; 3]>) -> PointCloud {
    PointCloud { positions, ..PointCloud::default() }
}
