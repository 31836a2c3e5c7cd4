#!/usr/bin/python3
"""Slows a velocity command down where the robot comes near to something: an example, not a safety device.

Topics: joint_states in; command in and limited_command out (sensor_msgs/JointState with names and velocities, rad/s or
m/s). The next ~horizon seconds (0.5) limit the speed. A pair of bodies that comes nearer than ~slow (0.1 m) allows less
than the commanded speed, and none at ~stop (0.02 m). ~reach (1.0 m): the distance from a joint to the farthest point
that it moves. From one checked state to the next, no point moves farther than ~stop, so no thin object is missed.
~node: the planning_scene_node (/planning_scene). ~group: the group that moves. joint_states must then have a value of
each of its joints, and a command must not move other joints. The velocities are 0 without an answer of the node, or if
joint values are older than 0.25 s when the answer comes. Joints outside ~group may have values up to 2.5 s old. The
controller must stop by itself if no more commands come."""
import argparse
import math
import threading
import time

OLDEST = 0.25  # seconds: joint values count up to this age
ENDED = 2.5  # seconds, outside the group: slow drivers, for example of grippers, publish once a second
NOISE = 1e-5  # metres: a distance that shrinks by less stays the same


def future_states(now, velocities, horizon, step):
    """The rows of joint values of the next `horizon` seconds at these velocities, from `now` on. `step`: radians or
    metres, the most that all joints together move between two rows."""
    steps = max(1, math.ceil(horizon * sum(abs(velocity) for velocity in velocities) / step))
    return [[value + velocity * horizon * i / steps for value, velocity in zip(now, velocities)]
            for i in range(steps + 1)]


def scale_of(states, slow, stop):
    """The factor of a command. `states`: for each future state at full speed, the first one now, the distances (m) of
    the pairs of bodies that are nearer than `slow`. Within the horizon, a robot at this factor reaches only states that
    allow this factor."""
    allowed = 1.0  # by the states so far
    for i, state in enumerate(states):
        for pair, distance in state.items():
            if distance < states[0].get(pair, slow) - NOISE:
                allowed = min(allowed, max(0.0, (distance - stop) / (slow - stop)))
        if allowed * (len(states) - 1) < i:
            return max(allowed, (i - 1) / (len(states) - 1))
    return allowed


