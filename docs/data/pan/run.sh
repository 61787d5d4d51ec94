#!/usr/bin/env bash
# Varies the assumed pan by 20 %: one run for each dimension up and down, and the assumed pan with three seeds.
# Runs that are done are not repeated. Usage: bash docs/data/pan/run.sh [FOLDER] [further arguments of `pancoat run`]
set -euo pipefail
cd "$(dirname "$0")/../../.."
out=${1:-runs/pan}
shift || true
pancoat=${PANCOAT:-target/release/pancoat}
[ -x "$pancoat" ] || cargo build --release

case_() {
    name=$1
    shift
    grep -qs '"status": *"done"' "$out/$name/run.json" && return
    rm -rf "${out:?}/$name"
    # 20 spheres a tablet: half the cost of the scene's 50; docs/accuracy.md says what that changes.
    "$pancoat" run round --set shapes.round.spheres=20 --out "$out/$name" --quiet "$@"
}

case_ assumed "$@"
case_ diameter_less --set 'drum.diameter=Mm(200)' "$@"
case_ diameter_more --set 'drum.diameter=Mm(300)' "$@"
case_ width_less --set 'drum.width=Mm(80)' "$@"
case_ width_more --set 'drum.width=Mm(120)' "$@"
case_ baffles_less --set 'drum.baffles.height=Mm(9.6)' "$@"
case_ baffles_more --set 'drum.baffles.height=Mm(14.4)' "$@"
case_ assumed_seed_2 --set seed=2 "$@"
case_ assumed_seed_3 --set seed=3 "$@"
