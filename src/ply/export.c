/* SPDX-License-Identifier: MIT */
/*
 * PLY from a scene of another format: one binary little endian mesh in world space. PLY has no nodes,
 * so every instance is written with its matrix applied: positions by the matrix, normals by its inverse
 * transpose, tangents by its upper 3x3 and made perpendicular to the normal again. If the determinant is negative,
 * faces are wound the other way round and w changes its sign, so that the bitangent stays the image of the bitangent.
 * Instances with the identity keep their bits.
 *
 * v points up in PLY: the scene has it so, but what came from glTF is -v there and becomes 1 - v. Texture coordinates
 * are called s and t, as MeshLab, Blender and trimesh read them (MeshLab does not read u and v), and a comment names
 * the one image that a PLY can have: "TextureFile NAME", from the folder of the PLY.
 */
#include "ply/encode.h"

#include <float.h>
#include <math.h>
#include "base/dvec.h"
#include "base/vec.h"
#include "file/image_type.h"
#include "file/relative_path.h"
#include "file/uri.h"
#include "scene/origin.h"
#include "scene/srgb.h"

/* Attributes of the file's vertices. */
typedef struct layout {
	bool normals, colors, byte_colors, texcoords, tangents, bitangents;
	bool doubles; /* positions, which float does not hold */
	nt_srgb srgb;
	size_t vertex_count, face_count;
} layout;

/* How one instance is brought into the world. */
typedef struct placement {
	bool identity, mirrored;
	nt_dvec3 columns[4];   /* of the matrix */
	nt_dvec3 cofactors[3]; /* columns of the inverse transpose times |determinant| */
} placement;

static bool is_written(const nt_mesh *mesh)
{
	return mesh->triangles && mesh->positions && mesh->face_count > 0;
}

/* The normals that tangents are made for. */
static const float *normals_of(const nt_mesh *mesh)
{
	return mesh->solve_normals ? mesh->solve_normals : mesh->normals;
}

static size_t vertices_of(const nt_mesh *mesh)
{
	return mesh->vertex_count + mesh->split.source_count;
}

static size_t mesh_vertex(const nt_mesh *mesh, size_t vertex)
{
	return vertex < mesh->vertex_count ? vertex : mesh->split.sources[vertex - mesh->vertex_count];
}

/* Alpha as a byte divided by 255; -1: it is none. */
static int alpha_byte(float alpha)
{
	const float scaled = alpha * 255.0f;
	return scaled >= 0.0f && scaled <= 255.5f && rintf(scaled) / 255.0f == alpha ? (int)rintf(scaled) : -1;
}

static placement find_placement(const nt_instance *instance)
{
	static const double identity[16] = {[0] = 1.0, [5] = 1.0, [10] = 1.0, [15] = 1.0};
	const double *m = instance->matrix;
	placement p = {.identity = memcmp(m, identity, sizeof identity) == 0};
	for (size_t i = 0; i < 4; i++)
		p.columns[i] = (nt_dvec3){m[4 * i], m[4 * i + 1], m[4 * i + 2]};
	for (size_t i = 0; i < 3; i++)
		p.cofactors[i] = nt_dvec3_cross(p.columns[(i + 1) % 3], p.columns[(i + 2) % 3]);
	p.mirrored = nt_dvec3_dot(p.columns[0], p.cofactors[0]) < 0.0;
	for (size_t i = 0; p.mirrored && i < 3; i++)
		p.cofactors[i] = nt_dvec3_scale(-1.0, p.cofactors[i]);
	return p;
}

/* Whether a node puts a mesh where float would move vertices by more than a hundredth of an edge: such nodes are what a
 * file with an origin has. */
static bool is_far(const placement *p, const nt_mesh *mesh)
{
	if (p->identity)
		return false;
	double lengths[NT_ORIGIN_TRIED], largest = 0;
	const double scale = cbrt(fabs(nt_dvec3_dot(p->columns[0], p->cofactors[0])));
	const size_t count = ply_sample_edges(mesh, NULL, NT_ORIGIN_TRIED, lengths);
	for (size_t i = 0; i < count; i++)
		lengths[i] *= scale;
	for (size_t i = 0; i < 4; i++)
		largest += fmax(fabs(p->columns[i].x), fmax(fabs(p->columns[i].y), fabs(p->columns[i].z))) *
			(i < 3 ? (double)nt_largest_of(mesh->positions, 3 * mesh->vertex_count, 0) : 1);
	return nt_origin_is_suspected((float)fmin(largest, FLT_MAX), lengths, count, 1);
}

