/* SPDX-License-Identifier: MIT */
/*
 * Triangles and what each is by itself: see surface.h. Points are found in points.c, edges in sides.c.
 */
#include "report/surface/surface.h"

#include <math.h>
#include <stdlib.h>
#include "topology/corners.h"

/* Triangles by which vertices are prefetched before they are needed: costs nothing where neighbours are near. */
enum { AHEAD = 16 };

static uint32_t vertex_of(const nt_mesh *mesh, size_t corner)
{
	return mesh->indices ? mesh->indices[corner] : (uint32_t)corner;
}

/* Quads are cut as they are written, so that corners, faces and vertices are lists of their own. */
typedef struct cut_lists {
	uint32_t *corners, *faces, *vertices;
} cut_lists;

static void add_triangle(nt_surface *s, const cut_lists *lists, size_t face, size_t first, const unsigned char order[3])
{
	const size_t t = s->triangle_count++;
	lists->faces[t] = (uint32_t)face;
	for (size_t k = 0; k < 3; k++) {
		lists->corners[3 * t + k] = (uint32_t)(first + order[k]);
		lists->vertices[3 * t + k] = vertex_of(s->mesh, first + order[k]);
	}
}

static nt_status cut_faces(nt_surface *s, size_t triangle_count, nt_scratch *scratch)
{
	static const unsigned char in_order[3] = {0, 1, 2};
	const nt_mesh *mesh = s->mesh;
	const cut_lists lists = {nt_scratch_alloc(scratch, 3 * triangle_count, sizeof *lists.corners),
		nt_scratch_alloc(scratch, triangle_count, sizeof *lists.faces),
		nt_scratch_alloc(scratch, 3 * triangle_count, sizeof *lists.vertices)};
	if (!lists.corners || !lists.faces || !lists.vertices)
		return NT_ERROR_MEMORY;
	nmtan_stored_uv stored;
	const nmtan_mesh view = nt_mesh_view(mesh, &stored);
	size_t first = 0;
	for (size_t face = 0; face < mesh->face_count; face++) {
		if (mesh->face_sizes[face] == 3) {
			add_triangle(s, &lists, face, first, in_order);
			first += 3;
			continue;
		}
		const int cut = mesh->face_diagonals ? mesh->face_diagonals[face] : nt_written_diagonal(&view, first);
		add_triangle(s, &lists, face, first, nt_quad_triangles[cut][0]);
		add_triangle(s, &lists, face, first, nt_quad_triangles[cut][1]);
		first += 4;
	}
	s->corners = lists.corners;
	s->faces = lists.faces;
	s->vertices = lists.vertices;
	return NT_OK;
}

/* Triangles alone are what the mesh has already. */
static nt_status list_triangles(nt_surface *s, nt_scratch *scratch)
{
	const nt_mesh *mesh = s->mesh;
	size_t quads = 0;
	for (size_t f = 0; mesh->face_sizes && f < mesh->face_count; f++)
		quads += mesh->face_sizes[f] == 4;
	if (quads)
		return cut_faces(s, mesh->face_count + quads, scratch);
	s->triangle_count = mesh->face_count;
	s->vertices = mesh->indices;
	return NT_OK;
}

/* ---- triangles by themselves ---- */

/* The area of corners a, b and c; NaN or infinite if a coordinate is. */
static double area_of(const float *a, const float *b, const float *c)
{
	const double ux = (double)b[0] - a[0], uy = (double)b[1] - a[1], uz = (double)b[2] - a[2];
	const double vx = (double)c[0] - a[0], vy = (double)c[1] - a[1], vz = (double)c[2] - a[2];
	const double nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
	return 0.5 * sqrt(nx * nx + ny * ny + nz * nz);
}

double nt_triangle_area(const nt_surface *s, size_t t)
{
	const double area = area_of(nt_side_position(s, 3 * t), nt_side_position(s, 3 * t + 1),
		nt_side_position(s, 3 * t + 2));
	return isfinite(area) ? area : 0.0;
}

double nt_uv_area(const nt_surface *s, size_t t)
{
	const float *a = nt_side_texcoord(s, 3 * t), *b = nt_side_texcoord(s, 3 * t + 1);
	const float *c = nt_side_texcoord(s, 3 * t + 2);
	return 0.5 * fabs(((double)b[0] - a[0]) * ((double)c[1] - a[1]) -
		((double)b[1] - a[1]) * ((double)c[0] - a[0]));
}

/* det = sum u[k] (v[k + 1] - v[k + 2]), each coordinate off by half a unit in its last place. The three differences
 * along an axis have twice the range together: with the largest coordinate that is a bound, which most triangles are
 * far above. */
