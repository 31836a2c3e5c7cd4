"""Only commands of the device write buffers. An upload at once may overtake clears and copies (docs/gpu.md)."""
import re
import unittest

from folders import ROOT

# Functions with which the host writes a buffer without a command, or lets OpenGL choose where a buffer lies.
UPLOADS = re.compile(r"\bGL_DYNAMIC_STORAGE_BIT\b|\bgl(Named)?BufferSubData\b|\bgl(Named)?BufferData\b"
                     r"|\bglInvalidateBuffer\w*\b|\bglBufferStorage\b")
MAPS = re.compile(r"\bgl(Map|Unmap|FlushMapped)\w*\b")
MAY_MAP = {"src/gpu/readback.cpp", "src/gpu/staging_ring.cpp"}


def wrong_lines(name, text):
    """The lines of a source file, without comments, that write or map a buffer in a way that is not allowed."""
    wrong = []
    for number, line in enumerate(text.splitlines(), 1):
        code = line.split("//")[0]
        found = UPLOADS.search(code) or (None if name in MAY_MAP else MAPS.search(code))
        if found:
            wrong.append(f"{name}:{number}: {found.group()}")
    return wrong


class DeviceBuffers(unittest.TestCase):
    def test_are_written_by_commands_of_the_device_only(self):
        files = [path for folder in ("src", "bench", "python", "include") for path in sorted((ROOT / folder).rglob("*.*"))
                 if path.suffix in (".cpp", ".h")]
        self.assertGreater(len(files), 200)
        self.assertTrue({str(path.relative_to(ROOT)) for path in files} >= MAY_MAP)
        self.assertEqual([], [line for path in files for line in
                              wrong_lines(str(path.relative_to(ROOT)), path.read_text(encoding="utf-8"))])

    def test_other_ways_to_write_them_are_found(self):
        text = ("glNamedBufferStorage(id, size, nullptr, GL_DYNAMIC_STORAGE_BIT);\n"
                "glNamedBufferSubData(id, 0, size, data);  // glBufferSubData\n"
                "glGetNamedBufferSubData(id, 0, size, data);\n"
                "glClearNamedBufferSubData(id, format, 0, size, kind, type, &zero);\n"
                "glCopyNamedBufferSubData(from, to, 0, 0, size);\n"
                "glMapNamedBufferRange(id, 0, size, access);  // GL_DYNAMIC_STORAGE_BIT\n")
        self.assertEqual(["a.cpp:1: GL_DYNAMIC_STORAGE_BIT", "a.cpp:2: glNamedBufferSubData",
                          "a.cpp:6: glMapNamedBufferRange"], wrong_lines("a.cpp", text))
        self.assertEqual(["src/gpu/readback.cpp:1: GL_DYNAMIC_STORAGE_BIT",
                          "src/gpu/readback.cpp:2: glNamedBufferSubData"], wrong_lines("src/gpu/readback.cpp", text))


if __name__ == "__main__":
    unittest.main()
