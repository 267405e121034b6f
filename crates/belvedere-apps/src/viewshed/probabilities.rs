//! How likely observers see targets.

use super::Observer;
use belvedere_core::query::{Certainty, MedialScene, Viewer};
use belvedere_data::Result;
use belvedere_data::control::Control;

/// How likely targets are seen.
#[derive(Clone, Debug, PartialEq)]
pub struct SeenProbabilities {
    /// Expected number of observers that see each target: of one observer the probability that it does, (M); NaN where
    /// no observer has an answer.
    pub expected: Vec<f32>,
    /// How many observers see each target with at least the certainty that was wanted, and how many do not see it with
    /// that certainty, (M).
    pub certain: Option<[Vec<u32>; 2]>,
    /// How many observers have an answer for each target, (M).
    pub answered: Vec<u32>,
}

/// How likely each of `observers` sees each of `targets`, (M, 3) local metres; progress counts observers times targets.
/// An observer whose eye is not finite has no answer, nor has one for a target that it is not turned to, or that lies
/// beyond the cloud.
///
/// # Errors
/// Those of [`MedialScene::visible_probabilities`].
pub fn seen_probabilities(
    scene: &MedialScene,
    observers: &[Observer],
    targets: &[[f32; 3]],
    certainty: Option<Certainty>,
    control: &Control<'_>,
) -> Result<SeenProbabilities> {
    let nobody = vec![0; targets.len()];
    let mut found = SeenProbabilities {
        expected: vec![f32::NAN; targets.len()],
        certain: certainty.map(|_| [nobody.clone(), nobody.clone()]),
        answered: nobody,
    };
    for observer in observers.iter().filter(|observer| observer.eye.iter().all(|v| v.is_finite())) {
        let probabilities = scene.visible_probabilities(Viewer::Eye(observer.eye), targets, control)?;
        for (row, (&probability, target)) in probabilities.iter().zip(targets).enumerate() {
            if probability.is_nan() || !observer.limits.allow(observer.eye, target.map(f64::from)) {
                continue;
            }
            let expected = &mut found.expected[row];
            *expected = if expected.is_nan() { probability } else { *expected + probability };
            found.answered[row] += 1;
            if let (Some([seen, hidden]), Some(certainty)) = (&mut found.certain, certainty)
                && !certainty.is_missed_by(probability)
            {
                let counts = if probability > 0.5 { seen } else { hidden };
                counts[row] += 1;
            }
        }
    }
    Ok(found)
}
