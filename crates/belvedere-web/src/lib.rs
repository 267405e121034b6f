//! Belvedere inside a browser: the page of `belvedere view` without a server. The same session answers the same
//! questions, compiled to WebAssembly and run in a worker, so that nothing leaves the computer.
//!
//! A host (JavaScript, or a test) gives the resources of a browser: parts of files, a view of the progress, and a place
//! for replies. The calls of both sides are in `exports.rs`; all `unsafe` of this crate is there. [`Engine`] is the
//! same without a browser.

mod engine;
#[cfg(any(target_family = "wasm", test))]
mod exports;

pub use engine::{Announced, Engine, Host, OpenRequest, OpenedFile, Tile, tiles_of};
