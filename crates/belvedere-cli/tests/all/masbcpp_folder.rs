//! `balls` and `normals` in place of masbcpp's programs, on its folders of arrays.
#![expect(clippy::cast_possible_truncation, reason = "small numbers")]

use crate::common::{EAST, NORTH, Workplace, house, npy, shared_data};
use std::path::Path;

#[test]
fn a_folder_gets_the_arrays_of_masbcpp_with_a_row_per_point() {
    let place = Workplace::new();
    let mut cloud = house();
    // duplicates, and a point alone far from the others
    let repeated: Vec<u32> = (0..cloud.len() as u32).chain([5, 5, 77]).collect();
    cloud = cloud.select(&repeated);
    cloud.positions.push([0.0, 0.0, 90.0]);
    cloud.attributes.normals.as_mut().unwrap().push([0.0, 0.0, 1.0]);
    let n = cloud.len() as u64;
    place.write_folder("in", &cloud);
    place.summary("balls in -o out");
    for side in ["in", "out"] {
        assert_eq!(place.npy::<f32>(&format!("out/ma_coords_{side}.npy")).0, [n, 3]);
        let (shape, touch) = place.npy::<i32>(&format!("out/ma_qidx_{side}.npy"));
        assert_eq!(shape, [n]);
        assert!(touch.iter().all(|&q| q >= -1 && i64::from(q) < n as i64));
    }
    // duplicates have the same ball
    let (_, centers) = place.npy::<f32>("out/ma_coords_in.npy");
    let row = |i: usize| &centers[3 * i..3 * i + 3];
    assert_eq!(row(5), row(cloud.len() - 4));
}

#[test]
fn what_a_folder_holds_already_stays_as_it_was() {
    let place = Workplace::new();
    place.write_folder("folder", &house());
    let [coords, normals] = ["folder/coords.npy", "folder/normals.npy"].map(|name| place.bytes(name));
    place.summary("balls folder -o folder");
    assert!(coords == place.bytes("folder/coords.npy"), "coordinates in f64 would lose their last digits in f32");
    assert!(normals == place.bytes("folder/normals.npy"));
    place.summary("normals folder --neighbors 10 -o folder");
    assert!(coords == place.bytes("folder/coords.npy"));
}

#[test]
fn normals_of_a_folder_are_estimated_even_where_it_has_some() {
    let place = Workplace::new();
    let cloud = house();
    place.write_folder("folder", &cloud);
    let given = place.bytes("folder/normals.npy");
    place.summary("normals folder --neighbors 10 -o folder");
    let (shape, normals) = place.npy::<f32>("folder/normals.npy");
    assert_eq!(shape, [cloud.len() as u64, 3]);
    assert_ne!(given, place.bytes("folder/normals.npy"));
    let truth = cloud.attributes.normals.unwrap();
    let close = truth.iter().zip(normals.chunks_exact(3)).filter(|(t, n)| {
        // within 10 degrees, up to sign: points beside an edge see both faces
        (t[0] * n[0] + t[1] * n[1] + t[2] * n[2]).abs() > 0.985
    });
    let share = close.count() as f64 / truth.len() as f64;
    assert!(share > 0.7, "{share}");
}

#[test]
fn normals_then_balls_is_the_way_of_masbcpp_on_a_folder_without_normals() {
    let place = Workplace::new();
    let mut cloud = house();
    cloud.attributes.normals = None;
    place.write_folder("folder", &cloud);
    place.summary("normals folder --neighbors 10 -o folder");
    place.summary("balls folder -o folder");
    assert_eq!(place.npy::<i32>("folder/ma_qidx_in.npy").0, [cloud.len() as u64]);
}

#[test]
fn a_row_that_is_not_finite_is_refused_instead_of_shifting_all_after_it() {
    let place = Workplace::new();
    place.write_folder("folder", &house());
    place.write_targets("folder/coords.npy", &[[0.0, 0.0, 0.0], [f64::NAN, 0.0, 0.0], [1.0, 1.0, 1.0]]);
    std::fs::remove_file(place.path("folder/normals.npy")).unwrap();
    for arguments in ["balls folder -o out", "normals folder -o out"] {
        place.refusal(1, arguments, &["coords.npy", "1 rows", "not finite"]);
    }
    assert_eq!(place.names(), ["folder"]);
}

#[test]
fn nan_marks_exactly_the_balls_that_never_shrank() {
    let place = Workplace::new();
    place.write_folder("folder", &house());
    place.summary("balls folder -o plain");
    place.summary("balls folder --nan -o marked");
    let mut never_shrunk = 0;
    for side in ["in", "out"] {
        let coords = |folder: &str| place.npy::<f32>(&format!("{folder}/ma_coords_{side}.npy")).1;
        let touch = place.npy::<i32>(&format!("marked/ma_qidx_{side}.npy")).1;
        for ((plain, marked), touch) in coords("plain").chunks(3).zip(coords("marked").chunks(3)).zip(touch) {
            if touch == -1 {
                never_shrunk += 1;
                assert!(marked.iter().all(|v| v.is_nan()) && plain.iter().all(|v| v.is_finite()));
            } else {
                assert_eq!(plain, marked);
            }
        }
    }
    assert!(never_shrunk > 0, "flat ground has balls above it that never shrink");
}