static layout find_layout(const nt_scene *scene, bool bitangents)
{
	layout l = {.byte_colors = true, .doubles = nt_scene_has_origin(scene)};
	nt_srgb_init(&l.srgb);
	for (size_t i = 0; i < scene->instance_count; i++) {
		const nt_mesh *mesh = &scene->meshes[scene->instances[i].mesh];
		if (!is_written(mesh))
			continue;
		l.normals |= mesh->normals != NULL;
		l.texcoords |= mesh->texcoords != NULL;
		l.tangents |= mesh->split.vertex_tangents || mesh->tangents;
		l.colors |= mesh->colors != NULL;
		const placement p = find_placement(&scene->instances[i]);
		l.doubles |= is_far(&p, mesh);
		/* whether all of them come from sRGB bytes */
		for (size_t k = 0; mesh->colors && k < 4 * mesh->vertex_count && l.byte_colors; k++)
			l.byte_colors = (k % 4 == 3 ? alpha_byte(mesh->colors[k])
				: nt_srgb_byte(&l.srgb, mesh->colors[k])) >= 0;
		l.vertex_count += vertices_of(mesh);
		l.face_count += mesh->face_count;
	}
	l.bitangents = bitangents && l.tangents && l.normals;
	return l;
}

/* texture: the name of the image; NULL: none */
static void write_header(ply_output *out, const layout *l, const char *texture)
{
	nt_buffer *b = &out->buffer;
	nt_buffer_text(b, "ply\nformat binary_little_endian 1.0\ncomment nmtan " NMTAN_VERSION_STRING "\n");
	if (texture)
		nt_buffer_format(b, "comment TextureFile %s\n", texture);
	nt_buffer_format(b, "element vertex %zu\n", l->vertex_count);
	const char *place = l->doubles ? "double" : "float";
	nt_buffer_format(b, "property %s x\nproperty %s y\nproperty %s z\n", place, place, place);
	if (l->normals)
		nt_buffer_text(b, "property float nx\nproperty float ny\nproperty float nz\n");
	if (l->colors) {
		const char *type = l->byte_colors ? "uchar" : "float";
		nt_buffer_format(b, "property %s red\nproperty %s green\nproperty %s blue\n"
			"property %s alpha\n", type, type, type, type);
	}
	if (l->texcoords)
		nt_buffer_text(b, "property float s\nproperty float t\n");
	if (l->tangents)
		nt_buffer_text(b, "property float tx\nproperty float ty\nproperty float tz\n"
			"property float tw\n");
	if (l->bitangents)
		nt_buffer_text(b, "property float bx\nproperty float by\nproperty float bz\n");
	nt_buffer_format(b, "element face %zu\nproperty list uchar %s vertex_indices\nend_header\n",
		l->face_count, l->vertex_count > INT32_MAX ? "uint" : "int");
}

static nt_dvec3 combine(const nt_dvec3 *columns, const float *v)
{
	return nt_dvec3_add(nt_dvec3_add(nt_dvec3_scale(v[0], columns[0]), nt_dvec3_scale(v[1], columns[1])),
		nt_dvec3_scale(v[2], columns[2]));
}

/* Positions as the source has them, if the scene holds these beside what is relative to its origin. */
static nt_dvec3 place_position(const placement *p, const nt_mesh *mesh, size_t vertex)
{
	if (mesh->exact_positions) {
		const size_t source = vertex < mesh->source_vertex_count ? vertex
			: mesh->vertex_sources[vertex - mesh->source_vertex_count];
		const double *place = mesh->exact_positions + 3 * source;
		return (nt_dvec3){place[0], place[1], place[2]};
	}
	const float *place = mesh->positions + 3 * vertex;
	return p->identity ? nt_dvec3_load(place) : nt_dvec3_add(combine(p->columns, place), p->columns[3]);
}

