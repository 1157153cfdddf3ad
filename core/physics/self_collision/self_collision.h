// Self-collision, mode `particles`: no two particles of any cloths nearer than the thickness,
// except neighbours: those within the range of the search of each other on the flat sheet.
//
// Sheets are cut into blocks (blocks.h). Those that nothing can touch, themselves included, are left
// out; the particles of the others are searched for pairs within the range, the thickness and a skin
// (cell_grid.h). The list stays complete until blocks that may touch have moved by more than the skin
// against each other (Verlet 1967), and is made anew then. Blocks are looked at, and pairs pushed
// apart, as often as the motion asks for: never more than a share of the thickness in between. A pair
// corrects both its ends from the same state (Jacobi), each particle gathering what its own pairs
// say, so that no order matters.
#pragma once

#include <memory>
#include <vector>

#include "physics/self_collision/blocks.h"
#include "physics/self_collision/pair_search.h"
#include "weft/scene.h"

namespace weft::physics {

class ClothStep;

// Pairs of particles in range of each other, each listed with both its ends.
struct NearPairs {
  std::vector<Site> site;               // of every particle with a pair
  std::vector<std::int32_t> first;      // of its neighbours, one more than particles
  std::vector<std::int32_t> neighbour;  // numbers into site; filled by SelfContact::search
};

class SelfContact {
 public:
  // Null when no cloth asks for it.
  static std::unique_ptr<SelfContact> make(const Scene& scene,
                                           const std::vector<std::unique_ptr<ClothStep>>& cloths,
                                           const KernelTable& kernels);
  ~SelfContact();

  // Pushes apart what is too near at the end of a substep of dt; `since` substeps after the last
  // time. Returns after how many substeps to come again.
  int run(double dt, int since, Threads& threads);

  // Pairs nearer than the thickness now, and by how much at most [m].
  struct Overlaps {
    std::int64_t pairs = 0;
    double deepest = 0;
  };
  Overlaps overlaps();

  // Searches now for all pairs nearer than the greatest thickness and `margin` [m].
  const NearPairs& search(double margin, Threads& threads);

  // One part of a run by itself, for measuring: the sort of what was searched last, its pairs
  // within the thickness and a margin, and pushing them apart.
  void sort(double margin, Threads& threads);
  void find(double margin, Threads& threads);
  // Returns the greatest relative speed of two that touch [m/s].
  double respond(double dt, int since, Threads& threads);

  const std::vector<Sheet>& sheets() const { return sheets_; }
  void restart() { valid_ = false; }
  // Share of the times so far that the list of pairs was still complete.
  double kept() const { return runs_ > 0 ? 1 - double(searches_) / double(runs_) : 0; }
  // Share of the particles so far that were in blocks that nothing could touch.
  double passed_over() const;
  std::int64_t particles() const { return std::int64_t(particles_); }
  std::size_t bytes() const;

 private:
  SelfContact(const Scene& scene, std::vector<Sheet> sheets, const KernelTable& kernels);
  void list_sites(Threads& threads);
  void join_chunks(Threads& threads);
  void order_owners(Threads& threads);
  template <class Visit>
  void for_each_owner(std::size_t chunk, Visit&& visit) const;
  void group_owners(Threads& threads);
  void list_neighbours();
  void gather(std::size_t group);
  void scatter(std::size_t group);
  std::size_t groups() const { return (pairs_.site.size() + 15) / 16; }

  const Scene& scene_;
  std::vector<Sheet> sheets_;
  const KernelTable& kernels_;
  const std::size_t particles_;
  Blocks blocks_;
  PairSearch search_;                    // among the particles of active blocks
  std::vector<std::size_t> first_site_;  // of every block
  std::size_t count_ = 0;                // particles of active blocks
  std::vector<std::int32_t> listed_;     // sorted particle -> number into pairs_.site
  std::vector<std::int32_t> place_;      // where each owner has come to when owners were ordered
  NearPairs pairs_;
  struct {                                // of pairs_, 16 owners at a time
    std::vector<std::size_t> first;       // of a group's slots, one more than groups
    std::vector<std::int32_t> neighbour;  // slots x 16
    std::vector<float> friction;          // of every owner
    std::vector<std::int32_t> course;
  } slots_;
  std::vector<float> speeds_;             // of a group's pairs that touch, squared, at most
  std::vector<Body> bodies_, separated_;  // of pairs_.site, up to whole groups, and 16 far away
  float thickness_ = 0;                   // greatest of the sheets [m]
  bool course_ = false;                   // whether any sheet has the course's rule
  bool valid_ = false;
  std::int64_t runs_ = 0, searches_ = 0, passed_over_ = 0;
};

}  // namespace weft::physics
