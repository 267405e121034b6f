//! Which balls are wrong, and why: the balls of a union compared with the solids that they should fill.

use belvedere::medial::MedialBalls;
use belvedere::vector::{dot, unit};
use rayon::prelude::*;

/// Beyond this angle a normal is taken for badly tilted, radians: 30°.
const TILTED: f64 = 30.0 * std::f64::consts::PI / 180.0;

/// What is known in truth of the point a ball is tangent at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TruePoint<K> {
    /// Kind of surface, such as its material.
    pub kind: K,
    /// Outward unit normal of the exact surface.
    pub normal: [f64; 3],
}

/// The balls tangent at one kind of surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Audit {
    /// Balls in all.
    pub count: usize,
    /// Balls whose centre lies in free air: they fill what is empty.
    pub wrong: usize,
    /// Wrong ones whose normal points into the solid: the ball lies on the wrong side of its surface.
    pub flipped: usize,
    /// Wrong ones whose normal is off by 30° to 90°.
    pub tilted: usize,
}

impl Audit {
    /// Wrong balls with a good normal: they bulge out of their solid through surface that no point marks.
    #[must_use]
    pub fn bulging(&self) -> usize {
        self.wrong - self.flipped - self.tilted
    }
}

/// What became of each ball of `balls`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BallVerdict {
    /// Its centre lies in a solid or in the ground.
    Right,
    /// Its centre lies in free air.
    Wrong,
}

/// Holds each ball against the truth: `points`, (N, 3) local metres, are those the balls were made for, `sources`, (N),
/// what is known of each of them, and `is_inside` returns whether a local position lies in a solid.
///
/// Returns a verdict for each ball, and the audit of each kind of surface in the order in which kinds occur first.
/// Balls of points of which nothing is known get a verdict and enter no audit.
pub fn audit<K: Copy + PartialEq + Sync>(
    balls: &MedialBalls,
    points: &[[f32; 3]],
    sources: &[Option<TruePoint<K>>],
    is_inside: impl Fn([f32; 3]) -> bool + Sync,
) -> (Vec<BallVerdict>, Vec<(K, Audit)>) {
    let verdict = |center: &[f32; 3]| if is_inside(*center) { BallVerdict::Right } else { BallVerdict::Wrong };
    let verdicts: Vec<BallVerdict> = balls.centers.par_iter().map(verdict).collect();
    let mut audits: Vec<(K, Audit)> = Vec::new();
    for (row, &verdict) in verdicts.iter().enumerate() {
        let Some(Some(source)) = sources.get(balls.source[row] as usize) else { continue };
        let at = audits.iter().position(|(kind, _)| *kind == source.kind).unwrap_or_else(|| {
            audits.push((source.kind, Audit::default()));
            audits.len() - 1
        });
        let audit = &mut audits[at].1;
        audit.count += 1;
        if verdict == BallVerdict::Right {
            continue;
        }
        audit.wrong += 1;
        // an interior ball lies at p − r·n
        let (point, center) = (points[balls.source[row] as usize], balls.centers[row]);
        let outward = std::array::from_fn(|i| f64::from(point[i]) - f64::from(center[i]));
        let cosine = unit(outward).map_or(1.0, |outward| dot(outward, source.normal));
        audit.flipped += usize::from(cosine < 0.0);
        audit.tilted += usize::from((0.0..TILTED.cos()).contains(&cosine));
    }
    (verdicts, audits)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn balls_of_a_slab_are_separated_by_what_is_wrong_with_them() {
        // solid below z = 0; balls of radius 1 at points of its surface, by the normals they were made with
        let tilt = 60f32.to_radians();
        let normals = [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [tilt.sin(), 0.0, tilt.cos()], [0.0, 0.0, 1.0_f32]];
        let points = [[0.0; 3], [5.0, 0.0, 0.0], [10.0, 0.0, 0.2], [15.0, 0.0, 1.5]];
        let balls = MedialBalls {
            centers: (0..4).map(|i| std::array::from_fn(|k| points[i][k] - normals[i][k])).collect(),
            radii: vec![1.0; 4],
            source: vec![0, 1, 2, 3],
            touch: vec![0; 4],
            separation_angles: vec![1.0; 4],
        };
        let up = [0.0, 0.0, 1.0];
        let mut sources = vec![Some(TruePoint { kind: 'a', normal: up }); 4];
        sources[3] = Some(TruePoint { kind: 'b', normal: up });
        // the ball of the third point reaches z = −0.3: where the solid begins only at −0.4, it stands in the air
        let (verdicts, audits) = audit(&balls, &points, &sources, |p| p[2] < -0.4);
        let (right, wrong) = (BallVerdict::Right, BallVerdict::Wrong);
        assert_eq!(verdicts, [right, wrong, wrong, wrong]);
        assert_eq!(audits[0], ('a', Audit { count: 3, wrong: 2, flipped: 1, tilted: 1 }));
        assert_eq!(audits[1], ('b', Audit { count: 1, wrong: 1, flipped: 0, tilted: 0 }));
        assert_eq!(audits[1].1.bulging(), 1);
        sources[3] = None;
        assert_eq!(audit(&balls, &points, &sources, |p| p[2] < -0.4).1.len(), 1);
    }
}
