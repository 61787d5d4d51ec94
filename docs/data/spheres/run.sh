#!/usr/bin/env bash
# The paper's round tablets with clumps of 10 to 400 spheres: one run for each, and the processor time it took.
# Runs that are done are not repeated. Usage: bash docs/data/spheres/run.sh [FOLDER] [further arguments of `pancoat run`]
# With another way of damping: bash docs/data/spheres/run.sh runs/spheres_contact --set "contact=(damping_mass: Contact)"
set -euo pipefail
cd "$(dirname "$0")/../../.."
out=${1:-runs/spheres}
shift || true
pancoat=${PANCOAT:-target/release/pancoat}
[ -x "$pancoat" ] || cargo build --release

TIMEFORMAT=%U
for spheres in ${COUNTS:-10 20 50 100 200 400}; do
    grep -qs '"status": *"done"' "$out/$spheres/run.json" && continue
    rm -rf "${out:?}/$spheres"
    mkdir -p "$out"
    { time "$pancoat" run round --set "shapes.round.spheres=$spheres" --threads 1 --quiet --out "$out/$spheres" "$@" >&3; } \
        3>&1 2>"$out/$spheres.cpu_s"
done
