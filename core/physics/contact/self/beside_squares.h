// Pairs of squares of one sheet that share a corner, and each square with itself (folded along its diagonal,
// its A comes near its own BDC), but for those that lie so much alike that they cannot touch. A pair is
// looked at anew where the edges of one of the two have changed.
#pragma once

#include <vector>

#include "physics/contact/self/blocks.h"
#include "physics/contact/self/pair_search.h"
#include "physics/contact/self/square_pairs.h"

namespace weft::physics {

class BesideSquares {
 public:
  // Squares have the names of the particles that they begin with.
  BesideSquares(const std::vector<Sheet>& sheets, const std::vector<NamedSheet>& named,
                const std::vector<Square>& squares);

  // All are to be looked at anew.
  void forget();
  // How the squares of a row lie now. Several rows may be measured at once.
  void measure_row(std::size_t sheet, int row, const Place* place);
  // Looks at what has changed; leaves out squares with a corner that is marked.
  void list(const std::vector<std::uint8_t>& passing, Threads& threads);
  // Of every square of a row and those beyond it there and in the next row, rows of all sheets in turn.
  const std::vector<SquarePairs>& pairs() const { return pairs_; }
  std::size_t bytes() const;

 private:
  struct Lie {
    float u[3], v[3];  // m, mean edges along the row and the column
    float uu, vv;      // m², their squares
    float warp;        // m, how far edges are off them
  };

  Lie lie_of(std::size_t n, const Place* place) const;
  bool lie_alike(const Sheet& sheet, std::size_t p, std::size_t q) const;
  void list_row(std::size_t sheet, int row, const std::vector<std::uint8_t>& passing,
                SquarePairs& found);

  const std::vector<Sheet>& sheets_;
  const std::vector<NamedSheet>& named_;
  const std::vector<Square>& squares_;
  std::vector<Lie> lies_;              // of every square, when it was looked at
  std::vector<std::uint8_t> changed_;  // squares that have changed since
  // Of every square, a bit for each of the pairs that it owns.
  std::vector<std::uint8_t> may_touch_;
  std::vector<std::size_t> first_row_;     // of every sheet
  std::vector<std::uint8_t> row_changed_;  // whether a square of it has
  std::vector<SquarePairs> pairs_;
};

}  // namespace weft::physics
