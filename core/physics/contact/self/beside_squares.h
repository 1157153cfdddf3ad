// Pairs of squares of one sheet that share a corner, and each square with itself (folded along its diagonal,
// its A comes near its own BDC), but for those that sleep (square_ways.h). Those that lie much alike cannot touch.
#pragma once

#include <array>
#include <vector>

#include "physics/contact/self/blocks.h"
#include "physics/contact/self/pair_search.h"
#include "physics/contact/self/square_pairs.h"
#include "physics/contact/self/square_ways.h"

namespace weft::physics {

class BesideSquares {
 public:
  // Squares have the names of the particles that they begin with.
  BesideSquares(const std::vector<Sheet>& sheets, const std::vector<NamedSheet>& named,
                const std::vector<Square>& squares);

  // None sleeps.
  void wake();
  // Lists those that are awake, or all; leaves out squares with a corner that is marked.
  void list(const Ways& ways, bool all, const std::vector<std::uint8_t>& marked, Threads& threads);
  // Of every square of a row and those beyond it there and in the next row, rows of all sheets in turn.
  const std::vector<SquarePairs>& pairs() const { return pairs_; }
  // Until when a listed pair sleeps, by its number.
  float& until(std::int32_t number) {
    return until_[std::size_t(number) % kPairs][std::size_t(number) / kPairs];
  }
  // By how much the two of a listed pair may come at least, in ways, before they lie so that they may touch; negative
  // where they may [m].
  float alike(std::int32_t number, const Place* place) const;
  std::size_t bytes() const;

 private:
  // A square's pairs: with itself, the next along the row, and those of the next row from the one before it to the
  // one after.
  static constexpr std::size_t kPairs = 5;
  struct Lie {
    float u[4], v[4];  // m, mean edges along the row and the column, three floats of each
    float uu, vv;      // m², their squares
    float warp;        // m, how far edges are off them
  };

  std::ptrdiff_t step(std::size_t sheet, std::size_t pair) const;
  Lie lie_of(std::size_t n, const Place* place) const;
  void find_awake(std::size_t sheet, int row, const Ways& ways, bool all);
  void list_row(std::size_t sheet, int row, const std::vector<std::uint8_t>& marked,
                SquarePairs& found);

  const std::vector<Sheet>& sheets_;
  const std::vector<NamedSheet>& named_;
  const std::vector<Square>& squares_;
  std::array<std::vector<float>, kPairs> until_;  // m, of every square's pairs
  std::vector<std::uint8_t> awake_;               // a bit for each pair of a square
  std::vector<std::size_t> first_row_;            // of every sheet
  std::vector<SquarePairs> pairs_;
};

}  // namespace weft::physics
