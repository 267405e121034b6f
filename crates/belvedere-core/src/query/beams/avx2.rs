//! Eight lanes at once on machines with AVX2 and FMA: the same arithmetic as [`super::lanes::BeamScalar`] with fused
//! products, in the same order.
#![expect(
    unsafe_code,
    reason = "nearly all of the time of viewsheds of many observers goes into these tests (docs/methods/viewshed.md); tests compare them with \
              the scalar form"
)]

use super::blockers::LANES;
use super::lanes::{ConvexSpace, HalfLine, Kernels, LaneBits, LaneColumns, PLANES};
use super::sweep::TreeSweep;
use crate::blocking::Ball;
use crate::instructions::Instructions;
use crate::ray_index::PartSides;
use std::arch::x86_64::*;

/// Visits the places of the targets below `node` that no ball blocks; false on a machine without these instructions,
/// where nothing is done.
pub(super) fn search(sweep: &TreeSweep<'_>, node: usize, visit: &mut impl FnMut(usize)) -> bool {
    #[target_feature(enable = "avx2,fma,bmi1,bmi2,lzcnt,popcnt")]
    fn run(sweep: &TreeSweep<'_>, node: usize, visit: &mut impl FnMut(usize)) {
        sweep.search::<BeamAvx2>(node, visit);
    }
    let is_able = Instructions::detect() == Instructions::Avx2;
    if is_able {
        // SAFETY: `detect` found all of these
        unsafe { run(sweep, node, visit) }
    }
    is_able
}

/// AVX2 and FMA.
pub(super) struct BeamAvx2;

// SAFETY of the blocks below: the methods are only used where AVX2 and FMA were found, and inlined into functions that
// enable them; `load` and `store` touch arrays of exactly eight f32.

#[inline(always)]
fn load(lanes: &[f32; LANES]) -> __m256 {
    // SAFETY: see above
    unsafe { _mm256_loadu_ps(lanes.as_ptr()) }
}

#[inline(always)]
fn store(lanes: &mut [f32; LANES], values: __m256) {
    // SAFETY: see above
    unsafe { _mm256_storeu_ps(lanes.as_mut_ptr(), values) }
}

#[inline(always)]
fn all(value: f32) -> __m256 {
    // SAFETY: see above
    unsafe { _mm256_set1_ps(value) }
}

#[inline(always)]
fn bits(mask: __m256) -> LaneBits {
    // SAFETY: see above
    LaneBits(unsafe { _mm256_movemask_ps(mask) }.cast_unsigned())
}

#[inline(always)]
fn dot(a: [__m256; 3], b: [__m256; 3]) -> __m256 {
    // SAFETY: see above
    unsafe {
        _mm256_add_ps(_mm256_add_ps(_mm256_mul_ps(a[0], b[0]), _mm256_mul_ps(a[1], b[1])), _mm256_mul_ps(a[2], b[2]))
    }
}

#[inline(always)]
fn depth(space: &ConvexSpace, plane: usize, [x, y, z]: [__m256; 3]) -> __m256 {
    let (normal, offset) = (space.normals[plane].map(all), all(space.offsets[plane]));
    // SAFETY: see above
    unsafe { _mm256_fnmadd_ps(normal[2], z, _mm256_fnmadd_ps(normal[1], y, _mm256_fnmadd_ps(normal[0], x, offset))) }
}

impl Kernels for BeamAvx2 {
    #[inline(always)]
    fn meet_boxes(space: &ConvexSpace, sides: &PartSides) -> LaneBits {
        // SAFETY: see above
        unsafe {
            let mut min = all(f32::INFINITY);
            for plane in 0..PLANES {
                let [x, y, z] = space.inward[plane];
                let corner = [
                    load(&sides[0][usize::from(x & 1)]),
                    load(&sides[1][usize::from(y & 1)]),
                    load(&sides[2][usize::from(z & 1)]),
                ];
                min = _mm256_min_ps(min, depth(space, plane, corner));
            }
            bits(_mm256_cmp_ps::<_CMP_GE_OQ>(min, _mm256_setzero_ps()))
        }
    }

    #[inline(always)]
    fn meet_balls(space: &ConvexSpace, [x, y, z, radius]: &LaneColumns) -> LaneBits {
        // SAFETY: see above
        unsafe {
            let (center, radius) = ([load(x), load(y), load(z)], load(radius));
            let mut min = radius;
            for plane in 0..PLANES {
                min = _mm256_min_ps(min, depth(space, plane, center));
            }
            bits(_mm256_cmp_ps::<_CMP_GE_OQ>(min, _mm256_sub_ps(_mm256_setzero_ps(), radius)))
        }
    }

    #[inline(always)]
    fn may_cover(space: &ConvexSpace, [x, y, z, radius]: &LaneColumns) -> LaneBits {
        // SAFETY: see above
        unsafe {
            let (center, radius) = ([load(x), load(y), load(z)], load(radius));
            let across = _mm256_max_ps(depth(space, 0, center), depth(space, 1, center));
            let along = _mm256_max_ps(depth(space, 2, center), depth(space, 3, center));
            let square = _mm256_add_ps(_mm256_mul_ps(across, across), _mm256_mul_ps(along, along));
            bits(_mm256_cmp_ps::<_CMP_LE_OQ>(square, _mm256_mul_ps(radius, radius)))
        }
    }

