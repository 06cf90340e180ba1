#!/usr/bin/env bash
# Runs the two commands of the README on a bare Debian 12: makes the system in a folder with debootstrap,
# clones the committed HEAD of this checkout into it, and runs scripts/demo.sh and scripts/test.sh there.
# Prints for each the wall time and the peak of the memory that all its processes use together. Fails if
# a command fails, if the picture differs from docs/images/demo.png, or if a test is skipped for a reason
# that is not in the list below.
#
# Needs root, debootstrap, git, a network, and 20 GB. The system sees neither this machine's environment
# nor its files. All mounts and processes end with the script.
#
#   scripts/bare-check.sh [OPTION...]
#     --demo               runs only scripts/demo.sh
#     --test               runs only scripts/test.sh
#     --extended           runs scripts/test.sh --extended
#     --keep FOLDER        makes the system in FOLDER and keeps it, with the logs. If FOLDER has a system,
#                          uses it: its packages are installed, so no missing package can be found
#     --mirror URL         Debian's archive (default: http://deb.debian.org/debian)
#     --apt-conf FILE      settings of apt for the system
#     --npmrc FILE         settings of npm for the system
#     --certificates FILE  certificates (PEM) that Node and npm accept beside their own
#     -- COMMAND...        runs COMMAND in the clone instead of the two commands
#
# Without --keep, the system lies in a folder in TMPDIR (default: /var/tmp). The script removes it, and
# leaves only the logs if a check failed.
set -euo pipefail

# A test may skip itself if its reason contains one of these texts.
allowed_skips=(
  # The test needs a CUDA device or the CUDA toolkit.
  'no CUDA device' 'nvcc not found'
  # The test needs large scenes that the repository does not have.
  'VOXDAG_SCENES'
  # The test needs a user other than root.
  'root may write everywhere'
  # The test needs a build without Embree.
  'built with Embree'
  # The extended tests build these.
  'OpenVDB (libopenvdb-dev' 'built without voxdag-lab' 'the program that measures was not found'
  'this build has no such tests'
  # The test needs several ranks (it runs under mpirun too), or one rank.
  'one rank' 'for one process'
)

usage() { sed -n '2,25s/^# \{0,1\}//p' "$0"; }
die() { echo "bare-check: $*" >&2; exit 1; }

demo=yes test=yes test_options=() folder='' mirror=http://deb.debian.org/debian
apt_conf='' npmrc='' certificates='' command=()
while [ $# -gt 0 ]; do
  case $1 in
    --demo) test=no ;;
    --test) demo=no ;;
    --extended) test_options=(--extended) ;;
    --keep | --mirror | --apt-conf | --npmrc | --certificates)
      [ $# -ge 2 ] || { usage >&2; exit 2; }
      case $1 in
        --keep) folder=$(realpath -m -- "$2") ;;
        --mirror) mirror=$2 ;;
        --apt-conf) apt_conf=$(realpath -e -- "$2") ;;
        --npmrc) npmrc=$(realpath -e -- "$2") ;;
        --certificates) certificates=$(realpath -e -- "$2") ;;
      esac
      shift ;;
    --) shift; command=("$@"); break ;;
    -h | --help) usage; exit 0 ;;
    *) usage >&2; exit 2 ;;
  esac
  shift
done
[ $demo$test != nono ] || die "--demo and --test exclude each other"
cd "$(dirname "$0")/.."
[ "$(id -u)" -eq 0 ] || die "must run as root"
for program in debootstrap git unshare; do
  command -v $program >/dev/null || die "$program is not installed"
done
[ -z "$(git status --porcelain)" ] || echo "bare-check: uses the last commit, without the uncommitted changes" >&2

failures=() kept=yes running=
if [ -z "$folder" ]; then
  kept=no
  folder=$(mktemp -d "${TMPDIR:-/var/tmp}/bare-check.XXXXXX")
fi
export system=$folder/system
clone=$system/root/voxdag

