//! Certainty of answers on the command line: bands and columns of probabilities, uncertain answers, intervals.

use crate::common::{Workplace, column};
use belvedere::control::Control;
use belvedere::io::{ReadBands, ReadOptions, read_cloud, read_tif_bands};

/// A surveyed village, and what reads it.
fn village() -> Workplace {
    let place = Workplace::new();
    place.summary("simulate village -o town --extent 70 --density 8");
    place.summary("balls town/cloud.laz -o balls.npz");
    place
}

fn numbers(place: &Workplace, name: &str) -> Vec<Vec<f32>> {
    match read_tif_bands(place.path(name).as_path()).unwrap() {
        ReadBands::F32(bands) => bands.iter().map(|band| band.values().to_vec()).collect(),
        _ => panic!("{name} does not hold numbers"),
    }
}

fn counts(place: &Workplace, name: &str) -> Vec<u16> {
    match read_tif_bands(place.path(name).as_path()).unwrap() {
        ReadBands::U16(bands) => bands[0].values().to_vec(),
        _ => panic!("{name} does not hold counts"),
    }
}

#[test]
fn shadows_viewsheds_and_lines_say_how_likely_they_are() {
    let place = village();
    let shadow = "shadow town/cloud.laz --sun 200,30 --cell 1";
    let plain = place.summary(&format!("{shadow} -o plain.tif"));
    let sure = place.summary(&format!("{shadow} --probability --certain 0.9 -o sure.tif -o sure.png -o sure.csv"));
    // answers stay
    assert_eq!(plain["measures"]["lit"], sure["measures"]["lit"], "{sure}");
    assert!(plain["certainty"].is_null());
    let certainty = &sure["certainty"];
    let percent = ["certainly_visible_percent", "certainly_blocked_percent", "uncertain_percent"]
        .map(|name| certainty[name].as_f64().unwrap());
    // each is rounded to a hundredth
    assert!((percent.iter().sum::<f64>() - 100.0).abs() < 0.02 && percent.iter().all(|p| *p > 0.1), "{certainty}");
    let bands = numbers(&place, "sure.tif");
    let [lit, unproven, likely, uncertain] = &bands[..] else { panic!("{} bands", bands.len()) };
    let (mut counted, mut doubtful) = (0, 0);
    for row in 0..lit.len() {
        if likely[row] < 0.0 {
            assert!(uncertain[row] < 0.0);
            continue;
        }
        let is_uncertain = likely[row].max(1.0 - likely[row]) < 0.9 || unproven[row] > 0.0;
        assert_eq!(uncertain[row] > 0.0, is_uncertain, "{} {}", likely[row], unproven[row]);
        counted += 1;
        doubtful += usize::from(is_uncertain);
    }
    assert!(counted > 2000 && doubtful > 20, "{doubtful} of {counted}");
    let agrees = (0..lit.len()).filter(|&row| likely[row] >= 0.0 && (likely[row] > 0.5) == (lit[row] > 0.0)).count();
    assert!(agrees as f64 > 0.95 * f64::from(counted), "{agrees} of {counted}");
    assert_eq!(column(&place, "sure.csv", "probability").len(), column(&place, "sure.csv", "lit").len());
    assert!(place.bytes("sure.png").starts_with(b"\x89PNG"));

    let info = place.summary("info town/cloud.laz");
    let corner = |which: &str, axis: usize| info[which][axis].as_f64().unwrap();
    let at =
        |share: f64| [0, 1].map(|axis| (1.0 - share) * corner("min_corner", axis) + share * corner("max_corner", axis));
    let [[ax, ay], [bx, by]] = [at(0.4), at(0.6)];
    let viewshed = format!("viewshed town/cloud.laz --observer {ax},{ay} --cell 1 --probability --certain 0.95");
    let seen = place.summary(&format!("{viewshed} -o seen.tif -o seen.png"));
    assert!(seen["certainty"]["uncertain_percent"].as_f64().unwrap() > 0.0, "{seen}");
    assert_eq!(numbers(&place, "seen.tif").len(), 4);
    let both = format!("viewshed town/cloud.laz --observer {ax},{ay} --observer {bx},{by} --cell 1 --probability");
    place.summary(&format!("{both} -o both.tif"));
    let [_, _, expected] = &numbers(&place, "both.tif")[..] else { panic!("three bands") };
    assert!(expected.iter().all(|value| *value <= 2.0) && expected.iter().any(|value| *value > 1.5));

    let line = format!("line-of-sight town/cloud.laz --observer {ax},{ay} --target {bx},{by} --target-height 1.7");
    let one = place.run(&format!("{line} --probability -o line.csv"));
    assert!(one.status == 0 && one.stdout.contains("visible with a probability of"), "{one:?}");
    let likely = column(&place, "line.csv", "probability");
    assert!(likely.len() == 1 && (0.0..=1.0).contains(&likely[0]), "{likely:?}");
    // the probability of an answer in Python or on a page is the same: it follows from the same scene
    let from_balls = line.replace("town/cloud.laz", "balls.npz --ground cloud=town/cloud.laz");
    place.summary(&format!("{from_balls} --probability -o again.csv"));
    assert_eq!(column(&place, "again.csv", "probability"), likely);
}