/* A matrix that flattens leaves some normals without a direction: they stay what they are. */
static void place_normal(const placement *p, const float *from, float *to)
{
	nt_dvec3 n = combine(p->cofactors, from);
	if (p->identity || !nt_dvec3_normalise(&n))
		memcpy(to, from, 3 * sizeof *to);
	else
		nt_dvec3_store(n, to);
}

/* n: the normal as written, NULL: none. */
static void place_tangent(const placement *p, const float *n, const float *from, float *to)
{
	memcpy(to, from, 4 * sizeof *to);
	if (p->identity)
		return;
	nt_dvec3 t = combine(p->columns, from);
	if (n)
		t = nt_dvec3_reject(nt_dvec3_load(n), t);
	if (!nt_dvec3_normalise(&t) && n)
		t = nt_dvec3_perpendicular(nt_dvec3_load(n));
	nt_dvec3_store(t, to);
	to[3] = p->mirrored ? -from[3] : from[3];
}

static void put_color(ply_output *out, const layout *l, const float *color)
{
	static const float white[4] = {1.0f, 1.0f, 1.0f, 1.0f};
	const float *c = color ? color : white;
	for (size_t i = 0; l->byte_colors && i < 4; i++)
		ply_put_integer(out, (uint32_t)(i == 3 ? alpha_byte(c[i]) : nt_srgb_byte(&l->srgb, c[i])), PLY_UINT8);
	for (size_t i = 0; !l->byte_colors && i < 4; i++)
		ply_put_floats(out, (const float[]){i == 3 ? c[i] : nt_srgb_from_linear(c[i])}, 1);
}

static bool are_finite(const float *values, size_t count)
{
	while (count > 0 && isfinite(values[count - 1]))
		count--;
	return count == 0;
}

/* glTF may hold, or make of what it holds, numbers that no reader of PLY takes, this one included. */
static nt_status fail_not_finite(const nt_mesh *mesh, const char *what, size_t vertex, bool placed, nt_error *error)
{
	nt_fail(error, NT_ERROR_INPUT, "the %s of vertex %zu is not finite%s, expected finite numbers for PLY",
		what, vertex, placed ? " where the node places it" : "");
	nt_mesh_place(mesh, &error->place);
	return NT_ERROR_INPUT;
}

/* An attribute that only other meshes have is zero, a colour white. Returns NT_OK or NT_ERROR_INPUT. */
static nt_status put_vertex(ply_output *out, const layout *l, const placement *p, const nt_mesh *mesh,
	size_t vertex, bool flip_v, nt_error *error)
{
	const size_t v = mesh_vertex(mesh, vertex);
	const nt_dvec3 place = place_position(p, mesh, v);
	float position[3], normal[3] = {0}, uv[2] = {0}, tangent[4] = {0}, bitangent[3];
	nt_dvec3_store(place, position);
	if (!are_finite(position, 3))
		return fail_not_finite(mesh, "position", v, are_finite(mesh->positions + 3 * v, 3), error);
	if (l->doubles)
		ply_put_doubles(out, (const double[]){place.x, place.y, place.z}, 3);
	else
		ply_put_floats(out, position, 3);
	if (mesh->normals)
		place_normal(p, normals_of(mesh) + 3 * v, normal);
	if (!are_finite(normal, 3))
		return fail_not_finite(mesh, "normal", v, false, error);
	if (l->normals)
		ply_put_floats(out, normal, 3);
	if (l->colors && mesh->colors && !are_finite(mesh->colors + 4 * v, 4))
		return fail_not_finite(mesh, "colour", v, false, error);
	if (l->colors)
		put_color(out, l, mesh->colors ? mesh->colors + 4 * v : NULL);
	if (mesh->texcoords) {
		uv[0] = mesh->texcoords[2 * v];
		uv[1] = flip_v ? 1.0f + mesh->texcoords[2 * v + 1] : mesh->texcoords[2 * v + 1];
	}
	if (!are_finite(uv, 2))
		return fail_not_finite(mesh, "texture coordinate", v, false, error);
	if (l->texcoords)
		ply_put_floats(out, uv, 2);
	const float *own = mesh->split.vertex_tangents ? mesh->split.vertex_tangents + 4 * vertex
		: mesh->tangents ? mesh->tangents + 4 * v : NULL;
	if (own)
		place_tangent(p, mesh->normals ? normal : NULL, own, tangent);
	if (l->tangents)
		ply_put_floats(out, tangent, 4);
	nt_bitangent(normal, tangent, bitangent);
	if (l->bitangents)
		ply_put_floats(out, bitangent, 3);
	return NT_OK;
}

