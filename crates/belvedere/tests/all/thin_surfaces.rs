//! Thin surfaces, distinguished from solid ones by pulses below them, on a canopy on posts and a block of the same
//! size.

use belvedere::control::Control;
use belvedere::medial::{CarvedInput, ThinSurfaceParams, on_thin_surfaces};
use belvedere::model::{ModelParams, OrientBy, SceneModel};
use belvedere::neighbors::NeighborIndex;
use belvedere::normals::OrientedCloud;
use belvedere::pulses::{FreeSegmentParams, FreeSegments};
use belvedere::query::{Answer, BlockRule, UnprovenAs};
use belvedere::random::uniform;
use belvedere::{Attributes, PointCloud};

const HEIGHT: f64 = 3.0;
/// West, south, east, north of the slab.
const SLAB: [f64; 4] = [-5.0, -3.0, 5.0, 3.0];

/// Object on level ground.
#[derive(Clone, Copy, PartialEq)]
enum Built {
    Canopy,
    Block,
}

struct ThinSurvey {
    points: Vec<[f32; 3]>,
    scanner: Vec<[f32; 3]>,
    /// Classes: 2 for the ground, 1 for anything else.
    classes: Vec<u8>,
    on_top: Vec<bool>,
}

/// `count` pulses from two lines 120 m to either side, 450 m up: 15 degrees. Exact first hits, by hand: the top, the
/// walls of the block, the ground.
fn survey(built: Built, count: u64) -> ThinSurvey {
    let mut survey = ThinSurvey { points: Vec::new(), scanner: Vec::new(), classes: Vec::new(), on_top: Vec::new() };
    for i in 0..count {
        let scanner = [if i % 2 == 0 { -120.0 } else { 120.0 }, 10.0 * (uniform(3, i) - 0.5), 450.0];
        let aim = [24.0 * (uniform(1, i) - 0.5), 16.0 * (uniform(2, i) - 0.5), 0.0];
        // share of the way from the ground to the scanner
        let at = |share: f64| -> [f64; 3] { std::array::from_fn(|k| aim[k] + share * (scanner[k] - aim[k])) };
        let inside = |p: [f64; 3]| (SLAB[0]..=SLAB[2]).contains(&p[0]) && (SLAB[1]..=SLAB[3]).contains(&p[1]);
        let top = at(HEIGHT / 450.0);
        let (p, on_top) = if inside(top) {
            (top, true)
        } else if built == Built::Block && inside(aim) {
            // it entered through a side: the last place outside
            let steps = 0..=300;
            (steps.map(|k| at(HEIGHT / 450.0 * f64::from(k) / 300.0)).find(|&p| !inside(p)).unwrap(), false)
        } else {
            (aim, false)
        };
        survey.points.push(p.map(|v| v as f32));
        survey.scanner.push(scanner.map(|v| v as f32));
        survey.classes.push(if p[2] < 0.01 { 2 } else { 1 });
        survey.on_top.push(on_top);
    }
    survey
}

/// Shares of the points on top and of all others that are found thin.
fn found(survey: &ThinSurvey) -> [f64; 2] {
    let thin = thin(survey);
    [true, false].map(|top| {
        let rows: Vec<usize> = (0..thin.len()).filter(|&row| survey.on_top[row] == top).collect();
        rows.iter().filter(|&&row| thin[row]).count() as f64 / rows.len() as f64
    })
}

fn thin(survey: &ThinSurvey) -> Vec<bool> {
    let (free_segments, _) =
        FreeSegments::new(&survey.points, &survey.scanner, &FreeSegmentParams::default(), &Control::none()).unwrap();
    thin_below(survey, &free_segments)
}

fn thin_below(survey: &ThinSurvey, free_segments: &FreeSegments) -> Vec<bool> {
    let index = NeighborIndex::new(&survey.points, &Control::none()).unwrap();
    let up = vec![[0.0, 0.0, 1.0]; survey.points.len()];
    let oriented = OrientedCloud::with_known_normals(survey.points.clone(), up).unwrap();
    let attributes = &Attributes { classification: Some(survey.classes.clone()), ..Attributes::default() };
    let input = CarvedInput {
        oriented: &oriented,
        measured: &survey.points,
        index: &index,
        attributes,
        free_segments,
        pulses: None,
        statistics: None,
    };
    on_thin_surfaces(&input, &ThinSurfaceParams::default(), &Control::none()).unwrap()
}

