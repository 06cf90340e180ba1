#!/usr/bin/env bash
# Builds voxdag with warnings as errors and tests it, on a Debian 12 that has only git.
#
#   scripts/test.sh             formatting, the build under g++, the tests of what a change can break
#   scripts/test.sh --debug     also a Debug build of the library, with the tests of what writes files
#   scripts/test.sh --cost      also fails if compiling costs a third more than scripts/compile_cost.json says
#   scripts/test.sh --extended  also --debug, the library under clang and for browsers, voxdag-lab, OpenVDB,
#                               CUDA's code on the host, browsers, programs of others, jobs that are killed
#   scripts/test.sh --tidy      also builds each source by itself under clang, runs clang-tidy and looks
#                               for types that are defined twice
set -euo pipefail
cd "$(dirname "$0")/.."
. scripts/packages.sh

usage() { sed -n '2,11s/^# \{0,1\}//p' "$0"; }
extended=no debug=no tidy=no cost=()
for argument in "$@"; do
  case "$argument" in
    --debug) debug=yes ;;
    --cost) cost=(--limit ordinary) ;;
    --extended) extended=yes debug=yes ;;
    --tidy) tidy=yes ;;
    -h | --help) usage; exit 0 ;;
    *) usage >&2; exit 2 ;;
  esac
done

jobs=$(nproc)
echo "== packages"
install_packages "${voxdag_packages[@]}" "${voxdag_test_packages[@]}"

# Installs the npm packages of a folder. npm writes its copy of package-lock.json when it has installed
# all of them.
install_npm() {
  cd "$1" || return
  [ node_modules/.package-lock.json -nt package-lock.json ] ||
    npm ci --no-audit --no-fund --loglevel=error
}
# Some tests skip themselves without these packages.
if [ "$extended" = yes ]; then
  install_packages "${voxdag_extended_packages[@]}"
  (install_packages "${voxdag_browser_packages[@]}" && install_npm tests/browser) ||
    echo "Skipping the tests of the viewer in browsers: the browsers or the npm packages could not be installed"
  install_packages "${voxdag_interop_packages[@]}" ||
    echo "Skipping tests with programs of others: Debian's packages could not be installed"
  (install_npm tests/interop) ||
    echo "Skipping tests with programs of others: npm's packages could not be installed"
fi

echo "== clang-format"
find . -name '*.[ch]pp' -not -path './build*' -print0 |
  xargs -0 -r clang-format --dry-run -Werror

# The ordinary tests do without OpenVDB and nvcc, which take minutes to compile.
options=(-DVOXDAG_EXTENDED_TESTS=OFF -DVOXDAG_BUILD_LAB=OFF -DVOXDAG_CUDA=OFF -DCMAKE_DISABLE_FIND_PACKAGE_OpenVDB=ON)
[ "$extended" = no ] ||
  options=(-DVOXDAG_EXTENDED_TESTS=ON -DVOXDAG_BUILD_LAB=ON -DVOXDAG_CUDA=ON -DCMAKE_DISABLE_FIND_PACKAGE_OpenVDB=OFF)
if [ "$extended" = yes ]; then
  echo "== the program for browsers"
  install_packages "${voxdag_wasm_packages[@]}"
  cmake --preset wasm -DVOXDAG_BUILD_TESTS=ON >/dev/null
  cmake --build build/wasm --target voxdag_wasm wasm_tests -- -j "$jobs"
  options+=(-DVOXDAG_BROWSER_MODULE="$PWD/build/wasm/apps/wasm")
fi
echo "== g++"
cmake --preset release -DVOXDAG_WERROR=ON -DVOXDAG_PYTHON=ON "${options[@]}" >/dev/null
if [ "$extended" = yes ]; then
  cmake --build --preset release -- -j "$jobs"
else
  scripts/compile_cost.py "${cost[@]}" build/release -j "$jobs"
fi

if [ "$extended" = yes ]; then
  echo "== clang"
  cmake --preset clang -DVOXDAG_WERROR=ON -DVOXDAG_BUILD_APPS=OFF -DVOXDAG_BUILD_FUZZERS=ON >/dev/null
  cmake --build --preset clang -- -j "$jobs"
fi

if [ "$tidy" = yes ]; then
  echo "== clang, each source by itself"
  cmake --preset clang -DVOXDAG_WERROR=ON -DVOXDAG_BUILD_APPS=ON -DVOXDAG_BUILD_LAB=ON -DCMAKE_UNITY_BUILD=OFF >/dev/null
  cmake --build --preset clang -- -j "$jobs"

  echo "== clang-tidy"
  # The sources that the clang build compiles: optional parts only if their packages were found.
  sed -n 's/^ *"file": "\(.*\.cpp\)",\?$/\1/p' build/clang/compile_commands.json | sort -u |
    xargs -r -d '\n' -n 1 -P "$jobs" clang-tidy -p build/clang --quiet --warnings-as-errors='*'

  echo "== one definition of each type"
  cmake --preset odr >/dev/null
  cmake --build --preset odr -- -j "$jobs"
fi

# Tests real scenes too if they lie beside the checkout.
if [ -z "${VOXDAG_SCENES-}" ] && [ -f ../shared/scenes/unpack.sh ]; then
  bash ../shared/scenes/unpack.sh build/scenes
  export VOXDAG_SCENES=$PWD/build/scenes
fi

# run_tests PRESET [ctest option...]
run_tests() {
  ctest --preset "$1" -j "$jobs" --no-tests=error "${@:2}" || {
    echo "== the tests that failed, again, one by one: their output comes last"
    ctest --preset "$1" --rerun-failed -O build/rerun.log || true
    exit 1
  }
}
if [ "$debug" = yes ]; then
  echo "== tests of a Debug build"
  cmake --preset debug -DVOXDAG_WERROR=ON -DVOXDAG_CUDA=OFF >/dev/null
  cmake --build --preset debug --target library_tests -- -j "$jobs"
  run_tests debug -R "^(svdag|esvo|attributes|compact|wire|file|model|algebra|io|parallel|core)\."
fi
echo "== tests"
if [ "$extended" = yes ]; then
  run_tests release
  ctest --test-dir build/wasm --output-on-failure --no-tests=error
else
  run_tests release -LE extended
fi
