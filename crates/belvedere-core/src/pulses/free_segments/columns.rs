//! Free segments as columns of numbers, with as few digits as the required accuracy allows.

use super::FreeSegments;
use super::segment::{FreeSegment, SegmentsByAxis};
use super::tree::{SegmentAxis, SegmentTree, node_count};
use belvedere_data::Result;
use belvedere_data::cast::to_row;
use belvedere_data::control::Control;
use belvedere_data::free_segments::FreeSegmentColumns;
use rayon::prelude::*;

/// Step of slopes, metres across a segment's main axis for each metre along it: the far end of a 60 m segment is off by
/// 3 mm.
const SLOPE_STEP: f64 = 1e-4;
/// A segment that ends within this distance of the common top, metres, counts as reaching it.
const REACHES_TOP: f64 = 1e-3;
/// Pulses handed to a thread at once.
const CHUNK: usize = 1 << 14;

/// First ends of those pulses from which [`FreeSegments::from_columns`] makes free segments, local metres.
pub(crate) fn lower_ends(columns: &FreeSegmentColumns) -> impl Iterator<Item = [f32; 3]> + '_ {
    let rows = (0..columns.starts.len()).filter(|&row| piece(columns, row).is_some());
    rows.filter_map(|row| columns.starts.get(row).copied())
}

/// Both ends of a pulse, local metres; `None` where it has no length.
#[must_use]
pub fn ends_of_pulse(columns: &FreeSegmentColumns, row: usize) -> Option<[[f64; 3]; 2]> {
    let (_, start, direction, length) = piece(columns, row)?;
    Some([start, std::array::from_fn(|axis| start[axis] + length * direction[axis])])
}

/// Way, start, unit vector and length of a pulse; `None` without length.
fn piece(columns: &FreeSegmentColumns, row: usize) -> Option<(SegmentAxis, [f64; 3], [f64; 3], f64)> {
    let way = match columns.ways.get(row) {
        Some(&number) => *SegmentAxis::ALL.get(usize::from(number))?,
        None => SegmentAxis::UP,
    };
    let slopes = columns.slopes.get(row)?.map(|steps| f64::from(steps) * SLOPE_STEP);
    let stretch = (slopes[0] * slopes[0] + slopes[1] * slopes[1] + 1.0).sqrt();
    let mut direction = [0.0; 3];
    direction[way.axis] = if way.is_backward { -1.0 } else { 1.0 } / stretch;
    for (axis, slope) in way.across().into_iter().zip(slopes) {
        direction[axis] = slope / stretch;
    }
    let start = columns.starts.get(row)?.map(f64::from);
    let to_top = if direction[2] > 0.0 { (f64::from(columns.top) - start[2]) / direction[2] } else { f64::INFINITY };
    let length = columns.lengths.get(row).map_or(to_top, |&length| f64::from(length).min(to_top));
    (length > 0.0 && length.is_finite()).then_some((way, start, direction, length))
}

