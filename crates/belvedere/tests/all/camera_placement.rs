//! Selections of cameras against all selections, and the bounds that they are proven by.

use belvedere::apps::cameras::{CoverageTable, Goal, Placement, PlacementParams, place_cameras};
use belvedere::control::Control;
use belvedere::random::uniform;
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_4};

/// Random numbers one after the other.
struct RandomNumbers(u64, u64);

impl RandomNumbers {
    fn between(&mut self, from: f64, to: f64) -> f64 {
        self.1 += 1;
        from + (to - from) * uniform(self.0, self.1)
    }

    fn below(&mut self, count: usize) -> usize {
        (self.between(0.0, count as f64) as usize).min(count - 1)
    }
}

/// Returns random targets that each of the cameras covers.
fn lists(random: &mut RandomNumbers, cameras: usize, targets: usize, share: f64) -> Vec<Vec<usize>> {
    (0..cameras).map(|_| (0..targets).filter(|_| random.between(0.0, 1.0) < share).collect()).collect()
}

fn place(lists: &[Vec<usize>], weights: &[f64], params: &PlacementParams) -> Placement {
    let table = CoverageTable::of_lists(weights.len(), lists).unwrap();
    place_cameras(&table, weights, params, &Control::none()).unwrap()
}

/// The share that cameras cover, by counting.
fn share(lists: &[Vec<usize>], weights: &[f64], required: u32, cameras: &[usize]) -> f64 {
    let count = |target: usize| cameras.iter().filter(|&&camera| lists[camera].contains(&target)).count();
    let part = |target: usize| count(target).min(required as usize) as f64 / f64::from(required);
    weights.iter().enumerate().map(|(target, weight)| weight * part(target)).sum::<f64>() / weights.iter().sum::<f64>()
}

/// The best share of `count` cameras beside the existing ones, and the fewest that reach each share, by trying all.
fn by_trying_all(lists: &[Vec<usize>], weights: &[f64], required: u32, existing: &[usize]) -> Vec<f64> {
    let mut best = vec![0.0_f64; lists.len() + 1];
    for subset in 0_u32..1 << lists.len() {
        let mut cameras: Vec<usize> = (0..lists.len()).filter(|&camera| subset >> camera & 1 == 1).collect();
        let count = cameras.iter().filter(|camera| !existing.contains(camera)).count();
        cameras.extend(existing.iter().filter(|&&camera| subset >> camera & 1 == 0));
        best[count] = best[count].max(share(lists, weights, required, &cameras));
    }
    // fewer cameras are allowed too
    (1..best.len()).for_each(|count| best[count] = best[count].max(best[count - 1]));
    best
}

/// The simple greedy choice, gain by gain.
fn greedy(lists: &[Vec<usize>], weights: &[f64], required: u32, existing: &[usize], count: usize) -> f64 {
    let mut cameras = existing.to_vec();
    for _ in 0..count {
        let with = |camera: usize| share(lists, weights, required, &[&cameras[..], &[camera]].concat());
        let best =
            (0..lists.len()).filter(|camera| !cameras.contains(camera)).max_by(|&a, &b| with(a).total_cmp(&with(b)));
        cameras.extend(best);
    }
    share(lists, weights, required, &cameras)
}

