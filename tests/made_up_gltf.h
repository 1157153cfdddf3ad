// glTF documents that tests make: meshes with skins, morph targets and animations.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "made_up_bodies.h"
#include "made_up_files.h"
#include "weft/point_cache.h"

namespace weft {

class GltfMaker {
 public:
  text::Json document = text::Json::parse(
      R"({"asset": {"version": "2.0"}, "nodes": [], "meshes": [], "accessors": [], "bufferViews": []})");

  // Accessors of such numbers, by their index.
  int floats(const std::vector<double>& values, const char* type) {
    return add<float>(values, type, 5126);
  }
  int bytes(const std::vector<double>& values, const char* type) {
    return add<std::uint8_t>(values, type, 5121);
  }
  int shorts(const std::vector<double>& values, const char* type) {
    return add<std::uint16_t>(values, type, 5123);
  }
  int indices(const TriangleMesh& mesh) {
    std::vector<double> all;
    for (const auto& t : mesh.triangles) all.insert(all.end(), t.begin(), t.end());
    return add<std::uint32_t>(all, "SCALAR", 5125);
  }
  static std::vector<double> flat(const std::vector<Vec3>& points) {
    std::vector<double> all;
    for (const Vec3& p : points) all.insert(all.end(), p.begin(), p.end());
    return all;
  }
  // A mesh of one primitive; its index.
  int mesh(const TriangleMesh& of) {
    document["meshes"].push_back(
        {{"primitives",
          text::Json::array({{{"attributes", {{"POSITION", floats(flat(of.vertices), "VEC3")}}},
                              {"indices", indices(of)}}})}});
    return int(document["meshes"].size()) - 1;
  }
  text::Json& primitive() { return document["meshes"][0]["primitives"][0]; }
  int node(text::Json value) {
    document["nodes"].push_back(std::move(value));
    return int(document["nodes"].size()) - 1;
  }
  // A channel of an animation, which is there or made.
  void channel(int node, const char* path, const std::vector<double>& times,
               const std::vector<double>& values, const char* way = "LINEAR",
               std::size_t animation = 0) {
    text::Json& all = document["animations"];
    while (all.size() <= animation)
      all.push_back({{"samplers", text::Json::array()}, {"channels", text::Json::array()}});
    text::Json& one = all[animation];
    const std::string name = path;
    const char* type = name == "weights" ? "SCALAR" : name == "rotation" ? "VEC4" : "VEC3";
    one["channels"].push_back(
        {{"sampler", one["samplers"].size()}, {"target", {{"node", node}, {"path", path}}}});
    one["samplers"].push_back({{"input", floats(times, "SCALAR")},
                               {"output", floats(values, type)},
                               {"interpolation", way}});
  }
  std::string write() const {
    text::Json whole = document;
    whole["buffers"] =
        text::Json::array({{{"byteLength", data_.size()},
                            {"uri", "data:application/octet-stream;base64," + base64(data_)}}});
    return whole.dump();
  }
  std::string write_glb() const {
    text::Json whole = document;
    whole["buffers"] = text::Json::array({{{"byteLength", data_.size()}}});
    return glb(whole, data_);
  }

 private:
  template <class T>
  int add(const std::vector<double>& values, const char* type, int component) {
    const std::string name = type;
    const std::size_t width = name == "SCALAR" ? 1 : name == "VEC3" ? 3 : name == "VEC4" ? 4 : 16;
    const std::size_t begin = data_.size();
    for (const double value : values) append_little_endian(data_, T(value));
    document["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", begin}, {"byteLength", data_.size() - begin}});
    data_.append((4 - data_.size() % 4) % 4, '\0');
    document["accessors"].push_back({{"bufferView", document["bufferViews"].size() - 1},
                                     {"componentType", component},
                                     {"count", values.size() / width},
                                     {"type", type}});
    return int(document["accessors"].size()) - 1;
  }

  std::string data_;
};

