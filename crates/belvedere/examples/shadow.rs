//! The shadow on a tile at an instant, as a raster: `cargo run --release --example shadow -- TILE.laz EPSG:7415
//! shadow.tif`.

use belvedere::prelude::*;
use std::sync::Arc;

fn main() -> Result<()> {
    let [tile, crs, output] = std::array::from_fn(|i| std::env::args().nth(i + 1).unwrap_or_default());
    let control = Control::none();
    let (cloud, _) = read_cloud([tile.as_str()], &ReadOptions::new().with_crs(crs), &control)?;
    let (model, _) = SceneModel::build(&cloud, &ModelParams::default(), &control)?;
    let scene = Scene::new(model, Arc::new(cloud));
    let question = ShadowQuestion::of_times(vec!["2026-06-21T15:00".to_owned()]);
    let answers = ask(&scene, &question, &Places::Cells(GridCells::default()), &control)?;
    answers.headline.iter().for_each(|line| eprintln!("{line}"));
    answers.remarks.iter().for_each(|remark| eprintln!("{}", remark.text));
    let bands: Vec<&Measure> = answers.measures.iter().collect();
    write_raster(output.as_ref(), &answers.found.on.targets, &bands, &[])
}
