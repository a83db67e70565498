"""The gallery's HTML: the front page with the data set's plots, and a page a scene. Text in, text out."""

import base64
from html import escape

import numpy as np
from numpy.typing import NDArray

from flymirage_core.dataset.card import KIND_MEANINGS, SPLIT_MEANINGS
from flymirage_core.dataset.gallery.svg_charts import bars, paired_columns
from flymirage_core.dataset.statistics import (
    PAPER_LENGTH_SHARES,
    PAPER_MEAN_LENGTH,
    DatasetStatistics,
    SceneShare,
    length_bin_names,
    statistics_of,
)
from flymirage_core.language.prompts import Prompt
from flymirage_core.language.verdicts import Verdict
from flymirage_core.navigation.trajectories import Flight
from flymirage_core.pictures.encoding import jpeg_under

THUMBNAIL_BYTES = 20_000
STYLE = """
:root{color-scheme:light dark;--ink:#1c2430;--paper:#fbfaf7;--line:#d9d6cf;--soft:#66707f;--a:#d9552c;--b:#9aa7b8}
@media(prefers-color-scheme:dark){:root{--ink:#e8e6e1;--paper:#16191f;--line:#343a45;--soft:#98a2b3;--a:#ff7a4d;
--b:#5b6b80}}
*{box-sizing:border-box}body{margin:0 auto;max-width:1180px;padding:28px 24px 80px;background:var(--paper);
color:var(--ink);font:15px/1.5 system-ui,sans-serif}h1{font-size:28px;margin:0 0 4px}
h2{font-size:19px;margin:36px 0 12px}
a{color:var(--a)}p.lead{color:var(--soft);margin:0 0 20px}.row{display:flex;flex-wrap:wrap;gap:18px}
.number{border:1px solid var(--line);border-radius:8px;padding:10px 16px;min-width:120px}
.number b{display:block;font-size:24px}.number span,.soft{color:var(--soft);font-size:13px}
figure{margin:0;align-self:flex-start;border:1px solid var(--line);border-radius:8px;padding:12px 14px}
figcaption{font-weight:600;margin-bottom:8px}svg{max-width:100%;height:auto;display:block}
svg text{fill:var(--ink);font-size:12px}svg .n{fill:var(--soft)}svg .s{font-size:10px}
svg rect,svg rect.ours{fill:var(--a)}svg rect.theirs{fill:var(--b)}
.card{border:1px solid var(--line);border-radius:8px;overflow:hidden;width:340px;text-decoration:none;color:inherit}
.card img,.card video{width:100%;display:block;aspect-ratio:4/3;object-fit:cover;background:#000}
.card div{padding:10px 14px}.card b{display:block}iframe{width:100%;height:620px;border:1px solid var(--line);
border-radius:8px}ul{margin:6px 0;padding-left:18px}.dropped{opacity:.75}td,th{padding:3px 12px 3px 0;text-align:left}
.tag{font-size:12px;border:1px solid var(--line);border-radius:10px;padding:1px 8px;margin-right:4px}
"""


def front_page(shares: tuple[SceneShare, ...], thumbnails: dict[str, NDArray[np.uint8]]) -> str:
    """The plots, then a card for each scene with a picture of it."""
    s = statistics_of(shares)
    numbers = [
        (f"{s.episodes}", "flights kept"),
        (f"{s.flights - s.episodes}", "flown and left out"),
        (f"{s.prompts}", "instructions"),
        (f"{s.scenes}", "scene" if s.scenes == 1 else "scenes"),
        (f"{s.frames}", "frames with depth and pose"),
        (f"{s.mean_length:.2f} m", f"mean flight (paper {PAPER_MEAN_LENGTH} m)"),
        (f"${s.usd:.2f}", "paid for services"),
    ]
    tiles = "".join(f'<div class="number"><b>{escape(n)}</b><span>{escape(what)}</span></div>' for n, what in numbers)
    cards = "".join(_scene_card(share, thumbnails.get(share.counts.scene)) for share in shares)
    body = f"""<h1>FlyMirage data set</h1>
<p class="lead">Aerial vision-language navigation in Gaussian-splat worlds.</p>
<div class="row">{tiles}</div><h2>Figures</h2><div class="row">{_charts(s)}</div>{_terms(shares)}
<h2>Scenes</h2><div class="row">{cards}</div>"""
    return _page("FlyMirage data set", body)


