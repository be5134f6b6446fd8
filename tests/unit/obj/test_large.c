/* SPDX-License-Identifier: MIT */
/*
 * The OBJ reader against a naive one: strtok, strtof and strtol line by line, which keeps what every
 * corner of every polygon is. Both must agree corner by corner, on a generated file of several chunks.
 */
#include "obj_file.h"

/* ---- the naive reader ---- */

typedef struct naive_corner {
	long v, t, n; /* from 1; 0: none */
} naive_corner;

typedef struct naive {
	float *v, *t, *n;
	size_t v_count, t_count, n_count;
	naive_corner *corners;
	size_t corner_count;
	size_t *face_sizes, *face_objects;
	size_t face_count, object_count; /* objects count from 0, the faces before the first `o` included */
} naive;

/* An array with room for one element more; it doubles. */
static void *naive_room(void *array, size_t count, size_t size)
{
	return count & (count - 1) ? array : realloc(array, (count ? 2 * count : 1) * size);
}

static void naive_floats(float **array, size_t count, int width)
{
	*array = naive_room(*array, count, (size_t)width * sizeof **array);
	for (int k = 0; k < width; k++) {
		const char *word = strtok(NULL, " \t\r");
		(*array)[count * (size_t)width + (size_t)k] = word ? strtof(word, NULL) : 0;
	}
}

static long naive_index(const char **p, size_t count)
{
	char *end;
	const long index = strtol(*p, &end, 10);
	*p = end;
	return index < 0 ? (long)count + index + 1 : index;
}

static void naive_face(naive *x)
{
	size_t size = 0;
	const char *word;
	while ((word = strtok(NULL, " \t\r"))) {
		naive_corner c = {naive_index(&word, x->v_count), 0, 0};
		if (*word == '/' && *++word != '/')
			c.t = naive_index(&word, x->t_count);
		if (*word == '/' && word++)
			c.n = naive_index(&word, x->n_count);
		x->corners = naive_room(x->corners, x->corner_count, sizeof c);
		x->corners[x->corner_count++] = c;
		size++;
	}
	if (size < 3) {
		x->corner_count -= size;
		return;
	}
	x->face_sizes = naive_room(x->face_sizes, x->face_count, sizeof *x->face_sizes);
	x->face_objects = naive_room(x->face_objects, x->face_count, sizeof *x->face_objects);
	x->face_sizes[x->face_count] = size;
	x->face_objects[x->face_count++] = x->object_count;
}

static void naive_read(naive *x, const char *bytes, size_t size)
{
	*x = (naive){0};
	char *text = malloc(size + 1), *next = text;
	memcpy(text, bytes, size);
	text[size] = '\0';
	while (next && *next) {
		char *line = next;
		next = strchr(line, '\n');
		if (next)
			*next++ = '\0';
		const char *word = strtok(line, " \t\r");
		if (!word)
			continue;
		if (strcmp(word, "v") == 0)
			naive_floats(&x->v, x->v_count++, 3);
		else if (strcmp(word, "vt") == 0)
			naive_floats(&x->t, x->t_count++, 2);
		else if (strcmp(word, "vn") == 0)
			naive_floats(&x->n, x->n_count++, 3);
		else if (strcmp(word, "f") == 0)
			naive_face(x);
		else if (strcmp(word, "o") == 0)
			x->object_count++;
	}
	free(text);
}

static void naive_free(naive *x)
{
	free(x->v);
	free(x->t);
	free(x->n);
	free(x->corners);
	free(x->face_sizes);
	free(x->face_objects);
}

/* ---- comparing ---- */

/* Whether vertex `vertex` of the mesh is what that corner says. */
static bool is_corner(const nt_mesh *mesh, uint32_t vertex, const naive *x, const naive_corner *c)
{
	const uint8_t lacks = mesh->vertex_lacks ? mesh->vertex_lacks[vertex] : 0;
	if (vertex >= mesh->vertex_count ||
		memcmp(mesh->positions + 3 * (size_t)vertex, x->v + 3 * (c->v - 1), 12) != 0)
		return false;
	const bool has_t = mesh->texcoords && !(lacks & NT_LACKS_TEXCOORD);
	const bool has_n = mesh->normals && !(lacks & NT_LACKS_NORMAL);
	if (has_t != (c->t != 0) || has_n != (c->n != 0))
		return false;
	return (!has_t || memcmp(mesh->texcoords + 2 * (size_t)vertex, x->t + 2 * (c->t - 1), 8) == 0) &&
		(!has_n || memcmp(mesh->normals + 3 * (size_t)vertex, x->n + 3 * (c->n - 1), 12) == 0);
}

