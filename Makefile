# Two commands on a fresh machine with Python 3.11 or later, git and make:
#   make demo    sets everything up and runs the main job
#   make test    sets everything up and passes all tests

PYTHON ?= $(firstword $(foreach p,python3.14 python3.13 python3.12 python3.11 python3 python,$(if $(shell $p -c "import sys, venv, ensurepip; print(sys.version_info >= (3, 11) or '')" 2>/dev/null | grep True),$p)))
BIN := .venv/bin
# What the pages are built from, when the package is installed:
PAGE := hatch_build.py $(wildcard frontend/src/*/*) frontend/package-lock.json frontend/vite.config.ts $(wildcard src/eigenwalker/stimulus/*.json)

# Tests that use every dependency, on the lowest versions that pyproject.toml declares:
LOWEST_PYTHON ?= $(firstword $(foreach p,python3.11 python3.12 python3,$(if $(shell $p -c "import sys, venv, ensurepip; print((3, 11) <= sys.version_info < (3, 13) or '')" 2>/dev/null | grep True),$p)))
LOWEST_TESTS ?= tests/core/test_kinematics.py tests/cli/test_options.py tests/io/test_bvh.py tests/io/test_c3d.py tests/plotting/test_walker_films.py tests/population/test_population.py tests/datasets/test_downloads.py tests/metric/test_loops.py tests/analysis/test_walker_space.py tests/study/test_process_capture.py tests/stimulus/test_stimulus_file.py tests/explorer/test_model.py

# Tests wait for browsers and servers, so there may be more of them at a time than there are cores;
# sums of small matrices are slower with a thread a core.
WORKERS ?= $(shell expr $$(getconf _NPROCESSORS_ONLN) \* 3 / 2)
tests newest lowest: export OMP_NUM_THREADS ?= 1

.PHONY: demo test tests lint lowest newest bench clean

demo: .venv/installed
	$(BIN)/eigenwalker demo

test: lint tests

tests: .venv/installed-dev
	$(BIN)/pytest -q -n $(WORKERS) --dist loadscope

lint: .venv/installed-dev
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/lint-imports
	$(BIN)/pyright

# As the tests of a fresh clone, in an environment that was made before.
newest: .venv/bin/python
	$(BIN)/python -m pip install --quiet --upgrade --upgrade-strategy eager -e ".[dev]"
	$(BIN)/pytest -q -n $(WORKERS) --dist loadscope

# The pages come with the other installation.
lowest: .venv-lowest/installed .venv/installed-dev
	PYTHONPATH=src .venv-lowest/bin/python -m pytest -q -n 2 --dist loadscope -W default -p no:cacheprovider $(LOWEST_TESTS)

.venv-lowest/installed: pyproject.toml .ci/lowest.py
	@test -n "$(LOWEST_PYTHON)" || { echo "The lowest versions have wheels for Python 3.11 and 3.12; found neither. Name one: make lowest LOWEST_PYTHON=/path/to/python3.11"; exit 1; }
	$(LOWEST_PYTHON) -m venv .venv-lowest
	$(LOWEST_PYTHON) .ci/lowest.py > .venv-lowest/requirements.txt
	.venv-lowest/bin/python -m pip install --quiet --no-compile --only-binary :all: -r .venv-lowest/requirements.txt
	@touch $@

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
	$(BIN)/python -m pip install --quiet --no-compile -e ".[dev]"
	@if command -v npm >/dev/null; then cd frontend && npm ci --silent || echo "npm could not fetch what tests of the browser's side need; they are skipped"; fi
	@touch $@ .venv/installed

clean:
	rm -rf .venv .venv-lowest eigenwalker-demo
