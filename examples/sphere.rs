//! The spherical tablets of `scenes/sphere.ron` through the library: `cargo run --release --example sphere -- 5` sprays for 5 s.
#![expect(clippy::print_stdout, reason = "an example prints its result")]

#[path = "common/coat.rs"]
mod coat;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    coat::coat("sphere")
}
