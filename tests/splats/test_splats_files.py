import gzip
import struct
from itertools import pairwise

import gsply
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from splat_worlds import random_cloud

from flymirage_core.errors import WorldError
from flymirage_core.splats.files import read_cloud, write_ply

FIELDS = ("means", "quaternions", "scales", "opacities", "sh")


def spz_v2(means, alphas, colours, log_scales, xyz, magic=0x5053474E, version=2):
    """An SPZ v2 file of degree 0, packed from the format's description alone; inputs are in stored units (bytes)."""
    fixed = np.round(np.asarray(means) * 4096).astype(np.int64) & 0xFFFFFF
    positions = np.stack([fixed & 255, fixed >> 8 & 255, fixed >> 16], axis=-1).astype(np.uint8)
    head = struct.pack("<IIIBBBB", magic, version, len(means), 0, 12, 0, 0)
    rest = (np.asarray(x, np.uint8).tobytes() for x in (alphas, colours, log_scales, xyz))
    return gzip.compress(head + positions.tobytes() + b"".join(rest))


def spz_decoded(data):
    """The same format read back, slowly: means, opacities, DC, scales, xyzw quaternions."""
    raw = gzip.decompress(data)
    _, version, n, degree, bits = struct.unpack("<IIIBB", raw[:14])
    assert (version, degree) == (2, 0)
    sizes = np.cumsum([16, 9 * n, n, 3 * n, 3 * n, 3 * n])
    p, a, c, s, r = (np.frombuffer(raw[i:j], np.uint8).astype(int) for i, j in pairwise(sizes))
    p = p.reshape(n, 3, 3) @ [1, 256, 65536]
    means = np.where(p >= 1 << 23, p - (1 << 24), p) / 2**bits
    xyz = r.reshape(n, 3) / 127.5 - 1
    w = np.sqrt(np.maximum(1 - (xyz**2).sum(axis=1), 0))
    q = np.column_stack([xyz, w])
    dc = (c.reshape(n, 3) / 255 - 0.5) / 0.15
    return means, a / 255, dc, np.exp(s.reshape(n, 3) / 16 - 10), q / np.linalg.norm(q, axis=1, keepdims=True)


def ply_text(path, header, body=b""):
    path.write_bytes(("\n".join(["ply", *header, "end_header"]) + "\n").encode() + body)
    return path


@given(st.integers(0, 3), st.integers(0, 2**32 - 1))
@settings(max_examples=25)
def test_a_cloud_survives_its_ply(tmp_path_factory, degree, seed):
    cloud = random_cloud(np.random.default_rng(seed), 20, degree)
    path = tmp_path_factory.mktemp("ply") / "world.ply"
    write_ply(cloud, path)
    again = read_cloud(path)
    for field in FIELDS:
        np.testing.assert_allclose(getattr(again, field), getattr(cloud, field), rtol=2e-6, atol=3e-7)


@pytest.mark.parametrize("degree", [0, 1, 2, 3])
def test_our_ply_means_the_same_to_another_reader(tmp_path, degree):
    cloud = random_cloud(np.random.default_rng(degree), 30, degree)
    write_ply(cloud, tmp_path / "w.ply")
    other = gsply.plyread(tmp_path / "w.ply")
    np.testing.assert_array_equal(other.means, cloud.means)
    np.testing.assert_array_equal(np.roll(other.quats, -1, axis=1), cloud.quaternions)
    np.testing.assert_allclose(np.exp(other.scales), cloud.scales, rtol=1e-6)
    np.testing.assert_allclose(1 / (1 + np.exp(-other.opacities)), cloud.opacities, rtol=1e-5)
    np.testing.assert_array_equal(other.sh0, cloud.sh[:, 0])
    np.testing.assert_array_equal(np.reshape(other.shN, (30, -1, 3)), cloud.sh[:, 1:])


def test_ply_with_normals_doubles_and_byte_colours_is_read_by_name(tmp_path):
    kinds = [("double", "<f8", ["x", "y", "z"]), ("float", "<f4", ["nx", "f_dc_0", "f_dc_1", "f_dc_2", "opacity"])]
    kinds += [("uchar", "<u1", ["red"]), ("float", "<f4", ["scale_0", "scale_1", "scale_2"])]
    kinds += [("float", "<f4", ["rot_0", "rot_1", "rot_2", "rot_3"])]
    table = np.zeros(2, [(name, dtype) for _, dtype, names in kinds for name in names])
    table["x"], table["rot_0"], table["f_dc_1"], table["opacity"], table["red"] = [1, 2], 2, 0.5, 0, 200
    properties = [f"property {kind} {name}" for kind, _, names in kinds for name in names]
    header = ["format binary_little_endian 1.0", "comment made by a test", "element vertex 2", *properties]
    cloud = read_cloud(ply_text(tmp_path / "odd.ply", header, table.tobytes()))
    np.testing.assert_array_equal(cloud.means, [[1, 0, 0], [2, 0, 0]])
    np.testing.assert_array_equal(cloud.quaternions, [[0, 0, 0, 1]] * 2)
    np.testing.assert_array_equal(cloud.sh[:, 0], [[0, 0.5, 0]] * 2)
    np.testing.assert_array_equal(cloud.opacities, [0.5, 0.5])
    np.testing.assert_array_equal(cloud.scales, np.ones((2, 3)))


