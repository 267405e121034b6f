//! Graphics processors, where the module is built with them.

use belvedere::query::{Backend, Cpu};
use belvedere::{Error, Parameter, Result};
use pyo3::prelude::*;
use std::sync::Arc;

/// Returns the backend that `device` names: `auto`, `cpu`, `gpu`, or the number of a device.
pub(crate) fn backend(device: &str) -> Result<Arc<dyn Backend>> {
    if device == "cpu" { Ok(Arc::new(Cpu)) } else { of_gpu(device) }
}

#[cfg(feature = "gpu")]
fn of_gpu(device: &str) -> Result<Arc<dyn Backend>> {
    use belvedere::gpu::{Choice, Gpu};
    let choice = match device {
        "auto" => Choice::Automatic,
        "gpu" => Choice::Gpu,
        number => number.parse().map(Choice::Number).map_err(|_| unknown(device))?,
    };
    Ok(Arc::new(Gpu::new(choice)?))
}

#[cfg(not(feature = "gpu"))]
fn of_gpu(device: &str) -> Result<Arc<dyn Backend>> {
    match device {
        "auto" => Ok(Arc::new(Cpu)),
        named if named == "gpu" || named.parse::<usize>().is_ok() => Err(Error::Device {
            what: "this package was built without the cargo feature `gpu`; leave the device out (the CPU gives the same results)".to_owned(),
        }),
        _ => Err(unknown(device)),
    }
}

fn unknown(device: &str) -> Error {
    Error::InvalidParameter {
        parameter: Parameter::Device,
        value: device.to_owned(),
        expected: "auto, cpu, gpu, or the number of a device",
    }
}

/// Name, kind, driver and interface of each device of this computer, in the order of their numbers; none without the
/// feature `gpu`.
#[pyfunction]
pub(crate) fn devices() -> Vec<[String; 4]> {
    #[cfg(feature = "gpu")]
    {
        let of = |info: belvedere::gpu::DeviceInfo| [info.name, info.kind.to_string(), info.driver, info.interface];
        belvedere::gpu::devices().into_iter().map(of).collect()
    }
    #[cfg(not(feature = "gpu"))]
    Vec::new()
}
