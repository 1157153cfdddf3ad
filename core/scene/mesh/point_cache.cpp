// Point caches as they are read (weft/point_cache.h). PC2, little-endian: "POINTCACHE2\0", int32 version 1,
// int32 points, float32 first frame, float32 frames from sample to sample, int32 samples; then float32 x, y, z
// of every point, sample after sample. MDD, big-endian: int32 samples, int32 points, float32 time of each sample
// [s], and the same.
#include "weft/point_cache.h"

#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "scene/mesh/faces.h"
#include "scene/mesh/mesh_file.h"

namespace weft {
namespace {

constexpr std::size_t kMostBytes = std::size_t(1) << 30;
constexpr double kLatest = 1e6;  // s, or frames

// Numbers of four bytes, one after the other.
class Numbers {
 public:
  Numbers(std::string_view bytes, std::endian order) : bytes_(bytes), order_(order) {}
  std::int32_t whole() { return std::bit_cast<std::int32_t>(next()); }
  float number() { return std::bit_cast<float>(next()); }

 private:
  std::uint32_t next() {
    std::uint32_t value = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t place = order_ == std::endian::little ? k : 3 - k;
      value |= std::uint32_t(static_cast<unsigned char>(bytes_[at_ + k])) << (8 * place);
    }
    at_ += 4;
    return value;
  }

  std::string_view bytes_;
  std::endian order_;
  std::size_t at_ = 0;
};

class Reader {
 public:
  Reader(std::string_view bytes, const std::string& name, int points)
      : bytes_(bytes), name_(name), points_(points) {}

  PointCacheFile run() {
    const bool done = name_.ends_with(".pc2") ? pc2()
                      : name_.ends_with(".mdd")
                          ? mdd()
                          : refuse("the file is of no known kind", ".pc2, .mdd, .glb, .gltf");
    if (done) file_.cache = std::make_shared<const PointCache>(std::move(cache_));
    return std::move(file_);
  }

 private:
  static constexpr std::string_view kMark{"POINTCACHE2\0", 12};

  bool refuse(const std::string& what, const std::string& allowed) {
    file_.faults.push_back({name_, what, allowed});
    return false;
  }

  bool pc2() {
    if (bytes_.size() < 32 || !bytes_.starts_with(kMark))
      return refuse("the file does not begin as a .pc2 file does", "POINTCACHE2 and 20 bytes more");
    Numbers numbers(bytes_.substr(kMark.size()), std::endian::little);
    if (const int version = numbers.whole(); version != 1)
      return refuse("the version is " + std::to_string(version), "1");
    const int points = numbers.whole();
    const float first = numbers.number(), step = numbers.number();
    const int samples = numbers.whole();
    if (!fits(points, samples, 32)) return false;
    if (samples > 1 && !(step > 0))
      return refuse("samples are " + std::to_string(step) + " frames apart", "above 0");
    cache_.in_frames = true;
    for (int n = 0; n < samples; ++n)
      cache_.times.push_back(n == 0 ? first : float(double(first) + double(step) * n));
    return times_increase() && places(std::endian::little);
  }

  bool mdd() {
    if (bytes_.size() < 8)
      return refuse("the file does not begin as an .mdd file does", "8 bytes at least");
    Numbers numbers(bytes_, std::endian::big);
    const int samples = numbers.whole(), points = numbers.whole();
    if (!fits(points, samples, 8 + 4 * std::int64_t(samples))) return false;
    for (int n = 0; n < samples; ++n) cache_.times.push_back(numbers.number());
    return times_increase() && places(std::endian::big);
  }

  // Counts and sizes, before anything is as large as they say.
  bool fits(int points, int samples, std::int64_t header) {
    if (points != points_ && (points < 1 || points_ != kAnyPoints))
      return refuse("the file has " + std::to_string(points) + " points",
                    points_ == kAnyPoints ? "at least 1"
                                          : std::to_string(points_) + ", the vertices of the mesh");
    if (samples < 1)
      return refuse("the file has " + std::to_string(samples) + " samples", "at least 1");
    const double size = double(header) + 12.0 * points * samples;
    if (size != double(bytes_.size()))
      return refuse("the file has " + std::to_string(bytes_.size()) + " bytes",
                    std::to_string(std::int64_t(size)) + ", by its header");
    cache_.points = points;
    return true;
  }

  bool times_increase() {
    for (std::size_t n = 0; n < cache_.times.size(); ++n) {
      const float time = cache_.times[n];
      const std::string sample = "the time of sample " + std::to_string(n + 1);
      if (!(std::abs(time) <= kLatest))
        return refuse(sample + " is " + std::to_string(time), "-1e6 to 1e6");
      if (n > 0 && time <= cache_.times[n - 1])
        return refuse(
            sample + " is " + std::to_string(time) + ", and the one before it is no earlier",
            "times that increase");
    }
    return true;
  }

  // The last bytes of the file.
  bool places(std::endian order) {
    const std::size_t count = std::size_t(cache_.points) * cache_.times.size();
    Numbers numbers(bytes_.substr(bytes_.size() - 12 * count), order);
    cache_.places.resize(count);
    for (std::size_t n = 0; n < count; ++n)
      for (float& value : cache_.places[n]) {
        value = numbers.number();
        if (!std::isfinite(value))
          return refuse("point " + std::to_string(n % std::size_t(cache_.points) + 1) +
                            " of sample " + std::to_string(n / std::size_t(cache_.points) + 1) +
                            " is " + std::to_string(value),
                        "finite numbers");
      }
    return true;
  }

  std::string_view bytes_;
  const std::string& name_;
  int points_;
  PointCache cache_;
  PointCacheFile file_;
};

void append(std::string& bytes, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes += char((value >> shift) & 0xff);
}

}  // namespace

PointCacheFile parse_point_cache(std::string_view bytes, const std::string& name, int points) {
  return Reader(bytes, name, points).run();
}

PointCacheFile read_point_cache(const std::string& path, int points) {
  const auto refuse = [&](const char* what, const char* allowed) {
    return PointCacheFile{{}, {{path, what, allowed}}, {}};
  };
  if (text::is_gltf_file(path)) {
    const text::FileBytes file = text::bytes_of_file(path, text::kMaxMeshBytes);
    if (file.fault) return refuse(file.fault, file.allowed);
    return read_gltf_motion(file.bytes, path, std::filesystem::path(path).parent_path().string(),
                            points);
  }
  std::ifstream in(path, std::ios::binary);
  if (!in)
    return refuse("there is no such point cache", "a readable .pc2, .mdd, .glb or .gltf file");
  std::string bytes(1 << 16, '\0'), all;
  while (in.read(bytes.data(), std::streamsize(bytes.size())), in.gcount() > 0) {
    all.append(bytes, 0, std::size_t(in.gcount()));
    if (all.size() > kMostBytes) return refuse("the file is larger", "at most 1 GiB");
  }
  if (in.bad() || !in.eof())
    return refuse("the file cannot be read", "a readable .pc2, .mdd, .glb or .gltf file");
  return parse_point_cache(all, path, points);
}

std::string mdd_bytes(const PointCache& cache) {
  std::string bytes;
  append(bytes, std::uint32_t(cache.samples()));
  append(bytes, std::uint32_t(cache.points));
  for (const float time : cache.times) append(bytes, std::bit_cast<std::uint32_t>(time));
  for (const PointCache::Place& place : cache.places)
    for (const float value : place) append(bytes, std::bit_cast<std::uint32_t>(value));
  return bytes;
}

}  // namespace weft
