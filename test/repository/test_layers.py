"""Includes point one way through the folders of src/, as docs/architecture.md shows, and only some folders use ROS."""
import re
import unittest

from folders import ROOT

# Each folder may include itself, the folders listed for it, and the folders that these may include.
LAYERS = {
    "base/text": [],
    "base": ["base/text"],
    "model": ["base"],
    "model/meshes": ["model"],
    "model/files": ["model/meshes"],
    "model/description": ["model/files"],
    "gpu": ["model/files"],
    "scene": ["model"],
    "scene/changes": ["scene"],
    "scene/files": ["scene/changes", "model/files"],
    "collision/geometry": ["model"],
    "collision/problem": ["collision/geometry", "scene"],
    "collision/trees": ["collision/problem"],
    "collision/exact": ["collision/trees"],
    "collision/bounds": ["collision/exact"],
    "collision/proofs": ["collision/exact"],
    "collision/cpu/lanes": ["collision/proofs"],
    "collision/cpu": ["collision/bounds", "collision/cpu/lanes"],
    "collision/gpu": ["collision/bounds", "collision/cpu/lanes", "gpu"],
    "collision/batch": ["collision/cpu", "collision/gpu"],
    "collision/contacts": ["collision/bounds"],
    "collision/motion": ["collision/bounds"],
    "collision/perception": ["collision/bounds"],
    "collision/report": ["collision/proofs"],
    "collision/checkers": ["collision/batch", "collision/contacts", "collision/motion"],
    "planning/space": ["collision/checkers"],
    "planning/validity": ["planning/space"],
    "planning/search": ["planning/validity"],
    "planning/shortening": ["planning/search"],
    "planning/goals": ["planning/validity"],
    "planning/lines": ["planning/validity"],
    "planning/timing": ["planning/validity"],
    "planning/watch": ["collision/checkers"],
    "planning": ["planning/shortening", "planning/goals", "planning/lines", "planning/timing", "planning/watch"],
    "service": ["collision/checkers", "scene/changes"],
    "render": ["collision/checkers"],
    "command_line": ["collision/checkers", "collision/report"],
    "tools": ["command_line", "render", "model/description"],
    "plugins": ["planning"],
    "planners": ["planning"],
    "node/messages": ["service"],
    "node/endpoints": ["service"],
    "node/parameters": ["service"],
    "node/scene": ["node/messages", "node/endpoints", "collision/report"],
    "node/follow": ["node/scene", "node/parameters"],
    "node/checks": ["node/messages", "node/endpoints", "collision/report"],
    "node/kinematics": ["node/checks", "node/parameters"],
    "node/watch": ["node/checks", "planning/watch"],
    "node/moveit": ["node/follow", "node/kinematics"],
    "node/markers": ["node/messages", "node/endpoints", "render"],
    "node/planning": ["node/checks", "node/markers", "node/parameters", "planners"],
    "node": ["node/scene", "node/checks", "node/follow", "node/kinematics", "node/moveit", "node/planning", "node/watch", "command_line"],
    "client": [],
    "moveit/shapes": ["collision/contacts"],
    "moveit/pairs": ["moveit/shapes"],
    "moveit/queries": ["moveit/pairs"],
    "moveit": ["moveit/queries"],
    "moveit/planner": ["moveit/shapes", "planners", "service", "model/description"],
}


def folder_of(path):
    """The innermost folder of LAYERS that contains a path below src/."""
    parts = path.split("/")[:-1]
    while parts and "/".join(parts) not in LAYERS:
        parts.pop()
    return "/".join(parts)


def allowed(folder):
    """All folders that a folder may include."""
    found = {folder}
    for below in LAYERS[folder]:
        found |= allowed(below)
    return found


class Layers(unittest.TestCase):
    def test_includes_point_one_way(self):
        wrong = []
        for path in sorted((ROOT / "src").rglob("*")):
            if path.suffix not in (".h", ".cpp"):
                continue
            place = str(path.relative_to(ROOT / "src"))
            for include in re.findall(r'(?m)^#include "([^"]+)"', path.read_text()):
                if include.startswith("gpu_planning_scene/") or include == "shader_constants.h":
                    continue
                if folder_of(include) not in allowed(folder_of(place)):
                    wrong.append(f"{place} includes {include}")
        self.assertEqual([], wrong)

    def test_every_folder_of_src_has_its_place(self):
        folders = {folder_of(str(path.relative_to(ROOT / "src"))) for path in (ROOT / "src").rglob("*.cpp")}
        self.assertLessEqual(folders, set(LAYERS))
        self.assertNotIn("", folders)

    def test_only_the_node_its_client_the_planners_and_the_plugins_for_moveit_know_ros(self):
        wrong = []
        for path in sorted([*(ROOT / "src").rglob("*.h"), *(ROOT / "src").rglob("*.cpp"),
                            *(ROOT / "include").rglob("*.h")]):
            place = str(path.relative_to(ROOT))
            if place.startswith(("src/node/", "src/client/", "src/plugins/", "src/planners/", "src/moveit/",
                                 "include/gpu_planning_scene/client/", "include/gpu_planning_scene/moveit/")):
                continue
            for include in re.findall(r"#include ([<\"](?:ros/|tf2|\w+_msgs/|pluginlib/)|<moveit/)", path.read_text()):
                wrong.append(f"{place} includes {include}")
        self.assertEqual([], wrong)


if __name__ == "__main__":
    unittest.main()
