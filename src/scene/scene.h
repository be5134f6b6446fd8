/* SPDX-License-Identifier: MIT */
/*
 * The scene: what readers fill, stages annotate and writers store.
 *
 * A mesh is the unit that is solved: faces of 3 or 4 corners over one set of vertices. An OBJ gives one
 * mesh per object, with a primitive per material; a PLY gives one mesh with one primitive; in glTF
 * every primitive is a mesh of its own, because glTF defines tangents per primitive.
 *
 * Reading goes in two steps, so that nothing is decoded in vain: a reader's open() describes the meshes
 * (names, materials, which attributes exist), select.c decides which need tangents, load() brings their
 * geometry. Text formats do all of it in open().
 */
#ifndef NT_SCENE_SCENE_H
#define NT_SCENE_SCENE_H

#include "base/memory.h"
#include "base/text.h"
#include "scene/finding.h"
#include "scene/format.h"

#define NT_NONE UINT32_MAX

/* Demands of a material or its glTF extensions on tangents: docs in scene/select.c. */
enum nt_slot {
	NT_SLOT_NORMAL = 1,           /* normalTexture */
	NT_SLOT_CLEARCOAT_NORMAL = 2, /* KHR_materials_clearcoat.clearcoatNormalTexture */
	NT_SLOT_ANISOTROPY = 4        /* KHR_materials_anisotropy, with or without a texture */
};

/* How a sampler takes coordinates outside of 0 to 1, along u or v. TILES: each tile has an image of its own (UDIM). */
typedef enum nt_wrap { NT_WRAP_REPEAT, NT_WRAP_MIRRORED, NT_WRAP_CLAMP, NT_WRAP_TILES } nt_wrap;

/* Whether a mesh gets tangents, and why. */
typedef enum nt_decision {
	NT_DECISION_OPEN,            /* not decided yet */
	NT_DECISION_SOLVE,           /* tangents are computed */
	NT_DECISION_REPAIR,          /* authored tangents are kept where they are valid */
	NT_DECISION_NORMALS,         /* of a glTF, normals alone are made */
	NT_SKIP_NO_SLOT,             /* no material of it uses tangents */
	NT_SKIP_UNLIT,
	NT_SKIP_NOT_TRIANGLES,       /* points or lines */
	NT_SKIP_EMPTY,               /* no faces */
	NT_SKIP_UNREACHABLE,         /* in no scene */
	NT_SKIP_NO_TEXCOORDS,
	NT_SKIP_NO_NORMALS,
	NT_SKIP_HAS_TANGENTS,        /* and --existing=keep */
	NT_SKIP_DROPPED,             /* has tangents that no material uses, and --existing=drop: they go */
	NT_DECISION_COUNT
} nt_decision;

/* Placement of an image: it is sampled at scale * (u, v) + offset, v up. */
typedef struct nt_placement {
	bool moved;                  /* else scale counts as 1 and offset as 0 */
	float scale[2], offset[2];   /* finite */
	bool clamp;                  /* beyond 0 to 1 its border goes on; else it repeats */
} nt_placement;

/* A map of a material. One channel of a map of numbers counts (red unless stated otherwise): with v from 0
 * to 1 the number is factor * (base + gain * v), or factor * the roughness of the exponent * (base + gain * v). */
typedef struct nt_map {
	const char *name;            /* of the file, as the source spells it; NULL: there is no map */
	size_t line;                 /* where that stands in `library` */
	nt_placement placement;
	uint32_t request;            /* in nt_write_options.textures, filled by the pipeline; NT_NONE: none */
	char channel;                /* 'r', 'g', 'b', 'm' (alpha), 'l' (luminance); 0: nobody says */
	float base, gain;            /* colours: for each channel */
	float exponent;              /* 0: it is no map of exponents */
	float factor;
	bool given;                  /* the user named the file: its name is a path as any */
} nt_map;

/* A map whose samples themselves are meant. */
static inline nt_map nt_map_of(const char *name)
{
	return (nt_map){.name = name, .gain = 1};
}

/* Whether they are. */
static inline bool nt_map_is_plain(const nt_map *map)
{
	return map->base == 0 && map->gain == 1;
}

