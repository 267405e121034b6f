//! `--device`: the graphics processor that was chosen, for all scenes of this run.

#[cfg(feature = "gpu")]
use crate::arguments::DeviceChoice;
use crate::arguments::Global;
use crate::summary::Summary;
use anyhow::Result;
use belvedere::model::SceneModel;

#[cfg(feature = "gpu")]
use belvedere::gpu::{Choice, Gpu, devices};
#[cfg(feature = "gpu")]
use std::sync::{Arc, OnceLock};

#[cfg(feature = "gpu")]
static CHOSEN: OnceLock<Arc<Gpu>> = OnceLock::new();

/// Makes the device ready that was asked for.
#[cfg(feature = "gpu")]
pub(crate) fn choose(global: &Global) -> Result<()> {
    let choice = match global.device {
        DeviceChoice::Cpu => return Ok(()),
        DeviceChoice::Automatic => Choice::Automatic,
        DeviceChoice::Gpu => Choice::Gpu,
        DeviceChoice::Number(number) => Choice::Number(number),
    };
    let gpu = crate::pipeline::flagged("--device", Gpu::new(choice))?;
    CHOSEN.get_or_init(|| Arc::new(gpu));
    Ok(())
}

/// Refuses what this program was built without.
#[cfg(not(feature = "gpu"))]
pub(crate) fn choose(global: &Global) -> Result<()> {
    use crate::arguments::{DeviceChoice, Usage};
    match global.device {
        DeviceChoice::Automatic | DeviceChoice::Cpu => Ok(()),
        DeviceChoice::Gpu | DeviceChoice::Number(_) => {
            let device = match global.device {
                DeviceChoice::Number(number) => number.to_string(),
                _ => "gpu".to_owned(),
            };
            Err(Usage(format!(
                "--device {device}: this program was built without the cargo feature `gpu`; leave --device out (the CPU gives the same \
                 results), or install the program with `cargo install belvedere-cli --features gpu`"
            ))
            .into())
        }
    }
}

/// The same model, whose scenes use the device.
pub(crate) fn with_device(model: SceneModel) -> SceneModel {
    #[cfg(feature = "gpu")]
    if let Some(gpu) = CHOSEN.get() {
        return model.with_backend(Arc::clone(gpu) as _);
    }
    model
}

/// Which device was used, and what the CPU had to do instead.
pub(crate) fn report(summary: &mut Summary) {
    #[cfg(feature = "gpu")]
    if let Some(gpu) = CHOSEN.get() {
        if let Some(device) = gpu.used() {
            summary.add("device", device.name.clone());
        }
        for note in gpu.notes() {
            summary.warn(note);
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
                .add("largest_buffer_mib", info.most_bytes >> 20);
            serde_json::Value::from(section)
        };
        summary.add("devices", devices().into_iter().map(section).collect::<Vec<_>>());
    }
    #[cfg(not(feature = "gpu"))]
    let _ = summary;
}
