# SPDX-License-Identifier: Apache-2.0
# The commands people use; the build itself is CMake (CMakePresets.json). `make help` lists them.
SHELL := /bin/bash
JOBS ?= $(shell nproc)

.PHONY: help setup configure build demo test bench fuzz page page-check format format-check tidy clean

help:            ## this list
	@grep -hE '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed -E 's/:[^#]*## */\t/' | expand -t 16

setup:           ## install the Debian packages that are missing (root or sudo)
	@scripts/setup

configure: setup
	@mkdir -p build
	@cmake --preset release >build/configure.log 2>&1 || { cat build/configure.log; exit 1; }

build: configure ## build the program: build/release/apps/burin/burin
	@cmake --build --preset release -j $(JOBS) --target burin

demo: build      ## cut three example parts and say where the pictures are
	@scripts/demo build/release/apps/burin/burin out/demo

test: configure  ## all tests
	@scripts/page deps || [ $$? = 75 ] # the tests of the page say that they were left out
	@cmake --build --preset release -j $(JOBS)
	@ctest --preset release -j $(JOBS)

bench: setup     ## measure beside the peers that Debian ships; writes out/bench.json
	@cmake --preset bench >/dev/null
	@cmake --build --preset bench -j $(JOBS) --target burin_bench
	@scripts/bench build/bench/bench/burin_bench out

fuzz: setup      ## run every fuzzer for SECONDS_EACH (default 60) seconds under the sanitizers
	@cmake --preset fuzz >/dev/null
	@cmake --build --preset fuzz -j $(JOBS) --target fuzzers
	@scripts/fuzz build/fuzz/fuzz $${SECONDS_EACH:-60}

page: setup      ## make the viewer's page from web/ after a change
	@scripts/page build

page-check: setup ## is data/pages/viewer.html what web/ makes?
	@scripts/page check

format:          ## format the sources in place
	@git ls-files '*.h' '*.cpp' | xargs clang-format-14 -i

format-check:    ## fail when a source is not formatted
	@git ls-files '*.h' '*.cpp' | xargs clang-format-14 --dry-run -Werror

tidy: configure  ## clang-tidy over the files changed since BASE (default: the last day's commits)
	@scripts/tidy build/release $(BASE)

clean:           ## remove everything that was built
	@rm -rf build out
