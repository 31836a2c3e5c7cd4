"""A screen in memory (Xvfb), on which tests show windows and look at the pixels."""
import os
import pathlib
import struct
import subprocess
import tempfile

import numpy

WIDTH, HEIGHT = 1280, 800


class VirtualScreen:
    """Runs Xvfb on a free display until close()."""

    def __init__(self):
        self.folder = tempfile.TemporaryDirectory()
        read, write = os.pipe()
        size = f"{WIDTH}x{HEIGHT}x24"
        self.process = subprocess.Popen(
            ["Xvfb", "-displayfd", str(write), "-screen", "0", size, "-fbdir", self.folder.name, "-nolisten", "tcp"],
            pass_fds=[write],
            stderr=subprocess.DEVNULL,
        )
        os.close(write)
        with os.fdopen(read) as pipe:
            self.display = ":" + pipe.readline().strip()

    def environment(self):
        """The environment of a program that shows its window on this screen and draws without a GPU."""
        return dict(os.environ, DISPLAY=self.display, QT_X11_NO_MITSHM="1", LIBGL_ALWAYS_SOFTWARE="1")

    def pixels(self):
        """The screen's red, green and blue as an array of HEIGHT x WIDTH x 3 bytes. Xvfb keeps the screen in a file in
        the format of X11/XWDFile.h: a header of 32-bit numbers, a table of colours, then four bytes a pixel."""
        data = pathlib.Path(self.folder.name, "Xvfb_screen0").read_bytes()
        header = struct.unpack(">25I", data[:100])
        start, colours, line = header[0] + 12 * header[19], header[19], header[12]
        assert colours <= 256 and header[11] == 32, header
        rows = numpy.frombuffer(data, numpy.uint8, HEIGHT * line, start).reshape(HEIGHT, line // 4, 4)
        return rows[:, :WIDTH, 2::-1]

    def save(self, path):
        """Writes the screen to a PNG file, for people who look at it."""
        from matplotlib import image

        image.imsave(path, self.pixels())

    def close(self):
        self.process.terminate()
        self.process.wait()
        self.folder.cleanup()
