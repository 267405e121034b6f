//! Hours of sun against closed forms, and against every sun and every ball tried in turn.

use crate::common::light_share;
use belvedere::apps::ask::{Days, SunHoursQuestion, SunPlace};
use belvedere::apps::rows::{CrownRows, RowBlock};
use belvedere::apps::sun::{
    Binning, Date, DayParams, Period, Refraction, Site, SunSchedule, Zone, sun_days, sun_position_with,
};
use belvedere::apps::sun_hours::{
    RuleDays, SunHours, SunHoursParams, SunRule, SunSums, sun_hours, sun_hours_through_crowns,
};
use belvedere::apps::targets::Targets;
use belvedere::control::Control;
use belvedere::medial::MedialBalls;
use belvedere::medium::Medium;
use belvedere::query::{BlockRule, MedialScene, VisibilityMatrix};
use belvedere::random::uniform;
use belvedere::{ExtinctionVoxels, Frame};

fn scene(centers: &[[f32; 3]], radii: &[f32]) -> MedialScene {
    let count = radii.len();
    let balls = MedialBalls {
        centers: centers.to_vec(),
        radii: radii.to_vec(),
        source: vec![0; count],
        touch: vec![0; count],
        separation_angles: vec![1.0; count],
    };
    MedialScene::new(&balls, &BlockRule { bias: 0.0, shell: 0.0, ..BlockRule::uncarved() }).unwrap()
}

fn site(latitude_deg: f64) -> Site {
    Site { latitude: latitude_deg.to_radians(), longitude: 0.1, height: 0.0, convergence: 0.0 }
}

fn date(text: &str) -> Date {
    Date::parse(text).unwrap()
}

fn plain(step: f64) -> DayParams {
    DayParams::default().with_step(step).with_refraction(Refraction::Without)
}

fn schedule(site: &Site, dates: Vec<Date>, params: &DayParams, binning: Binning) -> SunSchedule {
    let days = sun_days(site, &Zone::mean_solar(site), &Period::Days(dates), params).unwrap();
    SunSchedule::new(&days, binning).unwrap()
}

fn hours_at(
    scene: &MedialScene,
    schedule: &SunSchedule,
    targets: &[[f32; 3]],
    normals: Option<&[[f32; 3]]>,
) -> SunHours {
    let matrix = scene.visibility_matrix(targets, &schedule.directions, &Control::none()).unwrap();
    sun_hours(&matrix, schedule, normals, &SunHoursParams::default().with_sufficient_hours(2.0)).unwrap()
}

/// A ball so far off that it seems 15° wide in each direction, where the sun stands at its noon on the day of the
/// equinox.
fn ball_before_the_noon_sun(site: &Site, days: &[belvedere::apps::sun::SunDay]) -> MedialScene {
    let sun = sun_position_with(site, days[0].noon, Refraction::Without).unwrap().to_sun(site);
    let center = sun.map(|v| (100.0 * v) as f32);
    let radius = (100.0 * 15f64.to_radians().sin()) as f32;
    scene(&[center], &[radius])
}

