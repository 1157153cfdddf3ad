#include "hostile.h"

#include <limits>

#include "draw.h"
#include "failure.h"
#include "judges.h"

namespace fuzz {

using namespace weft;

namespace {

constexpr std::uint64_t kHostileStream = 4'000'000;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

double odd_value(Draw& draw) {
  return draw.of({kNaN, kInfinity, -kInfinity, 1e300, -1e300, 1e38, 1e-310, -1.0, 0.0});
}

int odd_index(Draw& draw) {
  return draw.of({-1, 0, 1, 16, 4095, 4096, 1 << 30, std::numeric_limits<int>::max(),
                  std::numeric_limits<int>::min()});
}

void mangle_cloth(Snapshot::ClothState& c, Draw& draw) {
  const auto any = [&](std::size_t size) { return std::size_t(draw.uniform(0, double(size))); };
  switch (draw.between(0, 7)) {
    case 0:
      c.columns = odd_index(draw);
      break;
    case 1:
      c.positions.resize(any(2 * c.positions.size()));
      break;
    case 2:
      c.velocities.resize(any(2 * c.velocities.size()));
      break;
    case 3:
      if (!c.positions.empty()) c.positions[any(c.positions.size())] = float(odd_value(draw));
      break;
    case 4:
      if (!c.velocities.empty()) c.velocities[any(c.velocities.size())] = float(odd_value(draw));
      break;
    case 5:
      c.held.push_back(odd_index(draw));
      break;
    case 6: {
      const int a = odd_index(draw);
      c.torn.push_back({a, draw.chance(0.5) ? odd_index(draw) : a});
      break;
    }
    default: {
      const double time = odd_value(draw), particle = odd_value(draw);
      if (!c.inside.empty() && draw.chance(0.7))
        c.inside.back() = {time, particle, odd_value(draw)};
      else
        c.inside.push_back({});
      break;
    }
  }
}

void mangle_path(std::vector<Key>& keys, Draw& draw) {
  if (keys.empty() || draw.chance(0.3)) {
    const double time = odd_value(draw);
    keys.push_back({time, {0, odd_value(draw), 0}});
  } else {
    keys.push_back(keys.front());  // times that do not increase
    keys.back().position[1] = odd_value(draw);
  }
}

void mangle(Snapshot& m, Draw& draw) {
  for (int n = draw.between(1, 3); n > 0; --n) {
    const double what = draw.uniform(0, 1);
    if (what < 0.08)
      m.time = odd_value(draw);
    else if (what < 0.2)
      m.origin[std::size_t(draw.between(0, 2))] = odd_value(draw);
    else if (what < 0.25)
      m.cloths.resize(std::size_t(draw.between(0, 3)));
    else if (what < 0.3)
      m.paths.resize(std::size_t(draw.between(0, 3)));
    else if (what < 0.45 && !m.paths.empty())
      mangle_path(m.paths.back(), draw);
    else if (!m.cloths.empty())
      mangle_cloth(m.cloths[std::size_t(draw.between(0, int(m.cloths.size()) - 1))], draw);
  }
}

// Makes a call that may refuse; tells whether it did.
template <class Error, class Call>
bool refused(const char* name, Call&& call) {
  try {
    call();
  } catch (const Error& error) {
    if (std::string(error.what()).empty()) throw Failure("hostile: no reason given");
    return true;
  } catch (const std::exception& error) {
    throw Failure("hostile: " + std::string(name) + ": " + error.what());
  }
  return false;
}

// After a call that was refused nothing has changed; after one that worked the simulation goes on.
void expect_sound(Simulation& simulation, bool was_refused, std::uint64_t before,
                  const char* name) {
  if (was_refused && hash_of(simulation) != before)
    throw Failure("hostile: " + std::string(name) + " was refused and changed the state");
  simulation.advance_frame();
  if (simulation.status().ok) Judges(simulation).end(simulation);
}

void mistreat_state(Simulation& simulation, Draw& draw) {
  std::vector<double> x = simulation.positions(), v = simulation.velocities();
  std::vector<double>& broken = draw.chance(0.5) ? x : v;
  if (draw.chance(0.3))
    broken.resize(std::size_t(draw.between(0, int(2 * broken.size()))));
  else
    broken[std::size_t(draw.between(0, int(broken.size()) - 1))] = odd_value(draw);
  const std::uint64_t before = hash_of(simulation);
  const bool no = refused<std::invalid_argument>("set_state", [&] { simulation.set_state(x, v); });
  expect_sound(simulation, no, before, "set_state");
}

void mistreat_input(Simulation& simulation, Draw& draw) {
  Input input;
  input.kind = static_cast<Input::Kind>(draw.between(0, 6));
  input.cloth = draw.chance(0.5) ? 0 : odd_index(draw);
  input.particle = odd_index(draw);
  input.collider = odd_index(draw);
  input.a = {0, draw.chance(0.5) ? 0 : odd_value(draw), 0};
  input.b = {0, draw.chance(0.5) ? 1 : odd_value(draw), 0};
  input.amount = draw.chance(0.5) ? 0.01 : odd_value(draw);
  const std::uint64_t before = hash_of(simulation);
  const bool no = refused<std::logic_error>("an input", [&] { apply(input, simulation); });
  expect_sound(simulation, no, before, "an input");
}

}  // namespace

void mistreat(const Case& c, const Options& options, int rounds) {
  Draw draw(c.seed, kHostileStream);
  Simulation simulation(c.scene, options);
  simulation.advance_frame();
  const Snapshot sound = simulation.snapshot();
  for (int round = 0; round < rounds; ++round) {
    const int kind = draw.between(0, 3);
    if (kind == 0) {
      mistreat_state(simulation, draw);
    } else if (kind == 1) {
      mistreat_input(simulation, draw);
    } else {
      Snapshot broken = sound;
      mangle(broken, draw);
      const std::uint64_t before = hash_of(simulation);
      const bool no =
          refused<std::invalid_argument>("restore", [&] { simulation.restore(broken); });
      expect_sound(simulation, no, before, "restore");
    }
    simulation.restore(sound);
  }
}

}  // namespace fuzz
