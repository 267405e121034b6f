//! Proof of visibility by pulses, against every pulse tried in turn, dense samples of lines, and closed forms.

use belvedere::Error;
use belvedere::control::Control;
use belvedere::medial::MedialBalls;
use belvedere::pulses::{FreeSegmentColumns, FreeSegmentParams, FreeSegments};
use belvedere::query::{
    Answer, AnswerCounts, Beside, BlockRule, MedialScene, Proof, ProofParams, UnprovenAs, Viewer, Visibility,
};
use belvedere::random::uniform;
use belvedere::view::View;

const FREE_SEGMENTS: FreeSegmentParams = FreeSegmentParams { end_margin: 0.05, headroom: 2.0 };

/// First returns at heights of 0 to 12 m on 60 m by 60 m, seen from two strips 400 m up, and where the scanner was.
fn survey(count: u64) -> (Vec<[f32; 3]>, Vec<[f32; 3]>) {
    let at = |seed, index| uniform(seed, index);
    (0..count)
        .map(|i| {
            let p = [60.0 * at(1, i), 60.0 * at(2, i), 12.0 * at(3, i).powi(3)].map(|v| v as f32);
            (p, [if i % 2 == 0 { -180.0 } else { 240.0 }, p[1] + 10.0, 400.0])
        })
        .unzip()
}

/// First returns in the same place, and scanners in their midst: pulses in all directions.
fn survey_from_the_ground(count: u64) -> (Vec<[f32; 3]>, Vec<[f32; 3]>) {
    let stations = [[10.0, 20.0, 1.5], [45.0, 30.0, 5.0], [30.0, 55.0, 1.0]];
    let (returns, _) = survey(count);
    let scanner = (0..returns.len()).map(|i| stations[i % 3]).collect();
    (returns, scanner)
}

fn free_segments(returns: &[[f32; 3]], scanner: &[[f32; 3]]) -> FreeSegments {
    FreeSegments::new(returns, scanner, &FREE_SEGMENTS, &Control::none()).unwrap().0
}

/// Ends of the pieces of lines that count as empty, in f64.
fn segments(returns: &[[f32; 3]], scanner: &[[f32; 3]]) -> Vec<[[f64; 3]; 2]> {
    let top = returns.iter().map(|p| p[2]).fold(f32::NEG_INFINITY, f32::max) + FREE_SEGMENTS.headroom;
    let piece = |(p, s): (&[f32; 3], &[f32; 3])| {
        let (p, s) = (p.map(f64::from), s.map(f64::from));
        let sight: [f64; 3] = std::array::from_fn(|i| s[i] - p[i]);
        let range = sight.iter().map(|v| v * v).sum::<f64>().sqrt();
        let on = |t: f64| std::array::from_fn(|i| p[i] + t * sight[i] / range);
        let to_top = if sight[2] > 0.0 { (f64::from(top) - p[2]) / sight[2] * range } else { range };
        [on(f64::from(FREE_SEGMENTS.end_margin)), on(to_top.min(range))]
    };
    returns.iter().zip(scanner).map(piece).collect()
}

/// Square of the distance of a point to a piece of a line.
fn square(point: [f64; 3], [a, b]: &[[f64; 3]; 2]) -> f64 {
    let (mut along, mut length) = (0.0, 0.0);
    for k in 0..3 {
        along += (point[k] - a[k]) * (b[k] - a[k]);
        length += (b[k] - a[k]).powi(2);
    }
    let share = (along / length).clamp(0.0, 1.0);
    (0..3).map(|k| (a[k] + share * (b[k] - a[k]) - point[k]).powi(2)).sum()
}

/// Distance of a point to the nearest of many pieces of lines.
fn distance(point: [f64; 3], segments: &[[[f64; 3]; 2]]) -> f64 {
    segments.iter().map(|segment| square(point, segment)).fold(f64::INFINITY, f64::min).sqrt()
}

fn random_point(seed: u64, i: u64) -> [f64; 3] {
    [-5.0 + 70.0 * uniform(seed, 3 * i), -5.0 + 70.0 * uniform(seed, 3 * i + 1), -1.0 + 20.0 * uniform(seed, 3 * i + 2)]
}

fn unit(v: [f64; 3]) -> [f64; 3] {
    let length = v.iter().map(|v| v * v).sum::<f64>().sqrt();
    v.map(|v| v / length)
}

