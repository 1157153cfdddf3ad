// fuzz: valid scenes at random, run in every way that must not matter (docs/fuzzing.md).
#include <CLI/CLI.hpp>
#include <chrono>
#include <cinttypes>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <list>
#include <memory>
#include <sstream>
#include <thread>

#include "child.h"
#include "examine.h"
#include "failure.h"
#include "log.h"
#include "random_scene.h"
#include "weft/read_scene.h"

namespace {

struct Settings {
  std::uint64_t first = 0, count = 100;
  double seconds = 0;  // 0: no end
  double limit = 120;  // s, of one scene
  int jobs = 1;
  bool resume = false;
  fuzz::Variants variants = fuzz::Variants::all;
  std::string log, compare, folder = "fuzz_failures";
};

std::string sixteen(std::uint64_t hash) {
  char text[17];
  std::snprintf(text, sizeof text, "%016" PRIx64, hash);
  return text;
}

std::uint64_t text_hash(const std::string& text) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return hash;
}

// In the child: "SCENE RESULT ANSWER".
std::string examined(const fuzz::Case& c, fuzz::Variants variants, const std::string& folder) {
  const std::string scene = sixteen(text_hash(weft::write_scene_text(c.scene)));
  try {
    return scene + " " + sixteen(fuzz::examine(c, variants, folder)) + " ok";
  } catch (const fuzz::Failure& failure) {
    return scene + " 0 " + failure.what();
  } catch (const std::exception& error) {
    return scene + " 0 exception: " + error.what();
  }
}

fuzz::Case case_of_file(const std::string& path) {
  weft::SceneFile file = weft::read_scene(path);
  if (!file.faults.empty())
    throw std::invalid_argument(path + file.faults[0].place + ": " + file.faults[0].what);
  return {1, std::move(file.scene)};
}

fuzz::Entry entry_of(const std::string& answer, double seconds) {
  fuzz::Entry e;
  e.ms = 1e3 * seconds;
  std::istringstream words(answer);
  if (words >> std::hex >> e.scene >> e.result >> std::ws) {
    std::getline(words, e.answer);
  } else {
    e.scene = 0;
    e.answer = answer;
  }
  for (char& c : e.answer)
    if (c == '\n') c = ' ';
  return e;
}

// What a child that ended early was at, and the sanitizers' summary.
std::string last_words(const std::string& path) {
  std::string place, summary;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("at: ")) place = " (" + line.substr(4) + ")";
    if (line.find("runtime error: ") != std::string::npos || line.starts_with("SUMMARY: "))
      summary = summary.empty() ? " " + line : summary;
  }
  return place + summary;
}

class Campaign {
 public:
  explicit Campaign(Settings settings)
      : settings_(std::move(settings)),
        log_(settings_.log),
        other_(fuzz::read_log(settings_.compare)) {
    if (settings_.resume) done_ = fuzz::read_log(settings_.log);
    for (const auto& [seed, entry] : done_) count(seed, entry);
    std::filesystem::create_directories(settings_.folder);
  }

  int run() {
    std::uint64_t next = settings_.first;
    while (true) {
      while (int(running_.size()) < settings_.jobs && more(next)) start(next++);
      if (running_.empty()) break;
      collect();
    }
    std::printf("%d scenes, %d failed; the slowest, %" PRIu64
                ", took %.1f s; %.1f scenes a second\n",
                all_, failed_, slowest_, slowest_ms_ / 1e3, double(fresh_) / elapsed());
    return failed_ > 0 ? 1 : 0;
  }

 private:
  struct Running {
    std::uint64_t seed;
    std::unique_ptr<fuzz::Child> child;
  };

  std::string file(std::uint64_t seed, const char* extension) const {
    return settings_.folder + "/" + std::to_string(seed) + extension;
  }

  double elapsed() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

  // Moves on to the next seed that is to be run, if any.
  bool more(std::uint64_t& next) const {
    if (settings_.seconds > 0 && elapsed() > settings_.seconds) return false;
    const auto wanted = [&] {
      return !done_.contains(next) && (settings_.compare.empty() || other_.contains(next));
    };
    const std::uint64_t end = settings_.first + settings_.count;
    while (next < end && !wanted()) ++next;
    return next < end;
  }

