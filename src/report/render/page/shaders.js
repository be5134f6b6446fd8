// SPDX-License-Identifier: MIT
//
// Shaders. Texture coordinates have v pointing down, as images do; tangents, bitangents and w are for v up.

const MODES = [
	['lit', 'Lit'], ['winding', 'Winding'], ['checker', 'Checker'], ['normal', 'Normals'], ['tangent', 'Tangents'],
	['bitangent', 'Bitangents'], ['sign', 'Handedness (w)'], ['angle', 'Angle of frames'],
	['skew', 'Tangent off surface']];
const FRAMES = [['authored', 'in the file'], ['computed', 'by nmtan'], ['screen', 'by the screen']];

// The inputs that a surface's shaders take of a vertex. Without a GPU a triangle pays for every input that the text has, used or not: those
// that a mode does not use are constants in the fragment shader, and not there in the vertex shader.
const inputs = [['n', 'vec3', 'vec2', 'direction(code1)'], ['st', 'vec2', 'vec2', 'code2'], ['authored', 'vec4', 'vec3', 'tangent(code3)'],
	['computed', 'vec4', 'vec3', 'tangent(code4)']];
const surfaceVertex = used => `#version 300 es
uniform mat4 camera; uniform vec3 origin, step_;
layout(location=0) in vec3 code;
${inputs.map(([name, type, code], i) => used.includes(name) ? `layout(location=${i + 1}) in ${code} code${i + 1}; out ${type} ${name};` : '').join('\n')}
out vec3 p;
vec3 direction(vec2 code) {
	vec2 xy = code / 2047.0 - 1.0;
	float z = 1.0 - abs(xy.x) - abs(xy.y);
	if (z < 0.0) xy = (1.0 - abs(xy.yx)) * vec2(xy.x < 0.0 ? -1.0 : 1.0, xy.y < 0.0 ? -1.0 : 1.0);
	return normalize(vec3(xy, z));
}
vec4 tangent(vec3 code) {
	return code.z == 0.0 ? vec4(0.0) : vec4(direction(code.xy), code.z == 1.0 ? 1.0 : -1.0);
}
void main() {
	p = origin + code * step_;
	${inputs.map(([name, , , value]) => used.includes(name) ? `${name} = ${value};` : '').join(' ')}
	gl_Position = camera * vec4(p, 1.0);
}`;

// A program for each mode and its frames: without a GPU a pixel pays for every branch, taken or not. `normals`, `textured`, `based`: whether the mesh has normals, texture coordinates, a base colour.
//
// The frame from screen derivatives: T and B as the gradients of u and v over the surface, with their common scale
// taken out, so that a mirrored triangle gets a mirrored frame without stored data.
const frameText = which => which === 2 ? 'derived(normal)' : 'stored(' + FRAMES[which][0] + ')';
const signText = (which, frame) => which === 2 ? 'sideOf(' + frame + ')' : FRAMES[which][0] + '.w';
const surfaceUses = (mode, frame, other, normals, textured) => inputs.map(([name]) => name).filter(name => name === 'n' ? normals :
	name === 'st' ? textured && (mode <= 2 || frame === 2 || (mode === 7 && other === 2)) :
	(mode === 0 || mode > 3) && (FRAMES[frame][0] === name || (mode === 7 && FRAMES[other][0] === name)));