fn proof(free_segments: FreeSegments, nearness: f64, beside: Beside) -> Proof {
    let params = ProofParams { nearness: Some(nearness), beside, ..ProofParams::default() };
    Proof::new(free_segments, &params).unwrap()
}

#[test]
fn nearness_of_pulses_equals_that_of_every_pulse_tried_in_turn() {
    for (returns, scanner) in [survey(700), survey_from_the_ground(900)] {
        let (index, segments) = (free_segments(&returns, &scanner), segments(&returns, &scanner));
        let mut near = 0;
        for i in 0..1500 {
            let point = random_point(8, i);
            let expected = distance(point, &segments);
            // free segments are kept as f32, which moves their ends by micrometres
            for (reach, is_near) in [(expected + 1e-4, true), (expected - 1e-4, false), (1.2, expected < 1.2)] {
                assert_eq!(index.passes_within(point, reach), is_near, "{point:?} at {reach}, distance {expected}");
            }
            let found = index.nearest_distance(point, 1.2);
            assert!(found.map_or(expected >= 1.2, |found| (found - expected).abs() < 1e-4), "{found:?} {expected}");
            near += usize::from(expected < 1.2);
        }
        assert!((300..1200).contains(&near), "both must occur: {near}");
    }
    let (returns, scanner) = survey(700);
    let index = free_segments(&returns, &scanner);
    assert!(!index.passes_within([f64::NAN, 0.0, 0.0], 1.0) && !index.passes_within([30.0; 3], f64::NAN));
    assert!(!free_segments(&[], &[]).passes_within([0.0; 3], 1e9));
}

#[test]
fn unproven_lengths_are_those_of_dense_samples() {
    const SPACING: f64 = 0.02;
    // pulses so sparse that lines have many gaps, and so dense that few are left and most boxes of space are near some
    type SurveyMaker = fn(u64) -> (Vec<[f32; 3]>, Vec<[f32; 3]>);
    let (above, ground): (SurveyMaker, SurveyMaker) = (survey, survey_from_the_ground);
    for (survey, count, nearness, lines) in [
        (above, 500, 1.2, 12),
        (above, 2500, 0.7, 12),
        (above, 25_000, 0.7, 6),
        (ground, 500, 1.2, 12),
        (ground, 5000, 0.7, 6),
    ] {
        let (returns, scanner) = survey(count);
        let segments = segments(&returns, &scanner);
        let top = returns.iter().map(|p| f64::from(p[2])).fold(0.0, f64::max) + 2.0;
        let border = [0, 1].map(|axis| {
            let ends = || segments.iter().map(|[start, _]| start[axis]);
            ends().fold(f64::INFINITY, f64::min)..=ends().fold(f64::NEG_INFINITY, f64::max)
        });
        let proof = proof(free_segments(&returns, &scanner), nearness, Beside::Unseen);
        let (mut sum, mut worst, mut sampled_sum): (f64, f64, f64) = (0.0, 0.0, 0.0);
        for i in 0..lines {
            let (from, to) = (random_point(12, i), random_point(13, i));
            let direction = unit(std::array::from_fn(|k| to[k] - from[k]));
            let range = (0..3).map(|k| (to[k] - from[k]).powi(2)).sum::<f64>().sqrt();
            let samples = (range / SPACING) as usize;
            let (mut unseen, mut changes, mut before) = (0, 0, false);
            for k in 0..samples {
                let at = (k as f64 + 0.5) * SPACING;
                let p: [f64; 3] = std::array::from_fn(|axis| from[axis] + at * direction[axis]);
                let beside = !(0..2).all(|axis| border[axis].contains(&p[axis]));
                let is_near = || segments.iter().any(|segment| square(p, segment) < nearness * nearness);
                let is_unseen = p[2] <= top && (beside || !is_near());
                unseen += usize::from(is_unseen);
                changes += usize::from(is_unseen != before);
                before = is_unseen;
            }
            let expected = unseen as f64 * SPACING;
            let found = proof.unproven_length(from, direction, range);
            // samples err by half their spacing at each change; a seen piece shorter than a step may be missed in a gap
            let slack = SPACING * (changes + 2) as f64;
            assert!(found > expected - slack, "line {i}: {found} is less than {expected}");
            assert!(found < expected + slack + 0.1 * changes as f64 / 2.0, "line {i}: {found} is more than {expected}");
            assert_eq!(proof.is_unproven(from, direction, range), found > 0.5, "line {i}: {found}");
            (sum, worst) = (sum + expected, worst.max((found - expected).abs()));
            let sampled = |enough| proof.sampled_unproven_length(from, direction, range, enough);
            let whole = sampled(f64::INFINITY);
            sampled_sum += whole;
            // the same from the other end, but for rounding; and what is found once stays
            let back = proof.sampled_unproven_length(to, direction.map(|v| -v), range, f64::INFINITY);
            assert!((whole - back).abs() < 1e-5, "line {i}: {whole} {back}");
            assert_eq!(sampled(f64::INFINITY), whole);
            let enough = sampled(2.0);
            assert!(if whole < 2.0 { enough == whole } else { enough >= 2.0 }, "line {i}: {enough} of {whole}");
        }
        assert!(sum > 5.0, "lines must have gaps: {sum}");
        // boxes begin and end where middles lie: too early as often as too late
        assert!((sampled_sum - sum).abs() < 0.1 * sum, "{sampled_sum} sampled, {sum}");
        // most lines miss nothing at all
        assert!(worst < 0.3, "{worst}");
    }
}

