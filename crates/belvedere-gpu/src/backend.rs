//! The device as a backend: its decisions, and the fallback to the CPU.

use crate::device::{Device, DeviceInfo};
use crate::drawing::{self, Drawing};
use crate::gpu_state::{Choice, GpuState, Readiness, Ready};
use crate::lines::{Liner, Loaded, Words};
use belvedere_core::depth::{BoundsParams, DepthBounds};
use belvedere_core::query::cpu::PreparedBalls;
use belvedere_core::query::{Backend, BallTree, Drawable, PreparedBackend, Profile, Settled, Viewers};
use belvedere_data::balls::MedialBalls;
use belvedere_data::control::Control;
use belvedere_data::view::View;
use belvedere_data::{Error, Result};
use std::sync::{Arc, Mutex, PoisonError};

/// Lines of sight from which on a device that is ready is used: a question to it takes the time of some thousands on
/// the CPU.
const WORTH_USING: usize = 1 << 14;
/// A graphics processor as a backend, with the CPU as its fallback.
#[derive(Clone, Debug)]
pub struct Gpu {
    shared: Arc<GpuState>,
}

impl Gpu {
    /// The device that `choice` says. One that is chosen by its number or as [`Choice::Gpu`] is made ready at once.
    ///
    /// # Errors
    /// [`Error::Device`] where no device has that number, or it cannot be made ready. That there is no graphics
    /// processor for [`Choice::Gpu`] is no error: the CPU gives the same results, and [`Gpu::notes`] says so.
    pub fn new(choice: Choice) -> Result<Self> {
        let gpu = Self::unopened(choice, None);
        match choice {
            Choice::Automatic => {}
            Choice::Number(number) => {
                *gpu.shared.lock() = Readiness::Ready(Arc::new(Ready::new(Device::open(number)?)?));
            }
            Choice::Gpu => {
                gpu.shared.ready(usize::MAX);
            }
        }
        Ok(gpu)
    }

    /// Creates a backend as [`Gpu::new`] with a device whose buffers have at most `max_bytes`, and that fails after
    /// `fails_after` directions of a part of a scene. For tests of scenes in parts, and of the fallback to the CPU.
    ///
    /// # Errors
    /// Those of [`Gpu::new`].
    #[doc(hidden)]
    pub fn limited(number: usize, max_bytes: u64, fails_after: Option<usize>) -> Result<Self> {
        let gpu = Self::unopened(Choice::Number(number), fails_after);
        let mut device = Device::open(number)?;
        device.info.max_bytes = device.info.max_bytes.min(max_bytes);
        *gpu.shared.lock() = Readiness::Ready(Arc::new(Ready::new(device)?));
        Ok(gpu)
    }

    fn unopened(choice: Choice, fails_after: Option<usize>) -> Self {
        Self { shared: Arc::new(GpuState::unopened(choice, fails_after)) }
    }

    /// Returns the share of the pixels of all depth maps so far that the CPU drew again, because single precision did
    /// not suffice.
    #[must_use]
    pub fn redone_share(&self) -> f64 {
        let [drawn, redone] = *self.shared.pixel_counts.lock().unwrap_or_else(PoisonError::into_inner);
        redone as f64 / drawn.max(1) as f64
    }

    /// The device that some question was answered with. Small questions are the CPU's.
    #[must_use]
    pub fn used(&self) -> Option<&DeviceInfo> {
        self.shared.used.get()
    }

    /// The device that is ready; `None` where the CPU does all, also as long as [`Choice::Automatic`] has not needed
    /// one.
    #[must_use]
    pub fn device(&self) -> Option<DeviceInfo> {
        match &*self.shared.lock() {
            Readiness::Ready(ready) => Some(ready.device.info.clone()),
            Readiness::Unopened | Readiness::Gone => None,
        }
    }

