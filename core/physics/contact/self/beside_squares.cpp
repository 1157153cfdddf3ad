// Squares beside each other (beside_squares.h).
#include "physics/contact/self/beside_squares.h"

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
    : sheets_(sheets), named_(named), squares_(squares), kernels_(kernels) {
  for (const Sheet& s : sheets) {
    first_row_.push_back(pairs_.size());
    pairs_.resize(pairs_.size() + std::size_t(rows_of(s)));
  }
  wake();
}

void BesideSquares::wake() {
  for (auto& until : until_)
    until.assign(squares_.size() + SquarePairs::kPadding, CornerWays::kAtOnce);
}

// From a square's number to that of the other one of a pair.
std::ptrdiff_t BesideSquares::step(std::size_t sheet, std::size_t pair) const {
  return pair < 2 ? std::ptrdiff_t(pair) : named_[sheet].stride + std::ptrdiff_t(pair) - 3;
}

auto BesideSquares::range(std::size_t sheet, int row, std::size_t pair) const -> Range {
  const auto first = std::size_t(named_[sheet].name(row, 0));
  const bool last_row = row + 1 == sheets_[sheet].points->rows;
  const int columns = sheets_[sheet].columns, end = columns - (pair == 1 || pair == 4 ? 1 : 0);
  return {pair == 2 ? 1 : 0, pair >= 2 && last_row ? 0 : end, first,
          first + std::size_t(step(sheet, pair))};
}

// visit(sheet, row, its list).
template <class Visit>
void BesideSquares::for_each_row(Threads& threads, const Visit& visit) {
  for (std::size_t s = 0; s < sheets_.size(); ++s)
    threads.share(std::size_t(rows_of(sheets_[s])), squares_.size() < kFewSquares,
                  [&](std::size_t j) {
                    SquarePairs& found = pairs_[first_row_[s] + j];
                    found.count = 0;
                    found.reserve(kPairs * std::size_t(sheets_[s].columns));
                    visit(s, int(j), found);
                  });
}

void BesideSquares::leave_out(const std::vector<std::uint8_t>& marked, SquarePairs& pairs) const {
  if (marked.empty()) return;
  const std::size_t count = std::exchange(pairs.count, 0);
  for (std::size_t k = 0; k < count; ++k)
    if (!has_corner_in(squares_[std::size_t(pairs.owner[k])], marked) &&
        !has_corner_in(squares_[std::size_t(pairs.neighbour[k])], marked))
      pairs.put(pairs, k);
}

void BesideSquares::list(const CornerWays& ways, const std::vector<std::uint8_t>& marked,
                         Threads& threads) {
  for_each_row(threads, [&](std::size_t sheet, int row, SquarePairs& found) {
    for (std::size_t pair = 0; pair < kPairs; ++pair) {
      const Range r = range(sheet, row, pair);
      if (r.end <= r.begin) continue;
      const std::size_t p = r.first + std::size_t(r.begin), q = r.other + std::size_t(r.begin);
      found.count += std::size_t(kernels_.sheets.beside_awake(
          {r.end - r.begin, ways.all() + p, ways.all() + q, until_[pair].data() + p,
           std::int32_t(p), std::int32_t(q), std::int32_t(kPairs * p + pair), std::int32_t(kPairs),
           found.owner.data() + found.count, found.neighbour.data() + found.count,
           found.number.data() + found.count}));
    }
    leave_out(marked, found);
  });
}

void BesideSquares::list_asked(const std::vector<std::uint8_t>& asked,
                               const std::vector<std::uint8_t>& marked, Threads& threads) {
  for_each_row(threads, [&](std::size_t sheet, int row, SquarePairs& found) {
    for (std::size_t pair = 0; pair < kPairs; ++pair) {
      const Range r = range(sheet, row, pair);
      for (int i = r.begin; i < r.end; ++i) {
        const std::size_t p = r.first + std::size_t(i), q = r.other + std::size_t(i);
        if (asked[p] | asked[q])
          found.put(std::int32_t(p), std::int32_t(q), std::int32_t(kPairs * p + pair));
      }
    }
    leave_out(marked, found);
  });
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
  std::size_t bytes = squares_.size() * 4 * kPairs;
  for (const SquarePairs& p : pairs_) bytes += p.bytes();
  return bytes;
}

}  // namespace weft::physics
