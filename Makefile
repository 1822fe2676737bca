# Two commands a newcomer needs: `make demo` and `make test`. Each sets up what it needs.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
READY := $(VENV)/.ready
export PIP_DISABLE_PIP_VERSION_CHECK = 1

.PHONY: demo test lint check-types unit soak tools goldens pictures clean help
help:
	@echo "make demo     the stool, end to end, into out/stool/"
	@echo "make test     format, lint, types, import rules and all tests"
	@echo "make tools    the independent readers: hp2xx, LibreCAD, Inkscape, and those of pip and npm (Debian, as root)"
	@echo "make pictures draw docs/gallery.md, the table of materials and machines, and their pictures anew"
	@echo "make soak     the long suites whole; PART=name for one; figures go to benchmarks/soak.md"
	@echo "make goldens  rewrite the golden files after a wanted change"

$(READY): pyproject.toml constraints.txt
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet -c constraints.txt -e ".[all,dev]"
	@touch $(READY)

demo: $(READY)
	$(BIN)/python -m foldmill_fabricate demo -o out/stool

test: lint check-types unit

lint: $(READY)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/lint-imports

check-types: $(READY)
	$(BIN)/mypy

unit: $(READY)
	$(BIN)/python -m pytest -n auto $(PYTEST_ARGS)

PART ?= soak or fuzz
soak: $(READY)
	$(BIN)/python -m pytest -n 0 --soak -k "$(PART)" $(PYTEST_ARGS)

goldens: $(READY)
	$(BIN)/python -m pytest -n 0 --update-goldens $(PYTEST_ARGS)

pictures: $(READY)
	$(BIN)/python examples/gallery.py docs
	$(BIN)/python examples/handbook.py docs
	$(BIN)/python examples/registration.py docs
	$(BIN)/python examples/coupon.py docs

# Those of Python and of node lie in a folder of their own, where the tests look for them.
TOOLS := $(or $(FOLDMILL_TOOLS),$(or $(XDG_CACHE_HOME),$(HOME)/.cache)/foldmill-tools)
READERS := tests/third_party/readers
tools:
	apt-get update -qq && apt-get install -y -qq hp2xx librecad xvfb inkscape python3-lxml python3-cssselect postgresql
	command -v npm >/dev/null || apt-get install -y -qq nodejs npm
	mkdir -p $(TOOLS)/node
	cp $(READERS)/package.json $(READERS)/package-lock.json $(READERS)/.npmrc $(TOOLS)/node
	npm ci --silent --prefix $(TOOLS)/node
	$(PYTHON) -m venv $(TOOLS)/python
	$(TOOLS)/python/bin/python -m pip install --quiet -r $(READERS)/requirements.txt

clean:
	rm -rf $(VENV) out
