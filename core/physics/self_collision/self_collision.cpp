// Self-collision among particles (self_collision.h): the list of pairs.
#include "physics/self_collision/self_collision.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "physics/plan.h"

namespace weft::physics {
namespace {

constexpr double kNeighbour = 0.3;  // of the thickness: neighbours are as near, and more, at rest
constexpr double kSkin = 0.5;       // of the thickness
constexpr double kMayTouch = 0.15;  // of the thickness: pairs so much further apart are looked at
constexpr double kMotion = 0.4;     // of the thickness: relative motion between two runs
constexpr double kFall = 0.005;     // of the thickness, twice the fall from rest between two runs
constexpr int kMostSubsteps = 12;   // between two runs
constexpr int kIterations = 3;      // of pushing apart, in one run
constexpr int kMostSubstepsCourse = 4;  // its push acts like a spring, stable up to here
constexpr std::size_t kChunks = 64;
constexpr std::size_t kFew = 4096;          // particles that one thread does faster
constexpr std::size_t kGrain = 512;         // particles of a task
constexpr std::size_t kPairsReserved = 16;  // neighbours per particle

Spread nothing() {
  constexpr float far = std::numeric_limits<float>::max();
  return {{far, far, far}, {-far, -far, -far}};
}

float diagonal(const Spread& s) {
  float square = 0;
  for (int k = 0; k < 3; ++k) square += (s.high[k] - s.low[k]) * (s.high[k] - s.low[k]);
  return std::sqrt(square);
}

// Calls work(k) for every chunk of n particles; few are not worth the threads.
template <class Work>
void for_each_chunk(std::size_t n, Threads& threads, Work&& work) {
  if (threads.count() == 1 || n < kFew) {
    for (std::size_t k = 0; k < kChunks; ++k) work(k);
    return;
  }
  threads.run([&] { oneapi::tbb::parallel_for(std::size_t(0), kChunks, work); });
}

}  // namespace

// What one share of the sorted particles finds, and its room to search in.
struct SelfContact::Chunk {
  std::vector<std::int32_t> owner, first, neighbour;  // sorted particles
  std::vector<float> x, y, z, column, row;            // candidates of one cell
  std::vector<std::int32_t> numbers, counts, hits;
};

SelfContact::~SelfContact() = default;

std::unique_ptr<SelfContact> SelfContact::make(
    const Scene& scene, const std::vector<std::unique_ptr<ClothStep>>& cloths,
    const KernelTable& kernels) {
  std::vector<Sheet> sheets;
  int first = 0;
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
                      float(uv), float(vv), self.response == SelfCollisionResponse::course, first});
    first += g.nx * g.ny;
  }
  if (sheets.empty()) return nullptr;
  return std::unique_ptr<SelfContact>(new SelfContact(scene, std::move(sheets), kernels));
}

SelfContact::SelfContact(const Scene& scene, std::vector<Sheet> sheets, const KernelTable& kernels)
    : scene_(scene), sheets_(std::move(sheets)), kernels_(kernels), chunks_(kChunks) {
  for (std::size_t s = 0; s < sheets_.size(); ++s) {
    thickness_ = std::max(thickness_, sheets_[s].thickness);
    const Lattice& l = *sheets_[s].lattice;
    for (int j = 0; j < l.rows; ++j)
      for (int i = 0; i < l.columns; ++i)
        sites_.push_back({std::uint16_t(s), std::uint16_t(j), std::uint16_t(i)});
  }
  for (const Sheet& s : sheets_) {
    const float range = s.thickness * float(1 + kNeighbour);
    metrics_.push_back({s.uu, s.uv, s.vv, range * range});
  }
  const std::size_t n = sites_.size();
  for (AlignedArray<float>* a : {&x_, &y_, &z_, &column_, &row_}) *a = AlignedArray<float>(n + 16);
  sheet_.resize(n);
  grid_.reserve(n);
  listed_.resize(n);
  pairs_.site.reserve(n);
  pairs_.first.reserve(n + 1);
  pairs_.neighbour.reserve(kPairsReserved * n);
  touching_.owner.reserve(n);
  touching_.first.reserve(n + 1);
  touching_.neighbour.reserve(kPairsReserved * n);
  bodies_.reserve(n);
  separated_.reserve(n);
  for (Chunk& c : chunks_) {
    c.owner.reserve(2 * n / kChunks);
    c.first.reserve(2 * n / kChunks);
    c.neighbour.reserve(kPairsReserved * n / kChunks);
  }
}

