"""The catalogue: every kind fills exactly its box, stands on the ground, is made of parts, and is the same again."""

import json
from importlib import resources

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flymirage_core.worldgen.catalogue import KINDS
from flymirage_core.worldgen.forms import cable, mirrored, pipe, sweep, tapered
from flymirage_core.worldgen.kinds import fitted
from flymirage_core.worldgen.materials import albedo, material_named
from flymirage_core.worldgen.meshes import corners_of, mesh_of, textured_mesh
from flymirage_core.worldgen.parts import Finish, box, cylinder, ellipsoid, paint
from flymirage_core.worldgen.pictured import PICTURES, lettering
from flymirage_core.worldgen.surfaces import Surfels, block_faces, surfels_of
from flymirage_core.worldgen.textures import TEXTURES

NOUNS = sorted(KINDS)
DISTORTED = 1.6
"""`fitted` may stretch a thing along one side this much more than along the others: beyond, it would look wrong."""


def finish_of(noun: str, seed: int, style: int = 0) -> Finish:
    colour, material = KINDS[noun].usual
    return Finish(material_named(material, colour, seed % 97), paint("walnut brown", "wood"), seed, style)


def bounds_of(parts):
    mesh = mesh_of(parts)
    return np.array(mesh.bounds)


@given(st.sampled_from(NOUNS), st.integers(0, 2**31 - 1), st.integers(0, 2**31 - 1), st.floats(2.6, 6.0))
@settings(max_examples=60)
def test_a_thing_fills_its_box_exactly_and_stands_on_the_ground(noun, seed, style, height):
    kind = KINDS[noun]
    size = kind.size(np.random.default_rng(seed), height)
    low, high = bounds_of(kind.build(size, finish_of(noun, seed, style)))
    assert low == pytest.approx([-size[0] / 2, -size[1] / 2, 0.0], abs=1e-6)
    assert high == pytest.approx([size[0] / 2, size[1] / 2, size[2]], abs=1e-6)


@pytest.mark.parametrize("noun", NOUNS)
def test_every_kind_has_parts_of_the_right_proportions_and_a_mesh_and_splats_that_agree(noun):
    kind = KINDS[noun]
    size = kind.size(np.random.default_rng(7), 3.0)
    parts = kind.builder(size, finish_of(noun, 11, 5))
    assert len(parts) >= 2 or noun in ("ball", "boulder", "tall grass")
    ends = np.array([(c.min(axis=0), c.max(axis=0)) for c in map(corners_of, parts)])
    ratio = (ends[:, 1].max(axis=0) - ends[:, 0].min(axis=0)) / np.array(size)
    proportions = ratio / np.exp(np.log(ratio).mean())
    assert (np.abs(np.log(proportions)) < np.log(DISTORTED)).all(), proportions
    mesh = textured_mesh(fitted(parts, size))
    surfels = Surfels.joined([surfels_of(p, max(size) / 25) for p in fitted(parts, size)])
    assert ((surfels.albedo >= 0) & (surfels.albedo <= 0.95)).all()
    assert np.linalg.norm(surfels.normals, axis=1) == pytest.approx(1.0, abs=1e-6)
    reach = np.linalg.norm(surfels.along, axis=1) + np.linalg.norm(surfels.across, axis=1)  # bent pieces cut corners
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    assert (surfels.points > low - reach[:, None] / 2 - 1e-6).all()
    assert (surfels.points < high + reach[:, None] / 2 + 1e-6).all()
    assert len(mesh.faces) < 60_000


@given(st.sampled_from(NOUNS), st.integers(0, 2**31 - 1))
@settings(max_examples=15)
def test_the_same_noun_size_finish_and_seed_give_the_same_parts(noun, seed):
    size = KINDS[noun].size(np.random.default_rng(seed), 3.0)
    one, two = (mesh_of(KINDS[noun].build(size, finish_of(noun, seed, seed))) for _ in range(2))
    assert one.vertices.tobytes() == two.vertices.tobytes()
    assert one.visual.face_colors.tobytes() == two.visual.face_colors.tobytes()


def test_two_chairs_of_one_scene_are_alike_and_scenes_differ():
    kind, size = KINDS["bar stool"], (0.4, 0.4, 1.0)
    shapes = [mesh_of(kind.build(size, finish_of("bar stool", seed, style))) for seed, style in ((1, 4), (2, 4))]
    assert shapes[0].vertices.tobytes() == shapes[1].vertices.tobytes()
    counts = {len(kind.build(size, finish_of("bar stool", 1, style))) for style in range(8)}
    assert len(counts) > 1


