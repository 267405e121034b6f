//! The device as a backend: what it sweeps, and what happens when it cannot.

use crate::device::{Device, DeviceInfo, DeviceKind, devices};
use crate::sweep::{Loaded, Sweeper};
use belvedere_core::depth::DepthBounds;
use belvedere_core::query::cpu::{Heading, Place, PreparedBalls, SpaceLayers, Swept, sweep_all};
use belvedere_core::query::{Backend, BallTree, Prepared, Settled};
use belvedere_data::control::Control;
use belvedere_data::view::View;
use belvedere_data::{Error, Result};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// Lines of sight from which on [`Choice::Automatic`] takes a device: to find one and to make it ready takes the time of some millions on the CPU.
const WORTH_A_DEVICE: usize = 1 << 26;

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
struct Shared {
    choice: Choice,
    state: Mutex<State>,
    notes: Mutex<Vec<String>>,
    /// The device that swept anything.
    used: OnceLock<DeviceInfo>,
    /// For tests: after so many headings the device fails.
    fails_after: Option<usize>,
}

#[derive(Debug)]
enum State {
    /// Not yet needed.
    Unopened,
    Ready(Arc<Sweeper>),
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
        let gpu = Self::with_failure(choice, None);
        match choice {
            Choice::Automatic => {}
            Choice::Number(number) => {
                *gpu.shared.lock() = State::Ready(Arc::new(Sweeper::new(Device::open(number)?)?));
            }
            Choice::Gpu => {
                gpu.shared.sweeper(usize::MAX);
            }
        }
        Ok(gpu)
    }

    /// As [`Gpu::new`] with a device that fails after so many directions: what tests of the way back to the CPU need.
    ///
    /// # Errors
    /// Those of [`Gpu::new`].
    #[doc(hidden)]
    pub fn failing_after(number: usize, headings: usize) -> Result<Self> {
        let gpu = Self::with_failure(Choice::Number(number), Some(headings));
        *gpu.shared.lock() = State::Ready(Arc::new(Sweeper::new(Device::open(number)?)?));
        Ok(gpu)
    }

    fn with_failure(choice: Choice, fails_after: Option<usize>) -> Self {
        let (state, notes) = (Mutex::new(State::Unopened), Mutex::default());
        Self { shared: Arc::new(Shared { choice, state, notes, used: OnceLock::new(), fails_after }) }
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
            State::Ready(sweeper) => Some(sweeper.device.info.clone()),
            State::Unopened | State::Gone => None,
        }
    }

    /// Sweeps `headings` through layers on the device: the same bits as [`sweep_all`]. For benches and tests; questions go through
    /// [`Backend::prepare`].
    ///
    /// # Errors
    /// [`Error::Cancelled`], and [`Error::Device`] where there is no device, or it fails.
    pub fn sweep(
        &self,
        space: &SpaceLayers,
        places: &[Option<Place>],
        headings: &[Heading],
        control: &Control<'_>,
    ) -> Result<Vec<Swept>> {
        let Some(sweeper) = self.shared.sweeper(usize::MAX) else {
            return Err(Error::Device { what: "there is no graphics processor to sweep with".to_owned() });
        };
        let mut swept = Vec::with_capacity(headings.len());
        let loaded = sweeper.load(space)?;
        sweeper.sweep(space, &loaded, places, headings, control, &mut |of_heading| swept.push(of_heading))?;
        Ok(swept)
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

    /// The device for a question about so many lines of sight, made ready if it is not yet.
    fn sweeper(&self, lines: usize) -> Option<Arc<Sweeper>> {
        let mut state = self.lock();
        if matches!(*state, State::Unopened) && (self.choice != Choice::Automatic || lines >= WORTH_A_DEVICE) {
            *state = match self.open() {
                Ok(Some(sweeper)) => State::Ready(Arc::new(sweeper)),
                Ok(None) => State::Gone,
                Err(error) => {
                    self.note(format!("{error}; the CPU does all instead, with the same results"));
                    State::Gone
                }
            };
        }
        match &*state {
            State::Ready(sweeper) => Some(Arc::clone(sweeper)),
            State::Unopened | State::Gone => None,
        }
    }

    fn open(&self) -> Result<Option<Sweeper>> {
        let of_kind = |kind| move |info: &DeviceInfo| info.kind == kind;
        let found = devices();
        let separate = found.iter().find(|info| of_kind(DeviceKind::Separate)(info));
        let chosen = match self.choice {
            Choice::Automatic => separate,
            _ => separate.or_else(|| found.iter().find(|info| of_kind(DeviceKind::Integrated)(info))),
        };
        match chosen {
            Some(info) => Ok(Some(Sweeper::new(Device::open(info.number)?)?)),
            None if self.choice == Choice::Automatic => Ok(None),
            None => Err(Error::Device { what: "there is no graphics processor with a driver".to_owned() }),
        }
    }
}

