//! Files of a flown town, and plans of it.

use belvedere::apps::ask::north::North;
use belvedere::apps::ask::{
    Days, IrradianceQuestion, Radiation, SOLAR, ShadowQuestion, SkyParts, SkyViewQuestion, SunHoursQuestion, SunPlace,
    Suns, ThroughTrees,
};
use belvedere::apps::irradiance::{ClearSky, IrradianceParams};
use belvedere::apps::sun::Site;
use belvedere::cloud::to_local;
use belvedere::control::Control;
use belvedere::crs::Crs;
use belvedere::io::{read_tif, write_cloud};
use belvedere::{Attributes, Frame, GpsTimeKind, PointCloud};
use belvedere_scenes::{AirborneParams, TownParams, scan_airborne, town};
use belvedere_tiles::{Plan, PlanParams, RunParams, RunReport, Shard, Steps, TileQuestion, Topic, run};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, LazyLock, Mutex, OnceLock};

/// Surveys of all tests: sides of towns, metres, and pulses per m².
pub(crate) static SMALL: LazyLock<TownSurvey> = LazyLock::new(|| TownSurvey::new("small", 60.0, 0.5));
pub(crate) static MIDDLE: LazyLock<TownSurvey> = LazyLock::new(|| TownSurvey::new("middle", 100.0, 1.0));
pub(crate) static LARGE: LazyLock<TownSurvey> = LazyLock::new(|| TownSurvey::new("large", 140.0, 1.0));
pub(crate) static WIDE: LazyLock<TownSurvey> = LazyLock::new(|| TownSurvey::new("wide", 200.0, 1.0));

/// Folder of balls that the first test that needs them makes.
type MadeOnce = Arc<OnceLock<PathBuf>>;

/// A town scanned once for all tests, with its balls for each size of tiles.
pub(crate) struct TownSurvey {
    /// Two files that adjoin along a line from south to north. No test changes them.
    pub(crate) clouds: Vec<PathBuf>,
    folder: PathBuf,
    /// Folders of balls by the size of tiles and by whether a question needs the pulses.
    balls: Mutex<BTreeMap<(u64, bool), MadeOnce>>,
}

impl TownSurvey {
    fn new(name: &str, extent: f64, pulses_per_m2: f64) -> Self {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("city").join(name);
        // Balls of another build may differ.
        let _ = std::fs::remove_dir_all(&folder);
        std::fs::create_dir_all(&folder).unwrap();
        Self { clouds: write_town(&folder, extent, pulses_per_m2), folder, balls: Mutex::default() }
    }

    /// Copies the files into a folder in which a test may change them.
    pub(crate) fn copied(&self, folder: &Path) -> Vec<PathBuf> {
        let copy = |cloud: &PathBuf| {
            let path = folder.join(cloud.file_name().unwrap());
            std::fs::copy(cloud, &path).unwrap();
            path
        };
        self.clouds.iter().map(copy).collect()
    }

    /// Runs a plan of this survey on balls that all runs with tiles of its size share, `max_balls` at a time at most.
    pub(crate) fn run(&self, plan: &Plan, folder: &Path, max_balls: Option<usize>) -> RunReport {
        self.share_balls(plan, folder);
        let report = run_with(plan, folder, max_balls);
        assert_eq!(report.balls_made, 0);
        report
    }

    /// Copies balls into the folder of a run. They depend on the survey, on the size of its tiles, and on whether a
    /// question needs the pulses.
    fn share_balls(&self, plan_of_run: &Plan, folder: &Path) {
        let proves =
            plan_of_run.questions.iter().any(|question| matches!(question.topic(), Topic::Shadow | Topic::Viewshed));
        let tile_size = plan_of_run.tile_size;
        let shared = self.balls.lock().unwrap().entry((tile_size.to_bits(), proves)).or_default().clone();
        let made = shared.get_or_init(|| {
            let folder = self.folder.join(format!("{tile_size}_{proves}"));
            let plan = plan(&self.clouds, &folder, tile_size, if proves { suns() } else { Vec::new() });
            let params = RunParams { steps: Steps::Balls, ..run_params(None) };
            assert!(run(&plan, &folder, &params, &Control::none()).unwrap().failed.is_empty());
            folder.join("balls")
        });
        std::fs::create_dir_all(folder.join("balls")).unwrap();
        for file in made.read_dir().unwrap().map(|entry| entry.unwrap()) {
            std::fs::copy(file.path(), folder.join("balls").join(file.file_name())).unwrap();
        }
    }
}

