"""Exports and reading, measured: metadata of 10,000 synthetic episodes, growth by one scene, frames read a second.

python benchmarks/exports.py metadata              # 100 scenes of 100 flights: manifest, then LeRobot's metadata
python benchmarks/exports.py reading EXPORT        # random and sequential reading beside plain PyAV
"""

import argparse
import resource
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from itertools import islice
from pathlib import Path

import av
import numpy as np
from torch.utils.data import DataLoader, Subset

import flymirage_core.dataset
from flymirage_core.dataset.card import dataset_card
from flymirage_core.dataset.export_folder import ExportIndex, Shard
from flymirage_core.dataset.lerobot import DepthExport, LeRobotFormat, export_lerobot
from flymirage_core.dataset.lerobot_places import move_shard, moved_place, start_after
from flymirage_core.dataset.lerobot_schema import features
from flymirage_core.dataset.manifest import DatasetManifest, build_manifest
from flymirage_core.dataset.scene_products import SceneProducts
from flymirage_core.language.prompts import Prompt, Prompts

SCENES, FLIGHTS = 100, 100


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=("metadata", "reading"))
    parser.add_argument("export", type=Path, nargs="?")
    arguments = parser.parse_args()
    if arguments.what == "metadata":
        metadata()
    else:
        reading(arguments.export)


def metadata() -> None:
    with tempfile.TemporaryDirectory() as folder:
        scenes = synthetic_scenes(Path(folder))
        timed("manifest of 10,000 episodes, saved and loaded", lambda: manifest(scenes, Path(folder) / "manifest"))
        one = export_lerobot(scenes[:1], Path(folder) / "one", DepthExport.NONE).folder
        whole = Path(folder) / "whole"
        shards: list[Shard] = []
        timed("LeRobot: 100 scenes' tables copied to other numbers", lambda: repeat(one, whole, shards))
        form = LeRobotFormat(DepthExport.NONE)
        timed("LeRobot: info, stats, tasks of 10,000 episodes", lambda: form.finish(whole, shards))
        timed("card of 10,000 episodes", lambda: dataset_card(tuple(s.share for s in shards), ()))


def repeat(one: Path, whole: Path, shards: list[Shard]) -> None:
    """The one exported scene a hundred times, each behind the last, as `keep` moves a scene."""
    first = Shard.load(one, ExportIndex.load(one).scenes[0])
    for i in range(SCENES):
        place = moved_place(first.place, start_after(shards))
        move_shard(one, whole, first, place, features(first.rig, with_depth=False))
        (whole / "scenes" / first.scene).rename(whole / "scenes" / f"copy-{i:04d}")
        shards.append(replace(first, scene=f"copy-{i:04d}", place=place))


def manifest(scenes: list[SceneProducts], folder: Path) -> None:
    build_manifest(scenes).save(folder)
    assert len(DatasetManifest.load(folder).episodes) == SCENES * FLIGHTS


def synthetic_scenes(folder: Path) -> list[SceneProducts]:
    """One filmed scene of 100 short flights, 100 times under other names."""
    sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))
    import filmed_room

    rig = replace(filmed_room.RIG, intrinsics=filmed_room.Intrinsics.from_horizontal_fov(16, 16, 1.4))
    targets = tuple(i % 5 for i in range(FLIGHTS))
    made = filmed_room.scene_products(folder, targets=(0, 1, 4), frames=4, rig=rig)
    boxes = made.boxes
    flights = [
        filmed_room.flight_to(boxes.by_id(t), i, frames=4, set_index=i // 5, start=(0.0, 0.01 * i, 1.2))
        for i, t in enumerate(targets)
    ]
    frames = filmed_room.film(folder / "all", flights, boxes, rig)
    (kept,) = {v for v in made.verdicts if v.flight_id == made.verdicts.kept[0]}
    verdicts = replace(made.verdicts, verdicts=tuple(replace(kept, flight_id=i) for i in range(FLIGHTS)))
    kinds = ("object_centred", "relative", "appearance")
    prompts = Prompts(
        tuple(Prompt(i, k, f"Fly to thing {i} in the {k} way.", "offline 1") for i in range(FLIGHTS) for k in kinds)
    )
    trajectories = replace(made.trajectories, flights=tuple(flights))
    one = replace(made, trajectories=trajectories, frames=frames, verdicts=verdicts, prompts=prompts)
    return [filmed_room.renamed(one, f"scene-{i:04d}") for i in range(SCENES)]


def reading(folder: Path) -> None:
    scene = flymirage_core.dataset.open(folder).episodes[0].scene
    paths = sorted((folder / "videos").rglob("*.mp4"))[:1]
    for name, streams in READ.items():
        dataset = flymirage_core.dataset.open(folder, scenes=[scene], **streams)
        count = min(MOST_FRAMES, len(dataset))
        orders = {"sequential": range(count), "random": np.random.default_rng(0).permutation(len(dataset))[:count]}
        for order, chosen in orders.items():
            indices = [int(i) for i in chosen]
            rate(f"open(), {name}, {order}, no worker", lambda d=dataset, i=indices: sum(1 for n in i if d[n]))
            for workers in (0, 2):
                loader = DataLoader(Subset(dataset, indices), batch_size=16, num_workers=workers)
                seconds(
                    f"DataLoader, {name}, {order}, {workers} workers", lambda x=loader: sum(len(b["task"]) for b in x)
                )
    rate("plain PyAV, sequential, RGB", lambda: sum(1 for _ in islice(decoded(paths), MOST_FRAMES)))
    rate("plain PyAV, random, RGB: file reopened", lambda: sum(1 for _ in sought(paths, indices)))


MOST_FRAMES = 300
READ: dict[str, dict[str, bool]] = {
    "RGB": {},
    "depth": {"rgb": False, "depth": True},
    "RGB and depth": {"depth": True},
    "RGB, depth and masks": {"depth": True, "masks": True},
}


def decoded(paths: list[Path]) -> Iterator[np.ndarray]:
    for path in paths:
        with av.open(str(path)) as container:
            container.streams.video[0].codec_context.thread_count = 1
            for frame in container.decode(video=0):
                yield frame.to_ndarray(format="rgb24")


def sought(paths: list[Path], chosen: list[int]) -> Iterator[np.ndarray]:
    """As a loader without kept files does it."""
    for number in chosen:
        with av.open(str(paths[0])) as container:
            stream = container.streams.video[0]
            wanted = round(number % stream.frames / (stream.average_rate * stream.time_base))
            container.seek(wanted, stream=stream)
            yield next(f for f in container.decode(stream) if f.pts >= wanted).to_ndarray(format="rgb24")


def timed(what: str, work: Callable[[], object]) -> None:
    started = time.process_time()
    work()
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(f"{what}: {time.process_time() - started:.1f} s of CPU, peak {peak:.0f} MB so far", flush=True)


def seconds(what: str, work: Callable[[], int]) -> None:
    started = time.perf_counter()
    count = work()
    print(f"{what}: {count / (time.perf_counter() - started):.0f} frames/s by the clock ({count} frames)", flush=True)


def rate(what: str, work: Callable[[], int]) -> None:
    started = time.process_time()
    count = work()
    print(f"{what}: {count / (time.process_time() - started):.0f} frames/s of CPU ({count} frames)", flush=True)


if __name__ == "__main__":
    main()
