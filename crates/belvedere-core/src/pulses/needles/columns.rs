//! Needles as columns of numbers, as short as what is asked of them allows.

use super::{Item, Needle, Needles};
use belvedere_data::Result;
use belvedere_data::control::Control;
use belvedere_data::needles::NeedleColumns;
use rayon::prelude::*;

/// Steps of a slope, metres of shift per metre of height: a needle 60 m long is off by 3 mm at its far end.
const SLOPE_STEP: f64 = 1e-4;
/// A needle that ends within this of the top of all, metres, reaches it.
const REACHES_TOP: f64 = 1e-3;
/// Pulses handed to a thread at once.
const CHUNK: usize = 1 << 14;

/// Lower ends of those pulses that [`Needles::from_columns`] makes needles of, local metres.
pub(crate) fn lower_ends(columns: &NeedleColumns) -> impl Iterator<Item = [f32; 3]> + '_ {
    let rows = (0..columns.starts.len()).filter(|&row| piece(columns, row).is_some());
    rows.filter_map(|row| columns.starts.get(row).copied())
}

/// Start, unit vector upward and length of a pulse; `None` without length.
fn piece(columns: &NeedleColumns, row: usize) -> Option<([f64; 3], [f64; 3], f64)> {
    let [east, north] = columns.slopes.get(row)?.map(|steps| f64::from(steps) * SLOPE_STEP);
    let stretch = (east * east + north * north + 1.0).sqrt();
    let up = [east / stretch, north / stretch, 1.0 / stretch];
    let start = columns.starts.get(row)?.map(f64::from);
    let to_top = (f64::from(columns.top) - start[2]) / up[2];
    let length = columns.lengths.get(row).map_or(to_top, |&length| f64::from(length).min(to_top));
    (length > 0.0).then_some((start, up, length))
}

impl Needles {
    /// Lower end, unit vector upward and length of each, local metres, in the order of the index.
    pub(crate) fn lines(&self) -> impl IndexedParallelIterator<Item = ([f64; 3], [f64; 3], f64)> + '_ {
        let line = |needle: &Needle| (needle.start.map(f64::from), needle.up.map(f64::from), f64::from(needle.length));
        self.needles.par_iter().map(line)
    }

    /// The needles as columns, in the order of the index. Directions are rounded, so that what [`Needles::from_columns`] makes of
    /// them lies up to 5 mm in 100 m off these; it gives the same columns again, in another order.
    #[must_use]
    pub fn to_columns(&self) -> NeedleColumns {
        let top = self.planes[1];
        #[expect(clippy::cast_possible_truncation, reason = "`as` saturates; the flattest needle has a slope of 3.2")]
        let slope = |needle: &Needle| {
            [0, 1].map(|i| (f64::from(needle.up[i]) / f64::from(needle.up[2]) / SLOPE_STEP).round() as i16)
        };
        let reaches_top = |needle: &Needle| {
            let end = f64::from(needle.start[2]) + f64::from(needle.length) * f64::from(needle.up[2]);
            (f64::from(top) - end).abs() < REACHES_TOP
        };
        let length = |needle: &Needle| if reaches_top(needle) { f32::INFINITY } else { needle.length };
        let all_reach = self.needles.iter().all(reaches_top);
        NeedleColumns {
            starts: self.lower_ends().collect(),
            slopes: self.needles.iter().map(slope).collect(),
            lengths: if all_reach { Vec::new() } else { self.needles.iter().map(length).collect() },
            top: if top.is_finite() { top } else { 0.0 },
        }
    }

    /// The needles of `columns`, indexed. What begins above the top, or has no length, is left out.
    ///
    /// # Errors
    /// Those of [`NeedleColumns::validate`], and [`Error::Cancelled`](belvedere_data::Error::Cancelled).
    pub fn from_columns(columns: &NeedleColumns, control: &Control<'_>) -> Result<Self> {
        columns.validate()?;
        let low = columns.starts.iter().map(|start| start[2]).fold(columns.top, f32::min);
        let planes = [low, columns.top];
        let item = |row| piece(columns, row).map(|(start, up, length)| Item::new(start, up, length, planes));
        let items: Vec<Item> = (0..columns.starts.len()).into_par_iter().with_min_len(CHUNK).filter_map(item).collect();
        control.check()?;
        Self::index(items, planes, control)
    }
}
