# Sourced by the scripts: configures and builds.
# shellcheck shell=bash

# configure_and_build FOLDER CMAKE_OPTIONS...: shows the output only after a failure. If `target` is set, builds only
# this target.
configure_and_build()
{
  local folder=$1 log="$1/build.log"
  shift
  use_build_folder "$folder"
  if ! run cmake -S "$repository" -B "$folder" -G Ninja -DPYTHON_EXECUTABLE=/usr/bin/python3 "$@" > "$log" 2>&1; then
    tail -40 "$log" >&2
    die "CMake could not configure the package (above; all of it in ${log#"$repository"/})"
  fi
  if ! run cmake --build "$folder" ${target:+--target "$target"} >> "$log" 2>&1; then
    grep -A 30 -m 1 '^FAILED' "$log" >&2 || tail -40 "$log" >&2
    die "the package does not build (above; all of it in ${log#"$repository"/})"
  fi
}
