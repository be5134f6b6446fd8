# SPDX-License-Identifier: MIT
#
# make wasm-tool: the tool as WebAssembly, in build/npm-tool (for Node, beside the npm package's library) and
# build/web-tool (for a page). Debian's emscripten, and the foreign libraries from Debian's source packages (sources.sh);
# what those need to know of the system is said here, not asked of CMake.

tool_dir := src/bindings/tool
T := build/wasm-tool
S := $(T)/sources
EMCC := EM_CACHE=$(CURDIR)/$(T)/cache EM_FROZEN_CACHE= NODE_PATH=/usr/share/nodejs emcc

# Exceptions and long jumps are WebAssembly's own. Contraction is off for foreign libraries too.
tool_flags := -O2 -DNDEBUG -DNT_NO_THREADS -msimd128 -fwasm-exceptions -sSUPPORT_LONGJMP=wasm -ffp-contract=off -fno-math-errno
ours := $(tool_flags) -isystem $(tool_dir)/system -D_GNU_SOURCE -fvisibility=hidden -Iinclude -Isrc -isystem $(T)/include -isystem $(S)/draco/unpacked/src \
	-isystem $(S)/meshoptimizer/unpacked/src -isystem $(S)/openmesh/unpacked/src -isystem $(S)/tinygltf/unpacked -isystem $(S)/libspng/unpacked/spng \
	-isystem $(S)/libdeflate/unpacked -isystem $(S)/libjpeg-turbo/unpacked -isystem $(S)/tiff/unpacked/libtiff -isystem $(S)/zlib/unpacked -isystem $(S)/libwebp/unpacked/src \
	-Wall -Wextra -Wno-bitwise-instead-of-logical -MMD -MP

