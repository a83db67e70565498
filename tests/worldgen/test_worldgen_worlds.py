"""Worlds: closed, lit, opaque, repeatable, and shaped as the truth says."""

import cv2
import numpy as np
import pytest
from generated_places import DAY, flat, street, tunnel

from flymirage_core.rendering.camera import Camera, Intrinsics, look_along
from flymirage_core.rendering.cpu import CpuRasterizer
from flymirage_core.scene.writer import OfflineSceneWriter
from flymirage_core.settings import GenerationSettings
from flymirage_core.splats.collider import from_glb
from flymirage_core.worldgen.assembly import assemble, build_truth
from flymirage_core.worldgen.catalogue import KINDS, kind_of
from flymirage_core.worldgen.colours import NAMED
from flymirage_core.worldgen.lighting import Illumination, Lamps, bake, direct_light, display, solid_faces
from flymirage_core.worldgen.meshes import textured_mesh
from flymirage_core.worldgen.model import OfflinePainter, OfflineWorldModel, _built
from flymirage_core.worldgen.parts import Finish, box, paint
from flymirage_core.worldgen.place import place_for
from flymirage_core.worldgen.rays import RayCaster
from flymirage_core.worldgen.reference import ReferenceTracer
from flymirage_core.worldgen.sampling import OVERLAP, lit_world
from flymirage_core.worldgen.sky import Sky, Sun, sky_of
from flymirage_core.worldgen.surfaces import Part, Sheet, Surfels, cells, surfels_of

SMALL = GenerationSettings(gaussians=60_000)


@pytest.fixture(scope="module")
def description():
    return flat()


@pytest.fixture(scope="module")
def world(description):
    return OfflineWorldModel(SMALL).build(description)


def test_the_same_key_gives_the_same_bytes():
    few = GenerationSettings(gaussians=20_000)
    one = OfflineWorldModel(few).build(tunnel())
    _built.cache_clear()
    again = OfflineWorldModel(few).build(tunnel())
    for name in ("means", "quaternions", "scales", "opacities", "sh"):
        assert getattr(one.cloud, name).tobytes() == getattr(again.cloud, name).tobytes(), name
    assert one.collider == again.collider
    assert one.panorama.tobytes() == again.panorama.tobytes()


def test_the_world_has_about_as_many_gaussians_as_asked_for(world):
    assert 0.8 * 60_000 < len(world.cloud) < 1.2 * 60_000


def test_from_c_every_direction_ends_in_the_room(description, world):
    intrinsics = Intrinsics.from_horizontal_fov(64, 64, np.pi / 2)
    directions = [*np.eye(3), *-np.eye(3)]
    cameras = [Camera(intrinsics, look_along(world.centre, d)) for d in directions]
    x, y, z = build_truth(description).dimensions
    for picture in CpuRasterizer().render(world.cloud, cameras):
        assert picture.alpha.min() > 0.8
        u, v = np.meshgrid((np.arange(64) + 0.5) / 32 - 1, (np.arange(64) + 0.5) / 32 - 1)
        distance = picture.depth * np.sqrt(1 + u * u + v * v)
        assert distance.min() > 0.95  # and nothing is near c
        assert distance.max() < np.linalg.norm([x, y, z])


def test_splats_lie_inside_of_the_room_and_are_flat(description, world):
    low, high = place_for(description).bounds
    means = world.cloud.means
    assert (means[:, :2] >= low[:2] - 0.15).all()  # panes lie behind the walls' faces
    assert (means[:, :2] <= high[:2] + 0.15).all()
    assert means[:, 2].min() > -0.11  # floor and ceiling are backed
    assert means[:, 2].max() < high[2] + 0.11
    ordered = np.sort(world.cloud.scales, axis=1)
    assert np.median(ordered[:, 0] / ordered[:, 1]) < 0.2


def test_splats_stand_where_the_truth_says_that_objects_are(description, world):
    for o in build_truth(description).objects:
        local = world.cloud.means - np.array(o.centre, np.float32)
        local[:, :2] = local[:, :2] @ o.axes.T
        inside = (np.abs(local) <= np.array(o.size) / 2 + 0.01).all(axis=1)
        assert inside.sum() > 8, o.noun


def test_the_collider_is_the_same_place_as_the_splats(description, world):
    vertices, faces = from_glb(world.collider)
    distance = (
        RayCaster(vertices[faces]).hits(np.tile(world.centre, (6, 1)), np.concatenate([np.eye(3), -np.eye(3)])).distance
    )
    intrinsics = Intrinsics.from_horizontal_fov(9, 9, 0.02)
    cameras = [Camera(intrinsics, look_along(world.centre, d)) for d in (*np.eye(3), *-np.eye(3))]
    seen = [v.depth[4, 4] for v in CpuRasterizer().render(world.cloud, cameras)]
    np.testing.assert_allclose(distance, seen, atol=0.1)


