#!/bin/sh
# SPDX-License-Identifier: MIT
#
# Says what make fuzz needs and is not there; installs nothing, because nothing else needs it.
clang=${CLANG:-clang}
${clang##* } --version >/dev/null 2>&1 ||
	{ echo "make fuzz needs clang: apt-get install clang libclang-rt-14-dev" >&2; exit 1; }
[ -f "$(${clang##* } -print-file-name=libclang_rt.fuzzer-x86_64.a)" ] ||
	[ -f "$(${clang##* } -print-runtime-dir)/libclang_rt.fuzzer-$(uname -m).a" ] ||
	{ echo "make fuzz needs clang's libFuzzer and sanitizers: apt-get install libclang-rt-14-dev" >&2; exit 1; }
