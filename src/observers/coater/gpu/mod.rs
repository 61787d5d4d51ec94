//! The coater's frames drawn on a graphics card.
//!
//! The same candidates as on the processor, drawn into a target of whole numbers that is read back and counted there:
//! half a megabyte a frame, and every count, even or weighted, passes through one piece of code. Vulkan, Metal and D3D12
//! do not promise the same pixels on all hardware: vertices that fall to the other side of a step of the grid move single
//! pixels at the edges of panels, some in a hundred thousand.

mod setup;

use super::bed::Bed;
use super::film::PanelIds;
use super::painter::GpuError;
use super::view::{Placement, View};
use crate::scene::Rays;
use crate::stepping::Frame;
use bytemuck::{Pod, Zeroable};
use std::ops::Range;
use std::sync::{Arc, Mutex, PoisonError};

/// A graphics card and what it needs to draw a bed.
#[derive(Debug)]
pub(super) struct GpuRaster {
    name: String,
    device: wgpu::Device,
    queue: wgpu::Queue,
    /// For bodies, seen from outside, and for the drum, seen from both sides.
    pipelines: [wgpu::RenderPipeline; 2],
    bindings: wgpu::BindGroup,
    view: wgpu::Buffer,
    instances: wgpu::Buffer,
    target: wgpu::Texture,
    depth: wgpu::TextureView,
    image: wgpu::Buffer,
    pixels: [u32; 2],
    /// Corners of each shape and then of each part of the drum.
    corners: Vec<Range<u32>>,
    fault: Fault,
    ids: Vec<u32>,
}

/// The first thing that a device has reported.
type Fault = Arc<Mutex<Option<String>>>;

#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
struct GpuView {
    axis: [f32; 2],
    pixels: [f32; 2],
    distance: f32,
    near: f32,
    diverging: u32,
    unused: u32,
}

#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
struct Instance {
    rows: [[f32; 4]; 3],
    first_corner: u32,
    first_id: u32,
    ids_per_panel: u32,
    is_body: u32,
}

/// Instances of the same corners that follow each other.
#[derive(Debug)]
struct Run {
    drawn: usize,
    instances: Range<u32>,
    is_body: bool,
}

impl GpuRaster {
    /// What it is, for the record of a run.
    pub(super) fn name(&self) -> &str {
        &self.name
    }

    /// Draws a frame and gives the numbers seen, row by row.
    ///
    /// # Errors
    /// [`GpuError::Failed`].
    pub(super) fn draw(&mut self, bed: &Bed, view: &View, frame: &Frame<'_>) -> Result<&[u32], GpuError> {
        let (instances, runs) = self.instances(bed, view, frame);
        let lens = view.lens();
        let seen = GpuView {
            axis: lens.axis(),
            pixels: self.pixels.map(|size| size as f32),
            distance: lens.distance(),
            near: lens.near(),
            diverging: u32::from(lens.rays() == Rays::Diverging),
            unused: 0,
        };
        self.queue.write_buffer(&self.view, 0, bytemuck::bytes_of(&seen));
        self.queue.write_buffer(&self.instances, 0, bytemuck::cast_slice(&instances));
        let mut encoder = self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        self.encode_pass(&mut encoder, bed.ids().panels() + PanelIds::EMPTY, &runs);
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(setup::row_bytes(self.pixels)),
            rows_per_image: None,
        };
        let to = wgpu::TexelCopyBufferInfo { buffer: &self.image, layout };
        encoder.copy_texture_to_buffer(self.target.as_image_copy(), to, setup::extent(self.pixels));
        self.queue.submit([encoder.finish()]);
        self.read()?;
        Ok(&self.ids)
    }

    /// What is drawn, one shape after the other and then the drum: the instances, and which of them are of what.
    fn instances(&self, bed: &Bed, view: &View, frame: &Frame<'_>) -> (Vec<Instance>, Vec<Run>) {
        let mut candidates = Vec::new();
        bed.candidates(view, frame, self.pixels.map(|size| size.cast_signed() - 1), &mut candidates);
        candidates.sort_by_key(|candidate| bed.shape_of(candidate.body));
        let mut instances = Vec::with_capacity(candidates.len() + bed.drum_parts().len());
        let mut runs: Vec<Run> = Vec::new();
        let mut add = |drawn: usize, placement: &Placement, first_id: u32, is_body: bool| {
            let number = instances.len() as u32;
            match runs.last_mut() {
                Some(run) if run.drawn == drawn => run.instances.end = number + 1,
                _ => runs.push(Run { drawn, instances: number..number + 1, is_body }),
            }
            instances.push(Instance {
                rows: placement.rows(),
                first_corner: self.corners[drawn].start,
                first_id,
                ids_per_panel: u32::from(is_body),
                is_body: u32::from(is_body),
            });
        };
        for candidate in &candidates {
            add(bed.shape_of(candidate.body), &candidate.placement, bed.ids().id(candidate.body, 0), true);
        }
        let drum = view.place_turned(frame.drum_angle);
        let shapes = self.corners.len() - bed.drum_parts().len();
        for (k, (number, _)) in bed.drum_parts().iter().enumerate() {
            add(shapes + k, &drum, bed.ids().panels() + number, false);
        }
        (instances, runs)
    }

    fn encode_pass(&self, encoder: &mut wgpu::CommandEncoder, background: u32, runs: &[Run]) {
        let clear = wgpu::Color { r: f64::from(background), ..wgpu::Color::BLACK };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &self.target.create_view(&wgpu::TextureViewDescriptor::default()),
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(clear), store: wgpu::StoreOp::Store },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.depth,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(1.0),
                    store: wgpu::StoreOp::Discard,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_bind_group(0, &self.bindings, &[]);
        for run in runs {
            pass.set_pipeline(&self.pipelines[usize::from(!run.is_body)]);
            let corners = &self.corners[run.drawn];
            pass.draw(0..corners.end - corners.start, run.instances.clone());
        }
    }

    /// Reads the image back.
    fn read(&mut self) -> Result<(), GpuError> {
        // Whether it succeeded is seen when the range is taken.
        self.image.map_async(wgpu::MapMode::Read, .., |_| {});
        self.device
            .poll(wgpu::PollType::wait_indefinitely())
            .map_err(|error| GpuError::Failed(error.to_string()))?;
        self.check()?;
        self.ids.clear();
        {
            let image =
                self.image.get_mapped_range(..).map_err(|error| GpuError::Failed(error.to_string()))?;
            for row in image.chunks_exact(setup::row_bytes(self.pixels) as usize) {
                self.ids.extend_from_slice(bytemuck::cast_slice(&row[..4 * self.pixels[0] as usize]));
            }
        }
        self.image.unmap();
        self.check()
    }

    /// Whether the device has reported anything.
    fn check(&self) -> Result<(), GpuError> {
        let fault = self.fault.lock().unwrap_or_else(PoisonError::into_inner).take();
        fault.map_or(Ok(()), |message| Err(GpuError::Failed(message)))
    }
}
