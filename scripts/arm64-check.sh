#!/usr/bin/env bash
# Builds voxdag for 64-bit ARM with Debian's cross compiler, runs the tests of the library's rooms under QEMU, and
# checks that the program writes the bytes that the program of this machine writes (scripts/same_bytes.py).
#
#   scripts/arm64-check.sh [--files]
#     --files   only compares the files
#
# The packages for arm64 lie in build/arm64-system; those of this machine do not change.
set -euo pipefail
cd "$(dirname "$0")/.."
. scripts/packages.sh

tests=yes
case ${1-} in
  --files) tests=no ;;
  '') ;;
  *) sed -n '2,8s/^# \{0,1\}//p' "$0" >&2; exit 2 ;;
esac
install_packages "${voxdag_packages[@]}" libgtest-dev python3
make_arm64_system build/arm64-system

cmake --preset release >/dev/null
cmake --build --preset release --target voxdag_app
cmake --preset arm64 >/dev/null
cmake --build --preset arm64 --target voxdag_app
scripts/same_bytes.py build/release/apps/voxdag/voxdag \
  "$(command -v qemu-aarch64-static) -L build/arm64-system build/arm64/apps/voxdag/voxdag"
[ $tests = yes ] || exit 0

# QEMU is 10 to 20 times slower than a processor, takes memory of its own, and has no seccomp. So these are left out:
# tests of the memory of the process, of children that can only compute, of those killed in a system call, and the longest ones.
cmake --build --preset arm64 --target library_tests
ctest --preset arm64 -j "$(nproc)" -LE extended \
  -R '^(core|io|parallel|stored|svdag|esvo|attributes|compact|wire|algebra|query|voxels|edit|voxelize|solid|dag|encode|build|trace|file|model|report)\.' \
  -E '\.(ConfinedChild|AtomicFile|ProcessMemory|MemoryBudget|BuildMemory)$'
