"""The verdict's gates on labelled damage: thresholds from one half of the scenes, rates and ROC on the other.

    python benchmarks/quality.py HOME... [--flights 4] [--seed 0] [--table FILE] [--sheet FOLDER]

Each HOME is a project's folder with finished scenes (`flymirage grow`, `flymirage import`), or a store. Good flights
are damaged in each of the ways of `quality_damage.py`. ``--seed`` says which half of the scenes sets the thresholds, by
one rule for all gates (`suggested`); on the other half stand, for each damage, the area under the ROC curve of its gate
and of the verdict, and how many are found and wrongly kept, with those thresholds and with the settings'. Then the same
over 20 splits.
"""

import argparse
import json
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from quality_damage import DAMAGES, Case

from flymirage_core.annotation.boxes import BoxMap
from flymirage_core.language.evidence import Evidence, scene_openings
from flymirage_core.language.judge import MeasuredJudge
from flymirage_core.language.settings import VerdictSettings
from flymirage_core.language.verdicts import GateResult, QualityVerdicts
from flymirage_core.navigation.trajectories import Trajectories
from flymirage_core.rendering.cpu import CpuRasterizer
from flymirage_core.rendering.frames import Frames
from flymirage_core.scene.keys import rng
from flymirage_core.splats.world import World

GATES = {
    "blur": ("blur",),
    "noise": ("noise",),
    "fog": ("contrast",),
    "dark": ("darkness",),
    "flicker": ("flicker",),
    "holes": ("hole",),
    "floaters": ("floaters",),
    "wrong_target": ("target_visible", "final_view"),
    "hovering": ("hovering", "progress"),
}
"""What is there to find each damage."""
LOW_IS_BAD = ("alpha_coverage", "contrast", "darkness", "target_visible", "target_size", "progress", "clearance")
SPLITS = 20
LENIENCE = 0.75
"""Of the way from the worst good flight to the least damaged: few scenes do not show how dark a good one can be."""
JUDGE = MeasuredJudge(VerdictSettings())
Row = dict[str, Any]
Thresholds = dict[str, float]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("homes", type=Path, nargs="+")
    parser.add_argument("--flights", type=int, default=4)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--sheet", type=Path)
    parser.add_argument(
        "--table",
        type=Path,
        default=Path("quality.jsonl"),
        help="where what was measured is kept, a line a flight, and taken up again",
    )
    options = parser.parse_args()
    rows = [json.loads(line) for line in options.table.read_text().splitlines()] if options.table.exists() else []
    done = {row["scene"] for row in rows}
    for home in options.homes:
        store = home / ".flymirage" / "store" if (home / ".flymirage").exists() else home
        for scene in sorted(path.name for path in (store / "products" / "quality_verdict").iterdir()):
            if f"{home.name}/{scene}" in done:
                continue
            fresh = [row | {"scene": f"{home.name}/{scene}"} for row in measured(store, scene, options)]
            rows += fresh
            with options.table.open("a") as table:
                table.writelines(json.dumps(row) + "\n" for row in fresh)
    report(rows, options.seed)


def measured(store: Path, scene: str, options: argparse.Namespace) -> Iterator[Row]:
    """Every gate's value on good flights and on each damage of them."""
    begun = time.process_time()
    for case, flight_id in cases(store, scene, options.flights):
        for damage in ("none", *DAMAGES):
            generator = rng(scene, f"damage {damage}", flight_id)
            evidence = case.evidence if damage == "none" else DAMAGES[damage](case, generator)
            results = JUDGE.gates(evidence)
            if options.sheet:
                _picture(options.sheet / f"{scene}-{flight_id}-{damage}.jpg", evidence)
            yield {
                "flight": flight_id,
                "damage": damage,
                "values": {g.gate: in_a_closed_scene(g) for g in results},
                "thresholds": {g.gate: in_a_closed_scene(replace(g, value=g.threshold)) for g in results},
            }
    sys.stderr.write(f"{scene}: {time.process_time() - begun:.0f} s CPU\n")


def in_a_closed_scene(result: GateResult) -> float:
    """The value that in a scene without openings of its own lies as far beyond the threshold."""
    if result.gate == "hole":
        return max(0.0, result.value - (result.threshold - JUDGE.settings.max_hole[0]))
    if result.gate == "alpha_coverage":
        return min(1.0, result.value + (1 - result.threshold - JUDGE.settings.max_empty[0]))
    return result.value


