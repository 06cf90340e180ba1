#!/usr/bin/env bash
# Builds voxdag for the CUDA device of this machine, runs the tests that need a device, and measures
# rays per second, pictures, and both papers again on coarse grids, for at most 10 minutes. Needs no
# network if the packages are installed.
#
#   scripts/gpu-check.sh [OPTION...]
#     --tests        builds and tests, measures nothing
#     --sanitize     also runs the tests under compute-sanitizer
#     --out FOLDER   folder of the results (default: lab/results/DEVICE-NAME)
#     --pack FILE    builds for all devices, and packs the programs, their libraries and the scenes
#                    into FILE, a .tar.gz; needs the CUDA toolkit, but no device
#     --packed FILE  tests and measures the packed programs; needs only the driver, and a C library
#                    that is not older than the one of the packing machine
#
# Measures a procedural courtyard, and Crytek Sponza if VOXDAG_SCENES names a folder with sponza.obj
# or the packed scenes lie beside the checkout.
set -euo pipefail

usage() { sed -n '2,16s/^# \{0,1\}//p' "$0"; }
die() { echo "gpu-check: $*" >&2; exit 1; }

measure=yes sanitize=no folder='' pack='' packed=''
while [ $# -gt 0 ]; do
  case $1 in
    --tests) measure=no ;;
    --sanitize) sanitize=yes ;;
    --out | --pack | --packed)
      [ $# -ge 2 ] || { usage >&2; exit 2; }
      file=$(realpath -m -- "$2")
      case $1 in --out) folder=$file ;; --pack) pack=$file ;; *) packed=$file ;; esac
      shift ;;
    -h | --help) usage; exit 0 ;;
    *) usage >&2; exit 2 ;;
  esac
  shift
done
cd "$(dirname "$0")/.."
. scripts/packages.sh
export PATH="$PATH:/usr/local/cuda/bin"

# Runs a command, limited to the time that is left.
deadline=$((SECONDS + 570))
[ -z "$pack" ] || deadline=$((SECONDS + 7200))
within() { timeout --foreground $((deadline - SECONDS > 5 ? deadline - SECONDS : 5)) "$@"; }

# build FOLDER [CMAKE-OPTION...]: builds the programs in FOLDER.
build() {
  local build=$1
  local configure=(cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DVOXDAG_CUDA=ON
    -DVOXDAG_BUILD_TESTS=ON -DVOXDAG_BUILD_LAB=ON "${@:2}")
  command -v nvcc >/dev/null || die "there is no nvcc; see --pack"
  echo "== build"
  mkdir -p build
  if ! "${configure[@]}" >"$build-configure.log" 2>&1; then
    install_packages "${voxdag_packages[@]}" libgtest-dev zstd ||
      die "packages are missing that cannot be installed; see --pack"
    "${configure[@]}" >"$build-configure.log" 2>&1 ||
      { cat "$build-configure.log" >&2; exit 1; }
  fi
  local targets=(voxdag_app voxdag_lab cuda_tests)
  # This target exists only if OpenVDB and NanoVDB are installed.
  if ninja -C "$build" -t query voxdag_rival_nanovdb_trace >/dev/null 2>&1; then
    targets+=(voxdag_rival_nanovdb_trace)
  fi
  within cmake --build "$build" --target "${targets[@]}" -- -j "$(nproc)"
}

# Prints the path of sponza.obj, or nothing.
find_sponza() {
  local scenes=${VOXDAG_SCENES-}
  if [ -z "$scenes" ] && [ -f ../shared/scenes/unpack.sh ]; then
    scenes=build/scenes
    within bash ../shared/scenes/unpack.sh $scenes >&2
  fi
  [ -z "$scenes" ] || find "$scenes" -name sponza.obj -print -quit
}

if [ -n "$pack" ]; then
  build build/cuda-pack
  content=build/cuda-pack/content
  rm -rf $content
  mkdir -p $content/lib
  programs=($content/voxdag $content/voxdag-lab $content/cuda_tests)
  cp build/cuda-pack/apps/voxdag/voxdag build/cuda-pack/apps/voxdag/voxdag-lab build/cuda-pack/tests/cuda_tests $content
  if [ -x build/cuda-pack/lab/rival_nanovdb_trace ]; then
    cp build/cuda-pack/lab/rival_nanovdb_trace $content
    programs+=($content/rival_nanovdb_trace)
  fi
  cp -r lab/report $content
  strip "${programs[@]}"
  ! ldd "${programs[@]}" | grep "not found" || die "libraries are missing"
  # Copies all libraries except the C library, which must match the loader of the other machine.
  ldd "${programs[@]}" | awk '$3 ~ "^/" { print $3 }' | sort -u |
    grep -vE '/(lib(c|m|dl|rt|pthread|resolv|mvec)|ld-linux[^/]*)\.so' | xargs cp -Lt $content/lib
  sponza=$(find_sponza)
  if [ -n "$sponza" ]; then
    cp "$sponza" $content
    # The packed materials name no textures, which would be too large. The rays do not see them.
    materials=${sponza%.obj}.mtl
    [ ! -f "$materials" ] || sed -E '/^[[:space:]]*(map_|bump|disp|refl)/d' "$materials" >$content/sponza.mtl
  fi
  tar -C $content -czf "$pack" .
  echo "== done: $(du -h "$pack" | cut -f 1) in $pack"
  exit 0
fi

