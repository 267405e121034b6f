//! `belvedere irradiance`.

mod planes;
mod radiation;
mod seasons;

use super::sights::{Proving, blockers, scene_params};
use super::sky_targets::{Measure, SkyTargets};
use crate::arguments::{Global, Irradiance, Usage};
use crate::pipeline::{self, Points};
use crate::progress::Stages;
use crate::summary::Summary;
use anyhow::Result;
use belvedere::apps::irradiance::Irradiation;
use seasons::Light;

/// Columns of the months.
const MONTHS: [&str; 12] = [
    "kwh_m2_01",
    "kwh_m2_02",
    "kwh_m2_03",
    "kwh_m2_04",
    "kwh_m2_05",
    "kwh_m2_06",
    "kwh_m2_07",
    "kwh_m2_08",
    "kwh_m2_09",
    "kwh_m2_10",
    "kwh_m2_11",
    "kwh_m2_12",
];
/// Digits of energies, kWh/m², and of shares.
const ENERGY_DECIMALS: usize = 2;
const SHARE_DECIMALS: usize = 4;

pub(crate) fn run(arguments: &Irradiance, global: &Global) -> Result<Summary> {
    let outputs = arguments.outputs.of_places();
    arguments.places.check(&outputs)?;
    let wants_places = !outputs.output.is_empty();
    if !wants_places && outputs.measures.is_some() {
        return Err(Usage("--measures needs -o".to_owned()).into());
    }
    planes::check(arguments)?;
    let params = radiation::params(arguments)?;
    let mut stages = Stages::new(global);
    let mut summary = Summary::default();
    // a mistyped weather file must not be told after the balls were made
    let weather = radiation::weather(arguments, &mut stages)?;
    let needs_points = !arguments.planes.is_empty() || arguments.places.needs_points();
    let points = if needs_points { Points::Keep } else { Points::LetGo };
    let mut scene = pipeline::scene(&arguments.scene, points, &mut stages, &mut summary)?;
    let site = radiation::site(arguments, &scene, weather.as_ref(), &mut summary)?;
    let profile = arguments.scene.profile.into();
    let blocking = scene_params(&scene, profile, &arguments.shell.giving_way());
    let trees = arguments.trees.of(&scene, &blocking, &mut summary)?;
    let sky = radiation::Sky { site: &site, weather: weather.as_ref(), trees: trees.as_ref() };
    let seasons = radiation::gather(arguments, &params, &sky, &mut stages, &mut summary)?;
    let roofs = planes::find(arguments, &mut scene, &mut stages, &mut summary)?;
    let targets = match wants_places {
        true => Some(arguments.places.targets(&mut scene, global.seed, &mut stages, &mut summary)?),
        false => None,
    };
    let mut section = Summary::default();
    let (blockers, _) =
        blockers(&scene, profile, &arguments.shell.giving_way(), Proving::Never, &mut stages, &mut section)?;
    let light = Light { blockers: &blockers, trees: trees.as_ref(), seasons: &seasons };
    section.add("directions", light.direction_count());
    summary.add("lines_of_sight", section);
    if let Some(targets) = &targets {
        let normals = targets.normals.as_deref();
        let looks = targets.positions.len() * light.look_count();
        let sums = stages
            .run("looking at sun and sky", looks, |progress| light.of_places(&targets.positions, normals, progress))?;
        write_places(targets, &sums, light.group_count(), &outputs, &mut stages, &mut summary)?;
    }
    if let Some(roofs) = &roofs {
        planes::measure(arguments, roofs, &light, &site, &mut stages, &mut summary)?;
    }
    summary.add_seconds(stages.into_seconds());
    Ok(summary)
}

fn write_places(
    targets: &SkyTargets,
    sums: &[Irradiation],
    group_count: usize,
    outputs: &crate::arguments::SkyOutputs,
    stages: &mut Stages,
    summary: &mut Summary,
) -> Result<()> {
    let whole: Vec<Irradiation> = sums.chunks(group_count).map(Irradiation::sum).collect();
    #[expect(clippy::cast_possible_truncation, reason = "energies for people")]
    let column =
        |value: &dyn Fn(&Irradiation) -> f64| -> Vec<f32> { whole.iter().map(|sum| value(sum) as f32).collect() };
    let totals = column(&Irradiation::total);
    let losses = column(&Irradiation::loss);
    let (beams, diffuse) = (column(&|sum| sum.beam), column(&|sum| sum.diffuse));
    let (reflected, unshaded) = (column(&|sum| sum.reflected), column(&|sum| sum.unshaded));
    let energy =
        |name, description, values| Measure { name, description, decimals: ENERGY_DECIMALS, range: None, values };
    let mut measures = vec![
        energy("kwh_m2", "energy of the period, kWh/m2", &totals[..]),
        Measure {
            name: "loss",
            description: "share lost by shading",
            decimals: SHARE_DECIMALS,
            range: Some([0.0, 1.0]),
            values: &losses,
        },
        energy("beam_kwh_m2", "straight from the sun, kWh/m2", &beams),
        energy("sky_kwh_m2", "diffuse, from the sky, kWh/m2", &diffuse),
        energy("ground_kwh_m2", "reflected, kWh/m2", &reflected),
        energy("free_kwh_m2", "without obstacles, kWh/m2", &unshaded),
    ];
    #[expect(clippy::cast_possible_truncation, reason = "energies for people")]
    let of_month = |month: usize| -> Vec<f32> {
        sums.iter().skip(month).step_by(group_count).map(|sum| sum.total() as f32).collect()
    };
    let months: Vec<Vec<f32>> =
        if group_count == MONTHS.len() { (0..group_count).map(of_month).collect() } else { Vec::new() };
    for (values, name) in months.iter().zip(MONTHS) {
        measures.push(energy(name, "energy of a month, kWh/m2", values));
    }
    summary.add("irradiation", targets.told(&measures));
    targets.write(outputs, &measures, "Energy of sun and sky, kWh/m²", stages, summary)
}
