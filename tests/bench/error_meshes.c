/* SPDX-License-Identifier: MIT */
/* See error_meshes.h. */
#include "error_meshes.h"

#include <math.h>
#include <string.h>
#include "soup.h"

enum { FINE = 128, MOST_FACES = 20000 };

static const double SHEAR = 4.0 / 3;
static const double JITTER = 0.25; /* cells: regular grids hide the error of one side behind the other's */

static void set_vertex(nt_owned *o, size_t v, const double p[3], const double n[3], double u, double w)
{
	for (int i = 0; i < 3; i++) {
		o->positions[v][i] = (float)p[i];
		o->normals[v][i] = (float)n[i];
	}
	o->texcoords[v][0] = (float)u;
	o->texcoords[v][1] = (float)w;
}

nt_owned bench_bevel(double width, uint32_t cells)
{
	const uint32_t columns = 2 * cells + 1, rows = cells;
	nt_owned o = nt_owned_make((size_t)(columns + 1) * (rows + 1), (size_t)columns * rows * 2);
	const double down = width / sqrt(2);
	for (uint32_t y = 0; y <= rows; y++) {
		for (uint32_t x = 0; x <= columns; x++) {
			const size_t v = (size_t)y * (columns + 1) + x;
			const double along = (double)y / cells;
			if (x <= cells) {
				const double s = (double)x / cells;
				set_vertex(&o, v, (double[3]){s, along, 0}, (double[3]){0, 0, 1}, s, along);
				o.truth[v][0] = 1;
			} else {
				const double s = (double)(x - cells - 1) / cells;
				set_vertex(&o, v, (double[3]){1 + down, along, -down - s}, (double[3]){1, 0, 0},
					1 + width + s, along + SHEAR * width);
			}
		}
	}
	uint32_t *to = o.indices;
	for (uint32_t y = 0; y < rows; y++) {
		for (uint32_t x = 0; x < columns; x++) {
			const uint32_t a = y * (columns + 1) + x, b = a + 1, d = a + columns + 1, c = d + 1;
			memcpy(to, (uint32_t[6]){a, b, c, a, c, d}, 6 * sizeof *to);
			to += 6;
		}
	}
	return o;
}

static nt_owned read_head(void)
{
	soup s = soup_read_obj(NT_DATA_DIR "/head.obj", MOST_FACES);
	soup_indexed indexed = soup_index(&s);
	size_t triangles = 0;
	for (size_t f = 0; f < s.face_count; f++)
		triangles += s.sizes[f] - 2u;
	nt_owned o = nt_owned_make(indexed.mesh.vertex_count, triangles);
	memcpy(o.positions, indexed.positions, indexed.mesh.vertex_count * sizeof *o.positions);
	memcpy(o.normals, indexed.normals, indexed.mesh.vertex_count * sizeof *o.normals);
	memcpy(o.texcoords, indexed.texcoords, indexed.mesh.vertex_count * sizeof *o.texcoords);
	uint32_t *to = o.indices;
	for (size_t f = 0, first = 0; f < s.face_count; first += s.sizes[f++]) {
		for (size_t k = 2; k < s.sizes[f]; k++) {
			*to++ = indexed.indices[first];
			*to++ = indexed.indices[first + k - 1];
			*to++ = indexed.indices[first + k];
		}
	}
	soup_indexed_free(&indexed);
	soup_free(&s);
	return o;
}

void bench_meshes_make(bench_mesh meshes[BENCH_MESH_COUNT])
{
	for (int i = 0; i < NT_SURFACE_COUNT; i++)
		meshes[i] = (bench_mesh){nt_surface_names[i],
			nt_surface_grid((nt_surface)i, FINE, FINE, JITTER, 1), true, false};
	meshes[5] = (bench_mesh){"bevel", bench_bevel(0.01, 64), false, false};
	meshes[6] = (bench_mesh){"head", read_head(), false, false};
	meshes[7] = (bench_mesh){"eye-torus", nt_surface_grid(NT_TORUS, 32, 20, 0, 1), false, true};
	meshes[8] = (bench_mesh){"eye-bevel", bench_bevel(0.02, 8), false, true};
}

void bench_meshes_free(bench_mesh meshes[BENCH_MESH_COUNT])
{
	for (int i = 0; i < BENCH_MESH_COUNT; i++)
		nt_owned_free(&meshes[i].mesh);
}

bool bench_frame_at(const bench_mesh *mesh, const double uv[2], double t[3], double n[3])
{
	if (strcmp(mesh->name, "eye-torus") == 0) {
		const nt_surface_point point = nt_surface_at(NT_TORUS, uv[0], uv[1]);
		memcpy(t, point.t, sizeof point.t);
		memcpy(n, point.n, sizeof point.n);
		return true;
	}
	memcpy(t, (double[3]){1, 0, 0}, 24);
	memcpy(n, (double[3]){0, 0, 1}, 24);
	return uv[0] <= 1.0;
}
