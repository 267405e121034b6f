//! Neighbouring targets are processed together: lines that the backend left open are tested against balls.

use super::super::backend::{BLOCK, Settled, WORD, WORDS, WordBits};
use super::super::ball_tree::BallTree;
use super::packet::{Blockers, LANES, Packet};

/// A direction and its column in the matrix.
pub(super) struct MatrixDirection {
    pub(super) direction: [f64; 3],
    column: usize,
}

/// The directions of some columns in bands of elevation, to and fro, so that each is close to the one before.
pub(super) fn headings(directions: &[[f64; 3]], columns: &[usize]) -> Vec<MatrixDirection> {
    /// Bands from the horizon to the zenith: about as high as 600 directions are apart.
    const BANDS: f64 = 16.0;
    let key = |direction: [f64; 3]| {
        let band = (direction[2] * BANDS).floor();
        let azimuth = direction[0].atan2(direction[1]);
        (band, if band % 2.0 == 0.0 { azimuth } else { -azimuth })
    };
    let mut order = columns.to_vec();
    order.sort_by(|&a, &b| {
        let (a, b) = (key(directions[a]), key(directions[b]));
        a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1))
    });
    order.into_iter().map(|column| MatrixDirection { direction: directions[column], column }).collect()
}

/// Headings whose columns share a word of the rows.
struct Group {
    word: usize,
    /// Bits and numbers of the headings.
    headings: Vec<(usize, usize)>,
}

impl Group {
    /// Selects the headings of a word whose bits are set in `met`; `None` if there are none.
    fn new((word, (numbers, met)): (usize, (&[Option<usize>], &u64))) -> Option<Self> {
        let of_column = |(column, number): (usize, &Option<usize>)| Some((column, (*number)?));
        let is_met = |(column, _): &(usize, usize)| met >> column & 1 == 1;
        let headings: Vec<_> = numbers.iter().enumerate().filter_map(of_column).filter(is_met).collect();
        (!headings.is_empty()).then_some(Self { word, headings })
    }
}

/// Directions that all targets share, with the balls.
pub(super) struct Sky<'a> {
    tree: &'a BallTree,
    headings: &'a [MatrixDirection],
    /// Result of the backend for the headings.
    settled: &'a Settled,
    /// Index of the heading of each column of the matrix, if any.
    numbers: Vec<Option<usize>>,
}

impl<'a> Sky<'a> {
    /// Looks at `headings`, which are some of `column_count` directions.
    pub(super) fn new(
        tree: &'a BallTree,
        headings: &'a [MatrixDirection],
        settled: &'a Settled,
        column_count: usize,
    ) -> Self {
        let mut numbers = vec![None; column_count];
        for (number, heading) in headings.iter().enumerate() {
            numbers[heading.column] = Some(number);
        }
        Self { tree, headings, settled, numbers }
    }

    /// Unsets the bits of directions that are blocked in the rows of the targets of a block, which is the `block`-th of
    /// those that the backend was given. Only bits that are set are tested, in columns that are set in `met`, the words
    /// of a row.
    pub(super) fn look(&self, targets: &[[f32; 3]], block: usize, met: &[u64], rows: &mut [u64]) {
        let width = met.len();
        let groups: Vec<Group> = self.numbers.chunks(WORD).zip(met).enumerate().filter_map(Group::new).collect();
        let mut known = vec![[0; WORDS]; self.headings.len()];
        for group in &groups {
            for (word, rows) in rows.chunks(width * WORD).enumerate() {
                let of_target = |target: usize| rows.get(target * width + group.word).copied().unwrap_or(0);
                let of_columns = transposed(std::array::from_fn(of_target));
                for &(column, number) in &group.headings {
                    known[number][word] = of_columns[column];
                }
            }
        }
        let range = block * self.headings.len()..(block + 1) * self.headings.len();
        let [free, blocked] = [&self.settled.free, &self.settled.blocked].map(|bits| &bits[range.clone()]);
        let mut open: Vec<WordBits> = (known.iter().zip(free).zip(blocked))
            .map(|((known, free), blocked)| std::array::from_fn(|word| known[word] & !free[word] & !blocked[word]))
            .collect();
        self.ask(targets, &mut open);
        for ((known, free), open) in known.iter_mut().zip(free).zip(&open) {
            *known = std::array::from_fn(|word| known[word] & free[word] | open[word]);
        }
        for group in &groups {
            let queried = group.headings.iter().fold(0_u64, |bits, (column, _)| bits | 1 << column);
            for (word, rows) in rows.chunks_mut(width * WORD).enumerate() {
                let mut of_columns = [0; WORD];
                group.headings.iter().for_each(|&(column, number)| of_columns[column] = known[number][word]);
                for (row, seen) in rows.chunks_mut(width).zip(transposed(of_columns)) {
                    row[group.word] &= seen | !queried;
                }
            }
        }
    }

