// MDD point cache: int32 samples, int32 points, float32 time of every sample [s], then per sample
// float32 x,y,z of every point. All big-endian. The times come before the positions, so that these
// wait in a spool until the last sample is known.
#include <algorithm>
#include <cstdint>

#include "output/animation.h"
#include "output/bytes.h"
#include "output/spool.h"

namespace weft {

namespace {

class Mdd final : public Animation {
 public:
  Mdd(const std::string& path, const View& first)
      : file_(path), positions_(path), points_(particle_count(first)) {}

  void append(const View& view) override {
    if (particle_count(view) != points_)
      throw std::invalid_argument("a point cache keeps its number of particles");
    append_big_endian(times_, static_cast<float>(view.time));
    ++samples_;
    for_each_placed(view, [&](const std::array<float, 3>& at) {
      for (const float value : at) append_big_endian(some_, value);
      if (some_.size() > kSome) flush();
    });
    flush();
  }

  void complete() override {
    std::string header;
    append_big_endian(header, samples_);
    append_big_endian(header, static_cast<std::int32_t>(points_));
    file_.write(header + times_);
    positions_.copy_to(file_);
    file_.complete();
  }
  void commit() override { file_.commit(); }

  std::string written() const override { return file_.path(); }

 private:
  static constexpr std::size_t kSome = 1 << 16;

  void flush() {
    positions_.write(some_);
    some_.clear();
  }

  OutputFile file_;
  Spool positions_;
  std::int64_t points_;
  std::int32_t samples_ = 0;
  std::string times_, some_;
};

}  // namespace

std::unique_ptr<Animation> open_mdd(const std::string& path, const View& first, std::int64_t) {
  return std::make_unique<Mdd>(path, first);
}

}  // namespace weft
