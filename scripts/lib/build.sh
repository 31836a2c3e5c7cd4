# Sourced by the scripts: configures and builds.
# shellcheck shell=bash

# say_progress LOG: prints once a minute how many steps of the build are done.
say_progress()
{
  local minutes=0
  while sleep 60; do
    say "minute $((++minutes)), steps done: $(grep -oE '^\[[0-9]+/[0-9]+\]' "$1" | tail -1)"
  done
}

# configure_and_build FOLDER [--target TARGET] CMAKE_OPTIONS...: shows the output only after a failure. With --target,
# builds only this target. The headers of FCL, OMPL and ROS take most of the time to compile, so the libraries are a
# unity build: it reads each header once for twenty files. ccache is used where it is installed. Programs are not linked
# again if only a shared library has changed.
configure_and_build()
{
  local folder=$1 log="$1/build.log" launcher progress built=0 only=()
  shift
  if [[ "${1:-}" == --target ]]; then
    only=(--target "$2")
    shift 2
  fi
  launcher="$(command -v ccache || true)"
  # Otherwise ccache compiles every file that uses precompiled headers.
  export CCACHE_SLOPPINESS="${CCACHE_SLOPPINESS:-pch_defines,time_macros}"
  use_build_folder "$folder"
  if ! run cmake -S "$repository" -B "$folder" -G Ninja -DPYTHON_EXECUTABLE=/usr/bin/python3 \
    -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=20 -DCMAKE_LINK_DEPENDS_NO_SHARED=ON \
    -DCMAKE_CXX_COMPILER_LAUNCHER="$launcher" "$@" > "$log" 2>&1; then
    tail -40 "$log" >&2
    die "CMake could not configure the package (above; all of it in ${log#"$repository"/})"
  fi
  say_progress "$log" &
  progress=$!
  started+=("$progress")
  disown  # otherwise bash reports its end
  # By itself, Ninja starts two compilers more than there are processors. On two processors, the build then takes 10 %
  # longer.
  run cmake --build "$folder" --parallel "$(nproc)" "${only[@]}" >> "$log" 2>&1 || built=$?
  stop "$progress"
  if ((built != 0)); then
    grep -A 30 -m 1 '^FAILED' "$log" >&2 || tail -40 "$log" >&2
    die "the package does not build (above; all of it in ${log#"$repository"/})"
  fi
}
