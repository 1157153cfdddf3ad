// Stanford .ply -> TriangleMesh, in text or binary: elements vertex, face and edge; others are passed over.
// Where vertices carry texture coordinates or normals, those of one place are copies of one vertex.
#include <cmath>

#include "scene/mesh/ply_header.h"
#include "scene/mesh/polygons.h"
#include "scene/mesh/welding.h"
#include "scene/mesh/words.h"

namespace weft {
namespace text {
namespace {

using Uv = TriangleMesh::Uv;

// A row: the values of its properties one after the other, and where those of each begin.
struct Row {
  std::vector<double> values;
  std::vector<std::size_t> first;  // and how many there are

  double at(int property) const { return values[first[std::size_t(property)]]; }
  std::size_t size(int property) const {
    return first[std::size_t(property) + 1] - first[std::size_t(property)];
  }
};

class Reader {
 public:
  Reader(std::string_view bytes, const std::string& name, MeshFile& file)
      : bytes_(bytes), raw_{file, name} {
    raw_.first_vertex = 0;
  }

  void run() {
    header_ = read_ply_header(bytes_, raw_);
    if (!sound()) return;
    at_ = header_.bytes;
    line_ = header_.lines;
    if (!header_.ascii)
      raw_.words = [this](int row) { return element_ + " " + std::to_string(row - 1); };
    for (const PlyElement& element : header_.elements)
      if (sound()) read(element);
    element_ = "face";
    if (sound()) polygons_.finish();
  }

 private:
  TriangleMesh& mesh() { return raw_.file.mesh; }
  bool sound() const { return raw_.file.faults.empty(); }
  int place() const { return header_.ascii ? line_ : int(row_) + 1; }
  bool fault(std::string what, std::string allowed) {
    raw_.fault(place(), std::move(what), std::move(allowed));
    return false;
  }

  void read(const PlyElement& element) {
    element_ = element.name;
    kept_ = element_ == "vertex" || element_ == "face" || element_ == "edge";
    if (element.name == "vertex") {
      read_vertices(element);
    } else if (element.name == "face") {
      read_faces(element);
    } else if (element.name == "edge") {
      read_edges(element);
    } else if (element.name == "tristrips") {
      raw_.fault(0, "the file has triangle strips", "faces, one by one");
    } else if (header_.ascii || !element.properties.empty()) {
      for_each_row(element, [] { return true; });
    }
  }

  template <class Visit>
  void for_each_row(const PlyElement& element, const Visit& visit) {
    for (row_ = 0; row_ < element.count; ++row_)
      if (!(header_.ascii ? read_text(element) : read_binary(element)) || !visit()) return;
  }

  // Whether a list may be so long: 256 values for the corners of a face, and twice as many for their texture
  // coordinates.
  bool fits(double count) {
    const double most = kept_ ? 2.0 * double(kMaxCorners) : double(kMaxMeshBytes);
    return (count >= 0 && count <= most && count == std::floor(count)) ||
           fault("a list has " + number(count) + " values", kept_ ? "at most 512" : "from 0 on");
  }

  static std::string number(double value) {
    return std::abs(value) < 1e15 && value == std::floor(value) ? std::to_string((long long)(value))
                                                                : std::to_string(value);
  }

  bool read_text(const PlyElement& element) {
    if (at_ >= bytes_.size())
      return fault("the file ends early", "as many rows as its header says");
    const std::size_t end = std::min(bytes_.find('\n', at_), bytes_.size());
    Words words(bytes_.substr(at_, end - at_));
    at_ = end + 1;
    ++line_;
    row_values_.values.clear();
    row_values_.first.assign(1, 0);
    const auto next = [&](double& value) {
      const std::string_view word = words.next();
      return parse_number(word, value) ||
             fault(word.empty() ? "a number is missing"
                                : "\"" + std::string(word.substr(0, 40)) + "\" is no number",
                   "as many numbers as the header says");
    };
    for (const PlyProperty& property : element.properties) {
      double count = 1;
      if (property.count && (!next(count) || !fits(count))) return false;
      for (double value = 0; count > 0; --count) {
        if (!next(value)) return false;
        if (kept_) row_values_.values.push_back(value);
      }
      row_values_.first.push_back(row_values_.values.size());
    }
    return true;
  }

  bool read_binary(const PlyElement& element) {
    row_values_.values.clear();
    row_values_.first.assign(1, 0);
    for (const PlyProperty& property : element.properties) {
      double count = 1;
      if (property.count) {
        if (!has(1, *property.count)) return false;
        count = value_of(*property.count);
        if (!fits(count)) return false;
      }
      if (!has(count, property.type)) return false;
      if (!kept_) at_ += std::size_t(count) * std::size_t(property.type.bytes);
      for (; kept_ && count > 0; --count) row_values_.values.push_back(value_of(property.type));
      row_values_.first.push_back(row_values_.values.size());
    }
    return true;
  }

  // Whether so many values are left in the file.
  bool has(double count, const PlyType& type) {
    return count * type.bytes <= double(bytes_.size() - at_) ||
           fault("the file ends early", "as many rows as its header says");
  }

  double value_of(const PlyType& type) {
    std::uint64_t bits = 0;
    for (int k = 0; k < type.bytes; ++k) {
      const int shift = header_.order == std::endian::little ? k : type.bytes - 1 - k;
      bits |= std::uint64_t(static_cast<unsigned char>(bytes_[at_++])) << (8 * shift);
    }
    if (type.real)
      return type.bytes == 4 ? double(std::bit_cast<float>(std::uint32_t(bits)))
                             : std::bit_cast<double>(bits);
    const int unused = 64 - 8 * type.bytes;
    return type.is_signed ? double(std::int64_t(bits << unused) >> unused) : double(bits);
  }

