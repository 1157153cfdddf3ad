// Self-collision among particles (self_collision.h): when to look, and the list of pairs.
#include "physics/self_collision/self_collision.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "physics/plan.h"

namespace weft::physics {
namespace {

constexpr double kNeighbour = 1.3;  // thicknesses: pairs nearer than that at rest are none
constexpr double kSkin = 0.45;      // of the thickness
// Of the thickness, relative motion between two runs: of those that touch; of others, which must
// not come from a thickness apart to the other side.
constexpr double kMotion = 0.4, kMotionApart = 0.9;
constexpr double kFall = 0.002;    // of the thickness, twice the fall from rest between two runs
constexpr int kMostSubsteps = 32;  // between two looks
constexpr int kMostSubstepsTouching = 12;
constexpr int kMostSubstepsCourse = 4;      // its push acts like a spring, stable up to here
constexpr std::size_t kFew = 4096;          // particles that one thread does faster
constexpr std::size_t kPairsReserved = 16;  // neighbours per particle
constexpr float kSoon = 1.15f;              // thicknesses: those that touch soon come first
constexpr std::size_t kWindow = 256;        // owners
constexpr std::int32_t kMostPairs = 63;     // that owners are told apart by

std::size_t count_particles(const std::vector<Sheet>& sheets) {
  std::size_t n = 0;
  for (const Sheet& s : sheets) n += std::size_t(s.lattice->columns) * std::size_t(s.lattice->rows);
  return n;
}

std::vector<RestMetric> rest_metrics(const std::vector<Sheet>& sheets) {
  std::vector<RestMetric> metrics;
  for (const Sheet& s : sheets) {
    const float range = s.thickness * float(kNeighbour);
    metrics.push_back({s.lattice->columns, s.lattice->rows, s.uu, s.uv, s.vv, range * range});
  }
  return metrics;
}

}  // namespace

SelfContact::~SelfContact() = default;

std::unique_ptr<SelfContact> SelfContact::make(
    const Scene& scene, const std::vector<std::unique_ptr<ClothStep>>& cloths,
    const KernelTable& kernels) {
  std::vector<Sheet> sheets;
  for (std::size_t c = 0; c < cloths.size(); ++c) {
    const SelfCollision& self = scene.cloths[c].self_collision;
    if (self.mode == SelfCollisionMode::off) continue;
    const Grid& g = scene.cloths[c].grid;
    double uu = 0, uv = 0, vv = 0;
    for (int k = 0; k < 3; ++k) {
      const double u = g.u[k] / (g.nx - 1), v = g.v[k] / (g.ny - 1);
      uu += u * u;
      uv += u * v;
      vv += v * v;
    }
    sheets.push_back({&cloths[c]->lattice(), float(self.thickness), float(self.friction), float(uu),
                      float(uv), float(vv), self.response == SelfCollisionResponse::course});
  }
  if (sheets.empty()) return nullptr;
  return std::unique_ptr<SelfContact>(new SelfContact(scene, std::move(sheets), kernels));
}

SelfContact::SelfContact(const Scene& scene, std::vector<Sheet> sheets, const KernelTable& kernels)
    : scene_(scene),
      sheets_(std::move(sheets)),
      kernels_(kernels),
      particles_(count_particles(sheets_)),
      blocks_(sheets_, float(kNeighbour)),
      search_(particles_, rest_metrics(sheets_), kernels) {
  for (const Sheet& s : sheets_) {
    thickness_ = std::max(thickness_, s.thickness);
    course_ |= s.course;
  }
  const std::size_t n = particles_;
  first_site_.resize(blocks_.all().size());
  listed_.resize(n);
  pairs_.site.reserve(n);
  pairs_.first.reserve(n + 1);
  slots_.first.reserve(n / 16 + 2);
  slots_.neighbour.reserve(kPairsReserved * n);
  slots_.friction.reserve(n + 16);
  slots_.course.reserve(n + 16);
  place_.reserve(n);
  speeds_.reserve(n / 16 + 1);
  bodies_.reserve(n + 32);
  separated_.reserve(n + 32);
}

// The particles of active blocks, block by block, and where they are.
void SelfContact::list_sites(Threads& threads) {
  const std::vector<Block>& blocks = blocks_.all();
  count_ = 0;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    first_site_[b] = count_;
    if (blocks[b].active) count_ += std::size_t(blocks[b].rows) * std::size_t(blocks[b].columns);
  }
  const Row3 to = search_.points();
  threads.share(blocks.size(), count_ < kFew, [&](std::size_t b) {
    const Block& block = blocks[b];
    if (!block.active) return;
    std::size_t at = first_site_[b];
    for (int j = block.row; j < block.row + block.rows; ++j, at += std::size_t(block.columns)) {
      const Row3 row = sheets_[std::size_t(block.sheet)].lattice->x.row(j);
      std::copy_n(row.x + block.column, block.columns, to.x + at);
      std::copy_n(row.y + block.column, block.columns, to.y + at);
      std::copy_n(row.z + block.column, block.columns, to.z + at);
      for (int i = 0; i < block.columns; ++i)
        search_.sites()[at + std::size_t(i)] = {std::uint16_t(block.sheet), std::uint16_t(j),
                                                std::uint16_t(block.column + i)};
    }
  });
}

