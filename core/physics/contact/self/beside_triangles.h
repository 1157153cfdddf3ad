// Pairs of a mesh's triangles that share a corner, but for those about vertices where the mesh lies so flat
// that they cannot touch.
//
// Let all normals about a vertex lie within φ of one direction n, and lengths be no less than s of those at
// rest. Seen along n the triangles cover one another nowhere; over the straight way from one point to another
// there the surface is at most 1/cos φ as long, and that is at least s times their distance at rest. So they
// are cos φ · s of it apart. Contact keeps half of it.
#pragma once

#include <span>
#include <vector>

#include "physics/contact/self/square_pairs.h"
#include "physics/step/threads.h"

namespace weft::physics {

class BesideTriangles {
 public:
  // The triangles are squares with numbers from `first` on; `rest`: of every body.
  BesideTriangles(std::span<const Square> triangles, std::int32_t first,
                  const std::vector<RestPlace>& rest);

  // Looks at how they lie; leaves out triangles with a corner that is marked.
  void list(const Place* place, const std::vector<std::uint8_t>& passing, Threads& threads);
  // In order of their numbers.
  const std::vector<SquarePairs>& pairs() const { return pairs_; }
  std::size_t bytes() const;

 private:
  static constexpr std::size_t kAtOnce = 256;  // triangles

  // How a triangle lies at rest: the edges AB and AC.
  struct Rest {
    float bb, bc, cc;  // 1/m²: |F|² is their sum with the products of the edges as they are
    float area;        // m², twice
  };
  struct Lie {
    float normal[3], whole;  // 1: no length is less than s of that at rest
  };
  struct Fan {
    std::int32_t body, first, count;  // of fan_
    bool joined;                      // edge to edge
  };

  void list_fans(std::size_t bodies);
  void list_beside();
  Lie lie_of(std::size_t triangle, const Place* place) const;
  bool is_flat(const Fan& fan) const;
  void list_some(std::size_t begin, std::size_t end, const std::vector<std::uint8_t>& passing,
                 SquarePairs& found) const;

  const std::span<const Square> triangles_;
  const std::int32_t first_;
  std::vector<Rest> rest_;            // of every triangle
  std::vector<Fan> fans_;             // of every vertex
  std::vector<std::int32_t> fan_;     // triangles
  std::vector<std::int32_t> begin_;   // of every triangle's
  std::vector<std::int32_t> beside_;  // triangles with greater numbers, ascending
  std::vector<Lie> lies_;
  std::vector<std::uint8_t> bent_;  // bodies: not flat
  std::vector<SquarePairs> pairs_;
};

}  // namespace weft::physics
