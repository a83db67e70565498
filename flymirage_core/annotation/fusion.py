"""Boxes compared and fused: yaw IoU, the distance-based pruning of single detections, clusters fused to one box each.

A detector that answers view by view (Boxer) goes through `prune_by_distance` and `fuse_detections`; the embedded
annotator fuses evidence before it makes boxes and uses the IoU only.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numba
import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from flymirage_core.annotation.boxes import BoxMap, ObjectBox
from flymirage_core.settings import AnnotationSettings

Vector3 = tuple[float, float, float]


class GravityAlignedBox(Protocol):
    """Anything with a centre, full sizes along its own axes, and a yaw: world frame, metres, radians."""

    @property
    def centre(self) -> Vector3: ...

    @property
    def size(self) -> Vector3: ...

    @property
    def yaw(self) -> float: ...


@dataclass(frozen=True)
class Detection:
    """One object as one view saw it. World frame, metres, radians."""

    label: str
    centre: Vector3
    size: Vector3
    yaw: float
    score: float  # 0..1
    view: int  # index of the view
    camera_position: Vector3  # its optical centre


def footprint_corners(box: GravityAlignedBox) -> NDArray[np.float64]:
    """(4, 2) corners of the box's plan in world xy, counter-clockwise."""
    c, s = np.cos(box.yaw), np.sin(box.yaw)
    half = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * np.asarray(box.size[:2]) / 2  # (4, 2)
    return np.asarray(half @ np.array([[c, s], [-s, c]]) + box.centre[:2], np.float64)


def plan_gap(a: GravityAlignedBox, b: GravityAlignedBox) -> float:
    """Metres between the circles round two plans, which are apart if it is positive."""
    reach = (math.hypot(*a.size[:2]) + math.hypot(*b.size[:2])) / 2
    return math.hypot(a.centre[0] - b.centre[0], a.centre[1] - b.centre[1]) - reach


def footprint_overlap(a: GravityAlignedBox, b: GravityAlignedBox) -> float:
    """Square metres that the two plans share."""
    if plan_gap(a, b) >= 0:
        return 0.0
    return convex_overlap(footprint_corners(a), footprint_corners(b))


def convex_overlap(a: NDArray[np.float64], b: NDArray[np.float64]) -> float:
    """Area shared by two convex polygons (A, 2) and (B, 2), counter-clockwise, of at most eight corners together."""
    return float(_convex_overlap(a, b))


def yaw_iou(a: GravityAlignedBox, b: GravityAlignedBox) -> float:
    """Intersection over union of two gravity-aligned boxes, exact, 0 to 1."""
    bottom = max(a.centre[2] - a.size[2] / 2, b.centre[2] - b.size[2] / 2)
    top = min(a.centre[2] + a.size[2] / 2, b.centre[2] + b.size[2] / 2)
    if top <= bottom or plan_gap(a, b) >= 0:
        return 0.0
    shared = footprint_overlap(a, b) * (top - bottom)
    union = float(np.prod(a.size) + np.prod(b.size)) - shared
    return min(shared / union, 1.0) if union > 0 else 0.0


def prune_by_distance(detections: Sequence[Detection], max_distance: float) -> list[Detection]:
    """The paper's pruning (section III-B): detections whose centre is within ``max_distance`` of their own camera."""
    return [d for d in detections if np.linalg.norm(np.subtract(d.centre, d.camera_position)) <= max_distance]


def fuse_detections(
    detections: Sequence[Detection], settings: AnnotationSettings, annotator: str, label_source: str
) -> BoxMap:
    """The global box map: detections linked by yaw IoU >= ``fusion_iou`` become one box, transitively.

    Centre and size are means weighted by score, after turning boxes whose axes are swapped by 90 degrees; yaw is the
    weighted mean of period pi; the label is the one with the largest sum of scores. Clusters that fewer than
    ``min_detections`` views saw are dropped. Ids follow the first detection of each cluster.
    """
    clusters = _clusters(detections, settings.fusion_iou)
    objects = [[detections[i] for i in members] for members in clusters]
    seen_often = [members for members in objects if len({d.view for d in members}) >= settings.min_detections]
    return BoxMap(tuple(_fused(i, members, annotator, label_source) for i, members in enumerate(seen_often)))


