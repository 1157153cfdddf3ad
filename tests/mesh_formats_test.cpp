// Meshes of .ply, .gltf and .glb: the same mesh from every form of it, and any bytes are read or refused.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "folder.h"
#include "made_up_bodies.h"
#include "made_up_mesh.h"
#include "output/bytes.h"
#include "scene/base64.h"
#include "scene/json_text.h"
#include "weft/output.h"
#include "weft/read_scene.h"
#include "weft/simulation.h"

namespace weft {
namespace {

using Json = text::Json;

std::string told(const MeshFile& file) {
  std::string text;
  for (const auto& f : file.faults) text += f.place + ": " + f.what + " (" + f.allowed + ")\n";
  for (const auto& note : file.notes) text += note + "\n";
  return text;
}

// Two squares side by side, bent, the second a quadrilateral.
const std::vector<Vec3> kPlaces = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0},
                                   {0, 1, 0}, {2, 0, 1}, {2, 1, 1}};
const std::vector<std::vector<int>> kFaces = {{0, 1, 2}, {0, 2, 3}, {1, 4, 5, 2}};
const std::vector<std::array<int, 3>> kTriangles = {{0, 1, 2}, {0, 2, 3}, {2, 1, 4}, {4, 5, 2}};

enum class Order { text, little, big };

// A .ply of those faces, with numbers of the named types.
class Ply {
 public:
  Ply(Order order, std::string real, std::string whole)
      : order_(order), real_(std::move(real)), whole_(std::move(whole)) {}

  std::string write(bool uv, bool edge) {
    bytes_ = "ply\nformat " +
             std::string(order_ == Order::text     ? "ascii"
                         : order_ == Order::little ? "binary_little_endian"
                                                   : "binary_big_endian") +
             " 1.0\ncomment made up\nelement vertex 6\n";
    for (const char* name : {"x", "y", "z"}) bytes_ += "property " + real_ + " " + name + "\n";
    bytes_ += "property uchar red\n";
    if (uv) bytes_ += "property float s\nproperty float t\n";
    bytes_ += "element thing 2\nproperty list uchar short of\n";
    bytes_ += "element face 3\nproperty list uchar " + whole_ + " vertex_indices\n";
    if (edge) bytes_ += "element edge 1\nproperty int vertex1\nproperty int vertex2\n";
    bytes_ += "end_header\n";
    for (const Vec3& p : kPlaces) {
      for (const double value : p) number(real_, value);
      number("uchar", 200);
      if (uv) number("float", p[0]), number("float", 0.5 * p[1]);
      end();
    }
    for (const int count : {0, 2}) {
      number("uchar", count);
      for (int n = 0; n < count; ++n) number("short", -7);
      end();
    }
    for (const auto& face : kFaces) {
      number("uchar", double(face.size()));
      for (const int corner : face) number(whole_, corner);
      end();
    }
    if (edge) number("int", 3), number("int", 5), end();
    return bytes_;
  }

 private:
  template <class T>
  void put(double value) {
    if (order_ == Order::text)
      bytes_ += std::to_string(T(value)) + " ";
    else if (order_ == Order::little)
      append_little_endian(bytes_, T(value));
    else
      append_big_endian(bytes_, T(value));
  }
  void number(const std::string& type, double value) {
    if (type == "uchar") put<std::uint8_t>(value);
    if (type == "short") put<std::int16_t>(value);
    if (type == "ushort") put<std::uint16_t>(value);
    if (type == "int" || type == "int32") put<std::int32_t>(value);
    if (type == "uint") put<std::uint32_t>(value);
    if (type == "float" || type == "float32") put<float>(value);
    if (type == "double") put<double>(value);
  }
  void end() {
    if (order_ == Order::text) bytes_ += "\n";
  }

  Order order_;
  std::string real_, whole_, bytes_;
};

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

// A document of one triangle, to be changed.
Json triangle(std::string* data) {
  std::string bytes;
  for (const int index : {0, 1, 2, 0}) append_little_endian(bytes, std::uint16_t(index));
  for (const float x : {0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F})
    append_little_endian(bytes, x);
  if (data) *data = bytes;
  return Json::parse(R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
    "nodes": [{"mesh": 0, "name": "leaf"}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 1}, "indices": 0}]}],
    "accessors": [{"bufferView": 0, "componentType": 5123, "count": 3, "type": "SCALAR"},
                  {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC3"}],
    "bufferViews": [{"buffer": 0, "byteLength": 8}, {"buffer": 0, "byteOffset": 8, "byteLength": 36}],
    "buffers": [{"byteLength": 44, "uri": "data:application/octet-stream;base64,)" +
                     base64(bytes) + R"("}]})");
}

