// Particles that alone hold two pieces of a torn sheet together go with one of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

#include "physics/model/lattice/tearing.h"
#include "weft/random.h"

namespace weft::physics {
namespace {

constexpr int kSide = 7;

using Site = std::pair<int, int>;  // column, row
// Which piece a particle is on; 0: on none, and joined to all.
using Side = std::function<int(int i, int j)>;

// A sheet of kSide x kSide, and what is left of it.
struct Sheet {
  explicit Sheet(bool shear) {
    cloth.grid.nx = cloth.grid.ny = kSide;
    if (!shear) cloth.stiffness.shear = 0;
    lattice = std::make_unique<Lattice>(make_lattice(cloth, 0, 0, false));
    stencils = stencils_of(cloth);
    tearing = std::make_unique<LatticeTearing>(*lattice, stencils, cloth);
  }
  // Every constraint, and whether it is there.
  void each(const std::function<void(const Stencil&, Site, Site, bool)>& visit) const {
    for (const Stencil& f : stencils)
      for (int j = 0; j + f.dj < kSide; ++j)
        for (int a = 0; a < f.per_row(kSide); ++a)
          visit(f, {a + f.near(), j}, {a + f.far(), j + f.dj}, f.alive(j, a));
  }
  void tear(const std::function<bool(Site, Site)>& torn) {
    std::vector<Joined> list;
    each([&](const Stencil&, Site a, Site b, bool) {
      if (torn(a, b))
        list.push_back({lattice->number(a.second, a.first), lattice->number(b.second, b.first)});
    });
    tearing->set_torn(list);
  }
  void part(const Side& side) {
    tear([&](Site a, Site b) {
      const int sa = side(a.first, a.second), sb = side(b.first, b.second);
      return sa && sb && sa != sb;
    });
  }
  // The particles that constraints join to one, not by way of `without`.
  std::vector<Site> joined_to(Site start, Site without, int reach = 99) const {
    std::vector<Site> found{start};
    for (std::size_t n = 0; n < found.size(); ++n)
      each([&](const Stencil& f, Site a, Site b, bool alive) {
        if (!alive || f.kind == Kind::bend) return;
        if (b == found[n]) std::swap(a, b);
        if (a != found[n] || b == without) return;
        const bool near = std::abs(b.first - without.first) <= reach &&
                          std::abs(b.second - without.second) <= reach;
        if (near && std::find(found.begin(), found.end(), b) == found.end()) found.push_back(b);
      });
    return found;
  }
  bool joins(Site a, Site b) const {
    const auto all = joined_to(a, {-9, -9});
    return std::find(all.begin(), all.end(), b) != all.end();
  }
  // By the triangles themselves: the pieces about a particle that share whole triangles with it.
  int pieces_about(Site p) const {
    std::vector<std::array<Site, 2>> beside;  // the other corners of its triangles
    for (const auto& t : tearing->triangles()) {
      const auto corner = [&](int k) {
        const int at = int(t[std::size_t(k % 3)]);
        return Site{at % tearing->stride(), at / tearing->stride()};
      };
      for (int k = 0; k < 3; ++k)
        if (corner(k) == p) beside.push_back({corner(k + 1), corner(k + 2)});
    }
    std::vector<int> piece(beside.size());
    std::iota(piece.begin(), piece.end(), 0);
    for (std::size_t n = 0; n < beside.size(); ++n)
      for (const Site& corner : beside[n])
        for (const Site& reached : joined_to(corner, p, 1))
          for (std::size_t m = 0; m < beside.size(); ++m)
            if (reached == beside[m][0] || reached == beside[m][1])
              std::replace(piece.begin(), piece.end(), int(piece[m]), int(piece[n]));
    std::sort(piece.begin(), piece.end());
    return int(std::unique(piece.begin(), piece.end()) - piece.begin());
  }

  Cloth cloth;
  std::unique_ptr<Lattice> lattice;
  std::vector<Stencil> stencils;
  std::unique_ptr<LatticeTearing> tearing;
};

// A tear that comes down on the right of (3,3) and goes on on its left.
int turning(int i, int j) {
  if (i == 3 && j == 3) return 0;
  return j < 3 ? (i <= 3 ? 1 : 2) : (i < 3 ? 1 : 2);
}

TEST(Hinge, ATearThatTurnsAtAParticleGoesPastIt) {
  for (const bool shear : {true, false}) {
    Sheet sheet(shear);
    sheet.part(turning);
    EXPECT_FALSE(sheet.joins({0, 0}, {6, 6})) << shear;
    EXPECT_TRUE(sheet.joins({3, 3}, {0, 0}) || sheet.joins({3, 3}, {6, 6}));
    EXPECT_TRUE(sheet.joins({0, 0}, {0, 6}));
    EXPECT_TRUE(sheet.joins({6, 0}, {6, 6}));
    EXPECT_EQ(sheet.pieces_about({3, 3}), 1);
  }
}

TEST(Hinge, ItGoesWithTheLargerPiece) {
  // A corner of the sheet hangs by its tip: one triangle against four.
  Sheet sheet(true);
  sheet.part([](int i, int j) {
    return i == 3 && j == 3 ? 0 : i <= 3 && j >= 3 && i + j <= 6 ? 1 : 2;
  });
  EXPECT_FALSE(sheet.joins({0, 3}, {6, 6}));
  EXPECT_TRUE(sheet.joins({3, 3}, {6, 6}));
}

TEST(Hinge, AThreadGoesOnHanging) {
  // All of column 3 below row 3 is a thread of its own.
  Sheet sheet(true);
  sheet.part([](int i, int j) { return i == 3 && j == 3 ? 0 : i == 3 && j > 3 ? 2 : 1; });
  EXPECT_TRUE(sheet.joins({3, 6}, {3, 3}));
  EXPECT_TRUE(sheet.joins({3, 3}, {0, 0}));
}

TEST(Hinge, NoneIsLeftWhateverTears) {
  Random random(11, 0);
  int hinges = 0;
  for (int round = 0; round < 60; ++round) {
    Sheet sheet(round % 3 > 0);
    const double share = 0.1 + 0.4 * random.unit();
    std::map<std::pair<Site, Site>, bool> torn;
    std::int64_t given = 0;
    sheet.each([&](const Stencil& f, Site a, Site b, bool) {
      const bool gone = f.kind != Kind::bend && random.unit() < share;
      torn[{a, b}] = gone;
      given += gone;
    });
    sheet.tear([&](Site a, Site b) { return torn[{a, b}]; });
    std::int64_t gone = 0;
    sheet.each(
        [&](const Stencil& f, Site, Site, bool alive) { gone += f.kind != Kind::bend && !alive; });
    hinges += gone > given;
    for (int j = 0; j < kSide; ++j)
      for (int i = 0; i < kSide; ++i) EXPECT_LE(sheet.pieces_about({i, j}), 1) << i << ", " << j;
  }
  EXPECT_GT(hinges, 10);  // rounds that had some
}

TEST(Hinge, AWholeSheetHasNone) {
  for (const bool shear : {true, false}) {
    Sheet sheet(shear);
    sheet.tear([](Site a, Site) { return a == Site{0, 0}; });  // one corner is off
    std::int64_t gone = 0, of_corner = 0;
    sheet.each([&](const Stencil& f, Site a, Site, bool alive) {
      if (f.kind == Kind::bend) return;
      gone += !alive;
      of_corner += a == Site{0, 0};
    });
    EXPECT_EQ(gone, of_corner);
  }
}

}  // namespace
}  // namespace weft::physics
