"""Gaussian clouds from and to files: 3DGS PLY (plain and compressed) and SPZ. Axes and units stay as the file has them.

Compressed PLY and SPZ are decoded by gsply. Plain PLY is read here, by the names and types in its header: gsply takes
every property for a float32, so a file with byte colours or double positions would come out as noise.
"""

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any, BinaryIO, Final

import gsply
import numpy as np
from numpy.typing import NDArray

from flymirage_core.errors import WorldError
from flymirage_core.splats.cloud import GaussianCloud

SUFFIXES: Final = (".ply", ".spz")
MAX_HEADER: Final = 1 << 16
"""Bytes in which a PLY header must end."""
OPACITY_MARGIN: Final = 1e-6
"""Opacities are kept this far from 0 and 1 when written, for their logits are infinite there."""
MIN_SCALE: Final = 1e-9
"""Metres. Scales are written as logarithms, so none may be zero."""
PLY_TYPES: Final = (
    dict.fromkeys(("char", "int8"), "<i1")
    | dict.fromkeys(("uchar", "uint8"), "<u1")
    | dict.fromkeys(("short", "int16"), "<i2")
    | dict.fromkeys(("ushort", "uint16"), "<u2")
    | dict.fromkeys(("int", "int32"), "<i4")
    | dict.fromkeys(("uint", "uint32"), "<u4")
    | dict.fromkeys(("float", "float32"), "<f4")
    | dict.fromkeys(("double", "float64"), "<f8")
)
NEEDED: Final = (
    *("x", "y", "z", "f_dc_0", "f_dc_1", "f_dc_2", "opacity"),
    *("scale_0", "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3"),
)


def read_cloud(path: Path | str) -> GaussianCloud:
    """Read a ``.ply`` (3DGS, or PlayCanvas compressed) or ``.spz`` (versions 2 to 4) file, SH degree 0 to 3.

    The frame is the file's own (see `flymirage_core.splats.frames`). Quaternions come out as unit xyzw, scales as
    standard deviations, opacities in [0, 1]. Gaussians with numbers that are not finite are kept: cleaning counts them.

    Raises:
        WorldError: no such file, an unknown suffix, a truncated or foreign file, or no usable Gaussian in it.
    """
    path = Path(path)
    if path.suffix.lower() not in SUFFIXES:
        raise WorldError(f"{path}: unknown suffix {path.suffix!r}; a world is a .ply or .spz file of Gaussian splats")
    if not path.is_file():
        raise WorldError(f"{path}: there is no such file")
    data = _read_spz(path) if path.suffix.lower() == ".spz" else _read_ply(path)
    cloud = _in_our_terms(data)
    if len(cloud) == 0:
        raise WorldError(f"{path}: the world is empty, it has no Gaussians; export it again")
    if not np.isfinite(cloud.means).all(axis=1).any():
        raise WorldError(f"{path}: none of the {len(cloud)} Gaussians has a finite position; export the world again")
    return cloud


def write_ply(cloud: GaussianCloud, path: Path | str) -> None:
    """Write a standard binary 3DGS PLY, as SuperSplat and gsplat's loaders read it.

    Properties ``x y z f_dc_* f_rest_* opacity scale_* rot_*``: f_rest channel by channel, opacity as logit, scales as
    natural logarithms, rotation wxyz.
    """
    rest = cloud.sh.shape[1] - 1
    names = ["x", "y", "z", "f_dc_0", "f_dc_1", "f_dc_2", *(f"f_rest_{i}" for i in range(3 * rest)), *NEEDED[6:]]
    opacity = np.clip(cloud.opacities.astype(np.float64), OPACITY_MARGIN, 1 - OPACITY_MARGIN)  # (N,)
    columns = [
        cloud.means,
        cloud.sh[:, 0],
        cloud.sh[:, 1:].transpose(0, 2, 1).reshape(len(cloud), -1),
        np.log(opacity / (1 - opacity))[:, None],
        np.log(np.maximum(cloud.scales, MIN_SCALE)),
        np.roll(cloud.quaternions, 1, axis=1),
    ]
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(cloud)}"]
    header += [f"property float {name}" for name in names] + ["end_header", ""]
    with Path(path).open("wb") as file:
        file.write("\n".join(header).encode("ascii"))
        file.write(np.hstack(columns).astype("<f4").tobytes())


@dataclass(frozen=True)
class _RawGaussians:
    """Gaussians as splat files store them."""

    means: NDArray[np.float32]  # (N, 3)
    log_scales: NDArray[np.float32]  # (N, 3)
    quaternions: NDArray[np.float32]  # (N, 4) wxyz, of any length
    logits: NDArray[np.float32]  # (N,)
    sh: NDArray[np.float32]  # (N, K, 3)


def _in_our_terms(raw: _RawGaussians) -> GaussianCloud:
    """Linear scales, opacities, unit xyzw; computed in float64 so that reading undoes writing."""
    with np.errstate(all="ignore"):  # numbers that are not finite stay so, and are cleaned later
        quaternions = np.roll(raw.quaternions, -1, axis=1).astype(np.float64)
        quaternions /= np.linalg.norm(quaternions, axis=1, keepdims=True)
        scales = np.exp(raw.log_scales.astype(np.float64))
        opacities = 1 / (1 + np.exp(-raw.logits.astype(np.float64)))
    return GaussianCloud(
        np.ascontiguousarray(raw.means, np.float32),
        quaternions.astype(np.float32),
        scales.astype(np.float32),
        opacities.astype(np.float32),
        np.ascontiguousarray(raw.sh, np.float32),
    )