    #[inline(always)]
    fn near_line([x, y, z, radius]: &LaneColumns, line: &HalfLine) -> LaneBits {
        // SAFETY: see above
        unsafe {
            let [ox, oy, oz] = line.origin.map(all);
            let [dx, dy, dz] = line.direction.map(all);
            let [mx, my, mz] = [_mm256_sub_ps(load(x), ox), _mm256_sub_ps(load(y), oy), _mm256_sub_ps(load(z), oz)];
            let minus = |a, b, c, d| _mm256_sub_ps(_mm256_mul_ps(a, b), _mm256_mul_ps(c, d));
            let across = [minus(my, dz, mz, dy), minus(mz, dx, mx, dz), minus(mx, dy, my, dx)];
            let reach = _mm256_add_ps(load(radius), all(line.room));
            let zero = _mm256_setzero_ps();
            let is_beside = _mm256_cmp_ps::<_CMP_LE_OQ>(dot(across, across), _mm256_mul_ps(reach, reach));
            let along = dot([mx, my, mz], [dx, dy, dz]);
            let is_ahead = _mm256_cmp_ps::<_CMP_GE_OQ>(along, _mm256_sub_ps(zero, reach));
            let is_ball = _mm256_cmp_ps::<_CMP_GT_OQ>(reach, zero);
            bits(_mm256_and_ps(_mm256_and_ps(is_beside, is_ahead), is_ball))
        }
    }

    #[inline(always)]
    fn columns(balls: &[Ball; LANES]) -> LaneColumns {
        // SAFETY: see above
        unsafe {
            let row = |ball: &Ball| _mm_set_ps(ball.radius, ball.center[2], ball.center[1], ball.center[0]);
            let pair = |i: usize| _mm256_set_m128(row(&balls[i + 4]), row(&balls[i]));
            let [a, b, c, d] = [pair(0), pair(1), pair(2), pair(3)];
            let (low, high) = (_mm256_unpacklo_ps(a, b), _mm256_unpackhi_ps(a, b));
            let (low_next, high_next) = (_mm256_unpacklo_ps(c, d), _mm256_unpackhi_ps(c, d));
            let mut columns = [[0.0; LANES]; 4];
            store(&mut columns[0], _mm256_shuffle_ps::<0x44>(low, low_next));
            store(&mut columns[1], _mm256_shuffle_ps::<0xee>(low, low_next));
            store(&mut columns[2], _mm256_shuffle_ps::<0x44>(high, high_next));
            store(&mut columns[3], _mm256_shuffle_ps::<0xee>(high, high_next));
            columns
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::query::beams::lanes::BeamScalar;
    use belvedere_data::random::uniform;

    /// The scalar form with fused products.
    type Fused = BeamScalar<true>;

    /// Balls, boxes, spaces and lines of all sizes; every fourth number is a round one, so that equal values and zeros
    /// occur.
    fn random(seed: u64, index: u64) -> f32 {
        let value = uniform(seed, index);
        #[expect(clippy::cast_possible_truncation, reason = "a test of f32")]
        match index % 4 {
            0 => (8.0 * value).floor() as f32 - 4.0,
            _ => (20.0 * value - 10.0) as f32,
        }
    }

    #[test]
    fn every_test_gives_the_bits_of_its_scalar_form() {
        if Instructions::detect() != Instructions::Avx2 {
            use std::io::Write;
            // not `println!`, which the test runner captures
            let what = "a comparison of instructions: this machine has no AVX2 or no FMA";
            let _ = writeln!(std::io::stderr().lock(), "SKIPPED {what}");
            return;
        }
        let mut passed = [0; 4];
        for seed in 0..4000 {
            let mut index = 0;
            let mut next = || {
                index += 1;
                random(seed, index)
            };
            let mut space = ConvexSpace::all();
            for plane in 0..PLANES {
                if next() > -8.0 {
                    space.set(plane, [next(), next(), next()].map(|v| 0.2 * v), next() + 6.0);
                }
            }
            let balls: [Ball; LANES] =
                std::array::from_fn(|_| Ball { center: [next(), next(), next()], radius: 2.0 * next() });
            let mut sides: PartSides = [[[0.0; LANES]; 2]; 3];
            for [low, high] in &mut sides {
                for (low, high) in low.iter_mut().zip(high) {
                    *low = next();
                    *high = *low + next().abs();
                }
            }
            let line = HalfLine {
                origin: [next(), next(), next()],
                direction: [next(), next(), 0.0].map(|v| 0.1 * v),
                room: 0.01,
            };
            // SAFETY of the calls: this machine has AVX2 and FMA, as tested above
            let columns = BeamAvx2::columns(&balls);
            assert_eq!(columns, Fused::columns(&balls));
            let pairs = [
                [BeamAvx2::meet_boxes(&space, &sides), Fused::meet_boxes(&space, &sides)],
                [BeamAvx2::meet_balls(&space, &columns), Fused::meet_balls(&space, &columns)],
                [BeamAvx2::may_cover(&space, &columns), Fused::may_cover(&space, &columns)],
                [BeamAvx2::near_line(&columns, &line), Fused::near_line(&columns, &line)],
            ];
            for (passed, [avx2, scalar]) in passed.iter_mut().zip(pairs) {
                assert_eq!(avx2, scalar, "seed {seed}");
                *passed += scalar.count();
            }
        }
        assert!(passed.iter().all(|passed| (300..31_700).contains(passed)), "{passed:?} of 32000 each");
    }
}
