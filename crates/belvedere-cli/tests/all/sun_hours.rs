//! Hours of sun on the command line, around a house whose shadow is known.

use crate::common::{Workplace, at, column, house, is_hidden};
use belvedere::apps::sun::{Date, DayParams, Site, Zone, sun_day, sun_position};
use belvedere::crs::Crs;
use std::fs::File;
use tiff::decoder::{Decoder, DecodingResult};
use tiff::tags::Tag;

const HOUSE: &str = "house.laz --orient given --scene-config ../tau.json";
/// Places around the house: north of it, south, east, and beneath nothing far off.
const PLACES: [[f64; 3]; 4] = [[0.0, 8.0, 0.5], [0.0, -9.0, 0.5], [9.0, 0.0, 0.5], [13.0, 13.0, 0.5]];

fn place() -> Workplace {
    let place = Workplace::with_house();
    place.write_places("places.csv", &PLACES);
    place
}

#[test]
fn bits_of_a_year_are_those_of_the_exact_house() {
    let place = place();
    let day = "--date 2027-03-21 --zone Europe/Amsterdam --cell 1 --sun-tolerance-deg 0";
    place.summary(&format!("sun-hours {HOUSE} {day} --hourly-sun year -o hours.tif"));
    let [west, north, _] = at(0.0, 0.0, 0.0);
    let site = Site::of(&Crs::from_epsg(28_992).unwrap(), [west, north], 4.5).unwrap();
    let zone = Zone::parse("Europe/Amsterdam").unwrap();
    let (mut suns, mut wrong) = (0, 0);
    for month in 1..=12_i8 {
        let mut decoder = Decoder::new(File::open(place.path(&format!("year/{month:02}.tif"))).unwrap()).unwrap();
        let tie = decoder.get_tag_f64_vec(Tag::ModelTiepointTag).unwrap();
        let width = decoder.dimensions().unwrap().0 as usize;
        let DecodingResult::U32(values) = decoder.read_image().unwrap() else { panic!("bits are 32 a cell") };
        // north of the house and east of it, and below its roof
        for [x, y] in [[0.5, 7.5], [8.5, -1.5], [-0.5, 0.5]] {
            let [column, row] = [west + x - tie[3], tie[4] - north - y].map(|cells| cells.floor() as usize);
            let words = &values[24 * (row * width + column)..][..24];
            if x < 0.0 {
                assert!(words.iter().all(|&word| word == 1 << 31), "{words:?}");
                continue;
            }
            for date in Date::new(2027, month, 1).unwrap().to(Date::new(2027, 12, 31).unwrap()) {
                if date.month() != month {
                    break;
                }
                for (hour, word) in (0_u8..).zip(words) {
                    let sun = sun_position(&site, zone.instant_of(date, f64::from(hour) + 0.5).unwrap()).unwrap();
                    let is_lit = word >> (date.day() - 1) & 1 == 1;
                    if sun.elevation > 0.0 {
                        suns += 1;
                        wrong += usize::from(is_lit == is_hidden([x, y, 0.1], sun.to_sun(&site)));
                    } else {
                        assert!(!is_lit, "{date} {hour}");
                    }
                }
            }
        }
    }
    // suns at the edges of the shadow, which balls round off
    assert!(suns > 8700 && wrong * 50 < suns, "{wrong} of {suns}");
    place.refusal(2, &format!("sun-hours {HOUSE} {day} --targets places.csv --hourly-sun h -o h.csv"), &["a grid"]);
    place.refusal(
        2,
        &format!("sun-hours {HOUSE} {day} --hourly-sun year -o year/01.tif"),
        &["year/01.tif", "choose another"],
    );
    std::fs::create_dir(place.path("new")).unwrap();
    place.refusal(2, &format!("sun-hours {HOUSE} {day} --hourly-sun new -o ./new/12.tif"), &["12.tif", "--hourly-sun"]);
}

