// `weft study STUDY.json --out FILE.h5`: many runs of one scene into one table.
#include "study/study.h"

#include <unistd.h>

#include <charconv>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <sstream>

#include "commands.h"
#include "failure.h"
#include "study/results.h"
#include "weft/estimate.h"
#include "weft/interrupt.h"
#include "weft/printable.h"

namespace weft::cli {

namespace {

struct StudyArguments {
  std::string study, out, shard;
  std::vector<std::string> merge;
  bool resume = false;
  int jobs = 0;
};

Shard parse_shard(const std::string& text) {
  if (text.empty()) return {};
  Shard shard;
  const char* const end = text.data() + text.size();
  const auto [slash, first] = std::from_chars(text.data(), end, shard.number);
  const bool whole = first == std::errc() && slash != end && *slash == '/';
  const auto [stop, second] = std::from_chars(whole ? slash + 1 : end, end, shard.of);
  if (!whole || second != std::errc() || stop != end || shard.number < 1 || shard.number > shard.of)
    throw Failure{kBadCommandLine,
                  {{"--shard", "'" + text + "' is no K/N", "such as 3/10: K from 1 to N"}}};
  --shard.number;
  return shard;
}

Study read_study(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream bytes;
  bytes << file.rdbuf();
  if (!file || std::filesystem::is_directory(path))
    throw Failure{kBadScene, {{path, "the file cannot be read", "a STUDY file"}}};
  try {
    return {bytes.str(), std::filesystem::path(path).parent_path().string()};
  } catch (const StudyError& error) {
    std::vector<Fault> faults = error.faults;
    for (Fault& f : faults) f.place = path + (f.place.empty() ? "" : ":" + f.place);
    throw Failure{kBadScene, faults};
  }
}

// One line a second on a terminal.
class StudyProgress {
 public:
  void operator()(std::uint64_t done, std::uint64_t all, std::uint64_t before) {
    const Clock::time_point now = Clock::now();
    if (::isatty(STDOUT_FILENO) != 1 || now - last_ < std::chrono::seconds(1)) return;
    last_ = now;
    const double seconds = std::chrono::duration<double>(now - start_).count();
    const double left = seconds * double(all - done) / double(done - before);
    std::cout << "run " << done << " of " << all << "  " << 100 * done / all << " %  "
              << time_words(left) << " left" << std::endl;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now(), last_ = start_;
};

int merge(const StudyArguments& arguments) {
  if (!arguments.study.empty() || arguments.resume || !arguments.shard.empty())
    throw Failure{
        kBadCommandLine,
        {{"--merge", "it goes with --out alone", "weft study --merge A.h5 B.h5 --out ALL.h5"}}};
  merge_study(arguments.merge, arguments.out);
  std::cout << "wrote     " << printable(arguments.out) << "\n";
  return kDone;
}

int run(const StudyArguments& arguments) {
  if (arguments.study.empty())
    throw Failure{kBadCommandLine,
                  {{"command line", "STUDY is required", "a STUDY file, or --merge"}}};
  const Study study = read_study(arguments.study);
  StudyOptions options{.path = arguments.out,
                       .shard = parse_shard(arguments.shard),
                       .resume = arguments.resume,
                       .jobs = arguments.jobs};
  catch_interrupts();
  options.keep_going = [] { return interrupted() == 0; };
  options.progress = StudyProgress();
  const std::uint64_t runs = options.shard.runs(study);
  std::cout << "study     " << runs << " runs of " << study.runs() << "\n" << std::flush;
  if (!run_study(study, options)) {
    std::cerr << "weft: interrupted; what is finished is in " << printable(arguments.out)
              << ".runs, and --resume goes on\n";
    return 128 + interrupted();
  }
  std::cout << "wrote     " << printable(arguments.out) << "\n";
  return kDone;
}

int study(const StudyArguments& arguments) {
  try {
    return arguments.merge.empty() ? run(arguments) : merge(arguments);
  } catch (const StudyError& error) {
    throw Failure{kBadCommandLine, error.faults};
  }
}

}  // namespace

void add_study(CLI::App& program, int& exit_code) {
  CLI::App* command =
      program.add_subcommand("study", "Run a scene with many values; one table, in HDF5");
  const auto arguments = std::make_shared<StudyArguments>();
  command->add_option("STUDY", arguments->study, "A STUDY file (docs/studies.md)")->type_name("");
  command->add_option("--out", arguments->out, "The file to write")
      ->required()
      ->type_name("FILE.h5");
  command->add_option("--shard", arguments->shard, "Only every Nth run, from the Kth on")
      ->type_name("K/N");
  command->add_flag("--resume", arguments->resume, "Go on with a study that was cut off");
  command
      ->add_option("--jobs", arguments->jobs,
                   "Runs at a time (default: all cores); never changes the result")
      ->type_name("P")
      ->check(CLI::Range(1, 256));
  command->add_option("--merge", arguments->merge, "Make one file of those of all shards")
      ->type_name("FILE.h5");
  command->callback([arguments, &exit_code] { exit_code = study(*arguments); });
}

}  // namespace weft::cli
