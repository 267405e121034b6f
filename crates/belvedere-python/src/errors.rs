//! Errors of the library as Python exceptions: one place.

use belvedere::shown::ShownPath;
use belvedere::{Error, Parameter};
use pyo3::exceptions::{PyMemoryError, PyOSError};
use pyo3::prelude::*;
use std::io::ErrorKind;

/// The exception for an error of the library.
///
/// Refusals of the operating system become `OSError` or its subclass, or `MemoryError`; all else
/// `belvedere.BelvedereError` with the problem, the offending value, and advice.
pub(crate) fn exception(error: Error) -> PyErr {
    let message = error.to_string();
    let (what, value, advice) = match error {
        Error::Io { path, source } => return refused(&ShownPath(&path).to_string(), &source),
        Error::TooLittleMemory { .. } => return PyMemoryError::new_err(message),
        Error::Malformed { path, what } | Error::UnusableCrs { path, what } => {
            (what.clone(), ShownPath(&path).to_string(), what)
        }
        Error::DistantFile { path } => ("distant file".to_owned(), ShownPath(&path).to_string(), message.clone()),
        Error::UnknownFormat { path, kind, supported } => {
            (format!("{kind} format"), ShownPath(&path).to_string(), format!("use one of {supported}"))
        }
        Error::MissingFeature { path, feature } => {
            (format!("feature {feature}"), ShownPath(&path).to_string(), format!("build the package with `{feature}`"))
        }
        Error::NoPoints { what } => ("points".to_owned(), "0".to_owned(), what),
        Error::NoSurface { count, what } => (format!("points {what}"), count.to_string(), message.clone()),
        Error::InvalidParameter { parameter, value, expected } => {
            (keyword(parameter).to_owned(), value, format!("must be {expected}"))
        }
        Error::NoObserver { who, what } => (format!("{who}s"), "0 left".to_owned(), what),
        Error::LengthMismatch { what, expected, found } => {
            (what.to_owned(), found.to_string(), format!("give {expected} values"))
        }
        Error::MissingAttribute { attribute, advice, .. } => {
            (attribute.to_owned(), "missing".to_owned(), advice.to_owned())
        }
        Error::UnsupportedTargets { method, what } | Error::UnsupportedViewer { method, what } => {
            (method.to_owned(), String::new(), what.to_owned())
        }
        _ => (message.clone(), String::new(), message.clone()),
    };
    belvedere_error(&message, &what, &value, &advice)
}

/// The argument that gives a parameter, or its name where several do or none.
fn keyword(parameter: Parameter) -> &'static str {
    match parameter {
        Parameter::Azimuth => "azimuth_range_deg",
        Parameter::Elevation => "elevation_range_deg",
        Parameter::AngleStep => "angle_step_deg",
        Parameter::DirectionCount => "directions",
        Parameter::FenceHeight => "fence_height",
        Parameter::Frequency => "frequency_ghz",
        Parameter::HoursOfDay => "between",
        Parameter::InitialRadius => "initial_radius",
        Parameter::LastDay => "to",
        Parameter::Latitude | Parameter::Longitude | Parameter::LatitudeLongitude => "location",
        Parameter::LookAt => "look_at",
        Parameter::ObserverCount => "spread",
        Parameter::Network => "places",
        Parameter::Study => "study",
        Parameter::Tower => "towers",
        Parameter::MaxDistance => "max_distance",
        Parameter::MaxHeight => "max_height",
        Parameter::MaxRadius => "max_radius",
        Parameter::MinJump => "min_jump",
        Parameter::DcAcRatio => "dc_ac_ratio",
        Parameter::InverterEfficiency => "inverter_efficiency",
        Parameter::ModuleEfficiency => "module_efficiency",
        Parameter::SystemLosses => "system_losses",
        Parameter::TemperatureCoefficient => "temperature_coefficient",
        Parameter::NeighborCount => "neighbors",
        Parameter::PatchDivision => "patch_division",
        Parameter::PictureSize => "size",
        Parameter::PixelSize => "pixel",
        Parameter::ProtectedPlace => "protect",
        Parameter::Refraction => "refraction",
        Parameter::Spacing => "spacing",
        Parameter::Reflector => "reflectors",
        Parameter::Scatter => "scatter_deg",
        Parameter::MinSeparation => "from_sun_deg",
        Parameter::SurveyPlace => "at",
        Parameter::SunCell => "sun_cell_deg",
        Parameter::SunDirection => "sun",
        Parameter::TimeStep => "time_step_min",
        Parameter::TimeZone => "zone",
        Parameter::Transmissivity | Parameter::ThroughTrees => "through_trees",
        Parameter::Turbidity => "linke",
        Parameter::UnprovenAs => "unproven",
        Parameter::Certainty => "certain",
        Parameter::Interval => "interval",
        Parameter::HeldOutShare => "share",
        Parameter::WeatherParts => "parts_per_row",
        Parameter::WindFactor => "wind_factor",
        Parameter::GroundWarming => "ground_warming",
        other => other.name(),
    }
}

/// A `BelvedereError` about an argument.
pub(crate) fn belvedere_error(message: &str, what: &str, value: &str, advice: &str) -> PyErr {
    let made = Python::attach(|py| {
        let class = py.import("belvedere._errors")?.getattr("BelvedereError")?;
        Ok::<_, PyErr>(PyErr::from_value(class.call1((message, what, value, advice))?))
    });
    made.unwrap_or_else(|error| error)
}

/// An argument outside its range.
pub(crate) fn wrong(what: &str, value: &str, advice: &str) -> PyErr {
    belvedere_error(&format!("{what} is {value}: {advice}"), what, value, advice)
}

/// The exception that Python itself raises for such a file, which chooses its class by the number.
fn refused(path: &str, source: &std::io::Error) -> PyErr {
    if source.kind() == ErrorKind::NotFound {
        return pyo3::exceptions::PyFileNotFoundError::new_err((
            source.raw_os_error(),
            "there is no such file or folder; check the path".to_owned(),
            path.to_owned(),
        ));
    }
    match source.raw_os_error() {
        Some(number) => PyOSError::new_err((number, source.to_string(), path.to_owned())),
        None => PyOSError::new_err(format!("{path}: {source}")),
    }
}
