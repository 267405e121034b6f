//! Choice of the up axis, the reference system and the unit of a cloud, made on the page.

use crate::shell_words::quoted;
use serde::{Deserialize, Serialize};

/// The choice for files that name them not or wrongly. By default z is up, and all else is that of the files.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[non_exhaustive]
pub struct ReadingChoice {
    /// The axis that is up.
    pub up: UpAxisChoice,
    /// The unit of all three axes of files that name none; without effect beside a reference system.
    pub unit: Option<LengthUnit>,
    /// The reference system, such as `EPSG:7415`.
    pub crs: Option<String>,
}

/// An axis that may be up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum UpAxisChoice {
    /// The third, as in surveys.
    #[default]
    Z,
    /// The second, as in computer graphics.
    Y,
}

/// A unit of coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum LengthUnit {
    /// Metres.
    Metre,
    /// International feet.
    Foot,
    /// Centimetres.
    Centimetre,
    /// Millimetres.
    Millimetre,
}

impl LengthUnit {
    /// Its name in a reference system, and metres.
    fn in_metres(self) -> (&'static str, f64) {
        match self {
            Self::Metre => ("metre", 1.0),
            Self::Foot => ("foot", 0.3048),
            Self::Centimetre => ("centimetre", 0.01),
            Self::Millimetre => ("millimetre", 0.001),
        }
    }
}

impl ReadingChoice {
    /// The reference system: the chosen one, or a local one that has nothing but the unit. `None` where neither was
    /// chosen.
    #[must_use]
    pub fn crs(&self) -> Option<String> {
        if self.crs.is_some() {
            return self.crs.clone();
        }
        let (name, metres) = self.unit?.in_metres();
        Some(format!("LOCAL_CS[\"site\",UNIT[\"{name}\",{metres}]]"))
    }

    /// The flags of the command line that say the same, each after a blank.
    pub(crate) fn flags(&self) -> String {
        let up = if self.up == UpAxisChoice::Y { " --up y" } else { "" };
        let crs = self.crs().map(|crs| format!(" --crs {}", quoted(&crs))).unwrap_or_default();
        format!("{up}{crs}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use belvedere::crs::Crs;

    #[test]
    fn a_unit_is_that_of_the_system_that_it_becomes() {
        for (unit, metres) in [("metre", 1.0), ("foot", 0.3048), ("centimetre", 0.01), ("millimetre", 0.001)] {
            let choice: ReadingChoice = serde_json::from_str(&format!(r#"{{"unit":"{unit}"}}"#)).unwrap();
            let crs = Crs::parse(&choice.crs().unwrap()).unwrap();
            assert_eq!(crs.metres_per_unit_xyz(), [metres; 3], "{unit}");
        }
        let placed: ReadingChoice = serde_json::from_str(r#"{"unit":"foot","crs":"EPSG:7415"}"#).unwrap();
        assert_eq!(placed.flags(), " --crs EPSG:7415");
        let turned: ReadingChoice = serde_json::from_str(r#"{"up":"y"}"#).unwrap();
        assert_eq!((turned.flags(), ReadingChoice::default().flags()), (" --up y".to_owned(), String::new()));
    }
}