enum { NT_MATERIAL_MAPS = 10 };

/* A material as OBJ has it, in glTF's terms; the numbers are those without maps. File names are relative to the folder
 * of the file in `library`. */
typedef struct nt_material {
	const char *name;
	const char *library;         /* path of the MTL file; NULL: none */
	size_t line;                 /* of its newmtl */
	float base_color[4];         /* linear factors, and alpha */
	float emissive[3];           /* also above 1 */
	float metallic, roughness;   /* glTF's default for OBJ is 0 and 1 */
	float clearcoat, clearcoat_roughness;
	float sheen, sheen_roughness;
	float anisotropy, anisotropy_rotation; /* in radians */
	float ior;                   /* above 1; 0: nobody says */
	float normal_scale;          /* -bm */
	union {
		struct {
			nt_map base_color_map;       /* a number of 0, of all channels, counts as 1 beside it */
			nt_map alpha_map;
			nt_map emissive_map;         /* as base_color_map */
			nt_map roughness_map, metallic_map, occlusion_map;
			nt_map clearcoat_map, clearcoat_roughness_map;
			nt_map sheen_map;
			nt_map normal_map;           /* norm, map_Kn, map_Bump, bump */
		};
		nt_map maps[NT_MATERIAL_MAPS];       /* all of these */
	};
	bool bump_is_normal;         /* who wrote it means a normal map by that: Blender */
	const char *bump;            /* the statement that normal_map came from, where it was a bump map; else NULL */
} nt_material;

/* The part of a mesh that one draw call shows. */
typedef struct nt_primitive {
	uint32_t material; /* index into scene->materials or NT_NONE */
	size_t face_count; /* faces of the mesh that belong to it */
	uint32_t group;    /* index into the mesh's groups; those of one group follow each other */
} nt_primitive;

/* A mesh as one morph target moves it at weight 1. */
typedef struct nt_morph {
	uint32_t target;        /* its number in the source */
	const char *name;       /* "" where it has none */
	const struct nt_displacement *positions, *normals; /* what is added to the base's, for nt_gltf_move(); NULL:
	                                                     nothing */
	size_t class_count, row_count, first_word; /* of its tangents then: scene/values.h */
	size_t turned_triangles;  /* that it turns to the other side of their normals: no w serves them with and
	                             without it */
	size_t halfway_triangles; /* where adding half of the deltas is wrong by more than 5 degrees */
	double halfway_degrees;   /* by how much at most */
} nt_morph;

/* Delta of a morph target's component; never -0, so that tangents which were read back give the same bytes. */
static inline float nt_morph_delta(float moved, float base)
{
	return moved - base + 0.0f;
}

/* Results of a split: copies to append behind the mesh's vertices. */
typedef struct nt_split {
	uint32_t *indices;      /* [mesh corner_count]; NULL: the mesh's own, nothing was split */
	uint32_t *sources;      /* [source_count] vertex each appended one is a copy of */
	size_t source_count;
	float *vertex_tangents; /* [vertex_count + source_count][4] */
} nt_split;

/* Primitives of one glTF mesh with the same texture coordinates and the same texture transform, in their order. */
typedef struct nt_join {
	struct nt_mesh **parts; /* [part_count] at least two: meshes of the scene that get tangents (or whose kept
	                           ones are checked), and copies of others, which the join alone has */
	size_t part_count;
	struct nt_mesh *first;  /* the first of them that gets tangents */
	bool *moves;            /* [target_count] morph targets that move any of them */
	size_t target_count;
} nt_join;

/* Whether a mesh is loaded and solved as a decoder of Draco will have it, since it will be compressed. */
typedef enum nt_quantized {
	NT_QUANTIZED_NOT,
	NT_QUANTIZED,
	NT_QUANTIZED_WHOLE /* if faces use all vertices of its block: otherwise it cannot be compressed again */
} nt_quantized;

