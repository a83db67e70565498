import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from splat_worlds import box, joined, panel

from flymirage_core.errors import WorldError
from flymirage_core.occupancy.distance import clearance_at, clearance_field
from flymirage_core.occupancy.grid import FREE, OCCUPIED, UNKNOWN
from flymirage_core.occupancy.voxelise import accumulated_opacity, occupancy_from_splats
from flymirage_core.settings import CleaningSettings, OccupancySettings
from flymirage_core.splats.cloud import GaussianCloud
from flymirage_core.splats.imports import import_world

SETTINGS = OccupancySettings()
C = np.array([0.05, 0.05, 1.25])
ROOM = box([-2, -1.5, 0], [2, 1.5, 2.5])


def gaussian(scales, opacity=1.0, mean=(0.0, 0.0, 0.0), quaternion=(0, 0, 0, 1)):
    arrays = ([mean], [quaternion], [scales], [opacity], np.zeros((1, 1, 3)))
    return GaussianCloud(*(np.asarray(a, np.float32) for a in arrays))


def free_volume(grid):
    return (grid.state == FREE).sum() * grid.resolution**3


def test_inside_of_a_closed_room_is_free_and_outside_is_unknown():
    grid = occupancy_from_splats(ROOM, C, SETTINGS)
    assert free_volume(grid) == pytest.approx(3.9 * 2.9 * 2.4, rel=0.05)
    rng = np.random.default_rng(0)
    assert (grid.state_at(rng.uniform([-1.8, -1.3, 0.2], [1.8, 1.3, 2.3], (500, 3))) == FREE).all()
    outside = [[x, 0, 1] for x in (-2.25, 2.25, 9)] + [[0, 0, -0.2], [0, 0, 2.75]]
    assert (grid.state_at(outside) == UNKNOWN).all()


def test_one_big_splat_blocks_the_whole_wall_that_it_paints():
    shell = box([-2, -1.5, 0], [2, 1.5, 2.5], step=4.0)  # a single Gaussian a face
    assert len(shell) == 6
    opacity = accumulated_opacity(shell, np.array([-3.0, -3, -1]), (60, 60, 50), 0.1)
    assert (opacity[25:35, 25:35, 9:11].max(axis=2) > 0.5).all()  # all over the middle of the floor


def test_inside_of_a_closed_cupboard_is_unknown():
    grid = occupancy_from_splats(joined(ROOM, box([1, 0.5, 0], [1.9, 1.4, 1.6])), C, SETTINGS)
    assert grid.state_at([1.45, 0.95, 0.8]) == UNKNOWN
    assert grid.state_at([1.45, 0.5, 0.8]) == OCCUPIED
    assert grid.state_at([1.45, 0.95, 2.0]) == FREE


def test_a_doorway_that_ends_in_nothing_does_not_leak():
    walls = ROOM.means
    doorway = (walls[:, 0] > 1.9) & (np.abs(walls[:, 1]) < 0.45) & (walls[:, 2] < 2) & (walls[:, 2] > 0.05)
    shed = panel([3.6, -1.5, 0], [0, 3, 0], [0, 0, 2.5])  # something is seen behind, without a floor
    grid = occupancy_from_splats(joined(ROOM[~doorway], shed), C, SETTINGS)
    assert grid.state_at([1.8, 0, 1]) == FREE
    assert (grid.state_at([[2.5, 0, 1], [2.5, 1, 1], [2.5, 0, 2.3]]) == UNKNOWN).all()


def test_a_crack_in_the_wall_does_not_leak():
    hall = joined(ROOM, panel([2, -1.5, 0], [1.5, 0, 0], [0, 3, 0]))
    crack = (hall.means[:, 0] > 1.9) & (hall.means[:, 0] < 2.01) & (np.abs(hall.means[:, 1]) < 0.12)
    grid = occupancy_from_splats(hall[~crack | (hall.means[:, 2] < 0.05)], C, SETTINGS)
    assert grid.state_at([1.7, 0, 1]) == FREE
    assert grid.state_at([2.6, 0, 1]) == UNKNOWN


def test_a_hall_with_a_floor_behind_a_doorway_is_free():
    hall = joined(ROOM, panel([2, -1.5, 0], [1.5, 0, 0], [0, 3, 0]))
    doorway = (hall.means[:, 0] > 1.9) & (hall.means[:, 0] < 2.01) & (np.abs(hall.means[:, 1]) < 0.5)
    grid = occupancy_from_splats(hall[~doorway | (hall.means[:, 2] < 0.05)], C, SETTINGS)
    assert grid.state_at([2.6, 0, 1]) == FREE


def test_nothing_below_the_floor_is_free_though_the_floor_has_holes():
    basement = box([-2, -1.5, -1.5], [2, 1.5, 0])
    holes = (basement.means[:, 2] > -0.1) & (np.hypot(*(basement.means[:, :2] - [0.8, 0]).T) < 0.45)
    top = ROOM.means[:, 2] > 0.1
    grid = occupancy_from_splats(joined(ROOM[top], basement[~holes]), C, SETTINGS)
    assert grid.state_at([0.8, 0, 1]) == FREE
    below = grid.state[:, :, : int(np.ceil((-0.05 - grid.origin[2]) / grid.resolution))]
    assert below.shape[2] > 1 and not (below == FREE).any()


def test_a_table_keeps_free_the_air_above_a_floor_that_was_not_scanned():
    under = (np.abs(ROOM.means[:, :2]) < [0.8, 0.8]).all(axis=1) & (ROOM.means[:, 2] < 0.1)
    table = panel([-0.8, -0.8, 0.75], [1.6, 0, 0], [0, 1.6, 0])
    grid = occupancy_from_splats(joined(ROOM[~under], table), C, SETTINGS)
    assert grid.state_at([0.3, 0.3, 1.2]) == FREE
    assert grid.state_at([1.3, 0.3, 0.4]) == FREE


