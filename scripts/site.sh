#!/usr/bin/env bash
# Makes the page that builds scenes in the browser: site/, a folder for any web server, and
# site/voxdag.html, one file that works from disk, offline. Installs what it needs, and builds the
# program for browsers (build/wasm) and the native one that packs it into the page (build/site).
#
#   scripts/site.sh [FOLDER]
#
# FOLDER is site by default.
set -euo pipefail
cd "$(dirname "$0")/.."
. scripts/packages.sh

site=${1:-site}
install_packages "${voxdag_packages[@]}" "${voxdag_wasm_packages[@]}"
cmake --preset wasm
cmake --build build/wasm --target voxdag_wasm
cmake --preset release -B build/site -DVOXDAG_BUILD_TESTS=OFF -DVOXDAG_CUDA=OFF \
  -DVOXDAG_BROWSER_MODULE="$PWD/build/wasm/apps/wasm"
cmake --build build/site --target voxdag_app
build/site/apps/voxdag/voxdag export -o "$site/"
