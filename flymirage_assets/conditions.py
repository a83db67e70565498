"""When the automation sensor asks for a stage by itself."""

from collections.abc import Sequence

import dagster as dg

from flymirage_assets.pools import is_paid
from flymirage_core.settings import Settings

_HANDLED = dg.AutomationCondition.newly_requested() | dg.AutomationCondition.newly_updated()
_GUARD = (
    ~dg.AutomationCondition.any_deps_missing()
    & ~dg.AutomationCondition.any_deps_in_progress()
    & ~dg.AutomationCondition.in_progress()
)
_UPSTREAM = dg.AutomationCondition.any_deps_match(
    dg.AutomationCondition.data_version_changed() | dg.AutomationCondition.will_be_requested()
)
_NEW = dg.AutomationCondition.missing().newly_true()

CASCADE = ((_NEW | dg.AutomationCondition.code_version_changed() | _UPSTREAM).since(_HANDLED) & _GUARD).with_label(
    "missing, or code or upstream changed"
)
"""A changed stage and all that follows in one run for each scene; what turns out unchanged is cut off in the store."""

ONCE = ((_NEW | _UPSTREAM).since(_HANDLED) & _GUARD).with_label("missing, or upstream changed")
"""For what costs money: a changed prompt or model alone starts nothing; `flymirage rebuild` does, when asked."""


def condition_of(settings: Settings, ports: Sequence[str]) -> dg.AutomationCondition:  # type: ignore[type-arg]
    """`ONCE` for paid stages, `CASCADE` for the others."""
    return ONCE if is_paid(settings, ports) else CASCADE
