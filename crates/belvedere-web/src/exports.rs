//! Border to JavaScript: exported and imported plain functions of numbers. The only `unsafe` of this crate.
//!
//! Texts and bytes are handed over as an address and a length. [`take`] gives room for incoming ones. Outgoing ones are
//! given to `reply` before the call returns. A call returns 0 after a reply, and 1 after a refusal, whose text is the
//! reply. One thread calls all of them, and it is none of the pool.
//!
//! Tests compile this file too, with a host in Rust, and compare it with [`Engine`], the same without `unsafe`.
#![expect(unsafe_code, reason = "the border to JavaScript")]
#![cfg_attr(test, allow(dead_code, reason = "tests start no threads and call what a file goes through"))]

#[cfg(test)]
mod twin;

use crate::engine::{Announced, Engine, Host, OpenRequest, OpenedFile, tiles_of};
use belvedere::control::Control;
use belvedere_viewer::Refusal;
use std::io::{Read, Seek, SeekFrom};
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Mutex, PoisonError};

#[cfg(test)]
use twin::{failed, read, reply, spawn, stage, tick};

#[cfg(not(test))]
#[link(wasm_import_module = "host")]
unsafe extern "C" {
    /// Reads at most `length` bytes of the file `id` from `at` on; returns how many, or -1.
    fn read(id: u32, at: f64, to: *mut u8, length: usize) -> i32;
    /// Takes a reply.
    fn reply(from: *const u8, length: usize);
    /// A stage has begun.
    fn stage(from: *const u8, length: usize, total: f64);
    /// The numbers at [`progress`] have changed, perhaps.
    fn tick();
    /// Takes the message of a panic.
    fn failed(from: *const u8, length: usize);
    /// Starts a thread, which calls [`run_thread`] with the address.
    fn spawn(builder: usize);
}

/// Items of the present stage that are done: read by JavaScript while this module computes.
static DONE: AtomicU32 = AtomicU32::new(0);
static ENGINE: Mutex<Option<Engine>> = Mutex::new(None);

struct Browser;

/// A file of the host.
struct HostFile {
    id: u32,
    size: u64,
    at: u64,
}

impl Host for Browser {
    type File = HostFile;
    fn open(&self, file: &OpenedFile) -> HostFile {
        HostFile { id: file.id, size: file.size, at: 0 }
    }
    fn begin(&self, name: &'static str, total: usize) {
        DONE.store(0, Ordering::Relaxed);
        // SAFETY: the text lives during the call
        unsafe { stage(name.as_ptr(), name.len(), total as f64) };
    }
    fn advance(&self, count: usize) {
        DONE.fetch_add(u32::try_from(count).unwrap_or(u32::MAX), Ordering::Relaxed);
        // SAFETY: takes nothing
        unsafe { tick() };
    }
}

impl Read for HostFile {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let left = usize::try_from(self.size.saturating_sub(self.at)).unwrap_or(usize::MAX);
        let length = buffer.len().min(left).min(i32::MAX as usize);
        if length == 0 {
            return Ok(0);
        }
        // SAFETY: the host writes no more than `length` bytes there
        let count = unsafe { read(self.id, self.at as f64, buffer.as_mut_ptr(), length) };
        let count = usize::try_from(count).map_err(|_| std::io::Error::other("the file cannot be read any more"))?;
        let count = count.min(length);
        self.at += count as u64;
        Ok(count)
    }
}

impl Seek for HostFile {
    fn seek(&mut self, to: SeekFrom) -> std::io::Result<u64> {
        let (from, by) = match to {
            SeekFrom::Start(at) => (at, 0),
            SeekFrom::End(by) => (self.size, by),
            SeekFrom::Current(by) => (self.at, by),
        };
        self.at = from.checked_add_signed(by).ok_or_else(|| std::io::Error::other("before the start of the file"))?;
        Ok(self.at)
    }
}

