//! Viewsheds of carved balls, against the exact mesh of a small town.
#![allow(dead_code, reason = "the example uses more of it")]

#[path = "../../src/bin/viewsheds/judge.rs"]
mod judge;

use belvedere_scenes::Preset;
use judge::ViewshedTown;

#[test]
fn what_people_in_streets_see_is_what_the_mesh_lets_them_see() {
    let town = ViewshedTown::new(Preset::Town, 120.0, 1.0, 6, 11).unwrap();
    assert!(town.eyes.len() >= 4, "{}", town.eyes.len());
    // what blocks people's sight of the ground here and no pulse reaches: trunks, fences and arcades
    for (height, min) in [(0.0, [0.65, 0.68]), (1.7, [0.75, 0.75])] {
        let score = town.judge(height).unwrap();
        println!(
            "{height} m: IoU {:.3?}, false-visible {:.4}, false-blocked {:.4}, {} unproven",
            score.ious(),
            score.false_visible_share(),
            score.false_blocked_share(),
            score.unproven
        );
        assert!(score.ious().iter().zip(min).all(|(iou, min)| *iou >= min), "{height}: {score:?}");
    }
}
