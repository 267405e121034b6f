//! A host in Rust, which compares the data at the border with the engine itself.

use super::{HostFile, ask, build, give, open, scene_file, take};
use crate::engine::{Engine, Host, OpenRequest, OpenedFile};
use belvedere::cast::to_index;
use belvedere::control::Control;
use belvedere_viewer::ReadingChoice;
use serde_json::json;
use std::cell::RefCell;
use std::io::{Cursor, Read, Seek, SeekFrom};
use std::sync::Mutex;

/// Files of the host, by their number.
static FILES: Mutex<Vec<Vec<u8>>> = Mutex::new(Vec::new());
/// Bytes of room behind the requested ones, which a host must not touch.
const GUARD: usize = 64;

thread_local! {
    static REPLY: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
}

/// Reads bytes of a file. For the file with the highest number the host gives fewer bytes than requested, for the
/// others all there are.
///
/// # Safety
/// There is room for `length` bytes.
pub(super) unsafe fn read(id: u32, at: f64, to: *mut u8, length: usize) -> i32 {
    let files = FILES.lock().unwrap();
    let Some(rest) = files.get(id as usize).and_then(|file| file.get(to_index(at)..)) else { return -1 };
    let count = rest.len().min(length);
    let count = if id as usize + 1 == files.len() { count.div_ceil(3) } else { count };
    // SAFETY: as promised
    unsafe { std::ptr::copy_nonoverlapping(rest.as_ptr(), to, count) };
    i32::try_from(count).unwrap()
}

/// # Safety
/// There are `length` bytes.
pub(super) unsafe fn reply(from: *const u8, length: usize) {
    // SAFETY: as promised
    let bytes = unsafe { std::slice::from_raw_parts(from, length) };
    REPLY.set(bytes.to_vec());
}

pub(super) unsafe fn stage(_from: *const u8, _length: usize, _total: f64) {}
pub(super) unsafe fn tick() {}
pub(super) unsafe fn failed(_from: *const u8, _length: usize) {}
pub(super) unsafe fn spawn(_builder: usize) {}

/// Calls an export with bytes, as JavaScript does: the status, and the reply.
fn called(export: unsafe extern "C" fn(*const u8, usize) -> u32, given: &[u8]) -> (u32, Vec<u8>) {
    let at = take(given.len());
    // SAFETY: the room is as long as what is given, and goes back with its length
    let status = unsafe {
        std::ptr::copy_nonoverlapping(given.as_ptr(), at, given.len());
        let status = export(at, given.len());
        give(at, given.len());
        status
    };
    (status, REPLY.take())
}

/// The same files without a border.
struct InMemory(Vec<Vec<u8>>);

impl Host for InMemory {
    type File = Cursor<Vec<u8>>;
    fn open(&self, file: &OpenedFile) -> Self::File {
        Cursor::new(self.0[file.id as usize].clone())
    }
    fn begin(&self, _stage: &'static str, _total: usize) {}
    fn advance(&self, _count: usize) {}
}

fn floor() -> Vec<u8> {
    let rows = (0..1600).map(|i| {
        let (x, y) = (f64::from(i % 40) * 0.25, f64::from(i / 40) * 0.25);
        let is_block = (4.0..6.0).contains(&x) && (4.0..6.0).contains(&y);
        format!("{x:.2} {:.2} {}\n", y + 0.01 * f64::from(i % 3), if is_block { 3 } else { 0 })
    });
    std::iter::once("x y z\n".to_owned()).chain(rows).collect::<String>().into_bytes()
}

#[test]
fn files_read_through_the_border_are_those_read_without_it() {
    let content: Vec<u8> = (0..5000_u32).map(|i| (i * 7 % 251) as u8).collect();
    // two of them, of which the host gives the last one in small parts
    let files = vec![content.clone(), content.clone()];
    *FILES.lock().unwrap() = files;
    let mut number = 1_u64;
    let mut random = |below: u64| {
        number = number.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (number >> 33) % below
    };
    for id in [0, 1] {
        let (mut own, mut twin) = (HostFile { id, size: 5000, at: 0 }, Cursor::new(&content));
        for _ in 0..2000 {
            let to = match random(4) {
                0 => SeekFrom::Start(random(6000)),
                1 => SeekFrom::End(-(random(6000) as i64)),
                2 => SeekFrom::Current(random(4000) as i64 - 2000),
                _ => SeekFrom::Current(0),
            };
            assert_eq!(own.seek(to).ok(), twin.seek(to).ok(), "{to:?}");
            let length = usize::try_from(random(700)).unwrap();
            let mut found = vec![0xEE; length + GUARD];
            let count = own.read(&mut found[..length]).unwrap();
            let mut expected = vec![0xEE; length + GUARD];
            // a reader may give fewer bytes
            twin.read_exact(&mut expected[..count]).unwrap();
            assert!(found == expected, "{id} {length}");
        }
    }
    // a file that is shorter than announced, or gone, is an error
    let mut gone = HostFile { id: 7, size: 10, at: 0 };
    assert!(gone.read(&mut [0; 4]).is_err());
    let mut shorter = HostFile { id: 0, size: 9000, at: 6000 };
    assert!(shorter.read(&mut [0; 4]).is_err());

    let file = || OpenedFile { name: "floor.xyz".to_owned(), id: 0, size: floor().len() as u64 };
    *FILES.lock().unwrap() = vec![floor(), Vec::new()];
    let host = InMemory(vec![floor()]);
    let request =
        OpenRequest { files: vec![file()], reading: ReadingChoice::default(), window: None, max_points: 10_000 };
    let mut twin = Engine::open(&request, &host).unwrap();
    let wanted = json!({ "files": [{ "name": "floor.xyz", "id": 0, "size": floor().len() }], "max_points": 10_000 });
    let state = |bytes: &[u8]| serde_json::from_slice::<serde_json::Value>(bytes).unwrap();
    let (status, reply) = called(open, wanted.to_string().as_bytes());
    assert_eq!((status, state(&reply)), (0, state(&twin.session().state())));
    assert_eq!(build(), 0);
    twin.build(&host).unwrap();
    assert_eq!(scene_file(), 0);
    assert!(REPLY.take() == twin.session().scene_file().unwrap());
    let question = json!({ "observer": [1.0, 5.0, 1.0], "target": [9.0, 5.0, 1.0] }).to_string();
    let path = "ask/line";
    // SAFETY: both texts live during the call
    let status = unsafe { ask(path.as_ptr(), path.len(), question.as_ptr(), question.len()) };
    let expected = twin.session().ask(path, question.as_bytes(), &Control::none()).unwrap();
    assert!(status == 0 && REPLY.take() == expected);
    let (status, refused) = called(open, b"{");
    assert!(status == 1 && String::from_utf8(refused).unwrap().contains("cannot be read"));
}
