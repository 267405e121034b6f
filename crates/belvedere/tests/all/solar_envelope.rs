//! Solar envelopes against closed forms and against shadows traced box by box.

use belvedere::apps::solar_envelope::{
    EnvelopeParams, Parcel, ProtectedPiece, SolarEnvelope, protected_faces, protected_line, solar_envelope,
};
use belvedere::control::Control;
use belvedere::ground::{Ground, MapGrid};
use belvedere::medial::MedialBalls;
use belvedere::mesh::Mesh;
use belvedere::query::{BlockRule, MedialScene, SurfacePieces};
use belvedere::random::uniform;
use belvedere::raster::Raster;
use belvedere::view::to_sun;
use std::collections::HashMap;

fn sun(azimuth_deg: f64, elevation_deg: f64) -> [f64; 3] {
    to_sun(azimuth_deg.to_radians(), elevation_deg.to_radians())
}

/// Ground that rises by `slope` to the east, over 40 m by 40 m around the origin.
fn ground(cell: f64, slope: f64) -> Ground {
    let count = (40.0 / cell) as usize;
    let grid = MapGrid { corner: [-20.0, 20.0], cell, width: count, height: count };
    let heights = (0..count * count).map(|i| (slope * grid.center(i % count, i / count)[0]) as f32).collect();
    Ground {
        grid,
        heights: Raster::from_values(count, count, heights).unwrap(),
        gaps: Raster::filled(count, count, 0.0),
    }
}

fn rectangle(low: [f64; 2], high: [f64; 2]) -> Parcel {
    Parcel::new(&[vec![low, [high[0], low[1]], high, [low[0], high[1]]]]).unwrap()
}

fn line(corners: &[[f64; 3]], fence: f64) -> Vec<ProtectedPiece> {
    protected_line(corners, fence, 1000.0, &ground(1.0, 0.0), 0).unwrap().0
}

fn envelope(parcel: &Parcel, protected: &[ProtectedPiece], suns: &[[f64; 3]]) -> SolarEnvelope {
    solar_envelope(parcel, &ground(1.0, 0.0), protected, suns, None, &EnvelopeParams::default(), &Control::none())
        .unwrap()
}

#[test]
fn a_long_fence_bounds_by_a_plane_at_the_elevation_of_the_sun() {
    let fence = line(&[[-500.0, 0.0, 0.0], [500.0, 0.0, 0.0]], 1.8);
    let (south, north) = (rectangle([-8.0, -12.0], [8.0, 0.0]), rectangle([-8.0, 0.0], [8.0, 12.0]));
    for (azimuth, elevation) in [(180.0, 30.0), (140.0, 12.0), (230.0, 61.0)] {
        let bounded = envelope(&south, &fence, &[sun(azimuth, elevation)]);
        assert_eq!(bounded.columns.len(), 16 * 12);
        // the rise square to the fence is tan e over the cosine of the angle between the sun and that square
        let rise = f64::to_radians(elevation).tan() / f64::to_radians(azimuth - 180.0).cos();
        for column in &bounded.columns {
            let [_, y] = bounded.grid.center(column.footprint.cell % 40, column.footprint.cell / 40);
            // the near side of the square, half a metre from its middle
            let expected = 1.8 + (-y - 0.5) * rise;
            assert!((column.top - expected).abs() < 1e-9, "{} {expected}", column.top);
        }
        // the sun stands in the south: what lies north of the fence shades away from it
        assert_eq!(envelope(&north, &fence, &[sun(azimuth, elevation)]).unbounded_count(), 16 * 12);
    }
}

