// `weft run SCENE`: simulates, and writes what was asked for.
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>

#include "commands.h"
#include "failure.h"
#include "files.h"
#include "needs.h"
#include "progress.h"
#include "recordings.h"
#include "scene_argument.h"
#include "weft/interrupt.h"
#include "weft/output.h"
#include "weft/printable.h"
#include "weft/takeover.h"
#include "weft/tolerance.h"

namespace weft::cli {

namespace {

struct RunArguments {
  SceneArgument scene;
  std::optional<double> seconds;
  std::optional<std::int64_t> frames;
  std::optional<double> tolerance;
  std::string resolution;  // "auto", or nothing
  int threads = 0;
  std::string simd = "best";
  std::optional<std::uint64_t> seed;
  FileNames files;
};

// A check of an option's text: the whole of it is a number from `least` to `most`.
template <class T>
CLI::Validator number_in(T least, T most, const std::string& allowed) {
  const auto fault = [=](const std::string& text) -> std::string {
    T value{};
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    const bool good = error == std::errc() && stop == end && value >= least && value <= most;
    return good ? "" : "'" + text + "' is out of place here (" + allowed + ")";
  };
  return {fault, ""};
}

CLI::Validator one_of(const std::vector<std::string>& words) {
  const auto fault = [=](const std::string& text) -> std::string {
    if (std::ranges::find(words, text) != words.end()) return "";
    return "'" + text + "' is none of the choices (" + list(words) + ")";
  };
  return {fault, ""};
}

std::string fault_of_animation(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  const std::vector<std::string> known = animation_extensions();
  if (std::ranges::find(known, extension) != known.end()) return "";
  return "'" + path + "' does not end in a format that can be written (" + list(known) + ")";
}

const std::vector<std::string>& simd_names() {
  static const std::vector<std::string> names{simd_name(Simd::scalar), simd_name(Simd::sse2),
                                              simd_name(Simd::avx2), simd_name(Simd::avx512)};
  return names;
}

Simd parse_simd(const std::string& name) {
  std::vector<std::string> available;
  for (const Simd simd : {Simd::scalar, Simd::sse2, Simd::avx2, Simd::avx512}) {
    if (simd_available(simd)) {
      if (name == simd_name(simd)) return simd;
      available.emplace_back(simd_name(simd));
    }
  }
  if (name == "best") return Simd::best;
  throw Failure{kBadCommandLine,
                {{"--simd", "this build or machine does not run " + name, list(available)}}};
}

std::int64_t frame_count(const RunArguments& arguments, const Time& time,
                         const std::optional<Recording>& replayed) {
  if (arguments.frames) return *arguments.frames;
  if (replayed && !arguments.seconds) return replayed->frames();
  return std::llround(arguments.seconds.value_or(time.seconds) / time.frame);
}

// Puts what keeps the asked error into the scene, and says so.
void choose(LoadedScene& loaded, const Tolerance& tolerance, const Options& options) {
  require_memory(loaded.scene, "--tolerance");
  try {
    Choice choice = weft::choose(loaded.scene, tolerance, options);
    std::cout << to_text(choice, tolerance);
    if (choice.best >= 0) {
      const Trial& best = choice.trials[std::size_t(choice.best)];
      loaded.notes.push_back("--tolerance: " + best.method + ", " + to_text(best));
    }
    loaded.scene = std::move(choice.scene);
    for (const std::string& note : choice.notes) loaded.notes.push_back("--tolerance: " + note);
  } catch (const SceneError& error) {
    throw Failure{kBadScene, error.faults};
  } catch (const std::invalid_argument& refused) {
    throw Failure{
        kBadCommandLine,
        {{"--tolerance", refused.what(),
          "grids of method spring, spring_friction or compliant; meshes without --resolution"}}};
  }
}

// The scene of the arguments, which a recording carries itself.
LoadedScene scene_to_run(const RunArguments& arguments, const std::optional<Recording>& replayed) {
  if (!replayed) {
    if (arguments.scene.scene.empty())
      throw Failure{kBadCommandLine,
                    {{"command line", "SCENE is required", "a scene, or --replay"}}};
    return load(arguments.scene);
  }
  const auto differs = [&](int code, const std::string& why) {
    return Failure{code, {{arguments.files.replay, why, ""}}};
  };
  if (!arguments.scene.scene.empty())
    if (const std::string place = difference(replayed->scene, load(arguments.scene).scene);
        !place.empty())
      throw differs(kBadScene,
                    "the recording is of another scene, which differs first at " + place);
  if (arguments.seed && *arguments.seed != replayed->seed)
    throw differs(kBadCommandLine, "it was recorded with seed " + std::to_string(replayed->seed));
  if (frame_count(arguments, replayed->scene.time, replayed) > replayed->frames())
    throw differs(kBadCommandLine, "it has only " + std::to_string(replayed->frames()) + " frames");
  return {replayed->scene, arguments.files.replay};
}

// Ends a run within a frame; the recording and the animation hold the frames before it.
[[noreturn]] void end_within_frame(Files& files, std::int64_t done, std::int64_t frames) {
  int code = 128 + interrupted();
  try {
    files.finish_within_frame();
    std::string text = "weft: interrupted within frame " + std::to_string(done + 1) + " of " +
                       std::to_string(frames) + "\n";
    if (!files.written().empty()) text += "weft: written: " + list(files.written()) + "\n";
    if (!files.missing().empty())
      text +=
          "weft: not written, for want of the end of the frame: " + list(files.missing()) + "\n";
    std::cerr << text;
  } catch (const WriteError& error) {
    print({{error.path, error.what(), ""}});
    code = kNotWritten;
  } catch (const std::exception& error) {  // there is nobody else on this thread to tell
    print({{"internal", error.what(), ""}});
    code = kStopped;
  }
  remove_temporaries();
  std::_Exit(code);
}

// All frames, or those until a signal; then the files. `read_with`: notes from before the run.
Report advance(Simulation& simulation, std::int64_t frames, Recordings& recordings, Files& files,
               Takeover& takeover, const std::vector<std::string>& read_with) {
  std::int64_t done = 0;
  takeover.on_interrupt([&] { end_within_frame(files, done, frames); });
  const struct Stop {
    Takeover& takeover;
    ~Stop() { takeover.stop(); }
  } stop{takeover};  // an exception too leaves nothing that `end` could work on
  Progress progress(frames, simulation.scene().time.frame);
  while (done < frames && interrupted() == 0) {
    {
      const auto hold = takeover.hold();
      recordings.before_frame(simulation);
    }
    simulation.advance_frame();
    if (!simulation.status().ok) break;
    const auto hold = takeover.hold();
    files.frame(simulation);
    progress.update(++done);
  }
  Report report = simulation.report();
  report.notes.insert(report.notes.begin(), read_with.begin(), read_with.end());
  if (simulation.status().ok && done < frames) {
    report.status.ok = false;
    report.status.text = "interrupted after frame " + std::to_string(simulation.frame());
  }
  takeover.stop();
  files.finish(simulation, report);
  return report;
}

// To a person at a terminal.
void print_trial(const std::string& run) {
  if (::isatty(STDOUT_FILENO) == 1) std::cout << "trying " << run << std::endl;
}

int run(const RunArguments& arguments) {
  Recordings recordings(arguments.files.record, arguments.files.replay);
  const std::optional<Recording>& replayed = recordings.replayed();
  LoadedScene loaded = scene_to_run(arguments, replayed);
  const std::int64_t frames = frame_count(arguments, loaded.scene.time, replayed);
  refuse_clashes(arguments.files, replayed ? arguments.scene.scene : loaded.path, frames + 1);
  Options options;
  options.threads = arguments.threads;
  options.simd = parse_simd(arguments.simd);
  options.seed = replayed ? replayed->seed : arguments.seed.value_or(options.seed);
  options.profile = options.follow_strain = !arguments.files.report.empty();
  if (arguments.tolerance && replayed)
    throw Failure{kBadCommandLine,
                  {{"--tolerance", "a recording carries its own solver", "not with --replay"}}};
  if (arguments.tolerance)
    choose(loaded,
           {*arguments.tolerance, double(frames) * loaded.scene.time.frame,
            !arguments.resolution.empty(), print_trial},
           options);
  catch_interrupts();  // before there is a temporary file that a signal could leave behind
  Takeover takeover;
  Simulation simulation = simulate(loaded, options);
  Files files(arguments.files, simulation, frames, recordings);
  std::vector<std::string> notes;
  for (const std::string& note : loaded.notes) notes.push_back(printable(note));
  const Report report = advance(simulation, frames, recordings, files, takeover, notes);
  std::cout << summary(report, report.notes, files.written());
  if (!simulation.status().ok) {
    const std::string why = "the simulation stopped itself: " + simulation.status().text;
    throw Failure{kStopped, {{loaded.path, why, ""}}};
  }
  if (!report.status.ok) {
    std::cerr << "weft: " << report.status.text << " of " << frames << "\n";
    return 128 + interrupted();
  }
  return kDone;
}

void add_duration(CLI::App& command, RunArguments& arguments) {
  constexpr double kLongest = 1e9;
  CLI::Option* seconds = command
                             .add_option("--seconds", arguments.seconds,
                                         "How long to simulate (default: as the scene says)")
                             ->type_name("T")
                             ->check(number_in(0.0, kLongest, "seconds, 0 to 1e9"));
  command.add_option("--frames", arguments.frames, "The same as a number of frames")
      ->type_name("N")
      ->check(number_in<std::int64_t>(0, 1'000'000'000, "a whole number from 0 to 1000000000"))
      ->excludes(seconds);
}

}  // namespace

void add_run(CLI::App& program, int& exit_code) {
  CLI::App* command = program.add_subcommand("run", "Simulate a scene");
  const auto arguments = std::make_shared<RunArguments>();
  add_scene_argument(*command, arguments->scene);
  command->get_option("SCENE")->required(false);
  add_duration(*command, *arguments);
  command
      ->add_option("--threads", arguments->threads,
                   "Worker threads (default: all cores); never changes the result")
      ->type_name("P")
      ->check(number_in(1, 256, "a whole number from 1 to 256"));
  command
      ->add_option("--simd", arguments->simd,
                   "Instruction set: " + list(simd_names()) +
                       " (default: the widest); never changes the result")
      ->type_name("SET")
      ->check(one_of(simd_names()));
  CLI::Option* const tolerance =
      command
          ->add_option(
              "--tolerance", arguments->tolerance,
              "Pick method, substeps and sweeps for this error of the positions, by trial runs")
          ->type_name("M")
          ->check(number_in(1e-6, 1.0, "m, 1e-6 to 1"));
  command
      ->add_option("--resolution", arguments->resolution,
                   "With --tolerance: auto picks the grids as well, for that error against the "
                   "sheet behind them")
      ->type_name("auto")
      ->check(one_of({"auto"}))
      ->needs(tolerance);
  command->add_option("--seed", arguments->seed, "Seeds every random choice (default: 1)")
      ->type_name("N")
      ->check(
          number_in<std::uint64_t>(0, UINT64_MAX, "a whole number from 0 to 18446744073709551615"));
  command->add_option("--report", arguments->files.report, "Write what was measured, as JSON")
      ->type_name("FILE.json");
  command
      ->add_option("--dump", arguments->files.dump,
                   "Write the final positions as raw little-endian float64 x,y,z")
      ->type_name("FILE.f64");
  command
      ->add_option("--export", arguments->files.animation,
                   "Write the animation: FILE.pc2 or FILE.mdd (point caches), FILE.obj "
                   "(FILE_0000.obj, …), FILE.glb or FILE.gltf (morph targets), FILE.usda (time "
                   "samples)")
      ->type_name("FILE")
      ->check(CLI::Validator(fault_of_animation, ""));
  command
      ->add_option("--record", arguments->files.record,
                   "Record the run: the scene, the inputs and the hash of every frame")
      ->type_name("FILE");
  command
      ->add_option("--replay", arguments->files.replay,
                   "Replay a recording (SCENE may be left out); fails at the first frame that "
                   "differs")
      ->type_name("FILE");
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace weft::cli
