#!/usr/bin/env bash
# What ./run and ./check share: the environment, the Debian packages, the build.
# Sourced it defines functions; run as a program it installs the packages.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
export python=/usr/bin/python3 # Debian's, the one that has the packages

run_packages=(petsc-dev libpetsc-real-dev libhdf5-openmpi-dev libopenmpi-dev openmpi-bin libyaml-dev libopenblas0-pthread
  libcmocka-dev python3-numpy python3-h5py python3-matplotlib cmake ninja-build pkg-config gcc)
check_packages=("${run_packages[@]}" clang-format cppcheck python3-pip python3-scipy python3-setuptools python3-wheel mkdocs)

# One thread a rank; OpenMPI may run as root, may share cores, and does not pin several runs to the same core.
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
export OMPI_MCA_rmaps_base_oversubscribe=1 OMPI_MCA_hwloc_base_binding_policy=none
export PRTE_MCA_rmaps_default_mapping_policy=:oversubscribe PRTE_MCA_hwloc_default_binding_policy=none # the same of OpenMPI 5
export OMPI_MCA_btl_vader_single_copy_mechanism=none OMPI_MCA_mpi_yield_when_idle=1
export OMPI_MCA_ess_singleton_isolated=1 # one rank starts no daemon of its own
export MPLBACKEND=Agg

say() { printf '== %s\n' "$*"; }
die() { printf '%s: %s\n' "$(basename "$0")" "$*" >&2; exit 1; }

# A package counts as there when dpkg has it; PETSc also when pkg-config finds a build of the user's own.
have_package() {
  case $1 in
    petsc-dev | libpetsc-real-dev) command -v pkg-config >/dev/null && pkg-config --exists PETSc && return 0 ;;
  esac
  [ "$(dpkg-query -W -f='${Status}' "$1" 2>/dev/null)" = "install ok installed" ]
}

# setup_packages NAME...: installs those that are missing.
setup_packages() {
  local missing=() name as_root=()
  command -v dpkg-query >/dev/null || { say "no dpkg here: taking it that these are installed: $*"; return 0; }
  for name in "$@"; do have_package "$name" || missing+=("$name"); done
  [ ${#missing[@]} -gt 0 ] || return 0
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || die "not root and no sudo; as root: apt-get install --no-install-recommends ${missing[*]}"
    as_root=(sudo)
  fi
  say "installing ${missing[*]}"
  "${as_root[@]}" apt-get update -q </dev/null || say "apt-get update failed; trying with the lists at hand"
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends "${missing[@]}" </dev/null
}

# quietly LOG COMMAND...: output to LOG, shown only when the command fails.
quietly() {
  local log=$1
  shift
  "$@" >"$log" 2>&1 </dev/null || { local code=$?; cat "$log" >&2; return $code; }
}

# setup_build FOLDER TARGET [cmake options]: configures and builds.
setup_build() {
  local folder=$root/$1 target=$2
  shift 2
  mkdir -p "$folder"
  if [ -f "$folder/CMakeCache.txt" ] && ! grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$root" "$folder/CMakeCache.txt"; then
    say "$folder was configured for a folder of another name: configuring it anew"
    rm -rf "$folder/CMakeCache.txt" "$folder/CMakeFiles"
  fi
  quietly "$folder/configure.log" cmake -S "$root" -B "$folder" -G Ninja "$@" || die "cmake failed in $folder"
  quietly "$folder/build.log" cmake --build "$folder" --target "$target" || die "the build failed in $folder"
}

if [ "${BASH_SOURCE[0]}" = "$0" ]; then
  setup_packages "${check_packages[@]}"
fi
