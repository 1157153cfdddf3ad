// The size of many values at once, by which the end of a frame tells whether all is well.
#include "physics/kernels/row_kernels.h"

namespace weft::WEFT_KERNELS {

namespace {
constexpr int kBlocks = 16 / kLanes;  // of 16 values: in the same lanes at every width
}

// As whole numbers the sizes of floats have the order of their bits, and what is not a number lies
// above infinity.
float greatest(const float* values, std::ptrdiff_t count) {
  constexpr int kSize = 0x7fffffff, kInfinite = 0x7f800000;
  WideInt most[kBlocks] = {};
  for (std::ptrdiff_t i = 0; i < count; i += 16)
    for (int b = 0; b < kBlocks; ++b) {
      const WideInt size = (WideInt)load(values + i + b * kLanes) & kSize;
      most[b] = size > most[b] ? size : most[b];
    }
  int greatest = 0;
  for (const WideInt& m : most)
    for (int lane = 0; lane < kLanes; ++lane) greatest = m[lane] > greatest ? m[lane] : greatest;
  return ((Wide)(WideInt{} + (greatest > kInfinite ? kInfinite : greatest)))[0];
}

float sum_of_squares(const float* values, std::ptrdiff_t count) {
  Wide sum[kBlocks] = {};
  for (std::ptrdiff_t i = 0; i < count; i += 16)
    for (int b = 0; b < kBlocks; ++b) {
      const Wide v = load(values + i + b * kLanes);
      sum[b] = sum[b] + v * v;
    }
  float all = 0;
  for (const Wide& s : sum)
    for (int lane = 0; lane < kLanes; ++lane) all += s[lane];
  return all;
}

}  // namespace weft::WEFT_KERNELS
