# SPDX-License-Identifier: MIT
# Coordinates that float cannot hold: --origin. One mesh lies near 0, and once more far away, where its edges of 2 cm are
# a fraction of the step between floats. Python's decimals add the distance, so that both files are exact.
. "$ROOT/tests/support/cli.sh"

cat >"$WORK/far.py" <<'END'
import json, math, os, struct, sys
from decimal import Decimal as D

FAR = (D(431234), D(5412345), D(101))
NONE = (D(0), D(0), D(0))

# A bumpy sheet of 20 x 20 quads, of which one in ten is two triangles, and five corners in a row are a pentagon.
def sheet():
    n, positions, uvs, faces = 21, [], [], []
    for j in range(n):
        for i in range(n):
            z = D(str(round(0.01 * math.sin(i * 0.7) * math.cos(j * 0.5), 5)))
            positions.append((D('0.12') + D('0.02') * i, D('0.67') + D('0.02') * j + D('0.001') * (i % 3), z))
            uvs.append((D('0.05') * i, D('0.05') * j))
    for j in range(n - 1):
        i = 0
        while i < n - 1:
            a, b = j * n + i, (j + 1) * n + i
            if (i, j) == (4, 7): # two quads less a corner, and the corner
                faces += [(a, a + 1, a + 2, b + 2, b + 1), (a, b + 1, b)]
                i += 1
            elif (i + j) % 10 == 0:
                faces += [(a, a + 1, b + 1), (a, b + 1, b)]
            else:
                faces.append((a, a + 1, b + 1, b))
            i += 1
    return positions, uvs, faces

def moved(at):
    positions, uvs, faces = sheet()
    return [tuple(x + o for x, o in zip(p, at)) for p in positions], uvs, faces

def rounded(x):
    return D(struct.unpack('f', struct.pack('f', float(x)))[0])