def scene_page(share: SceneShare, prose: str, flights: str, view: str) -> str:
    """One scene: its 3D page in a frame (``view`` is its path, "" if there is none) and its flights."""
    c = share.counts
    frame = f'<iframe src="{escape(view)}" title="the scene in 3D"></iframe>' if view else _NO_VIEW
    hint = "Drag to turn, right-drag to move, scroll to come nearer. Targets are orange." if view else ""
    return _page(
        c.scene,
        f"""<p><a href="../index.html">all scenes</a></p><h1>{escape(c.scene)}</h1>
<p class="lead">{escape(c.category)}, {escape(share.subcategory)}: {c.objects} objects, {c.flights} flights,
{c.episodes} kept; {escape(share.terms)}.</p>{frame}<p class="soft">{hint}</p><p>{escape(prose)}</p>
<h2>Flights</h2><div class="row">{flights}</div>""",
    )


def flight_card(
    flight: Flight,
    label: str,
    split: str,
    verdict: Verdict | None,
    prompts: tuple[Prompt, ...],
    video: str,
    poster: str,
) -> str:
    """A flight's video, its instructions, and what was measured."""
    r = flight.report
    said = "".join(
        f"<li>{escape(p.text)} <span class='soft'>{escape(KIND_MEANINGS[p.kind])}</span></li>" for p in prompts
    )
    kept = verdict is not None and verdict.keep
    why = "" if kept or verdict is None else f"<p>left out: {escape('; '.join(verdict.reasons))}</p>"
    place = f"set {flight.set_index}, leg {flight.leg_index}"
    return f"""<div class="card{"" if kept else " dropped"}">
<video src="{escape(video)}" poster="{poster}" controls muted loop playsinline preload="none"></video>
<div><b>{flight.flight_id:04d} to the {escape(label)}</b>
<span class="tag">{escape(split or "left out")}</span><span class="tag">{place}</span>
<ul>{said}</ul>{why}<span class="soft">{r.length:.2f} m in {r.duration:.1f} s, at most {r.max_speed:.2f} m/s and
{r.max_acceleration:.2f} m/s², {r.min_clearance:.2f} m clear</span></div></div>"""


def data_uri(rgb: NDArray[np.uint8]) -> str:
    return "data:image/jpeg;base64," + base64.b64encode(jpeg_under(rgb, THUMBNAIL_BYTES)).decode()


_NO_VIEW = "<p><i>No 3D page: pip install 'flymirage[view]', then run `flymirage gallery` again.</i></p>"


def _charts(s: DatasetStatistics) -> str:
    total = max(s.episodes, 1)
    ours = {name: count / total for name, count in s.length_histogram.items()}
    paper = dict(zip(length_bin_names(), PAPER_LENGTH_SHARES, strict=True))
    charts = [
        paired_columns("Flown length, metres (per cent of flights)", ours, paper, ("here", "published data set")),
        bars("Kinds of places (scenes)", s.scenes_per_category),
        bars("Commonest labels (boxes)", dict(list(s.commonest_labels.items())[:12])),
        bars("How instructions say where to", {KIND_MEANINGS[k]: n for k, n in s.prompts_per_kind.items()}),
        bars("Splits (flights)", s.episodes_per_split),
        bars("Left out, and why (flights)", _reasons(s) or {"none": 0}),
    ]
    return "".join(charts)


def _reasons(s: DatasetStatistics) -> dict[str, int]:
    """Gates that failed, by their names in plain letters; and flights of which nothing sure could be said."""
    gates = {gate.replace("_", " "): count for gate, count in s.dropped_by_gate.items()}
    return gates | ({"no sure instruction": s.kept_without_prompts} if s.kept_without_prompts else {})


def _terms(shares: tuple[SceneShare, ...]) -> str:
    terms = sorted({share.terms for share in shares})
    splits = "".join(f"<tr><td>{escape(k)}</td><td>{escape(v)}</td></tr>" for k, v in SPLIT_MEANINGS.items())
    listed = "".join(f"<li>{escape(t)}</li>" for t in terms)
    return f"<h2>Terms and splits</h2><ul>{listed}</ul><table>{splits}</table>"


def _scene_card(share: SceneShare, thumbnail: NDArray[np.uint8] | None) -> str:
    c = share.counts
    picture = "" if thumbnail is None else f'<img alt="{escape(c.scene)}" src="{data_uri(thumbnail)}">'
    return f"""<a class="card" href="scenes/{c.scene}.html">{picture}<div><b>{escape(c.scene)}</b>{escape(c.category)}
<br><span class="soft">{c.objects} objects, {c.episodes} of {c.flights} flights kept</span></div></a>"""


def _page(title: str, body: str) -> str:
    return f"""<!doctype html><html lang="en"><head><meta charset="utf-8"><title>{escape(title)}</title>
<meta name="viewport" content="width=device-width,initial-scale=1"><link rel="icon" href="data:,">
<style>{STYLE}</style></head><body>{body}</body></html>
"""
