// What holds together of a mesh that can tear: which edges, and so which triangles, are left.
//
// An edge ends past its tear strain, where a cutter passes, or where a caller cuts. With it end the triangles at
// it: their membrane at once, the bending of them and over their sides, and the surface that wind and contact
// see, between frames. So a tear runs between vertices, as that of a grid; each keeps its mass, and what is shown
// of a triangle in its way is each side's share (mesh_tear_boundary.h). Springs along other edges of such a
// triangle go on pulling; an edge that only a membrane held ends with the last triangle that it has.
//
// A vertex that alone holds pieces of the mesh together goes with one of them: where the edges about it fall into
// pieces that each share a triangle with it, it stays with the piece that has most area of these, and its edges
// to the others end. Vertices that are so in the file, and at which nothing has torn, stay as they are.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "physics/model/mesh/mesh_edges.h"
#include "physics/model/mesh/mesh_order.h"
#include "physics/model/mesh/mesh_pieces.h"

namespace weft::physics {

class MeshTearBoundary;

// What keeps edges or triangles in a form of its own.
class TornParts {
 public:
  virtual ~TornParts() = default;
  // An edge ends, or holds again; the mesh's triangles know already. While a substep runs, this comes from the
  // row that the edge belongs to.
  virtual void set_edge(int edge, bool holds) { (void)edge, (void)holds; }
  // A triangle has lost hinges or all that it had, or has them again; between frames only.
  virtual void set_triangle(int triangle) { (void)triangle; }
};

// Where the last sweep of a substep tells squared lengths in its midst [m²], about their own correction or solution
// (kernels/mesh_sweeps.cpp, strand_sweep.cpp): of every edge; or of every triangle, whose sides are kBatch apart.
// Neither: none does.
struct MidstLengths {
  std::vector<const float*> edges, triangles;
};

class MeshTearing final : public Tearing {
 public:
  // All of these outlive it. `triangles` and `surface` follow what tears. `lanes`: of each vertex, where it is in
  // the component arrays; `rest`: where it is at rest [m].
  struct Parts {
    const Cloth& cloth;
    const TriangleMesh& mesh;
    const MeshOrder& order;
    const Particles& particles;
    const MeshEdges& edges;
    const std::vector<Vec3>& rest;
    std::vector<RestTriangle>& triangles;
    SurfaceMesh& surface;
    const DrawnMesh& drawn;
  };
  explicit MeshTearing(const Parts& parts);
  ~MeshTearing() override;

  bool update() override;
  void remember() override { remembered_ = holds_; }
  void go_back() override;
  std::int64_t torn() const override { return torn_; }
  std::uint64_t version() const override { return version_; }
  std::vector<Joined> torn_list() const override;
  void set_torn(const std::vector<Joined>& torn) override;
  std::int64_t end_all(const std::vector<Joined>& constraints) override;
  TornSurface surface() override;

  // A side of a triangle, from corner k to the next.
  struct Side {
    int triangle = -1;
    std::size_t k = 0;
  };
  // Calls visit(side) for those that an edge is, one or two.
  template <class Visit>
  void for_each_side(int edge, const Visit& visit) const {
    for (const Side& side : sides_[std::size_t(edge)])
      if (side.triangle >= 0) visit(side);
  }
  // The edge that side k of a triangle is.
  int edge_of(int triangle, std::size_t k) const {
    return edge_of_[3 * std::size_t(triangle) + k % 3];
  }
  bool holds(std::size_t edge) const { return holds_[edge] != 0; }
  // Ends an edge, if it holds.
  void end(int edge);
  // An edge belongs to the first row that its triangles reach with what lies across their sides. It, its
  // triangles and what is kept of them lie within reach() rows from there.
  const std::vector<int>& edges_of_row(int row) const { return rows_[std::size_t(row)]; }
  int reach() const { return reach_; }

  // Edges of a triangle that have ended: bit k, from corner k to the next. Triangles have none left or all.
  unsigned gone(std::size_t triangle) const { return gone_[triangle]; }
  const std::vector<int>& around(int vertex) const { return around_[std::size_t(vertex)]; }
  const Parts& parts() const { return parts_; }

  // Tells these from now on, and of all that has torn so far.
  void tell(TornParts& parts);
  void tell_nobody() { told_.clear(); }
  std::size_t bytes() const;

 private:
  void find_rows();
  int edge_between(int a, int b) const;
  void set(int edge, bool holds);
  void stretch_as_now(const Side& side);
  bool follow();
  void end_unheld();
  void end_pinches();
  void end_pinch(int vertex);
  void bend_as_now(int triangle);
  void bend_about();
  void list_triangles();

  const Parts parts_;
  const bool membrane_;
  const std::vector<RestTriangle> whole_;
  std::vector<std::array<Side, 2>> sides_;  // of every edge
  std::vector<int> edge_of_;                // of every triangle's sides
  std::vector<std::vector<int>> around_;    // triangles of every vertex
  std::vector<int> row_;                    // of every edge
  std::vector<std::vector<int>> rows_;
  int reach_ = 0;
  std::vector<std::uint8_t> holds_, followed_edges_, remembered_;  // of every edge
  std::vector<std::int64_t> died_, followed_;                      // of every row, ever
  std::vector<std::uint8_t> gone_;                                 // of every triangle
  std::int64_t torn_ = 0;
  std::uint64_t version_ = 1;  // that of a mesh which is whole
  std::vector<std::array<std::uint32_t, 3>> drawn_;
  std::vector<std::array<std::array<double, 2>, 3>> uv_;
  // Of an update: triangles that have lost edges, now and in all; triangles or vertices about them.
  std::vector<int> lost_, touched_, about_;
  MeshPieces pieces_;
  std::vector<TornParts*> told_;
  std::unique_ptr<MeshTearBoundary> boundary_;  // null: not shown
};

}  // namespace weft::physics
