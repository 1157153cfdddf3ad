// What is written down of a cloth in a frame (rollback_buffer.h).
#include "physics/frame/rollback_buffer.h"

#include <algorithm>

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace weft::physics {
namespace {

// Rows of more bytes than this are written past the caches: nobody reads them before the frame's end,
// and they are not fetched first to be overwritten.
constexpr std::size_t kPastCaches = std::size_t(8) << 20;

void copy_past_caches(const float* from, int lanes, float* to) {
#if defined(__SSE2__)
  for (int i = 0; i < lanes; i += 4) _mm_stream_ps(to + i, _mm_load_ps(from + i));
  _mm_sfence();  // such stores are in no order with what tells other threads of them
#else
  std::copy_n(from, lanes, to);
#endif
}

void copy(ConstRow3 from, Row3 to, int lanes, bool past_caches) {
  const float* const source[] = {from.x, from.y, from.z};
  float* const target[] = {to.x, to.y, to.z};
  for (int k = 0; k < 3; ++k)
    if (past_caches)
      copy_past_caches(source[k], lanes, target[k]);
    else
      std::copy_n(source[k], lanes, target[k]);
}

}  // namespace

RollbackBuffer::RollbackBuffer(Particles& particles, const Vec3& gravity,
                               const KernelTable& kernels)
    : particles_(particles),
      gravity_(gravity),
      kernels_(kernels),
      x_(particles.rows, particles.stride),
      v_(particles.rows, particles.stride),
      seen_(std::size_t(particles.rows)) {}

void RollbackBuffer::before(RowSpan rows) {
  const int lanes = (rows.end - rows.begin) * particles_.stride;
  const bool past_caches = x_.bytes() + v_.bytes() > kPastCaches;
  copy(particles_.x.row(rows.begin), x_.row(rows.begin), lanes, past_caches);
  copy(particles_.v.row(rows.begin), v_.row(rows.begin), lanes, past_caches);
}

void RollbackBuffer::after(RowSpan rows) {
  for (int j = rows.begin; j < rows.end; ++j)
    seen_[std::size_t(j)] = kernels_.particles.energy_sum(
        energy_row(particles_, particles_.x.row(j), particles_.v.row(j), j, gravity_));
}

void RollbackBuffer::restore() {
  particles_.x.copy(x_);
  particles_.v.copy(v_);
}

EnergySum RollbackBuffer::energy_sum() const {
  EnergySum all;
  for (const EnergySum& row : seen_) all += row;
  return all;
}

}  // namespace weft::physics
