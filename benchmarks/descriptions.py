"""How various the offline writer's descriptions are, against the figures that are wanted.

    python benchmarks/descriptions.py                 500 scenes of a growing data set, and 600 draws from each taxonomy
    python benchmarks/descriptions.py 200             200 scenes
    python benchmarks/descriptions.py 500 --read 30   and prints 30 of them, to be read aloud

A sentence frame is a sentence without its facts: nouns, colours, numbers and lists of them are one blank.
"""

import argparse
import time
from collections import Counter

from flymirage_core.scene.description import SceneDescription
from flymirage_core.scene.knowledge import kits, nouns, places
from flymirage_core.scene.taxonomy import STANDARD, standard_taxonomy
from flymirage_core.scene.variety import variety_of
from flymirage_core.scene.writer import OfflineSceneWriter

DRAWS = 600


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenes", type=int, nargs="?", default=500)
    parser.add_argument("--read", type=int, default=0, help="print so many descriptions")
    arguments = parser.parse_args()
    print(f"known: {len(places())} subcategories, {len(kits())} kits, {len(nouns())} nouns that can be built")
    for name in STANDARD:
        print(f"{DRAWS} draws from {name!r}: {balance(name)}")
    start = time.process_time()
    descriptions = grown(arguments.scenes)
    seconds = (time.process_time() - start) / len(descriptions)
    v = variety_of(descriptions)
    rows = [
        ("scenes with the same objects as another", v.same_objects, "0"),
        ("distinct labels (colour, material, noun)", v.labels, ">= 1500 over 500"),
        ("distinct (colour, noun)", v.coloured_nouns, ""),
        ("distinct nouns", v.nouns, ">= 150"),
        ("sentence frames", v.frames, ""),
        ("scenes with the commonest frame", f"{v.widest_share:.1%} ({v.widest_frame!r})", "<= 5 %"),
        ("objects, least / median / most", f"{v.objects_least} / {v.objects_median} / {v.objects_most}", "60 to 100"),
        ("spread over categories", f"{v.category_spread:.1%}", "<= 10 %"),
        ("outdoor scenes", sum(d.setting == "outdoor" for d in descriptions), ""),
        ("words of prose, median", sorted(len(d.prose.split()) for d in descriptions)[len(descriptions) // 2], ""),
        ("longest world prompt, characters", max(len(d.world_prompt) for d in descriptions), ""),
        ("CPU seconds a description", f"{seconds:.4f}", ""),
    ]
    print(f"\n{v.scenes} scenes")
    for what, found, wanted in rows:
        print(f"  {what:42s} {found!s:40s} {wanted}")
    step = max(len(descriptions) // max(arguments.read, 1), 1)
    for d in descriptions[::step][: arguments.read]:
        print(f"\n{d.title} ({d.category} / {d.subcategory}, {d.scene})\n{d.prose}\n[image] {d.image_prompt}")


def balance(name: str) -> str:
    """How evenly a growing data set's draws fall on categories and subcategories."""
    taxonomy = standard_taxonomy(name)
    counts: Counter[tuple[str, str]] = Counter()
    for i in range(DRAWS):
        counts[taxonomy.pick(f"scene-{i:04d}", counts)] += 1
    totals = [sum(counts[c.name, s] for s in c.subcategories) for c in taxonomy.categories]
    within = [[counts[c.name, s] for s in c.subcategories] for c in taxonomy.categories]
    widest = max(max(w) - min(w) for w in within)
    return f"{min(totals)} to {max(totals)} a category, subcategories within {widest} of each other"


def grown(scenes: int) -> list[SceneDescription]:
    """A data set that grows scene by scene, each knowing the counts so far."""
    counts: Counter[tuple[str, str]] = Counter()
    descriptions = []
    for i in range(scenes):
        one = OfflineSceneWriter(counts_so_far=counts).describe(f"scene-{i:04d}")
        counts[one.category, one.subcategory] += 1
        descriptions.append(one)
    return descriptions


if __name__ == "__main__":
    main()
