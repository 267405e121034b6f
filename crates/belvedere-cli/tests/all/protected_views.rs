//! Protected views on the command line.

use crate::common::{Workplace, at};

const BALLS: &str = "--orient given --scene-config ../tau.json";

/// Creates a house in a field, and a wall of 10 m by 6 m as a mesh 30 m east of it that faces west, 3 m above the
/// ground.
fn place() -> Workplace {
    let place = Workplace::with_field();
    let corners = [[30.0, -5.0, 3.0], [30.0, 5.0, 3.0], [30.0, 5.0, 9.0], [30.0, -5.0, 9.0]];
    let vertex = |&[x, y, z]: &[f64; 3]| {
        let [x, y, z] = at(x, y, z);
        format!("v {x} {y} {z}\n")
    };
    let vertices: String = corners.iter().map(vertex).collect();
    place.write("wall.obj", format!("{vertices}o wall\nf 1 4 3 2\n"));
    place
}

fn coordinates(place: [f64; 3]) -> String {
    at(place[0], place[1], place[2]).map(|v| v.to_string()).join(",")
}

#[test]
fn the_view_of_a_wall_limits_what_may_be_built_before_it_and_not_behind_the_house() {
    let place = place();
    let eye = coordinates([10.0, 0.0, 1.7]);
    let run = place.summary(&format!(
        "protected-view house.laz {BALLS} --targets wall.obj --observer {eye} --cell 1 -o limits.npy -o limits.tif -o limits.png --tops tops.npy"
    ));
    let view = &run["protected_view"];
    assert_eq!((&view["lines_blocked"], &view["lines_not_tested"]), (&0.into(), &0.into()), "{run}");
    let (shape, heights) = place.npy::<f32>("limits.npy");
    let (_, tops) = place.npy::<f32>("tops.npy");
    let limited: Vec<f32> = heights.iter().copied().filter(|v| v.is_finite()).collect();
    assert_eq!(view["cells_limited"], limited.len());
    // a fan of 20 m by 10 m at its end, and the cells that its sides cross
    assert!((95..150).contains(&limited.len()), "{}", limited.len());
    // the plane from 1.7 m at the eye to 3 m at the lower edge of the wall; the ground is flat to a few centimetres
    let (min, max) = limited.iter().fold((f32::INFINITY, 0.0_f32), |(a, b), &v| (a.min(v), b.max(v)));
    assert!((min - 1.7).abs() < 0.15 && (max - 3.0).abs() < 0.15, "{min} {max}");
    assert_eq!(shape.iter().product::<u64>() as usize, tops.len());
    // the ground is flat at height 0, so that heights above it and heights of tops are the same
    let is_same = |(top, height): (&f32, &f32)| top.is_nan() && height.is_nan() || (top - height).abs() < 0.1;
    assert!(tops.iter().zip(&heights).all(is_same));
    assert!(place.bytes("limits.png").starts_with(b"\x89PNG") && place.bytes("limits.tif").starts_with(b"II"));

    // from behind the house most of the wall is hidden, and less is protected; from a file with a height above the
    // ground
    let [x, y, _] = at(-20.0, 0.0, 0.0);
    place.write("eyes.csv", format!("x,y,height\n{x},{y},1.7\n"));
    let hidden = place.summary(&format!(
        "protected-view house.laz {BALLS} --targets wall.obj --observers eyes.csv --cell 1 -o b.npy"
    ));
    assert!(hidden["protected_view"]["lines_blocked"].as_u64().unwrap() > 100, "{hidden}");
    // the wall seen from its back
    let eye = coordinates([40.0, 0.0, 1.7]);
    let none = place
        .summary(&format!("protected-view house.laz {BALLS} --targets wall.obj --observer {eye} --cell 1 -o c.npy"));
    assert_eq!(none["protected_view"]["cells_limited"], 0);
    assert!(none["remarks"].to_string().contains("nothing is protected"), "{none}");
}

#[test]
fn protected_views_refuse_what_they_cannot_do() {
    let place = place();
    let eye = coordinates([10.0, 0.0, 1.7]);
    let views = format!("protected-view house.laz {BALLS} --observer {eye}");
    place.refusal(2, &format!("{views} -o a.tif"), &["--targets"]);
    place.refusal(2, &format!("{views} --targets wall.obj -o a.csv"), &["-o", ".npy"]);
    place.refusal(2, &format!("{views} --targets wall.obj -o a.tif --tops a.png"), &["--tops"]);
    place.refusal(2, &format!("{views} --targets wall.obj -o a.tif --cell 1000"), &["--cell"]);
    place.refusal(1, &format!("{views} --targets wall.obj --object barn -o a.tif"), &["no object barn"]);
    let far = coordinates([5000.0, 0.0, 1.7]);
    let words = ["no observer is left"];
    place.refusal(1, &format!("protected-view house.laz {BALLS} --observer {far} --targets wall.obj -o a.tif"), &words);
}