static nt_status put_vertices(nt_scene *scene, ply_output *out, const layout *l, nt_error *error)
{
	const bool flip_v = scene->format == NT_FORMAT_GLTF || scene->format == NT_FORMAT_GLB;
	nt_status status = NT_OK;
	for (size_t i = 0; i < scene->instance_count; i++) {
		const nt_mesh *mesh = &scene->meshes[scene->instances[i].mesh];
		const placement p = find_placement(&scene->instances[i]);
		const size_t count = is_written(mesh) ? vertices_of(mesh) : 0;
		for (size_t v = 0; !status && v < count; v++) {
			status = put_vertex(out, l, &p, mesh, v, flip_v, error);
			if (!status)
				status = ply_drain(out, error);
		}
	}
	return status;
}

/* The first corner stays the first when a face is turned round. */
static void put_face(ply_output *out, const nt_mesh *mesh, size_t corner, size_t size, bool mirrored,
	size_t base)
{
	const uint32_t *indices = mesh->split.indices ? mesh->split.indices : mesh->indices;
	ply_put_integer(out, (uint32_t)size, PLY_UINT8);
	for (size_t k = 0; k < size; k++) {
		const size_t c = corner + (mirrored && k > 0 ? size - k : k);
		ply_put_integer(out, (uint32_t)(base + (indices ? indices[c] : c)), PLY_UINT32);
	}
}

static nt_status put_faces(nt_scene *scene, ply_output *out, nt_error *error)
{
	nt_status status = NT_OK;
	size_t base = 0;
	for (size_t i = 0; i < scene->instance_count; i++) {
		const nt_mesh *mesh = &scene->meshes[scene->instances[i].mesh];
		if (!is_written(mesh))
			continue;
		const bool mirrored = find_placement(&scene->instances[i]).mirrored;
		for (size_t f = 0, corner = 0; !status && f < mesh->face_count; f++) {
			const size_t size = mesh->face_sizes ? mesh->face_sizes[f] : 3;
			put_face(out, mesh, corner, size, mirrored, base);
			status = ply_drain(out, error);
			corner += size;
		}
		base += vertices_of(mesh);
	}
	return status;
}

/* ---- the image ---- */

/* MeshLab drops all other characters of a name. */
static bool is_read_by_all(char c)
{
	return c > 32 && c < 125;
}

/* Puts the image beside the output, under its own name as far as all read it; an embedded one is called after the
 * output. name: appended. */
static nt_status copy_image(nt_buffer *name, const nt_texture_file *image, const char *folder, const char *output,
	nt_output *set, nt_error *error)
{
	static const char *const endings[] = {[NT_IMAGE_PNG] = ".png", [NT_IMAGE_JPEG] = ".jpg",
		[NT_IMAGE_WEBP] = ".webp", [NT_IMAGE_EXR] = NULL};
	const char *own = nt_last_part(image->path ? image->path : output), *dot = strrchr(own, '.');
	const char *ending = image->path ? NULL : endings[nt_image_type_of_bytes(image->bytes, image->size)];
	nt_buffer path = {0};
	nt_sink *sink;
	nt_buffer_format(&path, "%s/", folder);
	const size_t begin = path.size;
	nt_buffer_append(&path, own, ending && dot ? (size_t)(dot - own) : strlen(own));
	nt_buffer_text(&path, ending ? ending : "");
	for (size_t i = begin; i < path.size && !path.failed; i++)
		path.data[i] = is_read_by_all(path.data[i]) ? path.data[i] : '_';
	nt_status status = path.failed ? nt_fail_memory(error)
		: nt_output_add(set, path.data, NT_ROLE_IMAGE, &sink, error);
	nt_buffer_free(&path);
	if (!status)
		status = nt_sink_write(sink, image->bytes, image->size, error);
	if (!status)
		status = nt_output_settle(set, sink, error);
	if (!status)
		nt_buffer_text(name, nt_sink_name(sink, false));
	return status;
}

