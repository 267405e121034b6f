//! Pulses held out, against methods whose faults are known: exact rays, and answers that are always the same.

use belvedere::control::Control;
use belvedere::pulses::{Pulses, SensorPositions, group};
use belvedere::query::{Answer, Sight, Viewer, Visibility};
use belvedere::trajectory::Trajectory;
use belvedere::vector::{length, sub};
use belvedere::{Attributes, Error, GpsTimeKind, PointCloud, Result};
use belvedere_baselines::MethodInput;
use belvedere_baselines::held_out::{FalseVisible, HeldOut, HeldOutParams, HeldOutScore, score, split};
use belvedere_baselines::hidden_points::{HiddenPoints, HiddenPointsParams};
use belvedere_scenes::{AirborneParams, Material, TownParams, TriangleScene, Truth, scan_airborne, town};

struct Flown {
    scene: TriangleScene,
    cloud: PointCloud,
    pulses: Pulses,
    scanner: SensorPositions,
}

/// The default town, without what `keeps` does not keep, scanned.
fn flown(keeps: impl Fn(Material) -> bool) -> Flown {
    let mut scene = town(&TownParams::default());
    let rows: Vec<usize> = (0..scene.triangles.len()).filter(|&i| keeps(scene.materials[i])).collect();
    scene.triangles = rows.iter().map(|&i| scene.triangles[i]).collect();
    scene.materials = rows.iter().map(|&i| scene.materials[i]).collect();
    scene.objects = rows.iter().map(|&i| scene.objects[i]).collect();
    let scan = scan_airborne(&scene, &AirborneParams { pulses_per_m2: 2.0, ..AirborneParams::default() });
    let coordinates: Vec<[f64; 3]> = (0..scan.len()).map(|i| [scan.x[i], scan.y[i], scan.z[i]]).collect();
    let (mut cloud, _) = PointCloud::from_coordinates(&coordinates);
    cloud.attributes = Attributes {
        gps_time: Some(scan.gps_time),
        gps_time_kind: GpsTimeKind::AdjustedStandard,
        return_number: Some(scan.return_number),
        return_count: Some(scan.return_count),
        point_source_id: Some(scan.point_source_id),
        classification: Some(scan.classification),
        ..Attributes::default()
    };
    let path = scan.sensor_path;
    let (trajectory, _) = Trajectory::from_records(path.times.into_iter().zip(path.positions).collect());
    let (pulses, _) = group(&cloud, &Control::none()).unwrap();
    let (scanner, _) = SensorPositions::from_trajectory(&cloud, &pulses, &trajectory).unwrap();
    Flown { scene, cloud, pulses, scanner }
}

fn is_solid(material: Material) -> bool {
    !matches!(material, Material::TreeCrown | Material::Trunk | Material::Leaf)
}

fn held_out(flown: &Flown) -> HeldOut {
    split(&flown.cloud, &flown.pulses, &flown.scanner, &HeldOutParams::default()).unwrap()
}

/// Rays through the triangles that were scanned.
struct ExactMesh {
    truth: Truth,
    origin: [f64; 3],
}

impl Visibility for ExactMesh {
    fn seen_from<'a>(&'a self, viewer: Viewer<'a>) -> Result<Sight<'a>> {
        Ok(Box::new(move |targets| {
            let absolute = |p: [f32; 3]| std::array::from_fn(|i| f64::from(p[i]) + self.origin[i]);
            let Viewer::Each(eyes) = viewer else { panic!("a common viewer") };
            let blocked = |(t, e): (&[f32; 3], &[f32; 3])| self.truth.occluded(absolute(*t), absolute(*e));
            let answer = |pair| if blocked(pair) { Answer::Blocked } else { Answer::Visible };
            Ok(targets.iter().zip(eyes).map(answer).collect())
        }))
    }
}

struct Always(Answer);

impl Visibility for Always {
    fn seen_from<'a>(&'a self, _: Viewer<'a>) -> Result<Sight<'a>> {
        Ok(Box::new(|targets| Ok(vec![self.0; targets.len()])))
    }
}

fn exact_score(flown: &Flown) -> HeldOutScore {
    let exact = ExactMesh { truth: Truth::new(&flown.scene), origin: flown.cloud.frame.origin };
    score(&exact, &held_out(flown)).unwrap()
}

#[test]
fn exact_rays_make_next_to_no_mistakes_in_a_town_without_trees() {
    let found = exact_score(&flown(is_solid));
    // an echo comes from within 9 cm of the axis, so a path may graze an eave or a wall that the axis met
    assert!(found.false_blocked.share() < 0.005, "{found:?}");
    assert!(found.false_blocked.answered_count > 3000 && found.false_blocked.undecided_count == 0, "{found:?}");
    for at_depth in &found.false_visible {
        // and what is behind an edge may be seen beside it
        assert!(at_depth.ground.share() < 0.005 && at_depth.building.share() < 0.005, "{found:?}");
        assert!(at_depth.ground.answered_count > 500 && at_depth.building.answered_count > 500, "{found:?}");
    }
}

