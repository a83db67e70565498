"""Filming: what overlaps and in which order, what is measured, and that damage is found."""

import json
import math
import threading
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from filmed_room import box
from hypothesis import given
from hypothesis import strategies as st
from test_rendering_products import SETTINGS, hover, wall

from flymirage_core.annotation.instances import oriented_boxes
from flymirage_core.errors import InputError, ProductError
from flymirage_core.progress import listening
from flymirage_core.rendering import cpu
from flymirage_core.rendering.cpu import CpuRasterizer
from flymirage_core.rendering.frames import Frames, camera_rig
from flymirage_core.rendering.rasterizer import Rasterizer
from flymirage_core.rendering.recording import record_frames
from flymirage_core.rendering.threads import LOOK_AHEAD, in_order
from flymirage_core.rendering.video import VideoWriter, yuv420p

RIG = camera_rig(SETTINGS)
PICTURE_ON_THE_WALL = box(6, "picture", (3.0, 0.0, 0.0), (0.3, 1.0, 1.0))


def film(folder, *paths, objects=None) -> Frames:
    return record_frames(wall(), paths, RIG, CpuRasterizer(2), folder, objects)


def test_the_files_are_the_same_whatever_the_number_of_threads_and_whoever_develops(tmp_path):
    class Streaming(Rasterizer):
        """A back end that renders on one thread, as a card does: its pictures are developed on others."""

        name = "streaming"

        def render(self, cloud, cameras):
            return CpuRasterizer(1).render(cloud, cameras)

    paths = [hover(0, 4), hover(1, 7, 0.3), hover(5, 2, -0.3)]
    objects = oriented_boxes([PICTURE_ON_THE_WALL])
    rasterizers = {"one": CpuRasterizer(1), "three": CpuRasterizer(3), "streaming": Streaming()}
    for name, rasterizer in rasterizers.items():
        record_frames(wall(), paths, RIG, rasterizer, tmp_path / name, objects)
    files = sorted(p.relative_to(tmp_path / "one") for p in (tmp_path / "one").rglob("*.*"))
    assert len(files) == 3 * 3 + 3
    for name in rasterizers:
        for file in files:
            assert (tmp_path / "one" / file).read_bytes() == (tmp_path / name / file).read_bytes(), (name, file)


@given(st.lists(st.integers(), max_size=20), st.integers(1, 4))
def test_work_on_threads_comes_back_in_order_and_is_not_begun_far_ahead(items, threads):
    begun = []
    results = in_order(lambda item: begun.append(item) or -item, items, threads)
    for done, item in enumerate(items):
        assert next(results) == -item
        assert len(begun) <= done + threads + LOOK_AHEAD
    assert list(results) == []


def test_frames_know_how_much_of_them_shows_the_target(tmp_path):
    target = oriented_boxes([PICTURE_ON_THE_WALL])
    facing, away = replace(hover(0, 3), target=target), replace(hover(1, 2, math.pi), target=target)
    table = film(tmp_path, facing, away, hover(2, 1)).table.set_index("flight_id")
    k = RIG.intrinsics
    expected = (k.fx * 1.06 / 3) * (k.fy * 1.0 / 3) / (k.width * k.height)  # grown by 3 cm on all sides but one
    assert table.loc[0]["target_share"].to_numpy() == pytest.approx(expected, rel=0.1)
    assert table.loc[0]["target_in_view"].all() and not table.loc[1]["target_in_view"].any()
    assert pd.isna(table.loc[2]["target_share"])  # it flies to nothing that is known


def test_the_instance_pictures_shows_the_objects_numbers(tmp_path):
    flight = film(tmp_path, hover(0, 3), objects=oriented_boxes([PICTURE_ON_THE_WALL])).flight(0)
    for ids in flight.instances():
        assert ids.shape == (48, 64) and ids[24, 32] == 7 and set(np.unique(ids)) == {0, 7}


def test_without_objects_there_are_no_instance_pictures(tmp_path):
    with pytest.raises(ProductError, match=r"instances.zip is missing"):
        list(film(tmp_path, hover(0, 2)).flight(0).instances())


def test_a_surround_rig_films_to_all_sides_and_its_poses_are_a_quarter_turn_apart(tmp_path):
    rig = camera_rig(SETTINGS.model_copy(update={"surround": True}))
    paths = [hover(0, 3), hover(1, 2, math.pi / 2)]  # the second flight's right is where the first looks ahead
    frames = record_frames(wall(), paths, rig, CpuRasterizer(2), tmp_path)
    assert Frames.load(tmp_path).rig == rig
    assert len(frames.table) == 5  # a row for each frame of the first camera
    right = frames.flight(1).looking("right")
    ahead = frames.flight(0)
    np.testing.assert_allclose(right.cameras()[0].T_world_camera, ahead.cameras()[0].T_world_camera, atol=1e-9)
    np.testing.assert_array_equal(next(right.depth()), next(ahead.depth()))
    assert not next(ahead.looking("back").depth()).any()  # there is one wall only
    with pytest.raises(InputError, match="no camera that looks up"):
        ahead.looking("up")


