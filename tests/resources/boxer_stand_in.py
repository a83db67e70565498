"""A program with Boxer's outside: the same command line, reads the same files, writes the same table. No network.

It finds one thing, a box that every view looks at, whose place stands in ``thing.json`` beside it (world frame), and
reports it view by view as the real program does: in a frame whose origin is the first camera. ``fault`` there names
what goes wrong.
"""

import argparse
import csv
import json
import subprocess
import sys
import time
from pathlib import Path

import cv2
import numpy as np

HEADER = [
    "time_ns", "tx_world_object", "ty_world_object", "tz_world_object", "qw_world_object", "qx_world_object",
    "qy_world_object", "qz_world_object", "scale_x", "scale_y", "scale_z", "name", "instance", "sem_id", "prob",
]  # fmt: skip


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--input", required=True)
    parser.add_argument("--output_dir", required=True)
    parser.add_argument("--skip_viz", action="store_true")
    parser.add_argument("--thresh2d", type=float)
    parser.add_argument("--thresh3d", type=float)
    parser.add_argument("--labels", type=lambda text: text.split(","), default=["lvisplus"])
    parser.add_argument("--ckpt", default="ckpts/boxernet.ckpt")
    options = parser.parse_args()
    thing = json.loads(Path(__file__).with_name("thing.json").read_text())
    Path(__file__).with_name("asked.json").write_text(json.dumps(vars(options)))
    fault = thing.get("fault", "")
    if fault == "weights":
        sys.exit("FileNotFoundError: [Errno 2] No such file or directory: 'ckpts/owlv2-base-patch16-ensemble.pt'")
    if fault == "cuda":
        sys.exit("RuntimeError: CUDA error: no kernel image is available for execution on the device")
    if fault == "hang":
        child = subprocess.Popen(["sh", "-c", "trap '' TERM; sleep 60 & wait; sleep 60"])
        Path(__file__).with_name("child.pid").write_text(str(child.pid))
        time.sleep(60)
    assert "/scannet/" in options.input, "this path would select another loader"
    frames = Path(options.input) / "frames"
    intrinsics = np.loadtxt(frames / "intrinsic" / "intrinsic_color.txt")
    assert intrinsics.shape == (4, 4)
    numbers = sorted(int(path.stem) for path in (frames / "color").glob("*.png"))
    poses = {n: np.loadtxt(frames / "pose" / f"{n}.txt") for n in numbers}
    table = Path(options.output_dir) / Path(options.input).name / "boxer_3dbbs.csv"
    table.parent.mkdir(parents=True)
    if fault == "no table":
        return
    with table.open("w", newline="") as file:
        rows = csv.writer(file)
        rows.writerow(HEADER[:-1] if fault == "other columns" else HEADER)
        for n in numbers if fault != "empty" else []:
            if fault == "half way" and n == numbers[len(numbers) // 2]:
                file.flush()
                sys.exit("Segmentation fault")
            colour = cv2.imread(str(frames / "color" / f"{n}.png"))
            depth = cv2.imread(str(frames / "depth" / f"{n}.png"), cv2.IMREAD_UNCHANGED)
            assert colour.shape[:2] == depth.shape and depth.dtype == np.uint16
            place = np.array(thing["centre"]) - poses[numbers[0]][:3, 3]
            yaw = thing["yaw"] / 2
            rows.writerow(
                [n, *place, np.cos(yaw), 0, 0, np.sin(yaw), *thing["size"], thing["name"], 0, 0, thing["prob"]]
            )


main()