def _read_spz(path: Path) -> _RawGaussians:
    try:
        data = gsply.spz.read_spz(path)
    except Exception as error:  # whatever a damaged file makes of the decoder
        reason = str(error).replace(f": {path}", "")
        if "zstandard" in reason:
            raise WorldError(f"{path}: SPZ version 4 needs one more package; `pip install zstandard`") from error
        raise WorldError(f"{path}: not a whole SPZ file ({reason}); it may be truncated, get it again") from error
    return _from_gsply(data)


def _read_ply(path: Path) -> _RawGaussians:
    with path.open("rb") as file:
        header = _ply_header(file, path)
        start = file.tell()
    if re.search(r"^element chunk ", header, re.MULTILINE):
        return _read_compressed_ply(path)
    return _read_plain_ply(path, header, start)


def _read_compressed_ply(path: Path) -> _RawGaussians:
    try:
        data = gsply.plyread(path)
    except Exception as error:  # whatever a damaged file makes of the decoder
        raise WorldError(f"{path}: not a whole compressed PLY file; it may be truncated, get it again") from error
    return _from_gsply(data)


def _from_gsply(data: Any) -> _RawGaussians:
    sh = data.sh0[:, None]  # (N, 1, 3)
    if data.shN is not None and data.shN.size > 0:
        sh = np.concatenate([sh, data.shN.reshape(len(sh), -1, 3)], axis=1)
    return _RawGaussians(data.means, data.scales, data.quats, data.opacities, sh)


def _ply_header(file: BinaryIO, path: Path) -> str:
    """The header's text; leaves ``file`` at the first byte after it."""
    head = file.read(MAX_HEADER)
    end = re.search(rb"\nend_header\r?\n", head)
    if not head.startswith(b"ply") or end is None:
        raise WorldError(f"{path}: not a PLY file, its header is missing or has no end; get it again")
    file.seek(end.end())
    return head[: end.end()].decode("ascii", "replace").replace("\r\n", "\n")


def _read_plain_ply(path: Path, header: str, start: int) -> _RawGaussians:
    if "format binary_little_endian" not in header:
        raise WorldError(f"{path}: the PLY is not binary little-endian; export it as a binary 3DGS PLY")
    vertex = re.search(r"^element vertex (\d+)\n((?:(?:property|comment) .*\n)*)", header, re.MULTILINE)
    before = header[: vertex.start()] if vertex else header
    if vertex is None or "\nelement " in before:
        raise WorldError(f"{path}: the PLY does not begin with vertices; export it as a binary 3DGS PLY")
    count = int(vertex.group(1))
    fields = re.findall(r"^property (\w+) (\w+)$", vertex.group(2), re.MULTILINE)
    names = [name for _, name in fields]
    missing = [name for name in NEEDED if name not in names]
    if missing:
        raise WorldError(
            f"{path}: the PLY has no property {', '.join(missing)} (it has {', '.join(names[:8])}...), so it is not a "
            "Gaussian splat file; export it as a 3DGS PLY"
        )
    if "property list" in vertex.group(2) or any(kind not in PLY_TYPES for kind, _ in fields):
        raise WorldError(
            f"{path}: the PLY's vertices have properties that are not plain numbers; export it as a 3DGS PLY"
        )
    row = np.dtype([(name, PLY_TYPES[kind]) for kind, name in fields])
    available = path.stat().st_size - start
    if available < count * row.itemsize:
        raise WorldError(
            f"{path}: the PLY is truncated, {count} Gaussians need {count * row.itemsize} bytes and {available} are "
            "there; get it again"
        )
    return _from_columns(np.fromfile(path, row, count, offset=start), path)


def _from_columns(table: NDArray[Any], path: Path) -> _RawGaussians:
    def columns(*names: str) -> NDArray[np.float32]:
        return np.stack([table[name].astype(np.float32) for name in names], axis=1)

    names = table.dtype.names or ()
    rest = sorted((name for name in names if re.fullmatch(r"f_rest_\d+", name)), key=lambda name: int(name[7:]))
    if len(rest) not in (0, 9, 24, 45):
        raise WorldError(
            f"{path}: the PLY has {len(rest)} f_rest properties, expected 0, 9, 24 or 45 (SH degree 0 to 3)"
        )
    sh = columns("f_dc_0", "f_dc_1", "f_dc_2")[:, None]  # (N, 1, 3)
    if rest:
        sh = np.concatenate([sh, columns(*rest).reshape(len(table), 3, -1).transpose(0, 2, 1)], axis=1)
    return _RawGaussians(
        columns("x", "y", "z"),
        columns("scale_0", "scale_1", "scale_2"),
        columns("rot_0", "rot_1", "rot_2", "rot_3"),
        table["opacity"].astype(np.float32),
        sh,
    )
