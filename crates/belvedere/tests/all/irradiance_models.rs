//! Radiation models against pvlib 0.16.1: the same inputs, unshaded, over a year at three sites
//! (`data/pvlib_reference.py`).

use belvedere::apps::irradiance::{
    BirdParams, ClearSky, SkyModel, air_mass, complete, diffuse_parts, extraterrestrial, patch_radiation, split_global,
};
use belvedere::apps::sky_view::SkyDirections;
use belvedere::vector::dot;
use belvedere::weather::Irradiance;
use std::collections::HashMap;
use std::f64::consts::PI;

/// Accepted relative error: a thousandth.
const SHARE: f64 = 1e-3;
/// Radiation that nobody measures, W/m²: below it a share says nothing.
const FLOOR: f64 = 0.01;

/// The rows of a table by the names of its columns.
fn rows(text: &str) -> Vec<HashMap<&str, f64>> {
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    lines.map(|line| names.iter().copied().zip(line.split(',').map(|cell| cell.parse().unwrap())).collect()).collect()
}

fn skies() -> Vec<HashMap<&'static str, f64>> {
    rows(include_str!("../data/pvlib_skies.csv"))
}

fn near(found: f64, expected: f64, what: &str) {
    assert!((found - expected).abs() <= SHARE * expected.abs() + FLOOR, "{what}: {found}, pvlib {expected}");
}

fn measured(sky: &HashMap<&str, f64>) -> Irradiance {
    Irradiance { ghi: sky["ghi"], dni: sky["dni"], dhi: sky["dhi"] }
}

fn direction(zenith: f64, azimuth: f64) -> [f64; 3] {
    [zenith.sin() * azimuth.sin(), zenith.sin() * azimuth.cos(), zenith.cos()]
}

#[test]
fn clear_skies_are_those_of_pvlib() {
    let skies = skies();
    assert!(skies.len() > 150);
    for sky in &skies {
        let (zenith, height) = (sky["zenith_deg"].to_radians(), sky["altitude"]);
        let outside = extraterrestrial(sky["unix_s"]);
        near(outside, sky["extraterrestrial"], "extraterrestrial");
        near(air_mass(zenith).unwrap(), sky["air_mass"], "air mass");
        let ineichen = ClearSky::Ineichen { linke: sky["linke"] }.irradiance(zenith, height, outside);
        near(ineichen.ghi, sky["ineichen_ghi"], "Ineichen, global");
        near(ineichen.dni, sky["ineichen_dni"], "Ineichen, direct");
        near(ineichen.dhi, sky["ineichen_dhi"], "Ineichen, diffuse");
        let haurwitz = ClearSky::Haurwitz.irradiance(zenith, height, outside);
        near(haurwitz.ghi, sky["haurwitz_ghi"], "Haurwitz, global");
        near(haurwitz.dni, sky["erbs_dni"], "Erbs, direct");
        near(haurwitz.dhi, sky["erbs_dhi"], "Erbs, diffuse");
        let bird = ClearSky::Bird(BirdParams::default()).irradiance(zenith, height, outside);
        near(bird.ghi, sky["bird_ghi"], "Bird, global");
        near(bird.dni, sky["bird_dni"], "Bird, direct");
        near(bird.dhi, sky["bird_dhi"], "Bird, diffuse");
    }
}

#[test]
fn planes_that_nothing_shades_are_those_of_pvlib() {
    let skies = skies();
    let planes = rows(include_str!("../data/pvlib_planes.csv"));
    assert!(planes.len() > 1000);
    for plane in &planes {
        let sky = &skies[plane["sky"] as usize];
        let (zenith, outside) = (sky["zenith_deg"].to_radians(), sky["extraterrestrial"]);
        let (tilt, facing) = (plane["tilt_deg"].to_radians(), plane["azimuth_deg"].to_radians());
        let cosine = dot(direction(zenith, sky["azimuth_deg"].to_radians()), direction(tilt, facing));
        let measured = measured(sky);
        near(measured.dni * cosine.max(0.0), plane["beam"], "beam");
        let models =
            [(SkyModel::Isotropic, "isotropic"), (SkyModel::HayDavies, "hay_davies"), (SkyModel::Perez, "perez")];
        for (model, name) in models {
            let parts = diffuse_parts(model, &measured, zenith, outside);
            near(parts.unshaded(tilt, cosine), plane[name], &format!("{name} at tilt {}", plane["tilt_deg"]));
        }
    }
}