    /// Takes out those that any ball blocks. One direction after the other, so that lines of sight side by side meet
    /// the same balls.
    fn ask(&self, targets: &[[f32; 3]], open: &mut [WordBits]) {
        debug_assert!(targets.len() <= BLOCK);
        // what blocked each target last
        let mut before: Vec<Option<u32>> = vec![None; targets.len()];
        for ((heading, open), &open_from) in self.headings.iter().zip(open).zip(&self.settled.open_from) {
            let queried = *open;
            let mut of_direction = OfDirection { open, before: &mut before, last: [None; 2] };
            let mut packet = Packet::new(self.tree, heading.direction, open_from);
            let mut taken = Vec::with_capacity(LANES);
            let targets_queried =
                (0..).zip(queried).flat_map(|(word, queried)| bits(queried).map(move |bit| word * WORD + bit));
            for target in targets_queried {
                let ray = self.tree.ray(targets[target].map(f64::from), heading.direction, f64::INFINITY);
                let blocks = |&ball: &u32| self.tree.front(ball as usize, &ray).is_some();
                if let Some(ball) = of_direction.likely(target).into_iter().flatten().find(blocks) {
                    of_direction.block(target, ball);
                    continue;
                }
                if !packet.take(targets[target]) {
                    of_direction.block_all(taken.drain(..), packet.find());
                    packet.take(targets[target]);
                }
                taken.push(target);
            }
            of_direction.block_all(taken.drain(..), packet.find());
        }
    }
}

/// State of the search in a direction.
struct OfDirection<'a> {
    /// A bit for each target that nothing blocks yet.
    open: &'a mut WordBits,
    /// Last blocker of each target.
    before: &'a mut [Option<u32>],
    /// Blockers of the previous targets.
    last: [Option<u32>; 2],
}

impl OfDirection<'_> {
    /// Balls that may block a target, as they block its neighbours, or it in other directions.
    #[inline]
    fn likely(&self, target: usize) -> [Option<u32>; 3] {
        [self.last[0], self.last[1], self.before[target]]
    }

    #[inline]
    fn block(&mut self, target: usize, ball: u32) {
        self.open[target / WORD] &= !(1 << (target % WORD));
        self.before[target] = Some(ball);
        if self.last[0] != Some(ball) {
            self.last = [Some(ball), self.last[0]];
        }
    }

    fn block_all(&mut self, targets: impl Iterator<Item = usize>, blockers: Blockers) {
        for (target, blocker) in targets.zip(blockers) {
            blocker.into_iter().for_each(|ball| self.block(target, ball));
        }
    }
}

/// The numbers of the bits that are set.
fn bits(mut word: u64) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        (word != 0).then(|| {
            let bit = word.trailing_zeros() as usize;
            word &= word - 1;
            bit
        })
    })
}

/// Bit j of word i becomes bit i of word j.
///
/// # Source
/// Warren, Hacker's Delight, 2nd edition, section 7-3.
fn transposed(mut words: [u64; WORD]) -> [u64; WORD] {
    let mut half = WORD / 2;
    let mut mask = u64::MAX >> half;
    while half > 0 {
        for i in (0..WORD).filter(|i| i & half == 0) {
            let swapped = (words[i] >> half ^ words[i + half]) & mask;
            words[i + half] ^= swapped;
            words[i] ^= swapped << half;
        }
        half /= 2;
        mask ^= mask << half;
    }
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_change_places() {
        let words: [u64; WORD] = std::array::from_fn(|i| belvedere_data::random::uniform(1, i as u64).to_bits());
        let turned = transposed(words);
        assert!((0..WORD).all(|i| (0..WORD).all(|j| words[i] >> j & 1 == turned[j] >> i & 1)));
        assert_eq!(bits(0b1010_0001).collect::<Vec<_>>(), [0, 5, 7]);
    }
}