void SelfContact::copy_positions() {
  for (const Sheet& s : sheets_)
    for (int j = 0; j < s.lattice->rows; ++j) {
      const Row3 row = s.lattice->x.row(j);
      const std::size_t at = std::size_t(s.first) + std::size_t(j) * s.lattice->columns;
      std::copy_n(row.x, s.lattice->columns, x_.data() + at);
      std::copy_n(row.y, s.lattice->columns, y_.data() + at);
      std::copy_n(row.z, s.lattice->columns, z_.data() + at);
    }
}

// The box about all displacements holds every difference of two of them.
float SelfContact::moved_apart() const {
  Spread spread = nothing();
  for (const Sheet& s : sheets_)
    for (int j = 0; j < s.lattice->rows; ++j) {
      const std::size_t at = std::size_t(s.first) + std::size_t(j) * s.lattice->columns;
      kernels_.spread(s.lattice->x.row(j), {x_.data() + at, y_.data() + at, z_.data() + at},
                      s.lattice->columns, spread);
    }
  return diagonal(spread);
}

float SelfContact::relative_speed() const {
  Spread spread = nothing();
  for (const Sheet& s : sheets_)
    for (int j = 0; j < s.lattice->rows; ++j)
      kernels_.spread(s.lattice->v.row(j), {nullptr, nullptr, nullptr}, s.lattice->columns, spread);
  return diagonal(spread);
}

// Where on its sheet each sorted particle lies; the columns of different sheets are far apart.
void SelfContact::sort_sites() {
  constexpr float kBetweenSheets = 1e5f;
  for (std::size_t p = 0; p < sites_.size(); ++p) {
    const Site& s = sites_[std::size_t(grid_.number(p))];
    column_[p] = float(s.column) + kBetweenSheets * float(s.cloth);
    row_[p] = float(s.row);
    sheet_[p] = s.cloth;
  }
}

void SelfContact::search_chunk(Chunk& c, std::size_t begin, std::size_t end, float range) const {
  c.owner.clear();
  c.first.clear();
  c.neighbour.clear();
  for (std::size_t cell = begin; cell < end;) {
    const std::size_t last = grid_.bucket_end(cell);
    Run runs[18];
    const int run_count = grid_.runs_about(cell, runs);
    std::size_t n = 0;
    for (int r = 0; r < run_count; ++r) n += std::size_t(runs[r].last - runs[r].first);
    if (n == 1) {  // alone
      cell = last;
      continue;
    }
    const std::size_t members = last - cell;
    if (const std::size_t room = n + 16 * 18; c.numbers.size() < room) {
      for (std::vector<float>* v : {&c.x, &c.y, &c.z, &c.column, &c.row}) v->resize(2 * room);
      c.numbers.resize(2 * room);
    }
    if (c.counts.size() < members) c.counts.resize(2 * members);
    if (c.hits.size() < members * n) c.hits.resize(2 * members * n);
    kernels_.near_pairs({grid_.sorted(0),
                         {std::int32_t(cell), std::int32_t(last)},
                         runs,
                         run_count,
                         column_.data(),
                         row_.data(),
                         sheet_.data(),
                         metrics_.data(),
                         c.column.data(),
                         c.row.data(),
                         {c.x.data(), c.y.data(), c.z.data()},
                         c.numbers.data(),
                         range * range,
                         c.counts.data(),
                         c.hits.data()});
    const std::int32_t* hit = c.hits.data();
    for (std::size_t m = 0; m < members; ++m) {
      if (c.counts[m] == 0) continue;
      c.owner.push_back(std::int32_t(cell + m));
      c.first.push_back(std::int32_t(c.neighbour.size()));
      c.neighbour.insert(c.neighbour.end(), hit, hit + c.counts[m]);
      hit += c.counts[m];
    }
    cell = last;
  }
}

