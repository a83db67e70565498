"""Marble: nothing is paid twice, whatever gets lost, and its world arrives in metres, z up, on the ground."""

import json
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from designs import design
from fake_http import Reply
from fake_marble import OPENAPI, REFUSED_402, FakeMarble
from marble_files import GROUND, SCALE, originals_of
from scripted import CANARY, FAST, KEYS
from splat_worlds import box

from flymirage_core.errors import (
    BudgetError,
    KeyRefusedError,
    LostStartError,
    ModerationError,
    QuotaError,
    SceneBudgetError,
    ServiceError,
    TransientServiceError,
)
from flymirage_core.rendering.picture import ScenePicture
from flymirage_core.scene.description import Provenance, SceneDescription
from flymirage_core.service_settings import MarbleSettings
from flymirage_core.settings import CleaningSettings
from flymirage_core.splats.collider import from_glb
from resources.services.account import Account
from resources.services.marble import MarbleWorldModel
from resources.services.marble_journal import Journals

DESCRIPTION = SceneDescription(
    **design(), scene="s1", category="c", subcategory="s", provenance=Provenance(kind="generated", writer="test")
)
PICTURE = ScenePicture(np.zeros((48, 72, 3), np.uint8), "test")
ROOM = box([-3, -2, 0], [3, 4, 2.6], step=0.2)  # 6 x 6 m, the camera 1.5 m above its floor


class Clock:
    """Time that passes only when somebody sleeps."""

    def __init__(self) -> None:
        self.now = 1_795_000_000.0

    def __call__(self) -> float:
        return self.now

    def sleep(self, seconds: float) -> None:
        self.now += max(seconds, 1e-3)


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.fixture
def marble(clock: Clock) -> Iterator[FakeMarble]:
    with FakeMarble(originals_of(ROOM), KEYS["WORLDLABS_API_KEY"]) as fake:
        fake.clock = clock
        yield fake
        assert fake.violations == []


Build = Callable[..., MarbleWorldModel]


@pytest.fixture
def model(marble: FakeMarble, account_of: Callable[..., Account], clock: Clock) -> Build:
    """model(**Marble's settings, services={...}): a process that has just started."""

    def build(services: dict[str, Any] | None = None, **settings: Any) -> MarbleWorldModel:
        marble_settings = {"base_url": marble.url, "pace": FAST, "poll_seconds": 5.0, **settings}
        account = account_of("world", marble=marble_settings, **(services or {}))
        made = MarbleWorldModel(account.settings.marble, CleaningSettings(), account, clock.sleep, clock)
        made.api.endpoint.pace.sleep = clock.sleep
        return made

    return build


