# SPDX-License-Identifier: MIT
#
#   make demo     installs what is missing, builds, puts tangents on a mesh from data/ and shows it
#   make check    the same, then every test
#   make          builds build/$(config)/nmtan, libnmtan.a and libnmtan.so; V=1 shows the commands
#   make install PREFIX=/usr/local LIBDIR=PREFIX/lib DESTDIR=
#   make install-lib  the library alone, which needs a C compiler and nothing else
#   make deb      Debian packages in build/deb
#   make soak     the heavy tests; make fuzz, make check-aarch64, make bench, make format, make lint, make clean
#
# config=release (default) | debug | sanitize | tsan | clang | clang-sanitize | fuzz

# Quiet, as make demo is. Someone who builds sees one line, and what the compiler says.
ifneq ($(V),1)
MAKEFLAGS += --silent
endif

config ?= release
PREFIX ?= /usr/local
LIBDIR ?= $(PREFIX)/lib
DESTDIR ?=
CC ?= gcc
CXX ?= g++
ifeq ($(origin CC),default)
CC := gcc
endif
ifeq ($(origin CXX),default)
CXX := g++
endif
CLANG ?= clang
CLANGXX ?= clang++
ifneq ($(filter clang clang-sanitize fuzz,$(config)),)
override CC := $(CLANG)
override CXX := $(CLANGXX)
endif

B := build/$(config)
VERSION := $(shell sed -n 's/^\#define NMTAN_VERSION_STRING "\(.*\)"/\1/p' include/nmtan.h)

flags_release := -O2 -g1 -DNDEBUG
flags_debug := -O0 -g
flags_sanitize := -O1 -g1 -fsanitize=address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer
flags_tsan := -O1 -g1 -fsanitize=thread
# clang 14 does not say that addresses are checked; its "undefined" has checks that gcc's lacks (float-cast-overflow).
flags_clang := $(flags_release)
flags_clang-sanitize := $(flags_sanitize) -D__SANITIZE_ADDRESS__=1
flags_fuzz := $(flags_clang-sanitize) -fsanitize=fuzzer-no-link
ifeq ($(flags_$(config)),)
$(error config=$(config) is not one of release, debug, sanitize, tsan, clang, clang-sanitize, fuzz)
endif

# No contraction anywhere: the bytes of the result depend on it (see README, "Reproducible"). No vectorization of
# straight-line code either: gcc 12 forgets the rounding in "float x = (float)d; double y = x;" when it combines two
# such lines into one vector. The tree's place makes no difference to what is built.
COMMON := $(flags_$(config)) -ffp-contract=off -fno-tree-slp-vectorize -fno-math-errno \
	-pthread -fPIC -fvisibility=hidden '-ffile-prefix-map=$(CURDIR)=.' \
	-Iinclude -Isrc -Wall -Wextra -MMD -MP
NT_CFLAGS := -std=c11 -D_GNU_SOURCE $(COMMON) -Wshadow -Wstrict-prototypes -Wmissing-prototypes \
	-Wvla $(CPPFLAGS) $(CFLAGS)
NT_CXXFLAGS := -std=c++17 -fvisibility-inlines-hidden $(COMMON) $(CPPFLAGS) $(CXXFLAGS)
NT_LDFLAGS := $(flags_$(config)) -pthread $(LDFLAGS)
# The sanitizers' tables of globals are 280 000 addresses; a program with a fixed place starts 5 of 27 ms sooner.
PROGRAM_LDFLAGS := $(NT_LDFLAGS) $(if $(filter sanitize,$(config)),-no-pie)
TOOL_LIBS := -Wl,-Bstatic -ljpeg -ldeflate -Wl,-Bdynamic -lm -ldl

