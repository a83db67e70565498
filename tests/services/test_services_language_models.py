"""Language and image models behind HTTP: what is asked on each wire, what an answer must be, what failures say."""

import json
from collections.abc import Callable

import numpy as np
import pytest
from designs import design
from fake_gemini import FakeGemini
from fake_http import Reply
from fake_openai import FakeOpenAI
from pydantic import BaseModel
from scripted import FAST, KEYS, Script

from flymirage_core.asking import Question
from flymirage_core.errors import (
    BadAnswerError,
    KeyRefusedError,
    ModerationError,
    QuotaError,
    SceneBudgetError,
    ServiceError,
    TransientServiceError,
)
from flymirage_core.scene.description import SceneDescription
from flymirage_core.scene.llm_writer import ModelSceneWriter
from resources.services.account import Account
from resources.services.language_models import ServiceModel
from resources.services.painter import ServicePainter

AccountOf = Callable[..., Account]
QUESTION = Question("colour", "You name colours.", "Which colour is grass?", seed=7)


class Colour(BaseModel):
    colour: str
    sure: bool


GREEN = {"colour": "green", "sure": True}


def writer_at(url: str, **more: object) -> dict[str, object]:
    return {"base_url": url, "pace": FAST, **more}


def openai_model(openai: FakeOpenAI, account_of: AccountOf, **more: object) -> ServiceModel:
    account = account_of(writer=writer_at(openai.base_url, **more))
    return ServiceModel("writer", account.settings.writer, account)


def gemini_model(gemini: FakeGemini, account_of: AccountOf) -> ServiceModel:
    account = account_of(writer=writer_at(gemini.url, vendor="gemini"))
    return ServiceModel("writer", account.settings.writer, account)


def dashscope_model(dashscope: FakeOpenAI, account_of: AccountOf) -> ServiceModel:
    account = account_of(vlm=writer_at(dashscope.base_url))
    return ServiceModel("vlm", account.settings.vlm, account)


class TestAnswers:
    def test_openai_answers_in_the_schema(self, openai, script, account_of) -> None:
        script.answers = [GREEN]
        assert openai_model(openai, account_of).answer(QUESTION, Colour) == Colour(colour="green", sure=True)
        sent = openai.asked("chat")[0].json
        assert sent["response_format"]["json_schema"]["strict"] is True
        assert sent["seed"] == 7 and sent["store"] is False and sent["messages"][0]["role"] == "developer"

    def test_dashscope_is_told_the_schema_in_words_and_not_to_think(self, dashscope, script, account_of) -> None:
        script.answers = [GREEN]
        picture = Question("colour", "You name colours.", "Which?", (b"\xff\xd8\xff jpeg",))
        assert dashscope_model(dashscope, account_of).answer(picture, Colour).colour == "green"
        sent = dashscope.asked("chat")[0].json
        assert sent["enable_thinking"] is False and sent["response_format"] == {"type": "json_object"}
        assert '"additionalProperties": false' in sent["messages"][0]["content"]
        assert script.seen[0][2] == 1

    def test_gemini_answers_in_the_schema(self, gemini, script, account_of) -> None:
        script.answers = [GREEN]
        model = gemini_model(gemini, account_of)
        assert model.answer(QUESTION, Colour).sure
        spent = model.account.ledger.spent()
        assert spent.output_tokens >= 300  # thoughts are billed

    def test_a_local_server_needs_no_key_but_a_price(self, script, account_of, monkeypatch) -> None:
        script.answers = [f"```json\n{json.dumps(GREEN)}\n```"]
        with FakeOpenAI(script, "", "dashscope") as server:
            server.key = ""
            server.models.append("my-llama")
            server.handle = _without_key(server)  # type: ignore[method-assign]
            local = {
                "vendor": "local",
                "base_url": server.base_url,
                "model": "my-llama",
                "json_mode": "json_object",
                "pace": FAST,
                "extra_body": {"enable_thinking": False},
            }
            account = account_of(writer=local)
            with pytest.raises(ServiceError, match=r"'my-llama' has no price.*prices.tokens"):
                ServiceModel("writer", account.settings.writer, account).answer(QUESTION, Colour)
            free = {"tokens": {"my-llama": {"input": 0, "output": 0, "as_of": "2026-11"}}}
            account = account_of(writer=local, prices=free)
            assert ServiceModel("writer", account.settings.writer, account).answer(QUESTION, Colour).sure
            assert account.ledger.spent().usd == 0
            assert "authorization" not in server.asked("chat")[0].headers

    def test_one_repair_call_says_what_was_wrong(self, openai, script, account_of) -> None:
        script.answers = ['{"colour": "green"}', GREEN]
        assert openai_model(openai, account_of).answer(QUESTION, Colour).sure
        repair = openai.asked("chat")[1].json["messages"]
        assert repair[-2] == {"role": "assistant", "content": '{"colour": "green"}'}
        assert "sure: Field required" in repair[-1]["content"]

    def test_two_bad_answers_are_a_clear_failure_and_are_not_kept(self, openai, script, account_of) -> None:
        script.answers = ["no json", "still none", GREEN]
        model = openai_model(openai, account_of)
        with pytest.raises(BadAnswerError, match=r"gpt-5.4 answered the question 'colour' twice .*no valid Colour"):
            model.answer(QUESTION, Colour)
        assert len(openai.asked("chat")) == 2
        assert model.answer(QUESTION, Colour).sure  # asked anew, not read from what was bad

    def test_an_answer_that_was_paid_for_is_not_asked_again(self, openai, script, account_of) -> None:
        script.answers = [GREEN]
        model = openai_model(openai, account_of)
        first = model.answer(QUESTION, Colour)
        spent = model.account.ledger.spent().usd
        again = openai_model(openai, account_of)
        assert again.answer(QUESTION, Colour) == first
        assert len(openai.asked("chat")) == 1
        assert again.account.ledger.spent().usd == spent > 0


