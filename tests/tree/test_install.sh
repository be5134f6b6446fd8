# SPDX-License-Identifier: MIT
# What make install puts where, that a C program finds it there, and that uninstall takes it away.
. "$ROOT/tests/support/cli.sh"

version=$(sed -n 's/^#define NMTAN_VERSION_STRING "\(.*\)"/\1/p' "$ROOT/include/nmtan.h")
install_here() {
	make -s -C "$ROOT" MAKEFLAGS= "$1" config=release DESTDIR="$PWD/root" PREFIX=/opt/nmtan \
		>"$WORK/out.txt" 2>"$WORK/err.txt" || wrong "make $1 failed"
}

scene "install puts every file in its place"
install_here install
p=root/opt/nmtan
exists $p/bin/nmtan $p/lib/libnmtan.a "$p/lib/libnmtan.so.$version" $p/include/nmtan.h \
	$p/lib/pkgconfig/nmtan.pc $p/share/man/man1/nmtan.1 \
	$p/share/bash-completion/completions/nmtan $p/share/zsh/site-functions/_nmtan
is "$(readlink $p/lib/libnmtan.so)" libnmtan.so.0
is "$(readlink $p/lib/libnmtan.so.0)" "libnmtan.so.$version"
grep -q "^prefix=/opt/nmtan$" $p/lib/pkgconfig/nmtan.pc || wrong "nmtan.pc has another prefix"
grep -q "^Version: $version$" $p/lib/pkgconfig/nmtan.pc || wrong "nmtan.pc has another version"
[ -z "$(find root -type f -perm /022)" ] || wrong "files that others may write"
"$p/bin/nmtan" --version | grep -q "$version" || wrong "the installed tool does not run"

scene "a C program finds header and library through pkg-config, shared and static, without C++"
install_here install
cat >program.c <<'C'
#include <nmtan.h>
#include <stdio.h>
int main(void)
{
	puts(nmtan_version());
	return 0;
}
C
export PKG_CONFIG_PATH=$PWD/root/opt/nmtan/lib/pkgconfig
where="--define-variable=prefix=$PWD/root/opt/nmtan"
# shellcheck disable=SC2046
cc -o shared program.c $(pkg-config "$where" --cflags --libs nmtan) || wrong "does not link shared"
is "$(LD_LIBRARY_PATH=root/opt/nmtan/lib ./shared)" "$version"
# shellcheck disable=SC2046
cc -o static program.c $(pkg-config "$where" --cflags nmtan) root/opt/nmtan/lib/libnmtan.a \
	-pthread -lm || wrong "does not link static"
is "$(./static)" "$version"
! ldd shared static | grep -q 'libstdc++' || wrong "C++ came along"

scene "uninstall leaves nothing"
install_here install
install_here uninstall
is "$(find root \( -type f -o -type l \))" ""

done_testing
