#!/usr/bin/env bash
# All checks, on a fresh machine with Rust and, as root, apt-get: formats, lints, docs, tests, physics verification, and
# the report looked at in a real browser. Where Chromium is there already, nothing is installed.
set -euo pipefail
cd "$(dirname "$0")/.."

if ! command -v chromium > /dev/null && command -v apt-get > /dev/null && [ "$(id -u)" = 0 ]; then
    apt-get update -qq
    apt-get install -y -qq --no-install-recommends chromium > /dev/null
fi
export REQUIRE_CHROMIUM=${REQUIRE_CHROMIUM-1}

cargo fmt --check
cargo clippy --release --all-targets -- -D warnings
RUSTDOCFLAGS="-D warnings" cargo doc --release --no-deps --document-private-items
cargo test --release
