"""Reading for training: random access, delta timestamps, depth in metres, target masks, and a policy that learns."""

from pathlib import Path

import numpy as np
import pytest
import torch
from filmed_room import renamed, scene_products
from torch import nn
from torch.utils.data import DataLoader

import flymirage_core.dataset
from flymirage_core.dataset.lerobot import DepthExport, export_lerobot
from flymirage_core.dataset.lerobot_schema import DEPTH_KEY, RGB_KEY
from flymirage_core.dataset.scene_products import SceneProducts
from flymirage_core.errors import InputError


@pytest.fixture(scope="module")
def cafe(tmp_path_factory: pytest.TempPathFactory) -> SceneProducts:
    return scene_products(tmp_path_factory.mktemp("cafe"))


@pytest.fixture(scope="module")
def folder(cafe: SceneProducts, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return export_lerobot([cafe, renamed(cafe, "hall")], tmp_path_factory.mktemp("export") / "out").folder


def test_any_frame_in_any_order_is_the_one_that_was_filmed(folder: Path, cafe: SceneProducts) -> None:
    dataset = flymirage_core.dataset.open(folder, depth=True)
    assert len(dataset) == sum(e.length for e in dataset.episodes) == 102
    for index in np.random.default_rng(3).permutation(len(dataset))[:40].tolist():
        item = dataset[index]
        episode = dataset.episodes[int(item["episode_index"])]
        frames = cafe.frames.flight(episode.flight_id)
        (rgb,), (depth,) = frames.rgb_at([int(item["frame_index"])]), frames.depth_at([int(item["frame_index"])])
        np.testing.assert_array_equal((item[RGB_KEY] * 255).round().to(torch.uint8).permute(1, 2, 0).numpy(), rgb)
        np.testing.assert_allclose(item[DEPTH_KEY][0].numpy(), depth / 1000, atol=1e-6)
        assert item["task"] in episode.prompts and item["observation.state"].shape == (13,)


def test_delta_timestamps_stack_neighbours_and_say_where_the_episode_ends(folder: Path) -> None:
    deltas = {RGB_KEY: [-0.1, 0.0], "action": [0.0, 0.1, 0.2, 0.3]}
    dataset = flymirage_core.dataset.open(folder, delta_timestamps=deltas)
    first, second = dataset[0], dataset[1]
    assert first[RGB_KEY].shape == (2, 3, 48, 64) and first["action"].shape == (4, 4)
    assert first[f"{RGB_KEY}_is_pad"].tolist() == [True, False]
    torch.testing.assert_close(second[RGB_KEY][0], first[RGB_KEY][1])
    torch.testing.assert_close(first["action"][1], second["action"][0])
    last = dataset[dataset.episodes[0].length - 1]
    assert last["action_is_pad"].tolist() == [False, True, True, True]


def test_the_target_mask_covers_the_targets_pixels_and_nothing_else(folder: Path, cafe: SceneProducts) -> None:
    dataset = flymirage_core.dataset.open(folder, masks=True)
    item = dataset[10]
    episode = dataset.episodes[int(item["episode_index"])]
    camera = cafe.frames.flight(episode.flight_id).cameras()[int(item["frame_index"])]
    target = cafe.boxes.by_id(episode.row["flymirage/object_id"])
    (u, v), _ = (x[0] for x in camera.project(target.centre))
    mask = item["target_mask"].numpy()
    assert mask[int(v), int(u)] and 0.005 < mask.mean() < 0.5
    rows, columns = np.nonzero(mask)
    pixels, _ = camera.project(target.corners)
    assert columns.min() >= pixels[:, 0].min() - 2 and columns.max() <= pixels[:, 0].max() + 2
    assert rows.min() >= pixels[:, 1].min() - 2 and rows.max() <= pixels[:, 1].max() + 2


def test_splits_and_scenes_are_chosen_by_name(folder: Path) -> None:
    train = flymirage_core.dataset.open(folder, split="train")
    assert {e.split for e in train.episodes} == {"train"}
    assert {e.scene for e in flymirage_core.dataset.open(folder, scenes=["hall"]).episodes} == {"hall"}
    with pytest.raises(InputError, match="has no episode of split 'val_unseen'"):
        flymirage_core.dataset.open(folder, split="val_unseen")


def test_what_cannot_be_had_is_said(folder: Path, cafe: SceneProducts, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"0\.03 s is no multiple of 1/10 s"):
        flymirage_core.dataset.open(folder, delta_timestamps={"action": [0.03]})
    with pytest.raises(InputError, match="there is no 'actions'"):
        flymirage_core.dataset.open(folder, delta_timestamps={"actions": [0.1]})
    flat = export_lerobot([cafe], tmp_path / "flat", DepthExport.NONE).folder
    with pytest.raises(InputError, match="was exported without depth"):
        flymirage_core.dataset.open(flat, depth=True)


def test_depth_alone_decodes_no_video(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    whole = flymirage_core.dataset.open(folder, depth=True)[3]
    monkeypatch.setattr("av.open", lambda *_: pytest.fail("a video was opened"))
    alone = flymirage_core.dataset.open(folder, rgb=False, depth=True)[3]
    assert RGB_KEY not in alone
    torch.testing.assert_close(alone[DEPTH_KEY], whole[DEPTH_KEY])
    with pytest.raises(InputError, match=r"there is no 'observation\.images\.front'"):
        flymirage_core.dataset.open(folder, rgb=False, delta_timestamps={RGB_KEY: [0.1]})


def test_workers_read_the_same_frames(folder: Path) -> None:
    dataset = flymirage_core.dataset.open(folder, depth=True)
    alone = [dataset[i] for i in range(len(dataset))]  # its files are open when the workers are forked
    batches = list(DataLoader(dataset, batch_size=16, num_workers=2, multiprocessing_context="fork"))
    for key in ("observation.state", RGB_KEY, DEPTH_KEY):
        torch.testing.assert_close(torch.cat([b[key] for b in batches]), torch.stack([item[key] for item in alone]))


def test_a_small_policy_learns_to_fly_from_it(folder: Path) -> None:
    """The README's example, shorter."""
    torch.manual_seed(0)
    dataset = flymirage_core.dataset.open(folder, split="train")
    policy = nn.Sequential(nn.Conv2d(3, 8, 5, 4), nn.ReLU(), nn.AdaptiveAvgPool2d(4), nn.Flatten(), nn.Linear(128, 4))
    optimiser = torch.optim.Adam(policy.parameters(), 3e-3)
    losses = []
    loader = DataLoader(dataset, 16, shuffle=True, generator=torch.Generator().manual_seed(0))
    for _ in range(5):
        for batch in loader:
            loss = nn.functional.mse_loss(policy(batch[RGB_KEY]), 10 * batch["action"])
            optimiser.zero_grad()
            loss.backward()
            optimiser.step()
            losses.append(loss.item())
    assert np.mean(losses[-5:]) < 0.7 * np.mean(losses[:5])