def test_hilly_ground_without_a_flat_floor_can_be_flown_over():
    x, y = np.meshgrid(np.arange(-6, 6, 0.1), np.arange(-6, 6, 0.1))
    z = 0.5 * np.sin(x) + 0.4 * y
    ground = panel([0, 0, 0], [12, 0, 0], [0, 12, 0], step=0.1)
    ground.means[:] = np.stack([x, y, z], axis=-1).reshape(-1, 3)
    ground.scales[:] = 0.07
    grid = occupancy_from_splats(joined(ground, panel([-6, -6, 5], [12, 0, 0], [0, 12, 0])), [0, 0, 2], SETTINGS)
    assert grid.state_at([0, 3, 2]) == FREE
    assert grid.state_at([0, -3, -0.5]) == FREE  # in the valley
    assert grid.state_at([0, 3, 0.5]) == UNKNOWN  # in the hill


def test_floaters_are_removed_and_small_things_stay():
    dust = gaussian([0.03, 0.03, 0.03], mean=[0.5, 0.5, 1.2])
    lamp = box([-0.65, 0.35, 1.5], [-0.35, 0.65, 1.8], step=0.05)
    grid = occupancy_from_splats(joined(ROOM, dust, lamp), C, SETTINGS)
    assert grid.state_at([0.5, 0.5, 1.2]) == FREE
    assert grid.state_at([-0.5, 0.5, 1.5]) == OCCUPIED


def test_haze_and_stray_splats_do_not_block():
    rng = np.random.default_rng(0)
    stray = [gaussian([0.03, 0.03, 0.03], mean=rng.normal(0, 40, 3)) for _ in range(30)]
    haze = [gaussian([0.8, 0.8, 0.8], opacity=0.05, mean=[0, 0, 1.2])]
    grid = occupancy_from_splats(joined(ROOM, *stray, *haze), C, SETTINGS)
    assert free_volume(grid) == pytest.approx(free_volume(occupancy_from_splats(ROOM, C, SETTINGS)), rel=0.01)


@pytest.mark.parametrize("centre", [[2, 0, 1.2], [0, 0, 0], [1.4, 0.9, 0.8], [0, 0, -3], [50, 0, 1]])
def test_a_centre_in_a_wall_a_floor_a_solid_or_outside_is_refused(centre):
    world = joined(ROOM, *(box([1 + d, 0.5 + d, 0], [1.9 - d, 1.4 - d, 1.6]) for d in (0, 0.1, 0.2, 0.3)))
    with pytest.raises(WorldError, match=r"scene centre .* is not in free space"):
        occupancy_from_splats(world, centre, SETTINGS)


def test_a_centre_that_touches_a_leaf_is_moved_a_little():
    leaf = panel([0.15, -0.15, 1.1], [0, 0.3, 0], [0, 0, 0.3])
    assert occupancy_from_splats(joined(ROOM, leaf), C, SETTINGS).state_at([-1, 0, 1]) == FREE


def test_an_empty_world_is_refused():
    with pytest.raises(WorldError, match="no Gaussians"):
        occupancy_from_splats(ROOM[:0], C, SETTINGS)


@given(st.integers(0, 2**32 - 1))
@settings(max_examples=30)
def test_opacity_adds_up_to_the_splats_area(seed):
    rng = np.random.default_rng(seed)
    quaternion = rng.normal(size=4)
    scales, alpha = np.exp(rng.uniform(-6, -1, 3)), rng.uniform(0.05, 1)
    splat = gaussian(scales, alpha, rng.uniform(-0.1, 0.1, 3), quaternion / np.linalg.norm(quaternion))
    opacity = accumulated_opacity(splat, np.array([-2.0, -2, -2]), (40, 40, 40), 0.1)
    _, middle, high = np.sort(scales)
    depth = -np.log1p(-opacity.astype(float)).sum()
    assert depth == pytest.approx(alpha * 2 * np.pi * middle * high / 0.1**2, rel=1e-3)


def test_opacity_is_where_the_splat_is():
    half = np.sqrt(0.5)
    flat = gaussian([0.3, 0.1, 0.001], 0.9, [0, 0, 0.05], [0, 0, half, half])  # long along y now
    opacity = accumulated_opacity(flat, np.array([-1.0, -1, -1]), (20, 20, 20), 0.1)
    occupied = np.argwhere(opacity > 0.1) - 10
    np.testing.assert_array_equal(occupied[:, 2], 0)
    assert np.ptp(occupied[:, 1]) > 1.8 * np.ptp(occupied[:, 0])


@pytest.mark.parametrize(("name", "volume"), [("bedroom_sw", (35, 48)), ("family_dining", (55, 75))])
def test_captured_room_has_its_free_space_round_c(captured_worlds, name, volume):
    world = import_world(captured_worlds / f"{name}_lod2.spz", "auto", None, CleaningSettings())
    grid = occupancy_from_splats(world.cloud, world.centre, SETTINGS)
    assert volume[0] < free_volume(grid) < volume[1]
    assert clearance_at(grid, clearance_field(grid), world.centre) == pytest.approx(1.0, abs=0.12)
    assert (np.argwhere(grid.state == FREE)[:, 2].min() + 1) * grid.resolution + grid.origin[2] > 0
    border = grid.state.copy()
    border[1:-1, 1:-1, 1:-1] = OCCUPIED
    assert not (border == FREE).any()
