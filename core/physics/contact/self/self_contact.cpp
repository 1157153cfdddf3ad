// Self-contact (self_contact.h): when to run, and the lists of pairs.
#include "physics/contact/self/self_contact.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <utility>

#include "physics/contact/self/held.h"
#include "physics/model/clamp_to_int.h"
#include "physics/model/lattice/stages.h"
#include "weft/mesh.h"

namespace weft::physics {
namespace {

// Thicknesses at rest: pairs nearer than that that are no neighbours are beside each other.
constexpr double kBeside = 2.6;
// Of a sheet's own distances, that surfaces are kept apart at least (kernels/surface.cpp).
constexpr float kFlatSurface = 0.5f;
// Of the thickness: wider where the list of pairs was good for a few runs only, narrower where it was
// for many.
constexpr float kLeastSkin = 0.45f, kMostSkin = 1.4f;
constexpr int kFewRuns = 3, kManyRuns = 8;
constexpr int kRunsToEdges = 16;  // until what was not flat is looked at again
// Of the thickness, that what does not touch, but may, moves against each other between two runs.
constexpr float kMotion = 0.03f;
constexpr int kMostSubsteps = 32;   // between two looks
constexpr std::size_t kFew = 4096;  // particles that one thread does faster
constexpr int kRowsOfBand = 8;

// Their names are still to be given. Rows are whole groups of lanes.
std::vector<NamedSheet> named(const std::vector<Sheet>& sheets) {
  std::vector<NamedSheet> named;
  for (const Sheet& s : sheets) {
    const float range = s.mesh ? 0 : s.thickness * float(kBeside);
    named.push_back({s.columns, s.points->rows, s.uu, s.uv, s.vv, range * range,
                     (s.columns + 15) / 16 * 16, 0});
  }
  return named;
}

Sheet sheet_of(ClothModel& model, const Cloth& cloth) {
  const SelfCollision& self = cloth.self_collision;
  Sheet sheet{
      &model, nullptr, &model.particles(), 0, float(self.thickness), float(self.friction), 0,
      0,      0,       self.response};
  if (LatticeParts* const grid = model.lattice()) {
    sheet.columns = grid->lattice.columns;
    const Grid& g = cloth.grid;
    double uu = 0, uv = 0, vv = 0;
    for (int k = 0; k < 3; ++k) {
      const double u = g.u[k] / (g.nx - 1), v = g.v[k] / (g.ny - 1);
      uu += u * u;
      uv += u * v;
      vv += v * v;
    }
    sheet.uu = float(uu), sheet.uv = float(uv), sheet.vv = float(vv);
  } else {
    sheet.mesh = std::make_unique<MeshPatches>(model, placed_vertices(cloth.mesh));
    sheet.points = &sheet.mesh->points();
    for (int j = 0; j < sheet.points->rows; ++j)
      sheet.columns = std::max(sheet.columns, sheet.points->count(j));
    sheet.uu = sheet.vv = float(std::pow(mean_edge(cloth.mesh), 2));
  }
  return sheet;
}

}  // namespace

SelfContact::~SelfContact() = default;

std::unique_ptr<SelfContact> SelfContact::make(const Scene& scene,
                                               const std::vector<ClothModel*>& cloths,
                                               const KernelTable& kernels) {
  std::vector<Sheet> sheets;
  bool surfaces = false;
  for (std::size_t c = 0; c < cloths.size(); ++c) {
    const SelfCollision& self = scene.cloths[c].self_collision;
    if (self.mode == SelfCollisionMode::off) continue;
    surfaces |= self.mode == SelfCollisionMode::surface;
    sheets.push_back(sheet_of(*cloths[c], scene.cloths[c]));
  }
  if (sheets.empty()) return nullptr;
  return std::unique_ptr<SelfContact>(new SelfContact(scene, std::move(sheets), surfaces, kernels));
}

SelfContact::SelfContact(const Scene& scene, std::vector<Sheet> sheets, bool surfaces,
                         const KernelTable& kernels)
    : scene_(scene),
      sheets_(std::move(sheets)),
      kernels_(kernels),
      particles_(count_particles(sheets_)),
      named_(named(sheets_)),
      bodies_(give_names(named_)),
      thickness_(std::ranges::max_element(sheets_, {}, &Sheet::thickness)->thickness),
      blocks_(sheets_, surfaces ? kFlatSurface : 0, kernels),
      search_(surfaces ? 0 : particles_, named_, kernels),
      answer_(scene, thickness_) {
  for (const Sheet& s : sheets_) course_ |= s.response != SelfCollisionResponse::stiff && !surfaces;
  for (std::size_t n = 0; n < sheets_.size(); ++n) {
    const float range = sheets_[n].thickness * sheets_[n].neighbour();
    steps_.push_back(steps_beyond(named_[n], range * range));
  }
  beside_.resize(blocks_.all().size());
  first_site_.resize(blocks_.all().size());
  place_.resize(bodies_ + kPacket);
  now_.resize(bodies_ + kPacket);
  moved_.resize(bodies_ + kPacket);
  rest_.resize(bodies_);
  friction_.resize(bodies_);
  for (std::size_t n = 0; n < sheets_.size(); ++n) {
    place_at_rest(n);
    const int rows = sheets_[n].points->rows, step = sheets_[n].mesh ? 1 : kRowsOfBand;
    for (int j = 0; j < rows; j += step) bands_.push_back({n, j, std::min(step, rows - j)});
  }
  if (surfaces) {
    near_ = std::make_unique<NearSquares>(sheets_, named_, blocks_, rest_, kernels);
    surfaces_ =
        std::make_unique<ContactSolver<4>>(bodies_, answer_, kernels.sheets.contacts_of_four);
    zone_.resize(bodies_);
    strayed_.resize(bodies_);
    std::iota(zone_.begin(), zone_.end(), 0);
  } else {
    for (std::size_t n = 0; n < sheets_.size(); ++n)
      if (sheets_[n].mesh) list_neighbours(n);
    spheres_ = std::make_unique<ContactSolver<2>>(bodies_, answer_, kernels.sheets.contacts_of_two);
  }
  begin_.resize((near_ ? near_->squares().size() : bodies_) + 1);
}

// A grid lies flat, its first particle at zero; a mesh as its file has it.
void SelfContact::place_at_rest(std::size_t sheet) {
  const Sheet& s = sheets_[sheet];
  const float u = std::sqrt(s.uu), shear = s.uv / u;
  const float height = std::sqrt(std::max(0.0f, s.vv - shear * shear));
  s.points->for_each([&](int j, int i) {
    RestPlace& rest = rest_[body(sheet, j, i)];
    friction_[body(sheet, j, i)] = s.friction;
    rest = {float(i) * u + float(j) * shear, float(j) * height, 0, float(sheet)};
    if (!s.mesh) return;
    const Vec3& at = s.mesh->rest()[std::size_t(s.points->number(j, i))];
    rest.x = float(at[0]), rest.y = float(at[1]), rest.z = float(at[2]);
  });
}

void SelfContact::list_neighbours(std::size_t sheet) {
  const Sheet& s = sheets_[sheet];
  const auto near = s.mesh->neighbours(double(s.thickness) * s.neighbour());
  neighbours_.resize(bodies_);
  s.points->for_each([&](int j, int i) {
    std::vector<std::int32_t>& of = neighbours_[body(sheet, j, i)];
    for (const int vertex : near[std::size_t(s.points->number(j, i))]) {
      const auto [row, column] = s.points->place(vertex);
      of.push_back(std::int32_t(body(sheet, row, column)));
    }
    std::sort(of.begin(), of.end());
  });
}

bool SelfContact::near_at_rest(std::int32_t a, std::int32_t b) const {
  const std::vector<std::int32_t>& of = neighbours_[std::size_t(a)];
  return std::binary_search(of.begin(), of.end(), b);
}

std::size_t SelfContact::body(std::size_t sheet, int row, int column) const {
  return std::size_t(named_[sheet].name(row, column));
}

Site SelfContact::site(std::int32_t body) const {
  std::size_t sheet = named_.size() - 1;
  while (body < named_[sheet].first) --sheet;
  const std::int32_t at = body - named_[sheet].first, stride = named_[sheet].stride;
  return {std::uint16_t(sheet), std::uint16_t(at / stride), std::uint16_t(at % stride)};
}

BodyBlock SelfContact::bodies_of(const Band& band) {
  Particles& l = *sheets_[band.sheet].points;
  BodyBlock b{};
  b.columns = sheets_[band.sheet].mesh ? l.count(band.row) : sheets_[band.sheet].columns;
  b.rows = band.rows;
  b.stride = l.stride;
  b.body_stride = named_[band.sheet].stride;
  b.x = l.x.row(band.row);
  b.w = l.w(band.row);
  b.half_held = 0.5f * held(sheets_[band.sheet]);
  const std::size_t first = body(band.sheet, band.row, 0);
  b.before = place_.data() + first;
  b.now = now_.data() + first;
  b.moved = moved_.data() + first;
  return b;
}

// Where all is now, and how far it has moved in the interval.
void SelfContact::gather(Threads& threads) {
  copy_meshes(sheets_, threads);
  threads.share(bands_.size(), particles_ < kFew,
                [&](std::size_t b) { kernels_.sheets.gather_bodies(bodies_of(bands_[b])); });
}

void SelfContact::begin(Threads& threads) {
  gather(threads);
  std::swap(place_, now_);
  blocks_.begin(threads);
  if (near_) near_->wake();
  begun_ = true;
}

void SelfContact::restart() {
  begun_ = listed_ = lost_ = false;
  record_.contacts_now = 0;
  skin_ = 0;
  kept_runs_ = 0;
  if (spheres_) spheres_->forget();
  if (surfaces_) surfaces_->forget();
  answer_.forget();
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
      const Row3 row = sheets_[std::size_t(block.sheet)].points->x.row(j);
      std::copy_n(row.x + block.column, block.columns, to.x + at);
      std::copy_n(row.y + block.column, block.columns, to.y + at);
      std::copy_n(row.z + block.column, block.columns, to.z + at);
      std::iota(search_.names() + at, search_.names() + at + block.columns,
                std::int32_t(body(std::size_t(block.sheet), j, block.column)));
    }
  });
}

