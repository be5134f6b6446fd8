// SPDX-License-Identifier: MIT
//
// OpenMesh's half-edges behind a C header. OpenMesh keeps the links and answers "next" and "opposite";
// what it is bad at is kept from it: directed edges used twice make add_face() fail or duplicate
// vertices, several fans at one vertex, and fans that grow on both sides, make it search around the vertex
// for every face (60 000 triangles on one vertex took 16 s). So build() pairs the sides first, leaves
// out triangles on taken edges, gives every fan a vertex of its own and adds the faces of large fans in
// the order in which they follow each other. Time is then linear.
//
// Only the connectivity class is used: no positions, no properties.
#include "ext/modules/guard.hpp"
#include "ext/tables.h"

#include <algorithm>
#include <vector>

#include <OpenMesh/Core/Mesh/TriConnectivity.hh>
#include <OpenMesh/Core/System/omstream.hh>

using OpenMesh::HalfedgeHandle;
using OpenMesh::VertexHandle;

namespace {

struct halfedges {
	OpenMesh::TriConnectivity topology;
	std::vector<bool> out;          // [triangle] not in the structure
	std::vector<uint32_t> halfedge; // [side]; `none` for triangles left out
	std::vector<uint32_t> side;     // [half-edge]; `none` where there is no triangle
	size_t fan_count = 0;           // vertices of topology
};

constexpr uint32_t none = UINT32_MAX;

// OpenMesh numbers half-edges by int, and three separate edges per triangle have six of them.
constexpr size_t max_triangles = 0x7fffffff / 6;

// Fans of more triangles than this are added first and in order. Below, the search is cheap.
constexpr size_t large_fan = 32;

uint32_t next_side(uint32_t side)
{
	return side % 3 == 2 ? side - 2 : side + 1;
}

uint32_t previous_side(uint32_t side)
{
	return side % 3 == 0 ? side + 2 : side - 1;
}

// Which side owns each direction of an edge, and from that, who is opposite to whom. Triangles that come to a direction
// that is taken, or to one edge twice, are left out.
std::vector<uint32_t> pair_sides(halfedges &mesh, const nt_walked_mesh &of)
{
	std::vector<uint32_t> owner(2 * of.edge_count, none);
	for (size_t t = 0; t < mesh.out.size(); t++) {
		const uint32_t *at = of.sides + 3 * t;
		mesh.out[t] = at[0] / 2 == at[1] / 2 || at[1] / 2 == at[2] / 2 || at[2] / 2 == at[0] / 2 ||
			owner[at[0]] != none || owner[at[1]] != none || owner[at[2]] != none;
		for (uint32_t k = 0; k < 3 && !mesh.out[t]; k++)
			owner[at[k]] = static_cast<uint32_t>(3 * t + k);
	}
	std::vector<uint32_t> opposite(3 * mesh.out.size(), none);
	for (size_t s = 0; s < opposite.size(); s++)
		if (!mesh.out[s / 3])
			opposite[s] = owner[of.sides[s] ^ 1];
	return opposite;
}

// The corners that hang together around a vertex get one vertex of the structure. Appends the
// triangles of large fans to `order`, each following the one before across the edge they share: the
// new face then meets the vertex at its open edge, which is where OpenMesh looks first.
std::vector<uint32_t> split_fans(halfedges &mesh, const std::vector<uint32_t> &opposite, std::vector<uint32_t> &order)
{
	std::vector<uint32_t> fan(opposite.size(), none);
	for (size_t c = 0; c < fan.size(); c++) {
		if (fan[c] != none || mesh.out[c / 3])
			continue;
		// Side c leaves the vertex: its opposite enters it, so that the one after leaves again.
		const uint32_t seed = static_cast<uint32_t>(c);
		uint32_t begin = seed;
		while (opposite[begin] != none) {
			begin = next_side(opposite[begin]);
			if (begin == seed)
				break;
		}
		const uint32_t number = static_cast<uint32_t>(mesh.fan_count++);
		const size_t order_before = order.size();
		uint32_t corner = begin;
		size_t size = 0;
		do {
			fan[corner] = number;
			size++;
			corner = opposite[previous_side(corner)];
		} while (corner != none && corner != begin);
		if (size <= large_fan)
			continue;
		order.resize(order_before + size);
		corner = begin;
		for (size_t i = 0; i < size; i++) {
			order[order_before + i] = corner / 3;
			corner = opposite[previous_side(corner)];
		}
	}
	return fan;
}

void add_triangle(halfedges &mesh, const std::vector<uint32_t> &fan, uint32_t triangle)
{
	const uint32_t *at = fan.data() + 3 * static_cast<size_t>(triangle);
	VertexHandle corners[3];
	for (int k = 0; k < 3; k++)
		corners[k] = VertexHandle(static_cast<int>(at[k]));
	const auto face = mesh.topology.add_face(corners, 3);
	mesh.out[triangle] = !face.is_valid(); // cannot be, after pair_sides()
	if (mesh.out[triangle])
		return;
	HalfedgeHandle h = mesh.topology.halfedge_handle(face);
	for (int i = 0; i < 3; i++, h = mesh.topology.next_halfedge_handle(h)) {
		const VertexHandle begin = mesh.topology.from_vertex_handle(h);
		const uint32_t k = begin == corners[0] ? 0 : begin == corners[1] ? 1 : 2;
		mesh.side[static_cast<size_t>(h.idx())] = 3 * triangle + k;
		mesh.halfedge[3 * static_cast<size_t>(triangle) + k] = static_cast<uint32_t>(h.idx());
	}
}

void build(halfedges &mesh, const nt_walked_mesh &of)
{
	const std::vector<uint32_t> opposite = pair_sides(mesh, of);
	std::vector<bool> done = mesh.out;
	std::vector<uint32_t> order;
	const std::vector<uint32_t> fan = split_fans(mesh, opposite, order);

	size_t twice = 0; // half-edges, and inner ones once more
	for (size_t s = 0; s < opposite.size(); s++)
		twice += mesh.out[s / 3] ? 0 : opposite[s] == none ? 2 : 1;
	mesh.topology.resize(mesh.fan_count, 0, 0);
	mesh.topology.reserve(mesh.fan_count, twice / 2, mesh.out.size());
	mesh.halfedge.assign(opposite.size(), none);
	mesh.side.assign(twice, none);
	for (size_t t = 0; t < mesh.out.size(); t++)
		order.push_back(static_cast<uint32_t>(t));
	for (const uint32_t t : order)
		if (!done[t]) {
			done[t] = true;
			add_triangle(mesh, fan, t);
		}
}

// OpenMesh complains to the standard streams unless told otherwise.
void silence()
{
	static const bool done = [] {
		omerr().disable();
		omlog().disable();
		omout().disable();
		return true;
	}();
	(void)done;
}

HalfedgeHandle opposite_of(const halfedges &mesh, HalfedgeHandle h)
{
	return mesh.topology.opposite_halfedge_handle(h);
}

// The number of a half-edge's side; `none`: it is not marked.
uint32_t mark_of(const halfedges &mesh, const uint32_t *marks, HalfedgeHandle h)
{
	const uint32_t side = mesh.side[static_cast<size_t>(h.idx())];
	return side != none ? marks[side] : none;
}

// Marked edges, by half-edge, and how they meet.
struct marked_edges {
	const halfedges &mesh;
	const uint32_t *marks;
	std::vector<bool> walked;     // [edge] walked, or not marked
	std::vector<uint8_t> degree;  // [vertex of topology] marked edges, at most 3
	std::vector<uint32_t> steps;  // of one walk

