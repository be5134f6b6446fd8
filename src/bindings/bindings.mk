# SPDX-License-Identifier: MIT
#
# make wasm: the npm package in build/npm (clang, lld and wasi-libc; wasm-opt where it is there). make python: a
# wheel and a source distribution in build/python. make amalgamation: the library as one C file in build/amalgamation.

# The tool alone sets deadlines, makes normals and judges tangents. Kernels come before what chooses between them.
amalgamation_src := $(filter-out src/base/deadline.c,$(filter src/base/% src/topology/%,$(core_src))) \
	src/tangent/fast/kernel_baseline.c \
	$(filter-out src/base/% src/topology/% src/tangent/normals.c src/tangent/%/kernel_baseline.c \
		src/tangent/%/kernel_avx2.c src/tangent/%/kernel_avx512.c,$(core_src))

.PHONY: amalgamation
amalgamation: build/amalgamation/nmtan.c $(addprefix build/amalgamation/,nmtan.h CMakeLists.txt)

build/amalgamation/nmtan.c: src/api/amalgamate.py src/api/amalgamation.in $(amalgamation_src) LICENSE \
		$(wildcard src/base/*.h src/t*/*.h src/t*/*/*.h src/api/*.h)
	@mkdir -p $(@D)
	python3 -B $< $@ $(amalgamation_src)

build/amalgamation/nmtan.h: include/nmtan.h
	@mkdir -p $(@D)
	cp $< $@

build/amalgamation/CMakeLists.txt: src/api/amalgamation.cmake
	@mkdir -p $(@D)
	cp $< $@

wasm_dir := src/bindings/wasm
wasm_src := $(filter-out %/kernel_avx2.c %/kernel_avx512.c,$(core_src)) $(wildcard $(wasm_dir)/*.c)
wasm_obj := $(patsubst %.c,build/wasm/%.o,$(wasm_src))

# Four lanes of 32 bits; small, but where the time of the default is spent: at -O2 it is 1.1 to 1.5 times as fast, and a
# third larger. -flto: 1 % smaller, and no slower.
WASM_CC ?= clang
WASM_FLAGS := --target=wasm32-wasi --sysroot=/usr -std=c11 -D_GNU_SOURCE -DNDEBUG -DNT_NO_THREADS -flto -msimd128 -mbulk-memory \
	-ffp-contract=off -fno-math-errno -fno-trapping-math -fvisibility=hidden -ffunction-sections \
	-Iinclude -Isrc -Wall -Wextra -Wno-bitwise-instead-of-logical -MMD -MP

build/wasm/%.o: WASM_LEVEL := -Oz
wasm_fast := src/base/% src/topology/% src/api/% src/tangent/fast/% src/tangent/usable.c src/tangent/repair.c src/tangent/frames.c
$(patsubst %.c,build/wasm/%.o,$(filter $(wasm_fast),$(wasm_src))): WASM_LEVEL := -O2
# Few meshes need these, and the last ones run once a call: 4 KB less, compressed.
$(addprefix build/wasm/src/,tangent/fast/fast.o topology/edge_tail.o topology/edge_sort.o api/self_test.o api/split.o api/tangents.o): WASM_LEVEL := -Oz
build/wasm/%.o: %.c | need-wasm
	@mkdir -p $(@D)
	$(WASM_CC) $(WASM_FLAGS) $(WASM_LEVEL) -c -o $@ $<

# Data that has no address below 1024, where the data begins, takes shorter instructions: 770 bytes less.
build/npm/nmtan.wasm: $(wasm_obj)
	@mkdir -p $(@D)
	$(WASM_CC) --target=wasm32-wasi --sysroot=/usr -nostartfiles \
		-Wl,--no-entry,--gc-sections,--strip-all,--global-base=1024,-z,stack-size=262144 -o $@.part $^
	@! command -v wasm-opt >/dev/null || \
		wasm-opt -O3 --low-memory-unused --enable-simd --enable-bulk-memory $@.part -o $@.part
	mv $@.part $@

build/npm/wasm.js: build/npm/nmtan.wasm
	{ printf '%s\n' '// SPDX-License-Identifier: MIT' && printf "export const wasm = '" && base64 -w 0 $< && \
		printf "';\n"; } >$@.part && mv $@.part $@

build/npm/package.json: $(wasm_dir)/package.json include/nmtan.h
	@mkdir -p $(@D)
	sed 's/"version": "0.0.0"/"version": "$(VERSION)"/' $< >$@.part && mv $@.part $@

npm_copies := $(addprefix build/npm/,index.js external.js external.node.js core.js index.d.ts README.md)
$(npm_copies): build/npm/%: $(wasm_dir)/%
	@mkdir -p $(@D)
	cp $< $@
build/npm/LICENSE: LICENSE
	@mkdir -p $(@D)
	cp $< $@

.PHONY: wasm need-wasm
need-wasm:
	@sh tests/support/need.sh wasm
wasm: $(npm_copies) $(addprefix build/npm/,LICENSE package.json wasm.js nmtan.wasm)

-include $(wasm_obj:.o=.d)

# The wheel's library needs no debugging information; the source distribution has the library as one C file.
python_src := $(wildcard src/bindings/python/nmtan/*) src/bindings/python/wheel.py
.PHONY: python
python: build/python/nmtan.whl build/python/nmtan.tar.gz

build/python/nmtan.whl: $(python_src) $(B)/libnmtan.so include/nmtan.h LICENSE
	@rm -rf $(@D) && mkdir -p $(@D)
	strip -o $(@D)/libnmtan.so.0 $(B)/libnmtan.so
	ln -s "$$(basename "$$(python3 -B src/bindings/python/wheel.py $(@D)/libnmtan.so.0 $(@D))")" $@

build/python/nmtan.tar.gz: build/python/nmtan.whl build/amalgamation/nmtan.c
	ln -sf "$$(basename "$$(python3 -B src/bindings/python/wheel.py --sdist build/amalgamation/nmtan.c $(@D))")" $@

include src/bindings/web/web.mk
