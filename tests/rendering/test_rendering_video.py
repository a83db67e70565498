"""Videos: depth without loss, RGB near enough, the same bytes again, and damage found."""

from collections.abc import Iterable
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from flymirage_core.errors import InputError, ProductError
from flymirage_core.rendering.image_stack import ImageStackWriter, read_images, read_images_at
from flymirage_core.rendering.video import read_rgb, read_rgb_at, write_rgb


def write_depth(path: Path, frames: Iterable[np.ndarray]) -> int:
    with ImageStackWriter(path) as writer:
        for frame in frames:
            writer.append(frame)
    return writer.count


def smooth_pictures(count: int, width: int = 64, height: int = 48) -> list[np.ndarray]:
    """Slowly changing colours, as a camera sees."""
    y, x = np.mgrid[:height, :width]
    planes = [[128 + 100 * np.sin(x / 17 + t / 9 + c) * np.cos(y / 13 - c) for c in range(3)] for t in range(count)]
    return [np.stack(plane, axis=-1).astype(np.uint8) for plane in planes]


@settings(max_examples=15, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.integers(0, 2**32 - 1), st.integers(1, 7), st.integers(8, 50), st.integers(8, 50))
def test_any_depth_comes_back_exactly(tmp_path: Path, seed: int, count: int, width: int, height: int):
    frames = np.random.default_rng(seed).integers(0, 2**16, (count, height, width)).astype(np.uint16)
    assert write_depth(tmp_path / "depth.zip", iter(frames)) == count
    back = list(read_images(tmp_path / "depth.zip", count))
    assert back[0].dtype == np.uint16
    np.testing.assert_array_equal(back, frames)


def test_colours_come_back_within_a_few_grey_levels_and_without_a_tint(tmp_path):
    frames = smooth_pictures(9)
    write_rgb(tmp_path / "rgb.mp4", iter(frames), 10)
    error = np.array(list(read_rgb(tmp_path / "rgb.mp4", 9)), float) - frames
    assert np.sqrt(np.mean(error**2)) < 3 and np.abs(error.mean(axis=(0, 1, 2))).max() < 0.6


def test_the_same_frames_give_the_same_bytes(tmp_path):
    frames = smooth_pictures(5)
    for name in ("a", "b"):
        write_rgb(tmp_path / f"{name}.mp4", frames, 10)
        write_depth(tmp_path / f"{name}.zip", [f[:, :, 0].astype(np.uint16) * 100 for f in frames])
    assert (tmp_path / "a.mp4").read_bytes() == (tmp_path / "b.mp4").read_bytes()
    assert (tmp_path / "a.zip").read_bytes() == (tmp_path / "b.zip").read_bytes()


def test_rgb_video_of_an_odd_size_is_refused_in_one_sentence(tmp_path):
    with pytest.raises(InputError, match=r"63 x 48 pixels; .*even width"):
        write_rgb(tmp_path / "rgb.mp4", smooth_pictures(1, width=63), 10)


def test_a_frame_of_another_size_is_refused(tmp_path):
    frames = [np.zeros((8, 8), np.uint16), np.zeros((8, 10), np.uint16)]
    with pytest.raises(InputError, match="frame 1 is 10 x 8 pixels, the first was 8 x 8"):
        write_depth(tmp_path / "depth.zip", frames)


def test_a_video_without_frames_is_refused(tmp_path):
    with pytest.raises(InputError, match="no frame"):
        write_rgb(tmp_path / "rgb.mp4", [], 10)


@pytest.mark.parametrize("kept", [0.0, 0.01, 0.5, 0.9])
@pytest.mark.parametrize("kind", ["rgb.mp4", "depth.zip"])
def test_a_torn_video_is_told_from_a_whole_one(tmp_path, kind, kept):
    path, frames = tmp_path / kind, smooth_pictures(20)
    if kind == "rgb.mp4":
        write_rgb(path, frames, 10)
    else:
        write_depth(path, [f[:, :, 0].astype(np.uint16) for f in frames])
    path.write_bytes(path.read_bytes()[: int(path.stat().st_size * kept)])
    with pytest.raises(ProductError, match="materialise `frames` again"):
        list((read_rgb if kind == "rgb.mp4" else read_images)(path, 20))


def test_a_missing_video_is_one_sentence(tmp_path):
    with pytest.raises(ProductError, match=r"rgb.mp4 is missing or torn"):
        next(read_rgb(tmp_path / "rgb.mp4", 1))


@settings(max_examples=10, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.lists(st.integers(0, 10), max_size=5), st.sampled_from([5.0, 10.0, 30.0]))
def test_any_frame_can_be_read_without_those_before_it(tmp_path: Path, indices: list[int], rate: float):
    frames = smooth_pictures(11)
    depths = [np.full((48, 64), 100 + t, np.uint16) for t in range(11)]
    write_rgb(tmp_path / "rgb.mp4", iter(frames), rate)
    write_depth(tmp_path / "depth.zip", iter(depths))
    in_order = list(read_rgb(tmp_path / "rgb.mp4", 11))
    picked = read_rgb_at(tmp_path / "rgb.mp4", indices)
    assert len(picked) == len(indices)
    assert all((picture == in_order[i]).all() for picture, i in zip(picked, indices, strict=True))
    assert [int(d[0, 0]) - 100 for d in read_images_at(tmp_path / "depth.zip", indices)] == indices


def test_a_frame_beyond_the_end_is_one_sentence(tmp_path):
    write_rgb(tmp_path / "rgb.mp4", iter(smooth_pictures(3)), 10)
    with pytest.raises(ProductError, match="has no whole frame 7"):
        read_rgb_at(tmp_path / "rgb.mp4", [7])


def test_a_damaged_depth_frame_is_named_and_the_others_still_read(tmp_path):
    write_depth(tmp_path / "depth.zip", [np.full((48, 64), 100 + t, np.uint16) for t in range(5)])
    content = bytearray((tmp_path / "depth.zip").read_bytes())
    content[content.index(b"000002.jxl") + 20] ^= 1  # in the picture, after its name
    (tmp_path / "depth.zip").write_bytes(content)
    assert [int(d[0, 0]) for d in read_images_at(tmp_path / "depth.zip", [1, 3])] == [101, 103]
    with pytest.raises(ProductError, match="has no whole frame 2"):
        list(read_images(tmp_path / "depth.zip", 5))