std::string glb(const Json& document, const std::string& data) {
  std::string text = document.dump();
  text.append((4 - text.size() % 4) % 4, ' ');
  std::string bytes = "glTF";
  for (const std::size_t value :
       {std::size_t(2), 28 + text.size() + data.size(), text.size(), std::size_t(0x4E4F534A)})
    append_little_endian(bytes, std::uint32_t(value));
  bytes += text;
  append_little_endian(bytes, std::uint32_t(data.size()));
  append_little_endian(bytes, std::uint32_t(0x004E4942));
  return bytes + data;
}

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
  EXPECT_EQ(
      fault("/accessors/0/sparse", "{}"),
      "a.gltf:/accessors/0/sparse: the accessor is sparse (accessors that list all values)\n");
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
            "a.gltf:/accessors: there is no item 7 (0 to 2 less 1)\n");
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

// Scenes take them for cloth, for shapes at rest and for bodies.
TEST(MeshFormats, ScenesNameThem) {
  const Folder folder;
  folder.write("sheet.ply", Ply(Order::little, "float", "int").write(false, false));
  Json document = triangle(nullptr);
  folder.write("leaf.gltf", document.dump());
  const SceneFile file = read_scene(folder.write("scene.json", R"({"weft": 1,
      "cloths": [{"mesh": {"file": "sheet.ply", "rest": "sheet.ply", "translate": [0, 1, 0]}},
                 {"mesh": {"file": "leaf.gltf"}, "pins": [{"group": "leaf"}]}],
      "colliders": [{"mesh": {"file": "leaf.gltf"}, "offset": 0.01}]})"));
  ASSERT_TRUE(file.faults.empty()) << file.faults[0].place << ": " << file.faults[0].what;
  Simulation run(file.scene, {.threads = 1});
  run.advance_frame();
  EXPECT_TRUE(run.status().ok);
  const SceneFile wrong = read_scene(folder.write("wrong.json", R"({"weft": 1,
      "cloths": [{"mesh": {"file": "none.ply"}}]})"));
  ASSERT_EQ(wrong.faults.size(), 1u);
  EXPECT_EQ(wrong.faults[0].place, "/cloths/0/mesh/file");
  EXPECT_EQ(wrong.faults[0].what, (folder / "none.ply") + ": there is no such mesh file");
}

std::string broken(std::string bytes, std::mt19937& random) {
  const std::vector<std::string> words = {"0",    "-1",    "1e9",    "nan",   "4294967295",
                                          "list", "uint",  "double", "1e400", "[0,0]",
                                          "null", "\"a\"", "{}",     "5126",  "3"};
  for (auto k = random() % 4; k > 0 && !bytes.empty(); --k) {
    const std::size_t at = random() % bytes.size();
    switch (random() % 5) {
      case 0:
        bytes[at] = char(random() % 256);
        break;
      case 1:
        bytes.erase(at, 1 + random() % 20);
        break;
      case 2:
        bytes.insert(at, bytes.substr(random() % bytes.size(), random() % 30));
        break;
      case 3:
        bytes.resize(at);
        break;
      default: {
        const std::size_t end = std::min(bytes.find_first_of(" ,}]\n", at), bytes.size());
        bytes.replace(at, end - at, words[random() % words.size()]);
      }
    }
  }
  return bytes;
}

TEST(MeshFormats, AnyBytesAreReadOrRefused) {
  std::mt19937 random(1);
  std::string data;
  Json document = triangle(&data);
  Json inside = document;
  inside["buffers"][0].erase("uri");
  const std::vector<std::string> plys = {Ply(Order::text, "float", "int").write(true, true),
                                         Ply(Order::little, "double", "ushort").write(true, true),
                                         Ply(Order::big, "float", "uint").write(false, true)};
  const std::vector<std::string> gltfs = {document.dump(), glb(inside, data)};
  int read = 0, refused = 0;
  for (int n = 0; n < 24000; ++n) {
    const bool ply = n % 2 == 0;
    const auto& originals = ply ? plys : gltfs;
    const std::string bytes = broken(originals[random() % originals.size()], random);
    const std::string name = ply ? "m.ply" : "m.glb";
    const MeshFile file = ply ? read_ply(bytes, name) : read_gltf(bytes, name, "/nowhere");
    for (const Fault& fault : file.faults) {
      ASSERT_EQ(fault.place.rfind(name, 0), 0u) << bytes;
      ASSERT_FALSE(fault.what.empty() || fault.allowed.empty()) << bytes;
    }
    (file.faults.empty() ? read : refused) += 1;
    if (!file.faults.empty()) continue;
    ASSERT_FALSE(file.mesh.triangles.empty());
    ASSERT_TRUE(file.mesh.uv.empty() || file.mesh.uv.size() == file.mesh.triangles.size());
    for (const auto& t : file.mesh.triangles)
      for (const int corner : t)
        ASSERT_TRUE(corner >= 0 && std::size_t(corner) < file.mesh.vertices.size());
    for (const Vec3& p : file.mesh.vertices)
      for (const double value : p) ASSERT_TRUE(std::abs(value) <= 1e9);
  }
  EXPECT_GT(read, 3000);
  EXPECT_GT(refused, 8000);
}

}  // namespace
}  // namespace weft
