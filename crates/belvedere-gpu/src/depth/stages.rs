//! The stages of a depth map as pipelines, the buffers between them, and which stage uses which buffer.

use super::{BLOCK, LEVELS, MAX_TILES, RANGES, STEPS, Shows, tiles_before};
use belvedere_data::cast::to_row;
use belvedere_data::view::{Projection, View};

/// All shaders together: each uses those before it.
const SHADERS: &str = concat!(include_str!("touch.wgsl"), include_str!("bins.wgsl"), include_str!("draw.wgsl"));

/// Kinds of views, as the shaders number them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum ShaderView {
    Parallel,
    Perspective,
    Hemispherical,
}

impl ShaderView {
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
struct DepthStage {
    pipeline: wgpu::ComputePipeline,
    bindings: &'static [u32],
}

/// The stages in their order.
#[derive(Debug)]
pub(super) struct DepthStages {
    sorting: [DepthStage; 6],
    draw: DepthStage,
}

/// Buffers that stages share, and their results.
#[derive(Debug)]
pub(super) struct DepthBuffers {
    pub(super) piece: wgpu::Buffer,
    touched: wgpu::Buffer,
    pub(super) depths: wgpu::Buffer,
    pub(super) counters: wgpu::Buffer,
    pub(super) before: wgpu::Buffer,
    listed: wgpu::Buffer,
    pub(super) pixels: wgpu::Buffer,
    pub(super) rows: wgpu::Buffer,
    between: wgpu::Buffer,
    pub(super) candidates: wgpu::Buffer,
    steps: wgpu::Buffer,
}

/// Sizes of buffers.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sizes {
    pub(super) ball_count: usize,
    /// True if no other balls come after these.
    pub(super) is_whole: bool,
    /// Columns and rows of a part of a picture.
    pub(super) size_px: [usize; 2],
    pub(super) shows: Shows,
}

impl DepthBuffers {
    pub(super) fn new(device: &wgpu::Device, sizes: &Sizes) -> Self {
        let with_usage = |bytes: usize, usage| {
            let size = bytes.max(16) as u64;
            device.create_buffer(&wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: false })
        };
        let copied = wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC;
        let of = |bytes: usize| with_usage(bytes, wgpu::BufferUsages::STORAGE | copied);
        let lists = (tiles_before(sizes.size_px)[LEVELS as usize] * STEPS).next_multiple_of(BLOCK);
        let (ball_count, pixel_count) = (sizes.ball_count, sizes.size_px[0] * sizes.size_px[1]);
        let only_if = |is_used: bool, bytes: usize| of(if is_used { bytes } else { 0 });
        Self {
            piece: with_usage(16, wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST),
            touched: of(8 * ball_count),
            depths: of(4 * RANGES),
            counters: of(4 * lists),
            before: of(4 * BLOCK),
            listed: of(4 * MAX_TILES * ball_count),
            pixels: of(4 * pixel_count),
            rows: only_if(sizes.shows != Shows::Depths, 4 * pixel_count),
            between: only_if(!sizes.is_whole, 16 * pixel_count),
            candidates: only_if(sizes.shows != Shows::Bounds, 4 + 8 * pixel_count),
            steps: of(4 * (RANGES + STEPS)),
        }
    }
}

impl DepthStages {
    pub(super) fn new(device: &wgpu::Device, kind: ShaderView, shows: Shows) -> Self {
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("depth maps"),
            source: wgpu::ShaderSource::Wgsl(SHADERS.into()),
        });
        let constants = [("KIND", f64::from(kind as u8)), ("SHOWS", f64::from(shows as u8))];
        let stage = |name: &str, bindings| DepthStage {
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
            sorting: [
                stage("touch", &[0, 2, 3, 4]),
                stage("share_depths", &[4, 12]),
                stage("count", &[0, 3, 5, 12]),
                stage("sum_lists", &[5, 6]),
                stage("sum_blocks", &[6]),
                stage("fill", &[0, 3, 5, 6, 7, 12]),
            ],
            draw: stage("draw", &[0, 1, 2, 5, 6, 7, 8, 9, 10, 11, 12]),
        }
    }

    /// The stages with their buffers, and those of a view and its balls.
    pub(super) fn bind(
        &self,
        device: &wgpu::Device,
        buffers: &DepthBuffers,
        view: &wgpu::Buffer,
        splats: &wgpu::Buffer,
    ) -> BoundStages<'_> {
        let all = [
            view,
            &buffers.piece,
            splats,
            &buffers.touched,
            &buffers.depths,
            &buffers.counters,
            &buffers.before,
            &buffers.listed,
            &buffers.pixels,
            &buffers.rows,
            &buffers.between,
            &buffers.candidates,
            &buffers.steps,
        ];
        let group = |stage: &DepthStage| {
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
        BoundStages {
            sorting: self.sorting.each_ref().map(|stage| (&stage.pipeline, group(stage))),
            draw: (&self.draw.pipeline, group(&self.draw)),
        }
    }
}

/// Stages that are ready to run.
pub(super) struct BoundStages<'s> {
    sorting: [(&'s wgpu::ComputePipeline, wgpu::BindGroup); 6],
    draw: (&'s wgpu::ComputePipeline, wgpu::BindGroup),
}

impl BoundStages<'_> {
    /// Places balls and sorts them into lists: so many groups of balls, so many blocks of lists.
    pub(super) fn sort(&self, encoder: &mut wgpu::CommandEncoder, ball_groups: usize, blocks: usize) {
        let groups = [ball_groups, 1, ball_groups, blocks, 1, ball_groups];
        for ((pipeline, bindings), groups) in self.sorting.iter().zip(groups) {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, bindings, &[]);
            pass.dispatch_workgroups(to_row(groups), 1, 1);
        }
    }

    /// Draws rows of tiles.
    pub(super) fn draw(&self, encoder: &mut wgpu::CommandEncoder, [columns, rows]: [usize; 2]) {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        pass.set_pipeline(self.draw.0);
        pass.set_bind_group(0, &self.draw.1, &[]);
        pass.dispatch_workgroups(to_row(columns), to_row(rows), 1);
    }
}
