// Draws numbers: the twin of the processor's raster. Vertices are fetched by number, so that a panel's own number follows
// from that of its first corner.

struct Instance {
    // Rows of the turn from body to camera axes, the position last.
    rows: array<vec4f, 3>,
    first_corner: u32,
    first_id: u32,
    // 1 for bodies, whose panels have numbers of their own, 0 for a part of the drum.
    ids_per_panel: u32,
    // Bodies are moved to the near plane, parts of the drum are cut by it.
    is_body: u32,
}

struct Corner {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(flat) id: u32,
}

@group(0) @binding(0) var<uniform> view: View;
@group(0) @binding(1) var<storage, read> vertices: array<vec4f>;
@group(0) @binding(2) var<storage, read> corners: array<u32>;
@group(0) @binding(3) var<storage, read> instances: array<Instance>;

// Parallel rays see what is nearer than this, m.
const FURTHEST: f32 = 16.0;

// Clip coordinates of a place on the screen, pixels; the centre of the first pixel is (0, 0).
fn clip(pixels: vec2f) -> vec2f {
    return ((pixels + 0.5) * 2.0 / view.pixels - 1.0) * vec2f(1.0, -1.0);
}

fn snapped(pixels: vec2f) -> vec2f {
    return round(pixels * 256.0) / 256.0;
}

@vertex
fn corner(@builtin(vertex_index) index: u32, @builtin(instance_index) number: u32) -> Corner {
    let instance = instances[number];
    let vertex = vertices[corners[instance.first_corner + index]];
    let camera = vec3f(dot(instance.rows[0], vertex), dot(instance.rows[1], vertex), dot(instance.rows[2], vertex));
    var away = camera.z;
    if instance.is_body == 1u {
        away = max(away, view.near);
    }
    var position: vec4f;
    if view.diverging == 0u {
        position = vec4f(clip(snapped(camera.xy + view.axis)), away / FURTHEST, 1.0);
    } else if instance.is_body == 1u {
        let pixels = camera.xy * (view.distance / away) + view.axis;
        position = vec4f(clip(snapped(pixels)), 1.0 - view.near / away, 1.0);
    } else {
        // Not divided yet: some corners may lie behind the nozzle.
        let pixels = camera.xy * view.distance + (view.axis + 0.5) * away;
        position = vec4f((pixels * 2.0 / view.pixels - away) * vec2f(1.0, -1.0), away - view.near, away);
    }
    return Corner(position, instance.first_id + index / 3u * instance.ids_per_panel);
}

@fragment
fn number(corner: Corner) -> @location(0) u32 {
    return corner.id;
}
