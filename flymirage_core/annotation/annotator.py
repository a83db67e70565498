"""The port `Annotator`: what the pipeline asks of whatever finds the objects, ours or an outside detector."""

from collections.abc import Iterable
from typing import Protocol

from flymirage_core.annotation.boxes import BoxMap
from flymirage_core.rendering.views import View


class Annotator(Protocol):
    """Finds objects in posed RGB-D views. ``name`` and ``version`` go into every box."""

    @property
    def name(self) -> str: ...

    @property
    def version(self) -> str: ...

    def annotate(self, views: Iterable[View], max_distance: float) -> BoxMap:
        """The fused, gravity-aligned box map of what the views show.

        Args:
            views: posed RGB-D pictures (`PosedViews`, or any iterable of `View`); iterated once, in order.
            max_distance: metres; evidence farther than this from the optical centre of the view that saw it does not
                count. d_th1 in the second pass, ``math.inf`` in the first (section III-B).

        Returns:
            Boxes with ids 0..n-1 in a deterministic order; an empty map if there is nothing.
        """
        ...
