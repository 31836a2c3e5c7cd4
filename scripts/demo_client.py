#!/usr/bin/python3
"""Checks random states of the robot on the parameter server through planning_scene_node, and summarises the answers."""
import argparse
import collections
import math
import sys
import threading
import time
import xml.etree.ElementTree

import numpy
import yaml

# Debian 11's rospy calls isAlive, which Python 3.9 no longer has.
threading.Thread.isAlive = threading.Thread.is_alive

# Variables have MoveIt's names: the name of the joint, or JOINT/PART if the joint has several variables.
Variable = collections.namedtuple("Variable", "name lower upper")
QUATERNION = ["rot_x", "rot_y", "rot_z", "rot_w"]


def limits_of(joint, replaced):
    """The limits of a revolute or prismatic joint of the URDF: those of <limit> and of <safety_controller>, or those
    that replace them."""
    lower, upper = (float(joint.find("limit").get(name, 0)) for name in ("lower", "upper"))
    soft = joint.find("safety_controller")
    if soft is not None:
        lower = max(lower, float(soft.get("soft_lower_limit", 0)))
        upper = min(upper, float(soft.get("soft_upper_limit", 0)))
    return replaced.get("min_position", lower), replaced.get("max_position", upper)


def variables_of(urdf, joint_limits=None, reach=1.0):
    """The variables of a URDF text that need values. `joint_limits`: the parameter
    robot_description_planning/joint_limits. Angles without limits get the range [-pi, pi]; translations of planar and
    floating joints get the range [-reach, reach] in metres."""
    variables = []
    for joint in xml.etree.ElementTree.fromstring(urdf).findall("joint"):
        name, kind = joint.get("name"), joint.get("type")
        if kind == "fixed" or joint.find("mimic") is not None:
            continue
        if kind in ("revolute", "prismatic"):
            variables.append(Variable(name, *limits_of(joint, (joint_limits or {}).get(name, {}))))
        elif kind == "continuous":
            variables.append(Variable(name, -math.pi, math.pi))
        elif kind == "planar":
            variables += [Variable(f"{name}/{part}", -reach, reach) for part in ("x", "y")]
            variables.append(Variable(f"{name}/theta", -math.pi, math.pi))
        elif kind == "floating":
            variables += [Variable(f"{name}/{part}", -reach, reach) for part in ("trans_x", "trans_y", "trans_z")]
            variables += [Variable(f"{name}/{part}", -1.0, 1.0) for part in QUATERNION]
    return variables


def random_states(variables, count, seed, around=None, spread=0.0):
    """Random states, one per row. Without `around`, they are uniform within the limits, and rotations of floating
    joints are uniform over all rotations. With `around` (name -> value), each variable is within the limits and within
    `spread` of its value in `around`; quaternions are normalised afterwards."""
    generator = numpy.random.default_rng(seed)
    lower = numpy.array([variable.lower for variable in variables])
    upper = numpy.array([variable.upper for variable in variables])
    names = [variable.name for variable in variables]
    if around is None:
        states = generator.uniform(lower, upper, (count, len(variables)))
    else:
        center = numpy.array([around.get(name, 1.0 if name.endswith("/rot_w") else 0.0) for name in names])
        states = center + generator.uniform(-spread, spread, (count, len(variables)))
        states = numpy.clip(states, lower, upper)
    for column, name in enumerate(names):
        if name.endswith("/rot_x"):
            rotation = slice(column, column + len(QUATERNION))
            if around is None:
                states[:, rotation] = generator.normal(size=(count, len(QUATERNION)))
            states[:, rotation] /= numpy.linalg.norm(states[:, rotation], axis=1, keepdims=True)
    return states


def state_of_scene(path):
    """The joint values in the robot_state of a scene file."""
    with open(path) as file:
        robot_state = yaml.safe_load(file)["robot_state"]
    if "joint_state" not in robot_state:
        sys.exit(f"demo_client: {path}: --around needs joint values, and robot_state has no joint_state")
    joint_state = robot_state["joint_state"]
    return dict(zip(joint_state["name"], joint_state["position"]))


def summary(response, count, seconds):
    """The lines that the client prints."""
    valid = numpy.frombuffer(response.valid, dtype=numpy.uint8)
    pairs = collections.Counter(
        tuple(sorted(pair)) for pair, free in zip(zip(response.body_1, response.body_2), valid) if not free
    )
    free = numpy.count_nonzero(valid)
    lines = [
        f"valid: {free} of {count} states ({100 * free / count:.1f} %)",
        f"rate: {count / response.seconds:.0f} states/s"
        f" ({response.seconds:.3f} s in the checker, {seconds:.3f} s for the whole ROS call; median of 5)",
        "states in collision, by the pair that was found first:" if pairs else "no state is in collision",
    ]
    commonest = pairs.most_common(5)
    lines += [f"  {first} - {second}: {number} states" for (first, second), number in commonest]
    others = sum(pairs.values()) - sum(number for _, number in commonest)
    return lines + ([f"  other pairs: {others} states"] if others else [])


def call(arguments):
    """Calls the node; returns the exit code."""
    import rospy  # imported here, so that the other functions work without ROS
    from gpu_planning_scene.srv import CheckStates

    rospy.init_node("demo_client", anonymous=True)
    rospy.wait_for_service(arguments.service, arguments.timeout)
    variables = variables_of(
        rospy.get_param("robot_description"), rospy.get_param("robot_description_planning/joint_limits", None)
    )
    around = state_of_scene(arguments.around) if arguments.around else None
    states = random_states(variables, arguments.states, arguments.seed, around, arguments.spread)
    check_states = rospy.ServiceProxy(arguments.service, CheckStates)
    request = {"group": arguments.group, "joint_names": [variable.name for variable in variables], "max_contacts": 0}

    calls = []
    for _ in range(5):  # the median leaves out slow first calls and calls on a busy machine
        begin = time.monotonic()
        response = check_states(positions=states.ravel(), **request)
        calls.append((time.monotonic() - begin, response))
        if not response.success:
            print(f"demo_client: {response.message}", file=sys.stderr)
            return 1
    if response.message:  # a warning, which is the same for each of the calls
        print(f"demo_client: {response.message}", file=sys.stderr)
    seconds, response = sorted(calls, key=lambda call: call[0])[len(calls) // 2]
    where = f"within {arguments.spread} of the scene's state" if around else "within the joints' limits"
    print(f"states: {len(states)}, random {where}, seed {arguments.seed}")
    print("\n".join(summary(response, len(states), seconds)))
    return 0


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--states", type=int, default=16384, help="how many (default: %(default)s)")
    parser.add_argument("--seed", type=int, default=1, help="of the random states (default: %(default)s)")
    parser.add_argument("--around", metavar="SCENE", help="draw states around the robot_state of this scene file")
    parser.add_argument("--spread", type=float, default=0.2, help="radians and metres (default: %(default)s)")
    parser.add_argument("--group", default="", help="check only what this planning group moves")
    parser.add_argument("--service", default="/planning_scene/check_states", help="(default: %(default)s)")
    parser.add_argument("--timeout", type=float, default=120, help="seconds to wait for it (default: %(default)s)")
    # Removes the arguments that roslaunch and rosrun add, such as __name:=...
    arguments = parser.parse_args([argument for argument in sys.argv[1:] if ":=" not in argument])
    try:
        return call(arguments)
    except KeyboardInterrupt:
        return 130
    except Exception as error:  # one line for the user instead of a traceback
        print(f"demo_client: {error}", file=sys.stderr)
        return 1


if __name__ == "__main__":
    sys.exit(main())
