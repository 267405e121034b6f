//! Blocking of lines of sight by balls, against another derivation: roots of quadratics and points on surfaces.

use belvedere::Error;
use belvedere::blocking::{Ball, BlockRule, Chord, Profile};
use belvedere::control::Control;
use belvedere::depth::{ItemBuffer, depth_map};
use belvedere::medial::MedialBalls;
use belvedere::query::MedialScene;
use belvedere::random::uniform;
use belvedere::vector::{dot, length, sub, unit};
use belvedere::view::View;

const CASES: u64 = 20_000;
/// Cases nearer than this to where an answer changes say nothing, metres: rounding decides them.
const UNDECIDED: f64 = 1e-5;

struct BlockingCase {
    ball: Ball,
    target: [f64; 3],
    towards: [f64; 3],
    reach: f64,
    rule: BlockRule,
}

fn case(number: u64) -> BlockingCase {
    let random = |k: u64| uniform(11, 16 * number + k);
    let coordinate = |k: u64| 8.0 * random(k) - 4.0;
    let ball =
        Ball { center: [0, 1, 2].map(|k| coordinate(k) as f32), radius: (0.05 + 4.0 * random(3).powi(2)) as f32 };
    let reach = if random(4) < 0.3 { f64::INFINITY } else { 12.0 * random(5) };
    let rule = BlockRule {
        profile: Profile::Sphere,
        bias: if random(6) < 0.5 { 0.0 } else { 0.8 * random(7) },
        shell: if random(8) < 0.3 { 0.0 } else { 0.6 * random(9) },
    };
    let direction = [10, 11, 12].map(|k| random(k) - 0.5);
    BlockingCase { ball, target: [13, 14, 15].map(coordinate), towards: unit(direction).unwrap(), reach, rule }
}

/// Returns the intersections of a line with a sphere, by the roots of |o + t d − c|² = r².
fn roots(center: [f64; 3], radius: f64, origin: [f64; 3], direction: [f64; 3]) -> Option<[f64; 2]> {
    let from = sub(origin, center);
    let (b, c) = (2.0 * dot(from, direction), dot(from, from) - radius * radius);
    let discriminant = b * b - 4.0 * c;
    (discriminant > 0.0).then(|| [-1.0, 1.0].map(|sign| (-b + sign * discriminant.sqrt()) / 2.0))
}

/// The radius that counts: whole from the shell on outside, less by the shell within it, falling in between.
fn counted(rule: &BlockRule, radius: f64, outside: f64) -> f64 {
    let shell = if rule.shell > radius / 2.0 { radius / 2.0 } else { rule.shell };
    if outside <= -shell || outside >= shell {
        radius
    } else if outside <= 0.0 {
        radius - shell
    } else {
        radius - shell + outside
    }
}

/// Returns the place at which the line leaves a ball that blocks; the error is the distance of the case from an
/// undecided one.
fn expected(case: &BlockingCase) -> Result<Option<f64>, f64> {
    let BlockingCase { ball, target, towards, reach, rule } = case;
    let (center, radius) = (ball.center.map(f64::from), f64::from(ball.radius));
    let sure = |distance: f64| if distance.abs() < UNDECIDED { Err(distance) } else { Ok(distance > 0.0) };
    let mut counts = radius;
    let viewer: [f64; 3] = std::array::from_fn(|i| target[i] + reach * towards[i]);
    for end in [*target, viewer].into_iter().filter(|end| end.iter().all(|v| v.is_finite())) {
        let outside = length(sub(center, end)) - radius;
        // the radius jumps where the shell begins inside
        sure(outside + rule.shell_of(radius))?;
        counts = counts.min(counted(rule, radius, outside));
    }
    let beside = length(sub(sub(center, *target), towards.map(|v| v * dot(sub(center, *target), *towards))));
    if !sure(radius - beside)? || !sure(counts - beside)? {
        return Ok(None);
    }
    let [enters, leaves] = roots(center, counts, *target, *towards).unwrap();
    if reach.is_finite() && !sure(reach - rule.bias - enters)? {
        return Ok(None);
    }
    Ok(sure(leaves - rule.bias)?.then_some(leaves.min(*reach)))
}

