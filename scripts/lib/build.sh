# Sourced by the scripts: configures and builds.
# shellcheck shell=bash

# configure_and_build FOLDER CMAKE_OPTIONS...: shows the output only after a failure. If `target` is set, builds only
# this target. The headers of FCL, OMPL and ROS take most of the time to compile, so the libraries are a unity build:
# it reads each header once for twelve files.
configure_and_build()
{
  local folder=$1 log="$1/build.log"
  shift
  use_build_folder "$folder"
  if ! run cmake -S "$repository" -B "$folder" -G Ninja -DPYTHON_EXECUTABLE=/usr/bin/python3 \
    -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=12 "$@" > "$log" 2>&1; then
    tail -40 "$log" >&2
    die "CMake could not configure the package (above; all of it in ${log#"$repository"/})"
  fi
  if ! run cmake --build "$folder" ${target:+--target "$target"} >> "$log" 2>&1; then
    grep -A 30 -m 1 '^FAILED' "$log" >&2 || tail -40 "$log" >&2
    die "the package does not build (above; all of it in ${log#"$repository"/})"
  fi
}