def _clusters(detections: Sequence[Detection], min_iou: float) -> list[list[int]]:
    """Indices of the detections of each connected component, components in the order of their first member."""
    if not detections:
        return []
    centres = np.array([d.centre for d in detections])  # (N, 3)
    radii = np.array([np.linalg.norm(d.size) / 2 for d in detections])  # (N,)
    links: list[tuple[int, int]] = []
    for i in range(len(detections)):
        gaps = np.linalg.norm(centres[i + 1 :] - centres[i], axis=1) - radii[i + 1 :] - radii[i]
        links += [
            (i, j)
            for j in (np.flatnonzero(gaps < 0) + i + 1).tolist()
            if yaw_iou(detections[i], detections[j]) >= min_iou
        ]
    rows, columns = np.array(links, int).reshape(-1, 2).T
    graph = coo_matrix((np.ones(len(rows)), (rows, columns)), shape=(len(detections), len(detections)))
    count, component = connected_components(graph, directed=False)
    clusters = [[int(i) for i in np.flatnonzero(component == k)] for k in range(count)]
    return sorted(clusters, key=lambda members: members[0])


def _fused(object_id: int, members: Sequence[Detection], annotator: str, label_source: str) -> ObjectBox:
    """The one box that a cluster becomes."""
    best = max(members, key=lambda d: d.score)
    weights = np.array([d.score for d in members])
    weights = weights / weights.sum() if weights.sum() > 0 else np.full(len(members), 1 / len(members))  # (N,)
    turns = [_quarter_turns(d.yaw - best.yaw) for d in members]
    yaws = np.array([d.yaw - t * np.pi / 2 for d, t in zip(members, turns, strict=True)])  # (N,)
    sizes = np.array([_turned(d.size, t) for d, t in zip(members, turns, strict=True)])  # (N, 3)
    distances = [np.linalg.norm(np.subtract(d.centre, d.camera_position)) for d in members]
    return ObjectBox(
        object_id=object_id,
        label=_most_voted(members),
        centre=_vector3(weights @ np.array([d.centre for d in members])),
        size=_vector3(weights @ sizes),
        yaw=float(np.angle(np.exp(2j * yaws) @ weights) / 2),
        score=float(np.mean([d.score for d in members])),
        label_source=label_source,
        colour="",
        material="",
        supporting_frames=len({d.view for d in members}),
        nearest_camera_distance=float(min(distances)),
        annotator=annotator,
    )


def _most_voted(members: Sequence[Detection]) -> str:
    """The label with the largest sum of scores; of equals the alphabetically first."""
    votes: dict[str, float] = {}
    for d in members:
        votes[d.label] = votes.get(d.label, 0.0) + d.score
    return max(sorted(votes), key=lambda label: votes[label])


def _vector3(values: NDArray[np.float64]) -> Vector3:
    x, y, z = (float(v) for v in values)
    return x, y, z


def _turned(size: Vector3, quarter_turns: int) -> Vector3:
    return size if quarter_turns % 2 == 0 else (size[1], size[0], size[2])


def _quarter_turns(angle: float) -> int:
    """How many quarter turns are nearest to ``angle``."""
    return round(angle / (np.pi / 2))


@numba.njit(cache=True, nogil=True)
def _convex_overlap(subject: NDArray[np.float64], clip: NDArray[np.float64]) -> float:
    """Area shared by two convex polygons (A, 2) and (B, 2), counter-clockwise (Sutherland & Hodgman 1974).

    OpenCV's intersectConvexConvex is not used: rectangles that share a part of an edge, as boxes in one room do, get
    areas that are wrong by up to their whole size.
    """
    polygon = np.empty((16, 2))
    clipped = np.empty((16, 2))
    count = len(subject)
    polygon[:count] = subject
    for edge in range(len(clip)):
        ax, ay = clip[edge]
        dx, dy = clip[(edge + 1) % len(clip), 0] - ax, clip[(edge + 1) % len(clip), 1] - ay
        kept = 0
        for k in range(count):
            p, q = polygon[k], polygon[(k + 1) % count]
            side_p = dx * (p[1] - ay) - dy * (p[0] - ax)
            side_q = dx * (q[1] - ay) - dy * (q[0] - ax)
            if side_p >= 0:
                clipped[kept] = p
                kept += 1
            if (side_p > 0 and side_q < 0) or (side_p < 0 and side_q > 0):
                clipped[kept] = p + (q - p) * (side_p / (side_p - side_q))
                kept += 1
        polygon, clipped, count = clipped, polygon, kept
    area = 0.0
    for k in range(count):
        p, q = polygon[k] - polygon[0], polygon[(k + 1) % count] - polygon[0]
        area += 0.5 * (p[0] * q[1] - p[1] * q[0])
    return max(area, 0.0)
