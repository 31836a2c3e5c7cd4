# Sourced by the scripts: messages, folders and the environment that Debian's ROS 1 needs.
# shellcheck shell=bash

die()
{
  echo "${0##*/}: $*" >&2
  exit 1
}

# Prints a heading.
say()
{
  echo "== $*"
}

repository="$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)"
build="$repository/build"

# Puts the system's tools before those of pyenv and conda: their python3 lacks Debian's ROS, and CMake would search
# their prefixes. Also removes the variables of another sourced ROS, which would be mixed with Debian's.
use_system_environment()
{
  export PATH="/usr/bin:/bin:/usr/sbin:/sbin:$PATH"
  unset PYTHONPATH PYTHONHOME VIRTUAL_ENV CONDA_PREFIX CMAKE_PREFIX_PATH PKG_CONFIG_PATH ROS_PACKAGE_PATH ROS_ROOT \
    ROS_DISTRO ROS_NAMESPACE ROSLISP_PACKAGE_DIRECTORIES
}

# use_build_folder FOLDER: makes the folder. Ends with an error if it contains files of another user, for example after
# a run with sudo.
use_build_folder()
{
  local foreign
  mkdir -p "$1" 2> /dev/null || die "cannot make ${1#"$repository"/}"
  foreign="$(find "$1" ! -writable -print -quit)"
  [[ -z "$foreign" ]] ||
    die "cannot write to ${foreign#"$repository"/}, which belongs to $(stat -c %U "$foreign"):" \
      "remove ${1#"$repository"/}, or run as that user"
}
