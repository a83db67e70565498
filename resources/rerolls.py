"""A scene whose content a service refused gets another description: a bounded number of times, and said so."""

from flymirage_core.errors import ModerationError
from resources.records import SceneOrigin
from resources.store import Store


class RerolledError(ModerationError):
    """A refusal after which the scene's description will be another one: running again goes on from there."""


def roll_again(store: Store, scene: str, refusal: ModerationError, rerolls: int) -> ModerationError:
    """Note that the scene needs another description, and say so; say that it is given up if it had its share."""
    origin = store.origin(scene) or SceneOrigin(scene=scene, kind="generated")
    if origin.kind == "imported":
        return refusal
    if origin.reroll >= rerolls:
        return ModerationError(
            f"{refusal}; this was description {origin.reroll + 1} of scene {scene!r}, and services.rerolls = {rerolls} "
            "allows no other: give the scene up, or grow it under another key"
        )
    store.register(origin.model_copy(update={"reroll": origin.reroll + 1}))
    return RerolledError(
        f"{refusal}; scene {scene!r} gets another description with a new seed ({origin.reroll + 1} of {rerolls}): "
        "materialise `description` and what follows again"
    )
