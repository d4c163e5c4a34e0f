"""Pictures from tapemark-eval-scenes, which renders what options of tapemark-render describe."""

import json
import subprocess


class SceneError(Exception):
    """A scene that could not be rendered."""


class Frame:
    """A rendered picture: 8-bit gray pixels, row by row, and the truth as tapemark-render tells it."""

    def __init__(self, width_px, height_px, pixels, truth):
        self.width_px = width_px
        self.height_px = height_px
        self.pixels = pixels
        self.truth = truth


class SceneSource:
    """One renderer, started once; use it in a with statement."""

    def __init__(self, program):
        self._program = program
        self._process = None

    def __enter__(self):
        self._process = subprocess.Popen([self._program], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        return self

    def __exit__(self, *_):
        self._process.stdin.close()
        self._process.stdout.close()
        self._process.wait()

    def frames(self, options):
        """Yields the frames of a scene; options are words as on tapemark-render's command line, without output.

        A generator that is not run to its end leaves frames in the pipe: take them all, or use one_frame()."""
        words = [str(word) for word in options] + ["--format", "GREY", "-o", "-"]
        self._process.stdin.write(("\t".join(words) + "\n").encode())
        self._process.stdin.flush()
        while True:
            answer = self._process.stdout.readline().decode()
            if answer == "end\n":
                return
            if not answer.startswith("frame "):
                raise SceneError(f"{answer.strip() or 'the renderer ended'}: {' '.join(words)}")
            yield self._read_frame(answer)

    def one_frame(self, options):
        """The only frame of a scene."""
        (frame,) = self.frames(options)
        return frame

    def _read_frame(self, header):
        width_px, height_px, truth_bytes = (int(word) for word in header.split()[1:])
        pixels = self._read(width_px * height_px)
        return Frame(width_px, height_px, pixels, json.loads(self._read(truth_bytes)))

    def _read(self, count):
        data = self._process.stdout.read(count)
        if len(data) != count:
            raise SceneError("the renderer ended within a frame")
        return data
