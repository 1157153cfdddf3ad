// Meshes of .ply: the same mesh from every form of it, and what is wrong with one.
#include <gtest/gtest.h>

#include "made_up_files.h"

namespace weft {
namespace {

TEST(MeshPly, EveryFormGivesTheSameMesh) {
  for (const Order order : {Order::text, Order::little, Order::big})
    for (const char* real : {"float", "double", "short", "int32"})
      for (const char* whole : {"uchar", "short", "ushort", "int", "uint"})
        for (const bool uv : {false, true}) {
          const MeshFile file = read_ply(Ply(order, real, whole).write(uv, true), "a.ply");
          EXPECT_EQ(told(file), "") << real << " " << whole;
          EXPECT_EQ(file.mesh.vertices, kPlaces);
          EXPECT_EQ(file.mesh.triangles, kTriangles);
          EXPECT_EQ(file.mesh.edges, (std::vector<std::array<int, 2>>{{3, 5}}));
          ASSERT_EQ(file.mesh.uv.size(), uv ? 4u : 0u);
          if (uv) {
            EXPECT_EQ(file.mesh.uv[3][1], (TriangleMesh::Uv{2, 0.5}));
          }
        }
}

TEST(MeshPly, CopiesForTextureCoordinatesAreOneVertex) {
  const std::string text =
      "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\n"
      "property float z\nproperty float u\nproperty float v\nelement face 2\n"
      "property list uchar int vertex_index\nend_header\n"
      "0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n1 0 0 5 5\n1 1 0 6 5\n3 0 1 2\n3 3 4 2\n";
  const MeshFile file = read_ply(text, "a.ply");
  EXPECT_EQ(
      told(file),
      "a.ply: 1 vertex lies exactly where another one does, as copies for texture coordinates and "
      "normals do; those of one place are one\n");
  EXPECT_EQ(file.mesh.vertices.size(), 4u);
  EXPECT_EQ(file.mesh.triangles[1], (std::array<int, 3>{1, 3, 2}));
  EXPECT_EQ(file.mesh.uv[1][0], (TriangleMesh::Uv{5, 5}));
}

TEST(MeshPly, WhatIsWrongIsNamed) {
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
      "property float y\nproperty float z\n";
  const std::string faces = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  const auto fault = [](const std::string& text) { return told(read_ply(text, "a.ply")); };
  EXPECT_EQ(fault(""), "a.ply:1: the file does not begin as a .ply file does (ply)\n");
  EXPECT_EQ(
      fault("ply\nformat ascii 2.0\n"),
      "a.ply:2: the format is \"ascii\", version \"2.0\" (format ascii, binary_little_endian or "
      "binary_big_endian, version 1.0)\n");
  EXPECT_EQ(fault("ply\nformat ascii 1.0\nelement vertex 5000000\n"),
            "a.ply:3: the mesh has 5000000 vertices (at most 4194304)\n");
  EXPECT_EQ(fault("ply\nformat ascii 1.0\nelement face -1\n"),
            "a.ply:3: \"-1\" is no count of elements (a whole number from 0 on)\n");
  EXPECT_EQ(fault(head + "property half w\n"),
            "a.ply:7: \"half\" is no type of numbers (char to double, int8 to float64)\n");
  EXPECT_EQ(fault(head), "a.ply:7: the header does not end (end_header)\n");
  EXPECT_EQ(fault(head + faces + "0 0 0\n1 0 nan\n"),
            "a.ply:11: nan is no coordinate (numbers, -1e9 to 1e9)\n");
  EXPECT_EQ(fault(head + faces + "0 0 0\n1 0\n"),
            "a.ply:11: a number is missing (as many numbers as the header says)\n");
  EXPECT_EQ(fault(head + faces + "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n"),
            "a.ply:13: there is no vertex 3 (0 to 2)\n");
  EXPECT_EQ(fault(head + faces + "0 0 0\n1 0 0\n0 1 0\n"),
            "a.ply:12: the file ends early (as many rows as its header says)\n");
  EXPECT_EQ(
      fault(head + faces + "0 0 0\n1 0 0\n2 0 0\n3 0 1 2\n"),
      "a.ply:13: the triangle of vertices 0, 1 and 2 has no area (three corners that are not in "
      "line)\n");
  std::string big = Ply(Order::big, "float", "int").write(false, false);
  big.pop_back();
  EXPECT_EQ(fault(big), "a.ply, face 2: the file ends early (as many rows as its header says)\n");
}

}  // namespace
}  // namespace weft
