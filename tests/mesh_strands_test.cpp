// What sweeps of a mesh are made of: strands of its edges, and attachments along its surface.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "mesh_scenes.h"
#include "physics/model/mesh/mesh_attachments.h"
#include "physics/model/mesh/mesh_edges.h"
#include "physics/model/mesh/strands.h"
#include "weft/vec3.h"

namespace weft {
namespace {

TEST(MeshStrands, MakesStrandsOfAllEdges) {
  for (const double shift : {0.0, 0.3}) {
    const auto mesh = made_up({.nx = 20, .ny = 17, .shift = shift, .shuffled = true});
    const auto edges = physics::edges_of(*mesh, mesh->vertices);
    const auto strands = physics::strands_of(edges, mesh->vertices);
    std::vector<int> met(edges.ends.size());
    for (const auto& s : strands) {
      EXPECT_EQ(s.vertices.size(), s.edges.size() + 1);
      EXPECT_EQ(std::set<int>(s.vertices.begin(), s.vertices.end()).size(), s.vertices.size());
      for (std::size_t n = 0; n < s.edges.size(); ++n) {
        ++met[std::size_t(s.edges[n])];
        const physics::Joined ends{std::min(s.vertices[n], s.vertices[n + 1]),
                                   std::max(s.vertices[n], s.vertices[n + 1])};
        EXPECT_EQ(edges.ends[std::size_t(s.edges[n])], ends);
      }
    }
    EXPECT_EQ(met, std::vector<int>(edges.ends.size(), 1));
    int solved = 0;
    for (const auto& colour : physics::coloured_strands(strands, int(mesh->vertices.size()))) {
      std::set<int> there;
      for (const int n : colour)
        for (const int v : strands[std::size_t(n)].vertices) EXPECT_TRUE(there.insert(v).second);
      solved += int(colour.size());
    }
    EXPECT_EQ(solved, int(strands.size()));
  }
}

// On a flat mesh the way to a pin is the straight line; what is told is never less.
TEST(MeshStrands, TethersAreAsLongAsTheWayOverTheMesh) {
  for (const double shift : {0.0, 0.3}) {
    const auto mesh = made_up({.nx = 31, .ny = 31, .shift = shift, .shuffled = true});
    const int a = nearest_vertex(*mesh, {0, 0, 0}), b = nearest_vertex(*mesh, {1, 0, 0.5});
    double most = 0, mean = 0;
    int count = 0;
    for (const auto& slot : physics::mesh_attachments(*mesh, mesh->vertices, {a, b}))
      for (std::size_t p = 0; p < slot.size(); ++p) {
        if (slot[p].pin < 0) continue;
        const Vec3 e = minus(mesh->vertices[p], mesh->vertices[std::size_t(slot[p].pin)]);
        const double over = slot[p].reach / length(e) - 1;
        EXPECT_GT(over, -1e-9);
        most = std::max(most, over);
        mean += over;
        ++count;
      }
    EXPECT_EQ(count, 2 * (31 * 31 - 2));
    EXPECT_LT(most, 0.06);
    EXPECT_LT(mean / count, 0.005);
  }
}

// Pins that edges join are one group, of which a vertex has the nearest; and nothing is farther away than it may.

}  // namespace
}  // namespace weft
