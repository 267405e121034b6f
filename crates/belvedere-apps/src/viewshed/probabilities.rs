//! Probabilities that observers see targets.

use super::Observer;
use belvedere_core::query::{Certainty, MedialScene, Viewer};
use belvedere_data::Result;
use belvedere_data::control::Control;

/// Probabilities that targets are visible.
#[derive(Clone, Debug, PartialEq)]
pub struct SeenProbabilities {
    /// Expected number of observers that see each target: of one observer the probability that it does, (M); NaN where
    /// no observer has an answer.
    pub expected: Vec<f32>,
    /// Number of their answers below the wanted certainty or unknown, (M); NaN if no observer has an answer.
    pub uncertain: Option<Vec<f32>>,
}

/// Computes the probability that each of `observers` sees each of `targets`, (M, 3) local metres; progress counts
/// observers times targets. There is no answer for an observer whose eye is not finite. Neither is there one for a
/// target that it is not turned to, or that lies beyond the cloud.
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
    let nobody = vec![f32::NAN; targets.len()];
    let mut found = SeenProbabilities { uncertain: certainty.map(|_| nobody.clone()), expected: nobody };
    for observer in observers.iter().filter(|observer| observer.eye.iter().all(|v| v.is_finite())) {
        let probabilities = scene.visible_probabilities(Viewer::Eye(observer.eye), targets, control)?;
        for (row, (&probability, target)) in probabilities.iter().zip(targets).enumerate() {
            if !observer.limits.allow(observer.eye, target.map(f64::from)) {
                continue;
            }
            if probability.is_nan() {
                // what nothing tells is uncertain
                if let Some(uncertain) = &mut found.uncertain
                    && scene.is_unknown(observer.eye, *target)
                {
                    add_known(&mut uncertain[row], 1.0);
                }
                continue;
            }
            add_known(&mut found.expected[row], probability);
            if let (Some(uncertain), Some(certainty)) = (&mut found.uncertain, certainty) {
                add_known(&mut uncertain[row], f32::from(u8::from(certainty.is_missed_by(probability))));
            }
        }
    }
    Ok(found)
}

/// Adds to a sum that is NaN as long as nothing was added.
pub fn add_known(sum: &mut f32, value: f32) {
    *sum = if sum.is_nan() { value } else { *sum + value };
}