bool nt_is_sliver(const nt_surface *s, size_t t)
{
	const float *uv[3] = {nt_side_texcoord(s, 3 * t), nt_side_texcoord(s, 3 * t + 1),
		nt_side_texcoord(s, 3 * t + 2)};
	double low[2], high[2], size[2], error = 0.0;
	for (int axis = 0; axis < 2; axis++) {
		const double x = uv[0][axis], y = uv[1][axis], z = uv[2][axis];
		low[axis] = fmin(x, fmin(y, z));
		high[axis] = fmax(x, fmax(y, z));
		size[axis] = fmax(fabs(low[axis]), fabs(high[axis]));
	}
	const double determinant = fabs(((double)uv[1][0] - uv[0][0]) * ((double)uv[2][1] - uv[0][1]) -
		((double)uv[2][0] - uv[0][0]) * ((double)uv[1][1] - uv[0][1]));
	if (determinant > 2.0 * 0x1p-24 * (size[0] * (high[1] - low[1]) + size[1] * (high[0] - low[0])))
		return false;
	for (int k = 0; k < 3; k++)
		for (int axis = 0; axis < 2; axis++)
			error += nt_half_unit(uv[k][axis]) *
				fabs((double)uv[(k + 1) % 3][1 - axis] - uv[(k + 2) % 3][1 - axis]);
	return determinant <= error;
}

/* ---- what rounding may have turned ---- */

/* Corners of a mesh that are asked for its grid. */
enum { SAMPLES = 1024 };

/*
 * A grid is coarser than what is told apart from the rounding of floats, 16 times, and has as many steps as bytes have
 * or more: a sphere of 64 segments is no rounding. Any few numbers lie on some grid, within the rounding of floats;
 * that eight do on one of up to 4 096 steps by chance has a probability of 2^-45.
 */
static const double COARSE = 16.0;
enum { LEAST_STEPS = 255, LEAST_VALUES = 8 };

static int compare_doubles(const void *a, const void *b)
{
	const double x = *(const double *)a, y = *(const double *)b;
	return x < y ? -1 : x > y;
}

/*
 * The step of which all differences of values are multiples, whose noise is given; 0: there is none. By Euclid: what is
 * left of a difference is a smaller step, at most half as large. Its error shrinks with every value that is further
 * away.
 */
static double find_step(double *values, size_t count, double noise)
{
	size_t distinct = 1;
	qsort(values, count, sizeof *values, compare_doubles);
	for (size_t i = 1; i < count; i++)
		distinct += values[i] > values[i - 1] + noise;
	const double range = count ? values[count - 1] - values[0] : 0.0;
	double step = range, error = noise;
	for (size_t i = 0; i < count && step > fmax(COARSE * noise, 4.0 * error);) {
		const double all = values[i] - values[0], steps = round(all / step);
		const double left = fabs(all - steps * step), most = noise + steps * error;
		i = left <= most ? i + 1 : 0;
		if (left > most) {
			step = left;
			error = most;
		} else if (steps * error > noise) {
			step = all / steps;
			error = noise / steps;
		}
	}
	const bool is_grid = distinct >= LEAST_VALUES && step > fmax(COARSE * noise, 4.0 * error);
	return is_grid && range >= LEAST_STEPS * step ? step : 0.0;
}

/* Coordinates along an axis, of some corners, and their range. */
static size_t take_values(const nt_surface *s, int axis, double values[SAMPLES], double range[2])
{
	const size_t sides = 3 * s->triangle_count, stride = (sides + SAMPLES - 1) / SAMPLES;
	size_t count = 0;
	range[0] = INFINITY;
	range[1] = -INFINITY;
	for (size_t side = 0; side < sides; side += stride) {
		const double value = nt_side_texcoord(s, side)[axis];
		if (!isfinite(value))
			continue;
		values[count++] = value;
		range[0] = fmin(range[0], value);
		range[1] = fmax(range[1], value);
	}
	return count;
}

/* Asked for once, if a triangle is so small that a grid may have turned it: values are put in order for that. */
static void find_grid(const nt_surface *s, nt_texcoord_grid *grid)
{
	for (int axis = 0; axis < 2 && !grid->asked; axis++) {
		double values[SAMPLES];
		const size_t count = take_values(s, axis, values, grid->range[axis]);
		/* of a difference: of two values, each made by two roundings to float */
		grid->noise[axis] = 0x1p-22 * fmax(fabs(grid->range[axis][0]), fabs(grid->range[axis][1]));
		grid->step[axis] = find_step(values, count, grid->noise[axis]);
	}
	grid->asked = true;
}

nt_texcoord_grid nt_texcoord_grid_of(const nt_surface *s)
{
	nt_texcoord_grid grid = {.asked = false};
	for (int axis = 0; axis < 2; axis++) {
		double values[SAMPLES];
		take_values(s, axis, values, grid.range[axis]);
	}
	return grid;
}

/*
 * On a grid each coordinate has moved by up to half a step. To first order the determinant, by that of a corner in u,
 * moves by half a step times the difference in v of both others; of all three corners that is a step times the
 * triangle's height along v, and u alike. So its height over its longest side is at most the root of two steps.
 */
