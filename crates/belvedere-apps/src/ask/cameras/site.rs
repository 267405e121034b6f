//! Ground and obstacles of cameras.

use crate::ask::scene::Scene;
use belvedere_core::ground::Ground;
use belvedere_core::query::MedialScene;
use std::sync::Arc;

/// Ground and obstacles of cameras.
pub(in crate::ask) struct CameraSite<'a> {
    pub(in crate::ask) scene: &'a Scene,
    pub(in crate::ask) blockers: &'a Arc<MedialScene>,
    pub(in crate::ask) ground: &'a Ground,
    pub(in crate::ask) grid_north: f64,
}
