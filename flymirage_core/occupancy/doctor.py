"""The scene doctor: measures whether a world can be flown in, and says in plain words what is wrong and what to do."""

from dataclasses import dataclass, replace
from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray

from flymirage_core.errors import WorldError
from flymirage_core.occupancy.distance import clearance_at, clearance_field
from flymirage_core.occupancy.grid import FREE, OCCUPIED, UNKNOWN, OccupancyGrid
from flymirage_core.occupancy.queries import first_hit
from flymirage_core.occupancy.voxelise import (
    REACH,
    accumulated_opacity,
    floor_layer,
    grid_bounds,
    occupancy_from_splats,
    without_floaters,
)
from flymirage_core.settings import OccupancySettings
from flymirage_core.splats.world import World

Severity = Literal["ok", "warning", "problem"]

CLEAR_HEIGHT: Final = (2.0, 6.0)
"""Metres from floor to ceiling that are taken for a right scale."""
TYPICAL_HEIGHT: Final = 2.6
"""Metres. The scale that is proposed makes the ceiling this high."""
FLOOR_TOLERANCE: Final = 0.15
"""Metres that the measured floor may be off z = 0."""
LEAST_VOLUME: Final = 5.0
"""Cubic metres. In less free space no two targets lie the paper's 2 m apart."""
SMALL_VOLUME: Final = 20.0
"""Cubic metres. Less than a small bedroom's."""
LEAST_CLEARANCE: Final = 0.35
"""Metres at c: the paper's flights begin there."""
OCCUPIED_SHARES: Final = (0.005, 0.6)
"""Share of voxels with matter: less is a ghost of a world, more is haze or solid filling."""
FLOATER_SHARE: Final = 0.1
"""Share of voxels with matter that may be floaters."""
OPEN_SHARE: Final = 0.25
"""Share of the directions round c in which nothing may be hit: more is not a closed room."""
CEILING_SHARE: Final = 0.5
"""There is a ceiling if matter lies right above this share of the free columns."""
REMOVED_SHARE: Final = 0.2
"""Share of the Gaussians that cleaning may remove without comment."""
DIRECTIONS: Final = 2000
"""Rays that are cast from c to see how open the world is."""


@dataclass(frozen=True)
class Finding:
    """One thing that was examined: a sentence on what was found and, if it is not well, on what to do."""

    severity: Severity
    subject: str
    sentence: str


@dataclass(frozen=True)
class DoctorReport:
    """What `examine` measured in a world; metres, world frame."""

    gaussians: int
    extent: tuple[float, float, float]  # of the grid round the world, x y z
    up: str  # the file's axis that points up, and how that was found
    scale: float  # metres per unit of the file
    scale_source: str
    centre: tuple[float, float, float]  # c
    floor: float | None  # z of the floor; None if no flat floor was found
    clear_height: float | None  # floor to ceiling, median; None without a ceiling
    free_volume: float  # m^3 reached from c
    clearance: float  # at c
    occupied_share: float  # of the grid's voxels
    floater_share: float  # of the voxels with matter, dropped
    open_share: float  # of the directions round c in which nothing is hit
    findings: tuple[Finding, ...]

    @property
    def severity(self) -> Severity:
        """The worst of the findings."""
        found = {finding.severity for finding in self.findings}
        return "problem" if "problem" in found else "warning" if "warning" in found else "ok"


def examine(world: World, settings: OccupancySettings) -> DoctorReport:
    """Measure a world; never raises for what a world may be like: all that is wrong is a finding."""
    centre = np.asarray(world.centre, float)
    origin, shape = grid_bounds(world.cloud, centre, settings.resolution)
    matter = accumulated_opacity(world.cloud, origin, shape, settings.resolution) >= settings.opacity_threshold
    solid = without_floaters(matter, settings.min_component_voxels)
    shell = OccupancyGrid(np.where(solid, OCCUPIED, UNKNOWN).astype(np.uint8), origin, settings.resolution)
    layer = floor_layer(shell, centre)
    blocked_because = ""
    try:
        grid = occupancy_from_splats(world.cloud, centre, settings)
    except WorldError as error:
        grid, blocked_because = shell, str(error)
    scale = world.notes.get("scale")  # a generated world says in words that it is metric
    x, y, z = (float(length) for length in np.multiply(shape, settings.resolution))
    report = DoctorReport(
        gaussians=len(world.cloud),
        extent=(x, y, z),
        up=f"{world.notes.get('up', 'z')} ({world.notes.get('up_source', 'as the world was made')})",
        scale=float(scale) if isinstance(scale, int | float) else 1.0,
        scale_source=str(world.notes.get("scale_source", scale or "as the world was made")),
        centre=(float(centre[0]), float(centre[1]), float(centre[2])),
        floor=None if layer is None else round(float(shell.centre_of([0, 0, layer])[2]), 6) + 0.0,
        clear_height=_clear_height(grid),
        free_volume=float((grid.state == FREE).sum() * settings.resolution**3),
        clearance=float(clearance_at(grid, clearance_field(grid), centre)),
        occupied_share=float(solid.mean()),
        floater_share=float((matter & ~solid).sum() / max(matter.sum(), 1)),
        open_share=float(np.isinf(first_hit(shell, centre, _directions(), 2 * float(REACH.max()))).mean()),
        findings=(),
    )
    findings = [*_frame_findings(report), *_space_findings(report, blocked_because), *_matter_findings(report, world)]
    return replace(report, findings=tuple(findings))


