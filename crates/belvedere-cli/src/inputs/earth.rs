//! The curved earth, from flags.

use crate::arguments::Earth;
use anyhow::Result;
use belvedere::query::EarthParams;

impl Earth {
    /// Parameters as typed.
    pub(crate) fn params(&self) -> Result<EarthParams> {
        let usual = EarthParams::default();
        let refraction = self.refraction.unwrap_or(usual.refraction);
        let params = EarthParams { curvature: self.curvature.into(), refraction, ..usual };
        params.validate()?;
        Ok(params)
    }
}
