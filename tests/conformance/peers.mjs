// SPDX-License-Identifier: MIT
//
// peers.mjs PEER MODULES KIT OUT: the tangents that a package of npm gives each KIT/*.glb, into OUT. glTF-Transform reads
// and writes all of them; its tangents() calls the PEER: mikktspace (what its users take), three, three-lengyel,
// meshoptimizer, meshoptimizer-compatible.
import {createRequire} from 'node:module';
import {readdirSync} from 'node:fs';
import {join, resolve} from 'node:path';
import {pathToFileURL} from 'node:url';

const [peer, modules, kit, out] = process.argv.slice(2);
const require = createRequire(resolve(modules) + '/');
const load = (name) => import(pathToFileURL(require.resolve(name)));
const {NodeIO} = await load('@gltf-transform/core'), {ALL_EXTENSIONS} = await load('@gltf-transform/extensions');
const {tangents, unweld} = await load('@gltf-transform/functions');

const three = async (negate, run) => {
	const at = (path) => import(pathToFileURL(resolve(modules, 'three', path)));
	const {BufferGeometry, BufferAttribute} = await at('build/three.module.js');
	const utils = await at('examples/jsm/utils/BufferGeometryUtils.js'), mikk = await at('examples/jsm/libs/mikktspace.module.js');
	await mikk.ready;
	return (positions, normals, texcoords) => {
		let geometry = new BufferGeometry().setAttribute('position', new BufferAttribute(positions, 3))
			.setAttribute('normal', new BufferAttribute(normals, 3)).setAttribute('uv', new BufferAttribute(texcoords, 2));
		geometry = run(geometry, utils, mikk);
		// tangents() turns w for v down; computeTangents() takes the texture coordinates of a glTF as they are
		return geometry.attributes.tangent.array.map((c, i) => negate && i % 4 === 3 ? -c : c);
	};
};
const meshoptimizer = async (flags) => {
	const {MeshoptTangents} = await load('meshoptimizer');
	await MeshoptTangents.ready;
	return (positions, normals, texcoords) => MeshoptTangents.generateTangents(Uint32Array.from(positions.keys()).subarray(
		0, positions.length / 3), positions, 3, normals, 3, texcoords, 2, flags);
};
const peers = {
	mikktspace: async () => require('mikktspace').generateTangents,
	three: () => three(false, (geometry, utils, mikk) => utils.computeMikkTSpaceTangents(geometry, mikk, false)),
	'three-lengyel': () => three(true, (geometry) => {
		geometry.setIndex([...Array(geometry.attributes.position.count).keys()]);
		geometry.computeTangents();
		return geometry;
	}),
	meshoptimizer: () => meshoptimizer([]),
	'meshoptimizer-compatible': () => meshoptimizer(['Compatible']),
};
const generateTangents = await peers[peer]();
const io = new NodeIO().registerExtensions(ALL_EXTENSIONS);
for (const name of readdirSync(kit).filter((n) => n.endsWith('.glb') && n !== 'card.glb')) {
	const document = await io.read(join(kit, name));
	await document.transform(unweld(), tangents({generateTangents}));
	await io.write(join(out, name), document);
}