#[test]
fn hours_are_those_of_the_exact_house() {
    let place = place();
    let run = place.summary(&format!(
        "sun-hours {HOUSE} --date 2026-03-21 --zone Europe/Amsterdam --targets places.csv -o hours.csv"
    ));
    let mut expected = vec![[0.0, f64::NAN, f64::NAN]; PLACES.len()];
    let [x, y, _] = at(0.0, 0.0, 0.0);
    let site = Site::of(&Crs::from_epsg(28_992).unwrap(), [x, y], 4.5).unwrap();
    let zone = Zone::parse("Europe/Amsterdam").unwrap();
    let day = sun_day(&site, &zone, Date::parse("2026-03-21").unwrap(), None, &DayParams::default()).unwrap();
    for step in &day.steps {
        for (place, sums) in PLACES.iter().zip(&mut expected) {
            if !is_hidden(*place, step.direction) {
                sums[0] += (step.end - step.start) / 3600.0;
                sums[1] = sums[1].min(day.clock_hours(step.start));
                sums[2] = sums[2].max(day.clock_hours(step.end));
            }
        }
    }
    let found = ["sun_hours", "first_light", "last_light"].map(|name| column(&place, "hours.csv", name));
    // the same on the clock, to the minute
    let table = place.text("hours.csv");
    let header: Vec<&str> = table.lines().next().unwrap().split(',').collect();
    let of_clock = header.iter().position(|name| *name == "first_light_time").unwrap();
    for (row, line) in table.lines().skip(1).enumerate() {
        let time = line.split(',').nth(of_clock).unwrap();
        let hours = time.split_once(':').map(|(h, m)| h.parse::<f64>().unwrap() + m.parse::<f64>().unwrap() / 60.0);
        match found[1][row].is_nan() {
            true => assert_eq!(time, ""),
            false => assert!((hours.unwrap() - found[1][row]).abs() <= 0.5 / 60.0 + 1e-4, "{line}"),
        }
    }
    for (i, expected) in expected.iter().enumerate() {
        for k in 0..3 {
            // balls end a quarter of a metre beside edges here (points half a metre apart): 2° of the sun's way from 8
            // m, two steps at each end
            let tolerance = if k == 0 { 0.7 } else { 0.4 };
            assert!(
                (found[k][i] - expected[k]).abs() < tolerance,
                "{:?} {k}: {} {}",
                PLACES[i],
                found[k][i],
                expected[k]
            );
        }
    }
    assert!(expected[0][0] < expected[1][0] - 2.0, "the house must shade something: {expected:?}");
    let when = &run["period"];
    assert_eq!(
        (&when["first_day"], &when["days"], &when["time_zone"]),
        (&"2026-03-21".into(), &1.into(), &"Europe/Amsterdam".into())
    );
    let possible = when["possible_hours_per_day"].as_f64().unwrap();
    assert!((possible - day.possible_hours()).abs() < 0.01);
    // pvlib 0.16.1 has the middle of the sun appear in Delft at 05:44:46 UTC, 06:44:46 winter time
    assert!((expected[3][1] - 6.7458).abs() < 2e-3, "{}", expected[3][1]);
    for (hours, share) in found[0].iter().zip(column(&place, "hours.csv", "sun_share")) {
        assert!((hours / possible - share).abs() < 2e-3);
    }
    assert!((run["location"]["latitude_deg"].as_f64().unwrap() - 51.998).abs() < 0.001, "{}", run["location"]);
}

#[test]
fn rules_and_periods_have_columns() {
    let place = place();
    let rules = "--rule bre-equinox --rule 11@03-21 --rule 1@shortest-day>5";
    let first = place.summary(&format!("sun-hours {HOUSE} {rules} --targets places.csv -o rules.csv"));
    let met = |name: &str| ["bre_equinox", "rule_1", "rule_2"].map(|rule| column(&place, name, rule));
    // two hours everywhere; eleven only where the house does not stand before the sun
    assert_eq!(met("rules.csv")[0], [1.0; 4]);
    assert_eq!(met("rules.csv")[1], [0.0, 1.0, 0.0, 1.0]);
    assert_eq!(met("rules.csv")[2][3], 1.0);
    assert!(first["period"]["rule_1"].as_str().unwrap().contains("11 h on 03-21"), "{}", first["period"]);
    // a span between two times, on a grid
    place.summary(&format!(
        "sun-hours {HOUSE} --from 2026-03-20T12:00+01:00 --to 2026-03-22T12:00+01:00 --time-step-min 30 --cell 4 -o grid.csv -o grid.tif -o grid.png"
    ));
    let [hours, total, min] =
        ["sun_hours", "total_hours", "min_sun_hours"].map(|name| column(&place, "grid.csv", name));
    assert!(hours.iter().zip(&total).all(|(hours, total)| (3.0 * hours - total).abs() < 5e-3));
    assert!(hours.iter().zip(&min).all(|(hours, min)| *min <= hours + 1e-3));
    assert!(!place.names().iter().any(|name| name == "no.csv"));
}

