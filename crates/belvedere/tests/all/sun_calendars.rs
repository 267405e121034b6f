//! Sun calendars against a closed form and against hours of sun, and the reports that are made of them.

use crate::common::simulated::cloud_of;
use belvedere::apps::ask::{
    Days, GivenWindow, GivenWindows, GridCells, Places, Scene, SunCalendarQuestion, SunCalendarResults,
    SunHoursQuestion, SunPlace, ask,
};
use belvedere::apps::sun::{Date, Refraction, Site, Zone, sun_position_with};
use belvedere::apps::sun_calendar::{CalendarDay, SunObstacle, SunStretch};
use belvedere::apps::window_views::SeenKind;
use belvedere::control::Control;
use belvedere::crs::Crs;
use belvedere::model::{ModelParams, ModelParts, SceneModel};
use belvedere::report::clock_time;
use belvedere::results::write_calendar;
use belvedere::sunlight_report::{Language, ReportArea, ReportParams, sunlight_report};
use belvedere::{Bounds, Frame, Mesh, PointCloud};
use belvedere_scenes::{AirborneParams, PlanPlacement, TownParams, TriangleScene, extruded, scan_airborne, town};
use std::sync::Arc;

fn box_mesh([x, y]: [f64; 2], [along, across]: [f64; 2], [bottom, top]: [f64; 2]) -> Mesh {
    let mut scene = TriangleScene::default();
    let place = PlanPlacement { origin: [x, y], angle: 0.0 };
    scene.add_object("tower", &[extruded(&place.rectangle(along, across), bottom, top)]);
    Mesh { vertices: scene.vertices.clone(), triangles: scene.triangles.clone(), ..Mesh::default() }
}

fn window(place: [f64; 3], azimuth_deg: f64) -> GivenWindow {
    GivenWindow { place, azimuth_deg: azimuth_deg.rem_euclid(360.0), tilt_deg: 90.0, size: None }
}

fn question(windows: Vec<GivenWindow>, date: &str, step: f64) -> SunCalendarQuestion {
    SunCalendarQuestion {
        windows: GivenWindows::Each(windows),
        days: Days { dates: vec![date.to_owned()], time_step_min: Some(step), ..Days::default() },
        place: SunPlace { zone: Some("+01:00".to_owned()), ..SunPlace::default() },
        without_trees: true,
        ..SunCalendarQuestion::default()
    }
}

fn calendar(scene: &Scene, question: &SunCalendarQuestion) -> SunCalendarResults {
    ask(scene, question, &Places::Scene, &Control::none()).unwrap().found
}

#[test]
fn a_tower_shades_a_window_from_minute_to_minute_as_its_closed_form() {
    let bounds = Bounds { low: [-100.0, -100.0, 0.0], high: [100.0, 100.0, 30.0] };
    let parts = ModelParts { frame: Frame::default(), bounds, ..ModelParts::default() };
    let (low, high) = ([-5.0, -30.0], [10.0, -20.0]);
    let (top, height) = (20.0, 3.0);
    let mesh = box_mesh([2.5, -25.0], [15.0, 10.0], [0.0, top]);
    let model = SceneModel::from_parts(parts).unwrap().with_added(&mesh, "tower.obj").unwrap();
    let scene = Scene::new(model, Arc::new(PointCloud::default()));
    let mut question = question(vec![window([0.0, 0.0, height], 140.0)], "2026-02-10", 1.0);
    question.place.location = Some([52.0, 5.0]);
    let found = calendar(&scene, &question);
    let [day] = &found.days[0][..] else { panic!("one day") };
    let site = Site {
        latitude: 52_f64.to_radians(),
        longitude: 5_f64.to_radians(),
        height: found.site.height,
        convergence: 0.0,
    };
    let (zone, date) = (Zone::parse("+01:00").unwrap(), Date::parse("2026-02-10").unwrap());
    let (east, north) = 140_f64.to_radians().sin_cos();
    let mut counts = [0; 3];
    for minute in 0..1440 {
        let hour = f64::from(minute) / 60.0;
        let instant = zone.instant_of(date, hour).unwrap();
        let sun = sun_position_with(&site, instant, Refraction::Standard).unwrap().to_sun(&site);
        // twice a step away from the ends of a stretch
        let inside =
            day.0.iter().find(|s| f64::from(s.start) + 2.0 / 60.0 < hour && hour < f64::from(s.end) - 2.0 / 60.0);
        let Some(stretch) = inside else { continue };
        let (mut from, mut to) = (0.0_f64, (top - height) / sun[2]);
        for axis in 0..2 {
            let [a, b] = [low[axis], high[axis]].map(|side| side / sun[axis]);
            from = from.max(a.min(b));
            to = to.min(a.max(b));
        }
        let expected = match () {
            () if sun[0] * east + sun[1] * north <= 0.0 => SunObstacle::OwnWall,
            () if from < to => SunObstacle::Mesh(0),
            () => SunObstacle::None,
        };
        assert_eq!(stretch.obstacle, expected, "{}", clock_time(hour));
        counts[match expected {
            SunObstacle::None => 0,
            SunObstacle::OwnWall => 1,
            _ => 2,
        }] += 1;
    }
    assert!(counts.iter().all(|&count| count > 30), "{counts:?}");
    assert_eq!(found.mesh_name(SunObstacle::Mesh(0)), Some("tower.obj"));
    assert_eq!(found.mesh_name(SunObstacle::Terrain), None);
    // sunrise to sunset
    let whole: f64 = day.hours(|_| true);
    assert!((whole - found.schedule.possible_hours()).abs() < 1e-3, "{whole}");
}

