"""The VLM's verdicts and instructions: what it is shown and told, and what of its answers counts."""

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from filmed_room import film, flight_to, furnished_room
from scripted import FAST

from flymirage_core.errors import BadAnswerError, TransientServiceError
from flymirage_core.language.contact_sheet import contact_sheets
from flymirage_core.language.judge import MeasuredJudge
from flymirage_core.language.verdicts import QualityVerdicts, Verdict
from flymirage_core.language.vlm_judge import VlmJudge
from flymirage_core.language.vlm_prompter import VlmPrompter
from flymirage_core.navigation.trajectories import Trajectories
from flymirage_core.settings import VerdictSettings
from resources.services.language_models import ServiceModel

BOXES = furnished_room()
FLIGHTS = Trajectories(tuple(flight_to(BOXES.by_id(t), i, frames=25, set_index=i) for i, t in enumerate((0, 4))))


@pytest.fixture(scope="module")
def frames(tmp_path_factory: pytest.TempPathFactory) -> Any:
    return film(Path(tmp_path_factory.mktemp("filmed")) / "room", list(FLIGHTS), BOXES)


@pytest.fixture
def vlm(dashscope, account_of) -> Callable[[], ServiceModel]:
    def build() -> ServiceModel:
        account = account_of("quality_verdict", vlm={"base_url": dashscope.base_url, "pace": FAST})
        return ServiceModel("vlm", account.settings.vlm, account)

    return build


def scores(artifacts: int = 5, visibility: int = 4, intent: int = 4, keep: bool | None = None) -> dict[str, Any]:
    values = {"artifacts": artifacts, "visibility": visibility, "intent": intent}
    reasons = {name: {"score": score, "reason": f"{name} in frame 2"} for name, score in values.items()}
    return {**reasons, "keep": min(values.values()) >= 3 if keep is None else keep}


def judge_with(vlm: Callable[[], ServiceModel]) -> VlmJudge:
    return VlmJudge(KeepsAll(), vlm(), 30, at_once=1)


class KeepsAll:
    """Measured gates that let everything pass."""

    name = "measured"

    def judge(self, frames: Any, flights: Trajectories, boxes: Any) -> QualityVerdicts:
        return QualityVerdicts(tuple(Verdict(f.flight_id, True, (), self.name) for f in flights))


class TestVerdicts:
    def test_scores_become_gates_with_reasons(self, vlm, script, frames) -> None:
        script.answers = [scores(), scores(intent=2)]
        first, second = judge_with(vlm).judge(frames, FLIGHTS, BOXES)
        assert first.keep and not second.keep
        assert second.reasons == ("intent in frame 2",)
        assert [g.gate for g in second.gates[-3:]] == ["vlm_artifacts", "vlm_visibility", "vlm_intent"]
        assert "qwen3.5-flash (prompt " in second.judge

    def test_it_sees_two_sheets_and_is_told_the_target(self, vlm, dashscope, script, frames) -> None:
        script.answers = [scores()]
        judge_with(vlm).judge(frames, FLIGHTS, BOXES)
        assert [seen[2] for seen in script.seen] == [2, 2]
        assert "The target is: red chair." in script.seen[0][1]
        assert "4 frames of one flight" in script.seen[0][1] and "1.0 s apart" in script.seen[0][1]

    def test_what_the_measured_gates_drop_is_not_asked_about(self, vlm, dashscope, script, frames) -> None:
        script.answers = [scores()]
        dark = VlmJudge(MeasuredJudge(VerdictSettings(min_brightness=250.0)), vlm(), 30, at_once=1)
        assert dark.judge(frames, FLIGHTS, BOXES).kept == ()
        assert dashscope.requests == []

    def test_a_verdict_that_contradicts_its_scores_is_sent_back(self, vlm, dashscope, script, frames) -> None:
        script.answers = [scores(artifacts=1, keep=True), scores(artifacts=1), scores()]
        verdicts = judge_with(vlm).judge(frames, FLIGHTS, BOXES)
        assert verdicts.kept == (1,)
        assert "keep is True" in dashscope.asked("chat")[1].json["messages"][-1]["content"]

    def test_a_model_that_keeps_talking_nonsense_fails_the_stage(self, vlm, script, frames) -> None:
        script.answers = ["I like it."]
        with pytest.raises(BadAnswerError, match=r"question 'verdict' twice"):
            judge_with(vlm).judge(frames, FLIGHTS, BOXES)

    def test_a_flight_that_the_model_refuses_to_see_is_dropped_for_that(self, vlm, dashscope, script, frames) -> None:
        refusal = dashscope.error(400, "Input data may contain inappropriate content.", "x", "data_inspection_failed")
        script.answers = [refusal, scores()]
        first, second = judge_with(vlm).judge(frames, FLIGHTS, BOXES)
        assert not first.keep and first.reasons[0].startswith("the model refused to look at it")
        assert second.keep

    def test_after_an_outage_only_what_is_missing_is_asked(self, vlm, dashscope, script, frames) -> None:
        script.answers = [scores()]
        judge = judge_with(vlm)
        dashscope.fail("chat", dashscope.error(503, "down", "server_error", "unavailable"))
        with pytest.raises(TransientServiceError):
            judge.judge(frames, FLIGHTS, BOXES)
        judge_with(vlm).judge(frames, FLIGHTS, BOXES)
        assert dashscope.charged_calls == 2


