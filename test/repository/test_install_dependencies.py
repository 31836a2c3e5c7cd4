"""install_dependencies on simulated machines made of stubs: the commands that it calls, and its error messages."""
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

from folders import SCRIPTS

TOOLS = ["bash", "cat", "dirname", "env", "grep", "head", "mktemp", "rm", "sed"]


class InstallDependencies(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)
        self.calls = self.folder / "calls"
        self.calls.touch()
        self.root = self.folder / "root"  # of the simulated machine
        self.os_release("ID=debian")
        self.bin = self.folder / "bin"
        self.bin.mkdir()
        for tool in TOOLS:
            (self.bin / tool).symlink_to(shutil.which(tool))
        lines = (SCRIPTS / "dependencies.txt").read_text().splitlines()
        self.packages = [line.split()[0] for line in lines if line and not line.startswith("#")]
        self.stub("id", "echo 0")
        self.stub("getent", "echo 127.0.0.1 localhost")
        self.stub("apt-get", f'echo "apt-get $*" >> {self.calls}')

    def stub(self, name, body):
        path = self.bin / name
        path.write_text(f"#!/bin/bash\n{body}\n")
        path.chmod(0o755)

    def os_release(self, text):
        (self.root / "etc").mkdir(parents=True, exist_ok=True)
        (self.root / "etc" / "os-release").write_text(text + "\n")

    def have(self, installed, known=()):
        """Makes a dpkg-query that reports `installed` as installed and `known` as removed. It fails as
        dpkg-query does for unknown packages."""
        lines = [f"echo {package} installed" for package in installed]
        lines += [f"echo {package} config-files" for package in known]
        self.stub("dpkg-query", "\n".join(lines + ["echo no packages found >&2", "exit 1"]))

    def run_script(self):
        return subprocess.run(
            [str(self.bin / "bash"), str(SCRIPTS / "install_dependencies")],
            env={"PATH": str(self.bin), "TMPDIR": str(self.folder), "GPU_PLANNING_SCENE_TEST_ROOT": str(self.root)},
            capture_output=True,
            text=True,
        )

    def assert_one_line(self, result, *words):
        self.assertEqual(result.returncode, 1)
        self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
        for word in words:
            self.assertIn(word, result.stderr)

    def test_leaves_apt_alone_where_nothing_is_missing(self):
        self.have(self.packages)
        result = self.run_script()
        self.assertEqual((result.returncode, result.stdout, result.stderr), (0, "", ""))
        self.assertEqual(self.calls.read_text(), "")

    def test_installs_just_what_is_missing(self):
        self.have(self.packages[2:], known=self.packages[1:2])
        result = self.run_script()
        self.assertEqual(result.returncode, 0, result.stderr)
        install = self.calls.read_text().splitlines()[-1]
        self.assertTrue(install.endswith("--no-install-recommends " + " ".join(self.packages[:2])), install)

    def test_says_before_the_wait_where_the_output_of_apt_is(self):
        self.have(self.packages[1:])
        self.stub("apt-get", "echo text of apt")
        line = self.run_script().stdout.splitlines()[0]
        self.assertRegex(line, rf"^== installing 1 packages, some minutes; meanwhile {self.folder}/\S+ has the output")

    def test_uses_sudo_where_the_user_is_not_root(self):
        self.have(self.packages[1:])
        self.stub("id", "echo 1000")
        self.stub("sudo", f'echo "sudo $1" >> {self.calls}; exec "$@"')
        self.assertEqual(self.run_script().returncode, 0)
        calls = self.calls.read_text()
        self.assertEqual(calls.count("sudo"), calls.count("apt-get"))
        self.assertIn("install", calls)

    def test_says_so_where_there_is_neither_root_nor_sudo(self):
        self.have(self.packages[1:])
        self.stub("id", "echo 1000")
        self.assert_one_line(self.run_script(), "sudo", self.packages[0])
        self.assertEqual(self.calls.read_text(), "")

    def test_says_what_apt_said_where_it_fails(self):
        self.have(self.packages[1:])
        self.stub("apt-get", 'echo "E: no network here"; exit 100')
        self.assert_one_line(self.run_script(), "no network here", self.packages[0])

    def test_a_failed_update_does_not_keep_it_from_installing(self):
        self.have(self.packages[1:])
        self.stub("apt-get", f'echo "$*" >> {self.calls}; [[ "$*" != *update* ]]')
        self.assertEqual(self.run_script().returncode, 0)
        self.assertIn("install", self.calls.read_text())

    def test_names_localhost_where_nothing_does(self):
        self.have(self.packages)
        self.stub("id", "echo 1000")
        self.stub("getent", '[[ "$*" != "hosts localhost" ]]')
        self.stub("sudo", f'echo "$*: $(cat)" >> {self.calls}')
        self.assertEqual(self.run_script().returncode, 0)
        self.assertEqual(self.calls.read_text(), "tee -a /etc/hosts: 127.0.0.1 localhost\n")

    def test_says_so_where_it_is_not_debian(self):
        self.assert_one_line(self.run_script(), "not Debian", "dependencies.txt")

    def test_refuses_on_ubuntu_and_names_the_command_of_rosdep(self):
        self.have(self.packages[1:])
        for text in ("ID=ubuntu\nID_LIKE=debian", 'ID=linuxmint\nID_LIKE="ubuntu debian"'):
            self.os_release(text)
            self.assert_one_line(self.run_script(), "is Ubuntu", "rosdep install --from-paths src --ignore-src")
        self.assertEqual(self.calls.read_text(), "")

    def test_refuses_beside_another_ros_1(self):
        self.have(self.packages[1:])
        package = self.root / "opt" / "ros" / "one" / "share" / "roscpp" / "package.xml"
        package.parent.mkdir(parents=True)
        package.touch()
        self.assert_one_line(self.run_script(), "/opt/ros/one", "rosdep install --from-paths src --ignore-src")
        self.assertEqual(self.calls.read_text(), "")

    def test_installs_beside_ros_2(self):
        self.have(self.packages[1:])
        (self.root / "opt" / "ros" / "humble" / "share" / "rclcpp").mkdir(parents=True)
        self.assertEqual(self.run_script().returncode, 0)
        self.assertIn("install", self.calls.read_text())

    def test_leaves_no_file_behind(self):
        self.have(self.packages[1:])
        before = sorted(os.listdir(self.folder))
        self.run_script()
        self.assertEqual(sorted(os.listdir(self.folder)), before)


if __name__ == "__main__":
    unittest.main()