bool nt_may_be_turned(const nt_surface *s, nt_texcoord_grid *grid, size_t t)
{
	const double determinant = 2.0 * nt_uv_area(s, t);
	double size[2], error = 0.0;
	const float *const uv[3] = {nt_side_texcoord(s, 3 * t), nt_side_texcoord(s, 3 * t + 1),
		nt_side_texcoord(s, 3 * t + 2)};
	if (nt_is_sliver(s, t))
		return true;
	for (int axis = 0; axis < 2; axis++)
		size[axis] = fmax(uv[0][axis], fmax(uv[1][axis], uv[2][axis])) -
			fmin(uv[0][axis], fmin(uv[1][axis], uv[2][axis]));
	for (int axis = 0; axis < 2; axis++)
		error += (grid->range[axis][1] - grid->range[axis][0]) / LEAST_STEPS * size[1 - axis];
	if (!(determinant <= error))
		return false;
	find_grid(s, grid);
	error = 0.0;
	for (int axis = 0; axis < 2; axis++) {
		bool lies = grid->step[axis] > 0.0;
		for (int k = 0; k < 3 && lies; k++) {
			const double all = uv[k][axis] - grid->range[axis][0];
			lies = fabs(all - round(all / grid->step[axis]) * grid->step[axis]) <= grid->noise[axis];
		}
		error += lies ? grid->step[axis] * size[1 - axis] : 0.0;
	}
	return determinant <= error;
}

static bool is_same_position(const float *a, const float *b)
{
	return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

static nt_flatness flatness_of(const float *a, const float *b, const float *c, double area)
{
	if (!isfinite(area))
		return NT_NOT_FINITE;
	if (area > 0.0)
		return NT_SOUND;
	return is_same_position(a, b) || is_same_position(b, c) || is_same_position(c, a)
		? NT_COINCIDENT : NT_COLLINEAR;
}

static void measure_triangle(nt_surface *s, size_t t, nt_block *block)
{
	/* of a texture transform the exact sign, not that of its rounded result */
	const bool exact = s->mesh->solve_texcoords && s->mesh->solve_sign;
	const float *signs = exact ? s->mesh->texcoords : s->texcoords, *shown = s->mesh->texcoords;
	size_t v[3];
	const float *p[3];
	for (size_t k = 0; k < 3; k++) {
		v[k] = nt_side_vertex(s, 3 * t + k);
		p[k] = s->mesh->positions + 3 * v[k];
		nt_box_add(&block->box, p[k]);
		if (shown)
			nt_range_add(block->minimum, block->maximum, shown + 2 * v[k]);
	}
	const double area = area_of(p[0], p[1], p[2]);
	s->flatness[t] = (uint8_t)flatness_of(p[0], p[1], p[2], area);
	s->orientation[t] = 0;
	if (signs)
		s->orientation[t] = (int8_t)(nt_orientation(signs + 2 * v[0], signs + 2 * v[1], signs + 2 * v[2]) *
			(exact ? s->mesh->solve_sign : 1));
	block->triangles[s->orientation[t] + 1]++;
	block->areas[s->orientation[t] + 1] += isfinite(area) ? area : 0.0;
}

/* A triangle whose vertices are asked for so many triangles later: they may lie anywhere. */
static void prefetch_triangle(const nt_surface *s, size_t t)
{
	for (size_t k = 0; k < 3; k++) {
		const size_t v = nt_side_vertex(s, 3 * t + k);
		__builtin_prefetch(s->mesh->positions + 3 * v);
		if (s->texcoords)
			__builtin_prefetch(s->texcoords + 2 * v);
		if (s->mesh->normals)
			__builtin_prefetch(s->mesh->normals + 3 * v);
	}
}

void nt_surface_measure(nt_surface *s, size_t b)
{
	nt_block block = {.box = nt_box_empty(), .minimum = {INFINITY, INFINITY}, .maximum = {-INFINITY, -INFINITY}};
	for (size_t t = b * NT_BLOCK; t < nt_block_end(s, b); t++) {
		if (t + AHEAD < s->triangle_count)
			prefetch_triangle(s, t + AHEAD);
		measure_triangle(s, t, &block);
	}
	s->blocks[b] = block;
}

nt_status nt_surface_build(nt_surface *s, const nt_mesh *mesh, nt_scratch *scratch)
{
	*s = (nt_surface){.mesh = mesh, .texcoords = mesh->solve_texcoords ? mesh->solve_texcoords : mesh->texcoords};
	const nt_status status = list_triangles(s, scratch);
	if (status)
		return status;
	s->orientation = nt_scratch_alloc(scratch, s->triangle_count, sizeof *s->orientation);
	s->flatness = nt_scratch_alloc(scratch, s->triangle_count, sizeof *s->flatness);
	s->blocks = nt_scratch_alloc(scratch, nt_block_count(s), sizeof *s->blocks);
	if (!s->orientation || !s->flatness || !s->blocks)
		return NT_ERROR_MEMORY;
	return nt_surface_weld(s, scratch);
}
