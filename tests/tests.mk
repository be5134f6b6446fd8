# SPDX-License-Identifier: MIT
#
# Tests. tests/unit/<room>/test_<file>.c tests src/<room>/<file>.c and may use every room;
# tests/api/test_*.c links libnmtan.a alone; tests/cli/test_*.sh runs the tool as its users do.

unit_src := $(wildcard tests/unit/*/test_*.c)
api_src := $(wildcard tests/api/test_*.c)
unit_bin := $(patsubst tests/%.c,$(B)/tests/%,$(unit_src))
api_bin := $(patsubst tests/%.c,$(B)/tests/%,$(api_src))
support_obj := $(patsubst tests/%.c,$(B)/tests/%.o,$(wildcard tests/support/*.c))

$(B)/tests/%.o: tests/%.c
	@mkdir -p $(@D)
	$(CC) $(NT_CFLAGS) -Itests/support -DNT_DATA_DIR='"data"' -c -o $@ $<

$(unit_bin): $(B)/tests/%: $(B)/tests/%.o $(support_obj) $(B)/libtool.a $(B)/libnmtan.a
	$(CXX) $(NT_LDFLAGS) -o $@ $(filter %.o,$^) -Wl,--start-group $(filter %.a,$^) -Wl,--end-group -lcmocka $(TOOL_LIBS)

$(api_bin): $(B)/tests/%: $(B)/tests/%.o $(support_obj) $(B)/libnmtan.a
	$(CC) $(NT_LDFLAGS) -o $@ $^ -lcmocka -lm

.PRECIOUS: $(B)/tests/%.o

.PHONY: tests
tests: $(unit_bin) $(api_bin)

.PHONY: unit
unit: tests
	@for t in $(unit_bin) $(api_bin); do $$t || exit 1; done