  // The first of some pairs of properties that an element has, of one value each.
  static std::array<int, 2> pair_of(const PlyElement& element) {
    for (const auto& [u, v] : {std::pair{"u", "v"}, {"s", "t"}, {"texture_u", "texture_v"}})
      if (const std::array<int, 2> pair{element.find(u), element.find(v)};
          is_single(element, pair[0]) && is_single(element, pair[1]))
        return pair;
    return {-1, -1};
  }
  static bool is_single(const PlyElement& element, int property) {
    return property >= 0 && !element.properties[std::size_t(property)].count;
  }

  void read_vertices(const PlyElement& element) {
    const std::array<int, 3> xyz{element.find("x"), element.find("y"), element.find("z")};
    for (const int property : xyz)
      if (!is_single(element, property))
        return raw_.fault(0, "vertices have no x, y and z", "a number for each");
    if (has_vertices_) return raw_.fault(0, "vertices are given twice", "once");
    has_vertices_ = true;
    const std::array<int, 2> uv = pair_of(element);
    for_each_row(element, [&] {
      Vec3 at{};
      for (std::size_t k = 0; k < 3; ++k) at[k] = row_values_.at(xyz[k]);
      for (const double value : at)
        if (!(std::abs(value) <= kFarthestPlace))
          return fault(number(value) + " is no coordinate", "numbers, -1e9 to 1e9");
      mesh().vertices.push_back(at);
      return uv[0] < 0 || push_uv({row_values_.at(uv[0]), row_values_.at(uv[1])});
    });
    const std::size_t given = mesh().vertices.size();
    if (sound() && (uv[0] >= 0 || element.find("nx") >= 0)) {
      numbers_ = weld(mesh().vertices);
      note_welded(raw_, given - mesh().vertices.size());
    } else {
      for (std::size_t n = 0; n < given; ++n) numbers_.push_back(int(n));
    }
    by_vertex_ = uv[0] >= 0;
  }

  bool push_uv(const Uv& at) {
    for (const double value : at)
      if (!(std::abs(value) <= kFarthestPlace))
        return fault(number(value) + " is no texture coordinate", "numbers, -1e9 to 1e9");
    if (uv_.size() == 4 * kMaxVertices)
      return fault("the mesh has more texture coordinates", "at most 16777216");
    uv_.push_back(at);
    return true;
  }

  // The number of a vertex that the file gives.
  bool vertex(double value, int& vertex) {
    if (!(value >= 0 && value < double(numbers_.size()) && value == std::floor(value)))
      return fault(
          "there is no vertex " + number(value),
          numbers_.empty() ? "vertices come first" : "0 to " + std::to_string(numbers_.size() - 1));
    vertex = numbers_[std::size_t(value)];
    return true;
  }

  void read_faces(const PlyElement& element) {
    int list = element.find("vertex_indices");
    if (list < 0) list = element.find("vertex_index");
    if (list < 0 || is_single(element, list))
      return raw_.fault(0, "faces have no list of vertices", "vertex_indices");
    int mapped = element.find("texcoord");
    if (mapped >= 0 && is_single(element, mapped)) mapped = -1;
    for_each_row(element, [&] { return read_face(list, mapped); });
  }

  bool read_face(int list, int mapped) {
    const std::size_t count = row_values_.size(list), first = row_values_.first[std::size_t(list)];
    if (count > kMaxCorners) return fault("the face has more corners", "3 to 256");
    const bool own_uv = mapped >= 0 && row_values_.size(mapped) == 2 * count;
    std::vector<Corner> corners(count);
    for (std::size_t k = 0; k < count; ++k) {
      const double given = row_values_.values[first + k];
      if (!vertex(given, corners[k].vertex)) return false;
      if (own_uv) {
        corners[k].uv = int(uv_.size());
        const std::size_t at = row_values_.first[std::size_t(mapped)] + 2 * k;
        if (!push_uv({row_values_.values[at], row_values_.values[at + 1]})) return false;
      } else if (by_vertex_) {
        corners[k].uv = int(given);
      }
    }
    return polygons_.add(std::move(corners), uv_, place()) && !raw_.full();
  }

  void read_edges(const PlyElement& element) {
    const std::array<int, 2> ends{element.find("vertex1"), element.find("vertex2")};
    if (!is_single(element, ends[0]) || !is_single(element, ends[1]))
      return raw_.fault(0, "edges have no ends", "vertex1 and vertex2");
    for_each_row(element, [&] {
      if (mesh().edges.size() == kMaxLooseEdges)
        return fault("the mesh has more loose edges", "at most 16777216");
      std::array<int, 2> edge{};
      for (std::size_t k = 0; k < 2; ++k)
        if (!vertex(row_values_.at(ends[k]), edge[k])) return false;
      if (edge[0] != edge[1]) mesh().edges.push_back(edge);
      return true;
    });
  }

  std::string_view bytes_;
  RawMesh raw_;
  Polygons polygons_{raw_};
  PlyHeader header_;
  std::size_t at_ = 0, row_ = 0;
  int line_ = 0;
  std::string element_;  // that is being read
  bool kept_ = false;    // its values are of use
  Row row_values_;
  std::vector<int> numbers_;  // of the file's vertices in the mesh
  std::vector<Uv> uv_;
  bool has_vertices_ = false, by_vertex_ = false;  // by_vertex_: a texture coordinate for each
};

}  // namespace
}  // namespace text

MeshFile read_ply(std::string_view bytes, const std::string& name) {
  MeshFile file;
  text::Reader(text::without_mark(bytes), name, file).run();
  return file;
}

}  // namespace weft
