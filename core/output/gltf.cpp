// glTF 2.0, as one file (.glb) or as JSON with its buffer beside it (.gltf and .bin): the first sample
// is each cloth's mesh, every later one a morph target (its displacement from the first), and one
// animation blends from each to the next at the times of the samples. Morph targets move vertices and
// keep triangles, so that cloth that tears cannot be written, and each target is held whole by whoever
// reads it, so that an animation may be too large. Vertices are the particles in scene order; where one has
// several texture coordinates, as along a seam, vertices of its own for the others follow all of these.
#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "output/animation.h"
#include "output/bytes.h"
#include "output/faces.h"
#include "output/gltf_pair.h"
#include "output/spool.h"

namespace weft {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::int64_t kMostBytes = std::int64_t{1} << 30;  // of positions
constexpr std::int64_t kMostSamples = 4000;                 // their weights grow by the square
constexpr int kFloat = 5126, kUnsignedInt = 5125;           // glTF's component types
constexpr int kVertices = 34962, kIndices = 34963;          // and targets of buffer views

struct Bounds {
  std::array<float, 3> low, high;
};

class Gltf final : public Animation {
 public:
  Gltf(const std::string& path, const View& first, std::int64_t samples)
      : path_(path), spool_(path), origin_(first.origin) {
    if (extension_of(path) == ".glb")
      binary_.emplace(path);
    else
      pair_.emplace(path);
    refuse_size(std::max<std::int64_t>(samples, 1), particle_count(first));
    for (const ClothView& cloth : first.cloths) shapes_.push_back(shape_of(cloth));
  }

  void append(const View& view) override {
    if (view.cloths.size() != shapes_.size())
      throw std::invalid_argument("an animation keeps its cloths");
    refuse_size(std::int64_t(times_.size()) + 1, particle_count(view));
    const bool base = times_.empty();
    times_.push_back(static_cast<float>(view.time));
    std::size_t at = 0;  // in base_
    for (std::size_t c = 0; c < view.cloths.size(); ++c) {
      const ClothView& cloth = view.cloths[c];
      if (particle_count(cloth) != shapes_[c].particles)
        throw std::invalid_argument("an animation keeps its number of particles");
      if (cloth.topology_version != shapes_[c].version)
        throw WriteError(path_, "the cloth tears, which morph targets cannot follow; .obj can");
      append_positions(view, c, base, at);
    }
  }

  void complete() override {
    std::string tail;
    for (const float time : times_) append_little_endian(tail, time);
    // Each sample's weights: all 0 but its own target's; the first sample is the mesh itself.
    for (std::size_t s = 0; s < times_.size(); ++s)
      for (std::size_t target = 1; target < times_.size(); ++target)
        append_little_endian(tail, s == target ? 1.0F : 0.0F);
    const std::int64_t size =
        std::int64_t(indices_.size() + uv_.size()) + spool_.bytes() + std::int64_t(tail.size());
    if (pair_) {
      write_buffer(pair_->buffer(), tail);
      pair_->complete([&](const std::string& uri) { return document(size, uri) + "\n"; });
    } else {
      write_glb(document(size, ""), size, tail);
      binary_->complete();
    }
  }

  void commit() override {
    if (pair_) pair_->commit();
    if (binary_) binary_->commit();
  }

  std::string written() const override { return pair_ ? pair_->written() : path_; }

 private:
  struct Shape {
    std::int64_t particles, corners, uv;  // how many; uv: of vertices, or 0
    std::uint64_t version;                // of the topology
    std::vector<std::int64_t> copies;     // the particles of vertices that follow them
    std::optional<std::array<double, 3>> color;
    std::int64_t vertices() const { return particles + std::int64_t(copies.size()); }
  };

  void refuse_size(std::int64_t samples, std::int64_t particles) const {
    if (samples > kMostSamples || samples * particles * 12 > kMostBytes)
      throw WriteError(path_, std::to_string(samples) + " samples of " + std::to_string(particles) +
                                  " particles do not fit morph targets; .pc2 and .mdd can");
  }

