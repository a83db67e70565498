"""`EmbeddedAnnotator`: objects from pixels and depth alone, with no network and no GPU.

Fuse the pixels of all views, take the building away, cut what is left by support and colour, join what belongs
together, fit boxes, cut and join those by what a small recogniser thinks of the pieces and the whole, name them by it
and, if its weights were fetched, a 2D detector. Each step is a file of this room.
"""

from collections.abc import Iterable, Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from flymirage_core.annotation.appearance import Observation
from flymirage_core.annotation.backs import with_backs
from flymirage_core.annotation.box_fitting import (
    MAX_CARRIED_GAP,
    MAX_WALL_GAP,
    FittedBox,
    fit_box,
    settle,
)
from flymirage_core.annotation.boxes import BoxMap, ObjectBox
from flymirage_core.annotation.carving import Detections, solid
from flymirage_core.annotation.colours import colour_step, shading_free, to_lab
from flymirage_core.annotation.crowns import with_crowns
from flymirage_core.annotation.evidence import Evidence
from flymirage_core.annotation.fused_points import Frame, FusedPoints, frames_of, fuse_points, square_only
from flymirage_core.annotation.fusion import yaw_iou
from flymirage_core.annotation.lying import floor_regions, lying_on, on_plates, rugs
from flymirage_core.annotation.merging import merge_parts
from flymirage_core.annotation.naming import ALONE, BESIDE_DETECTOR, Name, is_bare_front, is_believed, named
from flymirage_core.annotation.normals import surface_normals
from flymirage_core.annotation.open_air import find_open_air, sees_sky
from flymirage_core.annotation.parts import PartSet, Surface
from flymirage_core.annotation.picture_joins import join_pieces
from flymirage_core.annotation.picture_votes import Vote, look_at, visible_windows, votes
from flymirage_core.annotation.plausibility import MIN_OBJECT_POINTS, is_thing, without_contents
from flymirage_core.annotation.regrouping import regrouped
from flymirage_core.annotation.room_structure import RoomStructure, find_structure
from flymirage_core.annotation.rows import in_row
from flymirage_core.annotation.segmentation import (
    colour_parts,
    neighbour_edges,
    smoothed_colours,
)
from flymirage_core.annotation.supports import Face, level_faces, standing_things
from flymirage_core.annotation.tops import take_off_tops
from flymirage_core.annotation.wall_objects import ceiling_objects, wall_objects
from flymirage_core.annotation.yolox import PictureDetection, YoloxDetector
from flymirage_core.rendering.views import View
from flymirage_core.settings import AnnotationSettings

Float32 = NDArray[np.float32]

STRUCTURE_VOXEL: Final = 0.05
STRUCTURE_FRAMES: Final = 48
STRUCTURE_RANGE: Final = 12.0
"""Metres; the building is found from about so many views, without the pass's own distance limit."""
FARTHEST: Final = 12.0
"""Metres from its camera beyond which a pass without a limit of its own makes no boxes: pixels are too coarse there."""
NORMAL_RADIUS: Final = 3.0
"""Voxels within which points shape a normal."""
NORMAL_NEIGHBOURS: Final = 16
STRUCTURE_NEIGHBOURS: Final = 12
HALF_AN_OBJECT: Final = 0.5
"""Metres that an object may reach beyond its centre: so much farther than the limit its own pixels may lie."""
DUPLICATE_IOU: Final = 0.5
FULL_EVIDENCE: Final = 12
"""Supporting views from which more add nothing to the score."""


