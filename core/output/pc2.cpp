// PC2 point cache: a 32-byte header ("POINTCACHE2\0", int32 version 1, int32 points, float32 first
// frame, float32 frames per sample, int32 samples), then per sample float32 x,y,z of every point.
// All little-endian. The number of samples is put right at the end.
#include <cstdint>

#include "output/animation.h"
#include "output/bytes.h"

namespace weft {

namespace {

constexpr std::int64_t kSamplesOffset = 28;

std::int64_t particle_count(const View& view) {
  std::int64_t count = 0;
  for (const ClothView& cloth : view.cloths) {
    count += static_cast<std::int64_t>(cloth.columns) * cloth.rows;
  }
  return count;
}

class Pc2 final : public Animation {
 public:
  Pc2(const std::string& path, const View& first) : file_(path), points_(particle_count(first)) {
    std::string header("POINTCACHE2\0", 12);
    append_little_endian(header, std::int32_t{1});
    append_little_endian(header, static_cast<std::int32_t>(points_));
    append_little_endian(header, 0.0F);
    append_little_endian(header, 1.0F);
    append_little_endian(header, std::int32_t{0});
    file_.write(header);
  }

  void append(const View& view) override {
    if (particle_count(view) != points_) {
      throw std::invalid_argument("a point cache keeps its number of particles");
    }
    for (const ClothView& cloth : view.cloths) {
      for (int j = 0; j < cloth.rows; ++j) append_row(cloth, j);
    }
    ++samples_;
  }

  void finish() override {
    std::string bytes;
    append_little_endian(bytes, samples_);
    file_.overwrite(kSamplesOffset, bytes);
    file_.commit();
  }

  std::string written() const override { return file_.path(); }

 private:
  void append_row(const ClothView& cloth, int j) {
    row_.clear();
    const auto start = static_cast<std::size_t>(j) * static_cast<std::size_t>(cloth.stride);
    for (std::size_t n = start; n < start + static_cast<std::size_t>(cloth.columns); ++n) {
      append_little_endian(row_, cloth.x[n]);
      append_little_endian(row_, cloth.y[n]);
      append_little_endian(row_, cloth.z[n]);
    }
    file_.write(row_);
  }

  OutputFile file_;
  std::int64_t points_;
  std::int32_t samples_ = 0;
  std::string row_;  // bytes of one row, kept for its memory
};

}  // namespace

std::unique_ptr<Animation> open_pc2(const std::string& path, const View& first) {
  return std::make_unique<Pc2>(path, first);
}

}  // namespace weft
