// Records of four floats in memory as four wide values, and back: moved whole, and turned.
#pragma once

#include "physics/kernels/quarters.h"

namespace weft::WEFT_KERNELS {

// One of the four of kLanes records.
struct Wide4 {
  Wide3 xyz;
  Wide last;
};

// Record k of kLanes.
WEFT_INLINE Wide4 turned(const Four (&record)[kLanes]) {
#if WEFT_LANES >= 4
  Wide r[4];
  for (int k = 0; k < 4; ++k) r[k] = join_quarters([&](int l) { return record[l + k]; });
  turn(r);
  return {{r[0], r[1], r[2]}, r[3]};
#else
  const Four r = record[0];
  return {wide3(r[0], r[1], r[2]), wide(r[3])};
#endif
}

// visit(k, number[k]) for each of kLanes, two by one load: half of all loads would be of numbers.
template <class Visit>
WEFT_INLINE void for_each_number(const std::int32_t* number, const Visit& visit) {
#if WEFT_LANES >= 4
  for (int k = 0; k < kLanes; k += 2) {
    std::uint64_t two;
    __builtin_memcpy(&two, number + k, sizeof two);
    visit(k, std::ptrdiff_t(std::uint32_t(two)));
    visit(k + 1, std::ptrdiff_t(two >> 32));
  }
#else
  visit(0, std::ptrdiff_t(number[0]));
#endif
}

// Record k is what load makes of address(k).
template <class Address, class Load>
WEFT_INLINE Wide4 records_from(const Address& address, const Load& load) {
  Four record[kLanes];
  for (int k = 0; k < kLanes; ++k) record[k] = load(address(k));
  return turned(record);
}
// Record k has its four floats at address(k).
template <class Address>
WEFT_INLINE Wide4 records_from(const Address& address) {
  return records_from(address, [](const float* at) { return load_four(at); });
}

// At records + stride * number[k].
WEFT_INLINE Wide4 records_at(const float* records, int stride, const std::int32_t* number) {
  Four record[kLanes];
  for_each_number(number, [&](int k, std::ptrdiff_t n) {
    record[k] = load_four(records + std::ptrdiff_t(stride) * n);
  });
  return turned(record);
}
// At records + stride * k.
WEFT_INLINE Wide4 records_in_row(const float* records, int stride) {
  return records_from([&](int k) { return records + std::ptrdiff_t(stride) * k; });
}

// Of the records a[k] and b[k]: a - b of the first three floats, a + b of the last.
WEFT_INLINE Wide4 differences_at(const float* records, int stride, const std::int32_t* a,
                                 const std::int32_t* b) {
  Four record[kLanes];
  for_each_number(a, [&](int k, std::ptrdiff_t n) {
    record[k] = load_four(records + std::ptrdiff_t(stride) * n);
  });
  for_each_number(b, [&](int k, std::ptrdiff_t n) {
    const Four other = load_four(records + std::ptrdiff_t(stride) * n), sign{-1, -1, -1, 1};
#if WEFT_LANES == 16
    record[k] = (Four)_mm_maskz_fmadd_ps(0xf, (__m128)other, (__m128)sign, (__m128)record[k]);
#elif WEFT_LANES == 8
    record[k] = (Four)_mm_fmadd_ps((__m128)other, (__m128)sign, (__m128)record[k]);
#else
    record[k] = record[k] + other * sign;
#endif
  });
  return turned(record);
}

// Record k goes to records + stride * k.
WEFT_INLINE void put_records(float* records, [[maybe_unused]] int stride, Wide4 v) {
#if WEFT_LANES >= 4
  Wide r[4] = {v.xyz.x, v.xyz.y, v.xyz.z, v.last};
  turn(r);
  for (int k = 0; k < 4; ++k)
    for_each_quarter(r[k], [&](int l, Four one) {
      store_four(records + std::ptrdiff_t(stride) * (l + k), one);
    });
#else
  store_four(records, Four{v.xyz.x[0], v.xyz.y[0], v.xyz.z[0], v.last[0]});
#endif
}

// Adds to the first three floats of records; no number comes twice.
WEFT_INLINE void add_records(float* records, [[maybe_unused]] int stride,
                             const std::int32_t* number, Wide3 v) {
#if WEFT_LANES >= 4
  Wide r[4] = {v.x, v.y, v.z, Wide{}};
  turn(r);
  for (int k = 0; k < 4; ++k)
    for_each_quarter(r[k], [&](int l, Four one) {
      float* const at = records + stride * std::ptrdiff_t(number[l + k]);
      store_four(at, load_four(at) + one);
    });
#else
  float* const at = records + stride * std::ptrdiff_t(number[0]);
  store_four(at, load_four(at) + Four{v.x[0], v.y[0], v.z[0], 0});
#endif
}

}  // namespace weft::WEFT_KERNELS