def test_compressed_ply_is_read(tmp_path):
    cloud = random_cloud(np.random.default_rng(3), 300)
    write_ply(cloud, tmp_path / "w.ply")
    gsply.plywrite(tmp_path / "w.compressed.ply", gsply.plyread(tmp_path / "w.ply"), compressed=True)
    again = read_cloud(tmp_path / "w.compressed.ply")
    order = np.argmin(np.linalg.norm(again.means[:, None] - cloud.means[None], axis=2), axis=1)  # it sorts
    assert sorted(order) == list(range(300))
    np.testing.assert_allclose(again.means, cloud.means[order], atol=0.02)
    np.testing.assert_allclose(again.opacities, cloud.opacities[order], atol=0.01)
    np.testing.assert_allclose(again.sh, cloud.sh[order], atol=0.02)
    assert np.abs((again.quaternions * cloud.quaternions[order]).sum(axis=1)).min() > 0.9999
    np.testing.assert_allclose(np.log(again.scales), np.log(cloud.scales[order]), atol=0.02)


def test_spz_keeps_axes_signs_and_colours(tmp_path):
    rng = np.random.default_rng(4)
    xyz = rng.integers(60, 195, (40, 3))
    data = spz_v2(rng.uniform(-9, 9, (40, 3)), rng.integers(0, 256, 40), *rng.integers(0, 256, (2, 40, 3)), xyz)
    (tmp_path / "w.SPZ").write_bytes(data)
    cloud = read_cloud(tmp_path / "w.SPZ")
    found = (cloud.means, cloud.opacities, cloud.sh[:, 0], cloud.scales, cloud.quaternions)
    for ours, theirs in zip(found, spz_decoded(data), strict=True):
        np.testing.assert_allclose(ours, theirs, rtol=1e-5, atol=2e-6)


def test_spz_of_version_3_with_harmonics_is_read(tmp_path):
    cloud = random_cloud(np.random.default_rng(5), 60, degree=2)
    write_ply(cloud, tmp_path / "w.ply")
    gsply.spz.write_spz(tmp_path / "w.spz", gsply.plyread(tmp_path / "w.ply"), version=3)
    again = read_cloud(tmp_path / "w.spz")
    np.testing.assert_allclose(again.means, cloud.means, atol=1 / 4096)
    np.testing.assert_allclose(again.sh[:, 1:], np.clip(cloud.sh[:, 1:], -1, 127 / 128), atol=1 / 128)
    assert np.abs((again.quaternions * cloud.quaternions).sum(axis=1)).min() > 0.9999


@pytest.mark.parametrize("name", ["bedroom_sw", "family_dining"])
def test_captured_room_is_read_as_an_independent_decoder_reads_it(captured_worlds, name):
    path = captured_worlds / f"{name}_lod2.spz"
    cloud = read_cloud(path)
    found = (cloud.means, cloud.opacities, cloud.sh[:, 0], cloud.scales, cloud.quaternions)
    for ours, theirs in zip(found, spz_decoded(path.read_bytes()), strict=True):
        np.testing.assert_allclose(ours, theirs, rtol=1e-5, atol=2e-5)


def test_bad_files_get_one_clear_sentence_that_names_them(tmp_path):
    whole = spz_v2(np.zeros((500, 3)), np.zeros(500), *np.random.default_rng(0).integers(0, 256, (3, 500, 3)))
    names = ["x", "y", "z", *(f"{name}_{i}" for name in ("f_dc", "scale", "rot") for i in range(3)), "rot_3", "opacity"]
    properties = [f"property float {name}" for name in names]
    begin = ["format binary_little_endian 1.0", "element vertex 3"]
    cases = {
        "absent.ply": (None, "no such file"),
        "world.obj": (b"o", "unknown suffix '.obj'"),
        "cut.spz": (whole[: len(whole) // 2], "truncated"),
        "other.spz": (gzip.compress(b"hello" * 20), "not a whole SPZ"),
        "future.spz": (spz_v2([[0, 0, 0]], [0], [[0] * 3], [[0] * 3], [[0] * 3], version=9), "version 9"),
        "none.spz": (spz_v2(np.zeros((0, 3)), [], [], [], []), "empty"),
        "text.ply": (b"hello", "not a PLY"),
        "ascii.ply": (["format ascii 1.0", "element vertex 0"], "binary"),
        "mesh.ply": ([*begin[:1], "element face 3", "property list uchar int vertex_index"], "begin with vertices"),
        "points.ply": ([*begin, *properties[:-1]], "no property opacity"),
        "short.ply": ([*begin, *properties], "truncated"),
        "huge.ply": ([begin[0], "element vertex 99999999999999", *properties], "truncated"),
        "empty.ply": ([begin[0], "element vertex 0", *properties], "empty"),
    }
    for name, (content, expected) in cases.items():
        path = tmp_path / name
        if isinstance(content, bytes):
            path.write_bytes(content)
        elif content is not None:
            ply_text(path, content)
        with pytest.raises(WorldError, match=expected) as error:
            read_cloud(path)
        assert name in str(error.value) and "\n" not in str(error.value)


def test_a_world_of_nothing_but_nan_is_refused(tmp_path):
    cloud = random_cloud(np.random.default_rng(0), 5)
    cloud.means[:] = np.nan
    write_ply(cloud, tmp_path / "nan.ply")
    with pytest.raises(WorldError, match="none of the 5 Gaussians has a finite position"):
        read_cloud(tmp_path / "nan.ply")
