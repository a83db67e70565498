"""The verdict's gates on labelled damage: thresholds from one half of the scenes, rates and ROC on the other.

    python benchmarks/quality.py STORE [--flights 8] [--sheet FOLDER]

STORE holds finished scenes (`flymirage grow`, `flymirage import`). Good flights are damaged in each of the ways of
`quality_damage.py`; scenes alternate between the halves. Prints, for each damage, the gate that is there for it: its
area under the ROC curve, its false drops and false keeps at the settings' threshold; then the whole verdict's.
"""

import argparse
import json
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import cv2
import numpy as np
from quality_damage import DAMAGES, Case

from flymirage_core.annotation.boxes import BoxMap
from flymirage_core.language.evidence import Evidence
from flymirage_core.language.judge import MeasuredJudge
from flymirage_core.language.settings import VerdictSettings
from flymirage_core.language.verdicts import QualityVerdicts
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
JUDGE = MeasuredJudge(VerdictSettings())
SETTING = {"darkness": "min_brightness", "glare": "max_brightness", "final_view": "max_final_angle_deg"}
SETTING |= {"feasibility": "max_limit_ratio", "arrival": "max_end_error", "hovering": "max_hover"}
SETTING |= {"target_size": "min_target_share", "target_visible": "min_target_visible"}
THRESHOLDS = {
    gate: float(getattr(JUDGE.settings, name))
    for field in type(JUDGE.settings).model_fields
    for gate, name in [(field.partition("_")[2], field)]
} | {gate: float(getattr(JUDGE.settings, name)) for gate, name in SETTING.items()}
Row = dict[str, object]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("store", type=Path)
    parser.add_argument("--flights", type=int, default=8)
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
    scenes = sorted(path.name for path in (options.store / "products" / "quality_verdict").iterdir())
    for number, scene in enumerate(scenes):
        if scene not in done:
            fresh = list(measured(options.store, scene, number % 2, options.flights, options.sheet))
            rows += fresh
            with options.table.open("a") as table:
                table.writelines(json.dumps(row) + "\n" for row in fresh)
    report(rows)


def measured(store: Path, scene: str, half: int, flights: int, sheet: Path | None) -> Iterator[Row]:
    """Every gate's value on good flights and on each damage of them."""
    begun = time.process_time()
    for case, flight_id in cases(store, scene, flights):
        for damage in ("none", *DAMAGES):
            generator = rng(scene, f"damage {damage}", flight_id)
            evidence = case.evidence if damage == "none" else DAMAGES[damage](case, generator)
            results = JUDGE.gates(evidence)
            if sheet:
                _picture(sheet / f"{scene}-{flight_id}-{damage}.jpg", evidence)
            yield {
                "scene": scene,
                "half": half,
                "flight": flight_id,
                "damage": damage,
                "values": {g.gate: g.value for g in results},
            }
    sys.stderr.write(f"{scene}: {time.process_time() - begun:.0f} s CPU\n")


def cases(store: Path, scene: str, count: int) -> Iterator[tuple[Case, int]]:
    """Flights spread evenly over those that the store's verdict kept, as they are."""
    boxes, flights = BoxMap.load(folder(store, "boxes", scene)), Trajectories.load(folder(store, "trajectories", scene))
    frames, world = Frames.load(folder(store, "frames", scene)), World.load(folder(store, "world", scene))
    kept = QualityVerdicts.load(folder(store, "quality_verdict", scene)).kept
    chosen = [f for f in flights if f.flight_id in kept]
    for i in np.unique(np.linspace(0, len(chosen) - 1, count).astype(int)).tolist():
        flight = chosen[i]
        evidence = Evidence.of(
            flight, boxes.by_id(flight.object_id), frames.flight(flight.flight_id), JUDGE.settings.frame_step
        )
        yield Case(evidence, world.cloud, boxes, CpuRasterizer(0)), flight.flight_id


def folder(store: Path, asset: str, scene: str) -> Path:
    at = store / "products" / asset / scene
    return at / str(json.loads((at / "product.json").read_text())["digest"])


