# Two commands for everybody: `make report` and `make test`. Both make .venv from nothing but python3, pip and make.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
STAMP := $(VENV)/.installed
COMPILED := $(VENV)/.compiled

.PHONY: report test check test-slow test-long floors figures docs bench fuzz hunt coverage mutate clean

report: $(STAMP)
	$(BIN)/stabilab report cases/*.toml --papers --precision --out report

# ROOM=orbit/fate: the tests of one room or wing alone. A file stays with one of the two workers, which computes once what its tests share
ROOM ?=
test: export PYTHONDONTWRITEBYTECODE =  # where this is set, every process would compile all that it reads once more
test: $(STAMP) $(COMPILED)
	$(BIN)/python -m pytest -n 2 --dist loadfile -m "not slow" $(if $(ROOM),tests/$(ROOM))

# Once for both workers, which would each do it: loops are compiled, which numba keeps beside the sources, and tests read, which pytest does
$(COMPILED): $(STAMP) $(wildcard stabilab/*/*_kernel.py stabilab/unreduced/spin_up/*.py)
	$(BIN)/python -m tests.compiled
	touch $@

# Ruff's rules, types, and who may import whom
check: $(STAMP)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt -e ".[check]"
	$(BIN)/python -m ruff check
	$(BIN)/python -m mypy
	$(BIN)/python -m pytest tests/house/test_layout.py -k "not loads"

test-slow: $(STAMP)
	$(BIN)/python -m pytest -n 2 --dist loadfile -m "slow and not long"

# The tests that touch other packages, on the lowest versions that pyproject.toml admits, in an environment of their own
FLOORS := .floors
FLOOR_TESTS := $(addprefix tests/,$(addsuffix .py,case/test_read answers/test_certificate test_cli answers/digits/test_digits physics/test_equations \
  orbit/fine/test_rows orbit/fate/test_arrays house/test_layout theories/test_follow orbit/separatrix/test_branches \
  show/test_pictures answers/test_simulate equilibrium/test_stability house/test_surroundings integrate/test_trajectory verify/test_verify))
floors:
	rm -rf $(FLOORS)
	$(PYTHON) -m venv $(FLOORS)
	$(PYTHON) -m tests.house.floors > $(FLOORS)/constraints.txt
	$(FLOORS)/bin/python -m pip install --quiet --disable-pip-version-check -c $(FLOORS)/constraints.txt -e ".[all,test]"
	$(FLOORS)/bin/python -m pytest -n 2 -m "not slow" -p no:cacheprovider $(FLOOR_TESTS)

test-long: $(STAMP)
	$(BIN)/python -m pytest -n 2 -m long

figures: $(STAMP)
	$(BIN)/stabilab figures --out figures

# The documentation as a site, docs/_site/index.html; a warning ends it
docs: $(STAMP)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt -e ".[docs]"
	$(BIN)/python -m sphinx -q -W --keep-going -d docs/_site/.trees docs docs/_site

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
coverage: $(STAMP) $(COMPILED)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt -e ".[strength]"
	$(BIN)/python -m pytest -n 2 --dist loadfile -m "not slow" --cov --cov-report=term:skip-covered tests

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
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt -e ".[all,test]"
	$(BIN)/python -m compileall -q stabilab
	touch $@

clean:
	rm -rf $(VENV) $(FLOORS) report
