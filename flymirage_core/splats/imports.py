"""A splat file that a user has, made a `World`: read, put into the world frame, cleaned."""

from pathlib import Path

from flymirage_core.errors import WorldError
from flymirage_core.settings import CleaningSettings
from flymirage_core.splats.cleaning import clean, finite
from flymirage_core.splats.cloud import GaussianCloud
from flymirage_core.splats.files import read_cloud
from flymirage_core.splats.frames import Framing, MarbleSemantics, Up, frame_by_estimate, frame_from_marble
from flymirage_core.splats.world import World


def import_world(path: Path | str, up: Up, scale: float | None, settings: CleaningSettings) -> World:
    """A world from a .ply or .spz file that says nothing of its frame; see `frame_by_estimate`.

    Whether one can fly in it is another question: `flymirage_core.occupancy.doctor.examine` answers it.

    Args:
        path: the splat file.
        up: the file's axis that points up, or "auto".
        scale: metres per unit of the file; None takes the file to be in metres.
        settings: what cleaning removes; in metres, after scaling.

    Raises:
        WorldError: the file cannot be read, or no usable Gaussian is in it.
    """
    cloud, broken = _readable(path)
    return _cleaned(frame_by_estimate(cloud, up, scale), broken, settings, path)


def import_marble_world(path: Path | str, semantics: MarbleSemantics, settings: CleaningSettings) -> World:
    """A world from Marble's .spz and its ``semantics_metadata``; raises `WorldError` as `import_world` does."""
    cloud, broken = _readable(path)
    return _cleaned(frame_from_marble(cloud, semantics), broken, settings, path)


def _readable(path: Path | str) -> tuple[GaussianCloud, int]:
    """The file's Gaussians with which one can calculate, and how many others there are."""
    cloud = read_cloud(path)
    usable = finite(cloud)
    if not usable.any():
        raise WorldError(f"{path}: each of the {len(cloud)} Gaussians has a number that is not finite; export it again")
    return cloud[usable], int((~usable).sum())


def _cleaned(framing: Framing, broken: int, settings: CleaningSettings, path: Path | str) -> World:
    try:
        cloud, counts = clean(framing.cloud, framing.centre, settings)
    except WorldError as error:
        raise WorldError(f"{path}: {error}; check the scale, and the cleaning section of the settings") from error
    counts["removed_not_finite"] += broken
    return World(cloud, framing.centre, {"source": Path(path).name, **framing.notes, **counts})