/* The name of the image in the PLY: of its file if that is in the output's folder, else of a copy there; "": there is
 * none. */
static nt_status settle_image(nt_buffer *name, const nt_texture_file *image, const nt_write_options *options,
	nt_output *set, nt_error *error)
{
	nt_buffer folder = {0}, uri = {0}, path = {0};
	nt_status status = nt_link_folder(&folder, options->path, error);
	if (!status && image->path)
		status = nt_link_folder(&path, image->path, error);
	nt_buffer_format(&path, "/%s", image->path ? nt_last_part(image->path) : "");
	if (!status && (path.failed || folder.failed))
		status = nt_fail_memory(error);
	bool inside = !status && image->path && nt_link_is_inside(path.data, folder.data);
	for (const char *c = inside ? path.data + folder.size : ""; *c && inside; c++)
		inside = is_read_by_all(*c);
	if (!status && image->path && (options->images == NT_IMAGES_LINK ||
		(inside && options->images != NT_IMAGES_COPY))) {
		nt_link_uri(&uri, folder.data, path.data);
		nt_uri_append_decoded(name, uri.data ? uri.data : "", uri.size);
		status = uri.failed ? nt_fail_memory(error) : nt_output_protect(set, image->path, NULL, error);
	} else if (!status) {
		status = copy_image(name, image, folder.data, options->path, set, error);
	}
	nt_buffer_free(&folder);
	nt_buffer_free(&uri);
	nt_buffer_free(&path);
	return status || !name->failed ? status : nt_fail_memory(error);
}

/* Says what of the materials is not there. image: name of the one that is; NULL: none. */
static void tell_lost(nt_scene *scene, const char *image, const char *obstacle)
{
	const size_t textures = scene->left_out_textures - (image && scene->left_out_textures);
	const size_t count = scene->material_count + textures + scene->left_out_count;
	nt_buffer text = {0};
	if (scene->material_count)
		nt_buffer_format(&text, "materials (%zu)", scene->material_count);
	if (scene->left_out)
		nt_buffer_format(&text, "%s%s", text.size ? ", " : "", scene->left_out);
	if (textures)
		nt_buffer_format(&text, "%stextures (%zu)", text.size ? ", " : "", textures);
	if (image)
		nt_buffer_format(&text, "; TextureFile is %.100s", image);
	else if (obstacle)
		nt_buffer_format(&text, "; no TextureFile: %s", obstacle);
	if (count)
		nt_finding_add(&scene->findings, NT_CODE_REFERENCE_LOST, NULL, count, "%s",
			text.data && !text.failed ? text.data : "");
	scene->findings.failed |= text.failed;
	nt_buffer_free(&text);
}

nt_status ply_write_scene(nt_scene *scene, const nt_write_options *options, ply_output *out, nt_output *set,
	nt_error *error)
{
	const nt_texture_file *image = options->texture_file;
	const bool stream = nt_output_is_stream(options->path);
	nt_buffer name = {0};
	nt_status status = NT_OK;
	const layout l = find_layout(scene, options->bitangents);
	if (l.vertex_count > UINT32_MAX || l.face_count > UINT32_MAX)
		return nt_fail(error, NT_ERROR_TOO_LARGE,
			"the instances have %zu vertices and %zu faces together, more than PLY can number",
			l.vertex_count, l.face_count);
	out->encoding = PLY_LITTLE;
	if (image && image->bytes && !stream)
		status = settle_image(&name, image, options, set, error);
	tell_lost(scene, name.size ? name.data : NULL, !image ? NULL : image->bytes && stream
		? "there are no files beside a stream" : image->obstacle);
	if (!status)
		write_header(out, &l, name.size ? name.data : NULL);
	nt_buffer_free(&name);
	if (!status)
		status = put_vertices(scene, out, &l, error);
	return status ? status : put_faces(scene, out, error);
}
