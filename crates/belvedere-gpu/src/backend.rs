//! The device as a backend: what it decides, and what happens when it cannot.

use crate::depth::{Painter, Work};
use crate::device::{Device, DeviceInfo, DeviceKind, devices};
use crate::drawing::{self, Drawing};
use crate::lines::{Liner, Loaded, Words};
use belvedere_core::depth::{BoundsParams, DepthBounds};
use belvedere_core::query::cpu::PreparedBalls;
use belvedere_core::query::{Backend, BallTree, Drawable, PreparedBackend, Profile, Settled, Viewers};
use belvedere_data::balls::MedialBalls;
use belvedere_data::control::Control;
use belvedere_data::view::View;
use belvedere_data::{Error, Result};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// Lines of sight from which on [`Choice::Automatic`] looks for a device: to find one and to make it ready takes the time of some millions on the CPU.
const WORTH_A_DEVICE: usize = 1 << 24;
/// Lines of sight from which on a device that is ready is asked: a question to it takes the time of some thousands on the CPU.
const WORTH_ASKING: usize = 1 << 14;
/// Balls and pixels from which on a device is asked for a picture.
const WORTH_DRAWING: usize = 1 << 12;

/// Which device is used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Choice {
    /// A separate graphics card for large questions, else the CPU.
    Automatic,
    /// The first graphics processor: a separate one before an integrated one, never one in software.
    Gpu,
    /// The device of this number among [`devices`].
    Number(usize),
}

/// A graphics processor as a backend. What it cannot do the CPU does.
#[derive(Clone, Debug)]
pub struct Gpu {
    shared: Arc<Shared>,
}

#[derive(Debug)]
pub(crate) struct Shared {
    choice: Choice,
    state: Mutex<State>,
    notes: Mutex<Vec<String>>,
    /// The device that decided anything.
    used: OnceLock<DeviceInfo>,
    /// For tests: after so many directions, or parts of a picture, the device fails.
    pub(crate) fails_after: Option<usize>,
    /// For benches: how much work the depth maps were.
    counted: Option<Mutex<Work>>,
}

/// A device that is ready, with what it can do.
#[derive(Debug)]
pub(crate) struct Ready {
    pub(crate) device: Arc<Device>,
    liner: Liner,
    pub(crate) painter: Painter,
}

#[derive(Debug)]
enum State {
    /// Not yet needed.
    Unopened,
    Ready(Arc<Ready>),
    /// There is none, or it failed.
    Gone,
}

impl Gpu {
    /// The device that `choice` says. One that is chosen by its number or as [`Choice::Gpu`] is made ready at once.
    ///
    /// # Errors
    /// [`Error::Device`] where no device has that number, or it cannot be made ready. That there is no graphics processor for [`Choice::Gpu`] is no
    /// error: the CPU gives the same results, and [`Gpu::notes`] says so.
    pub fn new(choice: Choice) -> Result<Self> {
        let gpu = Self::unopened(choice, None, None);
        match choice {
            Choice::Automatic => {}
            Choice::Number(number) => {
                *gpu.shared.lock() = State::Ready(Arc::new(gpu.shared.make_ready(Device::open(number)?)?));
            }
            Choice::Gpu => {
                gpu.shared.ready(usize::MAX);
            }
        }
        Ok(gpu)
    }

    /// As [`Gpu::new`] with a device whose buffers have at most `most_bytes`, and that fails after so many directions of a part of a scene: what tests of
    /// scenes in parts, and of the way back to the CPU, need.
    ///
    /// # Errors
    /// Those of [`Gpu::new`].
    #[doc(hidden)]
    pub fn limited(number: usize, most_bytes: u64, fails_after: Option<usize>) -> Result<Self> {
        let gpu = Self::unopened(Choice::Number(number), fails_after, None);
        let mut device = Device::open(number)?;
        device.info.most_bytes = device.info.most_bytes.min(most_bytes);
        *gpu.shared.lock() = State::Ready(Arc::new(gpu.shared.make_ready(device)?));
        Ok(gpu)
    }

    /// As [`Gpu::new`] with a device that counts how much work depth maps are, which takes time: what benches need.
    ///
    /// # Errors
    /// Those of [`Gpu::new`].
    #[doc(hidden)]
    pub fn counting(number: usize) -> Result<Self> {
        let gpu = Self::unopened(Choice::Number(number), None, Some(Mutex::default()));
        *gpu.shared.lock() = State::Ready(Arc::new(gpu.shared.make_ready(Device::open(number)?)?));
        Ok(gpu)
    }

    fn unopened(choice: Choice, fails_after: Option<usize>, counted: Option<Mutex<Work>>) -> Self {
        let (state, notes) = (Mutex::new(State::Unopened), Mutex::default());
        Self { shared: Arc::new(Shared { choice, state, notes, used: OnceLock::new(), fails_after, counted }) }
    }

