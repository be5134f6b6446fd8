// SPDX-License-Identifier: MIT
//
// OpenMesh's half-edges behind a C header. OpenMesh keeps the links and answers "next" and "opposite";
// what it is bad at is kept from it: directed edges used twice make add_face() fail or duplicate
// vertices, several fans at one vertex, and fans that grow on both sides, make it search around the vertex
// for every face (60 000 triangles on one vertex took 16 s). So build() pairs the sides first, leaves
// out triangles on taken edges, gives every fan a vertex of its own and adds the faces of large fans in
// the order in which they follow each other. Time is then linear, but for sorting the sides of a vertex.
//
// Only the connectivity class is used: no positions, no properties.
#include "ext/modules/guard.hpp"
#include "ext/tables.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <vector>

#include <OpenMesh/Core/Mesh/TriConnectivity.hh>
#include <OpenMesh/Core/System/omstream.hh>

using OpenMesh::HalfedgeHandle;
using OpenMesh::VertexHandle;

struct nt_halfedges {
	OpenMesh::TriConnectivity topology;
	std::vector<uint32_t> left_out;     // ascending
	std::vector<uint32_t> halfedge;     // [side]; NT_OPEN for triangles left out
	std::vector<uint32_t> side;         // [half-edge]; NT_OPEN where there is no triangle
	std::vector<uint32_t> fan_vertex;   // [vertex of topology] the caller's vertex
	std::vector<uint32_t> left_corners; // [3 * left_out] the caller's vertices
	size_t triangle_count = 0;
};

namespace {

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

// Sides as directed edges, sorted by their two vertices.
struct directed_edges {
	const uint32_t *vertices; // [side] where a side begins
	std::vector<uint32_t> first; // [vertex + 1] its range in `sides`
	std::vector<uint32_t> sides; // by first vertex, then second, then number

	uint32_t from(uint32_t side) const { return vertices[side]; }
	uint32_t to(uint32_t side) const { return vertices[next_side(side)]; }

	directed_edges(size_t vertex_count, const uint32_t *triangles, size_t side_count)
		: vertices(triangles), first(vertex_count + 1), sides(side_count)
	{
		for (size_t s = 0; s < side_count; s++)
			first[triangles[s]]++;
		uint32_t sum = 0;
		for (uint32_t &begin : first) {
			const uint32_t size = begin;
			begin = sum;
			sum += size;
		}
		for (size_t s = 0; s < side_count; s++)
			sides[first[triangles[s]]++] = static_cast<uint32_t>(s);
		for (size_t v = vertex_count; v > 0; v--)
			first[v] = first[v - 1];
		first[0] = 0;
		for (size_t v = 0; v < vertex_count; v++)
			std::sort(sides.begin() + first[v], sides.begin() + first[v + 1],
				[this](uint32_t a, uint32_t b) {
					return to(a) != to(b) ? to(a) < to(b) : a < b;
				});
	}