def test_no_view_in_the_open_air_is_a_hole():
    """Beyond the place there are hills, houses and a sky."""
    lit_place = lit_world(assemble(street()), 40_000)
    centre = np.array(build_truth(street()).centre)
    intrinsics = Intrinsics.from_horizontal_fov(64, 64, np.pi / 2)
    cameras = [Camera(intrinsics, look_along(centre, d)) for d in (*np.eye(3), *-np.eye(3))]
    holes = [float((v.alpha < 0.5).mean()) for v in CpuRasterizer().render(lit_place.cloud, cameras)]
    assert max(holes) < 0.002


def test_splats_look_like_the_ray_traced_mesh():
    lit_place = lit_world(assemble(flat()), 120_000)
    centre = np.array(build_truth(flat()).centre)
    camera = Camera(Intrinsics.from_horizontal_fov(160, 120, 1.4), look_along(centre, [1.0, 0.4, -0.1]))
    reference = ReferenceTracer(lit_place).render(camera, 2)
    view = next(iter(CpuRasterizer().render(lit_place.cloud, [camera])))
    assert -10 * np.log10(((reference - view.rgb / 255.0) ** 2).mean()) > 22


def test_the_panorama_is_upright_and_looks_along_y_in_its_middle(world):
    height, width, _ = world.panorama.shape
    assert width == 2 * height
    ahead = Camera(Intrinsics.from_horizontal_fov(64, 64, 0.5), look_along(world.centre, [0, 1, 0]))
    view = next(iter(CpuRasterizer().render(world.cloud, [ahead]))).rgb.astype(float)
    half = round(0.25 / (2 * np.pi) * width)
    middle = world.panorama[height // 2 - half : height // 2 + half, width // 2 - half : width // 2 + half]
    small = cv2.resize(middle, (64, 64), interpolation=cv2.INTER_AREA).astype(float)
    assert np.abs(small - view).mean() < 12


def test_light_falls_unevenly_but_nothing_is_black_or_blown_out(world):
    colours = world.cloud.sh[:, 0] * 0.28209479 + 0.5
    grey = colours.mean(axis=1)
    assert 0.2 < np.median(grey) < 0.75
    assert grey.std() > 0.1
    assert (grey > 0.99).mean() < 0.08
    assert (grey < 0.02).mean() < 0.12  # undersides and insides of furniture see no light


def test_the_painter_shows_the_world_that_the_model_builds(description):
    picture = OfflinePainter(CpuRasterizer(), SMALL).paint(description)
    assert picture.rgb.shape == (640, 960, 3)
    assert picture.rgb.std() > 20
    assert picture.painter.startswith("offline")


@pytest.mark.parametrize("noun", sorted(KINDS))
def test_the_surfels_of_every_kind_keep_to_its_size_but_for_half_their_own(noun):
    kind = kind_of(noun)
    size = kind.size(np.random.default_rng(3), 3.0)
    parts = kind.build(size, Finish(paint("rust", "wood"), paint("charcoal"), 2))
    surfels = Surfels.joined([surfels_of(p, 0.05) for p in parts])
    reach = (np.abs(surfels.along) + np.abs(surfels.across)) / 2
    low, high = (surfels.points - reach).min(axis=0), (surfels.points + reach).max(axis=0)
    assert np.isfinite(surfels.points).all()
    assert (low >= np.array([-size[0] / 2, -size[1] / 2, 0.0]) - 0.035).all(), low
    assert (high <= np.array([size[0] / 2, size[1] / 2, size[2]]) + 0.035).all(), high
    assert (high - low >= np.array(size) * 0.78 - 0.03).all(), (high - low, size)


def test_words_that_are_not_in_the_catalogue_become_something_near():
    assert kind_of("antique oak desk") is KINDS["desk"]
    assert kind_of("reading lamp") is KINDS["floor lamp"]
    assert kind_of("flux capacitor").top == 0.0


def test_every_colour_of_the_furnishing_data_is_known():
    words = {o.colour for i in range(60) for o in OfflineSceneWriter().describe(f"k{i}").objects}
    assert words <= set(NAMED)


@pytest.mark.parametrize(("length", "spacing"), [(0.01, 0.05), (0.06, 0.05), (0.4, 0.05), (7.3, 0.031)])
def test_cells_fill_their_length_without_gaps(length, spacing):
    centres, widths = cells(length, spacing)
    edges = np.concatenate([[0.0], np.cumsum(widths)])
    np.testing.assert_allclose(edges[-1], length)
    np.testing.assert_allclose(centres, (edges[1:] + edges[:-1]) / 2)
    assert widths.max() <= 1.6 * spacing
    assert OVERLAP * widths.max() > 0


def baked(surfels, parts, illumination):
    mesh = textured_mesh(parts)
    return bake(surfels, np.zeros(len(surfels), bool), mesh, solid_faces(mesh), illumination)


def lit(strength: float) -> np.ndarray:
    """A bare 4 x 4 x 3 m room under one lamp, grey throughout, with a block in its middle: points and colours."""
    parts = [
        Part(Sheet((-2, -2, 0), (4, 0, 0), (0, 4, 0)), paint("grey")),
        Part(Sheet((-2, 2, 3), (4, 0, 0), (0, -4, 0)), paint("grey")),
        box(paint("grey"), (0.8, 0.8, 0.5)),
    ]
    surfels = Surfels.joined([surfels_of(p, 0.1) for p in parts])
    lamp = (np.array([0.0, 0.0, 2.0]), np.zeros(3), np.full(3, 0.05), np.array([0, 0, 0.05]), np.full(3, strength))
    illumination = Illumination(Lamps.of([lamp]), None, None)
    light = baked(surfels, parts, illumination)
    radiance = surfels.albedo * light.irradiance(surfels.points, surfels.normals) / np.pi
    return np.concatenate([surfels.points, light.seen(radiance)], axis=1)


def test_exposure_does_not_depend_on_the_lamps_strength():
    np.testing.assert_allclose(lit(5.0), lit(50.0), atol=1e-3)


def test_floor_in_a_blocks_shadow_is_darker_than_open_floor():
    rows = lit(10.0)
    floor = rows[np.abs(rows[:, 2]) < 1e-6]
    away = np.abs(floor[:, :2]).max(axis=1)
    assert floor[(away > 0.4) & (away < 0.5), 3].mean() < 0.8 * floor[(away > 0.9) & (away < 1.1), 3].mean()


def test_the_sun_leaves_the_ground_behind_a_wall_in_shadow():
    parts = [Part(Sheet((-5, -5, 0), (10, 0, 0), (0, 10, 0)), paint("grey")), box(paint("grey"), (6, 0.2, 2))]
    surfels = Surfels.joined([surfels_of(p, 0.2) for p in parts])
    sun = Sun(np.array([0, -1, 1]) / np.sqrt(2), np.full(3, 20.0))
    sky = Sky(np.full(3, 3.0), np.full(3, 3.0), sun, 0.0, 0)
    light = baked(surfels, parts, Illumination(Lamps.of([]), sun, sky))
    up = np.array([[0.0, 0.0, 1.0]])
    shade, open_ground = (light.irradiance(np.array([[0.0, y, 0.0]]), up)[0, 0] for y in (1.0, -3.0))
    assert 0 < shade < 0.5 * open_ground
    assert open_ground == pytest.approx(20 / np.sqrt(2) + 3 * np.pi, rel=0.1)


def test_light_goes_round_a_corner_by_bouncing():
    walls = [Part(Sheet((-3, -3, 0), (6, 0, 0), (0, 6, 0)), paint("white")), box(paint("white"), (0.2, 3, 2.5))]
    walls += [Part(Sheet((-3, 3, 0), (6, 0, 0), (0, 0, 2.5)), paint("white"))]
    surfels = Surfels.joined([surfels_of(p, 0.15) for p in walls])
    lamp = (np.array([-1.5, 0.0, 1.2]), np.zeros(3), np.zeros(3), np.zeros(3), np.full(3, 5.0))
    illumination = Illumination(Lamps.of([lamp]), None, None)
    light = baked(surfels, walls, illumination)
    hidden, up = np.array([[0.6, 0.5, 0.0]]), np.array([[0.0, 0.0, 1.0]])
    assert direct_light(hidden, up, illumination, light.shadows).max() == 0
    assert light.irradiance(hidden, up).min() > 0.01


def test_nights_are_darker_than_days_and_their_windows_are_dark():
    day, night = (sky_of(DAY.model_copy(update={"time_of_day": t}), 1) for t in ("noon", "night"))
    up = np.array([[0.0, 0.0, 1.0]])
    assert night.radiance(up).max() < 0.05 * day.radiance(up).min()
    assert night.sun.irradiance.max() < 0.05 * day.sun.irradiance.min()


def test_the_film_curve_rises_and_stays_in_range():
    ramp = display(np.repeat(np.linspace(0, 50, 400)[:, None], 3, axis=1))
    assert (np.diff(ramp[:, 0]) > 0).all()
    assert ramp.min() >= 0
    assert ramp.max() <= 1
