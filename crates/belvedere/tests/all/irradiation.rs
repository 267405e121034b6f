//! Energy over a period: against pvlib's sums where nothing shades, and against single instants among balls.

use belvedere::apps::irradiance::{
    ClearSky, Grouping, Instant, IrradianceParams, Irradiation, PeriodRadiation, SkyModel, Surroundings,
    clear_instants, irradiation, plane_irradiation, scene_irradiation, weather_instants,
};
use belvedere::apps::rows::RowBlock;
use belvedere::apps::sky_view::{SkyDirections, sky_view};
use belvedere::apps::sun::{Site, Zone, sun_position};
use belvedere::control::Control;
use belvedere::medial::MedialBalls;
use belvedere::query::{Answer, BlockRule, MedialScene};
use belvedere::random::uniform;
use belvedere::vector::dot;
use belvedere::weather::{CalendarDay, Irradiance, RowsHold, Weather, WeatherAir, WeatherStep, unix_day};

const YEAR: i32 = 2025;

fn site() -> Site {
    Site { latitude: 51.92f64.to_radians(), longitude: 4.48f64.to_radians(), height: 0.0, convergence: 0.0 }
}

fn year_start(year: i32) -> f64 {
    unix_day(CalendarDay::new(year, 1, 1).unwrap()) as f64 * 86_400.0
}

/// A year of clear sky over Rotterdam, with a turbidity of 3, in steps of 10 minutes.
fn clear_year() -> Vec<Instant> {
    let sky = ClearSky::Ineichen { linke: 3.0 };
    clear_instants(&sky, &site(), [year_start(YEAR), year_start(YEAR + 1)], 600.0, &Zone::utc()).unwrap()
}

fn scene(centers: Vec<[f32; 3]>, radii: Vec<f32>) -> MedialScene {
    let count = radii.len();
    let balls = MedialBalls {
        centers,
        radii,
        source: vec![0; count],
        touch: vec![0; count],
        separation_angles: vec![1.0; count],
    };
    MedialScene::new(&balls, &BlockRule::default()).unwrap()
}

fn facing(tilt_deg: f64, azimuth_deg: f64) -> [f32; 3] {
    let (tilt, azimuth) = (tilt_deg.to_radians(), azimuth_deg.to_radians());
    [tilt.sin() * azimuth.sin(), tilt.sin() * azimuth.cos(), tilt.cos()].map(|v| v as f32)
}

/// kWh/m² of the same year from pvlib 0.16.1: `clearsky.ineichen` at the middles of the same steps, its own solar
/// positions, and `irradiance.get_total_irradiance`, albedo 0.2. Tilt, azimuth, beam, diffuse by three models,
/// reflected.
const PVLIB: [(f64, f64, f64, [f64; 3], f64); 6] = [
    (0.0, 0.0, 1365.528, [265.509, 265.509, 265.198], 0.0),
    (20.0, 180.0, 1706.158, [257.503, 301.090, 318.226], 9.836),
    (35.0, 135.0, 1662.165, [241.501, 291.149, 325.959], 29.497),
    (60.0, 250.0, 1311.298, [199.132, 238.236, 300.012], 81.552),
    (90.0, 180.0, 1292.569, [132.755, 208.349, 271.746], 163.104),
    (90.0, 0.0, 61.157, [132.755, 68.769, 149.558], 163.104),
];

#[test]
fn a_year_that_nothing_shades_is_that_of_pvlib() {
    let instants = clear_year();
    let nothing = scene(Vec::new(), Vec::new());
    let targets = vec![[0.0; 3]; PVLIB.len()];
    let normals: Vec<[f32; 3]> = PVLIB.iter().map(|plane| facing(plane.0, plane.1)).collect();
    for (model, sky) in [SkyModel::Isotropic, SkyModel::HayDavies, SkyModel::Perez].into_iter().enumerate() {
        let radiation = PeriodRadiation::gather(&instants, &IrradianceParams::default().with_sky(sky)).unwrap();
        assert!((radiation.report.ghi - 1631.037).abs() < 1.6 && (radiation.report.dni - 2728.955).abs() < 2.7);
        let sums = scene_irradiation(&nothing, &targets, Some(&normals), &radiation, &Control::none()).unwrap();
        for (sum, plane) in sums.iter().zip(&PVLIB) {
            let (tilt, facing, beam, diffuse, reflected) = *plane;
            let total = beam + diffuse[model] + reflected;
            // a thousandth of what arrives, as the issue asks; cells of directions, too, are within it
            let what = format!("{sky:?}, tilt {tilt} to {facing}: {sum:?}");
            assert!((sum.beam - beam).abs() < 1e-3 * total, "{what}, beam {beam}");
            assert!((sum.diffuse - diffuse[model]).abs() < 1e-3 * total, "{what}, diffuse {}", diffuse[model]);
            assert!((sum.reflected - reflected).abs() < 1e-3 * total, "{what}, reflected {reflected}");
            assert!((sum.unshaded - sum.total()).abs() < 1e-9 * total && sum.loss() < 1e-9, "{what}");
        }
    }
}

