"""Checks thousands of robot states for collision in one call: see docs/python.md.

ROS generates the subpackages gpu_planning_scene.msg and gpu_planning_scene.srv into the same package. So the classes
below are loaded when they are first used: a program that needs only the messages does not load the libraries.
"""
import importlib

__all__ = [
    "AllowedCollisionMatrix",
    "AttachedObject",
    "BatchResult",
    "Box",
    "CartesianPath",
    "BodyDistances",
    "Clearances",
    "Cone",
    "Contact",
    "Cylinder",
    "DecidedStates",
    "Device",
    "DeviceLost",
    "Error",
    "Group",
    "HalfSpace",
    "IkResult",
    "IkStatus",
    "Joint",
    "JointType",
    "KinematicConstraints",
    "Link",
    "Mesh",
    "MotionChecker",
    "MotionOutlook",
    "MotionVerdicts",
    "NamedState",
    "PlanningResult",
    "PlanningScene",
    "PlanningStatus",
    "RobotModel",
    "SceneReport",
    "Sphere",
    "StateChecker",
    "StateInspector",
    "TimedPath",
    "Variable",
    "WorldObject",
    "follow_lines",
    "list_devices",
    "load_scene_file",
    "load_scene_text",
    "plan_motion",
    "render",
    "resolve_uri",
    "solve_ik",
    "time_path",
]


def __getattr__(name):
    if name not in __all__:
        raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
    value = getattr(importlib.import_module("._core", __name__), name)
    globals()[name] = value
    return value


def __dir__():
    return sorted({*globals(), *__all__})
