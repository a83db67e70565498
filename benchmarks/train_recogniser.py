"""Train the recogniser of flymirage_core/annotation on renders of generated worlds; no label is made by hand.

    python benchmarks/train_recogniser.py collect --data FOLDER train-0 train-1 ...   # one file a world, resumable
    python benchmarks/train_recogniser.py showrooms --data FOLDER --count 6           # of nouns with few examples
    python benchmarks/train_recogniser.py train --data FOLDER                         # recogniser.npz, RECOGNISER.md

What is learned from is what the annotator makes of the rendered views: its own boxes, partial and displaced as they
are, with the noun and material of the true object that each matches (IoU >= 0.25), and "no object of its own" where
none does. All worlds are learned from in the end; confidences are calibrated, and the card's figures measured, on what
networks say of worlds that they did not see (cross-validation by world).
"""

import argparse
import math
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import torch
from annotation import Scene, described, generated, in_opening, score_boxes, see_both_passes
from torch import nn

from flymirage_core.annotation.appearance import FEATURES, mirrored, reversed_depth
from flymirage_core.annotation.embedded import EmbeddedAnnotator
from flymirage_core.annotation.fused_points import frames_of
from flymirage_core.annotation.labels import UNKNOWN
from flymirage_core.annotation.naming import MAX_LEFT_OVER
from flymirage_core.annotation.recogniser import CLIP, Recogniser, recogniser_of
from flymirage_core.scene.description import SceneDescription
from flymirage_core.scene.design import PlannedObject
from flymirage_core.scene.keys import rng
from flymirage_core.scene.knowledge import nouns
from flymirage_core.scene.writer import OfflineSceneWriter
from flymirage_core.settings import Settings

Arrays = dict[str, np.ndarray]

HOME = Path(__file__).parents[1] / "flymirage_core" / "annotation"
FOLDS = 4  # of worlds; a network for each judges those that it was not trained on
MIN_EXAMPLES = 2  # of a noun in training; rarer ones are not learned
NETWORKS = 3
STEPS = 1200
BATCH = 256
HIDDEN = (128, 96)
RATE = 3e-3  # of learning, at its highest
LATER_RATE = 1e-3  # the same of what starts from a former recogniser
NETWORK = tuple(
    f"{layer}_{kind}" for layer in ("first", "second", "noun", "material") for kind in ("weights", "biases")
)
NO_CHANCE = -12.0  # logit of a class that a network does not know
NOISE = 0.1  # standard deviations, on every feature
SHOWN, SHOWN_LARGE = 26, 10  # nouns in a showroom: in a hall, in a yard
LARGEST_IN_HALL = 2.8  # metres
LEFT_OVER = ""  # the noun of a box that is no object of its own
WANTED = {"noun": 0.90, "family": 0.88, "material": 0.85}  # of what is said on held-out worlds, so much must be right
LEAST = 0.25  # probability; there are nouns that it never saw, which calibration knows too few of
SEED = 1
KINDS_OF_MATERIAL = {
    "wood": "oak walnut pine beech birch painted lacquered wood teak timber plywood cedar ash mahogany bamboo",
    "fabric": "linen velvet wool cotton cloth canvas felt leather nylon fabric polyester",
    "metal": "steel iron brass copper aluminium enamelled chrome zinc bronze metal",
    "plastic": "plastic vinyl rubber polymer fibreglass acrylic",
    "ceramic": "ceramic stoneware porcelain clay terracotta",
    "stone": "marble concrete granite stone brick sandstone slate",
    "paper": "paper cardboard",
    "wicker": "wicker rattan",
    "glass": "glass",
}  # last word of a description's material -> the kind that is guessed


@dataclass(frozen=True)
class Examples:
    """Boxes of some worlds: features (N, FEATURES), and for each its world, noun and material."""

    features: np.ndarray
    worlds: np.ndarray
    nouns: np.ndarray
    materials: np.ndarray

    def __getitem__(self, chosen: np.ndarray) -> "Examples":
        return Examples(self.features[chosen], self.worlds[chosen], self.nouns[chosen], self.materials[chosen])


def collect(keys: Iterable[str], folder: Path, settings: Settings) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    for key in keys:
        if not (folder / f"{key}.npz").exists():
            collect_world(generated(key, settings), folder, settings)


