"""`flymirage doctor --services` and `flymirage costs`: what is ready, what a scene will cost, what was spent."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from fake_http import Reply
from marble_files import originals_of
from paper_services import PaperServices, paper_services
from scripted import FAST, KEYS
from splat_worlds import box

from flymirage_core.settings import Settings
from resources.services.account import Account
from resources.services.checkup import PAPER_USD, Check, check_services, scene_cost
from resources.services.ledger import Call, Usage
from resources.store import Store


@pytest.fixture
def services() -> Iterator[PaperServices]:
    with paper_services(originals_of(box([-2, -2, 0], [2, 2, 2.6], step=0.4)), KEYS) as running:
        yield running


def settings_for(services: PaperServices, **more: Any) -> Settings:
    pace = {"pace": {**FAST, "tries": 1}}
    chosen = {
        "writer": {"base_url": services.openai.base_url, **pace},
        "painter": {"base_url": services.openai.base_url, **pace},
        "vlm": {"base_url": services.dashscope.base_url, **pace},
        "marble": {"base_url": services.marble.url, **pace},
    }
    return Settings(profile="paper", services={**chosen, **more})


def checked(services: PaperServices, folder: Path, **more: Any) -> list[Check]:
    return list(check_services(settings_for(services, **more), Store(str(folder))))


def test_ready_services_are_all_fine_and_cost_nothing_to_ask(services, tmp_path) -> None:
    checks = checked(services, tmp_path)
    assert {c.severity for c in checks} == {"ok"}
    assert any("enough for 32 worlds" in c.sentence for c in checks)
    assert services.openai.charged_calls == services.dashscope.charged_calls == len(services.marble.worlds) == 0


def test_each_missing_or_wrong_key_is_named(services, tmp_path, monkeypatch) -> None:
    monkeypatch.delenv("WORLDLABS_API_KEY")
    monkeypatch.setenv("DASHSCOPE_API_KEY", "sk-wrong")
    problems = [c.sentence for c in checked(services, tmp_path) if c.severity == "problem"]
    assert len(problems) == 2
    assert "WORLDLABS_API_KEY is not set" in problems[0] and "check the key in DASHSCOPE_API_KEY" in problems[1]


def test_an_empty_purse_is_a_problem(services, tmp_path) -> None:
    services.marble.balance = 100
    assert any(c.severity == "problem" and "enough for 0 worlds" in c.sentence for c in checked(services, tmp_path))


def test_a_model_without_price_and_a_model_that_is_not_there_are_told(services, tmp_path) -> None:
    vlm = {"base_url": services.dashscope.base_url, "model": "qwen9", "pace": FAST}
    sentences = [c.sentence for c in checked(services, tmp_path, vlm=vlm) if c.severity != "ok"]
    assert any("qwen9 is not listed" in s for s in sentences) and any("'qwen9' has no price" in s for s in sentences)


def test_a_clock_that_is_wrong_is_told(services, tmp_path) -> None:
    services.marble.clock_skew = -600.0
    assert any(c.severity == "warning" and "clock is +60" in c.sentence for c in checked(services, tmp_path))


def test_a_service_that_is_down_is_a_problem_of_one_sentence(services, tmp_path) -> None:
    services.marble.fail("credits", Reply(503, {"detail": "billing is down"}), times=9)
    assert any(c.severity == "problem" and "billing is down" in c.sentence for c in checked(services, tmp_path))


def test_a_scene_costs_about_what_it_cost_the_papers_authors(services) -> None:
    *_, total = scene_cost(settings_for(services))
    assert total.low < PAPER_USD < total.high and total.usual == pytest.approx(PAPER_USD, abs=0.2)


class TestLedger:
    def book(self, account: Account, name: str, worst: float = 1.0) -> None:
        account.ledger.book(Call(name, account.scene, account.asset, "marble", "m", worst, "2026-11"))

    def test_a_call_counts_at_its_worst_until_it_is_settled(self, account_of) -> None:
        account = account_of("world")
        self.book(account, "a")
        assert account.ledger.spent().usd == 1.0 and account.ledger.spent().unsettled == 1
        account.ledger.settle("a", Usage(usd=0.4, credits=500))
        account.ledger.settle("a", Usage(usd=0.9, credits=999))  # once is enough
        assert account.ledger.spent().usd == 0.4 and account.ledger.spent().credits == 500

    def test_caps_count_what_is_in_flight(self, account_of) -> None:
        account = account_of("world", budget={"scene_usd": 2.5})
        self.book(account, "a")
        self.book(account, "b")
        with pytest.raises(Exception, match=r"\$2\.00 already spent on scene 's1'"):
            self.book(account, "c")
        account.ledger.release("b")
        self.book(account, "c")

    def test_a_night_ends_at_noon_and_a_month_with_its_last_day(self, account_of) -> None:
        account = account_of("world", budget={"night_usd": 1.5, "month_usd": 2.5})
        now = [1_796_000_000.0]  # 30 November 2026, 00:53 UTC
        ledger = account.ledger
        ledger.clock = lambda: now[0]
        self.book(account, "a")
        with pytest.raises(Exception, match="night_usd"):
            self.book(account, "b")
        now[0] += 12 * 3600
        self.book(account, "b")
        now[0] += 24 * 3600
        self.book(account, "c")  # it is December

    def test_lines_add_up_by_scene_and_model(self, account_of) -> None:
        for scene in ("s1", "s2"):
            account = account_of("world", scene=scene)
            self.book(account, f"{scene}-a")
            account.ledger.settle(f"{scene}-a", Usage(usd=0.5))
        assert [(line.scene, line.spent.usd) for line in account.ledger.lines()] == [("s1", 0.5), ("s2", 0.5)]
