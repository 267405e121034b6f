//! The same input and seed give the same bytes, whatever the number of threads.

use crate::common::{Workplace, house};

#[test]
fn outputs_have_the_same_bytes_for_any_number_of_threads() {
    let place = Workplace::with_house();
    place.write_folder("folder", &house());
    let folder =
        ["ma_coords_in.npy", "ma_coords_out.npy", "ma_qidx_in.npy", "ma_qidx_out.npy", "lfs.npy", "decimate_lfs.npy"];
    let mut first: Vec<(String, Vec<u8>)> = Vec::new();
    for threads in [1, 2, 7] {
        let run = |arguments: &str| place.summary(&format!("{arguments} --threads {threads}"));
        run("balls house.laz -o balls.npz");
        run("balls house.laz --orient up -o balls.laz");
        run("balls folder --simplify 0.4 -o folder");
        run("normals house.laz --neighbors adaptive -o normals.laz");
        run("depth-map house.laz --sun 160,35 -o depth.tif --ball-ids ids.npy");
        run("depth-map house.laz --sun 160,35 -o depth.png");
        run("query house.laz --sun 160,35 --self -o self.laz");
        run("query house.laz --sun 160,35 --random 20000 -o random.csv");
        run("query house.laz --sun 160,35 --random 20000 --ball-profile paper-cone -o random.npy");
        let outputs = [
            "balls.npz",
            "balls.laz",
            "normals.laz",
            "depth.tif",
            "ids.npy",
            "depth.png",
            "self.laz",
            "random.csv",
            "random.npy",
        ];
        let names = outputs.iter().map(|n| (*n).to_owned()).chain(folder.iter().map(|n| format!("folder/{n}")));
        let now: Vec<(String, Vec<u8>)> = names.map(|name| (name.clone(), place.bytes(&name))).collect();
        if first.is_empty() {
            first = now;
            continue;
        }
        for ((name, expected), (_, found)) in first.iter().zip(&now) {
            assert!(expected == found, "{name} differs between 1 and {threads} threads");
        }
    }
}

#[test]
fn outputs_have_the_same_bytes_without_avx2() {
    let place = Workplace::with_house();
    let run = |arguments: &str, avx2: &str| {
        let output = place.command(arguments).env("BELVEDERE_AVX2", avx2).output().unwrap();
        assert!(output.status.success(), "{arguments}: {output:?}");
    };
    for (arguments, name) in [
        ("balls house.laz", "balls.npz"),
        ("normals house.laz", "normals.laz"),
        ("shadow house.laz --sun 160,35 --cell 0.5", "shadow.tif"),
        ("sky-view house.laz --directions 49 --cell 1", "sky.tif"),
        ("query house.laz --sun 160,35 --random 20000", "random.csv"),
        ("viewshed house.laz --observer 85000,445988 --cell 0.5", "seen.tif"),
    ] {
        run(&format!("{arguments} -o on_{name}"), "on");
        run(&format!("{arguments} -o off_{name}"), "off");
        assert!(place.bytes(&format!("on_{name}")) == place.bytes(&format!("off_{name}")), "{name} differs");
    }
    let output = place.command("info house.laz").env("BELVEDERE_AVX2", "maybe").output().unwrap();
    let message = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(message.contains("BELVEDERE_AVX2") && message.contains("on or off"), "{message}");
}

#[test]
fn another_seed_gives_other_random_targets_and_the_same_seed_the_same() {
    let place = Workplace::with_house();
    for (seed, name) in [("1", "a.csv"), ("2", "b.csv"), ("2", "c.csv")] {
        place.summary(&format!("query house.laz --sun 160,35 --random 1000 --seed {seed} -o {name}"));
    }
    place.summary("query house.laz --sun 160,35 --random 1000 -o default.csv");
    assert_ne!(place.text("a.csv"), place.text("b.csv"));
    assert_eq!(place.text("b.csv"), place.text("c.csv"));
    assert_eq!(place.text("a.csv"), place.text("default.csv"), "the seed is 1 unless given");
    assert_eq!(place.text("a.csv").lines().count(), 1001, "a header and a row per target");
}
