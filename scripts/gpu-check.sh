#!/usr/bin/env bash
# Builds voxdag for the CUDA device of this machine, runs the tests that need one, and measures rays
# per second into bench/results/DEVICE-NAME/. One call of under 8 minutes; no network where
# the packages are there. Needs the CUDA toolkit and a device.
#
#   scripts/gpu-check.sh           build, tests, measurements
#   scripts/gpu-check.sh --tests   build and tests
#
# Crytek Sponza is measured where VOXDAG_SCENES names a folder with sponza.obj, or the scenes lie
# packed beside the checkout; a procedural courtyard always.
set -euo pipefail
cd "$(dirname "$0")/.."
. scripts/packages.sh

measure=yes
case "${1-}" in
  "") ;;
  --tests) measure=no ;;
  *) sed -n '2,12s/^# \{0,1\}//p' "$0"; [ "$1" = --help ] && exit 0; exit 2 ;;
esac

# What is left of the time, for the commands that may take long.
deadline=$((SECONDS + 470))
within() { timeout --foreground $((deadline - SECONDS > 5 ? deadline - SECONDS : 5)) "$@"; }

export PATH="$PATH:/usr/local/cuda/bin"
command -v nvcc >/dev/null || { echo "gpu-check: there is no nvcc" >&2; exit 1; }
device=$(nvidia-smi --query-gpu=name --format=csv,noheader | head -n 1)
capability=$(nvidia-smi --query-gpu=compute_cap --format=csv,noheader | head -n 1)
[ -n "$device" ] || { echo "gpu-check: nvidia-smi finds no device" >&2; exit 1; }
folder=bench/results/$(tr '[:upper:]' '[:lower:]' <<<"$device" | tr -cs 'a-z0-9\n' -)
echo "== $device, compute capability $capability"

echo "== build"
build=build/cuda-check
configure() {
  cmake -S . -B $build -G Ninja -DCMAKE_BUILD_TYPE=Release -DVOXDAG_CUDA=ON \
    -DVOXDAG_BUILD_TESTS=ON -DVOXDAG_BUILD_BENCH=OFF \
    -DCMAKE_CUDA_ARCHITECTURES="${capability/./}-real" >$build-configure.log 2>&1
}
mkdir -p build
if ! configure; then
  install_packages "${voxdag_packages[@]}" libgtest-dev zstd
  configure || { cat $build-configure.log >&2; exit 1; }
fi
within cmake --build $build --target voxdag_app cuda_tests -- -j "$(nproc)"
voxdag() { within $build/apps/voxdag/voxdag "$@"; }

echo "== tests"
within $build/tests/cuda/cuda_tests --gtest_brief=1
scene=$build/courtyard
voxdag scene courtyard -o $scene.ply
voxdag build $scene.ply -r 2048 -o $scene.vdag
for where in cpu cuda; do
  voxdag render $scene.vdag -o $scene-$where.png --size 960x540 --device $where
done
[ $measure = yes ] || exit 0

# bench NAME FILE MESH LAYOUTS
bench() {
  echo "== $1"
  voxdag bench trace "$2" --mesh "$3" --device cuda --layout "$4" --size 1920x1080 --rays 8000000 \
    -o "$folder/$1.json"
}
mkdir -p "$folder"
bench courtyard-2048 $scene.vdag $scene.ply paper,wide

scenes=${VOXDAG_SCENES-}
if [ -z "$scenes" ] && [ -f ../shared/scenes/unpack.sh ]; then
  within bash ../shared/scenes/unpack.sh build/scenes
  scenes=build/scenes
fi
sponza=
[ -z "$scenes" ] || sponza=$(find "$scenes" -name sponza.obj -print -quit)
if [ -z "$sponza" ]; then
  echo "Crytek Sponza is not measured: VOXDAG_SCENES names no folder with sponza.obj" >&2
else
  for resolution in 4096 32768; do
    voxdag build "$sponza" -r $resolution -o $build/sponza.vdag
    bench sponza-$resolution $build/sponza.vdag "$sponza" paper,wide
  done
  voxdag build "$sponza" -r 1024 -o $build/sponza.esvo
  bench sponza-1024-esvo $build/sponza.esvo "$sponza" contours
fi
echo "== done in $SECONDS s: $folder"
