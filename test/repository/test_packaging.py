"""The Debian packages agree with the rest of the repository, and catkin_lint finds nothing in it."""
import re
import shutil
import subprocess
import unittest
import xml.etree.ElementTree

from folders import ROOT, SCRIPTS

CONTROL = (ROOT / "debian" / "control").read_text()
VERSION = xml.etree.ElementTree.parse(ROOT / "package.xml").getroot().findtext("version")


def build_dependencies():
    """The names of the packages that debian/control needs to build."""
    field = re.search(r"(?m)^Build-Depends:\n((?: .*\n)*)", CONTROL).group(1)
    return {re.match(r"[a-z0-9.+-]+", line.strip()).group() for line in field.splitlines()}


def packaged_files():
    """The files of the repository that gpu-planning-scene-doc has, at the same places."""
    lines = [line.split()[0] for kind in ("docs", "install", "examples")
             for line in (ROOT / "debian" / f"gpu-planning-scene-doc.{kind}").read_text().splitlines()]
    found = [path for line in lines for path in ROOT.glob(line)]
    return {file for path in found for file in [path, *path.rglob("*")]}


def misplaced_files():
    """The lines of gpu-planning-scene-doc.install that move a file from its place beside the other documents."""
    lines = (ROOT / "debian" / "gpu-planning-scene-doc.install").read_text().splitlines()
    return [line for line in lines
            if line.split()[1] != f"usr/share/doc/gpu-planning-scene/{line.split()[0].rpartition('/')[0]}"]


def links_out_of_the_package(packaged):
    """The links of the packaged documents to files of the repository that are not packaged."""
    documents = [path for path in packaged if path.suffix == ".md"]
    return sorted({f"{document.relative_to(ROOT)}: {link}" for document in documents
                   for link in re.findall(r"\]\(([^)#]+)[^)]*\)", document.read_text())
                   if "://" not in link and (document.parent / link).resolve() not in packaged})


class Packaging(unittest.TestCase):
    def test_packages_have_the_version_of_package_xml(self):
        first = (ROOT / "debian" / "changelog").read_text().splitlines()[0]
        self.assertRegex(first, rf"^gpu-planning-scene \({re.escape(VERSION)}-\d+\) ")

    def test_the_name_of_the_library_has_its_binary_version(self):
        name = "libgpu-planning-scene" + ".".join(VERSION.split(".")[:2])
        self.assertIn(f"Package: {name}\n", CONTROL)
        self.assertTrue((ROOT / "debian" / f"{name}.install").exists())

    def test_a_package_is_built_with_what_install_dependencies_installs(self):
        lines = (SCRIPTS / "dependencies.txt").read_text().splitlines()
        listed = {line.split()[0] for line in lines if line and not line.startswith("#")}
        helpers = {"debhelper-compat", "dh-sequence-python3", "pkgconf"}  # pkgconf: today's name of pkg-config
        self.assertEqual(set(), build_dependencies() - helpers - listed)

    def test_every_exported_library_is_installed(self):
        """debhelper fails for a file that is in no package, but not for a development link that is left out."""
        text = (ROOT / "cmake" / "install.cmake").read_text()
        libraries = re.search(r"set\(libraries ([^)]*)\)", text).group(1).split() + ["gpu_planning_scene_client"]
        installed = (ROOT / "debian" / "libgpu-planning-scene-dev.install").read_text()
        for library in libraries:
            self.assertIn(f"usr/lib/*/lib{library}.so\n", installed)

    def test_links_of_the_packaged_documents_lead_into_the_package(self):
        self.assertEqual([], links_out_of_the_package(packaged_files()))
        self.assertEqual([], misplaced_files())  # debhelper puts the files of .docs there

    def test_a_link_out_of_the_package_is_found(self):
        self.assertIn("README.md: docs/gpu.md", links_out_of_the_package({ROOT / "README.md"}))

    @unittest.skipUnless(shutil.which("catkin_lint"), "catkin_lint is not installed")
    def test_catkin_lint_finds_nothing(self):
        answer = subprocess.run(["catkin_lint", "--offline", "-W1", "--strict", str(ROOT)], capture_output=True,
                                text=True, check=False)
        self.assertIn("checked 1 packages", answer.stderr)
        # package.xml calls octomap by its key of rosdep, liboctomap-dev.
        self.assertEqual([], [line for line in answer.stdout.splitlines() if "build_depend on 'octomap'" not in line])


if __name__ == "__main__":
    unittest.main()