#[test]
fn a_ball_before_the_sun_takes_its_width_in_hours() {
    // on the equinox the sun moves along a great circle, 15° an hour: a ball of 15° each way hides it for two hours
    // around noon
    let site = site(40.0);
    let dates = vec![date("2026-03-20")];
    for step in [60.0, 300.0, 600.0] {
        let days = sun_days(&site, &Zone::mean_solar(&site), &Period::Days(dates.clone()), &plain(step)).unwrap();
        let blockers = ball_before_the_noon_sun(&site, &days);
        let schedule = SunSchedule::new(&days, Binning::Auto).unwrap();
        let found = hours_at(&blockers, &schedule, &[[0.0; 3]], None);
        let possible = days[0].possible_hours();
        // the sun of a step represents it: each edge of the shadow errs by half a step at most; the declination moves
        // 0.1° within the 2 hours
        let tolerance = step / 3600.0 + 0.01;
        let [hours, longest, share] = [found.hours[0], found.longest[0], found.share[0]].map(f64::from);
        assert!((hours - (possible - 2.0)).abs() <= tolerance, "{step}: {hours} of {possible}");
        assert!((longest - (possible / 2.0 - 1.0)).abs() <= tolerance, "{longest}");
        assert!((share - hours / possible).abs() < 1e-5);
        // it comes and goes with the sun; half a day before and after noon, which is 12 but for the equation of time,
        // −7.5 minutes
        let noon = days[0].clock_hours(days[0].noon);
        assert!((noon - 12.125).abs() < 0.02, "{noon}");
        assert!((f64::from(found.first[0]) - (noon - possible / 2.0)).abs() < 0.02, "{}", found.first[0]);
        assert!((f64::from(found.last[0]) - (noon + possible / 2.0)).abs() < 0.02, "{}", found.last[0]);
        assert_eq!((found.days[0], found.min[0]), (1, found.hours[0]));
    }
}

#[test]
fn walls_see_half_of_the_equinox_and_nothing_from_behind() {
    // at an equinox the sun stands south of the east-west line all day (north of the tropics): a south wall has it all,
    // a north wall none, east and west walls half each; a place without normal has it all
    let site = site(40.0);
    let schedule_of = |site: &Site, day| schedule(site, vec![date(day)], &plain(120.0), Binning::Exact);
    let schedule = schedule_of(&site, "2026-03-20");
    let normals =
        [[0.0, -1.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 0.0, 1.0]];
    let targets = [[0.0; 3]; 6];
    let blockers = scene(&[[0.0, 0.0, -1000.0]], &[1.0]);
    let found = hours_at(&blockers, &schedule, &targets, Some(&normals));
    let possible = schedule.possible_hours();
    for (hours, expected) in found.hours.iter().zip([possible, 0.0, possible / 2.0, possible / 2.0, 0.0, possible]) {
        // the declination is up to 0.2° from zero: by so much the sun rises north of east, within four minutes
        assert!((f64::from(*hours) - expected).abs() < 0.1, "{hours} {expected}");
    }
    // in winter a north wall has none at all
    let winter = schedule_of(&site, "2026-12-21");
    let dark = hours_at(&blockers, &winter, &targets[..1], Some(&normals[1..2]));
    assert!(dark.first[0].is_nan() && dark.last[0].is_nan() && dark.longest[0] == 0.0 && dark.share[0] == 0.0);
    assert_eq!(found.days, [1, 0, 1, 1, 0, 1]);
    let free = hours_at(&blockers, &schedule, &targets[..1], None);
    assert!((f64::from(free.hours[0]) - possible).abs() < 1e-3 && (1.0 - free.share[0]).abs() < 1e-6);
}

