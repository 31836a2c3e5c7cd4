#!/usr/bin/python3
"""A window with sliders for the joints of the robot on the parameter server. Publishes their values on the topic
joint_states. It starts with the current state of a planning_scene_node.

It needs only python3-tk. Debian 12 has joint_state_publisher_gui too, but its version 1.15.1 does not work with Python
3.11. It also has no sliders for planar and floating joints."""
import argparse
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from demo_client import variables_of  # noqa: E402

ROTATION = ("rot_x", "rot_y", "rot_z", "rot_w")
ANGLES = ("roll", "pitch", "yaw")
RATE = 10  # messages per second, also without a change: a node that starts later needs the values


class Slider:
    """A named value between two limits. It starts at `value`, or at the limit that is nearest to it; without a value at
    0, if the limits include 0."""

    def __init__(self, name, lower, upper, value=None):
        self.name, self.lower, self.upper = name, lower, upper
        self.value = min(max(value or 0.0, lower), upper)
        self.moved_from = None if value in (None, self.value) else value

    def warning(self):
        """A line that says that the slider starts at another value than the scene. Empty if it does not."""
        if self.moved_from is None:
            return ""
        return (
            f"{self.name} of the scene is {self.moved_from:.6g}, outside the range of its slider,"
            f" {self.lower:.6g} to {self.upper:.6g}; the slider starts at {self.value:.6g}"
        )


def sliders_of(variables, start):
    """The sliders for the variables of the robot. The rotation of a floating joint has three sliders instead of the
    four components of a quaternion. `start`: name -> value."""
    sliders = []
    for variable in variables:
        joint, _, part = variable.name.rpartition("/")
        if part not in ROTATION:
            sliders.append(Slider(*variable, start.get(variable.name)))
        elif part == "rot_w":
            quaternion = [start.get(f"{joint}/{name}", 1.0 if name == "rot_w" else 0.0) for name in ROTATION]
            for name, angle in zip(ANGLES, angles_of(*quaternion)):
                sliders.append(Slider(f"{joint}/{name}", -math.pi, math.pi, angle))
    return sliders


def angles_of(x, y, z, w):
    """Roll, pitch and yaw of a quaternion: rotations about the fixed axes x, y and z, in this order."""
    return (
        math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)),
        math.asin(max(-1.0, min(1.0, 2 * (w * y - z * x)))),
        math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)),
    )


def quaternion_of(roll, pitch, yaw):
    """The inverse of angles_of."""
    (sr, cr), (sp, cp), (sy, cy) = ((math.sin(angle / 2), math.cos(angle / 2)) for angle in (roll, pitch, yaw))
    return (
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
        cr * cp * cy + sr * sp * sy,
    )


def values_of(sliders):
    """The variables of the robot for the positions of the sliders: name -> value."""
    values = {slider.name: slider.value for slider in sliders}
    for joint in [name[: -len("/roll")] for name in values if name.endswith("/roll")]:
        quaternion = quaternion_of(*(values.pop(f"{joint}/{name}") for name in ANGLES))
        values.update({f"{joint}/{name}": value for name, value in zip(ROTATION, quaternion)})
    return values


def show_window(sliders, publish):
    """Shows the sliders until the window is closed. Calls `publish` RATE times per second."""
    import tkinter

    window = tkinter.Tk()
    window.title("joint sliders")
    window.geometry("-0+0")  # the upper right corner, beside RViz
    canvas = tkinter.Canvas(window, width=430, highlightthickness=0)
    bar = tkinter.Scrollbar(window, command=canvas.yview)
    canvas.configure(yscrollcommand=bar.set)
    canvas.pack(side="left", fill="both", expand=True)
    bar.pack(side="right", fill="y")
    column = tkinter.Frame(canvas)
    canvas.create_window(0, 0, window=column, anchor="nw", width=425)
    for slider in sliders:
        tkinter.Label(column, text=slider.name, anchor="w").pack(fill="x", padx=8)
        scale = tkinter.Scale(
            column,
            from_=slider.lower,
            to=slider.upper,
            orient="horizontal",
            resolution=-1,  # tkinter would round the values to multiples of a resolution
            digits=4,
            command=lambda text, slider=slider: setattr(slider, "value", float(text)),
        )
        scale.set(slider.value)
        scale.pack(fill="x", padx=8)
    column.update_idletasks()
    canvas.configure(scrollregion=canvas.bbox("all"), height=min(700, column.winfo_reqheight()))

    def tick():
        if publish():
            window.after(1000 // RATE, tick)
        else:
            window.destroy()

    tick()
    window.mainloop()


def start_values(node):
    """The current state of the scene of planning_scene_node: variable -> value. Waits until the node answers."""
    import rospy
    from gpu_planning_scene.msg import PlanningSceneComponents
    from gpu_planning_scene.srv import GetPlanningScene

    rospy.wait_for_service(f"{node}/get_planning_scene")
    components = PlanningSceneComponents(components=PlanningSceneComponents.ROBOT_STATE)
    answer = rospy.ServiceProxy(f"{node}/get_planning_scene", GetPlanningScene)(components)
    if not answer.success:
        raise rospy.ServiceException(answer.message)
    state = answer.scene.robot_state
    values = dict(zip(state.joint_state.name, state.joint_state.position))
    for joint, pose in zip(state.multi_dof_joint_state.joint_names, state.multi_dof_joint_state.transforms):
        parts = {f"trans_{axis}": getattr(pose.translation, axis) for axis in "xyz"}
        parts.update({f"rot_{axis}": getattr(pose.rotation, axis) for axis in "xyzw"})
        yaw = angles_of(*(parts[name] for name in ROTATION))[2]
        parts.update({"x": pose.translation.x, "y": pose.translation.y, "theta": yaw})
        values.update({f"{joint}/{part}": value for part, value in parts.items()})
    return values


def main():
    import rospy

    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--node", default="planning_scene", help="name of the planning_scene_node (%(default)s)")
    arguments = parser.parse_args(rospy.myargv()[1:])
    rospy.init_node("joint_sliders")
    start = start_values(rospy.resolve_name(arguments.node))
    variables = variables_of(
        rospy.get_param("robot_description"), rospy.get_param("robot_description_planning/joint_limits", None)
    )
    if not variables:
        print("joint_sliders.py: the robot has no joint that moves", file=sys.stderr)
        return 1
    try:
        import tkinter
    except ImportError:
        print(
            "joint_sliders.py: Python's tkinter is missing; install the package python3-tk,"
            " or give joint_state_publisher_gui:=true to live_demo.launch",
            file=sys.stderr,
        )
        return 1
    from sensor_msgs.msg import JointState

    publisher = rospy.Publisher("joint_states", JointState, queue_size=1)
    sliders = sliders_of(variables, start)
    for warning in filter(None, (slider.warning() for slider in sliders)):
        print(f"joint_sliders.py: {warning}", file=sys.stderr)

    def publish():
        message = JointState()
        message.header.stamp = rospy.Time.now()
        values = values_of(sliders)
        message.name, message.position = list(values), list(values.values())
        if not rospy.is_shutdown():
            publisher.publish(message)
        return not rospy.is_shutdown()

    try:
        show_window(sliders, publish)
    except tkinter.TclError as error:
        print(f"joint_sliders.py: cannot show a window: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