	// The first position in `sides` of the edge a -> b, or where it would be.
	size_t find(uint32_t a, uint32_t b) const
	{
		return static_cast<size_t>(
			std::lower_bound(sides.begin() + first[a], sides.begin() + first[a + 1], b,
				[this](uint32_t side, uint32_t wanted) { return to(side) < wanted; }) -
			sides.begin());
	}
};

// Which side owns each directed edge, and from that, who is opposite to whom. Triangles that come to a
// taken edge, or have two equal vertices, are left out.
std::vector<uint32_t> pair_sides(nt_halfedges &mesh, size_t vertex_count, const uint32_t *triangles)
{
	const size_t side_count = 3 * mesh.triangle_count;
	const directed_edges edges(vertex_count, triangles, side_count);
	std::vector<uint32_t> owner(side_count, NT_OPEN); // by the edge's first position
	std::vector<uint32_t> slot(side_count);           // that position, for each side
	for (size_t i = 0; i < side_count; i++) {
		const uint32_t s = edges.sides[i];
		const bool again = i > 0 && edges.from(edges.sides[i - 1]) == edges.from(s) &&
			edges.to(edges.sides[i - 1]) == edges.to(s);
		slot[s] = again ? slot[edges.sides[i - 1]] : static_cast<uint32_t>(i);
	}
	for (size_t t = 0; t < mesh.triangle_count; t++) {
		const uint32_t *v = triangles + 3 * t, *at = slot.data() + 3 * t;
		if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0] || owner[at[0]] != NT_OPEN ||
			owner[at[1]] != NT_OPEN || owner[at[2]] != NT_OPEN) {
			mesh.left_out.push_back(static_cast<uint32_t>(t));
			mesh.left_corners.insert(mesh.left_corners.end(), v, v + 3);
			continue;
		}
		for (uint32_t k = 0; k < 3; k++)
			owner[at[k]] = static_cast<uint32_t>(3 * t + k);
	}
	std::vector<uint32_t> opposite(side_count, NT_OPEN);
	for (size_t s = 0; s < side_count; s++) {
		const uint32_t side = static_cast<uint32_t>(s);
		const uint32_t a = edges.from(side), b = edges.to(side);
		if (owner[slot[s]] != side || a > b)
			continue;
		const size_t back = edges.find(b, a);
		if (back == edges.first[b + 1] || edges.to(edges.sides[back]) != a)
			continue;
		const uint32_t other = owner[back];
		if (other != NT_OPEN) {
			opposite[s] = other;
			opposite[other] = side;
		}
	}
	return opposite;
}

