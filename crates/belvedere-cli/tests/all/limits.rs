//! Options are checked before anything is read, and what would fill the memory or take hours is refused.

use crate::common::{EAST, NORTH, Workplace};

#[test]
fn options_are_refused_before_a_cloud_is_read() {
    let place = Workplace::new();
    // whoever reads it says so
    place.write("junk.laz", "no point cloud");
    place.write("many.csv", format!("x,y\n{}", "1,2\n".repeat(65_535)));
    place.write("some.csv", format!("x,y\n{}", "1,2\n".repeat(40)));
    place.write("mesh.obj", "v 0 0 0\n");
    for (arguments, words) in [
        ("info junk.laz --threads 100000", ["--threads", "1 to 1024"]),
        ("query junk.laz --sun 180,30 --random 1000000000 -o o.csv", ["--random", "1 to 50000000"]),
        ("line-of-sight junk.laz --random 1000000000 -o o.csv", ["--random", "1 to 10000000"]),
        ("viewshed junk.laz --observer 1,2 --target-height -1 -o o.tif", ["--target-height", "0 metres or more"]),
        ("viewshed junk.laz --observer 1,2 --observer-height nan -o o.tif", ["--observer-height", "0 metres or more"]),
        ("viewshed junk.laz --target 1,2 --observer-height=-inf -o o.tif", ["--observer-height", "0 metres or more"]),
        (
            "line-of-sight junk.laz --pairs some.csv --target-height inf -o o.csv",
            ["--target-height", "0 metres or more"],
        ),
        (
            "line-of-sight junk.laz --pairs some.csv --observer-height -0.1 -o o.csv",
            ["--observer-height", "0 metres or more"],
        ),
        ("horizon junk.laz --observer 1,2 --observer-height -3 -o o.csv", ["--observer-height", "0 metres or more"]),
        ("isovist junk.laz --observer 1,2 --observer-height nan -o o.csv", ["--observer-height", "0 metres or more"]),
        (
            "landmark junk.laz --targets mesh.obj --observer-height -3 -o o.csv",
            ["--observer-height", "0 metres or more"],
        ),
        (
            "cameras junk.laz --candidates some.csv --count 1 --camera-height -3 -o o.csv",
            ["--camera-height", "0 metres or more"],
        ),
        (
            "cameras junk.laz --candidates some.csv --count 1 --target-height nan -o o.csv",
            ["--target-height", "0 metres or more"],
        ),
        ("city plan junk.laz -o o --observer 1,2 --observer-height -1", ["--observer-height", "0 metres or more"]),
        ("comfort junk.laz --route 1,2 --target-height -1 -o o.csv", ["--target-height", "0 metres or more"]),
        (
            "envelope junk.laz --parcel 1,2 --protect 1,2 --fence-height -1 -o o.csv",
            ["--fence-height", "0 metres or more"],
        ),
        ("depth-map junk.laz --eye 1,1,1 --look-at 1,1,2 --size 1000000000x1 -o o.tif", ["--size", "65536 on a side"]),
        ("depth-map junk.laz --eye 1,1,1 --look-at 1,1,1 -o o.tif", ["--look-at", "point to look at"]),
        ("depth-map junk.laz --eye 1,1,1 --look-at 2,1,1 --fov 300 -o o.tif", ["--fov", "175"]),
        ("depth-map junk.laz --eye 1,1,1 --look-at 2,1,1 --near 5 --far 3 -o o.tif", ["--near", "near and far limit"]),
        ("depth-map junk.laz --sun 10,95 -o o.tif", ["--sun", "swapped"]),
        ("depth-map junk.laz --direction 0,0,0 -o o.tif", ["--direction", "0"]),
        ("query junk.laz --panorama 1,1,1 --size 100x100 --random 5 -o o.csv", ["--size", "twice as wide"]),
        ("query junk.laz --panorama 1,1,1 --ball-profile paper-cone --random 5 -o o.csv", ["--ball-profile", "cone"]),
        ("viewshed junk.laz --observer 1,1 --max-distance 5 --min-distance 10 -o o.tif", ["--max-distance", "5"]),
        ("viewshed junk.laz --observer 1,1 --elevation-range 50,20 -o o.tif", ["--elevation-range", "50"]),
        ("viewshed junk.laz --target 1,1 --azimuth-range 1,2 -o o.tif", ["--azimuth-range", "with a target"]),
        ("viewshed junk.laz --observer 1,1 --observer-height -0.01 -o o.tif", ["--observer-height", "0 metres"]),
        ("viewshed junk.laz --observers some.csv --masks o.tif -o p.tif", ["--masks", "40; use .npy"]),
        ("viewshed junk.laz --observers many.csv -o o.tif", ["65534", "65535"]),
        ("isovist junk.laz --observers some.csv -o o.png", ["o.png", "single observer"]),
        ("horizon junk.laz --observer 1,1 --observer 2,2 -o o.txt", ["o.txt", "single observer"]),
        ("irradiance junk.laz --clear-sky bird --location 200,10 -o o.tif", ["--location", "latitude"]),
    ] {
        let run = place.refusal(2, arguments, &words);
        assert!(!run.stderr.contains("junk.laz:"), "{arguments}: {}", run.stderr);
    }
    assert_eq!(place.names(), ["junk.laz", "many.csv", "mesh.obj", "some.csv"]);
}

