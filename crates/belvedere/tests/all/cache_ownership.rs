//! A cache removes what it made itself, and nothing else, whatever lies in its folder.

use belvedere::PointCloud;
use belvedere::cache::{CloudKey, ReadBefore, SceneCache, SurveyFolder};
use belvedere::io::ReadOptions;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

const KEY: &str = "0123456789abcdef0123456789abcdef";
const OTHER_KEY: &str = "fedcba98765432100123456789abcdef";

/// A stream of pseudo-random numbers (Knuth's MMIX generator).
struct Random(u64);

impl Random {
    fn below(&mut self, count: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) as usize) % count
    }

    fn is_lucky(&mut self) -> bool {
        self.below(2) == 0
    }

    fn one<'a>(&mut self, of: &[&'a str]) -> &'a str {
        of[self.below(of.len())]
    }
}

/// All files below a folder with their bytes, and links with where they point.
fn contents(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    for row in fs::read_dir(folder).into_iter().flatten() {
        let path = row.unwrap().path();
        let kind = path.symlink_metadata().unwrap();
        if kind.is_symlink() {
            found.insert(path.clone(), fs::read_link(&path).unwrap().to_string_lossy().as_bytes().to_vec());
        } else if kind.is_dir() {
            found.extend(contents(&path));
        } else {
            found.insert(path.clone(), fs::read(&path).unwrap());
        }
    }
    found
}

fn write(path: &Path, text: &str) {
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    if !path.exists() {
        fs::write(path, text).unwrap();
    }
}

/// Writes files of a user into a folder: some with names that are nearly those of the program.
fn add_files_of_others(folder: &Path, random: &mut Random) {
    let names = [
        "notes.txt",
        "anything_scene.npz",
        "scene.npz",
        ".scene.npz",
        "0123.scene.npz",
        "0123456789ABCDEF0123456789ABCDEF.scene.npz",
        "0123456789abcdef0123456789abcdef.scene.npz.bak",
        "0123456789abcdef0123456789abcdef-ground.npz",
        "tiles/notes.txt",
        "tiles/run/plan.json",
        "tiles/run/balls/e1_n2.npz",
        "tiles/run/shadow/e1_n2.tif",
        "tiles/0123456789abcdef0123456789abcdef/plan.json",
        "tiles/0123456789abcdef0123456789abcdef/CACHEDIR.TAG",
        "tiles/0123456789abcdef0123456789abcdef/0a1b2c3d/balls/e1_n2.npz",
        "plan.json",
        "report.md",
        "balls/e1_n2.json",
        ".result.tif.2024-11-28.part",
    ];
    for _ in 0..=random.below(8) {
        write(&folder.join(random.one(&names)), "mine");
    }
}

/// Writes files of a user between those of a survey.
fn add_files_beside_tiles(survey: &Path, random: &mut Random) -> Vec<PathBuf> {
    let names = [
        "notes.txt",
        "0a1b2c3d/notes.txt",
        "0a1b2c3d/balls/e1_n2.laz",
        "0a1b2c3d/balls/e01_n2.npz",
        "0a1b2c3d/balls/photos/e1_n2.npz",
        "0a1b2c3d/11112222/best.vrt",
        "0a1b2c3d/11112222/shadow/e1_n2.tif.aux.xml",
        "0a1b2c3d/11112222/shadow/summary.json",
        "0a1b2c3d/ground/heights.npz",
        "photos/plan.json",
        "0A1B2C3D/balls/e1_n2.npz",
    ];
    let chosen: Vec<PathBuf> = (0..random.below(5)).map(|_| survey.join(random.one(&names))).collect();
    chosen.iter().for_each(|path| write(path, "mine"));
    chosen
}

