//! A number that shows whether two scenes are the same, so that what was found in one is not taken for what is in the
//! other.

use crate::blocking::{BlockRule, Profile};
use crate::medial::MedialBalls;
use crate::query::{Blocker, BlockingTriangles, FarTerrain};
use belvedere_data::horizon::HorizonProfile;

/// A number that differs, but for one chance in 10¹⁹, between scenes whose balls, triangles, far terrain or
/// parameters differ in any bit; the same on any machine.
///
/// # Source
/// FNV-1a of 64 bits (Fowler, Noll & Vo), taken over words of 32 bits.
#[must_use]
pub fn scene_fingerprint(
    balls: &MedialBalls,
    triangles: Option<&BlockingTriangles>,
    far_terrain: &FarTerrain,
    params: &BlockRule,
) -> u64 {
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    let mut mix = |word: u32| hash = (hash ^ u64::from(word)).wrapping_mul(0x0100_0000_01b3);
    #[expect(clippy::cast_possible_truncation, reason = "both halves are taken")]
    let halves = |number: f64| [number.to_bits() as u32, (number.to_bits() >> 32) as u32];
    for number in [params.bias, params.shell] {
        halves(number).into_iter().for_each(&mut mix);
    }
    mix(u32::from(params.profile == Profile::Sphere));
    for (center, radius) in balls.centers.iter().zip(&balls.radii) {
        center.iter().for_each(|v| mix(v.to_bits()));
        mix(radius.to_bits());
    }
    for number in far_terrain.profile().map_or(&[][..], HorizonProfile::rows).as_flattened() {
        halves(*number).into_iter().for_each(&mut mix);
    }
    if let Some(grid) = far_terrain.grid() {
        for number in [grid.north_west(), grid.cell()].as_flattened() {
            halves(*number).into_iter().for_each(&mut mix);
        }
        grid.heights().values().iter().for_each(|height| mix(height.to_bits()));
    }
    for (corners, blocker) in triangles.into_iter().flat_map(BlockingTriangles::triangles) {
        corners.as_flattened().iter().flat_map(|corner| halves(*corner)).for_each(&mut mix);
        // meshes of any number block alike
        if let Blocker::Patch(kind) = blocker {
            mix(1 + u32::from(kind.code()));
        }
    }
    hash
}
