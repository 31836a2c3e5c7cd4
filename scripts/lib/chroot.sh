# Sourced by the scripts, after common.sh and processes.sh: fresh installations of a release in a folder, made by
# debootstrap.
# shellcheck shell=bash

require_chroots()
{
  [[ "$(id -u)" -eq 0 ]] || die "debootstrap and chroot need root"
  command -v debootstrap > /dev/null || die "debootstrap is missing: apt install debootstrap"
}

# remove_chroots FOLDER: removes the hidden folders that a killed run has left there.
remove_chroots()
{
  find "$1" -mindepth 1 -maxdepth 1 -name '.*' -exec rm -rf --one-file-system {} + 2> /dev/null || true
}

# isolated FUNCTION ARGUMENTS...: calls an exported function in name spaces of its own, in which nothing outside sees
# the mounts and no process outlives the call. The function has the functions of this file.
isolated()
{
  export repository
  export -f make_chroot in_chroot clone_commit
  export -f "$1"
  # shellcheck disable=SC2016  # the other bash replaces "$@"
  run unshare --mount --pid --fork --kill-child --propagation private bash -euo pipefail -c '"$@"' - "$@"
}

# make_chroot RELEASE ROOT PACKAGES: installs the release and the packages (separated by commas) in the folder ROOT,
# which an earlier run may have left. Only below `isolated`, whose end removes the mounts.
make_chroot()
{
  local release=$1 root=$2 packages=$3
  rm -rf --one-file-system "$root"
  mkdir -p "$(dirname "$root")"
  debootstrap --variant=minbase --include="$packages" "$release" "$root"
  mount --rbind /dev "$root/dev"
  mount --rbind /sys "$root/sys"
  mount -t proc proc "$root/proc"
  cp --dereference /etc/resolv.conf "$root/etc/resolv.conf"
  apt-config dump Acquire > "$root/etc/apt/apt.conf.d/acquire"  # a proxy, for example
}

# in_chroot ROOT FOLDER COMMAND: runs a command line with a clean environment in the folder of the chroot.
in_chroot()
{
  chroot "$1" /usr/bin/env --ignore-environment HOME=/root TERM=dumb PATH=/usr/sbin:/usr/bin:/sbin:/bin \
    bash -c 'cd "$1" && eval "$2"' - "$2" "$3"
}

# clone_commit ROOT FOLDER: clones the last commit into the folder of the chroot, which must have git.
clone_commit()
{
  # safe.directory: under sudo the repository belongs to another user, and git would refuse it.
  git -C "$repository" -c safe.directory='*' bundle create --quiet "$1/root/commit.bundle" HEAD
  git clone --quiet "$1/root/commit.bundle" "$1$2"
}