// The chunks' finds one after another, renumbered from sorted particles to those with pairs.
void SelfContact::join_chunks() {
  pairs_.site.clear();
  pairs_.first.clear();
  pairs_.neighbour.clear();
  for (const Chunk& c : chunks_) {
    const auto before = std::int32_t(pairs_.neighbour.size());
    for (std::size_t n = 0; n < c.owner.size(); ++n) {
      listed_[std::size_t(c.owner[n])] = std::int32_t(pairs_.site.size());
      pairs_.site.push_back(sites_[std::size_t(grid_.number(std::size_t(c.owner[n])))]);
      pairs_.first.push_back(before + c.first[n]);
    }
    pairs_.neighbour.insert(pairs_.neighbour.end(), c.neighbour.begin(), c.neighbour.end());
  }
  pairs_.first.push_back(std::int32_t(pairs_.neighbour.size()));
  for (std::int32_t& q : pairs_.neighbour) q = listed_[std::size_t(q)];
}

const NearPairs& SelfContact::search(double margin, Threads& threads) {
  copy_positions();
  Spread box = nothing();
  kernels_.spread({x_.data(), y_.data(), z_.data()}, {nullptr, nullptr, nullptr},
                  int(sites_.size()), box);
  const float range = thickness_ + float(margin);
  // A hair wider than the range, for the rounding of cell numbers.
  grid_.build({x_.data(), y_.data(), z_.data()}, sites_.size(), box.low, box.high, range * 1.001f);
  sort_sites();
  const std::size_t n = sites_.size();
  for_each_chunk(n, threads, [&](std::size_t k) {
    search_chunk(chunks_[k], grid_.bucket_start_from(k * n / kChunks),
                 grid_.bucket_start_from((k + 1) * n / kChunks), range);
  });
  join_chunks();
  return pairs_;
}

// Of the pairs in one share of the particles those that touch, or may before the run is over.
void SelfContact::touch_chunk(Chunk& c, std::size_t begin, std::size_t end) const {
  c.owner.clear();
  c.first.clear();
  c.neighbour.clear();
  for (std::size_t a = begin; a < end; ++a) {
    const Body& p = bodies_[a];
    const std::size_t before = c.neighbour.size();
    for (std::int32_t k = pairs_.first[a]; k < pairs_.first[a + 1]; ++k) {
      const std::int32_t other = pairs_.neighbour[std::size_t(k)];
      const Body& q = bodies_[std::size_t(other)];
      const float reach = 0.5f * float(1 + kMayTouch) * (p.thickness + q.thickness);
      const float d[3] = {p.x[0] - q.x[0], p.x[1] - q.x[1], p.x[2] - q.x[2]};
      if (d[0] * d[0] + d[1] * d[1] + d[2] * d[2] < reach * reach) c.neighbour.push_back(other);
    }
    if (c.neighbour.size() == before) continue;
    c.owner.push_back(std::int32_t(a));
    c.first.push_back(std::int32_t(before));
  }
}

void SelfContact::keep_touching(Threads& threads) {
  const std::size_t n = bodies_.size();
  for_each_chunk(n, threads, [&](std::size_t k) {
    touch_chunk(chunks_[k], k * n / kChunks, (k + 1) * n / kChunks);
  });
  touching_.owner.clear();
  touching_.first.clear();
  touching_.neighbour.clear();
  for (const Chunk& c : chunks_) {
    const auto before = std::int32_t(touching_.neighbour.size());
    touching_.owner.insert(touching_.owner.end(), c.owner.begin(), c.owner.end());
    for (const std::int32_t f : c.first) touching_.first.push_back(before + f);
    touching_.neighbour.insert(touching_.neighbour.end(), c.neighbour.begin(), c.neighbour.end());
  }
  touching_.first.push_back(std::int32_t(touching_.neighbour.size()));
}