    /// Returns one line for each piece of work that fell to the CPU, with the reason.
    #[must_use]
    pub fn notes(&self) -> Vec<String> {
        self.shared.notes.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

impl Backend for Gpu {
    fn prepare(&self, balls: &Arc<BallTree>) -> Result<Box<dyn PreparedBackend>> {
        let (tree, cpu) = (Arc::clone(balls), PreparedBalls::new(balls));
        Ok(Box::new(OnDevice { tree, cpu, shared: Arc::clone(&self.shared), memory: Mutex::default() }))
    }

    fn drawable<'b>(
        &self,
        balls: &'b MedialBalls,
        pixel_count: usize,
        _: &Control<'_>,
    ) -> Result<Option<Box<dyn Drawable + 'b>>> {
        let Some(ready) = self.shared.ready_to_draw(balls.len(), pixel_count) else { return Ok(None) };
        let drawing = Drawing::new(Arc::clone(&self.shared), ready, balls);
        Ok(drawing.map(|drawing| Box::new(drawing) as Box<dyn Drawable + 'b>))
    }

    fn device(&self) -> Option<String> {
        Self::device(self).map(|info| info.name)
    }

    fn notes(&self) -> Vec<String> {
        Self::notes(self)
    }
}

/// Balls that are in the memory of the device once they are needed there.
struct OnDevice {
    tree: Arc<BallTree>,
    cpu: PreparedBalls,
    shared: Arc<GpuState>,
    /// One question at a time: together they could need more memory than there is.
    memory: Mutex<DeviceMemory>,
}

/// Contents of the memory of the device: one part of the scene at a time.
#[derive(Default)]
struct DeviceMemory {
    /// The scene in parts, none before it is needed.
    parts: Vec<Words>,
    /// The number of a part, and that part.
    loaded: Option<(usize, Loaded)>,
}

impl PreparedBackend for OnDevice {
    fn depth(&self, view: &View, start: f64, control: &Control<'_>) -> Result<DepthBounds> {
        let params = BoundsParams { shell: self.tree.rule().shell, start };
        match drawing::bounds(&self.shared, self.tree.balls(), view, &params, control)? {
            Some(bounds) => Ok(bounds),
            None => self.cpu.depth(view, start, control),
        }
    }

    fn settle(&self, targets: &[[f32; 3]], directions: &[[f64; 3]], control: &Control<'_>) -> Result<Settled> {
        match self.decide(targets, Viewers::Directions(directions), control)? {
            Some((settled, finished)) if finished == directions.len() => Ok(settled),
            Some((mut settled, finished)) => {
                let rest = directions.get(finished..).unwrap_or_default();
                settled.set_directions(finished, &self.cpu.settle(targets, rest, control)?);
                Ok(settled)
            }
            None => self.cpu.settle(targets, directions, control),
        }
    }

    fn settle_few(&self, targets: &[[f32; 3]], viewers: Viewers<'_>, control: &Control<'_>) -> Result<Option<Settled>> {
        let decided = self.decide(targets, viewers, control)?;
        Ok(decided.filter(|(_, finished)| *finished == viewers.len()).map(|(settled, _)| settled))
    }
}

impl OnDevice {
    /// Returns the decisions of the device, and the number of viewers before it failed, if it did; `None` if it is not
    /// used.
    fn decide(
        &self,
        targets: &[[f32; 3]],
        viewers: Viewers<'_>,
        control: &Control<'_>,
    ) -> Result<Option<(Settled, usize)>> {
        let lines = targets.len().saturating_mul(viewers.len());
        let is_worth_it = lines >= WORTH_USING && self.tree.rule().profile == Profile::Sphere;
        let Some(ready) = is_worth_it.then(|| self.shared.ready(lines)).flatten() else { return Ok(None) };
        let mut settled = Settled::new(targets.len(), viewers.len());
        let mut finished = 0;
        match self.decide_on(&ready.liner, targets, viewers, control, &mut settled, &mut finished) {
            Ok(()) => self.shared.set_used(&ready.device),
            Err(Error::Device { what }) => self.shared.give_up(&ready.device, &what),
            Err(other) => return Err(other),
        }
        Ok(Some((settled, finished)))
    }

    /// Settles lines past one part of the scene after the other; `finished` is the number of viewers that are settled
    /// past all of them.
    fn decide_on(
        &self,
        liner: &Liner,
        targets: &[[f32; 3]],
        viewers: Viewers<'_>,
        control: &Control<'_>,
        settled: &mut Settled,
        finished: &mut usize,
    ) -> Result<()> {
        let mut memory = self.memory.lock().unwrap_or_else(PoisonError::into_inner);
        let DeviceMemory { parts, loaded } = &mut *memory;
        if parts.is_empty() {
            *parts = liner.words(&self.tree, control)?;
        }
        // the one that is there already is the first
        let start = loaded.as_ref().map_or(0, |(number, _)| *number);
        let fails_after = self.shared.fails_after.filter(|most| *most < viewers.len());
        let first = fails_after.map_or(viewers, |most| viewers.first(most));
        for turn in 0..parts.len() {
            let number = (start + turn) % parts.len();
            // the memory of the part before is free then
            let there = loaded.take_if(|(there, _)| *there == number);
            *loaded = None;
            let (_, part) = loaded.insert(match there {
                Some(there) => there,
                None => (number, liner.load(&parts[number])?),
            });
            if let [only] = &mut parts[..] {
                // it stays on the device
                *only = Words::default();
            }
            let (mut viewer, is_last) = (0, turn + 1 == parts.len());
            liner.decide(part, targets, first, control, &mut |free, blocked| {
                if turn == 0 {
                    settled.set_direction(viewer, free, blocked);
                } else {
                    settled.join_direction(viewer, free, blocked);
                }
                viewer += 1;
                if is_last {
                    *finished = viewer;
                }
            })?;
            if fails_after.is_some() {
                return Err(Error::Device { what: "the device was lost: a test".to_owned() });
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::{DeviceKind, devices};
    use crate::gpu_state::is_worth_drawing;

    #[test]
    fn large_pictures_alone_are_drawn_on_a_device_that_nobody_chose() {
        let large = 1 << 24;
        for choice in [Choice::Gpu, Choice::Number(0)] {
            assert!(is_worth_drawing(choice, 5000) && !is_worth_drawing(choice, 4000));
        }
        assert!(is_worth_drawing(Choice::Automatic, large) && !is_worth_drawing(Choice::Automatic, large - 1));
        // and only on a graphics card
        let gpu = Gpu::unopened(Choice::Automatic, None);
        let has_card = devices().iter().any(|info| info.kind == DeviceKind::Separate);
        assert!(gpu.shared.ready_to_draw(1000, 1 << 20).is_none());
        assert_eq!(gpu.shared.ready_to_draw(1000, large).is_some(), has_card);
    }
}