def cases(store: Path, scene: str, count: int) -> Iterator[tuple[Case, int]]:
    """Flights spread evenly over those that the store's verdict kept, as they are."""
    boxes, flights = BoxMap.load(folder(store, "boxes", scene)), Trajectories.load(folder(store, "trajectories", scene))
    frames, world = Frames.load(folder(store, "frames", scene)), World.load(folder(store, "world", scene))
    kept = QualityVerdicts.load(folder(store, "quality_verdict", scene)).kept
    chosen = [f for f in flights if f.flight_id in kept]
    openings = scene_openings(frames)
    for i in np.unique(np.linspace(0, len(chosen) - 1, count).astype(int)).tolist():
        flight = chosen[i]
        target, filmed = boxes.by_id(flight.object_id), frames.flight(flight.flight_id)
        evidence = Evidence.of(flight, target, filmed, JUDGE.settings.frame_step, openings)
        yield Case(evidence, world.cloud, boxes, CpuRasterizer(0)), flight.flight_id


def folder(store: Path, asset: str, scene: str) -> Path:
    at = store / "products" / asset / scene
    return at / str(json.loads((at / "product.json").read_text())["digest"])


def report(rows: list[Row], seed: int) -> None:
    """One split in full, then what the verdict does over many."""
    first, second = halves(rows, seed)
    good, clean = of_damage(first, "none"), of_damage(second, "none")
    set_here, found = rows[0]["thresholds"], calibrated(first)
    print(f"seed {seed}: {len(scenes_of(first))} scenes calibrate ({len(good)} good flights): {scenes_of(first)}")
    print(f"{len(scenes_of(second))} scenes test ({len(clean)} good flights)\n")
    print("gate              good 1%..99%               settings  calibrated   damage: 5%..95%")
    for damage, gates in GATES.items():
        for gate in gates:
            low, high = np.percentile(values(good, gate), [1, 99])
            a, b = np.percentile(values(of_damage(first, damage), gate), [5, 95])
            thresholds = f"{set_here[gate]:9.3f} {found[gate]:9.3f}"
            print(f"{gate:15s} {low:9.3f} .. {high:9.3f}  {thresholds}   {damage}: {a:.3f} .. {b:.3f}")
    for name, thresholds in (("calibrated", found), ("settings'", set_here)):
        print(f"\nother half, {name} thresholds\ndamage          gate AUC   finds  verdict AUC  false keep")
        scale = Scale.of(first)
        for damage in GATES:
            hurt = of_damage(second, damage)
            best, finds = gate_figures(clean, hurt, damage, thresholds)
            area, kept = verdict_figures(clean, hurt, scale, thresholds)
            print(f"{damage:15s} {best:8.3f}  {finds:6.1%}  {area:11.3f}  {kept:10.1%}")
        area, kept = verdict_figures(clean, [r for r in second if r["damage"] != "none"], scale, thresholds)
        dropped = {f"{r['scene']}/{r['flight']}": failed(r, thresholds) for r in clean if failed(r, thresholds)}
        print(f"in all: AUC {area:.3f}, false keep {kept:.1%}, false drop {len(dropped) / len(clean):.1%} {dropped}")
    many_splits(rows)


def many_splits(rows: list[Row]) -> None:
    """AUC and rates on the half that did not set the thresholds: mean, least and most over the splits."""
    table: dict[str, list[float]] = {}
    for seed in range(SPLITS):
        first, second = halves(rows, seed)
        clean, scale, thresholds = of_damage(second, "none"), Scale.of(first), calibrated(first)
        table.setdefault("false drop", []).append(float(np.mean([bool(failed(r, thresholds)) for r in clean])))
        for damage in (*GATES, "all"):
            hurt = [r for r in second if r["damage"] == damage or (damage == "all" and r["damage"] != "none")]
            if damage != "all":
                table.setdefault(f"{damage}: gate AUC", []).append(gate_figures(clean, hurt, damage, thresholds)[0])
            area, kept = verdict_figures(clean, hurt, scale, thresholds)
            table.setdefault(f"{damage}: verdict AUC", []).append(area)
            table.setdefault(f"{damage}: false keep", []).append(kept)
    print(f"\nover {SPLITS} splits, thresholds always from the other half: mean (least .. most)")
    for name, figures in table.items():
        print(f"{name:28s} {np.mean(figures):.3f} ({min(figures):.3f} .. {max(figures):.3f})")