#[test]
fn threads_of_the_environment_are_bounded_like_those_of_the_flag() {
    let place = Workplace::with_house();
    let run = |threads: &str| {
        let output = place.command("info house.laz").env("RAYON_NUM_THREADS", threads).output().unwrap();
        (output.status.code(), String::from_utf8(output.stderr).unwrap())
    };
    let (status, message) = run("2000");
    assert!(
        status == Some(2) && message.contains("RAYON_NUM_THREADS is 2000") && message.contains("1024"),
        "{message}"
    );
    assert_eq!(run("3").0, Some(0));
}

/// Refusals of the system end in a sentence, and no output is half written.
#[cfg(target_os = "linux")]
#[test]
fn limits_of_the_system_are_named() {
    let place = Workplace::with_house();
    let run = |limits: &str, arguments: &str| {
        let script = format!("{limits}; exec \"$BELVEDERE\" {arguments}");
        let mut shell = std::process::Command::new("bash");
        shell.args(["-c", &script]).current_dir(place.path("")).env("BELVEDERE", env!("CARGO_BIN_EXE_belvedere"));
        let output = shell.output().unwrap();
        (output.status.code(), String::from_utf8(output.stderr).unwrap())
    };
    // files of at most 8 kB, and memory for few threads
    let (status, message) = run("ulimit -f 8", "balls house.laz -o balls.npz");
    assert!(
        status == Some(1) && message.contains("balls.npz") && message.contains("ulimit -f"),
        "{status:?} {message}"
    );
    assert!(!message.contains("panicked") && message.lines().count() <= 3, "{message}");
    // a thread that begins while another is refused may find no memory either, and that ends the process at once
    let mut tries = (0..9).map(|_| run("ulimit -v 1500000", "balls house.laz -o balls.npz --threads 1000"));
    let is_ended =
        |message: &str| ["alternative stack", "memory allocation of"].iter().any(|end| message.contains(end));
    let (status, message) = tries.find(|(_, message)| !is_ended(message)).unwrap();
    assert!(status == Some(1) && message.contains("refuses 1000") && message.contains("--threads"), "{message}");
    assert!(!message.contains("panicked"), "{message}");
    assert_eq!(place.names(), ["house.laz"]);
}

#[test]
fn missing_files_are_reported_before_a_cloud_is_read() {
    let place = Workplace::new();
    place.write("junk.laz", "no point cloud");
    for (arguments, file) in [
        ("viewshed junk.laz --observers no.csv -o o.tif", "no.csv"),
        ("viewshed junk.laz --observer 1,1 --ground cloud=no.laz -o o.tif", "no.laz"),
        ("query junk.laz --sun 180,30 --targets no.csv -o o.csv", "no.csv"),
        ("line-of-sight junk.laz --pairs no.csv -o o.csv", "no.csv"),
        ("balls junk.laz --orient trajectory=no.txt -o o.npz", "no.txt"),
        ("balls junk.laz --orient mesh=no.obj -o o.npz", "no.obj"),
        ("envelope junk.laz --parcel no.geojson --protect no.geojson --date 2024-03-21 -o o.tif", "no.geojson"),
    ] {
        place.refusal(1, arguments, &[&format!("error: {file}: there is no such file")]);
    }
}

#[test]
fn grids_and_pictures_beyond_memory_are_refused_before_they_are_made() {
    let place = Workplace::with_house();
    place.summary("balls house.laz -o balls.npz");
    for (arguments, words) in [
        (format!("viewshed house.laz --observer {EAST},{NORTH} --cell 1e-3 -o o.tif"), ["--cell", "100 million"]),
        ("sky-view house.laz --cell 1e-3 -o o.tif".to_owned(), ["--cell", "100 million"]),
        ("shadow house.laz --sun 180,30 --cell 1e-3 -o o.tif".to_owned(), ["--cell", "100 million"]),
        ("depth-map balls.npz --sun 180,30 --pixel 1e-3 -o o.tif".to_owned(), ["--pixel", "268435456"]),
    ] {
        place.refusal(2, &arguments, &words);
    }
    assert_eq!(place.names(), ["balls.npz", "house.laz"]);
}
