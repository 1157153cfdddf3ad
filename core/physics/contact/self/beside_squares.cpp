// Squares beside each other (beside_squares.h).
#include "physics/contact/self/beside_squares.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace weft::physics {
namespace {

constexpr std::size_t kFewSquares = 4096;  // that one thread does faster

// Meshes have none (beside_triangles.h).
int rows_of(const Sheet& sheet) {
  return sheet.mesh ? 0 : sheet.points->rows;
}

}  // namespace

BesideSquares::BesideSquares(const std::vector<Sheet>& sheets, const std::vector<NamedSheet>& named,
                             const std::vector<Square>& squares, const KernelTable& kernels)
    : sheets_(sheets),
      named_(named),
      squares_(squares),
      kernels_(kernels),
      picked_(squares.size()) {
  for (const Sheet& s : sheets) {
    first_row_.push_back(pairs_.size());
    pairs_.resize(pairs_.size() + std::size_t(rows_of(s)));
  }
  wake();
}

void BesideSquares::wake() {
  for (auto& until : until_) until.assign(squares_.size(), SquareWays::kAtOnce);
}

// From a square's number to that of the other one of a pair.
std::ptrdiff_t BesideSquares::step(std::size_t sheet, std::size_t pair) const {
  return pair < 2 ? std::ptrdiff_t(pair) : named_[sheet].stride + std::ptrdiff_t(pair) - 3;
}

// pick(square, other square, pair).
template <class Pick>
void BesideSquares::pick_row(std::size_t sheet, int row, const Pick& pick) {
  const auto first = std::size_t(named_[sheet].name(row, 0));
  const int columns = sheets_[sheet].columns;
  const std::size_t pairs = row + 1 < sheets_[sheet].points->rows ? kPairs : 2;
  std::uint8_t* const picked = picked_.data() + first;
  std::fill_n(picked, columns, std::uint8_t(0));
  for (std::size_t pair = 0; pair < pairs; ++pair) {
    const int begin = pair == 2 ? 1 : 0, end = columns - (pair == 1 || pair == 4 ? 1 : 0);
    const std::size_t other = first + std::size_t(step(sheet, pair));
    const auto bit = std::uint8_t(1 << pair);
    for (int i = begin; i < end; ++i)
      picked[i] = std::uint8_t(
          picked[i] | (pick(first + std::size_t(i), other + std::size_t(i), pair) ? bit : 0));
  }
}

template <class Pick>
void BesideSquares::list_picked(const Pick& pick, const std::vector<std::uint8_t>& marked,
                                Threads& threads) {
  for (std::size_t s = 0; s < sheets_.size(); ++s)
    threads.share(std::size_t(rows_of(sheets_[s])), squares_.size() < kFewSquares,
                  [&](std::size_t j) {
                    pick_row(s, int(j), pick);
                    list_row(s, int(j), marked, pairs_[first_row_[s] + j]);
                  });
}

void BesideSquares::list(const Ways& ways, const std::vector<std::uint8_t>& marked,
                         Threads& threads) {
  const float* const way = ways.all.data();
  list_picked([&](std::size_t p, std::size_t q,
                  std::size_t pair) { return way[p] + way[q] >= until_[pair][p]; },
              marked, threads);
}

void BesideSquares::list_asked(const std::vector<std::uint8_t>& asked,
                               const std::vector<std::uint8_t>& marked, Threads& threads) {
  list_picked([&](std::size_t p, std::size_t q, std::size_t) { return (asked[p] | asked[q]) != 0; },
              marked, threads);
}

void BesideSquares::list_row(std::size_t sheet, int row, const std::vector<std::uint8_t>& marked,
                             SquarePairs& found) {
  const int columns = sheets_[sheet].columns;
  found.count = 0;
  found.reserve(kPairs * std::size_t(columns));
  for (int i = 0; i < columns; ++i) {
    const auto p = std::size_t(named_[sheet].name(row, i));
    for (unsigned left = picked_[p]; left != 0; left &= left - 1) {
      const auto pair = std::size_t(std::countr_zero(left));
      const std::size_t q = p + std::size_t(step(sheet, pair));
      if (has_corner_in(squares_[p], marked) || has_corner_in(squares_[q], marked)) continue;
      found.put(std::int32_t(p), std::int32_t(q), std::int32_t(kPairs * p + pair));
    }
  }
}

// Sheet by sheet: owners come in their order.
void BesideSquares::alike(const std::int32_t* owner, const std::int32_t* neighbour,
                          std::size_t pairs, const Place* place, float* change) const {
  std::size_t sheet = 0;
  for (std::size_t begin = 0, end; begin < pairs; begin = end) {
    while (sheet + 1 < named_.size() && owner[begin] >= named_[sheet + 1].first) ++sheet;
    end = begin + 1;
    while (end < pairs && (sheet + 1 == named_.size() || owner[end] < named_[sheet + 1].first))
      ++end;
    const NamedSheet& of = named_[sheet];
    kernels_.sheets.squares_alike({place, squares_.data(), int(end - begin), owner + begin,
                                   neighbour + begin, of.uu, of.uv, of.vv, change + begin});
  }
}

std::size_t BesideSquares::bytes() const {
  std::size_t bytes = squares_.size() * (4 * kPairs + 1);
  for (const SquarePairs& p : pairs_) bytes += p.bytes();
  return bytes;
}

}  // namespace weft::physics
