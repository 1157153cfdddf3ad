// Pairs of squares of one sheet that share a corner, and each square with itself (folded along its diagonal,
// its A comes near its own BDC), but for those that sleep (corner_ways.h). Those that lie much alike cannot touch.
#pragma once

#include <array>
#include <vector>

#include "physics/contact/self/blocks.h"
#include "physics/contact/self/corner_ways.h"
#include "physics/contact/self/pair_search.h"
#include "physics/contact/self/square_pairs.h"

namespace weft::physics {

class BesideSquares {
 public:
  // Squares have the names of the particles that they begin with.
  BesideSquares(const std::vector<Sheet>& sheets, const std::vector<NamedSheet>& named,
                const std::vector<Square>& squares, const KernelTable& kernels);

  // None sleeps.
  void wake();
  // Lists those that are awake; leaves out squares with a corner that is marked.
  void list(const CornerWays& ways, const std::vector<std::uint8_t>& marked, Threads& threads);
  // Lists those of squares asked for, whether they sleep or not.
  void list_asked(const std::vector<std::uint8_t>& asked, const std::vector<std::uint8_t>& marked,
                  Threads& threads);
  // Of every square of a row and those beyond it there and in the next row, rows of all sheets in turn.
  const std::vector<SquarePairs>& pairs() const { return pairs_; }
  // Until when a listed pair sleeps, by its number.
  float& until(std::int32_t number) {
    return until_[std::size_t(number) % kPairs][std::size_t(number) / kPairs];
  }
  // Of listed pairs, one after another: by how much their squares may come at least, in ways, before they lie so that
  // they may touch; negative where they may [m]. `pairs` and `change`: and SquarePairs::kPadding more.
  void alike(const std::int32_t* owner, const std::int32_t* neighbour, std::size_t pairs,
             const Place* place, float* change) const;
  std::size_t bytes() const;

 private:
  // A square's pairs: with itself, the next along the row, and those of the next row from the one before it to the
  // one after.
  static constexpr std::size_t kPairs = 5;

  std::ptrdiff_t step(std::size_t sheet, std::size_t pair) const;
  template <class Visit>
  void for_each_row(Threads& threads, const Visit& visit);
  // Pairs of a row that lead to squares so far on, all in one way.
  struct Range {
    int begin, end;     // columns
    std::size_t first;  // square of column 0,
    std::size_t other;  // and the other one
  };
  Range range(std::size_t sheet, int row, std::size_t pair) const;
  void leave_out(const std::vector<std::uint8_t>& marked, SquarePairs& pairs) const;

  const std::vector<Sheet>& sheets_;
  const std::vector<NamedSheet>& named_;
  const std::vector<Square>& squares_;
  const KernelTable& kernels_;
  std::array<std::vector<float>, kPairs> until_;  // m, of every square's pairs
  std::vector<std::size_t> first_row_;            // of every sheet
  std::vector<SquarePairs> pairs_;
};

}  // namespace weft::physics