void SelfContact::sort(double margin, Threads& threads) {
  list_sites(threads);
  search_.sort(count_, blocks_.box(), thickness_ + float(margin), threads);
}

void SelfContact::find(double margin, Threads& threads) {
  search_.find(thickness_ + float(margin), threads);
  if (!neighbours_.empty())
    search_.drop([&](std::int32_t a, std::int32_t b) { return near_at_rest(a, b); }, threads);
}

void SelfContact::search(double margin, Threads& threads) {
  copy_meshes(sheets_, threads);
  blocks_.begin(threads);
  blocks_.choose_all();
  sort(margin, threads);
  find(margin, threads);
  for (std::size_t b = 0; b < beside_.size(); ++b) list_beside(b, thickness_ + float(margin));
  listed_ = lost_ = false;
}

// Chooses the blocks that may touch, and lists pairs within `reach` and the skin, now.
void SelfContact::list_pairs(float reach, Threads& threads) {
  blocks_.choose(reach + skin());
  ++record_.searches;
  kept_runs_ = 0;
  listed_ = true;
  lost_ = false;
  if (surfaces()) {
    if (blocks_.active() > 0) near_->list(now_.data(), threads);
  } else {
    sort(reach - thickness_ + skin(), threads);
    find(reach - thickness_ + skin(), threads);
  }
}