def collect_showrooms(count: int, folder: Path, settings: Settings) -> None:
    """Places that hold two pieces each of the nouns that ``folder`` has the fewest examples of."""
    for number in range(count):
        key = f"showroom-{number}"
        if not (folder / f"{key}.npz").exists():
            found = Counter(load(folder).nouns.tolist())
            wanted = sorted(nouns(), key=lambda noun: (found[noun], rng(key, noun).random()))
            collect_world(described(showroom(key, wanted), settings), folder, settings)


def showroom(key: str, wanted: Sequence[str]) -> SceneDescription:
    """A hall with the first of the ``wanted`` nouns that fit in; a yard if the very first is too large for that."""
    generator = rng(key, "showroom")
    outside = max(nouns()[wanted[0]].size) > LARGEST_IN_HALL
    place = ("industrial and utility facilities", "construction site" if outside else "packing hall")
    base = OfflineSceneWriter().describe(key, place)
    zone = base.zones[0]
    fitting = [n for n in wanted if (max(nouns()[n].size) > LARGEST_IN_HALL) == outside]
    shown = fitting[: SHOWN_LARGE if outside else SHOWN]
    objects = []
    for noun in ["workbench", "workbench", *shown]:
        kind = nouns()[noun]
        material = str(generator.choice(list(kind.finishes)))
        where = [p for p in kind.placements if p in ("against_wall", "on_floor", "on_surface", "on_wall", "hanging")]
        placement = where[0] if where else "on_floor"
        objects += [
            PlannedObject(
                noun=noun,
                count=1,
                colour=str(generator.choice(kind.finishes[material])),
                material=material,
                size=size,
                placement=placement,
                relative_to="workbench" if placement == "on_surface" else "",
                zone=zone.name,
            )
            for size in ("small", "large")
        ]
    return base.model_copy(update={"objects": tuple(objects)})


def collect_world(scene: Scene, folder: Path, settings: Settings) -> None:
    """One file: features, nouns and materials of the boxes that the annotator makes of a world in both passes."""
    annotator = EmbeddedAnnotator(settings.annotation)
    seen = see_both_passes(scene, annotator, settings)
    features, nouns, materials = [], [], []
    for views, distance in ((seen.orbit_views, math.inf), (seen.all_views, settings.targets.near_distance)):
        found = [thing for thing, _ in annotator.observations(annotator.evidence(frames_of(views), distance))]
        boxes = [thing.box for thing in found]
        matches = {b: scene.truth[t] for t, b, _ in score_boxes(boxes, scene.truth, 0.25)}
        features += [thing.features for thing in found]
        nouns += [matches[b].noun if b in matches else opening_noun(x, scene.openings) for b, x in enumerate(boxes)]
        materials += [kind_of_material(matches[b].material) if b in matches else "" for b in range(len(boxes))]
    np.savez_compressed(
        folder / f"{scene.name}.npz",
        features=np.stack(features),
        nouns=np.array(nouns),
        materials=np.array(materials),
    )
    print(f"{scene.name}: {len(nouns)} boxes, {sum(noun != LEFT_OVER for noun in nouns)} with names", flush=True)


def opening_noun(box: object, openings: Sequence[np.ndarray]) -> str:
    """Doors and windows are no objects of the truth, but have names."""
    if not in_opening(box, openings):
        return LEFT_OVER
    return "door" if box.bottom < 0.3 else "window"


def kind_of_material(name: str) -> str:
    """ "walnut" -> "wood"; "" for what has no kind."""
    words = name.lower().replace("-", " ").split()
    return next((kind for word in reversed(words) for kind, of in KINDS_OF_MATERIAL.items() if word in of.split()), "")


def load(folder: Path) -> Examples:
    parts = [(path.stem, np.load(path)) for path in sorted(folder.glob("*.npz"))]
    return Examples(
        np.concatenate([p["features"] for _, p in parts]),
        np.concatenate([np.full(len(p["nouns"]), name) for name, p in parts]),
        np.concatenate([p["nouns"] for _, p in parts]),
        np.concatenate([p["materials"] for _, p in parts]),
    )


def family_of(noun: str, nouns: Sequence[str]) -> str:
    """The last word of a noun, if other nouns end in it too or it is one: "chair" of "office chair"."""
    head = noun.split()[-1]
    alike = [n for n in nouns if n.split()[-1] == head]
    return head if len(alike) > 1 else noun


