//! Glare against closed forms of a mirror and of a wall.

use belvedere::apps::ask::{Days, GivenWindow, GlareQuestion, GlareResults, Places, Scene, Standing, SunPlace, ask};
use belvedere::apps::result_columns::{ResultColumn, ResultValues};
use belvedere::control::Control;
use belvedere::model::{ModelParts, SceneModel};
use belvedere::vector::{cross, unit};
use belvedere::{Bounds, Frame, Mesh, PointCloud};
use belvedere_scenes::{PlanPlacement, TriangleScene, extruded};
use std::f64::consts::TAU;
use std::sync::Arc;

/// Radius of the sun (9.3 mrad across), and with the spread of smooth glass, radians.
const SUN_RADIUS: f64 = 0.00465;
const SPREAD_RADIUS: f64 = SUN_RADIUS + 0.0131;
/// Middle, width and height of a pane that faces south.
const PANE: ([f64; 3], [f64; 2]) = ([0.0, 20.0, 12.0], [6.0, 4.0]);

fn scene(walls: &[([f64; 2], [f64; 2], f64)]) -> Scene {
    let bounds = Bounds { low: [-100.0, -100.0, 0.0], high: [100.0, 100.0, 30.0] };
    let parts = ModelParts { frame: Frame::default(), bounds, ..ModelParts::default() };
    let mut model = SceneModel::from_parts(parts).unwrap();
    for (number, &(middle, [along, across], top)) in walls.iter().enumerate() {
        let mut scene = TriangleScene::default();
        let footprint = PlanPlacement { origin: middle, angle: 0.0 }.rectangle(along, across);
        scene.add_object("wall", &[extruded(&footprint, 0.0, top)]);
        let mesh = Mesh { vertices: scene.vertices.clone(), triangles: scene.triangles.clone(), ..Mesh::default() };
        model = model.with_added(&mesh, &format!("wall{number}.obj")).unwrap();
    }
    Scene::new(model, Arc::new(PointCloud::default()))
}

fn question(time_step_min: f64) -> GlareQuestion {
    let (place, size) = PANE;
    GlareQuestion {
        reflectors: vec![GivenWindow { place, azimuth_deg: 180.0, tilt_deg: 90.0, size: Some(size) }],
        days: Days { year: Some(2026), time_step_min: Some(time_step_min), ..Days::default() },
        place: SunPlace { location: Some([52.0, 5.0]), zone: Some("+01:00".to_owned()), ..SunPlace::default() },
        scatter_deg: Some(0.0),
        ..GlareQuestion::default()
    }
}

fn answered(scene: &Scene, question: &GlareQuestion, eyes: &[[f64; 3]]) -> GlareResults {
    let standing = eyes.iter().map(|&place| Standing { place, height: None }).collect();
    ask(scene, question, &Places::Eyes(standing), &Control::none()).unwrap().found
}

/// True if light of a disc around the sun reaches `eye`, by rays from the image of the eye behind the pane.
fn dazzles(eye: [f64; 3], to_sun: [f64; 3], radius: f64) -> bool {
    let ([x, y, z], [width, height]) = PANE;
    let image = [eye[0], 2.0 * y - eye[1], eye[2]];
    let across = unit(cross(to_sun, [0.0, 0.0, 1.0])).unwrap();
    let up = cross(across, to_sun);
    let ray = |radius: f64, turn: f64| {
        let (sin, cos) = turn.sin_cos();
        let towards: [f64; 3] = std::array::from_fn(|i| to_sun[i] + radius * (cos * across[i] + sin * up[i]));
        let share = (y - image[1]) / towards[1];
        let hit: [f64; 3] = std::array::from_fn(|i| image[i] + share * towards[i]);
        towards[1] < 0.0 && (hit[0] - x).abs() <= width / 2.0 && (hit[2] - z).abs() <= height / 2.0
    };
    // rings, since a pane may be smaller than the disc
    let middle = unit(std::array::from_fn(|i| [x, y, z][i] - image[i])).unwrap();
    // far from the pane no ray can meet it: it subtends at most 15 degrees
    if middle[0] * to_sun[0] + middle[1] * to_sun[1] + middle[2] * to_sun[2] < 20_f64.to_radians().cos() {
        return false;
    }
    let middle = unit(std::array::from_fn(|i| [x, y, z][i] - image[i])).unwrap();
    // far from the pane no ray can meet it: it subtends less than 15 degrees
    if middle[0] * to_sun[0] + middle[1] * to_sun[1] + middle[2] * to_sun[2] < 20_f64.to_radians().cos() {
        return false;
    }
    let ring = |share: f64| (0..120).any(|part| ray((share * radius).tan(), TAU * f64::from(part) / 120.0));
    ray(0.0, 0.0) || (1..=4).any(|number| ring(f64::from(number) / 4.0))
}

