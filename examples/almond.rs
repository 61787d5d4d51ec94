//! The almond-shaped tablets of `scenes/almond.ron` through the library: `cargo run --release --example almond -- 5` sprays for 5 s.
#![expect(clippy::print_stdout, reason = "an example prints its result")]

#[path = "common/coat.rs"]
mod coat;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    coat::coat("almond")
}
