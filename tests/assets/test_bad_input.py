"""Bad input gets one clear sentence at the command line, and no traceback."""

import gzip
import struct
from pathlib import Path

import numpy as np
import pytest
from projects import Project

HEADER = "ply\nformat binary_little_endian 1.0\nelement vertex {n}\n{properties}end_header\n"
FIELDS = ["x", "y", "z", "f_dc_0", "f_dc_1", "f_dc_2", "opacity", "scale_0", "scale_1", "scale_2"] + [
    f"rot_{i}" for i in range(4)
]


def write_ply(path: Path, values: np.ndarray, fields: list[str]) -> Path:
    properties = "".join(f"property float {name}\n" for name in fields)
    path.write_bytes(HEADER.format(n=len(values), properties=properties).encode() + values.astype("<f4").tobytes())
    return path


def splats(n: int) -> np.ndarray:
    rng = np.random.default_rng(0)
    values = rng.normal(size=(n, len(FIELDS)))
    values[:, 7:10] = -3.0
    return values


def bad_world(kind: str, folder: Path) -> Path:
    """A world file that is wrong in one way."""
    if kind == "truncated spz":
        packed = gzip.compress(struct.pack("<IIIBBBB", 0x5053474E, 2, 1000, 0, 12, 0, 0) + bytes(500))
        (folder / "world.spz").write_bytes(packed[: len(packed) // 2])
        return folder / "world.spz"
    if kind == "no opacity":
        keep = [i for i, name in enumerate(FIELDS) if name != "opacity"]
        return write_ply(folder / "world.ply", splats(50)[:, keep], [FIELDS[i] for i in keep])
    if kind == "empty":
        return write_ply(folder / "world.ply", splats(0), FIELDS)
    if kind == "nan":
        return write_ply(folder / "world.ply", np.full((50, len(FIELDS)), np.nan), FIELDS)
    if kind == "not a world":
        (folder / "world.ply").write_text("hello")
        return folder / "world.ply"
    if kind == "other type":
        (folder / "world.obj").write_text("v 0 0 0")
        return folder / "world.obj"
    return folder / "missing.spz"


def one_sentence(project: Project, *arguments: str) -> str:
    outcome = project.flymirage(*arguments)
    printed = outcome.stdout + outcome.stderr
    assert outcome.returncode != 0, printed
    assert "Traceback" not in printed, printed
    lines = [line for line in printed.splitlines() if line.strip()]
    assert len(lines) == 1, printed
    return lines[0]


@pytest.mark.parametrize(
    ("kind", "says"),
    [
        ("truncated spz", "world.spz"),
        ("no opacity", "opacity"),
        ("empty", "no Gaussian"),
        ("nan", "finite"),
        ("not a world", "world.ply"),
        ("other type", ".spz"),
        ("missing", "missing.spz"),
    ],
)
def test_a_world_that_cannot_be_read(project: Project, kind: str, says: str) -> None:
    world = bad_world(kind, project.folder)
    sentence = one_sentence(project, "import", str(world), "--scene", "flat")
    assert says in sentence
    assert not (project.folder / ".flymirage" / "store" / "scenes").exists()


def test_a_world_whose_centre_is_inside_of_a_wall(project: Project) -> None:
    values = splats(20_000)
    values[:, :3] = np.random.default_rng(1).uniform(-1.5, 1.5, (len(values), 3))  # solid all round the origin
    values[:, 6] = 5.0
    world = write_ply(project.folder / "world.ply", values, FIELDS)
    assert "not in free space" in one_sentence(project, "import", str(world), "--scene", "wall", "--up", "z")


@pytest.mark.parametrize("key", ["../../etc", "My Flat", ""])
def test_a_scene_key_that_is_not_a_name(project: Project, key: str) -> None:
    world = write_ply(project.folder / "world.ply", splats(50), FIELDS)
    assert "is not allowed" in one_sentence(project, "import", str(world), "--scene", key)


def test_a_setting_that_is_out_of_range(project: Project) -> None:
    (project.folder / "flymirage.toml").write_text("[targets]\nnear_distance = 5.0\n")
    assert "d_th1" in one_sentence(project, "status")


def test_an_unknown_setting(project: Project) -> None:
    (project.folder / "flymirage.toml").write_text("[planner]\nmax_sped = 5.0\n")
    assert "max_sped" in one_sentence(project, "status")


@pytest.mark.parametrize("command", ["make", "status"])
def test_a_scene_that_nobody_knows(project: Project, command: str) -> None:
    assert "'nowhere' is not known" in one_sentence(project, command, "nowhere")


def test_exporting_nothing(project: Project) -> None:
    assert "nothing to export" in one_sentence(project, "export", "lerobot")
