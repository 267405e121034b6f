//! Pulses of structured scans that returned nothing, against the exact town.

use belvedere::control::Control;
use belvedere::io::{ReadOptions, ReadReport, Source, read_cloud};
use belvedere::model::{BuildReport, ModelParams, SceneModel};
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

/// How many lines to the suns, free and blocked in truth, are called blocked, visible and unproven.
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

#[test]
#[ignore]
fn measure() {
    let var = |name: &str, usual: f64| std::env::var(name).ok().and_then(|v| v.parse().ok()).unwrap_or(usual);
    let preset = std::env::var("PRESET").unwrap_or("town".into());
    let preset = Preset::ALL.into_iter().find(|p| p.name() == preset).unwrap();
    let scene = town(&preset.params(var("EXTENT", 100.0), var("SEED", 5.0) as u64));
    let params = TerrestrialParams {
        seed: SEED,
        stations: Stations::Chosen(var("STATIONS", 10.0) as u16),
        ..TerrestrialParams::default()
    };
    let params = TerrestrialParams { angular_step: var("COARSER", 2.0) * params.angular_step, ..params };
    let scan = scan_terrestrial(&scene, &params);
    let (mut cloud, report) = read(&params.grids(&scan));
    eprintln!("{} points {:?}", cloud.len(), report.files[0].notes);
    for with in [true, false] {
        if !with {
            cloud.sky_regions.clear();
        }
        let (model, report) = built(&cloud);
        let pulses = report.pulses.unwrap();
        let start = std::time::Instant::now();
        let [free, blocked] = lines_to_the_sun(&scene, &cloud, &model, 3000);
        let share = |a: usize, of: [usize; 3]| 100.0 * a as f64 / of.iter().sum::<usize>() as f64;
        eprintln!(
            "with {with}: pulses {} sky {}; free {:?}: fb {:.2} unproven {:.2}; blocked {:?}: fv {:.2} unproven {:.2}; {:.1} s",
            pulses.free_segments.used,
            pulses.into_the_sky,
            free,
            share(free[0], free),
            share(free[2], free),
            blocked,
            share(blocked[1], blocked),
            share(blocked[2], blocked),
            start.elapsed().as_secs_f64()
        );
    }
}
