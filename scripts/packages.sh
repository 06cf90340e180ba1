# shellcheck shell=bash disable=SC2034
# The one list of Debian 12 packages that voxdag is built and tested with. The other scripts source
# it. install_packages installs missing packages only, so a second run works offline.

voxdag_packages=(
  # tools
  ca-certificates g++ cmake ninja-build
  # the library
  libtbb-dev libhwy-dev libpng-dev libjpeg-dev libwebp-dev libstb-dev libopenexr-dev
  libfast-float-dev nlohmann-json3-dev libxxhash-dev libdraco-dev libmeshoptimizer-dev libassimp-dev libembree-dev
  libexpat1-dev libminizip-dev libzstd-dev
  # the command line
  libcli11-dev libfmt-dev libcpp-httplib-dev zlib1g-dev
)
voxdag_test_packages=(
  libgtest-dev zstd python3-matplotlib
  pybind11-dev python3-dev python3-numpy python3-pytest  # the Python module
  libopenmpi-dev openmpi-bin  # several processes under mpirun
  doxygen  # the reference of the public headers
  clang-format
)

# The tests of the page run under Node; one from elsewhere serves, too.
command -v node >/dev/null || voxdag_test_packages+=(nodejs)

# What `scripts/test.sh --extended` and `--tidy` need beside.
voxdag_extended_packages=(
  libopenvdb-dev libnanovdb-dev libboost-dev  # .vdb and .nvdb volumes
  libtiff-dev libgdcm-dev  # stacks of TIFF, and DICOM
  clang clang-tidy libclang-rt-14-dev
  glslang-tools spirv-tools libvulkan-dev mesa-vulkan-drivers libglfw3-dev libopengl-dev libgl1-mesa-dri xvfb xauth  # shaders and their examples
)

# scripts/site.sh builds the program for browsers with these.
voxdag_wasm_packages=(emscripten googletest clang-16 lld-16 llvm-16)

# scripts/release.sh makes the files of a release with these.
voxdag_release_packages=(libopenvdb-dev libnanovdb-dev libboost-dev libtiff-dev libgdcm-dev pybind11-dev python3-dev python3-numpy
  python3-wheel patchelf dpkg-dev file)

# cmake/arm64.cmake cross-compiles with these, and QEMU runs the programs.
voxdag_arm64_packages=(crossbuild-essential-arm64 qemu-user-static mmdebstrap)

# The tests of the viewer in browsers skip themselves without these.
voxdag_browser_packages=(chromium firefox-esr xvfb xauth)
# A Node from elsewhere brings its own npm, which conflicts with Debian's package.
command -v npm >/dev/null || voxdag_browser_packages+=(npm)

# The tests that open exports with programs of others skip themselves without these, and without the
# npm packages of tests/interop.
voxdag_interop_packages=(python3-open3d python3-openvdb libopenvdb-tools libnanovdb-tools goxel
  xvfb xauth)

# install_packages PACKAGE...
install_packages() {
  local package missing=() as_root=()
  for package in "$@"; do
    dpkg-query -W -f='${db:Status-Status}\n' "$package" 2>/dev/null | grep -qx installed ||
      missing+=("$package")
  done
  [ ${#missing[@]} -eq 0 ] && return 0
  if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null; then
      echo "These packages are needed, and there is no sudo to install them: ${missing[*]}" >&2
      return 1
    fi
    as_root=(sudo)
  fi
  echo "Installing: ${missing[*]}"
  "${as_root[@]}" apt-get update -q
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -q -y --no-install-recommends "${missing[@]}"
}

# make_arm64_system FOLDER: unpacks the packages for arm64 that voxdag, its tests and its Python module need, and
# all that those need, into a folder. Nothing is installed: the processor of this machine runs none of them.
# FOLDER/files has a line "PACKAGE VERSION FILE" for each file.
make_arm64_system() {
  local system=$1 packages link
  packages=$(printf '%s\n' "${voxdag_packages[@]}" "${voxdag_release_packages[@]}" libgtest-dev |
    grep -- '-dev$\|^python3-numpy$' | sort -u | sed 's/^python3-dev$/libpython3-dev/' | paste -sd,)
  [ "$(cat "$system/packages" 2>/dev/null)" != "$packages" ] || [ ! -s "$system/files" ] || return 0
  install_packages "${voxdag_arm64_packages[@]}"
  echo "Unpacking the packages for arm64"
  rm -rf "$system"
  mkdir -p "$(dirname "$system")"
  # shellcheck disable=SC2016
  mmdebstrap --quiet --variant=extract --architectures=arm64 --include="$packages" --extract-hook='
    for deb in "$1"/var/cache/apt/archives/*.deb; do
      dpkg-deb --fsys-tarfile "$deb" | tar t | sed "s|^\.|$(dpkg-deb -W --showformat="\${Package} \${Version} " "$deb")|"
    done >"$1/files"' bookworm "$system"
  # Links to absolute paths would leave the folder.
  find "$system/usr/lib" "$system/lib" -type l -lname '/*' | while read -r link; do
    ln -sfr "$system$(readlink "$link")" "$link"
  done
  # CMake's files of some packages name absolute paths, too.
  find "$system/usr" -name '*.cmake' -exec sed -i 's|\([":;]\)/usr\b|\1${CMAKE_SYSROOT}/usr|g' {} +
  echo "$packages" >"$system/packages"
}
