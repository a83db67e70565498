"""What the embedded world model can build: for each noun its size range, its builder, and whether it has a top."""

from dataclasses import replace

from flymirage_core.worldgen import shapes_decor as decor
from flymirage_core.worldgen import shapes_furniture as furniture
from flymirage_core.worldgen import shapes_plants as plants
from flymirage_core.worldgen import shapes_street as street
from flymirage_core.worldgen import shapes_utility as utility
from flymirage_core.worldgen import shapes_vehicles as vehicles
from flymirage_core.worldgen.kinds import Builder, Kind, kind, round_kind


def _kind(
    build: Builder, x: tuple[float, float], y: tuple[float, float], z: tuple[float, float], top: float = 0.0
) -> Kind:
    return Kind(build, (x[0], y[0], z[0]), (x[1], y[1], z[1]), top=top)


def _round(build: Builder, width: tuple[float, float], z: tuple[float, float], top: float = 0.0) -> Kind:
    return Kind(build, (width[0], width[0], z[0]), (width[1], width[1], z[1]), top=top, square=True)


KINDS: dict[str, Kind] = {
    # tables
    "dining table": _kind(furniture.table, (1.6, 2.1), (0.85, 1.0), (0.74, 0.78), 1.0),
    "conference table": _kind(furniture.table, (2.0, 2.5), (1.0, 1.2), (0.74, 0.76), 1.0),
    "round table": _round(furniture.round_table, (0.9, 1.25), (0.72, 0.77), 1.0),
    "coffee table": _kind(furniture.coffee_table, (0.9, 1.25), (0.55, 0.7), (0.36, 0.42), 1.0),
    "side table": _round(furniture.round_table, (0.42, 0.55), (0.48, 0.62), 1.0),
    "console table": _kind(furniture.table, (1.0, 1.5), (0.34, 0.42), (0.76, 0.88), 1.0),
    "desk": _kind(furniture.desk, (1.3, 1.7), (0.65, 0.8), (0.73, 0.77), 1.0),
    "workbench": _kind(furniture.workbench, (1.5, 2.2), (0.65, 0.8), (0.86, 0.95), 1.0),
    "counter": _kind(furniture.counter, (1.5, 2.4), (0.6, 0.7), (0.92, 1.05), 1.0),
    "reception desk": _kind(furniture.reception_desk, (1.8, 2.4), (0.75, 0.9), (1.08, 1.18), 1.0),
    # seats and beds
    "dining chair": _kind(furniture.chair, (0.44, 0.5), (0.46, 0.52), (0.86, 0.98)),
    "padded chair": _kind(furniture.padded_chair, (0.5, 0.56), (0.52, 0.58), (0.82, 0.92)),
    "armchair": _kind(furniture.sofa, (0.82, 0.98), (0.8, 0.92), (0.8, 0.95)),
    "office chair": _kind(furniture.office_chair, (0.62, 0.68), (0.62, 0.68), (0.98, 1.12)),
    "stool": _round(furniture.stool, (0.36, 0.42), (0.46, 0.7)),
    "bench": _kind(furniture.bench, (1.2, 1.7), (0.38, 0.46), (0.44, 0.48)),
    "seat row": _kind(furniture.seat_row, (1.7, 2.3), (0.58, 0.66), (0.82, 0.9)),
    "sofa": _kind(furniture.sofa, (1.8, 2.35), (0.85, 0.98), (0.78, 0.9)),
    "pouf": _round(furniture.pouf, (0.48, 0.62), (0.36, 0.44)),
    "bed": _kind(furniture.bed, (1.4, 1.8), (2.0, 2.15), (0.95, 1.15)),
    # storage
    "bookshelf": _kind(furniture.bookshelf, (0.8, 1.2), (0.3, 0.36), (1.6, 2.1)),
    "low bookshelf": _kind(furniture.bookshelf, (0.9, 1.4), (0.3, 0.36), (0.85, 1.0), 1.0),
    "storage rack": _kind(furniture.storage_rack, (1.2, 1.8), (0.5, 0.6), (1.7, 2.2)),
    "cabinet": _kind(furniture.cabinet, (0.8, 1.2), (0.42, 0.5), (0.85, 1.1), 1.0),
    "sideboard": _kind(furniture.cabinet, (1.4, 1.9), (0.42, 0.5), (0.78, 0.9), 1.0),
    "wardrobe": _kind(furniture.cabinet, (1.0, 1.5), (0.55, 0.62), (1.9, 2.15)),
    "locker": _kind(furniture.cabinet, (0.9, 1.4), (0.45, 0.52), (1.75, 1.9)),
    "filing cabinet": _kind(furniture.drawers, (0.45, 0.5), (0.55, 0.62), (1.05, 1.35), 1.0),
    "chest of drawers": _kind(furniture.drawers, (0.85, 1.2), (0.45, 0.5), (0.8, 1.0), 1.0),
    "nightstand": _kind(furniture.drawers, (0.45, 0.55), (0.4, 0.45), (0.52, 0.6), 1.0),
    "display case": _kind(furniture.display_case, (0.9, 1.3), (0.45, 0.55), (1.5, 1.8)),
    "fridge": _kind(furniture.fridge, (0.66, 0.78), (0.66, 0.72), (1.75, 1.9)),
    "vending machine": _kind(furniture.vending_machine, (0.85, 1.0), (0.75, 0.85), (1.8, 1.92)),
    "tv stand": _kind(furniture.tv_stand, (1.3, 1.8), (0.4, 0.45), (0.48, 0.58), 1.0),
    # on the floor
    "floor lamp": _round(decor.floor_lamp, (0.36, 0.46), (1.5, 1.75)),
    "potted plant": _round(decor.potted_plant, (0.6, 0.85), (0.9, 1.6)),
    "floor vase": _round(decor.vase, (0.3, 0.42), (0.55, 0.85)),
    "sculpture": _round(decor.sculpture, (0.38, 0.5), (1.1, 1.5)),
    "coat rack": _round(decor.coat_rack, (0.44, 0.52), (1.65, 1.8)),
    "basket": _round(utility.basket, (0.38, 0.5), (0.32, 0.45)),
    "waste bin": _round(utility.bin_, (0.3, 0.4), (0.5, 0.75)),
    "cardboard box": _kind(utility.carton, (0.4, 0.6), (0.35, 0.5), (0.32, 0.48)),
    "crate": _kind(utility.crate, (0.6, 0.9), (0.55, 0.75), (0.5, 0.75), 1.0),
    "barrel": _round(utility.barrel, (0.55, 0.62), (0.82, 0.92)),
    "gas cylinder": _round(utility.gas_cylinder, (0.26, 0.32), (1.2, 1.45)),
    "storage tank": _round(utility.tank, (0.9, 1.2), (1.5, 2.0)),
    "machine": _kind(utility.machine, (1.2, 1.7), (0.75, 1.0), (1.25, 1.6)),
    "generator": _kind(utility.generator, (1.1, 1.5), (0.65, 0.8), (0.95, 1.2)),
    "pump": _kind(utility.pump, (0.9, 1.2), (0.5, 0.62), (0.7, 0.95)),
    "pipe rack": _kind(utility.pipe_rack, (1.6, 2.2), (0.24, 0.3), (1.5, 1.9)),
    "tool chest": _kind(utility.tool_chest, (0.65, 0.85), (0.45, 0.5), (0.85, 1.05), 1.0),
    "suitcase": _kind(utility.suitcase, (0.42, 0.5), (0.24, 0.3), (0.8, 1.0)),
    "traffic cone": _round(utility.traffic_cone, (0.34, 0.4), (0.6, 0.75)),
    "information sign": _kind(utility.standing_sign, (0.7, 0.95), (0.36, 0.42), (1.5, 1.75)),
    "ticket machine": _kind(utility.kiosk, (0.62, 0.75), (0.48, 0.56), (1.5, 1.75)),
    "turnstile": _kind(utility.turnstile, (0.8, 0.95), (0.9, 1.1), (0.95, 1.05)),
    "trolley": _kind(utility.trolley, (0.75, 0.95), (0.48, 0.56), (0.85, 0.98)),
    "pallet of sacks": _kind(utility.pallet, (1.0, 1.2), (0.8, 1.0), (0.5, 0.85)),
    "column": replace(_round(utility.column, (0.42, 0.5), (1.0, 1.0)), full_height=True),
    "rug": replace(_kind(decor.rug, (2.2, 2.8), (1.5, 1.9), (0.006, 0.006)), flat=True),
    # on surfaces
    "table lamp": _round(decor.table_lamp, (0.26, 0.34), (0.42, 0.55)),
    "vase": _round(decor.vase, (0.17, 0.24), (0.28, 0.42)),
    "fruit bowl": _round(decor.bowl, (0.28, 0.36), (0.13, 0.17)),
    "stack of books": _kind(decor.book_stack, (0.24, 0.3), (0.2, 0.24), (0.15, 0.24)),
    "mantel clock": _kind(decor.mantel_clock, (0.2, 0.28), (0.1, 0.13), (0.22, 0.3)),
    "monitor": _kind(decor.monitor, (0.55, 0.66), (0.18, 0.22), (0.44, 0.52)),
    "laptop": _kind(decor.laptop, (0.34, 0.38), (0.25, 0.28), (0.24, 0.27)),
    "globe": _round(decor.globe, (0.26, 0.32), (0.36, 0.44)),
    "printer": _kind(decor.printer, (0.42, 0.5), (0.36, 0.4), (0.24, 0.3)),
    "microwave": _kind(decor.microwave, (0.46, 0.52), (0.34, 0.38), (0.27, 0.31)),
    "kettle": _round(decor.kettle, (0.24, 0.28), (0.24, 0.3)),
    "candle holder": _round(decor.candle_holder, (0.14, 0.18), (0.24, 0.34)),
    "small plant": _round(decor.small_plant, (0.26, 0.36), (0.32, 0.45)),
    "storage box": _kind(utility.carton, (0.28, 0.38), (0.22, 0.3), (0.18, 0.26)),
    "toolbox": _kind(utility.toolbox, (0.4, 0.5), (0.2, 0.25), (0.22, 0.28)),
    "helmet": _kind(utility.helmet, (0.24, 0.27), (0.28, 0.32), (0.17, 0.2)),
    "bottle": _round(utility.bottle, (0.14, 0.17), (0.32, 0.4)),
    "cooking pot": _round(utility.pot, (0.3, 0.38), (0.2, 0.27)),
    "ball": _round(utility.ball, (0.22, 0.3), (0.22, 0.3)),
    # on walls
    "painting": _kind(decor.painting, (0.6, 1.2), (0.05, 0.06), (0.5, 0.85)),
    "poster": _kind(decor.poster, (0.5, 0.75), (0.025, 0.03), (0.7, 1.0)),
    "notice board": _kind(decor.notice_board, (0.9, 1.4), (0.05, 0.06), (0.65, 0.9)),
    "mirror": _kind(decor.mirror, (0.5, 0.8), (0.05, 0.06), (0.7, 1.1)),
    "television": _kind(decor.television, (1.0, 1.35), (0.06, 0.08), (0.6, 0.78)),
    "wall clock": replace(_kind(decor.wall_clock, (0.34, 0.45), (0.06, 0.07), (0.34, 0.45)), square=True),
    "wall shelf": _kind(decor.wall_shelf, (0.8, 1.1), (0.22, 0.26), (0.38, 0.46)),
    "wall lamp": _kind(decor.sconce, (0.2, 0.26), (0.2, 0.26), (0.34, 0.42)),
    "electrical box": _kind(utility.electrical_box, (0.4, 0.6), (0.16, 0.22), (0.55, 0.8)),
    "fire extinguisher": _kind(utility.fire_extinguisher, (0.22, 0.24), (0.2, 0.22), (0.52, 0.6)),
    # from the ceiling; z is from the ceiling down
    "pendant lamp": _round(decor.pendant_lamp, (0.4, 0.55), (0.55, 0.8)),
    "ceiling light": _kind(decor.ceiling_panel, (0.9, 1.2), (0.3, 0.6), (0.06, 0.08)),
    "hanging plant": _round(decor.hanging_plant, (0.5, 0.65), (0.75, 0.95)),
    # streets and squares
    "park bench": kind(street.park_bench, (1.5, 1.9), (0.6, 0.7), (0.8, 0.9), ("oak brown", "teak wood")),
    "street lamp": kind(street.street_lamp, (0.5, 0.6), (0.5, 1.5), (4.0, 5.2), ("charcoal", "cast iron")),
    "traffic light": kind(street.traffic_light, (0.34, 0.4), (0.5, 0.6), (3.0, 3.5), ("charcoal", "plastic")),
    "fire hydrant": kind(street.hydrant, (0.42, 0.5), (0.36, 0.42), (0.75, 0.9), ("red", "painted iron")),
    "post box": kind(street.mailbox, (0.5, 0.6), (0.5, 0.56), (1.2, 1.45), ("blue", "painted steel")),
    "bollard": round_kind(street.bollard, (0.2, 0.26), (0.9, 1.1), ("charcoal", "cast iron")),
    "litter bin": round_kind(street.litter_bin, (0.5, 0.6), (1.0, 1.15), ("oak brown", "wood")),
    "bus shelter": kind(street.bus_stop, (3.4, 4.2), (1.5, 1.8), (2.5, 2.7), ("slate grey", "painted steel")),
    "phone booth": round_kind(street.phone_booth, (0.9, 1.0), (2.4, 2.6), ("red", "painted steel")),
    "market stall": kind(street.market_stall, (2.2, 2.8), (1.7, 2.1), (2.4, 2.7), ("red", "canvas")),
    "kiosk": kind(street.kiosk, (2.3, 2.9), (1.9, 2.4), (2.7, 3.0), ("forest green", "painted wood")),
    "parking meter": kind(street.parking_meter, (0.22, 0.28), (0.18, 0.22), (1.3, 1.45), ("silver", "brushed steel")),
    "road sign": kind(street.road_sign, (0.7, 0.8), (0.08, 0.1), (2.3, 2.6), ("silver", "aluminium")),
    "concrete barrier": kind(street.concrete_barrier, (1.8, 2.4), (0.56, 0.64), (0.8, 0.95), ("light grey", "concrete")),
    "barricade": kind(street.barricade, (1.4, 1.7), (0.6, 0.7), (1.05, 1.2), ("white", "painted steel")),
    "planter": kind(street.planter, (0.8, 1.4), (0.45, 0.6), (0.7, 0.95), ("terracotta", "clay")),
    "fountain": round_kind(street.fountain, (2.6, 3.4), (2.1, 2.7), ("sand", "sandstone")),
    "statue": round_kind(street.statue, (0.9, 1.1), (2.6, 3.1), ("chalk", "marble")),
    "flagpole": kind(street.flagpole, (1.2, 1.5), (0.3, 0.36), (5.0, 6.5), ("blue", "nylon")),
    "fence panel": kind(street.fence_panel, (1.8, 2.4), (0.09, 0.12), (1.1, 1.7), ("honey brown", "pine wood")),
    "railing": kind(street.fence_panel, (1.6, 2.4), (0.06, 0.08), (1.0, 1.3), ("charcoal", "wrought iron")),
    "bicycle rack": kind(street.bicycle_rack, (1.6, 2.6), (0.7, 0.8), (0.76, 0.86), ("silver", "brushed steel")),
    "picnic table": kind(street.picnic_table, (1.6, 2.0), (1.4, 1.6), (0.72, 0.78), ("tan", "pine wood"), 1.0),
    "parasol": round_kind(street.parasol, (2.4, 3.0), (2.4, 2.7), ("cream", "canvas")),
    "wheelie bin": kind(street.wheelie_bin, (0.56, 0.62), (0.7, 0.8), (1.05, 1.15), ("forest green", "plastic")),
    "dumpster": kind(street.dumpster, (1.8, 2.2), (1.2, 1.5), (1.2, 1.4), ("forest green", "painted steel")),
    "tent": kind(street.tent, (2.8, 3.4), (2.8, 3.4), (2.9, 3.3), ("chalk", "canvas")),
    "arbour": kind(street.arbour, (1.4, 1.7), (0.8, 1.0), (2.2, 2.5), ("white", "painted wood")),
    # trees and plants
    "tree": round_kind(plants.tree, (3.2, 4.4), (4.6, 6.5), ("moss green", "leaves")),
    "birch tree": round_kind(plants.birch, (2.2, 3.0), (5.0, 7.0), ("moss green", "leaves")),
    "fir tree": round_kind(plants.conifer, (2.4, 3.2), (4.5, 6.5), ("forest green", "leaves")),
    "cypress": round_kind(plants.cypress, (0.9, 1.2), (4.0, 5.5), ("forest green", "leaves")),
    "palm tree": round_kind(plants.palm, (3.0, 3.8), (4.5, 6.0), ("green", "leaves")),
    "bush": round_kind(plants.bush, (0.9, 1.5), (0.8, 1.2), ("green", "leaves")),
    "hedge": kind(plants.hedge, (1.8, 3.0), (0.5, 0.8), (0.9, 1.6), ("forest green", "leaves")),
    "topiary": round_kind(plants.topiary, (0.7, 0.9), (1.8, 2.2), ("terracotta", "clay")),
    "flower bed": kind(plants.flower_bed, (1.4, 2.4), (0.9, 1.4), (0.36, 0.46), ("light grey", "stone")),
    "fern": round_kind(plants.fern, (0.8, 1.1), (0.6, 0.85), ("terracotta", "clay")),
    "potted palm": round_kind(plants.potted_palm, (1.0, 1.4), (1.4, 1.9), ("white", "ceramic")),
    "cactus": kind(plants.cactus, (0.5, 0.65), (0.4, 0.45), (0.9, 1.3), ("terracotta", "clay")),
    "snake plant": round_kind(plants.snake_plant, (0.36, 0.46), (0.75, 1.05), ("white", "ceramic")),
    "bamboo": kind(plants.bamboo, (0.9, 1.2), (0.5, 0.65), (1.8, 2.4), ("charcoal", "stone")),
    "tall grass": round_kind(plants.tall_grass, (0.6, 0.9), (0.6, 0.95), ("sage", "leaves")),
    "bonsai": kind(plants.bonsai, (0.4, 0.52), (0.28, 0.34), (0.36, 0.48), ("rust", "ceramic")),
    "boulder": kind(plants.rock, (0.7, 1.6), (0.6, 1.2), (0.4, 0.9), ("grey", "stone")),
    "tree stump": round_kind(plants.stump, (0.5, 0.8), (0.35, 0.5), ("tan", "wood")),
    "log pile": kind(plants.log_pile, (1.3, 1.7), (0.9, 1.1), (0.65, 0.85), ("walnut brown", "wood")),
    "hay bale": kind(plants.hay_bale, (0.9, 1.1), (0.45, 0.5), (0.45, 0.5), ("mustard", "straw")),
    "ivy": kind(plants.ivy, (1.0, 2.0), (0.1, 0.14), (1.4, 2.4), ("forest green", "leaves")),
    "lily pond": kind(plants.lily_pond, (2.2, 3.0), (1.5, 2.1), (0.18, 0.26), ("grey", "stone")),
    # vehicles
    "car": kind(vehicles.car, (1.7, 1.85), (3.9, 4.6), (1.38, 1.55), ("burgundy", "painted steel")),
    "taxi": kind(vehicles.taxi, (1.75, 1.85), (4.2, 4.6), (1.5, 1.62), ("yellow", "painted steel")),
    "van": kind(vehicles.van, (1.9, 2.05), (4.7, 5.4), (2.1, 2.4), ("white", "painted steel")),
    "pickup truck": kind(vehicles.pickup, (1.8, 1.95), (4.7, 5.2), (1.65, 1.8), ("denim blue", "painted steel")),
    "lorry": kind(vehicles.lorry, (2.3, 2.5), (6.2, 7.2), (3.1, 3.5), ("orange", "painted steel")),
    "bus": kind(vehicles.bus, (2.4, 2.55), (8.0, 9.5), (2.9, 3.1), ("red", "painted steel")),
    "bicycle": kind(vehicles.bicycle, (0.55, 0.6), (1.65, 1.8), (1.0, 1.1), ("teal", "painted steel")),
    "scooter": kind(vehicles.scooter, (0.66, 0.72), (1.6, 1.75), (1.1, 1.2), ("mint", "painted steel")),
    "forklift": kind(vehicles.forklift, (1.1, 1.25), (2.9, 3.3), (2.1, 2.3), ("yellow", "painted steel")),
    "rowing boat": kind(vehicles.rowing_boat, (1.3, 1.5), (3.2, 3.8), (0.55, 0.7), ("blue", "painted wood")),
    "motor boat": kind(vehicles.motor_boat, (1.9, 2.2), (5.0, 6.0), (1.5, 1.8), ("navy", "lacquered")),
    "canoe": kind(vehicles.canoe, (0.8, 0.95), (4.0, 4.8), (0.5, 0.65), ("forest green", "painted wood")),
    "wheelbarrow": kind(vehicles.wheelbarrow, (0.6, 0.68), (1.4, 1.6), (0.55, 0.65), ("green", "painted steel")),
    "shopping cart": kind(vehicles.shopping_cart, (0.55, 0.62), (0.9, 1.05), (0.98, 1.05), ("red", "plastic")),
    "hand truck": kind(vehicles.hand_truck, (0.5, 0.58), (0.45, 0.52), (1.15, 1.3), ("red", "painted steel")),
    "pallet jack": kind(vehicles.pallet_jack, (0.55, 0.62), (1.5, 1.7), (1.2, 1.3), ("orange", "painted steel")),
    "wheelchair": kind(vehicles.wheelchair, (0.62, 0.7), (0.9, 1.05), (0.9, 1.0), ("navy", "nylon")),
    "stroller": kind(vehicles.stroller, (0.52, 0.6), (0.9, 1.05), (1.0, 1.1), ("slate grey", "canvas")),
    "light aircraft": kind(vehicles.aircraft, (8.4, 9.6), (5.8, 6.6), (2.0, 2.3), ("white", "painted aluminium")),
}  # fmt: skip

UNKNOWN = _kind(utility.plain_box, (0.4, 0.7), (0.35, 0.5), (0.4, 0.7))


def kind_of(noun: str) -> Kind:
    """The kind for a noun, else for the longest ending of it that is known ("old oak desk"), else a plain body."""
    words = noun.lower().split()
    for start in range(len(words)):
        found = KINDS.get(" ".join(words[start:]))
        if found:
            return found
    ending = next((k for k in KINDS if words and k.split()[-1] == words[-1]), None)
    return KINDS[ending] if ending else UNKNOWN