# The compute library: no files, no C++.
core_src := src/base/structs.c src/base/deadline.c src/base/pages.c src/base/parallel.c src/base/pool.c \
	src/base/cpu.c src/base/scratch.c src/base/largest.c src/base/hash.c \
	$(foreach room,topology tangent tangent/fast tangent/sums api,$(wildcard src/$(room)/*.c))
tool_src := $(filter-out $(core_src) src/cli/main.c src/bindings/% src/ext/modules/%,$(wildcard src/*/*.c src/*/*/*.c)) \
	$(wildcard src/ext/*.cpp)
objects = $(patsubst src/%,$(B)/%.o,$(1))
core_obj := $(call objects,$(core_src))
tool_obj := $(call objects,$(tool_src))
main_obj := $(B)/cli/main.c.o

# Foreign libraries, each in a module that the tool opens when an input needs it (src/ext/module.c). A module is made of
# the files of its name, and what they use of the tool.
module_libs_draco := -ldraco
module_libs_meshopt := -lmeshoptimizer
module_libs_openmesh := -lOpenMeshCore
module_libs_png := -lspng
module_libs_tiff := -ltiff
module_libs_tinygltf := -ltinygltf
module_libs_webp := -lwebp
modules := draco meshopt openmesh png tiff tinygltf webp
module_so := $(modules:%=$(B)/nmtan-%.so)
module_obj := $(call objects,$(wildcard src/ext/modules/*.c src/ext/modules/*.cpp))
module_files = $(B)/ext/modules/$(1).c%.o $(B)/ext/modules/$(1)_%.o

.PHONY: all
ifeq ($(MAKECMDGOALS),)
$(info Building $(B)/nmtan)
endif
all: $(B)/nmtan $(module_so) $(B)/libnmtan.a $(B)/libnmtan.so $(B)/completion.bash $(B)/completion.zsh $(B)/licences.txt

# The tool has no shared library but the system's. Its part of the C++ library (std::to_chars) is linked in; modules
# bring the whole, and find the tool's operators new and delete. So are libdeflate, which is small, and libjpeg: as a shared
# library it would ask for thread-local memory late, and the loader ends a process that has none left.
link_tool = $(CXX) $(PROGRAM_LDFLAGS) $(if $(findstring fsanitize,$(NT_LDFLAGS)),,-static-libstdc++ -static-libgcc) \
	-Wl,--dynamic-list=src/ext/exported.list -o $@ $(1) $(filter %.o %.a,$^) $(TOOL_LIBS)

$(B)/nmtan: $(main_obj) $(B)/libtool.a $(B)/libnmtan.a src/ext/exported.list
	$(call link_tool)

# As it is installed, it knows where its modules are. The one in the build folder has them beside it.
$(B)/installed/nmtan: src/ext/module.c $(main_obj) $(B)/libtool.a $(B)/libnmtan.a src/ext/exported.list FORCE
	@mkdir -p $(@D)
	$(CC) $(NT_CFLAGS) -DNT_LIBDIR='"$(LIBDIR)"' -c -o $(@D)/module.o $<
	$(call link_tool,$(@D)/module.o)

.PHONY: FORCE
FORCE:

$(module_so): $(B)/nmtan-%.so: $(module_obj) $(B)/libmodule.a
	$(CXX) $(NT_LDFLAGS) -shared -Wl,--exclude-libs,ALL -o $@ $(filter $(call module_files,$*),$^) $(B)/libmodule.a \
		$(module_libs_$*)

# The part of the tool that modules use; all of it without a state, but for the key of hashes, which each makes for
# itself, and deadlines, of which they have none.
$(B)/libmodule.a: $(call objects,src/base/text.c src/base/hash.c src/base/deadline.c src/base/pages.c \
		src/ext/number.cpp src/ext/codec/pixels.c src/ext/modules/cxx.cpp)
	rm -f $@ && $(AR) qcsD $@ $^

$(B)/libnmtan.a: $(core_obj)
	rm -f $@ && $(AR) qcsD $@ $^

$(B)/libnmtan.so: $(core_obj) src/api/libnmtan.map
	$(CC) $(NT_LDFLAGS) -shared -Wl,-soname,libnmtan.so.0,-z,nodelete,--version-script=src/api/libnmtan.map -o $@ \
		$(core_obj) -lm

# Everything but main, for unit tests. Members of several rooms share a name, so none replaces another (q).
$(B)/libtool.a: $(tool_obj)
	rm -f $@ && $(AR) qcsD $@ $^

$(B)/%.c.o: src/%.c
	@mkdir -p $(@D)
	$(CC) $(NT_CFLAGS) $(FILE_FLAGS) -c -o $@ $<

$(B)/%.cpp.o: src/%.cpp
	@mkdir -p $(@D)
	$(CXX) $(NT_CXXFLAGS) $(FILE_FLAGS) -c -o $@ $<

# Objects of the sources under src that a rule for single files names. A name that matches nothing stops make: the
# rule would be without effect, and silently so.
existing = $(or $(wildcard $(1)),$(error Makefile has a rule for $(1), which is not there))
objects_of = $(call objects,$(foreach source,$(1),$(call existing,src/$(source))))

# The library's structs are cleared by plain stores: gcc's "rep stos" on x86 takes 30 cycles each, 12 % of a call of two
# triangles. Other compilers do not know the option.
stores := -mmemset-strategy=unrolled_loop:512:noalign,libcall:-1:noalign
ifeq ($(shell $(CC) $(stores) -fsyntax-only -x c /dev/null 2>/dev/null && echo can),can)
$(call objects,$(core_src)): NT_CFLAGS += $(stores)
endif

# The passes that need lanes, once for each instruction set. Exceptions are never looked at, so that
# comparisons may be made for all lanes; contraction stays off: FMA is used where fma() stands in the source.
lanes := -O3 -fno-trapping-math
# A sanitizer's checks leave nothing to vectorize: its kernels run as fast at -O1, which takes less time to compile.
ifeq ($(config),sanitize)
lanes := -fno-trapping-math
else ifeq ($(config),debug)
lanes :=
endif
$(call objects_of,tangent/fast/kernel_baseline.c tangent/sums/kernel_baseline.c): FILE_FLAGS := $(lanes)
ifneq ($(filter x86_64%,$(shell $(CC) -dumpmachine)),)
$(call objects_of,tangent/fast/kernel_avx2.c tangent/sums/kernel_avx2.c): FILE_FLAGS := $(lanes) -mavx2 -mfma
$(call objects_of,tangent/fast/kernel_avx512.c tangent/sums/kernel_avx512.c): FILE_FLAGS := $(lanes) \
	-mavx512f -mavx512bw -mavx512dq -mavx512vl -mfma -mprefer-vector-width=512
endif
# A quarter of the speed of the fast path comes from straight-line code in vectors. Its kernels make no double of a
# float that was a double, and their tests compare all bytes with those of the scalar definition.
$(foreach set,baseline avx2 avx512,$(call objects_of,tangent/fast/kernel_$(set).c)): FILE_FLAGS += -ftree-slp-vectorize
$(call objects_of,topology/adjacency.c topology/edge_few.c topology/edge_sort.c topology/edge_tail.c \
	topology/representatives.c topology/weld.c topology/weld_bloom.c topology/weld_table.c topology/weld_threads.c): FILE_FLAGS := $(lanes)
$(call objects_of,base/largest.c tangent/normals.c): FILE_FLAGS := $(lanes)

# An exception passes operator new, but what it and number.cpp do throws nothing, so they need no C++ library.
$(call objects_of,ext/reserve.cpp ext/number.cpp): FILE_FLAGS := -fno-exceptions

# Thread-local memory of modules is there from the start of each thread: none can be missing later.
$(module_obj): FILE_FLAGS := -ftls-model=initial-exec

# The page of HTML reports is assembled into the binary: see page_assets.c.
$(call objects_of,report/render/page_assets.c): $(call existing,src/report/render/page/*)

# Foreign headers whose warnings are not ours; clang knows one of the three.
$(call objects_of,ext/modules/openmesh.cpp): FILE_FLAGS += $(if $(findstring clang,$(CXX)),,-Wno-maybe-uninitialized -Wno-class-memaccess)
$(call objects_of,ext/codec/stb.c): FILE_FLAGS := -Wno-unused-function
# stb_image looks for colours behind the palette that it has read. clang 14 wants to be told twice.
$(call objects_of,ext/codec/stb.c): FILE_FLAGS += -ftrivial-auto-var-init=zero \
	$(if $(findstring clang,$(CC)),-enable-trivial-auto-var-init-zero-knowing-it-will-be-removed-from-clang)

-include $(shell find $(B) -name '*.d' 2>/dev/null)

include tests/tests.mk
include src/bindings/bindings.mk
include src/bindings/tool/tool.mk

$(B)/licences.txt: src/ext/licences.sh
	@mkdir -p $(@D)
	sh $< > $@

# Completions come from the tool's own table of options.
$(B)/completion.%: $(B)/nmtan
	$< --completion=$* > $@.new && mv $@.new $@

# As many jobs as processors, unless the caller has said how many.
JOBS = $(if $(findstring jobserver,$(MAKEFLAGS)),,-j$(shell nproc))

# The two commands on a fresh machine. The first step installs what is missing and is silent otherwise.
.PHONY: demo check soak need-build need-tests need-check
need-build need-tests need-check: need-%:
	@sh tests/support/need.sh $*

DEMO := data/mirrored_cube.obj
demo: need-build
	@echo "Building build/release/nmtan"
	@$(MAKE) --no-print-directory -s $(JOBS) config=release all
	@mkdir -p build/demo
	@echo "nmtan $(DEMO) build/demo/mirrored_cube.glb"
	@build/release/nmtan $(DEMO) build/demo/mirrored_cube.glb
	@echo "nmtan --check --max-issues=1 build/demo/mirrored_cube.glb"
	@build/release/nmtan --check --max-issues=1 build/demo/mirrored_cube.glb

check: need-tests
	@$(MAKE) --no-print-directory -s check-built

soak: need-tests
	@$(MAKE) --no-print-directory -s soak-built

# Paths as they are installed. Files that name them are made on the way, since the names may differ from the build's.
# CMake's file finds the header from where it lies itself, so that the whole may be moved.
bin := $(DESTDIR)$(PREFIX)/bin
lib := $(DESTDIR)$(LIBDIR)
share := $(DESTDIR)$(PREFIX)/share
so := libnmtan.so
farm_programs := data/farm/nmtan-farm $(wildcard data/farm/*.sh)
cmake_files := nmtan-config.cmake nmtan-config-version.cmake
names := sed -e 's|@PREFIX@|$(PREFIX)|; s|@LIBDIR@|$(patsubst $(PREFIX)/%,$${prefix}/%,$(LIBDIR))|; s|@VERSION@|$(VERSION)|' \
	-e 's|@TO_PREFIX@|$(shell realpath -ms --relative-to=$(LIBDIR)/cmake/nmtan $(PREFIX))|'
# The header's pages, one for each function; without Python there are none.
open := (
man3 := $(shell command -v python3 >/dev/null && { echo build/man3/nmtan.3 && \
	sed -n 's,^NMTAN_[AI][A-Z]* [^$(open)]*\(nmtan_[a-z_]*\)$(open).*,build/man3/\1.3,p' include/nmtan.h; })
build/man3/nmtan.3: src/api/man3.py include/nmtan.h
	python3 -B $^ $(@D)
$(filter-out build/man3/nmtan.3,$(man3)): build/man3/nmtan.3 ;
.PHONY: man3
man3: $(man3)
lib_pages := man/nmtan-engines.7 $(man3)
tool_pages := $(filter-out $(lib_pages),$(wildcard man/*.[157]))
page = $(share)/man/man$(patsubst .%,%,$(suffix $(1)))/$(notdir $(1))
pages = for page in $(1); do install -D -m 644 $$page $(share)/man/man$${page\#\#*.}/$${page\#\#*/} || exit 1; done

