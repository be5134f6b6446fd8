# SPDX-License-Identifier: MIT
# What make demo and make check install, watched through stand-ins for Debian's programs.
. "$ROOT/tests/support/cli.sh"
need=$ROOT/tests/support/need.sh

# stand_in NAME BODY: a program of that name in ./bin; what apt-get is told goes to ./log.
stand_in() {
	mkdir -p bin
	printf '#!/bin/sh\n%s\n' "$2" >"bin/$1"
	chmod +x "bin/$1"
}
# A machine on which the packages of the second argument are missing and nothing else is at hand.
machine() {
	local tool
	stand_in id "echo $1"
	stand_in dpkg-query "case ' $2 ' in *\" \$3 \"*) exit 1 ;; esac; printf 'install ok installed'"
	stand_in apt-get 'echo "apt-get $*" >>log'
	stand_in sudo 'echo "sudo $*" >>log; exec "$@"'
	for tool in sh sort tr mktemp rm cat env printf mkdir chmod; do
		ln -sf "$(command -v $tool)" "bin/$tool"
	done
	for tool in gcc g++ make node npm python3 cmake; do
		stand_in $tool 'exit 0'
	done
}
needs() {
	PATH=$PWD/bin sh "$need" "$1" >"$WORK/out.txt" 2>"$WORK/err.txt"
	status=$?
}

scene "nothing is touched when everything is there"
machine 0 ""
needs check
exits 0
silent
[ ! -e log ] || wrong "apt-get was called"

scene "what is missing is installed and said, and nothing else"
machine 0 "libdraco-dev"
needs build
exits 0
prints "libdraco-dev"
grep -q '^apt-get install .*libdraco-dev$\|^apt-get install .* libdraco-dev *$' log || wrong "$(cat log)"
! grep -q openmesh log || wrong "too much was installed"
! grep -q sudo log || wrong "root needs no sudo"

scene "a user who is not root gets it by sudo"
machine 1000 "libdraco-dev"
needs build
exits 0
grep -q '^sudo .*apt-get install' log || wrong "no sudo"

scene "neither root nor sudo: the missing packages are named"
machine 1000 "libdraco-dev libopenmesh-dev"
rm bin/sudo
needs build
exits 1
says "libdraco-dev"
says "libopenmesh-dev"

scene "programs of tests are asked for by the tests alone, and from wherever they come"
machine 0 "libcmocka-dev nodejs npm"
rm bin/node
needs build
exits 0
[ ! -e log ] || wrong "the build asked for $(cat log)"
needs tests
exits 0
is "$(sed 's/.*recommends //; s/ *$//' log)" libcmocka-dev
needs check
exits 0
grep -q 'nodejs' log || wrong "nodejs is missing"
grep -q 'libcmocka-dev' log || wrong "cmocka is missing"
! grep -q 'npm' log || wrong "npm is there already"

scene "a list of packages that is too old is fetched anew"
machine 0 "libdraco-dev"
stand_in apt-get 'echo "apt-get $*" >>log; [ "$1" != update ] || : >fresh; [ -e fresh ]'
needs build
exits 0
is "$(cut -d' ' -f2 log | tr '\n' ' ')" "install update install "

done_testing