/* The decision about a mesh, found before anything is loaded: reader, stages and writer keep to it. */
typedef struct nt_mesh_plan {
	const struct nt_mesh *same_as; /* an earlier mesh with the same geometry, which is loaded and solved once;
	                                  NULL: none. That one has none */
	const nt_join *join;     /* it is solved with the others of it; NULL: by itself */
	bool copied;             /* a copy of a mesh that a join has, and nobody else */
	nt_quantized quantized;
	bool disposable;         /* its geometry may go once it is solved: an edit of the source's document needs
	                            nothing but the results */
	bool pooled;             /* others have its vertices and other triangles: it is loaded with the vertices that
	                            it uses */
	bool temporary;          /* what it holds lies in scene->temporary, and is gone once the writer has merged it */
} nt_mesh_plan;

/* Whether w of authored tangents is that of the texture coordinates. */
typedef enum nt_signs {
	NT_SIGN_OPEN,     /* nobody has looked, or there are none */
	NT_SIGN_NONE,     /* no triangle says */
	NT_SIGN_RIGHT,    /* of some triangles at least */
	NT_SIGN_INVERTED  /* of none, but for slivers, and T is not reversed as well */
} nt_signs;

/* Faults of tangents that are kept: triangles whose bitangent runs the wrong way, whose corners differ in w, and that
 * say, without those that differ; tangents that no renderer can use. */
typedef struct nt_kept {
	size_t wrong, mixed, judged, bad;
} nt_kept;

/* Why it is not known whether a normal map cancels inverted w. */
typedef enum nt_doubt { NT_DOUBT_NONE, NT_DOUBT_UNEXAMINED, NT_DOUBT_UNDECODABLE } nt_doubt;

/* The end of a finding about inverted w. */
static inline const char *nt_doubt_text(nt_doubt doubt)
{
	static const char *const texts[] = {"",
		"; if green points down in its normal map, which was not examined, the two cancel",
		"; if green points down in its normal map, which cannot be decoded here, the two cancel"};
	return texts[doubt];
}

/* A normal map of a mesh, as far as it was examined. */
typedef struct nt_mesh_map {
	uint32_t number; /* one more than which of the scene's; 0: there is none, or it is not known */
	uint32_t image;  /* of the glTF */
	uint8_t green;   /* nt_green of image/image.h */
	bool examined, decodable; /* it was decoded; it could be */
	bool turnable;   /* --flip-green turns it */
} nt_mesh_map;

