//! Kinds of visible objects, and the kind of a ball.

use belvedere_core::medial::MedialBalls;
use belvedere_data::vector::{length, sub};
use belvedere_data::{Error, Result};
use serde::{Deserialize, Serialize};

/// Maximum distance between the surface of a ball and the point that it was made at, metres: rules of carving move
/// balls by less.
const FARTHEST_FROM_POINT: f64 = 1.0;

/// Kind of surface seen from a window.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum SeenKind {
    /// Sky: nothing blocks, at the horizon or above it.
    Sky,
    /// Trees, hedges and lower plants.
    Vegetation,
    /// Water.
    Water,
    /// Buildings, and meshes added to a scene.
    Building,
    /// Bare ground, roads and rails; and far terrain, above the horizon or below it.
    Ground,
    /// Whatever else blocks: cars, bridges, wires, and points without a class.
    #[default]
    Other,
    /// Space beyond the cloud: nothing in it blocks, below the horizon, and no far terrain is known.
    Beyond,
}

impl SeenKind {
    /// All kinds, in the order of shares.
    pub const ALL: [Self; 7] =
        [Self::Sky, Self::Vegetation, Self::Water, Self::Building, Self::Ground, Self::Other, Self::Beyond];

    /// Its name in tables and on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Sky => "sky",
            Self::Vegetation => "vegetation",
            Self::Water => "water",
            Self::Building => "building",
            Self::Ground => "ground",
            Self::Other => "other",
            Self::Beyond => "beyond",
        }
    }

    /// The kind of a surface by its name; `None` for sky, for places beyond the cloud, and for other words.
    #[must_use]
    pub fn thing_called(name: &str) -> Option<Self> {
        let is_thing = |seen: &Self| !matches!(seen, Self::Sky | Self::Beyond);
        Self::ALL.into_iter().filter(is_thing).find(|seen| seen.name() == name)
    }
}

/// Meanings of the classes of points.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ClassMeanings([Option<SeenKind>; 256]);

impl Default for ClassMeanings {
    /// Vegetation is 3 to 5, a building 6, water 9, ground 2, rails 10 and roads 11; nothing is said of 0 and 1, and
    /// all else is other.
    ///
    /// # Source
    /// ASPRS LAS 1.4, table 17.
    fn default() -> Self {
        Self(std::array::from_fn(|class| match class {
            0 | 1 => None,
            2 | 10 | 11 => Some(SeenKind::Ground),
            3..=5 => Some(SeenKind::Vegetation),
            6 => Some(SeenKind::Building),
            9 => Some(SeenKind::Water),
            _ => Some(SeenKind::Other),
        }))
    }
}

impl ClassMeanings {
    /// The same, where `class` means `seen`.
    #[must_use]
    pub fn with(mut self, class: u8, seen: SeenKind) -> Self {
        self.0[usize::from(class)] = Some(seen);
        self
    }

    /// Returns the meaning of `class`; `None` if it has none.
    #[must_use]
    pub fn of(&self, class: u8) -> Option<SeenKind> {
        self.0[usize::from(class)]
    }
}

/// The kind of each of `balls`, (B): that of the class of the point that it was made at. `classes`, (N), are those of
/// the cloud that the balls were made from; `None` where they are not known. Where a class says nothing, balls that are
/// `vegetation` ([`SceneModel::vegetation`](belvedere_core::model::SceneModel::vegetation)) are that, and others are
/// other.
///
/// # Errors
/// [`Error::LengthMismatch`] for a ball whose point has no class.
pub fn balls_seen(
    balls: &MedialBalls,
    classes: Option<&[u8]>,
    vegetation: &[bool],
    meanings: &ClassMeanings,
) -> Result<Vec<SeenKind>> {
    let min = balls.source.iter().map(|&row| row as usize + 1).max().unwrap_or(0);
    if let Some(found) = classes.map(<[_]>::len).filter(|&found| found < min) {
        return Err(Error::LengthMismatch { what: "classes of the points of balls", expected: min, found });
    }
    let kind = |(row, &source): (usize, &u32)| {
        let class = classes.and_then(|classes| classes.get(source as usize));
        let is_vegetation = vegetation.get(row) == Some(&true);
        let unsaid = if is_vegetation { SeenKind::Vegetation } else { SeenKind::Other };
        class.and_then(|&class| meanings.of(class)).unwrap_or(unsaid)
    };
    Ok(balls.source.iter().enumerate().map(kind).collect())
}

/// Returns true if `balls` were made from points at `positions`, (N, 3) in the same frame: most of them touch the point
/// of their row to a metre.
#[must_use]
pub fn are_made_from(balls: &MedialBalls, positions: &[[f32; 3]]) -> bool {
    let touches = |row: &usize| {
        let point = balls.source.get(*row).and_then(|&source| positions.get(source as usize));
        let (center, radius) = (balls.centers[*row].map(f64::from), f64::from(balls.radii[*row]));
        point.is_some_and(|point| (length(sub(point.map(f64::from), center)) - radius).abs() <= FARTHEST_FROM_POINT)
    };
    2 * (0..balls.len()).filter(touches).count() > balls.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn balls() -> MedialBalls {
        let mut balls = MedialBalls::default();
        for source in 0..4_u16 {
            balls.push(usize::from(source), [f32::from(source) * 10.0, 0.0, -2.0], 2.0, 0);
        }
        balls
    }

    #[test]
    fn balls_are_what_the_class_of_their_point_says() {
        let kinds = |classes: Option<&[u8]>, meanings: &ClassMeanings| {
            balls_seen(&balls(), classes, &[true, false, true, true], meanings).unwrap()
        };
        let usual = ClassMeanings::default();
        // a class that says something comes before what pulses tell
        assert_eq!(
            kinds(Some(&[6, 1, 0, 9]), &usual),
            [SeenKind::Building, SeenKind::Other, SeenKind::Vegetation, SeenKind::Water]
        );
        let own = usual.clone().with(1, SeenKind::Ground).with(0, SeenKind::Other);
        assert_eq!(
            kinds(Some(&[6, 1, 0, 9]), &own),
            [SeenKind::Building, SeenKind::Ground, SeenKind::Other, SeenKind::Water]
        );
        assert_eq!(
            kinds(None, &usual),
            [SeenKind::Vegetation, SeenKind::Other, SeenKind::Vegetation, SeenKind::Vegetation]
        );
        assert!(balls_seen(&balls(), Some(&[6, 1, 0]), &[], &usual).is_err());
    }

    #[test]
    fn balls_of_another_cloud_are_recognised() {
        let mut points = [[0.0, 0.0, 0.0], [10.0, 0.0, 0.0], [20.0, 0.0, 0.0], [30.0, 0.0, 0.0]];
        assert!(are_made_from(&balls(), &points));
        points.reverse();
        assert!(!are_made_from(&balls(), &points) && !are_made_from(&balls(), &points[..1]));
    }

    #[test]
    fn things_have_the_names_of_their_columns() {
        assert_eq!(SeenKind::thing_called("water"), Some(SeenKind::Water));
        assert!(["sky", "beyond", "Water", ""].iter().all(|name| SeenKind::thing_called(name).is_none()));
    }
}