#[test]
fn a_ball_blocks_where_the_roots_of_its_sphere_say() {
    let (mut blocked, mut free) = (0, 0);
    for number in 0..CASES {
        let case = case(number);
        let found = case.rule.blocks_line(case.ball, case.target, case.towards, case.reach);
        let Ok(expected) = expected(&case) else { continue };
        assert_eq!(found.is_some(), expected.is_some(), "case {number}");
        match found.zip(expected) {
            Some((found, expected)) => {
                blocked += 1;
                assert!((found - expected).abs() < 1e-4, "case {number}: {found} for {expected}");
            }
            None => free += 1,
        }
    }
    assert!(blocked > 1000 && free > 10_000, "{blocked} blocked, {free} free");
}

#[test]
fn a_straight_line_is_a_chord_of_itself() {
    let mut blocked = 0;
    for number in 0..CASES {
        let BlockingCase { ball, target, towards, rule, .. } = case(number);
        let reach = 12.0 * uniform(5, number);
        let observer = std::array::from_fn(|i| target[i] + reach * towards[i]);
        let case = BlockingCase { ball, target, towards, reach, rule };
        // a ball that touches one of the ends or the line is decided by rounding
        if expected(&case).is_err() {
            continue;
        }
        let chord = Chord { start: target, towards, ranges: [rule.bias, reach - rule.bias], target, observer };
        let on_chord = rule.blocks_chord(ball, &chord).is_some();
        let on_line = rule.blocks_line(ball, target, towards, reach).is_some();
        assert_eq!(on_chord, on_line, "case {number}");
        blocked += usize::from(on_line);
    }
    assert!(blocked > 1000, "{blocked}");
}

#[test]
fn the_ends_of_a_line_can_change_places() {
    let (mut blocked, mut held) = (0, 0);
    for number in 0..CASES {
        let BlockingCase { ball, target, towards, rule, .. } = case(number);
        let reach = 0.1 + 12.0 * uniform(5, number);
        let viewer = std::array::from_fn(|i| target[i] + reach * towards[i]);
        if expected(&BlockingCase { ball, target, towards, reach, rule }).is_err() {
            continue;
        }
        let there = rule.blocks_line(ball, target, towards, reach).is_some();
        let back = rule.blocks_line(ball, viewer, towards.map(|v| -v), reach).is_some();
        assert_eq!(there, back, "case {number}");
        // from inside an obstacle no line is free, but one that the bias takes away as a whole
        let is_held = [target, viewer].iter().any(|end| rule.holds_end(ball, *end));
        assert!(!is_held || there || reach <= rule.bias, "case {number}");
        blocked += usize::from(there);
        held += usize::from(is_held);
    }
    assert!(blocked > 1000 && held > 500, "{blocked} {held}");
}

#[test]
fn what_a_plane_cuts_blocks_nothing_and_what_it_does_not_blocks_as_ever() {
    let mut cut = 0;
    for number in 0..CASES {
        let BlockingCase { ball, target, towards, rule, .. } = case(number);
        let reach = 12.0 * uniform(5, number);
        let to_plane = rule.blocks_before_plane(ball, target, towards, reach);
        let without = rule.blocks_line(ball, target, towards, f64::INFINITY);
        let is_past = ball.interval(target, towards).is_some_and(|[_, leaves]| leaves >= reach);
        assert_eq!(to_plane, without.filter(|_| !is_past), "case {number}");
        cut += usize::from(is_past);
    }
    assert!(cut > 500, "{cut}");
}

