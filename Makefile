# Two commands do everything on a machine with Python 3.11+ (with venv), make and a C++ compiler:
#   make demo   set up, then check two sample meshes
#   make test   set up, then run every check of the project
# `make golden` rewrites the expected reports of the samples.

PYTHON ?= python3
VENV := .venv
ifeq ($(OS),Windows_NT)
BIN := $(VENV)/Scripts
ACTIVATE := $(VENV)\Scripts\activate
else
BIN := $(VENV)/bin
ACTIVATE := . $(VENV)/bin/activate
endif

ROOMS := api plugins cli audit verify report scene decompose core
LEVELS := $(foreach room,$(ROOMS),$(room)/* $(room)/*/* $(room)/*/*/* $(room)/*/*/*/*)
SOURCES := pyproject.toml CMakeLists.txt \
	$(wildcard $(foreach kind,.py .json .html .css .js .cpp .hpp /CMakeLists.txt,$(addsuffix $(kind),$(LEVELS))))
CXX_TESTS := $(wildcard core/native/tests/*/*.cpp core/native/tests/*/*.hpp tests/one_definition/*)

.PHONY: demo test golden install clean

# The boxes do overlap, which is exit code 1; make would call that an error.
demo: $(VENV)/installed
	$(BIN)/satcheck --exit-zero sample_meshes/box.obj sample_meshes/box_pushed.stl
	@echo
	@echo "Now your own meshes: $(BIN)/satcheck A B"
	@echo "or, to leave out the folder: $(ACTIVATE)"

test: $(VENV)/installed-test
	$(BIN)/python -m tests

golden: $(VENV)/installed-test
	$(BIN)/python -m tests.golden

install: $(VENV)/installed

$(VENV)/created:
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --upgrade pip
	@touch $@

$(VENV)/installed: $(VENV)/created $(SOURCES)
	@echo "Fetching what satcheck needs and compiling its core: a minute or three, once."
	$(BIN)/python -m pip install --quiet .
	@touch $@

# One build for the package and the C++ tests: both need the same library. Python compiles what is imported
# when it is; all of 9000 modules would take half a minute.
$(VENV)/installed-test: $(VENV)/created $(SOURCES) $(CXX_TESTS)
	@echo "Fetching what the tests need and compiling the core: a minute or three, once."
	$(BIN)/python -m pip install --quiet --no-compile --config-settings=cmake.define.SATCHECK_CXX_TESTS=ON ".[test]"
	@touch $(VENV)/installed $@

clean:
	rm -rf $(VENV) build