#[test]
fn several_suns_bound_by_the_least_and_the_binding_says_which() {
    let fence = line(&[[-500.0, 0.0, 0.0], [500.0, 0.0, 0.0]], 0.0);
    let parcel = rectangle([-8.0, -12.0], [8.0, 0.0]);
    let suns = [sun(180.0, 50.0), sun(170.0, 20.0), sun(200.0, 35.0)];
    let all = envelope(&parcel, &fence, &suns);
    let single: Vec<SolarEnvelope> = suns.iter().map(|&sun| envelope(&parcel, &fence, &[sun])).collect();
    for (i, column) in all.columns.iter().enumerate() {
        let min = single.iter().map(|one| one.columns[i].top).fold(f64::INFINITY, f64::min);
        assert_eq!(column.top, min);
        assert_eq!(single[column.binding.unwrap().sun].columns[i].top, min);
    }
    // the flattest sun bounds but for the row at the fence, which all bound to nothing, and the first is named
    let areas = all.bound_areas(3, |binding| binding.sun);
    assert_eq!(areas, [16.0, 11.0 * 16.0, 0.0]);
    // night and a sun overhead bound nothing
    let idle = envelope(&parcel, &fence, &[sun(180.0, -5.0), [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]]);
    assert_eq!((idle.report.sun_below_horizon_count, idle.report.pair_count), (2, 1));
    assert_eq!(idle.unbounded_count(), idle.columns.len());
}

#[test]
fn a_point_bounds_the_cells_that_its_line_to_the_sun_runs_over() {
    let point = [ProtectedPiece::point([0.3, 0.0, 1.0], 0)];
    let found = envelope(&rectangle([-8.0, -12.0], [8.0, 0.0]), &point, &[sun(180.0, 45.0)]);
    for column in &found.columns {
        let [x, y] = found.grid.center(column.footprint.cell % 40, column.footprint.cell / 40);
        let expected = if (x - 0.3).abs() < 0.5 { 1.0 + (-y - 0.5) } else { f64::INFINITY };
        assert!(column.top == expected || (column.top - expected).abs() < 1e-9, "{x} {y} {}", column.top);
    }
}

#[test]
fn a_fence_that_runs_toward_the_sun_and_a_wall_bound_by_their_lowest_place() {
    // a ramp of a fence, 0 m at its southern end, and the sun in the south: behind its end it counts from there
    let ramp = line(&[[0.5, 0.0, 0.0], [0.5, 4.0, 4.0]], 0.0);
    let found = envelope(&rectangle([0.0, -6.0], [1.0, 4.0]), &ramp, &[sun(180.0, 60.0)]);
    let slope = 60f64.to_radians().tan();
    for column in &found.columns {
        let [_, y] = found.grid.center(column.footprint.cell % 40, column.footprint.cell / 40);
        // over the fence itself its own height at the lower side of the cell, before it the distance to its end
        let expected = if y > 0.0 { y - 0.5 } else { (-y - 0.5) * slope };
        assert!((column.top - expected).abs() < 1e-9, "{y} {} {expected}", column.top);
    }
    // a wall, 3 m above the ground, seen from the south: its bottom counts, and only where it faces the sun
    let vertices = vec![[-300.0, 1.0, 3.0], [300.0, 1.0, 3.0], [300.0, 1.0, 9.0], [-300.0, 1.0, 9.0]];
    let mesh = Mesh { vertices, triangles: vec![[0, 1, 2], [0, 2, 3]], ..Mesh::default() };
    let wall = protected_faces(&SurfacePieces::of_mesh(&mesh, [0.0; 3], 2.0, 1).unwrap(), 0.1);
    let parcel = rectangle([-4.0, -6.0], [4.0, 0.0]);
    let found = envelope(&parcel, &wall, &[sun(180.0, 40.0), sun(0.0, 5.0)]);
    for column in &found.columns {
        let [_, y] = found.grid.center(column.footprint.cell % 40, column.footprint.cell / 40);
        let expected = 3.0 + (1.0 - y - 0.5) * 40f64.to_radians().tan();
        // pieces are f32 at 300 m: 3e-5 m
        assert!((column.top - expected).abs() < 1e-4, "{} {expected}", column.top);
    }
    assert_eq!(found.report.turned_away_count, wall.len());
}

/// Returns true if the path from `place` to the sun meets the box below `top` over a square cell.
fn is_shaded(place: [f64; 3], sun: [f64; 3], low: [f64; 2], cell: f64, top: f64) -> bool {
    let (mut from, mut to) = (0.0_f64, f64::INFINITY);
    for axis in 0..2 {
        if sun[axis].abs() < 1e-12 {
            if place[axis] <= low[axis] || place[axis] >= low[axis] + cell {
                return false;
            }
            continue;
        }
        let ends = [low[axis], low[axis] + cell].map(|v| (v - place[axis]) / sun[axis]);
        from = from.max(ends[0].min(ends[1]));
        to = to.min(ends[0].max(ends[1]));
    }
    // within the square the way is lowest where it enters
    to - from > 1e-9 && place[2] + from * sun[2] < top
}