def write_obj(path, at, to_float=False, spelled=False):
    positions, uvs, faces = moved(at)
    if to_float:
        positions = [tuple(map(rounded, p)) for p in positions]
    lines = ['v %s %s %s' % p for p in positions]
    if spelled: # the same numbers in every way that a line allows
        for k in range(0, len(lines), 4):
            x, y, z = positions[k]
            lines[k] = ['v %s \\\r\n %s %s' % (x, y, z), 'v\t%sE-1 +%s %s 1 0.5 0.25' % (x * 10, y, z),
                        '# c:\\\nv %s %s %s # v 1 2 3 \\' % (x, y, z), '  v %s %s %s 1.0' % (x, y, z)][k // 4 % 4]
    lines += ['vt %s %s' % t for t in uvs]
    for f, face in enumerate(faces):
        lines += ['o part%d' % (f > 0)] if f in (0, len(faces) // 2) else []
        lines.append('f ' + ' '.join('%d/%d' % (v + 1, v + 1) for v in face))
    open(path, 'w', newline='').write('\n'.join(lines) + '\n')

def write_ply(path, at, encoding, type='double'):
    positions, uvs, faces = moved(at)
    with open(path, 'wb') as out:
        out.write(('ply\nformat %s 1.0\nelement vertex %d\nproperty uchar k\nproperty %s x\nproperty %s y\nproperty %s z\n'
                   'property float s\nproperty float t\nelement face %d\nproperty list uchar int vertex_indices\n'
                   'end_header\n' % (encoding, len(positions), type, type, type, len(faces))).encode())
        order = '>' if 'big' in encoding else '<'
        for p, t in zip(positions, uvs):
            out.write(('7 %s %s %s %s %s\n' % (p + t)).encode() if encoding == 'ascii' else
                      struct.pack(order + 'B3%sff' % type[0], 7, *map(float, p), *map(float, t)))
        for f in faces:
            out.write((' '.join(map(str, (len(f),) + f)) + '\n').encode() if encoding == 'ascii' else
                      struct.pack(order + 'B%di' % len(f), len(f), *f))

# Rows of all meshes of a .gltf with a .bin: {'POSITION': [...], ..., 'indices': [...]}, and the nodes.
def read_gltf(path):
    g = json.load(open(path))
    data = open(os.path.join(os.path.dirname(path), g['buffers'][0]['uri']), 'rb').read()
    rows = {}
    for mesh in g['meshes']:
        for p in mesh['primitives']:
            for name, a in [*p['attributes'].items(), ('indices', p['indices'])]:
                a = g['accessors'][a]
                n = {'SCALAR': 1, 'VEC2': 2, 'VEC3': 3, 'VEC4': 4}[a['type']]
                at = g['bufferViews'][a['bufferView']].get('byteOffset', 0)
                kind = {5126: 'f', 5123: 'H', 5125: 'I'}[a['componentType']]
                flat = struct.unpack_from('<%d%s' % (n * a['count'], kind), data, at)
                rows.setdefault(name, []).extend(flat[i:i + n] for i in range(0, len(flat), n))
    return rows, g['nodes']

# The rows of a PLY's vertices, and what it calls them.
def read_ply(path):
    data = open(path, 'rb').read()
    head, body = data.split(b'end_header\n', 1)
    words = [line.split() for line in head.decode().split('\n')]
    types = {'uchar': 'B', 'double': 'd', 'float': 'f'}
    names = [w[2] for w in words if w[:1] == ['property'] and len(w) == 3]
    kinds = ''.join(types[w[1]] for w in words if w[:1] == ['property'] and len(w) == 3)
    count = next(int(w[2]) for w in words if w[:2] == ['element', 'vertex'])
    if b'format ascii' in head:
        rows = [tuple(map(float, line.split())) for line in body.decode().split('\n')[:count]]
    else:
        rows = list(struct.iter_unpack(('>' if b'big' in head else '<') + kinds,
                                       body[:count * struct.calcsize('<' + kinds)]))
    return names, kinds, rows

def degrees(a, b):
    return math.degrees(2 * math.asin(min(1, math.dist(a[:3], b[:3]) / 2)))

def worst(a, b):
    return max(map(degrees, a, b)) if len(a) == len(b) else math.inf

# Float is right to some ten-thousandths of a degree at edges of 2 cm within a metre of 0.
NEAR = 0.0006

def compare(far, near):
    a, nodes = read_gltf(far)
    b, _ = read_gltf(near)
    return {'normals': worst(a['NORMAL'], b['NORMAL']) < NEAR, 'tangents': worst(a['TANGENT'], b['TANGENT']) < NEAR,
            'w': [t[3] for t in a['TANGENT']] == [t[3] for t in b['TANGENT']], 'faces': a['indices'] == b['indices']}

# node translation + position is the source's position, up to half of a float's step at the position.
def stands(gltf, at):
    rows, nodes = read_gltf(gltf)
    source = {tuple(map(float, p)) for p in moved(at)[0]}
    offsets = {tuple(n['translation']) for n in nodes}
    if len(offsets) != 1:
        return False
    offset = offsets.pop()
    grid = {tuple(round(x * 1000) for x in p[:2]): p for p in source} # x and y have three decimals
    for p in rows['POSITION']:
        q = tuple(x + o for x, o in zip(p, offset))
        s = grid.get(tuple(round(x * 1000) for x in q[:2]))
        if not s or any(abs(x - y) > 2.0 ** -25 for x, y in zip(q, s)):
            return False
    return True

do = sys.argv[1]
if do == 'make':
    write_obj('near.obj', NONE)
    write_obj('far.obj', FAR)
    write_obj('spelled.obj', FAR, spelled=True)
    write_obj('rounded.obj', FAR, to_float=True)
    for encoding in 'ascii', 'binary_little_endian', 'binary_big_endian':
        write_ply('near_%s.ply' % encoding, NONE, encoding)
        write_ply('far_%s.ply' % encoding, FAR, encoding)
    write_ply('float.ply', FAR, 'binary_little_endian', 'float')
elif do == 'compare':
    print(json.dumps(compare(sys.argv[2], sys.argv[3])))
elif do == 'stands':
    print(stands(sys.argv[2], FAR))
elif do == 'exact': # positions of a PLY are the source's doubles
    names, kinds, rows = read_ply(sys.argv[2])
    source = {tuple(map(float, p)) for p in moved(FAR)[0]}
    x = names.index('x')
    print(kinds[x:x + 3], all(row[x:x + 3] in source for row in rows), len(rows) >= len(source))
elif do == 'near': # positions of a PLY are the source's, but for a float's rounding within a metre of 0
    names, kinds, rows = read_ply(sys.argv[2])
    grid = {tuple(round(x * 1000) for x in p[:2]): tuple(map(float, p)) for p in moved(FAR)[0]}
    x = names.index('x')
    print(kinds[x:x + 3], all(max(abs(a - b) for a, b in zip(row[x:x + 3], grid[tuple(round(a * 1000) for a in row[x:x + 2])])) < 3e-8
                              for row in rows))
elif do == 'ply': # the rows of the source are there, and what was added is that of the near one
    names, _, rows = read_ply(sys.argv[2])
    _, _, source = read_ply(sys.argv[3])
    _, _, near = read_ply(sys.argv[4])
    n, t = names.index('nx'), names.index('tx')
    width = len(source[0])
    print([r[:width] for r in rows[:len(source)]] == source, worst([r[n:n + 3] for r in rows], [r[n:n + 3] for r in near]) < NEAR,
          worst([r[t:t + 3] for r in rows], [r[t:t + 3] for r in near]) < NEAR)
elif do == 'normals': # the worst angle between normals of two glTF, at their corners
    corners = [[m['NORMAL'][i] for i, in m['indices']] for m in (read_gltf(path)[0] for path in sys.argv[2:])]
    print(round(worst(*corners)))
END
far() {
	command python3 "$WORK/far.py" "$@"
}
all_right='{"normals": true, "tangents": true, "w": true, "faces": true}'

scene "an OBJ far from 0 gets an origin, a node adds it, and its normals and tangents are those of the mesh near 0"
far make
run far.obj far.gltf
exits 0
says "far.obj: info: positions are computed relative to an origin: 431234.3,5412345.9,101; float would round positions by up to 0.25, 12 times the median edge of 0.0203 [POS_ORIGIN]"
is "$(gltf far.gltf 'g.nodes.map(n => n.translation)')" "[[431234.3,5412345.9,101],[431234.3,5412345.9,101]]"
is "$(far stands far.gltf)" True
run near.obj near.gltf
says_not POS_
is "$(far compare far.gltf near.gltf)" "$all_right"
run -q far.obj far.gltf
silent
run --ignore=POS_ORIGIN far.obj far.gltf
says_not POS_ORIGIN
run --verify -q --threads=3 far.obj three.gltf
exits 0
same far.bin three.bin

scene "numbers are read as doubles in every spelling of a line"
far make
run -q far.obj far.gltf
run spelled.obj spelled.gltf
exits 0
says POS_ORIGIN
is "$(far stands spelled.gltf)" True
is "$(far compare spelled.gltf far.gltf)" "$all_right"

scene "--origin=keep rounds positions, which a finding says, and blames no triangle of the source"
far make
run --origin=keep far.obj keep.gltf
exits 0
says "warning: 462 vertices are moved by more than a hundredth of an edge where positions become float: by up to 0.25, 12 times the median edge of 0.0203 [POS_ROUNDED]: nmtan --origin=auto far.obj keep.gltf"
is "$(gltf keep.gltf 'g.nodes.map(n => n.translation)')" "[null,null]"
# a file of numbers that are floats has these bytes, and needs nothing
run -v rounded.obj rounded.gltf
exits 0
says_not POS_ORIGIN
says_not POS_ROUNDED
same keep.bin rounded.bin
run --origin=0,-0,0.0 -q far.obj zero.gltf
same keep.bin zero.bin
run near.obj near.gltf
[ "$(far normals keep.gltf near.gltf)" -gt 30 ] || wrong "rounding has not bent the sheet"
run --check --origin=keep far.obj
exits 0
prints "POS_ROUNDED"
! grep -q "POS_DEGENERATE\|merge its vertices\|Ready to use" "$WORK/out.txt" || wrong "$(cat "$WORK/out.txt")"
run --check --origin=keep far_ascii.ply
prints "POS_ROUNDED"
! grep -q "POS_DEGENERATE\|merge its vertices\|Ready to use" "$WORK/out.txt" || wrong "$(cat "$WORK/out.txt")"

scene "files that need no origin keep their bytes"
far make
for file in near.obj near_ascii.ply near_binary_big_endian.ply rounded.obj float.ply "$data/mirrored_cube.obj"; do
	run -q "$file" auto.glb
	exits 0
	run -q --origin=keep "$file" keep.glb
	exits 0
	same auto.glb keep.glb
	run -q "$file" auto.ply
	run -q --origin=keep "$file" keep.ply
	same auto.ply keep.ply
done
run --check near.obj rounded.obj float.ply
! grep -q "POS_ORIGIN\|POS_ROUNDED" "$WORK/out.txt" || wrong "$(cat "$WORK/out.txt")"

scene "an OBJ that becomes a PLY has its numbers there, as doubles"
far make
run -q far.obj far.ply
exits 0
is "$(far exact far.ply)" "ddd True True"
run -q --normals=flat far.obj flat.ply
is "$(far exact flat.ply)" "ddd True True"
# which is read again with the same origin
run far.ply again.gltf
says "an origin: 431234.3,5412345.9,101; "
run -q near.obj near.ply
# so has a PLY of the glTF, whose nodes add the origin
run -q far.obj far.glb
run -q far.glb back.ply
exits 0
is "$(far near back.ply)" "ddd True"
is "$(sed -n '/^property.* [xyz]$/p' near.ply | tr '\n' ' ')" "property float x property float y property float z "

scene "a PLY of doubles keeps its rows, and is computed relative to an origin"
far make
for encoding in ascii binary_little_endian binary_big_endian; do
	run far_$encoding.ply out.ply
	exits 0
	says "an origin: 431234.3,5412345.9,101; "
	run -q near_$encoding.ply near.ply
	is "$(far ply out.ply far_$encoding.ply near.ply)" "True True True"
	run -q far_$encoding.ply $encoding.gltf
	is "$(gltf $encoding.gltf 'g.nodes.map(n => n.translation)')" "[[431234.3,5412345.9,101]]"
	run -q near_$encoding.ply near.gltf
	is "$(far compare $encoding.gltf near.gltf)" "$all_right"
	same $encoding.bin ascii.bin
done
run -q far_ascii.ply out.ply
sed '1,/^end_header/d' far_ascii.ply | sed '441q' >before.txt
sed '1,/^end_header/d' out.ply | sed '441q' | cut -d' ' -f1-6 >after.txt
same before.txt after.txt

scene "of a PLY to a PLY, --origin=keep says that only what is computed is made of floats"
far make
kept='; the PLY keeps its numbers: only what is computed is made of the floats'
run --origin=keep far_ascii.ply keep.ply
says "12 times the median edge of 0.0203$kept [POS_ROUNDED]: nmtan --origin=auto far_ascii.ply keep.ply"
run -q far_ascii.ply auto.ply
for file in keep auto; do sed '1,/^end_header/d' $file.ply | sed 441q | cut -d' ' -f1-3 >$file.txt; done
same keep.txt auto.txt
! cmp -s keep.ply auto.ply || wrong "the command changes nothing"
run --check --origin=keep far_ascii.ply
prints "$kept"
prints "let nmtan choose an origin: nmtan --origin=auto far_ascii.ply far_ascii-repaired.ply"
# if nothing is computed, nothing is wrong, and no command is named
run --origin=keep keep.ply again.ply
says_not "POS_ROUNDED"
same keep.ply again.ply
run --check --origin=keep keep.ply
prints "Ready to use"
prints "info      POS_ROUNDED"
prints "; the PLY keeps its numbers, its normals and its tangents"
! grep -q "nmtan --origin" "$WORK/out.txt" || wrong "$(cat "$WORK/out.txt")"
run --origin=keep --existing=replace keep.ply again.ply
says "$kept [POS_ROUNDED]: nmtan --existing=replace --origin=auto keep.ply again.ply"
run --origin=keep keep.ply out.glb
says "12 times the median edge of 0.0203 [POS_ROUNDED]: nmtan --origin=auto keep.ply out.glb"

scene "a PLY of integers that float does not hold"
printf '%s\n' ply 'format ascii 1.0' 'element vertex 4' 'property int x' 'property int y' 'property int z' \
	'property float s' 'property float t' 'element face 1' 'property list uchar int vertex_indices' end_header \
	'431234121 541234567 0 0 0' '431234131 541234567 0 1 0' '431234131 541234577 0 1 1' '431234121 541234577 0 0 1' \
	'4 0 1 2 3' >int.ply
run int.ply int.gltf
exits 0
says "an origin: 431234126,541234572,0; "
is "$(gltf int.gltf 'rows(g.meshes[0].primitives[0].attributes.POSITION)')" "[[-5,-5,0],[5,-5,0],[5,5,0],[-5,5,0]]"

scene "an origin that the user names, for several files"
far make
run --origin=431000,5412000,0.5 -d out far.obj far_ascii.ply
exits 0
is "$(gltf out/far.glb 'g.nodes.map(n => n.translation)')" "[[431000,5412000,0.5],[431000,5412000,0.5]]"
run --origin=431000,5412000,0.5 -q far_ascii.ply named.glb
is "$(gltf named.glb 'g.nodes.map(n => n.translation)')" "[[431000,5412000,0.5]]"
# also if float needs none
run --origin=1,0,-2 "$data/quad.obj" quad.gltf
says "info: positions are computed relative to an origin: 1,0,-2 [POS_ORIGIN]"
run -q "$data/quad.obj" plain.gltf
is "$(gltf quad.gltf '[g.nodes[0].translation, rows(g.meshes[0].primitives[0].attributes.POSITION)[2]]')" \
	"$(gltf plain.gltf '[[1, 0, -2], rows(g.meshes[0].primitives[0].attributes.POSITION)[2].map((x, k) => x - [1, 0, -2][k])]')"
run --origin=9e8,0,0 far.obj worse.gltf
says "POS_ROUNDED"
says "nmtan --origin=auto far.obj worse.gltf"

scene "glTF has floats already"
run -q "$data/mirrored_cube.obj" cube.glb
run --origin=1,2,3 cube.glb out.glb
exits 1
says "--origin=X,Y,Z is for OBJ and PLY: the positions of this file are floats already"
only cube.glb
run -q --origin=keep cube.glb out.glb
exits 0

scene "one vertex far from the rest: no origin helps, and that is said"
far make
{ cat near.obj; echo 'v 1 1 1000000007'; echo 'f 442/1 1/1 2/2'; } >lone.obj
run lone.obj lone.gltf
exits 0
says "warning: 1 vertex is moved by more than a hundredth of an edge where positions become float: by up to 7, "
says_not POS_ORIGIN
says_not "nmtan --origin"
run -q --origin=keep lone.obj keep.gltf
same lone.bin keep.bin

scene "a check says the same, and names places as the file has them"
far make
# a triangle that has no area in the file either
sed -n '/^v /p; /^vt /p; /^f /p' far.obj >flat.obj
echo 'f 1/1 2/2 2/3' >>flat.obj
run --check flat.obj --report-format=json
exits 0
command python3 - "$WORK/out.txt" >said.txt <<'END'
import json, sys
f = json.load(open(sys.argv[1]))['files'][0]
x = next(x for x in f['findings'] if x['code'] == 'POS_DEGENERATE_TRIANGLE')
print(f['origin'], [x['code'] for x in f['findings'] if x['code'].startswith('POS')], x['count'], x['spots'][0]['positions'],
      f['meshes'][0]['box'])
END
is "$(cat said.txt)" "[431234.3, 5412345.9, 101] ['POS_ORIGIN', 'POS_DEGENERATE_TRIANGLE'] 1 [[431234.12, 5412345.67, 101], [431234.14, 5412345.671, 101.00644], [431234.14, 5412345.671, 101.00644]] [[431234.12, 5412345.67, 100.99012], [431234.52, 5412346.072, 101.00991]]"
run --check flat.obj
prints "at (431234.12 5412345.67 101)"
prints "positions are computed relative to an origin: 431234.3,5412345.9,101; "
run --check flat.obj --report-format=csv
prints ",431234.12,5412345.67,101,"
# two quads that are mirrored along x = 431234.12
printf '%s\n' 'v 431234.12 5412345.67 101' 'v 431235.12 5412345.67 101' 'v 431235.12 5412346.67 101' \
	'v 431234.12 5412346.67 101' 'v 431233.12 5412345.67 101' 'v 431233.12 5412346.67 101' 'vt 0 0' 'vt 1 0' 'vt 1 1' 'vt 0 1' \
	'f 1/1 2/2 3/3 4/4' 'f 5/2 1/1 4/4 6/3' >mirror.obj
run --check mirror.obj
prints "seam of 1 edge: seam 0, an open chain, length 1,"
prints "plane x = 431234.12"
prints "at (431234.12 5412346.67 101)"
run -q --manifest=m.json far.obj far.gltf
grep -q '"origin":\[431234.3,5412345.9,101\]' m.json || wrong "$(cat m.json)"
run -q --manifest=m.json near.obj near.gltf
! grep -q origin m.json || wrong "$(cat m.json)"

scene "a scan in UTM coordinates"
utm=$ROOT/../shared/cases/utm
if [ -d "$utm" ]; then
	run "$utm/scan.obj" scan.gltf
	exits 0
	says POS_ORIGIN
	run -q "$utm/scan0.obj" near.gltf
	# it has 101 in z, where the step of floats is 0.0000076
	is "$(far normals scan.gltf near.gltf)" 0
	run --origin=keep "$utm/scan.obj" keep.gltf
	says POS_ROUNDED
	run "$utm/scan.ply" scan.ply
	says POS_ORIGIN
	is "$(sed '1,/^end_header/d' scan.ply | sed 441q | cut -d' ' -f1-5 | cksum)" \
		"$(sed '1,/^end_header/d' "$utm/scan.ply" | sed 441q | cksum)"
else
	skip_case "../shared is not here"
fi

done_testing