def test_there_are_far_more_than_150_kinds_and_most_have_their_own_builder():
    assert len(KINDS) >= 300
    assert len({kind.builder for kind in KINDS.values()}) >= 250


def test_every_noun_that_the_offline_writer_uses_can_be_built():
    nouns = json.loads((resources.files("flymirage_core.scene") / "nouns.json").read_text())["nouns"]
    assert [n for n in nouns if n not in KINDS] == []


@given(st.lists(st.floats(0.2, 3.0), min_size=3, max_size=3), st.floats(-3, 3))
@settings(max_examples=20)
def test_fitting_keeps_normals_square_to_their_surface(size, yaw):
    ball = ellipsoid(paint("red"), (0.5, 0.3, 0.8), (0.4, -1.0, 2.0))
    surfels = surfels_of(fitted([ball], tuple(size))[0], 0.05)
    across = np.abs((surfels.normals * surfels.along).sum(axis=1)) / np.linalg.norm(surfels.along, axis=1)
    assert np.nanmax(across) < 1e-6
    outward = (surfels.normals * (surfels.points - [0, 0, size[2] / 2])).sum(axis=1)
    assert (outward > 0).mean() > 0.99


@pytest.mark.parametrize(
    ("part", "volume"),
    [
        (box(paint("red"), (1.0, 0.5, 0.4)), 0.2),
        (cylinder(paint("red"), 0.5, 2.0), np.pi * 0.5),
        (pipe(paint("red"), [(0, 0, 0), (0, 0, 1), (1, 0, 1)], 0.1, 0.3), np.pi * 0.01 * 1.9),
        (tapered(paint("red"), [(1.0, 1.0, 0.0), (0.5, 0.5, 1.0)], radius=0.0), 7 / 12),
        (sweep(paint("red"), [(-1, -1), (1, -1), (1, 1), (-1, 1)], [(0, 0, 0), (0, 3, 0)]), 12.0),
        (cable(paint("red"), (0, 0, 1), (2, 0, 1), 0.2, 0.05), np.pi * 0.0025 * 2.05),
        (mirrored(cylinder(paint("red"), 0.5, 2.0, (2.0, 0, 0)))[1], np.pi * 0.5),
    ],
)
def test_solid_forms_enclose_their_volume_with_their_fronts_outside(part, volume):
    mesh = mesh_of([part])
    assert mesh.volume == pytest.approx(volume, rel=0.12)
    surfels = surfels_of(part, 0.04)
    assert surfels.areas.sum() == pytest.approx(mesh.area, rel=0.06)
    flux = (surfels.points * surfels.normals).sum(axis=1) @ surfels.areas / 3  # the divergence theorem
    assert flux == pytest.approx(volume, rel=0.15)


def test_the_faces_of_a_box_look_outwards_and_stand_upright():
    for corner, a, b in block_faces(np.array([1.0, 2.0, 3.0])):
        middle = corner + (a + b) / 2
        assert np.cross(a, b) @ middle > 0
        assert b[2] > 0 or abs(middle[2]) == pytest.approx(3.0)


@pytest.mark.parametrize("texture", sorted({*TEXTURES, *PICTURES}))
def test_textures_vary_within_the_range_of_real_surfaces(texture):
    rng = np.random.default_rng(0)
    points = rng.uniform(0, 2, (4000, 3))
    material = paint("sand", texture)
    colours = albedo(material, points[:, :2], (2.0, 2.0), points)
    assert ((colours >= 0) & (colours <= 0.95)).all()
    assert colours.std(axis=0).max() > 0.002 or texture == "text"


@given(st.text("ABCDEFGHIJKLMNOPQRSTUVWXYZ 0123456789", min_size=1, max_size=14), st.floats(0.5, 8.0))
@settings(max_examples=20)
def test_lettering_has_ink_inside_of_its_sign_and_a_margin(words, aspect):
    raster = lettering(words, round(aspect, 3))
    assert raster[:, :1].max() == raster[:, -1:].max() == 0
    if words.strip():
        assert 0.002 < raster.mean() < 0.7


def test_the_colour_of_a_mesh_at_a_point_is_the_material_there():
    parts = KINDS["dining table"].build((1.8, 0.9, 0.75), finish_of("dining table", 5))
    mesh = textured_mesh(parts)
    faces = np.arange(len(mesh.faces))
    assert mesh.albedo(faces, np.tile([0.2, 0.3, 0.5], (len(faces), 1))).shape == (len(faces), 3)
    assert mesh.trimesh().visual.face_colors.shape == (len(faces), 4)
