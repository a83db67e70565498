"""`EmbeddedAnnotator`: objects from pixels and depth alone, with no network, no GPU and no learned weights.

Fuse the pixels of all views, take the building away, cut what is left by support and colour, join what belongs
together, fit boxes, name them. Each step is a file of this room.
"""

from collections.abc import Iterable, Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from flymirage_core.annotation.box_fitting import ON_FLOOR, FittedBox, fit_box, settle
from flymirage_core.annotation.boxes import BoxMap, ObjectBox
from flymirage_core.annotation.carving import Detections, detections, solid
from flymirage_core.annotation.colours import colour_name, colour_step, shading_free, to_lab
from flymirage_core.annotation.fused_points import Frame, FusedPoints, frames_of, fuse_points, square_only
from flymirage_core.annotation.fusion import yaw_iou
from flymirage_core.annotation.labels import Support, is_plant, name_box, name_plant
from flymirage_core.annotation.merging import merge_parts
from flymirage_core.annotation.normals import surface_normals, surface_variation
from flymirage_core.annotation.parts import PartSet, Surface
from flymirage_core.annotation.plausibility import MIN_OBJECT_POINTS, is_thing, without_contents
from flymirage_core.annotation.room_structure import RoomStructure, find_structure
from flymirage_core.annotation.segmentation import (
    colour_parts,
    neighbour_edges,
    smoothed_colours,
)
from flymirage_core.annotation.supports import standing_things
from flymirage_core.annotation.wall_objects import wall_objects
from flymirage_core.rendering.views import View
from flymirage_core.settings import AnnotationSettings

Float32 = NDArray[np.float32]

STRUCTURE_VOXEL: Final = 0.05
STRUCTURE_FRAMES: Final = 48
STRUCTURE_RANGE: Final = 12.0
"""Metres; the building is found from about so many views, without the pass's own distance limit."""
NORMAL_RADIUS: Final = 3.0
"""Voxels within which points shape a normal."""
NORMAL_NEIGHBOURS: Final = 16
VARIATION_RADIUS: Final = 0.09
"""Metres within which roughness is judged."""
STRUCTURE_NEIGHBOURS: Final = 12
HALF_AN_OBJECT: Final = 0.5
"""Metres that an object may reach beyond its centre: so much farther than the limit its own pixels may lie."""
RESTING: Final = 0.1
"""Metres between a thing and what carries it."""
AT_WALL: Final = 0.15
DUPLICATE_IOU: Final = 0.5
FULL_EVIDENCE: Final = 12
"""Supporting views from which more add nothing to the score."""