def report(rows: list[Row]) -> None:
    """Thresholds that the first half suggests, then rates and areas on the second."""
    first, second = ([r for r in rows if r["half"] == half] for half in (0, 1))
    good = [r for r in first if r["damage"] == "none"]
    print(f"{len({r['scene'] for r in rows})} scenes; good flights: {len(good)} to calibrate, {count(second)} to test")
    print("\ngate             good 1%..99% (first half)        threshold  suggested   damage: 5%..95%")
    for damage, gates in GATES.items():
        for gate in gates:
            hurt = [r for r in first if r["damage"] == damage]
            print(spread_line(gate, values(good, gate), damage, values(hurt, gate)))
    print("\nsecond half      gate AUC  finds    verdict AUC  false keep")
    clean = [r for r in second if r["damage"] == "none"]
    usual = {gate: float(np.median(values(good, gate))) for gate in good[0]["values"]}
    calm = [score(r, usual) for r in clean]
    everything: list[float] = []
    for damage, gates in GATES.items():
        hurt = [r for r in second if r["damage"] == damage]
        scores = [score(r, usual) for r in hurt]
        everything += scores
        best = max(auc(badness(clean, g), badness(hurt, g)) for g in gates)
        finds = np.mean([bool(set(gates) & set(failed(r))) for r in hurt])
        kept = np.mean([not failed(r) for r in hurt])
        print(f"{damage:15s}  {best:8.3f}  {finds:5.1%}    {auc(calm, scores):11.3f}  {kept:10.1%}")
    hurt = [r for r in second if r["damage"] != "none"]
    dropped, missed = [r for r in clean if failed(r)], [r for r in hurt if not failed(r)]
    print(f"\nverdict in all: AUC {auc(calm, everything):.3f}")
    print(f"false drop {len(dropped) / len(clean):.1%} of {len(clean)}, ", end="")
    print(f"false keep {len(missed) / len(hurt):.1%} of {len(hurt)}")
    print("false drops:", {f"{r['scene']}/{r['flight']}": failed(r) for r in dropped})


def failed(row: Row) -> list[str]:
    """Gates that the settings' thresholds let the flight fail."""
    return [gate for gate, value in row["values"].items() if excess(gate, value, THRESHOLDS[gate]) > 0]


def count(rows: list[Row]) -> int:
    return sum(r["damage"] == "none" for r in rows)


def values(rows: list[Row], gate: str) -> np.ndarray:
    return np.array([r["values"][gate] for r in rows], float)


def badness(rows: list[Row], gate: str) -> np.ndarray:
    """The gate's values, greater is worse."""
    return -values(rows, gate) if gate in LOW_IS_BAD else values(rows, gate)


def spread_line(gate: str, good: np.ndarray, damage: str, hurt: np.ndarray) -> str:
    low, high = np.percentile(good, [1, 99])
    a, b = np.percentile(hurt, [5, 95])
    calibrated = f"{THRESHOLDS[gate]:9.3f}  {suggested(gate, good, hurt):9.3f}"
    return f"{gate:15s}  {low:9.3f} .. {high:9.3f}   {calibrated}   {damage}: {a:.3f} .. {b:.3f}"


def suggested(gate: str, good: np.ndarray, hurt: np.ndarray) -> float:
    """Where the shares of good flights passed and of damaged ones found add up to most: the middle of that gap."""
    sign = -1.0 if gate in LOW_IS_BAD else 1.0
    g, h = np.sort(sign * good), np.sort(sign * hurt)
    marks = np.unique(np.concatenate([g, h]))
    middles = (marks[:-1] + marks[1:]) / 2 if len(marks) > 1 else marks
    gain = np.searchsorted(g, middles, side="right") / len(g) - np.searchsorted(h, middles, side="right") / len(h)
    best = middles[gain >= gain.max() - 1e-9]
    return float(sign * best[len(best) // 2])


def score(row: Row, calm: dict[str, float]) -> float:
    """A verdict as one number: how far its worst gate lies beyond the threshold; -1 at good flights' median."""
    return max(excess(gate, value, calm[gate]) for gate, value in row["values"].items())


def excess(gate: str, value: float, calm: float) -> float:
    """How far a gate's value lies beyond its threshold, in distances of ``calm``, the usual value, from it."""
    if not np.isfinite(value):
        return float("inf")
    sign = -1.0 if gate in LOW_IS_BAD else 1.0
    return sign * (value - THRESHOLDS[gate]) / max(sign * (THRESHOLDS[gate] - calm), 1e-9)


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