class SpeedLimiter:
    def __init__(self):
        import rospy
        from gpu_planning_scene.msg import AnswerStatus
        from gpu_planning_scene.srv import CheckStates, CheckStatesRequest
        from sensor_msgs.msg import JointState
        self.ros = rospy
        self.command = JointState
        self.horizon = rospy.get_param("~horizon", 0.5)
        self.slow = rospy.get_param("~slow", 0.1)
        self.stop = rospy.get_param("~stop", 0.02)
        self.reach = rospy.get_param("~reach", 1.0)
        self.all_pairs = CheckStatesRequest.ALL_PAIRS
        self.is_wrong = AnswerStatus.INVALID_REQUEST
        self.group = rospy.get_param("~group", "")
        self.moved = None  # the joints of the group, when the node has answered
        if not (self.horizon > 0 and self.slow > self.stop > 0 and self.reach > 0):
            raise SystemExit("limit_speed.py: ~horizon, ~stop and ~reach must be above 0, and ~slow above ~stop")
        self.values = {}  # joint -> (position, steady time of arrival, ROS time of the stamp or 0)
        service = rospy.get_param("~node", "/planning_scene") + "/check_states"
        rospy.wait_for_service(service)
        self.check = rospy.ServiceProxy(service, CheckStates)
        self.limited = rospy.Publisher("limited_command", JointState, queue_size=1)
        rospy.Subscriber("joint_states", JointState, self.take_values, queue_size=10)
        rospy.Subscriber("command", JointState, self.take_command, queue_size=1)
        self.checked = None  # the command that is checked now, and the steady time since when

    def take_values(self, message):
        arrival = time.monotonic()  # the ROS clock of a simulation may go back
        stamp = message.header.stamp.to_sec()
        self.values.update((name, (position, arrival, stamp)) for name, position in zip(message.name, message.position))

    def take_command(self, message):
        """Publishes the command with scaled velocities."""
        self.checked = message, time.monotonic()
        try:
            scale = self.scale(message)
        except Exception as error:  # whatever is wrong, the robot stops
            self.ros.logwarn_throttle(1, f"limit_speed.py: stopped: {error}")
            scale = 0.0
        self.checked = None
        self.publish(message, scale)

    def publish(self, message, scale):
        velocity = [scale * velocity if scale else 0.0 for velocity in message.velocity]
        self.limited.publish(self.command(header=message.header, name=message.name, position=message.position,
                                          velocity=velocity, effort=message.effort))

    def stop_while_waiting(self):
        """The call of a service has no time limit: a node that hangs must not leave the robot at its last velocity."""
        checked = self.checked
        if checked and time.monotonic() - checked[1] > OLDEST:
            self.ros.logwarn_throttle(1, f"limit_speed.py: stopped: the node has not answered for {OLDEST} s")
            self.publish(checked[0], 0.0)

    def watch_calls(self):
        """Calls stop_while_waiting() for ever. A timer of rospy would stand with a simulated clock."""
        while True:
            time.sleep(OLDEST / 5)
            self.stop_while_waiting()

    def joints_of_group(self):
        """The joints that ~group moves; none without a group."""
        if self.moved is None and self.group:
            current = self.answer_to(group=self.group, distances=self.all_pairs, distance_range=self.stop)
            moved = set()
            for name in current.gradient_names:  # all variables of the robot
                # The node lists no joints of a group, but it refuses a state without any joint of the group.
                answer = self.check(group=self.group, joint_names=[name], positions=[0.0])
                if answer.success:
                    moved.add(name)
                elif answer.status != self.is_wrong:
                    raise ValueError(answer.message)
            self.moved = moved
        return self.moved or set()

    def answer_to(self, **request):
        answer = self.check(**request)
        if not answer.success:
            raise ValueError(answer.message)
        return answer

    def require_fresh(self, values, required, fault):
        """Raises ValueError for a joint that may be elsewhere by now. `required`: joints that must have a value."""
        for name in sorted(required | values.keys()):
            if name not in values:
                raise ValueError(f"joint_states has brought no value of {name}")
            _, arrival, stamp = values[name]
            age = max(time.monotonic() - arrival, self.ros.get_time() - stamp if stamp else 0.0)
            limit = OLDEST if name in required or not self.group else ENDED
            if age > limit:
                raise ValueError(f"{fault}: the value of {name} is {age:.2f} s old; at most {limit} s are allowed")

    def scale(self, message):
        if not message.name or len(message.velocity) != len(message.name):
            raise ValueError("the command needs one velocity for each name")
        if not all(math.isfinite(velocity) for velocity in message.velocity):
            raise ValueError("a velocity of the command is not finite")
        moved = self.joints_of_group()
        for name in message.name:
            if self.group and name not in moved:
                raise ValueError(f"~group {self.group} does not move {name}, which the command names; "
                                 "set ~group to a group that moves all joints of the command, or leave it out")
        values = dict(self.values)  # while the node checks, newer values come
        required = moved | set(message.name)
        self.require_fresh(values, required, "joint_states is late")
        states = future_states([values[name][0] for name in message.name], message.velocity, self.horizon,
                               self.stop / max(self.reach, 1.0))
        answer = self.answer_to(group=self.group, joint_names=message.name, positions=sum(states, []),
                                distances=self.all_pairs, distance_range=self.slow)
        self.require_fresh(values, required, "the node has answered too late")
        near = [{} for _ in states]
        for found in answer.distances:
            near[found.state][found.body_1, found.body_2] = found.distance
        return scale_of(near, self.slow, self.stop)


def main():
    import rospy
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter,
                            usage="limit_speed.py [NAME:=VALUE ...]").parse_args(rospy.myargv()[1:])
    rospy.init_node("limit_speed")
    limiter = SpeedLimiter()
    threading.Thread(target=limiter.watch_calls, daemon=True).start()
    rospy.spin()


if __name__ == "__main__":
    main()