#[test]
fn a_level_plane_gets_the_diffuse_radiation_of_the_patches() {
    for division in [1, 2] {
        let sky_directions = SkyDirections::patches(division).unwrap();
        let mut patches = Vec::new();
        for sky in &skies() {
            let zenith = sky["zenith_deg"].to_radians();
            let sun = direction(zenith, sky["azimuth_deg"].to_radians());
            patch_radiation(&sky_directions, &measured(sky), sun, zenith, sky["extraterrestrial"], &mut patches);
            assert!(patches.iter().all(|v| v.is_finite() && *v >= 0.0));
            let level: f64 = patches.iter().zip(&sky_directions.directions).map(|(patch, d)| patch * d[2]).sum();
            assert!((level - sky["dhi"]).abs() < 1e-9 * sky["dhi"] + 1e-12, "{level} {}", sky["dhi"]);
        }
    }
}

#[test]
fn patches_are_brightest_around_the_sun_of_a_clear_sky_and_above_under_clouds() {
    let sky = SkyDirections::patches(2).unwrap();
    let (zenith, azimuth) = (50f64.to_radians(), 2.0);
    let sun = direction(zenith, azimuth);
    let mut patches = Vec::new();
    let radiance = |patches: &[f64], i: usize| patches[i] / sky.solid_angles[i];
    let nearest = |towards: [f64; 3]| {
        let rank = |i: &usize| (dot(sky.directions[*i], towards) * 1e9) as i64;
        (0..sky.directions.len()).max_by_key(rank).unwrap()
    };
    let clear = Irradiance { ghi: 600.0, dni: 850.0, dhi: 600.0 - 850.0 * zenith.cos() };
    patch_radiation(&sky, &clear, sun, zenith, 1366.0, &mut patches);
    let brightest =
        (0..patches.len()).max_by(|&a, &b| radiance(&patches, a).total_cmp(&radiance(&patches, b))).unwrap();
    // a patch of 577 is six degrees wide
    assert!(dot(sky.directions[brightest], sun) > 6f64.to_radians().cos(), "{:?}", sky.directions[brightest]);
    // across from the sun a clear sky is several times darker than beside it
    let across = nearest([-sun[0], -sun[1], sun[2]]);
    assert!(radiance(&patches, brightest) > 5.0 * radiance(&patches, across));
    // overcast: at this brightness, 0.17, the table has a = 0.87 and b = -0.57, so that the gradation is 1 + a exp b =
    // 1.49 at the zenith and 1 at the horizon; what is added around the sun weighs little
    let overcast = Irradiance { ghi: 150.0, dni: 0.0, dhi: 150.0 };
    patch_radiation(&sky, &overcast, sun, zenith, 1366.0, &mut patches);
    let up = radiance(&patches, nearest([0.0, 0.0, 1.0]));
    let low = radiance(&patches, nearest([1.0, 0.0, 0.06]));
    assert!((1.3..1.7).contains(&(up / low)), "{}", up / low);
}

#[test]
fn a_sky_without_sun_is_even() {
    let sky = SkyDirections::patches(1).unwrap();
    let mut patches = Vec::new();
    let dusk = Irradiance { ghi: 3.0, dni: 0.0, dhi: 3.0 };
    patch_radiation(&sky, &dusk, direction(1.6, 0.0), 1.6, 1366.0, &mut patches);
    let radiances: Vec<f64> = patches.iter().zip(&sky.solid_angles).map(|(patch, angle)| patch / angle).collect();
    // 3 W/m² of an even sky are 3/π per steradian; the patches' sum of cosines errs by 1e-4
    assert!(radiances.iter().all(|v| (v - 3.0 / PI).abs() < 1e-3), "{radiances:?}");
    assert_eq!(ClearSky::default().irradiance(1.6, 0.0, 1366.0), Irradiance::default());
    assert_eq!(air_mass(1.6), None);
}

#[test]
fn radiation_that_is_missing_follows_from_what_is_there() {
    let zenith = 60f64.to_radians();
    let known = Irradiance { ghi: 400.0, dni: 500.0, dhi: 150.0 };
    assert_eq!(complete(400.0, Some(500.0), Some(150.0), zenith, 1366.0), known);
    let without_diffuse = complete(400.0, Some(500.0), None, zenith, 1366.0);
    let without_direct = complete(400.0, None, Some(150.0), zenith, 1366.0);
    // cos 60° is a half but for rounding
    assert!((without_diffuse.dhi - 150.0).abs() < 1e-9 && (without_direct.dni - 500.0).abs() < 1e-9);
    assert_eq!(complete(400.0, None, None, zenith, 1366.0), split_global(400.0, zenith, 1366.0));
    // no beam from a sun at the horizon, however the files round
    assert_eq!(complete(5.0, None, Some(2.0), 89.5f64.to_radians(), 1366.0).dni, 0.0);
    assert!(complete(900.0, None, Some(0.0), 86f64.to_radians(), 1366.0).dni <= 1366.0);
    assert_eq!(split_global(0.0, zenith, 1366.0).dni, 0.0);
}
