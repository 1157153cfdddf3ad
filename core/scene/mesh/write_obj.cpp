// TriangleMesh -> Wavefront .obj. Numbers are written so that they read back to the same bits.
#include <charconv>

#include "weft/mesh.h"

namespace weft {
namespace {

template <class Number>
void append(std::string& text, Number value) {
  char digits[32];
  text.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

template <class Numbers>
void append_line(std::string& text, const char* key, const Numbers& numbers) {
  text += key;
  for (const auto value : numbers) {
    text += ' ';
    append(text, value);
  }
  text += '\n';
}

// The face's corners; the three texture coordinates of triangle t come after those of the ones before.
void append_face(std::string& text, const TriangleMesh& mesh, std::size_t t) {
  text += 'f';
  for (std::size_t k = 0; k < 3; ++k) {
    text += ' ';
    append(text, mesh.triangles[t][k] + 1);
    if (mesh.uv.empty()) continue;
    text += '/';
    append(text, 3 * t + k + 1);
  }
  text += '\n';
}

}  // namespace

std::string write_obj(const TriangleMesh& mesh) {
  std::string text;
  for (const Vec3& at : mesh.vertices) append_line(text, "v", at);
  for (const auto& corners : mesh.uv)
    for (const TriangleMesh::Uv& at : corners) append_line(text, "vt", at);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) append_face(text, mesh, t);
  for (const auto& [a, b] : mesh.edges) append_line(text, "l", std::array{a + 1, b + 1});
  return text;
}

}  // namespace weft
