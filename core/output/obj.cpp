// Wavefront OBJ, one file per sample: run.obj becomes run_0000.obj, run_0001.obj, … Every cloth is
// an object of quads over its grid or, once it is torn, of the triangles that are left and those along
// its seams; coordinates are written so that they read back to the same bits. All files take their
// names at the end, in order.
#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
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
  for (const auto& [x, y, z] : cloth.tear_points) append_vertex(text, placed(view, x, y, z));
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

// What a mesh or a torn cloth shows: its triangles, then its seams, whose points follow the particles.
void append_torn(std::string& text, const ClothView& cloth, std::int64_t first) {
  const auto face = [&](const std::array<std::int64_t, 3>& corners) {
    text += 'f';
    for (const std::int64_t corner : corners) {
      text += ' ';
      append_number(text, corner);
    }
    text += '\n';
  };
  std::vector<std::int64_t> numbers;  // of a mesh, by lane
  if (!cloth.lanes.empty()) numbers.resize(cloth.x.size());
  for (std::size_t n = 0; n < cloth.lanes.size(); ++n)
    numbers[cloth.lanes[n]] = static_cast<std::int64_t>(n);
  const auto particle = [&](std::uint32_t p) {
    if (!numbers.empty()) return first + numbers[p];
    const auto stride = static_cast<std::uint32_t>(cloth.stride);
    return first + static_cast<std::int64_t>(p / stride) * cloth.columns + p % stride;
  };
  for (const auto& t : cloth.triangles) face({particle(t[0]), particle(t[1]), particle(t[2])});
  const std::int64_t points = first + particle_count(cloth);
  for (const auto& t : cloth.tear_triangles) face({points + t[0], points + t[1], points + t[2]});
}

// run.obj -> run_0012.obj; beyond 9999 the number grows a digit.
std::string obj_name(const std::filesystem::path& path, std::int64_t sample) {
  std::string digits = std::to_string(sample);
  if (digits.size() < 4) digits.insert(0, 4 - digits.size(), '0');
  return (path.parent_path() / (path.stem().string() + "_" + digits + ".obj")).string();
}

class ObjSequence final : public Animation {
 public:
  explicit ObjSequence(const std::string& path) : path_(path) {
    files_.emplace_back(obj_name(path_, 0));  // what cannot be written is found now
  }

  void append(const View& view) override {
    if (samples_ > 0) files_.emplace_back(obj_name(path_, samples_), files_.front());
    OutputFile& file = files_.back();
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
      first += particle_count(cloth) + static_cast<std::int64_t>(cloth.tear_points.size());
    }
    file.complete(false);
    ++samples_;
  }

  // All at once: the disk takes milliseconds for each.
  void complete() override {
    const int file = ::open(files_.front().temporary().c_str(), O_RDONLY | O_CLOEXEC);
    const bool stored = file >= 0 && ::syncfs(file) == 0;
    const int why = errno;
    if (file >= 0) ::close(file);
    if (!stored)
      throw WriteError(files_.front().path(), std::string("writing failed: ") + std::strerror(why));
  }
  void commit() override {
    if (samples_ == 0) return;
    for (OutputFile& file : files_) file.commit();
  }

  std::string written() const override {
    std::string text = files_.front().path() + " … " + files_.back().path();
    const std::string next = obj_name(path_, samples_);
    std::error_code error;
    if (std::filesystem::exists(next, error))
      text += " (" + next + " and what follows is of an earlier, longer run)";
    return text;
  }

 private:
  std::filesystem::path path_;
  std::int64_t samples_ = 0;
  std::vector<OutputFile> files_;
  std::string text_;  // one cloth, kept for its memory
};

}  // namespace

std::unique_ptr<Animation> open_obj_sequence(const std::string& path, const View&, std::int64_t) {
  return std::make_unique<ObjSequence>(path);
}

}  // namespace weft