#[test]
fn a_line_beside_one_pulse_is_seen_along_a_chord_of_its_cylinder() {
    // a vertical free segment over the origin, and two returns so low and far that they only make the survey larger
    let returns = [[0.0, 0.0, 0.0], [-40.0, -40.0, 0.0], [40.0, 40.0, 0.0]];
    let scanner = returns.map(|p: [f32; 3]| [p[0], p[1], 500.0]);
    let single = |beside| {
        proof(
            FreeSegments::new(
                &returns,
                &scanner,
                &FreeSegmentParams { headroom: 20.0, ..FREE_SEGMENTS },
                &Control::none(),
            )
            .unwrap()
            .0,
            0.7,
            beside,
        )
    };
    let proof = single(Beside::Ignored);
    for beside in [0.0, 0.3, 0.69, 0.71] {
        let found = proof.unproven_length([-10.0, beside, 5.0], [1.0, 0.0, 0.0], 20.0);
        let chord = 2.0 * (0.49 - beside * beside).max(0.0).sqrt();
        // rounding of f32 at the surface of the cylinder
        assert!((found - (20.0 - chord)).abs() < 1e-5, "{beside}: {found}");
        // the pieces before and behind the cylinder, from whichever end steps begin
        for (from, towards) in [(-10.0, 1.0), (10.0, -1.0)] {
            let pieces = proof.unproven_pieces([from, beside, 5.0], [towards, 0.0, 0.0], 20.0);
            let expected = [[0.0, 10.0 - chord / 2.0], [10.0 + chord / 2.0, 20.0]];
            let expected = if chord > 0.0 { &expected[..] } else { &[[0.0, 20.0]] };
            assert_eq!(pieces.len(), expected.len(), "{beside}: {pieces:?}");
            let ends = pieces.iter().flatten().zip(expected.iter().flatten());
            assert!(ends.into_iter().all(|(found, expected)| (found - expected).abs() < 1e-5), "{beside}: {pieces:?}");
        }
    }
    // a slope of one in one below the top at 20 m, of which the last 10 m lie above it
    let up = unit([1.0, 0.0, 1.0]);
    let free = proof.unproven_length([5.0, 0.0, 10.0], up, 20.0 * 2f64.sqrt());
    assert!((free - 10.0 * 2f64.sqrt()).abs() < 1e-5, "{free}");
    assert_eq!(proof.unproven_length([5.0, 0.0, 10.0], up, f64::INFINITY), free);
    // 10 m to the border at 40 m, 20 m beyond
    let east = [1.0, 0.0, 0.0];
    assert!((proof.unproven_length([30.0, 10.0, 5.0], east, 30.0) - 10.0).abs() < 1e-5);
    let all = single(Beside::Unseen);
    assert!((all.unproven_length([30.0, 10.0, 5.0], east, 30.0) - 30.0).abs() < 1e-5);
    assert_eq!(all.unproven_length([30.0, 10.0, 5.0], east, f64::INFINITY), f64::INFINITY);
    assert_eq!(all.unproven_length([30.0, 10.0, 5.0], [0.0, 0.0, -1.0], f64::INFINITY), f64::INFINITY);
    // nothing was seen where no pulse flew
    let none = Proof::new(free_segments(&[], &[]), &ProofParams::default()).unwrap();
    assert_eq!(none.unproven_length([0.0; 3], east, 7.0), 7.0);
}

