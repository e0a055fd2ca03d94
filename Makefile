# GNU make and a POSIX shell. `make` alone lists the targets.

MIN_PYTHON := 3.11
ifeq ($(origin PYTHON),undefined)
PYTHONS := python3 python3.14 python3.13 python3.12 python3.11
else
PYTHONS := $(PYTHON)
endif
WORKERS ?= 2
SEED ?= 5

VENV := .venv
BIN := $(VENV)/bin
PIP = PIP_DISABLE_PIP_VERSION_CHECK=1 PYTHONWARNINGS=ignore $(BIN)/python -m pip --no-input
INSTALL = $(PIP) install -qq
BENCH_INSTALL = $(subst $(BIN)/,$(BENCH_VENV)/bin/,$(INSTALL))

# The sections of requirements.lock: a heading `# [NAME]`, then pins up to an empty line.
section = sed -n '/^\# \[$(1)\]/,/^$$/p' requirements.lock

# A stamp carries the checksum of what was installed and where. Changed pins, or a checkout
# that was moved, need a new environment; a touched file does not.
checksum = $(shell { pwd; cat pyproject.toml; $(foreach name,$(1),$(call section,$(name));) } | cksum | cut -d' ' -f1)
RUN := $(VENV)/run-$(call checksum,run)
DEV := $(VENV)/dev-$(call checksum,run dev)
DOCS := $(VENV)/docs-$(call checksum,run docs)
BENCH_VENV := .venv-bench
BENCH := $(BENCH_VENV)/ready-$(call checksum,run bench)
BENCHMARKS ?= startup optimise turn route sweep fit study recordings diagnose effects grip reversal
MEASURE := OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1 $(BENCH_VENV)/bin/python -W ignore

.DEFAULT_GOAL := help
.PHONY: help run test check format-check lint types contracts format readme results fuzz chaos bench real prove settings demo docs pictures dist pins clean

help: ## list the targets
	@sed -n 's/^\([a-z-]*\):.*## \(.*\)/\1|\2/p' $(MAKEFILE_LIST) | \
	while IFS='|' read -r name what; do printf '  make %-13s %s\n' "$$name" "$$what"; done

run: $(RUN) ## find the fastest gait of the paper's prototype
	$(BIN)/rr-opt maximize-speed

test: $(DEV) ## run the tests (WORKERS=2)
	$(BIN)/python -m pytest -n $(WORKERS)

check: format-check lint types contracts test ## everything a change has to pass

format-check: $(DEV)
	$(BIN)/ruff format --check .

lint: $(DEV)
	$(BIN)/ruff check .

types: $(DEV)
	$(BIN)/pyright

contracts: $(DEV)
	$(BIN)/lint-imports

format: $(DEV) ## format the code and sort its imports
	$(BIN)/ruff check --select I --fix .
	$(BIN)/ruff format .

readme: $(DEV) ## run every command of README.md and docs/how-to-diagnose.md
	$(BIN)/python -m tests.readme_commands README.md docs/how-to-diagnose.md

results: $(DEV) ## write the results that are kept in results/
	$(BIN)/rr-opt maximize-speed --out results/prototype
	$(BIN)/rr-opt maximize-speed problems/loads --out results/loads
	$(BIN)/rr-opt maximize-speed problems/turning --out results/turning
	$(BIN)/rr-opt shapes --out results/shapes
	$(BIN)/rr-opt turn-chart --out results/turn-chart
	$(BIN)/rr-opt route problems/routes/around.yaml --out results/route
	$(BIN)/rr-opt study problems/studies/servo.yaml --restart --out results/servo
	$(BIN)/rr-opt maximize-speed problems/robust --out results/robust
	$(BIN)/rr-opt study problems/studies/economy.yaml --restart --out results/economy
	$(BIN)/rr-opt study problems/studies/grip.yaml --restart --out results/grip
	$(BIN)/python -m benchmarks.lab_agreement
	$(BIN)/rr-opt reproduce --out results/paper
	$(BIN)/rr-opt calibrate --out results/calibration

fuzz: $(DEV) ## spoil thousands of files, others each time (FUZZ=20000)
	OPENBLAS_NUM_THREADS=1 $(BIN)/python -m tests.robustness.fuzz --inputs $(or $(FUZZ),20000)

chaos: $(DEV) ## kill, starve and cross runs at random moments (KILLS=200)
	$(BIN)/python -m tests.robustness.chaos --kills $(or $(KILLS),200)

bench: $(BENCH) ## measure against other ways to the same answer, into results/bench (an hour)
	@for name in $(BENCHMARKS); do \
	  echo "== $$name"; $(MEASURE) -m benchmarks.$$name || exit 1; \
	done; $(MEASURE) -m benchmarks.regression

