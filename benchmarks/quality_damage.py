"""Labelled damage to good flights: pictures are spoilt, splats removed or added, flights changed.

Each damage takes a `Case` and a generator and gives the evidence of the damaged flight.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import cv2
import numpy as np

from flymirage_core.annotation.boxes import BoxMap
from flymirage_core.language.evidence import Evidence, Sighting, neighbours
from flymirage_core.navigation.trajectories import Flight
from flymirage_core.rendering.rasterizer import Rasterizer
from flymirage_core.rendering.views import DEPTH_UNIT, depth_to_millimetres
from flymirage_core.splats.cloud import GaussianCloud

SH_DC = 0.28209479177387814
"""The constant spherical harmonic: colour = 0.5 + SH_DC * sh[0]."""

SHOWN, SHOWN_GREY = 0.02, 30.0
"""Share of a picture's pixels, and grey levels by which each must change, for a hole to count as one."""
MOST_DRAWS = 10


@dataclass(frozen=True, eq=False)
class Case:
    """One good flight and where it was flown."""

    evidence: Evidence
    cloud: GaussianCloud
    boxes: BoxMap
    rasterizer: Rasterizer


Damage = Callable[[Case, np.random.Generator], Evidence]


def blur(case: Case, generator: np.random.Generator) -> Evidence:
    """Gaussian, standard deviation 1 to 3 pixels."""
    sigma = generator.uniform(1.0, 3.0)
    return spoilt(case.evidence, lambda s: cv2.GaussianBlur(s.rgb, (0, 0), sigma))


def noise(case: Case, generator: np.random.Generator) -> Evidence:
    """Normal, standard deviation 8 to 25 grey levels."""
    sigma = generator.uniform(8.0, 25.0)
    return spoilt(case.evidence, lambda s: s.rgb + generator.normal(0, sigma, s.rgb.shape))


def fog(case: Case, generator: np.random.Generator) -> Evidence:
    """Light grey, by depth: 0.25 to 0.6 of the light is lost in every metre."""
    density, grey = -np.log(1 - generator.uniform(0.25, 0.6)), generator.uniform(170, 230)

    def foggy(sighting: Sighting) -> np.ndarray:
        metres = np.where(sighting.depth > 0, sighting.depth * DEPTH_UNIT, 10.0)
        clear = np.exp(-density * metres)[..., None]  # (H, W, 1)
        return sighting.rgb * clear + grey * (1 - clear)

    return spoilt(case.evidence, foggy)


def dark(case: Case, generator: np.random.Generator) -> Evidence:
    """From some moment on, for a third of the flight, 3 to 15 % of the light is left."""
    gain, last = generator.uniform(0.03, 0.15), case.evidence.sightings[-1].frame_index
    begin = generator.uniform(0, 2 / 3) * last
    hit = [s.frame_index for s in case.evidence.sightings if begin <= s.frame_index <= begin + last / 3]
    lost = range(min(hit, default=0), max(hit, default=0) + 2)
    return spoilt(case.evidence, lambda s: s.rgb * gain if s.frame_index in lost else s.rgb)


def flicker(case: Case, generator: np.random.Generator) -> Evidence:
    """Every frame has its own brightness, 10 to 30 % up or down."""
    strength = generator.uniform(0.1, 0.3)
    return spoilt(case.evidence, lambda s: s.rgb * (1 + strength * (1 if s.frame_index % 2 else -1)))


def holes(case: Case, generator: np.random.Generator) -> Evidence:
    """What lies within 0.5 to 1.2 m of three points that the flight sees is gone, and it shows.

    Drawn again while no sampled picture has changed in `SHOWN` of its pixels: a hole behind a wall hurts nobody.
    """
    for _ in range(MOST_DRAWS):
        radius, cloud = generator.uniform(0.5, 1.2), case.cloud
        for _ in range(3):
            point = _seen_point(case.evidence, generator)
            cloud = cloud[np.linalg.norm(cloud.means - point, axis=1) > radius]
        damaged = filmed_again(case, cloud)
        if _changed(case.evidence, damaged) >= SHOWN:
            return damaged
    raise ValueError(f"flight {case.evidence.flight.flight_id}: no hole of {MOST_DRAWS} shows")


def _changed(before: Evidence, after: Evidence) -> float:
    """Most of a sampled picture's pixels that are of quite another brightness."""
    pairs = zip(before.sightings, after.sightings, strict=True)
    return max(float((np.abs(a.luma - b.luma) > SHOWN_GREY).mean()) for a, b in pairs)


def floaters(case: Case, generator: np.random.Generator) -> Evidence:
    """Four to eight clumps of soft grey splats, 0.15 to 0.5 m before the camera at moments of the flight."""
    clumps = [_clump(case.evidence, generator) for _ in range(int(generator.integers(4, 9)))]
    return filmed_again(case, joined([case.cloud, *(_spheres(*clump, case.cloud.sh.shape[1]) for clump in clumps)]))


def wrong_target(case: Case, generator: np.random.Generator) -> Evidence:
    """Another object is said to be the target, more than 1.5 m from the real one."""
    target = case.evidence.target
    others = [b for b in case.boxes.boxes if np.linalg.norm(np.subtract(b.centre, target.centre)) > 1.5]
    return replace(case.evidence, target=others[int(generator.integers(len(others)))])


def hovering(case: Case, generator: np.random.Generator) -> Evidence:
    """The drone never leaves its start, or stops half-way for 4 to 10 s: one as often as the other."""
    evidence = case.evidence
    if generator.random() < 0.5:
        return replace(
            evidence,
            flight=_frozen(evidence.flight),
            sightings=tuple(replace(evidence.sightings[0], frame_index=s.frame_index) for s in evidence.sightings),
            pairs=((evidence.sightings[0], evidence.sightings[0]),),
        )
    return replace(evidence, flight=_paused(evidence.flight, generator.uniform(4.0, 10.0)))


