"""What came of a night's growth, as an unpartitioned asset: one materialisation a night, numbers plotted over time."""

from dataclasses import asdict
from datetime import UTC, date, datetime
from typing import Any, cast

import dagster as dg

from flymirage_assets.catalogue import KINDS
from flymirage_assets.growing import growth_report as report_of
from flymirage_assets.stage import about
from resources.io_manager import ProductIOManager


class NightConfig(dg.Config):
    """Which night; today's if not given."""

    night: str = ""


def growth_assets() -> list[dg.AssetsDefinition]:
    @dg.asset(
        group_name="growth",
        owners=["team:growth"],
        required_resource_keys={"io_manager"},
        kinds=KINDS["growth_report"],
        metadata=about("growth_report", report_of),
    )
    def growth_report(context: dg.AssetExecutionContext, config: NightConfig) -> dg.MaterializeResult[None]:
        """One night of growth: scenes asked for, grown, failed; flights kept and dropped; dollars; seconds."""
        night = date.fromisoformat(config.night) if config.night else datetime.now(UTC).date()
        store = cast(ProductIOManager, context.resources.io_manager).store
        keys = [key for key in store.scenes() if key.startswith(f"n{night:%Y%m%d}-")]
        numbers: dict[str, Any] = asdict(report_of(store, keys))
        return dg.MaterializeResult(metadata={"night": night.isoformat(), **numbers})

    return [growth_report]