  // Indices and texture coordinates go to their buffers. A grid that tears is refused with its first sample.
  Shape shape_of(const ClothView& cloth) {
    const Faces faces = faces_of(cloth);
    Shape shape{particle_count(cloth),
                0,
                0,
                cloth.lanes.empty() ? 0 : cloth.topology_version,
                {},
                cloth.color};
    const bool mapped = !faces.uv_of.empty();
    std::vector<std::int64_t> uv(std::size_t(shape.particles), -1);  // of vertices
    std::map<std::pair<std::int64_t, std::int64_t>, std::int64_t> copies;
    const auto vertex = [&](std::size_t corner) {
      const std::int64_t p = faces.particles[corner];
      if (!mapped) return p;
      std::int64_t& first = uv[std::size_t(p)];
      if (first < 0) first = faces.uv_of[corner];
      if (first == faces.uv_of[corner]) return p;
      const auto [copy, fresh] =
          copies.try_emplace({p, faces.uv_of[corner]}, std::int64_t(uv.size()));
      if (fresh) {
        shape.copies.push_back(p);
        uv.push_back(faces.uv_of[corner]);
      }
      return copy->second;
    };
    for (std::size_t face = 0; face < faces.particles.size(); face += faces.corners) {
      const std::size_t last = face + faces.corners - 1;
      for (std::size_t k = face; k + 2 <= last; ++k)
        for (const std::size_t corner : {k, k + 1, last}) {
          append_little_endian(indices_, static_cast<std::uint32_t>(vertex(corner)));
          ++shape.corners;
        }
    }
    for (const std::int64_t n : uv) {
      if (!mapped) break;
      const std::array<double, 2> at = n < 0 ? std::array<double, 2>{} : faces.uv[std::size_t(n)];
      append_little_endian(uv_, static_cast<float>(at[0]));
      append_little_endian(uv_, static_cast<float>(1 - at[1]));  // from above in this format
      ++shape.uv;
    }
    return shape;
  }

  void append_positions(const View& view, std::size_t c, bool base, std::size_t& at) {
    constexpr float far = std::numeric_limits<float>::max();
    Bounds bounds{{far, far, far}, {-far, -far, -far}};
    some_.clear();
    now_.clear();
    std::array<float, 3> off{};  // from the node's translation
    for (std::size_t k = 0; k < 3; ++k) off[k] = static_cast<float>(view.origin[k] - origin_[k]);
    for_each_particle(view.cloths[c], [&](float x, float y, float z) {
      now_.push_back({x + off[0], y + off[1], z + off[2]});
    });
    for (const std::int64_t p : shapes_[c].copies) now_.push_back(now_[std::size_t(p)]);
    for (const std::array<float, 3>& p : now_) {
      if (base) base_.push_back(p);
      const std::array<float, 3> from = base ? std::array<float, 3>{} : base_[at++];
      for (std::size_t k = 0; k < 3; ++k) {
        const float moved = p[k] - from[k];
        bounds.low[k] = std::min(bounds.low[k], moved);
        bounds.high[k] = std::max(bounds.high[k], moved);
        append_little_endian(some_, moved);
      }
    }
    spool_.write(some_);
    bounds_.push_back(bounds);
  }

  // Seen from both sides. The format's factors are in proportion to light, and its standard is a metal.
  static Json material(const Shape& shape) {
    Json material{{"doubleSided", true}};
    if (!shape.color) return material;
    const auto [red, green, blue] = *shape.color;
    material["pbrMetallicRoughness"] = {{"baseColorFactor", {red, green, blue, 1}},
                                        {"metallicFactor", 0}};
    return material;
  }