// The corners that hang together around a vertex get one vertex of the structure. Appends the
// triangles of large fans to `order`, each following the one before across the edge they share: the
// new face then meets the vertex at its open edge, which is where OpenMesh looks first.
std::vector<uint32_t> split_fans(nt_halfedges &mesh, const uint32_t *triangles,
	const std::vector<uint32_t> &opposite, const std::vector<bool> &out,
	std::vector<uint32_t> &order)
{
	std::vector<uint32_t> fan(opposite.size(), NT_OPEN);
	for (size_t c = 0; c < fan.size(); c++) {
		if (fan[c] != NT_OPEN || out[c / 3])
			continue;
		// Side c leaves the vertex: its opposite enters it, so that the one after leaves again.
		const uint32_t seed = static_cast<uint32_t>(c);
		uint32_t begin = seed;
		while (opposite[begin] != NT_OPEN) {
			begin = next_side(opposite[begin]);
			if (begin == seed)
				break;
		}
		const uint32_t number = static_cast<uint32_t>(mesh.fan_vertex.size());
		mesh.fan_vertex.push_back(triangles[c]);
		const size_t order_before = order.size();
		uint32_t corner = begin;
		size_t size = 0;
		do {
			fan[corner] = number;
			size++;
			corner = opposite[previous_side(corner)];
		} while (corner != NT_OPEN && corner != begin);
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

void add_triangle(nt_halfedges &mesh, const std::vector<uint32_t> &fan, uint32_t triangle)
{
	const uint32_t *at = fan.data() + 3 * static_cast<size_t>(triangle);
	VertexHandle corners[3];
	for (int k = 0; k < 3; k++)
		corners[k] = VertexHandle(static_cast<int>(at[k]));
	const auto face = mesh.topology.add_face(corners, 3);
	if (!face.is_valid()) { // cannot be, after pair_sides(); reported all the same
		mesh.left_out.push_back(triangle);
		for (int k = 0; k < 3; k++)
			mesh.left_corners.push_back(mesh.fan_vertex[at[k]]);
		return;
	}
	HalfedgeHandle h = mesh.topology.halfedge_handle(face);
	for (int i = 0; i < 3; i++, h = mesh.topology.next_halfedge_handle(h)) {
		const VertexHandle begin = mesh.topology.from_vertex_handle(h);
		const uint32_t k = begin == corners[0] ? 0 : begin == corners[1] ? 1 : 2;
		mesh.side[static_cast<size_t>(h.idx())] = 3 * triangle + k;
		mesh.halfedge[3 * static_cast<size_t>(triangle) + k] = static_cast<uint32_t>(h.idx());
	}
}

void build(nt_halfedges &mesh, size_t vertex_count, const uint32_t *triangles)
{
	const size_t side_count = 3 * mesh.triangle_count;
	const std::vector<uint32_t> opposite = pair_sides(mesh, vertex_count, triangles);
	std::vector<bool> done(mesh.triangle_count);
	for (const uint32_t t : mesh.left_out)
		done[t] = true;
	std::vector<uint32_t> order;
	const std::vector<uint32_t> fan = split_fans(mesh, triangles, opposite, done, order);

	const size_t fan_count = mesh.fan_vertex.size();
	const size_t used = side_count - 3 * mesh.left_out.size();
	size_t inner = 0;
	for (const uint32_t other : opposite)
		inner += other != NT_OPEN;
	const size_t edge_count = used - inner / 2;
	mesh.topology.resize(fan_count, 0, 0);
	mesh.topology.reserve(fan_count, edge_count, mesh.triangle_count);
	mesh.halfedge.assign(side_count, NT_OPEN);
	mesh.side.assign(2 * edge_count, NT_OPEN);
	for (const uint32_t t : order)
		if (!done[t]) {
			done[t] = true;
			add_triangle(mesh, fan, t);
		}
	for (size_t t = 0; t < mesh.triangle_count; t++)
		if (!done[t])
			add_triangle(mesh, fan, static_cast<uint32_t>(t));
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

HalfedgeHandle opposite_of(const nt_halfedges &mesh, HalfedgeHandle h)
{
	return mesh.topology.opposite_halfedge_handle(h);
}

uint32_t side_of(const nt_halfedges &mesh, HalfedgeHandle h)
{
	return mesh.side[static_cast<size_t>(h.idx())];
}

uint32_t vertex_of(const nt_halfedges &mesh, VertexHandle v)
{
	return mesh.fan_vertex[static_cast<size_t>(v.idx())];
}

// Whether the edge of a half-edge is flagged on either side.
bool is_flagged(const nt_halfedges &mesh, const uint8_t *flags, HalfedgeHandle h)
{
	const uint32_t here = side_of(mesh, h), there = side_of(mesh, opposite_of(mesh, h));
	return (here != NT_OPEN && flags[here]) || (there != NT_OPEN && flags[there]);
}

// Walks while they are made.
struct walk_list {
	std::vector<size_t> first{0};
	std::vector<char> closed;
	std::vector<uint32_t> left, right, from, to;

	void step(uint32_t l, uint32_t r, uint32_t a, uint32_t b)
	{
		left.push_back(l);
		right.push_back(r);
		from.push_back(a);
		to.push_back(b);
	}

	void step(const nt_halfedges &mesh, HalfedgeHandle h)
	{
		step(side_of(mesh, h), side_of(mesh, opposite_of(mesh, h)),
			vertex_of(mesh, mesh.topology.from_vertex_handle(h)),
			vertex_of(mesh, mesh.topology.to_vertex_handle(h)));
	}

	void end(bool is_closed)
	{
		first.push_back(left.size());
		closed.push_back(is_closed);
	}

	nt_status move_to(nt_walks *walks, nt_error *error) const;
};

template <typename To, typename From>
To *copy_out(const std::vector<From> &from)
{
	To *to = static_cast<To *>(std::malloc((from.size() + 1) * sizeof(To)));
	if (to)
		std::copy(from.begin(), from.end(), to);
	return to;
}

nt_status walk_list::move_to(nt_walks *walks, nt_error *error) const
{
	walks->count = closed.size();
	walks->first = copy_out<size_t>(first);
	walks->closed = copy_out<bool>(closed);
	walks->left = copy_out<uint32_t>(left);
	walks->right = copy_out<uint32_t>(right);
	walks->from = copy_out<uint32_t>(from);
	walks->to = copy_out<uint32_t>(to);
	if (walks->first && walks->closed && walks->left && walks->right && walks->from && walks->to)
		return NT_OK;
	nt_walks_free(walks);
	return nt_fail_memory(error);
}

// Marked edges, by half-edge, and how they meet.
struct marked_edges {
	const nt_halfedges &mesh;
	std::vector<bool> walked;     // [edge] walked, or not marked
	std::vector<uint8_t> degree;  // [vertex of topology] marked edges, at most 3

	marked_edges(const nt_halfedges &of, const uint8_t *flags)
		: mesh(of), walked(of.topology.n_edges()), degree(of.topology.n_vertices())
	{
		for (size_t e = 0; e < walked.size(); e++) {
			const HalfedgeHandle h(static_cast<int>(2 * e));
			walked[e] = !is_flagged(mesh, flags, h);
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

	// Where the walk through h begins: h itself when it is closed.
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

	void walk(HalfedgeHandle seed, walk_list &list)
	{
		const HalfedgeHandle begin = beginning(seed);
		HalfedgeHandle h = begin, last;
		while (h.is_valid()) {
			list.step(mesh, h);
			walked[static_cast<size_t>(h.idx() / 2)] = true;
			last = h;
			h = after(h);
		}
		list.end(mesh.topology.to_vertex_handle(last) ==
			mesh.topology.from_vertex_handle(begin));
	}
};

// ---- the table ----

void free_mesh(nt_halfedges *mesh)
{
	const nt::reserve memory;
	delete mesh;
}

nt_status build_mesh(nt_halfedges **result, size_t vertex_count, const uint32_t *triangles,
	size_t triangle_count, nt_error *error)
{
	if (triangle_count > max_triangles || vertex_count > NT_OPEN)
		return nt_fail(error, NT_ERROR_TOO_LARGE,
			"%zu triangles are too many for the seam report, which takes %zu",
			triangle_count, max_triangles);
	for (size_t s = 0; s < 3 * triangle_count; s++)
		if (triangles[s] >= vertex_count)
			return nt_fail(error, NT_ERROR_INDEX,
				"triangle %zu refers to vertex %u of %zu", s / 3, triangles[s],
				vertex_count);
	nt_halfedges *mesh = nullptr;
	const nt_status status = nt::guard(error, "OpenMesh", [&] {
		silence();
		mesh = new nt_halfedges;
		mesh->triangle_count = triangle_count;
		build(*mesh, vertex_count, triangles);
		return NT_OK;
	});
	if (status == NT_OK)
		*result = mesh;
	else
		free_mesh(mesh);
	return status;
}

size_t left_out(const nt_halfedges *mesh, const uint32_t **triangles)
{
	*triangles = mesh->left_out.data();
	return mesh->left_out.size();
}

nt_status trace_chains(const nt_halfedges *mesh, const uint8_t *marked, nt_walks *walks,
	nt_error *error)
{
	std::memset(walks, 0, sizeof *walks);
	const nt_status status = nt::guard(error, "OpenMesh", [&] {
		walk_list list;
		marked_edges edges(*mesh, marked);
		for (const uint32_t h : mesh->halfedge)
			if (h != NT_OPEN && !edges.walked[h / 2])
				edges.walk(HalfedgeHandle(static_cast<int>(h)), list);
		for (size_t i = 0; i < mesh->left_out.size(); i++)
			for (uint32_t k = 0; k < 3; k++) {
				const uint32_t side = 3 * mesh->left_out[i] + k;
				if (!marked[side])
					continue;
				const uint32_t *corner = mesh->left_corners.data() + 3 * i;
				list.step(side, NT_OPEN, corner[k], corner[(k + 1) % 3]);
				list.end(corner[k] == corner[(k + 1) % 3]);
			}
		return list.move_to(walks, error);
	});
	if (status != NT_OK)
		nt_walks_free(walks);
	return status;
}

} // namespace

static const char version[] = {'0' + OM_GET_VER, '.', '0' + OM_GET_MAJ, 0};

const nt_openmesh_table nt_openmesh_module = {NT_MODULE_HEAD(nt_openmesh_table, "OpenMesh", version,
	"BSD-3-Clause", &nt::cxx), build_mesh, free_mesh, left_out, trace_chains};
