"""`BoxerAnnotator`: the port `Annotator` filled by the user's own checkout of Boxer, run as a separate program.

Boxer (facebookresearch/boxer) and its weights are CC-BY-NC-4.0: nothing of it is part of this project. It is given
files in the layout that its ScanNet loader reads, and answers with a table of detections, view by view; those farther
than d_th1 from their camera are dropped and the rest fused by us (paper, section III-B).
"""

import contextlib
import csv
import math
import os
import re
import signal
import subprocess
import tempfile
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Final

import cv2
import numpy as np

from flymirage_core.annotation.boxes import BoxMap
from flymirage_core.annotation.fusion import Detection, fuse_detections, prune_by_distance
from flymirage_core.annotation.seen_colours import with_seen_colours
from flymirage_core.annotation.settings import AnnotationSettings
from flymirage_core.errors import InputError, ServiceError
from flymirage_core.rendering.camera import Camera
from flymirage_core.rendering.views import View, depth_to_millimetres

SCENE: Final = "scene"
TABLE: Final = "boxer_3dbbs.csv"
COLUMNS: Final = (
    "time_ns", "tx_world_object", "ty_world_object", "tz_world_object", "qw_world_object", "qx_world_object",
    "qy_world_object", "qz_world_object", "scale_x", "scale_y", "scale_z", "name", "prob",
)  # fmt: skip
"""What is read of the table: view, place, turn, full sizes, noun, score."""
LAST_LINES: Final = 6
"""Lines of the program's own last words that an error repeats."""
GRACE: Final = 10.0
"""Seconds that a program which overran its time has to end before it is killed."""


class BoxerAnnotator:
    """Implements `Annotator`. The licence of its boxes is CC-BY-NC-4.0; records and the data card say so."""

    name = "boxer"
    label_source = "boxer"

    def __init__(self, settings: AnnotationSettings) -> None:
        """Raises `InputError` if the settings do not name a checkout of Boxer."""
        self.settings = settings
        self.home = Path(settings.boxer.home).expanduser()
        if not settings.boxer.home or not (self.home / "run_boxer.py").is_file():
            raise InputError(
                f"setting annotation.boxer.home is {settings.boxer.home!r}, where no run_boxer.py is; clone "
                "facebookresearch/boxer (for non-commercial use) and give its folder"
            )

    @property
    def version(self) -> str:
        """The checkout's commit, as far as it can be told."""
        answer = subprocess.run(
            ["git", "-C", str(self.home), "rev-parse", "--short", "HEAD"], capture_output=True, text=True, check=False
        )
        return answer.stdout.strip() or "unknown"

    def annotate(self, views: Iterable[View], max_distance: float) -> BoxMap:
        """See `Annotator.annotate`.

        Raises:
            ServiceError: the program failed, overran its time, or wrote a table that cannot be read.
            InputError: its interpreter does not exist.
        """
        with tempfile.TemporaryDirectory(prefix="flymirage-boxer-") as folder:
            workspace = Path(folder)
            cameras, seen = write_scannet(views, workspace / "scannet" / SCENE)
            if not cameras:
                return BoxMap(())
            self._run(workspace)
            detections = read_detections(workspace / "out" / SCENE / TABLE, cameras)
        kept = [d for d in detections if d.score >= self.settings.boxer.min_score]
        fused = fuse_detections(
            prune_by_distance(kept, max_distance), self.settings, f"{self.name} {self.version}", self.label_source
        )
        return with_seen_colours(fused, seen)

    def _run(self, workspace: Path) -> None:
        boxer = self.settings.boxer
        command = [
            boxer.python, "run_boxer.py", "--input", str(workspace / "scannet" / SCENE), "--skip_viz",
            "--output_dir", str(workspace / "out"), "--thresh2d", str(boxer.threshold_2d),
            "--thresh3d", str(boxer.threshold_3d),
        ]  # fmt: skip
        if boxer.labels:
            command.append(f"--labels={','.join(boxer.labels)}")
        if boxer.checkpoint:
            command += ["--ckpt", str(Path(boxer.checkpoint).expanduser().resolve())]
        log = workspace / "boxer.log"
        with log.open("wb") as output:
            try:
                process = subprocess.Popen(
                    command, cwd=self.home, stdout=output, stderr=subprocess.STDOUT, start_new_session=True
                )
            except OSError as error:
                raise InputError(
                    f"setting annotation.boxer.python is {boxer.python!r}, which cannot be run ({error.strerror}); "
                    "give the interpreter of Boxer's own environment"
                ) from error
            try:
                status = process.wait(boxer.timeout)
            except BaseException as error:
                _stop(process)
                if not isinstance(error, subprocess.TimeoutExpired):
                    raise
                raise ServiceError(
                    f"Boxer had not finished after {boxer.timeout:g} s and was stopped; it needs a GPU in practice: "
                    "use one, or raise annotation.boxer.timeout, or lower views.orbit_yaws"
                ) from error
        if status != 0:
            raise ServiceError(_why(status, log.read_text(errors="replace"), self.home))


