//! Kinds of towns by name.

use crate::town::site::RoofDetails;
use crate::town::trees::CrownMaterial;
use crate::town::{BlockPlan, StreetTrees, TownParams};

/// Default side of a town, metres: a few blocks, and a scan of a few hundred thousand points.
pub const EXTENT: f64 = 150.0;

/// Kind of town, at any size and seed. A third to two thirds of its sloped roofs have eaves, and half or more of the
/// flat ones have parapets ([`TownParams::roofs`]).
///
/// ```
/// use belvedere_scenes::{CrownMaterial, Preset, TownParams, blocks, town};
///
/// let params = TownParams { crowns: CrownMaterial::Porous, ..Preset::OldTown.params(60.0, 7) };
/// let scene = town(&params);
/// assert!(scene.object_names.iter().any(|name| name.starts_with("building")));
/// let city_model = blocks(&scene);
/// assert!(city_model.object_names.iter().all(|name| name == "terrain" || name.starts_with("building")));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Preset {
    /// Detached houses with chimneys and dormers in fenced gardens, porous trees, cars, masts and wires on hilly
    /// ground.
    Village,
    /// Rows of houses with party walls, high-rise with balconies and decks, a market square with arcades, courtyards, a
    /// petrol station. Also a dry canal with bridges, cars, fences, masts and wires, and opaque trees.
    Town,
    /// Narrow streets, party walls, courtyards, arcades, a canal.
    OldTown,
    /// High-rise blocks with balconies, and decks and canopies between them.
    Towers,
    /// Many porous trees, pavilions, lookout decks and footbridges over a trench.
    Park,
}

impl Preset {
    /// All presets.
    pub const ALL: [Self; 5] = [Self::Village, Self::Town, Self::OldTown, Self::Towers, Self::Park];

    /// Returns the name on the command line: `village`, `town`, `old-town`, `towers`, `park`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Village => "village",
            Self::Town => "town",
            Self::OldTown => "old-town",
            Self::Towers => "towers",
            Self::Park => "park",
        }
    }

    /// Returns the parameters of a town of this kind: a square of `extent` metres. All kinds of blocks occur from 120 m
    /// on; smaller towns have only the first of them.
    #[must_use]
    pub fn params(self, extent: f64, seed: u64) -> TownParams {
        let usual = TownParams { extent, seed, street_trees: StreetTrees::Kerb, ..TownParams::default() };
        match self {
            Self::Village => TownParams {
                slope: 0.05,
                hill_height: 3.0,
                street_width: 7.0,
                roofs: RoofDetails { eaves: 0.6, parapets: 0.0, boxes: 0.0, chimneys: 0.8 },
                blocks: vec![(BlockPlan::Gardens, 4), (BlockPlan::DetachedHouses, 1)],
                crowns: CrownMaterial::Porous,
                tree_heights: [5.0, 12.0],
                area_per_garden_tree: 150.0,
                street_trees: StreetTrees::Without,
                street_furniture: 0.5,
                ..usual
            },
            Self::Town => TownParams {
                canal_depth: 2.2,
                street_width: 8.0,
                block_pitch: 44.0,
                roofs: RoofDetails { eaves: 0.4, parapets: 0.6, boxes: 0.6, chimneys: 0.8 },
                blocks: vec![
                    (BlockPlan::RowHouses, 16),
                    (BlockPlan::HighRise, 5),
                    (BlockPlan::Square, 2),
                    (BlockPlan::Gardens, 4),
                    (BlockPlan::Courtyard, 4),
                    (BlockPlan::Perimeter, 6),
                    (BlockPlan::PetrolStation, 1),
                    (BlockPlan::LShapes, 1),
                ],
                area_per_garden_tree: 45.0,
                street_furniture: 0.7,
                ..usual
            },
            Self::OldTown => TownParams {
                slope: 0.02,
                canal_depth: 2.2,
                street_width: 5.0,
                block_pitch: 46.0,
                roofs: RoofDetails { eaves: 0.35, parapets: 0.5, boxes: 0.3, chimneys: 0.8 },
                blocks: vec![(BlockPlan::Perimeter, 6), (BlockPlan::Courtyard, 2), (BlockPlan::Square, 1)],
                area_per_garden_tree: 200.0,
                street_trees: StreetTrees::Without,
                street_furniture: 0.3,
                ..usual
            },
            Self::Towers => TownParams {
                slope: 0.01,
                hill_height: 0.6,
                street_width: 11.0,
                block_pitch: 56.0,
                roofs: RoofDetails { eaves: 0.35, parapets: 0.8, boxes: 0.8, chimneys: 0.8 },
                blocks: vec![(BlockPlan::HighRise, 6), (BlockPlan::PetrolStation, 1), (BlockPlan::Square, 1)],
                area_per_garden_tree: 220.0,
                street_furniture: 0.8,
                ..usual
            },
            Self::Park => TownParams {
                hill_height: 2.5,
                canal_depth: 2.2,
                street_width: 6.0,
                block_pitch: 56.0,
                blocks: vec![(BlockPlan::Lawn, 1)],
                crowns: CrownMaterial::Porous,
                tree_heights: [7.0, 18.0],
                area_per_garden_tree: 80.0,
                street_trees: StreetTrees::Without,
                street_furniture: 0.2,
                ..usual
            },
        }
    }
}
