"""A whole scene in profile `paper` through Dagster, as a user types it, against services on this machine."""

import json
from collections.abc import Iterator

import pytest
from paper_services import PaperServices, offline_originals, paper_services
from projects import SMALL, Project
from scripted import KEYS

from flymirage_core.language.prompts import Prompts
from flymirage_core.language.verdicts import QualityVerdicts
from flymirage_core.splats.world import World


@pytest.fixture(scope="module")
def grown(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Project, PaperServices, str]]:
    """One scene grown without disturbance, the services that it asked, and what was printed."""
    with paper_services(offline_originals(120_000), KEYS) as services:
        larger = {"FLYMIRAGE_FRAMES__WIDTH": "160", "FLYMIRAGE_FRAMES__HEIGHT": "120"}
        environment = {**SMALL, **larger, **services.environment(KEYS)}
        project = Project(tmp_path_factory.mktemp("paper"), environment)
        outcome = project.flymirage("grow", "--scenes", "1")
        assert outcome.returncode == 0, outcome.stdout + outcome.stderr
        yield project, services, outcome.stdout


def test_every_product_is_made_and_each_service_was_asked_as_often_as_needed(grown) -> None:
    project, services, _ = grown
    store = project.store
    flights = QualityVerdicts.load(store.folder("quality_verdict", "scene-0001"))
    judged = sum(len(v.gates) > 20 for v in flights)
    assert len(services.openai.asked("chat")) == 1 and services.openai.charged_images == 1
    assert len(services.marble.worlds) == 1 and services.marble.violations == []
    assert judged >= 1 and services.dashscope.charged_calls >= 2 * len(flights.kept)


def test_the_world_is_the_one_that_marble_made(grown) -> None:
    project, _, _ = grown
    world = World.load(project.store.folder("world", "scene-0001"))
    assert world.notes["semantics"] == "from Marble" and world.notes["caption"] == "A small room."
    assert world.panorama is not None


def test_prompts_say_who_wrote_them(grown) -> None:
    project, _, _ = grown
    prompts = Prompts.load(project.store.folder("prompts", "scene-0001"))
    writers = {p.writer.split()[0] for p in prompts}
    assert writers and writers <= {"qwen3.5-flash", "offline"}  # offline where a sentence did not read back


def test_costs_are_in_the_records_and_in_the_ledger(grown) -> None:
    project, _, _ = grown
    records = {a: project.store.current(a, "scene-0001") for a in ("description", "image", "world", "quality_verdict")}
    assert records["world"].usd == pytest.approx(2180 / 1250) and records["world"].usage["credits"] == 2180
    assert records["image"].usd == pytest.approx(0.165, abs=0.02)
    assert records["quality_verdict"].usage["scene_usd"] > 1.9
    lines = [json.loads(line) for line in project.flymirage("costs", "--json").stdout.splitlines()]
    total = sum(line["spent"]["usd"] for line in lines)
    assert {line["service"] for line in lines} == {"writer", "images", "marble", "vlm"}
    assert 1.9 < total < 2.2 and all(line["spent"]["unsettled"] == 0 for line in lines)


def test_no_key_is_in_the_store_in_dagsters_home_or_in_what_was_printed(grown) -> None:
    """Dagster's home holds all that the UI shows: runs, events, metadata and logs."""
    project, _, printed = grown
    files = [path for path in (project.folder / ".flymirage").rglob("*") if path.is_file()]
    assert any("dagster" in path.parts and path.suffix == ".db" for path in files)
    for key in KEYS.values():
        assert key not in printed
        assert [path for path in files if key.encode() in path.read_bytes()] == []


def test_running_again_asks_nobody(grown) -> None:
    project, services, _ = grown
    fakes = (services.openai, services.dashscope, services.marble)
    asked = [len(fake.requests) for fake in fakes]
    assert project.flymirage("make", "scene-0001").returncode == 0
    assert [len(fake.requests) for fake in fakes] == asked
