// Self-collision, mode `surface`: vertices never pass through triangles, nor edges through edges.
//
// From time to time the least distance d of anything that a vertex belongs to from anything else that
// shares no corner with it is measured. What is nearer than the thickness is pushed apart then
// (kernels/surface.cpp), by a quarter of d at most, and the vertex has its place there, and a bound:
// what is left of 0.45 d. While no vertex is farther from its place than its bound, whatever two things
// were d apart are at least (1 - 2 · 0.45) d apart, on the whole way from there: nothing can have
// passed. So what has moved too far is put back to its bound, and all is measured anew before
// bounds matter much. Below a floor bounds are nothing: however a collider or a pull presses, only
// pushing apart goes on, so that no distance dwindles to what rounding could cross. The common part
// of all motion is left out of account. (Conservative bounds on motion, as in Chen et al. 2025,
// Offset Geometric Contact; distances as in Bridson et al. 2002.)
//
// Pairs of squares of the sheets are found by the same search as particles (pair_search.h), and each
// is measured once.
#pragma once

#include <memory>
#include <vector>

#include "physics/kernels/surface.h"
#include "physics/self_collision/blocks.h"
#include "physics/self_collision/pair_search.h"
#include "weft/scene.h"

namespace weft::physics {

class SurfaceContact {
 public:
  // Null unless a cloth asks for it; then over all cloths that take part in self-collision.
  static std::unique_ptr<SurfaceContact> make(const Scene& scene, const std::vector<Sheet>& sheets,
                                              const KernelTable& kernels);

  // Measures where all is now; nothing has crossed.
  void begin(Threads& threads);
  // Puts back what has moved too far in `since` substeps of dt, and measures anew when it is time.
  // Returns after how many substeps to come again. Nothing has crossed afterwards.
  int run(double dt, int since, Threads& threads);

  void restart() { valid_ = false; }
  bool valid() const { return valid_; }
  // Times that all was measured, and vertices put back, so far.
  std::int64_t measured() const { return measured_; }
  std::int64_t held_back() const { return held_back_; }
  std::size_t bytes() const;

 private:
  struct Place {
    float x[3], bound;  // m
  };
  struct Motion {     // of all vertices
    float common[3];  // m
    float share;      // greatest |displacement|/bound
    float rate;       // greatest speed/bound [1/s]
  };

  SurfaceContact(std::vector<Sheet> sheets, const KernelTable& kernels);
  void measure(Threads& threads);
  float list_squares(Spread& box, std::size_t& count);
  void fill_square(std::size_t sorted);
  void measure_chunk(std::size_t chunk);
  void sum_up(std::size_t begin, std::size_t end);
  void set_places_and_push(std::size_t sheet, int row);
  Motion hold(double seconds);
  std::size_t number(std::size_t sheet, int row, int column) const {
    return first_[sheet] + std::size_t(row) * std::size_t(sheets_[sheet].lattice->columns) +
           std::size_t(column);
  }

  const std::vector<Sheet> sheets_;
  const KernelTable& kernels_;
  std::vector<std::size_t> first_;  // number of every sheet's first particle
  PairSearch search_;               // among squares
  // Squares as sorted by the search; those of torn ones are not among them.
  std::vector<std::int32_t> sorted_;  // of every particle, the number of its square, or -1
  std::vector<Square> squares_;
  std::vector<SquareBox> boxes_;
  struct Measured {  // pairs of a chunk whose boxes are in range, and those that touch
    std::vector<std::int32_t> owner, neighbour;
    std::vector<float> near_squared;
    std::vector<SquaresTouching> touching;
    std::size_t count = 0, touches = 0;
  };
  std::vector<Measured> chunks_;
  std::vector<SquareChange> sums_;   // of every square
  std::vector<float> near_squared_;  // and its distance from others, squared [m²]
  std::vector<Place> places_;
  float reach_ = 0, close_ = 0, floor_ = 0;  // m; floor_: a distance that motion does not go below
  bool valid_ = false;
  int since_ = 0;  // substeps since all was measured
  std::int64_t measured_ = 0, held_back_ = 0;
};

}  // namespace weft::physics
