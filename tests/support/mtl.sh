# SPDX-License-Identifier: MIT
#
# What scripts about materials of an OBJ source, behind cli.sh.

# Images made and read without nmtan.
images() { python3 "$ROOT/tests/support/images.py" "$@"; }

# quad.obj with a material; its lines are the arguments.
quad() {
	{
		echo "mtllib m.mtl"
		echo "usemtl m"
		grep -v '^#' "$data/quad.obj" | grep -v '^usemtl\|^mtllib'
	} >quad.obj
	{
		echo "newmtl m"
		printf '%s\n' "$@"
	} >m.mtl
}
