//! Lines of sight and depth maps on a graphics processor.
//!
//! [`Gpu`] is a [`Backend`](belvedere_core::query::Backend). It follows lines of sight through the tree of balls in
//! single precision and decides those that rounding cannot change. The CPU decides the others exactly, so that answers
//! have the same bits as on the CPU.
//!
//! In depth maps the CPU draws the pixels whose depth is too inaccurate in single precision. Depths differ by
//! [`DEPTH_MAP_TOLERANCE`](belvedere_core::query::DEPTH_MAP_TOLERANCE) of themselves at most. If there is no device,
//! too little memory, or the device is lost during the work, the CPU does the rest, and [`Gpu::notes`] has a line on
//! it.
//!
//! ```no_run
//! use belvedere_core::query::MedialScene;
//! use belvedere_gpu::{Choice, Gpu};
//! use std::sync::Arc;
//!
//! # fn example(scene: MedialScene) -> belvedere_data::Result<()> {
//! let gpu = Arc::new(Gpu::new(Choice::Gpu)?);
//! let scene = scene.with_backend(gpu.clone());
//! // ... questions about many lines of sight ...
//! for note in gpu.notes() {
//!     // what the CPU had to do instead, and why
//! }
//! # Ok(())
//! # }
//! ```

#![forbid(unsafe_code)]

mod backend;
mod depth;
mod device;
mod drawing;
mod gpu_state;
mod lines;

pub use backend::Gpu;
pub use device::{DeviceInfo, DeviceKind, devices};
pub use gpu_state::Choice;
