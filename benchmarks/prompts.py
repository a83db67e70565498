"""Prompts of finished scenes, written anew: how many there are, how they are spread, and pictures to read them by.

    python benchmarks/prompts.py HOME... [--sheets FOLDER] [--read 100]

Each HOME is a project's folder (`flymirage grow`) or its store. For each scene: boxes, those without a name, kept
flights, those with two prompts or more, long prompts, CPU s. Then the share of flights with two prompts, also of those
to things with a name and to things without, and of the commonest sentence. With ``--sheets``, so many prompts drawn
evenly over scenes, each with the flight's first and last picture and its target outlined, for a person to say: would I
find it?
"""

import argparse
import json
import re
import textwrap
import time
from collections import Counter
from pathlib import Path

import cv2
import numpy as np

from flymirage_core.annotation.boxes import BoxMap, ObjectBox
from flymirage_core.language.nouns import is_generic
from flymirage_core.language.prompter import OfflinePrompter
from flymirage_core.language.prompts import Prompt
from flymirage_core.language.verdicts import QualityVerdicts
from flymirage_core.language.wording import DIRECT, INTRODUCED
from flymirage_core.navigation.trajectories import Trajectories
from flymirage_core.rendering.camera import Camera
from flymirage_core.rendering.frames import FlightFrames, Frames
from flymirage_core.scene.keys import rng

ASKED_SHARE, ASKED_FRAME = 0.9, 0.1
"""Of kept flights with two prompts or more; of prompts with the commonest sentence."""
CELL = (256, 192)
PER_SHEET = (5, 3)  # rows, columns
Written = tuple[Path, str, Prompt]  # store, scene, prompt


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("homes", type=Path, nargs="+")
    parser.add_argument("--sheets", type=Path)
    parser.add_argument("--read", type=int, default=100)
    options = parser.parse_args()
    written: list[Written] = []
    counts: list[tuple[bool, int]] = []
    for store in (store_of(home) for home in options.homes):
        for path in sorted((store / "products" / "prompts").iterdir()):
            prompts, of_kept = scene(store, path.name)
            written += [(store, path.name, p) for p in prompts]
            counts += of_kept
    frames = Counter(frame_of(p.text) for *_, p in written)
    commonest, count = frames.most_common(1)[0]
    kinds = Counter(p.kind for *_, p in written)
    print(f"\n{len(written)} prompts, {len(written) / len(counts):.2f} a kept flight; {dict(kinds)}")
    share = several(counts)
    verdict(share >= ASKED_SHARE, f"two prompts or more for {share:.1%} of {len(counts)} kept flights")
    for what, nameless in (("with", False), ("without", True)):
        chosen = [c for c in counts if c[0] is nameless]
        print(f"{'':8}{several(chosen):.1%} of {len(chosen)} to things {what} a name")
    verdict(count / len(written) <= ASKED_FRAME, f"commonest sentence {commonest!r}: {count / len(written):.1%}")
    if options.sheets:
        sheets(written, options.read, options.sheets)


def store_of(home: Path) -> Path:
    return home / ".flymirage" / "store" if (home / ".flymirage").exists() else home


def several(counts: list[tuple[bool, int]]) -> float:
    """Share of flights with two prompts or more."""
    return sum(n > 1 for _, n in counts) / max(len(counts), 1)


def scene(store: Path, name: str) -> tuple[tuple[Prompt, ...], list[tuple[bool, int]]]:
    """The scene's prompts, and of each kept flight whether its target has no name, and its count; prints a line."""
    boxes, verdicts = (
        BoxMap.load(folder(store, "boxes", name)),
        QualityVerdicts.load(folder(store, "quality_verdict", name)),
    )
    flights, frames = Trajectories.load(folder(store, "trajectories", name)), Frames.load(folder(store, "frames", name))
    begun = time.process_time()
    prompts = OfflinePrompter().write(name, frames, boxes, flights, verdicts)
    spent = time.process_time() - begun
    counts = Counter(p.flight_id for p in prompts)
    kept = set(verdicts.kept)
    goals = {f.flight_id: boxes.by_id(f.object_id) for f in flights if f.flight_id in kept}
    of_kept = [(is_generic(goal.label), counts[i]) for i, goal in goals.items()]
    nameless = sum(is_generic(b.label) for b in boxes.boxes)
    print(
        f"{name:16s} {len(boxes):3d} boxes, {nameless} without a name; kept {len(of_kept)} of {len(verdicts)}; ", end=""
    )
    print(f"2+ prompts {sum(n > 1 for _, n in of_kept)}, none {sum(n == 0 for _, n in of_kept)}; ", end="")
    print(f"long {len(prompts.long_prompts)}; {spent:.1f} s")
    return prompts.prompts, of_kept