/// Returns the bytes that JavaScript wrote.
///
/// # Safety
/// `length` bytes from `from` on were given by [`take`] and written to.
unsafe fn written_bytes<'a>(from: *const u8, length: usize) -> &'a [u8] {
    // SAFETY: as promised
    unsafe { std::slice::from_raw_parts(from, length) }
}

fn answered(answer: Result<Vec<u8>, Refusal>) -> u32 {
    let (status, bytes) = match answer {
        Ok(bytes) => (0, bytes),
        Err(refusal) => (1, refusal.to_string().into_bytes()),
    };
    // SAFETY: the bytes live during the call
    unsafe { reply(bytes.as_ptr(), bytes.len()) };
    status
}

fn with_engine(work: impl FnOnce(&mut Engine) -> Result<Vec<u8>, Refusal>) -> u32 {
    let mut engine = ENGINE.lock().unwrap_or_else(PoisonError::into_inner);
    answered(engine.as_mut().map_or(Err(Refusal::NotReady), work))
}

fn parsed<T: serde::de::DeserializeOwned>(bytes: &[u8]) -> Result<T, Refusal> {
    serde_json::from_slice(bytes).map_err(|error| Refusal::from(format!("the request cannot be read: {error}")))
}

/// Room for so many bytes.
#[cfg_attr(target_family = "wasm", unsafe(no_mangle))]
extern "C" fn take(length: usize) -> *mut u8 {
    let mut room = Vec::<u8>::with_capacity(length.max(1));
    let at = room.as_mut_ptr();
    std::mem::forget(room);
    at
}

/// Gives the room back.
///
/// # Safety
/// It is from [`take`] with the same length, and not used any more.
#[cfg_attr(target_family = "wasm", unsafe(no_mangle))]
unsafe extern "C" fn give(at: *mut u8, length: usize) {
    // SAFETY: as promised
    drop(unsafe { Vec::from_raw_parts(at, 0, length.max(1)) });
}

/// Called first: from then on `failed` gets the message of a panic.
#[cfg_attr(target_family = "wasm", unsafe(no_mangle))]
extern "C" fn start() {
    std::panic::set_hook(Box::new(|info| {
        let text = info.to_string();
        // SAFETY: the text lives during the call
        unsafe { failed(text.as_ptr(), text.len()) };
    }));
}

/// Address of the number of items done, 32 bits.
#[cfg_attr(target_family = "wasm", unsafe(no_mangle))]
extern "C" fn progress() -> *const u32 {
    DONE.as_ptr()
}

/// The reply is the announcement of the headers of files, an array of [`OpenedFile`]: an [`Announced`], or null.
///
/// # Safety
/// That of [`given`].
#[cfg_attr(target_family = "wasm", unsafe(no_mangle))]
unsafe extern "C" fn announced(from: *const u8, length: usize) -> u32 {
    // SAFETY: as promised
    let files = parsed::<Vec<OpenedFile>>(unsafe { written_bytes(from, length) });
    answered(files.map(|files| serde_json::json!(Announced::of(&files, &Browser)).to_string().into_bytes()))
}

/// The reply is the tiles of a catalogue, an [`OpenedFile`]: an array of [`Tile`](crate::engine::Tile).
///
/// # Safety
/// That of [`given`].
#[cfg_attr(target_family = "wasm", unsafe(no_mangle))]
unsafe extern "C" fn tiles(from: *const u8, length: usize) -> u32 {
    // SAFETY: as promised
    let tiles = parsed::<OpenedFile>(unsafe { written_bytes(from, length) }).and_then(|file| tiles_of(&file, &Browser));
    answered(tiles.map(|tiles| serde_json::json!(tiles).to_string().into_bytes()))
}

