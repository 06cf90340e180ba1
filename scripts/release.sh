#!/usr/bin/env bash
# Makes the files of a release in dist/, on a Debian 12 that has only git:
#
#   voxdag-VERSION-linux-x86_64.tar.gz  program, Python module, headers and libraries, with all that they need
#                                       beyond glibc: unpack it anywhere, and run bin/voxdag
#   voxdag_VERSION_amd64.deb, voxdag-dev_..., python3-voxdag_...   for Debian 12
#   voxdag-VERSION-cp311-...whl         the Python module with all that it needs beyond glibc
#   voxdag-VERSION.tgz                  the npm package: viewer and builder
#   LICENCES.txt, SHA256SUMS            licences of all bundled libraries; checksums
#
#   scripts/release.sh [--no-npm]
#
# --no-npm leaves out the npm package, for which emscripten compiles the program.
# CUDA and MPI are left out: a module for MPI must fit the MPI of the cluster, and the CUDA backend needs the
# driver's version; both are built from source. Everything else that Debian 12 has is in the files.
set -euo pipefail
cd "$(dirname "$0")/.."
. scripts/packages.sh

npm=yes
case ${1-} in
  --no-npm) npm=no ;;
  '') ;;
  *) sed -n '2,15s/^# \{0,1\}//p' "$0" >&2; exit 2 ;;
esac
install_packages "${voxdag_packages[@]}" "${voxdag_release_packages[@]}"
export DEB_BUILD_OPTIONS=nocheck SOURCE_DATE_EPOCH
SOURCE_DATE_EPOCH=$(git log -1 --format=%ct)
version=$(sed -n 's/^project(voxdag VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)
machine=$(uname -m)
build=build/release-files
name=voxdag-$version-linux-$machine
rm -rf dist && mkdir -p dist
stage=$(mktemp -d)
trap 'rm -rf "$stage"' EXIT

module=''
if [ $npm = yes ]; then
  echo "== the program for browsers"
  install_packages "${voxdag_wasm_packages[@]}"
  cmake --preset wasm >/dev/null
  cmake --build build/wasm --target voxdag_wasm
  module=$PWD/build/wasm/apps/wasm
fi
echo "== the program"
# The packages of which voxdag-dev needs the libraries.
depends=$(printf '%s\n' "${voxdag_packages[@]}" | grep -- '-dev$' | grep -v 'httplib\|cli11\|stb\|fmt' | paste -sd, | sed 's/,/, /g')
cmake --preset release -B $build -DCMAKE_INSTALL_LIBDIR=lib -DVOXDAG_BUILD_TESTS=OFF -DVOXDAG_PYTHON=ON -DVOXDAG_CUDA=OFF \
  -DCMAKE_DISABLE_FIND_PACKAGE_MPI=ON -DVOXDAG_BROWSER_MODULE="$module" -DVOXDAG_DEV_PACKAGES="$depends" >/dev/null
cmake --build $build
mkdir -p $build/share/man/man1 $build/share/bash-completion/completions
docs/generate.py man $build/apps/voxdag/voxdag | gzip -9n >$build/share/man/man1/voxdag.1.gz
$build/apps/voxdag/voxdag completion bash >$build/share/bash-completion/completions/voxdag

# bundle FOLDER FILE...: copies the libraries that the files need into FOLDER, all but those of glibc.
bundle() {
  local folder=$1 library
  shift
  mkdir -p "$folder"
  ldd "$@" | sed -n 's|^.*=> \(/[^ ]*\) .*|\1|p' | sort -u | while read -r library; do
    case $(basename "$library") in
      libc.so.* | libm.so.* | libdl.so.* | librt.so.* | libpthread.so.* | libresolv.so.* | ld-linux*) ;;
      *)
        cp -Ln "$library" "$folder/"
        dpkg -S "$(realpath "$library")" | cut -d: -f1 >>"$stage/bundled"
        ;;
    esac
  done
  chmod u+w "$folder"/*.so*
  patchelf --set-rpath '$ORIGIN' "$folder"/*.so*
}

echo "== $name.tar.gz"
tree=$stage/$name
cmake --install $build --prefix "$tree" --strip >/dev/null
bundle "$tree/lib/voxdag" "$tree/bin/voxdag" "$tree"/lib/voxdag/*.so* "$tree"/lib/python3/dist-packages/voxdag/*.so
# The Python module of the wheel finds its libraries in a folder beside it.
wheel=$stage/wheel
mkdir -p "$wheel/voxdag.libs"
cp -r "$tree/lib/python3/dist-packages/voxdag" "$wheel/"
cp "$tree"/lib/voxdag/*.so* "$wheel/voxdag.libs/"
patchelf --set-rpath '$ORIGIN/../voxdag.libs' "$wheel"/voxdag/*.so
cp README.md CHANGELOG.md LICENSE "$tree/"

# The licences of the bundled libraries, as Debian states them.
{
  echo "voxdag has the licence in LICENSE. Its releases hold these libraries, each with its own licence."
  sort -u "$stage/bundled" | while read -r package; do
    printf '\n%s\n%s %s\n\n' "$(printf '=%.0s' {1..78})" "$package" "$(dpkg-query -W -f='${Version}' "$package")"
    cat "/usr/share/doc/$package/copyright"
  done
} >dist/LICENCES.txt
cp dist/LICENCES.txt "$tree/"
pack() { tar --sort=name --owner=0 --group=0 --numeric-owner --mtime=@"$SOURCE_DATE_EPOCH" -C "$stage" -cf - "$1" | gzip -9n; }
pack "$name" >"dist/$name.tar.gz"

echo "== Debian's packages"
(cd $build && cpack -G DEB -B packages >/dev/null)
cp $build/packages/*.deb dist/

echo "== the wheel"
tag=$(/usr/bin/python3 -c 'import sys; print("cp%d%d" % sys.version_info[:2])')
info=$wheel/voxdag-$version.dist-info
mkdir -p "$info"
cp LICENSE dist/LICENCES.txt "$info/"
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
(cd dist && sha256sum -- * >SHA256SUMS)
ls -l dist