#[test]
fn a_year_of_shared_suns_is_a_year_of_suns() {
    // a small town of balls: exact suns against shared ones, and both against every ball tried in turn
    let site = site(52.0);
    let at = |i: u64| uniform(5, i) as f32;
    let centers: Vec<[f32; 3]> =
        (0..60).map(|i| [120.0 * at(3 * i) - 60.0, 120.0 * at(3 * i + 1) - 60.0, 12.0 * at(3 * i + 2)]).collect();
    let radii: Vec<f32> = (0..60).map(|i| 1.0 + 6.0 * at(1000 + i)).collect();
    let blockers = scene(&centers, &radii);
    let targets: Vec<[f32; 3]> =
        (0..40).map(|i| [60.0 * at(2000 + 2 * i) - 30.0, 60.0 * at(2001 + 2 * i) - 30.0, 0.0]).collect();
    let dates: Vec<Date> = date("2025-01-01").to(date("2025-12-31")).collect();
    let params = DayParams::default().with_step(1200.0);
    let exact = schedule(&site, dates.clone(), &params, Binning::Exact);
    let shared = schedule(&site, dates, &params, Binning::Within(1f64.to_radians()));
    assert!(shared.directions.len() * 10 < exact.directions.len(), "{}", shared.directions.len());
    let [a, b] = [&exact, &shared].map(|schedule| hours_at(&blockers, schedule, &targets, None));
    let mut brute = Vec::new();
    for target in &targets {
        let mut hours = 0.0;
        for step in exact.days.iter().flat_map(|day| &day.steps) {
            let direction = exact.directions[step.direction as usize];
            let is_blocked = centers.iter().zip(&radii).any(|(center, &radius)| {
                let to: Vec<f64> = (0..3).map(|i| f64::from(center[i]) - f64::from(target[i])).collect();
                let along: f64 = (0..3).map(|i| to[i] * direction[i]).sum();
                let square = to.iter().map(|v| v * v).sum::<f64>() - along * along;
                let half = f64::from(radius).powi(2) - square;
                half > 0.0 && along + half.sqrt() > 0.0
            });
            hours += if is_blocked { 0.0 } else { f64::from(step.hours) };
        }
        brute.push(hours / 365.0);
    }
    let mut worst = 0.0_f64;
    for ((a, b), brute) in a.hours.iter().zip(&b.hours).zip(&brute) {
        // targets within a ball give way to it in one and not in the other; none here lie so. f32 sums err by 1e-5
        assert!((f64::from(*a) - brute).abs() < 1e-4, "{a} {brute}");
        worst = worst.max((f64::from(*a) - f64::from(*b)).abs());
    }
    // a sun 1° off comes 4 minutes early or late at each edge of a shadow, early and late in turn; among balls a day
    // has half a dozen edges, and a year evens out most of their 24 minutes
    assert!(worst < 0.1, "{worst}");
    // in spring and autumn the hours of a place change by minutes a day, so that a limit of two hours is passed weeks
    // early or late
    let differ = a.days.iter().zip(&b.days).map(|(&a, &b)| a.abs_diff(b)).max().unwrap();
    assert!(differ <= 40, "days with two hours differ by {differ}");
    let differ: Vec<f32> = a.min.iter().zip(&b.min).map(|(a, b)| (a - b).abs()).collect();
    assert!(differ.iter().all(|differ| *differ <= 1.01), "{differ:?}");
}

#[test]
fn light_through_crowns_counts_by_the_share_of_its_day() {
    let site = site(52.0);
    let dates = ["2026-03-20", "2026-04-06", "2026-04-07", "2026-06-21"].map(date).to_vec();
    let schedule = schedule(&site, dates, &plain(600.0), Binning::Exact);
    // a crown to the south, and a wall behind it that is not as high
    let crowns = scene(&[[0.0, -20.0, 10.0], [0.0, -40.0, 2.0]], &[8.0, 12.0]);
    let opaque = scene(&[[0.0, -40.0, 2.0]], &[12.0]);
    let targets = [[0.0; 3], [3.0, 1.0, 2.0], [0.0, 30.0, 0.0], [-25.0, -20.0, 0.0]];
    let [all, opaque] = [crowns, opaque]
        .map(|scene| scene.visibility_matrix(&targets, &schedule.directions, &Control::none()).unwrap());
    let params = SunHoursParams::default().with_sufficient_hours(8.0);
    let block = RowBlock { crowns: Some(CrownRows::Share(opaque.clone())), ..RowBlock::from(all.clone()) };
    let of = |shares: &[f64]| sun_hours_through_crowns(&block, &schedule, None, &params, shares);
    let shares = [0.5, 0.5, 0.03, 0.03];
    let found = of(&shares).unwrap();
    let mut took = 0.0;
    for target in 0..targets.len() {
        let of_day = |(day, share): (&belvedere::apps::sun::DayOfLight, &f64)| -> f64 {
            let light = |step: &belvedere::apps::sun::LightStep| {
                f64::from(step.hours) * light_share(&all, &opaque, target, step.direction as usize, *share)
            };
            day.steps.iter().map(light).sum()
        };
        let days: Vec<f64> = schedule.days.iter().zip(&shares).map(of_day).collect();
        let near =
            |found: f32, expected: f64| assert!((f64::from(found) - expected).abs() < 1e-4, "{found} {expected}");
        near(found.hours[target], days.iter().sum::<f64>() / 4.0);
        near(found.min[target], days.iter().copied().fold(f64::INFINITY, f64::min));
        near(found.share[target], days.iter().sum::<f64>() / schedule.possible_hours());
        assert_eq!(found.days[target] as usize, days.iter().filter(|&&hours| hours >= 8.0 - 1e-4).count());
        took += 12.0 - days[0];
    }
    assert!(took > 1.0, "something must stand before the sun: {took}");
    // nothing through is all, everything through is the rest; first and last light are those of the open sun
    let plain = |matrix| sun_hours(matrix, &schedule, None, &params).unwrap();
    let (none, whole) = (of(&[0.0; 4]).unwrap(), of(&[1.0; 4]).unwrap());
    for (a, b) in none.hours.iter().zip(&plain(&all).hours).chain(whole.hours.iter().zip(&plain(&opaque).hours)) {
        assert!((a - b).abs() < 1e-4, "{a} {b}");
    }
    assert_eq!((&found.first, &found.last, &found.longest), (&none.first, &none.last, &none.longest));
    assert!(of(&[0.5; 3]).is_err());
}

