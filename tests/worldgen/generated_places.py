"""Descriptions of places for tests: a flat of several rooms, a street, works with an office, a tunnel at night."""

from flymirage_core.scene.description import Provenance, SceneDescription
from flymirage_core.scene.design import Light, PlannedObject, Surface, Zone

DAY = Light(time_of_day="afternoon", sky="clear", sources=("windows",), words="a clear afternoon")
NIGHT = Light(time_of_day="night", sky="clear", sources=("work_lights",), words="a clear night")


def zone(name, kind, size, connects_to=(), windows=0, **materials):
    surfaces = tuple(Surface(part=p, colour="light grey", material=m) for p, m in materials.items())
    return Zone(name=name, kind=kind, dimensions=size, surfaces=surfaces, connects_to=connects_to, windows=windows)


def planned(noun, count, placement, relative_to="", zone="", material="oak", **words):
    return PlannedObject(
        noun=noun, count=count, colour="oak brown", material=material, placement=placement,
        relative_to=relative_to, zone=zone, **words,
    )  # fmt: skip


def described(key, zones, objects, light=DAY):
    outdoors = zones[0].kind in ("street", "yard", "courtyard", "rooftop")
    return SceneDescription(
        scene=key, title=key, category="test", subcategory="test", setting="outdoor" if outdoors else "indoor",
        dimensions=zones[0].dimensions, zones=tuple(zones), style="plain", era="today", palette=("white",), light=light,
        objects=tuple(objects), prose="A place.", image_prompt="A place.", world_prompt="A place.",
        provenance=Provenance(kind="generated", writer="test"),
    )  # fmt: skip


def flat(key="flat"):
    rooms = [
        zone("living room", "room", (7, 5.5, 2.8), ("hallway",), 3, floor="oak plank", walls="plaster"),
        zone("hallway", "corridor", (8, 2.6, 2.8), ("living room", "study", "kitchen"), 0),
        zone("study", "room", (4, 4, 2.8), ("hallway",), 1),
        zone("kitchen", "room", (4.5, 3.6, 2.8), ("hallway",), 1, floor="tile"),
    ]
    things = [
        planned("dining table", 1, "on_floor"), planned("dining chair", 6, "around", "dining table"),
        planned("sofa", 1, "against_wall"), planned("television", 1, "on_wall"),
        planned("armchair", 2, "facing", "sofa"), planned("side table", 2, "beside", "sofa"),
        planned("rug", 1, "on_floor", "sofa"), planned("vase", 3, "on_surface", "dining table"),
        planned("pendant lamp", 2, "hanging", "dining table"), planned("desk", 1, "against_wall", zone="study"),
        planned("office chair", 1, "around", "desk", zone="study"),
        planned("bookshelf", 2, "against_wall", zone="study"),
        planned("counter", 2, "against_wall", zone="kitchen"), planned("painting", 4, "on_wall", zone="hallway"),
    ]  # fmt: skip
    return described(key, rooms, things)


def street(key="street"):
    things = [
        planned("bench", 4, "against_wall"), planned("potted plant", 6, "against_wall"),
        planned("round table", 3, "on_floor"), planned("stool", 9, "around", "round table"),
        planned("traffic cone", 5, "in_row"), planned("crate", 6, "on_floor"),
    ]  # fmt: skip
    return described(key, [zone("lane", "street", (28, 11, 7), windows=20, ground="asphalt")], things)


def works(key="works"):
    zones = [
        zone("shop floor", "industrial_floor", (17, 11, 6.4), ("office",), 8, floor="concrete", walls="brick"),
        zone("office", "room", (5, 4, 3), ("shop floor",), 1),
    ]
    things = [
        planned("machine", 5, "in_row", material="painted steel"), planned("workbench", 4, "against_wall"),
        planned("toolbox", 3, "on_surface", "workbench"), planned("barrel", 6, "on_floor", material="steel"),
        planned("pendant lamp", 5, "hanging", material="steel"), planned("desk", 1, "against_wall", zone="office"),
    ]  # fmt: skip
    return described(key, zones, things, NIGHT)


def tunnel(key="tunnel"):
    things = [
        planned("crate", 5, "on_floor"),
        planned("barrel", 5, "against_wall"),
        planned("pendant lamp", 4, "hanging"),
    ]
    return described(key, [zone("tube", "tunnel", (26, 5.5, 3.8), walls="concrete")], things, NIGHT)


EVERY = {"flat": flat, "street": street, "works": works, "tunnel": tunnel}