/* Triangles and quads as they stand; of larger polygons the triangles use their corners, each at least
 * once, and there are two fewer than corners. */
static void assert_same(const nt_scene *scene, const naive *x)
{
	size_t source = 0, face = 0; /* of the naive reader */
	for (size_t m = 0; m < scene->mesh_count; m++) {
		const nt_mesh *mesh = &scene->meshes[m];
		size_t c = 0;
		for (size_t f = 0; f < mesh->face_count;) {
			const size_t size = x->face_sizes[face];
			assert_int_equal(x->face_objects[face], x->face_objects[face - (f ? 1 : 0)]);
			if (size <= 4) {
				assert_int_equal(mesh->face_sizes ? mesh->face_sizes[f] : 3, size);
				for (size_t k = 0; k < size; k++)
					assert_true(is_corner(mesh, mesh->indices[c + k], x, &x->corners[source + k]));
				c += size;
				f++;
			} else {
				for (size_t k = 0; k < size; k++) {
					size_t i = 0;
					while (i < 3 * (size - 2) &&
						!is_corner(mesh, mesh->indices[c + i], x, &x->corners[source + k]))
						i++;
					assert_true(i < 3 * (size - 2));
				}
				c += 3 * (size - 2);
				for (size_t k = 0; k < size - 2; k++)
					assert_int_equal(mesh->face_polygon[f + k], mesh->face_polygon[f]);
				f += size - 2;
			}
			source += size;
			face++;
		}
		assert_int_equal(c, mesh->corner_count);
		/* first uses are in order */
		uint32_t used = 0;
		for (size_t i = 0; i < mesh->corner_count && !mesh->face_polygon; i++) {
			assert_true(mesh->indices[i] <= used);
			used += mesh->indices[i] == used;
		}
		assert_true(mesh->face_polygon || used == mesh->vertex_count);
	}
	assert_int_equal(face, x->face_count);
}

static int compare_corners(const void *a, const void *b)
{
	return memcmp(a, b, 3 * sizeof(long));
}

/* How many different v/t/n each object's faces have, summed up. */
static size_t count_distinct(const naive *x)
{
	naive_corner *sorted = malloc((x->corner_count + 1) * sizeof *sorted);
	size_t total = 0, corner = 0;
	for (size_t f = 0; f < x->face_count;) {
		const size_t object = x->face_objects[f], first = corner;
		for (; f < x->face_count && x->face_objects[f] == object; f++)
			corner += x->face_sizes[f];
		memcpy(sorted, x->corners + first, (corner - first) * sizeof *sorted);
		qsort(sorted, corner - first, sizeof *sorted, compare_corners);
		for (size_t i = 0; i < corner - first; i++)
			total += i == 0 || compare_corners(&sorted[i], &sorted[i - 1]) != 0;
	}
	free(sorted);
	return total;
}

static void assert_agrees(const char *bytes, size_t size)
{
	reading r;
	naive x;
	open_bytes(&r, bytes, size, 1);
	if (r.status)
		print_message("line %zu: %s\n", r.error.place.line, r.error.message);
	assert_int_equal(r.status, NT_OK);
	naive_read(&x, bytes, size);
	assert_same(&r.scene, &x);
	size_t vertices = 0;
	for (size_t m = 0; m < r.scene.mesh_count; m++)
		vertices += r.scene.meshes[m].vertex_count;
	assert_int_equal(vertices, count_distinct(&x));
	naive_free(&x);
	close_reading(&r);
}

/* ---- the generated file ---- */

static uint32_t seed = 1;

static uint32_t below(uint32_t limit)
{
	seed = seed * 1664525u + 1013904223u;
	return (uint32_t)(((uint64_t)seed * limit) >> 32);
}

static size_t put_index(char *to, size_t count)
{
	const uint32_t index = 1 + below((uint32_t)count);
	const bool near = below(4) == 0;
	if (near && count > 50)
		return (size_t)sprintf(to, "-%u", 1 + index % 50);
	return (size_t)sprintf(to, "%u", below(3) ? (uint32_t)(count - index % (count < 40 ? count : 40)) : index);
}