#[test]
fn a_sun_behind_crowns_may_be_free_before_leaves_and_not_after() {
    let site = site(52.0);
    // days on both sides of 7 April, whose suns share directions
    let dates = ["2026-04-05", "2026-04-08"].map(date).to_vec();
    let schedule = schedule(&site, dates, &plain(600.0), Binning::Within(2f64.to_radians()));
    let steps = schedule.days.iter().map(|day| day.steps.len()).sum::<usize>();
    assert!(schedule.directions.len() < steps, "{} of {steps}", schedule.directions.len());
    // a layer of leaves from 5 to 8 m: depths of 0.3 overhead, and of half the light at 26 degrees
    let layer = |i: i32| [i % 200 - 100, i / 200 % 200 - 100, 5 + i / 40_000];
    let mut voxels: Vec<[i32; 3]> = (0..3 * 40_000).map(layer).collect();
    voxels.sort_unstable();
    let extinction = vec![0.1; voxels.len()];
    let medium = Medium::new(&ExtinctionVoxels { voxels, extinction }, [0.0; 3]);
    let targets = [[0.5, 0.5, 0.0], [-3.5, 2.5, 1.0], [0.5, 0.5, 20.0]];
    let open = scene(&[[0.0, 0.0, -100.0]], &[1.0]);
    let matrix = open.visibility_matrix(&targets, &schedule.directions, &Control::none()).unwrap();
    let directions = &schedule.directions[..];
    let crowns = Some(CrownRows::Measured { medium: &medium, targets: &targets, directions });
    let block = RowBlock { crowns, ..RowBlock::from(matrix) };
    let factors = [0.2, 1.0];
    let found = sun_hours_through_crowns(&block, &schedule, None, &SunHoursParams::default(), &factors).unwrap();
    for (number, target) in targets.iter().enumerate() {
        let mut sums = Vec::new();
        let (mut first, mut last) = (f64::INFINITY, f64::NEG_INFINITY);
        for (day, factor) in schedule.days.iter().zip(factors) {
            let mut hours = 0.0;
            for step in &day.steps {
                let towards = directions[step.direction as usize];
                let depth = factor * medium.optical_depth(target.map(f64::from), towards, f64::INFINITY);
                hours += f64::from(step.hours) * (-depth).exp();
                if depth <= 2f64.ln() {
                    first = first.min(f64::from(step.start));
                    last = last.max(f64::from(step.start + step.hours));
                }
            }
            sums.push(hours);
        }
        // sums of f32
        let is_near = |found: f32, expected: f64| (f64::from(found) - expected).abs() < 1e-3;
        assert!(is_near(found.hours[number], f64::midpoint(sums[0], sums[1])), "{number}");
        assert!(is_near(found.first[number], first) && is_near(found.last[number], last), "{number}");
    }
    // bare crowns let the low sun through, leaves would not
    let of_leaves = sun_hours_through_crowns(&block, &schedule, None, &SunHoursParams::default(), &[1.0; 2]).unwrap();
    assert!(found.longest[0] > of_leaves.longest[0] + 1.0, "{} {}", found.longest[0], of_leaves.longest[0]);
    assert_eq!((found.first[2], found.hours[2]), (of_leaves.first[2], of_leaves.hours[2]));
}

