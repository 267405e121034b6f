//! Heat on the command line: sun and shade of a house on a hot day, clocks and days of weather, and what is refused.

use crate::common::{Workplace, column, remarks};
use std::fmt::Write;

/// The days of a year of a place that is hot in summer, an hour a row, as PVGIS writes a typical year.
fn place() -> Workplace {
    let place = Workplace::with_house();
    let mut text = String::from(
        "Latitude (decimal degrees): 52.16\nLongitude (decimal degrees): 5.39\ntime(UTC),T2m,RH,G(h),Gb(n),Gd(h),IR(h),WS10m\n",
    );
    for (day, wind) in [("20150720", 2), ("20090721", 1), ("20150722", 25)] {
        for hour in 0..24 {
            let is_day = (5..19).contains(&hour);
            let [global, direct, diffuse] = if is_day { [600, 700, 100] } else { [0, 0, 0] };
            writeln!(text, "{day}:{hour:02}00,30.0,40.0,{global},{direct},{diffuse},370,{wind}").unwrap();
        }
    }
    place.write("weather.csv", text);
    // south of the house in the sun, and north of it in its shade
    let places = [[0.0, -12.0, 1.1], [0.0, 5.6, 1.1]];
    place.write_places("places.csv", &places);
    place
}

const HEAT: &str = "heat house.laz --orient given --scene-config ../tau.json --weather weather.csv --zone UTC";

#[test]
fn a_person_in_the_shade_of_a_house_is_cooler() {
    let place = place();
    let noon = place.summary(&format!("{HEAT} --date 2026-07-21 --between 11:00,13:00 --targets places.csv -o n.csv"));
    let [utci, radiant] = ["utci_max", "tmrt_max"].map(|name| column(&place, "n.csv", name));
    assert!(radiant[0] > 50.0 && radiant[1] < 40.0 && utci[0] > utci[1] + 4.0, "{radiant:?} {utci:?}");
    assert_eq!(noon["heat"]["hours"], 3.0);
    assert_eq!(noon["heat"]["ground"], "paved");
    // its own warmth, and nothing of the sun, is left at night
    place.summary(&format!("{HEAT} --date 07-21 --between 00:00,03:00 --targets places.csv -o m.csv"));
    let night = column(&place, "m.csv", "tmrt_max");
    assert!(night[0] < 30.0 && night[1] < 30.0 && night[1] > night[0], "{night:?}");
    // the ends of what is not known about warm ground
    let with = |flags: &str| {
        place.summary(&format!("{HEAT} --date 07-21 --between 11:00,13:00 {flags} --targets places.csv -o w.csv"));
        column(&place, "w.csv", "tmrt_mean")[0]
    };
    let [cold, warm] = ["--ground-warming 0", "--ground-warming 1"].map(with);
    assert!(cold < warm && warm - cold < 8.0, "{cold} {warm}");
    assert!(with("--ground-cover grass") < with("--ground-cover asphalt"));
    assert!((with("--body round") - with("--body sitting")).abs() < 12.0);
}

#[test]
fn hours_and_days_are_those_of_clocks() {
    let place = place();
    // in a zone two hours ahead the same sun is two hours later
    let at_noon = "--targets places.csv --between 12:00,12:00 -o a.csv --date 07-21";
    place.summary(&format!("{HEAT} {at_noon}"));
    let utc = column(&place, "a.csv", "tmrt_max");
    let later = at_noon.replace("12:00,12:00", "14:00,14:00").replace("a.csv", "b.csv");
    place.summary(&format!("{} {later}", HEAT.replace("--zone UTC", "--zone +02:00")));
    // its day begins two hours earlier, whose shade is almost forgotten
    let same = column(&place, "b.csv", "tmrt_max").into_iter().zip(&utc).all(|(a, b)| (a - b).abs() < 0.1);
    assert!(same, "{utc:?}");
    // each hour has bands of its own with its time
    place.summary(&format!("{HEAT} --date 07-21 --between 11:00,12:00 --by-hour --targets places.csv -o h.csv"));
    let hours = ["utci_20090721_1100", "utci_20090721_1200"].map(|name| column(&place, "h.csv", name)[0]);
    assert_eq!(column(&place, "h.csv", "utci_max")[0], hours[0].max(hours[1]));
    assert!((column(&place, "h.csv", "utci_mean")[0] - f64::midpoint(hours[0], hours[1])).abs() < 0.11);
    // several days are one mean, and hours of the sun's own clock warn
    let two = "--date 07-20 --date 07-21 --between 11:00,13:00 --pet";
    let days = place.summary(&format!("{HEAT} {two} --targets places.csv -o d.csv"));
    assert_eq!((&days["heat"]["days"], &days["heat"]["hours"]), (&2.into(), &6.0.into()));
    assert!(column(&place, "d.csv", "pet_max")[0] > column(&place, "d.csv", "pet_max")[1]);
    let solar = HEAT.replace(" --zone UTC", " --zone solar");
    let found = place.summary(&format!("{solar} --date 07-21 --between 11:00,13:00 --targets places.csv -o s.csv"));
    assert!(remarks(&found).iter().any(|remark| remark.contains("mean solar time")), "{:?}", remarks(&found));
    // wind beyond what the index is known for
    let storm = place.summary(&format!("{HEAT} --date 07-22 --between 11:00,13:00 --targets places.csv -o x.csv"));
    assert!(remarks(&storm).iter().any(|remark| remark.contains("have no UTCI")), "{:?}", remarks(&storm));
    assert!(column(&place, "x.csv", "utci_max")[0].is_nan() && column(&place, "x.csv", "tmrt_max")[0] > 50.0);
    let calmer = format!("{HEAT} --wind-factor 0.5 --date 07-22 --between 11:00,13:00 --targets places.csv -o y.csv");
    place.summary(&calmer);
    assert!(column(&place, "y.csv", "utci_max")[0] > 25.0);
}

#[test]
fn what_cannot_be_answered_is_refused() {
    let place = place();
    let command = |flags: &str| format!("{HEAT} {flags} --targets places.csv -o no.csv");
    place.refusal(2, &command(""), &["days"]);
    place.refusal(2, &command("--date 08-21"), &["2026-08-21", "a day of the weather"]);
    place.refusal(2, &command("--date 07-21 --ground-warming 3"), &["--ground-warming", "0 to 2"]);
    place.refusal(2, &command("--date 07-21 --wind-factor -1"), &["--wind-factor", "0 to 2"]);
    place.refusal(2, &command("--from 2009-07-20 --to 2009-07-22 --by-hour"), &["72 hours", "48 at most"]);
    place.refusal(2, &command("--date 07-21 --between noon,13:00"), &["--between"]);
    // the same year of radiation alone
    let text = place.text("weather.csv");
    let dry: String = text.lines().map(|line| line.replace(",40.0,", ",,") + "\n").collect();
    place.write("dry.csv", dry);
    place.refusal(1, &command("--date 07-21").replace("weather.csv", "dry.csv"), &["temperature and humidity"]);
    // balls alone have no surfaces
    place.summary("balls house.laz --orient given --scene-config ../tau.json -o balls.npz");
    let balls = command("--date 07-21").replace("house.laz --orient given --scene-config ../tau.json", "balls.npz");
    place.refusal(1, &balls, &["points that the balls were made from"]);
    assert!(!place.names().iter().any(|name| name == "no.csv"));
}
