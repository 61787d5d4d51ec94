// Counts the numbers that were drawn: the twin of the processor's ledger.

@group(0) @binding(0) var<uniform> view: View;
@group(0) @binding(1) var numbers: texture_2d<u32>;
@group(0) @binding(2) var<storage, read> weights: array<u32>;
// First number of each body, and of the first thing after the bodies.
@group(0) @binding(3) var<storage, read> firsts: array<u32>;
// Counts of each number and, in the same way, of each body in each slot: the lower half of 64 bits, the upper half.
@group(0) @binding(4) var<storage, read_write> counts: array<atomic<u32>>;
@group(0) @binding(5) var<storage, read_write> seen: array<atomic<u32>>;

@compute @workgroup_size(8, 8)
fn count(@builtin(global_invocation_id) at: vec3u) {
    let pixels = vec2u(view.pixels);
    if at.x >= pixels.x || at.y >= pixels.y {
        return;
    }
    let number = textureLoad(numbers, at.xy, 0).r;
    var weight = 1u;
    if view.weighted == 1u {
        weight = weights[at.y * pixels.x + at.x];
    }
    let before = atomicAdd(&counts[2u * number], weight);
    if before + weight < before {
        atomicAdd(&counts[2u * number + 1u], 1u);
    }
    if number >= firsts[view.bodies] {
        return;
    }
    // The last body whose first number is not above this one.
    var low = 0u;
    var high = view.bodies;
    while high - low > 1u {
        let middle = (low + high) / 2u;
        if firsts[middle] <= number {
            low = middle;
        } else {
            high = middle;
        }
    }
    let place = 2u * (view.slot * view.bodies + low);
    let seen_before = atomicAdd(&seen[place], weight);
    if seen_before + weight < seen_before {
        atomicAdd(&seen[place + 1u], 1u);
    }
}