#[test]
fn what_cannot_be_is_refused_with_advice() {
    let place = place();
    for (flags, words) in [
        ("", "--date"),
        ("--date 2026-02-30", "--date"),
        ("--date soon", "2026-06-21"),
        ("--date 2026-06-21 --time-step-min 0", "--time-step-min"),
        ("--date 2026-06-21 --time-step-min 61", "1/6 to 60 minutes"),
        ("--date 2026-06-21 --time-step-min nan", "--time-step-min"),
        ("--date 2026-06-21 --sun-tolerance-deg 6", "--sun-tolerance-deg"),
        ("--date 2026-06-21 --sun-tolerance-deg -1", "--sun-tolerance-deg"),
        ("--date 2026-06-21 --min-sun-elevation 90", "elevation"),
        ("--date 2026-06-21 --zone Mars/Olympus", "--zone"),
        ("--date 2026-06-21 --location 91,5", "--location"),
        ("--date 2026-06-21 --location 52", "--location"),
        ("--date 2026-06-21 --air 0,10", "hPa"),
        ("--date 2026-06-21 --air 1000,10 --sun-elevation geometric", "--air"),
        ("--date 2026-06-21 --from 2026-06-21 --to 2026-06-22", "--from"),
        ("--from 2026-06-21", "--to"),
        ("--from 2026-06-22 --to 2026-06-21", "--to"),
        ("--from 2026-06-21 --to 2026-06-21T12:00Z", "two days"),
        ("--from 2026-03-29T02:30 --to 2026-03-29T13:00 --zone Europe/Amsterdam", "skip"),
        ("--from 1000-01-01 --to 2900-01-01", "3700"),
        ("--rule sunny", "nl-light"),
        ("--rule bre-equinox --rule bre-equinox", "once"),
        ("--rule bre-equinox --year 999", "1000"),
    ] {
        let run = place.run(&format!("sun-hours {HOUSE} {flags} --targets places.csv -o no.csv"));
        assert!(run.status == 2 && run.stderr.contains(words), "{flags}: {run:?}");
    }
    // a cloud that does not say where on earth it lies
    let mut lost = house();
    lost.frame.crs = Crs::default();
    place.write_cloud("lost.laz", &lost);
    let lost = "lost.laz --orient given --scene-config ../tau.json --targets places.csv";
    let words = ["--location", "latitude", "reference system"];
    place.refusal(2, &format!("sun-hours {lost} --date 2026-06-21 -o no.csv"), &words);
    let run = place.summary(&format!("sun-hours {lost} --date 2026-06-21 --location -33.9,151.2 -o south.csv"));
    // the shortest day of Sydney, on its clocks
    assert!((run["period"]["possible_hours_per_day"].as_f64().unwrap() - 9.85).abs() < 0.1, "{run}");
    assert_eq!(run["period"]["time_zone"], "Australia/Sydney");
    // clocks differ between Elvas and Badajoz, unless a zone or an offset is given
    let border = "sun-position --location 38.88,-7.1 -o sun.csv --time 2026-06-21T12:00";
    let near = |flags: &str| {
        let run = place.run(&format!("{border}{flags}"));
        run.stderr.contains("places nearby have those of Europe/Madrid")
    };
    assert_eq!([near(""), near(" --zone Europe/Lisbon"), near("+01:00")], [true, false, false]);
    // the open sea has no zone
    let sea = format!("sun-hours {lost} --location 0,-30 -o sea.csv");
    assert_eq!(place.summary(&format!("{sea} --date 2026-06-21"))["period"]["time_zone"], "mean solar time");
    place.refusal(2, &format!("{sea} --from 2026-06-21T12:00 --to 2026-06-21T13:00"), &["--zone"]);
    // polar night: no hours, and no share
    let run = place.summary(&format!("sun-hours {lost} --date shortest-day --location 80,15 -o night.csv"));
    assert_eq!(run["period"]["suns"], 0);
    assert!(column(&place, "night.csv", "sun_hours").iter().all(|&hours| hours == 0.0));
}

