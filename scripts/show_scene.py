#!/usr/bin/python3
"""Starts RViz with the scene of a running planning_scene_node: the robot, the objects, contacts and planned paths."""
import argparse
import math
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

import numpy
import yaml

# Views that are tried, in this order: horizontal directions from the scene to the camera, in radians. The first is the
# default view of the tool `render`.
YAWS = [math.atan2(-0.75, 1.0) + step * math.pi / 4 for step in (0, -1, 1, -2, 2, -3, 3, 4)]
PITCH = 0.41  # radians
MAX_POINTS = 500  # of a marker
PATIENCE_FOR_PLAN = 1.0  # seconds: the node keeps the markers of the last plan for new subscribers


def rotation_of(quaternion):
    """The matrix of a geometry_msgs/Quaternion."""
    x, y, z, w = (getattr(quaternion, axis) for axis in "xyzw")
    return numpy.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


def upright(up):
    """A quaternion that turns the z axis to the direction `up`."""
    from geometry_msgs.msg import Quaternion

    x, y, z = numpy.array(up) / numpy.linalg.norm(up)
    if z < -0.999999:
        return Quaternion(1.0, 0.0, 0.0, 0.0)
    turn = numpy.array([-y, x, 0.0, 1.0 + z])
    return Quaternion(*map(float, turn / numpy.linalg.norm(turn)))


