// Meshes of .gltf and .glb: where they stand, what their numbers may be, and what is wrong with one.
#include <gtest/gtest.h>

#include <cmath>

#include "folder.h"
#include "made_up_files.h"
#include "made_up_mesh.h"
#include "weft/output.h"
#include "weft/simulation.h"

namespace weft {
namespace {

using Json = text::Json;

TEST(MeshGltf, BuffersLieInTheFileOrBesideIt) {
  const Folder folder;
  std::string data;
  Json document = triangle(&data);
  const auto expect_triangle = [](const MeshFile& file) {
    EXPECT_EQ(told(file), "");
    EXPECT_EQ(file.mesh.vertices, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    EXPECT_EQ(file.mesh.triangles, (std::vector<std::array<int, 3>>{{0, 1, 2}}));
    ASSERT_EQ(file.mesh.groups.size(), 1u);
    EXPECT_EQ(file.mesh.groups[0].name, "leaf");
  };
  expect_triangle(read_gltf(document.dump(), "a.gltf", ""));
  document["buffers"][0]["uri"] = "one%20leaf.bin";
  folder.write("one leaf.bin", data);
  expect_triangle(read_mesh(folder.write("a.gltf", document.dump())));
  document["buffers"][0].erase("uri");
  expect_triangle(read_mesh(folder.write("a.GLB", glb(document, data))));
}

TEST(MeshGltf, NodesPlaceTheirMeshes) {
  Json document = triangle(nullptr);
  document["nodes"] = Json::parse(R"([
    {"children": [1, 2], "translation": [0, 0, 3], "rotation": [0, 0, 0.7071067811865476, 0.7071067811865476]},
    {"mesh": 0, "scale": [2, 1, 1]},
    {"mesh": 0, "matrix": [-1,0,0,0, 0,1,0,0, 0,0,1,0, 5,0,0,1]}])");
  const MeshFile file = read_gltf(document.dump(), "a.gltf", "");
  EXPECT_EQ(told(file), "");
  ASSERT_EQ(file.mesh.vertices.size(), 6u);
  const std::vector<Vec3> expected = {{0, 0, 3}, {0, 2, 3}, {-1, 0, 3},
                                      {0, 5, 3}, {0, 4, 3}, {-1, 5, 3}};
  for (std::size_t n = 0; n < 6; ++n)
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(file.mesh.vertices[n][k], expected[n][k], 1e-12) << n;
  // A mirror turns the triangle, so that it looks the same way as before.
  EXPECT_EQ(file.mesh.triangles[1], (std::array<int, 3>{3, 5, 4}));
}

TEST(MeshGltf, StripsFansTypesAndStrides) {
  std::string data;
  for (const int index : {0, 1, 2, 3}) data += char(index);
  for (const int x :
       {0, 0, 1, 0, 0, 1, 1, 1}) {  // four places in two of three bytes and one between
    data += char(x * 127);
    if (data.size() % 4 == 2) data += std::string("\0\0", 2);
  }
  Json document = triangle(nullptr);
  document["accessors"] = Json::parse(
      R"([{"bufferView": 0, "componentType": 5121, "count": 4, "type": "SCALAR"},
          {"bufferView": 1, "componentType": 5120, "count": 4, "type": "VEC3", "normalized": true}])");
  document["bufferViews"] = Json::parse(
      R"([{"buffer": 0, "byteLength": 4}, {"buffer": 0, "byteOffset": 4, "byteLength": 16, "byteStride": 4}])");
  document["buffers"] = Json::parse(R"([{"byteLength": 20}])");
  for (const int mode : {5, 6}) {
    document["meshes"][0]["primitives"][0]["mode"] = mode;
    const MeshFile file = read_gltf(glb(document, data), "a.glb", "");
    ASSERT_EQ(file.faults.size(), 0u) << told(file);
    EXPECT_EQ(file.mesh.vertices[3], (Vec3{1, 1, 0}));
    EXPECT_EQ(file.mesh.triangles.size(), 2u);
    EXPECT_EQ(file.mesh.triangles[0], (std::array<int, 3>{0, 1, 2}));
    EXPECT_EQ(told(file), "");
  }
}

TEST(MeshGltf, WhatIsWrongIsNamed) {
  const auto fault = [](const char* place, const char* value) {
    Json document = triangle(nullptr);
    document[Json::json_pointer(place)] = Json::parse(value);
    return told(read_gltf(document.dump(), "a.gltf", ""));
  };
  EXPECT_EQ(fault("/asset/version", "\"1.0\""),
            "a.gltf:/asset/version: the version is \"1.0\" (2.0)\n");
  EXPECT_EQ(
      fault("/accessors/1/count", "4000000000"),
      "a.gltf:/accessors/1/count: 4000000000 is out of place (a whole number, 0 to 4194304)\n");
  EXPECT_EQ(
      fault("/accessors/1/count", "4"),
      "a.gltf:/accessors/1: the accessor reaches to byte 48 of its view (36 at most, which the "
      "view has)\n");
  EXPECT_EQ(fault("/accessors/0/componentType", "5121")
                .rfind("a.gltf, /meshes/0/primitives/0, triangle 0: ", 0),
            std::string::npos);  // 0, 0 and 1: nothing is left of it
  EXPECT_EQ(fault("/accessors/0/type", "\"VEC2\""),
            "a.gltf:/accessors/0/type: \"VEC2\" is out of place (SCALAR)\n");
  EXPECT_EQ(fault("/accessors/0/sparse", "{}"),
            "a.gltf:/accessors/0/sparse: count is missing (every key that glTF 2.0 asks for)\n");
  EXPECT_EQ(
      fault("/bufferViews/1/byteOffset", "1099511627776"),
      "a.gltf:/bufferViews/1: the view reaches to byte 1099511627812 of its buffer (44 at most, "
      "which the buffer has)\n");
  EXPECT_EQ(fault("/bufferViews/1/byteStride", "4"),
            "a.gltf:/bufferViews/1/byteStride: elements of 12 bytes are 4 apart (12 to 252)\n");
  EXPECT_EQ(fault("/buffers/0/byteLength", "45"),
            "a.gltf:/buffers/0/byteLength: the buffer is to have 45 bytes (44, which are there)\n");
  for (const char* uri : {"\"/etc/passwd\"", "\"../a.bin\"", "\"http://a.org/b\"", "\"%2Fetc\""})
    EXPECT_EQ(
        fault("/buffers/0/uri", uri),
        "a.gltf:/buffers/0/uri: the address is of no file beside this one (a file in the same "
        "folder or below, or data:…;base64,…)\n");
  EXPECT_EQ(fault("/nodes/0/children", "[0]"),
            "a.gltf:/nodes/0: the node has two parents, or is below itself (a tree of nodes)\n");
  EXPECT_EQ(
      fault("/nodes/0/scale", "[1, 1e300, 1]"),
      "a.gltf:/meshes/0/primitives/0/attributes/POSITION: vertex 2 lies at 1e300 (-1e9 to 1e9, "
      "with the transforms of its nodes)\n");
  EXPECT_EQ(fault("/meshes/0/primitives/0/indices", "7"),
            "a.gltf:/accessors: there is no item 7 (0 to 1)\n");
  EXPECT_EQ(
      fault("/extensionsRequired", "[\"KHR_draco_mesh_compression\"]"),
      "a.gltf:/extensionsRequired/0: the extension \"KHR_draco_mesh_compression\" is needed to "
      "read the file (plain triangles, without compression)\n");
  EXPECT_EQ(fault("/meshes/0/primitives/0/mode", "0"),
            "a.gltf: the mesh has no faces (at least one)\n"
            "a.gltf: 1 primitives that are no triangles are left out\n");
}

// What is exported comes back: vertices in their order, triangles, texture coordinates.
TEST(MeshGltf, WhatIsExportedIsReadBack) {
  const Folder folder;
  for (const char* name : {"run.glb", "run.gltf"})
    for (const bool mapped : {false, true}) {
      Scene scene;
      auto mesh = made_up({.nx = 9, .ny = 7, .shift = 0.3, .shuffled = true});
      for (std::size_t t = 0; mapped && t < mesh->triangles.size(); ++t) {
        auto& uv = mesh->uv.emplace_back();
        for (std::size_t k = 0; k < 3; ++k) {  // two pieces, which part vertices between them
          const Vec3& p = mesh->vertices[std::size_t(mesh->triangles[t][k])];
          uv[k] = {p[0] + (t % 2 ? 4 : 0), p[2]};
        }
      }
      scene.cloths.emplace_back().mesh.shape = mesh;
      scene.cloths[0].mesh.translate = {3000, 1, -20};
      Simulation run(scene, {.threads = 1});
      auto animation = open_animation(folder / name, run.view(), 3);
      for (int n = 0; n < 3; ++n) {
        animation->append(run.view());
        run.advance_frame();
      }
      animation->complete();
      animation->commit();
      const MeshFile file = read_mesh(folder / name);
      ASSERT_TRUE(file.faults.empty()) << told(file);
      EXPECT_EQ(file.notes.size(), mapped ? 1u : 0u) << told(file);
      ASSERT_EQ(file.mesh.vertices.size(), mesh->vertices.size());
      EXPECT_EQ(file.mesh.triangles, mesh->triangles);
      ASSERT_EQ(file.mesh.uv.size(), mesh->uv.size());
      for (std::size_t v = 0; v < mesh->vertices.size(); ++v)
        for (std::size_t k = 0; k < 3; ++k)
          EXPECT_NEAR(file.mesh.vertices[v][k] - scene.cloths[0].mesh.translate[k],
                      mesh->vertices[v][k], 1e-6);
      for (std::size_t t = 0; t < mesh->uv.size(); ++t)
        for (std::size_t k = 0; k < 6; ++k)
          EXPECT_NEAR(file.mesh.uv[t][k / 2][k % 2], mesh->uv[t][k / 2][k % 2], 1e-6);
    }
}

}  // namespace
}  // namespace weft