// Lists pairs within `reach` anew, for blocks that were chosen before. These may have moved by the skin since, and may
// by as much before they are where their list ends.
void SelfContact::list_again(float reach, Threads& threads) {
  lost_ = false;
  if (blocks_.active() == 0) return;
  if (near_) return near_->list_again(now_.data(), threads);
  sort(reach - thickness_ + 2 * skin(), threads);
  find(reach - thickness_ + 2 * skin(), threads);
}

// Lists those within a range whose first is of this block.
void SelfContact::list_beside(std::size_t block, float range) {
  const Block& b = blocks_.all()[block];
  const auto sheet = std::size_t(b.sheet);
  Particles& l = *sheets_[sheet].points;
  PairList& found = beside_[block];
  BesidePairs p{};
  p.x = l.x.row(0);
  p.stride = l.stride;
  p.columns = sheets_[sheet].columns;
  p.rows = l.rows;
  p.column = b.column;
  p.block_columns = b.columns;
  p.step = steps_[sheet].data();
  p.steps = int(steps_[sheet].size());
  p.range_squared = range * range;
  p.first = named_[sheet].first;
  p.name_stride = named_[sheet].stride;
  const int most_in_row = b.columns * p.steps;
  found.count = 0;
  for (int done = p.steps > 0 ? 0 : b.rows; done < b.rows;) {
    p.row = b.row + done;
    p.block_rows = b.rows - done;
    p.pairs = found.room(std::size_t(found.count + most_in_row)).from(found.count);
    p.most = int(found.owner.size() - kNearPadding) - found.count - most_in_row;
    const BesideFound some = kernels_.sheets.beside_pairs(p);
    done += some.rows;
    found.count += some.pairs;
  }
  found.pad();
}

