#!/usr/bin/env bash
# Makes the files of a release in dist/, on a Debian 12 that has only git:
#
#   voxdag-VERSION-linux-x86_64.tar.gz  program, Python module, headers and libraries, with all that they need
#                                       beyond glibc: unpack it anywhere, and run bin/voxdag
#   voxdag_VERSION_amd64.deb, voxdag-dev_..., python3-voxdag_...   for Debian 12
#   voxdag-VERSION-cp311-...whl         the Python module with all that it needs beyond glibc and libstdc++
#   voxdag-VERSION.tgz                  the npm package: viewer and builder
#   LICENCES.txt, SHA256SUMS            licences of all bundled libraries; checksums
#
#   scripts/release.sh [--no-npm] [--arch arm64]
#
# --no-npm leaves out the npm package, for which emscripten compiles the program. --arch arm64 adds the tarball and
# the wheel for 64-bit ARM (aarch64) to dist/, by Debian's cross compiler; the other files do not change.
# CUDA and MPI are left out: a module for MPI must fit the MPI of the cluster, and the CUDA backend needs the
# driver's version; both are built from source. Everything else that Debian 12 has is in the files.
set -euo pipefail
cd "$(dirname "$0")/.."
. scripts/packages.sh

npm=yes machine=x86_64 system=''
while [ $# -gt 0 ]; do
  case $1 in
    --no-npm) npm=no ;;
    --arch)
      [ "${2-}" = arm64 ] || { echo "release: --arch: only arm64 is possible" >&2; exit 2; }
      machine=aarch64 system=$PWD/build/arm64-system
      shift ;;
    *) sed -n '2,17s/^# \{0,1\}//p' "$0" >&2; exit 2 ;;
  esac
  shift
