//! Taking hold of a graphics card and handing it the bed.

use super::super::film::PanelIds;
use super::{Bed, Counted, Fault, GpuCounter, GpuError, GpuView, Instance, PENDING, SprayGun};
use std::future::Future;
use std::ops::Range;
use std::pin::pin;
use std::sync::{Arc, PoisonError};
use std::task::{Context, Poll, Waker};

const IDS: wgpu::TextureFormat = wgpu::TextureFormat::R32Uint;
const DEPTHS: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
/// Smallest buffer, bytes: none may be empty.
const SMALLEST: usize = 256;

impl GpuCounter {
    /// A graphics card, or with `software` a program that acts as one.
    ///
    /// # Errors
    /// Any [`GpuError`] but [`GpuError::Disagrees`].
    pub(in super::super) fn new(bed: &Bed, gun: &SprayGun, software: bool) -> Result<Self, GpuError> {
        let (device, queue, name) = open(software)?;
        let fault = watch(&device);
        let pixels = gun.pixels();
        let (vertices, indices, corners) = geometry(bed);
        let bodies = bed.ids().bodies();
        let numbers = (bed.ids().panels() + PanelIds::OTHERS) as usize;
        let firsts: Vec<u32> =
            (0..bodies).map(|body| bed.ids().id(body, 0)).chain([bed.ids().panels()]).collect();

        let make = Maker { device: &device, queue: &queue };
        let view = make.buffer(size_of::<GpuView>(), wgpu::BufferUsages::UNIFORM);
        let instances =
            make.buffer((bodies + corners.len()) * size_of::<Instance>(), wgpu::BufferUsages::STORAGE);
        let (counts, seen) = (make.counted(numbers), make.counted(PENDING * bodies));
        let target = make.texture(pixels, IDS, wgpu::TextureUsages::TEXTURE_BINDING);
        let depth = make.texture(pixels, DEPTHS, wgpu::TextureUsages::empty());
        let draw = make.drawing();
        let count = make.counting();
        let [vertices, indices, weights, firsts] = [
            bytemuck::cast_slice(&vertices),
            bytemuck::cast_slice(&indices),
            bytemuck::cast_slice(gun.weights().unwrap_or(&[])),
            bytemuck::cast_slice(&firsts),
        ]
        .map(|content| make.filled(content));
        let draw_bindings = make.bindings(
            &draw[0].get_bind_group_layout(0),
            &[&view, &vertices, &indices, &instances].map(wgpu::Buffer::as_entire_binding),
        );
        let count_bindings = make.bindings(
            &count.get_bind_group_layout(0),
            &[
                view.as_entire_binding(),
                wgpu::BindingResource::TextureView(&target),
                weights.as_entire_binding(),
                firsts.as_entire_binding(),
                counts.on_card.as_entire_binding(),
                seen.on_card.as_entire_binding(),
            ],
        );
        let counter = Self {
            name,
            draw,
            draw_bindings,
            count,
            count_bindings,
            view,
            instances,
            target,
            depth,
            counts,
            seen,
            pixels,
            weighted: gun.weights().is_some(),
            corners,
            fault,
            device,
            queue,
        };
        counter.check()?;
        Ok(counter)
    }
}

/// A device, its queue and its name.
fn open(software: bool) -> Result<(wgpu::Device, wgpu::Queue, String), GpuError> {
    // wgpu panics where none of its back ends exists.
    if wgpu::Instance::enabled_backend_features().is_empty() {
        return Err(GpuError::NotBuilt);
    }
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let wanted = wgpu::RequestAdapterOptions {
        power_preference: wgpu::PowerPreference::HighPerformance,
        force_fallback_adapter: software,
        ..Default::default()
    };
    let adapter =
        now(instance.request_adapter(&wanted)).map_err(|error| GpuError::None(error.to_string()))?;
    let info = adapter.get_info();
    if info.device_type == wgpu::DeviceType::Cpu && !software {
        return Err(GpuError::Software(info.name));
    }
    // A bed of many tablets needs larger buffers than every card has.
    let offered = adapter.limits();
    let required_limits = wgpu::Limits {
        max_buffer_size: offered.max_buffer_size,
        max_storage_buffer_binding_size: offered.max_storage_buffer_binding_size,
        ..wgpu::Limits::default()
    };
    let descriptor = wgpu::DeviceDescriptor { required_limits, ..Default::default() };
    let (device, queue) =
        now(adapter.request_device(&descriptor)).map_err(|error| GpuError::Failed(error.to_string()))?;
    Ok((device, queue, format!("{} ({}, {})", info.name, info.backend, info.driver)))
}

/// Has a device note what goes wrong, in place of its panic.
fn watch(device: &wgpu::Device) -> Fault {
    let fault = Fault::default();
    let note = || {
        let fault = Arc::clone(&fault);
        move |message: String| {
            fault.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(message);
        }
    };
    let (failed, lost) = (note(), note());
    device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| failed(error.to_string())));
    device.set_device_lost_callback(move |_, message| lost(message));
    fault
}