class TestTheWorld:
    def test_stands_on_the_ground_in_metres_around_its_camera(self, model, marble) -> None:
        world = model().build(DESCRIPTION, PICTURE)
        assert np.allclose(world.centre, [0, 0, GROUND])
        low, high = world.cloud.means.min(axis=0), world.cloud.means.max(axis=0)
        assert np.allclose(low, [-3, -2, 0], atol=0.12) and np.allclose(high, [3, 4, 2.6], atol=0.12)
        assert np.allclose(np.sort(world.cloud.scales, axis=1)[:, 2], 0.14, rtol=0.05)
        assert world.notes["scale"] == SCALE and world.notes["semantics"] == "from Marble"
        assert world.notes["caption"] == "A small room."
        assert world.panorama is not None and world.panorama.shape == (64, 128, 3)

    @pytest.mark.parametrize("turned", [False, True])
    def test_has_its_collider_in_the_same_frame_however_it_was_stored(self, model, marble, turned) -> None:
        marble.originals = originals_of(ROOM, collider_turned=turned)
        world = model().build(DESCRIPTION, PICTURE)
        assert world.collider is not None
        vertices, _ = from_glb(world.collider)
        assert np.allclose(vertices.min(axis=0), [-3, -2, 0], atol=0.1)
        assert np.allclose(vertices.max(axis=0), [3, 4, 2.6], atol=0.1)
        assert ("180" in world.notes["collider"]) is turned

    def test_a_collider_that_fits_nowhere_is_left_out_and_noted(self, model, marble) -> None:
        elsewhere = originals_of(replace(ROOM, means=ROOM.means + np.float32([9, 9, 9]))).files["collider.glb"]
        marble.originals = replace(marble.originals, files={**marble.originals.files, "collider.glb": elsewhere})
        world = model().build(DESCRIPTION, PICTURE)
        assert world.collider is None and "in no frame does it fit" in world.notes["collider"]

    def test_without_semantics_scale_is_assumed_and_the_ground_found(self, model, marble) -> None:
        marble.originals = originals_of(ROOM, scale=1.0)
        marble.null_semantics = True
        world = model().build(DESCRIPTION, PICTURE)
        assert np.allclose(world.centre, [0, 0, GROUND], atol=0.15)
        assert "scale assumed 1" in world.notes["semantics"]

    def test_the_best_resolution_is_taken_and_the_originals_are_kept(self, model, marble) -> None:
        world = model().build(DESCRIPTION, PICTURE)
        assert "full_res" in world.notes["source"]
        store = model().account.store
        (key,) = marble.charged
        assert store.read_service_file(f"s1/marble/{key}/world.spz") == marble.originals.files["full_res.spz"]
        assert store.read_service_file(f"s1/marble/{key}/collider.glb") == marble.originals.files["collider.glb"]

    def test_a_kept_world_needs_marble_no_more(self, model, marble) -> None:
        first = model().build(DESCRIPTION, PICTURE)
        asked = len(marble.requests)
        again = model().build(DESCRIPTION, PICTURE)
        assert len(marble.requests) == asked
        assert np.array_equal(first.cloud.means, again.cloud.means)


class TestTheRequest:
    def test_says_what_the_contract_says(self, model, marble) -> None:
        model().build(DESCRIPTION, PICTURE)
        sent = marble.asked("worlds:generate")[0].json
        assert sent["model"] == "marble-1.1-plus" and sent["world_prompt"]["disable_recaption"] is True
        assert "art deco" in sent["world_prompt"]["text_prompt"]
        assert sent["tags"][0] == "flymirage" and len(sent["tags"][1]) <= 32
        assert sent["permission"]["public"] is False and 0 <= sent["seed"] < 2**32

    @pytest.mark.skipif(not OPENAPI.exists(), reason="the vendor's file is not here")
    @pytest.mark.parametrize("settings", [{}, {"picture": "inline"}, {"is_pano": "auto"}, {"is_pano": "false"}])
    def test_every_form_of_it_passes_the_vendors_own_schema(self, model, marble, settings) -> None:
        assert marble.contract is not None
        model(**settings).build(DESCRIPTION, PICTURE)  # the fake answers 422 to whatever the schema refuses

    def test_the_upload_carries_its_headers_and_no_key(self, model, marble) -> None:
        model().build(DESCRIPTION, PICTURE)
        (put,) = marble.asked("/upload/")
        assert put.body[:4] == b"\x89PNG" and CANARY not in json.dumps(put.headers)

    def test_starts_are_paced_and_429_waits(self, model, marble) -> None:
        busy = Reply(429, {"detail": "Rate limit exceeded"}, {"retry-after": "0.1"})
        marble.fail("worlds:generate", busy, times=2)
        model().build(DESCRIPTION, PICTURE)
        assert len(marble.asked("worlds:generate")) == 3 and len(marble.worlds) == 1


