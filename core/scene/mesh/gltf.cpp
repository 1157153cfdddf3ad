// glTF 2.0 (.gltf, .glb) -> TriangleMesh: the meshes of all nodes of the scene as one, each node's vertices a group
// of its name. Vertices of one node in exactly one place are copies of one vertex: the format has but one texture
// coordinate and normal for each. Skins and morph targets are left out: the mesh is as its file lists it.
#include <cmath>
#include <map>
#include <set>

#include "scene/mesh/gltf_data.h"
#include "scene/mesh/polygons.h"
#include "weft/vec3.h"

namespace weft {
namespace text {
namespace {

using Uv = TriangleMesh::Uv;
constexpr std::size_t kMostItems = kMaxLists;

// x -> columns x + translation.
struct Placement {
  std::array<Vec3, 3> columns{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  Vec3 translation{};

  Vec3 turned(const Vec3& x) const {
    Vec3 y{};
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t n = 0; n < 3; ++n) y[k] += columns[n][k] * x[n];
    return y;
  }
  Vec3 operator()(const Vec3& x) const {
    Vec3 y = turned(x);
    for (std::size_t k = 0; k < 3; ++k) y[k] += translation[k];
    return y;
  }
  Placement operator*(const Placement& inner) const {
    Placement both;
    for (std::size_t n = 0; n < 3; ++n) both.columns[n] = turned(inner.columns[n]);
    both.translation = (*this)(inner.translation);
    return both;
  }
  bool mirrors() const { return dot(cross(columns[0], columns[1]), columns[2]) < 0; }
};

Placement placement_of(const GltfValue& node) {
  Placement p;
  if (node.find("matrix")) {
    const std::array<double, 16> m = node.numbers_or<16>("matrix", {});
    for (std::size_t n = 0; n < 3; ++n)
      for (std::size_t k = 0; k < 3; ++k) p.columns[n][k] = m[4 * n + k];
    p.translation = {m[12], m[13], m[14]};
    return p;
  }
  const auto [a, b, c, w] = node.numbers_or<4>("rotation", {0, 0, 0, 1});
  const double size = a * a + b * b + c * c + w * w;
  if (!(size > 1e-12 && size < 1e12))
    node.at("rotation").refuse("the quaternion is no rotation", "a unit quaternion");
  const double s = 2 / size;
  p.columns = {{{1 - s * (b * b + c * c), s * (a * b + c * w), s * (a * c - b * w)},
                {s * (a * b - c * w), 1 - s * (a * a + c * c), s * (b * c + a * w)},
                {s * (a * c + b * w), s * (b * c - a * w), 1 - s * (a * a + b * b)}}};
  const Vec3 scale = node.numbers_or<3>("scale", {1, 1, 1});
  for (std::size_t n = 0; n < 3; ++n)
    for (double& value : p.columns[n]) value *= scale[n];
  p.translation = node.numbers_or<3>("translation", {0, 0, 0});
  return p;
}

// Extensions that a file may say it cannot be read without, since they say nothing of where triangles are.
bool is_harmless(const std::string& extension) {
  for (const char* known : {"KHR_materials_", "KHR_texture_", "EXT_texture_", "MSFT_texture_",
                            "KHR_lights_", "KHR_mesh_quantization"})
    if (extension.starts_with(known)) return extension != "KHR_texture_transform";
  return false;
}

class Reader {
 public:
  Reader(const GltfValue& document, std::optional<std::string_view> binary,
         const std::string& folder, const std::string& name, MeshFile& file)
      : document_(document), data_(document, binary, folder), raw_{file, name} {
    raw_.first_vertex = 0;
    raw_.words = [this](int triangle) { return words_of(std::size_t(triangle - 1)); };
  }

  void run() {
    const std::string version = document_.at("asset").at("version").words();
    if (!version.starts_with("2."))
      document_.at("asset").at("version").refuse("the version is " + brief(Json(version)), "2.0");
    if (const auto required = document_.find("extensionsRequired"))
      for (std::size_t n = 0; n < required->size(); ++n)
        if (!is_harmless(required->item(n).words()))
          required->item(n).refuse("the extension " + brief(Json(required->item(n).words())) +
                                       " is needed to read the file",
                                   "plain triangles, without compression");
    for_each_node([&](const GltfValue& node, const Placement& place) { read_node(node, place); });
    for (const auto& [group, vertices] : groups_)
      raw_.file.mesh.groups.push_back({group, {vertices.begin(), vertices.end()}});
    note_welded(raw_, copies_);
    tell();
    polygons_.finish();
  }

