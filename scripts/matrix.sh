#!/usr/bin/env bash
# Builds Clathra and runs the short ring of tests (tests/CMakeLists.txt) in clean chroots of Debian, and prints a table.
set -euo pipefail
# shellcheck source=scripts/setup.sh
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

usage() {
  cat <<EOT
scripts/matrix.sh [--mirror URL] [SYSTEM...] [COMPILER...]
  SYSTEM    12, 13, testing: Debian's releases, each in a chroot of its own; default all three
            here: this system as it is, without a chroot and without root
  COMPILER  gcc, clang; default both
  --mirror  Debian's mirror; default CLATHRA_MIRROR of the environment, else the one that apt uses here
  JOBS=N    in the environment: so many jobs at once; default one a core
Chroots need root, debootstrap and 4 GB in TMPDIR, which is cleared at the end. Logs and table stay in results/matrix.
The exit code is 0 if all was built and passed, 1 if not, 2 if a word is wrong.
EOT
}

refuse() { printf 'matrix.sh: %s; scripts/matrix.sh --help says more\n' "$*" >&2; exit 2; }

systems=() compilers=() mirror=${CLATHRA_MIRROR-}
while [ $# -gt 0 ]; do
  case $1 in
    -h | --help) usage; exit 0 ;;
    --mirror) [ $# -gt 1 ] || refuse "--mirror needs a URL"; mirror=$2; shift ;;
    12 | 13 | testing | here) systems+=("$1") ;;
    gcc | clang) compilers+=("$1") ;;
    *) refuse "'$1' is neither a system (12, 13, testing, here) nor a compiler (gcc, clang)" ;;
  esac
  shift
