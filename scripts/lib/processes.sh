# Sourced by the scripts: runs programs. At the end of the script, also after an error or a signal, it ends the programs
# that the script started, and removes its temporary folder.
# shellcheck shell=bash

started=()  # ids of the processes that this script started in the background
grace=10    # seconds between SIGTERM and SIGKILL
temporary="$(mktemp -d)"
# All descendants of this script inherit this variable. It identifies them even after their parent has ended.
export GPU_PLANNING_SCENE_SCRIPT="$$.$RANDOM$RANDOM"

# process_state PID: prints the state in /proc/PID/stat, Z for a process that has ended. Fails if the process is gone.
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

# stop PID: sends SIGTERM to a process of this script, which should end its children as roslaunch does. After `grace`
# seconds, sends SIGKILL.
stop()
{
  local tries=$((grace * 10))
  kill -TERM "$1" 2> /dev/null || return 0
  while is_running "$1" && [[ $((tries--)) -gt 0 ]]; do
    sleep 0.1
  done
  kill -KILL "$1" 2> /dev/null || true
}

# stop_all: does the same with all remaining descendants of this script.
stop_all()
{
  local left signal=TERM tries=$((grace * 10))
  while mapfile -t left < <(processes_below) && [[ ${#left[@]} -gt 0 ]]; do
    kill -"$signal" "${left[@]}" 2> /dev/null || true
    sleep 0.1
    signal=0  # send SIGTERM only once
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

# start LOG COMMAND...: starts a command in the background, with its output in LOG. Its id is in $! afterwards.
start()
{
  local log=$1
  shift
  "$@" > "$log" 2>&1 < /dev/null &
  started+=($!)
  disown  # otherwise bash reports its end
}

# run COMMAND...: runs a command to its end. A signal during the run ends the script immediately.
run()
{
  "$@" < /dev/null &
  started+=($!)
  wait $!
}

# run_beside PID COMMAND...: like run, but if the process PID ends first, it ends the command and fails.
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