DAMAGES: dict[str, Damage] = {
    "blur": blur,
    "noise": noise,
    "fog": fog,
    "dark": dark,
    "flicker": flicker,
    "holes": holes,
    "floaters": floaters,
    "wrong_target": wrong_target,
    "hovering": hovering,
}


def spoilt(evidence: Evidence, change: Callable[[Sighting], np.ndarray]) -> Evidence:
    """The same frames with other pictures."""
    seen = {s.frame_index: s for s in (*evidence.sightings, *(s for pair in evidence.pairs for s in pair))}
    new = {i: replace(s, rgb=np.clip(np.rint(change(s)), 0, 255).astype(np.uint8)) for i, s in sorted(seen.items())}
    return _with_pictures(evidence, new)


def filmed_again(case: Case, cloud: GaussianCloud) -> Evidence:
    """The sampled frames in another world."""
    seen = {s.frame_index: s for s in (*case.evidence.sightings, *(s for pair in case.evidence.pairs for s in pair))}
    old = [seen[i] for i in sorted(seen)]
    pictures = list(case.rasterizer.render(cloud, [s.camera for s in old]))
    new = {
        s.frame_index: Sighting(s.frame_index, s.camera, p.rgb, depth_to_millimetres(p.depth))
        for s, p in zip(old, pictures, strict=True)
    }
    coverage = np.array([float((p.alpha >= 0.5).mean()) for p in pictures])
    return replace(_with_pictures(case.evidence, new), coverage=coverage)


def joined(clouds: list[GaussianCloud]) -> GaussianCloud:
    return GaussianCloud(
        *(
            np.concatenate([getattr(c, n) for c in clouds])
            for n in ("means", "quaternions", "scales", "opacities", "sh")
        )
    )


def _with_pictures(evidence: Evidence, new: dict[int, Sighting]) -> Evidence:
    sightings = tuple(new[s.frame_index] for s in evidence.sightings)
    return replace(evidence, sightings=sightings, pairs=neighbours(new.values()))


def _seen_point(evidence: Evidence, generator: np.random.Generator) -> np.ndarray:
    """A world point that a pixel of the middle half of some sampled frame shows."""
    sighting = evidence.sightings[int(generator.integers(len(evidence.sightings)))]
    height, width = sighting.depth.shape
    rows, columns = np.nonzero(sighting.depth[height // 4 : -height // 4, width // 4 : -width // 4])
    if not len(rows):
        return sighting.camera.position
    chosen = int(generator.integers(len(rows)))
    return _point(sighting, rows[chosen] + height // 4, columns[chosen] + width // 4)


def _point(sighting: Sighting, row: int, column: int) -> np.ndarray:
    return _placed(sighting, row, column, float(sighting.depth[row, column]) * DEPTH_UNIT)


def _placed(sighting: Sighting, row: float, column: float, z: float) -> np.ndarray:
    k = sighting.camera.intrinsics
    local = np.array([(column + 0.5 - k.cx) / k.fx * z, (row + 0.5 - k.cy) / k.fy * z, z, 1.0])
    return (sighting.camera.T_world_camera @ local)[:3]


def _clump(evidence: Evidence, generator: np.random.Generator) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Means, deviations, opacities and colours of 30 splats somewhere before the camera at a sampled moment."""
    sighting = evidence.sightings[int(generator.integers(len(evidence.sightings)))]
    k = sighting.camera.intrinsics
    row, column = generator.uniform(0.15, 0.85, 2) * (k.height, k.width)
    middle = _placed(sighting, row, column, generator.uniform(0.15, 0.5))
    means = middle + generator.normal(0, 0.04, (30, 3))
    colours = np.clip(generator.uniform(0.2, 0.8) + generator.normal(0, 0.05, (30, 3)), 0, 1)
    return means, generator.uniform(0.01, 0.04, 30), generator.uniform(0.3, 0.9, 30), colours


def _spheres(
    means: np.ndarray, deviations: np.ndarray, opacities: np.ndarray, colours: np.ndarray, coefficients: int
) -> GaussianCloud:
    sh = np.zeros((len(means), coefficients, 3), np.float32)
    sh[:, 0] = (colours - 0.5) / SH_DC
    upright = np.tile(np.array([0, 0, 0, 1], np.float32), (len(means), 1))
    scales = np.repeat(deviations[:, None], 3, axis=1)
    return GaussianCloud(*(np.asarray(a, np.float32) for a in (means, upright, scales, opacities, sh)))


def _frozen(flight: Flight) -> Flight:
    """For as long, but at the start."""
    return replace(
        flight,
        positions=np.repeat(flight.positions[:1], len(flight.times), axis=0),
        yaws=np.repeat(flight.yaws[:1], len(flight.times)),
        velocities=np.zeros_like(flight.velocities),
    )


def _paused(flight: Flight, seconds: float) -> Flight:
    """As before, with a stop in the middle."""
    step = float(flight.times[1] - flight.times[0])
    middle, count = len(flight.times) // 2, round(seconds / step)
    index = np.concatenate([np.arange(middle), np.full(count, middle), np.arange(middle, len(flight.times))])
    velocities = flight.velocities[index].copy()
    velocities[middle : middle + count] = 0.0
    return replace(
        flight,
        times=np.arange(len(index)) * step,
        positions=flight.positions[index],
        yaws=flight.yaws[index],
        velocities=velocities,
        clearances=flight.clearances[index],
    )
