// glTF 2.0 (.gltf, .glb) -> TriangleMesh: the meshes of all nodes of the scene as one, each node's vertices a group
// of its name, where the nodes as they rest put them, through skins and morph targets. Vertices of one node in
// exactly one place that move alike are copies of one vertex: the format has but one texture coordinate and normal
// for each.
#include <cmath>
#include <map>
#include <set>

#include "scene/mesh/gltf_figure.h"
#include "scene/mesh/gltf_file.h"
#include "scene/mesh/gltf_motion.h"
#include "scene/mesh/polygons.h"
#include "weft/point_cache.h"

namespace weft {
namespace text {
namespace {

using Uv = TriangleMesh::Uv;

// Joints and targets of all nodes: some 100 MB.
constexpr std::size_t kMostMovingParts = std::size_t{1} << 20;

class Reader {
 public:
  Reader(const GltfValue& document, GltfData& data, const std::string& name, MeshFile& file)
      : document_(document), data_(data), raw_{file, name} {
    raw_.first_vertex = 0;
    raw_.words = [this](int triangle) { return words_of(std::size_t(triangle - 1)); };
  }

  // `moving`: keeps what moves the vertices.
  void run(bool moving) {
    for (std::size_t n = 0; n < nodes_.shown().size(); ++n) read_node(n, moving);
    for (const auto& [group, vertices] : groups_)
      raw_.file.mesh.groups.push_back({group, {vertices.begin(), vertices.end()}});
    note_welded(raw_, copies_);
    tell();
    polygons_.finish();
  }

  const GltfNodes& nodes() const { return nodes_; }
  const GltfPose& pose() const { return pose_; }  // at rest
  // In the order of the vertices.
  const std::vector<GltfFigure>& figures() const { return figures_; }

 private:
  TriangleMesh& mesh() { return raw_.file.mesh; }

  void read_node(std::size_t n, bool moving) {
    const GltfValue& node = nodes_.shown()[n].value;
    const auto index = node.find("mesh");
    if (!index) return;
    const GltfValue mesh_value = document_.at("meshes").item(index->whole(kMostGltfItems));
    const GltfValue primitives = mesh_value.at("primitives");
    GltfFigure figure(document_, data_, nodes_, n);
    // A primitive's vertices wait for those of the others to be welded with.
    std::vector<Part> parts;
    for (std::size_t k = 0; k < primitives.size(); ++k)
      if (auto part = part_of(primitives.item(k), figure)) parts.push_back(std::move(*part));
    moving_parts_ += figure.joints() + figure.targets();
    if (moving_parts_ > kMostMovingParts)
      node.at("mesh").refuse("the nodes' meshes have more joints and targets",
                             std::to_string(kMostMovingParts) + " of all nodes together");
    const std::size_t given = figure.size(), first = mesh().vertices.size();
    const std::vector<int> numbers = figure.weld();
    copies_ += given - figure.size();
    if (given == 0) return;
    pose_.weights[n] = weights_of(node, mesh_value, figure.targets());
    figure.read_targets(moving, pose_.weights[n]);
    for (const Vec3& at : figure.vertices(pose_)) mesh().vertices.push_back(at);
    const std::string group = node.words_or("name", mesh_value.words_or("name", "").c_str());
    if (!group.empty())
      for (std::size_t v = first; v < mesh().vertices.size(); ++v) groups_[group].insert(int(v));
    for (const Part& part : parts) add(part, numbers, first, pose_.places[n].mirrors());
    if (moving) figures_.push_back(std::move(figure));
  }

  // Of the targets of a node's mesh, where the animation says nothing.
  static std::vector<double> weights_of(const GltfValue& node, const GltfValue& mesh,
                                        std::size_t targets) {
    std::vector<double> weights(targets);
    auto list = node.find("weights");
    if (!list) list = mesh.find("weights");
    if (!list) return weights;
    if (list->size() != targets)
      list->refuse("there are " + std::to_string(list->size()) + " weights",
                   std::to_string(targets) + ", as there are targets");
    for (std::size_t t = 0; t < targets; ++t) weights[t] = list->item(t).number();
    return weights;
  }