class TestNothingIsPaidTwice:
    def test_a_lost_answer_is_found_again_by_its_tag(self, model, marble) -> None:
        marble.fail("worlds:generate", Reply(drop=True), after=True)
        world = model().build(DESCRIPTION, PICTURE)
        assert len(marble.worlds) == 1 and world.notes["adopted"] == 1
        spent = model().account.ledger.spent(scene="s1")
        assert (spent.credits, spent.unsettled) == (2180, 0)  # its operation is unknown: told by the balance

    def test_a_server_error_after_acceptance_is_a_lost_answer(self, model, marble) -> None:
        marble.fail("worlds:generate", Reply(500, {"request_id": "r"}), after=True)
        model().build(DESCRIPTION, PICTURE)
        assert len(marble.worlds) == 1 and len(marble.asked("worlds:generate")) == 1

    def test_a_world_that_is_listed_late_is_waited_for(self, model, marble) -> None:
        marble.listed_after = 200.0
        marble.fail("worlds:generate", Reply(drop=True), after=True)
        model().build(DESCRIPTION, PICTURE)
        assert len(marble.worlds) == 1

    def test_a_start_of_which_there_is_no_trace_asks_a_person(self, model, marble) -> None:
        marble.fail("worlds:generate", Reply(drop=True))
        with pytest.raises(LostStartError, match=r"3 looks for the tag fm-.* balance has fallen by 0 credits"):
            model().build(DESCRIPTION, PICTURE)
        with pytest.raises(LostStartError):  # and again, without sending anything
            model().build(DESCRIPTION, PICTURE)
        assert len(marble.asked("worlds:generate")) == 1
        model(resubmit_after_lost_start="auto").build(DESCRIPTION, PICTURE)
        assert sum(marble.charged.values()) == 2180

    def test_marble_out_of_reach_leaves_nothing_behind(self, model, account_of, clock) -> None:
        with pytest.raises(TransientServiceError, match=r"cannot be reached"):
            model(base_url="http://127.0.0.1:9", connect_timeout=0.2).build(DESCRIPTION, PICTURE)
        assert model().account.ledger.spent().usd == 0
        model().build(DESCRIPTION, PICTURE)

    def test_a_run_that_gave_up_waiting_is_carried_on(self, model, marble) -> None:
        marble.seconds_until_done = 500.0
        with pytest.raises(TransientServiceError, match=r"still making the world .* run the command again"):
            model(poll_budget=60.0).build(DESCRIPTION, PICTURE)
        model().build(DESCRIPTION, PICTURE)
        assert len(marble.worlds) == 1

    def test_an_expired_operation_is_no_loss(self, model, marble) -> None:
        marble.expired_operation = True
        model().build(DESCRIPTION, PICTURE)
        assert len(marble.worlds) == 1
        assert model().account.ledger.spent().credits == 2180

    def test_a_journal_that_cannot_be_read_starts_nothing(self, model, marble) -> None:
        marble.seconds_until_done = 500.0
        with pytest.raises(TransientServiceError):
            model(poll_budget=20.0).build(DESCRIPTION, PICTURE)
        (key,) = marble.charged
        model().account.store.write_service_file(f"s1/marble/{key}.json", b'{"torn')
        with pytest.raises(Exception, match=r"cannot be read"):
            model().build(DESCRIPTION, PICTURE)
        assert len(marble.asked("worlds:generate")) == 1

    @pytest.mark.parametrize("mode", ["thin_snapshot", "wrapped_world", "no_cost"])
    def test_answers_of_other_forms_are_understood(self, model, marble, mode) -> None:
        setattr(marble, mode, True)
        model().build(DESCRIPTION, PICTURE)
        assert model().account.ledger.spent().credits == 2180


class TestDownloads:
    def test_cut_downloads_carry_on_where_they_broke_off(self, model, marble) -> None:
        marble.cut_downloads = 3
        model().build(DESCRIPTION, PICTURE)
        ranges = [r.headers.get("range") for r in marble.asked("full_res.spz")]
        assert ranges[0] is None and len(ranges) == 4 and all(r for r in ranges[1:])

    def test_downloads_that_never_end_are_one_sentence_and_carry_on_next_time(self, model, marble) -> None:
        marble.cut_downloads = 8
        with pytest.raises(
            TransientServiceError, match=r"broke off 6 times .* bytes are kept\): run the command again"
        ):
            model().build(DESCRIPTION, PICTURE)
        marble.cut_downloads = 0
        model().build(DESCRIPTION, PICTURE)
        assert len(marble.worlds) == 1 and marble.asked("full_res.spz")[-1].headers["range"].startswith("bytes=")

    def test_expired_addresses_are_asked_for_anew(self, model, marble) -> None:
        marble.expired_urls = 1
        model(poll_seconds=1.0).build(DESCRIPTION, PICTURE)
        assert len(marble.worlds) == 1

    def test_an_original_that_was_damaged_in_the_store_is_brought_again(self, model, marble) -> None:
        model().build(DESCRIPTION, PICTURE)
        (key,) = marble.charged
        model().account.store.write_service_file(f"s1/marble/{key}/world.spz", b"damaged")
        with pytest.raises(TransientServiceError, match=r"missing or damaged"):
            model().build(DESCRIPTION, PICTURE)
        model().build(DESCRIPTION, PICTURE)
        assert len(marble.worlds) == 1


