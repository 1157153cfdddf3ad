// References and their cache (reference.h).
#include "reference.h"

#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <future>
#include <stdexcept>

#include "verlet.h"
#include "weft/read_scene.h"

namespace bench {
namespace {

// Raised whenever the integration changes, so that no old answer is taken for a new one.
constexpr int kVersion = 3;

std::uint64_t hash_of(const Question& q) {
  char asked[160];
  std::snprintf(asked, sizeof asked, "%d %.17g %d %.17g %d", kVersion, q.seconds, int(q.at_rest),
                q.tolerance, q.most_halvings);
  weft::Scene physics = q.scene;  // how it will be solved does not matter
  physics.solver = {};
  physics.time = {};
  physics.name.clear();
  physics.about.clear();
  std::uint64_t hash = 14695981039346656037ull;
  for (const char c : weft::write_scene_text(physics) + asked)
    hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ull;
  return hash;
}

std::filesystem::path file_of(const Question& q, const std::string& cache) {
  char name[32];
  std::snprintf(name, sizeof name, "%016llx.f64", static_cast<unsigned long long>(hash_of(q)));
  return std::filesystem::path(cache) / name;
}

// Header: error [m], steps, wall seconds; then the positions.
constexpr std::size_t kHeader = 3;

bool read(const std::filesystem::path& path, std::size_t values, Reference& r) {
  std::ifstream in(path, std::ios::binary);
  std::vector<double> all(kHeader + values);
  const auto bytes = std::streamsize(all.size() * sizeof(double));
  if (!in.read(reinterpret_cast<char*>(all.data()), bytes)) return false;
  r.error = all[0];
  r.steps = std::int64_t(all[1]);
  r.seconds = all[2];
  r.cached = true;
  r.positions.assign(all.begin() + kHeader, all.end());
  return true;
}

void write(const std::filesystem::path& path, const Reference& r) {
  std::filesystem::create_directories(path.parent_path());
  std::vector<double> all{r.error, double(r.steps), r.seconds};
  all.insert(all.end(), r.positions.begin(), r.positions.end());
  const std::filesystem::path part = path.string() + "." + std::to_string(getpid());
  std::ofstream(part, std::ios::binary)
      .write(reinterpret_cast<const char*>(all.data()),
             std::streamsize(all.size() * sizeof(double)));
  std::filesystem::rename(part, path);
}

std::vector<double> run(const Question& q, std::int64_t steps) {
  Verlet verlet(q.scene);
  verlet.advance(q.seconds, steps);
  return verlet.positions();
}

// Halves the substep until the error, a third of what the last halving changed, is small enough.
Reference converge(const Question& q) {
  std::int64_t steps = std::int64_t(std::ceil(q.seconds / (0.5 * Verlet(q.scene).safe_step())));
  // The first two runs side by side, then one at a time: each takes as long as all before it.
  auto coarse_run = std::async(std::launch::async, [&q, steps] { return run(q, steps); });
  Reference r;
  r.positions = run(q, 2 * steps);
  r.steps = 2 * steps;
  r.error = distance(coarse_run.get(), r.positions).rms / 3;
  for (int n = 1; n < q.most_halvings && !(r.error < q.tolerance); ++n) {
    std::vector<double> finer = run(q, 2 * r.steps);
    r.error = distance(r.positions, finer).rms / 3;
    r.positions = std::move(finer);
    r.steps *= 2;
  }
  return r;
}

// The equilibrium does not depend on the substep: a fixed point of Verlet has no force left.
Reference rest(const Question& q) {
  Verlet verlet(q.scene);
  verlet.advance(q.seconds, std::int64_t(std::ceil(q.seconds / (0.5 * verlet.safe_step()))));
  verlet.come_to_rest(1e-5);
  Reference r;
  r.positions = verlet.positions();
  verlet.come_to_rest(1e-6);
  r.error = distance(r.positions, verlet.positions()).rms;
  r.positions = verlet.positions();
  return r;
}

}  // namespace

std::string unsupported(const weft::Scene& scene) {
  if (scene.cloths.size() != 1) return "not exactly one cloth";
  const weft::Cloth& c = scene.cloths[0];
  if (c.grid.jitter > 0) return "jitter";
  if (c.bending.damping > 0 || c.membrane.damping > 0) return "damping of the fabric";
  if (c.strain_limit > 0) return "strain limit";
  if (c.tear_strain > 0) return "tearing";
  if (c.self_collision.mode != weft::SelfCollisionMode::off) return "self-collision";
  if (scene.wind.drag > 0 || scene.wind.lift > 0) return "wind";
  for (const weft::Pin& pin : c.pins)
    if (pin.follow >= 0 || pin.of_several())
      return "pins that follow a body or hold several particles";
  for (const weft::Collider& collider : scene.colliders)
    if (!collider.keys.empty() || !collider.rotate.keys.empty() ||
        collider.friction.model != weft::FrictionModel::coulomb || collider.cuts ||
        collider.shape.index() > 1)
      return "a collider that is not a fixed sphere or plane with Coulomb friction";
  return "";
}

Reference reference(const Question& q, const std::string& cache) {
  if (const std::string why = unsupported(q.scene); !why.empty())
    throw std::invalid_argument("no reference for a scene with " + why);
  const weft::Grid& g = q.scene.cloths[0].grid;
  const std::filesystem::path path = file_of(q, cache);
  Reference r;
  if (read(path, 3 * std::size_t(g.nx) * std::size_t(g.ny), r)) return r;
  const auto start = std::chrono::steady_clock::now();
  r = q.at_rest ? rest(q) : converge(q);
  r.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  write(path, r);
  return r;
}

Distance distance(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0, most = 0;
  for (std::size_t p = 0; p + 2 < a.size(); p += 3) {
    double squared = 0;
    for (std::size_t c = 0; c < 3; ++c) squared += (a[p + c] - b[p + c]) * (a[p + c] - b[p + c]);
    sum += squared;
    most = !(squared <= most) ? squared : most;
  }
  return {std::sqrt(3 * sum / double(a.size())), std::sqrt(most)};
}

}  // namespace bench