 private:
  TriangleMesh& mesh() { return raw_.file.mesh; }

  // The nodes that nothing has as a child, in order; or those of the scene that is shown.
  std::vector<std::size_t> roots() const {
    std::vector<std::size_t> roots;
    const auto nodes = document_.find("nodes");
    if (!nodes) return roots;
    const auto add_all = [&](const GltfValue& list) {
      for (std::size_t n = 0; n < list.size(); ++n) roots.push_back(list.item(n).whole(kMostItems));
    };
    if (const auto scenes = document_.find("scenes"); scenes && scenes->size() > 0) {
      const GltfValue scene = scenes->item(document_.whole_or("scene", 0, kMostItems));
      if (const auto list = scene.find("nodes")) add_all(*list);
      return roots;
    }
    std::set<std::size_t> children;
    for (std::size_t n = 0; n < nodes->size(); ++n)
      if (const auto list = nodes->item(n).find("children"))
        for (std::size_t k = 0; k < list->size(); ++k)
          children.insert(list->item(k).whole(kMostItems));
    for (std::size_t n = 0; n < nodes->size(); ++n)
      if (!children.contains(n)) roots.push_back(n);
    return roots;
  }

  template <class Visit>
  void for_each_node(const Visit& visit) {
    struct Waiting {
      std::size_t node;
      Placement above;
    };
    std::vector<Waiting> waiting;
    for (const std::size_t root : roots()) waiting.insert(waiting.begin(), {root, {}});
    std::set<std::size_t> met;
    while (!waiting.empty()) {
      const auto [n, above] = waiting.back();
      waiting.pop_back();
      const GltfValue node = document_.at("nodes").item(n);
      if (!met.insert(n).second)
        node.refuse("the node has two parents, or is below itself", "a tree of nodes");
      const Placement place = above * placement_of(node);
      visit(node, place);
      const auto children = node.find("children");
      for (std::size_t k = children ? children->size() : 0; k > 0; --k)
        waiting.push_back({children->item(k - 1).whole(kMostItems), place});
    }
  }

  void read_node(const GltfValue& node, const Placement& above) {
    const auto index = node.find("mesh");
    if (!index) return;
    const GltfValue mesh_value = document_.at("meshes").item(index->whole(kMostItems));
    const bool skinned = node.find("skin").has_value();
    skins_ += skinned;
    if (const auto weights = mesh_value.find("weights"))
      for (std::size_t n = 0; n < weights->size(); ++n) morphed_ |= weights->item(n).number() != 0;
    const Placement place = skinned ? Placement{} : above;  // bones place what has a skin
    const GltfValue primitives = mesh_value.at("primitives");
    // A primitive's vertices wait for those of the others to be welded with.
    const std::size_t first = mesh().vertices.size();
    vertices_of_.clear();
    std::vector<Part> parts;
    for (std::size_t n = 0; n < primitives.size(); ++n)
      if (auto part = part_of(primitives.item(n), place)) parts.push_back(std::move(*part));
    const std::size_t given = mesh().vertices.size();
    const std::vector<int> numbers = weld(mesh().vertices, first);
    copies_ += given - mesh().vertices.size();
    const std::string group = node.words_or("name", mesh_value.words_or("name", "").c_str());
    if (!group.empty() && given > first)
      for (std::size_t v = first; v < mesh().vertices.size(); ++v) groups_[group].insert(int(v));
    for (const Part& part : parts) add(part, numbers, first, place.mirrors());
  }

  // A primitive: its corners by number of vertex, in groups of three, or of two where it is lines.
  struct Part {
    std::string place;
    std::size_t first;         // vertex
    std::vector<int> corners;  // from `first` on
    std::vector<Uv> uv;        // of each vertex, or none
    bool lines;
  };

