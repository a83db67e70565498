"""`ServicePainter`: OpenAI's images endpoint. Its answers are always base64; a picture cannot be asked for twice."""

import base64
import binascii
from typing import Any

import cv2
import numpy as np

from flymirage_core.asking import load_template
from flymirage_core.errors import BadAnswerError
from flymirage_core.rendering.picture import ScenePicture
from flymirage_core.scene.description import SceneDescription
from flymirage_core.service_settings import ImageModelSettings
from resources.services.account import Account
from resources.services.chat_wire import explain_openai
from resources.services.endpoint import Endpoint
from resources.services.language_models import CHARACTERS_PER_TOKEN
from resources.services.ledger import Usage
from resources.services.paid import PaidQuestion, ask_paid, price_of

SERVICE = "images"


class ServicePainter:
    """Implements `flymirage_core.worldgen.ports.ImagePainter`."""

    def __init__(self, settings: ImageModelSettings, account: Account) -> None:
        self.settings, self.account = settings, account
        self.template = load_template("flymirage_core.scene", "image_prompt")

        def headers(key: str) -> dict[str, str]:
            return {"Authorization": f"Bearer {key}"}

        self.endpoint = Endpoint(
            SERVICE,
            settings,
            headers,
            lambda response: explain_openai(settings.model, settings.key_env, response),
            account.pace(SERVICE, settings.pace),
        )

    @property
    def name(self) -> str:
        look = f"{self.settings.size} {self.settings.quality}"
        return f"{self.settings.model} {look} (prompt {self.template.fingerprint()})"

    def paint(self, description: SceneDescription) -> ScenePicture:
        """One picture; raises `ModerationError` if the description was refused, other `ServiceError`s."""
        settings = self.settings
        prompt = self.template.text({"image_prompt": description.image_prompt or description.prose})
        body = {
            "model": settings.model,
            "prompt": prompt,
            "size": settings.size,
            "quality": settings.quality,
            "output_format": "png",
            "n": 1,
            "background": "opaque",
            "moderation": settings.moderation,
        }
        price = price_of(self.account.settings.prices, settings.model)
        worst = (len(prompt) / CHARACTERS_PER_TOKEN * price.input + settings.worst_output_tokens * price.output) / 1e6
        question = PaidQuestion("/images/generations", body, worst, self._usage)
        answer = ask_paid(self.account, self.endpoint, question)
        try:
            data = np.frombuffer(base64.b64decode(answer["data"][0]["b64_json"], validate=True), np.uint8)
            image = cv2.imdecode(data, cv2.IMREAD_COLOR)
        except (KeyError, IndexError, TypeError, binascii.Error, cv2.error):
            image = None
        if image is None:
            self.account.forget_answer(question.key(self.endpoint))
            raise BadAnswerError(f"{settings.model} answered without a readable picture; run the command again")
        return ScenePicture(np.ascontiguousarray(image[:, :, ::-1]), self.name)

    def _usage(self, answer: Any) -> Usage:
        price = price_of(self.account.settings.prices, self.settings.model)
        usage = answer.get("usage") or {}
        read = int(usage.get("input_tokens", 0))
        pictures = int((usage.get("input_tokens_details") or {}).get("image_tokens", 0))
        written = int(usage.get("output_tokens", self.settings.worst_output_tokens))
        picture_price = price.input if price.image_input is None else price.image_input
        usd = ((read - pictures) * price.input + pictures * picture_price + written * price.output) / 1e6
        return Usage(usd=usd, input_tokens=read, output_tokens=written, images=len(answer.get("data") or ()))
