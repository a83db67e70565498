"""The open air: skies with clouds, weathered walls, window panes that differ, leaves that let light through."""

import numpy as np
import pytest
from generated_places import DAY, street

from flymirage_core.scene.keys import rng as seeded
from flymirage_core.worldgen.assembly import structures_of
from flymirage_core.worldgen.finishes import MORTAR, dressed
from flymirage_core.worldgen.lighting import BakedLight
from flymirage_core.worldgen.materials import albedo
from flymirage_core.worldgen.place import place_for
from flymirage_core.worldgen.sky import sky_of
from flymirage_core.worldgen.textures import BRICK, runs

AROUND = np.random.default_rng(0).normal(size=(4000, 3))
UP = AROUND[AROUND[:, 2] > 0.2] / np.linalg.norm(AROUND[AROUND[:, 2] > 0.2], axis=1, keepdims=True)


@pytest.mark.parametrize("cover", ["clear", "overcast"])
def test_no_sky_is_one_even_grey(cover):
    brightness = sky_of(DAY.model_copy(update={"sky": cover}), 5).radiance(UP).mean(axis=1)
    assert brightness.std() > 0.05 * brightness.mean()


def test_a_clear_sky_is_blue_between_its_clouds_and_an_overcast_one_is_grey():
    clear, overcast = (sky_of(DAY.model_copy(update={"sky": c}), 5).radiance(UP) for c in ("clear", "overcast"))
    blue = clear[:, 2] / clear[:, 0]
    assert np.quantile(blue, 0.7) > 1.5
    assert (overcast[:, 2] / overcast[:, 0]).max() < 1.2


def test_rain_leaves_its_marks_below_an_edge_and_they_fade_downwards():
    x, v = np.meshgrid(np.linspace(0, 8, 200), [0.1, 1.0, 2.9])
    uv = np.stack([x.ravel(), v.ravel()], 1)
    low, middle, high = runs(uv, (8.0, 3.0), uv, 3).reshape(3, 200).mean(axis=1)
    assert high > 2 * middle > 4 * low


def test_bricks_lie_in_mortar_and_are_not_all_of_one_colour():
    wall = dressed("brick red", "brick", 1)
    middles = np.array([(i + 0.5, 2 * j + 0.5) for i in range(12) for j in range(6)]) * BRICK
    points = np.column_stack([middles, np.zeros(len(middles))])
    bricks = albedo(wall, middles, (9.0, 9.0), points)
    joint = albedo(wall, np.array([[0.1, 0.0], [0.4, 0.5]]), (9.0, 9.0), np.zeros((2, 3)))
    assert bricks.mean(axis=1).std() > 0.05 * bricks.mean()
    np.testing.assert_allclose(joint, np.tile(MORTAR, (2, 1)), rtol=0.6)  # but for dirt
    assert (joint[:, 2] > bricks[:, 2].mean()).all()


def test_no_two_windows_of_a_street_show_the_same_room():
    place = place_for(street())
    things = structures_of(place, sky_of(place.light, place.seed), seeded("street", "structure"))
    panes = [p.material for t in things for p in t.parts if p.material.texture == "interior"]
    assert len(panes) > 8
    assert len({m.seed for m in panes}) == len(panes)


def test_a_leaf_lit_on_its_back_is_not_black():
    class OneSided(BakedLight):
        def irradiance(self, points, normals):
            return np.where(normals[:, 2:] > 0, 10.0, 0.0) * np.ones(3)

    down, here = np.array([[0.0, 0.0, -1.0]] * 2), np.zeros((2, 3))
    leaf, stone = OneSided(None, None, None, None, 1.0).through(here, down, np.array([True, False]))
    assert leaf.min() > 2
    assert stone.max() == 0