class EmbeddedAnnotator:
    """Implements `Annotator`. Deterministic: same views, same settings, same bytes."""

    version = "9"

    def __init__(self, settings: AnnotationSettings, detector: YoloxDetector | None = None) -> None:
        self.settings = settings
        self.detector = detector

    @property
    def name(self) -> str:
        return "embedded" if self.detector is None else f"embedded + {self.detector.name}"

    def annotate(self, views: Iterable[View], max_distance: float) -> BoxMap:
        """See `Annotator.annotate`.

        A detection here is an object as one view sees it, and is dropped if the object's centre lies beyond
        ``max_distance``; an object of which no detection is left is dropped. Pixels farther than that by more than
        `HALF_AN_OBJECT` are not looked at.
        """
        frames = frames_of(views)
        pictures = look_at(frames, self.detector) if self.detector is not None else []
        evidence = self.evidence(frames, max_distance)
        found = self.observations(evidence, pictures)
        things = [thing for thing, _ in found]
        said: list[Vote | None] = [None] * len(things)
        if pictures:
            windows = visible_windows([thing.points for thing in things], frames)
            said = votes([thing.box for thing in things], windows, pictures)
        names = named(things, said)
        doubt = BESIDE_DETECTOR if pictures else ALONE
        kept = [
            (t, s, n)
            for (t, s), n in zip(found, names, strict=True)
            if is_believed(t.box, n, s, doubt) and not is_bare_front(t, n, doubt)
        ]
        annotator = f"{self.name} {self.version}"
        return BoxMap(tuple(_object_box(k, evidence, *thing, annotator) for k, thing in enumerate(kept)))

    def evidence(self, frames: Sequence[Frame], max_distance: float) -> Evidence:
        """What the frames show of a place up to ``max_distance`` metres; see `annotate`."""
        structure, coarse = self.structure(frames)
        cloud = fuse_points(frames, self.settings.voxel, min(max_distance, FARTHEST) + HALF_AN_OBJECT)
        cloud = _solid_cloud(cloud, structure, frames)
        proposals = propose_boxes(cloud, structure, self.settings.voxel)
        return Evidence(cloud, coarse, structure, frames, max_distance, proposals)

    def observations(
        self, evidence: Evidence, pictures: Sequence[Sequence[PictureDetection]] = ()
    ) -> list[tuple[Observation, Detections]]:
        """The boxes of the objects, with what names are judged by and how each was seen; see `annotate`.

        ``pictures``: what a 2D detector found in each frame, if there is one.
        """
        structure, frames = evidence.structure, evidence.frames
        boxes = regrouped(evidence)
        boxes = with_crowns(with_backs(boxes, structure, frames), evidence.coarse, structure)
        if pictures:
            boxes = join_pieces(boxes, evidence.cloud, structure, frames, pictures)
        return [seen for seen in evidence.observed(boxes, [boxes] * len(boxes)) if seen is not None]

    def structure(self, frames: Sequence[Frame]) -> tuple[RoomStructure, Float32]:
        """The building, and the coarse cloud (N, 3) of views spread over the sequence that it was found in."""
        step = max(1, len(frames) // STRUCTURE_FRAMES)
        cloud = fuse_points(frames[::step], STRUCTURE_VOXEL, STRUCTURE_RANGE)
        square = fuse_points([square_only(frame) for frame in frames[::step]], STRUCTURE_VOXEL, STRUCTURE_RANGE)
        normals = surface_normals(cloud.points, cloud.to_camera, NORMAL_RADIUS * STRUCTURE_VOXEL, STRUCTURE_NEIGHBOURS)
        if sees_sky(frames[::step]):
            eyes = np.array([frame.camera.position for frame in frames])
            return find_open_air(cloud.points, normals, square.points, eyes), cloud.points
        return find_structure(cloud.points, normals, square.points, STRUCTURE_VOXEL), cloud.points


def propose_boxes(cloud: FusedPoints, structure: RoomStructure, voxel: float) -> list[FittedBox]:
    """Boxes of the objects in a cloud of solid points, floor to ceiling and then by place."""
    building = structure.contains(cloud.points)
    flat = building.copy()  # and what lies close before a wall and faces as it does
    objects = np.flatnonzero(~building)
    normals = surface_normals(cloud.points[objects], cloud.to_camera[objects], NORMAL_RADIUS * voxel, NORMAL_NEIGHBOURS)
    bulk = ~structure.is_wall_skin(cloud.points[objects], normals)
    flat[objects[~bulk]] = True
    objects = objects[bulk]
    normals = normals[bulk]
    edges = neighbour_edges(cloud.voxels[objects])
    faces = level_faces(cloud.points[objects], normals, edges, structure.floor, structure.yaw)
    parts = colour_parts(_surface(cloud[objects], normals, edges, faces, structure, voxel))
    merge_parts(parts)
    take_off_tops(parts)
    boxes = settle(_fitted(parts, objects, cloud, structure), structure, faces)
    boxes = [box for box in boxes if is_thing(box, structure)]
    colours = shading_free(to_lab(cloud.colours))
    regions = floor_regions(cloud.points, colours, structure)
    boxes = on_plates(boxes, cloud.points, colours, building, structure)
    boxes += wall_objects(cloud.points, colours, flat, structure) + ceiling_objects(cloud.points, colours, structure)
    boxes = without_contents(_without_duplicates(boxes), cloud.points)
    boxes += rugs(regions, boxes, structure) + lying_on(faces, boxes, cloud.points, colours, building)
    return sorted(boxes, key=lambda b: (round(b.bottom, 2), b.centre))


def _solid_cloud(cloud: FusedPoints, structure: RoomStructure, frames: Sequence[Frame]) -> FusedPoints:
    """The cloud without points that views see through; the building's own points are not tested."""
    kept = structure.contains(cloud.points)
    free = np.flatnonzero(~kept)
    kept[free] = solid(cloud.points[free], frames)
    return cloud[kept]


def _surface(
    cloud: FusedPoints,
    normals: Float32,
    edges: NDArray[np.intp],
    faces: Sequence[Face],
    structure: RoomStructure,
    voxel: float,
) -> Surface:
    things = standing_things(cloud.points, edges, faces)
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
        fit_box(
            cloud.points,
            cloud.to_camera,
            objects[part.members[piece]],
            structure,
            MAX_CARRIED_GAP if part.thing else MAX_WALL_GAP,
        )
        for _, part in sorted(parts.parts.items())
        for piece in in_row(part.points, structure.yaw)
        if len(piece) >= MIN_OBJECT_POINTS
    ]


def _without_duplicates(boxes: Sequence[FittedBox]) -> list[FittedBox]:
    """Of boxes that overlap by `DUPLICATE_IOU`, the one made from the most points."""
    kept: list[FittedBox] = []
    for box in sorted(boxes, key=lambda b: -len(b.members)):
        if all(yaw_iou(box, other) < DUPLICATE_IOU for other in kept):
            kept.append(box)
    return kept


def _object_box(
    number: int, evidence: Evidence, thing: Observation, found: Detections, name: Name, annotator: str
) -> ObjectBox:
    box = thing.box
    return ObjectBox(
        object_id=number,
        label=name.noun,
        centre=box.centre,
        size=box.size,
        yaw=box.yaw,
        score=float((name.score + min(1.0, found.views / FULL_EVIDENCE)) / 2),
        label_source=name.source,
        colour=evidence.colour_of(box),
        material=name.material,
        supporting_frames=found.views,
        nearest_camera_distance=found.nearest,
        annotator=annotator,
        label_score=name.score,
    )