#[test]
fn selections_are_the_best_of_all_and_bounds_are_never_below_them() {
    for seed in 0..60 {
        let mut random = RandomNumbers(seed, 0);
        let (cameras, targets) = (7 + random.below(3), 12 + random.below(20));
        let lists = lists(&mut random, cameras, targets, 0.25);
        let weights: Vec<f64> = match seed % 3 {
            0 => vec![1.0; targets],
            1 => (0..targets).map(|_| random.between(0.1, 5.0)).collect(),
            // some do not count
            _ => (0..targets).map(|i| if i % 4 == 0 { 0.0 } else { 2.0 }).collect(),
        };
        let required = 1 + u32::from(seed % 4 == 1) + u32::from(seed % 8 == 1);
        let existing: Vec<usize> = if seed % 5 == 0 { vec![2, 5] } else { Vec::new() };
        let best = by_trying_all(&lists, &weights, required, &existing);
        for count in [0, 1, 2, 3, 4] {
            let params =
                PlacementParams::new(Goal::Count(count)).with_required(required).with_existing(existing.clone());
            let found = place(&lists, &weights, &params);
            let quick = place(&lists, &weights, &params.clone().with_search_limit(Some(0)));
            let counted = share(&lists, &weights, required, &[&existing[..], &found.chosen].concat());
            // sums of thirty terms
            let same = |a: f64, b: f64| (a - b).abs() < 1e-12;
            assert!(same(found.coverage(), counted), "{seed} {count}");
            assert!(found.chosen.len() <= count && found.chosen.iter().all(|camera| !existing.contains(camera)));
            assert!(same(found.coverage(), best[count]) && found.is_optimal(), "{seed} {count}: {found:?} {best:?}");
            assert!(quick.bound > best[count] - 1e-12 && found.bound > best[count] - 1e-12, "{seed} {count}");
            assert!(quick.coverage() > greedy(&lists, &weights, required, &existing, count) - 1e-12, "{seed} {count}");
            assert!(
                found.curve.windows(2).all(|pair| pair[0] < pair[1]) && found.curve.len() == found.chosen.len() + 1
            );
        }
        for wanted in [0.3, 0.6, 0.9, 1.0] {
            let wanted = wanted * best[best.len() - 1];
            let params =
                PlacementParams::new(Goal::Coverage(wanted)).with_required(required).with_existing(existing.clone());
            let fewest = best.iter().position(|share| *share > wanted - 1e-12).unwrap();
            let found = place(&lists, &weights, &params);
            assert!(found.coverage() > wanted - 1e-9 && found.chosen.len() == fewest, "{seed} {wanted} {found:?}");
            assert_eq!((found.min_count, found.is_optimal()), (Some(fewest), true), "{seed} {wanted}");
            let quick = place(&lists, &weights, &params.with_search_limit(Some(0)));
            assert!(quick.min_count.unwrap() <= fewest && quick.chosen.len() >= fewest, "{seed} {wanted}");
        }
    }
}

#[test]
fn problems_without_an_answer_are_refused_with_the_reason() {
    let lists = vec![vec![0, 1], vec![2]];
    let table = CoverageTable::of_lists(4, &lists).unwrap();
    let run = |weights: &[f64], params: &PlacementParams| place_cameras(&table, weights, params, &Control::none());
    let usual = PlacementParams::new(Goal::Count(1));
    let too_much = run(&[1.0; 4], &PlacementParams::new(Goal::Coverage(0.9))).unwrap_err().to_string();
    assert!(too_much.contains("75.00 %") && too_much.contains("add candidates"), "{too_much}");
    assert!(run(&[1.0; 3], &usual).is_err());
    assert!(run(&[0.0; 4], &usual).is_err() && run(&[1.0, 1.0, f64::NAN, 1.0], &usual).is_err());
    assert!(run(&[1.0; 4], &usual.clone().with_required(0)).is_err());
    assert!(run(&[1.0; 4], &usual.with_existing(vec![2])).is_err());
    assert!(run(&[1.0; 4], &PlacementParams::new(Goal::Coverage(0.0))).is_err());
    // more cameras than there are: those that add something
    let all = run(&[1.0; 4], &PlacementParams::new(Goal::Count(9))).unwrap();
    assert_eq!((all.chosen, all.counts, all.bound), (vec![0, 1], vec![1, 1, 1, 0], 0.75));
}

