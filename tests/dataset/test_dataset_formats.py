"""The other formats: each is read back from its own files alone, and grows scene by scene."""

import csv
import gzip
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from filmed_room import RIG, renamed, scene_products
from hypothesis import given
from hypothesis import strategies as st

from flymirage_core.dataset.export_folder import ExportReport, Shard, export
from flymirage_core.dataset.formats import FORMATS
from flymirage_core.dataset.lerobot import DepthExport
from flymirage_core.dataset.scene_products import SceneProducts
from flymirage_core.dataset.tfrecord import example_bytes, example_from, read_records, write_records
from flymirage_core.dataset.vlnce import REFERENCE_STEP, VlnceFormat, resampled
from flymirage_core.errors import InputError, ProductError

OTHERS = [name for name in FORMATS if name != "lerobot"]


@pytest.fixture(scope="module")
def scenes(tmp_path_factory: pytest.TempPathFactory) -> list[SceneProducts]:
    cafe = scene_products(tmp_path_factory.mktemp("cafe"))
    return [cafe, renamed(cafe, "hall")]


def write(form: str, scenes: list[SceneProducts], folder: Path) -> ExportReport:
    return export(FORMATS[form](DepthExport.PNG16), scenes, folder)


@pytest.fixture(scope="module")
def exports(scenes: list[SceneProducts], tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    folder = tmp_path_factory.mktemp("exports")
    return {form: write(form, scenes, folder / form).folder for form in OTHERS}


@pytest.mark.parametrize("form", OTHERS)
class TestEveryFormat:
    def test_it_tells_its_conventions_and_carries_the_card(self, exports: dict[str, Path], form: str) -> None:
        conventions = json.loads((exports[form] / "conventions.json").read_text())
        assert conventions["cameras"][0]["K"] == RIG.intrinsics.matrix.tolist()
        assert conventions[form]
        assert "## Terms" in (exports[form] / "README.md").read_text()

    def test_growing_scene_by_scene_ends_as_if_made_at_once(
        self, exports: dict[str, Path], form: str, scenes: list[SceneProducts], tmp_path: Path
    ) -> None:
        write(form, scenes[:1], tmp_path / "out")
        report = write(form, scenes, tmp_path / "out")
        assert (report.written, report.kept) == (("hall",), ("cafe",))
        assert contents(tmp_path / "out") == contents(exports[form])

    def test_a_removed_scene_leaves_nothing_behind(
        self, form: str, scenes: list[SceneProducts], tmp_path: Path
    ) -> None:
        write(form, scenes, tmp_path / "out")
        write(form, scenes[1:], tmp_path / "out")
        write(form, scenes[1:], tmp_path / "anew")
        assert contents(tmp_path / "out") == contents(tmp_path / "anew")

    def test_another_format_does_not_overwrite_it(
        self, exports: dict[str, Path], form: str, scenes: list[SceneProducts]
    ) -> None:
        with pytest.raises(InputError, match=f"is an export in the format '{form}'"):
            export(FORMATS["lerobot"](DepthExport.NONE), scenes, exports[form])


def contents(folder: Path) -> dict[str, bytes]:
    history = {"export.json", "CHANGELOG.md", "README.md"}
    files = [p for p in folder.rglob("*") if p.is_file() and p.name not in history]
    return {str(p.relative_to(folder)): p.read_bytes() for p in files}


class TestRelease:
    def test_a_flight_is_a_folder_as_in_the_official_release(
        self, exports: dict[str, Path], scenes: list[SceneProducts]
    ) -> None:
        folders = sorted(p.name for p in exports["flymirage"].glob("0*"))
        assert [name[:7] for name in folders] == [f"{n:06d}_" for n in range(1, 7)]
        first = exports["flymirage"] / folders[0]
        assert {p.name for p in first.iterdir()} == {
            "instruction.json",
            "data.csv",
            "target_points.csv",
            "images",
            "depth",
        }
        source = list(scenes[0].frames.flight(0).depth())
        for i, depth in enumerate(source):
            png = cv2.imread(str(first / f"depth/front/frame_{i + 1}.png"), cv2.IMREAD_UNCHANGED)
            np.testing.assert_array_equal(png, depth)
            grey = cv2.imread(str(first / f"depth/front/frame_{i + 1}.jpg"), cv2.IMREAD_UNCHANGED)
            assert np.median(np.abs(grey * (10_000 / 255) - depth)) < 60  # millimetres: why there is a PNG
        with (first / "data.csv").open() as file:
            rows = list(csv.DictReader(file))
        assert len(rows) == len(source) and (first / rows[-1]["image"]).exists()
        instruction = json.loads((first / "instruction.json").read_text())
        assert instruction["instruction"] in {p.text for p in scenes[0].prompts.of_flight(0)}


class TestVlnce:
    def test_each_instruction_is_an_episode_that_ends_at_its_goal(
        self, exports: dict[str, Path], scenes: list[SceneProducts]
    ) -> None:
        rows = [
            row
            for path in sorted(exports["vlnce"].glob("*/*.json.gz"))
            if not path.name.endswith("_gt.json.gz")
            for row in json.loads(gzip.decompress(path.read_bytes()))["episodes"]
        ]
        assert sorted(
            r["instruction"]["instruction_text"] for r in rows if r["info"]["kind"] != "long_horizon"
        ) == sorted(p.text for scene in scenes for p in scene.prompts)
        assert len({r["episode_id"] for r in rows}) == len(rows)
        for row in rows:
            flight = scenes[0].trajectories.flights[row["trajectory_id"][-1]]
            np.testing.assert_allclose(row["reference_path"][-1], flight.positions[-1], atol=1e-4)
            np.testing.assert_allclose(row["goals"][-1]["position"], flight.positions[-1])

    @pytest.mark.parametrize(
        ("spoil", "said"),
        [
            (lambda row: row["start_position"].__setitem__(2, 9.0), "starts where|begins"),
            (lambda row: row["reference_path"].pop(0), "begins 0.2. m from its start"),
            (lambda row: row["reference_path"].pop(), "ends 0..* m from its goal"),
            (lambda row: row["reference_path"].pop(3), "has points"),
            (lambda row: row["reference_path"][3].__setitem__(2, 1.4), "has points|passes"),
            (lambda row: row["goals"][-1]["object"].__setitem__(0, 9.0), "from its box|starts where"),
            (lambda row: row.update(trajectory_id=[0]), "m from|projects"),
        ],
    )
    def test_the_self_test_finds_a_path_or_a_goal_that_is_not_the_flights(
        self,
        exports: dict[str, Path],
        scenes: list[SceneProducts],
        tmp_path: Path,
        spoil: Callable[[Any], object],
        said: str,
    ) -> None:
        source = next(exports["vlnce"].glob("*/content/cafe.json.gz"))
        episodes = json.loads(gzip.decompress(source.read_bytes()))["episodes"]
        spoil(episodes[0])
        path = tmp_path / source.relative_to(exports["vlnce"])
        path.parent.mkdir(parents=True)
        path.write_bytes(gzip.compress(json.dumps({"episodes": episodes}).encode()))
        with pytest.raises(ProductError, match=said):
            VlnceFormat().check(tmp_path, scenes[0])

    def test_a_flight_that_turns_back_on_the_spot_loses_no_corner_of_its_path(self) -> None:
        out = np.column_stack([np.linspace(0, 1.12, 80), np.zeros(80), np.full(80, 1.2)])
        back = np.column_stack([np.linspace(1.12, 0.2, 70), np.linspace(0, 0.3, 70), np.full(70, 1.2)])
        path = np.array(resampled(np.vstack([out, back])))
        assert np.linalg.norm(path - (1.12, 0, 1.2), axis=1).min() < 0.02
        assert np.linalg.norm(np.diff(path, axis=0), axis=1).max() <= REFERENCE_STEP + 1e-3
        straight = np.array(resampled(out))
        np.testing.assert_allclose(straight[:, 0], [0, 0.25, 0.5, 0.75, 1.0, 1.12], atol=1e-4)
        assert resampled(np.zeros((5, 3))) == [[0.0, 0.0, 0.0]], "who does not move is where it is"

    def test_one_scene_is_a_file_of_its_own(self, exports: dict[str, Path]) -> None:
        paths = list(exports["vlnce"].glob("*/content/hall.json.gz"))
        assert paths and all(
            row["scene_id"] == "hall" for p in paths for row in json.loads(gzip.decompress(p.read_bytes()))["episodes"]
        )


class TestTransforms:
    def test_pictures_and_depth_lie_where_it_says_and_the_camera_looks_along_minus_z(
        self, exports: dict[str, Path], scenes: list[SceneProducts]
    ) -> None:
        folder = exports["transforms"] / "cafe"
        data = json.loads((folder / "transforms.json").read_text())
        assert (data["w"], data["h"]) == (64, 48)
        for row in data["frames"]:
            camera = scenes[0].frames.flight(row["flight_id"]).cameras()[row["frame_index"]]
            pose = np.array(row["transform_matrix"])
            np.testing.assert_allclose(-pose[:3, 2], camera.forward, atol=1e-9)
            assert (folder / row["file_path"]).exists()
            depth = cv2.imread(str(folder / row["depth_file_path"]), cv2.IMREAD_UNCHANGED)
            assert depth.dtype == np.uint16 and depth.shape == (48, 64)


class TestRlds:
    def test_steps_hold_the_flight_and_the_file_list_is_complete(
        self, exports: dict[str, Path], scenes: list[SceneProducts]
    ) -> None:
        info = json.loads((exports["rlds"] / "dataset_info.json").read_text())
        found = 0
        for split in info["splits"]:
            for number, length in enumerate(split["shardLengths"]):
                path = exports["rlds"] / f"flymirage-{split['name']}.tfrecord-{number:05d}"
                examples = [example_from(r) for r in read_records(path)]
                assert len(examples) == int(length)
                found += len(examples)
                for example in examples:
                    _, flight = example["episode_metadata/episode_id"][0].decode().split("/")
                    source = scenes[0].frames.flight(int(flight))
                    assert len(example["steps/observation/image"]) == len(source)
                    png = np.frombuffer(example["steps/observation/depth"][-1], np.uint8)
                    depth = cv2.imdecode(png, cv2.IMREAD_UNCHANGED)
                    np.testing.assert_array_equal(depth, list(source.depth())[-1])
                    assert example["steps/is_last"].tolist() == [0] * (len(source) - 1) + [1]
        assert found == 6

    def test_the_checksum_is_the_castagnoli_one_of_the_standard(self, tmp_path: Path) -> None:
        """RFC 3720, B.4: 32 bytes of zeros give 8a9136aa; TFRecord turns it by 15 bits and adds a constant."""
        write_records(tmp_path / "zeros", [bytes(32)])
        stored = int.from_bytes((tmp_path / "zeros").read_bytes()[-4:], "little")
        turned = (stored - 0xA282EAD8) % 2**32
        assert (turned << 15 | turned >> 17) % 2**32 == 0x8A9136AA

    def test_a_damaged_record_is_named(self, tmp_path: Path) -> None:
        path = tmp_path / "some"
        write_records(path, [b"one", b"two"])
        data = bytearray(path.read_bytes())
        data[-6] ^= 1
        path.write_bytes(data)
        with pytest.raises(ProductError, match="record 1 is torn or damaged"):
            list(read_records(path))

    @given(
        st.dictionaries(
            st.text(max_size=20),
            st.one_of(
                st.lists(st.binary(max_size=300), min_size=1, max_size=4),
                st.lists(st.floats(width=32, allow_nan=False), min_size=1, max_size=40).map(np.float32),
                st.lists(st.integers(-(2**63), 2**63 - 1), min_size=1, max_size=40).map(np.int64),
            ),
            max_size=5,
        )
    )
    def test_any_example_is_read_back(self, features: dict) -> None:
        back = example_from(example_bytes(features))
        assert back.keys() == features.keys()
        for name, values in features.items():
            np.testing.assert_array_equal(back[name], values)


def test_a_release_folder_is_numbered_without_gaps_after_a_change(scenes: list[SceneProducts], tmp_path: Path) -> None:
    write("flymirage", scenes, tmp_path / "out")
    write("flymirage", scenes[1:], tmp_path / "out")
    assert Shard.load(tmp_path / "out", "hall").place["first"] == 1
    assert sorted(p.name[:6] for p in (tmp_path / "out").glob("0*")) == ["000001", "000002", "000003"]
