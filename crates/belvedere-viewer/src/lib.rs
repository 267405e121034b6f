//! A local page in the browser: it shows a point cloud and asks the library which parts are seen, lit and shaded there.
//!
//! The server listens on 127.0.0.1 alone. It answers requests that know its token, name it as their host, and come from
//! its own page (`guard`). It computes nothing itself. Each question is one file in `questions` that calls the library
//! as the command line does. Every answer comes with the command line that gives the same.
//!
//! The page is embedded in the program. Its sources and the script that bundles them are in `page/`.
//!
//! ```no_run
//! use belvedere_viewer::{PageServer, ViewerParams};
//!
//! let viewer = PageServer::start(&ViewerParams::default())?;
//! println!("{}", viewer.url());
//! let loading = viewer.loading();
//! // read a cloud, show it, build its balls, hand them over
//! # Ok::<(), std::io::Error>(())
//! ```

mod chunks;
#[cfg(feature = "server")]
mod connections;
mod export;
#[cfg(feature = "server")]
mod guard;
mod loading;
mod page;
mod plans;
mod questions;
mod reading;
mod replies;
mod results;
mod roof_planes;
#[cfg(feature = "server")]
mod routes;
mod scene;
mod scene_text;
#[cfg(feature = "server")]
mod server;
mod session;
mod shell_words;
mod target_points;

pub use export::{ExportParams, ExportReport, export};
pub use loading::{Loading, are_results};
pub use reading::{LengthUnit, ReadingChoice, UpAxisChoice};
pub use replies::Refusal;
pub use results::PointsOf;
pub use scene_text::SceneText;
#[cfg(feature = "server")]
pub use server::{PageServer, ViewerParams};
pub use session::Session;
pub use shell_words::quoted;
