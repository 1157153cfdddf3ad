// Mesh files that tests make: .ply in all its forms, and glTF documents of one triangle.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "output/bytes.h"
#include "scene/base64.h"
#include "scene/json_text.h"
#include "weft/mesh.h"

namespace weft {

inline std::string told(const MeshFile& file) {
  std::string text;
  for (const auto& f : file.faults) text += f.place + ": " + f.what + " (" + f.allowed + ")\n";
  for (const auto& note : file.notes) text += note + "\n";
  return text;
}

// Two squares side by side, bent, the second a quadrilateral.
inline const std::vector<Vec3> kPlaces = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0},
                                          {0, 1, 0}, {2, 0, 1}, {2, 1, 1}};
inline const std::vector<std::vector<int>> kFaces = {{0, 1, 2}, {0, 2, 3}, {1, 4, 5, 2}};
inline const std::vector<std::array<int, 3>> kTriangles = {
    {0, 1, 2}, {0, 2, 3}, {2, 1, 4}, {4, 5, 2}};

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

// A document of one triangle, to be changed.
inline text::Json triangle(std::string* data) {
  std::string bytes;
  for (const int index : {0, 1, 2, 0}) append_little_endian(bytes, std::uint16_t(index));
  for (const float x : {0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F})
    append_little_endian(bytes, x);
  if (data) *data = bytes;
  return text::Json::parse(R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
    "nodes": [{"mesh": 0, "name": "leaf"}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 1}, "indices": 0}]}],
    "accessors": [{"bufferView": 0, "componentType": 5123, "count": 3, "type": "SCALAR"},
                  {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC3"}],
    "bufferViews": [{"buffer": 0, "byteLength": 8}, {"buffer": 0, "byteOffset": 8, "byteLength": 36}],
    "buffers": [{"byteLength": 44, "uri": "data:application/octet-stream;base64,)" +
                           base64(bytes) + R"("}]})");
}

inline std::string glb(const text::Json& document, const std::string& data) {
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

}  // namespace weft
