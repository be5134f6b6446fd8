/* SPDX-License-Identifier: MIT */
/*
 * Functions that JavaScript calls, in a module of its own memory. core.js puts a job's arrays into this memory,
 * tightly packed, and takes the results out of it. One thread.
 */
#include <stdint.h>
#include "base/hash.h"
#include "nmtan.h"

/* Words of 32 bits in this order: core.js writes and reads them by their number. */
typedef struct nt_wasm_job {
	size_t face_count;
	size_t vertex_count;
	const uint32_t *indices; /* [corner count]; NULL: corner c is vertex c */
	const float *positions, *normals, *texcoords;
	const uint8_t *face_sizes; /* [face_count]; NULL: triangles */
	uint32_t *split_indices; /* [corner count] */
	uint32_t *sources;       /* [source_capacity] */
	size_t source_capacity;
	float *tangents;         /* [vertex_count + source_capacity][4], or of corners */
	float *bitangents;       /* of corners, or NULL */
	uint8_t *corner_faults;  /* of corners, or NULL */
	uint32_t method, repair; /* nmtan_method, nmtan_repair */
	uint32_t v_down;
	float angular_threshold_degrees;
	size_t source_count;     /* written */
	nmtan_counts counts;     /* written */
} nt_wasm_job;

static nt_wasm_job job;

/* The one job, whose arrays the caller allocates. */
__attribute__((export_name("job"))) nt_wasm_job *nt_wasm_get_job(void)
{
	return &job;
}

/* The key of tables: core.js gives random numbers before the first job, since the module imports nothing. */
__attribute__((export_name("set_key"))) void nt_wasm_set_key(uint32_t a, uint32_t b, uint32_t c, uint32_t d)
{
	nt_hash_key_words[0] = (uint64_t)a << 32 | b;
	nt_hash_key_words[1] = (uint64_t)c << 32 | d | 1; /* not 0: there is a key */
}

static nmtan_mesh job_mesh(void)
{
	nmtan_mesh mesh = NMTAN_MESH_INIT;
	mesh.face_count = job.face_count;
	mesh.vertex_count = job.vertex_count;
	mesh.indices = job.indices;
	mesh.face_sizes = job.face_sizes;
	mesh.v_down = job.v_down;
	mesh.positions = job.positions;
	mesh.normals = job.normals;
	mesh.texcoords = job.texcoords;
	return mesh;
}

static nmtan_options job_options(void)
{
	nmtan_options options = NMTAN_OPTIONS_INIT;
	options.method = (nmtan_method)job.method;
	options.repair = (nmtan_repair)job.repair;
	options.angular_threshold_degrees = job.angular_threshold_degrees;
	options.threads = 1;
	return options;
}

/* A tangent for each corner, into job.tangents. */
__attribute__((export_name("corner_tangents"))) nmtan_status nt_wasm_corner_tangents(void)
{
	const nmtan_mesh mesh = job_mesh();
	const nmtan_options options = job_options();
	nmtan_output output = NMTAN_OUTPUT_INIT;
	output.tangents = job.tangents;
	output.bitangents = job.bitangents;
	output.corner_faults = job.corner_faults;
	job.counts = (nmtan_counts)NMTAN_COUNTS_INIT;
	return nmtan_tangents(&mesh, &options, &output, &job.counts);
}

/* A tangent for each vertex, and vertices where one is not enough. */
__attribute__((export_name("vertex_tangents"))) nmtan_status nt_wasm_vertex_tangents(void)
{
	const nmtan_mesh mesh = job_mesh();
	const nmtan_options options = job_options();
	nmtan_split_output output = NMTAN_SPLIT_OUTPUT_INIT;
	output.indices = job.split_indices;
	output.sources = job.sources;
	output.source_capacity = job.source_capacity;
	output.vertex_tangents = job.tangents;
	job.counts = (nmtan_counts)NMTAN_COUNTS_INIT;
	const nmtan_status status = nmtan_vertex_tangents(&mesh, &options, &output, &job.counts);
	job.source_count = output.source_count;
	return status;
}
