"""What the measured judge keeps and drops, and the reasons it gives."""

from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest
from filmed_room import box, camera_at, film, flight_to, furnished_room, ray_cast

from flymirage_core.annotation.boxes import BoxMap
from flymirage_core.errors import ProductError
from flymirage_core.language.evidence import Sighting, sampled_indices
from flymirage_core.language.gates import blur_gate, sees
from flymirage_core.language.judge import MeasuredJudge
from flymirage_core.language.verdicts import QualityVerdicts, Verdict
from flymirage_core.navigation.trajectories import Flight, Trajectories
from flymirage_core.settings import PlannerSettings, VerdictSettings

SETTINGS = VerdictSettings(max_noise=255.0, max_flicker=255.0, max_depth_jump=1.0, min_contrast=10.0)
"""Hard-edged chequers in 64 x 48 pixels: noise, flicker and depth are asked about in pictures of real scenes."""
ROOM = furnished_room()
CHAIR = ROOM.by_id(0)


def verdict(folder: Path, flight: Flight, boxes: BoxMap = ROOM, settings: VerdictSettings = SETTINGS) -> Verdict:
    (answer,) = MeasuredJudge(settings).judge(film(folder, [flight], ROOM), Trajectories((flight,)), boxes)
    return answer


def failed(answer: Verdict) -> set[str]:
    return {g.gate for g in answer.gates if not g.passed}


def test_a_clean_flight_to_its_target_is_kept_and_every_gate_shows_its_number(tmp_path: Path) -> None:
    answer = verdict(tmp_path, flight_to(CHAIR, 0))
    assert answer.keep and not answer.reasons
    assert len(answer.gates) == 18
    assert all(np.isfinite([g.value, g.threshold]).all() for g in answer.gates)


def test_a_flight_away_from_the_target_is_dropped_for_view_visibility_and_progress(tmp_path: Path) -> None:
    away = replace(flight_to(ROOM.by_id(1), 0), object_id=0)
    answer = verdict(tmp_path, away)
    assert not answer.keep
    assert failed(answer) == {"target_visible", "target_size", "final_view", "progress"}
    assert any("chair" in reason and "at the end" in reason for reason in answer.reasons)


def test_hovering_at_the_start_is_dropped_for_progress_alone(tmp_path: Path) -> None:
    flight = flight_to(CHAIR, 0)
    yaw = np.arctan2(CHAIR.centre[1], CHAIR.centre[0])
    level = np.tile([0.0, 0.0, np.sin(yaw / 2), np.cos(yaw / 2)], (len(flight.times), 1))
    hover = replace(flight, positions=np.tile(flight.positions[0], (len(flight.times), 1)), quaternions=level)
    assert failed(verdict(tmp_path, hover)) == {"progress"}


def test_grazing_a_wall_and_breaking_limits_and_missing_the_goal_are_three_reasons(tmp_path: Path) -> None:
    flight = flight_to(CHAIR, 0)
    report = replace(flight.report, min_clearance=0.05, max_speed=3.0, end_error=0.8)
    answer = verdict(tmp_path, replace(flight, report=report))
    assert failed(answer) == {"clearance", "feasibility", "arrival"}
    assert any("speed 3.00 m/s is 2.00 times" in reason for reason in answer.reasons)


def test_faster_limits_of_the_planner_are_the_judges_limits_too(tmp_path: Path) -> None:
    flight = flight_to(CHAIR, 0)
    fast = replace(flight, report=replace(flight.report, max_speed=3.0))
    judge = MeasuredJudge(SETTINGS, PlannerSettings(max_speed=3.0))
    assert judge.judge(film(tmp_path, [fast], ROOM), Trajectories((fast,)), ROOM).kept == (0,)


def test_one_frame_with_holes_drops_the_flight_and_names_the_frame(tmp_path: Path) -> None:
    flight = flight_to(CHAIR, 0)
    frames = film(tmp_path, [flight], ROOM)
    frames.table.loc[7, "alpha_coverage"] = 0.4
    (answer,) = MeasuredJudge(SETTINGS).judge(frames, Trajectories((flight,)), ROOM)
    assert failed(answer) == {"alpha_coverage"}
    assert answer.reasons[0].startswith("frame 7 has holes: only 40%")