#[test]
fn hours_of_sun_and_views_of_the_sky_have_intervals() {
    let place = village();
    place
        .summary("sun-hours town/cloud.laz --date 2026-03-21 --zone Europe/Amsterdam --cell 2 --interval -o hours.csv");
    let [hours, expected, low, high] =
        ["sun_hours", "hours_expected", "hours_low", "hours_high"].map(|name| column(&place, "hours.csv", name));
    let rows = (0..hours.len()).filter(|&row| hours[row].is_finite());
    let mut widths = Vec::new();
    for row in rows {
        assert!(low[row] <= high[row] && low[row] >= 0.0 && high[row] <= 12.5, "{} {}", low[row], high[row]);
        assert!((0.0..=12.5).contains(&expected[row]));
        widths.push(high[row] - low[row]);
    }
    assert!(widths.len() > 500 && widths.iter().any(|width| *width > 0.2), "{} widths", widths.len());
    place.summary("sky-view town/cloud.laz --cell 2 --directions 145 --interval -o sky.csv");
    let [low, high] = ["factor_low", "factor_high"].map(|name| column(&place, "sky.csv", name));
    assert!(low.iter().zip(&high).filter(|(low, _)| low.is_finite()).all(|(low, high)| low <= high && *high <= 1.0));
}

/// Asserts that `sums` lie within their intervals, whose ends are ordered, and that some intervals are wide.
fn assert_intervals([sums, low, high]: [&[f64]; 3], wide: f64) {
    let rows = (0..sums.len()).filter(|&row| sums[row].is_finite());
    let mut widest = 0.0_f64;
    for row in rows {
        assert!(low[row] <= high[row], "{} {}", low[row], high[row]);
        widest = widest.max(high[row] - low[row]);
    }
    assert!(widest > wide, "{widest}");
}

#[test]
fn energies_of_places_and_of_roofs_have_intervals() {
    let place = village();
    let energy = "irradiance town/cloud.laz --clear-sky ineichen --location 52,5 --patch-division 1 --interval";
    place.summary(&format!("{energy} --cell 4 --months -o energy.csv --planes roofs.csv"));
    let of_places = |name: &str| column(&place, "energy.csv", name);
    let [energy_there, low, high, free] = ["kwh_m2", "kwh_m2_low", "kwh_m2_high", "free_kwh_m2"].map(of_places);
    assert!(energy_there.len() > 200);
    assert_intervals([&energy_there, &low, &high], 30.0);
    // tables round to a hundredth
    assert!(high.iter().zip(&free).filter(|(high, _)| high.is_finite()).all(|(high, free)| *high <= free + 0.011));
    let of_roofs = |name: &str| column(&place, "roofs.csv", name);
    let [found, low, high, loss, loss_high] =
        ["kwh_m2", "kwh_m2_low", "kwh_m2_high", "min_loss", "loss_high"].map(of_roofs);
    assert!(found.len() >= 2, "{} planes", found.len());
    assert_intervals([&found, &low, &high], 1.0);
    assert!(
        loss.iter().zip(&loss_high).all(|(loss, high)| (-1e-3..=1.0).contains(&(high - loss))),
        "{loss:?} {loss_high:?}"
    );
    let through = format!("{energy} --through-trees seasons -o no.csv");
    place.refusal(2, &through, &["--interval", "trees"]);
}

