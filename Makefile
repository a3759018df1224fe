# Two commands for everybody: `make report` and `make test`. Both make .venv from nothing but python3, pip and make.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
STAMP := $(VENV)/.installed

.PHONY: report test test-slow test-long floors figures bench fuzz hunt coverage mutate clean

report: $(STAMP)
	$(BIN)/stabilab report cases/*.toml --out report

test: $(STAMP)
	$(BIN)/python -m pytest -n 2 -m "not slow"

test-slow: $(STAMP)
	$(BIN)/python -m pytest -n 2 -m "slow and not long"

# The tests that touch other packages, on the lowest versions that pyproject.toml admits, in an environment of their own
FLOORS := .floors
FLOOR_TESTS := $(addprefix tests/test_,$(addsuffix .py,case certificate cli digits equations extremes_speed fate_speed layout models \
  separatrix_fast show simulation stability surroundings trajectories verify))
floors:
	rm -rf $(FLOORS)
	$(PYTHON) -m venv $(FLOORS)
	$(PYTHON) -m tests.floors > $(FLOORS)/constraints.txt
	$(FLOORS)/bin/python -m pip install --quiet --disable-pip-version-check -c $(FLOORS)/constraints.txt -e ".[test,fast]"
	$(FLOORS)/bin/python -m pytest -n 2 -m "not slow" -p no:cacheprovider $(FLOOR_TESTS)

test-long: $(STAMP)
	$(BIN)/python -m pytest -n 2 -m long

figures: $(STAMP)
	$(BIN)/stabilab figures --out figures

bench: $(STAMP)
	$(BIN)/python -m benchmarks

# The case loader under a coverage-guided fuzzer; what breaks it is kept in .fuzz
FUZZ_SECONDS ?= 600
fuzz: $(STAMP)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt -e ".[fuzz]"
	$(BIN)/python -m tests.fuzz $(FUZZ_SECONDS) .fuzz

# Turns the knobs of problems so that two ways to the answer part as far as they can; what exceeds its promise is kept in .hunt
HUNT_SECONDS ?= 600
hunt: $(STAMP)
	$(BIN)/python -W ignore -m tests.hunt $(HUNT_SECONDS) .hunt

# Which lines and branches of the analysis the default suite runs; fails below 95 %
coverage: $(STAMP)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt -e ".[strength]"
	$(BIN)/python -m pytest -n 2 -m "not slow" --cov --cov-report=term:skip-covered tests

# How many small faults in the analysis the tests see (docs/strength.md); 0 faults a subject means all
MUTANTS ?= 60
mutate: $(STAMP)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt -e ".[strength]"
	$(BIN)/python -m tests.mutate --sample $(MUTANTS)

# The table of hard cases: naive error, our error, and what the last place of the inputs does
hard-cases: $(STAMP)
	$(BIN)/python -W ignore -m tests.hard_table

# constraints.txt pins what was tested, so that a fresh install gives the same versions
$(STAMP): pyproject.toml constraints.txt
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt -e ".[test,fast]"
	$(BIN)/python -m compileall -q stabilab
	touch $@

clean:
	rm -rf $(VENV) $(FLOORS) report
