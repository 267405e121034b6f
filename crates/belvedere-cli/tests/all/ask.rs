//! Questions in JSON: the same answers as those of the commands, and the schema of all questions.

use crate::common::{EAST, NORTH, Workplace, at, column};
use belvedere::apps::ask;
use serde_json::{Map, Value, json};
use std::collections::BTreeSet;
use std::io::Write;
use std::path::Path;
use std::process::Stdio;

/// Latitude and longitude of a place 12 m south of the middle of the house, by pyproj 3.7.2.
const PLACE_DEG: [f64; 2] = [51.997_854, 4.367_890];
const HOUSE: &str = "house.laz --orient given --scene-config ../tau.json";

/// The summary of the answer to a question.
fn answer(place: &Workplace, question: &Value, flags: &str) -> Value {
    place.write("question.json", question.to_string());
    place.summary(&format!("ask question.json {HOUSE} {flags}"))
}

/// Numbers of a list; NaN for null.
fn numbers(list: &Value) -> Vec<f64> {
    list.as_array().unwrap_or_else(|| panic!("{list}")).iter().map(|value| value.as_f64().unwrap_or(f64::NAN)).collect()
}

/// Refuses lists that differ by more than the digits that both have.
fn assert_same(found: &[f64], expected: &[f64], digits: i32) {
    let step = 10f64.powi(-digits);
    let is_same = |(a, b): (&f64, &f64)| (a - b).abs() < step || a.is_nan() && b.is_nan();
    assert!(!found.is_empty() && found.len() == expected.len(), "{found:?} and {expected:?}");
    assert!(found.iter().zip(expected).all(is_same), "{found:?} instead of {expected:?}");
}

/// Places around the house, as flags and as JSON: north and south of it, and on the south of its roof.
fn spots() -> (String, Value) {
    let spots = [[0.0, 6.0], [0.0, -8.0], [1.0, -1.0]].map(|[x, y]| [EAST + x, NORTH + y]);
    (spots.map(|[x, y]| format!("--at {x},{y}")).join(" "), json!(spots))
}

#[test]
fn shadow_and_sun_hours_at_places_are_those_of_their_commands() {
    let place = Workplace::with_house();
    let (flags, spots) = spots();
    place.summary(&format!("shadow {HOUSE} {flags} --sun 180,30 --grid-north -o lit.csv"));
    let shadow = json!({ "suns": { "directions": [[180.0, 30.0]] }, "place": { "north": "grid" } });
    let run = answer(&place, &json!({ "question": { "shadow": shadow }, "places": { "at": spots } }), "-o placed.csv");
    let lit = &run["measures"]["lit"];
    // north of the house there is shade: the sun stands in the south
    assert_same(&numbers(&lit["values"]), &[0.0, 1.0, 1.0], 4);
    assert_same(&numbers(&lit["values"]), &column(&place, "lit.csv", "lit"), 4);
    assert!(lit["description"].is_string() && lit["unit"] == "1", "{lit}");
    assert_eq!(place.text("placed.csv"), place.text("lit.csv"));

    place.summary(&format!("sun-hours {HOUSE} {flags} --date 2026-03-21 -o hours.csv"));
    let days = json!({ "days": { "dates": ["2026-03-21"] } });
    let run = answer(&place, &json!({ "question": { "sun-hours": days }, "places": { "at": spots } }), "");
    let hours = &run["measures"]["sun_hours"];
    assert_eq!(hours["unit"], "h");
    assert_same(&numbers(&hours["values"]), &column(&place, "hours.csv", "sun_hours"), 3);
    // the statistics of all reports stand beside the values
    let mean = numbers(&hours["values"]).iter().sum::<f64>() / 3.0;
    assert!((hours["mean"].as_f64().unwrap() - mean).abs() < 0.01, "{hours}");
    assert_eq!(run["measures"]["targets"], 3);
}

