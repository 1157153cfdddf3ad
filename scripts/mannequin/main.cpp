// Makes a figure that walks, and clothes for it, into a folder:
//   mannequin.obj, walk.pc2   the body, and where its vertices are over time
//   shirt.obj                 a shirt that lies about it as it stands
#include <bit>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>

#include "garments.h"
#include "skin.h"

namespace mannequin {
namespace {

constexpr double kCell = 0.0155;                     // m, of the body's triangles
constexpr int kSamples = 181, kFramesPerSample = 2;  // of a scene with 60 frames a second: 6 s
constexpr double kFrame = 1.0 / 60;                  // s

void append(std::string& bytes, std::uint32_t value) {
  for (int shift = 0; shift < 32; shift += 8) bytes += char(value >> shift & 0xff);
}
void append(std::string& bytes, double value) {
  append(bytes, std::bit_cast<std::uint32_t>(float(value)));
}

// As the .pc2 files of `weft run --export`.
void write_walk(const Skin& skin, std::size_t points, const std::string& path) {
  std::string bytes("POINTCACHE2\0", 12);
  append(bytes, std::uint32_t(1));
  append(bytes, std::uint32_t(points));
  append(bytes, 0.0);
  append(bytes, double(kFramesPerSample));
  append(bytes, std::uint32_t(kSamples));
  for (int n = 0; n < kSamples; ++n)
    for (const Vec& p : skin.at(n * kFramesPerSample * kFrame))
      for (const double value : {p.x, p.y, p.z}) append(bytes, value);
  std::FILE* file = std::fopen(path.c_str(), "wb");
  const bool written = file && std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
  if ((file && std::fclose(file) != 0) || !written)
    throw std::runtime_error(path + ": cannot be written");
}

void make(const std::string& folder) {
  const Figure figure;
  const Mesh body = surface_of([&](Vec p) { return figure.body(p); }, {-0.75, -0.05, -0.25},
                               {0.75, 1.8, 0.3}, kCell);
  const Mesh shirt = make_shirt(figure);
  write_obj(body, folder + "/mannequin.obj", "mannequin");
  write_obj(shirt, folder + "/shirt.obj", "shirt");
  write_walk(Skin(figure, body), body.vertices.size(), folder + "/walk.pc2");
  std::printf("mannequin: %zu triangles, shirt: %zu vertices\n", body.triangles.size(),
              shirt.vertices.size());
}

}  // namespace
}  // namespace mannequin

int main(int count, char** words) {
  if (count != 2) {
    std::fprintf(stderr, "mannequin FOLDER: makes mannequin.obj, walk.pc2 and shirt.obj\n");
    return 2;
  }
  try {
    mannequin::make(words[1]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "mannequin: error: %s\n", error.what());
    return 5;
  }
}