  std::optional<Part> part_of(const GltfValue& primitive, const Placement& place) {
    const std::size_t mode = primitive.whole_or("mode", 4, 6);
    const auto position = primitive.at("attributes").find("POSITION");
    if (!position || (mode != 1 && mode < 4)) {
      ++left_out_;
      return {};
    }
    Part part{primitive.place(), 0, {}, {}, mode == 1};
    std::size_t count = 0;
    part.first = vertices_of(*position, place, count);
    std::vector<int> listed = indices(primitive, count);
    part.corners = in_groups(std::move(listed), mode);
    if (const auto uv = primitive.at("attributes").find("TEXCOORD_0"); uv && !part.lines)
      part.uv = texture(*uv, count);
    return part;
  }

  // The first vertex of an accessor, which several primitives may share.
  std::size_t vertices_of(const GltfValue& position, const Placement& place, std::size_t& count) {
    const std::size_t accessor = position.whole(kMostItems);
    count = data_.count(accessor, kMaxVertices);
    const auto known = vertices_of_.find(accessor);
    if (known != vertices_of_.end()) return known->second;
    const std::size_t first = mesh().vertices.size();
    if (count > kMaxVertices - first)
      position.refuse("the mesh has more vertices", "at most 4194304, of all nodes");
    const std::vector<double> values = data_.numbers(accessor, "VEC3");
    for (std::size_t v = 0; v < count; ++v) {
      const Vec3 at = place({values[3 * v], values[3 * v + 1], values[3 * v + 2]});
      for (const double value : at)
        if (!(std::abs(value) <= kFarthestPlace))
          position.refuse("vertex " + std::to_string(v) + " lies at " + number_words(value),
                          "-1e9 to 1e9, with the transforms of its nodes");
      mesh().vertices.push_back(at);
    }
    return vertices_of_[accessor] = first;
  }

  std::vector<int> indices(const GltfValue& primitive, std::size_t count) {
    std::vector<int> listed;
    const auto accessor = primitive.find("indices");
    if (!accessor) {
      for (std::size_t n = 0; n < count; ++n) listed.push_back(int(n));
      return listed;
    }
    const std::size_t most = 3 * (kMaxTriangles - mesh().triangles.size());
    const std::size_t n = accessor->whole(kMostItems);
    data_.count(n, most);
    for (const double value : data_.numbers(n, "SCALAR")) {
      if (!(value >= 0 && value < double(count) && value == std::floor(value)))
        accessor->refuse("index " + std::to_string(listed.size()) + " is " + number_words(value),
                         count == 0 ? "none: there are no vertices"
                                    : "0 to " + std::to_string(count - 1) + ", the vertices");
      listed.push_back(int(value));
    }
    return listed;
  }

  // Strips and fans as triangles, every other one of a strip the other way round.
  static std::vector<int> in_groups(std::vector<int> listed, std::size_t mode) {
    const std::size_t width = mode == 1 ? 2 : 3;
    if (mode == 1 || mode == 4) {
      listed.resize(listed.size() / width * width);
      return listed;
    }
    std::vector<int> corners;
    for (std::size_t n = 0; n + 2 < listed.size(); ++n) {
      const std::size_t a = mode == 6 ? 0 : n, odd = mode == 5 ? n % 2 : 0;
      for (const std::size_t k : {a, n + 1 + odd, n + 2 - odd}) corners.push_back(listed[k]);
    }
    return corners;
  }

  std::vector<Uv> texture(const GltfValue& attribute, std::size_t count) {
    const std::size_t accessor = attribute.whole(kMostItems);
    if (data_.count(accessor, kMaxVertices) != count)
      attribute.refuse("there are as many texture coordinates as " +
                           std::to_string(data_.count(accessor, kMaxVertices)),
                       std::to_string(count) + ", as there are vertices");
    const std::vector<double> values = data_.numbers(accessor, "VEC2");
    std::vector<Uv> uv(count);
    for (std::size_t n = 0; n < count; ++n) {
      if (!(std::max(std::abs(values[2 * n]), std::abs(values[2 * n + 1])) <= kFarthestPlace))
        attribute.refuse("element " + std::to_string(n) + " is far away", "-1e9 to 1e9");
      uv[n] = {values[2 * n], 1 - values[2 * n + 1]};  // from above in this format
    }
    return uv;
  }