#[test]
fn traced_box_by_box_the_columns_shade_nothing_and_none_can_grow_by_five_centimetres() {
    let suns: Vec<[f64; 3]> = (0..7).map(|i| sun(120.0 + 20.0 * f64::from(i), 15.0 + 3.0 * f64::from(i))).collect();
    let fences = [
        ([-9.0, 3.3, 0.0], [6.0, 9.0, 1.0], 1.2),
        ([-9.0, 3.3, 0.0], [-11.0, -14.0, 0.5], 0.0),
        // a fence on the parcel
        ([2.5, -3.0, 0.0], [7.0, -5.2, 0.0], 2.0),
    ];
    let mut protected = Vec::new();
    for (a, b, fence) in fences {
        protected.extend(line(&[a, b], fence));
    }
    let parcel = rectangle([-9.0, -10.0], [9.0, 2.0]);
    let found = envelope(&parcel, &protected, &suns);
    let mut bounded = 0;
    for column in &found.columns {
        let cell = column.footprint.cell;
        let [x, y] = found.grid.center(cell % 40, cell / 40);
        let shades = |top: f64, count: u32| {
            fences.iter().any(|(a, b, fence)| {
                (0..=count).any(|i| {
                    let share = f64::from(i) / f64::from(count);
                    let mut place: [f64; 3] = std::array::from_fn(|k| a[k] + share * (b[k] - a[k]));
                    place[2] += fence;
                    suns.iter().any(|&sun| is_shaded(place, sun, [x - 0.5, y - 0.5], 1.0, top))
                })
            })
        };
        if column.top.is_finite() {
            bounded += 1;
            assert!(!shades(column.top - 1e-6, 2000), "column at {x} {y} shades a fence");
            // 17 m of fence in 4000 steps of 4 mm, under suns of 33 degrees at most: the bound moves by a few mm
            // between them
            assert!(shades(column.top + 0.05, 4000), "column at {x} {y} could grow: {}", column.top);
        } else {
            assert!(!shades(1e6, 500));
        }
    }
    assert!(bounded > 100, "{bounded}");
}

#[test]
fn cells_that_the_outline_cuts_are_bounded_over_their_part_alone() {
    let outline = vec![[-6.2, -9.1], [5.3, -11.7], [8.4, -1.2], [0.4, -3.0], [-7.5, 0.6]];
    let hole = vec![[-2.0, -7.3], [1.1, -7.7], [0.2, -5.1]];
    let parcel = Parcel::new(&[outline.clone(), hole.clone()]).unwrap();
    let fence = ([-12.0, 4.0, 0.7], [11.0, 2.0, 0.2]);
    let suns = [sun(150.0, 25.0), sun(215.0, 18.0)];
    let found = envelope(&parcel, &line(&[fence.0, fence.1], 0.0), &suns);
    let area: f64 = found.columns.iter().map(|column| column.footprint.area).sum();
    assert!((area - parcel.area()).abs() < 1e-6);
    let inside = |ring: &[[f64; 2]], p: [f64; 2]| {
        let crossings = (0..ring.len()).filter(|&i| {
            let (a, b) = (ring[i], ring[(i + 1) % ring.len()]);
            (a[1] > p[1]) != (b[1] > p[1]) && p[0] < a[0] + (p[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0])
        });
        crossings.count() % 2 == 1
    };
    let mut partial = 0;
    for column in &found.columns {
        let cell = column.footprint.cell;
        let [x, y] = found.grid.center(cell % 40, cell / 40);
        let mut min = f64::INFINITY;
        for i in 0..4000_u64 {
            let p = [x - 0.5 + uniform(cell as u64, 2 * i), y - 0.5 + uniform(cell as u64, 2 * i + 1)];
            if !inside(&outline, p) || inside(&hole, p) {
                continue;
            }
            for sun in suns {
                // walk away from the sun to the fence: p − t s = a + u (b − a) on the map
                let (a, b) = fence;
                let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
                let determinant = -sun[0] * dy + sun[1] * dx;
                let t = (dy * (a[0] - p[0]) - dx * (a[1] - p[1])) / determinant;
                let at = [p[0] - t * sun[0], p[1] - t * sun[1]];
                let u = (at[0] - a[0]) / dx;
                if t > 0.0 && (0.0..=1.0).contains(&u) {
                    min = min.min(a[2] + u * (b[2] - a[2]) + t * sun[2]);
                }
            }
        }
        if min.is_finite() {
            assert!(column.top <= min + 1e-9, "{} {min}", column.top);
            // 4000 places leave corners of some 0.05 m empty, of thin parts more; slopes are 0.47 at most
            let tolerance = if column.footprint.area > 0.1 { 0.06 } else { 0.3 };
            assert!(column.top >= min - tolerance, "{} {min} {:?}", column.top, column.footprint);
        }
        partial += usize::from(!column.footprint.is_whole);
    }
    assert!(partial > 20, "{partial}");
}