/// Hours of the suns of which `counts` is true.
fn hours_of(found: &GlareResults, counts: impl Fn([f64; 3]) -> bool) -> f64 {
    let steps = found.schedule.days.iter().flat_map(|day| &day.steps);
    let lit = steps.filter(|step| counts(found.schedule.directions[step.direction as usize]));
    lit.map(|step| f64::from(step.hours)).sum()
}

#[test]
fn a_pane_dazzles_as_the_image_of_the_eye_says() {
    let eyes = [[0.0, -20.0, 1.7], [35.0, -10.0, 8.0], [-60.0, 10.0, 4.0], [0.0, 60.0, 1.7]];
    for (scatter_deg, radius) in [(Some(0.0), SUN_RADIUS), (None, SPREAD_RADIUS)] {
        let question = GlareQuestion { scatter_deg, ..question(3.0) };
        let found = answered(&scene(&[]), &question, &eyes);
        let mut total = 0.0;
        for (number, &eye) in eyes.iter().enumerate() {
            let expected = hours_of(&found, |to_sun| dazzles(eye, to_sun, radius));
            let hours = found.of_observer(number).unwrap().hours;
            // a polygon of 120 sides is smaller than the disc by 4e-4 of its radius, which few steps of 3 min notice
            assert!((hours - expected).abs() <= 0.005 * expected + 0.1, "{number}: {hours} {expected}");
            total += hours;
        }
        assert!(total > 50.0, "{total}");
        // behind the pane there is none
        assert_eq!(found.of_observer(3).unwrap().hours, 0.0);
    }
}

#[test]
fn reflections_near_the_sun_may_be_left_out_and_who_cannot_look_has_no_hours() {
    let mut question = question(4.0);
    // an eye beside the wall looks along it: sun and reflection stand near each other
    let eyes = [[40.0, 15.0, 2.0], [0.0, -20.0, 1.7], [500.0, 0.0, 2.0]];
    let all = answered(&scene(&[]), &question, &eyes);
    question.from_sun_deg = Some(20.0);
    let far = answered(&scene(&[]), &question, &eyes);
    let hours = |found: &GlareResults, observer: usize| found.of_observer(observer).unwrap().hours;
    assert!(hours(&all, 0) > 1.0 && hours(&far, 0) < 0.5 * hours(&all, 0));
    // in front of it the sun is behind the observer, and its reflection before him
    assert_eq!(hours(&all, 1), hours(&far, 1));
    assert_eq!(far.of_observer(2), None);
    let columns = far.columns(&[]);
    let ResultValues::Real(values, _) = &columns[3].values else { panic!() };
    assert!(columns[3].name == "hours" && values.len() == 3 && values[2].is_nan() && values[1] > 1.0);
}

#[test]
fn walls_before_the_sun_and_before_the_eye_end_glare_where_they_stand() {
    let eye = [0.0, -20.0, 1.7];
    let free = answered(&scene(&[]), &question(3.0), &[eye]);
    // a wall 300 m wide, whose edge the light of some suns passes
    let (south, top) = (-60.0, 35.0);
    let far = answered(&scene(&[([0.0, south - 0.5], [300.0, 1.0], top)]), &question(3.0), &[eye]);
    let ([_, y, _], _) = PANE;
    let hours = |lift: f64| {
        hours_of(&free, |to_sun| {
            // the light goes straight on from the image of the eye
            let share = (south - (2.0 * y - eye[1])) / to_sun[1];
            dazzles(eye, to_sun, SUN_RADIUS) && to_sun[1] < 0.0 && eye[2] + share * to_sun[2] > top + lift
        })
    };
    // half of the sun over 80 m is 0.37 m high
    let (least, greatest) = (hours(0.5), hours(-0.5));
    let (found, all) = (far.of_observer(0).unwrap().hours, free.of_observer(0).unwrap().hours);
    assert!(least <= found && found <= greatest, "{least} {found} {greatest}");
    assert!(least > 2.0 && greatest < all - 2.0, "{least} {greatest} {all}");
    // a wall between eye and pane hides all of it, and one beside them nothing
    let near = answered(&scene(&[([0.0, 0.0], [60.0, 1.0], 30.0)]), &question(3.0), &[eye]);
    assert_eq!(near.of_observer(0).unwrap().hours, 0.0);
    let beside = answered(&scene(&[([0.0, 60.0], [60.0, 1.0], 30.0)]), &question(3.0), &[eye]);
    assert_eq!(beside.of_observers, free.of_observers);
}

