//! Pulses of structured scans that returned nothing, against the exact town.

use belvedere::control::Control;
use belvedere::io::{ReadOptions, ReadReport, Source, read_cloud};
use belvedere::model::{BuildReport, ModelParams, OrientBy, SceneModel};
use belvedere::query::{Answer, UnprovenAs, Viewer, Visibility};
use belvedere::view::to_sun;
use belvedere::{Bounds, PointCloud};
use belvedere_scenes::{
    Preset, QuerySet, QuerySite, ScanGrid, Stations, TerrestrialParams, TriangleScene, Truth, scan_terrestrial, town,
};

const SEED: u64 = 5;
/// Azimuth and elevation, degrees.
const SUNS: [[f64; 2]; 3] = [[110.0, 20.0], [180.0, 65.0], [240.0, 35.0]];

fn read(grids: &[ScanGrid]) -> (PointCloud, ReadReport) {
    let text: String = grids.iter().map(ScanGrid::to_ptx).collect();
    let source = Source::bytes("scans.ptx", text.as_bytes());
    read_cloud([source], &ReadOptions::default(), &Control::none()).unwrap()
}

fn built(cloud: &PointCloud) -> (SceneModel, BuildReport) {
    SceneModel::build(cloud, &ModelParams::default(), &Control::none()).unwrap()
}

/// Counts lines to the suns, free and blocked in truth, that are called blocked, visible and unproven.
fn lines_to_the_sun(scene: &TriangleScene, cloud: &PointCloud, model: &SceneModel, count: usize) -> [[usize; 3]; 2] {
    let medial = model.scene(&model.rule(), UnprovenAs::Reported, &Control::none()).unwrap();
    let truth = Truth::new(scene);
    let origin = cloud.frame.origin;
    let absolute = |p: [f32; 3]| -> [f64; 3] { std::array::from_fn(|i| f64::from(p[i]) + origin[i]) };
    let Bounds { low, high } = cloud.bounds().unwrap();
    let site = QuerySite { scene, truth: &truth, bounds: [absolute(low), absolute(high)] };
    let people = site.targets(QuerySet::Pedestrians, count, SEED).positions;
    let people: Vec<[f32; 3]> = people.iter().map(|&p| belvedere::cloud::to_local(p, origin)).collect();
    let mut tally = [[0; 3]; 2];
    for sun in SUNS {
        let [azimuth, elevation] = sun.map(f64::to_radians);
        let towards = to_sun(azimuth, elevation);
        let answers = medial.visible(Viewer::Direction(towards), &people).unwrap();
        for (&place, answer) in people.iter().zip(answers) {
            let is_blocked = truth.occluded_towards(absolute(place), towards);
            let place = match answer {
                Answer::Blocked => 0,
                Answer::Visible => 1,
                Answer::Unproven => 2,
                _ => continue,
            };
            tally[usize::from(is_blocked)][place] += 1;
        }
    }
    tally
}

/// A small town scanned from some places, a pulse for each degree.
fn scanned(stations: u16) -> (TriangleScene, Vec<ScanGrid>) {
    let scene = town(&Preset::Town.params(60.0, SEED));
    let usual = TerrestrialParams::default();
    let params = TerrestrialParams {
        seed: SEED,
        stations: Stations::Chosen(stations),
        angular_step: 4.0 * usual.angular_step,
        ..usual
    };
    let grids = params.grids(&scan_terrestrial(&scene, &params));
    (scene, grids)
}

fn share(part: usize, of: [usize; 3]) -> f64 {
    100.0 * part as f64 / of.iter().sum::<usize>() as f64
}

#[test]
fn pulses_into_the_sky_prove_most_light_of_streets_and_change_nothing_else() {
    let (scene, grids) = scanned(6);
    let (cloud, report) = read(&grids);
    assert!(report.files[0].notes.iter().any(|note| note.contains("see the sky")), "{:?}", report.files[0].notes);
    let (model, report) = built(&cloud);
    let pulses = report.pulses.unwrap();
    assert!(pulses.into_the_sky > Some(1000) && pulses.blocked.unwrap().percent < 0.1, "{pulses:?}");
    let without = built(&PointCloud { sky_regions: Vec::new(), ..cloud.clone() }).0;
    let surfaces = |model: &SceneModel| (model.balls().centers.clone(), model.balls().radii.clone());
    assert!(surfaces(&model) == surfaces(&without), "these pulses do not carve");
    let [free, blocked] = lines_to_the_sun(&scene, &cloud, &model, 1500);
    let [free_before, blocked_before] = lines_to_the_sun(&scene, &cloud, &without, 1500);
    assert_eq!((free[0], blocked[0]), (free_before[0], blocked_before[0]), "what is blocked stays");
    let [unproven, before] = [share(free[2], free), share(free_before[2], free_before)];
    assert!(before > 90.0 && unproven < 40.0, "{unproven} {before}");
    let right = 100.0 * free[1] as f64 / (free[1] + blocked[1]) as f64;
    assert!(right > 97.0, "{right}: {free:?} {blocked:?}");
}

