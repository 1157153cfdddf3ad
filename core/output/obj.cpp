// Wavefront OBJ, one file per sample: run.obj becomes run_0000.obj, run_0001.obj, … Every cloth is
// an object of quads over its grid or, once it is torn, of the triangles that are left and those along
// its seams, or of its mesh's triangles, with texture coordinates; coordinates are written so that they read
// back to the same bits. All files take their
// names at the end, in order.
#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <map>
#include <tuple>
#include <vector>

#include "output/animation.h"
#include "output/faces.h"

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

// What is seen along a tear hangs together with the cloth on its side, as one surface: points of the same particle
// at the same place are one vertex, and one where the particle is, is the particle's. The other side's go with
// other particles, wherever they are.
class TearVertices {
 public:
  explicit TearVertices(const ClothView& cloth) : next_(particle_count(cloth)) {
    if (cloth.tear_points.empty()) return;
    particles_.resize(cloth.lanes.empty() ? 0 : cloth.x.size());
    for (std::size_t n = 0; n < cloth.lanes.size(); ++n)
      particles_[cloth.lanes[n]] = static_cast<std::int64_t>(n);
    for (std::size_t n = 0; n < cloth.tear_points.size(); ++n) {
      const std::uint32_t lane = cloth.tear_particles[n];
      const auto& [x, y, z] = cloth.tear_points[n];
      if (x == cloth.x[lane] && y == cloth.y[lane] && z == cloth.z[lane]) {
        numbers_.push_back(number_of(cloth, lane));
        continue;
      }
      const auto [known, fresh] = vertices_.try_emplace({lane, x, y, z}, next_);
      if (fresh) own_.push_back(cloth.tear_points[n]), ++next_;
      numbers_.push_back(known->second);
    }
  }

  // Those that are no particles, which they follow.
  const std::vector<std::array<float, 3>>& own() const { return own_; }
  // Of the point with this number.
  std::int64_t operator[](std::size_t point) const { return numbers_[point]; }

 private:
  std::int64_t number_of(const ClothView& cloth, std::uint32_t lane) const {
    if (!particles_.empty()) return particles_[lane];
    const auto stride = static_cast<std::uint32_t>(cloth.stride);
    return static_cast<std::int64_t>(lane / stride) * cloth.columns + lane % stride;
  }

  std::int64_t next_;
  std::vector<std::int64_t> particles_;  // of a mesh, by lane
  std::map<std::tuple<std::uint32_t, float, float, float>, std::int64_t> vertices_;
  std::vector<std::int64_t> numbers_;
  std::vector<std::array<float, 3>> own_;
};

void append_vertices(std::string& text, const View& view, const ClothView& cloth,
                     const TearVertices& tears) {
  for_each_particle(cloth,
                    [&](float x, float y, float z) { append_vertex(text, placed(view, x, y, z)); });
  for (const auto& [x, y, z] : tears.own()) append_vertex(text, placed(view, x, y, z));
}

void append_uv(std::string& text, const Faces& faces) {
  for (const auto& at : faces.uv) {
    text += "vt";
    for (const double value : at) {
      text += ' ';
      append_number(text, value);
    }
    text += '\n';
  }
}

// The numbers that a cloth's first vertex and texture coordinate have in the file, from 1.
struct First {
  std::int64_t vertex = 1, uv = 1;
};

void append_faces(std::string& text, const Faces& faces, const First& first) {
  for (std::size_t n = 0; n < faces.particles.size(); ++n) {
    text += n % faces.corners == 0 ? "f " : " ";
    append_number(text, first.vertex + faces.particles[n]);
    if (!faces.uv_of.empty()) {
      text += '/';
      append_number(text, first.uv + faces.uv_of[n]);
    }
    if (n % faces.corners + 1 == faces.corners) text += '\n';
  }
}

// What is seen along a tear: triangles of points that follow the particles.
void append_tears(std::string& text, const ClothView& cloth, const TearVertices& tears,
                  std::int64_t first) {
  for (const auto& t : cloth.tear_triangles) {
    text += 'f';
    for (const std::uint32_t point : t) {
      text += ' ';
      append_number(text, first + tears[point]);
    }
    text += '\n';
  }
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
    First first;
    shown_.resize(view.cloths.size());
    for (std::size_t c = 0; c < view.cloths.size(); ++c) {
      const ClothView& cloth = view.cloths[c];
      const Faces& faces = faces_now(c, cloth);
      text_ = "o cloth_" + std::to_string(c) + "\n";
      const TearVertices tears(cloth);
      append_vertices(text_, view, cloth, tears);
      append_uv(text_, faces);
      append_faces(text_, faces, first);
      append_tears(text_, cloth, tears, first.vertex);
      file.write(text_);
      first.vertex += particle_count(cloth) + static_cast<std::int64_t>(tears.own().size());
      first.uv += static_cast<std::int64_t>(faces.uv.size());
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
    std::string text = files_.front().path();
    if (samples_ > 1) text += " … " + files_.back().path();
    const std::string next = obj_name(path_, samples_);
    std::error_code error;
    if (std::filesystem::exists(next, error))
      text += " (" + next + " and what follows is of an earlier, longer run)";
    return text;
  }

 private:
  struct Shown {
    std::uint64_t version = 0;  // of the topology
    Faces faces;
  };
  const Faces& faces_now(std::size_t c, const ClothView& cloth) {
    Shown& shown = shown_[c];
    if (shown.faces.particles.empty() || shown.version != cloth.topology_version)
      shown = {cloth.topology_version, faces_of(cloth)};
    return shown.faces;
  }

  std::filesystem::path path_;
  std::vector<Shown> shown_;  // of every cloth
  std::int64_t samples_ = 0;
  std::vector<OutputFile> files_;
  std::string text_;  // one cloth, kept for its memory
};

}  // namespace

std::unique_ptr<Animation> open_obj_sequence(const std::string& path, const View&, std::int64_t) {
  return std::make_unique<ObjSequence>(path);
}

}  // namespace weft