const surfaceFragment = (used, mode, frame, other, normals, textured, based) => `#version 300 es
precision highp float;
const int mode = ${mode}; const bool normals = ${normals}, textured = ${textured}, based = ${based};
uniform vec3 light, eye; uniform float green; uniform sampler2D bump, base; uniform mat3 map, baseMap; uniform vec3 plain, mirrored, degenerate;
in vec3 p; ${inputs.map(([name, type]) => used.includes(name) ? `in ${type} ${name};` : `const ${type} ${name} = ${type}(0.0);`).join(' ')}
out vec4 colour;
mat3 derived(vec3 normal) {
	vec2 at = (map * vec3(st, 1.0)).xy;
	vec3 px = dFdx(p), py = dFdy(p);
	vec2 d = vec2(1.0, -1.0), ux = dFdx(at) * d, uy = dFdy(at) * d;
	vec3 a = cross(py, normal), b = cross(normal, px);
	float side = dot(cross(px, py), normal) < 0.0 ? -1.0 : 1.0;
	vec3 gu = side * (a * ux.x + b * uy.x), gv = side * (a * ux.y + b * uy.y);
	float s = inversesqrt(max(max(dot(gu, gu), dot(gv, gv)), 1e-30));
	return mat3(gu * s, gv * s, normal);
}
mat3 stored(vec4 t) { return mat3(t.xyz, cross(n, t.xyz) * t.w, n); }
float sideOf(mat3 f) { return dot(cross(f[2], f[0]), f[1]) < 0.0 ? -1.0 : 1.0; }
vec3 heat(float degrees, float most) {
	float x = sqrt(clamp(degrees / most, 0.0, 1.0));
	vec3 a = vec3(0.13, 0.19, 0.38), b = vec3(0.25, 0.55, 0.62), c = vec3(0.96, 0.80, 0.32), d = vec3(0.80, 0.16, 0.14);
	return x < 0.33 ? mix(a, b, x / 0.33) : x < 0.66 ? mix(b, c, (x - 0.33) / 0.33) : mix(c, d, (x - 0.66) / 0.34);
}
float degreesBetween(vec3 a, vec3 b) {
	return degrees(atan(length(cross(a, b)), dot(a, b)));
}
vec3 checker() {
	vec2 cell = floor(st * 16.0), wide = fwidth(st) * 16.0;
	float odd = mod(cell.x + cell.y, 2.0), blur = clamp(max(wide.x, wide.y) * 1.5 - 0.5, 0.0, 1.0);
	vec3 hue = 0.55 + 0.35 * cos(6.2831853 * (vec3(0.0, 0.33, 0.67) + fract(floor(st.x) * 0.13 + floor(st.y) * 0.29) + st.x * 0.35));
	return mix(hue * mix(0.62, 1.0, mix(odd, 0.5, blur)), vec3(1.0), 0.12 * st.y - 0.06);
}
vec3 shade(vec3 base, vec3 normal) {
	return base * (0.45 + 0.6 * abs(dot(normal, light)));
}
void main() {
	vec3 faceNormal = normalize(cross(dFdx(p), dFdy(p)));
	if (dot(faceNormal, eye - p) < 0.0) faceNormal = -faceNormal;
	vec3 normal = normals ? normalize(n) : faceNormal;
	// back faces are lit as the other side of a sheet is
	vec3 shown = dot(normal, eye - p) < 0.0 && dot(faceNormal, normal) < 0.0 ? -normal : normal;
	mat3 used = ${frameText(frame)};
	vec3 tangent = used[0], missing = vec3(0.62, 0.62, 0.6);
	bool has = dot(tangent, tangent) > 1e-12;
	if (mode == 1) {
		float turn = dFdx(st).x * dFdy(st).y - dFdx(st).y * dFdy(st).x;
		vec3 base = !textured || turn == 0.0 ? degenerate : (turn < 0.0) == gl_FrontFacing ? plain : mirrored;
		colour = vec4(shade(base, shown), 1.0);
	} else if (mode == 2) {
		colour = vec4(textured ? shade(checker(), shown) * 1.1 : shade(missing, shown), 1.0);
	} else if (mode == 3) {
		colour = vec4(normal * 0.5 + 0.5, 1.0);
	} else if (mode == 4 || mode == 5) {
		colour = vec4(has ? normalize(mode == 4 ? used[0] : used[1]) * 0.5 + 0.5 : missing, 1.0);
	} else if (mode == 6) {
		float w = ${signText(frame, 'used')};
		colour = vec4(shade(!has ? missing : w > 0.99 ? plain : w < -0.99 ? mirrored : vec3(0.95, 0.8, 0.15), shown), 1.0);
	} else if (mode == 7) {
		mat3 second = ${frameText(other)};
		bool both = has && dot(second[0], second[0]) > 1e-12;
		float angle = degreesBetween(used[0], second[0]);
		if (${signText(frame, 'used')} * ${signText(other, 'second')} < 0.0) angle = 180.0;
		colour = vec4(both ? shade(heat(angle, 90.0), shown) * 1.15 : missing, 1.0);
	} else if (mode == 8) {
		colour = vec4(has ? shade(heat(abs(90.0 - degreesBetween(tangent, normal)), 30.0), shown) * 1.15 : missing, 1.0);
	} else {
		vec3 m = texture(bump, (map * vec3(st, 1.0)).xy).xyz * 2.0 - 1.0;
		m.y *= green;
		vec3 bumped = has && textured ? normalize(used * m) : normal;
		if (dot(shown, normal) < 0.0) bumped = -bumped;
		float diffuse = dot(bumped, light);
		vec3 h = normalize(light + normalize(eye - p));
		vec3 paint = based && textured ? texture(base, (baseMap * vec3(st, 1.0)).xy).xyz : vec3(0.76, 0.75, 0.73);
		vec3 lit = paint * (0.2 + 0.8 * max(diffuse, 0.0)) + vec3(0.05, 0.06, 0.08) * max(-diffuse, 0.0);
		colour = vec4(lit + 0.18 * pow(max(dot(bumped, h), 0.0), 36.0), 1.0);
	}
}`;