/* About 4 MB: vertices and faces mixed, objects of all sizes, materials and smoothing groups, corners
 * of every form, polygons up to 7 corners, a hub of 3000 vt at v 1, and one polygon of 400. */
static char *generate(size_t *size)
{
	char *text = malloc(12 << 20);
	size_t used = 0, v = 0, t = 0, n = 0;
	for (int i = 0; i < 40000; i++) {
		used += (size_t)sprintf(text + used, "v %.6f %.9g %.17g\nvt %.7f %.3f\n", below(2000000) / 1e6 - 1,
			below(2000000) / 1e3, below(2000000) / 3e6, below(1000) / 999.0, below(1000) / 1e3);
		v++, t++;
		if (i % 3 == 0)
			used += (size_t)sprintf(text + used, "vn %d %.2f 1e-%d\n", (int)below(3) - 1,
				below(100) / 100.0, (int)below(9)), n++;
		if (i < 10)
			continue;
		if (below(300) == 0)
			used += (size_t)sprintf(text + used, "o object %d\n", i);
		if (below(50) == 0)
			used += (size_t)sprintf(text + used, "usemtl m%u\ns %u\n", below(5), below(3));
		if (i % 20 == 0)
			used += (size_t)sprintf(text + used, "f 1/%d/1 2 3\n# %d\n", i / 20 + 1, i);
		for (int k = 0; k < 2; k++) {
			const uint32_t corners = 2 + below(6);
			used += (size_t)sprintf(text + used, "f");
			for (uint32_t c = 0; c < corners; c++) {
				const uint32_t form = below(4);
				text[used++] = ' ';
				used += put_index(text + used, v);
				if (form)
					text[used++] = '/';
				if (form & 1)
					used += put_index(text + used, t);
				if (form & 2) {
					text[used++] = '/';
					used += put_index(text + used, n);
				}
			}
			used += (size_t)sprintf(text + used, "%s\n", below(9) ? "" : " \r");
		}
		if (i == 30000) {
			used += (size_t)sprintf(text + used, "f");
			for (int c = 0; c < 400; c++)
				used += (size_t)sprintf(text + used, " %d", 29000 + c);
			used += (size_t)sprintf(text + used, "\n");
		}
	}
	*size = used;
	return text;
}

TEST(generated_file_agrees_with_the_naive_reader)
{
	size_t size;
	char *text = generate(&size);
	assert_true(size > 3u << 20);
	assert_agrees(text, size);
	free(text);
}

static void assert_same_array(const void *a, const void *b, size_t size)
{
	assert_int_equal(a != NULL, b != NULL);
	if (a)
		assert_memory_equal(a, b, size);
}

static void assert_same_scene(const nt_scene *a, const nt_scene *b)
{
	assert_int_equal(a->mesh_count, b->mesh_count);
	assert_int_equal(a->material_count, b->material_count);
	for (size_t m = 0; m < a->mesh_count; m++) {
		const nt_mesh *p = &a->meshes[m], *q = &b->meshes[m];
		assert_string_equal(p->name, q->name);
		assert_int_equal(p->line, q->line);
		assert_int_equal(p->vertex_count, q->vertex_count);
		assert_int_equal(p->face_count, q->face_count);
		assert_int_equal(p->corner_count, q->corner_count);
		assert_same_array(p->positions, q->positions, 12 * p->vertex_count);
		assert_same_array(p->normals, q->normals, 12 * p->vertex_count);
		assert_same_array(p->texcoords, q->texcoords, 8 * p->vertex_count);
		assert_same_array(p->vertex_lacks, q->vertex_lacks, p->vertex_count);
		assert_same_array(p->face_sizes, q->face_sizes, p->face_count);
		assert_same_array(p->indices, q->indices, 4 * p->corner_count);
		assert_same_array(p->face_polygon, q->face_polygon, 4 * p->face_count);
		assert_same_array(p->face_smoothing, q->face_smoothing, 4 * p->face_count);
		assert_same_array(p->face_primitive, q->face_primitive, 4 * p->face_count);
		assert_int_equal(p->primitive_count, q->primitive_count);
		for (size_t i = 0; i < p->primitive_count; i++) {
			assert_int_equal(p->primitives[i].material, q->primitives[i].material);
			assert_int_equal(p->primitives[i].face_count, q->primitives[i].face_count);
		}
	}
	assert_int_equal(a->findings.count, b->findings.count);
	for (size_t i = 0; i < a->findings.count; i++) {
		assert_string_equal(a->findings.items[i].detail, b->findings.items[i].detail);
		assert_int_equal(a->findings.items[i].count, b->findings.items[i].count);
		assert_int_equal(a->findings.items[i].place.line, b->findings.items[i].place.line);
	}
}

