//! Light through a hedge and through a crown, whose shares are formulas.

use crate::common::light_share;
use belvedere::apps::ask::remark_on_leaves;
use belvedere::apps::rows::{CrownRows, RowBlock};
use belvedere::apps::sky_view::{SkyDirections, sky_through_crowns};
use belvedere::apps::tree_light::{
    CrownLight, CrownShadows, Foliage, Leaves, Season, Transmissivity, measured_density,
};
use belvedere::control::Control;
use belvedere::medial::{MedialBalls, vegetation_of_classes, vegetation_of_transmission, without_vegetation};
use belvedere::model::FlightDays;
use belvedere::query::{BlockRule, MedialScene, VisibilityMatrix};
use belvedere::view::to_sun;
use belvedere::{Attributes, GpsTimeKind};

const LEAF: u8 = 5;
const WALL: u8 = 6;

/// Balls given with the class of the point each is tangent at.
struct ClassifiedBalls {
    balls: MedialBalls,
    classes: Vec<u8>,
}

impl ClassifiedBalls {
    fn new(list: &[([f64; 3], f64, u8)]) -> Self {
        let balls = MedialBalls {
            centers: list.iter().map(|(center, ..)| center.map(|v| v as f32)).collect(),
            radii: list.iter().map(|&(_, radius, _)| radius as f32).collect(),
            source: (0..).take(list.len()).collect(),
            touch: vec![0; list.len()],
            separation_angles: vec![1.0; list.len()],
        };
        Self { balls, classes: list.iter().map(|&(.., class)| class).collect() }
    }

    /// Returns the free lines past all balls, and past those that are not vegetation.
    fn matrices(&self, directions: &[[f64; 3]]) -> [VisibilityMatrix; 2] {
        let opaque = without_vegetation(&self.balls, &vegetation_of_classes(&self.balls, &self.classes)).unwrap();
        [&self.balls, &opaque].map(|balls| {
            let scene = MedialScene::new(balls, &BlockRule::default()).unwrap();
            scene.visibility_matrix(&[[0.0; 3]], directions, &Control::none()).unwrap()
        })
    }
}

/// Elevation of the tangent to a ball whose centre lies `away` from the eye and `up`.
fn top(away: f64, up: f64, radius: f64) -> f64 {
    up.atan2(away) + (radius / away.hypot(up)).asin()
}

#[test]
fn a_hedge_before_a_low_wall_lets_its_share_of_the_sun_through() {
    // to the north: a hedge of 2 m at 3 m, stacked so that it leaves nothing, and at 12 m the rounded top of a wall of
    // 3 m
    let hedge = [0.0, 0.5, 1.0, 1.5].map(|up| ([0.0, 3.0, up], 0.5, LEAF));
    let wall = [0.0, 0.5, 1.0, 1.5, 2.0, 2.5].map(|up| ([0.0, 12.0, up], 0.5, WALL));
    let balls = ClassifiedBalls::new(&[&hedge[..], &wall[..]].concat());
    let elevations: Vec<f64> = (0..90).map(|degree| (f64::from(degree) + 0.5).to_radians()).collect();
    let directions: Vec<[f64; 3]> = elevations.iter().map(|&elevation| to_sun(0.0, elevation)).collect();
    let [all, opaque] = balls.matrices(&directions);
    let (hedge, wall) = (top(3.0, 1.5, 0.5), top(12.0, 2.5, 0.5));
    assert!(wall < hedge);
    let share = |elevation: f64, transmissivity: f64| match elevation {
        e if e > hedge => 1.0,
        e if e > wall => transmissivity,
        _ => 0.0,
    };
    for transmissivity in [0.0, 0.03, 0.4, 1.0] {
        for (direction, &elevation) in elevations.iter().enumerate() {
            let found = light_share(&all, &opaque, 0, direction, transmissivity);
            assert_eq!(found, share(elevation, transmissivity), "{} degrees", elevation.to_degrees());
        }
        let expected: f64 = elevations.iter().map(|&e| 0.25 * share(e, transmissivity)).sum();
        let block = RowBlock { crowns: Some(CrownRows::Share(opaque.clone())), ..RowBlock::from(all.clone()) };
        let mixed = 0.25 * block.light(0, transmissivity).iter().sum::<f64>();
        assert!((mixed - expected).abs() < 1e-9, "{mixed} instead of {expected}");
    }
}

#[test]
fn a_crown_takes_of_the_sky_what_it_covers_but_its_share() {
    // a crown of 2 m of radius, 5 m above
    let balls = ClassifiedBalls::new(&[([0.0, 0.0, 5.0], 2.0, LEAF)]);
    let sky = SkyDirections::even(2305).unwrap();
    let [all, opaque] = balls.matrices(&sky.directions);
    let block = RowBlock { crowns: Some(CrownRows::Share(opaque)), ..RowBlock::from(all) };
    let sin: f64 = 2.0 / 5.0;
    let covered = [sin * sin, 1.0 - (1.0 - sin * sin).sqrt()];
    for transmissivity in [0.0, 0.05, 0.5] {
        let seen = sky_through_crowns(&block, &sky, None, transmissivity).unwrap();
        for (found, covered) in [seen.factors[0], seen.openness[0]].into_iter().zip(covered) {
            let expected = 1.0 - (1.0 - transmissivity) * covered;
            // 2305 directions err by 0.0015
            assert!((f64::from(found) - expected).abs() < 0.002, "{found} instead of {expected}");
        }
    }
    for share in [-0.01, 1.01, f64::NAN, f64::INFINITY] {
        assert!(Transmissivity::constant(share).is_err(), "{share}");
    }
}

