# Two environments: .venv to use FlyMirage, .venv-test to test it. constraints.txt keeps torch to its small CPU build.
PYTHON ?= python3

.PHONY: demo dev test lint clean

demo: .venv/ready
	.venv/bin/flymirage demo

dev: .venv/ready
	DAGSTER_HOME=$$(.venv/bin/flymirage home) .venv/bin/dagster dev -w workspace.yaml

test: .venv-test/ready
	.venv-test/bin/ruff check .
	.venv-test/bin/ruff format --check .
	.venv-test/bin/mypy
	.venv-test/bin/lint-imports
	.venv-test/bin/pytest -n 2

.venv/ready: pyproject.toml constraints.txt
	$(PYTHON) -m venv .venv
	.venv/bin/pip install -q --disable-pip-version-check -c constraints.txt -e '.[view]'
	touch $@

.venv-test/ready: pyproject.toml constraints.txt
	$(PYTHON) -m venv .venv-test
	.venv-test/bin/pip install -q --disable-pip-version-check -c constraints.txt -e '.[dev]'
	touch $@

clean:
	rm -rf .venv .venv-test .flymirage data
