"""tapemark-eval: the measurements, their plots and their page. See apps/eval/README.md."""

import argparse
import json
import sys
import tempfile
from pathlib import Path

from . import experiments, gate, memory, page, plots, timing
from .camera import CAMERA, HEIGHT_PX, WIDTH_PX
from .measure import Bench
from .readers import all_readers
from .scene_source import SceneError, SceneSource
from .tapemark_library import Tapemark

TIMED_IMAGES = 4


def _arguments():
    parser = argparse.ArgumentParser(prog="tapemark-eval", description=__doc__)
    parser.add_argument("--build", type=Path, required=True, help="folder of a release build")
    parser.add_argument("--output", type=Path, required=True, help="folder for evaluation.json, plots and the page")
    parser.add_argument("--images", type=int, default=20, help="images a step (20)")
    parser.add_argument("--steps", type=int, help="about so many steps an experiment (all)")
    parser.add_argument("--only", action="append", choices=[each.name for each in experiments.EXPERIMENTS],
                        help="this experiment; again for more (all)")
    parser.add_argument("--page", action="store_true", help="only plots and page, from evaluation.json as it is")
    return parser.parse_args()


def _systems(bench, decoder):
    systems = [{"name": each.name, "label": each.label, "marker": each.marker, "version": each.version()}
               for each in bench.readers]
    decoder.prepare(b"", WIDTH_PX, HEIGHT_PX)
    systems[0]["workspace_bytes"] = decoder.workspace_bytes()
    return systems


def _measure(chosen, folder):
    """The whole report."""
    library = str(chosen.build / "lib" / "libtapemark.so")
    decoder = Tapemark(library)
    with SceneSource(chosen.build / "bin" / "tapemark-eval-scenes") as source:
        bench = Bench(source, all_readers(library), decoder, folder)
        return {
            "images": chosen.images, "camera": " ".join(CAMERA), "systems": _systems(bench, decoder),
            "timing": timing.measure(bench, TIMED_IMAGES), "memory": memory.measure(bench, library),
            "gate": gate.measure(source, decoder, folder),
            "experiments": {each.name: bench.run(each, chosen.images, chosen.steps) for each in experiments.EXPERIMENTS
                            if chosen.only is None or each.name in chosen.only}}


def main():
    chosen = _arguments()
    path = chosen.output / "evaluation.json"
    if chosen.page:
        report = json.loads(path.read_text())
    else:
        with tempfile.TemporaryDirectory() as folder:
            report = _measure(chosen, folder)
        chosen.output.mkdir(parents=True, exist_ok=True)
        path.write_text(json.dumps(report, separators=(",", ":")) + "\n")
    plots.draw_all(report, chosen.output)
    (chosen.output / "README.md").write_text(page.markdown(report, []))


if __name__ == "__main__":
    try:
        main()
    except (SceneError, OSError) as error:
        sys.exit(f"tapemark-eval: {error}")
