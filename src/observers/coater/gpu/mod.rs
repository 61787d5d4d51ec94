//! The coater's frames drawn and counted on a graphics card.
//!
//! The same candidates as on the processor, drawn into a target of whole numbers and counted there, where the counts of
//! panels add up over frames, in 64 bits, until they are asked for; only the counts of bodies come back with each batch of
//! frames. Vulkan, Metal and D3D12 do not promise the same pixels on all hardware: vertices that fall to the other side of
//! a step of the grid move single pixels at the edges of panels, some in a hundred thousand.

mod setup;

use super::bed::Bed;
use super::counter::{GpuError, PENDING};
use super::film::PanelIds;
use super::gun::SprayGun;
use super::ledger::Exposure;
use super::view::{Placement, View};
use crate::scene::Rays;
use crate::stepping::Frame;
use bytemuck::{Pod, Zeroable};
use std::ops::Range;
use std::sync::{Arc, Mutex, PoisonError};

/// A graphics card and what it needs to draw and count a bed.
#[derive(Debug)]
pub(super) struct GpuCounter {
    name: String,
    device: wgpu::Device,
    queue: wgpu::Queue,
    /// For bodies, seen from outside, and for the drum, seen from both sides.
    draw: [wgpu::RenderPipeline; 2],
    draw_bindings: wgpu::BindGroup,
    count: wgpu::ComputePipeline,
    count_bindings: wgpu::BindGroup,
    view: wgpu::Buffer,
    instances: wgpu::Buffer,
    target: wgpu::TextureView,
    depth: wgpu::TextureView,
    counts: Counted,
    seen: Counted,
    pixels: [u32; 2],
    weighted: bool,
    /// Corners of each shape and then of each part of the drum.
    corners: Vec<Range<u32>>,
    fault: Fault,
}

/// Counts of 64 bits on the card, and where they are read from.
#[derive(Debug)]
struct Counted {
    on_card: wgpu::Buffer,
    readable: wgpu::Buffer,
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
    slot: u32,
    bodies: u32,
    weighted: u32,
    unused: [u32; 2],
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

impl GpuCounter {
    /// What it is, for the record of a run.
    pub(super) fn name(&self) -> &str {
        &self.name
    }

    /// Counts at most [`PENDING`] frames and gives the bodies seen in each.
    ///
    /// # Errors
    /// [`GpuError::Failed`].
    pub(super) fn count(
        &mut self,
        bed: &Bed,
        gun: &SprayGun,
        frames: &[&Frame<'_>],
    ) -> Result<Vec<Vec<Exposure>>, GpuError> {
        let mut encoder = self.encoder();
        encoder.clear_buffer(&self.seen.on_card, 0, None);
        self.queue.submit([encoder.finish()]);
        for (slot, frame) in (0..).zip(frames) {
            for view in gun.views(frame.index) {
                self.submit(bed, &view, frame, slot);
            }
        }
        let seen = self.read(&self.seen)?;
        let bodies = bed.ids().bodies();
        let exposed = |counts: &[u64]| {
            let bodies = counts.iter().enumerate().filter(|(_, counts)| **counts > 0);
            bodies.map(|(body, &counts)| Exposure { body, counts }).collect()
        };
        Ok((0..frames.len()).map(|slot| exposed(&seen[slot * bodies..][..bodies])).collect())
    }

    /// Counts of every number since they were last collected.
    ///
    /// # Errors
    /// [`GpuError::Failed`].
    pub(super) fn collect(&mut self) -> Result<Vec<u64>, GpuError> {
        let counts = self.read(&self.counts)?;
        let mut encoder = self.encoder();
        encoder.clear_buffer(&self.counts.on_card, 0, None);
        self.queue.submit([encoder.finish()]);
        Ok(counts)
    }

    /// Loses the device.
    #[cfg(test)]
    pub(super) fn lose(&self) {
        self.device.destroy();
    }

    fn encoder(&self) -> wgpu::CommandEncoder {
        self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default())
    }

    /// Has a view drawn and counted; does not wait for it.
    fn submit(&self, bed: &Bed, view: &View, frame: &Frame<'_>, slot: u32) {
        let (instances, runs) = self.instances(bed, view, frame);
        let lens = view.lens();
        let seen = GpuView {
            axis: lens.axis(),
            pixels: self.pixels.map(|size| size as f32),
            distance: lens.distance(),
            near: lens.near(),
            diverging: u32::from(lens.rays() == Rays::Diverging),
            slot,
            bodies: bed.ids().bodies() as u32,
            weighted: u32::from(self.weighted),
            unused: [0; 2],
        };
        self.queue.write_buffer(&self.view, 0, bytemuck::bytes_of(&seen));
        self.queue.write_buffer(&self.instances, 0, bytemuck::cast_slice(&instances));
        let mut encoder = self.encoder();
        self.encode_drawing(&mut encoder, bed.ids().panels() + PanelIds::EMPTY, &runs);
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        pass.set_pipeline(&self.count);
        pass.set_bind_group(0, &self.count_bindings, &[]);
        let [across, down] = self.pixels.map(|size| size.div_ceil(8));
        pass.dispatch_workgroups(across, down, 1);
        drop(pass);
        self.queue.submit([encoder.finish()]);
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

    fn encode_drawing(&self, encoder: &mut wgpu::CommandEncoder, background: u32, runs: &[Run]) {
        let clear = wgpu::Color { r: f64::from(background), ..wgpu::Color::BLACK };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &self.target,
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
        pass.set_bind_group(0, &self.draw_bindings, &[]);
        for run in runs {
            pass.set_pipeline(&self.draw[usize::from(!run.is_body)]);
            let corners = &self.corners[run.drawn];
            pass.draw(0..corners.end - corners.start, run.instances.clone());
        }
    }

    /// Waits for all that was submitted and reads counts.
    fn read(&self, counted: &Counted) -> Result<Vec<u64>, GpuError> {
        let failed = |error: &dyn std::fmt::Display| GpuError::Failed(error.to_string());
        let mut encoder = self.encoder();
        encoder.copy_buffer_to_buffer(&counted.on_card, 0, &counted.readable, 0, None);
        self.queue.submit([encoder.finish()]);
        // Whether it succeeded is seen when the range is taken.
        counted.readable.map_async(wgpu::MapMode::Read, .., |_| {});
        self.device.poll(wgpu::PollType::wait_indefinitely()).map_err(|error| failed(&error))?;
        self.check()?;
        let counts = {
            let range = counted.readable.get_mapped_range(..).map_err(|error| failed(&error))?;
            bytemuck::pod_collect_to_vec::<u8, u64>(&range)
        };
        counted.readable.unmap();
        self.check()?;
        Ok(counts)
    }

    /// Whether the device has reported anything.
    fn check(&self) -> Result<(), GpuError> {
        let fault = self.fault.lock().unwrap_or_else(PoisonError::into_inner).take();
        fault.map_or(Ok(()), |message| Err(GpuError::Failed(message)))
    }
}
