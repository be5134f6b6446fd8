// SPDX-License-Identifier: MIT

/** Numbers one behind the other, or rows of an interleaved array; stride and offset count numbers, not bytes. */
export type Attribute = ArrayLike<number> | {array: ArrayLike<number>; stride?: number; offset?: number};

/** Normals as floats, or an Int8Array or Int16Array, which is normalized as glTF has it. */
export type Normals = Attribute;

export interface Direction {
	/** Whether v points down in texcoords, as in glTF. Default: false, v points up. */
	vDown?: boolean;
}

export interface Options extends Direction {
	/**
	 * How triangles around a vertex are averaged. 'mikktspace', the default, has the bytes of mikktspace.c as
	 * published; 'mikktspace-sorted' those of the rewrites of Blender and three.js, which complete its sort of edges.
	 */
	method?: 'mikktspace' | 'area' | 'lengyel' | 'robust' | 'mikktspace-sorted';
	/** Replace what a renderer cannot use by the nearest usable tangent, and count it. Default: true. */
	repair?: boolean;
	/** MikkTSpace's, more than 0 and at most 180 degrees, the default. */
	angularThreshold?: number;
	/** The corners of each face, 3 or 4. Default: all are triangles. */
	faceSizes?: ArrayLike<3 | 4> | Uint8Array;
}

export interface CornerOptions extends Options {
	/** Give bitangents too. Default: false. */
	bitangents?: boolean;
	/** Give what was wrong with each corner too. Default: false. */
	cornerFaults?: boolean;
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
	/** Vertices whose normal is not of unit length: their tangents lean. */
	normalsNotUnit: number;
}

export interface CornerTangents {
	/** x, y, z, w of each corner. */
	tangents: Float32Array;
	/** x, y, z of each corner: MikkTSpace's own, where `bitangents` asks for them. */
	bitangents?: Float32Array;
	/** Bits of nmtan_fault in nmtan.h for each corner, where `cornerFaults` asks for them. */
	cornerFaults?: Uint8Array;
	counts: Counts;
}

export interface IndexedTangents<Indices extends Uint16Array | Uint32Array = Uint16Array | Uint32Array> {
	/** x, y, z, w of each vertex: those given, then the copies. */
	tangents: Float32Array;
	/** The vertex of each corner after the split: a Uint16Array if one was given and holds them, else a Uint32Array. */
	indices: Indices;
	/** sources[i] is the vertex of which vertex `vertex count + i` is a copy. */
	sources: Uint32Array;
	counts: Counts;
}

/** Resolves when the functions below may be called; rejects where WebAssembly cannot be compiled. */
export const ready: Promise<void>;
export const isReady: boolean;

/**
 * A tangent for each corner of the faces. Without indices (null) each vertex is a corner.
 * Throws TypeError for arrays or options that are wrong, RangeError where memory ends.
 */
export function generateCornerTangents(indices: ArrayLike<number> | null, positions: Attribute, normals: Normals,
	texcoords: Attribute, options?: CornerOptions): CornerTangents;

/**
 * The raw result of MikkTSpace for triangles that share no vertex: x, y, z, w for each. The same function as that of
 * the package `mikktspace`: v points up unless vDown says otherwise.
 * Throws TypeError for arrays that do not fit each other, RangeError where memory ends.
 */
export function generateTangents(positions: Attribute, normals: Normals, texcoords: Attribute,
	options?: Direction): Float32Array;

/**
 * The same, repaired: each tangent is a unit vector across its normal, and the corners of a triangle have one w, by the
 * exact orientation of the triangle. If the raw result is that already, the two are equal.
 */
export function generateRepairedTangents(positions: Attribute, normals: Normals, texcoords: Attribute,
	options?: Direction): Float32Array;

/**
 * A tangent for each vertex of an indexed mesh, with copies of the vertices whose corners need different ones.
 * Throws TypeError for arrays or options that are wrong, RangeError where memory ends.
 */
export function generateTangentsIndexed(indices: Uint32Array | Uint8Array | readonly number[],
	positions: Attribute, normals: Normals, texcoords: Attribute, options?: Options): IndexedTangents<Uint32Array>;
export function generateTangentsIndexed(indices: ArrayLike<number>, positions: Attribute, normals: Normals,
	texcoords: Attribute, options?: Options): IndexedTangents;
