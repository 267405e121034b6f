//! Lines of sight decided on a device: balls and their tree as words, and the words that come back. The arithmetic is
//! in `lines.wgsl`.

use crate::device::{Device, DeviceKind};
use belvedere_core::query::{Ball, BallTree, Viewers};
use belvedere_core::ray_index::{NODE_WORDS, RayIndex};
use belvedere_data::cast::{to_f32, to_row};
use belvedere_data::control::Control;
use belvedere_data::frame::FARTHEST;
use belvedere_data::vector::dot;
use belvedere_data::{Error, Result};
use bytemuck::cast_slice;
use std::borrow::Cow;
use std::sync::Arc;

/// Targets of a group of threads.
const GROUP: usize = 64;
/// Lines of sight in a piece of work of a graphics card: a tenth of a second on a slow one, so that its picture does
/// not freeze and no driver gives it up. A fast one does as many in twenty milliseconds.
const CARD_LINES: usize = 1 << 23;
/// The same of any other device.
const OTHER_LINES: usize = 1 << 20;
/// Groups along an axis that every device allows.
const MAX_GROUPS: usize = 65_535;
/// Bytes of results that are made at a time, free and blocked lines each.
const MAX_BYTES: usize = 1 << 25;
/// Bytes of `Scene` in the shader.
const SCENE_BYTES: usize = 64;
/// Bytes of `Viewer` in the shader.
const VIEWER_BYTES: usize = 32;
/// Widening of boxes beyond their sides, as a share of the distance of the starts of lines from the middle of the tree:
/// twice the error of f32.
const WIDENING: f64 = 2e-6;
/// Kinds of viewers in the shader.
const NOBODY: u32 = 0;
const DIRECTION: u32 = 1;
const EYE: u32 = 2;
/// Maximum deviation of the length of a direction from one: more than the rounding of f64.
const UNIT: f64 = 1e-12;

/// A device with the shader.
#[derive(Debug)]
pub(crate) struct Liner {
    device: Arc<Device>,
    pipeline: wgpu::ComputePipeline,
}

/// Balls and their tree in the memory of a device.
#[derive(Debug)]
pub(crate) struct Loaded {
    nodes: wgpu::Buffer,
    balls: wgpu::Buffer,
    /// The first words of `Scene`.
    scene: Vec<u8>,
}

/// Balls and their tree as the shader reads them.
#[derive(Debug, Default)]
pub(crate) struct Words {
    nodes: Vec<[u32; NODE_WORDS]>,
    balls: Vec<[f32; 4]>,
    /// The first words of `Scene`.
    scene: Vec<u8>,
}

impl Words {
    /// Encodes a tree that is a part of the one with the index `whole`: targets as far away as from that are decided.
    fn new(tree: &BallTree, whole: &RayIndex) -> Self {
        let (index, rule) = (tree.index(), tree.rule());
        let as_words = |ball: &Ball| {
            let [x, y, z] = ball.center;
            [x, y, z, ball.radius]
        };
        let reach = |axis: usize| (index.center()[axis] - whole.center()[axis]).abs() + whole.half_size()[axis];
        let size = (0..3).map(reach).fold(0.0, f64::max);
        Self {
            nodes: index.node_words().collect(),
            balls: tree.balls().iter().map(as_words).collect(),
            scene: scene_bytes(index.center(), size, rule.shell, rule.bias),
        }
    }

    /// Bytes of the larger one of two buffers.
    fn max_bytes(&self) -> usize {
        size_of_val(self.nodes.as_slice()).max(size_of_val(self.balls.as_slice()))
    }
}