void SelfContact::sort(double margin, Threads& threads) {
  list_sites(threads);
  search_.sort(count_, blocks_.box(), thickness_ + float(margin), threads);
}

void SelfContact::find(double margin, Threads& threads) {
  search_.find(thickness_ + float(margin), thickness_ * kSoon, threads);
  join_chunks(threads);
  order_owners(threads);
  group_owners(threads);
}

// Those with pairs, chunk after chunk.
void SelfContact::join_chunks(Threads& threads) {
  const auto each = [&](auto&& work) { threads.share(PairSearch::kChunks, search_.few(), work); };
  const auto begin = [&](std::size_t k) { return search_.begin(k); };
  const std::int32_t* const counts = search_.counts();
  std::size_t first_owner[PairSearch::kChunks], first_pair[PairSearch::kChunks];
  each([&](std::size_t k) {
    const auto has = [](std::int32_t count) { return count > 0; };
    first_owner[k] = std::size_t(std::count_if(counts + begin(k), counts + begin(k + 1), has));
  });
  std::size_t owners = 0, pairs = 0;
  for (std::size_t k = 0; k < PairSearch::kChunks; ++k) {
    owners += std::exchange(first_owner[k], owners);
    first_pair[k] = pairs;
    pairs += search_.found(k);
  }
  pairs_.site.resize(owners);
  pairs_.first.resize(owners + 1);
  pairs_.first[owners] = std::int32_t(pairs);
  each([&](std::size_t k) {
    std::size_t owner = first_owner[k];
    auto first = std::int32_t(first_pair[k]);
    for (std::size_t p = begin(k); p < begin(k + 1); ++p) {
      if (counts[p] == 0) continue;
      listed_[p] = std::int32_t(owner);
      pairs_.site[owner] = search_.sites()[std::size_t(search_.number(p))];
      pairs_.first[owner++] = std::exchange(first, first + counts[p]);
    }
  });
}

// Puts owners of as many pairs side by side, so that few slots of a group are left empty; within
// windows, so that owners from one place stay together.
void SelfContact::order_owners(Threads& threads) {
  const std::size_t n = pairs_.site.size();
  place_.resize(n);
  threads.share((n + kWindow - 1) / kWindow, search_.few(), [&](std::size_t window) {
    const std::size_t begin = window * kWindow, end = std::min(n, begin + kWindow);
    std::array<std::int32_t, kWindow> counts;
    std::array<Site, kWindow> sites;
    std::array<std::size_t, kMostPairs + 1> next{};  // place of an owner of so many pairs, or more
    const auto bin = [](std::int32_t count) { return std::size_t(std::min(count, kMostPairs)); };
    for (std::size_t a = begin; a < end; ++a) {
      sites[a - begin] = pairs_.site[a];
      counts[a - begin] = pairs_.first[a + 1] - pairs_.first[a];
      ++next[bin(counts[a - begin])];
    }
    std::size_t before = begin;
    for (std::size_t b = next.size(); b-- > 0;) before += std::exchange(next[b], before);
    std::array<std::int32_t, kWindow> ordered;
    for (std::size_t a = begin; a < end; ++a) {
      const std::size_t to = next[bin(counts[a - begin])]++;
      place_[a] = std::int32_t(to);
      pairs_.site[to] = sites[a - begin];
      ordered[to - begin] = counts[a - begin];
    }
    for (std::size_t a = begin; a + 1 < end; ++a)
      pairs_.first[a + 1] = pairs_.first[a] + ordered[a - begin];
  });
  threads.share(PairSearch::kChunks, search_.few(), [&](std::size_t k) {
    for (std::size_t p = search_.begin(k); p < search_.begin(k + 1); ++p)
      if (search_.counts()[p] > 0) listed_[p] = place_[std::size_t(listed_[p])];
  });
}

// Calls visit(owner, its hits) for every owner of a chunk.
template <class Visit>
void SelfContact::for_each_owner(std::size_t chunk, Visit&& visit) const {
  const std::int32_t* hit = search_.hits(chunk).data();
  for (std::size_t p = search_.begin(chunk); p < search_.begin(chunk + 1); ++p) {
    const std::int32_t count = search_.counts()[p];
    if (count > 0) visit(std::size_t(listed_[p]), hit);
    hit += count;
  }
}

