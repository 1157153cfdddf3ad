#include "examine.h"

#include <algorithm>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <optional>
#include <vector>

#include "failure.h"
#include "hostile.h"
#include "judges.h"
#include "random_mesh.h"
#include "random_scene.h"
#include "weft/estimate.h"
#include "weft/read_scene.h"

namespace fuzz {

using namespace weft;

namespace {

constexpr int kFewFrames = 5;
// s of processor time; what takes longer is run in one other way alone. One scene in a hundred does, and all
// ways of these would take more than half of the time.
constexpr double kLong = 1;
constexpr std::uint64_t kCaseStream = 6'000'000;

Options options_of(const Case& c, Simd simd, int threads) {
  Options options;
  options.simd = simd;
  options.threads = threads;
  options.seed = c.seed;
  return options;
}

// What several looks at a scene find, so that one fault does not hide another.
class Findings {
 public:
  void look(const std::string& what, const std::function<void()>& work) {
    std::fprintf(stderr, "at: %s\n", what.c_str());  // for the case that it crashes
    try {
      work();
    } catch (const Failure& failure) {
      add(failure.what(), what);
    } catch (const std::exception& error) {
      add(std::string("exception: ") + error.what(), what);
    }
  }

  void tell() const {
    if (!text_.empty()) throw Failure(text_);
  }

 private:
  void add(const std::string& found, const std::string& what) {
    text_ += (text_.empty() ? "" : "; ") + found + " (" + what + ")";
  }