#[test]
fn trees_are_in_leaf_from_april_to_october_and_half_a_year_later_in_the_south() {
    let north = 52f64.to_radians();
    let states = |latitude: f64| (1..=366).map(move |day| Foliage::on_day(day, latitude));
    let in_leaf = |latitude: f64| states(latitude).filter(|state| *state == Foliage::InLeaf).count();
    assert_eq!(in_leaf(north), 204);
    assert_eq!(
        [96, 97, 300, 301].map(|day| Foliage::on_day(day, north) == Foliage::InLeaf),
        [false, true, true, false]
    );
    // in the south at Christmas and not in July
    assert_eq!([15, 200, 359].map(|day| Foliage::on_day(day, -north) == Foliage::InLeaf), [true, false, true]);
    assert!((in_leaf(-north) as i32 - 204).abs() <= 1);
    // no winter in the tropics
    assert_eq!(in_leaf(-0.1), 366);
    let usual = Transmissivity::default();
    assert!(usual.of(Foliage::InLeaf) < 0.06 && (0.4..=0.53).contains(&usual.of(Foliage::Bare)));
}

/// Points measured at noon of days, seconds since 1970.
fn flown_on(noons: &[f64]) -> FlightDays {
    // GPS times of files count from 10⁹ s after 6 January 1980, without the 18 leap seconds since
    let times = noons.iter().map(|noon| noon - 1e9 - 315_964_800.0 + 18.0).collect();
    let gps_time_kind = GpsTimeKind::AdjustedStandard;
    FlightDays::of(&Attributes { gps_time: Some(times), gps_time_kind, ..Attributes::default() })
}

#[test]
fn crowns_measured_bare_are_denser_in_leaf_by_what_leaves_take_of_the_light() {
    let (north, south) = (52f64.to_radians(), -35f64.to_radians());
    // 10 February and 10 July 2020
    let [winter, summer] = [1_581_336_000.0, 1_594_382_400.0];
    // what is left of the light in leaf, 0.03, and bare, 0.5, as depths
    let bare = 0.5f64.ln() / 0.03f64.ln();
    let density = |noons: &[f64], latitude: f64| measured_density(&flown_on(noons), latitude);
    assert_eq!((density(&[winter], north), density(&[summer], north)), (Some(bare), Some(1.0)));
    assert_eq!((density(&[winter], south), density(&[summer], south)), (Some(1.0), Some(bare)));
    assert_eq!((density(&[winter], 0.1), density(&[], north)), (Some(1.0), None));
    let both = density(&[winter, winter, winter, summer], north).unwrap();
    assert!((both - (0.75 * bare + 0.25)).abs() < 1e-12, "{both}");
    let crowns = |density, leaves| CrownLight::Measured { leaves, density, shadows: CrownShadows::Answers };
    let on = |day_of_year| Some(Season { day_of_year, latitude: north });
    let of_winter = crowns(density(&[winter], north), Leaves::ByDate);
    // as flown in winter and without a date, and by leaves in summer
    assert_eq!([on(41), None, on(172)].map(|season| of_winter.factor(season)), [1.0, 1.0, 1.0 / bare]);
    let of_summer = crowns(density(&[summer], north), Leaves::ByDate);
    assert_eq!([on(41), None, on(172)].map(|season| of_summer.factor(season)), [bare, 1.0, 1.0]);
    // what is given holds against the date, and nothing where the day of the flight is unknown
    assert_eq!(crowns(Some(bare), Leaves::On).factor(on(41)), 1.0 / bare);
    assert_eq!(crowns(Some(bare), Leaves::Off).factor(on(172)), 1.0);
    assert_eq!([on(41), on(172)].map(|season| crowns(None, Leaves::ByDate).factor(season)), [1.0, 1.0]);
}

#[test]
fn a_remark_says_what_became_of_leaves() {
    let crowns = |density, leaves| CrownLight::Measured { leaves, density, shadows: CrownShadows::Answers };
    let in_june = Some(Season { day_of_year: 172, latitude: 0.9 });
    let key =
        |crowns: CrownLight, season| remark_on_leaves(crowns, crowns.known_factors([season])).map(|remark| remark.key);
    let unlike = Some("leaves-unlike-measured");
    assert_eq!(key(crowns(Some(0.2), Leaves::ByDate), in_june), unlike);
    assert_eq!(key(crowns(Some(1.0), Leaves::ByDate), in_june), None);
    assert_eq!(key(crowns(Some(1.0), Leaves::Off), None), unlike);
    assert_eq!(key(crowns(None, Leaves::ByDate), in_june), Some("leaves-not-known"));
    assert_eq!(key(crowns(None, Leaves::ByDate), None), None);
    let denser = crowns(Some(0.25), Leaves::ByDate);
    let remark = remark_on_leaves(denser, denser.known_factors([in_june])).unwrap();
    assert!(remark.text.contains("4 times as dense") && remark.text.contains("too dark"), "{}", remark.text);
}

#[test]
fn balls_at_points_of_vegetation_differ_from_others() {
    let balls =
        ClassifiedBalls::new(&[([0.0; 3], 1.0, LEAF), ([5.0, 0.0, 0.0], 2.0, LEAF), ([9.0, 0.0, 0.0], 9.0, WALL)]);
    let transmission = [0.5, 0.25, f32::NAN];
    assert_eq!(vegetation_of_transmission(&transmission), [true, true, false]);
    assert_eq!(vegetation_of_classes(&balls.balls, &balls.classes), [true, true, false]);
    // classes of a cloud that is shorter than it should be name nothing
    assert_eq!(vegetation_of_classes(&balls.balls, &[LEAF]), [true, false, false]);
    assert!(without_vegetation(&balls.balls, &[true]).is_err());
}