#[test]
fn a_single_place_has_a_sentence_with_the_hours_of_the_table() {
    let place = place();
    let question = format!("sun-hours {HOUSE} --date 2026-03-21 --zone Europe/Amsterdam");
    place.summary(&format!("{question} --targets places.csv -o hours.csv"));
    let hours = column(&place, "hours.csv", "sun_hours")[1];
    let [x, y, z] = at(PLACES[1][0], PLACES[1][1], PLACES[1][2]);
    let run = place.run(&format!("{question} --at {x},{y},{z} -o at.csv"));
    assert_eq!((run.status, column(&place, "at.csv", "sun_hours")), (0, vec![hours]), "{run:?}");
    let sentence = run.stdout.lines().find(|line| line.starts_with("at ")).unwrap();
    assert!(sentence.contains(&format!("{hours:.1} h of sun a day")) && sentence.contains("first "), "{sentence}");
    // the same place in degrees, without a height: on the ground, and no file is needed
    let projection = Crs::from_epsg(28_992).unwrap().geographic_projection().unwrap();
    let [latitude, longitude] = projection.unproject([x, y]).unwrap().map(f64::to_degrees);
    let found = &place.summary(&format!("{question} --at {latitude:.8},{longitude:.8}"))["at"][0];
    let position = |axis: usize| found["position"][axis].as_f64().unwrap();
    // eight digits of a degree are a millimetre; the ground lies half a metre below the place, targets 0.1 m above it
    assert!((position(0) - x).abs() < 0.01 && (position(1) - y).abs() < 0.01, "{found}");
    assert!((position(2) - (z - 0.4)).abs() < 0.1 && found["height_from"] == "ground", "{found}");
    let [x, y, ground] = at(0.0, 0.0, 0.0);
    let roof = &place.summary(&format!("{question} --at {x},{y}"))["at"][0];
    assert!(roof["position"][2].as_f64().unwrap() > ground + 2.0 && roof["height_from"] == "cover", "{roof}");
    // half a metre deep in the west wall nothing is lit, and it is said why
    let [west, y, z] = at(-4.6, 0.25, 2.25);
    let inside = place.run(&format!("{question} --at {west},{y},{z}"));
    assert!(inside.stderr.contains("1 of 1 places (100 %) are inside an obstacle"), "{inside:?}");
    // a wrong place is refused before balls are made
    let wrong = place.run(&format!("--progress json {question} --at {},{y}", x + 9000.0));
    assert!(wrong.status != 0 && wrong.stderr.contains("the points reach from"), "{wrong:?}");
    assert!(!wrong.stderr.contains("balls"), "{wrong:?}");
}

#[test]
fn places_of_a_file_without_heights_stand_on_the_ground() {
    let place = place();
    let question = format!("sun-hours {HOUSE} --date 2026-03-21");
    // behind the house, where the shade of its roof ends higher up
    let places = [[0.0, 10.7], [0.0, -9.0]].map(|[x, y]| at(x, y, 0.0));
    let rows: Vec<String> = places.iter().map(|[x, y, _]| format!("{x},{y}")).collect();
    place.write("flat.csv", format!("id,x,y\nbench,{}\ndoor,{}\n", rows[0], rows[1]));
    let point = |[x, y, _]: [f64; 3]| {
        format!(
            r#"{{"type":"Feature","properties":{{"height":1.5}},"geometry":{{"type":"Point","coordinates":[{x},{y}]}}}}"#
        )
    };
    let crs = r#""crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::28992"}}"#;
    place.write(
        "places.geojson",
        format!(r#"{{"type":"FeatureCollection",{crs},"features":[{},{}]}}"#, point(places[0]), point(places[1])),
    );
    let hours = |flags: &str| {
        place.summary(&format!("{question} {flags} -o found.csv"));
        column(&place, "found.csv", "sun_hours")
    };
    let single = format!("--at {} --at {}", rows[0], rows[1]);
    let low = hours(&single);
    assert_eq!(hours("--targets flat.csv"), low);
    // columns of the table stay
    assert!(place.text("found.csv").lines().nth(2).unwrap().starts_with("door,"), "{}", place.text("found.csv"));
    let high = hours(&format!("{single} --target-height 1.5"));
    assert!(high != low);
    assert_eq!(hours("--targets flat.csv --target-height 1.5"), high);
    assert_eq!(hours("--targets places.geojson"), high);
    // a walk has a place each two metres, or each --spacing
    let [[west, south, _], [east, ..]] = [at(-6.0, 10.7, 0.0), at(6.0, 10.7, 0.0)];
    let line = format!(r#"{{"type":"LineString","coordinates":[[{west},{south}],[{east},{south}]]}}"#);
    let walk = format!(r#"{{"type":"Feature","properties":{{"name":"lane"}},"geometry":{line}}}"#);
    place.write("walk.geojson", format!(r#"{{"type":"FeatureCollection",{crs},"features":[{walk}]}}"#));
    let along = hours("--targets walk.geojson");
    assert_eq!(column(&place, "found.csv", "distance_m"), [0.0, 2.0, 4.0, 6.0, 8.0, 10.0, 12.0]);
    assert_eq!((along.len(), along[3]), (7, low[0]));
    assert!(place.text("found.csv").lines().nth(1).unwrap().starts_with("lane,0.00,"), "{}", place.text("found.csv"));
    assert_eq!(hours("--targets walk.geojson --spacing 4").len(), 4);
    let refused = format!("{question} --targets places.csv --target-height 1.5 -o no.csv");
    place.refusal(2, &refused, &["--target-height", "places without heights"]);
}