typedef struct nt_mesh {
	/* what it is called and where it stands */
	const char *name;     /* object or mesh name; "" where there is none */
	const char *file;     /* where it is, and its line there; NULL and 0: not known */
	size_t line;
	uint32_t gltf_mesh;      /* indices in the source document, NT_NONE elsewhere */
	uint32_t gltf_primitive;
	bool has_siblings;       /* its glTF mesh has other primitives */
	uint32_t gltf_material;  /* NT_NONE: none */
	const char *gltf_material_name; /* NULL: none */

	/* what decides: filled by open() */
	unsigned slots;          /* enum nt_slot, union over materials and variants */
	bool lost_map;           /* a material of an OBJ names a normal map that the output has not: no slot of it */
	bool triangles;          /* false: points or lines */
	bool reachable;          /* false: no scene shows it */
	bool unlit;              /* every material of it is unlit */
	bool has_positions, has_normals, has_texcoords, has_tangents; /* texcoords: the set that is used */
	const char *tangents_fault; /* why the tangents that it has cannot be read; NULL: they can */
	uint32_t texcoord_set;   /* number of that set */
	bool untextured;         /* it is a glTF's, and no texture of its materials is looked up with that set */
	const char *asked_set;   /* the set that --uv asks for is not there, others are: a sentence; NULL */
	nt_wrap wrap[2];         /* along u and v, of the texture that tangents serve */
	float wrap_offset[2];    /* of its transform, v up, where it is mirrored: elsewhere an offset moves all alike */
	const struct nt_uv_transform *transform; /* what turns or scales that set; NULL: nothing (scene/values.h) */
	bool texcoords_transformed; /* textures may be looked up elsewhere than the set says: glTF's texture
	                               transforms */
	bool compressed;         /* with Draco */
	bool has_polygons;       /* FB_ngon_encoding: triangles that follow each other with one first index are one */
	bool transforms_differ;  /* slots or materials turn that set in several ways */
	bool transform_animated; /* an animation turns it */
	bool texcoord_conflict;  /* another slot of it asks for another set: texcoord_other_set */
	uint32_t texcoord_other_set;
	uint32_t moving_targets; /* morph targets that move its positions or normals */
	uint32_t targets_without_tangents; /* of them those that have no TANGENT */
	uint8_t fix;             /* nt_existing of this mesh, whatever --only and --existing say; 0: theirs */
	bool keeps_inverted;     /* w is inverted and stays so in what is repaired: a normal map cancels it, or may */
	nt_decision decision;
	nt_mesh_plan plan;

	/* what tangents and normal maps are together: pipeline/pairs.c */
	nt_signs signs;
	nt_kept kept;            /* of tangents that stay */
	nt_mesh_map normal_maps[2]; /* the normal map, and that of the clearcoat */
	uint32_t pair;           /* number of a pair that it is in: its w and its maps are inverted; 0: none */
	nt_doubt doubt;          /* w is inverted, and a map that is not known may be, too */

	bool ready;              /* load() only reads what the scene holds: several may be loaded at once */

	/* geometry: filled by load(). Arrays belong to the scene's arena or point into the input. */
	size_t vertex_count;
	uint32_t *pool_vertices; /* [source_vertex_count] of a pooled mesh: the source's number of each vertex,
	                            ascending; NULL: the source's own numbers */
	size_t unused_vertices;  /* then: vertices of the source that it does not use */
	size_t vertex_bytes;     /* of a vertex with all its attributes and a tangent, as it is stored; 0: not known */
	float *positions;        /* [vertex_count][3] */
	double *exact_positions; /* [source_vertex_count][3] as the source has them, if positions are relative to an
	                            origin and the output is in the world; else NULL */
	float *normals;          /* [vertex_count][3]; NULL: none */
	float *solve_normals;    /* [vertex_count][3] of unit length: what tangents are made for, if normals are
	                            not and stay; NULL: normals themselves */
	float *stored_normals;   /* [vertex_count][3] integers before they were made unit: what targets add to; NULL:
	                            normals themselves */
	size_t scaled_normals;   /* normals that were made unit, there or in their place */
	size_t replaced_normals; /* and those whose normal has no direction */
	float *texcoords;        /* [vertex_count][2], v up; NULL: none */
	float *solve_texcoords;  /* [vertex_count][2] as a texture transform turns and scales them: what
	                            tangents follow; NULL: texcoords themselves */
	int solve_sign;          /* of that transform's determinant; 0 also where there is none */
	float *colors;           /* [vertex_count][4] linear RGBA; NULL: none */
	float *tangents;         /* [vertex_count][4] authored, w for v up; NULL: none */
	bool byte_tangents;      /* they are stored as bytes: within half a degree */
	float tangent_step;      /* of Draco's grid that they lie on; 0: they are stored as they are */
	float tangent_margin;    /* largest change of a kept tangent's component when it is quantized */
	uint8_t *vertex_lacks;   /* [vertex_count] enum nt_lack bits; NULL: nothing lacks */
	size_t face_count, corner_count;
	uint8_t *face_sizes;     /* [face_count] 3 or 4; NULL: all triangles */
	uint8_t *face_diagonals; /* [face_count] where a quad is cut (nt_written_diagonal): 0 gives
	                            corners 0 1 2, 0 2 3 and 1 gives 0 1 3, 1 2 3; NULL: 0 for all, until the
	                            pipeline knows */
	uint32_t *indices;       /* [corner_count]; NULL: corner c is vertex c, or nt_mesh_left_triangles() */
	uint8_t *halves;         /* [face_count] of triangles that are solved as quads: enum nt_half of api/tangents.h;
	                            NULL: all are solved as they are */
	size_t quad_count;       /* how many quads these are */
	size_t may_be_quads;     /* quads that its triangles make although they are solved as they are, if its author's
	                            program solves quads; else 0 */
	uint32_t *face_polygon;  /* [face_count] number of the source's polygon; NULL: the face's own */
	uint32_t *face_smoothing;/* [face_count] smoothing group, 0 flat; NULL: all smooth */
	uint32_t *face_primitive;/* [face_count] index into primitives; NULL: all 0 */
	nt_primitive *primitives;
	size_t primitive_count;
	const char *const *groups; /* names of its primitives' groups, each a mesh of an output; NULL: none */
	size_t made_primitives;    /* of a new glTF that it has become; 0: it is in none */
	size_t made_copies;        /* vertices that these have more than the mesh, since two of them use one */

	/* vertices that making normals appended: vertex source_vertex_count + i is a copy of
	 * vertex_sources[i], with another normal */
	size_t source_vertex_count;
	uint32_t *vertex_sources; /* [vertex_count - source_vertex_count] */
	bool normals_made;
	size_t made_normal_corners; /* corners without a normal for which one was made */
	size_t replaced_normal_corners; /* corners that had another one */
	size_t cancelled_normal_corners; /* those of both where smooth normals cancel: they got their face's */

	nt_morph *morphs;         /* [morph_count] targets that move positions or normals; filled by load() */
	size_t morph_count;
	struct nt_morph_tangents *morph_tangents; /* once they are solved: scene/values.h; NULL: none */

	/* results */
	float *corner_tangents;   /* [corner_count][4]; NULL until solved or after split */
	nmtan_counts counts;
	size_t replaced_tangents; /* corners whose authored tangent was invalid, or is beside one that was, and is
	                             another now */
	size_t left_tangents;     /* those that stay, as a solve gives no valid one either */
	nt_split split;
	uint64_t tangents_digest; /* of split.vertex_tangents, where that is wanted; 0: not known */
	bool merged;              /* the writer has merged them with those of the meshes that share its vertices */
} nt_mesh;