/// Writes what a run in tiles writes.
fn add_tiles(survey: &Path) {
    for name in [
        "plan.json",
        "0a1b2c3d/balls/e1_n2.npz",
        "0a1b2c3d/balls/e-1_n2.pulses.npz",
        "0a1b2c3d/balls/e1_n2.json",
        "0a1b2c3d/balls/.e1_n3.npz.0123456789ab4026531836-77-0.part",
        "0a1b2c3d/ground/00ff00ff.npz",
        "0a1b2c3d/11112222/plan.json",
        "0a1b2c3d/11112222/report.md",
        "0a1b2c3d/11112222/shadow/e1_n2.tif",
        "0a1b2c3d/11112222/shadow/e1_n2.json",
        "0a1b2c3d/11112222/shadow.vrt",
    ] {
        write(&survey.join(name), "own");
    }
}

/// Keeps something in a cache; says whether it could.
fn keep(cache: &SceneCache, file: &Path) -> bool {
    let cloud = PointCloud { positions: vec![[1.0, 2.0, 3.0]], ..PointCloud::default() };
    let notes = serde_json::Map::new();
    let found = ReadBefore::new(CloudKey::of(&cloud), cloud.frame.clone(), notes);
    cache.keep_reading(&[file.to_owned()], &ReadOptions::default(), &found, None).is_ok()
}

#[test]
fn files_of_others_stay_in_500_random_folders() {
    let (mut kept, mut refused, mut files_of_others) = (0, 0, 0);
    for seed in 0..500 {
        let mut random = Random(seed);
        let place = tempfile::tempdir().unwrap();
        let folder = place.path().join("cache");
        let file = place.path().join("tile.xyz");
        fs::write(&file, "1 2 3\n").unwrap();
        let elsewhere = place.path().join("elsewhere");
        add_files_of_others(&elsewhere, &mut random);
        let is_new = random.is_lucky();
        if !is_new {
            add_files_of_others(&folder, &mut random);
        }
        let cache = SceneCache::new(&folder).with_max_bytes(1);
        let before = contents(place.path());
        let is_kept = keep(&cache, &file);
        assert_eq!(is_kept, is_new, "{seed}");
        assert_eq!(cache.remark().is_none(), is_new, "{seed}");
        let mut own = 0;
        if is_kept {
            kept += 1;
            // a link to what a user has, with the name of an entry or of the folder of tiles
            #[cfg(unix)]
            {
                let link = |name: String| drop(std::os::unix::fs::symlink(&elsewhere, folder.join(name)));
                link(format!("{OTHER_KEY}.scene.npz"));
                if random.is_lucky() {
                    link("tiles".to_owned());
                }
            }
            add_files_of_others(&folder, &mut random);
        } else {
            refused += 1;
        }
        let with_others = contents(place.path());
        let of_others: BTreeMap<_, _> = with_others
            .iter()
            .filter(|(path, bytes)| before.contains_key(*path) || bytes.as_slice() == b"mine" || path.is_symlink())
            .collect();
        files_of_others += of_others.len();
        let survey = cache.survey_folder(std::slice::from_ref(&file), &ReadOptions::default());
        if let Some(survey) = &survey {
            own += 1;
            add_tiles(survey.path());
            cache.make_room_beside(survey);
            assert!(survey.path().join("plan.json").exists() && survey.bytes() > 0, "{seed}");
        }
        if random.is_lucky() {
            keep(&cache, &file);
        }
        cache.clear().unwrap();
        let after = contents(place.path());
        for (path, bytes) in &of_others {
            assert_eq!(after.get(*path), Some(*bytes), "{seed}: {}", path.display());
        }
        assert!(own == 0 || is_kept, "{seed}");
        // what is left beside them is the mark
        let left: Vec<_> = after.keys().filter(|path| !of_others.contains_key(path)).collect();
        assert!(left.iter().all(|path| path.ends_with("CACHEDIR.TAG")) && left.len() <= 1, "{seed}: {left:?}");
    }
    assert!(kept > 150 && refused > 150 && files_of_others > 2000, "{kept} {refused} {files_of_others}");
}