def _without_key(server: FakeOpenAI) -> Callable[..., Reply]:
    return lambda request: server._chat(request.json)


class TestFailures:
    @pytest.mark.parametrize(
        ("status", "code", "kind"),
        [
            (401, "invalid_api_key", KeyRefusedError),
            (403, "unsupported_country_region_territory", KeyRefusedError),
            (404, "model_not_found", KeyRefusedError),
            (429, "insufficient_quota", QuotaError),
            (400, "Arrearage", QuotaError),
            (400, "content_policy_violation", ModerationError),
            (400, "DataInspectionFailed", ModerationError),
            (400, "context_length_exceeded", ServiceError),
            (500, "server_error", TransientServiceError),
            (503, "slow_down", TransientServiceError),
        ],
    )
    def test_each_refusal_says_whether_to_wait_to_give_up_or_to_stop(
        self, openai, script, account_of, status, code, kind
    ) -> None:
        script.answers = [GREEN]
        openai.fail("chat", openai.error(status, "No, because.", "some_error", code), times=9)
        model = openai_model(openai, account_of)
        with pytest.raises(ServiceError, match=f"gpt-5.4 answered {status} .*No, because") as caught:
            model.answer(QUESTION, Colour)
        assert type(caught.value) is kind
        assert len(openai.asked("chat")) == 1  # a paid POST is not sent again
        assert model.account.ledger.spent().usd == 0  # refused: nothing was charged

    def test_429_waits_as_long_as_it_is_asked_to_and_goes_on(self, openai, script, account_of) -> None:
        script.answers = [GREEN]
        busy = openai.error(429, "Rate limit reached", "requests", "rate_limit_exceeded", **{"retry-after": "0.2"})
        openai.fail("chat", busy, times=2)
        assert openai_model(openai, account_of).answer(QUESTION, Colour).sure
        assert len(openai.asked("chat")) == 3

    def test_a_429_that_wants_a_long_pause_ends_the_attempt(self, openai, script, account_of) -> None:
        script.answers = [GREEN]
        busy = openai.error(429, "Come back tomorrow", "requests", "rate_limit_exceeded", **{"retry-after": "3600"})
        openai.fail("chat", busy)
        with pytest.raises(TransientServiceError) as caught:
            openai_model(openai, account_of).answer(QUESTION, Colour)
        assert caught.value.retry_after == 3600

    def test_geminis_retry_info_is_honoured(self, gemini, script, account_of) -> None:
        script.answers = [GREEN]
        gemini.fail("generateContent", gemini.out_of_breath(0.1), times=2)
        assert gemini_model(gemini, account_of).answer(QUESTION, Colour).sure

    def test_a_lost_answer_is_not_asked_again_and_stays_on_the_books(self, openai, script, account_of) -> None:
        script.answers = [GREEN]
        openai.fail("chat", Reply(drop=True), after=True)
        model = openai_model(openai, account_of)
        with pytest.raises(TransientServiceError, match=r"may have been charged.*run the command again"):
            model.answer(QUESTION, Colour)
        assert len(openai.asked("chat")) == 1
        assert model.account.ledger.spent().unsettled == 1

    def test_a_server_that_is_not_there_is_one_sentence(self, account_of) -> None:
        account = account_of(writer=writer_at("http://127.0.0.1:9", connect_timeout=0.3))
        with pytest.raises(TransientServiceError, match=r"writer at http://127.0.0.1:9 cannot be reached"):
            ServiceModel("writer", account.settings.writer, account).answer(QUESTION, Colour)
        assert account.ledger.spent().usd == 0

    def test_a_missing_key_is_named(self, openai, account_of, monkeypatch) -> None:
        monkeypatch.delenv("OPENAI_API_KEY")
        with pytest.raises(KeyRefusedError, match=r"OPENAI_API_KEY is not set.*FLYMIRAGE_PROFILE=offline"):
            openai_model(openai, account_of).answer(QUESTION, Colour)

    @pytest.mark.parametrize(("refusal", "finish"), [("I can't help with that.", "stop"), (None, "content_filter")])
    def test_a_refusal_in_a_200_is_a_refusal(self, openai, script, account_of, refusal, finish) -> None:
        body = {"model": "gpt-5.4", "messages": []}
        message = {"role": "assistant", "content": None, "refusal": refusal}
        script.answers = [Reply(body=openai.completion(body, message, finish))]
        with pytest.raises(ModerationError):
            openai_model(openai, account_of).answer(QUESTION, Colour)

    def test_a_cut_off_answer_says_which_limit_to_raise(self, openai, gemini, script, account_of) -> None:
        message = {"role": "assistant", "content": '{"colour": "gre', "refusal": None}
        script.answers = [Reply(body=openai.completion({"model": "gpt-5.4", "messages": []}, message, "length"))]
        with pytest.raises(BadAnswerError, match=r"cut off at 12000 tokens: raise max_tokens"):
            openai_model(openai, account_of).answer(QUESTION, Colour)
        script.answers = [Reply(body=gemini.candidates("gemini-3.1-pro-preview", "{", "MAX_TOKENS"))]
        with pytest.raises(BadAnswerError, match=r"cut off"):
            gemini_model(gemini, account_of).answer(QUESTION, Colour)

    def test_geminis_blocks_are_refusals(self, gemini, script, account_of) -> None:
        script.answers = [Reply(body=gemini.blocked("PROHIBITED_CONTENT"))]
        with pytest.raises(ModerationError, match=r"PROHIBITED_CONTENT"):
            gemini_model(gemini, account_of).answer(QUESTION, Colour)

    def test_a_wrong_gemini_key_is_a_wrong_key_although_it_is_a_400(self, gemini, account_of, monkeypatch) -> None:
        monkeypatch.setenv("GEMINI_API_KEY", "AIza-wrong")
        with pytest.raises(KeyRefusedError, match=r"GEMINI_API_KEY"):
            gemini_model(gemini, account_of).answer(QUESTION, Colour)

    def test_an_address_that_serves_a_web_page_is_one_sentence(self, openai, account_of) -> None:
        openai.fail("chat", Reply(body=b"<html>hello</html>", headers={"content-type": "text/html"}))
        with pytest.raises(BadAnswerError, match=r"no JSON object .*is the base URL right"):
            openai_model(openai, account_of).answer(QUESTION, Colour)

    def test_a_cap_stops_before_the_call_that_would_break_it(self, openai, script, account_of) -> None:
        script.answers = [GREEN]
        account = account_of(writer=writer_at(openai.base_url), budget={"scene_usd": 0.1})
        with pytest.raises(SceneBudgetError, match=r"services.budget.scene_usd = \$0.10: nothing was sent"):
            ServiceModel("writer", account.settings.writer, account).answer(QUESTION, Colour)
        assert openai.asked("chat") == []


