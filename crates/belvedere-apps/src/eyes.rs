//! Observers that cannot look: eyes without ground below them, beside or below the cloud, or inside an obstacle.

use belvedere_core::ground::Ground;
use belvedere_core::query::{Coverage, MedialScene};
use belvedere_data::Result;
use belvedere_data::control::Control;
use belvedere_data::report::rounded;
use rayon::prelude::*;
use serde::Serialize;

/// Maximum depth of an eye below the ground, metres: the accuracy of points. In an obstacle it may lie as deep as balls
/// give way ([`MedialScene::is_inside_obstacle`]), since an eye on a wall or a roof is common.
const TOLERANCE: f64 = 0.2;

/// Why nobody can look from a place.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum EyeFault {
    /// It has no height, and no ground is known below it.
    NoGround,
    /// It lies beside the cloud.
    OutsideCloud,
    /// It lies on the map of the cloud, but below its lowest point or far above its highest.
    OutsideHeights,
    /// It lies so far below the ground, metres.
    BelowGround(f64),
    /// It lies so deep in an obstacle, metres.
    InsideObstacle(f64),
}

impl std::fmt::Display for EyeFault {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NoGround => f.write_str("there is no ground known below it; give its height as a third coordinate"),
            Self::OutsideCloud => f.write_str(
                "it is outside the cloud, and not in the air above all of it; is it in the coordinates of the cloud?",
            ),
            Self::OutsideHeights => f.write_str(
                "its height is below the cloud, or more than 10 km above it; leave it out for the height of the ground",
            ),
            Self::BelowGround(depth) => write!(f, "it is {depth:.2} m below the ground"),
            Self::InsideObstacle(depth) => write!(f, "it is inside an obstacle, {depth:.2} m deep"),
        }
    }
}

/// An eye that is skipped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkippedEye {
    /// Its row among the eyes, from 0.
    pub row: usize,
    /// Position, local metres; the height may be NaN.
    pub place: [f64; 3],
    /// Why it is skipped.
    pub fault: EyeFault,
}

/// Number of eyes that can look, and reasons of the others.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct EyesReport {
    /// Eyes that were given.
    pub count: usize,
    /// Eyes that were skipped.
    pub skipped: usize,
    /// Number skipped without known ground below.
    pub skipped_without_ground: usize,
    /// Number skipped beside or below the cloud.
    pub skipped_outside_cloud: usize,
    /// Number skipped below the ground.
    pub skipped_below_ground: usize,
    /// Number skipped inside an obstacle.
    pub skipped_inside_obstacle: usize,
    /// The eyes skipped.
    #[serde(skip)]
    pub faults: Vec<SkippedEye>,
}

impl EyesReport {
    /// `count` eyes that all look.
    #[must_use]
    pub fn none_skipped(count: usize) -> Self {
        Self { count, ..Self::default() }
    }
}

/// Finds the `eyes`, (N) local metres, that cannot look in `scene`, and makes them NaN, so that others keep their rows.
/// `ground` is tested where it is given.
///
/// # Errors
/// [`Error::Cancelled`](belvedere_data::Error::Cancelled).
pub fn skip_unfit_eyes(
    scene: &MedialScene,
    ground: Option<&Ground>,
    eyes: &mut [[f64; 3]],
    control: &Control<'_>,
) -> Result<EyesReport> {
    skip(eyes, control, |place| fault_of(scene, ground, place))
}

/// The same for eyes whose lines of sight may leave the cloud: those on far terrain
/// ([`MedialScene::is_on_far_terrain`]) can look unless they lie below it.
///
/// # Errors
/// [`Error::Cancelled`](belvedere_data::Error::Cancelled).
pub fn skip_unfit_far_eyes(
    scene: &MedialScene,
    ground: Option<&Ground>,
    eyes: &mut [[f64; 3]],
    control: &Control<'_>,
) -> Result<EyesReport> {
    skip(eyes, control, |place| far_fault_of(scene, ground, place))
}

fn skip(
    eyes: &mut [[f64; 3]],
    control: &Control<'_>,
    fault_of: impl Fn([f64; 3]) -> Option<EyeFault> + Sync,
) -> Result<EyesReport> {
    let fault = |(row, &place): (usize, &[f64; 3])| {
        control.check()?;
        Ok(fault_of(place).map(|fault| SkippedEye { row, place, fault }))
    };
    let faults: Vec<Option<SkippedEye>> = eyes.par_iter().enumerate().map(fault).collect::<Result<_>>()?;
    let faults: Vec<SkippedEye> = faults.into_iter().flatten().collect();
    for skipped in &faults {
        eyes[skipped.row] = [f64::NAN; 3];
    }
    let number = |is_so: fn(&EyeFault) -> bool| faults.iter().filter(|skipped| is_so(&skipped.fault)).count();
    Ok(EyesReport {
        count: eyes.len(),
        skipped: faults.len(),
        skipped_without_ground: number(|fault| matches!(fault, EyeFault::NoGround)),
        skipped_outside_cloud: number(|fault| matches!(fault, EyeFault::OutsideCloud | EyeFault::OutsideHeights)),
        skipped_below_ground: number(|fault| matches!(fault, EyeFault::BelowGround(_))),
        skipped_inside_obstacle: number(|fault| matches!(fault, EyeFault::InsideObstacle(_))),
        faults,
    })
}

