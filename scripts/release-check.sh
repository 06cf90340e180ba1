#!/usr/bin/env bash
# Tries the files that scripts/release.sh left in dist/ on systems where nothing was installed: makes Debian 12 and
# Debian 13 in folders with debootstrap, and in each
#   unpacks the tarball, builds a scene, renders a picture and runs the Python module;
#   on Debian 12 installs the packages, uses them and removes them, and installs the wheel in a virtual environment
#   and runs the examples of docs/cookbook/python.md.
# The tarball for aarch64, if there is one, runs under QEMU with the glibc of build/arm64-system alone.
# The DAGs must have the bytes that the program of this machine makes. Needs root, debootstrap and 3 GB.
#
#   scripts/release-check.sh [--mirror URL]
set -euo pipefail
cd "$(dirname "$0")/.."

mirror=http://deb.debian.org/debian
[ "${1-}" != --mirror ] || mirror=$2
[ -f dist/SHA256SUMS ] || { echo "release-check: run scripts/release.sh first" >&2; exit 2; }
(cd dist && sha256sum --quiet -c SHA256SUMS)
folder=$(mktemp -d "${TMPDIR:-/var/tmp}/release-check.XXXXXX")
trap 'rm -rf --one-file-system "$folder"' EXIT

# in_system SYSTEM SCRIPT: runs a script in the system, in namespaces of its own, with a clean environment.
in_system() {
  system=$1 unshare --mount --pid --fork --kill-child --mount-proc -- bash -ec '
    mount -t proc proc "$system/proc"
    mount --rbind /dev "$system/dev"
    exec chroot "$system" /usr/bin/env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin bash -euxc "$0"' "$2"
}

use='scene sponge --size 2 -o s.ply
build s.ply -r 256 -o s.vdag
render s.vdag -o s.png --size 64x64
export s.vdag -o s.html
info s.vdag'
# run_with PROGRAM: the commands above as lines for a shell.
run_with() { sed "s|^|$1 |; s|\$| -q|" <<<"$use" | sed 's|\(info .*\) -q|\1|'; }

mkdir "$folder/here"
(cd "$folder/here" && eval "$(run_with "$OLDPWD/build/release-files-x86_64/apps/voxdag/voxdag")") >/dev/null
sum=$(sha256sum <"$folder/here/s.vdag")

for suite in bookworm trixie; do
  system=$folder/$suite
  echo "== a bare Debian: $suite"
  debootstrap --variant=minbase "$suite" "$system" "$mirror" >"$folder/$suite.log" 2>&1 ||
    { tail "$folder/$suite.log" >&2; exit 1; }
  cp -L /etc/resolv.conf "$system/etc/resolv.conf"
  cp -r dist "$system/root/dist"
  in_system "$system" "cd /root && tar xzf dist/voxdag-*-linux-x86_64.tar.gz && mv voxdag-*-linux-x86_64 /opt/voxdag
    $(run_with /opt/voxdag/bin/voxdag)
    /opt/voxdag/bin/voxdag --version"
  [ "$(sha256sum <"$system/root/s.vdag")" = "$sum" ] || { echo "$suite: the DAG has other bytes" >&2; exit 1; }
done

system=$folder/bookworm
echo "== packages on bookworm"
cp docs/cookbook/python.md tests/docs/run_page.py "$system/root/"
in_system "$system" "cd /root && rm -f s.*
  export DEBIAN_FRONTEND=noninteractive
  apt-get update -q >/dev/null
  apt-get install -q -y --no-install-recommends ./dist/voxdag_*.deb ./dist/voxdag-dev_*.deb ./dist/python3-voxdag_*.deb >/dev/null
  $(run_with voxdag)
  python3 run_page.py /usr/bin/voxdag python.md
  gunzip -t /usr/share/man/man1/voxdag.1.gz
  apt-get remove -q -y voxdag voxdag-dev python3-voxdag >/dev/null
  [ ! -e /usr/bin/voxdag ] && [ ! -e /usr/include/voxdag ]"
[ "$(sha256sum <"$system/root/s.vdag")" = "$sum" ] || { echo "the package: the DAG has other bytes" >&2; exit 1; }

echo "== the wheel on bookworm"
in_system "$system" "cd /root
  apt-get install -q -y --no-install-recommends python3-venv >/dev/null
  apt-get remove -q -y libtbb12 >/dev/null
  python3 -m venv --system-site-packages env
  env/bin/pip install -q --no-index --no-deps dist/voxdag-*-linux_x86_64.whl
  env/bin/python run_page.py /opt/voxdag/bin/voxdag python.md"
for tarball in dist/voxdag-*-linux-aarch64.tar.gz; do
  [ -f "$tarball" ] || break
  echo "== $tarball under QEMU"
  glibc=$folder/glibc
  mkdir -p "$glibc/lib" "$folder/arm64"
  for library in ld-linux-aarch64.so.1 lib{c,m,dl,rt,pthread,resolv}.so.{2,6,0,1}; do
    cp -L build/arm64-system/lib/aarch64-linux-gnu/$library "$glibc/lib/" 2>/dev/null || true
  done
  tar xzf "$tarball" -C "$folder/arm64" --strip-components=1
  (cd "$folder/arm64" && eval "$(run_with "qemu-aarch64-static -L $glibc bin/voxdag")") >/dev/null
  [ "$(sha256sum <"$folder/arm64/s.vdag")" = "$sum" ] || { echo "aarch64: the DAG has other bytes" >&2; exit 1; }
done
echo "== all files of dist/ work"