/// A scanned town of 60 m in the Netherlands, and the same with a tower.
fn towns() -> [Scene; 2] {
    let exact = town(&TownParams { extent: 60.0, seed: 5, ..TownParams::default() });
    let scan = scan_airborne(&exact, &AirborneParams { seed: 5, ..AirborneParams::default() });
    let mut cloud = cloud_of(&scan);
    cloud.frame.crs = Crs::parse("EPSG:7415").unwrap();
    let model = SceneModel::build(&cloud, &ModelParams::default(), &Control::none()).unwrap().0;
    let middle = [0, 1].map(|axis| model.frame().origin[axis] + f64::from(model.bounds().low[axis]) + 30.0);
    let ground = exact.mean_ground_height();
    let planned =
        model.clone().with_added(&box_mesh(middle, [12.0, 12.0], [ground, ground + 40.0]), "tower.obj").unwrap();
    let cloud = Arc::new(cloud);
    [Scene::new(model, Arc::clone(&cloud)), Scene::new(planned, cloud)]
}

/// Windows in free air around the middle of the town, which look to four sides.
fn windows(scene: &Scene) -> Vec<GivenWindow> {
    let [x, y] = scene.middle();
    let low = f64::from(scene.model().bounds().low[2]);
    let at = |number: u8| {
        let angle = f64::from(number).to_radians() * 30.0;
        window(
            [x + 14.0 * angle.cos(), y + 14.0 * angle.sin(), low + 4.0 + f64::from(number)],
            90.0 * f64::from(number),
        )
    };
    (0..12).map(at).collect()
}

#[test]
fn calendars_add_up_to_the_hours_of_sun_with_and_without_a_plan() {
    let mut plan_hours = 0.0;
    for scene in &towns() {
        for date in ["2026-03-21", "2026-12-21"] {
            let question = question(windows(scene), date, 10.0);
            let found = calendar(scene, &question);
            let of_sun_hours = SunHoursQuestion {
                days: question.days.clone(),
                place: question.place.clone(),
                sun_tolerance_deg: Some(0.0),
                ..SunHoursQuestion::default()
            };
            let places = Places::Targets(Arc::clone(&found.targets));
            let answers = ask(scene, &of_sun_hours, &places, &Control::none()).unwrap();
            let column = |name: &str| &answers.measures.iter().find(|m| m.name == name).unwrap().values;
            let (hours, first, last, longest) =
                (column("sun_hours"), column("first_light"), column("last_light"), column("longest"));
            for (row, days) in found.days.iter().enumerate() {
                let day = &days[0];
                // a day of f32 sums of up to 100 steps, which are known to 1e-6 h each
                assert!((day.sun_hours() - f64::from(hours[row])).abs() < 1e-3, "{row}: {day:?} {}", hours[row]);
                assert!((day.longest() - f64::from(longest[row])).abs() < 1e-3, "{row}");
                match day.first_and_last() {
                    Some([from, to]) => assert!((from - first[row]).abs() < 1e-3 && (to - last[row]).abs() < 1e-3),
                    None => assert!(first[row].is_nan() && last[row].is_nan()),
                }
                assert!((day.hours(|_| true) - found.schedule.possible_hours()).abs() < 1e-3);
                let without = found.without_trees.as_ref().unwrap()[row][0].clone();
                // balls that give way to no tree any more can only free lines
                assert!(without.sun_hours() >= day.sun_hours() - 1e-3, "{row}");
                assert_eq!(without.hours(|o| o == SunObstacle::Seen(SeenKind::Vegetation)), 0.0);
                plan_hours += day.hours(|obstacle| matches!(obstacle, SunObstacle::Mesh(_)));
            }
        }
    }
    assert!(plan_hours > 1.0, "the tower shades nothing");
}