#[test]
fn files_of_others_stay_in_500_random_folders_of_tiles() {
    let mut with_others = 0;
    for seed in 0..500 {
        let mut random = Random(seed);
        let place = tempfile::tempdir().unwrap();
        let folder = place.path().join("out.tiles");
        if random.below(4) == 0 {
            // a run of a user, with a plan of the same files
            add_tiles(&folder);
            add_files_of_others(&folder, &mut random);
            let before = contents(place.path());
            assert!(SurveyFolder::make(&folder).is_err(), "{seed}");
            assert_eq!(contents(place.path()), before, "{seed}");
            continue;
        }
        let survey = SurveyFolder::make(&folder).unwrap();
        add_tiles(&folder);
        let others = add_files_beside_tiles(&folder, &mut random);
        // a run that was stopped goes on
        SurveyFolder::make(&folder).unwrap();
        survey.remove();
        let left = contents(place.path());
        let of_others: Vec<_> = left.keys().filter(|path| !path.ends_with("CACHEDIR.TAG")).cloned().collect();
        let expected: std::collections::BTreeSet<PathBuf> = others.into_iter().collect();
        assert_eq!(of_others, expected.iter().cloned().collect::<Vec<_>>(), "{seed}");
        assert_eq!(folder.exists(), !expected.is_empty(), "{seed}");
        with_others += usize::from(!expected.is_empty());
    }
    assert!(with_others > 100, "{with_others}");
}

#[test]
fn a_folder_behind_a_link_is_never_emptied() {
    let place = tempfile::tempdir().unwrap();
    let own = place.path().join("own");
    SurveyFolder::make(&own).unwrap();
    add_tiles(&own);
    let before = contents(&own);
    #[cfg(unix)]
    {
        let link = place.path().join("out.tiles");
        std::os::unix::fs::symlink(&own, &link).unwrap();
        assert!(SurveyFolder::make(&link).is_err());
        let cache = SceneCache::new(place.path().join("cache"));
        let file = place.path().join("tile.xyz");
        fs::write(&file, "1 2 3\n").unwrap();
        assert!(keep(&cache, &file));
        let tiles = cache.folder().join("tiles");
        fs::create_dir(&tiles).unwrap();
        std::os::unix::fs::symlink(&own, tiles.join(KEY)).unwrap();
        cache.clear().unwrap();
    }
    assert_eq!(contents(&own), before);
}

#[cfg(unix)]
#[test]
fn folders_of_a_cache_are_for_their_user_alone() {
    use std::os::unix::fs::PermissionsExt;
    let place = tempfile::tempdir().unwrap();
    let file = place.path().join("tile.xyz");
    fs::write(&file, "1 2 3\n").unwrap();
    let cache = SceneCache::new(place.path().join("made/when/needed"));
    assert!(keep(&cache, &file));
    let survey = cache.survey_folder(&[file], &ReadOptions::default()).unwrap();
    for folder in [cache.folder(), &cache.folder().join("tiles"), survey.path()] {
        assert_eq!(fs::metadata(folder).unwrap().permissions().mode() & 0o777, 0o700, "{}", folder.display());
    }
}

#[cfg(unix)]
#[test]
fn a_pipe_with_the_name_of_an_entry_is_passed_over() {
    let place = tempfile::tempdir().unwrap();
    let file = place.path().join("tile.xyz");
    fs::write(&file, "1 2 3\n").unwrap();
    let cache = SceneCache::new(place.path().join("cache"));
    assert!(keep(&cache, &file));
    let row = fs::read_dir(cache.folder()).unwrap().map(|row| row.unwrap().path());
    let entry = row.into_iter().find(|path| path.to_string_lossy().ends_with("reading.npz")).unwrap();
    fs::remove_file(&entry).unwrap();
    assert!(std::process::Command::new("mkfifo").arg(&entry).status().unwrap().success());
    // nobody writes into it: who opened it would wait for ever
    assert!(cache.read_before(std::slice::from_ref(&file), &ReadOptions::default()).is_none());
    assert!(!keep(&cache, &file));
    assert!(cache.entries().unwrap().is_empty() && cache.clear().unwrap() == 0);
    assert!(entry.exists());
}
