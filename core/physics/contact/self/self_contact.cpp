// Self-collision among particles (self_contact.h): when to look, and the list of pairs.
#include "physics/contact/self/self_contact.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "physics/model/clamp_to_int.h"
#include "physics/model/path.h"

namespace weft::physics {
namespace {

// Thicknesses at rest: pairs nearer than that that are no neighbours are beside each other.
constexpr double kBeside = 2.6;
// Of the thickness: wider where the list of pairs was good for a few runs only, narrower where it was
// for many.
constexpr float kLeastSkin = 0.45f, kMostSkin = 1.4f;
constexpr int kFewRuns = 3, kManyRuns = 8;
constexpr int kRunsToEdges = 16;  // until what was not flat is looked at again
// Of the thickness, relative motion between two runs: of those that touch; of others, which must
// not come from a thickness apart to the other side.
constexpr double kMotion = 0.4, kMotionApart = 0.9;
constexpr double kFall = 0.0034;   // of the thickness, twice the fall from rest between two runs
constexpr int kMostSubsteps = 32;  // between two looks
constexpr int kMostSubstepsTouching = 12;
// Of the distance at which they are held: how deep two may be when looked at, or else the next time comes
// in half as many substeps, but not in fewer than these.
constexpr double kSunk = 0.04;
constexpr int kLeastSubstepsSunk = 2;
constexpr int kMostSubstepsCourse = 4;  // its push acts like a spring, stable up to here
constexpr std::size_t kFew = 4096;      // particles that one thread does faster

// Their names are still to be given. Rows are whole groups of lanes.
std::vector<NamedSheet> named(const std::vector<Sheet>& sheets) {
  std::vector<NamedSheet> named;
  for (const Sheet& s : sheets) {
    const float range = s.thickness * float(kBeside);
    named.push_back({s.lattice->columns, s.lattice->rows, s.uu, s.uv, s.vv, range * range,
                     (s.lattice->columns + 15) / 16 * 16, 0});
  }
  return named;
}

}  // namespace

SelfContact::~SelfContact() = default;

std::unique_ptr<SelfContact> SelfContact::make(const Scene& scene,
                                               const std::vector<const LatticeParts*>& cloths,
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
    sheets.push_back({&cloths[c]->lattice, float(self.thickness), float(self.friction), float(uu),
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
      blocks_(sheets_, kernels),
      named_(named(sheets_)),
      bodies_(give_names(named_)),
      search_(particles_, named_, kernels) {
  for (const Sheet& s : sheets_) {
    thickness_ = std::max(thickness_, s.thickness);
    course_ |= s.course;
  }
  for (std::size_t n = 0; n < sheets_.size(); ++n) {
    const float range = sheets_[n].thickness * sheets_[n].neighbour();
    steps_.push_back(steps_beyond(named_[n], range * range));
  }
  beside_.resize(blocks_.all().size());
  first_site_.resize(blocks_.all().size());
  most_touching_ = kMostSubstepsTouching;
  for (const Sheet& s : sheets_) {
    load_.emplace_back(s.lattice->rows, s.lattice->stride);
    ahead_.emplace_back(s.lattice->rows, s.lattice->stride);
    loaded_.emplace_back(std::size_t(s.lattice->rows) * std::size_t(s.lattice->stride) / 16);
  }
  place_.resize(bodies_);
  motion_.resize(bodies_);
  sums_.resize(bodies_);
  moved_.resize(bodies_ / 16 + 2);
  const auto friction = [](const Sheet& s) { return s.course ? kCourseRule : s.friction; };
  friction_alike_ = friction(sheets_[0]);
  if (std::any_of(sheets_.begin(), sheets_.end(),
                  [&](const Sheet& s) { return friction(s) != friction_alike_; }))
    for (std::size_t n = 0; n < sheets_.size(); ++n)
      friction_.resize(n + 1 < sheets_.size() ? body(n + 1, 0, 0) : bodies_, friction(sheets_[n]));
}

void SelfContact::forget_loads(const Block& block) {
  const auto sheet = std::size_t(block.sheet);
  for (Rows* rows : {&load_[sheet], &ahead_[sheet]}) {
    const Row3 first = first_of(block, *rows);
    for (float* component : {first.x, first.y, first.z})
      for (int j = 0; j < block.rows; ++j)
        std::fill_n(component + std::ptrdiff_t(j) * sheets_[sheet].lattice->stride, block.columns,
                    0.0f);
  }
}

void SelfContact::forget_loads() {
  for (auto* sheets : {&load_, &ahead_})
    for (Rows& rows : *sheets) rows.clear();
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
    if (!block.active) {
      forget_loads(block);
      return put_far_away(block);
    }
    std::size_t at = first_site_[b];
    for (int j = block.row; j < block.row + block.rows; ++j, at += std::size_t(block.columns)) {
      const Row3 row = sheets_[std::size_t(block.sheet)].lattice->x.row(j);
      std::copy_n(row.x + block.column, block.columns, to.x + at);
      std::copy_n(row.y + block.column, block.columns, to.y + at);
      std::copy_n(row.z + block.column, block.columns, to.z + at);
      std::iota(search_.names() + at, search_.names() + at + block.columns,
                std::int32_t(body(std::size_t(block.sheet), j, block.column)));
    }
  });
}

// Nothing is found to touch bodies that are not kept up to date.
void SelfContact::put_far_away(const Block& block) {
  constexpr Place kFar{{1e18f, 1e18f, 1e18f, 0}};  // its square is still finite
  for (int j = block.row; j < block.row + block.rows; ++j)
    std::fill_n(place_.data() + body(std::size_t(block.sheet), j, block.column), block.columns,
                kFar);
}

void SelfContact::sort(double margin, Threads& threads) {
  list_sites(threads);
  search_.sort(count_, blocks_.box(), thickness_ + float(margin), threads);
}

std::size_t SelfContact::body(std::size_t sheet, int row, int column) const {
  const NamedSheet& s = named_[sheet];
  return std::size_t(s.first + row * s.stride + column);
}

Site SelfContact::site(std::int32_t body) const {
  std::size_t sheet = sheets_.size() - 1;
  while (body < named_[sheet].first) --sheet;
  const std::int32_t at = body - named_[sheet].first, stride = named_[sheet].stride;
  return {std::uint16_t(sheet), std::uint16_t(at / stride), std::uint16_t(at % stride)};
}

void SelfContact::find(double margin, Threads& threads) {
  search_.find(thickness_ + float(margin), threads);
  found_ = 0;
  for (std::size_t k = 0; k < search_.chunks(); ++k) found_ += search_.pairs(k).count;
}

void SelfContact::search(double margin, Threads& threads) {
  blocks_.measure(threads);
  blocks_.choose_all();
  sort(margin, threads);
  find(margin, threads);
  for (std::size_t b = 0; b < beside_.size(); ++b) list_beside(b, thickness_ + float(margin));
  valid_ = false;
}

void SelfContact::restart() {
  valid_ = false;
  may_touch_ = false;
  skin_ = 0;
  kept_runs_ = 0;
  most_touching_ = kMostSubstepsTouching;
  forget_loads();
}

// Substeps until it has to come again, at most: where sheets touch, by gravity's pull on one of two, too.
double SelfContact::most_substeps(double dt, double swing) const {
  if (!may_touch_) return kMostSubsteps;
  if (course_) return kMostSubstepsCourse;
  const double pull = greatest_gravity(scene_);
  const double fall = std::sqrt(kFall * thickness_ / std::max(pull, 1e-12));
  return std::min<double>(std::min(fall, swing) / dt, most_touching_);
}

int SelfContact::run(double dt, int since, double swing, Threads& threads) {
  const float motion = float(kMotionApart) * thickness_;
  ++runs_;
  ++kept_runs_;
  blocks_.measure(threads);
  const bool edges = !valid_ || kept_runs_ % kRunsToEdges == 0;
  if (edges) blocks_.measure_edges(threads);
  const Blocks::Outlook now =
      blocks_.look(thickness_, skin_ * thickness_, motion, most_substeps(dt, swing) * dt);
  may_touch_ = now.touching;
  if (!valid_ || !now.covered) {
    if (kept_runs_ <= kFewRuns) skin_ *= 1.2f;
    if (kept_runs_ > kManyRuns) skin_ *= 0.8f;
    skin_ = std::clamp(skin_, kLeastSkin, kMostSkin);
    const float skin = skin_ * thickness_;
    if (!edges) blocks_.measure_edges(threads);
    blocks_.choose(thickness_ + skin);
    sort(skin, threads);
    find(skin, threads);
    ++searches_;
    kept_runs_ = 0;
    valid_ = true;
  }
  passed_over_ += std::int64_t(particles_ - count_);
  const Met met = respond(dt, since, threads);
  const double touching = kMotion * thickness_ / std::max(met.speed, 1e-12);
  // What is pressed together sinks in for as long as it is left alone.
  if (met.deepest > kSunk)
    most_touching_ = std::max(std::min(since, most_touching_) / 2, kLeastSubstepsSunk);
  else
    most_touching_ = std::min(most_touching_ + 1, kMostSubstepsTouching);
  const int most = clamp_to_int(most_substeps(dt, swing), 1, kMostSubsteps);
  return clamp_to_int(std::min(now.seconds, touching) / dt, 1, most);
}

double SelfContact::passed_over() const {
  return runs_ > 0 ? double(passed_over_) / (double(runs_) * double(particles_)) : 0;
}

SelfContact::Overlaps SelfContact::overlaps() {
  Threads one(1);
  search(0, one);
  Overlaps found;
  for_each_pair([&](const Site& p, const Site& q) {
    const Sheet &sheet = sheets_[p.cloth], &other = sheets_[q.cloth];
    double square = 0;
    for (int i = 0; i < 3; ++i) {
      const double d =
          double(sheet.lattice->x.at(i, p.row, p.column)) - other.lattice->x.at(i, q.row, q.column);
      square += d * d;
    }
    const double depth = 0.5 * (double(sheet.thickness) + other.thickness) - std::sqrt(square);
    if (depth <= 0) return;
    ++found.pairs;
    found.deepest = std::max(found.deepest, depth);
  });
  return found;
}

std::size_t SelfContact::bytes() const {
  std::size_t bytes = search_.bytes() + blocks_.bytes();
  bytes += bodies_ * (sizeof(Place) + sizeof(Motion) + sizeof(AskedSum)) + 4 * friction_.size();
  bytes += moved_.size();
  for (const auto* sheets : {&load_, &ahead_})
    for (const Rows& rows : *sheets) bytes += rows.bytes();
  for (const auto& loaded : loaded_) bytes += loaded.size();
  for (const auto* lists : {&close_, &beside_})
    for (const PairList& c : *lists) bytes += 8 * c.owner.capacity();
  for (const Touching& t : touching_)
    bytes += 8 * t.pairs.owner.capacity() + sizeof(Asked) * t.asked.capacity();
  for (const Part& p : parts_) bytes += 4 * p.bodies.capacity();
  return bytes;
}

}  // namespace weft::physics