int SelfContact::run(double dt, int since, Threads& threads) {
  const float skin = float(kSkin) * thickness_;
  ++runs_;
  if (!valid_ || moved_apart() > skin) {
    search(skin, threads);
    ++searches_;
    valid_ = true;
  }
  bodies_.resize(pairs_.site.size());
  const auto share = [&](auto&& work, std::size_t n) {
    if (n < kFew || threads.count() == 1) {
      for (std::size_t a = 0; a < n; ++a) work(a);
      return;
    }
    threads.run([&] {
      oneapi::tbb::parallel_for(std::size_t(0), (n + kGrain - 1) / kGrain, [&](std::size_t k) {
        for (std::size_t a = k * kGrain; a < std::min(n, (k + 1) * kGrain); ++a) work(a);
      });
    });
  };
  share([&](std::size_t a) { gather(a); }, bodies_.size());
  keep_touching(threads);
  separated_ = bodies_;
  const int iterations = course() ? 1 : kIterations;
  for (int n = 0; n < iterations; ++n) {
    share([&](std::size_t t) { separate(t, dt, since); }, touching_.owner.size());
    std::swap(bodies_, separated_);
  }
  share([&](std::size_t t) { scatter(t); }, touching_.owner.size());
  return next_run(dt);
}

bool SelfContact::course() const {
  return std::any_of(sheets_.begin(), sheets_.end(), [](const Sheet& s) { return s.course; });
}

// Before particles move by a share of the thickness against each other, be it by their speed now or
// by gravity's pull on one of them.
int SelfContact::next_run(double dt) const {
  const Vec3& g = scene_.gravity;
  const double pull = std::sqrt(g[0] * g[0] + g[1] * g[1] + g[2] * g[2]);
  const double fall = std::sqrt(kFall * thickness_ / std::max(pull, 1e-12)) / dt;
  const double way = kMotion * thickness_ / std::max(double(relative_speed()) * dt, 1e-12);
  const double most = course() ? kMostSubstepsCourse : fall;
  return int(std::clamp(std::min(most, way), 1.0, double(kMostSubsteps)));
}

SelfContact::Overlaps SelfContact::overlaps() {
  Threads one(1);
  search(0, one);
  valid_ = false;
  bodies_.resize(pairs_.site.size());
  for (std::size_t a = 0; a < bodies_.size(); ++a) gather(a);
  Overlaps found;
  for (std::size_t a = 0; a < bodies_.size(); ++a)
    for (std::int32_t k = pairs_.first[a]; k < pairs_.first[a + 1]; ++k) {
      const Body &p = bodies_[a], &q = bodies_[std::size_t(pairs_.neighbour[std::size_t(k)])];
      const double d =
          std::hypot(double(p.x[0]) - q.x[0], double(p.x[1]) - q.x[1], double(p.x[2]) - q.x[2]);
      const double depth = 0.5 * (double(p.thickness) + q.thickness) - d;
      if (depth <= 0) continue;
      ++found.pairs;
      found.deepest = std::max(found.deepest, depth);
    }
  found.pairs /= 2;
  return found;
}

std::size_t SelfContact::bytes() const {
  std::size_t bytes = sites_.size() * sizeof(Site) + 3 * x_.size() * 4 + grid_.bytes();
  bytes += bodies_.capacity() * sizeof(Body) + listed_.size() * 4;
  bytes += pairs_.site.capacity() * sizeof(Site);
  bytes += (pairs_.first.capacity() + pairs_.neighbour.capacity()) * 4;
  for (const Chunk& c : chunks_)
    bytes += (c.owner.capacity() + c.first.capacity() + c.neighbour.capacity() + c.hits.size()) * 4;
  return bytes;
}

}  // namespace weft::physics