#[test]
fn rules_know_their_days() {
    let site_north = site(52.0);
    let zone = Zone::utc();
    let days = |text: &str, site: &Site| -> Vec<String> {
        let rule = SunRule::parse(text).unwrap();
        rule.days.dates(2026, site, &zone).unwrap().iter().map(ToString::to_string).collect()
    };
    let light = days("nl-light", &site_north);
    assert_eq!((light.len(), light[0].as_str(), light[244].as_str()), (245, "2026-02-19", "2026-10-21"));
    let strict = days("nl-strict", &site_north);
    assert_eq!((strict.len(), strict[0].as_str(), strict[305].as_str()), (306, "2026-01-21", "2026-11-22"));
    assert_eq!(days("bre-equinox", &site_north), ["2026-03-21"]);
    // the solstices of 2026: 21 June 08:25 and 21 December 20:50 UTC
    assert_eq!(days("1@shortest-day", &site_north), ["2026-12-21"]);
    assert_eq!(days("1@longest-day", &site_north), ["2026-06-21"]);
    assert_eq!(days("1@winter-solstice", &site(-30.0)), ["2026-06-21"]);
    assert_eq!(days("3@12-30..01-02", &site_north), ["2026-01-01", "2026-01-02", "2026-12-30", "2026-12-31"]);
    assert_eq!(days("3@02-29", &site_north), ["2026-02-28"]);
    let hague = SunRule::parse("the-hague").unwrap();
    assert!((hague.min_elevation.to_degrees() - 10.0).abs() < 1e-9 && hague.hours == 2.0);
    let own = SunRule::parse("1.5@03-21>11").unwrap();
    assert_eq!((own.hours, own.days), (1.5, RuleDays::On([3, 21])));
    assert!((own.min_elevation.to_degrees() - 11.0).abs() < 1e-9);
    for bad in [
        "",
        "bre",
        "2@",
        "@03-21",
        "0@03-21",
        "25@03-21",
        "nan@03-21",
        "2@13-01",
        "2@02-30",
        "2@3-21",
        "2@03-21>90",
        "2@03-21>-1",
        "2@03-21>x",
        "2@03-21..",
        "2@..",
        "2@03-é",
        "2@03-21@7",
        "2@03-21@17-7",
        "2@03-21@7-25",
        "2@03-21@7-17@8-9",
        "2@03-21,solar",
        "2@03-21@7-17,twice",
    ] {
        let message = SunRule::parse(bad).unwrap_err().to_string();
        assert!(message.contains("nl-light"), "{bad}: {message}");
    }
}

