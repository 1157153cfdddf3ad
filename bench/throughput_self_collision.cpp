// Self-collision by its parts, in nanoseconds per particle: a sheet folded into layers, where about
// 200 others are near each particle, and a flat one, where nothing is near.
#include <algorithm>
#include <memory>

#include "physics/contact/self/self_contact.h"
#include "physics/frame/cloth_step.h"
#include "throughput.h"

namespace bench {
namespace {

using weft::physics::ClothStep;
using weft::physics::SelfContact;

constexpr double kMargin = 0.45;  // of the thickness, as the simulation searches
// Spacings: 27 cells of layers a spacing apart hold 200 particles.
constexpr double kThickness = 1.34;
constexpr int kRowsOfLayer = 20;

// A sheet of n x n and its self-collision.
struct Sheet {
  Sheet(int n, bool folded, int thread_count) : threads(thread_count) {
    scene.cloths.emplace_back();
    weft::Cloth& cloth = scene.cloths[0];
    cloth.grid = {n, n, {0, 0, 0}, {1, 0, 0}, {0, 0, 1}, 0};
    cloth.self_collision.mode = weft::SelfCollisionMode::particles;
    cloth.self_collision.thickness = kThickness / (n - 1);
    const auto& kernels = weft::physics::kernel_table(widest());
    cloths.push_back(std::make_unique<ClothStep>(scene, 0, weft::Method::spring, 1, kernels));
    if (folded) fold(cloths[0]->particles());
    x.copy_from(cloths[0]->particles());
    self = SelfContact::make(scene, models_of(cloths), kernels);
    self->search(margin(), threads);
  }

  // Layer upon layer, back and forth.
  static void fold(weft::physics::Particles& l) {
    const float h = 1.0f / float(l.count(0) - 1);
    l.for_each([&](int j, int i) {
      const int layer = j / kRowsOfLayer, along = j % kRowsOfLayer;
      l.x.at(1, j, i) = float(layer) * h;
      l.x.at(2, j, i) = float(layer % 2 ? kRowsOfLayer - 1 - along : along) * h;
    });
  }

  double margin() const { return kMargin * scene.cloths[0].self_collision.thickness; }

  struct Kept {
    std::unique_ptr<weft::physics::Rows> x, v;
    void copy_from(const weft::physics::Particles& l) {
      x = std::make_unique<weft::physics::Rows>(l.rows, l.stride);
      v = std::make_unique<weft::physics::Rows>(l.rows, l.stride);
      x->copy(l.x);
      v->copy(l.v);
    }
  };
  void put_back() {
    cloths[0]->particles().x.copy(*x.x);
    cloths[0]->particles().v.copy(*x.v);
  }

  weft::Scene scene;
  std::vector<std::unique_ptr<ClothStep>> cloths;
  std::unique_ptr<SelfContact> self;
  weft::physics::Threads threads;
  Kept x;
};

// The fastest of many times, each from the same state; once before, for the memory that it takes.
template <class Part>
void measure(benchmark::State& state, Sheet& sheet, Part&& part) {
  part();
  double best = std::numeric_limits<double>::infinity();
  for (auto _ : state) {
    sheet.put_back();
    const auto start = std::chrono::steady_clock::now();
    part();
    const std::chrono::duration<double, std::nano> spent = std::chrono::steady_clock::now() - start;
    best = std::min(best, spent.count());
  }
  state.counters["ms"] = best * 1e-6;
  state.counters["ns/particle"] = best / double(sheet.self->particles());
}

void add_part(const std::string& part, int n, int threads, bool folded,
              std::function<void(Sheet&)> work) {
  const std::string name = std::string("self_collision/") + (folded ? "folded" : "flat") + "/" +
                           part + "/" + std::to_string(n) + "/threads:" + std::to_string(threads);
  add_benchmark(name, [=](benchmark::State& state) {
    Sheet sheet(n, folded, threads);
    measure(state, sheet, [&] { work(sheet); });
  });
}

// A scene to its rest with its own mode of self-collision, a plainer one, or without.
void add_scene(const std::string& name, double seconds, weft::SelfCollisionMode mode) {
  constexpr const char* kModes[] = {"off", "particles", "surface"};
  add_benchmark("self_collision/scene/" + name + "/" + kModes[int(mode)],
                [=](benchmark::State& s) {
                  weft::SceneFile file = weft::read_scene(name);
                  for (weft::Cloth& cloth : file.scene.cloths) cloth.self_collision.mode = mode;
                  run_frames(s, file, seconds, 1);
                })
      ->Iterations(1)
      ->Repetitions(2);
}

}  // namespace

void register_self_collision(bool quick) {
  using weft::SelfCollisionMode;
  for (const auto mode : {SelfCollisionMode::off, SelfCollisionMode::particles})
    add_scene("selfCollision", 4, mode);
  for (const auto mode : {SelfCollisionMode::off, SelfCollisionMode::surface})
    add_scene("crumple", 4, mode);
  constexpr double dt = 1e-4;
  for (int n : quick ? std::vector<int>{100, 316} : std::vector<int>{100, 316, 1000})
    for (int threads : {1, 2}) {
      add_part("sort", n, threads, true, [](Sheet& s) { s.self->sort(s.margin(), s.threads); });
      add_part("search", n, threads, true, [](Sheet& s) { s.self->find(s.margin(), s.threads); });
      add_part("run", n, threads, true, [](Sheet& s) { s.self->run({dt, 1, 0}, s.threads); });
      add_part("look", n, threads, false, [](Sheet& s) { s.self->run({dt, 1, 0}, s.threads); });
    }
}

}  // namespace bench
