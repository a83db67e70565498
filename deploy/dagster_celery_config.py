"""Celery's settings for workers: put this folder on PYTHONPATH of `celery -A dagster_celery.app worker -Q dagster`."""

import os

broker_url = os.environ.get("CELERY_BROKER_URL", "redis://localhost:6379/0")
result_backend = os.environ.get("CELERY_RESULT_BACKEND", broker_url)
task_acks_late = True  # a stage whose worker dies is given to another worker ...
task_reject_on_worker_lost = True
worker_prefetch_multiplier = 1  # and nobody hoards stages that others could begin
broker_transport_options = {
    # ... if a whole machine dies: after so many seconds. Longer than the longest stage, or that one runs twice (which
    # costs time, never a wrong product: the store takes the same bytes twice).
    "visibility_timeout": int(os.environ.get("CELERY_VISIBILITY_SECONDS", "7200"))
}