  std::string text_;
};

std::string name_of(const Options& options) {
  return std::string(simd_name(options.simd)) + " on " + std::to_string(options.threads) +
         " threads";
}

void require_equal(const Trace& expected, const Trace& found) {
  if (const std::string where = difference(expected, found); !where.empty())
    throw Failure("difference: " + where);
}

// The scene as it comes back from its text, and meshes from their files.
Scene read_back(const Scene& scene, const std::string& folder) {
  const std::string text = write_scene_text(scene);
  SceneFile file = read_scene_text(text);
  std::filesystem::create_directories(folder);
  write_meshes(scene, folder);
  load_meshes(file.scene, folder, file.faults, file.notes);
  std::filesystem::remove_all(folder);
  if (!file.faults.empty())
    throw Failure("scene text: " + file.faults[0].place + ": " + file.faults[0].what);
  if (!(file.scene == scene) || !difference(scene, file.scene).empty())
    throw Failure("scene text: reads as another scene: " + difference(scene, file.scene));
  return file.scene;
}

// What `weft check` says of it.
void expect_estimate(const Scene& scene) {
  const Estimate e = estimate(scene);
  std::int64_t particles = 0;
  for (const Cloth& c : scene.cloths) particles += particle_count(c);
  const bool sound = e.particles == particles && e.substeps > 0 && std::isfinite(e.bytes) &&
                     e.bytes > 0 && std::isfinite(e.run_seconds()) && e.run_seconds() > 0;
  if (!sound)
    throw Failure("estimate: " + bytes_words(e.bytes) + ", " + time_words(e.run_seconds()));
}

// A run with judges; what they find first does not end it.
Trace judged(const Case& c, const Options& options, std::string& found) {
  const auto judge = [&](auto&& work) {
    try {
      if (found.empty()) work();
    } catch (const Failure& failure) {
      found = failure.what();
    }
  };
  Simulation simulation(c.scene, options);
  begin(c, simulation);
  std::optional<Judges> judges;
  judge([&] { judges.emplace(simulation); });
  Trace trace = run(c, simulation, nullptr, [&](const Simulation& s, bool touched) {
    judge([&] { judges->frame(s, touched); });
  });
  judge([&] { judges->end(simulation); });
  return trace;
}

Trace plain(const Case& c, const Options& options) {
  Simulation simulation(c.scene, options);
  begin(c, simulation);
  return run(c, simulation, nullptr, [](const Simulation&, bool) {});
}

// A run that is recorded, and its replay with other options.
void replay(const Case& c, const Trace& expected, const std::string& folder) {
  const std::string path = folder + "/" + std::to_string(c.seed) + ".weft";
  {
    Simulation simulation(c.scene, options_of(c, Simd::best, 2));
    Recorder recorder(path, simulation);
    require_equal(expected, run(c, simulation, &recorder, [](const Simulation&, bool) {}));
    recorder.finish();
  }
  const Recording recording = read_recording(path);
  Options options = options_of(c, Simd::best, 1);
  options.seed = recording.seed;
  Simulation simulation(recording.scene, options);
  for (std::size_t next = 0; next < recording.events.size();) {
    while (const Input* input = next_input(recording, next, simulation)) apply(*input, simulation);
    if (next >= recording.events.size()) break;
    simulation.advance_frame();
    try {
      compare_hash(recording, next, simulation);
    } catch (const RecordingError& error) {
      throw Failure(std::string("replay: ") + error.what());
    }
  }
  std::filesystem::remove(path);
}

Trace go_on(Simulation& simulation, const Snapshot& snapshot, int frames) {
  simulation.restore(snapshot);
  Trace trace{{hash_of(simulation)}, {}};
  for (int n = 0; n < frames; ++n) {
    simulation.advance_frame();
    trace.hashes.push_back(hash_of(simulation));
  }
  trace.status = simulation.status().text;
  return trace;
}

// What follows a snapshot is the same in a new simulation and in the one that it is of.
void restore(const Case& c, int frames) {
  Simulation first(c.scene, options_of(c, Simd::best, 1));
  Simulation second(c.scene, options_of(c, Simd::best, 2));
  for (int n = 0; n < frames; ++n) first.advance_frame();
  const Snapshot snapshot = first.snapshot();
  const Trace expected = go_on(first, snapshot, frames);
  require_equal(expected, go_on(second, snapshot, frames));
}

std::vector<Simd> available() {
  std::vector<Simd> all;
  for (const Simd simd : {Simd::scalar, Simd::sse2, Simd::avx2, Simd::avx512})
    if (simd_available(simd)) all.push_back(simd);
  return all;
}

std::uint64_t sum_of(const Trace& trace) {
  std::uint64_t sum = 0;
  for (const std::uint64_t hash : trace.hashes) sum = sum * 0x9e3779b97f4a7c15u + hash;
  return sum;
}

}  // namespace

std::uint64_t examine(const Case& c, Variants variants, const std::string& folder) {
  const std::vector<Simd> all = available();
  Findings findings;
  Case read = c;
  findings.look("scene text", [&] {
    read.scene = read_back(c.scene, folder + "/" + std::to_string(c.seed) + ".meshes");
  });
  findings.look("estimate", [&] { expect_estimate(c.scene); });
  Trace trace;
  std::string found;
  if (variants == Variants::one) {
    const Options options =
        options_of(c, all[c.seed % all.size()], 1 + int(c.seed / all.size() % 3));
    findings.look(name_of(options), [&] { trace = judged(read, options, found); });
    const int few = std::clamp(int(trace.hashes.size()) - 1, 1, kFewFrames);
    findings.look("hostile use", [&] { mistreat(c, options, few); });
  } else {
    const Options options = options_of(c, Simd::best, 1);
    const std::clock_t start = std::clock();
    findings.look("run", [&] { trace = judged(c, options, found); });
    const bool is_long = double(std::clock() - start) > kLong * CLOCKS_PER_SEC;
    int threads = int(c.seed % 3);
    for (const Simd simd : all) {
      const Options other = options_of(c, simd, 1 + threads++ % 3);
      if (is_long && simd != all[c.seed % all.size()]) continue;
      findings.look(name_of(other), [&] { require_equal(trace, plain(read, other)); });
    }
    if (c.inputs != Inputs::all && c.speed == 0 && !is_long)
      findings.look("replay", [&] { replay(c, trace, folder); });
    // Scenes whose frames are much work get few here, too.
    const int few = std::clamp(int(trace.hashes.size()) - 1, 1, kFewFrames);
    if (!is_long) {
      findings.look("restore", [&] { restore(c, few); });
      findings.look("hostile use", [&] { mistreat(c, options, few); });
    }
  }
  for (std::size_t n = 0; n < trace.hashes.size(); ++n)  // for comparing builds
    std::fprintf(stderr, "frame %zu: %016" PRIx64 "\n", n, trace.hashes[n]);
  findings.look("judges", [&] {
    if (!found.empty()) throw Failure(found);
  });
  findings.tell();
  return sum_of(trace);
}

Case case_of(std::uint64_t seed) {
  Case c{seed, random_scene(seed), inputs_of(seed)};
  Draw draw(seed, kCaseStream);
  if (c.inputs == Inputs::none && draw.chance(0.5)) c.speed = draw.decades(1e-3, 30);
  return c;
}

}  // namespace fuzz