  // A primitive: its corners by number of vertex, in groups of three, or of two where it is lines.
  struct Part {
    std::string place;
    std::size_t first;         // vertex
    std::vector<int> corners;  // from `first` on
    std::vector<Uv> uv;        // of each vertex, or none
    bool lines;
  };

  std::optional<Part> part_of(const GltfValue& primitive, GltfFigure& figure) {
    const std::size_t mode = primitive.whole_or("mode", 4, 6);
    const auto position = primitive.at("attributes").find("POSITION");
    if (!position || (mode != 1 && mode < 4)) {
      ++left_out_;
      return {};
    }
    Part part{primitive.place(), 0, {}, {}, mode == 1};
    std::size_t count = 0;
    part.first = figure.add(primitive, kMaxVertices - mesh().vertices.size(), count, skin_notes_);
    std::vector<int> listed = indices(primitive, count);
    part.corners = in_groups(std::move(listed), mode);
    if (const auto uv = primitive.at("attributes").find("TEXCOORD_0"); uv && !part.lines)
      part.uv = texture(*uv, count);
    return part;
  }

  std::vector<int> indices(const GltfValue& primitive, std::size_t count) {
    std::vector<int> listed;
    const auto accessor = primitive.find("indices");
    if (!accessor) {
      for (std::size_t n = 0; n < count; ++n) listed.push_back(int(n));
      return listed;
    }
    const std::size_t most = 3 * (kMaxTriangles - mesh().triangles.size());
    const std::size_t n = accessor->whole(kMostGltfItems);
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
    const std::size_t accessor = attribute.whole(kMostGltfItems);
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
      return int(first) + numbers[part.first + std::size_t(listed)];
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
    if (const std::size_t n = skin_notes_.unbound; n > 0)
      raw_.note(std::to_string(n) + (n == 1 ? " vertex has" : " vertices have") +
                " no weights, as if bound to the first joint of the skin");
    if (const std::size_t n = skin_notes_.unnormalised; n > 0)
      raw_.note("the weights of " + std::to_string(n) + (n == 1 ? " vertex sum" : " vertices sum") +
                " to other than 1 (" + number_words(skin_notes_.sum) +
                "), and are divided by their sum");
    if (left_out_ > 0)
      raw_.note(std::to_string(left_out_) + " primitives that are no triangles are left out");
  }

  GltfValue document_;
  GltfData& data_;
  RawMesh raw_;
  Polygons polygons_{raw_};
  GltfNodes nodes_{document_};
  GltfPose pose_{nodes_.places(nodes_.at_rest()),
                 std::vector<std::vector<double>>(nodes_.shown().size())};
  GltfSkinNotes skin_notes_;
  std::vector<GltfFigure> figures_;
  std::map<std::string, std::set<int>> groups_;
  std::map<std::size_t, std::string> parts_;  // places of primitives by their first triangle
  std::size_t triangles_ = 0, copies_ = 0, moving_parts_ = 0;
  int left_out_ = 0;
};

}  // namespace
}  // namespace text

MeshFile read_gltf(std::string_view bytes, const std::string& name, const std::string& folder) {
  MeshFile file;
  text::read_gltf_file(bytes, name, folder, file.faults,
                       [&](const text::GltfValue& document, text::GltfData& data) {
                         text::Reader(document, data, name, file).run(false);
                       });
  return file;
}

PointCacheFile read_gltf_motion(std::string_view bytes, const std::string& name,
                                const std::string& folder, int points) {
  PointCacheFile file;
  text::read_gltf_file(
      bytes, name, folder, file.faults, [&](const text::GltfValue& document, text::GltfData& data) {
        MeshFile mesh;
        text::Reader reader(document, data, name, mesh);
        reader.run(true);
        file.faults = mesh.faults;
        if (!file.faults.empty()) return;
        if (const auto given = mesh.mesh.vertices.size();
            points != kAnyPoints && int(given) != points)
          throw text::Refused{{"", "the file has " + std::to_string(given) + " points",
                               std::to_string(points) + ", the vertices of the mesh"}};
        text::GltfMotion motion =
            text::motion_of(document, data, reader.nodes(), reader.figures(), reader.pose());
        for (std::string& note : motion.notes) file.notes.push_back(name + ": " + note);
        file.cache = std::make_shared<const PointCache>(std::move(motion.cache));
      });
  return file;
}

}  // namespace weft
