// What drawing and counting share of a frame.

struct View {
    // Where the axis is on the screen, pixels.
    axis: vec2f,
    // Columns and rows.
    pixels: vec2f,
    // Nozzle to zone and nozzle to near plane, m.
    distance: f32,
    near: f32,
    diverging: u32,
    // Where this frame's counts of bodies go.
    slot: u32,
    bodies: u32,
    // 1 when pixels have weights.
    weighted: u32,
    unused: vec2u,
}

