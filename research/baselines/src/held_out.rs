//! How methods answer what pulses know that were kept from them ([`belvedere::apps::held_out`]).

use belvedere::Result;
pub use belvedere::apps::held_out::{ErrorTally, HeldOut, HeldOutPairs, HeldOutParams, MetSurface, split};
use belvedere::query::{Answer, Viewer, Visibility};

/// How a method does on pulses held out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HeldOutScore {
    /// Free paths called blocked.
    pub false_blocked: ErrorTally,
    /// Those to ground or water.
    pub false_blocked_ground: ErrorTally,
    /// Those to buildings.
    pub false_blocked_building: ErrorTally,
    /// Those to anything else.
    pub false_blocked_other: ErrorTally,
    /// Places behind last returns called visible, by depth.
    pub false_visible: Vec<FalseVisible>,
}

/// Places called visible that lie behind a last return.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FalseVisible {
    /// How far behind, metres.
    pub depth: f64,
    /// Behind ground or water.
    pub ground: ErrorTally,
    /// Behind buildings.
    pub building: ErrorTally,
    /// Behind anything else, mostly trees.
    pub other: ErrorTally,
}

/// How `method`, built from [`HeldOut::kept`] alone, answers what the pulses held out know.
///
/// # Errors
/// What the method returns; those that know no [`Viewer::Each`] fail with [`belvedere::Error::UnsupportedViewer`],
/// those that answer for points of their own only with [`belvedere::Error::UnsupportedTargets`].
pub fn score(method: &dyn Visibility, held_out: &HeldOut) -> Result<HeldOutScore> {
    let mut score = HeldOutScore::default();
    for (answer, surface) in answers(method, &held_out.free)? {
        score.false_blocked.count(answer, Answer::Blocked);
        let of_surface = match surface {
            MetSurface::Ground => &mut score.false_blocked_ground,
            MetSurface::Building => &mut score.false_blocked_building,
            MetSurface::Other => &mut score.false_blocked_other,
        };
        of_surface.count(answer, Answer::Blocked);
    }
    for (depth, pairs) in &held_out.behind {
        let [ground, building, other] = [ErrorTally::default(); 3];
        let mut at_depth = FalseVisible { depth: *depth, ground, building, other };
        for (answer, surface) in answers(method, pairs)? {
            match surface {
                MetSurface::Ground => at_depth.ground.count(answer, Answer::Visible),
                MetSurface::Building => at_depth.building.count(answer, Answer::Visible),
                MetSurface::Other => at_depth.other.count(answer, Answer::Visible),
            }
        }
        score.false_visible.push(at_depth);
    }
    Ok(score)
}

fn answers<'a>(
    method: &dyn Visibility,
    pairs: &'a HeldOutPairs,
) -> Result<impl Iterator<Item = (Answer, MetSurface)> + use<'a>> {
    let answers = method.visible(Viewer::Each(&pairs.eyes), &pairs.targets)?;
    Ok(answers.into_iter().zip(pairs.surfaces.iter().copied()))
}