class TestSceneWriter:
    def test_the_pick_is_ours_and_the_design_the_models(self, openai, script, account_of) -> None:
        script.answers = [design()]
        description = ModelSceneWriter(openai_model(openai, account_of), rerolls=3).describe("s1")
        assert f"Category: {description.category}" in script.seen[0][1]
        assert f"Type: {description.subcategory}" in script.seen[0][1]
        assert description.title == "Quiet reading room" and description.scene == "s1"
        assert description.provenance.writer.startswith("gpt-5.4 (prompt ")

    def test_a_design_that_contradicts_itself_is_repaired(self, openai, script, account_of) -> None:
        lost = design()
        lost["objects"][3]["relative_to"] = "piano"
        script.answers = [lost, design()]
        ModelSceneWriter(openai_model(openai, account_of), rerolls=3).describe("s1")
        assert "'piano', which is not among the objects" in openai.asked("chat")[1].json["messages"][-1]["content"]

    def test_a_refused_design_is_rolled_again_and_says_so(self, openai, script, account_of) -> None:
        refusal = openai.error(400, "Not this.", "invalid_request_error", "content_policy_violation")
        script.answers = [refusal, refusal, design()]
        description = ModelSceneWriter(openai_model(openai, account_of), rerolls=3).describe("s1")
        assert description.provenance.writer.endswith(", design 3 after 2 refused")
        seeds = [r.json["seed"] for r in openai.asked("chat")]
        assert len(set(seeds)) == 3

    def test_refusals_are_bounded(self, openai, script, account_of) -> None:
        script.answers = [openai.error(400, "Not this.", "invalid_request_error", "content_policy_violation")]
        with pytest.raises(ModerationError, match=r"3 designs of a .* were refused, each with another seed"):
            ModelSceneWriter(openai_model(openai, account_of), rerolls=2).describe("s1")
        assert len(openai.asked("chat")) == 3


