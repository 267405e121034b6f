//! Lines of sight and depth maps on a graphics processor.
//!
//! [`Gpu`] is a [`Backend`](belvedere_core::query::Backend): it follows lines of sight through the tree of balls in
//! single precision, decides those that rounding cannot change, and leaves the others to the CPU, which decides
//! exactly. So answers have the same bits as on the CPU. Of depth maps, too, it leaves the pixels to the CPU whose
//! depth single precision does not know well enough: depths differ by
//! [`DEPTH_MAP_TOLERANCE`](belvedere_core::query::DEPTH_MAP_TOLERANCE) of themselves at most. When there is no device,
//! too little memory, or the device is lost in the middle of the work, the CPU does what is left, and [`Gpu::notes`]
//! says so in a line.
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
mod lines;

pub use backend::{Choice, Gpu};
pub use device::{DeviceInfo, DeviceKind, devices};
