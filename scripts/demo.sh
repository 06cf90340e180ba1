#!/usr/bin/env bash
# Builds voxdag on a Debian 12 that has only git, makes a procedural scene, voxelizes it at 8192³,
# prints the summary, and renders the picture demo.png.
set -euo pipefail
cd "$(dirname "$0")/.."
. scripts/packages.sh

# say STEP: prints what comes next, and the time since the start.
say() { printf '== %d:%02d  %s\n' $((SECONDS / 60)) $((SECONDS % 60)) "$1"; }
echo "This builds voxdag and renders demo.png: some 5 minutes on two cores; installing packages takes 2 to 5 more."

say "Debian's packages"
install_packages "${voxdag_packages[@]}"
say "build voxdag"
cmake -S . -B build/demo -G Ninja -DCMAKE_BUILD_TYPE=Release -DVOXDAG_BUILD_TESTS=OFF >/dev/null
cmake --build build/demo -- -j "$(nproc)"

voxdag() { build/demo/apps/voxdag/voxdag "$@"; }
say "a procedural scene, voxelized at 8192³"
voxdag scene courtyard -o build/demo/courtyard.ply
voxdag build build/demo/courtyard.ply -r 8192 -o build/demo/courtyard.vdag
say "the picture"
# shellcheck disable=SC2046  # the view is several words
voxdag render build/demo/courtyard.vdag -o demo.png --size 1920x1080 --samples 4 \
  $(voxdag scene courtyard --view)
say "done: demo.png"
