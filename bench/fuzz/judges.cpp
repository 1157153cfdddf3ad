#include "judges.h"

#include <algorithm>
#include <cmath>

#include "run.h"
#include "weft/output.h"

namespace fuzz {

using namespace weft;

namespace {

std::string at(const char* what, std::size_t cloth, std::size_t particle) {
  return std::string(what) + " of cloth " + std::to_string(cloth) + ", particle " +
         std::to_string(particle);
}

void require(bool holds, const char* kind, const std::string& text) {
  if (!holds) throw Failure(std::string("judge ") + kind + ": " + text);
}

void check_values(const ClothView& c, std::size_t number) {
  const std::vector<std::size_t> lanes = lanes_of(c);
  for (std::size_t n = 0; n < lanes.size(); ++n) {
    const std::size_t p = lanes[n];
    const bool finite = std::isfinite(c.x[p]) && std::isfinite(c.y[p]) && std::isfinite(c.z[p]) &&
                        std::isfinite(c.vx[p]) && std::isfinite(c.vy[p]) && std::isfinite(c.vz[p]);
    require(finite, "finite", at("not finite", number, n));
    require(c.inverse_mass[p] >= 0 && std::isfinite(c.inverse_mass[p]), "view",
            at("inverse mass", number, n));
  }
}

void check_spans(const ClothView& c) {
  const std::size_t floats = std::size_t(c.rows) * std::size_t(c.stride);
  require(c.stride >= c.columns && c.stride % 16 == 0, "view", "stride");
  for (const auto* s : {&c.x, &c.y, &c.z, &c.vx, &c.vy, &c.vz, &c.inverse_mass})
    require(s->size() >= floats - std::size_t(c.stride - c.columns), "view",
            "an array of " + std::to_string(s->size()) + " values");
  std::vector<std::uint8_t> taken(floats, 0);
  for (const std::size_t lane : lanes_of(c)) taken[lane] = 1;
  for (const auto& t : c.triangles)
    for (const std::uint32_t corner : t)
      require(corner < floats && taken[corner] != 0, "view",
              "a triangle's corner " + std::to_string(corner));
  require(c.tear_points.size() == c.tear_particles.size(), "view", "points of seams");
  for (const auto& t : c.tear_triangles)
    for (const std::uint32_t corner : t)
      require(corner < c.tear_points.size(), "view", "a seam's corner " + std::to_string(corner));
  for (const std::uint32_t p : c.tear_particles)
    require(p < floats && taken[p] != 0, "view", "a seam's particle " + std::to_string(p));
}

void check_view(const Simulation& simulation) {
  const View view = simulation.view();
  const Scene& scene = simulation.scene();
  require(view.cloths.size() == scene.cloths.size(), "view", "cloths");
  for (std::size_t n = 0; n < view.cloths.size(); ++n) {
    const Cloth& cloth = scene.cloths[n];
    const ClothView& shown = view.cloths[n];
    if (cloth.mesh.given())
      require(int(shown.lanes.size()) == particle_count(cloth), "view", "vertices");
    else
      require(shown.columns == cloth.grid.nx && shown.rows == cloth.grid.ny, "view", "points");
    check_spans(view.cloths[n]);
    check_values(view.cloths[n], n);
  }
}

void check_report(const Simulation& simulation, const Report& r) {
  std::int64_t particles = 0;
  for (const Cloth& c : simulation.scene().cloths) particles += particle_count(c);
  require(r.particles == particles, "report", "particles");
  require(r.asleep >= 0 && r.asleep <= particles, "report", "asleep");
  require(r.torn >= 0 && r.penetration.self_pairs >= 0 && r.penetration.crossings >= 0, "report",
          "counts");
  require(r.hash == simulation.hash(), "report", "hash");
  // A run may stop itself; its last good state is finite all the same.
  require(r.finite == simulation.status().ok, "report", "finite, or not, unlike the status");
  // A constant pressure counts from the volume of the start, and may be below.
  const auto& cloths = simulation.scene().cloths;
  const bool pressed = std::any_of(cloths.begin(), cloths.end(),
                                   [](const Cloth& c) { return c.pressure.over != 0; });
  require(r.energy.kinetic >= 0 && (pressed || r.energy.elastic >= 0), "report", "negative energy");
  const double values[] = {r.dt,
                           r.energy.kinetic,
                           r.energy.elastic,
                           r.energy.gravity,
                           r.energy.total,
                           r.momentum[0],
                           r.momentum[1],
                           r.momentum[2],
                           r.angular_momentum[0],
                           r.angular_momentum[1],
                           r.angular_momentum[2],
                           r.strain.max,
                           r.strain.mean,
                           r.penetration.collider_max,
                           r.penetration.self_max};
  require(
      std::all_of(std::begin(values), std::end(values), [](double v) { return std::isfinite(v); }),
      "report", to_json(r));
}

void check_plan(const Simulation& simulation) {
  const Plan& plan = simulation.plan();
  require(simulation.substeps() >= 1 && simulation.dt() > 0, "plan", "substeps");
  require(!to_text(plan).empty() && !plan.stages.empty(), "plan", "no stages");
  require(!plan.fallback || !plan.notes.empty(), "plan", "a fallback without a note");
}

}  // namespace

Judges::Judges(const Simulation& simulation) {
  const View view = simulation.view();
  for (std::size_t n = 0; n < view.cloths.size(); ++n) {
    const ClothView& c = view.cloths[n];
    const Cloth& cloth = simulation.scene().cloths[n];
    const std::vector<std::size_t> lanes = lanes_of(c);
    for (const Pin& pin : single_pins(cloth)) {
      const std::size_t p = lanes[std::size_t(particle_number(cloth, pin))];
      if (!pin.moves()) held_.push_back({n, p, {c.x[p], c.y[p], c.z[p]}});
    }
  }
  check_view(simulation);
  check_plan(simulation);
  laws_.emplace(simulation);
}

void Judges::frame(const Simulation& simulation, bool touched) {
  check_view(simulation);
  check_plan(simulation);
  check_report(simulation, simulation.report(false));
  if (touched) {
    held_.clear();
    laws_.reset();
  }
  if (laws_ && simulation.status().ok) laws_->frame(simulation);
  const View view = simulation.view();
  for (const Held& h : held_) {
    const ClothView& c = view.cloths[h.cloth];
    require(h.place == std::array{c.x[h.at], c.y[h.at], c.z[h.at]}, "pins",
            at("moved: a pin in lane", h.cloth, h.at));
  }
}

void Judges::end(const Simulation& simulation) const {
  check_report(simulation, simulation.report());
  const Status& s = simulation.status();
  require(s.ok == (s.text == "ok") && !s.text.empty(), "status", s.text);
}

}  // namespace fuzz