def halves(rows: list[Row], seed: int) -> tuple[list[Row], list[Row]]:
    """Rows of the scenes that calibrate, and of those that test."""
    scenes = scenes_of(rows)
    chosen = {scenes[i] for i in rng("benchmark", "quality", seed).permutation(len(scenes))[: len(scenes) // 2]}
    return [r for r in rows if r["scene"] in chosen], [r for r in rows if r["scene"] not in chosen]


def scenes_of(rows: list[Row]) -> list[str]:
    return sorted({r["scene"] for r in rows})


def of_damage(rows: list[Row], damage: str) -> list[Row]:
    return [r for r in rows if r["damage"] == damage]


def calibrated(rows: list[Row]) -> Thresholds:
    """The settings' thresholds; those of gates that are there for a damage as these rows suggest."""
    good = of_damage(rows, "none")
    found = {
        gate: suggested(gate, values(good, gate), values(of_damage(rows, damage), gate))
        for damage, gates in GATES.items()
        for gate in gates
    }
    return rows[0]["thresholds"] | found


def suggested(gate: str, good: np.ndarray, hurt: np.ndarray) -> float:
    """Where the shares of good flights passed and of damaged ones found add up to most: `LENIENCE` into that gap."""
    sign = -1.0 if gate in LOW_IS_BAD else 1.0
    g, h = np.sort(sign * good), np.sort(sign * hurt)
    marks = np.unique(np.concatenate([g, h]))
    low, high = (marks[:-1], marks[1:]) if len(marks) > 1 else (marks, marks)
    middle = (low + high) / 2
    gain = np.searchsorted(g, middle, side="right") / len(g) - np.searchsorted(h, middle, side="right") / len(h)
    best = np.flatnonzero(gain >= gain.max() - 1e-9)
    return float(sign * (low[best[0]] + LENIENCE * (high[best[-1]] - low[best[0]])))


def gate_figures(clean: list[Row], hurt: list[Row], damage: str, thresholds: Thresholds) -> tuple[float, float]:
    """The best area under the curve of the gates that are there for the damage, and the share that they find."""
    gates = GATES[damage]
    area = max(auc(badness(clean, g), badness(hurt, g)) for g in gates)
    return area, float(np.mean([bool(set(gates) & set(failed(r, thresholds))) for r in hurt]))


def verdict_figures(clean: list[Row], hurt: list[Row], scale: "Scale", thresholds: Thresholds) -> tuple[float, float]:
    """The verdict's area under the curve, and the share of damaged flights that it keeps."""
    area = auc(*([scale.score(r, thresholds) for r in rows] for rows in (clean, hurt)))
    return area, float(np.mean([not failed(r, thresholds) for r in hurt]))


def failed(row: Row, thresholds: Thresholds) -> list[str]:
    """Gates that the flight fails."""
    return [g for g, v in row["values"].items() if beyond(g, v, thresholds[g]) > 0]


def values(rows: list[Row], gate: str) -> np.ndarray:
    return np.array([r["values"][gate] for r in rows], float)


def badness(rows: list[Row], gate: str) -> np.ndarray:
    """The gate's values, greater is worse."""
    return -values(rows, gate) if gate in LOW_IS_BAD else values(rows, gate)


@dataclass(frozen=True)
class Scale:
    """Makes one number of a verdict: of each gate, -1 is the median of good flights, 0 the threshold, and 1 the median
    of the damage that the gate is there for; the worst gate counts."""

    good: dict[str, float]
    hurt: dict[str, float]  # of gates that are there for a damage

    @staticmethod
    def of(rows: list[Row]) -> "Scale":
        clean = of_damage(rows, "none")
        good = {gate: float(np.median(values(clean, gate))) for gate in clean[0]["values"]}
        hurt = {
            gate: float(np.median(values(of_damage(rows, damage), gate)))
            for damage, gates in GATES.items()
            for gate in gates
        }
        return Scale(good, hurt)

    def score(self, row: Row, thresholds: Thresholds) -> float:
        return max(self._of_gate(gate, value, thresholds[gate]) for gate, value in row["values"].items())

    def _of_gate(self, gate: str, value: float, threshold: float) -> float:
        over = beyond(gate, value, threshold)
        calm = -beyond(gate, self.good[gate], threshold)
        far = max(beyond(gate, self.hurt.get(gate, self.good[gate]), threshold), calm)
        return over / max(far if over > 0 else calm, 1e-9)


def beyond(gate: str, value: float, threshold: float) -> float:
    """How far a value lies on the bad side of a threshold, in the gate's own units."""
    sign = -1.0 if gate in LOW_IS_BAD else 1.0
    return float("inf") if not np.isfinite(value) else sign * (value - threshold)


def auc(good: "np.ndarray | list[float]", hurt: "np.ndarray | list[float]") -> float:
    """Chance that a damaged flight's value exceeds a good one's (Mann-Whitney); ties count half."""
    g, h = np.asarray(good)[:, None], np.asarray(hurt)[None, :]
    return float(((h > g) + 0.5 * (h == g)).mean())


def _picture(path: Path, evidence: Evidence) -> None:
    """Four of the sampled frames side by side."""
    path.parent.mkdir(parents=True, exist_ok=True)
    chosen = [evidence.sightings[i] for i in np.linspace(0, len(evidence.sightings) - 1, 4).astype(int)]
    strip = np.hstack([cv2.resize(s.rgb, (240, 180), interpolation=cv2.INTER_AREA) for s in chosen])
    cv2.imwrite(str(path), strip[:, :, ::-1])


if __name__ == "__main__":
    main()