def _frame_findings(report: DoctorReport) -> list[Finding]:
    """Scale, up axis and floor."""
    findings = [Finding("ok", "up axis", f"The file's axis {report.up} points up.")]
    if report.floor is None:
        say = "No flat floor was found below c; if the world should have one, try another `--up`."
        findings.append(Finding("warning", "floor", say))
    elif abs(report.floor) > FLOOR_TOLERANCE:
        say = f"The floor was measured at z = {report.floor:.2f} m, expected 0; try another `--up`, or check the scale."
        findings.append(Finding("problem", "floor", say))
    else:
        say = f"The floor is at z = {report.floor:.2f} m, and c is at z = {report.centre[2]:.2f} m."
        findings.append(Finding("ok", "floor", say))
    height, told = report.clear_height, f"scale {report.scale:g} ({report.scale_source})"
    if height is None:
        say = f"No ceiling was found, so the {told} cannot be checked; compare a door (2 m) or a table (0.75 m)."
        findings.append(Finding("ok", "scale", say))
    elif CLEAR_HEIGHT[0] <= height <= CLEAR_HEIGHT[1]:
        findings.append(Finding("ok", "scale", f"The ceiling is {height:.2f} m high: {told} is plausible."))
    else:
        proposal = report.scale * TYPICAL_HEIGHT / height
        say = f"The ceiling is {height:.2f} m high, so {told} is doubtful; a room would need `--scale {proposal:.3g}`."
        findings.append(Finding("warning", "scale", say))
    return findings


def _space_findings(report: DoctorReport, blocked_because: str) -> list[Finding]:
    """Free space, c's clearance, openness."""
    if blocked_because:
        return [Finding("problem", "centre", blocked_because[0].upper() + blocked_because[1:] + ".")]
    findings = []
    volume = f"{report.free_volume:.1f} m3 can be flown in from c"
    if report.free_volume < LEAST_VOLUME:
        say = f"Only {volume}: c is shut in, or the scale is too small; give another `--scale`."
        findings.append(Finding("problem", "free volume", say))
    elif report.free_volume < SMALL_VOLUME:
        findings.append(Finding("warning", "free volume", f"Only {volume}; expect few and short flights."))
    else:
        findings.append(Finding("ok", "free volume", f"{volume[0].upper()}{volume[1:]}."))
    if report.clearance < LEAST_CLEARANCE:
        say = f"c has only {report.clearance:.2f} m clearance; flights begin there, so expect rejected tasks."
        findings.append(Finding("warning", "clearance", say))
    else:
        findings.append(Finding("ok", "clearance", f"c has {report.clearance:.2f} m clearance."))
    share = f"{report.open_share:.0%} of the directions round c"
    if report.open_share > OPEN_SHARE:
        say = f"Nothing is hit in {share}: an open place, or walls are missing; free space ends where the ground ends."
        findings.append(Finding("warning", "openness", say))
    else:
        findings.append(Finding("ok", "openness", f"Nothing is hit in {share}: doorways, windows and holes."))
    return findings


def _matter_findings(report: DoctorReport, world: World) -> list[Finding]:
    """Occupied voxels, floaters, what cleaning removed."""
    findings = []
    share = f"{report.occupied_share:.1%} of the voxels hold matter"
    if report.occupied_share < OCCUPIED_SHARES[0]:
        say = f"Only {share}: surfaces may be full of holes; lower `occupancy.opacity_threshold`."
        findings.append(Finding("warning", "matter", say))
    elif report.occupied_share > OCCUPIED_SHARES[1]:
        say = f"{share}: haze fills the world; raise `occupancy.opacity_threshold` or lower `cleaning.max_scale`."
        findings.append(Finding("warning", "matter", say))
    else:
        findings.append(Finding("ok", "matter", f"{share}."))
    floaters = f"floaters make {report.floater_share:.1%} of the matter and were dropped"
    if report.floater_share > FLOATER_SHARE:
        say = f"{floaters.capitalize()}, which is much; look at the world from c, it may be a poor capture."
        findings.append(Finding("warning", "floaters", say))
    else:
        findings.append(Finding("ok", "floaters", f"{floaters.capitalize()}."))
    removed = sum(int(count) for note, count in world.notes.items() if note.startswith("removed_"))
    if removed > REMOVED_SHARE * (removed + report.gaussians):
        say = f"Cleaning removed {removed} of {removed + report.gaussians} Gaussians; check the scale, or `cleaning`."
        findings.append(Finding("warning", "cleaning", say))
    return findings


def _clear_height(grid: OccupancyGrid) -> float | None:
    """Median metres from the lowest to the highest free voxel of the columns that end below matter."""
    free = grid.state == FREE
    columns = free.any(axis=2)
    if not columns.any():
        return None
    top = free.shape[2] - 1 - free[:, :, ::-1].argmax(axis=2)  # (X, Y)
    above = np.arange(free.shape[2]) > top[:, :, None]
    covered = columns & ((grid.state == OCCUPIED) & above).any(axis=2)
    if covered.sum() < CEILING_SHARE * columns.sum():
        return None
    lowest = np.argwhere(free)[:, 2].min()
    return float((np.median(top[covered]) + 1 - lowest) * grid.resolution)


def _directions() -> NDArray[np.float64]:
    """`DIRECTIONS` unit vectors (M, 3), evenly over the sphere (a Fibonacci spiral)."""
    n = np.arange(DIRECTIONS)
    z = 1 - (2 * n + 1) / DIRECTIONS
    azimuth = n * np.pi * (3 - np.sqrt(5))
    radius = np.sqrt(1 - z * z)
    return np.stack([radius * np.cos(azimuth), radius * np.sin(azimuth), z], axis=1)
