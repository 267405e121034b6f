//! Rows of the visibility matrix as a stream: the same for any blocks, and stopped where that is requested.

use belvedere::apps::exposure::{ShadeAtEachSun, scene_exposure, shaded_shares};
use belvedere::apps::rows::{CrownRows, Obstacles, fold_blocks, fold_rows};
use belvedere::apps::shadow::{Edges, ShadowSun, scene_shadow};
use belvedere::apps::sky_view::{SkyDirections, scene_sky_view, sky_view};
use belvedere::apps::sum_errors::Intervals;
use belvedere::apps::sun::{Binning, Date, DayParams, Period, Site, SunSchedule, Zone, sun_days};
use belvedere::apps::sun_hours::{SunHoursParams, SunPlan, SunRule, SunSums, scene_sun_hours, sun_hours};
use belvedere::apps::targets::Targets;
use belvedere::apps::tree_light::{CrownLight, Leaves, Transmissivity, TreeLight};
use belvedere::control::{Control, Watcher};
use belvedere::medial::{MedialBalls, without_vegetation};
use belvedere::query::{BlockRule, MedialScene};
use belvedere::random::uniform;
use belvedere::{Error, PointCloud};
use std::sync::atomic::{AtomicUsize, Ordering};

fn at(i: u64) -> f32 {
    uniform(11, i) as f32
}

/// Some hundred balls of a little town, every third of them a crown.
fn balls() -> (MedialBalls, Vec<bool>) {
    let count = 300_u64;
    let place = |i: u64| [100.0 * at(3 * i) - 50.0, 100.0 * at(3 * i + 1) - 50.0, 10.0 * at(3 * i + 2)];
    let balls = MedialBalls {
        centers: (0..count).map(place).collect(),
        radii: (0..count).map(|i| 0.5 + 3.0 * at(5000 + i)).collect(),
        source: vec![0; 300],
        touch: vec![0; 300],
        separation_angles: vec![1.0; 300],
    };
    (balls, (0..count).map(|i| i % 3 == 0).collect())
}

fn params() -> BlockRule {
    BlockRule::carved()
}

/// Places on the ground, one of them none.
fn targets(count: u64) -> Targets {
    let place = |i: u64| [f64::from(90.0 * at(9000 + 2 * i)), f64::from(90.0 * at(9001 + 2 * i)), 0.0];
    let (cloud, _) = PointCloud::from_coordinates(&(0..count).map(place).collect::<Vec<_>>());
    let mut targets = Targets::of_points(&cloud, None);
    targets.positions[7] = [f32::NAN; 3];
    targets
}

#[test]
fn blocks_of_any_size_give_the_rows_of_the_whole_matrix() {
    let (balls, vegetation) = balls();
    let scene = MedialScene::new(&balls, &params()).unwrap();
    let opaque = MedialScene::new(&without_vegetation(&balls, &vegetation).unwrap(), &params()).unwrap();
    let trees = TreeLight {
        opaque: opaque.into(),
        crowns: CrownLight::Share { transmissivity: Transmissivity::default(), leaves: Leaves::ByDate },
        medium: None,
    };
    let targets = targets(300);
    let sky = SkyDirections::even(150).unwrap();
    let [whole, opaque] = [&scene, &*trees.opaque]
        .map(|scene| scene.visibility_matrix(&targets.positions, &sky.directions, &Control::none()).unwrap());
    assert_ne!(whole, opaque, "trees must hide something");
    for block in [1, 63, 64, 257, 299, 300, 10_000] {
        let obstacles = Obstacles { scene: &scene, trees: Some(&trees) };
        let mut next = 0;
        fold_blocks(obstacles.into(), &targets.positions, &sky.directions, block, &Control::none(), |rows| {
            assert_eq!((rows.rows.start, rows.matrix.target_count()), (next, rows.rows.len()));
            for row in rows.rows.clone() {
                assert_eq!(rows.matrix.row(row - next), whole.row(row), "{block}: row {row}");
                let Some(CrownRows::Share(without)) = &rows.crowns else { panic!("trees let a share through") };
                assert_eq!(without.row(row - next), opaque.row(row), "{block}: row {row}");
            }
            next = rows.rows.end;
            Ok(())
        })
        .unwrap();
        assert_eq!(next, 300);
    }
    let none = fold_blocks((&scene).into(), &targets.positions, &sky.directions, 0, &Control::none(), |_| Ok(()));
    assert!(matches!(none, Err(Error::InvalidParameter { .. })));
}