// A tube of length 2 along x, of radius 0.2, closed, and its skin: an upper arm from 0 and a forearm from x 1, which
// a point follows the more the farther out it is. Nodes: 0 the mesh, 1 what the arm hangs on, 2 the upper arm, 3 the
// forearm.
struct Arm {
  static constexpr Vec3 kShoulder{0.5, -0.25, 2};
  std::shared_ptr<TriangleMesh> mesh;
  GltfMaker file;

  static double share(const Vec3& p) { return std::clamp((p[0] - 0.75) / 0.5, 0.0, 1.0); }
  // `sets`: of four joints and weights each, over which the two are spread.
  explicit Arm(std::shared_ptr<TriangleMesh> tube, int sets = 1, bool whole_numbers = false)
      : mesh(std::move(tube)) {
    file.mesh(*mesh);
    text::Json& attributes = file.primitive()["attributes"];
    for (int set = 0; set < sets; ++set) {
      std::vector<double> joints, weights;
      for (const Vec3& p : mesh->vertices) {
        const double most = whole_numbers ? 255 : 1, w = share(p);
        const double fore = whole_numbers ? std::round(255 * w) : w;
        const bool last = set == sets - 1;
        joints.insert(joints.end(), {0, 1, 0, 0});
        weights.insert(weights.end(), {set == 0 ? most - fore : 0, last ? fore : 0, 0, 0});
      }
      const std::string n = std::to_string(set);
      attributes["JOINTS_" + n] =
          set % 2 ? file.shorts(joints, "VEC4") : file.bytes(joints, "VEC4");
      attributes["WEIGHTS_" + n] =
          whole_numbers ? file.bytes(weights, "VEC4") : file.floats(weights, "VEC4");
      if (whole_numbers)
        file.document["accessors"][attributes["WEIGHTS_" + n].get<std::size_t>()]["normalized"] =
            true;
    }
    // The node of the mesh has a place of its own, which a skin takes no notice of.
    file.node({{"mesh", 0}, {"skin", 0}, {"name", "arm"}, {"translation", {7, 7, 7}}});
    file.node({{"children", {2}}, {"translation", kShoulder}});
    file.node({{"children", {3}}});
    file.node({{"translation", {1, 0, 0}}});
    std::vector<double> inverse;
    for (const double x : {0.0, -1.0})
      inverse.insert(inverse.end(), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, 0, 0, 1});
    file.document["skins"] = text::Json::array(
        {{{"joints", {2, 3}}, {"inverseBindMatrices", file.floats(inverse, "MAT4")}}});
  }
  // Where a point is when the forearm has turned about z.
  static Vec3 bent(const Vec3& p, double angle) {
    const double w = share(p), c = std::cos(angle), s = std::sin(angle);
    const Vec3 fore{1 + c * (p[0] - 1) - s * p[1], s * (p[0] - 1) + c * p[1], p[2]};
    Vec3 q;
    for (std::size_t k = 0; k < 3; ++k) q[k] = kShoulder[k] + (1 - w) * p[k] + w * fore[k];
    return q;
  }
};

inline std::string told(const PointCacheFile& file) {
  std::string text;
  for (const auto& f : file.faults) text += f.place + ": " + f.what + " (" + f.allowed + ")\n";
  for (const auto& note : file.notes) text += note + "\n";
  return text;
}

inline PointCacheFile motion_of(const GltfMaker& file) {
  return read_gltf_motion(file.write(), "a.gltf", "", kAnyPoints);
}

inline std::shared_ptr<TriangleMesh> tube() {
  return tests::revolved(12, 16, false, [](double u, double v) {
    const double a = 2 * std::numbers::pi * u, r = v > 0 && v < 1 ? 0.2 : 0;
    return Vec3{2 * v, r * std::cos(a), r * std::sin(a)};
  });
}

// q of a turn about an axis of length 1.
inline std::vector<double> turn(const Vec3& axis, double degrees) {
  const double half = degrees * std::numbers::pi / 360, s = std::sin(half);
  return {s * axis[0], s * axis[1], s * axis[2], std::cos(half)};
}

inline std::vector<double> joined(std::initializer_list<std::vector<double>> parts) {
  std::vector<double> all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace weft