/// Vertices of all shapes and of the drum, the vertices of all their corners, and which corners belong to what.
fn geometry(bed: &Bed) -> (Vec<[f32; 4]>, Vec<u32>, Vec<Range<u32>>) {
    let (mut vertices, mut indices, mut corners) = (Vec::new(), Vec::new(), Vec::new());
    let mut add = |first_vertex: usize, triangles: &[[u32; 3]]| {
        let first = indices.len() as u32;
        indices.extend(triangles.iter().flatten().map(|vertex| first_vertex as u32 + vertex));
        corners.push(first..indices.len() as u32);
    };
    let with_one = |[x, y, z]: [f32; 3]| [x, y, z, 1.0];
    for shape in 0..bed.shapes() {
        let (points, triangles) = bed.shape(shape);
        add(vertices.len(), triangles);
        vertices.extend(points.map(with_one));
    }
    for (_, triangles) in bed.drum_parts() {
        add(vertices.len(), triangles);
    }
    vertices.extend(bed.drum_points().map(with_one));
    (vertices, indices, corners)
}

/// Makes what lies on a card.
struct Maker<'a> {
    device: &'a wgpu::Device,
    queue: &'a wgpu::Queue,
}

impl Maker<'_> {
    fn buffer(&self, bytes: usize, usage: wgpu::BufferUsages) -> wgpu::Buffer {
        self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: bytes.max(SMALLEST) as u64,
            usage: usage | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        })
    }

    fn filled(&self, content: &[u8]) -> wgpu::Buffer {
        let buffer = self.buffer(content.len(), wgpu::BufferUsages::STORAGE);
        self.queue.write_buffer(&buffer, 0, content);
        buffer
    }

    /// Room for `numbers` counts, all 0.
    fn counted(&self, numbers: usize) -> Counted {
        let bytes = numbers * size_of::<u64>();
        let on_card = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC;
        Counted {
            on_card: self.buffer(bytes, on_card),
            readable: self.buffer(bytes, wgpu::BufferUsages::MAP_READ),
        }
    }

    fn texture(
        &self,
        [width, height]: [u32; 2],
        format: wgpu::TextureFormat,
        usage: wgpu::TextureUsages,
    ) -> wgpu::TextureView {
        let texture = self.device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: usage | wgpu::TextureUsages::RENDER_ATTACHMENT,
            view_formats: &[],
        });
        texture.create_view(&wgpu::TextureViewDescriptor::default())
    }

    fn bindings(
        &self,
        layout: &wgpu::BindGroupLayout,
        resources: &[wgpu::BindingResource<'_>],
    ) -> wgpu::BindGroup {
        let entries: Vec<_> = (0..)
            .zip(resources)
            .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource: resource.clone() })
            .collect();
        self.device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &entries })
    }

    fn shader(&self, source: &str) -> wgpu::ShaderModule {
        let source = wgpu::ShaderSource::Wgsl(source.into());
        self.device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source })
    }

    fn counting(&self) -> wgpu::ComputePipeline {
        let module = self.shader(concat!(include_str!("view.wgsl"), include_str!("count.wgsl")));
        self.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: None,
            layout: None,
            module: &module,
            entry_point: Some("count"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            cache: None,
        })
    }

    /// For bodies and for the drum.
    fn drawing(&self) -> [wgpu::RenderPipeline; 2] {
        let device = self.device;
        let module = self.shader(concat!(include_str!("view.wgsl"), include_str!("raster.wgsl")));
        let storage = wgpu::BufferBindingType::Storage { read_only: true };
        let kinds = [wgpu::BufferBindingType::Uniform, storage, storage, storage];
        let bindings = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: None,
            entries: &std::array::from_fn::<_, 4, _>(|k| wgpu::BindGroupLayoutEntry {
                binding: k as u32,
                visibility: wgpu::ShaderStages::VERTEX,
                ty: wgpu::BindingType::Buffer {
                    ty: kinds[k],
                    has_dynamic_offset: false,
                    min_binding_size: None,
                },
                count: None,
            }),
        });
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: None,
            bind_group_layouts: &[Some(&bindings)],
            immediate_size: 0,
        });
        [Some(wgpu::Face::Back), None].map(|cull_mode| {
            device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: None,
                layout: Some(&layout),
                vertex: wgpu::VertexState {
                    module: &module,
                    entry_point: Some("corner"),
                    compilation_options: wgpu::PipelineCompilationOptions::default(),
                    buffers: &[],
                },
                primitive: wgpu::PrimitiveState { cull_mode, ..Default::default() },
                depth_stencil: Some(wgpu::DepthStencilState {
                    format: DEPTHS,
                    depth_write_enabled: Some(true),
                    depth_compare: Some(wgpu::CompareFunction::Less),
                    stencil: wgpu::StencilState::default(),
                    bias: wgpu::DepthBiasState::default(),
                }),
                multisample: wgpu::MultisampleState::default(),
                fragment: Some(wgpu::FragmentState {
                    module: &module,
                    entry_point: Some("number"),
                    compilation_options: wgpu::PipelineCompilationOptions::default(),
                    targets: &[Some(IDS.into())],
                }),
                multiview_mask: None,
                cache: None,
            })
        })
    }
}

/// The value of a future that is ready at once, as all of wgpu's are outside browsers.
fn now<T>(future: impl Future<Output = T>) -> T {
    let mut future = pin!(future);
    loop {
        if let Poll::Ready(value) = future.as_mut().poll(&mut Context::from_waker(Waker::noop())) {
            return value;
        }
        std::thread::yield_now();
    }
}