real: $(DEV) ## diagnose recordings of real machines (DATA=folder with experiment.yaml, or of sets)
	$(BIN)/python -m benchmarks.real "$(DATA)"

prove: $(DEV) ## try the diagnosis on 100 sealed cases, of the commit's own seed (an hour)
	$(BIN)/rr-opt prove --workers $(WORKERS) --out results/proof

settings: $(DEV) ## halve and double each number of the diagnosis, on 40 cases (a night)
	$(BIN)/python -m benchmarks.settings --workers $(WORKERS)

demo: $(DEV) ## record, diagnose, open the seal, correct, predict: some minutes (SEED=5)
	$(BIN)/python docs/demonstration.py --seed $(SEED)

pins: $(RUN) ## pin the newest dependencies that pyproject.toml allows
	@set -e; export LC_ALL=C; new=$$(mktemp -d); trap 'rm -r "$$new"' EXIT; \
	freeze() { \
	  $(BIN)/python -m venv --clear "$$new/venv"; pip="$$new/venv/bin/python -m pip --no-input"; \
	  $$pip install -qq 'setuptools>=77' "$$2"; \
	  $$pip freeze --all --exclude pip --exclude rr-opt | \
	    sed 's/^backports.zstd==.*/&; python_version < "3.14"/' | sort >"$$new/$$1"; \
	  if [ -n "$$(comm -23 "$$new/run" "$$new/$$1")" ]; then \
	    echo "The extras of $$1 change pins of run: give pyproject.toml narrower bounds." >&2; exit 1; \
	  fi; \
	}; \
	freeze run .; freeze dev '.[netcdf,ros,cluster,lab,dev]'; freeze docs '.[docs]'; \
	{ \
	  sed '/^# \[run\]/,$$d' requirements.lock; echo '# [run]'; cat "$$new/run"; \
	  for name in dev docs; do printf '\n# [%s]\n' $$name; comm -13 "$$new/run" "$$new/$$name"; done; \
	  echo; sed -n '/^# \[bench\]/,$$p' requirements.lock; \
	} >"$$new/lock"; cp "$$new/lock" requirements.lock

docs: $(DOCS) ## build the documentation's site, into out/site
	$(BIN)/python -m mkdocs build --quiet --strict --site-dir out/site

pictures: $(DEV) ## photograph the pages of the gallery, into docs/pages (needs chromium)
	$(BIN)/python docs/pictures.py

dist: $(DEV) ## build the source distribution and the wheel, into dist/
	rm -rf dist build
	$(BIN)/python -W ignore -c 'from setuptools import build_meta as b; b.build_sdist("dist")' >/dev/null
	$(PIP) wheel -qq --no-deps --no-build-isolation --wheel-dir dist dist/*.tar.gz
	cd dist && sha256sum *

clean: ## remove the environment and everything temporary
	rm -rf $(VENV) $(BENCH_VENV) build dist out .pytest_cache .hypothesis .ruff_cache .import_linter_cache
	find . -name __pycache__ -type d -prune -exec rm -rf {} +
	rm -rf src/*.egg-info

$(RUN): | requirements.lock
	@for python in $(PYTHONS); do \
	  if $$python -c 'import sys; sys.exit(sys.version_info < tuple(map(int, "$(MIN_PYTHON)".split("."))))' \
	    2>/dev/null; then found=$$python; break; fi; \
	done; \
	if [ -z "$$found" ]; then \
	  echo "Python $(MIN_PYTHON) or newer is needed. Looked for: $(PYTHONS)." >&2; \
	  for python in $(PYTHONS); do \
	    version=$$($$python -V 2>/dev/null) && echo "  $$python is $$version, too old." >&2; \
	  done; \
	  echo "Install one, or name it: make PYTHON=/path/to/python $(MAKECMDGOALS)" >&2; \
	  exit 1; \
	fi; \
	echo "Setting up $(VENV) with $$($$found -V); once, a minute or two ..."; \
	$$found -m venv --clear $(VENV)
	@$(call section,run) | $(INSTALL) -r /dev/stdin
	@$(INSTALL) --no-deps --no-build-isolation -e .
	@touch $@

$(DEV): $(RUN)
	@echo "Installing what tests and checks need ..."
	@$(call section,dev) | $(INSTALL) -r /dev/stdin
	@touch $@

$(DOCS): $(RUN)
	@echo "Installing what the documentation needs ..."
	@$(call section,docs) | $(INSTALL) -r /dev/stdin
	@touch $@

$(BENCH): | $(RUN)
	@echo "Installing what to measure against, into $(BENCH_VENV) ..."
	@$(VENV)/bin/python -m venv --clear $(BENCH_VENV)
	@$(call section,bench) | $(BENCH_INSTALL) --no-deps -r /dev/stdin
	@$(BENCH_INSTALL) --no-deps --no-build-isolation -e .
	@touch $@
