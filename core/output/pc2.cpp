// PC2 point cache: a 32-byte header ("POINTCACHE2\0", int32 version 1, int32 points, float32 first
// frame, float32 frames per sample, int32 samples), then per sample float32 x,y,z of every point.
// All little-endian. The number of samples is put right at the end.
#include <cstdint>

#include "output/animation.h"
#include "output/bytes.h"

namespace weft {

namespace {

constexpr std::int64_t kSamplesOffset = 28;

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
    for_each_placed(view, [&](const std::array<float, 3>& at) {
      for (const float value : at) append_little_endian(some_, value);
      if (some_.size() > kSome) flush();
    });
    flush();
    ++samples_;
  }

  void complete() override {
    std::string bytes;
    append_little_endian(bytes, samples_);
    file_.overwrite(kSamplesOffset, bytes);
    file_.complete();
  }
  void commit() override { file_.commit(); }

  std::string written() const override { return file_.path(); }

 private:
  static constexpr std::size_t kSome = 1 << 16;

  void flush() {
    file_.write(some_);
    some_.clear();
  }

  OutputFile file_;
  std::int64_t points_;
  std::int32_t samples_ = 0;
  std::string some_;
};

}  // namespace

std::unique_ptr<Animation> open_pc2(const std::string& path, const View& first, std::int64_t) {
  return std::make_unique<Pc2>(path, first);
}

}  // namespace weft
