"""The examples in docs/scene_files.md and docs/your_robot.md are scene files that the reader takes without a warning."""
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

DOCS = pathlib.Path(__file__).resolve().parents[2] / "docs"
ARM = DOCS.parent / "config" / "demo" / "arm.urdf"


def scenes(document):
    """The indented blocks that are scene files."""
    blocks = re.findall(r"(?:^    .*\n)+", (DOCS / document).read_text(encoding="utf-8"), flags=re.MULTILINE)
    texts = [re.sub("^    ", "", block, flags=re.MULTILINE) for block in blocks]
    return [text for text in texts if re.match(r"[a-z_]+:( |\n)", text)]


class SceneFiles(unittest.TestCase):
    def setUp(self):
        if not pathlib.Path(URDF).exists():
            self.skipTest("Debian's dart-doc is not here")

    def check(self, text):
        robot = ["--urdf", URDF, "--package", "KR5=" + str(pathlib.Path(URDF).parent)]
        if "named_state:" in text:  # the KR5 has no named states
            robot = ["--urdf", str(ARM), "--srdf", str(ARM.with_suffix(".srdf"))]
        with tempfile.NamedTemporaryFile("w", suffix=".yaml", encoding="utf-8") as file:
            file.write(text)
            file.flush()
            command = [CHECK_STATES, *robot, "--scene", file.name, "--random", "1"]
            return subprocess.run(command + ["--device", "cpu"], capture_output=True, text=True, timeout=60, check=False)

    def test_each_example_is_read_without_a_warning(self):
        for document, least in (("scene_files.md", 12), ("your_robot.md", 1)):
            texts = scenes(document)
            self.assertGreaterEqual(len(texts), least)
            for text in texts:
                answer = self.check(text)
                self.assertEqual(0, answer.returncode, text + answer.stderr)
                warnings = [line for line in answer.stderr.splitlines() if line.startswith("warning")]
                # The page says that the robot has no joint `base`, and that the state leaves out the gripper.
                expected = ("does not have them: base", "get their default: grip")
                self.assertEqual([], [line for line in warnings if not line.endswith(expected)], text)

    def test_each_field_of_a_scene_has_an_example(self):
        text = "".join(scenes("scene_files.md"))
        for field in (
            "named_state collision_objects primitives meshes planes resource vertices triangles scale coef pose primitive_poses "
            "mesh_poses header frame_id subframe_names subframe_poses joint_state multi_dof_joint_state "
            "attached_collision_objects link_name touch_links entry_names entry_values default_entry_names "
            "default_entry_values link_padding link_scale fixed_frame_transforms object_colors octomap origin binary "
            "resolution data"
        ).split():
            self.assertRegex(text, rf"\b{field}:")


if __name__ == "__main__":
    CHECK_STATES, URDF = sys.argv[1:]
    unittest.main(argv=sys.argv[:1])