#[test]
fn nearness_follows_the_density_of_pulses_where_they_are_sparse() {
    let of = |spacing: f32| {
        let side = (64.0 / spacing) as u16;
        let returns: Vec<[f32; 3]> = (0..side * side)
            .map(|i| [f32::from(i % side) * spacing + 0.1, f32::from(i / side) * spacing + 0.1, 0.0])
            .collect();
        let scanner: Vec<[f32; 3]> = returns.iter().map(|p| [p[0], p[1], 500.0]).collect();
        Proof::new(free_segments(&returns, &scanner), &ProofParams::default()).unwrap().nearness()
    };
    assert_eq!([of(0.5), of(1.0), of(2.0)], [0.7, 1.0, 2.0]);
}

#[test]
fn what_nothing_blocks_is_visible_where_pulses_passed_and_unproven_where_none_did() {
    // pulses every half metre, none on a strip of 4 m, and a ball beyond the strip
    let returns: Vec<[f32; 3]> = (0..6400_u16)
        .map(|i| [f32::from(i % 80) * 0.5, f32::from(i / 80) * 0.5, 0.0])
        .filter(|p| !(18.0..22.0).contains(&p[0]))
        .collect();
    let scanner: Vec<[f32; 3]> = returns.iter().map(|p| [p[0], p[1], 500.0]).collect();
    let ball = MedialBalls {
        centers: vec![[30.0, 20.0, 0.5]],
        radii: vec![1.0],
        source: vec![0],
        touch: vec![0],
        separation_angles: vec![1.0],
    };
    let scene = |tolerance: f64| {
        let params = ProofParams { tolerance, ..ProofParams::default() };
        let balls = MedialScene::new(&ball, &BlockRule::default()).unwrap();
        balls.with_pulses(Proof::new(free_segments(&returns, &scanner), &params).unwrap())
    };
    let targets = [[10.0, 10.0, 1.0], [24.0, 10.0, 1.0], [10.0, 20.0, 0.5], [10.0, 10.0, 30.0], [10.0, 10.0, f32::NAN]];
    let east = Viewer::Eye([35.0, 10.0, 1.0]);
    let answers = scene(0.5).visible(east, &targets).unwrap();
    use Answer::{Blocked, OutsideView, Unproven, Visible};
    assert_eq!(answers, [Unproven, Visible, Unproven, Visible, OutsideView]);
    let along = |scene: &MedialScene| scene.visible(Viewer::Direction([1.0, 0.0, 0.0]), &targets).unwrap();
    assert_eq!(along(&scene(0.5)), [Unproven, Visible, Blocked, Visible, OutsideView]);
    // pulses at 17.5 and 22 m see 0.7 m into the strip: 3.1 m are left
    assert_eq!([scene(3.05), scene(3.15)].map(|scene| along(&scene)[0]), [Unproven, Visible]);
    let counts = AnswerCounts::of(&answers);
    assert_eq!((counts.visible, counts.unproven, counts.blocked, counts.outside_view), (2, 2, 0, 1));
    let settled = [UnprovenAs::Reported, UnprovenAs::Visible, UnprovenAs::Blocked].map(|by| by.settle(Unproven));
    assert_eq!(settled, [Unproven, Visible, Blocked]);
    assert!([Visible, Blocked, OutsideView].iter().all(|&other| UnprovenAs::Blocked.settle(other) == other));
    // a picture plane 5 m east of the first target, facing west: the line of sight ends before the strip
    let view = View::from_viewport([15.0, 5.0, 10.0], [0.0, 30.0, 0.0], [0.0, 0.0, -10.0], 1.0).unwrap();
    assert_eq!(view.frame.forward, [-1.0, 0.0, 0.0]);
    let seen = scene(0.5).query_view(&view, &targets, &Control::none()).unwrap();
    assert_eq!(seen, [Visible, OutsideView, Visible, OutsideView, OutsideView]);
}