def train(examples: Examples, count: int, former: Arrays | None = None) -> Arrays:
    """The arrays of recogniser.npz, for ``count`` networks; thresholds still to be set.

    ``former``: those of a recogniser that learned from worlds which are not at hand. Its networks stay, lest what they
    know is forgotten, and beside each one begins where it stood and learns on. Its features are the last of today's.
    """
    counts = Counter(examples.nouns.tolist())
    known_before = set(former["nouns"].tolist()) if former else set()
    nouns = sorted({n for n, k in counts.items() if n != LEFT_OVER and k >= MIN_EXAMPLES} | known_before)
    materials = sorted((set(examples.materials.tolist()) - {""}) | set(former["materials"].tolist() if former else ()))
    known = np.isin(examples.nouns, [*nouns, LEFT_OVER])
    examples = examples[known]
    noun_index = {n: i for i, n in enumerate([*nouns, LEFT_OVER])}
    material_index = {m: i for i, m in enumerate(materials)} | {"": -100}
    x = examples.features
    mean, scale = x.mean(axis=0), x.std(axis=0) + 0.05
    if former:
        mean[-len(former["mean"]) :], scale[-len(former["scale"]) :] = former["mean"], former["scale"]
    turned = np.concatenate([x, mirrored(x), reversed_depth(x), reversed_depth(mirrored(x))])
    inputs = torch.from_numpy(np.clip((turned - mean) / scale, -CLIP, CLIP).astype(np.float32))
    noun_targets = torch.tensor([noun_index[n] for n in examples.nouns]).repeat(4)
    material_targets = torch.tensor([material_index[m] for m in examples.materials]).repeat(4)
    networks = []
    for k in range(count):
        torch.manual_seed(SEED + k)
        layers = _layers(len(nouns) + 1, len(materials))
        if former:
            weights = {name: former[name][k % len(former[name])] for name in NETWORK}
            _begin_with(layers, weights, former, nouns, materials)
            networks.append(_weights(layers))
        networks.append(
            _weights(_trained(layers, inputs, noun_targets, material_targets, LATER_RATE if former else RATE))
        )
    arrays = {name: np.stack([n[name] for n in networks]).astype(np.float16) for name in networks[0]}
    families = [family_of(n, nouns) for n in nouns]
    return arrays | {
        "mean": mean.astype(np.float32),
        "scale": scale.astype(np.float32),
        "nouns": np.array(nouns),
        "families": np.array(families),
        "materials": np.array(materials),
        "thresholds": np.zeros(3, np.float32),
    }


def _layers(nouns: int, materials: int) -> dict[str, nn.Linear]:
    return {
        "first": nn.Linear(FEATURES, HIDDEN[0]),
        "second": nn.Linear(*HIDDEN),
        "noun": nn.Linear(HIDDEN[1], nouns),
        "material": nn.Linear(HIDDEN[1], materials),
    }


@torch.no_grad()
def _begin_with(
    layers: dict[str, nn.Linear], weights: Arrays, former: Arrays, nouns: Sequence[str], materials: Sequence[str]
) -> None:
    """Put a former network's weights in: what was no feature of it has no weight, what was no class of it no chance."""
    rows = {
        "first": np.arange(HIDDEN[0]),
        "second": np.arange(HIDDEN[1]),
        "noun": np.array([*(nouns.index(n) for n in former["nouns"]), len(nouns)]),
        "material": np.array([materials.index(m) for m in former["materials"]]),
    }
    for name, layer in layers.items():
        old = torch.from_numpy(weights[f"{name}_weights"].astype(np.float32).T)
        layer.weight.zero_()
        layer.bias.fill_(NO_CHANCE)
        layer.weight[rows[name], -old.shape[1] :] = old
        layer.bias[rows[name]] = torch.from_numpy(weights[f"{name}_biases"].astype(np.float32)[0])


def _trained(
    layers: dict[str, nn.Linear], x: torch.Tensor, nouns: torch.Tensor, materials: torch.Tensor, rate: float
) -> dict[str, nn.Linear]:
    first, second, noun, material = layers.values()
    body = nn.Sequential(nn.Dropout(0.2), first, nn.ReLU(), nn.Dropout(0.3), second, nn.ReLU(), nn.Dropout(0.2))
    parameters = [p for module in (body, noun, material) for p in module.parameters()]
    optimiser = torch.optim.AdamW(parameters, lr=rate, weight_decay=0.03)
    schedule = torch.optim.lr_scheduler.OneCycleLR(optimiser, rate, total_steps=STEPS)
    noun_loss, material_loss = nn.CrossEntropyLoss(label_smoothing=0.05), nn.CrossEntropyLoss(label_smoothing=0.05)
    for _ in range(STEPS):
        rows = torch.randint(len(x), (BATCH,))
        hidden = body(x[rows] + NOISE * torch.randn(BATCH, FEATURES))
        loss = noun_loss(noun(hidden), nouns[rows])
        if (materials[rows] >= 0).any():
            loss = loss + 0.5 * material_loss(material(hidden), materials[rows])
        optimiser.zero_grad()
        loss.backward()
        optimiser.step()
        schedule.step()
    return layers


