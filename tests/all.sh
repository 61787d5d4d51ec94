#!/usr/bin/env bash
# All checks, on a fresh machine with Rust and, as root, apt-get: formats, lints, docs, tests, physics verification, the
# report looked at in a real browser, and the coater on a software graphics card. What is there already is not installed.
set -euo pipefail
cd "$(dirname "$0")/.."

if ! command -v chromium > /dev/null && command -v apt-get > /dev/null && [ "$(id -u)" = 0 ]; then
    apt-get update -qq
    apt-get install -y -qq --no-install-recommends chromium > /dev/null
fi
export REQUIRE_CHROMIUM=${REQUIRE_CHROMIUM-1}

# A program that acts as a graphics card, for the coater's other backend.
if ! ls /usr/share/vulkan/icd.d/lvp_icd* > /dev/null 2>&1 && command -v apt-get > /dev/null && [ "$(id -u)" = 0 ]; then
    apt-get update -qq
    apt-get install -y -qq --no-install-recommends mesa-vulkan-drivers libvulkan1 > /dev/null
fi
export REQUIRE_GPU=${REQUIRE_GPU-1}
# Mesa complains without one.
export XDG_RUNTIME_DIR=${XDG_RUNTIME_DIR-/tmp}

cargo fmt --check
cargo clippy --release --all-targets -- -D warnings
RUSTDOCFLAGS="-D warnings" cargo doc --release --no-deps --document-private-items
cargo test --release

# The same bits with and without optimisation.
bits=$(mktemp -d)
for profile in dev release; do
    cargo run --profile $profile -- run scenes/verification/small_bed.ron --quiet --out "$bits/$profile"
    grep state_hash "$bits/$profile/run.json" > "$bits/$profile.txt"
done
diff "$bits/dev.txt" "$bits/release.txt"
rm -r "$bits"

cargo clippy --release --features gpu --lib --test coating -- -D warnings
cargo test --release --features gpu --lib observers::coater
cargo test --release --features gpu --test coating