#[test]
fn a_report_says_what_calendars_and_hours_of_sun_say_in_four_languages() {
    let [present, planned] = towns();
    let [x, y] = present.middle();
    let ring = vec![[x - 12.0, y + 8.0], [x + 12.0, y + 8.0], [x + 12.0, y + 20.0], [x - 12.0, y + 20.0]];
    let mut params = ReportParams {
        windows: windows(&present),
        names: vec!["<b>kitchen & \"hall\"</b>".to_owned()],
        areas: vec![ReportArea { name: String::new(), rings: vec![ring.clone()] }],
        rooms: ["", "hall", "hall"].map(str::to_owned).to_vec(),
        rule: Some("2@equinoxes@8-17".to_owned()),
        days: Days { dates: vec!["2026-03-21".to_owned()], year: Some(2026), ..Days::default() },
        place: SunPlace { zone: Some("Europe/Amsterdam".to_owned()), ..SunPlace::default() },
        ..ReportParams::default()
    };
    let report = sunlight_report(&present, Some(&planned), &params, &Control::none()).unwrap();
    let said = report.headlines();
    assert_eq!(said.len(), 16, "{said:?}");
    assert!(
        said[0].starts_with("Windows that meet the rule: ") && said[0].contains(" of 12 with the plan, "),
        "{said:?}"
    );
    assert!(said[1].starts_with("<b>kitchen & \"hall\"</b>: ") && said[2].starts_with("Window 2: "), "{said:?}");
    // the hall has the sun of its windows together, so no less than the best of them
    let hours = |sentence: &str| -> f64 {
        let of = sentence.split(" of possible sun").next().unwrap();
        let number = |unit: &str| {
            let words: Vec<&str> = of.split(' ').collect();
            words.iter().position(|word| *word == unit).map_or(0.0, |at| words[at - 1].parse().unwrap())
        };
        number("h") + number("min") / 60.0
    };
    assert!(said[13].starts_with("Room: hall: "), "{said:?}");
    assert!(hours(&said[13]) >= hours(&said[2]).max(hours(&said[3])), "{said:?}");
    assert!(said[14].starts_with("Area 1: "), "{said:?}");
    let page = report.to_html().unwrap();
    assert!(page.contains("&lt;b&gt;kitchen &amp; &quot;hall&quot;&lt;/b&gt;") && !page.contains("<b>kitchen"));
    assert!(!page.contains("http:") && !page.contains("https:") && !page.contains("<script"), "it needs a network");
    assert!(page.len() < 3_000_000, "{}", page.len());
    // rows inside the page: hours of sun of each window and state
    let rows = page.split("<pre>").nth(1).unwrap().split("</pre>").next().unwrap();
    for (state, scene) in [("before", &present), ("after", &planned)] {
        let found = calendar(
            scene,
            &SunCalendarQuestion { place: params.place.clone(), ..question(params.windows.clone(), "2026-03-21", 2.0) },
        );
        for (number, days) in found.days.iter().enumerate() {
            let is_of = |cells: &[&str]| {
                cells[0] == state && cells[1] == (number + 1).to_string() && cells[7] == "sun" && cells[10] == "detail"
            };
            let cells = rows.lines().skip(1).map(|row| row.split(',').collect::<Vec<_>>()).filter(|cells| is_of(cells));
            let hours: f64 = cells.map(|cells| cells[6].parse::<f64>().unwrap()).sum();
            // three decimals in each row
            assert!((hours - days[0].sun_hours()).abs() < 0.02, "{state} {number}: {hours} {}", days[0].sun_hours());
        }
    }
    // shade of the plan on the area, by the first obstacle on each line
    let cells = GridCells {
        cell: Some(0.5),
        bounds: Some((ring[0], ring[2])),
        within: vec![ring.clone()],
        ..GridCells::default()
    };
    let of_cells = SunCalendarQuestion {
        days: Days { dates: vec!["2026-03-21".to_owned()], ..Days::default() },
        place: params.place.clone(),
        ..SunCalendarQuestion::default()
    };
    let [was, will] = [&present, &planned]
        .map(|scene| ask(scene, &of_cells, &Places::Cells(cells.clone()), &Control::none()).unwrap().found);
    let count = was.targets.target_count() as f64;
    let is_sun = |days: &[CalendarDay], hour: f32| days[0].sun().any(|s| s.start <= hour && hour < s.end);
    let (mut times, mut most) = (Vec::new(), 0.0_f64);
    for step in &was.schedule.days[0].steps {
        let hour = step.start + step.hours / 2.0;
        let pairs = was.days.iter().zip(&will.days);
        let lost = pairs.filter(|(was, will)| is_sun(was, hour) && !is_sun(will, hour)).count() as f64 / count;
        if lost >= 0.01 {
            times.extend([step.start, step.start + step.hours]);
            most = most.max(lost);
        }
    }
    let [first, last] = [times[0], *times.last().unwrap()].map(|hour| clock_time(hour.into()));
    let row = format!("<tr><th>Area 1</th><td>21 March</td><td>{first}</td><td>{last}</td>");
    assert!(page.contains(&row), "{row}");
    assert!(page.contains(&format!("<td>{:.0} % (", 100.0 * most)), "{most}");
    let mut pages = vec![page];
    for (code, language) in Language::ALL.into_iter().skip(1) {
        params.language = language;
        let page = sunlight_report(&present, Some(&planned), &params, &Control::none()).unwrap().to_html().unwrap();
        assert!(page.contains(&format!("<html lang='{code}'>")) && !pages.contains(&page));
        pages.push(page);
    }
    for wrong in [
        ReportParams { rule: Some("nonsense".to_owned()), ..params.clone() },
        ReportParams { windows: Vec::new(), areas: Vec::new(), ..params.clone() },
        ReportParams { days: Days { dates: vec!["equinox".to_owned()], ..Days::default() }, ..params.clone() },
    ] {
        assert!(sunlight_report(&present, None, &wrong, &Control::none()).is_err());
    }
}

