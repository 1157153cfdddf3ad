// Wavefront files -> triangle meshes: polygons, groups, uv; what is repaired and what is refused.
#include <gtest/gtest.h>

#include <cmath>

#include "scene/mesh/faces.h"
#include "weft/mesh.h"

namespace {

using weft::MeshFile;
using weft::read_obj;

std::string told(const MeshFile& file) {
  std::string text;
  for (const auto& f : file.faults) text += f.place + ": " + f.what + " (" + f.allowed + ")\n";
  for (const auto& note : file.notes) text += note + "\n";
  return text;
}

const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

double area(const weft::TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const auto &p = mesh.vertices[std::size_t(a)], &q = mesh.vertices[std::size_t(b)],
               &r = mesh.vertices[std::size_t(c)];
    sum += 0.5 * ((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]));
  }
  return sum;
}

TEST(MeshFile, KeepsVerticesGroupsUvAndLooseEdges) {
  const MeshFile file =
      read_obj("# a square\nmtllib x.mtl\no sheet\n" + kSquare +
                   "vt 0 0\nvt 2 0\nvt 2 2\nvt 0 2\nvn 0 0 1\ng left\nf 1/1/1 2/2/1 3/3/1\n"
                   "g right\nf -4/-4 -2/-2 -1/-1\nl 2 4 3\n",
               "a.obj");
  EXPECT_EQ(told(file), "");
  EXPECT_EQ(file.mesh.vertices.size(), 4u);
  EXPECT_EQ(file.mesh.triangles, (std::vector<std::array<int, 3>>{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_EQ(file.mesh.uv[1][2], (weft::TriangleMesh::Uv{0, 2}));
  EXPECT_EQ(file.mesh.edges, (std::vector<std::array<int, 2>>{{1, 3}}));
  ASSERT_EQ(file.mesh.groups.size(), 3u);
  EXPECT_EQ(file.mesh.groups[0].name, "left");
  EXPECT_EQ(file.mesh.groups[0].vertices, (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(file.mesh.groups[2].vertices, (std::vector<int>{0, 1, 2, 3}));
}

// Of any simple polygon, convex or not, the triangles add up to its area and none is turned over.
TEST(MeshFile, CutsPolygonsIntoTriangles) {
  for (const int corners : {4, 5, 8, 21})
    for (const double inner : {1.0, 0.5, 0.2}) {
      std::string text, face = "f";
      double expected = 0;
      std::vector<std::array<double, 2>> at;
      for (int k = 0; k < corners; ++k) {
        const double r = k % 2 ? inner : 1, angle = 2 * M_PI * k / corners;
        at.push_back({r * std::cos(angle), r * std::sin(angle)});
        text += "v " + std::to_string(at.back()[0]) + " " + std::to_string(at.back()[1]) + " 0\n";
        face += " " + std::to_string(k + 1);
      }
      for (int k = 0; k < corners; ++k) {
        const auto &p = at[std::size_t(k)], &q = at[std::size_t((k + 1) % corners)];
        expected += 0.5 * (p[0] * q[1] - p[1] * q[0]);
      }
      const MeshFile file = read_obj(text + face + "\n", "p.obj");
      EXPECT_EQ(told(file), "");
      EXPECT_EQ(int(file.mesh.triangles.size()), corners - 2);
      EXPECT_NEAR(area(file.mesh), expected, 1e-4);
      for (const auto& t : file.mesh.triangles) {
        weft::TriangleMesh one = file.mesh;
        one.triangles = {t};
        EXPECT_GT(area(one), 0) << corners << " corners, " << inner;
      }
    }
}

TEST(MeshFile, RepairsAndSaysSo) {
  const MeshFile file =
      read_obj(kSquare + "v 9 9 9\nf 1 2 3\nf 3 1 2\nf 1 4 3\nf 1 1 2\n", "r.obj");
  EXPECT_EQ(told(file),
            "r.obj: 1 face repeats a vertex, first in line 9; the repeated corners are left out\n"
            "r.obj: 1 triangle is given twice, first in line 7; each counts once\n"
            "r.obj: 1 triangle is turned over to agree with the others, first in line 8\n"
            "r.obj: 1 vertex belongs to no face, first vertex 5; what has no face has no mass and "
            "stays where it is\n");
  EXPECT_DOUBLE_EQ(area(file.mesh), 1);
}

TEST(MeshFile, TellsOfAMoebiusBand) {
  std::string text, faces;
  constexpr int n = 12;
  for (int k = 0; k < n; ++k)
    for (const int side : {-1, 1}) {
      const double a = 2 * M_PI * k / n, w = 0.2 * side;
      text += "v " + std::to_string((1 + w * std::cos(a / 2)) * std::cos(a)) + " " +
              std::to_string((1 + w * std::cos(a / 2)) * std::sin(a)) + " " +
              std::to_string(w * std::sin(a / 2)) + "\n";
    }
  for (int k = 0; k < n; ++k) {
    const bool last = k == n - 1;
    const int a = 2 * k + 1, b = 2 * k + 2, c = last ? 2 : a + 2, d = last ? 1 : b + 2;
    faces += "f " + std::to_string(a) + " " + std::to_string(c) + " " + std::to_string(d) + " " +
             std::to_string(b) + "\n";
  }
  EXPECT_EQ(told(read_obj(text + faces, "m.obj")),
            "m.obj: the surface has one side only (a Moebius band); its normals jump somewhere\n");
}

struct Bad {
  const char* text;
  const char* told;
};

TEST(MeshFile, RefusesWhatIsNoClothAndNamesTheLine) {
  for (const Bad& bad : {
           Bad{"", "b.obj: the mesh has no faces (at least one)\n"},
           Bad{"v 0 nan 0\n", "b.obj:1: \"nan\" is no coordinate (numbers, -1e9 to 1e9)\n"},
           Bad{"v 0 1e999 0\n", "b.obj:1: \"1e999\" is no coordinate (numbers, -1e9 to 1e9)\n"},
           Bad{"v 0 0\n", "b.obj:1: a number is missing (numbers, -1e9 to 1e9)\n"},
           Bad{"f 1 2 3\n", "b.obj:1: there is no vertex \"1\" (none comes before)\n"},
           Bad{"v 0 0 0\nf 1 0 9\n",
               "b.obj:2: there is no vertex \"0\" (1 to 1, or from -1 down)\n"},
           Bad{"v 0 0 0\nf 1/7 1 1\n",
               "b.obj:2: there is no texture coordinate \"7\" (none comes before)\n"},
           Bad{"v 0 0 0\nf 1\n", "b.obj:2: the face has 1 corners (3 to 256)\n"},
           Bad{"v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n",
               "b.obj:4: the triangle of vertices 1, 2 and 3 has no area (three corners that are "
               "not "
               "in line)\n"},
           Bad{"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 -1 0\nf 1 2 3\nf 1 2 4\nf 1 2 5\n",
               "b.obj:8: the edge from vertex 1 to 2 has 3 triangles (one or two)\n"},
       })
    EXPECT_EQ(told(read_obj(bad.text, "b.obj")), bad.told) << bad.text;
  EXPECT_EQ(told(weft::read_mesh("/no/such.obj")),
            "/no/such.obj: there is no such mesh file (a readable file)\n");
  EXPECT_EQ(told(weft::read_mesh("a.txt")),
            "a.txt: the file is of no known kind (.obj, .ply, .glb, .gltf)\n");
  EXPECT_EQ(told(weft::read_mesh("obj")),
            "obj: the file is of no known kind (.obj, .ply, .glb, .gltf)\n");
  EXPECT_EQ(told(weft::read_mesh("a.oBJ")),
            "a.oBJ: there is no such mesh file (a readable file)\n");
}

// Any bytes: no crash, and faults stay few.
TEST(MeshFile, LivesThroughAnyBytes) {
  const std::string words[] = {"v ",
                               "f ",
                               "vt ",
                               "l ",
                               "g ",
                               "1 ",
                               "-1 ",
                               "3/2/1 ",
                               "1e3 ",
                               "nan ",
                               "\n",
                               "\n",
                               "/",
                               "#",
                               "\t",
                               "\r\n",
                               "99999999999999999999 ",
                               "\xff"};
  unsigned seed = 1;
  const auto next = [&](unsigned n) { return (seed = seed * 1664525u + 1013904223u) / 65536u % n; };
  for (int n = 0; n < 3000; ++n) {
    std::string text;
    for (unsigned k = next(200); k > 0; --k) text += words[next(std::size(words))];
    EXPECT_LE(read_obj(text, "x.obj").faults.size(), weft::text::kMaxMeshFaults);
  }
}

}  // namespace