#[test]
fn the_sky_of_patches_gives_a_level_plane_all_and_tilted_ones_about_what_perez_does() {
    let instants = clear_year();
    let radiation = PeriodRadiation::gather(&instants, &IrradianceParams::default()).unwrap();
    let normals: Vec<[f32; 3]> = PVLIB.iter().map(|plane| facing(plane.0, plane.1)).collect();
    let nothing = scene(Vec::new(), Vec::new());
    let targets = vec![[0.0; 3]; PVLIB.len()];
    let sums = scene_irradiation(&nothing, &targets, Some(&normals), &radiation, &Control::none()).unwrap();
    assert!((sums[0].diffuse - radiation.report.dhi).abs() < 1e-9 * radiation.report.dhi);
    for (sum, plane) in sums.iter().zip(&PVLIB) {
        let perez = plane.2 + plane.3[2] + plane.4;
        // two models by the same authors from different measurements: a few per cent of the total
        assert!((sum.total() - perez).abs() < 0.05 * perez, "{} to {}: {} {perez}", plane.0, plane.1, sum.total());
    }
}

/// Balls around and above places on the ground.
fn surrounded() -> (MedialScene, Vec<[f32; 3]>) {
    let at = |seed: u64, i: u64| uniform(seed, i) as f32;
    let centers = (0..60).map(|i| [60.0 * at(1, i), 60.0 * at(2, i), 3.0 + 9.0 * at(3, i)]).collect();
    let radii = (0..60).map(|i| 1.0 + 2.0 * at(4, i)).collect();
    let targets = (0..40).map(|i| [60.0 * at(5, i), 60.0 * at(6, i), 0.0]).collect();
    (scene(centers, radii), targets)
}

#[test]
fn directions_gathered_in_cells_shade_as_single_instants_do() {
    let (scene, targets) = surrounded();
    // a sixth of the year's steps, whose suns are as far apart as in the whole
    let instants: Vec<Instant> = clear_year().into_iter().step_by(6).collect();
    for degrees in [1.0, 3.0_f64] {
        let params = IrradianceParams::default().with_sun_cell(degrees.to_radians());
        shades_as_single_instants_do(&scene, &targets, &instants, &params, degrees);
    }
}

fn shades_as_single_instants_do(
    scene: &MedialScene,
    targets: &[[f32; 3]],
    instants: &[Instant],
    params: &IrradianceParams,
    degrees: f64,
) {
    let radiation = PeriodRadiation::gather(instants, params).unwrap();
    let normals = vec![facing(30.0, 160.0); targets.len()];
    let sums = scene_irradiation(scene, targets, Some(&normals), &radiation, &Control::none()).unwrap();
    let normal = normals[0].map(f64::from);
    let mut error = 0.0;
    for (sum, target) in sums.iter().zip(targets) {
        let mut beam = 0.0;
        for instant in instants {
            let cosine = dot(instant.sun, normal);
            if cosine > 0.0 && scene.answer(target.map(f64::from), instant.sun, f64::INFINITY) == Answer::Visible {
                beam += cosine * instant.irradiance.dni * instant.hours / 1000.0;
            }
        }
        error += (sum.beam - beam).abs() / targets.len() as f64;
        // a cell moves the edge of a shadow by half its side: of 40 edges in a year's way few are crossed at once
        assert!((sum.beam - beam).abs() < 0.02 * degrees * sum.unshaded, "{} {beam}", sum.beam);
    }
    assert!(error < 0.005 * degrees * sums[0].unshaded, "{degrees}: {error} of {}", sums[0].unshaded);
    assert!(sums.iter().any(|sum| sum.loss() > 0.2) && sums.iter().any(|sum| sum.loss() < 0.2));
}

/// Suns in cells of 1 degree.
fn fine() -> IrradianceParams {
    IrradianceParams::default().with_sun_cell(1f64.to_radians())
}