	marked_edges(const halfedges &of, const uint32_t *numbers)
		: mesh(of), marks(numbers), walked(of.topology.n_edges()), degree(of.topology.n_vertices())
	{
		for (size_t e = 0; e < walked.size(); e++) {
			const HalfedgeHandle h(static_cast<int>(2 * e));
			walked[e] = mark_of(mesh, marks, h) == none &&
				mark_of(mesh, marks, opposite_of(mesh, h)) == none;
			if (walked[e])
				continue;
			for (const VertexHandle v : {mesh.topology.from_vertex_handle(h),
					mesh.topology.to_vertex_handle(h)}) {
				uint8_t &count = degree[static_cast<size_t>(v.idx())];
				count = static_cast<uint8_t>(std::min(count + 1, 3));
			}
		}
	}

	// The marked half-edge that goes on where h ends; invalid at an end or a junction. Edges count as
	// marked until they are walked.
	HalfedgeHandle after(HalfedgeHandle h) const
	{
		const VertexHandle v = mesh.topology.to_vertex_handle(h);
		if (degree[static_cast<size_t>(v.idx())] != 2)
			return HalfedgeHandle();
		for (auto around = mesh.topology.cvoh_iter(v); around.is_valid(); ++around)
			if (*around != opposite_of(mesh, h) &&
				!walked[static_cast<size_t>(around->idx() / 2)])
				return *around;
		return HalfedgeHandle();
	}

