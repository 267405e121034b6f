//! Probabilities that targets are visible, against the exact mesh of a simulated town, and the same for any number of
//! threads.

use crate::common::simulated::cloud_of;
use belvedere::apps::sum_errors::{Outlines, SumKind, class_of, expected_measures};
use belvedere::apps::targets::Measure;
use belvedere::cloud::to_local;
use belvedere::control::Control;
use belvedere::model::{ModelParams, SceneModel};
use belvedere::query::{Answer, BlockRule, MedialScene, UnprovenAs, Viewer};
use belvedere::view::to_sun;
use belvedere::{Bounds, Error};
use belvedere_scenes::{
    AirborneParams, Preset, QuerySet, QuerySite, TownParams, TriangleScene, Truth, scan_airborne, town,
};

/// Suns, degrees.
const SUNS: [[f64; 2]; 3] = [[110.0, 20.0], [180.0, 50.0], [250.0, 35.0]];

struct Surveyed {
    town: TriangleScene,
    scene: MedialScene,
    origin: [f64; 3],
    bounds: Bounds,
}

fn small_town() -> Surveyed {
    surveyed(&TownParams { extent: 70.0, seed: 12, ..TownParams::default() })
}

fn surveyed(params: &TownParams) -> Surveyed {
    let town = town(params);
    let cloud = cloud_of(&scan_airborne(&town, &AirborneParams::covering(&town, 10.0)));
    let model = SceneModel::build(&cloud, &ModelParams::default(), &Control::none()).unwrap().0;
    let scene = model.scene(&BlockRule::carved(), UnprovenAs::Reported, &Control::none()).unwrap();
    Surveyed { town, scene, origin: cloud.frame.origin, bounds: cloud.bounds().unwrap() }
}

/// Places of a kind, absolute and local.
fn places(surveyed: &Surveyed, truth: &Truth, set: QuerySet, count: usize) -> (Vec<[f64; 3]>, Vec<[f32; 3]>) {
    let Surveyed { town, origin, bounds, .. } = surveyed;
    let absolute = |p: [f32; 3]| std::array::from_fn(|i| f64::from(p[i]) + origin[i]);
    let site = QuerySite { scene: town, truth, bounds: [absolute(bounds.low), absolute(bounds.high)] };
    let found = site.targets(set, count, 4).positions;
    let local = found.iter().map(|p| to_local(*p, *origin)).collect();
    (found, local)
}

#[test]
fn probabilities_are_nearer_to_the_truth_than_answers_and_true_on_average() {
    let surveyed = surveyed(&Preset::Town.params(110.0, 201));
    let truth = Truth::new(&surveyed.town);
    let (mut of_answers, mut of_probabilities) = (0.0, 0.0);
    for set in [QuerySet::Pedestrians, QuerySet::Roofs, QuerySet::Facades] {
        let (absolute, local) = places(&surveyed, &truth, set, 2500);
        let (mut expected, mut found) = (0.0, 0.0);
        for [azimuth, elevation] in SUNS {
            let sun = to_sun(azimuth.to_radians(), elevation.to_radians());
            let viewer = Viewer::Direction(sun);
            let answers = surveyed.scene.visible_from(viewer, &local, &Control::none()).unwrap();
            let likely = surveyed.scene.visible_probabilities(viewer, &local, &Control::none()).unwrap();
            for ((blocked, answer), p) in truth.occluded_towards_each(&absolute, sun).iter().zip(answers).zip(likely) {
                let truth = f64::from(u8::from(!blocked));
                let hard = f64::from(u8::from(answer != Answer::Blocked));
                let p = f64::from(p);
                of_answers += (hard - truth).powi(2);
                of_probabilities += (p - truth).powi(2);
                expected += p;
                found += truth;
            }
        }
        let count = 3.0 * local.len() as f64;
        // two points is what is promised for the mean of tenths
        assert!((expected - found).abs() < 0.02 * count, "{}: {expected} {found} of {count}", set.name());
    }
    // a quarter less over many towns
    assert!(of_probabilities < 0.9 * of_answers, "{of_probabilities} {of_answers}");
}