#[test]
fn an_even_sky_gives_the_sky_view_factor() {
    let (scene, targets) = surrounded();
    let instants: Vec<Instant> = clear_year().into_iter().step_by(50).collect();
    let params = IrradianceParams::default().with_sky(SkyModel::Isotropic);
    let radiation = PeriodRadiation::gather(&instants, &params).unwrap();
    let sums = scene_irradiation(&scene, &targets, None, &radiation, &Control::none()).unwrap();
    let sky = SkyDirections::patches(2).unwrap();
    let matrix = scene.visibility_matrix(&targets, &sky.directions, &Control::none()).unwrap();
    let seen = sky_view(&matrix, &sky, None).unwrap();
    for (sum, factor) in sums.iter().zip(&seen.factors) {
        // factors are f32, and their patches sum up to 1 within 1e-4
        assert!((sum.diffuse / radiation.report.dhi - f64::from(*factor)).abs() < 2e-4, "{sum:?} {factor}");
    }
    // what obstacles send as if they were ground is what they hide of the sky
    let like_ground = params.with_surroundings(Surroundings::LikeGround);
    let radiation = PeriodRadiation::gather(&instants, &like_ground).unwrap();
    let brighter = scene_irradiation(&scene, &targets, None, &radiation, &Control::none()).unwrap();
    for (sum, factor) in brighter.iter().zip(&seen.factors) {
        let expected = 0.2 * radiation.report.ghi * (1.0 - f64::from(*factor));
        assert!((sum.reflected - expected).abs() < 2e-4 * radiation.report.ghi, "{sum:?} {expected}");
    }
}

#[test]
fn months_add_up_to_the_year() {
    let (scene, targets) = surrounded();
    let instants: Vec<Instant> = clear_year().into_iter().step_by(12).collect();
    let whole = PeriodRadiation::gather(&instants, &fine()).unwrap();
    let params = fine().with_grouping(Grouping::Months);
    let months = PeriodRadiation::gather(&instants, &params).unwrap();
    assert_eq!(months.group_count(), 12);
    let normals = vec![facing(40.0, 200.0); targets.len()];
    let year = scene_irradiation(&scene, &targets, Some(&normals), &whole, &Control::none()).unwrap();
    let parts = scene_irradiation(&scene, &targets, Some(&normals), &months, &Control::none()).unwrap();
    for (year, parts) in year.iter().zip(parts.chunks(12)) {
        // of a cell of directions that the plane itself parts, months on its far side count in the sum of the year
        assert!((Irradiation::sum(parts).total() - year.total()).abs() < 1e-4 * year.unshaded);
        assert!(parts[5].unshaded > 3.0 * parts[11].unshaded, "June has more than December at 52° north");
    }
}

#[test]
fn a_string_gets_what_all_of_its_cells_get() {
    // a ball close above the first of four cells, small beside the others
    let scene = scene(vec![[0.0, -0.6, 0.6]], vec![0.5]);
    let cells: Vec<[f32; 3]> = [0.0_f32, 3.0, 6.0, 9.0].map(|x| [x, 0.0, 0.0]).to_vec();
    let instants: Vec<Instant> = clear_year().into_iter().step_by(7).collect();
    let radiation = PeriodRadiation::gather(&instants, &IrradianceParams::default()).unwrap();
    let matrix = scene.visibility_matrix(&cells, &radiation.directions(), &Control::none()).unwrap();
    let alone = irradiation(&matrix, None, &radiation).unwrap();
    let block = RowBlock::from(matrix);
    let up = [0.0, 0.0, 1.0];
    let string = |strings: &[usize]| plane_irradiation(&block, (0, strings), up, &radiation, 0.0).unwrap();
    let one = string(&[0, 0, 0, 0]);
    let mean = alone.iter().map(Irradiation::total).sum::<f64>() / 4.0;
    assert!((one.mean[0].total() - mean).abs() < 1e-9 * mean);
    // the shaded cell decides alone, or nearly: the others lose a little on the way
    assert!(one.string_limited[0].total() <= alone[0].total() + 1e-9);
    assert!(one.string_limited[0].total() > 0.9 * alone[0].total());
    // strings of one cell each lose no more than the mean does
    let each = string(&[0, 1, 2, 3]);
    assert!((each.string_limited[0].total() - mean).abs() < 1e-9 * mean);
    let two = string(&[0, 0, 1, 1]).string_limited[0].total();
    assert!(one.string_limited[0].total() < two && two < mean);
}

fn weather(steps: Vec<WeatherStep>) -> Weather {
    Weather {
        format: "test",
        latitude: site().latitude,
        longitude: site().longitude,
        height: 0.0,
        rows_hold: RowsHold::Means,
        utc_offset: 0.0,
        steps,
        left_out_count: 0,
        notes: Vec::new(),
    }
}

fn step(hour_of_year: f64, dni: f64) -> WeatherStep {
    let instant = year_start(YEAR) + hour_of_year * 3600.0;
    WeatherStep {
        instant,
        hours: 1.0,
        month: 6,
        ghi: Some(300.0),
        dni: Some(dni),
        dhi: Some(100.0),
        air: WeatherAir::default(),
    }
}