// Chosen triangles, drawn over the others.
const fillFragment = `#version 300 es
precision highp float;
uniform vec4 tint; uniform vec3 eye;
in vec3 p;
out vec4 colour;
void main() {
	vec3 face = normalize(cross(dFdx(p), dFdy(p)));
	float light = 0.6 + 0.4 * abs(dot(face, normalize(eye - p)));
	colour = vec4(tint.rgb * light, tint.a);
}`;

// The view of a camera: red where chosen triangles show their front.
const seenFragment = `#version 300 es
precision highp float;
uniform vec4 tint;
in vec3 p;
out vec4 colour;
void main() { colour = gl_FrontFacing ? tint : vec4(0.0, 1.0, 0.0, 1.0); }`;

// A line of some pixels' width: each is a strip of four corners.
const lineVertex = `#version 300 es
uniform mat4 camera; uniform vec2 size; uniform float width, lift;
layout(location=0) in vec3 from; layout(location=1) in vec3 to; layout(location=2) in vec3 ink;
out vec3 c;
void main() {
	vec4 a = camera * vec4(from, 1.0), b = camera * vec4(to, 1.0);
	float near = 1e-4;
	if (a.w < near && b.w < near) { gl_Position = vec4(0.0, 0.0, 2.0, 1.0); return; }
	if (a.w < near) a = mix(b, a, (b.w - near) / (b.w - a.w));
	if (b.w < near) b = mix(a, b, (a.w - near) / (a.w - b.w));
	vec2 along = (b.xy / b.w - a.xy / a.w) * size;
	along = length(along) > 1e-6 ? normalize(along) : vec2(1.0, 0.0);
	vec2 aside = vec2(-along.y, along.x) * (gl_VertexID % 2 == 0 ? -1.0 : 1.0) * width;
	vec2 ahead = along * (gl_VertexID < 2 ? -0.5 : 0.5) * width;
	vec4 end = gl_VertexID < 2 ? a : b;
	gl_Position = end + vec4((aside + ahead) / size * end.w, -lift * end.w, 0.0);
	c = ink;
}`;
const lineFragment = `#version 300 es
precision highp float;
in vec3 c; out vec4 colour;
void main() { colour = vec4(c, 1.0); }`;

// How often triangles cover a place of the texture: see Space.coverage().
const coverVertex = `#version 300 es
uniform mat3 place;
layout(location=2) in vec2 uv;
void main() { gl_Position = vec4((place * vec3(uv, 1.0)).xy, 0.0, 1.0); }`;
const coverFragment = `#version 300 es
precision mediump float;
uniform vec4 tint;
out vec4 colour;
void main() { colour = tint; }`;
