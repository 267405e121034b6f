use belvedere::{
    depth::*, medial::*, neighbors::NeighborIndex, normals::OrientedCloud, progress::Progress, query::*, view::*,
};
use std::time::Instant;
fn read(p: &str) -> Vec<[f32; 3]> {
    let v: Vec<f32> = npyz::NpyFile::new(std::fs::File::open(p).unwrap()).unwrap().into_vec().unwrap();
    v.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect()
}
fn main() {
    let d = "/work/shared/reference/delft1/";
    let (c, n) = (read(&format!("{d}coords.npy")), read(&format!("{d}normals.npy")));
    let index = NeighborIndex::new(&c).unwrap();
    let cloud = OrientedCloud::new(c, n);
    for p in [ShrinkParams::angles(), ShrinkParams::tau()] {
        let (b, _) = shrink(&cloud, &index, Side::Interior, &p, Progress::none()).unwrap();
        for (az, el) in [(0.0f64, 90.0f64), (180.0, 35.0), (240.0, 12.0)] {
            let f = to_sun(az.to_radians(), el.to_radians()).map(|v| -v);
            let v = View::parallel(f, [0.0, 0.0, 0.0], [192.0, 229.3, 20.4], 0.25).unwrap();
            for prof in [Profile::Sphere, Profile::PaperCone] {
                for it in [ItemBuffer::Without, ItemBuffer::With] {
                    let t = Instant::now();
                    let m = depth_map(&b, &v, prof, it).unwrap();
                    let e = t.elapsed();
                    let q = random_targets([0.0; 3], [192.0, 229.3, 20.4], 1000000, 1);
                    let t = Instant::now();
                    let a = query_points(&m, &q, 0.1);
                    println!(
                        "{az} {el} {prof:?} {it:?} {:?} map {:?} query {:?} {:?}",
                        v.size_px,
                        e,
                        t.elapsed(),
                        AnswerCounts::of(&a)
                    );
                }
            }
        }
    }
}
