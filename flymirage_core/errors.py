"""The project's own errors: each is one clear sentence - what was found, where, what was expected, what to do."""

import errno

NO_RETRY = {
    errno.ENOSPC: "the disk is full",
    errno.EROFS: "the disk is read-only",
    errno.EACCES: "it may not be written",
}
"""Errors of the system that a second attempt would meet again, in words."""


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


class ServiceError(FlyMirageError):
    """An outside service did not do what was asked, and asking again for the same would not help."""


class TransientServiceError(ServiceError):
    """A service is busy, slow or down: the same request may succeed after ``retry_after`` seconds (None: unknown)."""

    def __init__(self, sentence: str, retry_after: float | None = None) -> None:
        super().__init__(sentence)
        self.retry_after = retry_after


class ModerationError(ServiceError):
    """A service refused a scene's content; the scene needs another description."""


class BadAnswerError(ServiceError):
    """A service answered with something that is not what it promised, also after one repair call."""


class LostStartError(ServiceError):
    """A paid request was sent, its answer was lost, and no trace of it was found: a person decides."""


class SceneBudgetError(ServiceError):
    """The next call could cost more than one scene may."""


class NightStopError(ServiceError):
    """No further scene can be paid for: everything else of this night would fail in the same way."""


class KeyRefusedError(NightStopError):
    """A service's key is missing, wrong, or has no access to the model."""


class QuotaError(NightStopError):
    """Credits or quota of an account are used up."""


class BudgetError(NightStopError):
    """The next call could cost more than the night's or the month's cap."""