done
[ ${#systems[@]} -gt 0 ] || systems=(12 13 testing)
[ ${#compilers[@]} -gt 0 ] || compilers=(gcc clang)
jobs=${JOBS:-$(env -u OMP_NUM_THREADS nproc)} # nproc would answer with one thread a process
[[ $jobs =~ ^[1-9][0-9]*$ ]] || refuse "JOBS is '$jobs', not a number of jobs"
export CMAKE_BUILD_PARALLEL_LEVEL=$jobs CTEST_PARALLEL_LEVEL=$jobs
results=$root/results/matrix

# installed FOLDER: does what cmake --install puts elsewhere run a case, and does the Python package drive it to the same, from another folder and with an empty
# environment?  As root with the tree out of sight.
installed() {
  local prefix hide=() code=0
  prefix=$(mktemp -d)
  [ "$(id -u)" -ne 0 ] || hide=(unshare --mount sh -c 'mount -t tmpfs tmpfs "$0" && exec "$@"' "$root")
  cmake --install "$1" --prefix "$prefix" && (cd "$prefix" && "${hide[@]}" env -i PATH=/usr/bin:/bin HOME="$prefix" OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 PYTHONPATH=lib/python3/dist-packages \
    sh -ec 'bin/clathra share/clathra/cases/terzaghi -time_end "100 s" -output_times "0 s,100 s" -output_dir out; exec "$@"' - "$python" -c "
import clathra
run = clathra.Case('terzaghi').with_(time_end=100, output_times=[0, 100]).run('driven')
assert run.finished and (run.particles()['p_w'] == clathra.Run('out').particles()['p_w']).all()") || code=1
  rm -rf "$prefix"
  return $code
}

# here COMPILER: builds and tests on this system; the last line of the output is a row of the table.
here() {
  local folder=results/matrix/here-$1 log=$results/here-$1 built=no warnings='' lives='' tests='' failed name petsc version
  setup_packages "${run_packages[@]}" "$1" >&2
  name=$(. /etc/os-release && echo "$PRETTY_NAME")
  petsc=$(pkg-config --modversion PETSc) || petsc=none
  version=$("$1" --version | sed -nE '1s/[^0-9]*([0-9.]+).*/\1/p')
  say "$name, PETSc $petsc, $1 $version" >&2
  if (CC=$1 setup_build "$folder" all -DCMAKE_BUILD_TYPE=Release); then
    built=yes warnings=$(grep -c 'warning:' "$log/build.log" || true)
    lives=no
    if installed "$log" >"$log/installed.log" 2>&1; then lives=yes; fi
    ctest --test-dir "$log" -L '^short$' --output-on-failure >"$log/tests.log" 2>&1 </dev/null || true
    failed=$(sed -nE 's/^ *[0-9]+\/[0-9]+ Test +#[0-9]+: (\S+) .*\*\*\*.*/\1/p' "$log/tests.log" | tr '\n' ' ')
    tests="$(grep -cE '^ *[0-9]+/[0-9]+ Test .* Passed ' "$log/tests.log" || true) / $(wc -w <<<"$failed")${failed:+: $failed}"
  else
    tests=$(cat "$log"/{configure,build}.log 2>/dev/null | grep -m1 -oE '(error|Error).*' | tr '|' ' ')
  fi
  echo "| $name | $petsc | $1 $version | $built | $warnings | $lives | $tests |"
}

# apart COMMAND...: in namespaces of its own, so that what it mounts and starts ends with it, however it ends.
child=''
apart() {
  local code=0
  unshare --mount --pid --fork --kill-child "$@" </dev/null &
  child=$!
  wait "$child" || code=$?
  child=''
  return $code
}

make_chroot() { # SYSTEM FOLDER: with this tree in /clathra, and apt's proxies and checks of dates as here
  local suite=$1
  case $1 in 12) suite=bookworm ;; 13) suite=trixie ;; esac
  apart debootstrap --variant=minbase "$suite" "$2" "$mirror" || return
  apt-config dump | grep -E '^Acquire::(https?::Proxy|Check-)' >"$2/etc/apt/apt.conf.d/99host" || true
  echo force-unsafe-io >"$2/etc/dpkg/dpkg.cfg.d/99chroot" # it need not outlive a loss of power
  mkdir "$2/clathra"
  tar -C "$root" --exclude='./build*' --exclude=./results --exclude=./.git -c . | tar -C "$2/clathra" -x
}

# shellcheck disable=SC2016 # expanded by the inner shell
enter='mount --bind "$0" "$0"; mount -t proc proc "$0/proc"; mount -t sysfs -o ro sysfs "$0/sys"
  mount -t devpts devpts "$0/dev/pts"; mount -t tmpfs -o mode=1777 tmpfs "$0/dev/shm"; exec chroot "$0" "$@"'
in_chroot() { # FOLDER COMPILER
  apart sh -ec "$enter" "$1" /usr/bin/env -i HOME=/root PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin \
    LC_ALL=C.UTF-8 JOBS="$jobs" ${http_proxy:+"http_proxy=$http_proxy"} /clathra/scripts/matrix.sh here "$2"
}

# rows_of SYSTEM: a row for each compiler.
rows_of() {
  local system=$1 chroot=$work/$1 log compiler
  if [ "$system" != here ]; then
    say "Debian $system: chroot from $mirror" >&2
    make_chroot "$system" "$chroot" >"$results/$system.log" 2>&1 || { echo "| Debian $system | no chroot: $results/$system.log |"; return; }
  fi
  for compiler in "${compilers[@]}"; do
    log=$results/$system-$compiler
    rm -rf "$log"
    mkdir "$log"
    if [ "$system" = here ]; then
      (here "$compiler") >"$work/row" || true
    else
      say "Debian $system, $compiler" >&2
      in_chroot "$chroot" "$compiler" >"$work/row" 2>"$log/matrix.log" || true
      cp "$chroot/clathra/results/matrix/here-$compiler/"*.log "$log" 2>/dev/null || true
    fi
    grep -E '^\| .* \| (yes|no) \| .* \|$' "$work/row" || echo "| $system, $compiler | not built: $log/matrix.log |"
  done
  rm -rf --one-file-system "$chroot"
}

clear_up() {
  [ -z "$child" ] || kill -KILL "$child" 2>/dev/null || true # the namespaces' first process, and with it all that is in them
  rm -rf --one-file-system "$work" 2>/dev/null || { sleep 1; rm -rf --one-file-system "$work"; }
}

if [[ " ${systems[*]} " != " here " ]]; then
  [ "$(id -u)" = 0 ] || die "a chroot needs root; scripts/matrix.sh here tries this system without one"
  command -v debootstrap >/dev/null || die "a chroot needs debootstrap; as root: apt-get install debootstrap"
  # shellcheck disable=SC2016 # apt's variable
  [ -n "$mirror" ] || mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Label: Debian' 2>/dev/null | head -1) || true
  [ -n "$mirror" ] || die "apt names no mirror of Debian here: --mirror URL does"
fi
work=$(mktemp -d)
trap clear_up EXIT
trap 'exit 129' HUP
trap 'exit 130' INT
trap 'exit 143' TERM
mkdir -p "$results"
table=$results/table.md
printf '| %s ' system PETSc compiler built warnings installed 'passed / failed' >"$table"
printf '|\n|---|---|---|---|---|---|---|\n' >>"$table"
for system in "${systems[@]}"; do
  rows_of "$system" >>"$table"
done
cat "$table"
! tail -n +3 "$table" | grep -v '| yes | [0-9]* | yes | [1-9][0-9]* / 0 |$' >/dev/null