tool_wasm_src := $(filter-out %/kernel_avx2.c %/kernel_avx512.c,$(core_src)) $(tool_src) src/cli/main.c \
	$(wildcard src/ext/modules/*.c src/ext/modules/*.cpp $(tool_dir)/*.c)
tool_wasm_obj := $(patsubst %,$(T)/%.o,$(tool_wasm_src))

$(T)/src/%.c.o: src/%.c $(S)/.complete $(T)/flags $(wildcard $(tool_dir)/system/*)
	@mkdir -p $(@D)
	$(EMCC) -std=c11 $(ours) $(TOOL_LEVEL) -c -o $@ $<
$(T)/src/%.cpp.o: src/%.cpp $(S)/.complete $(T)/flags $(wildcard $(tool_dir)/system/*)
	@mkdir -p $(@D)
	$(EMCC) -std=c++17 $(ours) -c -o $@ $<

# ---- foreign libraries ----

# Headers of libraries that are nothing else come from where they are installed; draco_features.h and tiffconf.h are made
# by building, jconfig.h and zlib's zconf.h as well.
.PHONY: need-emscripten
need-emscripten:
	@sh tests/support/need.sh emscripten
$(S)/.complete: $(tool_dir)/sources.sh $(tool_dir)/configure.sh
	sh $(tool_dir)/sources.sh $(S)
	sh $(tool_dir)/configure.sh $(S) $(T)/include
	touch $@

foreign_of = $(wildcard $(foreach pattern,$(2),$(S)/$(1)/unpacked/$(pattern)))
foreign_draco := $(filter-out %_test.cc %/draco_test_utils.cc %/io/gltf% %/io/scene% %/tiny_gltf%, \
	$(call foreign_of,draco,$(addprefix src/draco/,attributes/*.cc compression/*.cc compression/*/*.cc compression/*/*/*.cc \
		core/*.cc mesh/*.cc metadata/*.cc point_cloud/*.cc point_cloud/algorithms/*.cc)))
foreign_meshopt := $(call foreign_of,meshoptimizer,src/indexcodec.cpp src/vertexcodec.cpp src/vertexfilter.cpp src/allocator.cpp)
foreign_openmesh := $(call foreign_of,openmesh,$(addprefix src/OpenMesh/Core/,Mesh/*.cc Utils/*.cc System/*.cc))
foreign_tinygltf := $(call foreign_of,tinygltf,tiny_gltf.cc)
foreign_spng := $(call foreign_of,libspng,spng/spng.c)
foreign_deflate := $(call foreign_of,libdeflate,lib/*.c lib/arm/*.c lib/x86/*.c)
foreign_zlib := $(filter-out %/gz%,$(call foreign_of,zlib,*.c))
foreign_zstd := $(call foreign_of,libzstd,lib/common/*.c lib/compress/*.c lib/decompress/*.c)
# Leaves out the sources of libjpeg's programs and files that other files include.
foreign_jpeg := $(filter-out %/jccolext.c %/jdcolext.c %/jdcol565.c %/jdmrgext.c %/jdmrg565.c %/jstdhuff.c %/jpegtran.c \
	%/jcstest.c %/jdatadst-tj.c %/jdatasrc-tj.c, $(call foreign_of,libjpeg-turbo,jc*.c jd*.c jerror.c jfdct*.c jidct*.c jmem*.c \
	jquant*.c jutils.c jsimd_none.c jaricom.c))
foreign_tiff := $(filter-out %/tif_win32.c %/tif_jpeg_12.c,$(call foreign_of,tiff,libtiff/tif_*.c))
foreign_webp := $(call foreign_of,libwebp,src/dec/*.c src/dsp/*.c src/utils/*.c)
foreign_obj := $(patsubst $(S)/%,$(T)/foreign/%.o,$(foreach library,draco meshopt openmesh tinygltf spng deflate zlib zstd \
	jpeg tiff webp,$(foreign_$(library))))

# Their warnings are not ours.
foreign_flags := $(tool_flags) -w -isystem $(T)/include/stb -isystem $(T)/include -isystem $(S)/zlib/unpacked -isystem $(S)/libjpeg-turbo/unpacked -isystem $(S)/libzstd/unpacked/lib \
	-isystem $(S)/draco/unpacked/src -isystem $(S)/openmesh/unpacked/src -isystem $(S)/libdeflate/unpacked -isystem $(S)/tinygltf/unpacked \
	-isystem $(S)/tiff/unpacked/libtiff -isystem $(S)/libwebp/unpacked -DZSTD_DISABLE_ASM
# Other flags make other objects.
$(T)/flags: FORCE
	@mkdir -p $(@D)
	@echo '$(ours) $(foreign_flags)' | cmp -s - $@ || echo '$(ours) $(foreign_flags)' >$@
$(T)/foreign/%.c.o: $(S)/%.c $(T)/flags
	@mkdir -p $(@D)
	$(EMCC) $(foreign_flags) -c -o $@ $<
$(T)/foreign/%.cc.o: $(S)/%.cc $(T)/flags
	@mkdir -p $(@D)
	$(EMCC) -std=c++17 $(foreign_flags) -c -o $@ $<
$(T)/foreign/%.cpp.o: $(S)/%.cpp $(T)/flags
	@mkdir -p $(@D)
	$(EMCC) -std=c++17 $(foreign_flags) -c -o $@ $<

$(T)/libforeign.a: $(foreign_obj)
	rm -f $@ && EM_CACHE=$(CURDIR)/$(T)/cache EM_FROZEN_CACHE= emar qcs $@ $^

# ---- the two links ----

# Memory that was grown is not given back before the run ends. The tool ends by exit(), which runs what is registered.
tool_link := $(tool_flags) -sALLOW_MEMORY_GROWTH -sMAXIMUM_MEMORY=4GB -sINITIAL_MEMORY=64MB -sTOTAL_STACK=8MB -sEXIT_RUNTIME \
	-sMODULARIZE -sEXPORT_NAME=createNmtan -sINVOKE_RUN=0 -sEXPORTED_RUNTIME_METHODS=callMain,FS,ENV '-sDEFAULT_LIBRARY_FUNCS_TO_INCLUDE=$$ERRNO_CODES' \
	-sDYNAMIC_EXECUTION=0

$(T)/node/nmtan-tool.js: $(tool_wasm_obj) $(T)/libforeign.a $(tool_dir)/tool.mk
	@mkdir -p $(@D)
	$(EMCC) $(tool_link) -sENVIRONMENT=node -sNODERAWFS -o $@ $(filter %.o %.a,$^)
$(T)/web/nmtan-tool.js: $(tool_wasm_obj) $(T)/libforeign.a $(tool_dir)/tool.mk
	@mkdir -p $(@D)
	$(EMCC) $(tool_link) -sENVIRONMENT=web,worker,node -o $@ $(filter %.o %.a,$^)

# The package: the library's files, and beside them the tool, which nothing of the library loads.
tool_package := build/npm-tool
$(tool_package)/nmtan-tool.cjs: $(T)/node/nmtan-tool.js
	cp $< $@ && cp $(T)/node/nmtan-tool.wasm $(@D)/
$(tool_package)/nmtan.js: $(tool_dir)/nmtan.js $(tool_dir)/windows.js
	cp $^ $(@D)/ && chmod 755 $@
$(tool_package)/package.json: $(wasm_dir)/package.json $(tool_dir)/package.mjs build/npm/package.json
	@mkdir -p $(@D)
	cp $(npm_copies) $(addprefix build/npm/,LICENSE wasm.js nmtan.wasm) $(@D)/
	node $(tool_dir)/package.mjs build/npm/package.json >$@.part && mv $@.part $@

# For pages: the same objects over files in memory.
build/web-tool/run.js: $(tool_dir)/run.js $(T)/web/nmtan-tool.js
	@mkdir -p $(@D)
	cp $(T)/web/nmtan-tool.js $(T)/web/nmtan-tool.wasm $< $(@D)/

# The lists of foreign sources are made of what is there, so that they are there first.
.PHONY: wasm-tool
wasm-tool: need-emscripten wasm $(S)/.complete
	@$(MAKE) --no-print-directory $(addprefix $(tool_package)/,package.json nmtan-tool.cjs nmtan.js) build/web-tool/run.js

-include $(shell find $(T)/src -name '*.d' 2>/dev/null)
