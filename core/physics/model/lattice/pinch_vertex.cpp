// Pinch vertices of a torn sheet (pinch_vertex.h).
#include "physics/model/lattice/pinch_vertex.h"

#include <bit>

namespace weft::physics {
namespace {

constexpr int kTriangles = 6;  // around a particle

// The neighbourhood of one particle.
class Ring {
 public:
  Ring(const LatticeTearing& tearing, int i, int j) : tearing_(tearing), i_(i), j_(j) {
    constexpr unsigned kFirst = 7, kSecond = 7 << 3;
    triangles_ = whole(0, 0, kFirst) | whole(-1, 0, kSecond) << 1 | whole(-1, 0, kFirst) << 2 |
                 whole(-1, -1, kSecond) << 3 | whole(0, -1, kFirst) << 4 |
                 whole(0, -1, kSecond) << 5;
  }

  // The whole triangles with p, in their order around it (bits).
  unsigned triangles() const { return triangles_; }
  // Where triangle n begins: it reaches to where the next one begins.
  static constexpr int kBegin[kTriangles] = {0, 2, 3, 4, 6, 7};

  // Directions that hold together with direction k, without p.
  unsigned piece(int k) const {
    unsigned found = 1u << k;
    for (unsigned before = 0; before != found;) {
      before = found;
      for (int n = 0; n < kTriangles; ++n)
        if (triangles_ >> n & 1) link(found, kBegin[n], kBegin[(n + 1) % kTriangles]);
      for (int n = 0; n < 8; ++n) {
        if (joined(n, (n + 1) % 8)) link(found, n, (n + 1) % 8);
        if (n % 2 == 0 && joined(n, (n + 2) % 8)) link(found, n, (n + 2) % 8);
      }
    }
    return found;
  }

 private:
  static void link(unsigned& found, int a, int b) {
    const unsigned both = 1u << a | 1u << b;
    if (found & both) found |= both;
  }
  unsigned whole(int di, int dj, unsigned edges) const {
    const int i = i_ + di, j = j_ + dj;
    return i >= 0 && j >= 0 && i + 1 < tearing_.columns() && j + 1 < tearing_.rows() &&
           !(tearing_.gone(i, j) & edges);
  }
  bool exists(Direction d) const {
    const int i = i_ + d.di, j = j_ + d.dj;
    return i >= 0 && j >= 0 && i < tearing_.columns() && j < tearing_.rows();
  }
  bool joined(int from, int to) const {
    const Direction a = kAround[std::size_t(from)], b = kAround[std::size_t(to)];
    if (b.dj < a.dj || (b.dj == a.dj && b.di < a.di)) return joined(to, from);
    return exists(a) && exists(b) &&
           tearing_.joined(b.di - a.di, b.dj - a.dj, i_ + a.di, j_ + a.dj);
  }

  const LatticeTearing& tearing_;
  const int i_, j_;
  unsigned triangles_;
};

}  // namespace

unsigned pinched(const LatticeTearing& tearing, int i, int j) {
  const Ring ring(tearing, i, j);
  const unsigned triangles = ring.triangles();
  // Triangles next to each other share a constraint of p: one run of them is one piece.
  const unsigned turned =
      (triangles << 1 | triangles >> (kTriangles - 1)) & ((1 << kTriangles) - 1);
  if (std::popcount(triangles & ~turned) < 2) return 0;
  unsigned kept = 0, pieces = 0;
  int most = 0, count = 0;
  for (int n = 0; n < kTriangles; ++n) {
    if (!(triangles >> n & 1) || pieces >> Ring::kBegin[n] & 1) continue;
    const unsigned piece = ring.piece(Ring::kBegin[n]);
    int shared = 0;
    for (int m = 0; m < kTriangles; ++m) shared += triangles >> m & piece >> Ring::kBegin[m] & 1;
    if (shared > most) {
      most = shared;
      kept = piece;
    }
    pieces |= piece;
    ++count;
  }
  return count > 1 ? pieces & ~kept : 0;
}

}  // namespace weft::physics
