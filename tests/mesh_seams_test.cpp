// Which vertices seams join: what files and scenes say, and what is refused.
#include <gtest/gtest.h>

#include "mesh_scenes.h"

namespace weft {
namespace {

TEST(MeshSeams, TakesLooseEdgesOfFiles) {
  // Two triangles; edges 1-4 and 2-7-5, over a vertex of no face; 1-2 is a side of a face.
  const MeshFile file = read_obj(
      "v 0 0 0\nv 1 0 0\nv 0 0 1\nv 0 1 0\nv 1 1 0\nv 0 1 -1\nv 5 5 5\n"
      "f 1 2 3\nf 4 5 6\nl 1 4\nl 2 7 5\nl 1 2\n",
      "a.obj");
  ASSERT_TRUE(file.faults.empty());
  EXPECT_EQ(file.mesh.edges.size(), 3u);
  Cloth cloth;
  cloth.mesh.shape = std::make_shared<const TriangleMesh>(file.mesh);
  EXPECT_TRUE(sewn_vertices(cloth).empty());
  cloth.sewing = true;
  EXPECT_EQ(sewn_vertices(cloth), (std::vector<std::vector<int>>{{0, 3}, {1, 4}}));
  cloth.seams = {{4, 3}};
  EXPECT_EQ(sewn_vertices(cloth), (std::vector<std::vector<int>>{{0, 1, 3, 4}}));
}

struct Wrong {
  const char* what;
  void (*set)(Cloth&);
  const char* fault;
};
const Wrong kWrong[] = {
    {"an end beyond the mesh",
     [](Cloth& c) {
       c.seams = {{0, 117}};
     },
     "/cloths/0/seams/0: the seam's end 117 is no vertex of the mesh (0 to 80)"},
    {"one vertex",
     [](Cloth& c) {
       c.seams = {{0, 80}, {5, 5}};
     },
     "/cloths/0/seams/1: the seam joins vertex 5 to itself (two vertices)"},
    {"one triangle",
     [](Cloth& c) {
       c.seams = {{0, 80}, {80, 1}};
     },
     "/cloths/0/seams: vertices 0 and 1 of one triangle are sewn together (at most one corner of a "
     "triangle to each group that seams make one)"},
    {"a loose edge beyond the mesh",
     [](Cloth& c) {
       auto mesh = std::make_shared<TriangleMesh>(*c.mesh.shape);
       mesh->edges = {{0, 81}};
       c.mesh.shape = mesh;
       c.sewing = true;
     },
     "/cloths/0/sewing: a loose edge of the mesh is not of its vertices (0 to 80)"},
    {"many in one place",
     [](Cloth& c) {
       c.mesh.shape = made_up({.nx = 30, .ny = 30});
       for (int n = 1; n < 70; ++n) c.seams.push_back({0, n * 12 + 5});
     },
     "/cloths/0/seams: vertex 0 and 69 others are sewn together (at most 64 vertices in one "
     "place)"},
    {"a grid",
     [](Cloth& c) {
       c = Cloth{};
       c.sewing = true;
     },
     "/cloths/0/sewing: sewing is on (with a mesh alone, not with a grid)"},
};

TEST(MeshSeams, RefusesWhatCannotBeSewn) {
  for (const Wrong& wrong : kWrong) {
    Scene scene = scene_of(made_up({}));
    wrong.set(scene.cloths[0]);
    std::string told;
    for (const Fault& f : validate(scene)) told += f.place + ": " + f.what + " (" + f.allowed + ")";
    EXPECT_EQ(told, wrong.fault) << wrong.what;
  }
}

}  // namespace
}  // namespace weft