#[test]
fn what_does_not_belong_together_is_refused() {
    let site = site(52.0);
    let schedule = schedule(&site, vec![date("2026-03-20")], &plain(600.0), Binning::Exact);
    let blockers = scene(&[[0.0, 0.0, -1000.0]], &[1.0]);
    let targets = [[0.0; 3], [f32::NAN; 3]];
    let matrix = blockers.visibility_matrix(&targets, &schedule.directions, &Control::none()).unwrap();
    let usual = SunHoursParams::default();
    let found = sun_hours(&matrix, &schedule, None, &usual).unwrap();
    assert!(found.hours[0] > 11.0 && found.hours[1] == 0.0, "a place that is none sees nothing");
    assert!(sun_hours(&matrix, &schedule, Some(&[[0.0, 0.0, 1.0]]), &usual).is_err());
    for first_direction in [1, usize::MAX] {
        assert!(sun_hours(&matrix, &schedule, None, &usual.with_first_direction(first_direction)).is_err());
    }
    for sufficient_hours in [-1.0, 25.0, f64::NAN] {
        assert!(sun_hours(&matrix, &schedule, None, &usual.with_sufficient_hours(sufficient_hours)).is_err());
    }
    let zone = Zone::utc();
    let [a, b] = [date("2026-03-20").noon_utc(), date("2026-03-21").noon_utc()];
    for period in [
        Period::Days(Vec::new()),
        Period::Days(vec![date("2026-03-20"); 4000]),
        Period::Between([b, a]),
        Period::Between([a, a]),
        Period::Between([a, f64::NAN]),
        Period::Between([a, 1e18]),
    ] {
        assert!(sun_days(&site, &zone, &period, &plain(600.0)).is_err(), "{period:?}");
    }
    // a noon to the next: half of each day's light
    let between = sun_days(&site, &zone, &Period::Between([a, b]), &plain(600.0)).unwrap();
    let hours: Vec<f64> = between.iter().map(|day| day.possible_hours()).collect();
    assert!(hours.len() == 2 && hours.iter().all(|hours| (hours - 6.0).abs() < 0.8), "{hours:?}");
}

#[test]
fn polar_night_has_no_share() {
    let site = site(80.0);
    let schedule = schedule(&site, vec![date("2026-12-21")], &plain(600.0), Binning::Auto);
    let blockers = scene(&[[0.0, 0.0, -1000.0]], &[1.0]);
    let found = hours_at(&blockers, &schedule, &[[0.0; 3]], None);
    assert!(found.hours[0] == 0.0 && found.share[0].is_nan() && found.first[0].is_nan() && found.days[0] == 0);
}

#[test]
fn bits_of_a_matrix_have_the_size_of_its_rows() {
    let matrix = VisibilityMatrix::from_words(3, 70, vec![u64::MAX, 0b11_1111, 0, 0, 7 << 40, 0b10_0001]).unwrap();
    assert!(matrix.is_free(0, 69) && matrix.is_free(2, 42) && matrix.is_free(2, 69));
    assert!(!matrix.is_free(2, 43) && !matrix.is_free(1, 0));
    assert!(VisibilityMatrix::from_words(3, 70, vec![0; 5]).is_err());
    assert!(VisibilityMatrix::from_words(usize::MAX, 70, vec![0; 6]).is_err());
}

/// Returns true if a place with sun between the given hours of the clock of each day, and never else, meets a rule.
fn meets(rule: &str, latitude_deg: f64, sun: &[[f64; 2]]) -> bool {
    let place = Site { latitude: latitude_deg.to_radians(), longitude: 0.0, height: 0.0, convergence: 0.0 };
    let question = SunHoursQuestion {
        rules: vec![rule.to_owned()],
        days: Days { year: Some(2026), time_step_min: Some(3.0), ..Days::default() },
        place: SunPlace { zone: Some("UTC".to_owned()), ..SunPlace::default() },
        sun_tolerance_deg: Some(0.0),
        ..SunHoursQuestion::default()
    };
    let (plan, _) = question.plan(&place).unwrap();
    let count = plan.directions().len();
    let mut words = vec![0_u64; count.div_ceil(64)];
    for step in plan.rules()[0].schedule.days.iter().flat_map(|day| &day.steps) {
        let is_lit = sun.iter().any(|[from, to]| (*from..*to).contains(&step.middle()));
        words[step.direction as usize / 64] |= u64::from(is_lit) << (step.direction % 64);
    }
    let matrix = VisibilityMatrix::from_words(1, count, words).unwrap();
    let mut sums = SunSums::default();
    sums.add(&plan, &RowBlock::from(matrix), None, None).unwrap();
    let targets = Targets::of_places(&[[0.0; 3]], Frame::default());
    let measures = sums.into_measures(&plan, &targets);
    measures.last().unwrap().values[0] == 1.0
}

