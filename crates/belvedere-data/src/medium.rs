//! Crowns as a medium: how much of the light plants take per metre, in voxels.

use crate::cast::to_i32;
use crate::{Error, Parameter, Result};
use std::collections::HashSet;

/// Side of a voxel, metres. At 2 to 20 pulses/m² 1 m predicts kept pulses best: 2 m and three spacings are worse, 0.5 m
/// is better from 20 pulses/m² on only.
pub const VOXEL_SIDE: f64 = 1.0;
/// Largest extinction that a voxel can hold, per metre: 1 mm of it lets nothing through.
pub const MAX_EXTINCTION: f32 = 1e4;

/// Extinction by plants, in voxels of [`VOXEL_SIDE`] on the grid of the reference system. Voxels that are not listed
/// hold nothing that takes light.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ExtinctionVoxels {
    /// Numbers of the voxels from zero of the reference system, (V, 3): easting, northing and height of their lowest
    /// corner in sides. Ascending, each once.
    pub voxels: Vec<[i32; 3]>,
    /// Extinction, per metre, (V), 0 to [`MAX_EXTINCTION`].
    pub extinction: Vec<f32>,
}

impl ExtinctionVoxels {
    /// Number of voxels.
    #[must_use]
    pub fn len(&self) -> usize {
        self.voxels.len()
    }

    /// Returns true if there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.voxels.is_empty()
    }

    /// The number of the voxel that a local position lies in, of a frame with this `origin`.
    #[must_use]
    pub fn voxel_of(position: [f32; 3], origin: [f64; 3]) -> [i32; 3] {
        std::array::from_fn(|axis| {
            let base = (origin[axis] / VOXEL_SIDE).floor();
            let place = f64::from(position[axis]) / VOXEL_SIDE + (origin[axis] / VOXEL_SIDE - base);
            to_i32((base + place.floor()).clamp(-2e9, 2e9))
        })
    }

    /// The square on the map that a voxel covers, from its south-west to its north-east corner, local metres.
    #[must_use]
    pub fn square_of(voxel: [i32; 3], origin: [f64; 3]) -> [[f64; 2]; 2] {
        [0.0, 1.0].map(|side| [0, 1].map(|axis| (f64::from(voxel[axis]) + side) * VOXEL_SIDE - origin[axis]))
    }

    /// Height of the top of a voxel, local metres.
    #[must_use]
    pub fn top_of(voxel: [i32; 3], origin: [f64; 3]) -> f64 {
        (f64::from(voxel[2]) + 1.0) * VOXEL_SIDE - origin[2]
    }

    /// The voxels for which `is_kept`, given the number of each, is true.
    #[must_use]
    pub fn filtered(&self, is_kept: impl Fn([i32; 3]) -> bool) -> Self {
        let (voxels, extinction) =
            self.voxels.iter().zip(&self.extinction).filter(|(voxel, _)| is_kept(**voxel)).unzip();
        Self { voxels, extinction }
    }

    /// Returns the voxels that remain after clearing. `cleared` are voxels that held removed points, `kept` those with
    /// other points. Voxels that hold or touch removed points are dropped, unless points remain in them.
    #[must_use]
    pub fn without_cleared(&self, cleared: &HashSet<[i32; 3]>, kept: &HashSet<[i32; 3]>) -> Self {
        let is_beside = |voxel: [i32; 3]| {
            let offsets = (0..27).map(|number| [number % 3 - 1, number / 3 % 3 - 1, number / 9 - 1]);
            let mut around = offsets.map(|offset: [i32; 3]| std::array::from_fn(|axis| voxel[axis] + offset[axis]));
            around.any(|other: [i32; 3]| cleared.contains(&other))
        };
        self.filtered(|voxel| kept.contains(&voxel) || !is_beside(voxel))
    }

    /// Adds the voxels of `other`, which are none of these.
    pub fn append(&mut self, other: &Self) {
        let mut all: Vec<([i32; 3], f32)> = self.voxels.iter().copied().zip(self.extinction.iter().copied()).collect();
        all.extend(other.voxels.iter().copied().zip(other.extinction.iter().copied()));
        all.sort_unstable_by_key(|(voxel, _)| *voxel);
        all.dedup_by_key(|(voxel, _)| *voxel);
        (self.voxels, self.extinction) = all.into_iter().unzip();
    }

    /// Checks that both columns are equally long, voxels ascending, and extinctions in their range.
    ///
    /// # Errors
    /// [`Error::LengthMismatch`] or [`Error::InvalidParameter`] for the first fault.
    pub fn validate(&self) -> Result<()> {
        let (expected, found) = (self.voxels.len(), self.extinction.len());
        if expected != found {
            return Err(Error::LengthMismatch { what: "extinctions of voxels", expected, found });
        }
        let invalid = |value: String, expected| Err(Error::invalid(Parameter::Transmissivity, value, expected));
        if let Some(pair) = self.voxels.windows(2).find(|pair| pair[0] >= pair[1]) {
            return invalid(format!("voxel {:?} after {:?}", pair[1], pair[0]), "voxels in ascending order");
        }
        if let Some(bad) = self.extinction.iter().find(|v| !(0.0..=MAX_EXTINCTION).contains(*v)) {
            return invalid(format!("extinction {bad}"), "extinctions of 0 to 10000 per metre");
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn voxels_must_ascend_and_extinctions_be_finite() {
        let sound = ExtinctionVoxels { voxels: vec![[0, 0, 1], [0, 1, 0]], extinction: vec![0.5, 2.0] };
        assert!(sound.validate().is_ok());
        let swapped = ExtinctionVoxels { voxels: vec![[0, 1, 0], [0, 0, 1]], ..sound.clone() };
        let twice = ExtinctionVoxels { voxels: vec![[0, 0, 1]; 2], ..sound.clone() };
        let missing = ExtinctionVoxels { extinction: vec![0.5], ..sound.clone() };
        assert!([swapped, twice, missing].iter().all(|wrong| wrong.validate().is_err()));
        for bad in [-1.0, f32::NAN, f32::INFINITY] {
            assert!(ExtinctionVoxels { extinction: vec![0.5, bad], ..sound.clone() }.validate().is_err(), "{bad}");
        }
    }

    #[test]
    fn parts_in_any_order_are_the_whole() {
        let voxels: Vec<[i32; 3]> = (0..50).map(|i| [i % 3, -i, 2 * i]).collect();
        let mut whole = ExtinctionVoxels::default();
        whole.append(&ExtinctionVoxels { extinction: voxels.iter().map(|v| v[2] as f32).collect(), voxels });
        assert!(whole.validate().is_ok() && whole.len() == 50);
        let [west, east] = [0, 1].map(|side| whole.filtered(|voxel| voxel[0].min(1) == side));
        for [first, second] in [[&west, &east], [&east, &west]] {
            let mut both = first.clone();
            both.append(second);
            assert_eq!(both, whole);
        }
    }
}
