"""What the gates measure: pictures against formulae, neighbouring frames against each other, flights by the clock."""

from dataclasses import replace

import cv2
import numpy as np
import pytest
from filmed_room import box, camera_at, flight_to, furnished_room, ray_cast
from hypothesis import given, settings
from hypothesis import strategies as st

from flymirage_core.annotation.boxes import BoxMap
from flymirage_core.language.evidence import Sighting
from flymirage_core.language.gates import floater_gate, hover_gate, target_size_gate
from flymirage_core.language.picture_measures import blur_effect, contrast, largest_hole, noise_level
from flymirage_core.language.reprojection import change
from flymirage_core.language.settings import VerdictSettings
from flymirage_core.rendering.camera import Camera, Intrinsics, look_along

ROOM = furnished_room()
CHAIR = ROOM.by_id(0)
SETTINGS = VerdictSettings()
LENS = Intrinsics.from_horizontal_fov(160, 120, np.radians(80))


def seen(x: float, index: int, boxes: BoxMap = ROOM, gain: float = 1.0) -> Sighting:
    """The room from x metres towards the chair, looking at it."""
    camera = Camera(LENS, look_along((x, 0.7 * x, 1.2), (3.0, 2.0, -0.3)))
    rgb, depth = ray_cast(camera, boxes)
    return Sighting(index, camera, np.clip(rgb * gain, 0, 255).astype(np.uint8), depth)


def texture(seed: int, size: int = 96) -> np.ndarray:
    """Smooth structure at several scales, 0..255."""
    generator = np.random.default_rng(seed)
    layers = [
        cv2.resize(generator.uniform(0, 1, (n, n)), (size, size), interpolation=cv2.INTER_CUBIC) for n in (4, 9, 24)
    ]
    mixed = sum(layers) / 3
    return np.asarray(255 * (mixed - mixed.min()) / (mixed.max() - mixed.min()), np.float32)


class TestPictures:
    @settings(max_examples=25)
    @given(st.floats(2.0, 30.0), st.integers(0, 99))
    def test_noise_is_measured_in_its_own_grey_levels(self, sigma: float, seed: int) -> None:
        ramp = np.add.outer(np.arange(200.0), np.arange(200.0)) / 2
        noisy = ramp + np.random.default_rng(seed).normal(0, sigma, ramp.shape)
        assert noise_level(noisy.astype(np.float32)) == pytest.approx(sigma, rel=0.06)
        assert noise_level(ramp.astype(np.float32)) == pytest.approx(0.0, abs=1e-4)

    @settings(max_examples=25)
    @given(st.integers(0, 999))
    def test_more_blur_is_more_blur_effect_whatever_the_picture_and_its_contrast(self, seed: int) -> None:
        sharp = texture(seed)
        effects = [blur_effect(sharp if s == 0 else cv2.GaussianBlur(sharp, (0, 0), s)) for s in (0, 1.5, 3, 6)]
        assert effects == sorted(effects) and effects[0] >= 0 and effects[-1] <= 1
        assert blur_effect(sharp * np.float32(0.3)) == pytest.approx(effects[0], abs=1e-4)

    def test_a_picture_of_nothing_is_wholly_blurred_and_without_contrast(self) -> None:
        grey = np.full((40, 60), 128, np.float32)
        assert blur_effect(grey) == 1.0 and contrast(grey) == 0.0

    def test_the_largest_of_two_holes_counts_and_specks_do_not_add_up(self) -> None:
        depth = np.full((100, 100), 2000, np.uint16)
        depth[10:20, 10:20] = depth[50:70, 50:70] = 0
        depth[::10, 0] = 0
        assert largest_hole(depth) == pytest.approx(0.04)
        assert largest_hole(np.full((4, 4), 9, np.uint16)) == 0.0


class TestNeighbours:
    def test_a_still_room_does_not_change_when_the_camera_moves(self) -> None:
        found = change(seen(0.0, 0), seen(0.1, 1))
        assert found is not None and found.colour < 2 and found.depth < 0.02

    def test_brightness_that_jumps_is_flicker_and_no_depth_jump(self) -> None:
        found = change(seen(0.0, 0), seen(0.1, 1, gain=0.7))
        assert found is not None and found.colour > 20 and found.depth < 0.02

    def test_a_thing_that_pops_up_is_a_depth_jump(self) -> None:
        popped = BoxMap((*ROOM.boxes, box(9, "crate", (2.0, 1.4, 1.1), (0.8, 0.8, 0.8))))
        found = change(seen(0.0, 0), seen(0.1, 1, popped))
        assert found is not None and found.depth > 0.05

    def test_two_views_without_anything_in_common_are_not_compared(self) -> None:
        back = Camera(LENS, look_along((0.0, 0.0, 1.2), (-1.0, 0.0, 0.0)))
        assert change(seen(0.0, 0), Sighting(1, back, *ray_cast(back, ROOM))) is None


class TestFlights:
    def test_what_is_nearer_than_the_map_leaves_room_for_is_a_floater(self) -> None:
        near = BoxMap((*ROOM.boxes, box(9, "fluff", (0.3, 0.2, 1.2), (0.05, 0.05, 0.05))))
        room = np.array([0.8])
        assert floater_gate([seen(0.0, 0)], room, SETTINGS).value == 0.0
        gate = floater_gate([seen(0.0, 0, near)], room, SETTINGS)
        assert not gate.passed and "floaters fill" in gate.reason
        assert floater_gate([seen(0.0, 0, near)], np.array([0.3]), SETTINGS).passed, "it may be what the map knows"

    def test_hovering_counts_only_while_the_drone_does_not_turn(self) -> None:
        flight = flight_to(CHAIR, 0, frames=60)
        still = replace(flight, velocities=np.zeros_like(flight.velocities))
        spun = replace(still, yaws=0.3 * flight.times)
        frozen = replace(still, yaws=np.zeros_like(flight.yaws))
        assert hover_gate(flight, SETTINGS).passed and hover_gate(spun, SETTINGS).passed
        gate = hover_gate(frozen, SETTINGS)
        assert not gate.passed and gate.value == pytest.approx(flight.times[-1], abs=0.1)

    def test_a_target_that_is_a_speck_at_the_end_is_too_small(self) -> None:
        camera = camera_at(flight_to(CHAIR, 0), 0.0)
        last = Sighting(0, camera, *ray_cast(camera, ROOM))
        assert target_size_gate(last, CHAIR, SETTINGS).passed
        speck = replace(CHAIR, size=(0.02, 0.02, 0.02), centre=(5.5, 5.5, 1.0))
        gate = target_size_gate(last, speck, SETTINGS)
        assert not gate.passed and "of the last picture" in gate.reason