def _weights(layers: dict[str, nn.Linear]) -> Arrays:
    weights = {f"{name}_weights": layer.weight.detach().numpy().T.copy() for name, layer in layers.items()}
    return weights | {f"{name}_biases": layer.bias.detach().numpy()[None].copy() for name, layer in layers.items()}


@dataclass(frozen=True)
class Judged:
    """What a recogniser thinks of N boxes: its best noun, family and material, each with its probability (N,)."""

    noun: np.ndarray
    noun_p: np.ndarray
    family: np.ndarray
    family_p: np.ndarray
    material: np.ndarray
    material_p: np.ndarray
    left_over: np.ndarray

    def said(self, thresholds: np.ndarray) -> np.ndarray:
        """The noun where it is sure enough, else the family, else "object"."""
        family = np.where(self.family_p >= thresholds[1], self.family, UNKNOWN)
        return np.where(self.noun_p >= thresholds[0], self.noun, family)


def judge(recogniser: Recogniser, features: np.ndarray) -> Judged:
    probabilities, materials = recogniser.probabilities(features)
    nouns, families = np.array(recogniser.nouns), np.array(recogniser.families)
    kinds = np.unique(families)
    totals = np.stack([probabilities[:, :-1][:, families == k].sum(axis=1) for k in kinds], axis=1)
    return Judged(
        nouns[probabilities[:, :-1].argmax(axis=1)],
        probabilities[:, :-1].max(axis=1),
        kinds[totals.argmax(axis=1)],
        totals.max(axis=1),
        np.array(recogniser.materials)[materials.argmax(axis=1)],
        materials.max(axis=1),
        probabilities[:, -1],
    )


def judged_unseen(examples: Examples, former: Arrays | None) -> Judged:
    """What networks that were not trained on a box's world think of it; in the order of the examples."""
    worlds = np.unique(examples.worlds)
    fold = np.searchsorted(worlds, examples.worlds) % FOLDS
    order = np.argsort(fold, kind="stable")
    answers = [
        judge(recogniser_of(train(examples[fold != k], 1, former)), examples.features[fold == k])
        for k in range(FOLDS)
        if (fold == k).any()
    ]
    back = np.argsort(order, kind="stable")
    return Judged(*(np.concatenate([getattr(a, n) for a in answers])[back] for n in Judged.__dataclass_fields__))


def calibrated(judged: Judged, examples: Examples) -> np.ndarray:
    """The least probabilities of a noun, a family and a material that make what is said right often enough."""
    objects, some = examples.nouns != LEFT_OVER, examples.materials != ""
    right = judged.noun == examples.nouns
    noun = least_probability(judged.noun_p[objects], right[objects], WANTED["noun"])
    unsure = objects & (judged.noun_p < noun)
    right = judged.family == heads(examples.nouns)
    family = least_probability(judged.family_p[unsure], right[unsure], WANTED["family"])
    right = judged.material == examples.materials
    material = least_probability(judged.material_p[some], right[some], WANTED["material"])
    return np.array([noun, family, material], np.float32)


def heads(nouns: np.ndarray) -> np.ndarray:
    """The last word of each noun."""
    return np.array([n.split(" ")[-1] for n in nouns.tolist()])


def least_probability(probabilities: np.ndarray, right: np.ndarray, wanted: float) -> float:
    """The least threshold at which the share of ``right`` among the surer ones is as ``wanted``."""
    order = np.argsort(-probabilities, kind="stable")
    if not len(order):
        return 0.9
    share = np.cumsum(right[order]) / np.arange(1, len(order) + 1)
    good = np.flatnonzero(share >= wanted)
    return float(np.clip(probabilities[order][good[-1]] if len(good) else 0.95, LEAST, 0.95))


