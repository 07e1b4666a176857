# Two commands do everything on a machine with Python 3.11+ (with venv), make and a C++ compiler:
#   make demo   set up, then check two sample meshes
#   make test   set up, then run every check

PYTHON ?= python3
VENV := .venv
ifeq ($(OS),Windows_NT)
BIN := $(VENV)/Scripts
else
BIN := $(VENV)/bin
endif

SOURCES := pyproject.toml CMakeLists.txt $(wildcard */*.py */*/*.py */*/*.json */native/*.cpp */native/*.hpp */native/CMakeLists.txt)

.PHONY: demo test install clean

demo: $(VENV)/installed
	$(BIN)/satcheck sample_meshes/unit_box.obj sample_meshes/unit_box_shifted.stl

test: $(VENV)/installed-test
	$(BIN)/python -m tests

install: $(VENV)/installed

$(VENV)/created:
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --upgrade pip
	touch $@

$(VENV)/installed: $(VENV)/created $(SOURCES)
	$(BIN)/python -m pip install --quiet .
	touch $@

$(VENV)/installed-test: $(VENV)/installed
	$(BIN)/python -m pip install --quiet ".[test]"
	touch $@

clean:
	rm -rf $(VENV) build