/// A rule, the latitude of a place, and hours of sun that just meet it and that just do not.
type RuleCase<'a> = (&'a str, f64, &'a [[f64; 2]], &'a [[f64; 2]]);

#[test]
fn rules_are_met_as_they_are_by_hand() {
    // of each rule a place that just meets it and one that just does not, by the clock: sun of a few minutes more and
    // less than the hours that count. UTC is the solar time of the place but for the equation of time: -7 minutes on 21
    // March, +8 on 23 September, -13 on 1 March, -10 on 17 January, -11 on 20 January, +2 on 21 December
    let cases: &[RuleCase] = &[
        ("nl-light", 52.0, &[[11.0, 13.1]], &[[11.0, 12.9]]),
        ("nl-strict", 52.0, &[[10.5, 13.6]], &[[10.5, 13.4]]),
        // the sun stands above 10° all around noon, even in February
        ("the-hague", 52.0, &[[11.0, 13.1]], &[[11.0, 12.9]]),
        ("bre-equinox", 52.0, &[[7.0, 8.1], [15.0, 16.0]], &[[7.0, 8.0], [15.0, 15.9]]),
        ("en17037-minimum", 52.0, &[[11.0, 12.6]], &[[11.0, 12.4]]),
        // in the evening after half past five, the sun is up on the last days only: sunset is at 18:13 on 21 March
        ("1@02-01..03-21,any", 52.0, &[[17.0, 24.0]], &[[17.3, 24.0]]),
        ("1@03-21", 52.0, &[[17.0, 24.0]], &[[17.3, 24.0]]),
        ("en17037-medium", 52.0, &[[10.0, 13.1]], &[[10.0, 12.9]]),
        ("en17037-high", 52.0, &[[10.0, 14.1]], &[[10.0, 13.9]]),
        ("din-winter", 52.0, &[[11.5, 12.6]], &[[11.5, 12.4]]),
        // at the equinox the sun stands above 6° at 52° north until 40 minutes before sunset
        ("din-equinox", 52.0, &[[10.0, 14.1]], &[[6.0, 6.5], [14.0, 17.4]]),
        ("pl", 52.0, &[[6.0, 10.1]], &[[6.0, 9.9]]),
        ("pl-centre", 52.0, &[[15.4, 20.0]], &[[15.6, 20.0]]),
        ("cz", 50.0, &[[11.0, 12.6]], &[[11.0, 12.4]]),
        ("se", 59.0, &[[6.0, 14.1]], &[[6.0, 13.9]]),
        ("nsw", -34.0, &[[7.0, 11.1]], &[[7.0, 10.9]]),
        ("nsw-outer", -34.0, &[[11.9, 17.0]], &[[12.1, 17.0]]),
        // from 8 o'clock solar time, 8:11 by the clock, and until 16:11
        ("cn", 40.0, &[[7.0, 10.3]], &[[7.0, 10.1]]),
        ("2@01-20@8-16,solar", 40.0, &[[14.1, 18.0]], &[[14.3, 18.0]]),
        // one piece, not two
        ("kr", 37.0, &[[8.0, 11.1]], &[[9.0, 10.5], [12.0, 13.5]]),
        ("2@shortest-day@9-15", 37.0, &[[9.0, 10.5], [12.0, 13.5]], &[[8.0, 10.9]]),
    ];
    for (rule, latitude, met, missed) in cases {
        assert!(meets(rule, *latitude, met), "{rule} is met");
        assert!(!meets(rule, *latitude, missed), "{rule} is missed");
    }
    let named: Vec<&str> = SunRule::columns().map(|(name, _)| name).collect();
    assert_eq!(named.len(), 17);
    for name in named {
        assert!(cases.iter().any(|(rule, ..)| *rule == name), "{name} has no case");
    }
}