impl Backend for Gpu {
    fn prepare(&self, balls: &Arc<BallTree>) -> Result<Box<dyn Prepared>> {
        let cpu = PreparedBalls::new(balls);
        Ok(Box::new(OnDevice { cpu, shared: Arc::clone(&self.shared), loaded: Mutex::default() }))
    }
}

/// Balls whose layers are in the memory of the device once they are needed there.
struct OnDevice {
    cpu: PreparedBalls,
    shared: Arc<Shared>,
    /// One question at a time: together they could need more memory than there is.
    loaded: Mutex<Option<Loaded>>,
}

impl Prepared for OnDevice {
    fn depth(&self, view: &View, start: f64, control: &Control<'_>) -> Result<DepthBounds> {
        self.cpu.depth(view, start, control)
    }

    fn settle(&self, targets: &[[f32; 3]], directions: &[[f64; 3]], control: &Control<'_>) -> Result<Settled> {
        let lines = targets.len().saturating_mul(directions.len());
        self.cpu.settle_by(targets, directions, control, &|space, places, headings, control| match self
            .shared
            .sweeper(lines)
        {
            Some(sweeper) => self.sweep(&sweeper, space, places, headings, control),
            None => sweep_all(space, places, headings, control),
        })
    }
}

impl OnDevice {
    /// Sweeps on the device; on the CPU what the device does not finish.
    fn sweep(
        &self,
        sweeper: &Sweeper,
        space: &SpaceLayers,
        places: &[Option<Place>],
        headings: &[Heading],
        control: &Control<'_>,
    ) -> Result<Vec<Swept>> {
        let mut swept = Vec::with_capacity(headings.len());
        match self.sweep_on_device(sweeper, space, places, headings, control, &mut swept) {
            Ok(()) => {
                self.shared.used.get_or_init(|| sweeper.device.info.clone());
                return Ok(swept);
            }
            Err(Error::Device { what }) => {
                let name = &sweeper.device.info.name;
                self.shared.note(format!("{name}: {what}; the CPU does the rest, with the same results"));
                *self.shared.lock() = State::Gone;
            }
            Err(other) => return Err(other),
        }
        let rest = headings.get(swept.len()..).unwrap_or_default();
        swept.extend(sweep_all(space, places, rest, control)?);
        Ok(swept)
    }

    fn sweep_on_device(
        &self,
        sweeper: &Sweeper,
        space: &SpaceLayers,
        places: &[Option<Place>],
        headings: &[Heading],
        control: &Control<'_>,
        swept: &mut Vec<Swept>,
    ) -> Result<()> {
        let mut loaded = self.loaded.lock().unwrap_or_else(PoisonError::into_inner);
        let loaded = match &mut *loaded {
            Some(loaded) => loaded,
            empty => empty.insert(sweeper.load(space)?),
        };
        let asked = headings.get(..self.shared.fails_after.unwrap_or(usize::MAX)).unwrap_or(headings);
        sweeper.sweep(space, loaded, places, asked, control, &mut |of_heading| swept.push(of_heading))?;
        if asked.len() < headings.len() {
            return Err(Error::Device { what: "the device was lost: a test".to_owned() });
        }
        Ok(())
    }
}
