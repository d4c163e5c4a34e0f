"""tapemark-eval: the measurements, their plots and their page. See apps/eval/README.md."""

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path

from . import experiments, gate, memory, no_tape, page, plots, timing, walk
from .camera import CAMERA, HEIGHT_PX, WIDTH_PX
from .measure import Bench
from .readers import all_readers
from .scene_source import SceneError, SceneSource
from .tapemark_library import Tapemark

TIMED_IMAGES = 4
PARTS = ("timing", "memory", "gate", "walk", "no-tape", *(each.name for each in experiments.EXPERIMENTS))


def _count(text):
    """A whole number above zero, for argparse."""
    if not text.isascii() or not text.isdigit() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"'{text}' is no whole number above zero")
    return int(text)


def _arguments():
    parser = argparse.ArgumentParser(prog="tapemark-eval", description=__doc__)
    parser.add_argument("--build", type=Path, required=True, help="folder of a release build")
    parser.add_argument("--output", type=Path, required=True, help="folder for evaluation.json, plots and the page")
    parser.add_argument("--paper-data", type=Path, help="folder with the inventors' videos, for the walk")
    parser.add_argument("--images", type=_count, default=20, help="images a step (20)")
    parser.add_argument("--steps", type=_count, help="about so many steps an experiment (all)")
    parser.add_argument("--tape-free", type=_count, default=4000, help="frames without tape of each kind (4000)")
    parser.add_argument("--only", action="append", choices=PARTS, metavar="PART",
                        help=f"this part, the others stay as they are in evaluation.json; again for more: "
                             f"{' '.join(PARTS)}")
    parser.add_argument("--page", action="store_true", help="only plots and page, from evaluation.json as it is")
    return parser.parse_args()


class Evaluation:
    """All parts of the report, each measured when it is asked for."""

    def __init__(self, chosen, source, folder):
        self.chosen = chosen
        self.decoder_path = str(chosen.build / "lib" / "libtapemark.so")
        self.decoder = Tapemark(self.decoder_path)
        self.source = source
        self.folder = Path(folder)
        self.bench = Bench(source, all_readers(self.decoder_path), self.decoder, folder)

    def systems(self):
        systems = [{"name": each.name, "label": each.label, "marker": each.marker, "version": each.version()}
                   for each in self.bench.readers]
        self.decoder.prepare(b"", WIDTH_PX, HEIGHT_PX)
        systems[0]["workspace_bytes"] = self.decoder.workspace_bytes()
        return systems

    def part(self, name):
        chosen, readers = self.chosen, self.bench.readers
        if name == "timing":
            return timing.measure(self.bench, TIMED_IMAGES)
        if name == "memory":
            return memory.measure(self.bench, self.decoder_path)
        if name == "gate":
            return gate.measure(self.source, self.decoder, self.folder)
        if name == "walk":
            return walk.measure(self.source, readers, chosen.build / "bin" / "tapemark-make", self.folder,
                                chosen.paper_data)
        clutter = chosen.build / "apps" / "eval" / "clutter" / "tapemark-clutter"
        return no_tape.measure(clutter, readers, self.folder, chosen.tape_free, max(1, chosen.tape_free // 20))

    def add_to(self, report):
        """Measures what is asked for; yields after each part, so that what is there can be kept."""
        report |= {"camera": " ".join(CAMERA), "systems": self.systems()}
        report.setdefault("experiments", {})
        for name in PARTS:
            if self.chosen.only is not None and name not in self.chosen.only:
                continue
            if name in (each.name for each in experiments.EXPERIMENTS):
                report["experiments"][name] = self.bench.run(experiments.find(name), self.chosen.images,
                                                             self.chosen.steps)
            else:
                print(f"{name} …", file=sys.stderr)
                report[name] = self.part(name)
            yield


def _report_so_far(chosen, path):
    """What is in evaluation.json, where it is kept or wanted."""
    if not chosen.page and (chosen.only is None or not path.exists()):
        return {}
    try:
        report = json.loads(path.read_text())
    except ValueError as error:
        raise OSError(f"{path}: is no JSON ({error})") from error
    if not isinstance(report, dict) or "systems" not in report or "experiments" not in report:
        raise OSError(f"{path}: holds no evaluation; without --only and --page it is made anew")
    return report


def main():
    chosen = _arguments()
    path = chosen.output / "evaluation.json"
    report = _report_so_far(chosen, path)
    chosen.output.mkdir(parents=True, exist_ok=True)
    if not chosen.page:
        with tempfile.TemporaryDirectory() as folder, \
                SceneSource(chosen.build / "apps" / "eval" / "tapemark-eval-scenes") as source:
            for _ in Evaluation(chosen, source, folder).add_to(report):
                path.write_text(json.dumps(report, separators=(",", ":")) + "\n")
    plots.draw_all(report, chosen.output)
    (chosen.output / "README.md").write_text(page.markdown(report))


if __name__ == "__main__":
    try:
        main()
    except (SceneError, OSError, subprocess.SubprocessError) as error:
        sys.exit(f"tapemark-eval: {error}")
