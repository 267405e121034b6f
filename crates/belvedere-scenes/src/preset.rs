//! Kinds of towns by name.

use crate::town::TownParams;

/// A kind of town, at any size and seed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Preset {
    /// Detached houses with gardens, hedges and many trees on hilly ground.
    Village,
    /// Terraces, L-shaped blocks, a tower, detached houses.
    Town,
    /// Narrow streets, party walls, courtyards, arcades.
    OldTown,
    /// High-rise blocks with balconies, decks and canopies between them.
    Towers,
    /// Trees, ponds' bridges and a few pavilions.
    Park,
}

impl Preset {
    /// Every preset.
    pub const ALL: [Self; 5] = [Self::Village, Self::Town, Self::OldTown, Self::Towers, Self::Park];

    /// Name on the command line: `village`, `town`, `old-town`, `towers`, `park`.
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

    /// Parameters of a town of this kind: a square of `extent` metres.
    #[must_use]
    pub fn params(self, extent: f64, seed: u64) -> TownParams {
        TownParams { extent, seed, ..TownParams::default() }
    }
}
