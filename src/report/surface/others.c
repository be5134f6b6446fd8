/* SPDX-License-Identifier: MIT */
/*
 * Other meshes that may share the texels of one: a sampler takes them alike, and their unmirrored triangles reach into
 * the same part of UV space. Meshes are sorted by sampler when the first one asks, and a sampler's meshes become a tree
 * of boxes (k-d, in place: the middle of a range knows the box of the range) when it is asked for: a scene of n
 * objects asks n times, and takes n log n.
 */
#include "report/surface/surface.h"

#include <stdlib.h>
#include "topology/corners.h"

/* A mesh, and the box of its unmirrored triangles as the sampler wraps them, rounded outwards. */
struct nt_other {
	const nt_mesh *mesh;
	float low[2], high[2];
	float all_low[2], all_high[2]; /* of the range that this is the middle of */
};

bool nt_next_unmirrored(nt_mesh_triangles *at, const float *texcoords[3])
{
	const nt_mesh *mesh = at->mesh;
	const float *uv = mesh->solve_texcoords ? mesh->solve_texcoords : mesh->texcoords;
	while (at->face < mesh->face_count) {
		const size_t size = mesh->face_sizes ? mesh->face_sizes[at->face] : 3, k = 2 + at->turn++;
		if (k >= size) {
			at->first += size;
			at->face++;
			at->turn = 0;
			continue;
		}
		const size_t corners[3] = {at->first, at->first + k - 1, at->first + k};
		for (int i = 0; i < 3; i++)
			texcoords[i] = uv + 2 * (mesh->indices ? mesh->indices[corners[i]] : corners[i]);
		if (nt_orientation(texcoords[0], texcoords[1], texcoords[2]) > 0)
			return true;
	}
	return false;
}

static int compare_samplers(const nt_mesh *a, const nt_mesh *b)
{
	const int64_t differences[] = {(int64_t)a->gltf_material - (int64_t)b->gltf_material,
		(int64_t)a->texcoord_set - (int64_t)b->texcoord_set, (int64_t)a->wrap[0] - (int64_t)b->wrap[0],
		(int64_t)a->wrap[1] - (int64_t)b->wrap[1], (int64_t)a->solve_sign - (int64_t)b->solve_sign};
	for (size_t i = 0; i < sizeof differences / sizeof *differences; i++)
		if (differences[i])
			return differences[i] < 0 ? -1 : 1;
	return 0;
}

static int by_sampler(const void *a, const void *b)
{
	const nt_other *x = a, *y = b;
	const int order = compare_samplers(x->mesh, y->mesh);
	return order ? order : x->mesh < y->mesh ? -1 : x->mesh > y->mesh;
}

static int compare_centres(const nt_other *x, const nt_other *y, int axis)
{
	const float a = x->low[axis] + x->high[axis], b = y->low[axis] + y->high[axis];
	return a < b ? -1 : a > b ? 1 : x->mesh < y->mesh ? -1 : x->mesh > y->mesh;
}

static int by_u(const void *a, const void *b)
{
	return compare_centres(a, b, 0);
}

static int by_v(const void *a, const void *b)
{
	return compare_centres(a, b, 1);
}

static void build_tree(nt_other *others, size_t count)
{
	if (!count)
		return;
	float low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
	for (size_t i = 0; i < count; i++) {
		nt_range_add(low, high, others[i].low);
		nt_range_add(low, high, others[i].high);
	}
	qsort(others, count, sizeof *others, high[0] - low[0] > high[1] - low[1] ? by_u : by_v);
	const size_t middle = count / 2;
	for (int axis = 0; axis < 2; axis++) {
		others[middle].all_low[axis] = low[axis];
		others[middle].all_high[axis] = high[axis];
	}
	build_tree(others, middle);
	build_tree(others + middle + 1, count - middle - 1);
}

