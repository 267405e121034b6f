//! Is the index faster than a kd-tree crate where it has to be: near the surface, and from the far centres of large
//! balls? With `--features belvedere-benches/kiddo`, which takes long to compile, that crate is measured too. And what
//! do AVX2 instructions give?
#![allow(clippy::unwrap_used, reason = "a bench that cannot go on fails")]

mod common;

use belvedere::control::Control;
use belvedere::neighbors::{Instructions, NeighborIndex};
use belvedere_benches::Group;

fn searches() {
    let (points, _) = common::aerial_city(500_000);
    let index = NeighborIndex::new(&points, &Control::none()).unwrap();
    let scalar = NeighborIndex::with_instructions(&points, Instructions::Scalar, &Control::none()).unwrap();
    #[cfg(feature = "kiddo")]
    let other = kiddo::ImmutableKdTree::<f32, 3>::new_from_slice(&points).unwrap();
    let some: Vec<[f32; 3]> = index.tree_order().iter().step_by(25).map(|&i| points[i as usize]).collect();
    for (name, depth) in [("on the surface", 0.0), ("5 m below", 5.0), ("200 m below", 200.0)] {
        let queries: Vec<[f32; 3]> = some.iter().map(|p| [p[0], p[1], p[2] - depth]).collect();
        let mut group = Group::new(format!("nearest point, {name}"));
        group.sample_size(10).throughput(queries.len());
        group.bench_function("belvedere", |b| {
            b.iter(|| queries.iter().filter_map(|&q| index.nearest_within(q, f32::INFINITY)).count());
        });
        group.bench_function("belvedere, scalar", |b| {
            b.iter(|| queries.iter().filter_map(|&q| scalar.nearest_within(q, f32::INFINITY)).count());
        });
        #[cfg(feature = "kiddo")]
        group.bench_function("kiddo", |b| {
            b.iter(|| {
                let nearest =
                    |q: &[f32; 3]| other.query(q).nearest_one::<kiddo::SquaredEuclidean<f32>>().execute().distance;
                queries.iter().map(nearest).fold(0.0, f32::max)
            });
        });
    }
}

fn main() {
    searches();
}
