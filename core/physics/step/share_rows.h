// The rows of a lattice in pieces, shared out to threads.
#pragma once

#include <algorithm>

#include "physics/step/stage.h"
#include "physics/step/threads.h"

namespace weft::physics {

// Calls work(rows) for spans that make up the rows 0 … rows-1, in any order, several at once; `alone`: on this
// thread, because they are short.
template <class Work>
void share_rows(Threads& threads, int rows, bool alone, const Work& work) {
  constexpr int kShares = 4;  // for each thread: rows are not alike
  const int height = alone ? rows : std::max(1, rows / (kShares * threads.count()));
  threads.share(std::size_t((rows + height - 1) / height), alone, [&](std::size_t k) {
    const int begin = int(k) * height;
    work(RowSpan{begin, std::min(begin + height, rows)});
  });
}

}  // namespace weft::physics
