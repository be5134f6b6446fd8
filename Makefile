# SPDX-License-Identifier: MIT
#
#   make demo     installs what is missing, builds, puts tangents on a mesh from data/ and shows it
#   make check    the same, then every test
#   make          builds build/$(config)/nmtan, libnmtan.a and libnmtan.so
#   make install PREFIX=/usr/local DESTDIR=
#   make soak     the heavy tests; make bench, make format, make lint, make clean
#
# config=release (default) | debug | sanitize | tsan

config ?= release
PREFIX ?= /usr/local
DESTDIR ?=
CC ?= gcc
CXX ?= g++
ifeq ($(origin CC),default)
CC := gcc
endif
ifeq ($(origin CXX),default)
CXX := g++
endif

B := build/$(config)
VERSION := $(shell sed -n 's/^\#define NMTAN_VERSION_STRING "\(.*\)"/\1/p' include/nmtan.h)

flags_release := -O2 -DNDEBUG
flags_debug := -O0 -g
flags_sanitize := -O1 -g -fsanitize=address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer
flags_tsan := -O1 -g -fsanitize=thread
ifeq ($(flags_$(config)),)
$(error config=$(config) is not one of release, debug, sanitize, tsan)
endif

# No contraction anywhere: the bytes of the result depend on it (see README, "Reproducible").
COMMON := $(flags_$(config)) -g1 -ffp-contract=off -fno-math-errno -fopenmp -fPIC -fvisibility=hidden \
	-Iinclude -Isrc -Wall -Wextra -MMD -MP
NT_CFLAGS := -std=c11 -D_GNU_SOURCE $(COMMON) -Wshadow -Wstrict-prototypes -Wmissing-prototypes \
	-Wvla $(CFLAGS)
NT_CXXFLAGS := -std=c++17 -fvisibility-inlines-hidden $(COMMON) $(CXXFLAGS)
NT_LDFLAGS := $(flags_$(config)) -fopenmp $(LDFLAGS)
TOOL_LIBS := -ltinygltf -lOpenMeshCore -ldraco -lmeshoptimizer -lm

# The compute library: no files, no C++.
core_src := src/base/status.c src/base/memory.c src/base/parallel.c src/base/cpu.c src/base/scratch.c \
	$(wildcard src/topology/*.c src/tangent/*.c)
tool_src := $(filter-out $(core_src) src/cli/main.c,$(wildcard src/*/*.c)) $(wildcard src/ext/*.cpp)
objects = $(patsubst src/%,$(B)/%.o,$(1))
core_obj := $(call objects,$(core_src))
tool_obj := $(call objects,$(tool_src))
main_obj := $(B)/cli/main.c.o

.PHONY: all
all: $(B)/nmtan $(B)/libnmtan.a $(B)/libnmtan.so

$(B)/nmtan: $(main_obj) $(tool_obj) $(B)/libnmtan.a
	$(CXX) $(NT_LDFLAGS) -o $@ $^ $(TOOL_LIBS)

$(B)/libnmtan.a: $(core_obj)
	rm -f $@ && $(AR) rcs $@ $^

$(B)/libnmtan.so: $(core_obj)
	$(CC) $(NT_LDFLAGS) -shared -Wl,-soname,libnmtan.so.0 -o $@ $^ -lm

# Everything but main, for unit tests.
$(B)/libtool.a: $(tool_obj)
	rm -f $@ && $(AR) rcs $@ $^

$(B)/%.c.o: src/%.c
	@mkdir -p $(@D)
	$(CC) $(NT_CFLAGS) $(FILE_FLAGS) -c -o $@ $<

$(B)/%.cpp.o: src/%.cpp
	@mkdir -p $(@D)
	$(CXX) $(NT_CXXFLAGS) $(FILE_FLAGS) -c -o $@ $<

# Foreign headers whose warnings are not ours.
$(B)/ext/openmesh.cpp.o: FILE_FLAGS := -Wno-maybe-uninitialized -Wno-class-memaccess

-include $(shell find $(B) -name '*.d' 2>/dev/null)

include tests/tests.mk

.PHONY: clean format
clean:
	rm -rf build

format:
	clang-format -i $(wildcard src/*/*.[ch] src/*/*.cpp include/*.h tests/*/*.[ch] tests/*/*/*.[ch])
