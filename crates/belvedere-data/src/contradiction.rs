//! Contradictions between what is given and what is known: a row of [`ALL`] for each kind.
//!
//! Readers, models and questions look for them where both sides are at hand. Key, tolerance and outcome stand here
//! alone. A new kind is a constant, its place in [`ALL`], and the line that compares.

use std::collections::BTreeMap;

/// What becomes of a contradiction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// Nothing is computed: neither side can be right for the question, or it is not known which one is.
    Refused,
    /// Results follow one of the sides, and mislead a user who does not know it.
    Warned,
    /// Results follow the side that is known.
    Noted,
}

impl Outcome {
    /// In a word, as tables print it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Refused => "error",
            Self::Warned => "warning",
            Self::Noted => "note",
        }
    }
}

/// A kind of contradiction.
#[derive(Debug, PartialEq)]
pub struct Contradiction {
    /// Its name, which stays the same from version to version: that of its remark.
    pub key: &'static str,
    /// Statement of a user or a file, in words.
    pub given: &'static str,
    /// Contrary evidence, in words.
    pub known: &'static str,
    /// Largest difference between the two that is accepted, in `unit`.
    pub tolerance: f64,
    /// The unit of the tolerance.
    pub unit: &'static str,
    /// Consequence: an error, a warning or a note.
    pub outcome: Outcome,
}

/// A contradiction that was found.
#[derive(Clone, Debug, PartialEq)]
pub struct FoundContradiction {
    /// Its row.
    pub row: &'static Contradiction,
    /// A plain sentence with both sides, without a full stop.
    pub text: String,
    /// Its numbers by name.
    pub numbers: Vec<(&'static str, f64)>,
}

impl Contradiction {
    /// Whether a difference is above the tolerance. One that is not a number is.
    #[must_use]
    pub fn is_exceeded_by(&self, difference: f64) -> bool {
        difference.is_nan() || difference.abs() > self.tolerance
    }

    /// One that was found, in words.
    #[must_use]
    pub fn found(&'static self, text: impl Into<String>) -> FoundContradiction {
        FoundContradiction { row: self, text: text.into(), numbers: Vec::new() }
    }
}

impl FoundContradiction {
    /// This with a number.
    #[must_use]
    pub fn with(mut self, name: &'static str, number: f64) -> Self {
        self.numbers.push((name, number));
        self
    }
}

/// What begins the names of contradictions in the provenance of a model.
const IN_PROVENANCE: &str = "contradiction ";

impl FoundContradiction {
    /// Notes it in the provenance of a model, which keeps it with the scene.
    pub fn note_in(&self, provenance: &mut BTreeMap<String, String>) {
        provenance.insert(format!("{IN_PROVENANCE}{}", self.row.key), self.text.clone());
    }

