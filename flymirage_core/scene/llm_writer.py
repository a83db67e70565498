"""`ModelSceneWriter`: a language model designs the scene of a taxonomy pick (paper section III-A)."""

from collections.abc import Mapping

from flymirage_core.asking import LanguageModel, load_template
from flymirage_core.errors import ModerationError
from flymirage_core.scene.description import Provenance, SceneDescription
from flymirage_core.scene.design import SceneDesign
from flymirage_core.scene.keys import check_scene_key, rng
from flymirage_core.scene.taxonomy import Taxonomy, standard_taxonomy

SEEDS = 2**31


class ModelSceneWriter:
    """The two-step pick is ours, the design is the model's: so its own preferences do not bias the scene types.

    A refusal re-rolls the design with a new seed, at most ``rerolls`` times; ``reroll`` is how often another service
    refused what this scene's earlier descriptions showed.
    """

    def __init__(
        self,
        model: LanguageModel,
        rerolls: int,
        reroll: int = 0,
        taxonomy: Taxonomy | None = None,
        counts_so_far: Mapping[tuple[str, str], int] | None = None,
    ) -> None:
        self.model, self.rerolls, self.reroll = model, rerolls, reroll
        self.taxonomy = taxonomy or standard_taxonomy()
        self.counts_so_far = dict(counts_so_far or {})
        self.template = load_template("flymirage_core.scene", "scene_design")
        self.name = f"{model.name} (prompt {self.template.fingerprint(SceneDesign)})"

    def describe(self, scene_key: str, place: tuple[str, str] | None = None) -> SceneDescription:
        """The description of a scene; raises `SceneKeyError`, `ModerationError` if every seed was refused, and other
        `ServiceError`s."""
        check_scene_key(scene_key)
        category, subcategory = place or self.taxonomy.pick(scene_key, self.counts_so_far)
        refusals: list[str] = []
        for attempt in range(self.reroll, self.reroll + self.rerolls + 1):
            seed = int(rng(scene_key, "design", attempt).integers(SEEDS))
            values = {"category": category, "subcategory": subcategory, "variation": str(seed % 10_000)}
            try:
                design = self.model.answer(self.template.question(values, seed=seed), SceneDesign)
            except ModerationError as error:
                refusals.append(str(error))
                continue
            writer = self.name + (f", design {attempt + 1} after {attempt} refused" if attempt else "")
            return SceneDescription(
                **dict(design),
                scene=scene_key,
                category=category,
                subcategory=subcategory,
                provenance=Provenance(kind="generated", writer=writer),
            )
        raise ModerationError(
            f"{len(refusals)} designs of a {subcategory} ({category}) were refused, each with another seed; the last "
            f"time: {refusals[-1]}; give the scene another key or the taxonomy another type"
        )
