"""`write_gallery`: index.html with the plots, scenes/<scene>.html with videos and prompts, scenes/<scene>-3d.html."""

from collections.abc import Callable, Iterable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from flymirage_core.dataset.episodes import episodes_of
from flymirage_core.dataset.gallery.pages import data_uri, flight_card, front_page, scene_page
from flymirage_core.dataset.gallery.scene_view import scene_html
from flymirage_core.dataset.scene_products import SceneProducts, SceneSource
from flymirage_core.dataset.statistics import SceneShare
from flymirage_core.errors import InputError
from flymirage_core.files import link_or_copy
from flymirage_core.splats.cloud import GaussianCloud

MARK = "gallery.txt"
"""Lies in every gallery, so that no other folder is written into."""


def write_gallery(scenes: Iterable[tuple[SceneSource, Callable[[], GaussianCloud]]], folder: Path) -> Path:
    """Write the gallery of scenes, each with a way to load its splats; returns the path of index.html.

    Without viser there are no 3D pages, and the scene pages say how to get them. Raises `InputError` if ``folder``
    holds something else.
    """
    if folder.exists() and any(folder.iterdir()) and not (folder / MARK).exists():
        raise InputError(f"{folder} is not empty and no gallery; choose another folder, or empty this one")
    (folder / "scenes").mkdir(parents=True, exist_ok=True)
    (folder / MARK).write_text("A gallery written by FlyMirage: open index.html.\n")
    shares: list[SceneShare] = []
    thumbnails: dict[str, NDArray[np.uint8]] = {}
    for source, load_cloud in scenes:
        products = source.products()
        shares.append(SceneShare.of(products, tuple(episodes_of(products))))
        if len(products.trajectories):
            first = products.trajectories.flights[0].flight_id
            thumbnails[products.scene] = products.frames.flight(first).rgb_at([0])[0]
        _write_scene(folder / "scenes", products, load_cloud, shares[-1])
    index = folder / "index.html"
    index.write_text(front_page(tuple(shares), thumbnails))
    return index


def _write_scene(
    folder: Path, products: SceneProducts, load_cloud: Callable[[], GaussianCloud], share: SceneShare
) -> None:
    view = f"{products.scene}-3d.html"
    try:
        (folder / view).write_text(scene_html(products, load_cloud()))
    except InputError:
        view = ""
    page = scene_page(share, products.description.prose, _flight_cards(folder, products), view)
    (folder / f"{products.scene}.html").write_text(page)


def _flight_cards(folder: Path, products: SceneProducts) -> str:
    splits = {e.flight_id: e.split for e in episodes_of(products)}
    verdicts = {v.flight_id: v for v in products.verdicts}
    videos = folder / products.scene
    videos.mkdir(exist_ok=True)
    cards = []
    for flight in sorted(products.trajectories, key=lambda f: (f.flight_id not in splits, f.flight_id)):
        frames = products.frames.flight(flight.flight_id)
        video = videos / f"{flight.flight_id:04d}.mp4"
        video.unlink(missing_ok=True)
        link_or_copy(frames.folder / "rgb.mp4", video)
        cards.append(
            flight_card(
                flight,
                products.boxes.by_id(flight.object_id).label,
                splits.get(flight.flight_id, ""),
                verdicts.get(flight.flight_id),
                products.prompts.of_flight(flight.flight_id),
                f"{products.scene}/{video.name}",
                data_uri(frames.rgb_at([len(frames) - 1])[0]),
            )
        )
    return "".join(cards)