#[test]
fn parts_of_a_row_keep_its_energy_and_follow_the_sun() {
    // through a midsummer day, sunrise among its hours
    let first = 171.0 * 24.0 + 0.5;
    let file = weather((0..24).map(|hour| step(first + f64::from(hour), 400.0)).collect());
    let up = |instants: &[Instant]| {
        instants.iter().filter(|i| i.sun[2] > 0.0).map(|i| i.irradiance.dni * i.hours).sum::<f64>()
    };
    let one = weather_instants(&file, &site(), 1).unwrap();
    let six = weather_instants(&file, &site(), 6).unwrap();
    assert_eq!((one.len(), six.len()), (24, 144));
    let all = |instants: &[Instant]| instants.iter().map(|i| i.irradiance.dhi * i.hours).sum::<f64>();
    assert!((all(&one) - 2400.0).abs() < 1e-6 && (all(&six) - 2400.0).abs() < 1e-6);
    // with one sun an hour the hours of sunrise and sunset count wholly or not at all; with six all that have some sun
    let hours_with_sun = (0..24)
        .filter(|hour| {
            (0..6).any(|part| {
                let at = year_start(YEAR) + (first - 0.5 + f64::from(*hour) + (f64::from(part) + 0.5) / 6.0) * 3600.0;
                sun_position(&site(), at).unwrap().elevation > 0.0
            })
        })
        .count();
    assert!((up(&six) - 400.0 * hours_with_sun as f64).abs() < 1e-6, "{} {hours_with_sun}", up(&six));
    assert!(weather_instants(&file, &site(), 0).is_err() && weather_instants(&file, &site(), 1000).is_err());
    assert!(weather_instants(&weather(Vec::new()), &site(), 1).is_err());
}

#[test]
fn direct_radiation_without_a_sun_is_reported() {
    // a file whose clock is wrong by twelve hours
    let night = weather(vec![step(171.0 * 24.0 + 0.5, 400.0)]);
    let instants = weather_instants(&night, &site(), 1).unwrap();
    let radiation = PeriodRadiation::gather(&instants, &IrradianceParams::default()).unwrap();
    assert!((radiation.report.dni_without_sun - 0.4).abs() < 1e-12 && radiation.report.sun_direction_count == 0);
    let nothing = scene(Vec::new(), Vec::new());
    let sum = scene_irradiation(&nothing, &[[0.0; 3]], None, &radiation, &Control::none()).unwrap()[0];
    assert!(sum.beam == 0.0 && (sum.diffuse - 0.1).abs() < 1e-12);
}

#[test]
fn what_cannot_be_is_refused() {
    let instants = clear_year();
    let gather = |params: IrradianceParams| PeriodRadiation::gather(&instants[..10], &params);
    for albedo in [-0.1, 1.1, f64::NAN] {
        assert!(gather(IrradianceParams::default().with_albedo(albedo)).is_err());
    }
    for sun_cell in [0.0, -1.0, 1e-4, 1.0, f64::NAN, f64::INFINITY] {
        assert!(gather(IrradianceParams::default().with_sun_cell(sun_cell)).is_err(), "{sun_cell}");
    }
    assert!(gather(IrradianceParams::default().with_patch_division(0)).is_err());
    assert!(PeriodRadiation::gather(&[], &IrradianceParams::default()).is_err());
    let bad = Instant { irradiance: Irradiance { ghi: f64::NAN, dni: 0.0, dhi: 0.0 }, ..instants[0] };
    assert!(PeriodRadiation::gather(&[bad], &IrradianceParams::default()).is_err());
    let radiation = gather(IrradianceParams::default()).unwrap();
    let nothing = scene(Vec::new(), Vec::new());
    let matrix = nothing.visibility_matrix(&[[0.0; 3]], &[[0.0, 0.0, 1.0]], &Control::none()).unwrap();
    assert!(irradiation(&matrix, None, &radiation).is_err(), "other directions");
    let places = [[0.0; 3], [f32::NAN, 0.0, 0.0]];
    assert!(scene_irradiation(&nothing, &places, Some(&[[0.0, 0.0, 1.0]]), &radiation, &Control::none()).is_err());
    let normals = [[0.0; 3], [0.0, 0.0, 1.0]];
    let sums = scene_irradiation(&nothing, &places, Some(&normals), &radiation, &Control::none()).unwrap();
    assert!(sums.iter().all(|sum| sum.total().is_nan()), "no normal, no place");
    let period = [year_start(YEAR), year_start(YEAR + 1)];
    for (sky, period, step) in [
        (ClearSky::Ineichen { linke: 0.5 }, period, 600.0),
        (ClearSky::Ineichen { linke: f64::NAN }, period, 600.0),
        (ClearSky::Haurwitz, [period[1], period[0]], 600.0),
        (ClearSky::Haurwitz, period, 0.0),
        (ClearSky::Haurwitz, period, 1e-9),
        (ClearSky::Haurwitz, [0.0, f64::INFINITY], 600.0),
    ] {
        assert!(clear_instants(&sky, &site(), period, step, &Zone::utc()).is_err(), "{sky:?}");
    }
}
