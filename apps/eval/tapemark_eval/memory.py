"""What a system takes in memory for its first frames, in a process of its own: run as a program by measure()."""

import json
import subprocess
import sys

import numpy

FRAMES = 5


def _own_kib(field):
    """VmRSS (resident now) or VmHWM (at most so far) of this process."""
    with open("/proc/self/status", encoding="ascii") as file:
        for line in file:
            if line.startswith(f"{field}:"):
                return int(line.split()[1])
    raise OSError(f"/proc/self/status: no {field}")


def measure(bench, library_path):
    """Per system by how many KiB the process grows at its peak, from before the system is made to after some frames.
    What the operating system loads of its code when it runs is in it."""
    path = bench.folder / "frame.raw"
    grown = {}
    for reader in bench.readers:
        frame = bench.source.one_frame(bench.words_at(2.0, reader.marker))
        path.write_bytes(frame.pixels)
        command = [sys.executable, "-m", __name__, library_path, reader.name, str(path), str(frame.width_px)]
        grown[reader.name] = json.loads(subprocess.run(command, check=True, capture_output=True).stdout)
    return grown


def _main(library_path, name, path, width_px):
    from . import readers  # pylint: disable=import-outside-toplevel
    gray = numpy.fromfile(path, numpy.uint8).reshape(-1, int(width_px))
    before_kib = _own_kib("VmRSS")
    reader = readers.reader_named(name, library_path)
    for _ in range(FRAMES):
        reader.read(gray)
    print(json.dumps(_own_kib("VmHWM") - before_kib))


if __name__ == "__main__":
    _main(*sys.argv[1:])
