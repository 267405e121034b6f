//! Plans, records and balls with any bytes are refused or read, and never end the program.

use crate::common::{SMALL, plan, suns};
use belvedere::control::Control;
use belvedere::io::{Source, read_balls};
use belvedere_tiles::{Plan, status, write_catalogue};

/// Numbers and other texts that a file may have in place of a number.
const ODD: [&str; 9] =
    ["-1", "0", "1e308", "9223372036854775807", "-9223372036854775808", "null", "[]", "\"\"", "1e-308"];

/// Endless random numbers that are the same each time.
struct Dice(u64);

impl Dice {
    fn below(&mut self, count: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        usize::try_from(self.0 >> 33).unwrap() % count.max(1)
    }
}

/// Returns the bytes with one change: a bit, a missing or doubled part, a cut end, or a number of a text.
fn changed(bytes: &[u8], dice: &mut Dice) -> Vec<u8> {
    let mut changed = bytes.to_vec();
    let (at, length) = (dice.below(bytes.len()), 1 + dice.below(40));
    let part = at..(at + length).min(bytes.len());
    match dice.below(6) {
        0 => changed[at] ^= 1 << dice.below(8),
        1 => changed.truncate(at),
        2 => drop(changed.drain(part)),
        3 => drop(changed.splice(at..at, bytes[part].to_vec())),
        _ => {
            let is_number = |byte: &u8| byte.is_ascii_digit() || b"-.e".contains(byte);
            let Some(first) = (at..bytes.len()).find(|&i| bytes[i].is_ascii_digit()) else { return changed };
            let end = (first..bytes.len()).find(|&i| !is_number(&bytes[i])).unwrap_or(bytes.len());
            changed.splice(first..end, ODD[dice.below(ODD.len())].bytes());
        }
    }
    changed
}

/// Corrects the checksum of the rest, so that the data behind it are tested too.
fn with_checksum(bytes: &[u8]) -> Vec<u8> {
    let Some((start, rest)) = bytes.split_at_checked(b"{'checksum':'01234567',".len()) else { return bytes.to_vec() };
    let sum = format!("{:08x}", crc32fast::hash(rest));
    [&start[..13], sum.as_bytes(), &start[21..], rest].concat()
}

#[test]
fn plans_records_and_balls_with_any_bytes_never_end_the_program() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path().join("run");
    let whole = plan(&SMALL.clouds, &folder, 64.0, suns()[1..2].to_vec());
    SMALL.run(&whole, &folder, None);
    let mut dice = Dice(17);
    let path = folder.join("plan.json");
    let bytes = std::fs::read(&path).unwrap();
    let mut read = 0;
    for _ in 0..1000 {
        std::fs::write(&path, with_checksum(&changed(&bytes, &mut dice))).unwrap();
        if let Ok(plan) = Plan::read(&folder) {
            read += 1;
            let _ = (plan.estimate(), plan.bounds(), plan.frame(), status(&plan, &folder).is_complete());
            // Each catalogue is flushed to the disk, which takes time.
            for question in plan.questions.iter().filter(|_| read % 20 == 0) {
                let _ = write_catalogue(&plan, place.path(), question, &Control::none());
            }
        }
    }
    assert!((10..950).contains(&read), "{read}");
    std::fs::write(&path, &bytes).unwrap();
    let tile =
        whole.tiles.iter().map(|tile| tile.name()).find(|name| folder.join(format!("balls/{name}.npz")).exists());
    let record = folder.join(format!("balls/{}.json", tile.clone().unwrap()));
    let bytes = std::fs::read(&record).unwrap();
    for _ in 0..500 {
        std::fs::write(&record, with_checksum(&changed(&bytes, &mut dice))).unwrap();
        let _ = status(&whole, &folder);
    }
    let bytes = std::fs::read(folder.join(format!("balls/{}.npz", tile.unwrap()))).unwrap();
    for _ in 0..1000 {
        let _ = read_balls(Source::bytes("balls.npz", &changed(&bytes, &mut dice)));
    }
}
