//! `belvedere trajectory`: the scanner's path from the pulses of a cloud, against the path that was flown.

use crate::common::Workplace;

/// Rows of a table of numbers below its heading; NaN for what is empty.
fn rows(text: &str) -> Vec<Vec<f64>> {
    let row = |line: &str| line.split(',').map(|field| field.parse().unwrap_or(f64::NAN)).collect();
    text.lines().skip(1).map(row).collect()
}

/// The flown position at `time`, between the rows of the simulated trajectory, 20 a second.
fn flown(truth: &[Vec<f64>], time: f64) -> [f64; 3] {
    let after = truth.partition_point(|row| row[0] <= time).clamp(1, truth.len() - 1);
    let (a, b) = (&truth[after - 1], &truth[after]);
    let share = (time - a[0]) / (b[0] - a[0]);
    [1, 2, 3].map(|i| a[i] + share * (b[i] - a[i]))
}

#[test]
fn the_path_is_the_one_flown_and_is_read_as_a_trajectory() {
    let place = Workplace::new();
    place.summary("simulate town -o town --extent 100 --density 6");
    let made = place.summary("trajectory town/cloud.laz --time-step-s 0.25 -o found.csv");
    assert_eq!(made["scanner"]["found_by"], "pulses with several returns", "{made}");
    let lines = made["scanner_by_line"].as_array().unwrap();
    assert_eq!(lines.len(), 2, "{made}");
    for line in lines {
        // simulated strips are flown 450 m up at 60 m/s; the echoes of the simulator are worth a percent of the height
        assert!((line["speed_m_per_s"].as_f64().unwrap() - 60.0).abs() < 2.0, "{line}");
        assert!((line["height_above_ground_m"].as_f64().unwrap() - 450.0).abs() < 15.0, "{line}");
    }
    let text = place.text("found.csv");
    assert_eq!(text.lines().next(), Some("time,x,y,z,sd_x,sd_y,sd_z,residual_deg,line"));
    let (found, truth) = (rows(&text), rows(&place.text("town/trajectory.csv")));
    assert_eq!(found.len(), usize::try_from(made["positions"].as_u64().unwrap()).unwrap());
    for row in &found {
        let place = flown(&truth, row[0]);
        let off = (0..3).map(|i| (row[i + 1] - place[i]).powi(2)).sum::<f64>().sqrt();
        assert!(off < 1.5, "{row:?} {place:?}");
        // deviations below half a millimetre are printed as 0
        assert!(row[4..8].iter().all(|v| *v >= 0.0) && (row[8] >= 1.0), "{row:?}");
    }
    // no gap within a line is longer than readers bridge
    assert!(found.windows(2).all(|w| w[0][8] < w[1][8] || w[1][0] - w[0][0] <= 0.2501), "{found:?}");
    let used = place.summary("balls town/cloud.laz --method carved --orient trajectory=found.csv -o balls.npz");
    assert_eq!(used["scanner"]["found_by"], "trajectory");
    // half a microsecond at either end of a line is rounded off
    assert!(used["scanner"]["scanner_known_percent"].as_f64().unwrap() > 99.9, "{used}");
    assert_eq!(used["scanner"]["trajectory_height_offset_corrected"].as_str().unwrap().get(..2), Some("no"), "{used}");
    let info = place.summary("info town/cloud.laz");
    assert_eq!(info["scanner"]["found_by"], made["scanner"]["found_by"]);
    assert_eq!(info["scanner_by_line"], made["scanner_by_line"]);
}

#[test]
fn files_without_a_path_are_refused() {
    let place = Workplace::new();
    place.write("bare.xyz", "1 1 1\n2 2 2\n3 4 4\n4 4 5\n");
    place.refusal(1, "trajectory bare.xyz -o found.csv", &["GPS time"]);
    place.refusal(2, "trajectory bare.xyz -o found.laz", &[".csv"]);
    place.refusal(2, "trajectory bare.xyz --time-step-s 5 -o found.csv", &["--time-step-s", "2 s"]);
    assert_eq!(place.names(), ["bare.xyz"]);
}
