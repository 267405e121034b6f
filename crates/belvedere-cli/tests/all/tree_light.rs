//! Light through trees on the command line: below a crown, what arrives lies between shade and the open sky by the
//! share given.

use crate::common::{Workplace, at, column, house, remarks};
use belvedere::PointCloud;
use std::f64::consts::TAU;

const TREES: &str = "trees.laz --orient given --scene-config ../tau.json";
/// The house, and a crown of class 5.
fn house_and_tree(middle: [f32; 3], radius: f32) -> PointCloud {
    let mut cloud = house();
    let count = 800;
    let mut classes = vec![6_u8; cloud.len()];
    for (p, class) in cloud.positions.iter().zip(&mut classes) {
        if p[2] < 0.2 {
            *class = 2;
        }
    }
    let normals = cloud.attributes.normals.as_mut().unwrap();
    for i in 0..count {
        let up = 1.0 - 2.0 * (f64::from(i) + 0.5) / f64::from(count);
        let turn = TAU * (f64::from(i) * 0.618_033_988_75).fract();
        let along = (1.0 - up * up).sqrt();
        #[expect(clippy::cast_possible_truncation, reason = "local positions")]
        let normal = [along * turn.cos(), along * turn.sin(), up].map(|v| v as f32);
        cloud.positions.push([0, 1, 2].map(|axis| middle[axis] + radius * normal[axis]));
        normals.push(normal);
        classes.push(5);
    }
    cloud.attributes.classification = Some(classes);
    cloud
}

fn place() -> Workplace {
    let place = Workplace::new();
    place.write_cloud("trees.laz", &house_and_tree([10.0, 0.0, 5.0], 2.5));
    place.write_cloud("tall.laz", &house_and_tree([11.0, 0.0, 8.0], 4.0));
    place.write_cloud("house.laz", &house());
    // in the shade of the crown in summer, and in winter; north of the house, in the open
    let places = [[10.0, 4.0, 0.5], [10.0, 14.0, 0.5], [0.0, 7.0, 0.5], [0.0, -12.0, 0.5]];
    place.write_places("places.csv", &places);
    place
}

/// Columns of what a command finds at the places.
fn values(place: &Workplace, command: &str, flags: &str, names: &[&str]) -> Vec<Vec<f64>> {
    place.summary(&format!("{command} {flags} --targets places.csv -o out.csv"));
    names.iter().map(|name| column(place, "out.csv", name)).collect()
}

/// Each command with the days that count in leaf and bare, and the columns that light through crowns changes.
const COMMANDS: [(&str, &str, &str, &[&str]); 4] = [
    ("shadow", "--time 2026-07-01T13:40+02:00", "--time 2026-01-15T12:40+01:00", &["lit"]),
    (
        "sun-hours",
        "--date 2026-07-01 --time-step-min 30",
        "--date 2026-01-15 --time-step-min 30",
        &["sun_hours", "sun_share"],
    ),
    ("sky-view", "--leaves on", "--leaves off", &["sky_view_factor", "sky_openness"]),
    (
        "irradiance",
        "--clear-sky haurwitz --sun-cell-deg 6 --patch-division 1 --leaves on",
        "--clear-sky haurwitz --sun-cell-deg 6 --patch-division 1 --leaves off",
        &["kwh_m2", "beam_kwh_m2", "sky_kwh_m2"],
    ),
];

/// The flags of a question without those of leaves, which belong to seasons.
fn plain(flags: &str) -> &str {
    flags.split(" --leaves").next().unwrap().trim_start_matches("--leaves on").trim_start_matches("--leaves off")
}

#[test]
fn what_arrives_lies_between_shade_and_open_by_the_share() {
    let place = place();
    for (command, leaf, bare, names) in COMMANDS {
        let ask = |flags: &str, share: &str| {
            values(&place, &format!("{command} {TREES}"), &format!("{flags} {share}"), names)
        };
        let between = |found: &[Vec<f64>], low: &[Vec<f64>], high: &[Vec<f64>], share: f64| {
            for (column, name) in names.iter().enumerate() {
                for i in 0..4 {
                    let [found, low, high] = [found, low, high].map(|values| values[column][i]);
                    let expected = low + share * (high - low);
                    // digits written, and suns that seasons gather in directions of their own
                    let tolerance = 0.011 + if command == "irradiance" { 0.01 * high } else { 0.0 };
                    assert!((found - expected).abs() < tolerance, "{command} {name} {i}: {found} {expected}");
                }
            }
        };
        let (opaque, free) = (ask(plain(leaf), ""), ask(plain(leaf), "--through-trees 1"));
        between(&ask(plain(leaf), "--through-trees 0"), &opaque, &free, 0.0);
        between(&ask(plain(leaf), "--through-trees 0.25"), &opaque, &free, 0.25);
        // 3 % in leaf, half of it bare
        between(&ask(leaf, "--through-trees seasons"), &opaque, &free, 0.03);
        for (opaque, free) in opaque.iter().zip(&free) {
            assert!(
                free[0] > opaque[0] && opaque.iter().zip(free).all(|(a, b)| a <= b),
                "{command}: {opaque:?} {free:?}"
            );
        }
        let is_same = plain(leaf) == plain(bare);
        let (opaque, free) =
            if is_same { (opaque, free) } else { (ask(plain(bare), ""), ask(plain(bare), "--through-trees 1")) };
        assert!(free[0][1] > opaque[0][1], "{command}: {opaque:?} {free:?}");
        between(&ask(bare, "--through-trees seasons"), &opaque, &free, 0.5);
    }
}

