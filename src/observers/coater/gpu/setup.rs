//! Taking hold of a graphics card and handing it the bed.

use super::{Bed, Fault, GpuError, GpuRaster, GpuView, Instance};
use std::future::Future;
use std::ops::Range;
use std::pin::pin;
use std::sync::{Arc, PoisonError};
use std::task::{Context, Poll, Waker};

const IDS: wgpu::TextureFormat = wgpu::TextureFormat::R32Uint;
const DEPTHS: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

impl GpuRaster {
    /// A graphics card, or with `software` a program that acts as one.
    ///
    /// # Errors
    /// Any [`GpuError`] but [`GpuError::Disagrees`].
    pub(in super::super) fn new(bed: &Bed, pixels: [u32; 2], software: bool) -> Result<Self, GpuError> {
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
        let (device, queue) = now(adapter.request_device(&wgpu::DeviceDescriptor::default()))
            .map_err(|error| GpuError::Failed(error.to_string()))?;
        let fault = watch(&device);

        let (vertices, indices, corners) = geometry(bed);
        let buffer = |bytes: usize, usage| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: None,
                size: bytes.max(size_of::<Instance>()) as u64,
                usage: usage | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        };
        let storage = wgpu::BufferUsages::STORAGE;
        let filled = |content: &[u8]| {
            let filled = buffer(content.len(), storage);
            queue.write_buffer(&filled, 0, content);
            filled
        };
        let instances = buffer((bed.ids().bodies() + corners.len()) * size_of::<Instance>(), storage);
        let view = buffer(size_of::<GpuView>(), wgpu::BufferUsages::UNIFORM);
        let pipelines = pipelines(&device);
        let resources = [
            &view,
            &filled(bytemuck::cast_slice(&vertices)),
            &filled(bytemuck::cast_slice(&indices)),
            &instances,
        ];
        let raster = Self {
            name: format!("{} ({}, {})", info.name, info.backend, info.driver),
            bindings: device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: None,
                layout: &pipelines[0].get_bind_group_layout(0),
                entries: &std::array::from_fn::<_, 4, _>(|k| wgpu::BindGroupEntry {
                    binding: k as u32,
                    resource: resources[k].as_entire_binding(),
                }),
            }),
            target: texture(&device, pixels, IDS, wgpu::TextureUsages::COPY_SRC),
            depth: texture(&device, pixels, DEPTHS, wgpu::TextureUsages::empty())
                .create_view(&wgpu::TextureViewDescriptor::default()),
            image: buffer(row_bytes(pixels) as usize * pixels[1] as usize, wgpu::BufferUsages::MAP_READ),
            ids: Vec::with_capacity(pixels.map(|size| size as usize).iter().product()),
            pipelines,
            view,
            instances,
            pixels,
            corners,
            fault,
            device,
            queue,
        };
        raster.check()?;
        Ok(raster)
    }
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

fn pipelines(device: &wgpu::Device) -> [wgpu::RenderPipeline; 2] {
    let module = device.create_shader_module(wgpu::include_wgsl!("raster.wgsl"));
    let storage = wgpu::BufferBindingType::Storage { read_only: true };
    let kinds = [wgpu::BufferBindingType::Uniform, storage, storage, storage];
    let bindings = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: None,
        entries: &std::array::from_fn::<_, 4, _>(|k| wgpu::BindGroupLayoutEntry {
            binding: k as u32,
            visibility: wgpu::ShaderStages::VERTEX,
            ty: wgpu::BindingType::Buffer { ty: kinds[k], has_dynamic_offset: false, min_binding_size: None },
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

fn texture(
    device: &wgpu::Device,
    pixels: [u32; 2],
    format: wgpu::TextureFormat,
    usage: wgpu::TextureUsages,
) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: extent(pixels),
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: usage | wgpu::TextureUsages::RENDER_ATTACHMENT,
        view_formats: &[],
    })
}

pub(super) fn extent([width, height]: [u32; 2]) -> wgpu::Extent3d {
    wgpu::Extent3d { width, height, depth_or_array_layers: 1 }
}

/// Bytes from a row of the image to the next.
pub(super) fn row_bytes(pixels: [u32; 2]) -> u32 {
    (4 * pixels[0]).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT)
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
