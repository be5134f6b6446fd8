# SPDX-License-Identifier: MIT
#
# Tests. tests/unit/<room>/test_<file>.c tests src/<room>/<file>.c and may use every room;
# tests/api/test_*.c links libnmtan.a alone; tests/cli/test_*.sh runs the tool as its users do.

unit_src := $(wildcard tests/unit/*/test_*.c tests/unit/*/*/test_*.c)
api_src := $(wildcard tests/api/test_*.c)
unit_bin := $(patsubst tests/%.c,$(B)/tests/%,$(unit_src))
api_bin := $(patsubst tests/%.c,$(B)/tests/%,$(api_src))
support_obj := $(patsubst tests/%.c,$(B)/tests/%.o,$(wildcard tests/support/*.c))

# The oracle of tests/support/oracle128.c.
QUADMATH := $(if $(filter x86_64 i686,$(shell uname -m)),-lquadmath)

# Tests have the modules' libraries linked in.
LINKED_LIBS := -ltinygltf -lOpenMeshCore -ldraco -lmeshoptimizer -lspng -ltiff -lwebp $(TOOL_LIBS)

# tests/support/fail_alloc.c stands in for these
WRAP := -Wl,--wrap=malloc,--wrap=calloc,--wrap=realloc,--wrap=posix_memalign,--wrap=strdup,--wrap=strndup

# Tests spend their time in the library: at -O0 they compile in half of the time. Tests of the core compute what they expect.
$(addsuffix .o,$(filter-out $(B)/tests/unit/topology/% $(B)/tests/unit/tangent/% %/test_hash,$(unit_bin) $(api_bin))): TEST_LEVEL := -O0
$(B)/tests/%.o: tests/%.c
	@mkdir -p $(@D)
	$(CC) $(NT_CFLAGS) $(TEST_LEVEL) -Werror=implicit-function-declaration -Werror=incompatible-pointer-types -Itests/support -DNT_DATA_DIR='"data"' -c -o $@ $<

# One program for all of tests/unit and one for tests/api: 150 links took as long as a tenth of make check. mmap() is
# that of test_needed.c, which guards mapped files, pthread_create() that of test_pool.c, where threads cannot be made.
$(B)/tests/unit/all: $(unit_bin:=.o) $(support_obj) $(module_obj) $(B)/libtool.a $(B)/libnmtan.a
	$(CXX) $(PROGRAM_LDFLAGS) $(WRAP) -Wl,--wrap=mmap,--wrap=pthread_create -o $@ $(filter %.o,$^) \
		-Wl,--start-group $(filter %.a,$^) -Wl,--end-group -lcmocka $(LINKED_LIBS) $(QUADMATH)

$(B)/tests/api/all: $(api_bin:=.o) $(support_obj) $(B)/libnmtan.a
	$(CC) $(PROGRAM_LDFLAGS) $(WRAP) -o $@ $^ -lcmocka -lm $(QUADMATH)

# By its name it knows whose tests to run: tests/support/test.c.
$(unit_bin) &: $(B)/tests/unit/all
	for name in $(unit_bin); do ln -f $< $$name; done

$(api_bin) &: $(B)/tests/api/all
	for name in $(api_bin); do ln -f $< $$name; done

.PRECIOUS: $(B)/tests/%.o

# The library between the tool and the system in tests/support/sets.py; never with a sanitizer's own calls in it.
calls_so := $(B)/tests/preload/calls.so
$(calls_so): tests/preload/calls.c
	@mkdir -p $(@D)
	$(CC) -std=c11 -D_GNU_SOURCE -O1 -fPIC -Wall -Wextra -shared -o $@ $< -ldl

# The sweeps over faults of memory and the system: see tests/faults/sweep.py. Sanitizers have an allocator of their
# own, so they sweep nothing.
faults_bin := $(patsubst %,$(B)/tests/faults/%,faulty.so make_meshopt)
$(B)/tests/faults/faulty.so: tests/faults/faulty.c
	@mkdir -p $(@D)
	$(CC) -std=gnu11 -D_GNU_SOURCE -O1 -g -Wall -Wextra -fno-builtin -fPIC -shared -o $@ $<

$(B)/tests/faults/make_meshopt: $(B)/tests/faults/make_meshopt.o
	$(CXX) $(NT_LDFLAGS) -o $@ $^ -lmeshoptimizer

# Sources of fuzz, stress and bench compile in every check.
rest_looked := $(patsubst %,$(B)/tests/%.looked,bench fuzz stress)
$(rest_looked): $(B)/tests/%.looked: $(wildcard tests/*/*.[ch] src/*/*.h src/*/*/*.h include/*.h)
	@mkdir -p $(@D)
	$(CC) $(filter-out -MMD -MP,$(NT_CFLAGS)) -Werror=implicit-function-declaration -Werror=incompatible-pointer-types -Itests/support \
		-DNT_DATA_DIR='"data"' -fsyntax-only $(filter tests/$*/%.c,$^)
	@touch $@

.PHONY: tests
tests: $(unit_bin) $(api_bin) $(calls_so) $(if $(filter release debug clang,$(config)),$(faults_bin)) \
	$(if $(filter release,$(config)),$(rest_looked))

.PHONY: unit
unit: tests
	@for t in $(unit_bin) $(api_bin); do $$t || exit 1; done

# The Khronos validator and playwright-core, outside the source tree. Nothing is fetched when it is there.
build/node/node_modules/gltf-validator/package.json: tests/support/package.json tests/support/package-lock.json
	@mkdir -p build/node
	@cp tests/support/package.json tests/support/package-lock.json build/node/
	@echo "Installing gltf-validator, gltfpack, meshoptimizer, playwright-core and axe-core (npm) into build/node"
	@npm ci --prefix build/node --no-audit --no-fund --loglevel=error >/dev/null || \
		echo "npm cannot install them: the tests that need it will be skipped"
	@[ ! -f $@ ] || touch $@

# Programs that the npm package is tried in.
build/clients/node_modules/three/package.json: tests/bindings/package.json tests/bindings/package-lock.json
	@mkdir -p build/clients
	@cp tests/bindings/package.json tests/bindings/package-lock.json build/clients/
	@echo "Installing three, glTF-Transform, bundlers and others (npm) into build/clients"
	@npm ci --prefix build/clients --ignore-scripts --no-audit --no-fund --loglevel=error >/dev/null
	@touch $@

# Everything in release and under ASan and UBSan; make's own jobs carry over to the builds, which run at the same time, so
# that no processor waits for the last link of one. npm installs meanwhile, and beside the first tests: it waits
# for the network more than all builds take. Tests run at the same time, so that what they ask make for is made here.
.PHONY: check-built soak-built built-release built-sanitize built-debug built-clients built-node built-rest
check-built:
	@echo "Building config=release and config=sanitize"
	@$(MAKE) -s $(if $(findstring jobserver,$(MAKEFLAGS)),,-j$$(($$(nproc) + 1))) need-check built-release built-sanitize \
		built-debug built-rest built-node built-clients
	@bash tests/run $(if $(filter true,$(CI)),--strict) --installing build/release build/sanitize
built-release:
	@$(MAKE) -s config=release all tests
built-sanitize:
	@$(MAKE) -s config=sanitize all tests
built-debug:
	@$(MAKE) -s config=debug build/debug/libnmtan.so
built-rest: built-release need-check
	@$(MAKE) -s config=release amalgamation python $$(command -v clang >/dev/null && echo wasm) man3 \
		$(addprefix build/web/report.,html css js)
# A file says that npm is at work: tests/run --installing. It goes with the last of its jobs, whatever that came to.
built-node: need-check
	@mkdir -p build && touch build/node.installing
	@{ MAKEFLAGS= $(MAKE) -s build/node/node_modules/gltf-validator/package.json; rm -f build/node.installing; } &
built-clients: need-check
	@mkdir -p build && touch build/clients.installing
	@{ MAKEFLAGS= $(MAKE) -s build/clients/node_modules/three/package.json >/dev/null 2>&1 || \
		echo "npm cannot install three, bundlers and others: the tests that need them will be skipped"; \
		rm -f build/clients.installing; } &

# mikktspace.c as published is in the folder that MIKKTSPACE names: tests/soak/published.sh.
$(B)/tests/soak/published.o: NT_CFLAGS += -I$(MIKKTSPACE)
$(B)/tests/soak/mikktspace.o: $(MIKKTSPACE)/mikktspace.c
	@mkdir -p $(@D)
	$(CC) -O2 -ffp-contract=off -w -c -o $@ $<

$(B)/tests/soak/published: $(patsubst %,$(B)/tests/%.o,soak/published soak/mikktspace support/definition support/nasty support/soup \
		support/surfaces support/golden) $(B)/libnmtan.a
	$(CC) $(NT_LDFLAGS) -o $@ $^ -lcmocka -lm

# Heavy runs: tests/soak/*.sh in turn, each with its own closing line.
soak-built: check-built
	@for script in tests/soak/*.sh; do [ ! -f $$script ] || \
		{ echo "$$script" && bash $$script build/release build/sanitize || exit 1; }; done

# make fuzz SECONDS=60 TARGET="obj gltf": made-up inputs, for so long with each target, all of them by default. Needs
# clang and libclang-rt-14-dev.
$(B)/tests/fuzz/target: $(patsubst %,$(B)/tests/%.o,fuzz/target fuzz/image support/any_settings support/mutate) \
		$(module_obj) $(B)/libtool.a $(B)/libnmtan.a
	$(CXX) $(NT_LDFLAGS) -fsanitize=fuzzer -Wl,--wrap=open,--wrap=rename,--wrap=link -o $@ $(filter %.o,$^) -Wl,--start-group $(filter %.a,$^) -Wl,--end-group $(LINKED_LIBS) -lz

SECONDS ?= 60
TARGET ?= obj mtl ply gltf glb drc image
.PHONY: fuzz
fuzz:
	@CLANG="$(CLANG)" sh tests/fuzz/need.sh
	@$(MAKE) -s $(JOBS) config=release all build/release/tests/faults/make_meshopt build/release/tests/unit/image/test_image
	@$(MAKE) -s $(JOBS) config=fuzz build/fuzz/tests/fuzz/target
	@bash tests/fuzz/run.sh build/release build/fuzz $(SECONDS) $(TARGET)

# make stress: numerical stability at the edges of floating point.
stress_obj := $(patsubst tests/%.c,$(B)/tests/%.o,$(wildcard tests/stress/*.c))

measure_obj := $(patsubst %,$(B)/tests/support/%.o,oracle128 surfaces soup golden measure extremes)
$(B)/tests/stress/stress: $(stress_obj) $(measure_obj) $(B)/libnmtan.a
	$(CC) $(NT_LDFLAGS) -o $@ $^ -lm $(QUADMATH)

.PHONY: stress
stress: $(B)/tests/stress/stress
	@$<

# make bench: run time against error, with the peers that the machine has; tables, and data/charts/pareto.svg.
pareto_obj := $(patsubst %,$(B)/tests/%.o,$(addprefix bench/,pareto image round_trip faults files models native) \
	stress/bounds)

$(B)/tests/bench/pareto: $(pareto_obj) $(measure_obj) $(B)/libtool.a $(B)/libnmtan.a
	$(CXX) $(NT_LDFLAGS) -o $@ $(filter %.o,$^) -Wl,--start-group $(filter %.a,$^) -Wl,--end-group $(TOOL_LIBS) -ldl $(QUADMATH)

$(B)/tests/bench/sweeps: $(B)/tests/bench/sweeps.o $(measure_obj) $(B)/libnmtan.a
	$(CC) $(NT_LDFLAGS) -o $@ $^ -lm $(QUADMATH)

.PHONY: bench bench-error
bench: bench-error
bench-error: $(B)/tests/bench/pareto $(B)/tests/bench/sweeps $(B)/nmtan
	@CC="$(CC)" sh tests/bench/run_pareto.sh $< $(B)/nmtan build/bench data/charts/pareto.svg
	@$(B)/tests/bench/sweeps

# make bench-core: million triangles a second on real meshes ($MODELS names a folder of more, $PEERS one with native
# peers: tests/bench/native.h) and on each family of meshes.
core_bench_obj := $(patsubst %,$(B)/tests/%.o,$(addprefix bench/,core core_real families models native) \
	$(addprefix support/,measure surfaces))

$(B)/tests/bench/core: $(core_bench_obj) $(B)/libtool.a $(B)/libnmtan.a
	$(CXX) $(NT_LDFLAGS) -o $@ $(filter %.o,$^) -Wl,--start-group $(filter %.a,$^) -Wl,--end-group $(TOOL_LIBS) -ldl

.PHONY: bench-core
bench: bench-core
bench-core: $(B)/tests/bench/core $(B)/nmtan
	@$< $$(sh tests/bench/models.sh $(B)/nmtan build/bench/models)

# make bench-js: the npm package beside others, in Node.
.PHONY: bench-js
bench-js: $(B)/nmtan wasm build/clients/node_modules/three/package.json
	@node tests/bench/js.mjs $(B)/nmtan $(CURDIR)/build/npm $(CURDIR)/build/clients build/bench/js \
		$$(sh tests/bench/models.sh $(B)/nmtan build/bench/models)

# make bench-green: which way green points, told of maps whose surface is known, and of $(MAPS).
$(B)/tests/bench/green: $(B)/tests/bench/green.o $(module_obj) $(B)/libtool.a $(B)/libnmtan.a
	$(CXX) $(NT_LDFLAGS) -o $@ $< -Wl,--start-group $(filter %.a,$^) -Wl,--end-group $(LINKED_LIBS)

.PHONY: bench-green
bench: bench-green
bench-green: $(B)/tests/bench/green
	@$< $(MAPS)

# make bench-need: the memory that runs take, beside what --memory guesses; of $(FILES), or of files that are made.
$(B)/tests/bench/need: $(B)/tests/bench/need.o $(B)/libtool.a $(B)/libnmtan.a
	$(CXX) $(NT_LDFLAGS) -o $@ $< -Wl,--start-group $(filter %.a,$^) -Wl,--end-group $(TOOL_LIBS)

.PHONY: bench-need
bench-need: $(B)/tests/bench/need $(B)/nmtan
	@bash tests/bench/need.sh $(B)/nmtan $(FILES)

# make bench-farm: 10 000 files in one process, by GNU parallel, by Slurm; calls of the system per file.
.PHONY: bench-farm
bench-farm: $(B)/nmtan
	@bash tests/bench/farm.sh $(B)/nmtan

# make bench-process PEERS=DIR: whole processes on small files, beside DIR/gltfpack.
$(B)/tests/bench/process: $(B)/tests/bench/process.o
	$(CC) $(NT_LDFLAGS) -o $@ $< -lm

.PHONY: bench-process
bench-process: $(B)/tests/bench/process $(B)/nmtan
	@CXX="$(CXX)" sh tests/bench/process.sh $^

# make bench-obj: reading the 104 MB file that speed is stated for; the lines "parse" and "index" are the reader.
build/bench/torus.obj: tests/support/inputs.py
	@mkdir -p $(@D)
	python3 $< obj_torus 980000 $@


.PHONY: bench-obj
bench-obj: build/bench/torus.obj $(B)/nmtan
	@for threads in 1 2; do for run in 1 2 3 4 5; do \
		$(B)/nmtan --timing --dry-run --threads=$$threads $< build/bench/torus.glb 2>&1 | \
		sed -nE "s/^(parse|index)/threads $$threads, \1 ms/p"; done; done

# make check-aarch64: the fast path on another processor, under qemu. Needs gcc-aarch64-linux-gnu and qemu-user.
aarch64_src := $(core_src) tests/support/nasty.c tests/support/golden.c tests/aarch64/run_fast.c

.PHONY: check-aarch64
check-aarch64:
	@if command -v aarch64-linux-gnu-gcc >/dev/null && command -v qemu-aarch64 >/dev/null; then \
		$(MAKE) -s build/aarch64/run_fast && \
		qemu-aarch64 -L /usr/aarch64-linux-gnu build/aarch64/run_fast data/golden 300; \
	else echo "no aarch64-linux-gnu-gcc or qemu-aarch64 (gcc-aarch64-linux-gnu, qemu-user): skipped"; fi

build/aarch64/run_fast: $(aarch64_src) $(wildcard src/*/*.h src/*/*/*.h)
	@mkdir -p $(@D)
	aarch64-linux-gnu-gcc -std=c11 -D_GNU_SOURCE -O2 -ffp-contract=off -fno-math-errno -fno-trapping-math \
		-pthread -Iinclude -Isrc -Itests/support -Wall -Wextra -o $@ $(aarch64_src) -lm

