// What of the surface of a body stays as it moves: which triangles there are and how they hang together, and
// the trees by which they are found.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "physics/contact/body/box_tree.h"
#include "weft/mesh.h"

namespace weft::physics {

struct BodyForm {
  struct Part {
    int first = 0, last = 0;  // its triangles
    BoxTree tree;             // of them, from its first on
  };
  // An edge or a corner, which may stick out.
  struct Feature {
    int a = 0, b = 0;  // vertices; a corner's are one
    int triangle = 0;  // one of them
    int other = -1;    // across the edge, or -1
  };

  // Of a mesh whose vertices are there.
  BodyForm(const TriangleMesh& mesh, const std::vector<Vec3>& vertices);

  bool closed() const { return open_edges.empty(); }
  // The triangles at a vertex.
  std::span<const int> at_vertex(int vertex) const {
    const auto begin = std::size_t(first_at[std::size_t(vertex)]);
    return std::span(at).subspan(begin, std::size_t(first_at[std::size_t(vertex) + 1]) - begin);
  }
  // Where its vertices are, by where those of the file are.
  std::vector<Vec3> split(const std::vector<Vec3>& of_file) const;
  std::size_t bytes() const;

  std::vector<std::array<int, 3>> triangles;  // part after part
  std::vector<std::array<int, 3>> beside;  // the triangle across the edge from each corner, or -1
  std::vector<std::array<int, 2>> open_edges;  // by the file's numbers
  std::vector<int> of_file;                    // of each vertex, its number in the file
  std::vector<int> first_at, at;               // the triangles at each vertex
  std::vector<Part> parts;
  std::vector<Feature> features;
  BoxTree feature_tree;
  double mean_edge = 0;  // m

 private:
  void sort_into_parts(const TriangleMesh& mesh);
  void look_outward(const std::vector<Vec3>& x);
  void list_corners(const std::vector<Vec3>& x);
  void plant(const std::vector<Vec3>& x);
};

}  // namespace weft::physics
