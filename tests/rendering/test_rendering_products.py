"""What rendering leaves on disk: posed views and flights' frames come back as they went."""

import json
import math

import numpy as np
import pyarrow.parquet as pq
import pytest
from scipy.spatial.transform import Rotation

from flymirage_core.errors import InputError, ProductError
from flymirage_core.rendering.camera import Camera, Intrinsics, look_along
from flymirage_core.rendering.cpu import CpuRasterizer
from flymirage_core.rendering.frames import FRAME_SCHEMA, BodyPath, Frames, camera_rig
from flymirage_core.rendering.rasterizer import Rasterizer, Rendering
from flymirage_core.rendering.recording import record_frames
from flymirage_core.rendering.views import PosedViews, depth_to_millimetres
from flymirage_core.settings import FrameSettings
from flymirage_core.splats.cloud import GaussianCloud

SETTINGS = FrameSettings(width=64, height=48, horizontal_fov_deg=90, rate=10)


def wall(seed: int = 0) -> GaussianCloud:
    """A coloured wall across +x, three metres from the origin."""
    rng = np.random.default_rng(seed)
    y, z = (a.ravel() for a in np.meshgrid(np.arange(-4, 4, 0.2), np.arange(-4, 4, 0.2)))
    n = len(y)
    return GaussianCloud(
        np.stack([np.full(n, 3.0), y, z], axis=1).astype(np.float32),
        np.tile(np.array([0, 0, 0, 1], np.float32), (n, 1)),
        np.tile(np.array([0.01, 0.15, 0.15], np.float32), (n, 1)),
        np.full(n, 0.95, np.float32),
        rng.normal(0, 0.3, (n, 1, 3)).astype(np.float32),
    )


def hover(flight_id: int, count: int, yaw: float = 0.0) -> BodyPath:
    """A flight that drifts a little to the left, nose at ``yaw``."""
    positions = np.stack([np.zeros(count), np.linspace(0, 0.2, count), np.zeros(count)], axis=1)
    quaternion = Rotation.from_euler("z", yaw).as_quat()
    return BodyPath(flight_id, np.arange(count) / 10, positions, np.tile(quaternion, (count, 1)))


@pytest.fixture
def frames(tmp_path) -> Frames:
    return record_frames(
        wall(), [hover(0, 5), hover(3, 2, yaw=math.pi)], camera_rig(SETTINGS), CpuRasterizer(2), tmp_path / "frames"
    )


def test_the_level_camera_looks_along_the_bodys_x_with_its_top_up():
    body_camera = np.array(camera_rig(SETTINGS).T_body_camera)
    np.testing.assert_allclose(body_camera[:3, 2], [1, 0, 0], atol=1e-12)  # forward
    np.testing.assert_allclose(body_camera[:3, 0], [0, -1, 0], atol=1e-12)  # right
    np.testing.assert_allclose(body_camera[:3, 1], [0, 0, -1], atol=1e-12)  # down


def test_a_pitched_camera_looks_down():
    rig = camera_rig(SETTINGS.model_copy(update={"pitch_deg": 30.0}))
    np.testing.assert_allclose(np.array(rig.T_body_camera)[:3, 2], [math.cos(math.pi / 6), 0, -0.5], atol=1e-12)


def test_an_odd_picture_is_refused_before_anything_is_rendered():
    with pytest.raises(ValueError, match="even"):
        FrameSettings(width=481)


def test_a_flight_is_filmed_from_where_the_drone_is(frames):
    assert frames.flight_ids == [0, 3] and frames.summary() == {"flights": 2, "frames": 7}
    flight = frames.flight(0)
    assert len(flight) == 5 == len(flight.cameras())
    cloud = wall()
    expected = list(CpuRasterizer(1).render(cloud, flight.cameras()))
    for picture, rgb, depth in zip(expected, flight.rgb(), flight.depth(), strict=True):
        assert np.mean(np.abs(rgb.astype(float) - picture.rgb)) < 6
        np.testing.assert_array_equal(depth, depth_to_millimetres(picture.depth))
    for camera, position in zip(flight.cameras(), hover(0, 5).positions, strict=True):
        np.testing.assert_allclose(camera.position, position, atol=1e-12)
        np.testing.assert_allclose(camera.forward, [1, 0, 0], atol=1e-12)


def test_the_table_tells_how_much_of_a_frame_is_covered_and_how_far_it_is(frames):
    facing, turned_away = frames.flight(0).table, frames.flight(3).table
    assert (facing["alpha_coverage"] > 0.99).all() and (turned_away["alpha_coverage"] == 0).all()
    assert facing["mean_depth"].to_numpy() == pytest.approx(3.0, abs=0.02) and (turned_away["mean_depth"] == 0).all()
    assert facing["time"].tolist() == [0, 0.1, 0.2, 0.3, 0.4]
    assert pq.read_schema(frames.folder / "frames.parquet").equals(FRAME_SCHEMA)