impl Liner {
    /// # Errors
    /// [`Error::Device`] where the device cannot run the shader.
    pub(crate) fn new(device: Arc<Device>) -> Result<Self> {
        let module = device.device.create_shader_module(wgpu::include_wgsl!("lines.wgsl"));
        let pipeline = device.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some("lines"),
            layout: None,
            module: &module,
            entry_point: Some("lines"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            cache: None,
        });
        device.trouble.check()?;
        Ok(Self { device, pipeline })
    }

    /// The balls of a tree as words, in as many parts as buffers of the device need.
    ///
    /// # Errors
    /// [`Error::Cancelled`], and [`Error::Device`] where a part does not fit.
    pub(crate) fn words(&self, tree: &BallTree, control: &Control<'_>) -> Result<Vec<Words>> {
        let whole = Words::new(tree, tree.index());
        let (bytes, most) = (whole.max_bytes(), self.device.limit());
        if bytes <= most {
            return Ok(vec![whole]);
        }
        drop(whole);
        // trees of parts have a few more nodes
        let count = (bytes + bytes / 8).div_ceil(most.max(1));
        let of_part = tree.balls().len().div_ceil(count).max(1);
        let mut parts = Vec::new();
        for first in (0..tree.balls().len()).step_by(of_part) {
            control.check()?;
            let part = tree.part(first..tree.balls().len().min(first + of_part))?;
            parts.push(Words::new(&part, tree.index()));
        }
        match parts.iter().map(Words::max_bytes).max() {
            Some(bytes) if bytes > most => {
                let what = format!("a part of the scene takes {bytes} bytes of a device that allows {most}");
                Err(Error::Device { what })
            }
            _ => Ok(parts),
        }
    }

    /// Brings balls and their tree into the memory of the device.
    ///
    /// # Errors
    /// [`Error::Device`] where they do not fit.
    pub(crate) fn load(&self, words: &Words) -> Result<Loaded> {
        let Words { nodes, balls, scene } = words;
        let loaded = Loaded {
            nodes: self.device.filled_buffer(cast_slice(nodes)),
            balls: self.device.filled_buffer(cast_slice(balls)),
            scene: scene.clone(),
        };
        self.device.trouble.check()?;
        Ok(loaded)
    }

    /// Decides the lines of sight of `targets`, (M, 3) local metres, to each of `viewers`. Results go to `done` viewer
    /// by viewer: bit masks over the targets, 32 a word, of free and of blocked lines.
    ///
    /// # Errors
    /// [`Error::Cancelled`], and [`Error::Device`] where the device fails: the rows handed to `done` before are right.
    pub(crate) fn decide(
        &self,
        loaded: &Loaded,
        targets: &[[f32; 3]],
        viewers: Viewers<'_>,
        control: &Control<'_>,
        done: &mut dyn FnMut(&[u32], &[u32]),
    ) -> Result<()> {
        let bytes = 12 * targets.len();
        if bytes > self.device.limit() {
            let what = format!("{} targets at once are too many for the device", targets.len());
            return Err(Error::Device { what });
        }
        if targets.is_empty() {
            (0..viewers.len()).for_each(|_| done(&[], &[]));
            return Ok(());
        }
        let finite = finite_targets(targets);
        let on_device = self.device.filled_buffer(cast_slice(&finite));
        let word_count = 2 * targets.len().div_ceil(GROUP);
        let most = (MAX_BYTES.min(self.device.limit()) / (4 * word_count)).clamp(1, MAX_GROUPS);
        let viewers: Vec<[u8; VIEWER_BYTES]> = match viewers {
            Viewers::Directions(directions) => directions.iter().map(|direction| direction_bytes(*direction)).collect(),
            Viewers::Eyes(eyes) => eyes.iter().map(|eye| eye_bytes(*eye)).collect(),
        };
        for viewers in viewers.chunks(most) {
            let [free, blocked] = self.run(loaded, &on_device, targets.len(), viewers, control)?;
            for (free, blocked) in free.chunks(word_count).zip(blocked.chunks(word_count)) {
                done(free, blocked);
            }
        }
        Ok(())
    }

    /// The words of free and of blocked lines, viewer after viewer.
    fn run(
        &self,
        loaded: &Loaded,
        targets: &wgpu::Buffer,
        target_count: usize,
        viewers: &[[u8; VIEWER_BYTES]],
        control: &Control<'_>,
    ) -> Result<[Vec<u32>; 2]> {
        let device = &self.device.device;
        let group_count = target_count.div_ceil(GROUP);
        let word_count = 2 * group_count;
        let bytes = 4 * (word_count * viewers.len()) as u64;
        let result = || {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("results"),
                size: bytes,
                usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
                mapped_at_creation: false,
            })
        };
        let [free, blocked] = [result(), result()];
        let read_back = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("results on their way back"),
            size: 2 * bytes,
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let uniform = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("scene"),
            size: SCENE_BYTES as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let on_device = self.device.filled_buffer(viewers.as_flattened());
        self.device.trouble.check()?;
        let buffers = [&uniform, &loaded.nodes, &loaded.balls, targets, &on_device, &free, &blocked];
        let entries: Vec<wgpu::BindGroupEntry<'_>> = (0..)
            .zip(buffers)
            .map(|(binding, buffer)| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() })
            .collect();
        let bindings = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("lines"),
            layout: &self.pipeline.get_bind_group_layout(0),
            entries: &entries,
        });
        let piece = if self.device.info.kind == DeviceKind::Separate { CARD_LINES } else { OTHER_LINES };
        let groups = group_count.min(MAX_GROUPS).min(piece / GROUP);
        let mut before = None;
        for first_group in (0..group_count).step_by(groups) {
            let groups = groups.min(group_count - first_group);
            let mut first_viewer = 0;
            while first_viewer < viewers.len() {
                control.check()?;
                let count = (piece / (GROUP * groups)).clamp(1, viewers.len() - first_viewer);
                let of_piece = [target_count, first_viewer, word_count, 2 * first_group];
                let scene: Vec<u8> = (loaded.scene.iter().copied())
                    .chain(of_piece.into_iter().flat_map(|count| to_row(count).to_le_bytes()))
                    .chain([0; 4])
                    .collect();
                self.device.queue.write_buffer(&uniform, 0, &scene);
                let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
                {
                    let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
                    pass.set_pipeline(&self.pipeline);
                    pass.set_bind_group(0, &bindings, &[]);
                    pass.dispatch_workgroups(to_row(groups), to_row(count), 1);
                }
                let this = self.device.queue.submit([encoder.finish()]);
                // two pieces are under way at a time, so that the device does not wait
                if let Some(before) = before.replace(this) {
                    self.device.wait_for(Some(before))?;
                }
                self.device.trouble.check()?;
                first_viewer += count;
            }
        }
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encoder.copy_buffer_to_buffer(&free, 0, &read_back, 0, bytes);
        encoder.copy_buffer_to_buffer(&blocked, 0, &read_back, bytes, bytes);
        self.device.queue.submit([encoder.finish()]);
        read_back.slice(..).map_async(wgpu::MapMode::Read, |_| ());
        self.device.wait_for(None)?;
        self.device.trouble.check()?;
        let words = |from: u64| -> Result<Vec<u32>> {
            let bytes = read_back
                .slice(from..from + bytes)
                .get_mapped_range()
                .map_err(|error| Error::Device { what: format!("no results come back: {error}") })?;
            Ok(bytes.as_chunks::<4>().0.iter().map(|word| u32::from_le_bytes(*word)).collect())
        };
        Ok([words(0)?, words(bytes)?])
    }
}