    /// How much work depth maps were so far, of a device that counts ([`Gpu::counting`]).
    #[doc(hidden)]
    #[must_use]
    pub fn work(&self) -> Work {
        let counted = self.shared.counted.as_ref();
        counted.map_or_else(Work::default, |work| *work.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// The device that some question was answered with. Small questions are the CPU's.
    #[must_use]
    pub fn used(&self) -> Option<&DeviceInfo> {
        self.shared.used.get()
    }

    /// The device that is ready; `None` where the CPU does all, also as long as [`Choice::Automatic`] has not needed one.
    #[must_use]
    pub fn device(&self) -> Option<DeviceInfo> {
        match &*self.shared.lock() {
            State::Ready(ready) => Some(ready.device.info.clone()),
            State::Unopened | State::Gone => None,
        }
    }

    /// What the CPU had to do instead, and why, a line each.
    #[must_use]
    pub fn notes(&self) -> Vec<String> {
        self.shared.notes.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

impl Shared {
    fn lock(&self) -> std::sync::MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn note(&self, what: String) {
        let mut notes = self.notes.lock().unwrap_or_else(PoisonError::into_inner);
        if !notes.contains(&what) {
            notes.push(what);
        }
    }

    fn make_ready(&self, device: Device) -> Result<Ready> {
        let device = Arc::new(device);
        let painter = Painter::new(Arc::clone(&device), self.counted.is_some());
        Ok(Ready { liner: Liner::new(Arc::clone(&device))?, painter, device })
    }

    /// Says which device was of use.
    pub(crate) fn set_used(&self, device: &Device) {
        self.used.get_or_init(|| device.info.clone());
    }

    pub(crate) fn count(&self, work: Work) {
        if let Some(counted) = &self.counted {
            *counted.lock().unwrap_or_else(PoisonError::into_inner) += work;
        }
    }

    /// The device failed: from now on the CPU does all.
    pub(crate) fn give_up(&self, device: &Device, what: &str) {
        self.note(format!("{}: {what}; the CPU does the rest, with the same results", device.info.name));
        *self.lock() = State::Gone;
    }

    /// The device for a question that takes the CPU as long as so many lines of sight, made ready if it is not yet.
    pub(crate) fn ready(&self, lines: usize) -> Option<Arc<Ready>> {
        let mut state = self.lock();
        if matches!(*state, State::Unopened) && (self.choice != Choice::Automatic || lines >= WORTH_A_DEVICE) {
            *state = match self.open() {
                Ok(Some(ready)) => State::Ready(Arc::new(ready)),
                Ok(None) => State::Gone,
                Err(error) => {
                    self.note(format!("{error}; the CPU does all instead, with the same results"));
                    State::Gone
                }
            };
        }
        match &*state {
            State::Ready(ready) => Some(Arc::clone(ready)),
            State::Unopened | State::Gone => None,
        }
    }

    /// The device for a picture of so many balls and pixels.
    pub(crate) fn ready_to_draw(&self, ball_count: usize, pixel_count: usize) -> Option<Arc<Ready>> {
        // from which size on a picture pays to make a device ready for was not measured: it has to be asked for
        let is_worth_it = self.choice != Choice::Automatic && ball_count.saturating_add(pixel_count) >= WORTH_DRAWING;
        is_worth_it.then(|| self.ready(0)).flatten()
    }

    fn open(&self) -> Result<Option<Ready>> {
        let of_kind = |kind| move |info: &DeviceInfo| info.kind == kind;
        let found = devices();
        let separate = found.iter().find(|info| of_kind(DeviceKind::Separate)(info));
        let chosen = match self.choice {
            Choice::Automatic => separate,
            _ => separate.or_else(|| found.iter().find(|info| of_kind(DeviceKind::Integrated)(info))),
        };
        match chosen {
            Some(info) => Ok(Some(self.make_ready(Device::open(info.number)?)?)),
            None if self.choice == Choice::Automatic => Ok(None),
            None => Err(Error::Device { what: "there is no graphics processor with a driver".to_owned() }),
        }
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
        control: &Control<'_>,
    ) -> Result<Option<Box<dyn Drawable + 'b>>> {
        let Some(ready) = self.shared.ready_to_draw(balls.len(), pixel_count) else { return Ok(None) };
        let drawing = Drawing::new(Arc::clone(&self.shared), ready, balls, control)?;
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
    shared: Arc<Shared>,
    /// One question at a time: together they could need more memory than there is.
    memory: Mutex<Memory>,
}

/// What is in the memory of the device: one part of the scene at a time.
#[derive(Default)]
struct Memory {
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
    /// What the device decides, and for how many of the viewers it did before it failed, if it did; `None` where it is not asked.
    fn decide(
        &self,
        targets: &[[f32; 3]],
        viewers: Viewers<'_>,
        control: &Control<'_>,
    ) -> Result<Option<(Settled, usize)>> {
        let lines = targets.len().saturating_mul(viewers.len());
        let is_worth_it = lines >= WORTH_ASKING && self.tree.rule().profile == Profile::Sphere;
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

    /// Settles lines past one part of the scene after the other; `finished` is the number of viewers that are settled past all of them.
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
        let Memory { parts, loaded } = &mut *memory;
        if parts.is_empty() {
            *parts = liner.words(&self.tree, control)?;
        }
        // the one that is there already is the first
        let start = loaded.as_ref().map_or(0, |(number, _)| *number);
        let fails_after = self.shared.fails_after.filter(|most| *most < viewers.len());
        let asked = fails_after.map_or(viewers, |most| viewers.first(most));
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
            liner.decide(part, targets, asked, control, &mut |free, blocked| {
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
