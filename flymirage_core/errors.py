"""The project's own errors: each is one clear sentence - what was found, where, what was expected, what to do."""


class FlyMirageError(Exception):
    """Base of every error that a user can meet; its text is a whole sentence and needs no traceback."""


class InputError(FlyMirageError):
    """Something the user gave (a file, a key, a setting) cannot be used."""


class WorldError(InputError):
    """A Gaussian-splat world cannot be read, or cannot be flown in."""


class SceneKeyError(InputError):
    """A scene key that does not match ``^[a-z0-9][a-z0-9_-]{0,63}$``."""


class ProductError(FlyMirageError):
    """A stored product is missing, torn, or of a version that this code does not read."""


class PlanningError(FlyMirageError):
    """A flight or camera path cannot be planned; the text says why."""