done
[ "$(uname -m)" = x86_64 ] || { echo "release: only x86_64 makes releases; --arch arm64 cross-compiles there" >&2; exit 2; }
export DEB_BUILD_OPTIONS=nocheck SOURCE_DATE_EPOCH
SOURCE_DATE_EPOCH=$(git log -1 --format=%ct)
version=$(sed -n 's/^project(voxdag VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)
build=build/release-files-$machine
name=voxdag-$version-linux-$machine
stage=$(mktemp -d)
trap 'rm -rf "$stage"' EXIT
install_packages "${voxdag_packages[@]}" "${voxdag_release_packages[@]}"

module='' options=() run=()
if [ $machine = aarch64 ]; then
  npm=no
  make_arm64_system "$system"
  run=(qemu-aarch64-static -L "$system")
  mkdir -p dist
  rm -f dist/*aarch64*
else
  rm -rf dist
  mkdir -p dist
  # The packages of which voxdag-dev needs the libraries.
  depends=$(printf '%s\n' "${voxdag_packages[@]}" | grep -- '-dev$' | grep -v 'httplib\|cli11\|stb\|fmt' | paste -sd, | sed 's/,/, /g')
  options=(-DVOXDAG_DEV_PACKAGES="$depends")
fi
if [ $npm = yes ]; then
  echo "== the program for browsers"
  install_packages "${voxdag_wasm_packages[@]}"
  command -v npm >/dev/null || install_packages npm
  cmake --preset wasm >/dev/null
  cmake --build build/wasm --target voxdag_wasm
  module=$PWD/build/wasm/apps/wasm
fi
echo "== the program"
preset=release
[ $machine = x86_64 ] || preset=arm64
cmake --preset $preset -B $build -DCMAKE_INSTALL_LIBDIR=lib -DVOXDAG_BUILD_TESTS=OFF -DVOXDAG_PYTHON=ON -DVOXDAG_CUDA=OFF \
  -DCMAKE_DISABLE_FIND_PACKAGE_MPI=ON -DVOXDAG_BROWSER_MODULE="$module" "${options[@]}" >/dev/null
cmake --build $build
printf '#!/bin/sh\nexec %s %s "$@"\n' "${run[*]}" "$PWD/$build/apps/voxdag/voxdag" >"$stage/voxdag"
chmod +x "$stage/voxdag"
mkdir -p $build/share/man/man1 $build/share/bash-completion/completions
docs/generate.py man "$stage/voxdag" | gzip -9n >$build/share/man/man1/voxdag.1.gz
"$stage/voxdag" completion bash >$build/share/bash-completion/completions/voxdag

# needs FILE...: prints the libraries that ELF files name.
needs() { readelf -d "$@" | sed -n 's/.*(NEEDED).*\[\(.*\)\]$/\1/p' | sort -u; }

# package_of LIBRARY: prints the name and the version of its package. dpkg may know it in /lib or in /usr/lib.
package_of() {
  local file=${1#"$system"} package
  if [ -n "$system" ]; then
    awk -v file="${file#/usr}" '$3 == file || $3 == "/usr" file { print $1, $2; found = 1 } END { exit !found }' \
      "$system/files" || { echo "release: no package has $file" >&2; return 1; }
  else
    package=$(dpkg -S "$file" 2>/dev/null || dpkg -S "${file#/usr}")
    dpkg-query -W -f='${Package} ${Version}\n' "${package%%: *}"
  fi
}

# bundle FOLDER FILE...: copies the libraries that the files need into FOLDER, and those that these need: all but
# those of glibc.
bundle() {
  local folder=$1 library added=yes
  shift
  while [ $added = yes ]; do
    added=no
    for library in $(needs "$@" "$folder"/*.so*); do
      case $library in
        libc.so.* | libm.so.* | libdl.so.* | librt.so.* | libpthread.so.* | libresolv.so.* | ld-linux*) continue ;;
      esac
      [ ! -e "$folder/$library" ] || continue
      cp -L "$system/usr/lib/$machine-linux-gnu/$library" "$folder/" 2>/dev/null ||
        cp -L "$system/lib/$machine-linux-gnu/$library" "$folder/"
      package_of "$(realpath -e "$system/usr/lib/$machine-linux-gnu/$library" 2>/dev/null ||
        realpath "$system/lib/$machine-linux-gnu/$library")" >>"$stage/bundled"
      chmod u+w "$folder/$library"
      patchelf --set-rpath '$ORIGIN' "$folder/$library"
      added=yes
    done
  done
}

echo "== $name.tar.gz"
tree=$stage/$name
strip=strip
[ $machine = x86_64 ] || strip=aarch64-linux-gnu-strip
cmake --install $build --prefix "$tree" >/dev/null
$strip "$tree/bin/voxdag" "$tree"/lib/voxdag/*.so "$tree"/lib/python3/dist-packages/voxdag/*.so
bundle "$tree/lib/voxdag" "$tree/bin/voxdag" "$tree"/lib/python3/dist-packages/voxdag/*.so
patchelf --set-rpath '$ORIGIN' "$tree"/lib/voxdag/voxdag_*.so
cp README.md CHANGELOG.md LICENSE docs/install.md "$tree/"

# The licences of the bundled libraries, as Debian states them.
{
  echo "voxdag has the licence in LICENSE. Its releases hold these libraries, each with its own licence."
  sort -u "$stage/bundled" | while read -r package package_version; do
    printf '\n%s\n%s %s\n\n' "$(printf '=%.0s' {1..78})" "$package" "$package_version"
    cat "$system/usr/share/doc/$package/copyright"
  done
} >"$tree/LICENCES.txt"
[ $machine = aarch64 ] || cp "$tree/LICENCES.txt" dist/
# The oldest glibc with which all of it runs: docs/install.md states it.
glibc=$(readelf -V "$tree/bin/voxdag" "$tree"/lib/voxdag/*.so* "$tree"/lib/python3/dist-packages/voxdag/*.so |
  grep -o 'GLIBC_2\.[0-9.]*' | sort -uV | tail -n 1)
echo "needs glibc ${glibc#GLIBC_} or newer"
grep -q "glibc ${glibc#GLIBC_} " docs/install.md || { echo "release: docs/install.md states another version of glibc" >&2; exit 1; }
tar --sort=name --owner=0 --group=0 --numeric-owner --mtime=@"$SOURCE_DATE_EPOCH" -C "$stage" -cf - "$name" | gzip -9n >"dist/$name.tar.gz"

if [ $machine = x86_64 ]; then
  echo "== Debian's packages"
  (cd $build && cpack -G DEB -B packages >/dev/null)
  cp $build/packages/*.deb dist/
fi

echo "== the wheel"
# The module finds its libraries in a folder beside it. It takes the libstdc++ of the system, as all wheels do: with
# one of its own, other modules that need a newer one would fail.
wheel=$stage/wheel
mkdir -p "$wheel/voxdag.libs"
cp -r "$tree/lib/python3/dist-packages/voxdag" "$wheel/"
cp "$tree"/lib/voxdag/voxdag_*.so "$wheel/voxdag.libs/"
bundle "$wheel/voxdag.libs" "$wheel"/voxdag/*.so
rm -f "$wheel"/voxdag.libs/lib{stdc++,gcc_s}.so.*
patchelf --set-rpath '$ORIGIN/../voxdag.libs' "$wheel"/voxdag/*.so
tag=$(/usr/bin/python3 -c 'import sys; print("cp%d%d" % sys.version_info[:2])')
info=$wheel/voxdag-$version.dist-info
mkdir -p "$info"
cp LICENSE "$tree/LICENCES.txt" "$info/"
printf 'Wheel-Version: 1.0\nGenerator: scripts/release.sh\nRoot-Is-Purelib: false\nTag: %s-%s-linux_%s\n' "$tag" "$tag" "$machine" >"$info/WHEEL"
{
  printf 'Metadata-Version: 2.1\nName: voxdag\nVersion: %s\nLicense: MIT\nRequires-Python: >=3.11,<3.12\nRequires-Dist: numpy\n' "$version"
  sed -n 's/^description = "\(.*\)"/Summary: \1/p' pyproject.toml
  printf 'Description-Content-Type: text/markdown\n\n'
  cat docs/python.md
} >"$info/METADATA"
/usr/bin/python3 -m wheel pack --dest-dir dist "$wheel" >/dev/null

if [ $npm = yes ]; then
  echo "== the npm package"
  node apps/npm/pack.mjs $build/apps/viewer/page "$stage/npm"
  (cd "$stage/npm" && npm pack --silent --pack-destination "$OLDPWD/dist" >/dev/null)
fi
rm -f dist/SHA256SUMS
(cd dist && sha256sum -- * >"$stage/sums" && mv "$stage/sums" SHA256SUMS)
ls -l dist