class TestRefusals:
    def test_the_balance_is_asked_before_anything_is_started(self, model, marble) -> None:
        marble.balance = 3079
        with pytest.raises(QuotaError, match=r"balance is 3079 credits.*nothing was started"):
            model().build(DESCRIPTION, PICTURE)
        assert marble.asked("worlds:generate") == [] and model().account.ledger.spent().usd == 0

    def test_402_stops_the_night(self, model, marble) -> None:
        marble.fail("worlds:generate", Reply(402, {"detail": REFUSED_402}))
        with pytest.raises(QuotaError, match=r"Insufficient API credits"):
            model().build(DESCRIPTION, PICTURE)
        assert model().account.ledger.spent().usd == 0
        model().build(DESCRIPTION, PICTURE)  # after buying some

    def test_caps_hold_before_the_start(self, model, marble) -> None:
        with pytest.raises(SceneBudgetError, match=r"may cost \$2.46"):
            model({"budget": {"scene_usd": 2.0}}).build(DESCRIPTION, PICTURE)
        with pytest.raises(BudgetError, match=r"services.budget.night_usd"):
            model({"budget": {"night_usd": 2.0}}).build(DESCRIPTION, PICTURE)
        assert marble.requests == []

    def test_a_refused_content_is_a_refusal(self, model, marble) -> None:
        marble.refuse_content = True
        with pytest.raises(ModerationError, match=r"content policy"):
            model().build(DESCRIPTION, PICTURE)

    def test_a_wrong_key_is_named_and_not_repeated(self, model, marble, monkeypatch) -> None:
        monkeypatch.setenv("WORLDLABS_API_KEY", "wl-wrong-secret")
        with pytest.raises(KeyRefusedError, match=r"WORLDLABS_API_KEY") as caught:
            model().build(DESCRIPTION, PICTURE)
        assert "wl-wrong-secret" not in str(caught.value)

    def test_a_failed_generation_is_tried_once_more_with_another_seed(self, model, marble) -> None:
        marble.fail_generation = "internal"
        with pytest.raises(ServiceError, match=r"in 2 attempts, each with another seed; the last time: internal"):
            model().build(DESCRIPTION, PICTURE)
        assert len({r.json["seed"] for r in marble.asked("worlds:generate")}) == 2
        with pytest.raises(ServiceError, match=r"2 attempts"):  # known, not asked again
            model().build(DESCRIPTION, PICTURE)
        assert len(marble.asked("worlds:generate")) == 2


def test_the_journal_is_durable_before_the_start_is_sent(model, marble, monkeypatch) -> None:
    builder = model()
    seen: list[str] = []
    generate = builder.api.generate

    def spying(body: dict[str, Any]) -> Any:
        journal = Journals(builder.account.store, "s1").load(body["tags"][1])
        seen.append("" if journal is None else journal.state)
        return generate(body)

    monkeypatch.setattr(builder.api, "generate", spying)
    builder.build(DESCRIPTION, PICTURE)
    assert seen == ["submitting"]


def test_marbles_unconfirmed_quirks_are_settings() -> None:
    fields = MarbleSettings.model_fields
    assert {"is_pano", "text_limit", "list_statuses", "failed_credits", "splats", "key_header", "model"} <= set(fields)