/* Attributes that a vertex of an OBJ lacks although others have them. */
enum nt_lack { NT_LACKS_NORMAL = 1, NT_LACKS_TEXCOORD = 2 };

/* A mesh placed in the world; OBJ and PLY place each mesh once, with the identity. */
typedef struct nt_instance {
	uint32_t mesh;
	double matrix[16]; /* column-major, as in glTF */
} nt_instance;

/* The effect of storing tangents as integers on their directions. */
typedef struct nt_rounding {
	size_t count; /* tangents that were rounded */
	double worst_radians, sum_radians;
} nt_rounding;

/* Bytes of the written tangents of morph targets, and of their meshes without them. */
typedef struct nt_morph_cost {
	size_t targets;
	uint64_t bytes, mesh_bytes;
} nt_morph_cost;

/* Vertices of the source, and copies of them, by what differs. */
typedef struct nt_vertex_counts {
	size_t vertices, normal_copies, tangent_copies;
} nt_vertex_counts;

/* Vertices of pools of several solved meshes. Each mesh by itself counts those of its pool, and its copies. */
typedef struct nt_shared_vertices {
	nt_vertex_counts counted; /* by all of these meshes */
	nt_vertex_counts actual;
} nt_shared_vertices;

/* Vertices that --weld looked at, and what is left of them. */
typedef struct nt_weld_result {
	size_t before, after;
} nt_weld_result;

/* Draco's edgebreaker makes one of vertices that its grid makes equal, and leaves out triangles that it makes flat. */
typedef struct nt_block_result {
	size_t before, after; /* vertices, of the blocks that have others */
	size_t dropped;       /* triangles */
} nt_block_result;

/* The place of a face in a text. */
typedef struct nt_face_place {
	uint32_t mesh, face; /* face: number in the source, as face_polygon has it */
	size_t line;         /* of its statement, from 1 */
	const char *corners; /* as written, one blank between two */
} nt_face_place;

