"""tapemark-eval: the measurements, their plots and their page. See README.md."""

import argparse
import json
import sys
import tempfile
from pathlib import Path

from . import experiments
from .camera import CAMERA
from .measure import Bench
from .readers import all_readers
from .scene_source import SceneError, SceneSource
from .tapemark_library import Tapemark


def _arguments():
    parser = argparse.ArgumentParser(prog="tapemark-eval", description=__doc__)
    parser.add_argument("--build", type=Path, required=True, help="folder of a release build")
    parser.add_argument("--output", type=Path, required=True, help="folder for evaluation.json, plots and the page")
    parser.add_argument("--images", type=int, default=20, help="images a step (20)")
    parser.add_argument("--steps", type=int, help="about so many steps an experiment (all)")
    parser.add_argument("--only", action="append", choices=[each.name for each in experiments.EXPERIMENTS],
                        help="this experiment; again for more (all)")
    return parser.parse_args()


def main():
    chosen = _arguments()
    library = chosen.build / "lib" / "libtapemark.so"
    program = chosen.build / "bin" / "tapemark-eval-scenes"
    with tempfile.TemporaryDirectory() as folder, SceneSource(program) as source:
        readers = all_readers(str(library))
        bench = Bench(source, readers, Tapemark(str(library)), folder)
        results = {each.name: bench.run(each, chosen.images, chosen.steps) for each in experiments.EXPERIMENTS
                   if chosen.only is None or each.name in chosen.only}
    report = {"camera": " ".join(CAMERA),
              "systems": [{"name": each.name, "label": each.label, "marker": each.marker, "version": each.version()}
                          for each in readers],
              "experiments": results}
    chosen.output.mkdir(parents=True, exist_ok=True)
    (chosen.output / "evaluation.json").write_text(json.dumps(report, separators=(",", ":")) + "\n")


if __name__ == "__main__":
    try:
        main()
    except (SceneError, OSError) as error:
        sys.exit(f"tapemark-eval: {error}")
