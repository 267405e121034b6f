//! `belvedere sun-calendar` and `belvedere report`.

use crate::common::{EAST, NORTH, Workplace, at, corners};

const HOUSE: &str = "house.laz --scene-config ../tau.json --orient given --location 52,5 --zone +01:00";

/// A house of 10 by 8 m, a window north of it and one high above it, and a planned wall south of both.
fn place() -> Workplace {
    let place = Workplace::with_house();
    let row =
        |x: f64, y: f64, z: f64, azimuth: u16, name: &str| format!("{},{},{z},{azimuth},{name}\n", EAST + x, NORTH + y);
    let rows = [row(0.0, 9.0, 1.5, 180, "garden room"), row(0.0, 9.0, 50.0, 180, "")].concat();
    place.write("windows.csv", format!("x,y,z,azimuth,name\n{rows}"));
    let corner = |x: f64, z: f64| format!("v {} {} {z}\n", EAST + x, NORTH + 6.0);
    let wall = [corner(-30.0, 0.0), corner(30.0, 0.0), corner(30.0, 12.0), corner(-30.0, 12.0)].concat();
    place.write("wall.obj", format!("o wall\n{wall}f 1 2 3\nf 1 3 4\n"));
    place
}

#[test]
fn calendars_list_sun_and_shade_with_their_cause() {
    let place = place();
    let command = format!("sun-calendar {HOUSE} --windows windows.csv --add wall.obj --date 2026-12-21");
    let run = place.run(&format!("{command} -o c.csv -o c.ics"));
    assert_eq!(run.status, 0, "{}", run.stderr);
    assert!(run.stdout.contains("Sun calendar of 2 windows, 2026-12-21 (+01:00)"), "{}", run.stdout);
    assert!(run.stdout.contains("in the shade of added meshes"), "{}", run.stdout);
    let rows = place.text("c.csv");
    let of_window = |number: &str| -> Vec<Vec<String>> {
        let cells = rows.lines().skip(1).map(|row| row.split(',').map(str::to_owned).collect::<Vec<_>>());
        cells.filter(|cells| cells[0] == number).collect()
    };
    // a wall of 12 m three metres before a window shades it all day in December, and nothing stands before 50 m
    let (low, high) = (of_window("1"), of_window("2"));
    assert!(
        low.iter().all(|cells| cells[1] == "garden room" && cells[6] == "plan" && cells[7] == "wall.obj"),
        "{rows}"
    );
    assert_eq!(high.len(), 1, "{rows}");
    assert_eq!([high[0][1].as_str(), high[0][6].as_str()], ["window 2", "sun"]);
    // the shortest day of 52 degrees: 7.7 h
    let hours: f64 = high[0][5].parse().unwrap();
    assert!((7.4..8.0).contains(&hours), "{hours}");
    let appointments = place.text("c.ics");
    assert!(appointments.contains("SUMMARY:Shade of wall.obj: garden room\r\n"), "{appointments}");
    assert!(appointments.contains("SUMMARY:Sun: window 2\r\n"));
    let summary = place.summary_with(
        &format!("sun-calendar {HOUSE} --date 2026-06-21 -o at.csv"),
        &["--at", &format!("{EAST},{}", NORTH + 15.0)],
    );
    assert!(summary["measures"]["sun_hours"]["mean"].as_f64().unwrap() > 8.0, "{summary}");
}

#[test]
fn reports_compare_a_plan_with_what_is() {
    let place = place();
    let garden = corners(&[[-6.0, 8.0], [6.0, 8.0], [6.0, 14.0], [-6.0, 14.0]]);
    let command = format!("report {HOUSE} --windows windows.csv --add wall.obj --rule 2@03-21 --year 2026 -o r.html");
    let run = place.run_with(&command, &["--area", &garden, "--title", "A <wall>", "--note", "For <us>"]);
    assert_eq!(run.status, 0, "{}", run.stderr);
    assert!(run.stdout.contains("Windows that meet the rule: 1 of 2 with the plan, 2 without it"), "{}", run.stdout);
    // only low suns in the east and in the west reach it beside the wall
    assert!(run.stdout.contains("garden room: with the plan 56 min of possible sun on the critical day, 21 March 2026, without the plan 6 h 58 min on 21 March 2026"), "{}", run.stdout);
    let page = place.text("r.html");
    assert!(page.contains("<h1>A &lt;wall&gt;</h1>") && page.contains("Sunlight before and after a plan"));
    assert!(page.contains("<p class='note'>For &lt;us&gt;</p>"));
    assert!(page.contains("belvedere report house.laz --windows windows.csv"), "the command is in the report");
    for file in ["house.laz", "windows.csv", "wall.obj"] {
        assert!(page.contains(&format!("{file} (")), "{file}");
    }
    assert_eq!(page.matches("SHA-256 ").count(), 3);
    // without a plan there is neither a change nor its words
    let command = format!("report {HOUSE} --windows windows.csv --date 2026-06-21 --language de -o now.html");
    assert_eq!(place.run(&command).status, 0);
    let page = place.text("now.html");
    assert!(page.contains("<h1>Besonnungsbericht</h1>") && !page.contains("nachher") && page.contains("21. Juni 2026"));
}