#[test]
fn what_exact_rays_get_wrong_they_get_wrong_in_crowns() {
    let found = exact_score(&flown(|_| true));
    // the simulated crowns let a seventh of the light through, the mesh lets none: returns from within and under crowns
    let of_opaque = found.false_blocked_building.wrong_count + found.false_blocked_ground.wrong_count;
    assert!(found.false_blocked_other.share() > 0.01 && found.false_blocked_other.wrong_count > of_opaque, "{found:?}");
    assert!(found.false_blocked_building.share() < 0.005 && found.false_blocked_ground.share() < 0.005, "{found:?}");
    assert!(found.false_visible.iter().all(|at_depth| at_depth.ground.share() < 0.005), "{found:?}");
    // what is behind opaque crowns is hidden, also from within them
    assert!(found.false_visible.iter().all(|at| at.other.answered_count > 100 && at.other.share() < 0.02), "{found:?}");
}

#[test]
fn a_tenth_of_the_pulses_is_held_out_with_all_returns() {
    let flown = flown(|_| true);
    let held_out = held_out(&flown);
    let mut is_kept = vec![false; flown.cloud.len()];
    held_out.kept.iter().for_each(|&row| is_kept[row as usize] = true);
    let mut out_count = 0;
    for pulse in 0..flown.pulses.len() {
        let returns = flown.pulses.returns_of(pulse);
        let kept = returns.iter().filter(|&&row| is_kept[row as usize]).count();
        assert!(kept == 0 || kept == returns.len());
        out_count += usize::from(kept == 0);
    }
    assert_eq!(out_count, held_out.pulse_count);
    // binomial: five standard deviations
    let (mean, sd) = (0.1 * flown.pulses.len() as f64, (0.09 * flown.pulses.len() as f64).sqrt());
    assert!((out_count as f64 - mean).abs() < 5.0 * sd);
    assert_eq!(held_out.free.targets.len(), out_count);
    for (target, eye) in held_out.free.targets.iter().zip(&held_out.free.eyes) {
        // f32 holds centimetres of a kilometre to 0.1 mm
        assert!((length(sub(target.map(f64::from), eye.map(f64::from))) - 29.7).abs() < 1e-3);
    }
    let other = HeldOutParams { seed: 2, ..HeldOutParams::default() };
    assert_ne!(split(&flown.cloud, &flown.pulses, &flown.scanner, &other).unwrap().kept, held_out.kept);
}

#[test]
fn answers_that_never_change_are_all_right_or_all_wrong() {
    let held_out = held_out(&flown(is_solid));
    let blind = score(&Always(Answer::Blocked), &held_out).unwrap();
    assert_eq!(blind.false_blocked.wrong_count, held_out.free.targets.len());
    let wrong_behind = |at: &FalseVisible| at.ground.wrong_count + at.building.wrong_count + at.other.wrong_count;
    assert!(blind.false_visible.iter().all(|at| wrong_behind(at) == 0));
    let by_surface = [blind.false_blocked_ground, blind.false_blocked_building, blind.false_blocked_other];
    assert_eq!(by_surface.map(|tally| tally.wrong_count).iter().sum::<usize>(), blind.false_blocked.wrong_count);
    let see_through = score(&Always(Answer::Visible), &held_out).unwrap();
    assert_eq!(see_through.false_blocked.wrong_count, 0);
    for (at, (depth, pairs)) in see_through.false_visible.iter().zip(&held_out.behind) {
        assert_eq!((at.depth.to_bits(), wrong_behind(at)), (depth.to_bits(), pairs.targets.len()));
    }
    let silent = score(&Always(Answer::OutsideView), &held_out).unwrap();
    assert_eq!(silent.false_blocked.undecided_count, held_out.free.targets.len());
    assert!(silent.false_blocked.share().is_nan());
}

#[test]
fn methods_and_clouds_that_cannot_take_part_say_so() {
    let flown = flown(is_solid);
    let held_out = held_out(&flown);
    let survey = MethodInput { cloud: &flown.cloud, scanner: &[], models: &[] };
    let hidden_points = HiddenPoints::new(&survey, HiddenPointsParams::default()).unwrap();
    assert!(matches!(score(&hidden_points, &held_out), Err(Error::UnsupportedViewer { .. })));
    let attempt = |scanner: &SensorPositions, params| split(&flown.cloud, &flown.pulses, scanner, &params);
    let nowhere = SensorPositions { per_pulse: vec![[f32::NAN; 3]; flown.pulses.len()] };
    assert!(matches!(attempt(&nowhere, HeldOutParams::default()), Err(Error::MissingAttribute { .. })));
    let few = SensorPositions::default();
    assert!(matches!(attempt(&few, HeldOutParams::default()), Err(Error::LengthMismatch { .. })));
    for wrong in [
        HeldOutParams { share: 0.0, ..HeldOutParams::default() },
        HeldOutParams { clearance: f64::NAN, ..HeldOutParams::default() },
        HeldOutParams { path_length: 0.1, ..HeldOutParams::default() },
        HeldOutParams { depths: vec![-1.0], ..HeldOutParams::default() },
    ] {
        assert!(matches!(attempt(&flown.scanner, wrong), Err(Error::InvalidParameter { .. })));
    }
}