	// The beginning of the walk through h: h itself when it is closed.
	HalfedgeHandle beginning(HalfedgeHandle h) const
	{
		HalfedgeHandle back = opposite_of(mesh, h);
		for (HalfedgeHandle next = after(back); next.is_valid(); next = after(back)) {
			back = next;
			if (back == opposite_of(mesh, h))
				break;
		}
		return opposite_of(mesh, back);
	}

	void walk(HalfedgeHandle seed, nt_walk_taker *take, void *context)
	{
		const HalfedgeHandle begin = beginning(seed);
		HalfedgeHandle h = begin, last;
		steps.clear();
		while (h.is_valid()) {
			const uint32_t mark = mark_of(mesh, marks, h);
			steps.push_back(mark != none
				? 2 * mark : 2 * mark_of(mesh, marks, opposite_of(mesh, h)) + 1);
			walked[static_cast<size_t>(h.idx() / 2)] = true;
			last = h;
			h = after(h);
		}
		take(context, steps.data(), steps.size(), mesh.topology.to_vertex_handle(last) ==
			mesh.topology.from_vertex_handle(begin));
	}
};

// ---- the table ----

nt_status walk_marked(const nt_walked_mesh *of, nt_walk_taker *take, void *context, size_t *left_out, nt_error *error)
{
	if (of->triangle_count > max_triangles || of->edge_count > none / 2)
		return nt_fail(error, NT_ERROR_TOO_LARGE,
			"%zu triangles are too many for the seam report, which takes %zu",
			of->triangle_count, max_triangles);
	for (size_t s = 0; s < 3 * of->triangle_count; s++)
		if (of->sides[s] / 2 >= of->edge_count)
			return nt_fail(error, NT_ERROR_INDEX, "triangle %zu refers to edge %u of %zu", s / 3,
				of->sides[s] / 2, of->edge_count);
	return nt::guard(error, "OpenMesh", [&] {
		silence();
		halfedges mesh;
		mesh.out.resize(of->triangle_count);
		build(mesh, *of);
		*left_out = static_cast<size_t>(std::count(mesh.out.begin(), mesh.out.end(), true));
		marked_edges edges(mesh, of->marks);
		for (const uint32_t h : mesh.halfedge)
			if (h != none && !edges.walked[h / 2])
				edges.walk(HalfedgeHandle(static_cast<int>(h)), take, context);
		return NT_OK;
	});
}

} // namespace

static const char version[] = {'0' + OM_GET_VER, '.', '0' + OM_GET_MAJ, 0};

const nt_openmesh_table nt_openmesh_module = {NT_MODULE_HEAD(nt_openmesh_table, "OpenMesh", version,
	"BSD-3-Clause", &nt::cxx), walk_marked};
