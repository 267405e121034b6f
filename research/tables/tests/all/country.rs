//! The simulated country of docs/scale.md: nothing is lost, and no time but what must be.

#[path = "../../src/bin/country/simulation.rs"]
mod simulation;

use simulation::{Cluster, Country, simulate};

const COUNTRY: Country =
    Country { plans: 250, tiles_per_plan: 4096, seconds: [110.0, 42.0], ball_bytes: 135e6, bad_share: 0.0 };
const CLUSTER: Cluster =
    Cluster { workers: 1000, hours_to_loss: f64::INFINITY, seconds_to_replace: 600.0, tries: 3, max_open: 4 };

#[test]
fn a_million_tiles_are_computed_once_in_the_time_that_their_work_takes() {
    let outcome = simulate(&COUNTRY, &CLUSTER);
    assert_eq!(outcome.records.len(), 1_024_000);
    assert!(outcome.records.iter().all(|&records| records == [1, 1]));
    assert_eq!((outcome.wasted, outcome.losses, outcome.named), (0.0, 0, 0));
    let min = outcome.recorded / 1000.0;
    // a list of tasks without order between them ends one longest task after that at the latest (Graham 1966); here
    // workers wait for the longest task at the end of the stages of the last two plans
    assert!((min..min + 4.0 * 5.0 * 110.0).contains(&outcome.elapsed), "{} of {min}", outcome.elapsed);
    let all_balls = 1_024_000.0 * COUNTRY.ball_bytes;
    assert!(outcome.max_ball_bytes <= all_balls * 4.0 / 250.0, "{}", outcome.max_ball_bytes);
}

#[test]
fn whatever_is_lost_every_tile_is_recorded_once_or_named() {
    let country = Country { bad_share: 1e-3, plans: 60, ..COUNTRY };
    let cluster = Cluster { hours_to_loss: 2.0, ..CLUSTER };
    let outcome = simulate(&country, &cluster);
    let named = outcome.records.iter().filter(|records| records[0] == 0).count();
    assert!(outcome.records.iter().all(|records| records[0] <= 1 && records[1] == 1));
    assert_eq!(named, outcome.named);
    // 245 760 tiles, one in a thousand: 246, give or take five standard deviations
    assert!((168..324).contains(&named), "{named}");
    // a processor works two hours on average until it is lost
    let expected = (outcome.recorded + outcome.wasted) / 7200.0;
    assert!((0.9..1.1).contains(&(outcome.losses as f64 / expected)), "{} losses", outcome.losses);
    // half a tile of about 90 seconds, weighted by how long tiles take, is lost with each, and bad tiles three times
    assert!((0.003..0.02).contains(&(outcome.wasted / outcome.recorded)), "{}", outcome.wasted / outcome.recorded);
    assert_eq!(simulate(&country, &cluster), outcome, "the same once more");
}
