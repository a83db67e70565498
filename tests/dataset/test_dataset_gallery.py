"""The gallery in a real browser: no errors, nothing asked of the network, videos that play, scenes in 3D."""

import sys
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest
from filmed_room import furnished_room, renamed, scene_products

from flymirage_core.dataset.gallery.gallery import write_gallery
from flymirage_core.dataset.gallery.scene_view import MOST_SPLATS, SH_DC, visible_splats
from flymirage_core.dataset.gallery.svg_charts import bars
from flymirage_core.dataset.scene_products import SceneProducts
from flymirage_core.errors import InputError
from flymirage_core.splats.cloud import GaussianCloud

VISERS_OWN = "computeBoundingSphere(): Computed radius is NaN"
"""What viser 1.1's client itself logs of any splats: its quad has no bounding sphere. The picture is right."""


def splats(count: int) -> GaussianCloud:
    """Splats all over the boxes of the furnished room, and a ceiling."""
    chance = np.random.default_rng(5)
    boxes = furnished_room().boxes
    means = np.concatenate([b.centre + (chance.random((count // 5, 3)) - 0.5) * b.size for b in boxes])
    means[: count // 10] = chance.uniform((-6, -6, 2.95), (6, 6, 3.0), (count // 10, 3))
    n = len(means)
    quaternions = np.tile([0.0, 0.0, 0.0, 1.0], (n, 1))
    arrays = (means, quaternions, np.full((n, 3), 0.03), np.full(n, 0.9), chance.normal(0, 0.5, (n, 1, 3)))
    return GaussianCloud(*(a.astype(np.float32) for a in arrays))


def magenta_floor() -> GaussianCloud:
    """A colour that nothing else on the page has, all over the floor."""
    x, y = np.meshgrid(np.linspace(-6, 6, 60), np.linspace(-6, 6, 60))
    means = np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], axis=1)
    means[:60, 2] = 3.0  # a row of the ceiling, which is left out
    n = len(means)
    colour = np.tile((np.array([1.0, 0.0, 1.0]) - 0.5) / SH_DC, (n, 1, 1))
    arrays = (means, np.tile([0.0, 0.0, 0.0, 1.0], (n, 1)), np.full((n, 3), 0.15), np.full(n, 0.95), colour)
    return GaussianCloud(*(a.astype(np.float32) for a in arrays))


@pytest.fixture(scope="module")
def cafe(tmp_path_factory: pytest.TempPathFactory) -> SceneProducts:
    return scene_products(tmp_path_factory.mktemp("cafe"))


@pytest.fixture(scope="module")
def gallery(cafe: SceneProducts, tmp_path_factory: pytest.TempPathFactory) -> Path:
    pytest.importorskip("viser", reason="viser is not installed: pip install 'flymirage[view]'")
    folder = tmp_path_factory.mktemp("gallery") / "out"
    both = [(scene, magenta_floor) for scene in (cafe, renamed(cafe, "hall"))]
    return write_gallery(both, folder).parent


def test_every_flight_has_its_video_and_its_prompts(gallery: Path, cafe: SceneProducts) -> None:
    page = (gallery / "scenes" / "cafe.html").read_text()
    for flight in cafe.trajectories:
        assert (gallery / "scenes" / "cafe" / f"{flight.flight_id:04d}.mp4").exists()
        assert f'src="cafe/{flight.flight_id:04d}.mp4"' in page
    assert all(p.text in page for p in cafe.prompts)


def shows_the_world(png: bytes) -> bool:
    """The floor's splats fill a good part of the page, and boxes, flights and pictures bring many colours."""
    blue, green, red = np.moveaxis(cv2.imdecode(np.frombuffer(png, np.uint8), cv2.IMREAD_COLOR), -1, 0)
    floor = ((red > 180) & (green < 130) & (blue > 180)).mean()
    return floor > 0.05 and len(np.unique(np.stack([red, green], axis=-1).reshape(-1, 2), axis=0)) > 200


def test_a_browser_draws_it_finds_no_error_and_asks_nobody(gallery: Path) -> None:
    browser = pytest.importorskip("browser", reason="websockets is not installed: it comes with viser")
    if browser.CHROMIUM is None:
        pytest.skip("no chromium on this machine: apt-get install chromium")
    count = "document.querySelectorAll('svg rect').length"
    front = browser.visit((gallery / "index.html").as_uri(), 1.5, count)
    assert front.answer > 15
    play = (
        "Promise.race([new Promise(done => {const v = document.querySelector('video');"
        "v.onloadeddata = () => done(v.videoWidth); v.onerror = () => done('error'); v.load(); v.play()}),"
        "new Promise(done => setTimeout(() => done('never'), 50000))])"
    )
    scene = browser.visit((gallery / "scenes" / "cafe.html").as_uri(), 6, play)
    assert scene.answer == 64  # the video's width: it was decoded
    canvas = (
        "new Promise(done => {const look = () => "
        "document.querySelector('canvas') ? done(true) : setTimeout(look, 200); look();})"
    )
    world = browser.visit((gallery / "scenes" / "cafe-3d.html").as_uri(), 3, canvas, shows_the_world, size=(640, 480))
    assert world.answer is True and world.shown, "the splats, or what stands on them, are not on the canvas"
    for seen in (front, scene, world):
        assert [error for error in seen.errors if VISERS_OWN not in error] == []
        assert [url for url in seen.requests if not url.startswith(("file:", "data:", "blob:"))] == []


def test_an_indoor_scene_has_no_ceiling_and_few_enough_splats(cafe: SceneProducts) -> None:
    cloud = splats(MOST_SPLATS + 50_000)
    shown = visible_splats(cloud, cafe, np.array([6.0, 6.0, 3.0]))
    assert len(shown) == MOST_SPLATS and shown.means[:, 2].max() < 2.8
    again = visible_splats(cloud, cafe, np.array([6.0, 6.0, 3.0]))
    np.testing.assert_array_equal(shown.means, again.means)
    outdoors = cafe.description.model_copy(update={"setting": "outdoor"})
    assert visible_splats(splats(500), replace(cafe, description=outdoors), np.full(3, 3.0)).means[:, 2].max() > 2.9


def test_without_viser_the_scene_page_says_how_to_get_it(
    cafe: SceneProducts, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "viser", None)
    write_gallery([(cafe, lambda: splats(100))], tmp_path / "out")
    assert "flymirage[view]" in (tmp_path / "out" / "scenes" / "cafe.html").read_text()


def test_a_folder_with_other_things_in_it_is_left_alone(cafe: SceneProducts, tmp_path: Path) -> None:
    (tmp_path / "thesis.tex").write_text("years of work")
    with pytest.raises(InputError, match="is not empty and no gallery"):
        write_gallery([(cafe, lambda: splats(100))], tmp_path)


def test_names_are_escaped_in_charts() -> None:
    assert "<script" not in bars("x<script>", {"<script>": 1.0})
