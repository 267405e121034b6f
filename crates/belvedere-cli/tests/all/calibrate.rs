//! `belvedere calibrate`: how reliable answers on a survey are, and the scene that keeps it.

use crate::common::{Workplace, remarks};
use serde_json::Value;

#[test]
fn a_survey_is_measured_and_its_scene_quotes_the_figures() {
    let place = Workplace::new();
    place.summary("simulate town -o town --extent 60 --density 6");
    let run = place.summary("calibrate town/cloud.laz -o found.json -o found.npz");
    let written: Value = serde_json::from_str(&place.text("found.json")).unwrap();
    assert_eq!(written, run["reliability"]);
    let percent = |places: &str| run["reliability"][places]["wrong_percent"]["value"].as_f64().unwrap();
    let (blocked, visible) = (percent("free_paths"), percent("hidden_places"));
    let headline = run["headline"].to_string();
    for figure in [format!("{blocked} % ("), format!("{visible} % ("), "90 % and more".to_owned()] {
        assert!(headline.contains(&figure), "{figure}: {headline}");
    }
    // the scene is that of all points
    place.summary("balls town/cloud.laz -o all.npz");
    assert!(place.npz::<f32>("found.npz", "radii") == place.npz::<f32>("all.npz", "radii"));
    let info = place.summary("info found.npz");
    assert_eq!(info["made"]["reliability_false_blocked_percent"], blocked.to_string());
    assert_eq!(info["made"]["reliability_false_visible_percent"], visible.to_string());
    let shadow = place.summary("shadow found.npz --targets town/cloud.laz --sun 180,30 -o lit.laz");
    let is_quoted = |remark: &&Value| remark["key"] == "reliability-measured";
    let quoted = shadow["remarks"].as_array().unwrap().iter().find(is_quoted).unwrap();
    assert_eq!(
        (&quoted["severity"], quoted["numbers"]["false_blocked_percent"].as_f64()),
        (&"note".into(), Some(blocked))
    );
    let plain = place.summary("shadow all.npz --targets town/cloud.laz --sun 180,30 -o lit.laz");
    assert!(!remarks(&plain).iter().any(|text| text.contains("pulses kept out")));

    let other = place.summary("calibrate town/cloud.laz --seed 2 --share 0.2");
    assert!(other["reliability"]["seed"] == 2 && other["reliability"]["share"] == 0.2);
    let count = |run: &Value| run["reliability"]["pulses_kept_out"].as_u64().unwrap();
    // a fifth instead of a tenth, within a tenth of these numbers of some thousands
    assert!(count(&other) * 10 > count(&run) * 18 && count(&other) * 10 < count(&run) * 22, "{other}");
}

#[test]
fn what_cannot_be_measured_is_refused_with_what_to_do() {
    let place = Workplace::with_house();
    place.refusal(1, "calibrate house.laz", &["house.laz", "scanner positions", "--orient trajectory=FILE"]);
    place.refusal(1, "calibrate house.xyz", &["house.xyz"]);
    place.summary("balls house.laz --orient given --method tau -o balls.npz");
    place.refusal(2, "calibrate balls.npz", &["balls.npz", "give the cloud"]);
    for share in ["0", "1", "-0.1", "nan"] {
        place.refusal(2, &format!("calibrate house.laz --share={share}"), &["--share", "above 0 and below 1"]);
    }
    place.refusal(2, "calibrate house.laz -o found.tif", &["found.tif", ".json .npz"]);
    place.refusal(1, "calibrate house.laz -o none/found.json", &["none"]);
}
