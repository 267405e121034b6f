//! The stages of a depth map as pipelines, the buffers between them, and which stage uses which buffer.

use super::{BLOCK, HEAD, LEVELS, MOST_LEFT, MOST_TILES, RANGES, STEPS, Shows, tiles_before, whole};
use belvedere_data::view::{Projection, View};

/// All shaders together: each uses what stands before it.
const SHADERS: &str = concat!(
    include_str!("floats.wgsl"),
    include_str!("place.wgsl"),
    include_str!("bins.wgsl"),
    include_str!("draw.wgsl")
);

/// Kinds of views, as the shaders number them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Kind {
    Parallel,
    Perspective,
    Hemispherical,
}

impl Kind {
    pub(super) fn of(view: &View) -> Self {
        match view.projection {
            Projection::Orthographic { .. } => Self::Parallel,
            Projection::Perspective { .. } => Self::Perspective,
            Projection::Hemispherical { .. } => Self::Hemispherical,
        }
    }
}

/// A stage with the numbers of the buffers that it uses.
#[derive(Debug)]
struct Stage {
    pipeline: wgpu::ComputePipeline,
    bindings: &'static [u32],
}

/// The stages in their order.
#[derive(Debug)]
pub(super) struct Stages {
    place: Stage,
    share_depths: Stage,
    count: Stage,
    sum_lists: Stage,
    sum_blocks: Stage,
    fill: Stage,
    draw: Stage,
}

/// What stages hand to each other, and what they draw.
#[derive(Debug)]
pub(super) struct Buffers {
    pub(super) piece: wgpu::Buffer,
    splats: wgpu::Buffer,
    touched: wgpu::Buffer,
    pub(super) counters: wgpu::Buffer,
    pub(super) before: wgpu::Buffer,
    listed: wgpu::Buffer,
    pub(super) pixels: wgpu::Buffer,
    pub(super) rows: wgpu::Buffer,
    pub(super) left_out: wgpu::Buffer,
    pub(super) depths: wgpu::Buffer,
    steps: wgpu::Buffer,
}

impl Buffers {
    /// Those for so many balls, and for pictures of a width and height.
    pub(super) fn new(device: &wgpu::Device, ball_count: usize, [width, height]: [usize; 2], shows: Shows) -> Self {
        let with_usage = |bytes: usize, usage| {
            let size = bytes.max(16) as u64;
            device.create_buffer(&wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: false })
        };
        let copied = wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC;
        let of = |bytes: usize| with_usage(bytes, wgpu::BufferUsages::STORAGE | copied);
        let lists = (tiles_before([width, height])[LEVELS as usize] * STEPS).next_multiple_of(BLOCK);
        let row_count = if shows == Shows::Depths { 0 } else { width * height };
        Self {
            piece: with_usage(16, wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST),
            splats: of(16 * ball_count),
            touched: of(8 * ball_count),
            counters: of(4 * lists),
            before: of(4 * BLOCK),
            listed: of(4 * MOST_TILES * ball_count),
            pixels: of(4 * width * height),
            rows: of(4 * row_count),
            left_out: of(4 * (HEAD + MOST_LEFT)),
            depths: of(4 * RANGES),
            steps: of(4 * (RANGES + STEPS)),
        }
    }
}

impl Stages {
    pub(super) fn new(device: &wgpu::Device, kind: Kind, shows: Shows, is_counted: bool) -> Self {
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("depth maps"),
            source: wgpu::ShaderSource::Wgsl(SHADERS.into()),
        });
        let (kind, shows) = (f64::from(kind as u8), f64::from(shows as u8));
        let counted = f64::from(u8::from(is_counted));
        let constants = [("KIND", kind), ("SHOWS", shows), ("IS_COUNTED", counted)];
        let stage = |name: &str, bindings| Stage {
            pipeline: device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(name),
                layout: None,
                module: &module,
                entry_point: Some(name),
                compilation_options: wgpu::PipelineCompilationOptions {
                    constants: &constants,
                    zero_initialize_workgroup_memory: false,
                },
                cache: None,
            }),
            bindings,
        };
        Self {
            place: stage("place", &[0, 2, 3, 4, 10, 11]),
            share_depths: stage("share_depths", &[11, 12]),
            count: stage("count", &[0, 4, 5, 10, 12]),
            sum_lists: stage("sum_lists", &[5, 6]),
            sum_blocks: stage("sum_blocks", &[6]),
            fill: stage("fill", &[0, 4, 5, 6, 7, 12]),
            draw: stage("draw", &[0, 1, 3, 5, 6, 7, 8, 9, 10, 12, 13]),
        }
    }

    /// The stages with their buffers, and those of a view, its balls and the offsets of its pixels.
    pub(super) fn bind(
        &self,
        device: &wgpu::Device,
        buffers: &Buffers,
        [view, balls, offsets]: [&wgpu::Buffer; 3],
    ) -> Bound<'_> {
        let all = [
            view,
            &buffers.piece,
            balls,
            &buffers.splats,
            &buffers.touched,
            &buffers.counters,
            &buffers.before,
            &buffers.listed,
            &buffers.pixels,
            &buffers.rows,
            &buffers.left_out,
            &buffers.depths,
            &buffers.steps,
            offsets,
        ];
        let group = |stage: &Stage| {
            let used = (0_u32..).zip(all).filter(|(binding, _)| stage.bindings.contains(binding));
            let entries: Vec<wgpu::BindGroupEntry<'_>> = used
                .map(|(binding, buffer)| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() })
                .collect();
            device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: None,
                layout: &stage.pipeline.get_bind_group_layout(0),
                entries: &entries,
            })
        };
        let of_sorting = [&self.place, &self.share_depths, &self.count, &self.sum_lists, &self.sum_blocks, &self.fill];
        Bound {
            sorting: of_sorting.map(|stage| (&stage.pipeline, group(stage))),
            draw: (&self.draw.pipeline, group(&self.draw)),
        }
    }
}

/// Stages that are ready to run.
pub(super) struct Bound<'s> {
    sorting: [(&'s wgpu::ComputePipeline, wgpu::BindGroup); 6],
    draw: (&'s wgpu::ComputePipeline, wgpu::BindGroup),
}

impl Bound<'_> {
    /// Places balls and sorts them into lists: so many groups of balls, so many blocks of lists.
    pub(super) fn sort(&self, encoder: &mut wgpu::CommandEncoder, ball_groups: usize, blocks: usize) {
        let groups = [ball_groups, 1, ball_groups, blocks, 1, ball_groups];
        for ((pipeline, bindings), groups) in self.sorting.iter().zip(groups) {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, bindings, &[]);
            pass.dispatch_workgroups(whole(groups), 1, 1);
        }
    }

    /// Draws rows of tiles.
    pub(super) fn draw(&self, encoder: &mut wgpu::CommandEncoder, [columns, rows]: [usize; 2]) {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        pass.set_pipeline(self.draw.0);
        pass.set_bind_group(0, &self.draw.1, &[]);
        pass.dispatch_workgroups(whole(columns), whole(rows), 1);
    }
}