typedef struct nt_scene {
	nt_arena arena;
	nt_arena temporary; /* of meshes that are */
	nt_format format;
	nt_format judged; /* that of the output; the input's if it is judged as it is */
	const char *path; /* for messages and to find sidecars; "-" is standard input */
	nt_mesh *meshes;
	size_t mesh_count;
	nt_material *materials;
	size_t material_count;
	nt_instance *instances;
	size_t instance_count;
	double origin[3]; /* the source's coordinates are those of meshes plus this, which the matrices of instances
	                     have; 0 0 0: none */
	bool positions_rounded; /* float moves vertices by more than a hundredth of an edge: POS_ROUNDED */
	nt_join *joins; /* of meshes that get tangents, whether they are solved so or could be */
	size_t join_count;
	nt_finding_list findings;
	nt_rounding rounding; /* of all meshes that were written */
	nt_morph_cost morph_cost; /* the same */
	nt_weld_result welded;    /* the same */
	nt_block_result packed;   /* the same */
	nt_shared_vertices shared; /* the same */
	const bool *turned_images; /* [turned_image_count] images of a glTF whose green --fix turns; NULL: all that
	                              need it, if any are turned */
	size_t turned_image_count;

	bool solves_quads; /* what wrote the input solves tangents on quads: Blender */

	nt_buffer left_out; /* what the source has and the scene has not: "lines (3), points (1)". Writers of other
	                       formats report it. A glTF fills it only if the output is one mesh in the world */
	size_t left_out_count, left_out_line; /* line: of the first in a text; 0: unknown */
	size_t left_out_textures; /* of a glTF, the same; a PLY may have one of them */

	/* Data that a reader keeps for the writer of the same format, and the input's bytes. */
	void *source;
	struct nt_output *written; /* its files are those of this output set, which is not in place yet: file/output.h;
	                              NULL: they are in place */
	void (*free_source)(void *source);
	uint64_t (*read_of_source)(const void *source); /* bytes of the input and its files that were read, as far as
	                                                   the reader knows; NULL: all of the input */
	/* Finds faces, which come sorted by mesh and face, in the text: fills line and corners, these in an arena.
	 * The text is read again for it. NULL: there are no lines. */
	nt_status (*locate_faces)(const struct nt_scene *scene, nt_face_place *faces, size_t count,
		nt_arena *arena);
	void (*unmap)(struct nt_scene *scene); /* releases the mapped input; NULL: none */
	double index_seconds; /* of open(), spent on making vertices of corners; --timing shows them apart */
	const unsigned char *bytes;
	size_t byte_count;
	const struct nt_file *file; /* the file of these bytes, to stream from; NULL: only the bytes are there */
} nt_scene;

/* The one image of base colours that all of a scene has: a PLY can name one. */
typedef struct nt_texture_file {
	const char *path;   /* of the file that it is; NULL: it is in the input */
	const unsigned char *bytes; /* [size] NULL: there is none */
	size_t size;
	const char *obstacle; /* why there is none although materials have one; NULL: they have none */
} nt_texture_file;

/* An empty scene. */
void nt_scene_init(nt_scene *scene, const char *path);

/* Frees everything; the scene is empty afterwards. */
void nt_scene_free(nt_scene *scene);

/* A line of a text; 0: the file. */
static inline nt_place nt_line_place(const char *path, size_t line)
{
	nt_place place;
	nt_place_clear(&place);
	nt_utf8_keep_end(place.file, sizeof place.file, path);
	place.line = line;
	return place;
}

/* Whether there are any triangles. */
bool nt_scene_has_triangles(const nt_scene *scene);

/* Appends to scene->left_out. */
void nt_scene_leave_out(nt_scene *scene, size_t line, size_t count, const char *format, ...) NT_PRINTF(4, 5);

/* Fills the place of a mesh in the source, with its name in words as object. Returns `place`. */
const nt_place *nt_mesh_place(const nt_mesh *mesh, nt_place *place);

/* Whether a mesh gets tangents. */
static inline bool nt_mesh_gets_tangents(const nt_mesh *mesh)
{
	return mesh->decision == NT_DECISION_SOLVE || mesh->decision == NT_DECISION_REPAIR;
}

/* The same, or normals alone. */
static inline bool nt_mesh_is_wanted(const nt_mesh *mesh)
{
	return nt_mesh_gets_tangents(mesh) || mesh->decision == NT_DECISION_NORMALS;
}

/* The vertex of a corner of a mesh that is loaded. */
static inline size_t nt_mesh_vertex(const nt_mesh *mesh, size_t corner)
{
	return mesh->indices ? mesh->indices[corner] : corner;
}