#[test]
fn horizons_and_isovists_have_intervals_and_landmarks_an_expected_share() {
    let place = village();
    let info = place.summary("info town/cloud.laz");
    let corner = |which: &str, axis: usize| info[which][axis].as_f64().unwrap();
    let [x, y] = [0, 1].map(|axis| 0.5 * (corner("min_corner", axis) + corner("max_corner", axis)));
    let horizon = format!("horizon town/cloud.laz --observer {x},{y} --angle-step-deg 4");
    place.summary(&format!("{horizon} -o plain.csv"));
    let sure = place.summary(&format!("{horizon} --interval -o sure.csv"));
    let [plain, elevation] = ["plain.csv", "sure.csv"].map(|name| column(&place, name, "elevation"));
    assert_eq!(plain, elevation);
    let [low, high] = ["low", "high"].map(|name| column(&place, "sure.csv", name));
    assert_intervals([&elevation, &low, &high], 0.3);
    assert!((0..low.len()).all(|row| low[row] <= elevation[row] && elevation[row] <= high[row]));
    assert!(sure["horizons"]["mean_interval_deg"].as_f64().unwrap() > 0.01, "{sure}");
    place.refusal(2, &format!("{horizon} --interval -o sure.txt"), &["sure.txt", "--interval", ".csv"]);

    let isovist = format!("isovist town/cloud.laz --observer {x},{y} --max-distance 40 --angle-step-deg 4");
    let within = place.summary(&format!("{isovist} --interval -o space.csv"));
    assert!(!within["remarks"].to_string().contains("isovist-above-interval"), "{within}");
    // a place that no pulse came near to is free in the answer, and doubtful in the interval
    let (cloud, _) = read_cloud([place.path("town/cloud.laz")], &ReadOptions::default(), &Control::none()).unwrap();
    let is_far = |row: &u32| {
        let [east, north, _] = cloud.frame.file_from_local(cloud.positions[*row as usize].map(f64::from));
        (east - x).hypot(north - y) > 20.0
    };
    let rows: Vec<u32> = (0..u32::try_from(cloud.len()).unwrap()).filter(is_far).collect();
    place.write_cloud("hole.laz", &cloud.select(&rows));
    let over = isovist.replace("town/cloud.laz", "hole.laz").replace(&format!("{x},{y}"), &format!("{x},{y},1.7"));
    let over = place.summary(&format!("{over} --interval -o over.csv"));
    assert!(over["remarks"].to_string().contains("isovist-above-interval"), "{over}");
    for (name, ends) in [
        ("plan_area_m2", ["plan_area_low_m2", "plan_area_high_m2"]),
        ("volume_m3", ["volume_low_m3", "volume_high_m3"]),
    ] {
        let value = column(&place, "space.csv", name)[0];
        let [low, high] = ends.map(|name| column(&place, "space.csv", name)[0]);
        assert!(low < value && value < high && high < 3.0 * value, "{name}: {low} {value} {high}");
    }

    let landmark = "landmark town/cloud.laz --target-class 6 --cell 8";
    place.summary(&format!("{landmark} --probability -o views.csv"));
    let of_views = |name: &str| column(&place, "views.csv", name);
    let [seen, unproven, expected] = ["visible_area_m2", "unproven_area_m2", "expected_share"].map(of_views);
    let shares = of_views("visible_share");
    let rows: Vec<usize> = (0..seen.len()).filter(|&row| seen[row] > 1.0).collect();
    assert!(rows.len() > 20, "{} observers see it", rows.len());
    // what is expected is near to what nothing blocks
    let mean = |of: &dyn Fn(usize) -> f64| rows.iter().map(|&row| of(row)).sum::<f64>() / rows.len() as f64;
    let free = mean(&|row| shares[row] * (1.0 + unproven[row] / seen[row]));
    let found = mean(&|row| expected[row]);
    assert!((found - free).abs() < 0.3 * free, "{found} {free}");
    assert!(rows.iter().any(|&row| (expected[row] - shares[row]).abs() > 1e-4));
    place.summary(&format!("{landmark} -o plain.csv"));
    assert!(!place.text("plain.csv").contains("expected_share"));
}