/// Why nobody can look from `place`, local metres, whose height is NaN where no ground is known below it; `None` where
/// somebody can.
#[must_use]
pub fn fault_of(scene: &MedialScene, ground: Option<&Ground>, place: [f64; 3]) -> Option<EyeFault> {
    let [x, y, z] = place;
    let is_over =
        |coverage: &Coverage| if z.is_nan() { coverage.holds_on_map(place) } else { coverage.holds_end(place) };
    if let Some(coverage) = scene.coverage().filter(|coverage| !is_over(coverage)) {
        let is_on_map = coverage.holds_on_map(place);
        return Some(if is_on_map { EyeFault::OutsideHeights } else { EyeFault::OutsideCloud });
    }
    if z.is_nan() {
        return Some(EyeFault::NoGround);
    }
    if let Some(below) = ground.and_then(|ground| ground.height_at([x, y])).map(|height| height - z)
        && below > TOLERANCE
    {
        return Some(EyeFault::BelowGround(rounded(below, 3)));
    }
    scene.is_inside_obstacle(place).then(|| EyeFault::InsideObstacle(rounded(scene.enclosure(place).depth, 3)))
}

/// The same where lines of sight may leave the cloud.
fn far_fault_of(scene: &MedialScene, ground: Option<&Ground>, place: [f64; 3]) -> Option<EyeFault> {
    let Some(terrain) = scene.far_terrain().grid().filter(|_| scene.is_on_far_terrain(place)) else {
        return fault_of(scene, ground, place);
    };
    if place[2].is_nan() {
        return Some(EyeFault::NoGround);
    }
    let below = terrain.height_at([place[0], place[1]]).map(|height| height - place[2]);
    below.filter(|below| *below > TOLERANCE).map(|below| EyeFault::BelowGround(rounded(below, 3)))
}

/// Why a target at `place`, local metres, in the cloud or on far terrain, cannot be looked at from anywhere. Other than
/// eyes, targets may lie inside an obstacle: often it is they that are seen.
#[must_use]
pub fn fault_of_target(scene: &MedialScene, place: [f64; 3]) -> Option<EyeFault> {
    far_fault_of(scene, None, place).filter(|fault| !matches!(fault, EyeFault::InsideObstacle(_)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use belvedere_core::medial::MedialBalls;
    use belvedere_core::query::BlockRule;
    use belvedere_data::Bounds;

    #[test]
    fn eyes_that_cannot_look_are_named_and_others_keep_their_rows() {
        // one ball of 3 m around (10, 10, 3) on a cloud of 20 by 20 m
        let balls = MedialBalls {
            centers: vec![[10.0, 10.0, 3.0]],
            radii: vec![3.0],
            source: vec![0],
            touch: vec![0],
            separation_angles: vec![1.0],
        };
        let bounds = Bounds { low: [0.0; 3], high: [20.0, 20.0, 6.0] };
        let scene = MedialScene::new(&balls, &BlockRule::carved()).unwrap().with_coverage(Coverage::of(bounds));
        let fit = [2.0, 2.0, 1.7];
        let mut eyes = [
            fit,
            [10.0, 10.0, 1.0],       // 1 m deep in the ball
            [10.0, 10.0, 6.0 - 0.1], // on its surface, within the tolerance
            [3_000.0, 2.0, 1.7],
            [2.0, 2.0, -5.0],
            [2.0, 2.0, f64::NAN],
            [3_000.0, 2.0, f64::NAN],
            [10.0, 10.0, 106.0], // a drone
        ];
        let report = skip_unfit_eyes(&scene, None, &mut eyes, &Control::none()).unwrap();
        let rows: Vec<usize> = report.faults.iter().map(|skipped| skipped.row).collect();
        assert_eq!(rows, [1, 3, 4, 5, 6]);
        assert_eq!(report.faults[0].fault, EyeFault::InsideObstacle(1.0));
        assert_eq!([1, 2].map(|i| report.faults[i].fault), [EyeFault::OutsideCloud, EyeFault::OutsideHeights]);
        assert_eq!((report.count, report.skipped, report.skipped_outside_cloud), (8, 5, 3));
        assert_eq!((report.skipped_without_ground, report.skipped_inside_obstacle), (1, 1));
        assert!(eyes[0] == fit && eyes[7][2] == 106.0 && eyes[1][0].is_nan());
    }
}
