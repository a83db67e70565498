"""`flymirage stats`: the figures beside the paper's, from tables alone."""

import json
from pathlib import Path

import pytest
from filmed_room import scene_products

from flymirage_core.dataset.paper_figures import TABLES, figures, share_of_tables, statistics_of_export
from flymirage_core.dataset.statistics import statistics_of
from flymirage_core.errors import ProductError


@pytest.fixture(scope="module")
def folders(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """One scene's products, saved as the store has them."""
    base = tmp_path_factory.mktemp("cafe")
    scene = scene_products(base)
    values = {"quality_verdict": scene.verdicts}
    for asset in TABLES:
        values.get(asset, getattr(scene, asset, None)).save(base / asset)
    return {asset: base / asset for asset in TABLES}


def test_counts_from_tables_are_those_of_the_loaded_products(folders: dict[str, Path], tmp_path: Path) -> None:
    share = share_of_tables("cafe", folders)
    scene = scene_products(tmp_path)
    told = {p.flight_id for p in scene.prompts}
    assert share.counts.objects == len(scene.boxes)
    assert share.counts.flights == len(scene.trajectories) and share.counts.episodes == len(told)
    assert share.lengths == tuple(f.report.length for f in scene.trajectories if f.flight_id in told)
    assert sum(share.kinds.values()) == len(scene.prompts)
    assert share.frames == len(scene.frames.table)


def test_lengths_stand_beside_the_papers(folders: dict[str, Path]) -> None:
    lines = {f.name: f for f in figures(statistics_of([share_of_tables("cafe", folders)]))}
    assert lines["mean length"].paper == "4.33 m" and lines["mean length"].ours.endswith(" m")
    assert lines["length 2-4 m"].paper == "42.7%"
    assert lines["objects per scene"].ours == "median 5, 5 to 5"


def test_an_exports_statistics_give_the_same_figures(folders: dict[str, Path], tmp_path: Path) -> None:
    statistics = statistics_of([share_of_tables("cafe", folders)])
    (tmp_path / "statistics.json").write_text(json.dumps(statistics.as_dict()))
    assert figures(statistics_of_export(tmp_path)) == figures(statistics)


def test_a_folder_that_is_no_export_is_one_sentence(tmp_path: Path) -> None:
    with pytest.raises(ProductError, match=r"statistics\.json is missing"):
        statistics_of_export(tmp_path)