impl FreeSegments {
    /// First end, unit vector towards the scanner and length of each, local metres, in the order of the index.
    pub(crate) fn lines(&self) -> impl IndexedParallelIterator<Item = ([f64; 3], [f64; 3], f64)> + '_ {
        let line = |free_segment: &FreeSegment| {
            (free_segment.start.map(f64::from), free_segment.direction.map(f64::from), f64::from(free_segment.length))
        };
        self.free_segments.par_iter().map(line)
    }

    /// The free segments as columns, in the order of the index. Directions are rounded, so that the segments of
    /// [`FreeSegments::from_columns`] lie up to 5 mm in 100 m off these; they give the same columns again, in another
    /// order.
    #[must_use]
    pub fn to_columns(&self) -> FreeSegmentColumns {
        let top = self.top;
        #[expect(clippy::cast_possible_truncation, reason = "`as` saturates; the flattest segment has a slope of 3.2")]
        let slope = |way: SegmentAxis, free_segment: &FreeSegment| {
            let along = f64::from(free_segment.direction[way.axis]).abs();
            way.across().map(|axis| (f64::from(free_segment.direction[axis]) / along / SLOPE_STEP).round() as i16)
        };
        #[expect(clippy::cast_possible_truncation, reason = "one of six")]
        let number = |way: SegmentAxis| way.number() as u8;
        let reaches_top = |free_segment: &FreeSegment| {
            let end = f64::from(free_segment.start[2])
                + f64::from(free_segment.length) * f64::from(free_segment.direction[2]);
            (f64::from(top) - end).abs() < REACHES_TOP
        };
        let length =
            |free_segment: &FreeSegment| if reaches_top(free_segment) { f32::INFINITY } else { free_segment.length };
        let all_reach = self.free_segments.iter().all(reaches_top);
        let all_upright = self.trees.iter().all(|tree| tree.way == SegmentAxis::UP);
        FreeSegmentColumns {
            starts: self.lower_ends().collect(),
            slopes: self.ways().zip(&self.free_segments).map(|(way, free_segment)| slope(way, free_segment)).collect(),
            lengths: if all_reach { Vec::new() } else { self.free_segments.iter().map(length).collect() },
            ways: if all_upright { Vec::new() } else { self.ways().map(number).collect() },
            top: if top.is_finite() { top } else { 0.0 },
        }
    }

    /// The main axis of each segment.
    fn ways(&self) -> impl Iterator<Item = SegmentAxis> + '_ {
        let ends = self.trees.iter().skip(1).map(|tree| tree.first).chain([self.free_segments.len()]);
        self.trees.iter().zip(ends).flat_map(|(tree, end)| std::iter::repeat_n(tree.way, end - tree.first))
    }

    /// The free segments of `columns`, indexed. Segments that begin above the top, or have no length, are left out.
    ///
    /// # Errors
    /// Those of [`FreeSegmentColumns::validate`], and [`Error::Cancelled`](belvedere_data::Error::Cancelled).
    pub fn from_columns(columns: &FreeSegmentColumns, control: &Control<'_>) -> Result<Self> {
        columns.validate()?;
        let rows: Vec<u32> = (0..to_row(columns.starts.len())).collect();
        Self::index(by_way(columns, &rows, control)?, None, columns.top, control)
    }

    /// The same with the order and the boxes of an index of these columns ([`FreeSegments::order_and_boxes`]): nothing
    /// is sorted again. If they do not belong together, the columns are indexed anew.
    pub(crate) fn from_index(
        columns: &FreeSegmentColumns,
        (order, boxes): (&[u32], &[[f32; 10]]),
        control: &Control<'_>,
    ) -> Result<Self> {
        columns.validate()?;
        let by_way = by_way(columns, order, control)?;
        let count: usize = by_way.iter().map(Vec::len).sum();
        let nodes: usize = by_way.iter().filter(|own| !own.is_empty()).map(|own| node_count(own.len())).sum();
        if count != order.len() || nodes != boxes.len() {
            return Self::from_columns(columns, control);
        }
        Self::index(by_way, Some(boxes), columns.top, control)
    }

    /// The order of the index, as rows of the columns that it was made of, and the boxes of its nodes.
    pub(crate) fn order_and_boxes(&self) -> (Vec<u32>, Vec<[f32; 10]>) {
        let order = self.free_segments.iter().map(|free_segment| free_segment.row).collect();
        (order, self.trees.iter().flat_map(SegmentTree::boxes).collect())
    }
}

/// The free segments of some rows, in their order, by direction.
fn by_way(columns: &FreeSegmentColumns, rows: &[u32], control: &Control<'_>) -> Result<SegmentsByAxis> {
    let mut by_way = SegmentsByAxis::default();
    for (way, free_segments) in SegmentAxis::ALL.into_iter().zip(&mut by_way) {
        if columns.ways.is_empty() && way != SegmentAxis::UP {
            continue;
        }
        let free_segment = |&row: &u32| {
            let (own, start, direction, length) = piece(columns, row as usize)?;
            (own == way).then(|| FreeSegment { row, ..FreeSegment::new(start, direction, length) })
        };
        *free_segments = rows.par_iter().with_min_len(CHUNK).filter_map(free_segment).collect();
        control.check()?;
    }
    Ok(by_way)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pulses::FreeSegmentParams;
    use belvedere_data::cast::to_f32;
    use belvedere_data::random::uniform;

    #[test]
    fn an_index_that_is_kept_is_the_one_that_was_made() {
        let random = |i: u64, k: u64| to_f32(uniform(9, 4 * i + k));
        let returns: Vec<[f32; 3]> =
            (0..3000).map(|i| [40.0 * random(i, 0), 40.0 * random(i, 1), 9.0 * random(i, 2)]).collect();
        // from the air and from the ground
        let scanner: Vec<[f32; 3]> =
            (0..3000).map(|i| [60.0 * random(i, 3), 20.0, if i % 2 == 0 { 300.0 } else { 1.6 }]).collect();
        let control = Control::none();
        let (first, _) = FreeSegments::new(&returns, &scanner, &FreeSegmentParams::default(), &control).unwrap();
        let columns = first.to_columns();
        let made = FreeSegments::from_columns(&columns, &control).unwrap();
        assert!(made.trees.len() > 3, "{}", made.trees.len());
        let (order, boxes) = made.order_and_boxes();
        let kept = FreeSegments::from_index(&columns, (&order, &boxes), &control).unwrap();
        assert!(kept.order_and_boxes() == (order.clone(), boxes.clone()));
        assert_eq!(kept.len(), made.len());
        assert!((0..made.len()).all(|number| kept.segment(number) == made.segment(number)));
        for i in 0..500 {
            let place = [0, 1, 2].map(|k| [40.0, 40.0, 12.0][k] * uniform(10, 3 * i + k as u64));
            assert_eq!(kept.passes_within(place, 0.4), made.passes_within(place, 0.4));
        }
        // what does not belong together is indexed anew
        let short = FreeSegments::from_index(&columns, (&order, &boxes[1..]), &control).unwrap();
        assert!(short.order_and_boxes() == (order, boxes));
    }
}
