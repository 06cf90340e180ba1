#!/usr/bin/env bash
# Builds voxdag with warnings as errors and runs every test, on a Debian 12 that has only git.
#
#   scripts/test.sh           formatting, the library under clang, everything under g++, the tests
#   scripts/test.sh --tidy    also builds the programs under clang, runs clang-tidy and looks for
#                             types that are defined twice (takes minutes more)
set -euo pipefail
cd "$(dirname "$0")/.."
. scripts/packages.sh

usage() { sed -n '2,6s/^# \{0,1\}//p' "$0"; }
tidy=no
case "${1-}" in
  "") programs=OFF ;;
  --tidy) tidy=yes programs=ON ;;
  -h | --help) usage; exit 0 ;;
  *) usage >&2; exit 2 ;;
esac

install_packages "${voxdag_packages[@]}" "${voxdag_test_packages[@]}"
jobs=$(nproc)

# Installs the npm packages of a folder. npm writes its copy of package-lock.json when it has installed
# all of them.
install_npm() {
  cd "$1" || return
  [ node_modules/.package-lock.json -nt package-lock.json ] ||
    npm ci --no-audit --no-fund --loglevel=error
}
# Some tests skip themselves without these packages.
(install_packages "${voxdag_browser_packages[@]}" && install_npm tests/browser) ||
  echo "Skipping the tests of the viewer in browsers: the browsers or the npm packages could not be installed"
install_packages "${voxdag_interop_packages[@]}" ||
  echo "Skipping tests with programs of others: Debian's packages could not be installed"
(install_npm tests/interop) ||
  echo "Skipping tests with programs of others: npm's packages could not be installed"

echo "== clang-format"
find . -name '*.[ch]pp' -not -path './build*' -print0 |
  xargs -0 -r clang-format --dry-run -Werror

echo "== clang"
cmake --preset clang -DVOXDAG_WERROR=ON -DVOXDAG_BUILD_APPS=$programs >/dev/null
cmake --build --preset clang -- -j "$jobs"

echo "== g++"
cmake --preset release -DVOXDAG_WERROR=ON -DVOXDAG_PYTHON=ON >/dev/null
cmake --build --preset release -- -j "$jobs"

if [ "$tidy" = yes ]; then
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

echo "== tests"
ctest --preset release -j "$jobs" --no-tests=error || {
  echo "== the tests that failed, again, one by one: their output comes last"
  ctest --preset release --rerun-failed || true
  exit 1
}