#[test]
fn what_is_summed_up_block_by_block_is_what_the_whole_matrix_gives() {
    let (balls, _) = balls();
    let scene = MedialScene::new(&balls, &params()).unwrap();
    let mut targets = targets(300);
    targets.groups = vec![0..100, 100..300];
    targets.weights = (0..300_u32).map(|i| f64::from(1 + i % 4)).collect();
    let sky = SkyDirections::even(145).unwrap();
    let site = Site { latitude: 0.9, longitude: 0.1, height: 0.0, convergence: 0.0 };
    let zone = Zone::mean_solar(&site);
    let schedule = |day: &str| {
        let days = Period::Days(vec![Date::parse(day).unwrap()]);
        let days = sun_days(&site, &zone, &days, &DayParams::default().with_step(1800.0)).unwrap();
        SunSchedule::new(&days, Binning::Exact).unwrap()
    };
    let period = schedule("2026-06-21");
    let none = Control::none();
    let of_sky = scene.visibility_matrix(&targets.positions, &sky.directions, &none).unwrap();
    let of_sun = scene.visibility_matrix(&targets.positions, &period.directions, &none).unwrap();
    let clear = |mut values: Vec<f32>| {
        targets.clear_unasked(&mut values);
        values.into_iter().map(f32::to_bits).collect::<Vec<_>>()
    };

    let seen = scene_sky_view(&scene, &targets, &sky, Intervals::Without, &none).unwrap();
    assert_eq!(clear(seen.factors), clear(sky_view(&of_sky, &sky, None).unwrap().factors));

    let rule = SunRule::parse("2@12-21").unwrap();
    let plan = SunPlan::new(period.clone(), vec![("rule_1".to_owned(), rule, schedule("2026-12-21"))]);
    assert_eq!(plan.directions().len(), period.directions.len() + plan.rules()[0].schedule.directions.len());
    let sums = scene_sun_hours(&scene, &targets, &plan, Some(&site), Intervals::Without, &none).unwrap();
    assert_eq!(sums.period.hours, sun_hours(&of_sun, &period, None, &SunHoursParams::default()).unwrap().hours);
    let mut in_blocks = SunSums::default();
    fold_blocks((&scene).into(), &targets.positions, plan.directions(), 64, &none, |block| {
        in_blocks.add(&plan, &block, None, None)
    })
    .unwrap();
    let figures = |sums: &SunSums| (sums.period.hours.clone(), sums.rules[0].hours.clone(), sums.rules[0].days.clone());
    assert_eq!(figures(&in_blocks), figures(&sums));
    let measures = sums.into_measures(&plan, &targets);
    assert_eq!(measures.last().map(|measure| measure.name.as_str()), Some("rule_1"));
    assert!(measures.iter().all(|measure| measure.values.len() == 300 && measure.values[7].is_nan()));

    let found = scene_exposure(&scene, &targets, &sky, &period, ShadeAtEachSun::Kept, &none).unwrap();
    for (group, shares) in targets.groups.iter().zip(&found.shaded_shares) {
        let own = |(row, &weight): (usize, &f64)| if group.contains(&row) { weight } else { 0.0 };
        let weights: Vec<f64> = targets.weights.iter().enumerate().map(own).collect();
        assert_eq!(shares, &shaded_shares(&of_sun, &weights).unwrap());
    }
}

#[test]
fn a_sun_without_obstacles_lights_all_and_one_below_the_horizon_nothing() {
    let (balls, _) = balls();
    let targets = targets(20);
    let open = MedialScene::new(&MedialBalls::default(), &params()).unwrap();
    let suns = [ShadowSun::at(1.0, 0.5), ShadowSun::at(1.0, -0.1)];
    let lit = scene_shadow(&open, &targets, &suns, Edges::Soft, &Control::none()).unwrap();
    assert!((0..20).all(|row| if row == 7 { lit[0][row].is_nan() } else { lit[0][row] == 1.0 && lit[1][row] == 0.0 }));
    let town = MedialScene::new(&balls, &params()).unwrap();
    let shaded = scene_shadow(&town, &targets, &suns, Edges::Hard, &Control::none()).unwrap();
    assert!(shaded[0].contains(&0.0) && shaded[0].contains(&1.0), "{shaded:?}");
}

/// Cancels after so many checks.
struct CancelDuringRows(AtomicUsize);

impl Watcher for CancelDuringRows {
    fn is_cancelled(&self) -> bool {
        self.0.fetch_update(Ordering::Relaxed, Ordering::Relaxed, |left| left.checked_sub(1)).is_err()
    }
}

#[test]
fn a_cancelled_stream_ends_between_blocks() {
    let (balls, _) = balls();
    let scene = MedialScene::new(&balls, &params()).unwrap();
    let targets = targets(200);
    let sky = SkyDirections::even(64).unwrap();
    let watcher = CancelDuringRows(AtomicUsize::new(0));
    let mut blocks = 0;
    let found = fold_rows((&scene).into(), &targets.positions, &sky.directions, &Control::new(&watcher), |_| {
        blocks += 1;
        Ok(())
    });
    assert!(matches!(found, Err(Error::Cancelled)) && blocks == 0);
    // an error of the fold ends it too
    let failed = fold_blocks((&scene).into(), &targets.positions, &sky.directions, 64, &Control::none(), |_| {
        blocks += 1;
        Err(Error::Cancelled)
    });
    assert!(failed.is_err() && blocks == 1);
}

#[test]
fn targets_inside_a_ball_are_left_out() {
    let balls = MedialBalls {
        centers: vec![[0.0, 0.0, 5.0]],
        radii: vec![2.0],
        source: vec![0],
        touch: vec![0],
        separation_angles: vec![1.0],
    };
    let scene = MedialScene::new(&balls, &params()).unwrap();
    let mut targets = targets(20);
    targets.positions = vec![[0.0, 0.5, 5.0], [0.0, 0.0, 9.0], [f32::NAN; 3]];
    assert_eq!(targets.leave_out_enclosed(&scene, &Control::none()).unwrap(), 1);
    assert_eq!((0..3).map(|row| targets.is_target(row)).collect::<Vec<_>>(), [false, true, false]);
}