#[test]
fn hours_of_other_clocks_are_not_lost() {
    // noon of Los Angeles is at 20 o'clock in UTC, and the evening at 3 of the next day
    let mut question = question(5.0);
    question.place.location = Some([34.0, -118.0]);
    question.place.zone = Some("UTC".to_owned());
    question.reflectors[0].azimuth_deg = 270.0;
    let found = answered(&scene(&[]), &question, &[[-30.0, 20.0, 2.0]]);
    let own = found.of_observer(0).unwrap();
    assert!(own.hours > 5.0 && own.between.unwrap()[1] > 24.0, "{own:?}");
    let sum: f64 = found.columns_by_hour().iter().filter(|column| column.name.starts_with("min_")).map(total).sum();
    assert!((sum / 60.0 - own.hours).abs() < 1e-3 * own.hours, "{sum} {}", own.hours);
}

fn total(column: &ResultColumn) -> f64 {
    let ResultValues::Real(values, _) = &column.values else { panic!("{}", column.name) };
    values.iter().sum()
}

#[test]
fn twice_the_time_step_changes_minutes_by_less_than_two_percent() {
    let eyes = [[0.0, -20.0, 1.7], [35.0, -10.0, 8.0]];
    let plain = scene(&[]);
    let [fine, coarse] = [1.0, 2.0].map(|step| answered(&plain, &question(step), &eyes));
    for observer in 0..eyes.len() {
        let [fine, coarse] = [&fine, &coarse].map(|found| found.of_observer(observer).unwrap().hours);
        assert!(fine > 10.0 && (coarse / fine - 1.0).abs() < 0.02, "{fine} {coarse}");
    }
}

#[test]
fn hours_of_months_and_of_several_panes_add_up() {
    let mut question = question(4.0);
    let second = GivenWindow { place: [12.0, 20.0, 12.0], ..question.reflectors[0] };
    question.reflectors.push(second);
    question.scatter_deg = None;
    let found = answered(&scene(&[]), &question, &[[0.0, -20.0, 1.7]]);
    let [one, two, all] = [found.of_pair(0, 0), found.of_pair(0, 1), found.of_observer(0)].map(Option::unwrap);
    assert!(one.hours > 0.0 && two.hours > 0.0);
    assert!(all.hours <= one.hours + two.hours && all.hours >= one.hours.max(two.hours));
    assert!(all.after_image_hours > 0.0 && all.after_image_hours <= all.hours);
    let by_hour = found.columns_by_hour();
    let sum = |name: &str| total(by_hour.iter().find(|column| column.name == name).unwrap());
    let minutes: f64 = (0..24).map(|hour| sum(&format!("min_{hour:02}"))).sum();
    assert!((minutes / 60.0 - all.hours).abs() < 1e-3 * all.hours, "{minutes} {}", all.hours);
    assert!(all.max_day_min >= all.longest_min && all.max_day_min <= 60.0 * all.hours);
    let [from, to] = all.between.unwrap();
    assert!(sum("min_03") == 0.0 && from > 4.0 && to < 22.0);
}

#[test]
fn what_cannot_reflect_is_refused() {
    let good = question(1.0).reflectors[0];
    let ask_with = |change: &dyn Fn(&mut GlareQuestion)| {
        let mut question = question(1.0);
        change(&mut question);
        belvedere::apps::ask::Ask::check(&question).unwrap_err().to_string()
    };
    for (error, words) in [
        (ask_with(&|question| question.reflectors.clear()), "at least one"),
        (
            ask_with(&|question| question.reflectors.push(GivenWindow { size: None, ..good })),
            "number 2, without a size",
        ),
        (ask_with(&|question| question.reflectors[0].tilt_deg = 200.0), "number 1, tilted by 200"),
        (ask_with(&|question| question.scatter_deg = Some(20.0)), "0 to 11.4"),
        (ask_with(&|question| question.from_sun_deg = Some(-1.0)), "0 to 180"),
        (ask_with(&|question| question.days = Days::default()), "a year, as days"),
    ] {
        assert!(error.contains(words), "{error}");
    }
}