  void start(std::uint64_t seed) {
    const auto work = [seed, this] {
      return examined(fuzz::case_of(seed), settings_.variants, settings_.folder);
    };
    running_.push_back({seed, std::make_unique<fuzz::Child>(work, file(seed, ".txt"))});
  }

  void collect() {
    for (auto r = running_.begin(); r != running_.end();) {
      const auto answer = r->child->answer(settings_.limit);
      if (!answer) {
        ++r;
        continue;
      }
      fuzz::Entry entry = entry_of(*answer, r->child->seconds());
      if (entry.scene == 0) entry.answer += last_words(file(r->seed, ".txt"));
      compare(r->seed, entry);
      log_.add(r->seed, entry);
      ++fresh_;
      count(r->seed, entry);
      finish(r->seed, entry);
      r = running_.erase(r);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }

  void compare(std::uint64_t seed, fuzz::Entry& entry) const {
    const auto other = other_.find(seed);
    if (other == other_.end() || !entry.ok() || !other->second.ok()) return;
    if (other->second.scene != entry.scene)
      entry.answer = "difference: the scene is another one in " + settings_.compare;
    else if (other->second.result != entry.result)
      entry.answer = "difference: the result is another one in " + settings_.compare;
  }

  void count(std::uint64_t seed, const fuzz::Entry& entry) {
    ++all_;
    failed_ += !entry.ok();
    if (entry.ms > slowest_ms_) slowest_ = seed, slowest_ms_ = entry.ms;
  }

  // Keeps the scene of a failure, and what was said.
  void finish(std::uint64_t seed, const fuzz::Entry& entry) const {
    if (entry.ok()) {
      std::filesystem::remove(file(seed, ".txt"));
      return;
    }
    std::printf("seed %" PRIu64 ": %s\n", seed, entry.answer.c_str());
    std::fflush(stdout);
    std::ofstream(file(seed, ".json")) << weft::write_scene_text(fuzz::random_scene(seed));
  }

  Settings settings_;
  fuzz::Log log_;
  std::map<std::uint64_t, fuzz::Entry> other_, done_;
  std::list<Running> running_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  int all_ = 0, failed_ = 0, fresh_ = 0;
  std::uint64_t slowest_ = 0;
  double slowest_ms_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"fuzz: valid scenes at random, run in every way that must not matter", "fuzz"};
  Settings s;
  bool one = false;
  std::uint64_t show = 0, here = 0;
  std::string scene;
  app.add_option("--first", s.first, "seed of the first scene")->capture_default_str();
  app.add_option("--count", s.count, "scenes")->capture_default_str();
  app.add_option("--seconds", s.seconds, "starts no scene after so many seconds");
  app.add_option("--limit", s.limit, "seconds that one scene may take")->capture_default_str();
  app.add_option("--jobs", s.jobs, "scenes at once")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  app.add_option("--log", s.log, "adds a line for every scene to this file");
  app.add_flag("--resume", s.resume, "leaves out the seeds that the log has already");
  app.add_option("--compare", s.compare, "results must be those of another build's log");
  app.add_option("--folder", s.folder, "where scenes that fail are written")->capture_default_str();
  app.add_flag("--one", one, "runs each scene once, in one of the ways that must not matter");
  CLI::Option* shown = app.add_option("--show", show, "prints the scene of a seed");
  CLI::Option* one_here = app.add_option("--here", here, "examines a seed in this process");
  app.add_option("--scene", scene, "examines a scene file in this process, without inputs");
  CLI11_PARSE(app, argc, argv);
  try {
    if (*shown) {
      std::puts(weft::write_scene_text(fuzz::random_scene(show)).c_str());
      return 0;
    }
    s.variants = one ? fuzz::Variants::one : fuzz::Variants::all;
    if (*one_here || !scene.empty()) {
      const fuzz::Case c = scene.empty() ? fuzz::case_of(here) : case_of_file(scene);
      std::puts(examined(c, s.variants, ".").c_str());
      return 0;
    }
    return Campaign(s).run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "fuzz: %s\n", error.what());
    return 2;
  }
}
