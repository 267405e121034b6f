//! Sun hours and sky views of carved balls, against the exact mesh of a small town.
#![allow(dead_code, reason = "the example uses more of it")]

#[path = "../../src/bin/sun_and_sky/judge.rs"]
mod judge;

use belvedere::query::BlockRule;
use belvedere_scenes::Preset;
use judge::LightTown;
use judge::score::LightDirections;

#[test]
fn sun_hours_and_sky_views_are_those_of_the_mesh() {
    // 21 June at 52° N in steps of twenty minutes
    let light = LightDirections::of_day(52f64.to_radians(), 23.44f64.to_radians(), 20.0, 145).unwrap();
    let town = LightTown::new(Preset::OldTown, 120.0, 1.0, 11).unwrap();
    let ground = town.ground_cells(0.1, 1000, &light);
    let roofs = town.roofs(1000, &light);
    assert!(ground.len() > 900 && roofs.len() > 900, "{} {}", ground.len(), roofs.len());
    // measured 0.24 and 0.25 h, 0.012 and 0.014; the room is for changes of the last bits and of a rule or two, not of
    // the method
    for (what, places, hours, sky) in [("ground", &ground, 0.28, 0.016), ("roofs", &roofs, 0.28, 0.016)] {
        let score = town.judge(places, &light, 0.0, &BlockRule::carved()).unwrap();
        println!("{what}: {score:.4?}");
        // some places have sun all day and others little: the truth tells something
        assert!(score.sun[0] > 5.0 && score.sun[0] < 16.0, "{what}: {score:?}");
        assert!(score.sun[1] < hours, "{what}: {score:?}");
        assert!(score.factor[1] < sky && score.openness[1] < sky, "{what}: {score:?}");
    }
    // what stands close to the ground in the shade of it: a lift of half a metre adds sun that is not there
    let lifted = town.judge(&roofs, &light, 0.5, &BlockRule::carved()).unwrap();
    assert!(lifted.sun[2] > 3.0 * lifted.sun[3], "{lifted:?}");
}