def test_an_opening_that_most_flights_see_is_the_rooms_and_a_hole_that_one_sees_is_its_own(tmp_path: Path) -> None:
    flights = tuple(flight_to(CHAIR, i) for i in range(3))
    frames = film(tmp_path, list(flights), ROOM)
    judge, worst = MeasuredJudge(SETTINGS), {0: 0.86, 1: 1.0, 2: 1.0}
    frames.table["alpha_coverage"] = frames.table["flight_id"].map(worst)
    assert judge.judge(frames, Trajectories(flights), ROOM).kept == (1, 2)
    worst |= {1: 0.9, 2: 0.9}
    frames.table["alpha_coverage"] = frames.table["flight_id"].map(worst)
    assert judge.judge(frames, Trajectories(flights), ROOM).kept == (0, 1, 2)
    frames.table.loc[3, "alpha_coverage"] = 0.7
    assert judge.judge(frames, Trajectories(flights), ROOM).kept == (1, 2), "no room's door is as large as that"


@pytest.mark.parametrize(("gain", "offset", "gate"), [(0.05, 0, "darkness"), (0.05, 243, "glare")])
def test_dark_and_washed_out_pictures_are_dropped(tmp_path: Path, gain: float, offset: float, gate: str) -> None:
    flight = flight_to(CHAIR, 0)
    frames = film(tmp_path, [flight], ROOM, spoil=lambda rgb: (rgb * gain + offset).astype(np.uint8))
    (answer,) = MeasuredJudge(SETTINGS).judge(frames, Trajectories((flight,)), ROOM)
    assert gate in failed(answer) <= {gate, "contrast"}


def test_blur_fails_its_gate() -> None:
    camera = camera_at(flight_to(CHAIR, 0), 0.0)
    rgb, depth = ray_cast(camera, ROOM)
    settings = VerdictSettings(max_blur=0.2)
    sharp = blur_gate([Sighting(0, camera, rgb, depth)], settings)
    blurred = blur_gate([Sighting(0, camera, cv2.GaussianBlur(rgb, (0, 0), 3.0), depth)], settings)
    assert sharp.passed and not blurred.passed
    assert blurred.value > 3 * sharp.value


def test_a_target_behind_a_wall_is_in_the_picture_but_not_seen() -> None:
    camera = camera_at(flight_to(CHAIR, 0), 0.0)
    rgb, depth = ray_cast(camera, ROOM)
    assert sees(Sighting(0, camera, rgb, depth), CHAIR)
    wall = box(9, "wall", (1.5, 1.0, 1.5), (0.1, 4.0, 3.0), yaw=np.arctan2(2.0, 3.0))
    rgb, depth = ray_cast(camera, BoxMap((*ROOM, wall)))
    assert not sees(Sighting(0, camera, rgb, depth), CHAIR)


def test_no_depth_return_on_the_target_is_not_taken_for_a_view_of_it() -> None:
    camera = camera_at(flight_to(CHAIR, 0), 0.0)
    rgb, depth = ray_cast(camera, ROOM)
    assert not sees(Sighting(0, camera, rgb, np.zeros_like(depth)), CHAIR)


def test_the_papers_thirty_frames_are_one_second_at_any_rate_and_the_ends_always_count() -> None:
    assert sampled_indices(91, 30.0, 30) == [0, 30, 60, 90]
    assert sampled_indices(32, 10.0, 30) == [0, 10, 20, 30, 31]
    assert sampled_indices(1, 10.0, 30) == [0]


def test_a_torn_video_is_one_clear_sentence(tmp_path: Path) -> None:
    flight = flight_to(CHAIR, 0)
    frames = film(tmp_path, [flight], ROOM)
    video = tmp_path / "0000" / "rgb.mp4"
    video.write_bytes(video.read_bytes()[:500])
    with pytest.raises(ProductError, match=r"rgb\.mp4.*materialise `frames` again"):
        MeasuredJudge(SETTINGS).judge(frames, Trajectories((flight,)), ROOM)


def test_products_of_different_runs_are_told_apart(tmp_path: Path) -> None:
    stranger = replace(flight_to(CHAIR, 0), object_id=77)
    with pytest.raises(ProductError, match="object 77, not among the 5 boxes"):
        verdict(tmp_path, stranger)


def test_verdicts_come_back_from_disk_as_they_were(tmp_path: Path) -> None:
    verdicts = QualityVerdicts((verdict(tmp_path / "frames", flight_to(CHAIR, 0)),))
    verdicts.save(tmp_path / "verdicts")
    assert QualityVerdicts.load(tmp_path / "verdicts") == verdicts