/// The words of `Scene` that are the same for all targets: `size` is how far from `center` the scene reaches, metres.
fn scene_bytes(center: [f64; 3], size: f64, shell: f64, bias: f64) -> Vec<u8> {
    let (rounded, rest) = split(center);
    let farthest = 4.0 * size;
    let numbers = [
        rounded[0],
        rounded[1],
        rounded[2],
        to_f32(shell),
        rest[0],
        rest[1],
        rest[2],
        to_f32(WIDENING * (farthest + size)),
        to_f32(bias).next_down(),
        to_f32(bias).next_up(),
        to_f32(farthest),
    ];
    numbers.into_iter().flat_map(f32::to_le_bytes).collect()
}

/// `Viewer` of the shader for a unit vector. Lines of sight along one that is none stay open.
fn direction_bytes(direction: [f64; 3]) -> [u8; VIEWER_BYTES] {
    let is_unit = (dot(direction, direction) - 1.0).abs() < UNIT;
    viewer_bytes(direction, if is_unit { DIRECTION } else { NOBODY })
}

/// `Viewer` of the shader for an eye. Lines of sight to one that is not finite, or too far away, stay open.
fn eye_bytes(eye: [f64; 3]) -> [u8; VIEWER_BYTES] {
    viewer_bytes(eye, if eye.iter().all(|v| v.abs() <= f64::from(FARTHEST)) { EYE } else { NOBODY })
}

fn viewer_bytes(at: [f64; 3], kind: u32) -> [u8; VIEWER_BYTES] {
    let at = if kind == NOBODY { [0.0; 3] } else { at };
    let ([x, y, z], [rest_x, rest_y, rest_z]) = split(at);
    let words = [x, y, z, f32::from_bits(kind), rest_x, rest_y, rest_z, 0.0];
    let mut bytes = [0; VIEWER_BYTES];
    for (bytes, word) in bytes.as_chunks_mut::<4>().0.iter_mut().zip(words) {
        *bytes = word.to_le_bytes();
    }
    bytes
}

/// A place as the sum of two in single precision: rounded, and the remainder.
fn split(place: [f64; 3]) -> ([f32; 3], [f32; 3]) {
    let rounded = place.map(to_f32);
    (rounded, std::array::from_fn(|axis| to_f32(place[axis] - f64::from(rounded[axis]))))
}

/// Targets as the shader reads them; the lines of sight of one that is not finite stay open.
fn finite_targets(targets: &[[f32; 3]]) -> Cow<'_, [[f32; 3]]> {
    if targets.as_flattened().iter().all(|v| v.is_finite()) {
        return Cow::Borrowed(targets);
    }
    let finite = |target: &[f32; 3]| target.map(|v| if v.is_finite() { v } else { f32::MAX });
    Cow::Owned(targets.iter().map(finite).collect())
}