  void add(const Part& part, const std::vector<int>& numbers, std::size_t first, bool mirrored) {
    const auto vertex = [&](int listed) {
      return numbers[part.first - first + std::size_t(listed)];
    };
    for (std::size_t n = 0; part.lines && n < part.corners.size(); n += 2) {
      const std::array<int, 2> edge{vertex(part.corners[n]), vertex(part.corners[n + 1])};
      if (mesh().edges.size() == kMaxLooseEdges)
        throw Refused{{part.place, "the mesh has more loose edges", "at most 16777216"}};
      if (edge[0] != edge[1]) mesh().edges.push_back(edge);
    }
    if (part.lines) return;
    parts_[triangles_] = part.place;
    for (std::size_t n = 0; n < part.corners.size(); n += 3) {
      std::vector<Corner> corners;
      for (std::size_t k : {0, mirrored ? 2 : 1, mirrored ? 1 : 2}) {
        const int listed = part.corners[n + k];
        corners.push_back({vertex(listed), part.uv.empty() ? -1 : listed});
      }
      if (!polygons_.add(std::move(corners), part.uv, int(++triangles_))) return;
    }
  }

  // Of the triangle that is the n-th of all.
  std::string words_of(std::size_t n) const {
    const auto part = std::prev(parts_.upper_bound(n));
    return part->second + ", triangle " + std::to_string(n - part->first);
  }

  void tell() const {
    if (skins_ > 0) raw_.note("the mesh has a skin, which is left out: it is as without bones");
    if (morphed_) raw_.note("the mesh has morph targets, which are left out");
    if (left_out_ > 0)
      raw_.note(std::to_string(left_out_) + " primitives that are no triangles are left out");
  }

  GltfValue document_;
  GltfData data_;
  RawMesh raw_;
  Polygons polygons_{raw_};
  std::map<std::string, std::set<int>> groups_;
  std::map<std::size_t, std::size_t> vertices_of_;  // first vertex of an accessor, in this node
  std::map<std::size_t, std::string> parts_;        // places of primitives by their first triangle
  std::size_t triangles_ = 0, copies_ = 0;
  int skins_ = 0, left_out_ = 0;
  bool morphed_ = false;
};

std::uint32_t whole_at(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t k = 0; k < 4; ++k)
    value |= std::uint32_t(static_cast<unsigned char>(bytes[at + k])) << (8 * k);
  return value;
}

struct Container {
  std::string_view json;
  std::optional<std::string_view> binary;
};

// The parts of a .glb: 12 bytes of header, then the document and the data, each with its length and kind.
Container parts_of(std::string_view bytes) {
  const auto refuse = [](const char* what, const char* allowed) {
    throw Refused{{"", what, allowed}};
  };
  if (bytes.size() < 20) refuse("the file ends early", "20 bytes at least");
  if (whole_at(bytes, 4) != 2) refuse("the version is not 2", "glTF 2.0");
  const std::size_t length = whole_at(bytes, 8);
  if (length > bytes.size() || length < 20)
    refuse("the file is not as long as its header says", "a whole file");
  bytes = bytes.substr(0, length);
  Container found;
  for (std::size_t at = 12, n = 0; at + 8 <= bytes.size() && n < 2; ++n) {
    const std::size_t size = whole_at(bytes, at);
    const std::uint32_t kind = whole_at(bytes, at + 4);
    if (size > bytes.size() - at - 8) refuse("a part is longer than the file", "a whole file");
    if (n == 0 && kind != 0x4E4F534A) refuse("the first part is no document", "JSON");
    if (n == 0) found.json = bytes.substr(at + 8, size);
    if (n == 1 && kind == 0x004E4942) found.binary = bytes.substr(at + 8, size);
    at += 8 + size;
  }
  return found;
}

}  // namespace
}  // namespace text

MeshFile read_gltf(std::string_view bytes, const std::string& name, const std::string& folder) {
  MeshFile file;
  try {
    text::Container parts{bytes, {}};
    if (bytes.starts_with("glTF")) parts = text::parts_of(bytes);
    std::vector<Fault> faults;
    const text::Json document = text::parse(parts.json, faults);
    for (Fault& fault : faults) throw text::Refused{std::move(fault)};
    text::Reader({document, ""}, parts.binary, folder, name, file).run();
  } catch (text::Refused& refused) {
    Fault& fault = refused.fault;
    if (!fault.place.empty()) fault.place.insert(0, ":");
    file.faults.assign(1, {name + fault.place, std::move(fault.what), std::move(fault.allowed)});
  }
  return file;
}

}  // namespace weft
