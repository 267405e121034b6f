//! `--device`: the graphics processor that was chosen, for all scenes of this run.

use crate::arguments::{DeviceChoice, Global};
use crate::summary::Summary;
use anyhow::Result;
use belvedere::model::SceneModel;

#[cfg(feature = "gpu")]
use belvedere::gpu::{Choice, Gpu, devices};
#[cfg(feature = "gpu")]
use std::sync::{Arc, OnceLock};

#[cfg(feature = "gpu")]
static CHOSEN: OnceLock<Arc<Gpu>> = OnceLock::new();

/// Prepares the requested device.
#[cfg(feature = "gpu")]
pub(crate) fn choose(global: &Global) -> Result<()> {
    let choice = match global.device {
        DeviceChoice::Cpu => return Ok(()),
        DeviceChoice::Automatic => Choice::Automatic,
        DeviceChoice::Gpu => Choice::Gpu,
        DeviceChoice::Number(number) => Choice::Number(number),
    };
    let gpu = Gpu::new(choice)?;
    CHOSEN.get_or_init(|| Arc::new(gpu));
    Ok(())
}

/// Refuses what this program was built without.
#[cfg(not(feature = "gpu"))]
pub(crate) fn choose(global: &Global) -> Result<()> {
    refuse_without_feature(global.device)
}

/// Refuses all devices but the CPU.
#[cfg(any(test, not(feature = "gpu")))]
fn refuse_without_feature(device: DeviceChoice) -> Result<()> {
    let device = match device {
        DeviceChoice::Automatic | DeviceChoice::Cpu => return Ok(()),
        DeviceChoice::Gpu => "gpu".to_owned(),
        DeviceChoice::Number(number) => number.to_string(),
    };
    Err(crate::arguments::Usage(format!(
        "--device {device}: this program was built without the cargo feature `gpu`; leave --device out (the CPU gives the same results), or \
         install the program with `cargo install belvedere-cli --features gpu`"
    ))
    .into())
}

/// The same model, whose scenes use the device.
pub(crate) fn with_device(model: SceneModel) -> SceneModel {
    #[cfg(feature = "gpu")]
    if let Some(gpu) = CHOSEN.get() {
        return model.with_backend(Arc::clone(gpu) as _);
    }
    model
}

/// Reports the device that was used, and the work that fell to the CPU.
pub(crate) fn report(summary: &mut Summary) {
    #[cfg(feature = "gpu")]
    if let Some(gpu) = CHOSEN.get() {
        if let Some(device) = gpu.used() {
            summary.add("device", device.name.clone());
        }
        for note in gpu.notes() {
            summary.warn("device", note);
        }
    }
    #[cfg(not(feature = "gpu"))]
    let _ = summary;
}

/// The graphics processors of this computer, for `info`.
pub(crate) fn list(summary: &mut Summary) {
    #[cfg(feature = "gpu")]
    {
        let section = |info: belvedere::gpu::DeviceInfo| {
            let mut section = Summary::default();
            section
                .add("number", info.number)
                .add("name", info.name)
                .add("kind", info.kind.to_string())
                .add("driver", info.driver)
                .add("interface", info.interface)
                .add("largest_buffer_mib", info.max_bytes >> 20);
            serde_json::Value::from(section)
        };
        summary.add("devices", devices().into_iter().map(section).collect::<Vec<_>>());
    }
    #[cfg(not(feature = "gpu"))]
    let _ = summary;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_program_without_the_feature_refuses_devices_and_names_flag_and_feature() {
        for device in [DeviceChoice::Automatic, DeviceChoice::Cpu] {
            assert!(refuse_without_feature(device).is_ok());
        }
        for (device, flag) in [(DeviceChoice::Gpu, "--device gpu"), (DeviceChoice::Number(7), "--device 7")] {
            let error = refuse_without_feature(device).unwrap_err();
            assert!(error.is::<crate::arguments::Usage>());
            let text = error.to_string();
            assert!(text.contains(flag) && text.contains("--features gpu"), "{text}");
        }
    }
}