# make conformance: build/conformance and its .zip, for programs that make or read tangents: tests/conformance/README.md.
.PHONY: conformance
conformance:
	@mkdir -p build
	@python3 -B tests/conformance/kit.py build/conformance
	@echo "build/conformance and build/conformance.zip are made; build/conformance/README.md says how to use them"

# make picture: the pictures of the README rendered anew: data/signs.png, at its top, and data/report.png.
.PHONY: picture
picture: $(B)/nmtan build/node/node_modules/gltf-validator/package.json
	@sh tests/picture/run.sh $< build/picture
	@$< --check -q --report=build/picture/report.html data/head.obj
	@node tests/picture/report.mjs build/picture/report.html build/node data/report.png

# make mutate ROOM=gltf N=40 SEED=1: how many of N random faults in a room's sources the tests notice.
ROOM ?= all
N ?= 40
SEED ?= 1
.PHONY: mutate
mutate: build/node/node_modules/gltf-validator/package.json
	@python3 -B tests/soak/mutate.py $(ROOM) $(N) $(SEED)

# make oracle FOLDERS="data ../shared": this tree beside the one that the house is rebuilt against.
FOLDERS ?= data $(wildcard ../shared)
.PHONY: oracle
oracle: all
	@python3 -B tests/soak/oracle.py $(FOLDERS)
