// SPDX-License-Identifier: MIT
//
// Tangents for a geometry that three.js has loaded: nmtan-engines(7).
import { BufferAttribute } from 'three';
import { generateTangentsIndexed, ready } from 'nmtan';

// begin
export async function addTangents(geometry, vDown = true) {
	await ready;
	const rows = (a) => Float32Array.from({ length: a.count * a.itemSize },
		(_, i) => a.getComponent(Math.floor(i / a.itemSize), i % a.itemSize));
	const { position, normal, uv } = geometry.attributes;
	const { tangents, indices, sources } = generateTangentsIndexed(geometry.index.array, rows(position),
		rows(normal), rows(uv), { vDown });
	for (const [name, old] of Object.entries(geometry.attributes)) {
		const array = new old.array.constructor((old.count + sources.length) * old.itemSize);
		const grown = new BufferAttribute(array, old.itemSize, old.normalized);
		for (let v = 0; v < grown.count; v++)
			for (let c = 0; c < old.itemSize; c++)
				grown.setComponent(v, c, old.getComponent(v < old.count ? v : sources[v - old.count], c));
		geometry.setAttribute(name, grown);
	}
	geometry.setAttribute('tangent', new BufferAttribute(tangents, 4));
	geometry.setIndex(new BufferAttribute(indices, 1));
}
// end