#[test]
fn shadow_studies_count_the_days_and_hours_of_their_city() {
    let place = place();
    let garden = corners(&[[12.0, 8.0], [20.0, 8.0], [20.0, 12.0], [12.0, 12.0]]);
    let command = format!("report {HOUSE} --add wall.obj --year 2026");
    let added = |study: &str| {
        let run = place.run_with(&format!("{command} --study {study} -o s.html"), &["--area", &garden]);
        assert_eq!(run.status, 0, "{}", run.stderr);
        let page = place.text("s.html");
        // the area, the day, first and last time
        let rows = page.split("Shade that the plan adds to areas").nth(1).unwrap().split("</table>").next().unwrap();
        let cells =
            |row: &str| row.split("<td>").skip(1).map(|cell| cell.split('<').next().unwrap().to_owned()).collect();
        let rows: Vec<Vec<String>> = rows.split("<tr>").skip(2).map(cells).collect();
        (rows, page)
    };
    let minutes = |time: &str| {
        let (hours, minutes) = time.split_once(':').unwrap();
        60 * hours.parse::<i32>().unwrap() + minutes.parse::<i32>().unwrap()
    };
    let (rows, page) = added("ceqr");
    assert!(page.contains("CEQR Technical Manual (2021)"));
    // the wall south of the garden shades it all day in December; almanac of 52 N, 5 E: 08:46 to 16:29, less 1.5 hours
    let winter = rows.iter().find(|row| row[0].starts_with("21 Dec")).unwrap();
    assert!((minutes(&winter[1]) - minutes("10:16")).abs() <= 2, "{winter:?}");
    assert!((minutes(&winter[2]) - minutes("14:59")).abs() <= 2, "{winter:?}");
    assert!(rows.iter().any(|row| row[0].starts_with("6 May")), "{rows:?}");
    let (rows, _) = added("toronto");
    let hours_of = |row: &Vec<String>| [&row[1], &row[2]].map(|time| minutes(time));
    assert!(rows.iter().map(hours_of).all(|[from, to]| from >= minutes("9:18") && to <= minutes("18:18")), "{rows:?}");
    assert!(rows.iter().all(|row| !row[0].contains("Dec")), "{rows:?}");

    let (_, page) = added("san-francisco");
    let year = page.split("Sun of a year over areas").nth(1).unwrap().split("</table>").next().unwrap();
    let cells: Vec<&str> = year.split("<td>").skip(1).map(|cell| cell.split('<').next().unwrap()).collect();
    let number =
        |cell: &str| cell.trim_end_matches(" %").replace([',', '\u{202f}', '\u{a0}'], "").parse::<f64>().unwrap();
    // the sun of a year at 52 degrees, less two hours a day
    let (area, possible, added, share) = (number(cells[0]), number(cells[1]), number(cells[3]), number(cells[4]));
    assert!(area == 32.0 && (3600.0..3800.0).contains(&(possible / area)), "{cells:?}");
    assert!((added / possible * 100.0 - share).abs() < 0.02 && (20.0..100.0).contains(&share), "{cells:?}");

    place.refusal_with(2, &format!("report {HOUSE} --study ceqr -o s.html"), &["--area", &garden], &["--add"]);
}

#[test]
fn reports_and_calendars_refuse_what_they_cannot_do() {
    let place = place();
    place.refusal(2, &format!("report {HOUSE} -o r.html"), &["--windows"]);
    place.refusal(2, &format!("report {HOUSE} --windows windows.csv -o r.pdf"), &["extension", "html"]);
    place.refusal(2, &format!("report {HOUSE} --windows windows.csv --rule 99@x -o r.html"), &["99@x", "nl-light"]);
    place.refusal(2, &format!("report {HOUSE} --windows wall.obj -o r.html"), &["--windows", "table"]);
    place.refusal(2, &format!("sun-calendar {HOUSE} --windows windows.csv -o c.csv"), &["--date"]);
    place.refusal(2, &format!("sun-calendar {HOUSE} --date 2026-03-21 -o c.csv"), &["--windows"]);
    place.refusal(2, &format!("sun-calendar {HOUSE} --windows windows.csv --date 2026-03-21 -o c.txt"), &["extension"]);
    let [x, y, z] = at(0.0, 9.0, 1.5);
    for (row, words) in [
        (format!("{},{y},{z},180", x + 5000.0), "all outside of the cloud"),
        (format!("{x},{y},{z},999"), "azimuth of 999 degrees"),
        (format!("\"{x},5\",{y},{z},180"), "decimal points"),
    ] {
        place.write("odd.csv", format!("x,y,z,azimuth\n{row}\n"));
        for command in ["report", "sun-calendar --date 2026-03-21"] {
            let (command, more) = command.split_once(' ').unwrap_or((command, ""));
            let output = if command == "report" { "r.html" } else { "c.csv" };
            let run = place.run(&format!("{command} {HOUSE} --windows odd.csv {more} -o {output}"));
            assert!(run.status > 0 && run.stderr.contains(words), "{command} {row}: {}", run.stderr);
        }
    }
    // one of two windows outside counts nowhere
    place.write("odd.csv", format!("x,y,z,azimuth\n{x},{y},{z},180\n{},{y},{z},180\n", x + 5000.0));
    let run = place.run(&format!("report {HOUSE} --windows odd.csv --rule 2@03-21 --year 2026 -o one.html"));
    assert!(run.stdout.contains("Windows that meet the rule: 1 of 1"), "{}", run.stdout);
    assert!(run.stdout.contains("Window 2: outside the survey, no answer."), "{}", run.stdout);
    let line = corners(&[[-6.0, 8.0], [6.0, 8.0]]);
    place.refusal_with(1, &format!("report {HOUSE} -o r.html"), &["--area", &line], &["area"]);
    assert!(!place.path("r.html").exists() && !place.path("c.csv").exists());
}