  // `uri`: of the buffer, "" where it is in the same file.
  std::string document(std::int64_t size, const std::string& uri) const {
    Json json;
    json["asset"] = {{"version", "2.0"}, {"generator", "weft"}};
    json["scene"] = 0;
    Json views = Json::array(), accessors = Json::array(), meshes = Json::array();
    Json nodes = Json::array(), roots = Json::array(), channels = Json::array();
    Json materials = Json::array();
    std::int64_t offset = 0;
    const auto place = [&](std::int64_t bytes, int target) {
      Json view{{"buffer", 0}, {"byteOffset", offset}, {"byteLength", bytes}};
      if (target != 0) view["target"] = target;
      views.push_back(view);
      offset += bytes;
      return std::int64_t(views.size()) - 1;
    };
    const auto accessor = [&](std::int64_t view, int type, std::int64_t count, const char* shape) {
      accessors.push_back(
          {{"bufferView", view}, {"componentType", type}, {"count", count}, {"type", shape}});
      return std::int64_t(accessors.size()) - 1;
    };
    for (const Shape& s : shapes_)  // accessor c: triangles of cloth c
      accessor(place(s.corners * 4, kIndices), kUnsignedInt, s.corners, "SCALAR");
    std::vector<std::int64_t> uv_views;
    for (const Shape& s : shapes_) uv_views.push_back(s.uv > 0 ? place(s.uv * 8, kVertices) : -1);
    const std::size_t samples = times_.size();
    for (std::size_t n = 0; n < samples * shapes_.size(); ++n) {  // then sample after sample
      const std::int64_t vertices = shapes_[n % shapes_.size()].vertices();
      const std::int64_t a = accessor(place(vertices * 12, kVertices), kFloat, vertices, "VEC3");
      accessors[std::size_t(a)]["min"] = bounds_[n].low;
      accessors[std::size_t(a)]["max"] = bounds_[n].high;
    }
    for (std::size_t c = 0; c < shapes_.size(); ++c) {
      const auto position = [&](std::size_t sample) { return shapes_.size() * (1 + sample) + c; };
      Json primitive{{"attributes", {{"POSITION", position(0)}}},
                     {"indices", c},
                     {"material", materials.size()}};
      materials.push_back(material(shapes_[c]));
      if (uv_views[c] >= 0)
        primitive["attributes"]["TEXCOORD_0"] =
            accessor(uv_views[c], kFloat, shapes_[c].uv, "VEC2");
      for (std::size_t s = 1; s < samples; ++s)
        primitive["targets"].push_back({{"POSITION", position(s)}});
      const std::string name = "cloth_" + std::to_string(c);
      meshes.push_back({{"name", name}, {"primitives", Json::array({primitive})}});
      nodes.push_back({{"name", name}, {"mesh", c}});
      if (origin_ != decltype(origin_){}) nodes.back()["translation"] = origin_;
      roots.push_back(c);
      channels.push_back({{"sampler", 0}, {"target", {{"node", c}, {"path", "weights"}}}});
    }
    if (samples > 1) {
      const auto count = std::int64_t(samples);
      const std::int64_t times = accessor(place(count * 4, 0), kFloat, count, "SCALAR");
      accessors[std::size_t(times)]["min"] = {times_.front()};
      accessors[std::size_t(times)]["max"] = {times_.back()};
      const std::int64_t weights =
          accessor(place(count * (count - 1) * 4, 0), kFloat, count * (count - 1), "SCALAR");
      json["animations"] =
          Json::array({{{"samplers", Json::array({{{"input", times}, {"output", weights}}})},
                        {"channels", channels}}});
    }
    json["materials"] = materials;
    json["scenes"] = Json::array({{{"nodes", roots}}});
    json["nodes"] = nodes;
    json["meshes"] = meshes;
    json["accessors"] = accessors;
    json["bufferViews"] = views;
    Json buffer{{"byteLength", size}};
    if (!uri.empty()) buffer["uri"] = uri;
    json["buffers"] = Json::array({buffer});
    return json.dump();
  }

  void write_buffer(OutputFile& file, const std::string& tail) {
    file.write(indices_);
    file.write(uv_);
    spool_.copy_to(file);
    file.write(tail);
  }

  // 12 bytes of header, then the JSON and the buffer, each with its length and name before it and
  // padded to 4 bytes.
  void write_glb(std::string text, std::int64_t size, const std::string& tail) {
    text.append((4 - text.size() % 4) % 4, ' ');
    std::string header;
    const auto number = [&](std::int64_t value) {
      append_little_endian(header, static_cast<std::uint32_t>(value));
    };
    number(0x46546C67);  // "glTF"
    number(2);
    number(12 + 8 + std::int64_t(text.size()) + 8 + size);
    number(std::int64_t(text.size()));
    number(0x4E4F534A);  // "JSON"
    header += text;
    number(size);
    number(0x004E4942);  // "BIN"
    binary_->write(header);
    write_buffer(*binary_, tail);
  }

  std::string path_;
  std::optional<OutputFile> binary_;  // .glb
  std::optional<GltfPair> pair_;      // .gltf
  Spool spool_;                       // positions and displacements
  std::vector<Shape> shapes_;
  std::array<double, 3> origin_;  // the nodes' translation [m]
  std::string indices_, uv_, some_;
  std::vector<std::array<float, 3>> now_;
  std::vector<float> times_;
  std::vector<std::array<float, 3>> base_;
  std::vector<Bounds> bounds_;  // of every sample's cloths
};

}  // namespace

std::unique_ptr<Animation> open_gltf(const std::string& path, const View& first,
                                     std::int64_t samples) {
  return std::make_unique<Gltf>(path, first, samples);
}

}  // namespace weft