/// Ten pulses a square metre.
const PULSES: u64 = 3840;

#[test]
fn a_canopy_is_thin_to_its_middle_and_a_block_is_not() {
    let canopy = survey(Built::Canopy, PULSES);
    let thin = thin(&canopy);
    // pulses reach 0.8 m below the edge at most, and the middle is 3 m from the nearest
    let mut inner_count = 0;
    for (row, p) in canopy.points.iter().enumerate().filter(|&(row, _)| canopy.on_top[row]) {
        let p = p.map(f64::from);
        // two cells from the edge: nearer, a cell that happens to hold ground alone hides the one behind it
        let is_inner = p[0] > SLAB[0] + 1.0 && p[0] < SLAB[2] - 1.0 && p[1] > SLAB[1] + 1.0 && p[1] < SLAB[3] - 1.0;
        inner_count += usize::from(is_inner);
        assert!(thin[row] || !is_inner, "{p:?}");
    }
    assert!(inner_count > 250, "{inner_count}");
    let [top, beside] = found(&canopy);
    // of the points within a cell of the edge, a third of all, a tenth may be hidden so
    assert!(top > 0.96, "{top}");
    assert!(beside == 0.0, "ground was found thin: {beside}");
    assert_eq!(found(&survey(Built::Block, PULSES)), [0.0, 0.0]);
}

#[test]
fn a_canopy_hides_the_sky_and_leaves_room_below_it() {
    let ThinSurvey { points, scanner, classes, .. } = survey(Built::Canopy, PULSES);
    let mut cloud = PointCloud { positions: points, ..PointCloud::default() };
    cloud.attributes.classification = Some(classes);
    let params = ModelParams::default().with_orient(OrientBy::ScannerOfEachPoint(scanner));
    let (model, _) = SceneModel::build(&cloud, &params, &Control::none()).unwrap();
    let scene = model.scene(&BlockRule::carved(), UnprovenAs::Visible, &Control::none()).unwrap();
    let share = |height: f64, towards: [f64; 3]| {
        let places = (0..4000).map(|i| [8.0 * (uniform(8, i) - 0.5), 4.0 * (uniform(9, i) - 0.5), height]);
        let visible = places.filter(|&place| scene.answer(place, towards, f64::INFINITY) == Answer::Visible);
        visible.count() as f64 / 4000.0
    };
    // 0.32 m between pulses, at random; 0.027 measured; circles of 0.95 of that at points only leave a twentieth of a
    // plane open
    let through = share(1.5, [0.0, 0.0, 1.0]);
    assert!(through < 0.04, "{through} of lines see through the canopy");
    // balls of 0.95 spacings reach 0.6 m down
    let below = share(HEIGHT - 0.45, [1.0, 0.0, 0.0]);
    assert!(below > 0.95, "{below} of level lines are free below it");
}

#[test]
fn vegetation_and_ground_are_never_thin() {
    for class in [2, 5] {
        let mut survey = survey(Built::Canopy, PULSES);
        survey.classes.fill(class);
        assert!(!thin(&survey).contains(&true));
    }
}

#[test]
fn neither_order_of_points_nor_number_of_threads_matters() {
    let forward = survey(Built::Canopy, PULSES);
    let mut backward = survey(Built::Canopy, PULSES);
    backward.points.reverse();
    backward.scanner.reverse();
    backward.classes.reverse();
    let on = |threads: usize, survey: &ThinSurvey| {
        rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(|| thin(survey))
    };
    let expected = on(1, &forward);
    let mut turned = on(5, &backward);
    turned.reverse();
    assert!(expected == turned && expected.contains(&true));
}

#[test]
fn no_points_and_no_pulses_are_no_thin_surfaces() {
    let nothing = ThinSurvey { points: Vec::new(), scanner: Vec::new(), classes: Vec::new(), on_top: Vec::new() };
    assert!(thin(&nothing).is_empty());
    let (none, _) = FreeSegments::new(&[], &[], &FreeSegmentParams::default(), &Control::none()).unwrap();
    let survey = survey(Built::Canopy, PULSES);
    let thin = thin_below(&survey, &none);
    assert!(thin.len() == survey.points.len() && !thin.contains(&true));
}