def points_of(marker):
    """Points of a marker in its frame, one per row: vertices of triangles, or corners of boxes around the solids."""
    chosen = marker.points[:: max(1, len(marker.points) // MAX_POINTS)]
    points = numpy.array([[point.x, point.y, point.z] for point in chosen]).reshape(-1, 3)
    if marker.type != marker.TRIANGLE_LIST:
        half = 0.5 * numpy.array([marker.scale.x, marker.scale.y, marker.scale.z])
        corners = half * numpy.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
        centers = points if len(points) else numpy.zeros((1, 3))
        points = (centers[:, None, :] + corners[None, :, :]).reshape(-1, 3)
    position = marker.pose.position
    return points @ rotation_of(marker.pose.orientation).T + [position.x, position.y, position.z]


def hidden_share(points, eye, boxes):
    """The share of the points whose straight line to the eye passes through one of the boxes (lower, upper)."""
    hidden = numpy.zeros(len(points), dtype=bool)
    direction = eye - points
    direction[direction == 0.0] = 1e-12
    for lower, upper in boxes:
        slabs = numpy.stack([(lower - points) / direction, (upper - points) / direction])
        enter = numpy.maximum(slabs.min(axis=0).max(axis=1), 0.0)
        leave = numpy.minimum(slabs.max(axis=0).min(axis=1), 1.0)
        hidden |= enter < leave
    return hidden.mean()


def view_of(markers, axes):
    """The focal point, distance and yaw of an RViz orbit view, in metres and radians: the robot fills much of the
    picture, and few objects hide it. The robots along a planned path count as robots. `axes`: the axes of the fixed
    frame, as columns, in the frame of the markers."""
    robot = [points_of(marker) @ axes for marker in markers if marker.ns in ("robot", "ghosts")]
    points = numpy.concatenate(robot) if robot else numpy.array([[-1.0, -1.0, -1.0], [1.0, 1.0, 1.0]])
    lower, upper = points.min(axis=0), points.max(axis=0)
    focus, size = 0.5 * (lower + upper), max(0.1, float(numpy.linalg.norm(upper - lower)))
    objects = [points_of(marker) @ axes for marker in markers if marker.ns == "objects"]
    boxes = [(corners.min(axis=0), corners.max(axis=0)) for corners in objects]

    def hidden(yaw):
        line_of_sight = [math.cos(PITCH) * math.cos(yaw), math.cos(PITCH) * math.sin(yaw), math.sin(PITCH)]
        return round(hidden_share(points, focus + 2.4 * size * numpy.array(line_of_sight), boxes), 1)

    return focus, 2.4 * size, min(YAWS, key=hidden)


def configuration(template, node, frame, view):
    """The RViz configuration `template` with the topics of `node`, the fixed frame and the view."""
    manager = template["Visualization Manager"]
    for display in manager["Displays"]:
        if "Marker Topic" in display:
            display["Marker Topic"] = f"{node}/{display['Marker Topic'].rsplit('/', 1)[1]}"
    manager["Global Options"]["Fixed Frame"] = frame
    focus, distance, yaw = view
    manager["Views"]["Current"].update(
        {
            "Focal Point": dict(zip("XYZ", map(float, focus))),
            "Distance": float(distance),
            "Pitch": PITCH,
            "Yaw": float(yaw % (2 * math.pi)),
        }
    )
    return template


def first_markers(topic):
    """Waits for the markers of the node. None if ROS shuts down before they come."""
    import rospy  # imported here, so that the other functions work without ROS
    from visualization_msgs.msg import MarkerArray

    while not rospy.is_shutdown():
        try:
            # The first marker only deletes earlier markers.
            return rospy.wait_for_message(topic, MarkerArray, 10).markers[1:]
        except rospy.ROSInterruptException:
            return None
        except rospy.ROSException:
            rospy.logwarn("no message on %s; is planning_scene_node running under this name?", topic)
    return None


def markers_of_plan(topic):
    """The markers of the last planned path, in the frame of the scene's markers; empty without a plan."""
    import rospy
    from visualization_msgs.msg import MarkerArray

    try:
        return rospy.wait_for_message(topic, MarkerArray, PATIENCE_FOR_PLAN).markers[1:]
    except rospy.ROSException:  # also when ROS shuts down
        return []


def announce(frame, child, rotation):
    """Publishes the frame `child` at the origin of the planning frame. RViz needs it for another upward direction. It
    also warns about a planning frame that tf does not know, which is the case where nobody else publishes tf."""
    import rospy
    from geometry_msgs.msg import TransformStamped
    from tf2_msgs.msg import TFMessage

    origin = TransformStamped(child_frame_id=child)
    origin.header.frame_id, origin.header.stamp = frame, rospy.Time.now()
    origin.transform.rotation = rotation
    publisher = rospy.Publisher("/tf_static", TFMessage, queue_size=1, latch=True)
    publisher.publish(TFMessage([origin]))
    return publisher


def environment_of_rviz(environment):
    """The environment for RViz. RViz draws through X11 only, and ends at its start if Qt chooses Wayland. None without
    an X11 screen."""
    if not environment.get("DISPLAY"):
        return None
    platform = environment.get("QT_QPA_PLATFORM", "wayland")
    return dict(environment, QT_QPA_PLATFORM="xcb" if "wayland" in platform else platform)


def fault_of(status):
    """A line about RViz's exit status; empty if RViz was closed."""
    if status == 0:
        return ""
    how = f"was ended by signal {-status}" if status < 0 else f"ended with exit code {status}"
    return (
        f"show_scene.py: RViz {how}; its messages are above. If it cannot draw with the graphics driver, run the "
        "command again after: export LIBGL_ALWAYS_SOFTWARE=1"
    )


def main():
    import rospkg
    import rospy

    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--node", default="planning_scene", help="name of the planning_scene_node (%(default)s)")
    parser.add_argument("--up", default="0,0,1", metavar="X,Y,Z", help="upward direction (%(default)s)")
    arguments = parser.parse_args(rospy.myargv()[1:])
    try:
        up = [float(word) for word in arguments.up.split(",")]
    except ValueError:
        up = []
    if len(up) != 3 or not 0.0 < numpy.linalg.norm(up) < math.inf:
        parser.error(f"--up: '{arguments.up}' is not a direction X,Y,Z")
    if not shutil.which("rviz"):
        print("show_scene.py: RViz is missing; install the package rviz (Debian) or ros-noetic-rviz", file=sys.stderr)
        return 1
    environment = environment_of_rviz(os.environ)
    if environment is None:
        print(
            "show_scene.py: there is no screen for RViz, because DISPLAY is not set; start it in a terminal of a "
            "desktop or with ssh -X, or leave out RViz (rviz:=false)",
            file=sys.stderr,
        )
        return 1
    rospy.init_node("show_scene", anonymous=True)
    node = rospy.resolve_name(arguments.node)
    markers = first_markers(f"{node}/markers")
    if markers is None:
        return 0
    if not markers:
        print(f"show_scene.py: the scene of {node} has no shapes, so there is nothing to show", file=sys.stderr)
        return 1
    template = pathlib.Path(rospkg.RosPack().get_path("gpu_planning_scene"), "config", "scene.rviz")
    frame, child, rotation = markers[0].header.frame_id, f"{node.strip('/')}/upright", upright(up)
    frames = announce(frame, child, rotation)  # published as long as this object lives
    fixed = frame if rotation.w == 1.0 else child
    view = view_of(markers + markers_of_plan(f"{node}/plan_markers"), rotation_of(rotation))
    made = configuration(yaml.safe_load(template.read_text()), node, fixed, view)
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder, "scene.rviz")
        file.write_text(yaml.safe_dump(made, sort_keys=False))
        with subprocess.Popen(["rviz", "-d", str(file)], env=environment) as rviz:
            rospy.on_shutdown(rviz.terminate)
            status = rviz.wait()
    if not rospy.is_shutdown() and fault_of(status):
        print(fault_of(status), file=sys.stderr)
    frames.unregister()
    return status


if __name__ == "__main__":
    sys.exit(main())