/* Returns whether the mesh has unmirrored triangles. If these reach into several tiles, they are all over the axis. */
static bool measure(nt_other *other)
{
	const nt_mesh *mesh = other->mesh;
	nt_mesh_triangles at = {.mesh = mesh};
	const float *texcoords[3];
	float low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
	bool any = false;
	while (nt_next_unmirrored(&at, texcoords)) {
		any = true;
		for (int k = 0; k < 3; k++)
			nt_range_add(low, high, texcoords[k]);
	}
	for (int axis = 0; axis < 2 && any; axis++) {
		const bool wrapped = mesh->wrap[axis] == NT_WRAP_REPEAT || mesh->wrap[axis] == NT_WRAP_MIRRORED;
		const bool several = wrapped && floor((double)low[axis] + mesh->wrap_offset[axis]) !=
			floor((double)high[axis] + mesh->wrap_offset[axis]);
		const double a = several ? 0.0 : nt_wrap_coordinate(mesh, axis, low[axis]);
		const double b = several ? 1.0 : nt_wrap_coordinate(mesh, axis, high[axis]);
		other->low[axis] = nextafterf((float)fmin(a, b), -INFINITY);
		other->high[axis] = nextafterf((float)fmax(a, b), INFINITY);
	}
	return any;
}

static bool sort_meshes(const nt_scene *scene, nt_others *others)
{
	others->all = nt_alloc(scene->mesh_count, sizeof *others->all);
	others->built = nt_alloc(scene->mesh_count, sizeof *others->built);
	if (!others->all || !others->built)
		return false;
	for (size_t i = 0; i < scene->mesh_count; i++) {
		const nt_mesh *mesh = &scene->meshes[i];
		others->built[i] = NT_NONE;
		if (mesh->triangles && mesh->positions && mesh->texcoords)
			others->all[others->count++].mesh = mesh;
	}
	qsort(others->all, others->count, sizeof *others->all, by_sampler);
	return true;
}

/* The first one of a mesh's sampler. */
static size_t find_sampler(const nt_others *others, const nt_mesh *mesh)
{
	size_t first = 0, end = others->count;
	while (first < end) {
		const size_t middle = first + (end - first) / 2;
		if (compare_samplers(others->all[middle].mesh, mesh) < 0)
			first = middle + 1;
		else
			end = middle;
	}
	return first;
}

/* Meshes with unmirrored triangles come first, and are the tree: returns how many. */
static uint32_t build_sampler(nt_others *others, size_t first)
{
	nt_other *all = others->all + first;
	uint32_t kept = 0;
	for (size_t i = 0; first + i < others->count && !compare_samplers(all[i].mesh, all[0].mesh); i++) {
		if (measure(&all[i]))
			all[kept++] = all[i]; /* all behind are of the sampler, whichever of its meshes they are */
	}
	build_tree(all, kept);
	return kept;
}

static bool meet(const float low[2], const float high[2], const double minimum[2], const double maximum[2])
{
	for (int axis = 0; axis < 2; axis++)
		if (low[axis] > maximum[axis] || high[axis] < minimum[axis])
			return false;
	return true;
}

/* Returns whether to go on. */
static bool ask(const nt_other *others, size_t count, const double minimum[2], const double maximum[2],
	bool (*visit)(void *context, const nt_mesh *other), void *context)
{
	const nt_other *middle = others + count / 2;
	if (!count || !meet(middle->all_low, middle->all_high, minimum, maximum))
		return true;
	if (meet(middle->low, middle->high, minimum, maximum) && !visit(context, middle->mesh))
		return false;
	return ask(others, count / 2, minimum, maximum, visit, context) &&
		ask(middle + 1, count - count / 2 - 1, minimum, maximum, visit, context);
}

nt_status nt_others_ask(nt_others *others, const nt_scene *scene, const nt_mesh *mesh, const double minimum[2],
	const double maximum[2], bool (*visit)(void *context, const nt_mesh *other), void *context)
{
	if (scene->mesh_count < 2)
		return NT_OK;
	if (!others->all && !sort_meshes(scene, others))
		return NT_ERROR_MEMORY;
	const size_t first = find_sampler(others, mesh);
	/* a mesh whose sampler nobody else has asks nobody */
	if (first + 1 >= others->count || compare_samplers(others->all[first + 1].mesh, mesh))
		return NT_OK;
	if (others->built[first] == NT_NONE)
		others->built[first] = build_sampler(others, first);
	ask(others->all + first, others->built[first], minimum, maximum, visit, context);
	return NT_OK;
}

void nt_others_free(nt_others *others)
{
	free(others->all);
	free(others->built);
	free(others->textures);
	free(others->met);
}