#[test]
fn ball_files_keep_pulses_into_the_sky_and_threads_do_not_change_them() {
    let (scene, grids) = scanned(2);
    let (cloud, _) = read(&grids);
    let (model, report) = built(&cloud);
    let count = report.pulses.unwrap().into_the_sky;
    assert!(count > Some(500), "{count:?}");
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("town.balls.npz");
    belvedere::io::write_balls(&path, model.parts()).unwrap();
    let kept = SceneModel::from_parts(belvedere::io::read_balls(&path).unwrap()).unwrap();
    let answers = |model: &SceneModel| lines_to_the_sun(&scene, &cloud, model, 300);
    assert_eq!(answers(&kept), answers(&model));
    let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let (of_one, _) = alone.install(|| built(&read(&grids).0));
    assert_eq!(of_one.pulses(), model.pulses());
}

#[test]
fn poses_that_the_user_replaces_leave_the_sky_unused() {
    let (_, grids) = scanned(1);
    let (cloud, _) = read(&grids);
    let place = grids[0].station;
    let params = ModelParams::default().with_orient(OrientBy::ScannerAt([place[0], place[1], place[2] + 0.2]));
    let (_, report) = SceneModel::build(&cloud, &params, &Control::none()).unwrap();
    assert_eq!(report.pulses.unwrap().into_the_sky, None);
}

/// The pulses of a station that return from between two elevations and two azimuths, degrees, return nothing.
fn swallowed(grid: &ScanGrid, elevations: [f64; 2], azimuths: [f64; 2]) -> (ScanGrid, usize) {
    let mut grid = grid.clone();
    let mut count = 0;
    for found in &mut grid.returns {
        let Some(p) = *found else { continue };
        let [x, y, z]: [f64; 3] = std::array::from_fn(|i| p[i] - grid.station[i]);
        let elevation = z.atan2(x.hypot(y)).to_degrees();
        let azimuth = y.atan2(x).to_degrees();
        if (elevations[0]..elevations[1]).contains(&elevation) && (azimuths[0]..azimuths[1]).contains(&azimuth) {
            *found = None;
            count += 1;
        }
    }
    (grid, count)
}

/// Azimuth of a station, whole degrees, around which no pulse below an elevation met nothing.
fn walled_azimuth(grid: &ScanGrid, elevation: f64) -> f64 {
    let reaches = |azimuth: f64| {
        let (_, count) = swallowed(grid, [5.0, elevation], [azimuth - 5.0, azimuth + 5.0]);
        count as f64 > 0.97 * 10.0 * (elevation - 5.0)
    };
    (-170..170).map(f64::from).find(|&azimuth| reaches(azimuth)).unwrap()
}

#[test]
fn a_window_and_a_dark_place_on_the_ground_prove_nothing() {
    let (_, grids) = scanned(2);
    let grid = &grids[0];
    let azimuth = walled_azimuth(grid, 25.0);
    let around = [azimuth - 3.0, azimuth + 3.0];
    let (window, of_window) = swallowed(grid, [8.0, 20.0], around);
    let (puddle, of_puddle) = swallowed(grid, [-40.0, -10.0], around);
    let (van, of_van) = swallowed(grid, [-10.0, 4.0], around);
    assert!(of_window > 60 && of_puddle > 100 && of_van > 60, "{of_window} {of_puddle} {of_van}");
    let sky = |grid: &ScanGrid| {
        let cloud = read(std::slice::from_ref(grid)).0;
        let [region] = &cloud.sky_regions[..] else { panic!("no sky") };
        (region.columns, region.is_open.clone())
    };
    let expected = sky(grid);
    assert!(expected.1.contains(&true));
    for swallowing in [window, puddle, van] {
        assert!(sky(&swallowing) == expected, "empty cells that are not the sky");
    }
}
