//! The device that is used, made ready when it is first worth it.

use crate::depth::Painter;
use crate::device::{Device, DeviceInfo, DeviceKind, devices};
use crate::lines::Liner;
use belvedere_data::{Error, Result};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// Lines of sight from which on [`Choice::Automatic`] looks for a device: to find one and to make it ready takes the
/// time of some millions on the CPU.
const WORTH_A_DEVICE: usize = 1 << 24;
/// Balls and pixels of a picture from which on a device that was chosen draws it. [`Choice::Automatic`] takes each of
/// them for a line of sight.
const WORTH_DRAWING: usize = 1 << 12;

/// Choice of the device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Choice {
    /// A separate graphics card for large questions, else the CPU.
    Automatic,
    /// The first graphics processor: a separate one before an integrated one, never one in software.
    Gpu,
    /// The device of this number among [`devices`].
    Number(usize),
}

/// Choice of the device, its state, and its use so far.
#[derive(Debug)]
pub(crate) struct GpuState {
    choice: Choice,
    state: Mutex<Readiness>,
    pub(crate) notes: Mutex<Vec<String>>,
    /// The device that decided anything.
    pub(crate) used: OnceLock<DeviceInfo>,
    /// Number of directions, or parts of a picture, after which the device fails in tests.
    pub(crate) fails_after: Option<usize>,
    /// Pixels of depth maps, and those of them that the CPU drew again.
    pub(crate) pixel_counts: Mutex<[usize; 2]>,
}

/// A device that is ready, with its programs.
#[derive(Debug)]
pub(crate) struct Ready {
    pub(crate) device: Arc<Device>,
    pub(crate) liner: Liner,
    pub(crate) painter: Painter,
}

/// State of the device.
#[derive(Debug)]
pub(crate) enum Readiness {
    /// Device that is not yet needed.
    Unopened,
    Ready(Arc<Ready>),
    /// There is none, or it failed.
    Gone,
}

impl Ready {
    /// Makes a device ready.
    pub(crate) fn new(device: Device) -> Result<Self> {
        let device = Arc::new(device);
        let painter = Painter::new(Arc::clone(&device));
        Ok(Self { liner: Liner::new(Arc::clone(&device))?, painter, device })
    }
}

impl GpuState {
    /// A device that is not yet needed.
    pub(crate) fn unopened(choice: Choice, fails_after: Option<usize>) -> Self {
        let (state, notes) = (Mutex::new(Readiness::Unopened), Mutex::default());
        let (used, pixel_counts) = (OnceLock::new(), Mutex::default());
        Self { choice, state, notes, used, fails_after, pixel_counts }
    }

    pub(crate) fn lock(&self) -> std::sync::MutexGuard<'_, Readiness> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn note(&self, what: String) {
        let mut notes = self.notes.lock().unwrap_or_else(PoisonError::into_inner);
        if !notes.contains(&what) {
            notes.push(what);
        }
    }

    /// Says which device was of use.
    pub(crate) fn set_used(&self, device: &Device) {
        self.used.get_or_init(|| device.info.clone());
    }

    pub(crate) fn count_pixels(&self, drawn: usize, redone: usize) {
        let mut counts = self.pixel_counts.lock().unwrap_or_else(PoisonError::into_inner);
        *counts = [counts[0] + drawn, counts[1] + redone];
    }

    /// The device failed: from now on the CPU does all.
    pub(crate) fn give_up(&self, device: &Device, what: &str) {
        self.note(format!("{}: {what}; the CPU does the rest, with the same results", device.info.name));
        *self.lock() = Readiness::Gone;
    }

    /// The device for a question that takes the CPU as long as so many lines of sight, made ready if it is not yet.
    pub(crate) fn ready(&self, lines: usize) -> Option<Arc<Ready>> {
        let mut state = self.lock();
        if matches!(*state, Readiness::Unopened) && (self.choice != Choice::Automatic || lines >= WORTH_A_DEVICE) {
            *state = match self.open() {
                Ok(Some(ready)) => Readiness::Ready(Arc::new(ready)),
                Ok(None) => Readiness::Gone,
                Err(error) => {
                    self.note(format!("{error}; the CPU does all instead, with the same results"));
                    Readiness::Gone
                }
            };
        }
        match &*state {
            Readiness::Ready(ready) => Some(Arc::clone(ready)),
            Readiness::Unopened | Readiness::Gone => None,
        }
    }

    /// The device for a picture of so many balls and pixels.
    pub(crate) fn ready_to_draw(&self, ball_count: usize, pixel_count: usize) -> Option<Arc<Ready>> {
        let lines = ball_count.saturating_add(pixel_count);
        is_worth_drawing(self.choice, lines).then(|| self.ready(lines)).flatten()
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
            Some(info) => Ok(Some(Ready::new(Device::open(info.number)?)?)),
            None if self.choice == Choice::Automatic => Ok(None),
            None => Err(Error::Device { what: "there is no graphics processor with a driver".to_owned() }),
        }
    }
}

/// Returns true if a picture is drawn on a device; the CPU would take as long as for `lines` lines of sight. By itself
/// only a large one is, also if a device is ready, so that a picture does not depend on the questions before it.
pub(crate) fn is_worth_drawing(choice: Choice, lines: usize) -> bool {
    lines >= if choice == Choice::Automatic { WORTH_A_DEVICE } else { WORTH_DRAWING }
}
