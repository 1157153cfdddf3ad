// A person who does anything at any time to a simulation on a thread of its own, as the window lets
// them: what is shown stays whole, and what was recorded replays to the same bits.
#include "run/session.h"

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cmath>
#include <thread>

#include "folder.h"
#include "machines.h"
#include "weft/random.h"
#include "weft/read_scene.h"

namespace weft::viewer {
namespace {

class Person {
 public:
  explicit Person(std::uint64_t seed) : random_(seed, 1) {}

  int one_of(int n) { return static_cast<int>(random_.bits() % static_cast<std::uint64_t>(n)); }
  double between(double a, double b) { return a + (b - a) * random_.unit(); }
  Vec3 near(const Vec3& p, double by) {
    return {p[0] + by * random_.symmetric(), p[1] + by * random_.symmetric(),
            p[2] + by * random_.symmetric()};
  }

  // What hands do to what is shown.
  Input input(const FrameData& shown) {
    Input input;
    input.kind = static_cast<Input::Kind>(one_of(static_cast<int>(Input::Kind::set_scene)));
    input.cloth = one_of(static_cast<int>(shown.cloths.size()));
    const ClothCopy& cloth = shown.cloths[static_cast<std::size_t>(input.cloth)];
    input.particle = one_of(cloth.columns * cloth.rows);
    const Vec3f shown_at = cloth.position(input.particle);
    const Vec3 at{shown.origin[0] + shown_at.x, shown.origin[1] + shown_at.y,
                  shown.origin[2] + shown_at.z};
    input.a = input.kind == Input::Kind::carry ? near({}, 0.5) : near(at, 0.1);
    input.b = near(at, 0.1);
    input.amount = input.kind == Input::Kind::cut ? 0.01 : 2000;
    if (shown.bodies.empty() && input.kind == Input::Kind::move_collider)
      input.kind = Input::Kind::release;
    else if (input.kind == Input::Kind::move_collider)
      input.collider = one_of(static_cast<int>(shown.bodies.size()));
    return input;
  }

  // Another value in the panel; the scene as it was where it does not go with the others.
  Scene edited(const Scene& before, double time) {
    Scene scene = before;
    Cloth& cloth = scene.cloths[static_cast<std::size_t>(one_of(int(scene.cloths.size())))];
    const auto point = [&] { return near(cloth.grid.origin, 1); };
    switch (one_of(10)) {
      case 0:
        cloth.stiffness.structural *= between(0.5, 2);
        break;
      case 1:
        cloth.drag = between(0, 2);
        break;
      case 2:
        cloth.tear_strain = between(0.05, 0.5);
        break;
      case 3:
        scene.solver.method = std::array{Method::spring, Method::spring_friction,
                                         Method::positional, Method::compliant}[one_of(4)];
        break;
      case 4:
        cloth.self_collision.mode = SelfCollisionMode(one_of(3));
        break;
      case 5:
        scene.colliders.push_back(
            {Sphere{point(), 0.1}, {}, 0.01, {{time, point()}, {time + 0.5, point()}}, false});
        break;
      case 6:
        if (!scene.colliders.empty()) scene.colliders.pop_back();
        break;
      case 7:
        cloth.pins.push_back({one_of(cloth.grid.nx), one_of(cloth.grid.ny), {}});
        break;
      case 8:
        cloth.grid.nx += one_of(3) - 1;
        break;
      case 9:
        cloth.color.back = std::array{"", "#ff8000", "#0080ff"}[one_of(3)];
        break;
    }
    return validate(scene).empty() ? scene : before;
  }