TEST(threads_do_not_show)
{
	size_t size;
	char *text = generate(&size);
	reading one, many;
	open_bytes(&one, text, size, 1);
	assert_int_equal(one.status, NT_OK);
	const unsigned threads[] = {2, 3, 8};
	for (int i = 0; i < 3; i++) {
		open_bytes(&many, text, size, threads[i]);
		assert_int_equal(many.status, NT_OK);
		assert_same_scene(&one.scene, &many.scene);
		close_reading(&many);
	}
	close_reading(&one);
	free(text);
}

/* Faults in several chunks: the first in the file is named, by every number of threads. */
TEST(the_first_fault_is_named_whatever_the_threads)
{
	size_t size;
	char *text = generate(&size);
	const size_t at[3] = {size - 100000, size - (2u << 20), (1u << 20) + 5000};
	size_t expected = 1;
	for (int k = 0; k < 3; k++) {
		char *line = strchr(text + at[k], '\n') + 1;
		*line = '\x01';
		if (k == 2)
			for (const char *p = text; p < line; p++)
				expected += *p == '\n';
	}
	for (unsigned threads = 1; threads <= 8; threads += threads) {
		reading r;
		open_bytes(&r, text, size, threads);
		assert_int_equal(r.status, NT_ERROR_INPUT);
		assert_int_equal(r.error.place.line, expected);
		close_reading(&r);
	}
	free(text);
}

/* One v whose 100 000 corners all differ: the links behind a v end where a hash table begins. */
TEST(hub_of_different_corners_is_not_quadratic)
{
	char *text = malloc(8 << 20);
	size_t used = (size_t)sprintf(text, "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
	for (int i = 0; i < 100000; i++)
		used += (size_t)sprintf(text + used, "vt %d 0\n", i);
	for (int round = 0; round < 2; round++)
		for (int i = 1; i <= 100000; i++)
			used += (size_t)sprintf(text + used, "f 1/%d 2/1 3/1\n", i);
	reading r;
	open_bytes(&r, text, used, 2);
	assert_int_equal(r.status, NT_OK);
	assert_int_equal(r.scene.meshes[0].vertex_count, 100002);
	const uint32_t *indices = r.scene.meshes[0].indices;
	for (uint32_t i = 0; i < 100000; i++) {
		assert_int_equal(indices[3 * i], i ? i + 2 : 0);
		assert_int_equal(indices[3 * (100000 + i)], indices[3 * i]);
	}
	close_reading(&r);
	free(text);
}

/* A line longer than a chunk, and a chunk whose every line is joined to the next. */
TEST(lines_longer_than_a_chunk)
{
	char *text = malloc(8 << 20);
	size_t used = (size_t)sprintf(text, "v 0 0 0\nv 1 0 0\nv 0 1 0\n#");
	memset(text + used, 'x', 3 << 20);
	used += 3 << 20;
	used += (size_t)sprintf(text + used, "\nf 1");
	for (int i = 0; i < 400000; i++)
		used += (size_t)sprintf(text + used, " \\\n%s", i == 200000 ? "2" : "");
	used += (size_t)sprintf(text + used, " 3\nf 3 2 1");
	for (unsigned threads = 1; threads <= 2; threads++) {
		reading r;
		open_bytes(&r, text, used, threads);
		assert_int_equal(r.status, NT_OK);
		assert_int_equal(r.scene.meshes[0].face_count, 2);
		close_reading(&r);
	}
	used += (size_t)sprintf(text + used, " x");
	reading r;
	open_bytes(&r, text, used, 2);
	assert_int_equal(r.status, NT_ERROR_INPUT);
	assert_int_equal(r.error.place.line, 4 + 1 + 400000 + 1);
	close_reading(&r);
	free(text);
}
