"""Shaders take their bindings and locations from shader_constants.h, and no program uses a binding or a unit twice."""
import re
import unittest

from folders import ROOT

SHADERS = ROOT / "shaders"


def constants():
    return dict(re.findall(r"(?m)^#define (\w+) (\d+)\b", (SHADERS / "shader_constants.h").read_text()))


def whole_text(path, seen):
    """The text of a shader with the files that it includes, each once."""
    if path in seen:
        return ""
    seen.add(path)
    return "\n".join(whole_text(SHADERS / line.split('"')[1], seen) if line.startswith("#include") else line
                     for line in path.read_text().splitlines())


def bindings(text):
    """(kind, number or name, block) of each storage buffer and sampler."""
    found = re.findall(r"layout\((?:std430, )?binding = (\w+)\)[^{;]*?\b(buffer|uniform \w+) (\w+)", text)
    return [("buffer" if kind == "buffer" else "unit", binding, block) for binding, kind, block in found]


def numbers_used_twice(text, values):
    used = [(kind, values.get(binding, binding)) for kind, binding, _ in bindings(text)]
    return sorted({place for place in used if used.count(place) > 1})


class Shaders(unittest.TestCase):
    def test_name_their_bindings_and_uniform_locations(self):
        wrong = [f"{path.relative_to(ROOT)}: {line}" for path in sorted(SHADERS.rglob("*.*"))
                 for line in path.read_text().splitlines()
                 if re.search(r"binding = \d", line) or re.search(r"location = \d.*\buniform\b", line)]
        self.assertEqual([], wrong)

    def test_begin_with_a_comment(self):
        wrong = [str(path.relative_to(ROOT)) for path in sorted(SHADERS.rglob("*.*"))
                 if path.suffix in (".comp", ".glsl", ".vert", ".frag") and not path.read_text().startswith("//")]
        self.assertEqual([], wrong)

    def test_use_each_binding_once_in_a_program(self):
        values = constants()
        programs = sorted(SHADERS.rglob("*.comp"))
        self.assertGreater(len(programs), 20)
        wrong = {}
        for path in programs:
            text = whole_text(path, set())
            self.assertTrue(bindings(text), path)
            twice = numbers_used_twice(text, values)
            if twice:
                wrong[str(path.relative_to(ROOT))] = twice
        self.assertEqual({}, wrong)

    def test_a_binding_that_is_used_twice_is_found(self):
        text = ("layout(std430, binding = BINDING_X) readonly buffer A { uint a[]; };\n"
                "layout(std430, binding = BINDING_Y) coherent buffer B { uint b[]; };\n"
                "layout(binding = UNIT_Z) uniform usamplerBuffer c;\n")
        self.assertEqual([("buffer", "3")], numbers_used_twice(text, {"BINDING_X": "3", "BINDING_Y": "3", "UNIT_Z": "3"}))


if __name__ == "__main__":
    unittest.main()