 private:
  Random random_;
};

void expect_whole(const Shown& shown) {
  const FrameData& s = shown.frame_data;
  ASSERT_TRUE(shown.telemetry.status.ok) << shown.telemetry.status.text;
  ASSERT_TRUE(s.scene);
  ASSERT_EQ(s.cloths.size(), s.scene->cloths.size());
  for (const ClothCopy& cloth : s.cloths) {
    const std::size_t all = cloth.at(0, cloth.rows);
    for (const auto* values : {&cloth.x, &cloth.y, &cloth.z, &cloth.vx, &cloth.vy, &cloth.vz}) {
      ASSERT_EQ(values->size(), all);
      for (const float value : *values) ASSERT_TRUE(std::isfinite(value));
    }
    ASSERT_EQ(cloth.inverse_mass.size(), all);
    for (const auto& triangle : cloth.triangles)
      for (const std::uint32_t p : triangle) ASSERT_LT(p, all);
    ASSERT_EQ(cloth.tear_points.size(), cloth.tear_particles.size());
    for (const auto& triangle : cloth.tear_triangles)
      for (const std::uint32_t p : triangle) ASSERT_LT(p, cloth.tear_points.size());
  }
}

Scene scene_of(const std::string& name) {
  if (name == "far_cutter") return moved(read_scene("cutter").scene, {4000, 200, -7000});
  return read_scene(name).scene;
}

class Sessions : public testing::TestWithParam<const char*> {
 protected:
  static constexpr int kWishes = 120;

  // Waits for a frame computed from now on, on a machine however slow.
  static void await_frame(Session& session) {
    const std::int64_t before = session.shown().telemetry.frames;
    for (int n = 0; n < 6000 && session.shown().telemetry.frames == before; ++n) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
      if (session.refresh()) expect_whole(session.shown());
    }
    EXPECT_GT(session.shown().telemetry.frames, before) << "none came";
  }
  // Waits a little, as a person does, and looks at what has come.
  static void look(Session& session, Person& person) {
    std::this_thread::sleep_for(std::chrono::microseconds(person.one_of(8000)));
    if (session.refresh()) expect_whole(session.shown());
  }
};

TEST_P(Sessions, StayWholeWhateverIsAsked) {
  const Scene first = scene_of(GetParam());
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    Person person(seed);
    Options options;
    options.threads = 1;
    Session session(first, options, false, false);
    session.post([](Player& player) { player.set_speed(8); });
    Scene scene = first;
    for (int n = 0; n < kWishes; ++n) {
      look(session, person);
      const FrameData& shown = session.shown().frame_data;
      switch (person.one_of(12)) {
        case 0:
          session.post([](Player& player) { player.step(); });
          break;
        case 1:
          session.post([&, n](Player& player) { player.pause(n % 2 == 0); });
          break;
        case 2:
          session.post([back = n % 7](Player& player) { player.go_back(back); });
          break;
        case 3:
          session.post([threads = 1 + n % 3, simd = n % 2 == 0 ? Simd::best : wide_simd()](
                           Player& player) { player.set_options(threads, simd); });
          break;
        case 4:
          if (n % 4 == 0) scene = first;
          session.post([scene](Player& player) { player.open(scene); });
          break;
        case 5:
        case 6:
          scene = person.edited(scene, shown.time);
          session.post([scene](Player& player) { player.change(scene); });
          break;
        default:
          session.post([input = person.input(shown)](Player& player) { player.hand(input); });
      }
    }
    session.post([](Player& player) { player.pause(true); });
    look(session, person);
  }
}

TEST_P(Sessions, RecordingsReplay) {
  const Folder folder;
  const std::string path = folder / "session.jsonl";
  {
    Person person(3);
    Scene scene = scene_of(GetParam());
    Options options;
    options.threads = 1;
    Session session(scene, options, false, false);
    session.post([path](Player& player) {
      player.set_speed(8);
      player.record(path);
    });
    for (int n = 0; n < kWishes / 2; ++n) {
      look(session, person);
      if (n % 8 == 7) {
        await_frame(session);
        scene = person.edited(scene, session.shown().frame_data.time);
        session.post([scene](Player& player) { player.change(scene); });
      } else {
        session.post([input = person.input(session.shown().frame_data)](Player& player) {
          player.hand(input);
        });
      }
    }
    await_frame(session);
  }
  const Recording recording = read_recording(path);
  EXPECT_GT(recording.frames(), 0);
  Simulation simulation(recording.scene);
  for (std::size_t next = 0; next < recording.events.size();) {
    while (const Input* input = next_input(recording, next, simulation)) apply(*input, simulation);
    if (next == recording.events.size()) break;
    simulation.advance_frame();
    ASSERT_NO_THROW(compare_hash(recording, next, simulation));
  }
}

