// Self-collision, mode `particles`: no two particles of any cloths nearer than the thickness,
// except neighbours: those within the thickness and a skin of each other on the flat sheet.
//
// Who may touch is found rarely: pairs within the thickness and a skin stay complete until two
// particles have moved by more than the skin against each other (Verlet's list, 1967). That is
// checked, and the pairs are pushed apart, as often as the fastest relative motion asks for: never
// more than a share of the thickness in between. A pair corrects both its ends from the same state
// (Jacobi), each particle gathering what its own pairs say, so that no order matters.
#pragma once

#include <memory>
#include <vector>

#include "physics/self_collision/cell_grid.h"
#include "physics/threads.h"

namespace weft::physics {

class ClothStep;

// One particle: which lattice, row and column.
struct Site {
  std::uint16_t cloth, row, column;
};

// Pairs of particles in range of each other, each listed with both its ends.
struct NearPairs {
  std::vector<Site> site;               // of every particle with a pair, cell by cell
  std::vector<std::int32_t> first;      // of its neighbours, one more than particles
  std::vector<std::int32_t> neighbour;  // numbers into site
};

class SelfContact {
 public:
  // Null when no cloth asks for it.
  static std::unique_ptr<SelfContact> make(const Scene& scene,
                                           const std::vector<std::unique_ptr<ClothStep>>& cloths,
                                           const KernelTable& kernels);

  // Pushes apart what is too near at the end of a substep of dt; `since` substeps after the last
  // time. Returns after how many substeps to come again.
  int run(double dt, int since, Threads& threads);

  // Pairs nearer than the thickness now, and by how much at most [m].
  struct Overlaps {
    std::int64_t pairs = 0;
    double deepest = 0;
  };
  Overlaps overlaps();

  // Searches now for all pairs nearer than their thickness and `margin` [m].
  const NearPairs& search(double margin, Threads& threads);

  void restart() { valid_ = false; }
  // Share of the times so far that the list of pairs was still complete.
  double kept() const { return runs_ > 0 ? 1 - double(searches_) / double(runs_) : 0; }
  std::int64_t particles() const { return std::int64_t(sites_.size()); }
  std::size_t bytes() const;

 private:
  struct Sheet {  // one cloth that takes part
    Lattice* lattice;
    float thickness, friction;
    float uu, uv, vv;  // rest metric: |di u + dj v|² [m²]
    bool course;
    int first;  // number of its first particle
  };
  struct Body {  // a particle with pairs, as it is now
    float x[3], w, v[3], thickness;
  };
  struct Chunk;  // a share of the search

  SelfContact(const Scene& scene, std::vector<Sheet> sheets, const KernelTable& kernels);
  void copy_positions();
  float moved_apart() const;     // since the last search, at most [m]
  float relative_speed() const;  // at most [m/s]
  void search_chunk(Chunk& chunk, std::size_t begin, std::size_t end, float range) const;
  void sort_sites();
  void keep_touching(Threads& threads);
  void touch_chunk(Chunk& chunk, std::size_t begin, std::size_t end) const;
  void join_chunks();
  void gather(std::size_t a);
  void separate(std::size_t t, double dt, int since);
  void scatter(std::size_t t);
  int next_run(double dt) const;
  bool course() const;

  const Scene& scene_;
  std::vector<Sheet> sheets_;
  const KernelTable& kernels_;
  std::vector<Site> sites_;        // of every particle
  AlignedArray<float> x_, y_, z_;  // of every particle at the last search
  CellGrid grid_;
  std::vector<Chunk> chunks_;
  std::vector<RestMetric> metrics_;   // of every sheet
  AlignedArray<float> column_, row_;  // of every particle, as sorted
  std::vector<std::uint16_t> sheet_;  // the same
  std::vector<std::int32_t> listed_;  // sorted particle -> number into pairs_.site, or -1
  NearPairs pairs_;
  std::vector<Body> bodies_, separated_;
  struct {  // of the pairs, those that may touch now; numbers into pairs_.site
    std::vector<std::int32_t> owner, first, neighbour;
  } touching_;
  float thickness_ = 0;  // greatest of the sheets [m]
  bool valid_ = false;
  std::int64_t runs_ = 0, searches_ = 0;

 public:
  ~SelfContact();
};

}  // namespace weft::physics