class EmbeddedAnnotator:
    """Implements `Annotator`. Deterministic: same views, same settings, same bytes."""

    name = "embedded"
    version = "1"

    def __init__(self, settings: AnnotationSettings) -> None:
        self.settings = settings

    def annotate(self, views: Iterable[View], max_distance: float) -> BoxMap:
        """See `Annotator.annotate`.

        A detection here is an object as one view sees it, and is dropped if the object's centre lies beyond
        ``max_distance``; an object of which no detection is left is dropped. Pixels farther than that by more than
        `HALF_AN_OBJECT` are not looked at.
        """
        frames = frames_of(views)
        structure = self.structure(frames)
        cloud = fuse_points(frames, self.settings.voxel, max_distance + HALF_AN_OBJECT)
        cloud = _solid_cloud(cloud, structure, frames)
        boxes = propose_boxes(cloud, structure, self.settings.voxel)
        return self._described(boxes, cloud, structure, frames, max_distance)

    def structure(self, frames: Sequence[Frame]) -> RoomStructure:
        """The building, from a coarse cloud of views spread over the sequence."""
        step = max(1, len(frames) // STRUCTURE_FRAMES)
        cloud = fuse_points(frames[::step], STRUCTURE_VOXEL, STRUCTURE_RANGE)
        square = fuse_points([square_only(frame) for frame in frames[::step]], STRUCTURE_VOXEL, STRUCTURE_RANGE)
        normals = surface_normals(cloud.points, cloud.to_camera, NORMAL_RADIUS * STRUCTURE_VOXEL, STRUCTURE_NEIGHBOURS)
        return find_structure(cloud.points, normals, square.points, STRUCTURE_VOXEL)

    def _described(
        self,
        boxes: Sequence[FittedBox],
        cloud: FusedPoints,
        structure: RoomStructure,
        frames: Sequence[Frame],
        max_distance: float,
    ) -> BoxMap:
        support = detections(cloud.points, boxes, frames, max_distance)
        seen = [(box, found) for box, found in zip(boxes, support, strict=True) if found.views]
        annotator = f"{self.name} {self.version}"
        rivals = [box for box, _ in seen]
        described = [
            _object_box(k, box, rivals, cloud, structure, found, annotator) for k, (box, found) in enumerate(seen)
        ]
        return BoxMap(tuple(described))


def propose_boxes(cloud: FusedPoints, structure: RoomStructure, voxel: float) -> list[FittedBox]:
    """Boxes of the objects in a cloud of solid points, floor to ceiling and then by place."""
    objects = np.flatnonzero(~structure.contains(cloud.points))
    normals = surface_normals(cloud.points[objects], cloud.to_camera[objects], NORMAL_RADIUS * voxel, NORMAL_NEIGHBOURS)
    bulk = ~structure.is_wall_skin(cloud.points[objects], normals)
    objects = objects[bulk]
    surface = _surface(cloud[objects], normals[bulk], structure, voxel)
    parts = colour_parts(surface)
    merge_parts(parts)
    boxes = settle(_fitted(parts, objects, cloud, structure), structure)
    boxes = [box for box in boxes if is_thing(box, structure)]
    boxes += wall_objects(cloud.points, shading_free(to_lab(cloud.colours)), structure)
    boxes = without_contents(_without_duplicates(boxes), cloud.points)
    return sorted(boxes, key=lambda b: (round(b.bottom, 2), b.centre))


def _solid_cloud(cloud: FusedPoints, structure: RoomStructure, frames: Sequence[Frame]) -> FusedPoints:
    """The cloud without points that views see through; the building's own points are not tested."""
    kept = structure.contains(cloud.points)
    free = np.flatnonzero(~kept)
    kept[free] = solid(cloud.points[free], frames)
    return cloud[kept]


def _surface(cloud: FusedPoints, normals: Float32, structure: RoomStructure, voxel: float) -> Surface:
    edges = neighbour_edges(cloud.voxels)
    things = standing_things(cloud.points, normals, edges, structure.floor, structure.yaw)
    edges = edges[things[edges[:, 0]] == things[edges[:, 1]]]
    colours = smoothed_colours(shading_free(to_lab(cloud.colours)), edges) if len(cloud) else cloud.colours
    return Surface(
        points=cloud.points,
        colours=colours,
        normals=normals,
        things=things,
        edges=edges,
        steps=colour_step(colours[edges[:, 0]], colours[edges[:, 1]]),
        voxel=voxel,
        floor=structure.floor,
        yaw=structure.yaw,
    )


def _fitted(parts: PartSet, objects: NDArray[np.intp], cloud: FusedPoints, structure: RoomStructure) -> list[FittedBox]:
    return [
        fit_box(cloud.points, cloud.to_camera, objects[parts.parts[k].members], structure)
        for k in sorted(parts.parts)
        if len(parts.parts[k]) >= MIN_OBJECT_POINTS
    ]


def _without_duplicates(boxes: Sequence[FittedBox]) -> list[FittedBox]:
    """Of boxes that overlap by `DUPLICATE_IOU`, the one made from the most points."""
    kept: list[FittedBox] = []
    for box in sorted(boxes, key=lambda b: -len(b.members)):
        if all(yaw_iou(box, other) < DUPLICATE_IOU for other in kept):
            kept.append(box)
    return kept


def _object_box(
    number: int,
    box: FittedBox,
    boxes: Sequence[FittedBox],
    cloud: FusedPoints,
    structure: RoomStructure,
    found: Detections,
    annotator: str,
) -> ObjectBox:
    lab = to_lab(cloud.colours[box.members])  # (M, 3)
    support = _support_of(box, boxes, structure)
    variation = surface_variation(cloud.points[box.members], VARIATION_RADIUS, NORMAL_NEIGHBOURS)
    plant = not box.on_wall and is_plant(lab, variation)
    label = name_plant(box.size, support) if plant else name_box(box.size, support)
    return ObjectBox(
        object_id=number,
        label=label.noun,
        centre=box.centre,
        size=box.size,
        yaw=box.yaw,
        score=float((label.fit + min(1.0, found.views / FULL_EVIDENCE)) / 2),
        label_source="colour and roughness" if plant else "size_prior",
        colour=colour_name(np.median(lab, axis=0)),
        material="",
        supporting_frames=found.views,
        nearest_camera_distance=found.nearest,
        annotator=annotator,
    )


def _support_of(box: FittedBox, boxes: Sequence[FittedBox], structure: RoomStructure) -> Support:
    """What a box rests on, judged from its place."""
    if box.on_wall:
        return Support.WALL
    if box.hanging:
        return Support.CEILING
    if box.bottom - structure.floor < ON_FLOOR:
        return Support.FLOOR
    carried = any(other is not box and abs(other.top - box.bottom) < RESTING and _over(box, other) for other in boxes)
    near_wall = any(
        abs(float(np.dot(w.normal, box.centre[:2])) - w.offset) - max(box.size[:2]) / 2 < AT_WALL
        for w in structure.walls
    )
    return Support.WALL if near_wall and not carried else Support.SURFACE


def _over(box: FittedBox, other: FittedBox) -> bool:
    return bool(
        np.hypot(box.centre[0] - other.centre[0], box.centre[1] - other.centre[1]) < max(other.size[:2]) / 2 + RESTING
    )
