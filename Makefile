# Two commands on a fresh machine with Python 3.11 or later, git and make:
#   make demo    sets everything up and runs the main job
#   make test    sets everything up and passes all tests

PYTHON ?= $(firstword $(foreach p,python3.14 python3.13 python3.12 python3.11 python3 python,$(if $(shell $p -c "import sys, venv, ensurepip; print(sys.version_info >= (3, 11) or '')" 2>/dev/null | grep True),$p)))
BIN := .venv/bin
# What the pages are built from, when the package is installed:
PAGE := hatch_build.py $(wildcard frontend/src/*/*) frontend/package-lock.json frontend/vite.config.ts $(wildcard src/eigenwalker/stimulus/*.json)

.PHONY: demo test lint bench clean

demo: .venv/installed
	$(BIN)/eigenwalker demo

test: .venv/installed-dev lint
	$(BIN)/pytest -q -n auto

lint: .venv/installed-dev
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/lint-imports
	$(BIN)/pyright

bench: .venv/installed-dev
	$(BIN)/python -m pip install --quiet -e ".[dev,bench]"
	for script in benchmarks/bench_*.py; do $(BIN)/python $$script || exit 1; done

.venv/bin/python:
	@test -n "$(PYTHON)" || { echo "eigenwalker needs Python 3.11 or later with its venv module; found none. Name one: make PYTHON=/path/to/python3"; exit 1; }
	$(PYTHON) -m venv .venv

.venv/installed: pyproject.toml $(PAGE) | .venv/bin/python
	$(BIN)/python -m pip install --quiet -e .
	@touch $@

.venv/installed-dev: pyproject.toml $(PAGE) | .venv/bin/python
	$(BIN)/python -m pip install --quiet -e ".[dev]"
	@if command -v npm >/dev/null; then cd frontend && npm ci --silent || echo "npm could not fetch what tests of the browser's side need; they are skipped"; fi
	@touch $@ .venv/installed

clean:
	rm -rf .venv eigenwalker-demo
