"""The GPU back end: what it hands to gsplat and makes of the answer, by a stand-in; and gsplat itself where it runs."""

import sys
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
import torch
from clouds import camera, cloud_of, random_cloud
from oracle import splat

from flymirage_core.errors import InputError
from flymirage_core.rendering import gsplat_backend
from flymirage_core.rendering.camera import Camera, Intrinsics
from flymirage_core.rendering.cpu import CpuRasterizer
from flymirage_core.rendering.gsplat_backend import GsplatRasterizer, batches
from flymirage_core.rendering.rasterizer import Rendering
from flymirage_core.settings import Settings
from flymirage_core.splats.cloud import GaussianCloud
from flymirage_core.splats.files import read_cloud
from resources.tools import choose_rasterizer


class StandIn(ModuleType):
    """gsplat's ``rasterization``, as far as its documentation promises, rendered by the float64 oracle."""

    def __init__(self) -> None:
        super().__init__("gsplat")
        self.calls: list[int] = []

    def rasterization(
        self, means, quats, scales, opacities, colors, viewmats, Ks, width, height, near_plane=0.01, far_plane=1e10,
        radius_clip=0.0, eps2d=0.3, sh_degree=None, packed=True, tile_size=16, backgrounds=None, render_mode="RGB",
    ):  # fmt: skip
        n, c = len(means), len(viewmats)
        shapes = [(means, (n, 3)), (quats, (n, 4)), (scales, (n, 3)), (opacities, (n,))]
        shapes += [
            (colors, (n, (sh_degree + 1) ** 2, 3)),
            (viewmats, (c, 4, 4)),
            (Ks, (c, 3, 3)),
            (backgrounds, (c, 3)),
        ]
        for tensor, shape in shapes:
            assert tensor.shape == shape and tensor.dtype == torch.float32 and tensor.is_contiguous()
        assert n and render_mode == "RGB+ED" and packed and not backgrounds.any()
        assert (near_plane, far_plane, eps2d, radius_clip) == (0.01, 1e10, 0.3, 0.0)
        self.calls.append(c)
        cloud = GaussianCloud(*(t.numpy() for t in (means, quats[:, [1, 2, 3, 0]], scales, opacities, colors)))
        colours, alphas = [], []
        for T_camera_world, K in zip(viewmats.double().numpy(), Ks.double().numpy(), strict=True):
            intrinsics = Intrinsics(width, height, K[0, 0], K[1, 1], K[0, 2], K[1, 2])
            rgb, depth, alpha = splat(cloud, Camera(intrinsics, np.linalg.inv(T_camera_world)))
            colours.append(np.dstack([rgb, depth]))
            alphas.append(alpha[..., None])
        return torch.tensor(np.array(colours)).float(), torch.tensor(np.array(alphas)).float(), {}


@pytest.fixture
def gsplat(monkeypatch) -> StandIn:
    stand_in = StandIn()
    stand_in.__spec__ = object()  # what `find_spec` answers
    monkeypatch.setitem(sys.modules, "gsplat", stand_in)
    monkeypatch.setattr(torch.cuda, "is_available", lambda: True)
    return stand_in


def assert_alike(found: Rendering, expected: Rendering) -> None:
    assert found.rgb.dtype == np.uint8 and found.depth.dtype == found.alpha.dtype == np.float32
    difference = np.abs(found.rgb.astype(int) - expected.rgb)
    assert np.mean(difference > 2) < 0.005 and np.mean(difference) < 0.1
    assert np.quantile(np.abs(found.alpha - expected.alpha), 0.995) < 1e-3
    solid = (found.alpha > 0.501) & (expected.alpha > 0.501)
    assert solid.any() and np.quantile(np.abs(found.depth - expected.depth)[solid], 0.995) < 0.005
    assert (found.depth[found.alpha < 0.5] == 0).all()


@pytest.mark.parametrize("degree", [0, 2])
def test_both_back_ends_make_the_same_pictures(gsplat, degree):
    cloud = random_cloud(degree, 800, degree)
    views = [
        camera([-4, -6, 2], [0.5, 1, -0.3]),
        camera([-4, -6, 2], [0.4, 1, -0.2]),
        camera([5, 0, 0], [-1, 0, 0], 40),
    ]
    found = list(GsplatRasterizer("cpu").render(cloud, views))
    assert gsplat.calls == [2, 1]  # two pictures of one size are one call
    for picture, expected in zip(found, CpuRasterizer(1).render(cloud, views), strict=True):
        assert_alike(picture, expected)


