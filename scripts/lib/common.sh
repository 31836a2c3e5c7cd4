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

# use_build_folder FOLDER: makes it. What another user left there (sudo, once) is named rather than tripped over.
use_build_folder()
{
  local foreign
  mkdir -p "$1" 2> /dev/null || die "cannot make ${1#"$repository"/}"
  foreign="$(find "$1" ! -writable -print -quit)"
  [[ -z "$foreign" ]] ||
    die "cannot write to ${foreign#"$repository"/}, which belongs to $(stat -c %U "$foreign"): remove ${1#"$repository"/}, or run as that user"
}
