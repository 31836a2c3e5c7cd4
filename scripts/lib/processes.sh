# Sourced by the scripts: runs programs, and at the end of the script, however it comes, ends those that it started and
# removes its temporary folder.
# shellcheck shell=bash

started=()  # ids of the processes that this script started in the background
grace=10    # seconds that a process has to end by itself
temporary="$(mktemp -d)"
# Everything below this script inherits it, so that it is found even where the process between has ended.
export GPU_PLANNING_SCENE_SCRIPT="$$.$RANDOM$RANDOM"

# process_state PID: as in /proc/PID/stat, Z for one that has ended; fails when the process is gone.
process_state()
{
  local line
  { line="$(< "/proc/$1/stat")"; } 2> /dev/null || return 1
  line="${line##*) }"  # the name before it may hold spaces
  echo "${line%% *}"
}

is_running()
{
  [[ "$(process_state "$1")" == [^Z] ]]
}

# stop PID: asks a process of ours to end (it ends those below it, as roslaunch does); after `grace` it has to.
stop()
{
  local tries=$((grace * 10))
  kill -TERM "$1" 2> /dev/null || return 0
  while is_running "$1" && [[ $((tries--)) -gt 0 ]]; do
    sleep 0.1
  done
  kill -KILL "$1" 2> /dev/null || true
}

# stop_all: the same for everything that is left below this script.
stop_all()
{
  local left signal=TERM tries=$((grace * 10))
  while mapfile -t left < <(processes_below) && [[ ${#left[@]} -gt 0 ]]; do
    kill -"$signal" "${left[@]}" 2> /dev/null || true
    sleep 0.1
    signal=0  # asked once
    [[ $((tries--)) -gt 0 ]] || signal=KILL
  done
}

processes_below()
{
  local mark="GPU_PLANNING_SCENE_SCRIPT=$GPU_PLANNING_SCENE_SCRIPT" file
  while read -r file; do
    file="${file#/proc/}"
    echo "${file%/environ}"
  done < <(env --unset=GPU_PLANNING_SCENE_SCRIPT grep -lasF "$mark" /proc/[0-9]*/environ)
}

# start LOG COMMAND...: in the background; its id is in $! afterwards.
start()
{
  local log=$1
  shift
  "$@" > "$log" 2>&1 < /dev/null &
  started+=($!)
  disown  # bash is not to report its end
}

# run COMMAND...: waits for it, but a signal that comes meanwhile ends the script at once.
run()
{
  "$@" < /dev/null &
  started+=($!)
  wait $!
}

# run_beside PID COMMAND...: as `run`, but ends the command and fails when the process PID ends before it.
run_beside()
{
  local other=$1 own
  shift
  "$@" < /dev/null &
  own=$!
  started+=("$own")
  while is_running "$own"; do
    if ! is_running "$other"; then
      stop "$own"
      return 1
    fi
    sleep 0.1
  done
  wait "$own"
}

clean_up()
{
  local status=$? i
  trap '' INT TERM HUP
  for ((i = ${#started[@]} - 1; i >= 0; i--)); do
    stop "${started[i]}"
  done
  stop_all
  rm -rf "$temporary"
  exit "$status"
}
trap clean_up EXIT
trap 'exit 130' INT
trap 'exit 143' TERM
trap 'exit 129' HUP