/// Returns true if each edge of a mesh is walked as often one way as the other; places are compared number for number.
fn is_closed(mesh: &Mesh) -> bool {
    let mut balance: HashMap<[u32; 2], i32> = HashMap::new();
    for [a, b, c] in &mesh.triangles {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            *balance.entry([*from.min(to), *from.max(to)]).or_default() += if from < to { 1 } else { -1 };
        }
    }
    balance.values().all(|sum| *sum == 0)
}

fn volume(mesh: &Mesh) -> f64 {
    let six_fold = |t: usize| {
        let [a, b, c] = mesh.corners(t).unwrap();
        a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])
    };
    (0..mesh.triangles.len()).map(six_fold).sum::<f64>() / 6.0
}

#[test]
fn the_mesh_is_closed_and_holds_the_volume_also_over_sloping_ground_and_around_holes() {
    let outline = vec![[-6.2, -9.1], [5.3, -11.7], [8.4, -1.2], [0.4, -3.0], [-7.5, 0.6]];
    let hole = vec![[-2.0, -7.3], [1.1, -7.7], [0.2, -5.1]];
    let parcel = Parcel::new(&[outline, hole]).unwrap();
    let fence = line(&[[-12.0, 4.0, 0.0], [11.0, 2.0, 0.0]], 0.5);
    let params = EnvelopeParams::default().with_ceiling(Some(4.0));
    for (slope, suns) in [(0.0, vec![sun(180.0, 20.0)]), (0.9, vec![sun(150.0, 25.0), sun(215.0, 18.0)])] {
        let found =
            solar_envelope(&parcel, &ground(1.0, slope), &fence, &suns, None, &params, &Control::none()).unwrap();
        let mesh = found.to_mesh([0.0; 3]).unwrap();
        assert!(is_closed(&mesh), "slope {slope}");
        // columns below a millimetre are left out: 1e-3 m of 100 m² at most
        assert!((volume(&mesh) - found.volume()).abs() < 0.1, "{} {}", volume(&mesh), found.volume());
        assert!(found.volume() > 50.0 && found.greatest_height() <= 4.0 + 1e-9);
        let moved = found.to_mesh([100_000.0, 400_000.0, 10.0]).unwrap();
        assert_eq!(moved.triangles, mesh.triangles);
    }
    let open = solar_envelope(&parcel, &ground(1.0, 0.0), &[], &[], None, &EnvelopeParams::default(), &Control::none())
        .unwrap();
    assert!(open.to_mesh([0.0; 3]).unwrap_err().to_string().contains("maximum height"));
}