def card(
    recogniser: Recogniser, judged: Judged, thresholds: np.ndarray, examples: Examples, size: int, kept: int
) -> str:
    """RECOGNISER.md; ``kept`` of the networks are those of a former recogniser."""
    networks = len(recogniser.noun_head[0])
    known_before = (
        f"\n{kept} of the networks are those of the former recogniser, whose worlds are not counted here (its card is "
        "in\nthis file's history); the others began where it stood and learned on."
    )
    said = judged.said(thresholds)
    objects = examples.nouns != LEFT_OVER
    right = said == examples.nouns
    family = ~right & (said == heads(examples.nouns))
    generic = said == UNKNOWN
    wrong = objects & ~right & ~family & ~generic
    dropped = judged.left_over >= MAX_LEFT_OVER
    guessed = objects & (judged.material_p >= thresholds[2]) & (examples.materials != "")
    confused = Counter(zip(examples.nouns[wrong].tolist(), said[wrong].tolist(), strict=True)).most_common(12)
    unknown = objects & ~np.isin(examples.nouns, recogniser.nouns)
    share = lambda mask: f"{mask[objects].mean():.1%}"  # noqa: E731
    return f"""# Model card: the recogniser of the embedded annotator

`recogniser.npz` ({size / 1e6:.2f} MB): {networks} networks, {FEATURES} -> {HIDDEN[0]} -> {HIDDEN[1]} ->
{len(recogniser.nouns)} nouns and "no object of its own", {len(recogniser.materials)} kinds of material; probabilities
averaged. Made by `benchmarks/train_recogniser.py` (`collect`, then `train`); seed {SEED}; Apache-2.0 like the rest.

**Input**: {FEATURES} numbers of a box (`surroundings.py`, `appearance.py`): what goes on beyond its faces and how it
was seen, size, place, shape grid, colours by height, crops of the three views that show most of it. **Output**: a noun,
else the family of nouns, else "object"; a material or none.

**Data**: {len(set(examples.worlds.tolist()))} generated worlds, {len(examples.nouns)} boxes that the annotator
itself made of their renders in both passes ({(~objects).sum()} of them no object of their own);
labels from the generator. No photograph, no captured room, nobody's data but our own.{known_before if kept else ""}

**Figures** by cross-validation: each world is judged by a network that was trained on others ({objects.sum()} matched
boxes; {unknown.sum()} are of nouns too rare to be learned). The thresholds were set on these, so
`benchmarks/ANNOTATION.md`, on further worlds, is the judge.

| | share of matched boxes |
|---|---|
| best noun is right, if it had to answer | {share(judged.noun == examples.nouns)} |
| says the right noun | {share(right)} |
| says the right family ("chair" of an office chair) | {share(family)} |
| says "object" | {share(generic)} |
| says something wrong | {share(wrong)} |
| material right, of the {guessed.sum()} guessed | {(judged.material == examples.materials)[guessed].mean():.1%} |

Of the boxes that are no object of their own {dropped[~objects].mean():.1%} are known as such (probability
{MAX_LEFT_OVER}), of the objects {dropped[objects].mean():.1%}.

**Limits**: it knows {len(recogniser.nouns)} nouns of the embedded world model's catalogue and their looks there. Real
rooms differ: there it is less sure, and it can be wrong with confidence; the 2D detector decides there.
Most frequent mistakes (true -> said): {"; ".join(f"{t} -> {s} ({n})" for (t, s), n in confused) or "none"}.
"""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    for name in ("collect", "showrooms", "train"):
        commands.add_parser(name).add_argument("--data", type=Path, required=True)
    commands.choices["collect"].add_argument("worlds", nargs="+")
    commands.choices["showrooms"].add_argument("--count", type=int, default=6)
    commands.choices["train"].add_argument("--former", type=Path, help="recogniser.npz to keep and to go on from")
    arguments = parser.parse_args()
    torch.set_num_threads(1)
    torch.use_deterministic_algorithms(True)
    if arguments.command == "collect":
        collect(arguments.worlds, arguments.data, Settings())
        return
    if arguments.command == "showrooms":
        collect_showrooms(arguments.count, arguments.data, Settings())
        return
    examples = load(arguments.data)
    former = dict(np.load(arguments.former)) if arguments.former else None
    judged = judged_unseen(examples, former)
    arrays = train(examples, NETWORKS, former)
    arrays["thresholds"] = calibrated(judged, examples)
    np.savez_compressed(HOME / "recogniser.npz", **arrays)
    size = (HOME / "recogniser.npz").stat().st_size
    text = card(recogniser_of(arrays), judged, arrays["thresholds"], examples, size, NETWORKS if former else 0)
    (HOME / "RECOGNISER.md").write_text(text)
    print(text)


if __name__ == "__main__":
    main()
