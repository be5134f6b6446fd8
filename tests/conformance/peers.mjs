// SPDX-License-Identifier: MIT
//
// peers.mjs MODULES KIT OUT: glTF-Transform's tangents() with npm's mikktspace, for each KIT/*.glb into OUT.
import {createRequire} from 'node:module';
import {readdirSync} from 'node:fs';
import {join, resolve} from 'node:path';
import {pathToFileURL} from 'node:url';

const [modules, kit, out] = process.argv.slice(2);
const require = createRequire(resolve(modules) + '/');
const load = (name) => import(pathToFileURL(require.resolve(name)));
const {NodeIO} = await load('@gltf-transform/core'), {ALL_EXTENSIONS} = await load('@gltf-transform/extensions');
const {tangents, unweld} = await load('@gltf-transform/functions');
const mikktspace = await load('mikktspace');
await mikktspace.ready;
const io = new NodeIO().registerExtensions(ALL_EXTENSIONS);
for (const name of readdirSync(kit).filter((n) => n.endsWith('.glb') && n !== 'card.glb')) {
	const document = await io.read(join(kit, name));
	await document.transform(unweld(), tangents({generateTangents: mikktspace.generateTangents || mikktspace.default.generateTangents}));
	await io.write(join(out, name), document);
}
