// Recordings: a run told again gives the same bits, and a difference is named by its frame.
#include <sstream>
#include <tuple>
#include <vector>

#include "machines.h"
#include "program.h"
#include "weft/read_scene.h"
#include "weft/recording.h"

namespace weft {
namespace {

TEST(Recording, ReplaysToTheSameBits) {
  const Folder folder;
  const std::string scene = small_scene(folder);
  ASSERT_EQ(run_weft(folder, "run small.json --frames 9 --record a.rec").exit_code, 0);
  const Outcome again =
      run_weft(folder, "run --replay a.rec --record b.rec --threads 1 --simd scalar");
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(folder.read("a.rec"), folder.read("b.rec"));
  EXPECT_EQ(run_weft(folder, "run small.json --replay a.rec").exit_code, 0);
}

TEST(Recording, ADifferenceIsNamedByItsFrame) {
  const Folder folder;
  small_scene(folder);
  ASSERT_EQ(run_weft(folder, "run small.json --frames 9 --record a.rec").exit_code, 0);
  std::string text = folder.read("a.rec");
  const std::size_t at = text.find("\"hash\"", text.find("\"frame\":4"));
  char& digit = text[text.find_first_of("0123456789abcdef", at + 8)];
  digit = digit == '0' ? '1' : '0';
  folder.write("a.rec", text);
  const Outcome outcome = run_weft(folder, "run --replay a.rec");
  EXPECT_EQ(outcome.exit_code, 4);
  EXPECT_NE(outcome.err.find("frame 4 differs"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("record it anew"), std::string::npos) << outcome.err;
  // Two hashes, which differ.
  const std::size_t first = outcome.err.find("its hash is ") + 12;
  const std::size_t second = outcome.err.find("in the recording ") + 17;
  EXPECT_NE(outcome.err.substr(first, 16), outcome.err.substr(second, 16)) << outcome.err;
}

// Frames of another length count the time so far anew.
TEST(Recording, FramesOfAnotherLengthReplay) {
  const Folder folder;
  Scene scene = read_scene("swing").scene;
  scene.cloths[0].grid.nx = scene.cloths[0].grid.ny = 8;
  scene.cloths[0].pins = {{0, 0, {}}, {7, 0, {}}};
  const std::string path = folder.path() + "/a.rec";
  std::vector<std::uint64_t> hashes;
  {
    Simulation simulation(scene);
    Recorder recorder(path, simulation);
    const auto frames = [&](int count) {
      for (int n = 0; n < count; ++n) {
        simulation.advance_frame();
        recorder.frame(simulation);
        hashes.push_back(simulation.hash());
      }
    };
    for (const double length : {scene.time.frame, 0.5 * scene.time.frame, 3 * scene.time.frame}) {
      Input other;
      other.kind = Input::Kind::set_scene;
      Scene changed = scene;
      changed.time.frame = length;
      other.scene = std::make_shared<const Scene>(changed);
      recorder.input(simulation.frame(), other);
      apply(other, simulation);
      frames(4);
    }
    recorder.finish();
  }
  const Recording recording = read_recording(path);
  Simulation again(recording.scene, {.seed = recording.seed});
  std::size_t next = 0;
  for (const std::uint64_t hash : hashes) {
    while (const Input* input = next_input(recording, next, again)) apply(*input, again);
    again.advance_frame();
    compare_hash(recording, next, again);
    EXPECT_EQ(again.hash(), hash);
  }
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

TEST(Recording, HoldsValuesOverTime) {
  const Folder folder;
  folder.write("s.json", R"({"weft": 1, "gravity": {"keys": [[0, 0,-9,0], [0.1, 3,-2,1]]},
      "wind": {"drag": 0.5, "turbulence": 0.3, "velocity": {"keys": [[0, 1,0,0], [0.2, 0,0,4]]}},
      "cloths": [{"grid": {"points": [9, 7]}, "velocity": [0, 1, 0], "spin": [0, 0, 2], "pins": [
        {"at": [0, 0], "follow": 0},
        {"at": [8, 0], "rotate": {"axis": [0,1,0], "about": [0.5,0,0], "keys": [[0, 0], [1, 90]]}}]}],
      "colliders": [{"sphere": {"center": [0.5, -0.4, 0.5], "radius": 0.2},
        "keys": [[0, 0.5,-0.4,0.5], [0.3, 0.6,0,0.5]]}]})");
  ASSERT_EQ(run_weft(folder, "run s.json --frames 12 --record a.rec").exit_code, 0);
  for (const Simd simd : {Simd::scalar, wide_simd()}) {
    const Outcome outcome =
        run_weft(folder, std::string("run --replay a.rec --threads 3 --simd ") + simd_name(simd));
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  }
}

// What is wrong in a line is told with the line, the place in it, and no word of a parser.
TEST(Recording, FaultsAreNamedByLineAndPlace) {
  const Folder folder;
  small_scene(folder);
  ASSERT_EQ(run_weft(folder, "run small.json --frames 3 --record a.rec").exit_code, 0);
  const std::vector<std::string> lines = lines_of(folder.read("a.rec"));
  ASSERT_EQ(lines.size(), 4U);
  const std::string deep(100'000, '[');
  const std::string header = lines[0];
  const auto with_drag = [&](const std::string& value) {
    std::string text = header;
    const std::size_t at = text.find("\"grid\":");
    return text.insert(at, "\"drag\":" + value + ",");
  };
  for (const auto& [number, line, why] :
       std::vector<std::tuple<std::size_t, std::string, std::string>>{
           {1, deep, "nested deeper than 32"},
           {2, deep, "nested deeper than 32"},
           {1, "[]", "no recording"},
           {1, "", "column 1: "},
           {1, R"({"weft_recording": 3})", "no recording"},
           {1, R"({"weft_recording": "1"})", "/weft_recording: "},
           {1, R"({"weft_recording": 1, "seed": -1})", "/seed: -1 is out of place"},
           {1, R"({"weft_recording": 1, "seed": 1})", "\"scene\" is missing"},
           {1, R"({"weft_recording": 1, "seed": 1, "scene": 5})", "/scene: 5 is out of place"},
           {1, with_drag("-1"), "/scene/cloths/0/drag: "},
           {2, R"({"frame": 1, "hash": "xyz"})", "/hash: \"xyz\" is no hash"},
           {2, R"({"frame": 1, "hash": 7})", "/hash: 7 is no hash"},
           {2, R"({"frame": "1"})", "/frame: \"1\" is out of place"},
           {2, R"({"frame": 1e99})", "/frame: "},
           {2, R"([1, 2])", "[1, 2] is out of place"},
           {2, R"({"frame": 0, "jump": {}})", "neither a hash nor an input"},
           {2, R"({"frame": 0, "pin": {"particle": [0]}})", "/pin/particle: [0] is out of"},
           {2, R"({"frame": 0, "pin": {"particle": [0, -1]}})", "/pin/particle/1: -1"},
           {2, R"({"frame": 0, "pin": 3})", "/pin: 3 is out of place"},
           {2, R"({"frame": 0, "carry": {"cloth": 0, "velocity": "up"}})", "/carry/velocity: "},
           {2, R"({"frame": 0, "cut": {"from": [0,0,0], "to": [0,0,"x"]}})", "/cut/to/2: "},
           {3, lines[1], "/frame: 1 is out of order"},
           {3, lines[3], "/frame: 3 is out of order"},
           {4, lines[3].substr(0, 20), "column "}}) {
    std::string text;
    for (std::size_t n = 1; n <= lines.size(); ++n)
      text += (n == number ? line : lines[n - 1]) + "\n";
    folder.write("b.rec", text);
    const Outcome outcome = run_weft(folder, "run --replay b.rec");
    EXPECT_EQ(outcome.exit_code, 3) << line.substr(0, 99);
    EXPECT_TRUE(outcome.err.starts_with("weft: error: --replay: b.rec:" + std::to_string(number)))
        << outcome.err;
    EXPECT_NE(outcome.err.find(why), std::string::npos) << why << "\n" << outcome.err;
    EXPECT_EQ(outcome.err.find("json.exception"), std::string::npos) << outcome.err;
  }
  // A particle that the cloth does not have is found where it is asked for.
  folder.write("b.rec", lines[0] + "\n" + R"({"frame": 0, "pin": {"particle": [0, 9999]}})" + "\n" +
                            lines[1] + "\n");
  const Outcome outcome = run_weft(folder, "run --replay b.rec");
  EXPECT_EQ(outcome.exit_code, 4);
  EXPECT_NE(outcome.err.find("before frame 1: cloth 0 has no particle"), std::string::npos)
      << outcome.err;
}

// Files of version 1 name particles by column and row, of the scene that runs at that time.
TEST(Recording, OfVersion1IsReplayed) {
  const Folder folder;
  small_scene(folder);
  ASSERT_EQ(run_weft(folder, "run small.json --frames 3").exit_code, 0);
  const std::string path = folder.path() + "/a.rec";
  const Scene scene = read_scene(folder.path() + "/small.json").scene;
  Simulation simulation(scene);
  {
    Recorder recorder(path, simulation);
    Input input;
    input.particle = particle_number(scene.cloths[0].grid, 2, 1);
    for (int n = 0; n < 3; ++n) {
      if (n == 1) {
        input.kind = Input::Kind::pin;
        recorder.input(1, input);
        apply(input, simulation);
      }
      simulation.advance_frame();
      recorder.frame(simulation);
    }
    recorder.finish();
  }
  std::string text = folder.read("a.rec");
  const auto replace = [&](const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
  };
  const int number = particle_number(scene.cloths[0].grid, 2, 1);
  replace("\"weft_recording\":2", "\"weft_recording\":1");
  replace("[0," + std::to_string(number) + "]", "[0,2,1]");
  folder.write("old.rec", text);
  const Outcome outcome = run_weft(folder, "run --replay old.rec");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  replace("[0,2,1]", "[0,2,999]");
  folder.write("old.rec", text);
  EXPECT_NE(run_weft(folder, "run --replay old.rec").err.find("/pin/particle/2: 999 is out of"),
            std::string::npos);
  replace("[0,2,999]", "[7,2,1]");
  folder.write("old.rec", text);
  EXPECT_EQ(run_weft(folder, "run --replay old.rec").exit_code, 3);
}

TEST(Recording, AnotherSceneSeedOrLengthIsRefused) {
  const Folder folder;
  small_scene(folder);
  ASSERT_EQ(run_weft(folder, "run small.json --frames 6 --seed 5 --record a.rec").exit_code, 0);
  for (const auto& [arguments, code, why] :
       {std::tuple<std::string, int, std::string>{"--seed 6", 2, "seed 5"},
        {"--frames 7", 2, "only 6 frames"},
        {"--set /cloths/0/drag=1", 3, "differs first at /cloths/0"}}) {
    const Outcome outcome = run_weft(folder, "run small.json --replay a.rec " + arguments);
    EXPECT_EQ(outcome.exit_code, code) << arguments;
    EXPECT_NE(outcome.err.find(why), std::string::npos) << outcome.err;
  }
}

TEST(Recording, WhatIsNoneIsRefused) {
  const Folder folder;
  const std::string scene = small_scene(folder);
  EXPECT_EQ(run_weft(folder, "run --replay nowhere.rec").exit_code, 3);
  EXPECT_EQ(run_weft(folder, "run --replay small.json").exit_code, 3);
  EXPECT_EQ(run_weft(folder, "run --replay .").exit_code, 3);
  const Outcome endless = run_weft(folder, "run --replay /dev/zero", "timeout 60");
  EXPECT_EQ(endless.exit_code, 3);
  EXPECT_NE(endless.err.find("64 MiB"), std::string::npos) << endless.err;
  EXPECT_EQ(run_weft(folder, "run").exit_code, 2);
  ASSERT_EQ(run_weft(folder, "run small.json --frames 2 --record a.rec").exit_code, 0);
  EXPECT_EQ(run_weft(folder, "run hello --replay a.rec").exit_code, 3);
}

}  // namespace
}  // namespace weft
