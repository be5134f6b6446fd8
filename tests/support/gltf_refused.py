#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""gltf_refused.py NMTAN: a good glTF with one fault each, and JSON of each spelling: what is said, and where, and what is kept.

A row is a change of the document, the place and the words of the message; without a place the file is converted. Rows of
JSON are the text of a value, how many bytes of it are read before the fault, and the words; without words the output spells it
alike. Rows of BYTES are changes of a .glb, with the byte of the message. Rows of MEANT are documents in order.
"""
import json
import os
import subprocess
import sys

import gltf_table as table

ROWS = r"""
g.clear()|/asset/version|nothing, expected the version of glTF as a string
g['asset'] = 2|/asset/version|nothing, expected the version
g['asset']['version'] = 2.0|/asset/version|
g['asset']['version'] = '1.1'|/asset/version|"1.1", expected 2.0
g['asset']['minVersion'] = '2.1'|/asset/minVersion|needs glTF 2.1, expected 2.0
g['asset']['minVersion'] = '2.0'
g['asset']['version'] = '2.7'
g['accessors'] = {}|/accessors|an object, expected an array
a[0] = []|/accessors/0|an array, expected an object
a[0]['count'] = '6'|/accessors/0/count|a string, expected a whole number of at least 0
a[0]['count'] = 0|/meshes/0/primitives/0/attributes/NORMAL|accessor 1 has 6 elements, POSITION has 0
a[0]['count'] = 10 ** 20 - 1|/accessors/0/count|expected a whole number of at least 0
a[0]['count'] = 2 ** 32 - 1|/accessors/0/count|4294967295, expected at most 4294967294
del a[0]['count']|/accessors/0|"count" is missing
del a[0]['componentType']|/accessors/0|"componentType" is missing
a[0]['componentType'] = 5124|/accessors/0/componentType|5124, expected 5120 to 5123, 5125 or 5126
a[0]['componentType'] = 5127|/accessors/0/componentType|5127
a[0]['componentType'] = 5119|/accessors/0/componentType|5119
del a[0]['type']|/accessors/0/type|
a[0]['type'] = 'VEC1'|/accessors/0/type|"VEC1"
a[0]['type'] = 3|/accessors/0/type|
a[0]['byteOffset'] = 4|/accessors/0|6 elements end at byte 76 of bufferView 0, which has 72
a[0]['byteOffset'] = -4|/accessors/0/byteOffset|
a[0]['bufferView'] = 40|/accessors/0|refers to bufferViews[40], there are
a[0]['bufferView'] = 1.5|/accessors/0/bufferView|
a[0]['type'] = 'VEC2'|/meshes/0/primitives/0/attributes/POSITION|accessor 0 has 2 components, expected 3
a[1]['type'] = 'VEC2'|/meshes/0/primitives/0/attributes/NORMAL|accessor 1 has 2 components, expected 3
a[2]['type'] = 'SCALAR'|/meshes/0/primitives/0/attributes/TEXCOORD_0|accessor 2 has 1 components, expected 2
a[1]['count'] = 5|/meshes/0/primitives/0/attributes/NORMAL|accessor 1 has 5 elements, POSITION has 6
a[2]['count'] = 5|/meshes/0/primitives/0/attributes/TEXCOORD_0|accessor 2 has 5 elements, POSITION has 6
a[3]['count'] = 5|/accessors/3|5 elements, but other attributes of the same primitives have 6
another(p, 5)|/meshes/0/primitives/1|5 vertices, but a primitive that shares attributes with it has 6
another(p, 6)
p['attributes']['TANGENT'] = 'x'
p['attributes']['TANGENT'] = 0
p['attributes']['TANGENT'] = 3; a[3]['count'] = 5
a[p['indices']].update(componentType=5121, bufferView=len(v)); numbers([0] * 11 + [255])|/accessors/9|index 11 is 255 (reserved), there are 6 vertices
a[p['indices']].update(componentType=5123, bufferView=len(v)); numbers([0] * 22 + [255] * 2); g['extensionsUsed'] = ['KHR_mesh_primitive_restart']|/accessors/9|index 11 restarts the primitive
a[p['indices']].update(componentType=5121, bufferView=len(v)); numbers([0] * 11 + [6])|/accessors/9|index 11 is 6, there are 6 vertices
v[0]['byteStride'] = 8|/accessors/0|elements of 12 bytes, but bufferView 0 has a byteStride of 8
v[0]['byteStride'] = 16|/accessors/0|6 elements end at byte 92 of bufferView 0, which has 72
v[0]['byteStride'] = 256|/accessors/0|6 elements end at byte 1292 of bufferView 0, which has 72
v[0]['byteLength'] = 71|/accessors/0|6 elements end at byte 72 of bufferView 0, which has 71
v[0]['byteLength'] = 0|/accessors/0|6 elements end at byte 72 of bufferView 0, which has 0
del v[0]['byteLength']|/bufferViews/0|"byteLength" is missing
v[0]['byteLength'] = 1e6|/bufferViews/0|bytes 0 to 1000000, but buffer 0 has
v[0]['byteOffset'] = 1e6|/bufferViews/0|bytes 1000000 to 1000072, but buffer 0 has
v[0]['byteOffset'] = 2 ** 53|/bufferViews/0|
v[0]['buffer'] = 3|/bufferViews/0|refers to buffers[3], there are 1
del v[0]['buffer']|/bufferViews/0|"buffer" is missing
v[0] = 3|/bufferViews/0|an integer, expected an object
g['bufferViews'] = None|/bufferViews|
g['buffers'][0]['byteLength'] += 100|/buffers/0|bytes are there
del g['buffers'][0]['byteLength']|/buffers/0|"byteLength" is missing
del g['buffers'][0]['uri']|/buffers/0|the buffer has no uri
[x.pop('bufferView', 0) for x in a]; g['meshes'][0]['primitives'].append({**p, 'attributes': dict(p['attributes'], POSITION=len(a), NORMAL=len(a) + 1, TEXCOORD_0=len(a) + 2, COLOR_0=len(a) + 3, _ID=len(a) + 4)}); del p['targets'], g['meshes'][0]['primitives'][1]['targets']; a += [dict(a[p['attributes'][n]]) for n in ('POSITION', 'NORMAL', 'TEXCOORD_0', 'COLOR_0', '_ID')]; g['bufferViews'], g['buffers'] = [], []
g['buffers'][0]['uri'] = 3|/buffers/0/uri|an integer, expected a string
g['buffers'][0]['uri'] = 'data:;base64,A'|/buffers/0|
g['buffers'] = []|/bufferViews/0|refers to buffers[0], there are 0
p['indices'] = 99|/meshes/0/primitives/0/indices|refers to accessors[99], there are
p['indices'] = 'x'|/meshes/0/primitives/0/indices|
p['indices'] = 0|/accessors/0|the indices of a primitive are 3 components of type 5126, expected an unsigned SCALAR
del a[p['indices']]['bufferView']
a[p['indices']]['componentType'] = 5120|/accessors/9|the indices of a primitive are 1 components of type 5120, expected an unsigned SCALAR
a[p['indices']].update(count=3999999999); del a[p['indices']]['bufferView']|/accessors/9|
g.update(cameras=[7], skins={}, animations=[{'channels': 9}])
g['buffers'].append({'byteLength': 100, 'uri': '../absent.bin'}); g['buffers'].append({'uri': 7})
p['mode'] = 7|/meshes/0/primitives/0/mode|7, expected at most 6
p['mode'] = -1|/meshes/0/primitives/0/mode|
p['material'] = 9|/meshes/0/primitives/0|refers to materials[9], there are 4
p['attributes'] = 3|/meshes/0/primitives/0|"attributes" is an integer, expected an object
p['attributes']['POSITION'] = 99|/meshes/0/primitives/0/attributes/POSITION|refers to accessors[99]
p['attributes']['NORMAL'] = 99|/meshes/0/primitives/0/attributes/NORMAL|refers to accessors[99]
p['targets'][0]['POSITION'] = 99|/meshes/0/primitives/0/targets/0|refers to accessors[99], there are 10
p['targets'][0]['POSITION'] = 2|/meshes/0/primitives/0/targets/0|POSITION: accessor 2 has 6 elements of 2 components, expected 6 of 3
a[p['targets'][0]['POSITION']]['count'] = 5|/meshes/0/primitives/0/targets/0|
g['meshes'] = {}|/meshes|an object, expected an array
g['meshes'][0]['primitives'] = {}|/meshes/0|"primitives" is an object, expected an array
g['meshes'][0]['primitives'][0] = 3|/meshes/0/primitives/0|an integer, expected an object
g['meshes'][0] = 3|/meshes/0|
g['nodes'][0]['mesh'] = 9
g['nodes'][0]['children'] = [0]
g['scenes'][0]['nodes'] = [9]
g['scene'] = 9
g['materials'][0]['normalTexture'] = 3|/materials/0/normalTexture|an integer, expected an object
g['materials'][0]['normalTexture']['texCoord'] = 'x'|/materials/0/normalTexture/texCoord|
g['materials'][0]['normalTexture'].update(extensions={'KHR_texture_transform': {'rotation': 'x'}})|/materials/0/normalTexture/extensions/KHR_texture_transform/rotation|a string, expected a number
g['materials'][0]['normalTexture'].update(extensions={'KHR_texture_transform': {'scale': [1]}})|/materials/0/normalTexture/extensions/KHR_texture_transform/scale|
g['materials'] = 3|/materials|
g['extensionsRequired'] = ['VENDOR_x']
g['extensionsUsed'] = 3
a[0]['sparse'] = sparse(); a[0]['sparse']['count'] = 7|/accessors/0/sparse/count|7, expected at most 6
a[0]['sparse'] = sparse(); a[0]['sparse']['indices']['componentType'] = 5126|/accessors/0/sparse/indices|componentType 5126, expected 5121, 5123 or 5125
a[0]['sparse'] = sparse(); a[0]['sparse']['indices']['bufferView'] = 99|/accessors/0/sparse/indices|refers to bufferViews[99]
a[0]['sparse'] = sparse(); a[0]['sparse']['values']['bufferView'] = 99|/accessors/0/sparse/values|refers to bufferViews[99]
a[0]['sparse'] = sparse(); a[0]['sparse']['values']['byteOffset'] = 70|/accessors/0/sparse/values|2 elements end at byte 94 of bufferView 0, which has 72
a[0]['sparse'] = sparse(); del a[0]['sparse']['count']|/accessors/0/sparse|"count" is missing
a[0]['sparse'] = sparse([1, 1])|/accessors/0/sparse/indices|index 1 is 1, expected more than the one before
a[0]['sparse'] = sparse([2, 1])|/accessors/0/sparse/indices|index 1 is 1, expected more than the one before
a[0]['sparse'] = sparse([1, 6])|/accessors/0/sparse/indices|index 1 is 6, expected less than the accessor's count
a[0]['sparse'] = sparse([0, 5])
g['bufferViews'][0]['extensions'] = {'EXT_meshopt_compression': {}}|/bufferViews/0/extensions/EXT_meshopt_compression|
pack(v[0], count=7)|/bufferViews/0/extensions/EXT_meshopt_compression|7 elements of 12 bytes, but the view has 72 bytes
pack(v[0], byteStride=16)|/bufferViews/0/extensions/EXT_meshopt_compression|6 elements of 16 bytes, but the view has 72 bytes
pack(v[0], byteStride=14)|/bufferViews/0/extensions/EXT_meshopt_compression|byteStride 14 in mode ATTRIBUTES
pack(v[0], mode='X')|/bufferViews/0/extensions/EXT_meshopt_compression|
pack(v[0], filter='X')|/bufferViews/0/extensions/EXT_meshopt_compression|
pack(v[0], buffer=9)|/bufferViews/0/extensions/EXT_meshopt_compression|refers to buffers[9]
pack(v[0], byteLength=10 ** 6)|/bufferViews/0/extensions/EXT_meshopt_compression|bytes 0 to 1000000, but buffer 0 has
pack(v[0])|/bufferViews/0/extensions/EXT_meshopt_compression|meshoptimizer cannot decode the view's 72 bytes
p['extensions'] = {'KHR_draco_mesh_compression': 3}|/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression|
draco(p, bufferView=99)|/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression|refers to bufferViews[99]
draco(p, bufferView='x')|/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression/bufferView|
draco(p, bufferView=0)|/bufferViews/0|not Draco data
draco(p, bufferView=0); p['mode'] = 5|/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression|compressed primitive of mode 5, expected 4
draco(p, bufferView=0, attributes=3)|/bufferViews/0|not Draco data
"""

# b: the bytes of a .glb, of which j have the JSON and c the rest; ended(): the same with the length of a file in its head.
BYTES = r"""
b = b[:8]|8|the file ends within the 12-byte GLB header
b = b[:8] + u32(19) + b[12:]|8|declares 19 bytes, too few for a JSON chunk
b = b[:12] + u32(len(b)) + b[16:]|12|a GLB chunk declares
b = b[:16] + u32(5) + b[20:]|16|the first GLB chunk has type 0x00000005, expected JSON
b = ended(b + bytes(7))|len(b) - 7|7 bytes left, a GLB chunk begins with 8
b = ended(b + b'abc')|len(b) - 3|3 bytes left, a GLB chunk begins with 8
b = ended(b + bytes(3))
b = b + b'behind the end'
b = ended(chunk(JSON, bytes(8)) + c)|12|the JSON chunk of the GLB is empty
b = ended(chunk(JSON, j + bytes(4)) + c)
b = ended(chunk(JSON, j + b'    ') + c)
b = ended(chunk(JSON, j.replace(b'"asset"', b'"asset')) + c)|20 + j.index(b'"asset"') + len(b'"asset: {"')|expected ':'
b = ended(chunk(JSON, j) + chunk(7, b'more') + c)|/buffers/0|the buffer has no uri and there is no BIN chunk for it
b = ended(chunk(JSON, j) + c + chunk(7, b'more') + chunk(JSON, b'{}  ') + c)
b = b'7'||an integer, expected an object
"""

# A row has a change, what a report says of the primitive then, and the value. Texture 0 is a normal map.
MEANT = r"""
m[0] = {}|slots|[]
m[0] = normal(texCoord=1)|slots, texcoord_set, has_texcoords|(['normal'], 1, False)
m[0] = normal(texCoord=1, extensions={'KHR_texture_transform': {'texCoord': 0}})|slots, texcoord_set|(['normal'], 0)
m[0] = also({}, KHR_materials_anisotropy={})|slots|['anisotropy']
m[0] = also({}, KHR_materials_clearcoat={})|slots|[]
m[0] = also({}, KHR_materials_clearcoat={'clearcoatNormalTexture': {'index': 0, 'texCoord': 1}}, KHR_materials_anisotropy={'anisotropyTexture': {'index': 0}})|sorted(slots), texcoord_set, 'TAN_UVSET_CONFLICT' in codes|(['anisotropy', 'clearcoat_normal'], 1, True)
m[0] = normal(extensions={'KHR_texture_transform': {'scale': [1, 1]}}); animate('rotation')|'TAN_UV_TRANSFORM_ANIMATED' in codes|True
m[0] = normal(extensions={'KHR_texture_transform': {'scale': [1, 1]}}); animate('offset')|'TAN_UV_TRANSFORM_ANIMATED' in codes|False
m[0] = also(normal(), KHR_materials_unlit={})|slots|[]
# MToon of VRM 1 samples the map although the fallback is unlit; that of VRM 0 is in the root
m[0] = also(normal(), KHR_materials_unlit={}, VRMC_materials_mtoon={})|slots|['normal']
m[0] = also({}, KHR_materials_unlit={}, VRMC_materials_mtoon={})|slots|[]
m[0] = also({}, KHR_materials_unlit={}); g['extensions'] = {'VRM': {'materialProperties': [{'textureProperties': {'_BumpMap': 0}}]}}|slots|['normal']
m[0] = {}; g['extensions'] = {'VRM': {'materialProperties': [{'textureProperties': {'_MainTex': 0}}]}}|slots|[]
# its normal map lies as the main texture does: offset and scale
m[0:2] = {}, normal(); also(p, KHR_materials_variants={'mappings': [{'material': 0}, {'material': 1}]}); g['extensions'] = {'VRM': {'materialProperties': [{'textureProperties': {'_BumpMap': 0}, 'vectorProperties': {'_MainTex': [0, 0, -1, 1]}}]}}|'TAN_UVSET_CONFLICT' in codes|True
m[0:2] = {}, normal(); also(p, KHR_materials_variants={'mappings': [{'material': 0}, {'material': 1}]}); g['extensions'] = {'VRM': {'materialProperties': [{'textureProperties': {'_BumpMap': 0}, 'vectorProperties': {'_MainTex': [0, 0, 1, -1]}}]}}|'TAN_UVSET_CONFLICT' in codes|True
m[0:2] = {}, normal(); also(p, KHR_materials_variants={'mappings': [{'material': 0}, {'material': 1}]}); g['extensions'] = {'VRM': {'materialProperties': [{'textureProperties': {'_BumpMap': 0}, 'vectorProperties': {'_MainTex': [0.5, 0.5, 1, 1]}}]}}|'TAN_UVSET_CONFLICT' in codes|False
m[0:2] = {}, normal(); also(p, KHR_materials_variants={'mappings': [{'material': 0}, {'material': 1}]})|slots|['normal']
m[0:2] = also({}, MSFT_lod={'ids': [1]}), normal()|slots|['normal']
g['scenes'] = []|hidden|True
g.update(scenes=[{'nodes': [0]}], nodes=[{'children': [1]}, {'mesh': 0}])|hidden|False
g.update(scenes=[{'nodes': [0]}], nodes=[{}, {'mesh': 0}])|hidden|True
g.update(scenes=[{}, {'nodes': [1]}], nodes=[{}, {'mesh': 0}])|hidden|False
g.update(scenes=[{'nodes': [0]}], nodes=[{'children': [0, 77, 'x', 1]}, {'children': [0]}])|hidden|True
g.update(scenes=[{'nodes': [0]}], nodes=[also({}, MSFT_lod={'ids': [1]}), {'mesh': 0}])|hidden|False
g.update(scenes=7, nodes=8)|hidden|True
"""

# Text, bytes of it that are read, words; one blank more is no part of it.
TEXTS = r"""
01|1|expected ',' or '}'
1.|2|expected a digit
.5|0|expected a value
+1|0|expected a value
-|1|expected a digit
1e|2|expected a digit
1e+|3|expected a digit
-01|2|expected ',' or '}'
tru|3|expected true
nulL|3|'L', expected null
True|0|expected a value
"\x"|2|'x', expected an escape
"\u12g4"|2|expected four hexadecimal digits
"\ud800"|1|the surrogate \ud800 is not one of a pair
"\ud800\u0041"|1|the surrogate \ud800 is not one of a pair
"\udc00"|1|the surrogate \udc00 is not one of a pair
[1,]|3|
[1 2]|3|expected ',' or ']'
[,1]|1|expected a value
{"a":1,}|7|
{"a" 1}|5|expected ':'
{a:1}|1|
{"a":}|5|expected a value
{"a":1 "b":2}|7|expected ',' or '}'
[1}|2|expected ',' or ']'
'a'|0|expected a value
/**/1|0|expected a value
0
-0
-0.0e-0
1E5
1e+05
123456789012345678901234567890
0.1000000000000000055511151231257827
1e-400
-1.7976931348623157e308
true
[ ]
{ }
[[[[]]],{"":{}}]
{"a": 1 ,"b" :[1 , 2]}
"\u00e9\ud83d\ude00\b\f\n\r\t\/\\\""
"é😀"
"\u0000"
"\u0041"
{"\u0061":1}
""
"""


def rows_of(text):
    return [line.split('|') for line in text.strip('\n').split('\n')]


def base():
    d = table.build('x', table.morphs, table.none, table.separate)
    d.write('bad', embedded=True)
    with open('bad/x.gltf', encoding='utf-8') as file:
        g = json.load(file)
    os.remove('bad/x.gltf')
    del g['extras']
    return g


def make():
    """Gives for each file the place and words that are expected, what was changed, and the text that stays."""
    expected, text = {}, json.dumps(base())
    for number, (change, *message) in enumerate(rows_of(ROWS)):
        g = json.loads(text)
        a, v, p = g['accessors'], g['bufferViews'], g['meshes'][0]['primitives'][0]

        def sparse(numbers=(0, 1)):
            uri = 'data:application/octet-stream;base64,' + table.base64.b64encode(bytes(numbers)).decode()
            g['buffers'].append({'byteLength': len(numbers), 'uri': uri})
            v.append({'buffer': len(g['buffers']) - 1, 'byteLength': len(numbers)})
            return {'count': len(numbers), 'indices': {'bufferView': len(v) - 1, 'componentType': 5121}, 'values': {'bufferView': 0}}
        def numbers(bytes_):
            sparse(bytes_)

        def another(primitive, count):
            """A primitive with vertices of its own, but for one attribute that no load takes."""
            own = {n: len(a) + i for i, n in enumerate(('POSITION', 'NORMAL', 'TEXCOORD_0'))}
            a.extend([dict(a[primitive['attributes'][n]], count=count) for n in own])
            a[own['POSITION']]['byteOffset'] = a[own['NORMAL']]['byteOffset'] = 0
            numbers([0, 1, 2])
            a.append({'componentType': 5121, 'count': 3, 'type': 'SCALAR', 'bufferView': len(v) - 1})
            g['meshes'][0]['primitives'].append({'attributes': {**own, '_ID': primitive['attributes']['_ID']},
                                                 'indices': len(a) - 1, 'material': 0})

        def pack(view, **members):
            view['extensions'] = {'EXT_meshopt_compression': {'buffer': 0, 'byteOffset': 0, 'byteLength': 72, 'byteStride': 12,
                                                              'count': 6, 'mode': 'ATTRIBUTES', **members}}

        def draco(primitive, **members):
            primitive['extensions'] = {'KHR_draco_mesh_compression': {'attributes': {'POSITION': 0}, **members}}
        exec(change, {'g': g, 'a': a, 'v': v, 'p': p, 'sparse': sparse, 'pack': pack, 'draco': draco,
                      'numbers': numbers, 'another': another})
        name = 'bad/row%03d.gltf' % number
        expected[name] = message, change, None
        with open(name, 'w', encoding='utf-8') as file:
            json.dump(g, file)
    g = json.loads(text)
    rest = table.base64.b64decode(g['buffers'][0].pop('uri').split(',')[1])
    scope = {'JSON': 0x4E4F534A, 'u32': lambda n: n.to_bytes(4, 'little')}
    scope['chunk'] = lambda kind, data: scope['u32'](len(data)) + scope['u32'](kind) + data
    scope['ended'] = lambda data: b'glTF' + scope['u32'](2) + scope['u32'](
        len(data) + 12 * (data[:4] != b'glTF')) + data[12 * (data[:4] == b'glTF'):]
    scope['j'] = json.dumps(g).encode()
    scope['j'] += b' ' * (-len(scope['j']) % 4)
    scope['c'] = scope['chunk'](0x004E4942, rest + bytes(-len(rest) % 4))
    for number, (change, *message) in enumerate(rows_of(BYTES)):
        scope['b'] = scope['ended'](scope['chunk'](scope['JSON'], scope['j']) + scope['c'])
        exec(change, scope)
        if message and message[0][:1] not in ('', '/'):
            message[0] = 'at byte %d' % eval(message[0], scope)
        name = 'bad/bytes%02d.%s' % (number, 'glb' if scope['b'][:4] == b'glTF' else 'gltf')
        expected[name] = message, change, None
        with open(name, 'wb') as file:
            file.write(scope['b'])
    begin = text[:-1] + ', "extras": '
    for number, (value, *message) in enumerate(rows_of(TEXTS)):
        if message:
            message = ['at byte %d' % (len(begin) + int(message[0])), message[1]]
        name = 'bad/text%03d.gltf' % number
        expected[name] = message, value, value
        with open(name, 'w', encoding='utf-8') as file:
            file.write(begin + value + ' }')
    return expected


def normal(**members):
    return {'normalTexture': {'index': 0, **members}}


def also(object, **extensions):
    object.setdefault('extensions', {}).update(extensions)
    return object


def misunderstood(nmtan):
    """The rows of MEANT that a report contradicts."""
    text, faults, rows = json.dumps(base()), [], [row for row in rows_of(MEANT) if row[0][0] != '#']
    names = ['bad/meant%02d.gltf' % number for number in range(len(rows))]
    for name, (change, _, _) in zip(names, rows):
        g = json.loads(text)
        def animate(member):
            pointer = '/materials/0/normalTexture/extensions/KHR_texture_transform/' + member
            target = {'extensions': {'KHR_animation_pointer': {'pointer': pointer}}}
            g['animations'] = [{'channels': [{'target': target}]}]
        exec(change, {'animate': animate, 'g': g, 'm': g['materials'], 'p': g['meshes'][0]['primitives'][0], 'normal': normal, 'also': also})
        with open(name, 'w', encoding='utf-8') as file:
            json.dump(g, file)
    subprocess.run([nmtan, '-q', '--check', '--fail-on=never', '--report=meant.json', *names], check=False)
    with open('meant.json', encoding='utf-8') as file:
        judged = {f['file'].split('/')[-1]: dict(f['meshes'][0], codes=[x['code'] for x in f['findings']])
                  for f in json.load(file)['files']}
    for name, (change, question, answer) in zip(names, rows):
        mesh = judged[os.path.basename(name)]
        said = eval(question, dict(mesh, hidden='scene' in mesh['why'], sorted=sorted))
        if said != eval(answer):
            faults.append('%s: %s is %s' % (change, question, said))
    return faults


def main():
    os.makedirs('bad')
    expected = make()
    done = subprocess.run([sys.argv[1], '-v', '--only=all', '--verify', '-d', 'good', *expected], stdin=subprocess.DEVNULL, capture_output=True)
    said = done.stderr.decode().split('\n')
    # a sanitizer's code is another
    faults = [] if done.returncode == 3 else ['ends with %d' % done.returncode]
    for name, (message, change, spelled) in expected.items():
        lines = [line[len('nmtan: ' + name + ': '):] for line in said if line.startswith('nmtan: ' + name + ': ')]
        output = 'good' + name[3:]
        if message:
            place, words = message
            if not any(line.startswith(place and place + ': ') and words in line for line in lines) or os.path.exists(output):
                faults.append('%s: %s, expected %s: %s' % (change, lines, place, words))
        elif not os.path.exists(output):
            faults.append('%s: %s' % (change, lines))
        elif spelled:
            with open(output, encoding='utf-8') as file:
                if '"extras": %s }' % spelled not in file.read():
                    faults.append('%s is spelled otherwise' % spelled)
    faults += misunderstood(sys.argv[1])
    print('\n'.join(faults))
    return 1 if faults else 0


if __name__ == '__main__':
    sys.exit(main())
