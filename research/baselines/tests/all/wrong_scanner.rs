//! What it costs carved balls that the scanner is known badly, or not at all, and that normals come with the wrong
//! sign: on a simulated town, against its exact mesh.

use crate::common::place::TownWithLight;
use belvedere::control::Control;
use belvedere::medial::{CarvedInput, CarvedParams, carved_balls};
use belvedere::neighbors::NeighborIndex;
use belvedere::normals::estimate::{Neighborhood, estimate};
use belvedere::normals::{Orientation, OrientedCloud, orient};
use belvedere::pulses::{FreeSegmentParams, FreeSegments, VerticalParams, vertical_pulses};
use belvedere::query::{BlockRule, MedialScene, Viewer, Visibility};
use belvedere_baselines::agreement::{Rate, TruthCounts};
use belvedere_baselines::medial::DEPTH_BIAS;
use belvedere_scenes::Preset;

impl TownWithLight {
    /// Percent of answers that are right, balanced over lit and shaded places, mean over the suns, for a scanner at
    /// `scanner` and normals that `turn` has had its way with after pulses gave them their signs.
    fn score(
        &self,
        scanner: &[[f32; 3]],
        before: impl Fn([f32; 3]) -> [f32; 3],
        turn: impl Fn(OrientedCloud) -> OrientedCloud,
    ) -> f64 {
        let index = NeighborIndex::new(&self.cloud.positions, &Control::none()).unwrap();
        let mut normals =
            estimate(&self.cloud.positions, &index, Neighborhood::Fixed { k: 16 }, &Control::none()).unwrap();
        normals.vectors.iter_mut().for_each(|normal| *normal = before(*normal));
        let (oriented, _) = orient(&self.cloud, normals, &Orientation::Pulses(scanner), &Control::none()).unwrap();
        let (free_segments, _) =
            FreeSegments::of_cloud(&self.cloud, scanner, &FreeSegmentParams::default(), &Control::none()).unwrap();
        let oriented = turn(oriented);
        let attributes = &self.cloud.attributes;
        let input = CarvedInput {
            oriented: &oriented,
            measured: oriented.positions(),
            index: &index,
            attributes,
            free_segments: &free_segments,
            pulses: None,
            statistics: None,
        };
        let balls = carved_balls(&input, &CarvedParams::default(), &Control::none()).unwrap().balls;
        let blocking = BlockRule { bias: DEPTH_BIAS, ..BlockRule::default() };
        let scene = MedialScene::new(&balls, &blocking).unwrap();
        let balanced = |(direction, visible): &([f64; 3], Vec<bool>)| {
            let answers = scene.visible(Viewer::Direction(*direction), &self.targets).unwrap();
            let mut counts = TruthCounts::default();
            visible.iter().zip(answers).for_each(|(&visible, answer)| counts.add(visible, answer));
            100.0 * Rate::Balanced.of(&counts).unwrap()
        };
        self.suns.iter().map(balanced).sum::<f64>() / self.suns.len() as f64
    }
}

fn as_it_is(oriented: OrientedCloud) -> OrientedCloud {
    oriented
}

fn all_flipped(oriented: &OrientedCloud) -> OrientedCloud {
    let normals = oriented.normals().iter().map(|n| n.map(|v| -v)).collect();
    let (quality, confidence) = (oriented.quality().to_vec(), oriented.confidence().to_vec());
    OrientedCloud::new(oriented.positions().to_vec(), normals, quality, confidence).unwrap()
}

#[test]
fn a_scanner_known_badly_and_normals_turned_wrongly_cost_less_than_a_point() {
    let place = TownWithLight::new(Preset::Town);
    let same = |normal: [f32; 3]| normal;
    let exact = place.score(&place.scanner, same, as_it_is);
    // lateral error at an angle to the flight, and height
    for [aside, up] in [[5.0, 10.0], [20.0, 40.0]] {
        let moved: Vec<[f32; 3]> =
            place.scanner.iter().map(|s| [s[0] + 0.6 * aside, s[1] + 0.8 * aside, s[2] + up]).collect();
        let score = place.score(&moved, same, as_it_is);
        assert!((score - exact).abs() < 1.0, "{aside}/{up} m: {score} of {exact}");
    }
    // pulses turn them whatever they were
    let flipped = place.score(&place.scanner, |normal| normal.map(|v| -v), as_it_is);
    assert!((flipped - exact).abs() < 1.0, "{flipped} of {exact}");
    let wrong = place.score(&place.scanner, same, |oriented| all_flipped(&oriented));
    // by more than what is tolerated above, so that the test would notice
    assert!(wrong < exact - 1.0, "turning matters: {wrong} of {exact}");
}

#[test]
fn pulses_that_are_merely_assumed_to_be_vertical_are_worth_carving_with() {
    let place = TownWithLight::new(Preset::Town);
    let same = |normal: [f32; 3]| normal;
    let exact = place.score(&place.scanner, same, as_it_is);
    let assumed = vertical_pulses(&place.cloud.positions, &VerticalParams::default(), &Control::none()).unwrap();
    let vertical = place.score(&assumed, same, as_it_is);
    // on the towns of the rules' table they cost streets nothing; one town is not their mean
    assert!(vertical > exact - 2.0, "{vertical} of {exact}");
}