#[test]
fn lines_of_sight_and_horizons_are_those_of_their_commands() {
    let place = Workplace::with_house();
    let ends = |[x, y, z]: [f64; 3]| json!(at(x, y, z));
    let typed = |place: [f64; 3]| at(place[0], place[1], place[2]).map(|v| v.to_string()).join(",");
    let (south, north) = ([0.0, -12.0, 2.0], [0.0, 12.0, 2.0]);
    let command = format!("line-of-sight {HOUSE} --observer {} --target {}", typed(south), typed(north));
    let expected = place.summary(&format!("{command} -o line.csv"));
    let question = json!({ "question": { "line-of-sight": {} }, "places": { "pairs": [[ends(south), ends(north)]] } });
    let run = answer(&place, &question, "");
    assert_eq!((&run["line"], &run["headline"]), (&expected["line"], &expected["headline"]));
    // the south wall is 8 m from the observer
    let range = numbers(&run["columns"]["first_block_range_m"]);
    assert!((range[0] - 8.0).abs() < 0.5, "{range:?}");
    for name in ["answer", "first_block_range_m", "block_x", "block_y", "block_z", "block_ball"] {
        assert_same(&numbers(&run["columns"][name]), &column(&place, "line.csv", name), 3);
    }

    place.summary(&format!("horizon {HOUSE} --observer {} --angle-step-deg 30 -o horizon.csv", typed(south)));
    let horizon = json!({ "horizon": { "angle_step_deg": 30.0 } });
    let run = answer(&place, &json!({ "question": horizon, "places": { "eyes": [ends(south)] } }), "");
    assert_same(&numbers(&run["columns"]["azimuth_deg"]), &column(&place, "horizon.csv", "azimuth"), 4);
    assert_same(&numbers(&run["columns"]["elevation_deg"]), &column(&place, "horizon.csv", "elevation"), 4);
}

#[test]
fn the_question_of_a_raster_is_put_again() {
    let place = Workplace::with_house();
    place.summary(&format!("sky-view {HOUSE} --surface --cell 2 --directions 145 --target-height 0.5 -o sky.tif"));
    let run = place.summary(&format!("ask sky.tif {HOUSE} -o again.tif"));
    assert_eq!(place.pixels("again.tif"), place.pixels("sky.tif"));
    assert_eq!(run["lines_of_sight"]["directions"], 145);
    // and again that of the raster that it wrote
    place.summary(&format!("ask again.tif {HOUSE} -o third.tif"));
    assert_eq!(place.pixels("third.tif"), place.pixels("sky.tif"));

    place.summary(&format!("viewshed {HOUSE} --observer {EAST},{} --cell 2 -o seen.tif", NORTH - 12.0));
    place.refusal(2, &format!("ask seen.tif {HOUSE}"), &["seen.tif", "who looks", "belvedere viewshed"]);
    place.refusal(1, &format!("ask house.tif {HOUSE}"), &["house.tif", "no such file"]);
    place.refusal(2, &format!("ask sky.tif {HOUSE} -o sky.tif"), &["same file as the input"]);
}

