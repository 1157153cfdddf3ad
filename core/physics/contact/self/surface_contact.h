// Self-collision, mode `surface`: vertices never pass through triangles, nor edges through edges.
//
// From time to time the least distance d of anything that a vertex belongs to from anything else that
// shares no corner with it is measured. What is nearer than the thickness is pushed apart then
// (kernels/surface.cpp), by a quarter of d at most, and the vertex has its place there, and a bound:
// what is left of 0.45 d. While no vertex is farther from its place than its bound, whatever two things
// were d apart are at least (1 - 2 · 0.45) d apart, on the whole way from there: nothing can have
// passed. So what has moved too far is put back to its bound. Below a floor bounds are nothing: however
// a collider or a pull presses, only pushing apart goes on, so that no distance dwindles to what
// rounding could cross. The common part of all motion is left out of account. (Conservative bounds on
// motion, as in Chen et al. 2025, Offset Geometric Contact; distances as in Bridson et al. 2002.)
//
// Vertices that come near their bounds are hot. Few of them are measured by themselves: they get a new
// bound, and all others keep what is left of theirs, about where they are, or less where a hot one has
// come near. Where many are hot, and every few substeps, all is measured.
//
// Only pairs of squares that are near each other are measured (near_squares.h).
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "physics/contact/self/near_squares.h"
#include "weft/scene.h"

namespace weft::physics {

class SurfaceContact {
 public:
  // Null unless a cloth asks for it; then over all cloths that take part in self-collision.
  static std::unique_ptr<SurfaceContact> make(const Scene& scene, const std::vector<Sheet>& sheets,
                                              const KernelTable& kernels);

  // Squares that have a marked particle are left alone from the next beginning on (untangle.h).
  void leave_out(const std::vector<std::uint8_t>& marked) { near_.leave_out(marked); }
  // Measures where all is now; nothing has crossed but what is left alone.
  void begin(Threads& threads);
  // Puts back what has moved too far in `since` substeps of dt, and measures what it is time for.
  // Returns after how many substeps to come again. Nothing has crossed afterwards.
  int run(double dt, int since, Threads& threads);

  void restart() { valid_ = false; }
  bool valid() const { return valid_; }
  // Whether something may have crossed all the same since last asked: a pinned particle that left its
  // bound on a path.
  bool forced() { return std::exchange(forced_, false); }
  // So far: times that all was measured, and a part, squares whose pairs were listed (in times all
  // of them), and vertices put back.
  std::int64_t measured() const { return measured_; }
  std::int64_t measured_in_part() const { return measured_in_part_; }
  double listed() const { return near_.listed(); }
  std::int64_t held_back() const { return held_back_; }
  std::size_t bytes() const;

 private:
  struct Place {
    float x[3], bound;  // m
  };
  struct Common {
    float moved[3], speed[3];  // m, m/s
  };
  struct Motion {                       // of all vertices, the greatest
    float share_squared, rate_squared;  // |displacement|/bound, speed/bound [1/s]
    std::size_t hot;                    // vertices that are near their bounds
  };
  struct Piece {  // of the pairs that are measured
    std::vector<SquaresTouching> touching;
    std::size_t touches = 0;
    std::vector<float> near_squared;  // m²
  };

  SurfaceContact(std::vector<Sheet> sheets, const KernelTable& kernels);
  void measure(bool all, Threads& threads);
  const SquarePairs& pairs_of_hot();
  void measure_piece(std::size_t piece);
  void sum_up(std::size_t begin, std::size_t end);
  void set_places_and_push(std::size_t sheet, int row, bool all);
  Common common_motion() const;
  void hold(double seconds, double dt);
  void hold_row(std::size_t sheet, int row, const float (&drift)[3], double seconds, double dt);

  const std::vector<Sheet> sheets_;
  const KernelTable& kernels_;
  NearSquares near_;  // of these sheets
  std::vector<Place> places_;
  float frame_[3] = {};            // m: what has been common so far; places are apart from it
  std::vector<std::uint8_t> hot_;  // vertices that are near their bounds
  Motion motion_{};

  SquarePairs of_hot_;                  // of the near pairs, what hot vertices belong to
  const SquarePairs* pairs_ = nullptr;  // those that are measured this time
  std::vector<Piece> pieces_;
  std::vector<SquareChange> sums_;   // of every square
  std::vector<float> near_squared_;  // and its distance from others, squared [m²]
  float floor_ = 0;                  // m: a distance that motion does not go below
  bool valid_ = false;
  bool forced_ = false;
  int since_ = 0;  // substeps since all was measured
  std::int64_t measured_ = 0, measured_in_part_ = 0, held_back_ = 0;
};

}  // namespace weft::physics
