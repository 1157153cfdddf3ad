#include "inputs.h"

#include <utility>

#include "random_scene.h"

namespace fuzz {

using namespace weft;

namespace {

// Streams of random numbers: of what holds for all frames, and the first of those of single frames.
constexpr std::uint64_t kChoiceStream = 1'000'000, kHandStream = 2'000'000,
                        kStateStream = 3'000'000;

// A particle of any cloth.
void aim(Input& input, const Scene& scene, Draw& draw) {
  input.cloth = draw.between(0, int(scene.cloths.size()) - 1);
  const Cloth& cloth = scene.cloths[std::size_t(input.cloth)];
  if (cloth.mesh.given()) {
    input.particle = draw.between(0, particle_count(cloth) - 1);
    return;
  }
  const Grid& g = cloth.grid;
  const int column = draw.between(0, g.nx - 1), row = draw.between(0, g.ny - 1);
  input.particle = particle_number(g, column, row);
}

Input random_input(const Scene& scene, Draw& draw) {
  Input input;
  input.kind = static_cast<Input::Kind>(draw.between(0, 7));
  if (input.kind == Input::Kind::move_collider && scene.colliders.empty())
    input.kind = Input::Kind::grab;
  aim(input, scene, draw);
  if (input.kind == Input::Kind::carry) {
    input.a = draw.chance(0.3) ? Vec3{} : draw.vector(draw.decades(1e-3, 30));
    return input;
  }
  input.a = point_near(scene, draw);
  input.b = point_near(scene, draw);
  if (input.kind == Input::Kind::cut) input.amount = draw.chance(0.3) ? 0 : draw.decades(1e-5, 0.1);
  if (input.kind == Input::Kind::grab)
    input.amount = draw.of({0.0, 200.0, draw.decades(1e-3, 1e6), 1e12});
  if (input.kind == Input::Kind::move_collider)
    input.collider = draw.between(0, int(scene.colliders.size()) - 1);
  if (input.kind == Input::Kind::set_scene)
    input.scene = std::make_shared<const Scene>(changed_scene(scene, draw));
  return input;
}

}  // namespace

Inputs inputs_of(std::uint64_t seed) {
  return Draw(seed, kChoiceStream).of({Inputs::none, Inputs::recorded, Inputs::all});
}

void throw_cloth(Simulation& simulation, double speed, double off, Draw draw) {
  std::vector<double> x = simulation.positions(), v = simulation.velocities();
  for (double& c : x) c += off * draw.uniform(-1, 1);
  for (double& c : v) c = speed * draw.uniform(-1, 1);
  simulation.set_state(x, v);
}

Hand::Hand(std::uint64_t seed, Inputs inputs) : seed_(seed), inputs_(inputs) {
  Draw draw(seed, kChoiceStream + 1);
  busy_ = draw.of({0.1, 0.3, 1.0});
}

void Hand::act_on_state(Simulation& simulation, int kind) {
  Draw draw(seed_, kStateStream + step_);
  const double speed = draw.chance(0.9) ? draw.decades(1e-3, 10) : draw.decades(10, 1e4);
  if (kind == 0) {
    const double off = draw.chance(0.5) ? 0 : draw.decades(1e-6, 1);
    throw_cloth(simulation, speed, off, draw);
  }
  if (kind == 1) kept_ = simulation.snapshot();
  // A snapshot of a scene with other colliders is refused.
  if (kind == 2 && kept_ && kept_->paths.size() == simulation.scene().colliders.size())
    simulation.restore(*std::exchange(kept_, std::nullopt));
}

bool Hand::act(Simulation& simulation, Recorder* recorder) {
  if (inputs_ == Inputs::none) return false;
  Draw draw(seed_, kHandStream + ++step_);
  if (!draw.chance(busy_)) return false;
  if (const int kind = draw.between(0, 5); inputs_ == Inputs::all && kind < 3) {
    act_on_state(simulation, kind);
    return true;
  }
  const Input input = random_input(simulation.scene(), draw);
  const std::int64_t frame = simulation.frame();  // another scene may count them another way
  apply(input, simulation);
  if (recorder) recorder->input(frame, input);
  return true;
}

}  // namespace fuzz
