// SPDX-License-Identifier: MIT

/** Numbers one behind the other, or rows of an interleaved array; stride and offset count numbers, not bytes. */
export type Attribute = ArrayLike<number> | {array: ArrayLike<number>; stride?: number; offset?: number};

export interface Options {
	/**
	 * How triangles around a vertex are averaged. 'mikktspace', the default, has the bytes of mikktspace.c as
	 * published; 'mikktspace-sorted' those of the rewrites of Blender and three.js, which complete its sort of edges.
	 */
	method?: 'mikktspace' | 'area' | 'lengyel' | 'robust' | 'mikktspace-sorted';
	/** Replace what a renderer cannot use by the nearest usable tangent, and count it. Default: true. */
	repair?: boolean;
	/** Where v points in texcoords: 'gltf' down (the default), 'mikktspace' up. */
	convention?: 'gltf' | 'mikktspace';
}

/**
 * What was met and repaired, in corners; degenerate and mirrored in triangles. sortedInstead is 1 where 'mikktspace'
 * gave the answer of 'mikktspace-sorted', since the mesh is beyond the limits that nmtan.h states under "Results".
 */
export interface Counts {
	degeneratePositions: number;
	degenerateTexcoords: number;
	mirrored: number;
	storedDifferently: number;
	foldedQuads: number;
	repairedZero: number;
	repairedNotFinite: number;
	repairedParallel: number;
	repairedSign: number;
	repairedUnassigned: number;
	repairedLeaning: number;
	illConditioned: number;
	sortedInstead: number;
	/** Corners of hubs past the bound of MikkTSpace's work, which have one sum. */
	summedInstead: number;
}

export interface IndexedTangents {
	/** x, y, z, w of each vertex: those given, then the copies. */
	tangents: Float32Array;
	/** The vertex of each corner after the split: a Uint16Array where one was given and holds them. */
	indices: Uint16Array | Uint32Array;
	/** sources[i] is the vertex of which vertex `vertex count + i` is a copy. */
	sources: Uint32Array;
	counts: Counts;
}

/** Resolves when the functions below may be called; rejects where WebAssembly cannot be compiled. */
export const ready: Promise<void>;
export const isReady: boolean;

/**
 * The raw result of MikkTSpace for triangles that share no vertex: x, y, z, w for each. The same function as that of
 * the package `mikktspace`: v points up, and callers who store v pointing down negate w.
 * Throws TypeError for arrays that do not fit each other, RangeError where memory ends.
 */
export function generateTangents(positions: Attribute, normals: Attribute, texcoords: Attribute): Float32Array;

/**
 * The same, repaired: each tangent is a unit vector across its normal, and the corners of a triangle have one w, by the
 * exact orientation of the triangle. Where the raw result is that already, the two are equal.
 */
export function generateRepairedTangents(positions: Attribute, normals: Attribute, texcoords: Attribute): Float32Array;

/**
 * A tangent for each vertex of an indexed mesh, with copies of the vertices whose corners need different ones.
 * Throws TypeError for arrays or options that are wrong, RangeError where memory ends.
 */
export function generateTangentsIndexed(indices: ArrayLike<number>, positions: Attribute, normals: Attribute,
	texcoords: Attribute, options?: Options): IndexedTangents;
