//! Bit matrix of the targets that each camera covers.

use belvedere_data::{Error, Parameter, Result};

/// Maximum number of bits of a table: 8 GiB.
const MAX_BITS: u64 = 1 << 36;

/// A row of bits for each camera: bit t of word t / 64 says whether it covers target t.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CoverageTable {
    target_count: usize,
    words: usize,
    bits: Vec<u64>,
}

impl CoverageTable {
    /// The table of cameras that cover these targets, each given by its number.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a target that is not there, and for a table of more than 8 GiB.
    pub fn of_lists(target_count: usize, covered: &[Vec<usize>]) -> Result<Self> {
        check_size(covered.len(), target_count)?;
        let words = target_count.div_ceil(64);
        let mut bits = vec![0; words * covered.len()];
        for (camera, list) in covered.iter().enumerate() {
            for &target in list {
                if target >= target_count {
                    return Err(Error::invalid(Parameter::Target, target, "the number of a target, counted from 0"));
                }
                bits[camera * words + target / 64] |= 1 << (target % 64);
            }
        }
        Ok(Self { target_count, words, bits })
    }

    /// The table whose rows stand one after the other in `bits`.
    pub(super) fn of_bits(target_count: usize, bits: Vec<u64>) -> Self {
        Self { target_count, words: target_count.div_ceil(64), bits }
    }

    /// Number of targets.
    #[must_use]
    pub fn target_count(&self) -> usize {
        self.target_count
    }

    /// Number of cameras.
    #[must_use]
    pub fn camera_count(&self) -> usize {
        self.bits.len().checked_div(self.words).unwrap_or(0)
    }

    /// The bits of a camera.
    pub(super) fn row(&self, camera: usize) -> &[u64] {
        &self.bits[camera * self.words..(camera + 1) * self.words]
    }

    /// The targets that a camera covers, in ascending order.
    pub fn covered_by(&self, camera: usize) -> impl Iterator<Item = usize> + '_ {
        self.row(camera).iter().enumerate().flat_map(|(word, &bits)| ones(word, bits))
    }

    /// Number of pairs of a camera and a target that it covers.
    #[must_use]
    pub fn pair_count(&self) -> usize {
        self.bits.iter().map(|word| word.count_ones() as usize).sum()
    }
}

/// Refuses tables that no memory holds.
pub(super) fn check_size(cameras: usize, targets: usize) -> Result<()> {
    if (cameras as u64).saturating_mul(targets as u64) <= MAX_BITS {
        return Ok(());
    }
    let value = format!("{cameras} x {targets}");
    let expected = "at most 69 billion pairs; use fewer candidates, or larger cells";
    Err(Error::invalid(Parameter::TargetCount, value, expected))
}

/// Places of the bits of a word.
pub(super) fn ones(word: usize, mut bits: u64) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let place = (bits != 0).then(|| 64 * word + bits.trailing_zeros() as usize);
        bits &= bits.wrapping_sub(1);
        place
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_the_lists_they_were_made_of() {
        let lists = vec![vec![0, 63, 64, 129], vec![], vec![5]];
        let table = CoverageTable::of_lists(130, &lists).unwrap();
        assert_eq!((table.camera_count(), table.target_count(), table.pair_count()), (3, 130, 5));
        for (camera, list) in lists.iter().enumerate() {
            assert_eq!(&table.covered_by(camera).collect::<Vec<_>>(), list);
        }
        assert!(CoverageTable::of_lists(4, &[vec![4]]).is_err());
        assert!(check_size(1 << 20, 1 << 20).is_err());
        assert_eq!(CoverageTable::of_lists(0, &[]).unwrap().camera_count(), 0);
    }
}
