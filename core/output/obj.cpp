// Wavefront OBJ, one file per sample: run.obj becomes run_0000.obj, run_0001.obj, … Every cloth is
// an object of quads over its grid or, once it is torn, of the triangles that are left and those along
// its seams; coordinates are written so that they read back to the same bits.
#include <array>
#include <charconv>
#include <filesystem>

#include "output/animation.h"

namespace weft {

namespace {

template <class T>
void append_number(std::string& text, T value) {
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  text.append(digits.data(), end);
}

void append_vertex(std::string& text, const std::array<float, 3>& at) {
  text += 'v';
  for (const float value : at) {
    text += ' ';
    append_number(text, value);
  }
  text += '\n';
}

void append_vertices(std::string& text, const View& view, const ClothView& cloth) {
  for_each_particle(cloth,
                    [&](float x, float y, float z) { append_vertex(text, placed(view, x, y, z)); });
  for (const auto& [x, y, z] : cloth.seam_points) append_vertex(text, placed(view, x, y, z));
}

// Corners in the order that makes u × v the face normal. OBJ counts vertices from 1 over the whole
// file; `first` is the number of the cloth's first one.
void append_quads(std::string& text, const ClothView& cloth, std::int64_t first) {
  const auto corner = [&](int i, int j) {
    text += ' ';
    append_number(text, first + static_cast<std::int64_t>(j) * cloth.columns + i);
  };
  for (int j = 0; j + 1 < cloth.rows; ++j) {
    for (int i = 0; i + 1 < cloth.columns; ++i) {
      text += 'f';
      corner(i, j);
      corner(i + 1, j);
      corner(i + 1, j + 1);
      corner(i, j + 1);
      text += '\n';
    }
  }
}

// What a torn cloth shows: its triangles, then its seams, whose points follow the particles.
void append_torn(std::string& text, const ClothView& cloth, std::int64_t first) {
  const auto face = [&](const std::array<std::int64_t, 3>& corners) {
    text += 'f';
    for (const std::int64_t corner : corners) {
      text += ' ';
      append_number(text, corner);
    }
    text += '\n';
  };
  const auto particle = [&](std::uint32_t p) {
    const auto stride = static_cast<std::uint32_t>(cloth.stride);
    return first + static_cast<std::int64_t>(p / stride) * cloth.columns + p % stride;
  };
  for (const auto& t : cloth.triangles) face({particle(t[0]), particle(t[1]), particle(t[2])});
  const std::int64_t points = first + static_cast<std::int64_t>(cloth.columns) * cloth.rows;
  for (const auto& t : cloth.seams) face({points + t[0], points + t[1], points + t[2]});
}

class ObjSequence final : public Animation {
 public:
  explicit ObjSequence(const std::string& path) : path_(path) {
    OutputFile probe(name(0));  // found now, not after the first frame; leaves nothing
  }

  void append(const View& view) override {
    OutputFile file(name(samples_));
    std::int64_t first = 1;
    int number = 0;
    for (const ClothView& cloth : view.cloths) {
      text_ = "o cloth_" + std::to_string(number++) + "\n";
      append_vertices(text_, view, cloth);
      if (cloth.topology_version > 0)
        append_torn(text_, cloth, first);
      else
        append_quads(text_, cloth, first);
      file.write(text_);
      first += static_cast<std::int64_t>(cloth.columns) * cloth.rows +
               static_cast<std::int64_t>(cloth.seam_points.size());
    }
    file.commit();
    ++samples_;
  }

  void finish() override {}

  std::string written() const override { return name(0) + " … " + name(samples_ - 1); }

 private:
  // run.obj -> run_0012.obj; beyond 9999 the number grows a digit.
  std::string name(std::int64_t sample) const {
    std::string digits = std::to_string(sample);
    if (digits.size() < 4) digits.insert(0, 4 - digits.size(), '0');
    return (path_.parent_path() / (path_.stem().string() + "_" + digits + ".obj")).string();
  }

  std::filesystem::path path_;
  std::int64_t samples_ = 0;
  std::string text_;  // one cloth, kept for its memory
};

}  // namespace

std::unique_ptr<Animation> open_obj_sequence(const std::string& path, const View&, std::int64_t) {
  return std::make_unique<ObjSequence>(path);
}

}  // namespace weft