/// Returns the places between houses that cameras before their walls cover, within `reach` metres and 90 degrees, on a
/// square of `side` metres.
fn town(seed: u64, (side, houses): (f64, usize), targets: usize, cameras: usize, reach: f64) -> Vec<Vec<usize>> {
    let mut random = RandomNumbers(seed, 0);
    let mut house = || {
        let [x, y] = [(); 2].map(|()| random.between(0.0, side));
        let [width, depth] = [(); 2].map(|()| random.between(6.0, 18.0));
        [[x, y], [x + width, y + depth]]
    };
    let houses: Vec<[[f64; 2]; 2]> = (0..houses).map(|_| house()).collect();
    let holds = |[low, high]: &[[f64; 2]; 2], p: [f64; 2]| (0..2).all(|i| p[i] > low[i] && p[i] < high[i]);
    let is_free = |p: [f64; 2]| !houses.iter().any(|house| holds(house, p));
    let places: Vec<[f64; 2]> = std::iter::repeat_with(|| [(); 2].map(|()| random.between(0.0, side)))
        .filter(|p| is_free(*p))
        .take(targets)
        .collect();
    let before_a_wall = || {
        let [low, high] = houses[random.below(houses.len())];
        let along: [f64; 2] = std::array::from_fn(|i| random.between(low[i], high[i]));
        match random.below(4) {
            0 => [low[0] - 0.1, along[1]],
            1 => [high[0] + 0.1, along[1]],
            2 => [along[0], low[1] - 0.1],
            _ => [along[0], high[1] + 0.1],
        }
    };
    let eyes: Vec<[f64; 2]> =
        std::iter::repeat_with(before_a_wall).filter(|p| is_free(*p)).take(cameras.div_ceil(8)).collect();
    let is_hidden = |a: [f64; 2], b: [f64; 2]| {
        houses.iter().any(|[low, high]| {
            let (mut from, mut to) = (0.0_f64, 1.0_f64);
            for i in 0..2 {
                let [one, other] = [low[i], high[i]].map(|wall| (wall - a[i]) / (b[i] - a[i]));
                (from, to) = (from.max(one.min(other)), to.min(one.max(other)));
            }
            from < to
        })
    };
    let covers = |eye: [f64; 2], heading: f64, place: [f64; 2]| {
        let [x, y] = [place[0] - eye[0], place[1] - eye[1]];
        let ahead = x * heading.sin() + y * heading.cos();
        x.hypot(y) <= reach && ahead >= x.hypot(y) * FRAC_1_SQRT_2 && !is_hidden(eye, place)
    };
    let list = |camera: usize| {
        let (eye, heading) = (eyes[camera / 8], (camera % 8) as f64 * FRAC_PI_4);
        (0..targets).filter(|&target| covers(eye, heading, places[target])).collect()
    };
    (0..cameras).map(list).collect()
}

#[test]
fn ten_cameras_in_random_towns_are_proven_best() {
    let weights = vec![1.0; 2000];
    for seed in 0..20 {
        let lists = town(seed, (200.0, 60), 2000, 500, 60.0);
        let found = place(&lists, &weights, &PlacementParams::new(Goal::Count(10)));
        assert!(found.is_optimal(), "{seed}: {} of {}", found.coverage(), found.bound);
        let quick = place(&lists, &weights, &PlacementParams::new(Goal::Count(10)).with_search_limit(Some(0)));
        // the bar: a hundredth of the proven optimum
        assert!(quick.coverage() > 0.99 * found.coverage(), "{seed}: {} of {}", quick.coverage(), found.coverage());
        assert!(quick.bound > found.coverage() - 1e-9 && quick.coverage() < found.coverage() + 1e-9);
    }
}

#[test]
fn threads_do_not_change_what_is_chosen() {
    let lists = town(77, (150.0, 40), 900, 240, 50.0);
    let weights: Vec<f64> = (0..900).map(|i| 1.0 + 0.37 * f64::from(i % 7)).collect();
    for goal in [Goal::Count(8), Goal::Coverage(0.7)] {
        let params = PlacementParams::new(goal).with_required(2).with_search_limit(Some(30));
        let [one, four] = [1, 4].map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| place(&lists, &weights, &params))
        });
        assert_eq!(one, four);
    }
}
