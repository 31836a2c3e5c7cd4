# Sourced by the scripts: messages, folders and the environment that Debian's ROS 1 needs.
# shellcheck shell=bash

die()
{
  echo "${0##*/}: $*" >&2
  exit 1
}

# A heading of the script's own output.
say()
{
  echo "== $*"
}

repository="$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)"
build="$repository/build"

# The system's tools come before those of pyenv, conda and the like, whose python3 lacks Debian's ROS, and whose prefixes
# CMake would search. Another ROS that is sourced here would be mixed with Debian's: it goes too.
use_system_environment()
{
  export PATH="/usr/bin:/bin:/usr/sbin:/sbin:$PATH"
  unset PYTHONPATH PYTHONHOME VIRTUAL_ENV CONDA_PREFIX CMAKE_PREFIX_PATH PKG_CONFIG_PATH ROS_PACKAGE_PATH ROS_ROOT \
    ROS_DISTRO ROS_NAMESPACE ROSLISP_PACKAGE_DIRECTORIES
}

# use_build_folder FOLDER: makes it; a folder left behind by another user (sudo, once) is named rather than tripped over.
use_build_folder()
{
  if ! mkdir -p "$1" 2> /dev/null || [[ ! -w "$1" || ! -w "$build" ]]; then
    die "cannot write to ${1#"$repository"/}: it belongs to $(stat -c %U "$build" 2> /dev/null || echo another user); remove it or run as that user"
  fi
}
