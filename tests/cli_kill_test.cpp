// A run that is killed at a random moment leaves each file old or new, a .gltf with its own .bin, and
// nothing else; what only SIGKILL leaves behind, the next run removes. WEFT_KILLS says how many
// (600: some minutes), WEFT_KILL_SEED which.
#include <array>
#include <cstdio>
#include <random>
#include <set>

#include "killed_run.h"

namespace weft {
namespace {

constexpr int kFrames = 24;

int from_environment(const char* name, int other) {
  const char* const text = std::getenv(name);
  return text != nullptr ? std::atoi(text) : other;
}

struct Output {
  const char* option;
  const char* name;
};
constexpr std::array<Output, 9> kOutputs{{{"--export", "a.pc2"},
                                          {"--export", "b.mdd"},
                                          {"--export", "c.obj"},
                                          {"--export", "d.gltf"},
                                          {"--export", "e.glb"},
                                          {"--export", "i.usda"},
                                          {"--dump", "f.f64"},
                                          {"--report", "g.json"},
                                          {"--record", "h.rec"}}};
constexpr std::size_t kAnimations = 6;  // the first of them, of which a run writes one
constexpr std::array<int, 6> kSignals{SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE, SIGKILL};

class Kills : public testing::Test {
 protected:
  Kills() {
    folder.write("scene.json", R"({"weft": 1, "name": "killed",
      "time": {"frame": 0.02, "substeps": 60}, "solver": {"method": "compliant"},
      "cloths": [{"grid": {"points": [24, 24], "u": [1, 0, 0], "v": [0, 0, 1]}, "pins": [[0, 0]]}]})");
  }

  // The options for some outputs, one animation among them at most.
  static std::vector<std::string> words(bool fresh, const std::vector<Output>& outputs) {
    std::vector<std::string> all{"run", "scene.json", "--threads",
                                 "1",   "--frames",   std::to_string(kFrames)};
    if (fresh) all.insert(all.end(), {"--set", "/gravity=[1,-5,0]"});
    for (const Output& output : outputs) all.insert(all.end(), {output.option, output.name});
    return all;
  }
  Truth truth_of(bool fresh) const {
    EXPECT_EQ(wait_for(start_weft(folder, words(fresh, {kOutputs[0], kOutputs.back()}))), 0);
    return {folder.read("a.pc2"), folder.read("h.rec")};
  }
  std::set<std::string> names() const {
    std::set<std::string> all;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
      all.insert(entry.path().filename().string());
    return all;
  }
  static std::string sample_name(std::size_t sample) {
    const std::string digits = std::to_string(sample);
    return "c_" + std::string(4 - digits.size(), '0') + digits + ".obj";
  }

  // Whether an output is all of one run.
  static bool good(const Output& output, const Judge& judge) {
    switch (output.name[0]) {
      case 'a':
        return judge.pc2(output.name);
      case 'b':
        return judge.mdd(output.name);
      case 'd':
      case 'e':
        return judge.gltf(output.name);
      case 'i':
        return judge.usda(output.name);
      case 'f':
        return judge.dump(output.name);
      case 'g':
        return judge.report(output.name);
      default:
        return judge.record(output.name);
    }
  }
  // Each file of a sequence is whole, and new ones come first.
  void expect_sequence(const Judge& old_files, const Judge& new_files) const {
    bool fresh = true;
    for (std::size_t s = 0; s <= kFrames; ++s) {
      fresh = fresh && new_files.obj(sample_name(s), s);
      EXPECT_TRUE(fresh || old_files.obj(sample_name(s), s)) << sample_name(s);
    }
  }

  Folder folder;
};

TEST_F(Kills, LeaveOldOrNewFilesAndNothingElse) {
  const Truth old_truth = truth_of(false), new_truth = truth_of(true);
  const Judge old_files(folder, old_truth), new_files(folder, new_truth);
  std::mt19937 random(static_cast<unsigned>(from_environment("WEFT_KILL_SEED", 1)));
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
  const int kills = from_environment("WEFT_KILLS", 36);
  int killed = 0, kept = 0, debris = 0;
  for (int kill = 0; kill < kills; ++kill) {
    for (const std::string& name : names())
      if (name != "scene.json") std::filesystem::remove_all(folder / name);
    std::vector<Output> outputs{kOutputs[static_cast<std::size_t>(kill) % kAnimations]};
    for (std::size_t n = kAnimations; n < kOutputs.size(); ++n)
      if (below(2) == 0) outputs.push_back(kOutputs[n]);
    const int signal = kSignals[static_cast<std::size_t>(kill) / kAnimations % kSignals.size()];
    SCOPED_TRACE("kill " + std::to_string(kill) + ", signal " + std::to_string(signal) + ", " +
                 outputs[0].name);

    const auto start = Clock::now();
    ASSERT_EQ(wait_for(start_weft(folder, words(false, outputs))), 0);
    const double whole = std::chrono::duration<double>(Clock::now() - start).count();  // s
    const std::set<std::string> before = names();
    // Anywhere in the run, or where files take their names.
    const FirstRename renames(folder);
    const pid_t child = start_weft(folder, words(true, outputs));
    if (below(2) == 0) {
      std::this_thread::sleep_for(
          std::chrono::duration<double>(1.1 * whole * static_cast<double>(below(1000)) / 1000));
    } else {
      renames.wait(child);
      const auto until = Clock::now() + std::chrono::microseconds(below(400));
      while (Clock::now() < until) {
      }
    }
    ::kill(child, signal);
    const int status = wait_for(child);
    killed += WIFSIGNALED(status) ? 1 : 0;

    for (const Output& output : outputs) {
      if (output.name[0] == 'c') {
        expect_sequence(old_files, new_files);
        continue;
      }
      const bool is_new = good(output, new_files);
      EXPECT_TRUE(is_new || good(output, old_files)) << output.name;
      kept += is_new ? 0 : 1;
    }
    const std::set<std::string> after = names();
    if (signal != SIGKILL) {
      EXPECT_EQ(after, before);
      continue;
    }
    debris += after != before ? 1 : 0;
    ASSERT_EQ(wait_for(start_weft(folder, words(true, outputs))), 0);
    EXPECT_EQ(names(), before);
  }
  std::printf(
      "%d kills, %d ended by the signal itself, %d old files kept, SIGKILL left something %d "
      "times\n",
      kills, killed, kept, debris);
  EXPECT_GT(killed, 0);
}

}  // namespace
}  // namespace weft
