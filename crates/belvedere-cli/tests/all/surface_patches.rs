//! Ball files with patches of surfaces: what `info` counts, and what a line of sight says that blocks it.

use crate::common::{Workplace, at};
use belvedere::io::{read_balls, write_balls};
use belvedere::{PatchKind, SurfacePatches};

#[test]
fn patches_of_a_ball_file_are_counted_and_named_where_they_block() {
    let place = Workplace::with_house();
    place.summary("balls house.laz --orient given --without planes -o bare.npz");
    // a wall of 20 by 5 m east of the house, which faces east
    let mut parts = read_balls(&place.path("bare.npz")).unwrap();
    let local = |x: f64, y: f64, z: f64| {
        let file = at(x, y, z);
        std::array::from_fn(|i| (file[i] - parts.frame.origin[i]) as f32)
    };
    let [a, b, c, d] =
        [local(10.0, -10.0, 0.0), local(10.0, 10.0, 0.0), local(10.0, 10.0, 5.0), local(10.0, -10.0, 5.0)];
    let mut patches = SurfacePatches::default();
    patches.push([a, b, c], PatchKind::Wall);
    patches.push([a, c, d], PatchKind::Wall);
    parts.patches = patches;
    for name in ["walled.npz", "walled.laz", "walled.ply"] {
        write_balls(&place.path(name), &parts).unwrap();
        let info = place.summary(&format!("info {name}"));
        assert_eq!(info["surface_patches"]["triangles"], 2, "{name} {info}");
        assert_eq!(info["surface_patches"]["wall"]["area_m2"], 100.0, "{name} {info}");
        let typed = |[x, y, z]: [f64; 3]| format!("{x},{y},{z}");
        let ends = format!("--observer {} --target {}", typed(at(13.0, 1.0, 2.0)), typed(at(7.5, 1.0, 2.0)));
        let bare = place.summary(&format!("line-of-sight bare.npz {ends}"));
        assert!(bare["line"]["block_surface"].is_null() && bare["line"]["answer"] != "blocked", "{bare}");
        let run = place.run(&format!("line-of-sight {name} {ends}"));
        assert!(run.status == 0 && run.stdout.contains("a surface of the survey (wall)"), "{run:?}");
        let blocked = place.summary(&format!("line-of-sight {name} {ends} -o lines.csv"));
        assert_eq!(blocked["line"]["block_surface"], "wall", "{blocked}");
        assert_eq!(blocked["lines_of_sight"]["patches"], 2, "{blocked}");
        let table = place.text("lines.csv");
        assert!(table.lines().next().unwrap().contains("block_surface") && table.contains("wall"), "{table}");
    }
    let none = place.summary("info bare.npz");
    assert_eq!(none["surface_patches"]["triangles"], 0, "{none}");
}
