// The threads of a simulation (threads.h).
#include "physics/threads.h"

#include <oneapi/tbb/info.h>

namespace weft::physics {

Threads::Threads(int count)
    : count_(count > 0 ? count : oneapi::tbb::info::default_concurrency()),
      allowed_(count_ > oneapi::tbb::info::default_concurrency()
                   ? std::make_unique<oneapi::tbb::global_control>(
                         oneapi::tbb::global_control::max_allowed_parallelism,
                         static_cast<std::size_t>(count_))
                   : nullptr),
      arena_(count_) {}

}  // namespace weft::physics