#[test]
fn standard_input_holds_a_question_and_one_without_places_is_about_cells() {
    let place = Workplace::with_house();
    let mut command = place.command(&format!("--json ask - {HOUSE}"));
    let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
    child.stdin.take().unwrap().write_all(br#"{"sky-view": {"sky": {"even": 48}}}"#).unwrap();
    let output = child.wait_with_output().unwrap();
    let run: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(run["lines_of_sight"]["directions"], 48);
    assert!(run["headline"][0].as_str().unwrap().ends_with("cells of 0.5 m"), "{run}");
    assert!(run["measures"]["sky_view_factor"]["values"].is_null());
}

#[test]
fn places_may_be_degrees_and_those_beside_the_points_are_refused_at_once() {
    let place = Workplace::with_house();
    let degrees = json!([[PLACE_DEG[0], PLACE_DEG[1]]]);
    let sky = json!({ "sky-view": { "sky": { "even": 48 } } });
    let run = answer(&place, &json!({ "question": sky, "places": { "at": degrees } }), "");
    let position = numbers(&run["at"][0]["position"]);
    assert!((position[0] - EAST).abs() < 1.0 && (position[1] - NORTH + 12.0).abs() < 1.0, "{position:?}");
    place.write("question.json", json!({ "question": sky, "places": { "at": [[EAST + 500.0, NORTH]] } }).to_string());
    place.refusal(1, &format!("ask question.json {HOUSE}"), &["85500", "the points reach from"]);
}

#[test]
fn what_is_no_question_is_refused_and_says_why() {
    let place = Workplace::with_house();
    let eyes = r#""places": {"eyes": [[85000, 445990]]}"#;
    for (status, text, words) in [
        (1, "{", &["question.json", "line 1"][..]),
        (1, r#"{"question": {"sun-hour": {}}}"#, &["sun-hour", "sun-hours"]),
        (1, r#"{"question": {"sky-view": {"ski": 3}}}"#, &["question.sky-view", "\"ski\"", "trees"]),
        (1, r#"{"sun-hours": {"days": {"date": []}}}"#, &["sun-hours.days", "\"date\"", "dates"]),
        (1, r#"{"question": {"sky-view": {}}, "place": "scene"}"#, &["`place`", "places"]),
        (1, r#"{"question": {"sky-view": {}}, "places": {"at": [[1]]}}"#, &["1 numbers", "x and y"]),
        (1, r#"{"question": {"horizon": {}}}"#, &["observer", "eyes"]),
        (1, r#"{"question": {"line-of-sight": {}}}"#, &["pairs"]),
        (1, &format!(r#"{{"question": {{"sky-view": {{}}}}, {eyes}}}"#), &["observer", "cells"]),
        (2, r#"{"question": {"towers": {}}}"#, &["towers", "belvedere towers"]),
        (2, r#"{"question": {"view-targets": {}}}"#, &["a view", "belvedere query"]),
        (2, r#"{"question": {"landmark": {"shape": {"mesh": {"seed": 1}}}}}"#, &["belvedere landmark"]),
        (2, r#"{"question": {"heat": {}}}"#, &["weather", "path"]),
    ] {
        place.write("question.json", text);
        place.refusal(status, &format!("ask question.json {HOUSE}"), words);
    }
    place.write("question.json", format!(r#"{{"question": {{"horizon": {{}}}}, {eyes}}}"#));
    place.refusal(2, &format!("ask question.json {HOUSE} -o a.csv"), &["belvedere horizon", "--json"]);
}

/// The JSON schema as the program prints it.
fn schema(place: &Workplace) -> Value {
    serde_json::from_str(&place.run("describe --json-schema").stdout).unwrap()
}

/// Checks a value against a schema, with the keywords that these schemas have.
fn is_valid(value: &Value, schema: &Value, root: &Value) -> bool {
    let Some(schema) = schema.as_object() else { return schema.as_bool().unwrap() };
    let any = |schemas: &Value| schemas.as_array().unwrap().iter().filter(|one| is_valid(value, one, root)).count();
    let is_of_type = |name: &str| match name {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "boolean" => value.is_boolean(),
        "null" => value.is_null(),
        "integer" => value.is_i64() || value.is_u64(),
        "number" => value.is_number(),
        other => panic!("{other}"),
    };
    let fields = |object: &Map<String, Value>| {
        let known = schema.get("properties").and_then(Value::as_object);
        object.iter().all(|(name, field)| match known.and_then(|known| known.get(name)) {
            Some(inner) => is_valid(field, inner, root),
            None => schema.get("additionalProperties") != Some(&Value::Bool(false)),
        })
    };
    let items = |list: &Vec<Value>| {
        let first = schema.get("prefixItems").and_then(Value::as_array).map_or(&[][..], Vec::as_slice);
        let rest = schema.get("items");
        list.iter().enumerate().all(|(i, item)| match first.get(i).or(rest) {
            Some(inner) => is_valid(item, inner, root),
            None => true,
        })
    };
    let count = value.as_array().map(|list| list.len() as u64);
    schema.iter().all(|(keyword, wanted)| match keyword.as_str() {
        "$schema" | "$defs" | "title" | "description" | "default" | "format" => true,
        "additionalProperties" => wanted.is_boolean(),
        "$ref" => is_valid(value, root.pointer(wanted.as_str().unwrap().trim_start_matches('#')).unwrap(), root),
        "type" => match wanted {
            Value::Array(names) => names.iter().any(|name| is_of_type(name.as_str().unwrap())),
            name => is_of_type(name.as_str().unwrap()),
        },
        "oneOf" => any(wanted) == 1,
        "anyOf" => any(wanted) > 0,
        "const" => value == wanted,
        "enum" => wanted.as_array().unwrap().contains(value),
        "required" => wanted.as_array().unwrap().iter().all(|name| value.get(name.as_str().unwrap()).is_some()),
        "properties" => value.as_object().is_none_or(fields),
        "items" | "prefixItems" => value.as_array().is_none_or(items),
        "minItems" => count.is_none_or(|count| count >= wanted.as_u64().unwrap()),
        "maxItems" => count.is_none_or(|count| count <= wanted.as_u64().unwrap()),
        "minimum" => value.as_f64().is_none_or(|number| number >= wanted.as_f64().unwrap()),
        "maximum" => value.as_f64().is_none_or(|number| number <= wanted.as_f64().unwrap()),
        other => panic!("no check of the keyword {other}"),
    })
}

#[test]
fn the_schema_has_every_question_and_a_text_for_each_field() {
    let place = Workplace::new();
    let schema = schema(&place);
    assert_eq!(schema["$schema"], "https://json-schema.org/draft/2020-12/schema");
    let variants = schema["$defs"]["Question"]["oneOf"].as_array().unwrap();
    let names: BTreeSet<&str> = variants.iter().map(|one| one["required"][0].as_str().unwrap()).collect();
    // questions have the names of commands, but for that of `query`
    let program = place.summary("describe");
    let commands: BTreeSet<&str> =
        program["commands"].as_array().unwrap().iter().map(|command| command["name"].as_str().unwrap()).collect();
    let others: Vec<&&str> = names.iter().filter(|name| !commands.contains(**name)).collect();
    assert_eq!((names.len(), others), (22, vec![&"view-targets"]));

    let mut fields = 0;
    for (of, definition) in schema["$defs"].as_object().unwrap() {
        for (name, field) in definition["properties"].as_object().into_iter().flatten() {
            fields += 1;
            let text = field["description"].as_str().unwrap_or_default();
            assert!(text.len() > 5 && !text.contains(['`', '[']), "{of}.{name}: {text}");
        }
    }
    assert!(fields > 150, "{fields}");
}

#[test]
fn defaults_of_the_schema_are_those_of_the_questions() {
    let schema = schema(&Workplace::new());
    let questions = [
        ("SunHoursQuestion", serde_json::to_value(ask::SunHoursQuestion::default())),
        ("SkyViewQuestion", serde_json::to_value(ask::SkyViewQuestion::default())),
        ("HeatQuestion", serde_json::to_value(ask::HeatQuestion::default())),
        ("LinesOfSightQuestion", serde_json::to_value(ask::LinesOfSightQuestion::default())),
        ("HorizonQuestion", serde_json::to_value(ask::HorizonQuestion::default())),
        ("ViewshedQuestion", serde_json::to_value(ask::ViewshedQuestion::default())),
        ("CamerasQuestion", serde_json::to_value(ask::CamerasQuestion::default())),
        ("SurveyPlanQuestion", serde_json::to_value(ask::SurveyPlanQuestion::default())),
        ("SunPlace", serde_json::to_value(ask::SunPlace::default())),
        ("GivenCells", serde_json::to_value(ask::GivenCells::default())),
    ];
    for (name, expected) in questions {
        let expected = expected.unwrap();
        let properties = schema["$defs"][name]["properties"].as_object().unwrap();
        let defaults: Map<String, Value> =
            properties.iter().map(|(field, text)| (field.clone(), text["default"].clone())).collect();
        assert_eq!(Value::Object(defaults), expected, "{name}");
    }
}

/// The blocks of a language on the page about questions in JSON.
fn blocks(language: &str) -> Vec<String> {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/methods/json.md");
    let page = std::fs::read_to_string(page).unwrap();
    let fence = format!("```{language}\n");
    let blocks = page.split(&fence).skip(1).filter_map(|rest| rest.split("```").next());
    blocks.map(str::to_owned).collect()
}

#[test]
fn questions_of_the_page_work_as_printed_and_fit_the_schema() {
    let place = Workplace::new();
    assert_eq!(place.run("demo -o demo").status, 0);
    let schema = schema(&place);
    let questions = blocks("json");
    assert!(questions.len() >= 3, "{questions:?}");
    for text in &questions {
        let question: Value = serde_json::from_str(text).unwrap();
        assert!(is_valid(&question, &schema, &schema), "{text}");
        place.write("question.json", text);
        let run = place.run("ask question.json demo/town.laz --json");
        assert_eq!(run.status, 0, "{text}: {run:?}");
    }
    let of_demo: Value = serde_json::from_str(&place.text("demo/question.json")).unwrap();
    assert!(is_valid(&of_demo, &schema, &schema));
    for wrong in [
        r#"{"question": {"sun-hours": {"dayz": {}}}}"#,
        r#"{"question": {"sky-view": {}}, "places": {"at": [[1]]}}"#,
        r#"{"question": {"sky-view": {}}, "place": "scene"}"#,
        r#"{"question": {"shadow": {}}}"#,
    ] {
        assert!(!is_valid(&serde_json::from_str(wrong).unwrap(), &schema, &schema), "{wrong}");
    }
    let commands = blocks("sh").join("");
    let commands: Vec<&str> = commands.lines().filter_map(|line| line.strip_prefix("belvedere ")).collect();
    assert!(commands.len() >= 3, "{commands:?}");
    for command in commands {
        let run = place.run(command.split(" > ").next().unwrap());
        assert_eq!(run.status, 0, "{command}: {run:?}");
    }
}
