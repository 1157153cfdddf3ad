// Records of four floats in memory as four wide values, and back: moved whole, and turned.
#pragma once

#include "physics/kernels/quarters.h"

namespace weft::WEFT_KERNELS {

// One of the four of kLanes records.
struct Wide4 {
  Wide3 xyz;
  Wide last;
};

// Record k has its four floats at address(k).
template <class Address>
WEFT_INLINE Wide4 records_from(const Address& address) {
#if WEFT_LANES >= 4
  Wide r[4];
  for (int k = 0; k < 4; ++k)
    r[k] = join_quarters([&](int l) { return load_four(address(l + k)); });
  turn(r);
  return {{r[0], r[1], r[2]}, r[3]};
#else
  const float* r = address(0);
  return {wide3(r[0], r[1], r[2]), wide(r[3])};
#endif
}

// At records + stride * number[k].
WEFT_INLINE Wide4 records_at(const float* records, int stride, const std::int32_t* number) {
  return records_from([&](int k) { return records + std::ptrdiff_t(stride) * number[k]; });
}
// At records + stride * k.
WEFT_INLINE Wide4 records_in_row(const float* records, int stride) {
  return records_from([&](int k) { return records + std::ptrdiff_t(stride) * k; });
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

}  // namespace weft::WEFT_KERNELS
