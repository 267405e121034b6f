//! Neighbouring targets looked at together: what sweeps left open is asked of balls.

use super::nearby::{NEAR, Nearby};
use super::space_layers::WORD;
use super::sweep::Settled;
use crate::query::MedialScene;
use crate::ray_index::Ray;

/// Targets handed to a thread at once: neighbours, which share what blocks.
pub(super) const CHUNK: usize = WORDS * WORD;
/// Words with a bit for each of them.
const WORDS: usize = 4;
/// Of these, those for which balls near by are looked up together.
const TOGETHER: usize = 8;

/// A direction and what of it is needed again and again.
pub(super) struct Heading {
    pub(super) direction: [f64; 3],
    /// Range at which it has left the near space of a target.
    pub(super) near: f64,
    column: usize,
}

/// Directions in bands of elevation, to and fro, so that each is close to the one before.
pub(super) fn headings(directions: &[[f64; 3]]) -> Vec<Heading> {
    /// Bands from the horizon to the zenith: about as high as 600 directions are apart.
    const BANDS: f64 = 16.0;
    let key = |direction: [f64; 3]| {
        let band = (direction[2] * BANDS).floor();
        let azimuth = direction[0].atan2(direction[1]);
        (band, if band % 2.0 == 0.0 { azimuth } else { -azimuth })
    };
    let mut order: Vec<usize> = (0..directions.len()).collect();
    order.sort_by(|&a, &b| {
        let (a, b) = (key(directions[a]), key(directions[b]));
        a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1))
    });
    let heading = |column: usize| {
        let direction = directions[column];
        let across = direction[0].abs().max(direction[1].abs());
        Heading { direction, near: (NEAR[1] / direction[2]).min(NEAR[0] / across), column }
    };
    order.into_iter().map(heading).collect()
}

/// What all targets look at.
pub(super) struct Sky<'a> {
    scene: &'a MedialScene,
    headings: &'a [Heading],
    /// What a sweep of each direction found; empty without sweeps.
    settled: Vec<Option<Settled>>,
    /// Which of the headings belongs to each column of the matrix.
    numbers: Vec<Option<usize>>,
}

/// A bit for each target of a chunk.
type Bits = [u64; WORDS];

impl<'a> Sky<'a> {
    /// Looks at `headings`, each with what a sweep settled of it or all without, which are some of `column_count` directions.
    pub(super) fn new(
        scene: &'a MedialScene,
        headings: &'a [Heading],
        settled: Vec<Option<Settled>>,
        column_count: usize,
    ) -> Self {
        let mut numbers = vec![None; column_count];
        for (number, heading) in headings.iter().enumerate() {
            numbers[heading.column] = Some(number);
        }
        Self { scene, headings, settled, numbers }
    }

    /// Sets the bits of directions that are free in the rows, of `width` words each, of the targets of a chunk.
    pub(super) fn look(&self, targets: &[[f32; 3]], chunk: usize, rows: &mut [u64], width: usize) {
        let (mut free, mut open) = self.settled_of(targets.len(), chunk);
        if !self.settled.is_empty() {
            self.leave_near(targets, &mut free, &mut open);
        }
        self.ask(targets, &mut open);
        for (seen, open) in free.iter_mut().zip(&open) {
            *seen = std::array::from_fn(|word| seen[word] | open[word]);
        }
        for (group, columns) in self.numbers.chunks(WORD).enumerate() {
            for (word, rows) in rows.chunks_mut(width * WORD).enumerate() {
                let of_column = |column: usize| columns.get(column).copied().flatten().map_or(0, |n| free[n][word]);
                let of_targets = transposed(std::array::from_fn(of_column));
                for (row, seen) in rows.chunks_mut(width).zip(of_targets) {
                    row[group] |= seen;
                }
            }
        }
    }