def test_a_rig_of_one_camera_says_how_to_get_more(tmp_path):
    with pytest.raises(InputError, match=r"no camera that looks left; set frames.surround"):
        film(tmp_path, hover(0, 2)).flight(0).looking("left")


@pytest.mark.parametrize("lost", ["0000/left/rgb.mp4", "0000/back/depth.zip"])
def test_a_side_video_that_is_lost_is_found_at_load(tmp_path, lost):
    rig = camera_rig(SETTINGS.model_copy(update={"surround": True}))
    record_frames(wall(), [hover(0, 2)], rig, CpuRasterizer(2), tmp_path)
    (tmp_path / lost).unlink()
    with pytest.raises(ProductError, match=rf"{lost} is missing"):
        Frames.load(tmp_path)


def test_an_encoder_that_fails_ends_the_filming_and_its_threads(tmp_path, monkeypatch):
    def full(self, frame):
        raise InputError("the disk is full")

    monkeypatch.setattr(VideoWriter, "append_planes", full)
    with pytest.raises(InputError, match="the disk is full"):
        film(tmp_path, hover(0, 20), hover(1, 20))
    assert not [t for t in threading.enumerate() if t.name.startswith(("encoder", "rasterizer"))]
    assert not (tmp_path / "frames.parquet").exists()


@pytest.mark.parametrize("name", ["0000/rgb.mp4", "0000/depth.zip"])
def test_a_video_cut_short_is_found_at_load(tmp_path, name):
    film(tmp_path, hover(0, 3))
    (tmp_path / name).write_bytes((tmp_path / name).read_bytes()[:-1])
    with pytest.raises(ProductError, match=rf"{name} has \d+ bytes, \d+ were written; materialise `frames` again"):
        Frames.load(tmp_path)


@pytest.mark.parametrize("name", ["0000/rgb.mp4", "0000/depth.zip"])
def test_one_flipped_bit_in_a_video_is_found_by_check(tmp_path, name):
    film(tmp_path, hover(0, 3)).check()
    content = bytearray((tmp_path / name).read_bytes())
    content[len(content) // 2] ^= 4
    (tmp_path / name).write_bytes(content)
    with pytest.raises(ProductError, match=rf"{name} is damaged"):
        Frames.load(tmp_path).check()


def test_a_frame_index_with_a_missing_row_is_found_at_load(tmp_path):
    frames = film(tmp_path, hover(0, 3))
    frames.table.drop(index=1).to_parquet(tmp_path / "frames.parquet", index=False)
    with pytest.raises(ProductError, match=r"flight 0 has 2 rows that are not numbered from 0 to 1"):
        Frames.load(tmp_path)


def test_a_frame_index_with_a_flipped_bit_is_found_at_load(tmp_path):
    film(tmp_path, hover(0, 30))
    path = tmp_path / "frames.parquet"
    content = bytearray(path.read_bytes())
    content[200] ^= 1  # in the first column's pages
    path.write_bytes(content)
    with pytest.raises(ProductError, match="no whole `frames` product"):
        Frames.load(tmp_path)


def test_a_flight_whose_videos_are_not_listed_is_found_at_load(tmp_path):
    film(tmp_path, hover(0, 2), hover(1, 2))
    videos = json.loads((tmp_path / "videos.json").read_text())
    (tmp_path / "videos.json").write_text(json.dumps([v for v in videos if not v["path"].startswith("0001")]))
    with pytest.raises(ProductError, match=r"does not know 0001/rgb.mp4"):
        Frames.load(tmp_path)


def test_a_person_is_told_that_the_renderer_compiles_and_only_then(monkeypatch):
    heard = []
    monkeypatch.setattr(cpu.kernels, "compiled", lambda: False)
    monkeypatch.setattr(cpu, "PATIENCE", 0.01)
    release = threading.Event()
    monkeypatch.setattr(cpu, "_first_picture", lambda: release.wait(0.1))
    with listening(lambda *report: heard.append(report)):
        cpu.compile_kernels()
    assert heard == [(cpu.COMPILING, 0, 1), (cpu.COMPILING, 1, 1)]
    monkeypatch.setattr(cpu, "_first_picture", lambda: None)
    with listening(lambda *report: heard.append(report)):
        cpu.compile_kernels()
    assert len(heard) == 2


@pytest.mark.parametrize(
    ("colour", "expected"),
    [((255, 255, 255), (235, 128, 128)), ((0, 0, 0), (16, 128, 128)), ((255, 0, 0), (81, 90, 240))],
)
def test_pure_colours_have_their_textbook_values_in_yuv(colour, expected):
    planes = yuv420p(np.full((4, 6, 3), colour, np.uint8))
    assert planes.shape == (6, 6)
    assert [set(rows.ravel()) for rows in (planes[:4], planes[4], planes[5])] == [{value} for value in expected]
