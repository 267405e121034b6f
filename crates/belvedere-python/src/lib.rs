//! The native part of the Python package `belvedere`: calls the library, decides and computes nothing itself.
//!
//! The package in `python/belvedere` has the documentation and everything that does not need the library. Here arrays
//! become columns, work is done without the interpreter, and results become arrays.

mod arrays;
mod cameras;
mod cloud;
mod device;
mod documents;
mod energy;
mod errors;
mod fetch;
mod glare;
mod landmark;
mod mesh;
mod observers;
mod outlook;
mod pictures;
mod planning;
mod question;
mod raster;
mod remarks;
mod result_columns;
mod scene;
mod shadow;
mod simulate;
mod sun;
mod survey_plan;
mod system;
mod targets;
mod towers;
mod viewshed;
mod visibility;
mod windows;
mod work;

use pyo3::prelude::*;

/// Defines the native module of the package.
#[pymodule]
fn _core(module: &Bound<'_, PyModule>) -> PyResult<()> {
    if std::env::var("BELVEDERE_AVX2").is_ok_and(|text| text == "off") {
        belvedere::neighbors::Instructions::turn_avx2_off();
    }
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add("NO_VALUE", belvedere::results::ResultKind::NO_NUMBER)?;
    module.add_class::<cloud::Cloud>()?;
    module.add_class::<mesh::PyMesh>()?;
    module.add_class::<scene::PyScene>()?;
    module.add_class::<system::System>()?;
    module.add_function(wrap_pyfunction!(cloud::read, module)?)?;
    module.add_function(wrap_pyfunction!(device::devices, module)?)?;
    module.add_function(wrap_pyfunction!(fetch::fetch, module)?)?;
    module.add_function(wrap_pyfunction!(fetch::open_surveys, module)?)?;
    module.add_function(wrap_pyfunction!(raster::write_geotiff, module)?)?;
    module.add_function(wrap_pyfunction!(simulate::simulate, module)?)?;
    Ok(())
}