    /// For each direction the targets for which a sweep found that nothing blocks beyond their near space, and those of which it does not
    /// know.
    fn settled_of(&self, target_count: usize, chunk: usize) -> (Vec<Bits>, Vec<Bits>) {
        let all: Bits = std::array::from_fn(|word| match target_count.saturating_sub(word * WORD) {
            0 => 0,
            count => u64::MAX >> WORD.saturating_sub(count),
        });
        let of_chunk = |bits: &[u64]| -> Bits {
            std::array::from_fn(|word| bits.get(chunk * WORDS + word).copied().unwrap_or(0) & all[word])
        };
        (0..self.headings.len())
            .map(|number| match self.settled.get(number).and_then(Option::as_ref) {
                None => ([0; WORDS], all),
                Some(settled) => {
                    let (free, blocked) = (of_chunk(&settled.free), of_chunk(&settled.blocked));
                    (free, std::array::from_fn(|word| all[word] & !free[word] & !blocked[word]))
                }
            })
            .unzip()
    }

    /// Takes out those that a ball near the target blocks.
    fn leave_near(&self, targets: &[[f32; 3]], free: &mut [Bits], open: &mut [Bits]) {
        let mut nearby = Nearby::default();
        for (i, target) in targets.iter().enumerate() {
            if i % TOGETHER == 0 {
                nearby.gather(self.scene, &targets[i..targets.len().min(i + TOGETHER)]);
            }
            let target = target.map(f64::from);
            nearby.select(self.scene, target);
            if nearby.is_empty() {
                continue;
            }
            let (word, bit) = (i / WORD, 1 << (i % WORD));
            for ((heading, free), open) in self.headings.iter().zip(&mut *free).zip(&mut *open) {
                let is_asked = (free[word] | open[word]) & bit != 0 && heading.direction[2] >= 0.0;
                if is_asked && nearby.blocks(self.scene, &self.scene.ray(target, heading.direction, f64::INFINITY)) {
                    free[word] &= !bit;
                    open[word] &= !bit;
                }
            }
        }
    }

    /// Takes out those that any ball blocks. One direction after the other, so that lines of sight side by side meet the same balls.
    fn ask(&self, targets: &[[f32; 3]], open: &mut [Bits]) {
        // what blocked each target last
        let mut before: Vec<Option<u32>> = vec![None; targets.len()];
        for (heading, open) in self.headings.iter().zip(open) {
            let is_near_asked = !self.settled.is_empty() && heading.direction[2] >= 0.0;
            // what blocked the targets before in this direction
            let mut last = [None; 2];
            for (word, open) in open.iter_mut().enumerate() {
                for bit in bits(*open) {
                    let i = word * WORD + bit;
                    let target = targets[i].map(f64::from);
                    let ray = self.scene.ray(target, heading.direction, f64::INFINITY);
                    let start = if is_near_asked { heading.near } else { ray.ranges[0] };
                    let is_by = |&ball: &u32| self.scene.front(ball as usize, &ray).is_some();
                    let [last_one, one_before] = last;
                    let found = last_one
                        .filter(is_by)
                        .or_else(|| one_before.filter(is_by))
                        .or_else(|| before[i].filter(is_by))
                        .or_else(|| self.block_from(start, &ray));
                    if found.is_some() {
                        *open &= !(1 << bit);
                        before[i] = found;
                        if found != last_one {
                            last = [found, last_one];
                        }
                    }
                }
            }
        }
    }

    /// A ball that blocks `ray`, where none does before the range `start`.
    fn block_from(&self, start: f64, ray: &Ray) -> Option<u32> {
        let mut block = None;
        let far = Ray { ranges: [start.max(ray.ranges[0]), ray.ranges[1]], ..*ray };
        self.scene.index.any(&far, |number| {
            let blocks = self.scene.front(number, ray).is_some();
            #[expect(clippy::cast_possible_truncation, reason = "balls are numbered with 32 bits")]
            if blocks {
                block = Some(number as u32);
            }
            blocks
        });
        block
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