#[test]
fn answers_depend_on_neither_threads_nor_the_order_of_pulses() {
    let (returns, scanner) = survey(5000);
    let targets: Vec<[f32; 3]> = (0..3000).map(|i| random_point(20, i).map(|v| v as f32)).collect();
    let run = |threads: usize, turned: bool| {
        let (mut returns, mut scanner) = (returns.clone(), scanner.clone());
        if turned {
            returns.reverse();
            scanner.reverse();
        }
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let proof = Proof::new(free_segments(&returns, &scanner), &ProofParams::default()).unwrap();
            let empty = MedialScene::new(&MedialBalls::default(), &BlockRule::default()).unwrap();
            empty.with_pulses(proof).visible(Viewer::Direction([0.5, 0.3, 0.4]), &targets).unwrap()
        })
    };
    let one = run(1, false);
    assert!(one.contains(&Answer::Unproven) && one.contains(&Answer::Visible));
    assert!(one == run(3, false) && one == run(2, true));
}

#[test]
fn pulses_as_columns_come_back_within_millimetres_and_then_the_same() {
    let (returns, scanner) = survey(900);
    // some scanners lower than the highest return: their free segments end early
    let mut low = scanner.clone();
    low.iter_mut().step_by(7).zip(returns.iter().step_by(7)).for_each(|(s, p)| *s = [p[0], p[1] + 1.0, p[2] + 3.0]);
    let ground = survey_from_the_ground(900);
    for (returns, scanner, all_reach_the_top, all_go_up) in
        [(&returns, &scanner, true, true), (&returns, &low, false, true), (&ground.0, &ground.1, false, false)]
    {
        let first = free_segments(returns, scanner);
        let columns = first.to_columns();
        assert_eq!((columns.lengths.is_empty(), columns.ways.is_empty()), (all_reach_the_top, all_go_up));
        let again = FreeSegments::from_columns(&columns, &Control::none()).unwrap();
        assert_eq!((again.len(), again.top()), (first.len(), first.top()));
        for i in 0..500 {
            let point = random_point(30, i);
            let [a, b] = [&first, &again].map(|index| index.nearest_distance(point, 50.0).unwrap());
            // half a step of the slope, over 14 m of height or 60 m of ground, in two directions
            let along = if all_go_up { 14.0 } else { 60.0 };
            assert!((a - b).abs() < along * 0.5e-4 * 1.5, "{a} {b}");
        }
        let sorted = |columns: FreeSegmentColumns| {
            let length = |i: usize| columns.lengths.get(i).map_or(0, |v| v.to_bits());
            let way = |i: usize| columns.ways.get(i).copied();
            let mut rows: Vec<_> = (0..columns.starts.len())
                .map(|i| (columns.starts[i].map(f32::to_bits), columns.slopes[i], way(i), length(i)))
                .collect();
            rows.sort_unstable();
            rows
        };
        assert!(sorted(columns) == sorted(again.to_columns()));
    }
    let broken = |change: fn(&mut FreeSegmentColumns)| {
        let mut columns = free_segments(&returns, &low).to_columns();
        change(&mut columns);
        FreeSegments::from_columns(&columns, &Control::none()).map(|_| ())
    };
    assert!(matches!(
        broken(|c| {
            c.slopes.pop();
        }),
        Err(Error::LengthMismatch { .. })
    ));
    assert!(matches!(broken(|c| c.starts[3][1] = f32::NAN), Err(Error::InvalidParameter { .. })));
    assert!(matches!(broken(|c| c.lengths[3] = -1.0), Err(Error::InvalidParameter { .. })));
    assert!(matches!(broken(|c| c.ways = vec![0; 2]), Err(Error::LengthMismatch { .. })));
    assert!(matches!(broken(|c| c.ways = vec![6; 900]), Err(Error::InvalidParameter { .. })));
    assert!(matches!(broken(|c| c.top = f32::INFINITY), Err(Error::InvalidParameter { .. })));
    assert!(free_segments(&[], &[]).to_columns().starts.is_empty());
}

#[test]
fn parameters_out_of_range_are_errors() {
    let with = |params: ProofParams| Proof::new(free_segments(&[], &[]), &params).map(|_| ());
    let usual = ProofParams::default();
    assert!(with(usual).is_ok());
    for params in [
        ProofParams { nearness: Some(0.0), ..usual },
        ProofParams { nearness: Some(f64::NAN), ..usual },
        ProofParams { tolerance: -0.1, ..usual },
        ProofParams { step: 0.0, ..usual },
    ] {
        assert!(matches!(with(params), Err(Error::InvalidParameter { .. })), "{params:?}");
    }
}
