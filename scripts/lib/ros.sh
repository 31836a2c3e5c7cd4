# Sourced by the scripts: starts a separate ROS master on the loopback interface.
# shellcheck shell=bash

# source_workspace FOLDER: sets the environment of a built workspace.
source_workspace()
{
  set +u  # catkin's script reads unset variables
  # shellcheck disable=SC1091
  source "$1/devel/setup.bash"
  set -u
}

# start_master: starts roscore on a free port, so that it does not conflict with another master.
start_master()
{
  local port log="$temporary/roscore.log" tries=200
  port="$(/usr/bin/python3 -c \
    'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])')"
  export ROS_MASTER_URI="http://127.0.0.1:$port" ROS_IP=127.0.0.1
  export ROS_HOME="$temporary/ros" ROS_LOG_DIR="$temporary/ros/log"
  unset ROS_HOSTNAME
  start "$log" roscore -p "$port"
  until (: < "/dev/tcp/127.0.0.1/$port") 2> /dev/null; do
    if ! kill -0 "${started[-1]}" 2> /dev/null || [[ $((tries--)) -eq 0 ]]; then
      tail -20 "$log" >&2
      die "roscore did not start (above)"
    fi
    sleep 0.1
  done
}
