use belvedere::{medial::*, neighbors::NeighborIndex, normals::OrientedCloud, progress::Progress};
fn cpu() -> f64 {
    let s = std::fs::read_to_string("/proc/self/stat").unwrap();
    let v: Vec<&str> = s.rsplit(')').next().unwrap().split_whitespace().collect();
    (v[11].parse::<f64>().unwrap() + v[12].parse::<f64>().unwrap()) / 100.0
}
fn read(p: &str) -> Vec<[f32; 3]> {
    let v: Vec<f32> = npyz::NpyFile::new(std::fs::File::open(p).unwrap()).unwrap().into_vec().unwrap();
    v.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect()
}
fn main() {
    let d = "/work/shared/reference/delft1/";
    let (c, n) = (read(&format!("{d}coords.npy")), read(&format!("{d}normals.npy")));
    let t = cpu();
    let index = NeighborIndex::new(&c).unwrap();
    println!("index {:.2}", cpu() - t);
    let t = cpu();
    let e =
        belvedere::normals::estimate::estimate(&c, &index, belvedere::normals::estimate::Neighborhood::Fixed { k: 10 })
            .unwrap();
    println!("normals {:.2} {}", cpu() - t, e.quality[0]);
    let cloud = OrientedCloud::new(c, n);
    for p in
        [ShrinkParams::angles(), ShrinkParams { initial_radius: 50.0, ..ShrinkParams::angles() }, ShrinkParams::tau()]
    {
        for side in [Side::Interior, Side::Exterior] {
            let t = cpu();
            let (b, r) = shrink(&cloud, &index, side, &p, Progress::none()).unwrap();
            println!("{p:?} {side:?} {:.2} s {r:?}", cpu() - t);
            let mut rr: Vec<f32> = (0..b.len()).filter(|&i| b.touch[i] != NO_TOUCH).map(|i| b.radii[i]).collect();
            rr.sort_by(f32::total_cmp);
            println!("radii {:?}", [0.01, 0.1, 0.5, 0.9, 0.99, 1.0].map(|q| rr[((rr.len() - 1) as f64 * q) as usize]));
        }
    }
}