#[test]
fn cameras_cover_what_they_see_with_certainty_only() {
    let place = village();
    let info = place.summary("info town/cloud.laz");
    let corner = |which: &str, axis: usize| info[which][axis].as_f64().unwrap();
    let [x, y] = [0, 1].map(|axis| 0.5 * (corner("min_corner", axis) + corner("max_corner", axis)));
    std::fs::write(place.path("mast.csv"), format!("x,y\n{x},{y}\n")).unwrap();
    let cameras = "cameras town/cloud.laz --candidates mast.csv --camera-height 12 --fov 360 --count 1 --cell 2";
    let any = place.summary(&format!("{cameras} -o any.tif"));
    let sure = place.summary(&format!("{cameras} --certain 0.9 -o sure.tif"));
    let [covered, certain] = ["any.tif", "sure.tif"].map(|name| counts(&place, name));
    // the same mast looks at the same cells from its height: each is covered if its probability is high enough
    let flags = "--observer-height 12 --target-height 1.5 --cell 2 --probability";
    place.summary(&format!("viewshed town/cloud.laz --observer {x},{y} {flags} -o seen.tif"));
    let [seen, unproven, likely] = &numbers(&place, "seen.tif")[..] else { panic!("three bands") };
    assert_eq!(seen.len(), covered.len());
    let mut lost = 0;
    for row in 0..seen.len() {
        let is_seen = seen[row] == 1.0 && unproven[row] == 0.0;
        assert_eq!(covered[row] == 1, is_seen, "{row}");
        assert_eq!(certain[row] == 1, is_seen && likely[row] >= 0.9, "{row}: {}", likely[row]);
        lost += usize::from(is_seen && certain[row] == 0);
    }
    assert!(lost > 10, "{lost} cells are seen without certainty");
    assert_eq!(sure["pictures"]["uncertain"].as_u64().unwrap(), lost as u64, "{sure}");
    assert!(any["pictures"]["uncertain"].is_null());
}

#[test]
fn points_of_a_query_have_probabilities() {
    let place = village();
    let query = "query town/cloud.laz --self --sun 200,30";
    place.summary(&format!("{query} --probability -o lit.csv"));
    let [answers, likely] = ["answer", "probability"].map(|name| column(&place, "lit.csv", name));
    let known = || (0..answers.len()).filter(|&row| likely[row].is_finite());
    let agreeing = known().filter(|&row| (likely[row] > 0.5) == [1.0, 2.0].contains(&answers[row])).count();
    assert!(known().count() == answers.len() && agreeing as f64 > 0.95 * answers.len() as f64, "{agreeing}");
    place.summary(&format!("{query} --probability -o lit.laz"));
    let run = place.run(&format!("{query} --probability -o lit.npy"));
    assert!(run.status == 2 && run.stderr.contains(".npy"), "{run:?}");
}

#[test]
fn scanners_on_the_ground_have_doubtful_probabilities_and_no_intervals() {
    let place = Workplace::new();
    place.summary("simulate village -o tls --extent 60 --scanner terrestrial --angle-step-deg 0.6");
    let scans = "tls/cloud.laz --orient stations=tls/stations.csv --cell 6";
    let lit = place.run(&format!("shadow {scans} --sun 200,30 --probability -o lit.tif"));
    assert!(lit.status == 0 && lit.stderr.contains("probabilities are left out where nothing"), "{lit:?}");
    let queried = place
        .run("query tls/cloud.laz --orient stations=tls/stations.csv --sun 200,30 --random 50 --probability -o q.csv");
    assert!(queried.status == 0 && queried.stderr.contains("probabilities are left out where nothing"), "{queried:?}");
    let sky = place.run(&format!("sky-view {scans} --directions 145 --interval -o sky.tif"));
    assert!(sky.status != 0 && sky.stderr.contains("surveys from the air"), "{sky:?}");
}

#[test]
fn what_has_no_probability_is_refused() {
    let place = village();
    for (flags, what) in [
        ("shadow town/cloud.laz --sun 200,30 --soft --probability -o lit.tif", "soft edges"),
        ("shadow town/cloud.laz --sun 200,30 --through-trees 0.3 --certain 0.9 -o lit.tif", "trees"),
        ("shadow town/cloud.laz --sun 200,30 --certain 0.4 -o lit.tif", "--certain"),
        ("shadow town/cloud.laz --sun 200,30 --certain 1.2 -o lit.tif", "--certain"),
        ("sky-view town/cloud.laz --through-trees 0.3 --interval -o sky.tif", "--interval"),
        ("cameras balls.laz --ground cloud=town/cloud.laz --on-ground 20 --count 1 --certain 0.9 -o c.csv", "pulses"),
        ("query balls.laz --random 9 --sun 200,30 --probability -o q.csv", "pulses"),
        ("cameras town/cloud.laz --on-ground 20 --count 1 --certain 0.4 -o c.csv", "--certain"),
        ("viewshed balls.laz --ground cloud=town/cloud.laz --observer 84000,447000 --probability -o v.tif", "pulses"),
    ] {
        if flags.contains("balls.laz") {
            place.summary("balls town/cloud.laz -o balls.laz");
        }
        let run = place.run(flags);
        assert!(run.status != 0 && run.stderr.contains(what), "{flags}: {run:?}");
    }
}
