//! Water returns no pulses, and balls do not reach over it: on a simulated town with canals, against its exact mesh.

use crate::common::place::TownWithLight;
use belvedere::medial::{CarvedParams, Rule};
use belvedere::model::BallParams;
use belvedere::query::{Viewer, Visibility};
use belvedere_baselines::MethodInput;
use belvedere_baselines::agreement::{Rate, TruthCounts};
use belvedere_baselines::medial::{MedialBaseline, MedialParams, Outward};
use belvedere_baselines::simulated::without_returns_from_water;
use belvedere_scenes::Preset;

#[test]
fn canals_hide_few_suns_that_pedestrians_see() {
    let place = TownWithLight::new(Preset::OldTown);
    let (cloud, scanner) = without_returns_from_water(&place.cloud, &place.scanner);
    let errors = |carving: CarvedParams| {
        let params = MedialParams { making: BallParams::Carved(carving), ..MedialParams::carved() };
        let survey = MethodInput { cloud: &cloud, scanner: &scanner, models: &[] };
        let model = MedialBaseline::new(&survey, Outward::Survey, &params).unwrap();
        let mut counts = TruthCounts::default();
        for (direction, visible) in &place.suns {
            let answers = model.visible(Viewer::Direction(*direction), &place.targets).unwrap();
            visible.iter().zip(answers).for_each(|(&visible, answer)| counts.add(visible, answer));
        }
        [Rate::FalseBlocked, Rate::FalseVisible].map(|rate| 100.0 * rate.of(&counts).unwrap())
    };
    let [blocked, seen] = errors(CarvedParams::default());
    let [blocked_without, seen_without] = errors(CarvedParams::default().without(Rule::DataVoids));
    // 2.2 of 5.2 % when the rule was made; on the towns of its page 4.8 of 8.3 %. Since walls cap the balls that
    // reached over canals most, 2.6 of 3.3 %
    assert!(blocked < 0.85 * blocked_without, "{blocked} of {blocked_without} % without the rule");
    // 0.1 % more on both
    assert!(seen < seen_without + 0.2, "{seen} of {seen_without} % without the rule");
}
