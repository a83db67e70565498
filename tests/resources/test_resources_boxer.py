"""The Boxer adapter against a stand-in with Boxer's outside, and against each way in which the real one fails."""

import json
import math
import shutil
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from flymirage_core.annotation.settings import AnnotationSettings, BoxerSettings
from flymirage_core.errors import InputError, ServiceError
from flymirage_core.rendering.camera import Camera, Intrinsics, look_along
from flymirage_core.rendering.rasterizer import Rendering
from flymirage_core.rendering.views import View
from flymirage_core.settings import Settings
from resources.annotators import choose_annotator
from resources.boxer import BoxerAnnotator, plain_noun

CENTRE, SIZE, YAW = (1.0, 2.0, 0.5), (0.8, 0.4, 1.0), 0.4
INTRINSICS = Intrinsics.from_horizontal_fov(32, 24, math.radians(90))


@pytest.fixture
def checkout(tmp_path: Path) -> Path:
    home = tmp_path / "boxer"
    home.mkdir()
    shutil.copyfile(Path(__file__).with_name("boxer_stand_in.py"), home / "run_boxer.py")
    set_thing(home)
    return home


def set_thing(home: Path, **changes: object) -> None:
    thing = {"centre": CENTRE, "size": SIZE, "yaw": YAW, "name": "trash_can", "prob": 0.8, **changes}
    (home / "thing.json").write_text(json.dumps(thing))


def annotator(home: Path, **boxer: object) -> BoxerAnnotator:
    settings = BoxerSettings(home=str(home), python=sys.executable, **boxer)
    return BoxerAnnotator(AnnotationSettings(boxer=settings))


def views(distances: list[float]) -> list[View]:
    """Views of a red plane through the thing's middle, from so many metres before it."""
    found = []
    for distance in distances:
        position = np.array(CENTRE) - [0, distance, 0]
        red = np.full((24, 32, 3), (170, 30, 30), np.uint8)
        depth = np.full((24, 32), distance, np.float32)
        found.append(
            View(Camera(INTRINSICS, look_along(position, [0, 1, 0])), Rendering(red, depth, np.ones((24, 32))))
        )
    return found


NEAR = [1.5, 1.6, 1.7, 1.8, 1.9]


def test_a_thing_seen_in_many_views_is_one_box_where_it_is_in_the_world(checkout):
    (box,) = annotator(checkout).annotate(views(NEAR), 3.0)
    assert box.centre == pytest.approx(CENTRE, abs=1e-6)
    assert box.size == pytest.approx(SIZE)
    assert box.yaw == pytest.approx(YAW)
    assert (box.label, box.label_source, box.supporting_frames) == ("trash can", "boxer", len(NEAR))
    assert box.nearest_camera_distance == pytest.approx(1.5)


def test_its_colour_is_measured_in_our_own_pictures(checkout):
    (box,) = annotator(checkout).annotate(views(NEAR), 3.0)
    assert "red" in box.colour


def test_a_box_of_boxer_says_so_because_of_its_licence(checkout):
    (box,) = annotator(checkout).annotate(views(NEAR), 3.0)
    assert box.annotator.startswith("boxer ")


def test_detections_beyond_the_distance_from_their_camera_are_dropped_before_fusion(checkout):
    far = views([*NEAR, 3.5, 4.0])
    (box,) = annotator(checkout).annotate(far, 3.0)
    assert box.supporting_frames == len(NEAR)
    assert len(annotator(checkout).annotate(views([3.2, 3.5, 3.6, 4.0, 5.0]), 3.0)) == 0
    assert len(annotator(checkout).annotate(views([3.2, 3.5, 3.6, 4.0, 5.0]), math.inf)) == 1


def test_doubtful_detections_are_dropped(checkout):
    set_thing(checkout, prob=0.5)
    assert len(annotator(checkout).annotate(views(NEAR), 3.0)) == 0


def test_settings_reach_the_program(checkout, tmp_path):
    weights = tmp_path / "weights.ckpt"
    annotator(checkout, labels=("chair", "red box"), threshold_2d=0.3, checkpoint=str(weights)).annotate(views(NEAR), 3)
    asked = json.loads((checkout / "asked.json").read_text())
    assert (asked["labels"], asked["thresh2d"], asked["ckpt"]) == (["chair", "red box"], 0.3, str(weights))
    assert asked["skip_viz"] is True


@pytest.mark.parametrize("fault", ["empty", "no table"])
def test_a_program_that_finds_nothing_gives_an_empty_map(checkout, fault):
    set_thing(checkout, fault=fault)
    assert len(annotator(checkout).annotate(views(NEAR), 3.0)) == 0


def test_no_views_need_no_program(checkout):
    assert len(annotator(checkout).annotate([], 3.0)) == 0
    assert not (checkout / "asked.json").exists()


@pytest.mark.parametrize(
    ("fault", "words"),
    [
        ("weights", "scripts/download_ckpts.sh"),
        ("cuda", "nvidia-smi"),
        ("half way", "exit status 1.*Segmentation fault"),
        ("other columns", "no column 'prob'"),
    ],
)
def test_a_program_that_fails_is_one_clear_sentence(checkout, fault, words):
    set_thing(checkout, fault=fault)
    with pytest.raises(ServiceError, match=words):
        annotator(checkout).annotate(views(NEAR), 3.0)


def test_a_number_that_is_none_is_refused_with_its_line(checkout):
    set_thing(checkout, prob="nan")
    with pytest.raises(ServiceError, match="line 2"):
        annotator(checkout).annotate(views(NEAR), 3.0)


def test_a_program_that_hangs_is_stopped_with_all_that_it_started(checkout):
    set_thing(checkout, fault="hang")
    with pytest.raises(ServiceError, match="had not finished after 2 s"):
        annotator(checkout, timeout=2.0).annotate(views(NEAR), 3.0)
    child = Path("/proc") / (checkout / "child.pid").read_text()  # it ignores SIGTERM
    deadline = time.monotonic() + 5
    while child.exists() and "Z" not in (child / "stat").read_text().rpartition(")")[2]:
        assert time.monotonic() < deadline


def test_a_missing_checkout_or_interpreter_is_named(checkout, tmp_path):
    with pytest.raises(InputError, match=r"annotation\.boxer\.home"):
        annotator(tmp_path / "nothing")
    settings = AnnotationSettings(boxer=BoxerSettings(home=str(checkout), python="/nowhere/python"))
    with pytest.raises(InputError, match=r"annotation\.boxer\.python"):
        BoxerAnnotator(settings).annotate(views(NEAR), 3.0)


def test_the_setting_chooses_the_annotator(checkout):
    boxer = Settings(tools={"annotator": "boxer"}, annotation={"boxer": {"home": str(checkout)}})
    assert choose_annotator(boxer).name == "boxer"
    assert choose_annotator(Settings(annotation={"detector": "none"})).name == "embedded"


def test_names_of_the_lvis_kind_become_nouns():
    assert plain_noun("arctic_(type_of_shoe)") == "arctic"
    assert plain_noun("Trash_can") == "trash can"