def folder(store: Path, asset: str, name: str) -> Path:
    at = store / "products" / asset / name
    return at / str(json.loads((at / "product.json").read_text())["digest"])


def frame_of(text: str) -> str:
    """The sentence that the text was made with."""
    gaps = {"{the}": "the .+", "{a}": "(an? )?.+", "{it}": "(it|them)", "{is}": "(is|are)"}
    for frame in sorted(DIRECT + INTRODUCED, key=len, reverse=True):
        pattern = re.escape(frame)
        for gap, words in gaps.items():
            pattern = pattern.replace(re.escape(gap), words)
        if re.fullmatch(pattern, text):
            return frame
    return text


def verdict(met: bool, text: str) -> None:
    print(f"{'met' if met else 'NOT MET':8}{text}")


def sheets(written: list[Written], count: int, out: Path) -> None:
    """Numbered prompts with the first and last picture of their flights."""
    out.mkdir(parents=True, exist_ok=True)
    generator, scenes = rng("benchmark", "prompts", 0), sorted({entry[:2] for entry in written})
    chosen: list[Written] = []
    for scene_of in scenes:
        own = [entry for entry in written if entry[:2] == scene_of]
        picked = generator.permutation(len(own))[: -(-count // len(scenes))]
        chosen += [own[i] for i in sorted(picked.tolist())]
    cells = [cell(number, *entry) for number, entry in enumerate(chosen[:count])]
    rows, columns = PER_SHEET
    for i in range(0, len(cells), rows * columns):
        page = cells[i : i + rows * columns]
        page += [np.full_like(cells[0], 255)] * (-len(page) % columns)
        lines = [np.hstack(page[j : j + columns]) for j in range(0, len(page), columns)]
        cv2.imwrite(str(out / f"prompts{i // (rows * columns)}.png"), np.vstack(lines)[:, :, ::-1])


def cell(number: int, store: Path, name: str, prompt: Prompt) -> np.ndarray:
    flights = Trajectories.load(folder(store, "trajectories", name))
    flight = next(f for f in flights if f.flight_id == prompt.flight_id)
    target = BoxMap.load(folder(store, "boxes", name)).by_id(flight.object_id)
    frames = Frames.load(folder(store, "frames", name)).flight(flight.flight_id)
    pictures = np.hstack([outlined(frames, i, target) for i in (0, len(frames) - 1)])
    text = f"{number} {name[-5:]} [{prompt.kind[:3]}] {prompt.text} ({target.label})"
    bar = np.full((46, pictures.shape[1], 3), 255, np.uint8)
    for i, line in enumerate(textwrap.wrap(text, 72)[:2]):
        cv2.putText(bar, line, (4, 16 + 18 * i), cv2.FONT_HERSHEY_SIMPLEX, 0.42, (0, 0, 0), 1, cv2.LINE_AA)
    return np.vstack([bar, pictures])


def outlined(frames: FlightFrames, index: int, target: ObjectBox) -> np.ndarray:
    picture = np.ascontiguousarray(frames.rgb_at([index])[0])
    camera: Camera = frames.cameras()[index]
    pixels, depth = camera.project(target.corners)
    if (depth > 0.05).all():
        for a in range(8):
            for b in (a ^ bit for bit in (1, 2, 4) if a & bit == 0):
                one, other = (tuple(int(v) for v in pixels[i]) for i in (a, b))
                cv2.line(picture, one, other, (255, 0, 0), 1, cv2.LINE_AA)
    return cv2.resize(picture, CELL, interpolation=cv2.INTER_AREA)


if __name__ == "__main__":
    main()