/* A face of n corners is n - 2 triangles; a mesh that is not loaded has no sizes. */
static inline size_t nt_mesh_triangle_count(const nt_mesh *mesh)
{
	return mesh->face_sizes ? mesh->corner_count - 2 * mesh->face_count : mesh->face_count;
}

/* Whether a mesh of a glTF keeps tangents that a material uses, and has what they are judged by. */
static inline bool nt_mesh_is_kept_and_used(const nt_mesh *mesh)
{
	return mesh->decision == NT_SKIP_HAS_TANGENTS && mesh->slots && mesh->reachable && mesh->triangles &&
	       mesh->has_positions && mesh->has_normals && mesh->has_texcoords;
}

/* Whether nobody keeps the triangles of a solved mesh: its geometry went with its job, and no vertex was split. */
static inline bool nt_mesh_left_triangles(const nt_mesh *mesh)
{
	return mesh->plan.disposable && !mesh->indices && !mesh->split.indices;
}

/* The arena of what a mesh holds. */
static inline nt_arena *nt_mesh_arena(nt_scene *scene, const nt_mesh *mesh)
{
	return mesh->plan.temporary ? &scene->temporary : &scene->arena;
}

/* Makes NULL of what a mesh holds in an arena that is gone: geometry and results, but not what is counted of them. */
void nt_mesh_drop_arrays(nt_mesh *mesh);

/* How the source numbers a vertex of it; not one that was appended. */
static inline uint32_t nt_mesh_pool_vertex(const nt_mesh *mesh, uint32_t vertex)
{
	return mesh->pool_vertices ? mesh->pool_vertices[vertex] : vertex;
}

/* A material as it is where nothing is said about it: white and rough, and no metal, as glTF's own default is. */
nt_material nt_material_default(const char *name);

/* A place in it; line: 0 is its newmtl. */
nt_place nt_material_place(const nt_scene *scene, const nt_material *material, size_t line);

/* Fills and returns the place of the statement that names a map, or a file that the user named for it. */
const nt_place *nt_map_place(const nt_scene *scene, const nt_material *material, const nt_map *map, nt_place *place);

/* Whether anything of a material takes texture coordinates: maps and anisotropy. */
bool nt_material_takes_texcoords(const nt_material *material);

/* Gives a mesh with same_as the geometry and the results that the other has by now. They are shared, not
 * copied. */
void nt_mesh_share(nt_mesh *mesh);

/* The public view of a loaded mesh, for nmtan_tangents() and nmtan_split(). It refers to `stored`, which is
 * filled; v_offset is left to the caller. */
nmtan_mesh nt_mesh_view(const nt_mesh *mesh, nmtan_stored_uv *stored);

/* Whether tangents of the mesh, and what is wrong with its texture coordinates, may show in the light. The materials of
 * a glTF tell, of one that is written, too; a PLY has none, and its tangents are for whoever reads it. */
static inline bool nt_mesh_needs_tangents(const nt_mesh *mesh, bool judged_as_gltf)
{
	return !judged_as_gltf || mesh->slots != 0;
}

/* ---- which meshes get tangents, by the rules of the glTF specification and its extensions: select.c ---- */

typedef enum nt_only { NT_ONLY_AUTO, NT_ONLY_NEEDED, NT_ONLY_ALL } nt_only;
typedef enum nt_existing { NT_EXISTING_KEEP, NT_EXISTING_REPAIR, NT_EXISTING_REPLACE, NT_EXISTING_DROP } nt_existing;

/* Which meshes get normals that are made. */
typedef enum nt_making_normals {
	NT_MAKING_NONE,
	NT_MAKING_MISSING,     /* those that get tangents, and lack them */
	NT_MAKING_ALL_MISSING, /* of a glTF, also those that get no tangents; other formats load these in any case */
	NT_MAKING_ALL          /* the same, and those that have some get others */
} nt_making_normals;

/* Sets the decision of every mesh of the scene; findings name the meshes that need tangents and cannot have them. */
void nt_select(nt_scene *scene, nt_only only, nt_existing existing, nt_making_normals normals);

/* A few words why a mesh was or was not solved: "no material of it uses tangents". */
const char *nt_decision_text(nt_decision decision);

#endif