def test_frames_come_back_from_a_copy_as_they_were(frames, tmp_path):
    frames.save(tmp_path / "copy")
    back = Frames.load(tmp_path / "copy")
    assert back.rig == frames.rig
    assert back.table.to_json() == frames.table.to_json()
    for a, b in zip(frames.flight(3).depth(), back.flight(3).depth(), strict=True):
        np.testing.assert_array_equal(a, b)


def test_filming_again_gives_the_same_files(frames, tmp_path):
    paths = [hover(0, 5), hover(3, 2, yaw=math.pi)]
    again = record_frames(wall(), paths, camera_rig(SETTINGS), CpuRasterizer(1), tmp_path / "again")
    files = sorted(p.relative_to(frames.folder) for p in frames.folder.rglob("*") if p.is_file())
    assert len(files) == 7
    for file in files:
        assert (frames.folder / file).read_bytes() == (again.folder / file).read_bytes(), file


def test_a_scene_without_flights_is_a_whole_product(tmp_path):
    record_frames(wall(), [], camera_rig(SETTINGS), CpuRasterizer(1), tmp_path / "none")
    assert Frames.load(tmp_path / "none").summary() == {"flights": 0, "frames": 0}


@pytest.mark.parametrize("lost", ["0003/rgb.mp4", "0000/depth.zip", "frames.parquet", "camera.json"])
def test_a_missing_file_is_found_at_load(frames, lost):
    (frames.folder / lost).unlink()
    with pytest.raises(ProductError, match="materialise"):
        Frames.load(frames.folder)


@pytest.mark.parametrize("torn", ["frames.parquet", "camera.json"])
def test_a_torn_file_is_found_at_load(frames, torn):
    (frames.folder / torn).write_bytes((frames.folder / torn).read_bytes()[:40])
    with pytest.raises(ProductError, match="no whole `frames` product"):
        Frames.load(frames.folder)


def test_an_unknown_flight_is_named(frames):
    with pytest.raises(InputError, match=r"flight 7 has no frames; those that have are \[0, 3\]"):
        frames.flight(7)


def test_a_rasterizer_that_stops_early_is_found_out(tmp_path):
    class Tired(Rasterizer):
        name = "tired"

        def render(self, cloud, cameras):
            return iter(list(CpuRasterizer(1).render(cloud, cameras))[:2])

    with pytest.raises(ProductError, match="gave 2 pictures, 5 were asked for"):
        record_frames(wall(), [hover(0, 5)], camera_rig(SETTINGS), Tired(), tmp_path / "short")
    assert not (tmp_path / "short" / "frames.parquet").exists()


def test_posed_views_come_back_as_they_were(tmp_path):
    intrinsics = Intrinsics(40, 30, 33.0, 34.0, 19.0, 16.0)
    cameras = [Camera(intrinsics, look_along([0, y, 0.1], [1, 0.1, 0])) for y in (0.0, 0.5)]
    pictures = list(CpuRasterizer(1).render(wall(), cameras))
    PosedViews.write(tmp_path / "made", cameras, iter(pictures), ["a", "b"]).save(tmp_path / "kept")
    views = PosedViews.load(tmp_path / "kept")
    assert len(views) == 2 and views.groups == ("a", "b") and views.summary() == {"views": 2, "groups": 2}
    for view, camera, picture in zip(views, cameras, pictures, strict=True):
        assert view.camera.intrinsics == intrinsics
        np.testing.assert_array_equal(view.camera.T_world_camera, camera.T_world_camera)
        np.testing.assert_allclose(view.picture.depth, picture.depth, atol=0.00051)
        np.testing.assert_allclose(view.picture.alpha, picture.alpha, atol=0.0021)
        assert np.mean(np.abs(view.picture.rgb.astype(float) - picture.rgb)) < 6


def test_a_torn_view_is_one_sentence(tmp_path):
    blank = Rendering(np.zeros((4, 6, 3), np.uint8), np.zeros((4, 6), np.float32), np.zeros((4, 6), np.float32))
    views = PosedViews.write(tmp_path, [Camera(Intrinsics(6, 4, 5, 5, 3, 2), np.eye(4))], [blank], ["a"])
    (tmp_path / "0000_depth.png").write_bytes(b"torn")
    with pytest.raises(ProductError, match=r"0000_depth.png is missing or torn"):
        views[0]


def test_views_without_a_whole_table_are_one_sentence(tmp_path):
    with pytest.raises(ProductError, match=r"views.parquet is missing or torn"):
        PosedViews.load(tmp_path)
    (tmp_path / "views.parquet").write_bytes(b"PAR1torn")
    with pytest.raises(ProductError, match=r"views.parquet is missing or torn"):
        PosedViews.load(tmp_path)


def test_depth_that_cannot_be_stored_is_no_return():
    depth = np.array([[np.nan, np.inf, -1.0, 65.535, 65.6, 0.0004, 0.0006, 1.2345]], np.float32)
    assert depth_to_millimetres(depth).tolist() == [[0, 0, 0, 65535, 0, 0, 1, 1234]]


def test_the_camera_file_is_plain_json(frames):
    data = json.loads((frames.folder / "camera.json").read_text())
    assert data["intrinsics"]["width"] == 64 and data["frame_rate"] == 10