#[test]
fn a_year_has_both_seasons() {
    let place = place();
    let energy = |flags: &str| {
        let usual = "--clear-sky haurwitz --sun-cell-deg 6 --patch-division 1 --months";
        let run = place.summary(&format!("irradiance {TREES} {usual} {flags} --targets places.csv -o out.csv"));
        let months = |month: u32| column(&place, "out.csv", &format!("kwh_m2_{month:02}"));
        (months(1), months(7), column(&place, "out.csv", "kwh_m2"), run)
    };
    let (january, july, year, run) = energy("--through-trees seasons");
    let (bare, ..) = energy("--through-trees seasons --leaves off");
    let (_, leaf, ..) = energy("--through-trees seasons --leaves on");
    for i in 0..4 {
        // directions that suns are gathered in differ by season, by less than a cell
        assert!((january[i] - bare[i]).abs() < 0.02 * bare[i] + 0.02, "{i}: {} {}", january[i], bare[i]);
        assert!((july[i] - leaf[i]).abs() < 0.02 * leaf[i] + 0.02, "{i}: {} {}", july[i], leaf[i]);
    }
    let [low, high] = ["on", "off"].map(|leaves| energy(&format!("--through-trees seasons --leaves {leaves}")).2[0]);
    assert!(low < year[0] && year[0] < high, "{low} {} {high}", year[0]);
    assert_eq!(run["trees"]["transmissivity_in_leaf"], 0.03);
    // the energy of the sky is that without trees
    let whole = |run: &serde_json::Value| run["radiation"]["global_kwh_m2"].as_f64().unwrap();
    assert!((whole(&run) - whole(&energy("").3)).abs() < 0.11);
    // sun hours of days on both sides of 7 April
    let hours =
        |flags: &str| values(&place, &format!("sun-hours {TREES} --time-step-min 30"), flags, &["sun_hours"]).remove(0);
    let both = hours("--from 2026-04-05 --to 2026-04-08 --through-trees seasons --sun-tolerance-deg 0");
    let parts = ["2026-04-05 --to 2026-04-06", "2026-04-07 --to 2026-04-08"]
        .map(|days| hours(&format!("--from {days} --through-trees seasons --sun-tolerance-deg 0")));
    for i in 0..4 {
        assert!((both[i] - f64::midpoint(parts[0][i], parts[1][i])).abs() < 2e-3, "{both:?} {parts:?}");
    }
    assert!(parts[0][0] > parts[1][0] + 0.3, "{parts:?}");
}

#[test]
fn planes_of_roofs_get_light_through_crowns() {
    let place = place();
    let energy = |flags: &str| {
        let usual = "--clear-sky haurwitz --sun-cell-deg 6 --patch-division 1";
        place.summary(&format!(
            "irradiance tall.laz --orient given --scene-config ../tau.json {usual} {flags} --planes roofs.csv"
        ));
        ["kwh_m2", "free_kwh_m2", "min_loss", "max_loss"].map(|name| column(&place, "roofs.csv", name))
    };
    let [opaque, .., opaque_loss, opaque_max] = energy("");
    let [quarter, ..] = energy("--through-trees 0.25");
    let [free, unshaded, loss, max] = energy("--through-trees 1");
    assert_eq!(opaque.len(), 2);
    for i in 0..2 {
        assert!(opaque[i] < free[i] && free[i] <= unshaded[i] + 0.1, "{opaque:?} {free:?}");
        assert!((quarter[i] - opaque[i] - 0.25 * (free[i] - opaque[i])).abs() < 0.15, "{quarter:?}");
        assert!(loss[i] < opaque_loss[i] && max[i] < opaque_max[i] && loss[i] <= max[i] + 1e-4);
    }
}

#[test]
fn what_cannot_be_is_refused_with_advice() {
    let place = place();
    for (command, flags, ..) in COMMANDS {
        let flags = plain(flags);
        for (trees, scene, words) in [
            ("--through-trees 1.5", TREES, "0 (opaque) to 1"),
            ("--through-trees -0.1", TREES, "0 (opaque) to 1"),
            ("--through-trees leaves", TREES, "seasons"),
            ("--through-trees 0.5 --leaves on", TREES, "--leaves needs"),
            ("--leaves off", TREES, "--leaves needs"),
            ("--through-trees pulses", TREES, "pulses in vegetation"),
            ("--through-trees seasons", "house.laz --orient given --scene-config ../tau.json", "vegetation"),
        ] {
            let run = place.run(&format!("{command} {scene} {flags} {trees} --targets places.csv -o no.csv"));
            assert!(run.status == 2 && run.stderr.contains(words), "{command} {trees}: {run:?}");
        }
    }
    assert!(!place.path("no.csv").exists());
    // commands that ask no pulses know no --unproven
    for command in ["sun-hours", "sky-view", "irradiance", "comfort", "envelope"] {
        place.refusal(2, &format!("{command} {TREES} --unproven report"), &["--unproven"]);
        assert!(place.run(&format!("help {command}")).stdout.contains("--shell"), "{command}");
    }
}

#[test]
fn a_horizon_below_a_crown_says_what_it_is() {
    let place = place();
    let horizon = |x: f64, y: f64| {
        let [x, y, _] = at(x, y, 0.0);
        let made = place.summary(&format!("horizon {TREES} --observer {x},{y} -o horizon.csv"));
        let is_said = remarks(&made).iter().any(|text| text.contains("straight above the observer"));
        (column(&place, "horizon.csv", "elevation").iter().all(|v| *v > 89.9), is_said)
    };
    assert_eq!(horizon(10.0, 0.0), (true, true));
    assert_eq!(horizon(10.0, 6.0), (false, false));
}
