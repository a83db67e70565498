"""Where splats go: many where the texture changes and where drones look, none behind what hides them."""

import numpy as np
import pytest
from generated_places import flat, street

from flymirage_core.worldgen.assembly import assemble, build_truth
from flymirage_core.worldgen.lighting import opaque_faces, solid_faces
from flymirage_core.worldgen.meshes import textured_mesh
from flymirage_core.worldgen.parts import paint
from flymirage_core.worldgen.sampling import _covered
from flymirage_core.worldgen.spacing import FLOWN, HIGH_LOW, LOOKED_AT, NEARBY, coarseness
from flymirage_core.worldgen.surfaces import Part, Sheet, surfels_of
from flymirage_core.worldgen.visibility import flown_spots, pixels_per_area

BOARD = Sheet((0, 0, 0), (1.6, 0, 0), (0, 0.8, 0))


def test_a_plain_board_is_cut_evenly_and_a_striped_one_along_its_stripes():
    plain, striped = (surfels_of(Part(BOARD, paint("white", texture)), 0.1) for texture in ("plain", "stripes"))
    assert len(striped) > 1.5 * len(plain)
    narrow = np.linalg.norm(striped.along, axis=1) < 0.02
    edges = np.abs((striped.points[:, 0] / 0.16 + 0.5) % 1 - 0.5) * 0.16  # metres from where a stripe ends
    inside = np.abs(striped.points[:, 0] - 0.8) < 0.6  # the board's own ends have narrow cells too
    assert edges[narrow & inside].max() < 0.03


@pytest.mark.parametrize("texture", ["plain", "stripes", "checks", "bricks", "wood", "dial"])
def test_halving_cells_loses_and_doubles_no_surface(texture):
    surfels = surfels_of(Part(BOARD, paint("white", texture)), 0.1)
    assert surfels.areas.sum() == pytest.approx(1.6 * 0.8)
    np.testing.assert_allclose((surfels.points * surfels.areas[:, None]).sum(axis=0) / 1.28, [0.8, 0.4, 0.0], atol=1e-9)


def test_the_board_behind_a_glowing_screen_is_left_out_though_light_passes_the_screen():
    screen = Part(Sheet((0, 0, 0.01), (1.6, 0, 0), (0, 0.8, 0)), paint("white", emission=0.5))
    mesh = textured_mesh([Part(BOARD, paint("black")), screen])
    board = surfels_of(Part(BOARD, paint("black")), 0.1)
    assert _covered(board, opaque_faces(mesh)).all()
    assert not _covered(board, solid_faces(mesh)).any()


def test_what_is_far_from_where_drones_fly_is_cut_coarser():
    assembly = assemble(street())
    mesh = textured_mesh(assembly.parts)
    distance = np.linalg.norm(mesh.vertices[mesh.faces[:, 0]] - assembly.truth.centre, axis=1)  # (F,)
    nearest = np.full(len(assembly.parts), np.inf)
    np.minimum.at(nearest, mesh.face_part, distance)
    factors = coarseness(assembly, mesh, opaque_faces(mesh))
    assert np.median(factors[nearest > 40]) > 1.5 * np.median(factors[nearest < 10])


def test_what_reaches_near_is_cut_finely_however_little_of_it_is_seen_lest_its_splats_be_fog():
    assembly = assemble(street())
    mesh = textured_mesh(assembly.parts)
    off = np.abs(mesh.vertices - assembly.truth.centre)  # (V, 3) metres
    near = (off < FLOWN).all(axis=1) & (mesh.vertices[:, 2] < HIGH_LOW[0])
    parts = np.unique(mesh.face_part[near[mesh.faces].any(axis=1)])
    opaque = opaque_faces(mesh)
    assert pixels_per_area(assembly, mesh, opaque)[parts].min() ** -LOOKED_AT > NEARBY
    assert coarseness(assembly, mesh, opaque)[parts].max() <= NEARBY


def test_spots_that_are_flown_through_are_free_and_lie_in_several_rooms():
    truth = build_truth(flat())
    spots = flown_spots(truth, 200, np.random.default_rng(0))
    assert truth.is_free(spots).all()
    rooms = [((spots >= space.low) & (spots <= space.high)).all(axis=1).any() for space in truth.spaces]
    assert sum(rooms) >= 3
