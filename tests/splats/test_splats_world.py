import io
import json

import numpy as np
import pytest
import trimesh
from splat_worlds import box, random_cloud

from flymirage_core.errors import ProductError, WorldError
from flymirage_core.settings import CleaningSettings
from flymirage_core.splats.cleaning import clean
from flymirage_core.splats.collider import from_glb, to_glb
from flymirage_core.splats.files import write_ply
from flymirage_core.splats.frames import MarbleSemantics
from flymirage_core.splats.imports import import_marble_world, import_world
from flymirage_core.splats.world import World


def test_cleaning_counts_what_it_removes_and_why():
    cloud = random_cloud(np.random.default_rng(0), 10)
    cloud.means[0] = np.nan
    cloud.quaternions[1] = np.inf
    cloud.opacities[2] = 1e-4
    cloud.scales[3, 1] = 40
    cloud.means[4] = [300, 0, 0]
    cloud.means[5], cloud.opacities[5] = [300, 0, 0], 0  # counted once
    kept, counts = clean(cloud, [0, 0, 1], CleaningSettings())
    np.testing.assert_array_equal(kept.means, cloud.means[6:])
    assert list(counts.values()) == [2, 2, 1, 1]


def test_a_world_that_cleaning_empties_is_refused():
    cloud = random_cloud(np.random.default_rng(0), 10)
    with pytest.raises(WorldError, match="10 Gaussians after cleaning \\(10 far\\)"):
        clean(cloud, [1000, 0, 0], CleaningSettings())


def test_a_saved_world_is_loaded_again(tmp_path):
    world = World(random_cloud(np.random.default_rng(1), 40, 1), np.array([0.1, 0.2, 1.6]), {"up": "-y", "scale": 1.0})
    world.save(tmp_path / "w")
    again = World.load(tmp_path / "w")
    np.testing.assert_array_equal(again.centre, world.centre)
    np.testing.assert_allclose(again.cloud.scales, world.cloud.scales, rtol=1e-6)
    assert again.notes == world.notes and again.collider is None and again.summary()["sh_degree"] == 1


def test_saving_twice_gives_the_same_bytes(tmp_path):
    world = World(random_cloud(np.random.default_rng(2), 40), np.zeros(3))
    for folder in ("a", "b"):
        world.save(tmp_path / folder)
    for name in ("world.ply", "world.json"):
        assert (tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes()


def test_the_collider_travels_with_the_world(tmp_path):
    glb = to_glb([[0, 0, 0], [1, 0, 0], [0, 0, 2]], [[0, 1, 2]])
    World(random_cloud(np.random.default_rng(2), 4), np.zeros(3), collider=glb).save(tmp_path)
    assert World.load(tmp_path).collider == glb


def test_a_collider_is_z_up_here_and_y_up_in_its_file():
    vertices, faces = [[0, 0, 0], [1, 0, 0], [0, 0, 2.5], [0, 3, 0]], [[0, 1, 2], [0, 3, 1]]
    found, triangles = from_glb(to_glb(vertices, faces))
    np.testing.assert_allclose(found[triangles], np.array(vertices)[faces], atol=1e-6)
    stored = trimesh.load_scene(io.BytesIO(to_glb(vertices, faces)), file_type="glb").to_mesh()
    np.testing.assert_allclose(stored.bounds, [[0, 0, -3], [1, 2.5, 0]], atol=1e-6)


def test_a_collider_that_is_no_glb_is_refused():
    with pytest.raises(WorldError, match="not a whole GLB"):
        from_glb(b"glTF and then nothing")


def test_the_panorama_travels_with_the_world_and_a_torn_one_is_refused(tmp_path):
    panorama = np.zeros((32, 64, 3), np.uint8)
    panorama[:, 32:] = (200, 120, 40)
    World(random_cloud(np.random.default_rng(2), 4), np.zeros(3), panorama=panorama).save(tmp_path)
    found = World.load(tmp_path).panorama
    assert found.shape == (32, 64, 3)
    assert np.abs(found[:, 48].astype(int) - [200, 120, 40]).max() < 6
    (tmp_path / "panorama.jpg").write_bytes(b"torn")
    with pytest.raises(ProductError, match="panorama"):
        World.load(tmp_path)


def test_torn_or_foreign_world_folders_are_refused(tmp_path):
    World(random_cloud(np.random.default_rng(2), 4), np.zeros(3)).save(tmp_path)
    document = json.loads((tmp_path / "world.json").read_text())
    for text in ("", "[]", "{}", json.dumps({**document, "schema": 99})):
        (tmp_path / "world.json").write_text(text)
        with pytest.raises(ProductError, match="make"):
            World.load(tmp_path)
    (tmp_path / "world.json").write_text(json.dumps(document))
    (tmp_path / "world.ply").write_bytes((tmp_path / "world.ply").read_bytes()[:-9])
    with pytest.raises(ProductError, match="truncated"):
        World.load(tmp_path)


def test_an_imported_room_is_clean_upright_and_says_how(tmp_path):
    room = box([-2, -1.2, -2.5], [2, 1.5, 2.5])  # y down, c at the origin
    room.means[:3] = np.nan
    room.means[3] = [500, 0, 0]
    write_ply(room, tmp_path / "room.ply")
    world = import_world(tmp_path / "room.ply", "-y", 2.0, CleaningSettings())
    np.testing.assert_allclose(world.centre, [0, 0, 3], atol=0.05)
    assert world.notes["removed_not_finite"] == 3 and world.notes["removed_far"] == 1
    assert world.notes["source"] == "room.ply" and world.notes["scale_source"] == "given"
    marble = import_marble_world(tmp_path / "room.ply", MarbleSemantics(1.0, 1.5), CleaningSettings())
    np.testing.assert_allclose(marble.cloud.means[:, 2].min(), 0, atol=0.01)


def test_a_file_whose_numbers_are_all_broken_is_refused(tmp_path):
    cloud = random_cloud(np.random.default_rng(0), 5)
    cloud.sh[:] = np.nan
    write_ply(cloud, tmp_path / "nan.ply")
    with pytest.raises(WorldError, match=r"nan\.ply: each of the 5 Gaussians"):
        import_world(tmp_path / "nan.ply", "auto", None, CleaningSettings())
