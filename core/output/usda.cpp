// USD as text (.usda): a mesh for every cloth with points as time samples, one time code a sample, texture
// coordinates by corner. Points come prim by prim, and so lie on disk until the end. Numbers are written so that
// they read back to the same bits.
#include <algorithm>
#include <charconv>
#include <cmath>

#include "output/animation.h"
#include "output/faces.h"
#include "output/spool.h"

namespace weft {

namespace {

template <class T>
void append_number(std::string& text, T value) {
  std::array<char, 32> digits{};
  text.append(digits.data(),
              std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr);
}

template <class Values>
void append_tuple(std::string& text, const Values& values) {
  const char* before = "(";
  for (const auto value : values) {
    text += before;
    append_number(text, value);
    before = ", ";
  }
  text += ')';
}

// "[a, b, c]" of whatever append_one writes.
template <class List, class Append>
void append_list(std::string& text, const List& list, const Append& append_one) {
  text += '[';
  for (std::size_t n = 0; n < list.size(); ++n) {
    if (n > 0) text += ", ";
    append_one(list[n]);
  }
  text += ']';
}

class Usda final : public Animation {
 public:
  Usda(const std::string& path, const View& first) : file_(path), points_(path) {
    for (const ClothView& cloth : first.cloths) {
      Prim& prim = prims_.emplace_back();
      prim.particles = particle_count(cloth);
      prim.version = cloth.lanes.empty() ? 0 : cloth.topology_version;
      append_faces(prim.faces, faces_of(cloth));
      if (cloth.color) append_color(prim.faces, *cloth.color);
    }
  }

  void append(const View& view) override {
    if (view.cloths.size() != prims_.size())
      throw std::invalid_argument("an animation keeps its cloths");
    times_.push_back(view.time);
    for (std::size_t c = 0; c < prims_.size(); ++c) append_points(view, view.cloths[c], prims_[c]);
  }

  void complete() override {
    file_.write(header());
    for (std::size_t c = 0; c < prims_.size(); ++c) write_prim(c);
    file_.write("}\n");
    file_.complete();
  }
  void commit() override { file_.commit(); }

  std::string written() const override { return file_.path(); }

 private:
  // Of a sample: where its points are, and what they are within.
  struct Sample {
    std::int64_t from, bytes;
    std::array<std::array<float, 3>, 2> extent;
  };
  struct Prim {
    std::int64_t particles = 0;
    std::uint64_t version = 0;  // of the topology
    std::string faces;
    std::vector<Sample> samples;
  };

  static void append_faces(std::string& text, const Faces& faces) {
    const auto number = [&](std::int64_t n) { append_number(text, n); };
    const std::size_t count = faces.particles.size() / faces.corners;
    text = "        int[] faceVertexCounts = ";
    append_list(text, std::vector<std::int64_t>(count, std::int64_t(faces.corners)), number);
    text += "\n        int[] faceVertexIndices = ";
    append_list(text, faces.particles, number);
    text += "\n        uniform token orientation = \"rightHanded\"\n";
    text +=
        "        uniform token subdivisionScheme = \"none\"\n        uniform bool doubleSided = "
        "1\n";
    if (faces.uv_of.empty()) return;
    text += "        texCoord2f[] primvars:st = ";
    append_list(text, faces.uv, [&](const std::array<double, 2>& at) {
      append_tuple(text, std::array{static_cast<float>(at[0]), static_cast<float>(at[1])});
    });
    text += " (\n            interpolation = \"faceVarying\"\n        )\n";
    text += "        int[] primvars:st:indices = ";
    append_list(text, faces.uv_of, number);
    text += '\n';
  }

  static void append_color(std::string& text, const std::array<double, 3>& color) {
    text += "        color3f[] primvars:displayColor = [";
    std::array<float, 3> linear{};
    std::ranges::transform(color, linear.begin(), [](double c) { return static_cast<float>(c); });
    append_tuple(text, linear);
    text += "]\n";
  }

  void append_points(const View& view, const ClothView& cloth, Prim& prim) {
    if (particle_count(cloth) != prim.particles)
      throw std::invalid_argument("an animation keeps its number of particles");
    if (cloth.topology_version != prim.version)
      throw WriteError(file_.path(),
                       "the cloth tears, which a mesh of one shape cannot follow; .obj can");
    some_ = "[";
    Sample sample{points_.bytes(), 0, {}};
    bool first = true;
    for_each_particle(cloth, [&](float x, float y, float z) {
      const std::array<float, 3> at = placed(view, x, y, z);
      if (first) sample.extent = {at, at};
      for (std::size_t k = 0; k < 3; ++k) {
        sample.extent[0][k] = std::min(sample.extent[0][k], at[k]);
        sample.extent[1][k] = std::max(sample.extent[1][k], at[k]);
      }
      if (!first) some_ += ", ";
      append_tuple(some_, at);
      first = false;
    });
    some_ += ']';
    points_.write(some_);
    sample.bytes = std::int64_t(some_.size());
    prim.samples.push_back(sample);
  }

  // A time code a sample; how long one is, the first two tell.
  std::string header() const {
    double rate = 24;
    if (times_.size() > 1 && times_[1] > times_[0]) rate = 1 / (times_[1] - times_[0]);
    if (std::abs(rate - std::round(rate)) < 1e-6 * rate) rate = std::round(rate);
    std::string text = "#usda 1.0\n(\n    defaultPrim = \"weft\"\n    endTimeCode = ";
    append_number(text, times_.empty() ? 0 : times_.size() - 1);
    text += "\n    framesPerSecond = ";
    append_number(text, rate);
    text += "\n    metersPerUnit = 1\n    startTimeCode = 0\n    timeCodesPerSecond = ";
    append_number(text, rate);
    text += "\n    upAxis = \"Y\"\n)\n\ndef Xform \"weft\"\n{\n";
    return text;
  }

  void write_prim(std::size_t c) {
    const Prim& prim = prims_[c];
    std::string text = "    def Mesh \"cloth_" + std::to_string(c) + "\"\n    {\n" + prim.faces;
    text += "        float3[] extent.timeSamples = {\n";
    for (std::size_t n = 0; n < prim.samples.size(); ++n) {
      text += "            " + std::to_string(n) + ": ";
      append_list(text, prim.samples[n].extent,
                  [&](const std::array<float, 3>& at) { append_tuple(text, at); });
      text += ",\n";
    }
    text += "        }\n        point3f[] points.timeSamples = {\n";
    file_.write(text);
    for (std::size_t n = 0; n < prim.samples.size(); ++n) {
      file_.write("            " + std::to_string(n) + ": ");
      points_.copy_to(file_, prim.samples[n].from, prim.samples[n].bytes);
      file_.write(",\n");
    }
    file_.write("        }\n    }\n");
  }

  OutputFile file_;
  Spool points_;
  std::vector<Prim> prims_;
  std::vector<double> times_;
  std::string some_;
};

}  // namespace

std::unique_ptr<Animation> open_usda(const std::string& path, const View& first, std::int64_t) {
  return std::make_unique<Usda>(path, first);
}

}  // namespace weft