#[test]
fn where_something_else_shades_already_the_credit_lifts_the_bound() {
    // a ball of 3 m to the south-east of the eastern half of the fence hides the sun from it
    let suns = [sun(180.0, 30.0)];
    let pieces = protected_line(&[[-6.0, 0.0, 0.0], [6.0, 0.0, 0.0]], 0.0, 1.0, &ground(1.0, 0.0), 0).unwrap().0;
    let balls = MedialBalls {
        centers: vec![[3.0, -20.0, 20.0 * 30f32.to_radians().tan()]],
        radii: vec![3.0],
        source: vec![0],
        touch: vec![0],
        separation_angles: vec![3.0],
    };
    let scene = MedialScene::new(&balls, &BlockRule::carved()).unwrap();
    let samples: Vec<[f32; 3]> = pieces.iter().map(|piece| piece.sample).collect();
    let free = scene.visibility_matrix(&samples, &suns, &Control::none()).unwrap();
    let parcel = rectangle([-6.0, -8.0], [6.0, 0.0]);
    let params = EnvelopeParams::default();
    let credited =
        solar_envelope(&parcel, &ground(1.0, 0.0), &pieces, &suns, Some(&free), &params, &Control::none()).unwrap();
    let plain = solar_envelope(&parcel, &ground(1.0, 0.0), &pieces, &suns, None, &params, &Control::none()).unwrap();
    assert_eq!(credited.report.shaded_already_count, 6);
    for (with, without) in credited.columns.iter().zip(&plain.columns) {
        let [x, _] = credited.grid.center(with.footprint.cell % 40, with.footprint.cell / 40);
        if x > 0.0 {
            assert!(with.top.is_infinite());
        } else {
            assert_eq!(with.top, without.top);
        }
        assert!(without.top.is_finite());
    }
    // a matrix of something else
    let other = scene.visibility_matrix(&samples[1..], &suns, &Control::none()).unwrap();
    assert!(
        solar_envelope(&parcel, &ground(1.0, 0.0), &pieces, &suns, Some(&other), &params, &Control::none()).is_err()
    );
}

#[test]
fn envelopes_do_not_depend_on_threads() {
    let suns: Vec<[f64; 3]> = (0..9).map(|i| sun(100.0 + 18.0 * f64::from(i), 12.0 + 4.0 * f64::from(i))).collect();
    let fence = protected_line(&[[-9.0, 3.3, 0.0], [6.0, 9.0, 1.0]], 1.0, 0.5, &ground(1.0, 0.0), 0).unwrap().0;
    let parcel = rectangle([-9.3, -10.0], [9.0, 2.2]);
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| envelope(&parcel, &fence, &suns)).columns
    };
    assert_eq!(on(1), on(3));
}

#[test]
fn hostile_input_is_refused_with_what_is_wrong() {
    let parcel = rectangle([-6.0, -8.0], [6.0, 0.0]);
    let ask = |parcel: &Parcel, protected: &[ProtectedPiece], suns: &[[f64; 3]], ceiling: Option<f64>| {
        let params = EnvelopeParams::default().with_ceiling(ceiling);
        solar_envelope(parcel, &ground(1.0, 0.0), protected, suns, None, &params, &Control::none())
            .unwrap_err()
            .to_string()
    };
    assert!(ask(&parcel, &[], &[[0.0, 0.0, 2.0]], None).contains("direction to the sun"));
    assert!(ask(&parcel, &[], &[[f64::NAN, 0.0, 1.0]], None).contains("direction to the sun"));
    assert!(ask(&parcel, &[ProtectedPiece::point([0.0, f64::NAN, 0.0], 0)], &[], None).contains("protected place"));
    for ceiling in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(ask(&parcel, &[], &[], Some(ceiling)).contains("maximum height"));
    }
    assert!(
        ask(&rectangle([500.0, 500.0], [510.0, 510.0]), &[], &[], None).contains("ground below the parcel is unknown")
    );
    for (fence, spacing) in [(-1.0, 1.0), (f64::NAN, 1.0), (0.0, 0.0), (0.0, f64::NAN), (0.0, 1e-9)] {
        let corners = [[0.0, 0.0, 0.0], [10.0, 0.0, 0.0]];
        assert!(protected_line(&corners, fence, spacing, &ground(1.0, 0.0), 0).is_err());
    }
    assert!(protected_line(&[[0.0; 3], [f64::INFINITY, 0.0, 0.0]], 0.0, 1.0, &ground(1.0, 0.0), 0).is_err());
    // a line without heights follows the ground as far as it is known
    let (pieces, unknown) =
        protected_line(&[[0.0, 0.0, f64::NAN], [50.0, 0.0, f64::NAN]], 1.5, 1.0, &ground(1.0, 0.1), 3).unwrap();
    assert_eq!((pieces.len(), unknown), (20, 30));
    // heights are f32 in the ground
    assert!(pieces.iter().all(|p| p.source == 3 && (p.corners[0][2] - 1.5 - 0.1 * p.corners[0][0]).abs() < 0.06));
}
