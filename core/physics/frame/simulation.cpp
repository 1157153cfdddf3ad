// The simulation: builds the state and the plan of a scene, and advances it frame by frame.
#include "weft/simulation.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "physics/frame/cloth_step.h"
#include "physics/frame/measure.h"
#include "physics/frame/placed_scene.h"
#include "physics/frame/state.h"

namespace weft {

using namespace physics;

namespace {

std::string fault_text(const std::vector<Fault>& faults) {
  std::string text = "the scene cannot be simulated";
  for (const Fault& f : faults) {
    text += "\n  " + f.place + ": " + f.what;
    if (!f.allowed.empty()) text += " (" + f.allowed + ")";
  }
  return text;
}

}  // namespace

SceneError::SceneError(std::vector<Fault> found)
    : std::invalid_argument(fault_text(found)), faults(std::move(found)) {}

Simulation::Simulation(Scene scene, Options options) {
  if (auto faults = validate(scene); !faults.empty()) throw SceneError(std::move(faults));
  if (!simd_available(options.simd))
    throw std::invalid_argument(std::string("this build or machine has no ") +
                                simd_name(options.simd));
  if (options.threads < 0 || options.threads > 256)
    throw std::invalid_argument("threads is " + std::to_string(options.threads) + " (0 to 256)");
  const Vec3 origin = origin_of(scene);
  state_ = std::make_shared<State>(std::move(scene), options, origin);
}

Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

void Simulation::draw_as(const Scene& scene) {
  if (auto faults = validate(scene); !faults.empty()) throw SceneError(std::move(faults));
  state_->placed.draw_as(scene);
}

void Simulation::advance_frame() {
  state_->advance_frame();
}
const Scene& Simulation::scene() const {
  return state_->placed.given();
}
const Options& Simulation::options() const {
  return state_->options;
}
int Simulation::threads() const {
  return state_->runner.threads().count();
}
Simd Simulation::simd() const {
  return state_->simd;
}
std::int64_t Simulation::frame() const {
  return state_->frame;
}
double Simulation::time() const {
  return state_->time();
}
double Simulation::dt() const {
  return state_->time_step.dt;
}
int Simulation::substeps() const {
  return state_->time_step.substeps;
}
const Plan& Simulation::plan() const {
  state_->tell_notes();
  return state_->plan;
}
const Status& Simulation::status() const {
  return state_->status;
}

View Simulation::view() const {
  View view;
  view.version = std::uint64_t(state_->frame) + state_->changes;
  view.time = time();
  view.origin = state_->placed.origin();
  for (std::size_t n = 0; n < state_->cloths.size(); ++n) {
    const auto& step = state_->cloths[n];
    const Particles& l = step->particles();
    ClothView c;
    c.columns = l.count(0);
    c.rows = l.rows;
    c.stride = l.stride;
    c.x = l.x.component(0);
    c.y = l.x.component(1);
    c.z = l.x.component(2);
    c.vx = l.v.component(0);
    c.vy = l.v.component(1);
    c.vz = l.v.component(2);
    c.inverse_mass = state_->masses(n).span();
    c.color = linear_color(scene().cloths[n].color.front);
    if (const DrawnMesh* drawn = step->model().drawn_mesh()) {
      c.lanes = drawn->lanes;
      c.triangles = drawn->triangles;
      c.uv = drawn->uv;
      c.topology_version = 1;
    }
    if (Tearing* t = step->model().tearing()) {
      const TornSurface torn = t->surface();
      c.topology_version = t->version();
      c.torn = t->torn() > 0;
      c.triangles = torn.whole;
      c.tear_points = torn.points;
      c.tear_particles = torn.owners;
      c.tear_triangles = torn.boundary;
      if (!torn.uv.empty()) c.uv = torn.uv;
    }
    view.cloths.push_back(c);
  }
  return view;
}

std::shared_ptr<const void> Simulation::memory() const {
  return state_;
}

std::vector<double> Simulation::positions() const {
  std::vector<double> all;
  for (const auto& step : state_->cloths)
    for (const Vec3& x : step->particles().gather(step->particles().x))
      for (int k = 0; k < 3; ++k) all.push_back(x[k] + state_->placed.origin()[k]);
  return all;
}

std::vector<double> Simulation::velocities() const {
  std::vector<double> all;
  for (std::size_t c = 0; c < state_->cloths.size(); ++c)
    for (const Vec3& v : state_->velocities(c)) all.insert(all.end(), v.begin(), v.end());
  return all;
}

void Simulation::set_state(std::span<const double> positions, std::span<const double> velocities) {
  state_->set(positions, {}, velocities);
}

void Simulation::grab(int cloth, int particle, const Vec3& target, double stiffness) {
  state_->grab(cloth, particle, target, stiffness);
}
void Simulation::release() {
  state_->release();
}
void Simulation::carry(int cloth, const Vec3& velocity) {
  state_->carry(cloth, velocity);
}
void Simulation::pin(int cloth, int particle) {
  state_->hold(cloth, particle, true);
}
void Simulation::unpin(int cloth, int particle) {
  state_->hold(cloth, particle, false);
}

void Simulation::move_collider(int collider, const Vec3& target) {
  state_->move_collider(collider, target);
}

int Simulation::cut(const Vec3& a, const Vec3& b, double width) {
  return state_->cut(a, b, width);
}

Report Simulation::report(bool contacts) const {
  state_->tell_notes();
  return measure(*state_, contacts);
}
std::uint64_t Simulation::hash() const {
  return state_hash(*state_);
}

double Simulation::bytes_per_particle() const {
  std::size_t particles = 0;
  for (const auto& step : state_->cloths) particles += std::size_t(step->particles().count());
  return double(state_->bytes()) / double(particles);
}

}  // namespace weft
