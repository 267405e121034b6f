//! The devices of this computer, and one made ready. All errors of wgpu end here, as lines of text.

use belvedere_data::{Error, Result};
use std::sync::{Arc, LazyLock, Mutex, MutexGuard, PoisonError};

/// Bytes that are copied to a device at a time.
const PART_BYTES: usize = 1 << 25;

/// Kind of a device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum DeviceKind {
    /// A graphics card with memory of its own, or a share of one.
    Separate,
    /// Part of the CPU, with which it shares memory.
    Integrated,
    /// The CPU itself, which only behaves like a graphics card.
    Software,
}

impl std::fmt::Display for DeviceKind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Separate => "graphics card",
            Self::Integrated => "integrated graphics",
            Self::Software => "software",
        })
    }
}

/// A device of this computer.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct DeviceInfo {
    /// Its number among [`devices`].
    pub number: usize,
    /// Its name.
    pub name: String,
    /// Its driver, with the version.
    pub driver: String,
    /// The interface that it is reached by: Vulkan, Metal or DirectX 12.
    pub interface: String,
    /// Kind of the device.
    pub kind: DeviceKind,
    /// The largest buffer that a shader can use, bytes.
    pub max_bytes: u64,
}

/// The interfaces to devices, found once. Drivers were seen to crash where several threads look for devices at the same
/// time: whoever does holds this.
fn instance() -> MutexGuard<'static, wgpu::Instance> {
    static INSTANCE: LazyLock<Mutex<wgpu::Instance>> = LazyLock::new(|| Mutex::new(new_instance()));
    INSTANCE.lock().unwrap_or_else(PoisonError::into_inner)
}

fn new_instance() -> wgpu::Instance {
    let mut wanted = wgpu::InstanceDescriptor::new_without_display_handle();
    wanted.backends = wgpu::Backends::VULKAN | wgpu::Backends::METAL | wgpu::Backends::DX12;
    // no layers of validation, which are for work on shaders
    wanted.flags = wgpu::InstanceFlags::empty();
    wgpu::Instance::new(wanted)
}

fn adapters(instance: &wgpu::Instance) -> Vec<wgpu::Adapter> {
    pollster::block_on(instance.enumerate_adapters(wgpu::Backends::all()))
}

/// All devices of this computer, in the order of their numbers.
#[must_use]
pub fn devices() -> Vec<DeviceInfo> {
    adapters(&instance()).iter().enumerate().map(|(number, adapter)| info_of(number, adapter)).collect()
}

fn info_of(number: usize, adapter: &wgpu::Adapter) -> DeviceInfo {
    let info = adapter.get_info();
    let limits = adapter.limits();
    DeviceInfo {
        number,
        name: info.name,
        driver: format!("{} {}", info.driver, info.driver_info).trim().to_owned(),
        interface: match info.backend {
            wgpu::Backend::Dx12 => "DirectX 12".to_owned(),
            other => format!("{other:?}"),
        },
        kind: match info.device_type {
            wgpu::DeviceType::DiscreteGpu | wgpu::DeviceType::VirtualGpu => DeviceKind::Separate,
            wgpu::DeviceType::IntegratedGpu => DeviceKind::Integrated,
            wgpu::DeviceType::Cpu | wgpu::DeviceType::Other => DeviceKind::Software,
        },
        max_bytes: limits.max_storage_buffer_binding_size.min(limits.max_buffer_size),
    }
}

/// The first thing that went wrong on a device.
#[derive(Clone, Debug, Default)]
pub(crate) struct Trouble(Arc<Mutex<Option<String>>>);

impl Trouble {
    fn note(&self, what: String) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(what);
    }

    /// # Errors
    /// [`Error::Device`] if anything went wrong since the device was made ready.
    pub(crate) fn check(&self) -> Result<()> {
        match &*self.0.lock().unwrap_or_else(PoisonError::into_inner) {
            Some(what) => Err(Error::Device { what: what.clone() }),
            None => Ok(()),
        }
    }
}

/// A device that work can be given to.
#[derive(Debug)]
pub(crate) struct Device {
    pub(crate) info: DeviceInfo,
    pub(crate) device: wgpu::Device,
    pub(crate) queue: wgpu::Queue,
    pub(crate) trouble: Trouble,
}

impl Device {
    /// Makes the device of a number ready, with all that its adapter can do.
    ///
    /// # Errors
    /// [`Error::Device`] where there is no such device, or the driver refuses.
    pub(crate) fn open(number: usize) -> Result<Self> {
        let instance = instance();
        let adapters = adapters(&instance);
        let count = adapters.len();
        let Some(adapter) = adapters.into_iter().nth(number) else {
            let what = format!("there is no device {number}; this computer has {count}, see `belvedere info`");
            return Err(Error::Device { what });
        };
        let info = info_of(number, &adapter);
        let wanted = wgpu::DeviceDescriptor {
            label: Some("belvedere"),
            required_limits: adapter.limits(),
            memory_hints: wgpu::MemoryHints::MemoryUsage,
            ..wgpu::DeviceDescriptor::default()
        };
        let (device, queue) = pollster::block_on(adapter.request_device(&wanted))
            .map_err(|error| Error::Device { what: format!("{}: {error}", info.name) })?;
        let trouble = Trouble::default();
        let (of_errors, of_loss) = (trouble.clone(), trouble.clone());
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| of_errors.note(describe(&error))));
        device.set_device_lost_callback(move |_, why| of_loss.note(format!("the device was lost: {why}")));
        Ok(Self { info, device, queue, trouble })
    }
}

impl Device {
    /// The largest buffer, bytes.
    pub(crate) fn limit(&self) -> usize {
        usize::try_from(self.info.max_bytes).unwrap_or(usize::MAX)
    }

    /// Waits for a piece of work, or for all.
    ///
    /// # Errors
    /// [`Error::Device`] where the device is lost.
    pub(crate) fn wait_for(&self, submission_index: Option<wgpu::SubmissionIndex>) -> Result<()> {
        let until = wgpu::PollType::Wait { submission_index, timeout: None };
        match self.device.poll(until) {
            Ok(_) => self.trouble.check(),
            Err(error) => Err(Error::Device { what: format!("the device does not answer: {error}") }),
        }
    }

    /// A buffer of these bytes that shaders read. On a device without memory left it holds nothing, and the trouble is
    /// noted.
    pub(crate) fn filled_buffer(&self, bytes: &[u8]) -> wgpu::Buffer {
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            // none is empty
            size: bytes.len().next_multiple_of(16).max(16) as u64,
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let mut at = 0;
        for part in bytes.chunks(PART_BYTES) {
            self.queue.write_buffer(&buffer, at, part);
            at += part.len() as u64;
        }
        buffer
    }
}

fn describe(error: &wgpu::Error) -> String {
    match error {
        wgpu::Error::OutOfMemory { .. } => "the memory of the device is full".to_owned(),
        other => other.to_string().lines().collect::<Vec<_>>().join(" "),
    }
}
