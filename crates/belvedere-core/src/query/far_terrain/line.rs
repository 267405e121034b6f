//! A line of sight over the curved earth, from its observer on.

use crate::query::EarthParams;
use belvedere_data::vector::piece_in_box;

/// A line of sight over far terrain, local metres.
pub(crate) struct FarLine<'a> {
    pub(crate) observer: [f64; 3],
    pub(crate) target: [f64; 3],
    /// Unit vector to the target on the map, and how far it is there, metres.
    pub(crate) along: [f64; 2],
    pub(crate) span: f64,
    /// Tangent of the elevation at which the target appears.
    pub(crate) tangent: f64,
    pub(crate) earth: &'a EarthParams,
}

impl<'a> FarLine<'a> {
    /// `None` where a coordinate is not finite or one end is above the other.
    pub(crate) fn new(observer: [f64; 3], target: [f64; 3], earth: &'a EarthParams) -> Option<Self> {
        let across = [target[0] - observer[0], target[1] - observer[1]];
        let span = across[0].hypot(across[1]);
        if !(span > 0.0 && span.is_finite() && (target[2] - observer[2]).is_finite()) {
            return None;
        }
        let tangent = earth.apparent_tangent(target[2] - observer[2], span);
        Some(Self { observer, target, along: across.map(|v| v / span), span, tangent, earth })
    }

    pub(crate) fn ends(&self) -> [[f64; 3]; 2] {
        [self.observer, self.target]
    }

    /// Its place `span` metres from the observer on the map.
    pub(crate) fn at(&self, span: f64) -> [f64; 3] {
        let height = self.observer[2] + self.earth.height_along(self.tangent, span);
        [self.observer[0] + self.along[0] * span, self.observer[1] + self.along[1] * span, height]
    }

    /// Returns the horizontal distance of a place on the line from the observer, metres.
    pub(crate) fn span_to(&self, place: [f64; 3]) -> f64 {
        (place[0] - self.observer[0]).hypot(place[1] - self.observer[1])
    }
}

/// Returns the piece of a line over a box in plan, from and to, metres from the start of the line. The box is given by
/// its low and high corner; the line is `span` metres long along the unit vector `along`. `None` if the line passes
/// beside it.
pub(crate) fn piece_over([low, high]: [[f64; 2]; 2], start: [f64; 3], along: [f64; 2], span: f64) -> Option<[f64; 2]> {
    let sides = std::array::from_fn(|axis| [low[axis] - start[axis], high[axis] - start[axis]]);
    piece_in_box(sides, along, [0.0, span]).filter(|[from, to]| from < to)
}