/// Reads the files of an [`OpenRequest`]; the reply is the state.
///
/// # Safety
/// That of [`given`].
#[cfg_attr(target_family = "wasm", unsafe(no_mangle))]
unsafe extern "C" fn open(from: *const u8, length: usize) -> u32 {
    // SAFETY: as promised
    let request = parsed::<OpenRequest>(unsafe { written_bytes(from, length) });
    let opened = request.and_then(|request| Engine::open(&request, &Browser));
    answered(opened.map(|engine| {
        let state = engine.session().state();
        *ENGINE.lock().unwrap_or_else(PoisonError::into_inner) = Some(engine);
        state
    }))
}

/// The reply is the name under which the scene of the files read can be kept.
#[cfg_attr(target_family = "wasm", unsafe(no_mangle))]
extern "C" fn scene_name() -> u32 {
    with_engine(|engine| Ok(engine.scene_name().unwrap_or_default().into_bytes()))
}

/// Builds the scene; the reply is the state.
#[cfg_attr(target_family = "wasm", unsafe(no_mangle))]
extern "C" fn build() -> u32 {
    with_engine(|engine| {
        engine.build(&Browser)?;
        Ok(engine.session().state())
    })
}

/// Takes the scene that was kept, an [`OpenedFile`]; the reply is the state.
///
/// # Safety
/// That of [`given`].
#[cfg_attr(target_family = "wasm", unsafe(no_mangle))]
unsafe extern "C" fn build_from(from: *const u8, length: usize) -> u32 {
    // SAFETY: as promised
    let kept = parsed::<OpenedFile>(unsafe { written_bytes(from, length) });
    with_engine(|engine| {
        engine.build_from(&kept?, &Browser)?;
        Ok(engine.session().state())
    })
}

/// The reply is the scene, to be kept.
#[cfg_attr(target_family = "wasm", unsafe(no_mangle))]
extern "C" fn scene_file() -> u32 {
    with_engine(|engine| engine.session().scene_file())
}

/// Indexes the pulses before the first question; the reply is empty.
#[cfg_attr(target_family = "wasm", unsafe(no_mangle))]
extern "C" fn index_proof() -> u32 {
    with_engine(|engine| {
        engine.session().index_proof();
        Ok(Vec::new())
    })
}

/// Makes the data that most questions need; the reply is empty.
#[cfg_attr(target_family = "wasm", unsafe(no_mangle))]
extern "C" fn prepare() -> u32 {
    with_engine(|engine| {
        engine.session().prepare();
        Ok(Vec::new())
    })
}

/// Answers the request at a path: a part of the drawing, or a question with its body.
///
/// # Safety
/// That of [`given`], for both.
#[cfg_attr(target_family = "wasm", unsafe(no_mangle))]
unsafe extern "C" fn ask(path: *const u8, path_length: usize, body: *const u8, body_length: usize) -> u32 {
    // SAFETY: as promised
    let (path, body) = unsafe { (written_bytes(path, path_length), written_bytes(body, body_length)) };
    with_engine(|engine| {
        let path = std::str::from_utf8(path).map_err(|_| Refusal::Missing("there is nothing at this address"))?;
        let session = engine.session();
        if belvedere_viewer::Session::is_question(path) {
            session.ask(path, body, &Control::none())
        } else {
            session.part(path)
        }
    })
}

/// Starts a pool of so many threads, each by `spawn`, for all that follows. The host has them waiting already: this
/// call returns only when all of them run.
#[cfg_attr(target_family = "wasm", unsafe(no_mangle))]
extern "C" fn start_threads(count: usize) -> u32 {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(count).spawn_handler(|thread| {
        // SAFETY: takes a number
        unsafe { spawn(Box::into_raw(Box::new(thread)) as usize) };
        Ok(())
    });
    u32::from(pool.build_global().is_err())
}

/// Runs a thread of the pool; it never returns while the pool is there.
///
/// # Safety
/// The address is one that `spawn` was given, and is used once.
#[cfg_attr(target_family = "wasm", unsafe(no_mangle))]
unsafe extern "C" fn run_thread(builder: usize) {
    // SAFETY: as promised
    let thread = unsafe { Box::from_raw(builder as *mut rayon::ThreadBuilder) };
    thread.run();
}