# Ends all processes in the system: unshare takes them, and their mounts, with it.
clean_up() {
  if [ -n "$running" ]; then
    kill -KILL "$running" 2>/dev/null || true
    wait "$running" 2>/dev/null || true
    sleep 1
  fi
  [ $kept = yes ] || rm -rf --one-file-system "$system"
  [ $kept = yes ] || [ ${#failures[@]} -gt 0 ] || rm -rf "$folder"
}
trap clean_up EXIT
trap 'exit 130' INT
trap 'exit 143' TERM HUP

# alone COMMAND...: runs a command in its own namespaces of mounts and processes.
alone() {
  unshare --mount --pid --fork --kill-child --mount-proc -- "$@" &
  running=$!
  local status=0
  wait $running || status=$?
  running=
  return $status
}

# The first process of the namespace: runs the command in the clone, with a clean environment. Writes the
# wall time in seconds, and the peak of memory in MiB, to the file $measured.
run_in_system() {
  mount --rbind /dev "$system/dev"
  mount -t tmpfs tmpfs "$system/dev/shm"
  mount --rbind /sys "$system/sys"
  mount -t proc proc "$system/proc"
  # Background processes ignore SIGINT. Tests send it.
  chroot "$system" /usr/bin/env -i --default-signal HOME=/root TERM=dumb \
    PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin \
    ${certificates:+NODE_EXTRA_CA_CERTS=/etc/bare-check-certificates.pem} \
    bash -c 'cd /root/voxdag && exec "$@"' bash "$@" </dev/null &
  local child=$! start=$SECONDS peak=0 sum status=0
  while kill -0 $child 2>/dev/null; do
    # Pss counts a page that n processes share as 1/n page for each.
    sum=$(cat "$system"/proc/[0-9]*/smaps_rollup 2>/dev/null |
      awk '/^Pss:/ { sum += $2 } END { printf "%d", sum / 1024 }')
    [ "$sum" -le "$peak" ] || peak=$sum
    sleep 1
  done
  wait $child || status=$?
  echo "$((SECONDS - start)) $peak" >"$measured"
  return $status
}
export -f run_in_system

# run NAME COMMAND...: runs a command in the clone, prints and logs its output, and prints what it took.
run() {
  local name=$1 status=0 printer seconds memory
  shift
  echo "== bare-check: $*"
  export measured=$folder/$name.measured certificates
  rm -f "$measured"
  exec 3> >(exec tee "$folder/$name.log")
  printer=$!
  alone bash -ec 'run_in_system "$@"' bash "$@" >&3 2>&1 || status=$?
  exec 3>&-
  wait $printer || true
  [ -f "$measured" ] || die "could not run $*"
  read -r seconds memory <"$measured"
  results+=("$*: $((seconds / 60)) min $((seconds % 60)) s, at most $memory MiB of memory, exit status $status")
  [ $status -eq 0 ] || failures+=("$* ended with status $status")
}

# Prints "TEST: REASON" for each skipped test in logs of ctest, also for tests inside a test program.
skipped_tests() {
  awk '
    /^[0-9]+\/[0-9]+ Test: / { test = $0; sub(/^[^:]*: /, "", test); inside = 0 }
    /: Skipped$/ { inside = 1; reason = ""; next }
    /^\[  SKIPPED \] .* ms\)$/ { print test ": " $4 ":" reason; inside = 0; next }
    inside { reason = reason " " $0 }
    # Scripts that end with status 77; unittest; pytest; Node.
    /^[Ss]kipped: / || /^OK .*skipped=/ || /(^|, )[1-9][0-9]* skipped/ || /^(#|ℹ) skipped [1-9]/ { print test ": " $0 }
  ' "$@"
}

check_tests() {
  local logs=("$clone"/build/*/Testing/Temporary/LastTest.log) allowed name left_out
  allowed=$(printf '%s\n' "${allowed_skips[@]}")
  [ -f "${logs[0]}" ] || { failures+=("there is no log of the tests"); return; }
  skipped_tests "${logs[@]}" >"$folder/skipped"
  if grep -vF "$allowed" "$folder/skipped"; then
    failures+=("tests are skipped for the reasons above")
  fi
  # Tests that ctest did not run, and whose reason is not in the logs.
  while read -r name; do
    grep -qF "$name: " "$folder/skipped" || failures+=("the test $name is skipped without a reason")
  done < <(sed -nE 's/^\s+[0-9]+ - (.*) \((Skipped|Disabled|Not Run)\)$/\1/p' "$folder/test.log")
  # Tests and parts that CMake left out, because it did not find a package.
  alone bash -ec 'run_in_system "$@"' bash cmake build/release >"$folder/cmake.log" 2>&1 ||
    failures+=("cmake build/release failed, see $folder/cmake.log")
  left_out=$(grep -E 'left out|not found:' "$folder/cmake.log" | grep -vF "$allowed" || true)
  [ -z "$left_out" ] || failures+=("the build lacks something: $left_out")
}

if [ ! -e "$folder/is-made" ]; then
  [ ! -e "$system" ] || die "$system is incomplete: remove it"
  mkdir -p "$folder"
  echo "== bare-check: makes a bare Debian 12 in $system"
  alone debootstrap --variant=minbase --include=git bookworm "$system" "$mirror" >"$folder/debootstrap.log" 2>&1 ||
    { tail "$folder/debootstrap.log" >&2; die "debootstrap failed"; }
  cat >"$system/etc/apt/sources.list" <<END
deb $mirror bookworm main
deb $mirror bookworm-updates main
deb http://deb.debian.org/debian-security bookworm-security main
END
  echo "127.0.0.1 localhost $(hostname)" >"$system/etc/hosts"
  touch "$folder/is-made"
fi
cp -L /etc/resolv.conf "$system/etc/resolv.conf"
[ -z "$apt_conf" ] || cp "$apt_conf" "$system/etc/apt/apt.conf.d/99bare-check"
[ -z "$npmrc" ] || cp "$npmrc" "$system/root/.npmrc"
[ -z "$certificates" ] || cp "$certificates" "$system/etc/bare-check-certificates.pem"
rm -rf "$clone"
git clone -q --no-hardlinks . "$clone"
[ "$(git -C "$clone" rev-parse HEAD)" = "$(git rev-parse HEAD)" ] || die "the clone has another HEAD"

results=()
if [ ${#command[@]} -gt 0 ]; then
  run command "${command[@]}"
else
  if [ $demo = yes ]; then
    run demo scripts/demo.sh
    cmp "$clone/demo.png" "$clone/docs/images/demo.png" || failures+=("demo.png differs from docs/images/demo.png")
  fi
  if [ $test = yes ]; then
    run test scripts/test.sh "${test_options[@]}"
    # Where tests failed, the log has only those that ran again.
    [[ ${results[-1]} != *'exit status 0' ]] || check_tests
  fi
fi
echo "== bare-check: $(git rev-parse --short HEAD), $(nproc) processors"
printf '%s\n' "${results[@]}"
echo "(memory: the sum over all processes that run together, looked at once a second)"
if [ ${#failures[@]} -gt 0 ]; then
  printf 'bare-check: FAILED: %s\n' "${failures[@]}" "see the logs in $folder" >&2
  [ ! -f "$clone/demo.png" ] || cp "$clone/demo.png" "$folder"
  exit 1
fi