#[test]
fn a_ray_meets_a_ball_on_its_surface_and_a_line_lies_in_it_between() {
    let mut met = 0;
    for number in 0..CASES {
        let BlockingCase { ball, target, towards, rule, .. } = case(number);
        let surface = |range: f64| ball.depth_of(std::array::from_fn(|i| target[i] + range * towards[i]));
        let interval = ball.interval(target, towards);
        if let Some([enters, leaves]) = interval {
            assert!(surface(enters).abs() < 1e-5 && surface(leaves).abs() < 1e-5, "case {number}");
            assert!(surface(f64::midpoint(enters, leaves)) > 0.0, "case {number}");
        }
        let entry = rule.meets_ray(ball, target, towards);
        let ahead = interval.filter(|[enters, _]| *enters > 0.0);
        assert_eq!(entry.is_some(), ahead.is_some(), "case {number}");
        if let Some((entry, [enters, _])) = entry.zip(ahead) {
            assert!((entry - enters).abs() < 1e-9, "case {number}");
            met += 1;
        }
    }
    assert!(met > 500, "{met}");
}

#[test]
fn what_a_ball_covers_of_the_sky_is_what_it_blocks_without_bias() {
    let mut blocked = 0;
    for number in 0..CASES {
        let BlockingCase { ball, target, towards, rule, .. } = case(number);
        let rule = BlockRule { bias: 0.0, ..rule };
        let cover = rule.cover(ball, target);
        let off = dot(cover.towards, towards) - cover.cosine;
        let blocks = rule.blocks_line(ball, target, towards, f64::INFINITY).is_some();
        if off.abs() > 1e-6 && cover.cosine > -1.0 {
            assert_eq!(blocks, off > 0.0, "case {number}");
            assert!(!blocks || towards[2] <= cover.highest + 1e-9, "case {number}");
            blocked += usize::from(blocks);
        }
        let seen = rule.seen_from(ball, target);
        assert_eq!(seen.is_none(), cover.cosine < -1.0, "case {number}");
    }
    assert!(blocked > 500, "{blocked}");
}

#[test]
fn a_wider_shell_or_bias_never_blocks_more() {
    for number in 0..CASES {
        let BlockingCase { ball, target, towards, reach, rule } = case(number);
        let blocks = |rule: BlockRule| rule.blocks_line(ball, target, towards, reach).is_some();
        if !blocks(BlockRule { shell: 0.0, ..rule }) {
            assert!(!blocks(rule), "case {number}");
        }
        if !blocks(rule) {
            assert!(!blocks(BlockRule { bias: rule.bias + 0.3, ..rule }), "case {number}");
        }
        let radius = f64::from(ball.radius);
        let [counted, min] = [rule.radius_for(radius, ball.distance_to(target)), rule.min_radius(radius)];
        assert!(min <= counted && counted <= radius, "case {number}");
    }
}

#[test]
fn columns_of_unequal_length_are_refused() {
    let balls = MedialBalls {
        centers: vec![[0.0; 3]; 2],
        radii: vec![1.0; 2],
        source: vec![0; 2],
        touch: vec![0; 2],
        separation_angles: vec![1.0; 2],
    };
    let view = View::parallel([0.0, 0.0, -1.0], [-1.0; 3], [1.0; 3], 0.5).unwrap();
    let shortened: [fn(&mut MedialBalls); 5] = [
        |balls| balls.centers.truncate(1),
        |balls| balls.radii.truncate(1),
        |balls| balls.source.truncate(1),
        |balls| balls.touch.truncate(1),
        |balls| balls.separation_angles.truncate(1),
    ];
    for shorten in shortened {
        let mut uneven = balls.clone();
        shorten(&mut uneven);
        let refused = [
            MedialScene::new(&uneven, &BlockRule::default()).err(),
            depth_map(&uneven, &view, Profile::Sphere, ItemBuffer::Without, &Control::none()).err(),
        ];
        assert!(refused.iter().all(|error| matches!(error, Some(Error::LengthMismatch { .. }))), "{refused:?}");
    }
    assert!(MedialScene::new(&balls, &BlockRule::default()).is_ok());
}

#[test]
fn rules_out_of_range_are_refused() {
    let usual = BlockRule::carved();
    for bad in [BlockRule { bias: f64::NAN, ..usual }, BlockRule { shell: -0.1, ..usual }] {
        assert!(matches!(MedialScene::new(&MedialBalls::default(), &bad), Err(Error::InvalidParameter { .. })));
    }
}