#[test]
fn thinning_depends_on_the_seed_alone() {
    let place = Workplace::new();
    let n = house().len();
    place.write_folder("folder", &house());
    for (seed, out) in [(1, "a"), (2, "b"), (2, "c")] {
        let summary = place.summary(&format!("balls folder --simplify 0.4 --seed {seed} -o {out}"));
        let kept = summary["thinning_kept_percent"].as_f64().unwrap();
        assert!(kept > 0.0 && kept < 100.0, "{kept}");
    }
    let (shape, sizes) = place.npy::<f32>("a/lfs.npy");
    assert_eq!(shape, [n as u64]);
    assert!(sizes.iter().all(|&s| s > 0.0));
    let [a, b, c] = ["a", "b", "c"].map(|out| place.npy::<bool>(&format!("{out}/decimate_lfs.npy")).1);
    assert_eq!(a.len(), n);
    assert_ne!(a, b);
    assert_eq!(b, c);
    assert_eq!(place.bytes("a/lfs.npy"), place.bytes("b/lfs.npy"));
}

#[test]
fn a_folder_at_projected_coordinates_gives_the_balls_of_one_near_zero() {
    let place = Workplace::new();
    let mut near = house();
    near.frame.origin = [0.0; 3];
    place.write_folder("near", &near);
    place.write_folder("far", &house());
    let radii = ["near", "far"].map(|name| {
        let out = format!("{name}.npz");
        // pruning of carved balls goes by blocks of the reference system, which these two do not share
        place.summary(&format!("balls {name} --method tau -o {out}"));
        (place.npz::<f32>(&out, "radii"), place.npz::<u32>(&out, "touch"))
    });
    assert!(radii[0] == radii[1], "coordinates in f64 lose nothing at a large offset");
    // the folder's own layout is f32: centres are rounded to 2^-6 m at 446 km, and no further
    place.summary("balls near -o near-out");
    place.summary("balls far -o far-out");
    assert_eq!(place.bytes("near-out/ma_qidx_in.npy"), place.bytes("far-out/ma_qidx_in.npy"));
    let [near, far] = ["near", "far"].map(|n| place.npy::<f32>(&format!("{n}-out/ma_coords_in.npy")).1);
    for (i, (near, far)) in near.iter().zip(&far).enumerate() {
        let expected = f64::from(*near) + [EAST, NORTH, 0.0][i % 3];
        assert!((f64::from(*far) - expected).abs() <= 1.0 / 64.0, "{far} for {expected}");
    }
}

/// Share of the balls that are the same: centres to a millimetre (NaN equals NaN), second points by number.
fn agreement(mine: &Path, theirs: &Path, side: &str) -> [f64; 2] {
    let coords = |folder: &Path| npy::<f32>(&folder.join(format!("ma_coords_{side}.npy"))).1;
    let touch = |folder: &Path| npy::<i32>(&folder.join(format!("ma_qidx_{side}.npy"))).1;
    let (a, b) = (coords(mine), coords(theirs));
    assert_eq!(a.len(), b.len());
    let same = a.chunks(3).zip(b.chunks(3)).filter(|(a, b)| {
        let squares: f32 = a.iter().zip(*b).map(|(a, b)| (a - b).powi(2)).sum();
        squares.sqrt() < 1e-3 || (a[0].is_nan() && b[0].is_nan())
    });
    let same = same.count() as f64 / (a.len() / 3) as f64;
    let (a, b) = (touch(mine), touch(theirs));
    let same_touch = a.iter().zip(&b).filter(|(a, b)| a == b).count() as f64 / a.len() as f64;
    [same, same_touch]
}

#[test]
fn a_folder_gets_what_masbcpp_computes() {
    let Some(data) = shared_data("a_folder_gets_what_masbcpp_computes") else { return };
    let place = Workplace::new();
    for (case, setting, flags) in [
        ("houseL", "default", ""),
        ("houseL", "nan", "--nan"),
        ("houseL", "nodenoise", "--first-angle 0 --next-angle 0"),
        ("houseL", "strict", "--first-angle 75 --next-angle 40"),
        ("houseL", "r50", "--initial-radius 50"),
        ("houseL_dup", "default", ""),
    ] {
        let case = data.join("reference").join(case);
        let out = place.path("out");
        place.summary_with(&format!("balls -o out {flags}"), &[case.to_str().unwrap()]);
        for side in ["in", "out"] {
            let [centers, touch] = agreement(&out, &case.join(setting), side);
            // two other programs that repeat masbcpp reach 99.92 %: the rest are ties broken by the last bit, of which
            // there are more where no ball is ever refused
            let min = if setting == "nodenoise" { 0.997 } else { 0.999 };
            assert!(centers >= min, "{}: {setting} {side}: centres {centers}", case.display());
            // of duplicates, either may be named as second point
            let min = if case.ends_with("houseL_dup") { 0.0 } else { min };
            assert!(touch >= min, "{}: {setting} {side}: second points {touch}", case.display());
        }
    }
}