def write_scannet(views: Iterable[View], folder: Path) -> tuple[list[Camera], list[View]]:
    """Write views as ``frames/{intrinsic,color,depth,pose}`` of a ScanNet scene; the cameras in order, and the views.

    Colour and depth of one size, PNG; depth in 16-bit millimetres, 0 = none; poses camera-to-world, OpenCV axes, in
    our own z-up world, which is what Boxer takes gravity from. All views have the first one's intrinsics.
    """
    frames = folder / "frames"
    for name in ("intrinsic", "color", "depth", "pose"):
        (frames / name).mkdir(parents=True)
    cameras: list[Camera] = []
    seen: list[View] = []
    for i, view in enumerate(views):
        cameras.append(view.camera)
        seen.append(view)
        if view.camera.intrinsics != cameras[0].intrinsics:
            raise InputError("Boxer reads one set of intrinsics for all views, but these views differ in theirs")
        cv2.imwrite(str(frames / "color" / f"{i}.png"), view.picture.rgb[:, :, ::-1])
        cv2.imwrite(str(frames / "depth" / f"{i}.png"), depth_to_millimetres(view.picture.depth))
        np.savetxt(frames / "pose" / f"{i}.txt", view.camera.T_world_camera, fmt="%.9f")
    if cameras:
        matrix = np.eye(4)
        matrix[:3, :3] = cameras[0].intrinsics.matrix
        np.savetxt(frames / "intrinsic" / "intrinsic_color.txt", matrix, fmt="%.6f")
    return cameras, seen


def read_detections(table: Path, cameras: Sequence[Camera]) -> list[Detection]:
    """Boxer's detections in the world frame; none if it wrote no table.

    Its loader takes the first camera's place as the origin, which is undone here; ``time_ns`` is the view's number.
    Raises `ServiceError` if the table is not as expected.
    """
    if not table.exists():
        return []
    with table.open(newline="") as file:
        rows = csv.DictReader(file, skipinitialspace=True)
        missing = [c for c in COLUMNS if c not in (rows.fieldnames or ())]
        if missing:
            raise ServiceError(
                f"Boxer's {table.name} has no column {missing[0]!r}, but {', '.join(rows.fieldnames or ['nothing'])}; "
                "this checkout of Boxer is of a version that FlyMirage does not know"
            )
        try:
            return [_detection(row, cameras) for row in rows]
        except (ValueError, TypeError, IndexError) as error:
            raise ServiceError(
                f"Boxer's {table.name}, line {rows.line_num}, cannot be read ({error}); run it again"
            ) from error


def _detection(row: dict[str, str], cameras: Sequence[Camera]) -> Detection:
    numbers = [float(row[c]) for c in COLUMNS if c not in ("time_ns", "name")]
    if not all(math.isfinite(n) for n in numbers):
        raise ValueError("a number is not finite")
    x, y, z, qw, _, _, qz, length, width, height, score = numbers
    view = int(row["time_ns"])
    if not 0 <= view < len(cameras):
        raise ValueError(f"view {view} of {len(cameras)}")
    centre = np.array([x, y, z]) + cameras[0].position
    return Detection(
        label=plain_noun(row["name"]),
        centre=(float(centre[0]), float(centre[1]), float(centre[2])),
        size=(length, width, height),
        yaw=2 * math.atan2(qz, qw),
        score=min(max(score, 0.0), 1.0),
        view=view,
        camera_position=(
            float(cameras[view].position[0]),
            float(cameras[view].position[1]),
            float(cameras[view].position[2]),
        ),
    )


def plain_noun(name: str) -> str:
    """A label of the LVIS kind as people say it.

    >>> plain_noun("trash_can"), plain_noun("Bow_(decorative_ribbons)")
    ('trash can', 'bow')
    """
    return re.sub(r"\s+", " ", re.sub(r"\(.*?\)", "", name).replace("_", " ")).strip().lower() or "object"


def _stop(process: "subprocess.Popen[bytes]") -> None:
    """End a program with all that it started."""
    for sign in (signal.SIGTERM, signal.SIGKILL):  # the second one also for what outlived the program itself
        with contextlib.suppress(ProcessLookupError, subprocess.TimeoutExpired):
            os.killpg(process.pid, sign)
            process.wait(GRACE)


def _why(status: int, log: str, home: Path) -> str:
    """One sentence about a failed run, from its exit status and what it printed."""
    last = " | ".join([line.strip() for line in log.splitlines() if line.strip()][-LAST_LINES:])[-600:]
    if re.search(r"No such file or directory.*\.(pt|ckpt|pth)|FileNotFoundError.*ckpts", log):
        return (
            f"Boxer did not find its weights (exit status {status}); run scripts/download_ckpts.sh in {home}, or give "
            f"annotation.boxer.checkpoint. Its last words: {last}"
        )
    if re.search(r"CUDA|NVIDIA|cuDNN", log) and re.search(r"rror", log):
        return (
            f"Boxer could not use a GPU (exit status {status}); look at the driver with nvidia-smi, and at the torch "
            f"of annotation.boxer.python. Its last words: {last}"
        )
    return f"Boxer failed with exit status {status}; its last words: {last or 'none'}"
