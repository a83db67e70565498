"""Prompts of finished scenes, written anew: how many there are, how they are spread, and pictures to read them by.

    python benchmarks/prompts.py STORE [--sheets FOLDER] [--read 100]

For each scene: boxes, those without a name, kept flights, those with two prompts or more, long prompts, CPU s. Then
the share of the commonest sentence. With ``--sheets``, so many prompts drawn evenly over scenes, each with the flight's
first and last picture and its target outlined, for a person to say: would I find it?
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


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("store", type=Path)
    parser.add_argument("--sheets", type=Path)
    parser.add_argument("--read", type=int, default=100)
    options = parser.parse_args()
    written: list[tuple[str, Prompt]] = []
    kept = several = 0
    for path in sorted((options.store / "products" / "prompts").iterdir()):
        prompts, of_kept = scene(options.store, path.name)
        written += [(path.name, p) for p in prompts]
        kept, several = kept + len(of_kept), several + sum(n > 1 for n in of_kept)
    frames = Counter(frame_of(p.text) for _, p in written)
    commonest, count = frames.most_common(1)[0]
    print(f"\n{len(written)} prompts, {len(written) / kept:.2f} a kept flight", Counter(p.kind for _, p in written))
    verdict(several / kept >= ASKED_SHARE, f"two prompts or more for {several / kept:.1%} of {kept} kept flights")
    verdict(count / len(written) <= ASKED_FRAME, f"commonest sentence {commonest!r}: {count / len(written):.1%}")
    if options.sheets:
        sheets(options.store, written, options.read, options.sheets)


def scene(store: Path, name: str) -> tuple[tuple[Prompt, ...], list[int]]:
    """The scene's prompts, and how many each kept flight has; prints a line."""
    boxes, verdicts = (
        BoxMap.load(folder(store, "boxes", name)),
        QualityVerdicts.load(folder(store, "quality_verdict", name)),
    )
    flights, frames = Trajectories.load(folder(store, "trajectories", name)), Frames.load(folder(store, "frames", name))
    begun = time.process_time()
    prompts = OfflinePrompter().write(name, frames, boxes, flights, verdicts)
    spent = time.process_time() - begun
    counts = Counter(p.flight_id for p in prompts)
    of_kept = [counts[i] for i in verdicts.kept]
    nameless = sum(is_generic(b.label) for b in boxes.boxes)
    print(
        f"{name:16s} {len(boxes):3d} boxes, {nameless} without a name; kept {len(of_kept)} of {len(verdicts)}; ", end=""
    )
    print(f"2+ prompts {sum(n > 1 for n in of_kept)}, none {of_kept.count(0)}; ", end="")
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


def sheets(store: Path, written: list[tuple[str, Prompt]], count: int, out: Path) -> None:
    """Numbered prompts with the first and last picture of their flights."""
    out.mkdir(parents=True, exist_ok=True)
    generator, scenes = rng("benchmark", "prompts", 0), sorted({name for name, _ in written})
    chosen: list[tuple[str, Prompt]] = []
    for name in scenes:
        own = [entry for entry in written if entry[0] == name]
        picked = generator.permutation(len(own))[: -(-count // len(scenes))]
        chosen += [own[i] for i in sorted(picked.tolist())]
    cells = [cell(store, number, *entry) for number, entry in enumerate(chosen[:count])]
    rows, columns = PER_SHEET
    for i in range(0, len(cells), rows * columns):
        page = cells[i : i + rows * columns]
        page += [np.full_like(cells[0], 255)] * (-len(page) % columns)
        lines = [np.hstack(page[j : j + columns]) for j in range(0, len(page), columns)]
        cv2.imwrite(str(out / f"prompts{i // (rows * columns)}.png"), np.vstack(lines)[:, :, ::-1])


def cell(store: Path, number: int, name: str, prompt: Prompt) -> np.ndarray:
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