int SelfContact::run(const ContactInterval& interval, Threads& threads) {
  const double dt = interval.dt;
  const float reach = thickness_ * kHeld, motion = kMotion * thickness_;
  ++record_.runs;
  ++kept_runs_;
  gather(threads);
  blocks_.measure(threads);
  const bool edges = !listed_ || kept_runs_ % kRunsToEdges == 0;
  if (edges) blocks_.measure_edges(threads);
  const Blocks::Outlook now =
      blocks_.look(reach, skin(), motion, (touches() ? 1 : kMostSubsteps) * dt);
  const bool joined = near_ && blocks_.active() > 0 && near_->any_joined(now_.data());
  if (!listed_ || !now.covered || joined) {
    if (kept_runs_ <= kFewRuns) skin_ *= 1.2f;
    if (kept_runs_ > kManyRuns) skin_ *= 0.8f;
    skin_ = std::clamp(skin_, kLeastSkin, kMostSkin);
    if (!edges) blocks_.measure_edges(threads);
    list_pairs(reach, threads);
  } else if (lost_) {
    list_again(reach, threads);
  }
  record_.passed_over += double(particles_ - blocks_.active());
  respond(interval, threads);
  std::swap(place_, now_);
  begun_ = true;
  if (touches()) return 1;
  return int(std::bit_floor(unsigned(clamp_to_int(now.seconds / dt, 1, kMostSubsteps))));
}

PairRoom SelfContact::PairList::room(std::size_t pairs) {
  if (owner.size() < pairs + kNearPadding) {
    owner.resize(2 * pairs + kNearPadding);
    neighbour.resize(owner.size());
  }
  return {owner.data(), neighbour.data()};
}

// What kernels may read beyond the last.
void SelfContact::PairList::pad() {
  room(std::size_t(count));
  std::fill_n(owner.begin() + count, kNearPadding, 0);
  std::fill_n(neighbour.begin() + count, kNearPadding, 0);
}

std::size_t SelfContact::bytes() const {
  std::size_t bytes = search_.bytes() + blocks_.bytes() + answer_.bytes() +
                      4 * (begin_.size() + zone_.size()) + strayed_.size();
  bytes += bodies_ * (2 * sizeof(Place) + sizeof(Displacement) + sizeof(RestPlace) + sizeof(float));
  for (const Sheet& s : sheets_)
    if (s.mesh) bytes += s.mesh->bytes();
  for (const auto& of : neighbours_) bytes += sizeof of + 4 * of.capacity();
  for (const auto* lists : {&meeting_, &beside_})
    for (const PairList& c : *lists) bytes += 8 * c.owner.capacity();
  for (const auto& m : measured_) bytes += m.room.capacity() * sizeof(SurfaceContact);
  if (near_) bytes += near_->bytes();
  if (spheres_) bytes += spheres_->bytes();
  if (surfaces_) bytes += surfaces_->bytes();
  return bytes;
}

}  // namespace weft::physics
