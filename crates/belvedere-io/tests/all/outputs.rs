//! Files appear whole or not at all, and writers get the same bytes as files.

use std::cell::RefCell;
use std::fs::File;
use std::io::{Cursor, Write};
use std::path::Path;
use std::time::{Duration, SystemTime};

use belvedere_data::crs::Crs;
use belvedere_data::raster::Raster;
use belvedere_data::result_columns::ResultColumn;
use belvedere_data::{Error, Mesh, PointCloud};
use belvedere_io::{
    Georeference, MasbcppFolder, Output, atomic, write_cloud, write_masbcpp, write_mesh, write_npy_f32_2d, write_table,
    write_tif_f32,
};

fn names_in(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        folder.read_dir().unwrap().map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// Returns the bytes that `write` gives to a writer, after checking that a file of the same name gets the same.
fn written(name: &str, write: impl Fn(Output<'_>) -> belvedere_data::Result<()>) -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    write(Output::path(&path)).unwrap();
    let mut cursor = Cursor::new(Vec::new());
    write(Output::writer(name, &mut cursor)).unwrap();
    assert_eq!(cursor.get_ref(), &std::fs::read(&path).unwrap(), "{name}");
    assert_eq!(names_in(folder.path()), [name], "nothing else is left in the folder");
    cursor.into_inner()
}

#[test]
fn writers_get_the_bytes_of_files() {
    let (cloud, _) = PointCloud::from_coordinates(&[[1.0, 2.0, 3.0], [4.0, 5.5, 6.0], [7.0, 8.0, 9.0]]);
    for name in ["a.las", "a.laz", "a.ply", "a.csv", "a.xyz", "a.npy"] {
        assert!(!written(name, |output| write_cloud(output, &cloud, &[]).map(|_| ())).is_empty());
    }
    let mesh = Mesh { vertices: cloud.positions.iter().map(|p| p.map(f64::from)).collect(), ..Mesh::default() };
    let mesh = Mesh { triangles: vec![[0, 1, 2]], ..mesh };
    for name in ["a.obj", "b.ply"] {
        written(name, |output| write_mesh(output, &mesh, [1.0; 3]));
    }
    let raster = Raster::from_values(3, 2, vec![1.0, 2.0, 3.0, 4.0, 5.0, f32::NAN]).unwrap();
    let place = Georeference {
        upper_left: [155_000.0, 463_002.0],
        column_step: [1.0, 0.0],
        row_step: [0.0, -1.0],
        crs: Crs::parse("EPSG:28992").unwrap(),
    };
    written("a.tif", |output| write_tif_f32(output, &raster, Some(&place), Some(-9999.0), None));
    written("r.npy", |output| write_npy_f32_2d(output, &raster));
    let table = written("t.csv", |output| write_table(output, &[ResultColumn::real("x", [1.25, f64::NAN], 2)]));
    assert_eq!(table, b"x\n1.25\n\n");
}

#[test]
fn a_cancelled_output_leaves_what_was_there() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("result.csv");
    std::fs::write(&path, "before").unwrap();
    let cancelled = atomic::write(&path, |file| {
        file.write_all(&[0; 1 << 20]).map_err(Error::io(&path))?;
        // the process is part of the name: another program that writes the same result is not disturbed
        let own = format!("{}", std::process::id());
        assert!(names_in(folder.path()).iter().any(|name| name.contains(&own)), "{:?}", names_in(folder.path()));
        Err::<(), Error>(Error::Cancelled)
    });
    assert!(matches!(cancelled, Err(Error::Cancelled)));
    assert_eq!(
        (names_in(folder.path()), std::fs::read(&path).unwrap()),
        (vec!["result.csv".to_owned()], b"before".into())
    );
}

#[cfg(target_os = "linux")]
#[test]
fn files_that_killed_runs_left_are_removed_and_those_of_others_are_not() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("result.csv");
    // the name of an unfinished file of this process says what its host is called
    let name = RefCell::new(String::new());
    atomic::write(&path, |_| {
        *name.borrow_mut() = names_in(folder.path()).remove(0);
        Ok(())
    })
    .unwrap();
    std::fs::remove_file(&path).unwrap();
    let name = name.into_inner();
    let host = name.strip_prefix(".result.csv.").unwrap().split('-').next().unwrap().to_owned();
    // beyond the largest number of a process
    let (dead, own) = (4_194_305, std::process::id());
    let write = |name: &str, age_hours: u64| {
        let path = folder.path().join(name);
        std::fs::write(&path, "unfinished").unwrap();
        let then = SystemTime::now() - Duration::from_secs(age_hours * 3600);
        File::options().write(true).open(&path).unwrap().set_modified(then).unwrap();
    };
    let kept = [
        format!(".result.csv.{host}-{own}-9.part"),
        format!(".other.csv.{host}-{dead}-0.part"),
        ".result.csv.old-0.part".to_owned(),
        format!(".result.csv.{host}-{dead}-0.part.txt"),
        // of another computer or container, whose processes are not seen here
        format!(".result.csv.0123456789ab4026531836-{dead}-0.part"),
    ];
    kept.iter().for_each(|name| write(name, 20));
    let mut expected = kept.to_vec();
    for name in [format!(".result.csv.{host}-{dead}-0.part"), format!(".result.csv.{host}-{dead}-12.part")] {
        write(&name, 0);
    }
    // nobody has written to it since long ago
    write(&format!(".result.csv.0123456789ab4026531836-{own}-1.part"), 25);
    // of others, however old: no name that the program gives
    for name in [".result.csv.2024-11-28.part", ".result.csv.2024-11.part", ".result.csv.0-1-2-3.part"] {
        write(name, 25);
        expected.push(name.to_owned());
    }
    write_table(path.as_path(), &[ResultColumn::real("x", [1.0], 1)]).unwrap();
    expected.push("result.csv".to_owned());
    expected.sort();
    assert_eq!(names_in(folder.path()), expected);
}

#[test]
fn a_folder_of_arrays_that_cannot_be_written_is_as_it_was() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("balls");
    let arrays = MasbcppFolder { coords: Some(&[[1.0; 3]]), ma_qidx_in: Some(&[0]), ..MasbcppFolder::default() };
    // a folder in the place of the last array
    std::fs::create_dir_all(path.join("ma_qidx_in.npy")).unwrap();
    std::fs::write(path.join("notes.txt"), "ours").unwrap();
    assert!(write_masbcpp(&path, &arrays).is_err());
    assert_eq!(names_in(&path), ["ma_qidx_in.npy", "notes.txt"]);
    std::fs::remove_dir(path.join("ma_qidx_in.npy")).unwrap();
    write_masbcpp(&path, &arrays).unwrap();
    assert_eq!(names_in(&path), ["coords.npy", "ma_qidx_in.npy", "notes.txt"]);
}