void advance(Player& player, int frames) {
  for (int n = 0; n < frames; ++n) player.advance();
}

// It lets go of nothing, begins nothing anew, and forgets no state.
TEST(Players, AColourIsShownAndTheRunGoesOn) {
  Scene scene = read_scene("two_sheets").scene;
  for (Cloth& cloth : scene.cloths) cloth.grid.nx = cloth.grid.ny = 12;
  Scene painted = scene;
  painted.cloths[1].color.front = "#ff0000";
  painted.colliders[0].color = "#00ff00";
  Player plain(scene, {}, true), other(scene, {}, true);
  Input grab{.kind = Input::Kind::grab};
  grab.a = {0, 1, 0};
  grab.amount = 500;
  for (Player* player : {&plain, &other}) {
    player->hand(grab);
    advance(*player, 5);
  }
  other.change(painted);
  Shown one, two;
  advance(plain, 5);
  advance(other, 5);
  plain.show(one);
  other.show(two);
  EXPECT_EQ(two.telemetry.hash, one.telemetry.hash);
  EXPECT_EQ(two.frame_data.frame, 10);
  EXPECT_EQ(two.telemetry.kept, one.telemetry.kept);
  EXPECT_EQ(two.frame_data.scene->cloths[1].color.front, "#ff0000");
  EXPECT_EQ(two.frame_data.bodies[0].color, "#00ff00");
  EXPECT_NE(two.frame_data.scene_serial, one.frame_data.scene_serial);
  painted.cloths[0].color.front = "red";
  other.change(painted);
  other.show(two);
  EXPECT_NE(two.telemetry.problem.find("front is \"red\""), std::string::npos)
      << two.telemetry.problem;
}

TEST(Players, ACutTakenBackLaysTheClothBackOrTellsThatItCannot) {
  const Scene whole = read_scene("pinned2").scene;
  Scene cut = whole;
  cut.cloths[0].cuts = {{{-1, 25.4}, {51, 25.4}}};
  Shown before, apart, after;
  Player player(whole, {}, false);
  advance(player, 20);
  player.show(before);
  player.change(cut);
  advance(player, 40);
  player.show(apart);
  player.change(whole);
  player.show(after);
  const auto farthest = [&](const Shown& shown) {
    const ClothCopy &a = before.frame_data.cloths[0], &b = shown.frame_data.cloths[0];
    float most = 0;
    for (int p = 0; p < a.columns * a.rows; ++p)
      most = std::max(most, length(a.position(p) - b.position(p)));
    return most;
  };
  EXPECT_TRUE(apart.frame_data.cloths[0].torn);
  EXPECT_GT(farthest(apart), 0.5f);
  EXPECT_FALSE(after.frame_data.cloths[0].torn);
  EXPECT_LT(farthest(after), 0.05f);  // a frame or two, where not every one is kept
  EXPECT_EQ(after.telemetry.problems, 0);

  Player torn(cut, {}, false);
  advance(torn, 5);
  torn.change(whole);
  torn.show(after);
  EXPECT_FALSE(after.frame_data.cloths[0].torn);
  EXPECT_NE(after.telemetry.problem.find("no longer kept"), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(, Sessions,
                         testing::Values("seed1_friction", "hello", "far_cutter", "tug",
                                         "two_sheets"),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace weft::viewer
