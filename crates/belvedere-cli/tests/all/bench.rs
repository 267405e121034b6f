//! `belvedere bench`: stages and their times.

use crate::common::Workplace;

#[test]
fn stages_of_a_simulated_town_and_of_a_cloud_are_measured() {
    let place = Workplace::new();
    let of_town = place.summary("bench --extent 60");
    place.summary("simulate town -o town --extent 60 --density 6");
    let of_cloud = place.summary("bench town/cloud.laz -- --orient trajectory=town/trajectory.csv");
    for found in [&of_town, &of_cloud] {
        let number = |name: &str| found[name].as_f64().unwrap();
        let points = number("points");
        assert!(points > 10_000.0 && number("elapsed_seconds") > 0.0, "{found}");
        let stages = found["stage"].as_array().unwrap();
        let seconds: Vec<f64> = stages.iter().map(|stage| stage["seconds"].as_f64().unwrap()).collect();
        assert!(seconds.is_sorted_by(|a, b| a >= b), "{seconds:?}");
        // each is rounded to a millisecond, the sum to a hundredth
        assert!((seconds.iter().sum::<f64>() - number("elapsed_seconds")).abs() < 0.03, "{found}");
        for name in ["reading", "carving balls", "testing sun", "writing"] {
            let stage = stages.iter().find(|stage| stage["name"] == name).unwrap_or_else(|| panic!("{name}: {found}"));
            let [seconds, of_point] = ["seconds", "us_per_point"].map(|key| stage[key].as_f64().unwrap());
            assert!((of_point - 1e6 * seconds / points).abs() < 1e-3, "{stage}");
        }
        assert!(found["machine"]["threads"].as_u64().unwrap() > 0);
    }
    // what was measured leaves nothing behind: neither a scene nor a map
    assert_eq!(place.summary("cache")["scenes"], 0);
    assert!(!of_town["stage"].as_array().unwrap().iter().any(|stage| stage["name"] == "total"));
}

#[test]
fn what_cannot_be_measured_is_an_error() {
    let place = Workplace::new();
    for (command, what) in [
        ("bench missing.laz", "missing.laz"),
        ("bench --extent 5", "--extent"),
        ("bench missing.laz -- --no-such-flag", "--no-such-flag"),
    ] {
        let run = place.run(command);
        assert!(run.status != 0 && run.stderr.contains(what), "{command}: {run:?}");
    }
}