#[test]
fn probabilities_do_not_depend_on_threads_nor_on_who_looks() {
    let surveyed = small_town();
    let truth = Truth::new(&surveyed.town);
    let (_, mut local) = places(&surveyed, &truth, QuerySet::Pedestrians, 600);
    local.push([f32::NAN; 3]);
    local.push([1e4, 0.0, 0.0]);
    let eye = local[0].map(f64::from);
    let of_eye = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| surveyed.scene.visible_probabilities(Viewer::Eye(eye), &local, &Control::none()).unwrap())
    };
    let bits = |values: &[f32]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
    let found = of_eye(1);
    assert_eq!(bits(&found), bits(&of_eye(3)));
    // the eye itself, a place that is not known, one outside the cloud
    assert!([0, 600, 601].iter().all(|&row| found[row].is_nan()) && found[1].is_finite());
    assert!(found.iter().any(|p| *p > 0.9) && found.iter().any(|p| *p < 0.1));
    let pairs = |is_swapped: bool| {
        let ends = |target: &[f32; 3]| {
            let pair = [eye, target.map(f64::from)];
            if is_swapped { [pair[1], pair[0]] } else { pair }
        };
        let pairs: Vec<_> = local.iter().map(ends).collect();
        surveyed.scene.pair_probabilities(&pairs, &Control::none()).unwrap()
    };
    assert_eq!(bits(&pairs(false)), bits(&pairs(true)));
    assert_eq!(bits(&pairs(false)), bits(&found));
}

#[test]
fn without_pulses_there_is_no_probability() {
    let scene = MedialScene::new(&belvedere::medial::MedialBalls::default(), &BlockRule::carved()).unwrap();
    let refused = scene.visible_probabilities(Viewer::Eye([0.0; 3]), &[[1.0; 3]], &Control::none());
    assert!(matches!(refused, Err(Error::InvalidParameter { .. })));
}

#[test]
fn intervals_of_hours_of_sun_hold_the_truth() {
    let surveyed = small_town();
    let truth = Truth::new(&surveyed.town);
    let suns: Vec<[f64; 3]> = (0..60)
        .map(|i| to_sun((70.0 + 4.0 * f64::from(i)).to_radians(), (8.0 + 0.8 * f64::from(i.min(59 - i))).to_radians()))
        .collect();
    let outlines = Outlines::new(&suns, &[1.0; 60]);
    let (mut held, mut count) = (0, 0);
    for set in [QuerySet::Pedestrians, QuerySet::Roofs, QuerySet::Facades] {
        let (absolute, local) = places(&surveyed, &truth, set, 500);
        let matrix = surveyed.scene.visibility_matrix(&local, &suns, &Control::none()).unwrap();
        let mut hours = vec![0.0_f32; local.len()];
        for sun in &suns {
            let blocked = truth.occluded_towards_each(&absolute, *sun);
            hours.iter_mut().zip(blocked).for_each(|(sum, blocked)| *sum += if blocked { 0.0 } else { 1.0 });
        }
        for (row, (&target, &exact)) in local.iter().zip(&hours).enumerate() {
            let moved = outlines.moved_share(|number| matrix.is_free(row, number));
            let class = class_of(surveyed.scene.is_inside_obstacle(target.map(f64::from)), moved);
            let sum = Measure::new("hours", vec![matrix.sum(row, &[1.0; 60]) as f32]);
            let measures = expected_measures("hours", &sum, |_| 60.0, SumKind::Sun, &[class]);
            held += usize::from(measures[1].values[0] <= exact + 1e-3 && exact <= measures[2].values[0] + 1e-3);
            count += 1;
        }
    }
    // 90 % of many towns; one of 70 m may differ by some points
    assert!(held as f64 > 0.84 * f64::from(count), "{held} of {count}");
}
