//! `--device`: the files are those of the CPU, whichever device is used; depth maps within their tolerance.
//!
//! The tests run on every device of the computer, software ones among them (Debian: `mesa-vulkan-drivers`).

use crate::common::{Workplace, house_in_a_field, skipped};
use serde_json::Value;

/// The numbers and names of the devices of this computer.
fn devices(place: &Workplace) -> Vec<(u64, String)> {
    let info = place.summary("info field.laz");
    let device = |device: &Value| (device["number"].as_u64().unwrap(), device["name"].as_str().unwrap().to_owned());
    let found: Vec<_> = info["devices"].as_array().unwrap().iter().map(device).collect();
    if found.is_empty() {
        skipped("tests of --device: this computer has no device with a driver for Vulkan, Metal or DirectX 12");
    }
    found
}

fn with_field() -> Workplace {
    let place = Workplace::new();
    place.write_cloud("field.laz", &house_in_a_field());
    place.summary("balls field.laz -o balls.npz");
    place
}

/// Returns true if the depths in two NPY files of single precision differ by at most 10⁻⁵ of themselves.
fn are_depths_within(expected: &[u8], drawn: &[u8]) -> bool {
    // headers of version 1 take 128 bytes
    let depths = |bytes: &[u8]| -> Vec<f32> {
        bytes[128..].as_chunks::<4>().0.iter().map(|word| f32::from_le_bytes(*word)).collect()
    };
    let (expected_depths, drawn_depths) = (depths(expected), depths(drawn));
    let is_within =
        |(&expected, &drawn): (&f32, &f32)| drawn == expected || (drawn - expected).abs() <= 1e-5 * expected;
    let seen = expected_depths.iter().filter(|depth| depth.is_finite()).count();
    seen > 1000
        && expected.len() == drawn.len()
        && expected[..128] == drawn[..128]
        && expected_depths.iter().zip(&drawn_depths).all(is_within)
}

#[test]
fn a_device_gives_the_results_of_the_cpu_and_is_named() {
    let place = with_field();
    for (number, name) in devices(&place) {
        for (command, output) in [
            ("sky-view balls.npz --ground cloud=field.laz --cell 2", "tif"),
            ("sun-hours balls.npz --ground cloud=field.laz --date 2026-03-21 --cell 2", "tif"),
            ("shadow balls.npz --ground cloud=field.laz --sun 160,35 --cell 0.5", "tif"),
            ("viewshed balls.npz --ground cloud=field.laz --observer 85020,446020 --cell 0.5", "tif"),
            ("depth-map balls.npz --sun 160,35", "npy"),
        ] {
            let of_cpu = place.summary(&format!("{command} --device cpu -o cpu.{output}"));
            let of_device = place.summary(&format!("{command} --device {number} -o device.{output}"));
            assert_eq!(of_cpu.get("device"), None, "{command}");
            assert_eq!(of_device["device"].as_str(), Some(name.as_str()), "{command}");
            let [cpu, device] = ["cpu", "device"].map(|name| place.bytes(&format!("{name}.{output}")));
            let is_equal = if output == "npy" { are_depths_within(&cpu, &device) } else { cpu == device };
            assert!(is_equal, "{command} differs on {name}");
        }
    }
}

#[test]
fn a_device_that_is_not_there_is_refused_or_replaced_by_the_cpu() {
    let place = with_field();
    place.refusal(1, "shadow field.laz --sun 160,35 -o out.tif --device 999", &["no device 999", "belvedere info"]);
    place.summary("sky-view field.laz --cell 1 --device cpu -o cpu.tif");
    let summary = place.summary("sky-view field.laz --cell 1 --device gpu -o gpu.tif");
    let is_replaced = summary["remarks"].to_string().contains("no graphics processor with a driver");
    assert_ne!(summary.get("device").is_some(), is_replaced, "{summary}");
    assert!(place.bytes("cpu.tif") == place.bytes("gpu.tif"));
    assert_eq!(place.names(), ["balls.npz", "cpu.tif", "field.laz", "gpu.tif"]);
}