    /// Those that were noted in the provenance of a model, without their numbers.
    pub fn noted_in(provenance: &BTreeMap<String, String>) -> impl Iterator<Item = Self> {
        provenance.iter().filter_map(|(name, text)| {
            let key = name.strip_prefix(IN_PROVENANCE)?;
            let row = ALL.iter().find(|row| row.key == key)?;
            Some(row.found(text))
        })
    }
}

macro_rules! contradictions {
    ($($(#[$doc:meta])* $name:ident = $key:literal: $given:literal, $known:literal, $tolerance:literal $unit:literal, $outcome:ident;)*) => {
        $($(#[$doc])*
        pub static $name: Contradiction = Contradiction {
            key: $key,
            given: $given,
            known: $known,
            tolerance: $tolerance,
            unit: $unit,
            outcome: Outcome::$outcome,
        };)*

        /// All kinds.
        pub static ALL: &[&Contradiction] = &[$(&$name),*];
    };
}

contradictions! {
    /// Records, units and axes of a system, and what stands beside its file.
    REFERENCE_SYSTEM = "reference-system-doubtful":
        "records, unit and axes of a reference system", "each other, their codes, and the `.prj` beside the file", 5.0 "m of place, no difference of units", Warned;
    /// A system of another country, or of another continent.
    AREA_OF_USE = "outside-area-of-use":
        "reference system of a scene", "its area of use, by its code or the parameters of its projection", 300.0 "km; a note from 2 km on", Warned;
    /// Clouds of computer graphics.
    UP_AXIS = "y-looks-up":
        "z as the axis that is up", "level surfaces of a cloud without a reference system, floor and ceiling of a room", 3.0 "times as many along y, and fewer in rooms", Warned;
    /// A header of an interrupted writer counts the points that were written when it was written.
    POINTS_NOT_COUNTED = "points-not-counted":
        "number of points in the header of a LAS, LAZ or E57 file", "points that the file holds", 0.0 "points", Warned;
    /// Nodes and tiles that were copied in part, or again.
    ANNOUNCED_POINTS = "announced-points":
        "number of points of a node or tile in a hierarchy or catalogue", "header of its file", 0.0 "points", Warned;
    /// Bounds decide which files of a box are opened.
    ANNOUNCED_BOUNDS = "announced-bounds":
        "bounds of a node or tile in a hierarchy or catalogue", "bounds in the header of its file", 10.0 "steps of the coordinates", Warned;
    /// A hierarchy that lost nodes.
    HIERARCHY_POINTS = "hierarchy-points":
        "number of points in `ept.json`", "sum of the nodes of the hierarchy", 0.0 "points", Warned;
    /// Columns of one meaning under the same name.
    COLUMN_TWICE = "column-twice":
        "two columns of one name", "one value of a point", 0.0 "columns", Warned;
    /// The head of a PTX scan says where the scanner stood twice.
    SCAN_POSE = "scan-pose":
        "position and axes of the scanner in the head of a PTX scan", "its matrix", 0.01 "m, and as a share of the axes", Warned;
    /// A datum of heights is a constant; coarse cells and tall grass are less.
    TERRAIN_HEIGHTS = "terrain-heights-differ":
        "heights of far terrain", "ground of the cloud where both are known", 2.0 "m", Warned;
    /// A planned building whose base lies above the ground beside and below it.
    MESH_FLOATS = "mesh-floats":
        "base of an added mesh", "ground of the scene around it", 1.5 "m above it", Warned;
    /// One that lies deeper than a cellar.
    MESH_SINKS = "mesh-sinks":
        "base of an added mesh", "ground of the scene around it", 4.5 "m below it, or its top below it", Warned;
    /// Millimetres, or another system: nothing taller was ever built.
    MESH_IS_HUGE = "mesh-is-huge":
        "height of an added mesh", "the tallest buildings", 1000.0 "m", Warned;
    /// Clouds without a reference system are taken as metres.
    UNIT_OF_ROOM = "unit-of-room":
        "metres, as the unit of a cloud without a reference system", "height of a room from floor to ceiling", 9.0 "m", Warned;
    /// Units outdoors: surveys with points so far apart show no walls.
    UNIT_OF_SURVEY = "unit-of-survey":
        "metres, as the unit of a cloud without a reference system", "distance between points of a cloud that shows upright surfaces", 5.0 "m", Warned;
    /// Longitude and latitude as x and y: a survey in a cell of a map.
    COORDINATES_IN_DEGREES = "coordinates-in-degrees":
        "metres, as the unit of a cloud without a reference system", "width and depth of a cloud that is twenty times as high", 0.05 "m", Warned;
    /// Writers that fill one of the two columns only.
    RETURN_NUMBERS = "return-numbers":
        "return numbers of points", "number of returns of their pulses", 0.01 "of the points", Warned;
    /// Writers that keep the encoding of the header and change the times, or the other way round.
    GPS_TIME_EPOCH = "gps-time-epoch":
        "epoch of GPS times in a header", "GPS times, which no week has", 1_209_600.0 "s", Noted;
    /// Days that a user gives for files that know their own.
    FLIGHT_DAY = "flight-day":
        "day of the flight", "GPS times that name their day", 31.0 "days", Warned;
    /// Clocks of another continent.
    CLOCK_OF_ZONE = "clock-of-zone":
        "offset of a time or a zone from UTC", "mean solar time of the place", 4.0 "hours; UTC is taken anywhere", Warned;
    /// Trajectories in UTC beside clouds in GPS time.
    TRAJECTORY_TIME = "trajectory-time":
        "times of a trajectory", "directions of pulses with several returns", 0.3 "s", Warned;
    /// Ground of another town.
    GROUND_ELSEWHERE = "ground-elsewhere":
        "cloud that shows the ground", "extent of the scene on the map", 0.0 "m between the two", Refused;
    /// Ground above another level.
    GROUND_HEIGHTS = "ground-heights-differ":
        "heights of the cloud that shows the ground", "ground of the scene where both are known", 2.0 "m", Warned;
    /// A least elevation that no sun of the period reaches.
    SUN_TOO_LOW = "sun-too-low":
        "least elevation of suns that count", "elevations of the sun in the period", 0.0 "degrees", Refused;
    /// Horizons in radians or gon, and those that leave half of the circle out.
    HORIZON_ANGLES = "horizon-angles":
        "azimuths of a horizon table in degrees", "a full circle from -180 or 0", 180.0 "degrees between two rows", Refused;
    /// Rasters of two quantities.
    DIFFERENT_QUANTITIES = "different-quantities":
        "a raster before", "quantity of the raster after", 0.0 "words", Warned;
    /// Shadows of two suns.
    DIFFERENT_SUNS = "different-suns":
        "a raster before", "sun of the raster after", 0.0 "words", Warned;
    /// Weather whose rows belong to other times than it says.
    WEATHER_CLOCK = "weather-clock":
        "times of the rows of a weather file", "noon of the sun at its place", 10.0 "minutes", Warned;
    /// A few rays between two points of a wall, each as far as the greatest range.
    SIGHT_LEAVES_ROOM = "sight-leaves-room":
        "directions in which nothing blocks", "closed surface around the eye", 0.0 "of all directions, where up to 10 % are open", Noted;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tolerance_is_taken_in_silence_and_what_is_no_number_is_not() {
        let row = &SCAN_POSE;
        assert!(!row.is_exceeded_by(row.tolerance) && !row.is_exceeded_by(-row.tolerance));
        assert!(row.is_exceeded_by(1.01 * row.tolerance) && row.is_exceeded_by(f64::NAN));
    }

    #[test]
    fn what_is_noted_in_a_model_is_found_there() {
        let mut provenance = BTreeMap::from([("side".to_owned(), "interior".to_owned())]);
        let found = MESH_FLOATS.found("a house floats");
        found.note_in(&mut provenance);
        assert_eq!(FoundContradiction::noted_in(&provenance).collect::<Vec<_>>(), [found]);
    }

    #[test]
    fn every_kind_has_a_key_of_its_own() {
        let mut keys: Vec<&str> = ALL.iter().map(|row| row.key).collect();
        keys.sort_unstable();
        keys.dedup();
        assert_eq!(keys.len(), ALL.len());
    }
}