device=$(nvidia-smi --query-gpu=name --format=csv,noheader | head -n 1) || true
capability=$(nvidia-smi --query-gpu=compute_cap --format=csv,noheader | head -n 1) || true
[ -n "$device" ] || die "nvidia-smi finds no device"
echo "== $device, compute capability $capability"
: "${folder:=lab/results/$(tr '[:upper:]' '[:lower:]' <<<"$device" | tr -cs 'a-z0-9\n' -)}"

work=build/cuda-check
if [ -n "$packed" ]; then
  work=build/cuda-packed
  rm -rf $work
  mkdir -p $work
  tar -C $work -xzf "$packed"
  program=$work/voxdag tests=$work/cuda_tests
  nanovdb=$work/rival_nanovdb_trace
  libraries=$PWD/$work/lib
else
  build $work -DCMAKE_CUDA_ARCHITECTURES="${capability/./}-real"
  program=$work/apps/voxdag/voxdag tests=$work/tests/cuda_tests libraries=
  nanovdb=$work/lab/rival_nanovdb_trace
fi
[ -z "${LD_LIBRARY_PATH-}" ] || libraries=${libraries:+$libraries:}$LD_LIBRARY_PATH
ours() { within env LD_LIBRARY_PATH="$libraries" "$@"; }
voxdag() { ours $program "$@"; }

# attempt COMMAND...: runs the command; counts a failure and continues.
failures=0
attempt() { "$@" || { echo "gpu-check: FAILED: $*" >&2; failures=$((failures + 1)); }; }

echo "== tests"
attempt ours $tests --gtest_brief=1
if [ $sanitize = yes ]; then
  attempt ours compute-sanitizer --error-exitcode 1 $tests --gtest_brief=1 \
    --gtest_filter='CudaTimedCasts.*:CudaTrace.Stops*:CudaRender.Filters*:CudaRender.AnEmpty*:CudaStreaming.IsThePicture*'
fi
scene=$work/courtyard
voxdag scene courtyard -o $scene.ply
voxdag build $scene.ply -r 2048 -o $scene.vdag
mkdir -p "$folder"
for where in cpu cuda; do
  attempt voxdag render $scene.vdag -o "$folder/courtyard-$where.png" --size 960x540 --device $where
done

# Fails if a hit of the device differs from the CPU's.
hits_agree() {
  awk -F '[:,]' '/"rival":/ { ours = $2 ~ "voxdag_cpu" } /"rival_agreement":/ && ours && $2 != 1 { exit 1 }' "$1"
}
# bench NAME FILE OPTION...: measures rays per second; fails if a hit differs from the CPU's.
bench() {
  echo "== $1"
  attempt voxdag bench trace "$2" --device cuda --size 1920x1080 --views 2 "${@:3}" -o "$folder/$1.json"
  [ ! -f "$folder/$1.json" ] || attempt hits_agree "$folder/$1.json"
}
# bench_esvo NAME MESH: measures rays per second at ESVOs of 1024³; fails if a hit differs from the
# CPU's.
bench_esvo() {
  echo "== $1"
  attempt voxdag bench esvo "$1=$2" -r 1024 --views 2 --device cuda -o "$folder/$1.json"
}
if [ $measure = yes ]; then
  nvidia-smi --query-gpu=name,driver_version,clocks.sm,clocks.max.sm --format=csv || true
  if [ -n "$packed" ]; then sponza=$(find $work -name sponza.obj); else sponza=$(find_sponza); fi
  if [ -z "$sponza" ]; then
    echo "Crytek Sponza is not measured: VOXDAG_SCENES names no folder with sponza.obj" >&2
  else
    for resolution in 32768 4096; do
      attempt voxdag build "$sponza" -r $resolution -o $work/sponza-$resolution.vdag
      bench sponza-$resolution $work/sponza-$resolution.vdag --mesh "$sponza" --layout paper \
        --rays 8000000
      bench sponza-$resolution-top $work/sponza-$resolution.vdag --layout paper,top --rays 8000000
    done
    # Rays that end at voxels, and NanoVDB with the same rays.
    if [ -x $nanovdb ]; then
      bench sponza-4096-nanovdb $work/sponza-4096.vdag --nanovdb $nanovdb --lod 0 --layout paper \
        --rays 4000000
    else
      echo "NanoVDB is not measured: OpenVDB or NanoVDB was not found" >&2
    fi
    for where in cpu cuda; do
      attempt voxdag render $work/sponza-4096.vdag -o $work/sponza-$where.png --size 3840x2160 \
        --device $where
    done
    cmp $work/sponza-cpu.png $work/sponza-cuda.png && echo "both pictures are equal"
    attempt voxdag build "$sponza" -r 1024 -o $work/sponza.esvo
    bench sponza-1024-esvo $work/sponza.esvo --mesh "$sponza" --layout contours,cubes --rays 8000000
    bench_esvo sponza-rates "$sponza"
  fi
  bench courtyard-2048 $scene.vdag --mesh $scene.ply --layout paper,top --rays 8000000
  bench_esvo courtyard-rates $scene.ply
  echo "== papers"
  attempt voxdag bench papers --quick --device cuda -o $work/papers
  if [ -f $work/papers/report.md ]; then
    ! grep -F "differ from the CPU's" $work/papers/report.md || failures=$((failures + 1))
    cp $work/papers/report.json "$folder/papers.json"
    echo "the report: $work/papers/report.html"
  fi
  echo "== results: $folder"
fi
echo "== done in $SECONDS s, $failures failures"
[ $failures -eq 0 ]