#[test]
fn calendars_are_tables_and_appointments() {
    let [_, planned] = towns();
    let found = calendar(&planned, &question(windows(&planned), "2026-03-21", 2.0));
    let folder = tempfile::tempdir().unwrap();
    let (table, appointments) = (folder.path().join("c.csv"), folder.path().join("c.ics"));
    let names = vec!["a, b; c".to_owned()];
    write_calendar(&table, &found, &names).unwrap();
    write_calendar(&appointments, &found, &names).unwrap();
    let table = std::fs::read_to_string(table).unwrap();
    assert!(table.starts_with("window,name,date,from,to,hours,state,object,unproven_hours\n"));
    assert_eq!(table.lines().count() - 1, found.days.iter().map(|days| days[0].0.len()).sum::<usize>());
    let text = std::fs::read_to_string(appointments).unwrap();
    let lines: Vec<&str> = text.split("\r\n").collect();
    let count = |what: &str| lines.iter().filter(|line| **line == what).count();
    let listed = found.days.iter().flat_map(|days| &days[0].0);
    let expected = listed.filter(|s| s.hours() >= 5.0 / 60.0 && s.obstacle != SunObstacle::OwnWall).count();
    assert_eq!(
        [count("BEGIN:VEVENT"), count("END:VEVENT"), count("BEGIN:VCALENDAR"), count("END:VCALENDAR")],
        [expected, expected, 1, 1]
    );
    // one of each state of the place with a name that has to be escaped
    let of_first = found.days[0].iter().flat_map(|day| &day.0);
    let is_listed = |s: &&SunStretch| s.hours() >= 5.0 / 60.0 && s.obstacle != SunObstacle::OwnWall;
    let kept: Vec<&SunStretch> = of_first.filter(is_listed).collect();
    let named = |start: &str| lines.iter().filter(|l| l.starts_with(start) && l.ends_with(": a\\, b\\; c")).count();
    let sunny = kept.iter().filter(|s| s.obstacle == SunObstacle::None).count();
    assert!(!kept.is_empty() && named("SUMMARY:Sun") == sunny && named("SUMMARY:") == kept.len(), "{text}");
    assert!(lines.iter().any(|line| line.starts_with("DTSTART:20260321T") && line.ends_with('Z')));
}
