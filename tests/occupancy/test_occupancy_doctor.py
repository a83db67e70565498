import numpy as np
import pytest
from splat_worlds import box, joined, panel, random_cloud

from flymirage_core.occupancy.doctor import examine
from flymirage_core.settings import CleaningSettings, OccupancySettings
from flymirage_core.splats.frames import transformed
from flymirage_core.splats.imports import import_world
from flymirage_core.splats.world import World

ROOM = box([-2, -1.5, 0], [2, 1.5, 2.5])
C = np.array([0.0, 0.0, 1.3])


def findings(world):
    return {finding.subject: finding for finding in examine(world, OccupancySettings()).findings}


def test_a_sound_room_is_measured_and_has_no_complaints():
    report = examine(World(ROOM, C), OccupancySettings())
    assert report.severity == "ok", report.findings
    assert report.floor == pytest.approx(0, abs=0.01)
    assert report.clear_height == pytest.approx(2.4, abs=0.11)
    assert report.free_volume == pytest.approx(3.9 * 2.9 * 2.4, rel=0.05)
    assert report.clearance == pytest.approx(1.2, abs=0.1)
    assert report.open_share == 0 and report.floater_share == 0


def test_a_room_ten_times_too_large_is_told_its_scale():
    large = World(transformed(ROOM, np.eye(3), 4.0, np.zeros(3)), 4 * C, {"scale": 4.0, "scale_source": "given"})
    finding = findings(large)["scale"]
    assert finding.severity == "warning"
    assert float(finding.sentence.split("--scale ")[1].split("`")[0]) == pytest.approx(1.04, abs=0.05)


def test_a_centre_in_the_wall_is_a_problem_with_advice():
    finding = findings(World(ROOM, np.array([2.0, 0, 1.2])))["centre"]
    assert finding.severity == "problem"
    assert "not in free space" in finding.sentence and "give another" in finding.sentence


def test_a_cell_too_small_to_fly_is_a_problem():
    assert findings(World(box([-0.6, -0.6, 0], [0.6, 0.6, 2.2]), C))["free volume"].severity == "problem"


def test_a_floor_that_is_not_at_zero_is_a_problem():
    low = World(transformed(ROOM, np.eye(3), 1.0, [0, 0, -0.5]), C - [0, 0, 0.5])
    assert findings(low)["floor"].severity == "problem"


def test_missing_walls_are_noticed():
    carport = joined(panel([-3, -3, 0], [6, 0, 0], [0, 6, 0]), panel([-3, -3, 2.4], [6, 0, 0], [0, 6, 0]))
    finding = findings(World(carport, C))["openness"]
    assert finding.severity == "warning" and "walls are missing" in finding.sentence


def test_a_cloud_of_dust_is_a_warning_about_floaters():
    specks = np.mgrid[-1.8:1.8:0.25, -1.3:1.3:0.25, 0.3:2.3:0.25].reshape(3, -1).T
    specks = specks[np.linalg.norm(specks - C, axis=1) > 0.5]
    dust = random_cloud(np.random.default_rng(0), len(specks))
    dust.means[:], dust.scales[:], dust.opacities[:] = specks, 0.02, 0.9
    report = examine(World(joined(ROOM, dust), C), OccupancySettings())
    assert {f.subject: f.severity for f in report.findings}["floaters"] == "warning"


def test_a_generated_world_says_its_scale_in_words():
    report = examine(World(ROOM, C, {"scale": "metric by construction"}), OccupancySettings())
    assert (report.scale, report.scale_source) == (1.0, "metric by construction")


def test_much_cleaning_is_a_warning():
    world = World(ROOM, C, {"removed_far": 4 * len(ROOM), "removed_giant": 3})
    assert findings(world)["cleaning"].severity == "warning"


@pytest.mark.parametrize("name", ["bedroom_sw", "family_dining"])
def test_captured_rooms_are_sound(captured_worlds, name):
    world = import_world(captured_worlds / f"{name}_lod2.spz", "auto", None, CleaningSettings())
    report = examine(world, OccupancySettings())
    assert report.severity == "ok", report.findings
    assert report.clearance == pytest.approx(1.0, abs=0.12)
    assert 2.4 < report.clear_height < 3.4 and report.open_share < 0.1