class TestContactSheets:
    def test_one_shows_the_frames_and_the_other_the_box_as_well(self, frames) -> None:
        sheets = contact_sheets(frames.flight(0), BOXES.by_id(0), 30)
        assert (sheets.frames, sheets.seconds_apart) == (4, 1.0)  # 25 frames at 10 Hz: 0, 10, 20 and the last
        bare, boxed = (cv2.imdecode(np.frombuffer(d, np.uint8), 1) for d in (sheets.bare, sheets.boxed))
        assert bare.shape == boxed.shape == (48, 256, 3)
        assert magenta_pixels(boxed) > 20 and magenta_pixels(bare) == 0


def magenta_pixels(bgr: np.ndarray) -> int:
    blue, green, red = bgr.astype(int).transpose(2, 0, 1)
    return int((red + blue - 2 * green > 200).sum())


def answer(object_centred: str = "", relative: str = "", appearance: str = "") -> dict[str, str]:
    return {"object_centred": object_centred, "relative": relative, "appearance": appearance}


class TestInstructions:
    @pytest.fixture
    def write(self, vlm, frames) -> Callable[[], list[Any]]:
        verdicts = QualityVerdicts((Verdict(0, True, (), "t"), Verdict(1, False, (), "t")))
        prompter = VlmPrompter(vlm(), 30, at_once=1)
        return lambda: list(prompter.write("cafe", frames, BOXES, FLIGHTS, verdicts))

    def test_what_reads_back_as_the_target_counts(self, write, script) -> None:
        script.answers = [answer("", "Fly to the chair in front of the bookshelf.", "Go to the red chair.")]
        prompts = {p.kind: p for p in write()}
        assert prompts["relative"].text == "Fly to the chair in front of the bookshelf."
        assert prompts["appearance"].text == "Go to the red chair."
        assert prompts["appearance"].writer.startswith("qwen3.5-flash (prompt ")

    @pytest.mark.parametrize(
        ("said", "why"),
        [
            ("Fly to the chair.", "any of"),  # there are two
            ("Fly to the blue chair.", "not chair 0"),
            ("Fly to the red piano.", ""),
            ("Fly to the red chair next to the piano.", ""),
            ("Fly to the cosy red chair.", "nothing measured confirms"),
        ],
    )
    def test_what_is_ambiguous_or_made_up_is_sent_back_then_left_out(self, write, dashscope, script, said, why) -> None:
        script.answers = [answer(appearance=said)]
        prompts = write()
        assert said not in [p.text for p in prompts]
        assert all(p.writer.startswith("offline") for p in prompts) and prompts
        assert len(dashscope.asked("chat")) == 2
        complaint = script.seen[1][1]
        assert f'"{said}" cannot be used: ' in complaint and why in complaint

    def test_a_better_second_try_counts(self, write, script) -> None:
        script.answers = [answer(appearance="Fly to the chair."), answer(appearance="Fly to the red chair.")]
        appearance = next(p for p in write() if p.kind == "appearance")
        assert appearance.text == "Fly to the red chair." and appearance.writer.startswith("qwen")

    def test_it_is_told_what_is_there(self, write, script) -> None:
        script.answers = [answer(appearance="Go to the red chair.")]
        write()
        told = script.seen[0][1]
        assert "Target: red chair" in told and "Other things of the same name" in told and "blue chair" in told
        assert "in front of a green bookshelf" in told or "in front of and" in told
        assert "All things in the scene: blue chair, brown table" in told

    def test_without_the_model_the_offline_prompter_steps_in(self, write, dashscope, script) -> None:
        script.answers = [dashscope.error(400, "no", "x", "data_inspection_failed")]
        assert {p.writer.split()[0] for p in write()} == {"offline"}


def test_the_sheets_are_jpeg_data_urls(vlm, dashscope, script, frames) -> None:
    script.answers = [scores()]
    judge_with(vlm).judge(frames, Trajectories((replace(FLIGHTS.flights[0]),)), BOXES)
    content = dashscope.asked("chat")[0].json["messages"][1]["content"]
    assert [part["type"] for part in content] == ["image_url", "image_url", "text"]
    assert "json" in json.dumps(dashscope.asked("chat")[0].json).lower()