class TestPainter:
    def painter(self, openai: FakeOpenAI, account_of: AccountOf) -> ServicePainter:
        account = account_of("image", painter=writer_at(openai.base_url))
        return ServicePainter(account.settings.painter, account)

    def described(self, script: Script, openai: FakeOpenAI, account_of: AccountOf) -> SceneDescription:
        script.answers = [design()]
        return ModelSceneWriter(openai_model(openai, account_of), rerolls=0).describe("s1")

    def test_the_picture_of_a_description_is_painted_once(self, openai, script, account_of) -> None:
        description = self.described(script, openai, account_of)
        picture = self.painter(openai, account_of).paint(description)
        again = self.painter(openai, account_of).paint(description)
        assert np.array_equal(picture.rgb, again.rgb) and openai.charged_images == 1
        assert picture.painter.startswith("gpt-image-2 1536x1024 high (prompt ")
        sent = openai.asked("images")[0].json
        assert "art deco reading room" in sent["prompt"] and "response_format" not in sent
        spent = self.painter(openai, account_of).account.ledger.spent(asset="image")
        assert spent.images == 1 and spent.usd == pytest.approx(0.165, abs=0.01)

    def test_a_picture_that_was_lost_is_not_ordered_again_by_itself(self, openai, script, account_of) -> None:
        description = self.described(script, openai, account_of)
        openai.fail("images", Reply(drop=True), after=True)
        with pytest.raises(TransientServiceError, match=r"may have been charged"):
            self.painter(openai, account_of).paint(description)
        assert openai.charged_images == 1

    def test_a_refused_picture_is_a_refusal(self, openai, script, account_of) -> None:
        description = self.described(script, openai, account_of)
        openai.fail(
            "images",
            openai.error(400, "Your request was rejected.", "image_generation_user_error", "moderation_blocked"),
        )
        with pytest.raises(ModerationError, match=r"moderation_blocked"):
            self.painter(openai, account_of).paint(description)


class TestVendorsOwnClients:
    """The vendors' SDKs parse our fakes: so the fakes speak as the services do."""

    def test_openais_client_reads_chat_images_and_errors(self, openai, script) -> None:
        sdk = pytest.importorskip("openai")
        script.answers = [GREEN]
        client = sdk.OpenAI(api_key=KEYS["OPENAI_API_KEY"], base_url=openai.base_url, max_retries=1)
        busy = openai.error(429, "slow", "requests", "rate_limit_exceeded", **{"retry-after": "0.1"})
        openai.fail("chat", busy)
        parsed = client.chat.completions.parse(
            model="gpt-5.4", messages=[{"role": "user", "content": "hi"}], response_format=Colour, seed=1
        )
        assert parsed.choices[0].message.parsed == Colour(colour="green", sure=True)
        assert parsed.usage.prompt_tokens > 0
        image = client.images.generate(model="gpt-image-2", prompt="a room", size="1536x1024", quality="low")
        assert image.data[0].b64_json and image.usage.output_tokens == 158
        with pytest.raises(sdk.AuthenticationError):
            sdk.OpenAI(api_key="sk-no", base_url=openai.base_url).models.list()
        assert [m.id for m in client.models.list()] == ["gpt-5.4", "gpt-image-2"]

    def test_googles_client_reads_answers_and_errors(self, gemini, script) -> None:
        genai = pytest.importorskip("google.genai")
        script.answers = [GREEN]
        options = genai.types.HttpOptions(base_url=gemini.url)
        client = genai.Client(api_key=KEYS["GEMINI_API_KEY"], http_options=options)
        config = genai.types.GenerateContentConfig(
            response_mime_type="application/json",
            response_json_schema=Colour.model_json_schema(),
            seed=1,
            thinking_config=genai.types.ThinkingConfig(thinking_level="LOW"),
        )
        answer = client.models.generate_content(model="gemini-3.1-pro-preview", contents="hi", config=config)
        assert json.loads(answer.text) == GREEN and answer.usage_metadata.thoughts_token_count == 300
        gemini.fail("generateContent", gemini.out_of_breath(1))
        with pytest.raises(genai.errors.ClientError):
            client.models.generate_content(model="gemini-3.1-pro-preview", contents="hi", config=config)
