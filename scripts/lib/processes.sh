# Sourced by the scripts: runs programs, and at the end of the script, however it comes, ends those that it started and
# removes its temporary folder.
# shellcheck shell=bash

started=()  # ids of the processes that this script started in the background
grace=10    # seconds that a process has to end by itself
temporary="$(mktemp -d)"

# process_field PID N: field N of /proc/PID/stat, counted from the state (0); fails when the process is gone.
process_field()
{
  local line fields
  { line="$(< "/proc/$1/stat")"; } 2> /dev/null || return 1
  read -ra fields <<< "${line##*) }"  # the name before it may hold spaces
  echo "${fields[$2]}"
}

# process_tree PID: prints PID:STARTTIME of the process and all below it, parents first.
process_tree()
{
  cat /proc/[0-9]*/stat 2> /dev/null | awk -v root="$1" '
    { pid = $1; sub(/^.*\) /, ""); parent[pid] = $2; start[pid] = $20 }
    function print_tree(pid, child)
    {
      print pid ":" start[pid]
      for (child in parent)
        if (parent[child] == pid)
          print_tree(child)
    }
    END { if (root in start) print_tree(root) }'
}

# is_running PID:STARTTIME: still that process, and no zombie.
is_running()
{
  local start
  start="$(process_field "${1%:*}" 19)" && [[ "$start" == "${1#*:}" && "$(process_field "${1%:*}" 0)" == [^Z] ]]
}

# stop PID: asks a process of ours to end (it ends those below it, as roslaunch and ninja do); after `grace` it ends what
# is left of it and of those below it.
stop()
{
  local tree process tries=$((grace * 10))
  is_running "$1:$(process_field "$1" 19)" || return 0
  mapfile -t tree < <(process_tree "$1")
  kill -TERM "$1" 2> /dev/null || true
  for process in "${tree[@]}"; do
    while is_running "$process" && [[ $((tries--)) -gt 0 ]]; do
      sleep 0.1
    done
    if is_running "$process"; then
      kill -KILL "${process%:*}" 2> /dev/null || true
    fi
  done
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
  while [[ "$(process_field "$own" 0)" == [^Z] ]]; do
    if [[ "$(process_field "$other" 0)" != [^Z] ]]; then
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
  rm -rf "$temporary"
  exit "$status"
}
trap clean_up EXIT
trap 'exit 130' INT
trap 'exit 143' TERM
trap 'exit 129' HUP