.PHONY: install install-lib uninstall uninstall-lib
install-lib: $(B)/libnmtan.a $(B)/libnmtan.so $(man3)
	install -d $(lib)/pkgconfig $(lib)/cmake/nmtan $(DESTDIR)$(PREFIX)/include
	install -m 644 $(B)/libnmtan.a $(lib)/libnmtan.a
	install -m 755 $(B)/$(so) $(lib)/$(so).$(VERSION)
	ln -sf $(so).$(VERSION) $(lib)/$(so).0
	ln -sf $(so).0 $(lib)/$(so)
	install -m 644 include/nmtan.h $(DESTDIR)$(PREFIX)/include/nmtan.h
	$(names) src/api/nmtan.pc > $(lib)/pkgconfig/nmtan.pc
	for file in $(cmake_files); do $(names) src/api/$$file > $(lib)/cmake/nmtan/$$file; done
	chmod 644 $(lib)/pkgconfig/nmtan.pc $(patsubst %,$(lib)/cmake/nmtan/%,$(cmake_files))
	$(call pages,$(lib_pages))

install: all $(B)/installed/nmtan install-lib
	install -d $(bin) $(lib)/nmtan $(share)/bash-completion/completions $(share)/zsh/site-functions $(share)/nmtan/farm \
		$(share)/doc/nmtan
	install -m 755 $(B)/installed/nmtan $(bin)/nmtan
	install -m 644 $(module_so) $(lib)/nmtan/
	$(call pages,$(tool_pages))
	install -m 644 data/*.schema.json $(share)/nmtan/
	install -m 644 $(filter-out $(farm_programs),$(wildcard data/farm/*)) $(share)/nmtan/farm/
	install -m 755 $(farm_programs) $(share)/nmtan/farm/
	ln -sf ../share/nmtan/farm/nmtan-farm $(bin)/nmtan-farm
	install -m 644 LICENSE $(B)/licences.txt $(share)/doc/nmtan/
	install -m 644 $(B)/completion.bash $(share)/bash-completion/completions/nmtan
	install -m 644 $(B)/completion.zsh $(share)/zsh/site-functions/_nmtan

uninstall-lib:
	rm -f $(lib)/libnmtan.a $(lib)/$(so) $(lib)/$(so).0 $(lib)/$(so).$(VERSION) $(DESTDIR)$(PREFIX)/include/nmtan.h \
		$(lib)/pkgconfig/nmtan.pc $(patsubst %,$(lib)/cmake/nmtan/%,$(cmake_files)) \
		$(foreach file,$(lib_pages),$(call page,$(file)))
	[ ! -d $(lib)/cmake/nmtan ] || rmdir --ignore-fail-on-non-empty $(lib)/cmake/nmtan

uninstall: uninstall-lib
	rm -f $(bin)/nmtan $(bin)/nmtan-farm $(modules:%=$(lib)/nmtan/nmtan-%.so) \
		$(foreach file,$(tool_pages),$(call page,$(file))) \
		$(patsubst data/%,$(share)/nmtan/%,$(wildcard data/*.schema.json data/farm/*)) \
		$(share)/doc/nmtan/LICENSE $(share)/doc/nmtan/licences.txt \
		$(share)/bash-completion/completions/nmtan $(share)/zsh/site-functions/_nmtan
	for folder in $(lib)/nmtan $(share)/nmtan/farm $(share)/nmtan $(share)/doc/nmtan; do \
		[ ! -d $$folder ] || rmdir --ignore-fail-on-non-empty $$folder; done

# Debian packages, in build/deb: built from a copy of the tree, with data/debian as its debian folder. The time of the
# changelog stands for all others, so that the same tree gives the same packages.
DEB ?= build/deb
.PHONY: deb
deb:
	@sh data/debian/build.sh $(DEB)

.PHONY: lint
lint: $(B)/libnmtan.a $(B)/libnmtan.so
	@bash tests/lint/rooms.sh $(B)

.PHONY: clean format
clean:
	rm -rf build

format:
	clang-format -i $(shell find src include tests -name '*.[ch]' -o -name '*.[ch]pp')