/// Writes the scan of a town of `extent` metres as two files that adjoin along a line from south to north.
pub(crate) fn write_town(folder: &Path, extent: f64, pulses_per_m2: f64) -> Vec<PathBuf> {
    let scene = town(&TownParams { extent, seed: 5, ..TownParams::default() });
    let scan = scan_airborne(&scene, &AirborneParams { pulses_per_m2, ..AirborneParams::default() });
    let origin = [154_624.0, 462_848.0, 0.0];
    let middle = f64::midpoint(
        scan.x.iter().copied().fold(f64::INFINITY, f64::min),
        scan.x.iter().copied().fold(f64::NEG_INFINITY, f64::max),
    );
    let cloud = PointCloud {
        frame: Frame { origin, crs: Crs::parse("EPSG:7415").unwrap() },
        positions: (0..scan.len()).map(|i| to_local([scan.x[i], scan.y[i], scan.z[i]], origin)).collect(),
        attributes: Attributes {
            classification: Some(scan.classification.clone()),
            gps_time: Some(scan.gps_time.clone()),
            gps_time_kind: GpsTimeKind::AdjustedStandard,
            return_number: Some(scan.return_number.clone()),
            return_count: Some(scan.return_count.clone()),
            scan_angle: Some(scan.scan_angle_deg.iter().map(|a| a.to_radians()).collect()),
            point_source_id: Some(scan.point_source_id.clone()),
            ..Attributes::default()
        },
        ..PointCloud::default()
    };
    let sides: [fn(f64, f64) -> bool; 2] = [|x, middle| x < middle, |x, middle| x >= middle];
    let file = |(number, is_in): (usize, &fn(f64, f64) -> bool)| {
        let rows: Vec<u32> = (0..).zip(&scan.x).filter(|(_, x)| is_in(**x, middle)).map(|(row, _)| row).collect();
        let path = folder.join(format!("half_{number}.laz"));
        write_cloud(&path, &cloud.select(&rows), &[]).unwrap();
        path
    };
    sides.iter().enumerate().map(file).collect()
}

/// Returns the shadow of a sun at an azimuth from grid north and an elevation, radians.
pub(crate) fn shadow(name: &str, azimuth: f64, elevation: f64) -> TileQuestion {
    let suns = Suns::Directions(vec![[azimuth.to_degrees(), elevation.to_degrees()]]);
    let place = SunPlace { north: North::Grid, ..SunPlace::default() };
    let question = ShadowQuestion { suns, place, ..ShadowQuestion::of_times(Vec::new()) };
    TileQuestion::new(name, question.into()).unwrap()
}

/// Returns suns in the south-east at 5, 20 and 60 degrees.
pub(crate) fn suns() -> Vec<TileQuestion> {
    [5.0_f64, 20.0, 60.0].map(|degrees| shadow(&format!("shadow_{degrees}"), 2.2, degrees.to_radians())).to_vec()
}

/// Returns the sky view by so many directions.
pub(crate) fn sky_view(directions: usize) -> TileQuestion {
    let question = SkyViewQuestion { sky: SkyParts::Even(directions), ..SkyViewQuestion::default() };
    TileQuestion::new("sky_view_factor", question.into()).unwrap()
}

/// Returns the hours of sun of days, by the clock of the sun.
pub(crate) fn sun_hours(days: Days) -> TileQuestion {
    let question = SunHoursQuestion { days, place: solar(), ..SunHoursQuestion::default() };
    TileQuestion::new("sun_hours", question.into()).unwrap()
}

/// Returns the energy of a year without clouds.
pub(crate) fn clear_year(params: IrradianceParams) -> TileQuestion {
    let radiation = Radiation::ClearSky { clear_sky: ClearSky::Haurwitz, year: 2026 };
    let (trees, roofs, interval) = (ThroughTrees::default(), None, false);
    let question = IrradianceQuestion { radiation, params, place: solar(), trees, roofs, interval };
    TileQuestion::new("irradiance", question.into()).unwrap()
}

/// Returns the place of the survey with the clock of the sun.
pub(crate) fn solar() -> SunPlace {
    SunPlace { zone: Some(SOLAR.to_owned()), ..SunPlace::default() }
}

/// Returns the location of a survey.
pub(crate) fn site(plan: &Plan) -> Site {
    SunPlace::default().site_of(&plan.frame().unwrap(), &plan.bounds(), None).unwrap().0
}

/// Plans a run and writes the plan into `folder`.
pub(crate) fn plan(clouds: &[PathBuf], folder: &Path, tile_size: f64, questions: Vec<TileQuestion>) -> Plan {
    let params = PlanParams { clouds: clouds.to_vec(), tile_size, ..PlanParams::default() };
    let plan = Plan::make(&params, &Control::none()).unwrap();
    plan.with_questions(questions, &Control::none()).unwrap().write(folder).unwrap();
    Plan::read(folder).unwrap()
}

pub(crate) fn run_all(plan: &Plan, folder: &Path) -> RunReport {
    run_with(plan, folder, None)
}

/// Runs a plan with at most `max_balls` balls at a time.
pub(crate) fn run_with(plan: &Plan, folder: &Path, max_balls: Option<usize>) -> RunReport {
    run(plan, folder, &run_params(max_balls), &Control::none()).unwrap()
}

/// Returns the parameters of a whole run.
pub(crate) fn run_params(max_balls: Option<usize>) -> RunParams<'static> {
    RunParams { shard: Shard::default(), steps: Steps::All, max_balls, seconds: &|| 0.0 }
}

/// Returns the values of all cells of 1 m of a merged raster by their place, metres, without cells of no data.
pub(crate) fn cells<T: Copy + PartialEq>(path: &Path, values: &[T], width: usize, none: T) -> BTreeMap<[i64; 2], T> {
    let corner = read_tif(path).unwrap().place.unwrap().upper_left.map(|v| v.round() as i64);
    let cell = |(number, &value): (usize, &T)| {
        let [column, row] = [number % width, number / width].map(|v| v as i64);
        (value != none).then_some(([corner[0] + column, corner[1] - row], value))
    };
    values.iter().enumerate().filter_map(cell).collect()
}
