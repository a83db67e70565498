"""What a daemon, a code server or a worker loads to run stand-in stages: `stand_in` first, then the definitions."""

import stand_in  # noqa: F401 - replaces the stages' functions

from flymirage_assets.definitions import defs as defs