// Pairs slot by slot for 16 owners at a time; unused slots name the body far away.
void SelfContact::group_owners(Threads& threads) {
  const std::size_t n = pairs_.site.size();
  const auto count = [&](std::size_t owner) {
    return std::size_t(pairs_.first[owner + 1] - pairs_.first[owner]);
  };
  slots_.first.resize(groups() + 1);
  std::size_t total = 0;
  for (std::size_t g = 0; g < groups(); ++g) {
    slots_.first[g] = total;
    std::size_t most = 0;
    for (std::size_t a = 16 * g; a < std::min(n, 16 * g + 16); ++a) most = std::max(most, count(a));
    total += most;
  }
  slots_.first[groups()] = total;
  slots_.neighbour.resize(16 * total);
  slots_.friction.resize(16 * groups());
  slots_.course.resize(16 * groups());
  const auto far_away = std::int32_t(16 * groups());
  const auto fill_up = [&](std::size_t owner, std::size_t used) {
    for (std::size_t k = slots_.first[owner / 16] + used; k < slots_.first[owner / 16 + 1]; ++k)
      slots_.neighbour[16 * k + owner % 16] = far_away;
  };
  threads.share(PairSearch::kChunks, search_.few(), [&](std::size_t chunk) {
    for_each_owner(chunk, [&](std::size_t owner, const std::int32_t* hit) {
      const Sheet& sheet = sheets_[pairs_.site[owner].cloth];
      slots_.friction[owner] = sheet.friction;
      slots_.course[owner] = sheet.course ? -1 : 0;
      std::int32_t* const to = slots_.neighbour.data() + 16 * slots_.first[owner / 16] + owner % 16;
      for (std::size_t i = 0; i < count(owner); ++i) to[16 * i] = listed_[std::size_t(hit[i])];
      fill_up(owner, count(owner));
    });
  });
  for (std::size_t owner = n; owner < 16 * groups(); ++owner) fill_up(owner, 0);
}

void SelfContact::list_neighbours() {
  pairs_.neighbour.resize(std::size_t(pairs_.first.back()));
  for (std::size_t chunk = 0; chunk < PairSearch::kChunks; ++chunk)
    for_each_owner(chunk, [&](std::size_t owner, const std::int32_t* hit) {
      for (std::int32_t i = pairs_.first[owner]; i < pairs_.first[owner + 1]; ++i)
        pairs_.neighbour[std::size_t(i)] = listed_[std::size_t(hit[i - pairs_.first[owner]])];
    });
}

const NearPairs& SelfContact::search(double margin, Threads& threads) {
  blocks_.measure(kernels_, threads);
  blocks_.choose_all();
  sort(margin, threads);
  find(margin, threads);
  list_neighbours();
  valid_ = false;
  return pairs_;
}

int SelfContact::run(double dt, int since, Threads& threads) {
  const float skin = float(kSkin) * thickness_, motion = float(kMotionApart) * thickness_;
  ++runs_;
  blocks_.measure(kernels_, threads);
  const Blocks::Outlook now = blocks_.look(thickness_, skin, motion, kMostSubsteps * dt);
  if (!valid_ || !now.covered) {
    blocks_.choose(thickness_ + skin);
    sort(skin, threads);
    find(skin, threads);
    ++searches_;
    valid_ = true;
  }
  passed_over_ += std::int64_t(particles_ - count_);
  const double speed = respond(dt, since, threads);
  // By gravity's pull on one of two that touch, too.
  const Vec3& g = scene_.gravity;
  const double pull = std::sqrt(g[0] * g[0] + g[1] * g[1] + g[2] * g[2]);
  const double fall = std::sqrt(kFall * thickness_ / std::max(pull, 1e-12)) / dt;
  double most = kMostSubsteps;
  if (now.touching)
    most = course_ ? kMostSubstepsCourse : std::min<double>(fall, kMostSubstepsTouching);
  const double touching = kMotion * thickness_ / std::max(speed, 1e-12);
  return int(std::clamp(std::min(now.seconds, touching) / dt, 1.0, std::max(1.0, most)));
}

double SelfContact::passed_over() const {
  return runs_ > 0 ? double(passed_over_) / (double(runs_) * double(particles_)) : 0;
}

SelfContact::Overlaps SelfContact::overlaps() {
  Threads one(1);
  search(0, one);
  bodies_.resize(16 * groups());
  for (std::size_t g = 0; g < groups(); ++g) gather(g);
  Overlaps found;
  for (std::size_t a = 0; a < pairs_.site.size(); ++a)
    for (std::int32_t k = pairs_.first[a]; k < pairs_.first[a + 1]; ++k) {
      const Body &p = bodies_[a], &q = bodies_[std::size_t(pairs_.neighbour[std::size_t(k)])];
      const double d =
          std::hypot(double(p.x[0]) - q.x[0], double(p.x[1]) - q.x[1], double(p.x[2]) - q.x[2]);
      const double depth = 0.5 * (double(p.x[3]) + q.x[3]) - d;
      if (depth <= 0) continue;
      ++found.pairs;
      found.deepest = std::max(found.deepest, depth);
    }
  found.pairs /= 2;
  return found;
}

std::size_t SelfContact::bytes() const {
  std::size_t bytes = 4 * (listed_.size() + place_.size()) + search_.bytes() + blocks_.bytes();
  bytes += 2 * bodies_.capacity() * sizeof(Body) + pairs_.site.capacity() * sizeof(Site);
  bytes += (pairs_.first.capacity() + slots_.neighbour.capacity()) * 4;
  return bytes;
}

}  // namespace weft::physics
