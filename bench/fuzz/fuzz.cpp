// fuzz: valid scenes at random, run in every way that must not matter (docs/fuzzing.md).
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "campaign.h"
#include "minimise.h"
#include "random_mesh.h"
#include "random_scene.h"
#include "weft/read_scene.h"

namespace {

using namespace fuzz;

weft::Scene scene_of_file(const std::string& path) {
  weft::SceneFile file = weft::read_scene(path);
  if (!file.faults.empty())
    throw std::invalid_argument(path + file.faults[0].place + ": " + file.faults[0].what);
  return std::move(file.scene);
}

// A scene that fails, made smaller, and how it is run again.
void minimise(const Case& c, const Settings& settings) {
  std::filesystem::create_directories(settings.folder);
  const std::string path = settings.folder + "/" + std::to_string(c.seed) + ".min.json";
  write_meshes(c.scene, settings.folder);
  const auto keep = [&](const Case& smaller) {
    std::ofstream(path) << weft::write_scene_text(smaller.scene);
  };
  const Trial trial = [&](const Case& one) { return examined_apart(one, settings).answer; };
  const Case least = minimised(c, trial, keep);
  keep(least);
  std::printf("%s\nfuzz --here %llu --scene %s%s\n", trial(least).c_str(),
              static_cast<unsigned long long>(c.seed), path.c_str(),
              least.inputs == Inputs::none && least.speed == 0 ? " --alone" : "");
}

struct Wanted {
  std::uint64_t show = 0, here = 0, minimise = 0;
  std::string scene;
  bool one = false, alone = false;
};

void add_options(CLI::App& app, Settings& s, Wanted& w) {
  app.add_option("--first", s.first, "seed of the first scene")->capture_default_str();
  app.add_option("--count", s.count, "scenes")->capture_default_str();
  app.add_option("--seconds", s.seconds, "starts no scene after so many seconds");
  app.add_option("--limit", s.limit, "seconds of processor time that one scene may take")
      ->capture_default_str();
  app.add_option("--jobs", s.jobs, "scenes at once")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  app.add_option("--log", s.log, "adds a line for every scene to this file");
  app.add_flag("--resume", s.resume, "leaves out the seeds that the log has already");
  app.add_option("--compare", s.compare, "results must be those of another build's log")
      ->check(CLI::ExistingFile);
  app.add_option("--quick", s.quick, "leaves out scenes that took the other build more ms")
      ->needs("--compare");
  app.add_option("--folder", s.folder, "where scenes that fail are written")->capture_default_str();
  app.add_flag("--one", w.one, "runs each scene once, in one of the ways that must not matter");
  app.add_option("--show", w.show, "prints the scene of a seed, and writes its meshes here");
  app.add_option("--here", w.here, "examines the scene of a seed in this process");
  app.add_option("--minimise", w.minimise,
                 "makes the scene of a seed smaller while it fails alike");
  app.add_option("--scene", w.scene,
                 "for --here, --minimise: this file in place of the seed's scene");
  app.add_flag("--alone", w.alone, "for --here, --minimise: without inputs");
}

int run(const CLI::App& app, const Settings& settings, const Wanted& w) {
  if (app.count("--show") > 0) {
    write_meshes(random_scene(w.show), ".");
    std::fputs(weft::write_scene_text(random_scene(w.show)).c_str(), stdout);
    return 0;
  }
  const bool here = app.count("--here") > 0, smaller = app.count("--minimise") > 0;
  if (!here && !smaller) return Campaign(settings).run();
  Case c = case_of(here ? w.here : w.minimise);
  if (!w.scene.empty()) c.scene = scene_of_file(w.scene);
  if (w.alone) c.inputs = Inputs::none, c.speed = 0;
  if (smaller)
    minimise(c, settings);
  else
    std::puts(examined(c, settings.variants, ".").c_str());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"fuzz: valid scenes at random, run in every way that must not matter", "fuzz"};
  Settings settings;
  Wanted wanted;
  add_options(app, settings, wanted);
  CLI11_PARSE(app, argc, argv);
  try {
    settings.variants = wanted.one ? Variants::one : Variants::all;
    return run(app, settings, wanted);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "fuzz: %s\n", error.what());
    return 2;
  }
}