def test_gaussians_that_cannot_be_drawn_never_reach_the_card(gsplat):
    cloud = cloud_of({}, {"means": [np.nan, 0, 0]}, {"opacities": 0}, {"quaternions": [0, 0, 0, 0]})
    rasterizer = GsplatRasterizer("cpu")
    assert_alike(next(rasterizer.render(cloud, [camera()])), next(CpuRasterizer(1).render(cloud, [camera()])))
    blank = next(rasterizer.render(cloud[1:], [camera()]))
    assert not blank.rgb.any() and not blank.depth.any() and blank.alpha.shape == (72, 96)


def test_a_call_holds_no_more_than_fits_a_card():
    views = [camera()] * 7 + [camera(width=2000, height=2000)] * 3
    assert [len(b) for b in batches(views, 10)] == [7, 2, 1]
    assert [len(b) for b in batches(views[:7], gsplat_backend.BATCH_GAUSSIANS // 2)] == [2, 2, 2, 1]
    assert [len(b) for b in batches(views[:2], 10**12)] == [1, 1]
    assert list(batches([], 5)) == []


def test_auto_takes_gsplat_where_it_is_and_the_cpu_where_not(gsplat, monkeypatch):
    assert choose_rasterizer(Settings()).name.startswith("gsplat")
    assert choose_rasterizer(Settings(renderer="cpu")).name == "cpu"
    monkeypatch.setattr(torch.cuda, "is_available", lambda: False)
    assert choose_rasterizer(Settings()).name == "cpu"


def test_asking_for_gsplat_where_it_is_missing_says_what_to_install(monkeypatch):
    monkeypatch.setattr(gsplat_backend.importlib.util, "find_spec", lambda name: None)
    with pytest.raises(InputError, match=r"gsplat is not installed: pip install 'flymirage\[gpu\]'"):
        choose_rasterizer(Settings(renderer="gsplat"))


def test_asking_for_gsplat_without_a_card_says_so(gsplat, monkeypatch):
    monkeypatch.setattr(torch.cuda, "is_available", lambda: False)
    with pytest.raises(InputError, match=r"finds no CUDA card: pip install 'flymirage\[gpu\]'"):
        choose_rasterizer(Settings(renderer="gsplat"))


needs_cuda = pytest.mark.skipif(bool(gsplat_backend.why_unusable()), reason=f"no CUDA: {gsplat_backend.why_unusable()}")


@needs_cuda
@pytest.mark.parametrize("degree", [0, 1, 2, 3])
def test_gsplat_itself_agrees_on_a_cloud_of_all_shapes(degree):
    cloud = random_cloud(degree, 20_000, degree)
    views = [camera([-4, -6, 2], [0.5, 1, -0.3], 320, 240), camera([0.2, -0.1, 0.3], [1, 0.2, 0], 320, 240)]
    pairs = zip(GsplatRasterizer().render(cloud, views), CpuRasterizer().render(cloud, views), strict=True)
    for picture, expected in pairs:
        print(f"SH {degree}: {psnr(picture, expected):.1f} dB")
        assert_alike(picture, expected)


@needs_cuda
@pytest.mark.parametrize("room", ["bedroom_sw_lod2.spz", "family_dining_lod2.spz"])
def test_gsplat_itself_agrees_on_a_captured_room(captured_worlds: Path, room: str):
    cloud = read_cloud(captured_worlds / room)
    pose = np.eye(4)
    views = [Camera(Intrinsics.from_horizontal_fov(640, 480, 1.4), pose)]
    picture, expected = (next(r.render(cloud, views)) for r in (GsplatRasterizer(), CpuRasterizer()))
    print(f"{room}: {psnr(picture, expected):.1f} dB")
    assert psnr(picture, expected) > 45
    assert_alike(picture, expected)


def psnr(found: Rendering, expected: Rendering) -> float:
    error = np.mean((found.rgb.astype(float) - expected.rgb) ** 2)
    return float(10 * np.log10(255**2 / max(error, 1e-9)))
