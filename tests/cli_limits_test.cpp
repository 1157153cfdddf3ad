// What `weft` does where the machine gives less than a run asks for: threads, memory, time.
#include <fcntl.h>
#include <grp.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include "program.h"
#include "weft/estimate.h"
#include "weft/read_scene.h"
#include "weft/simulation.h"

namespace weft {
namespace {

constexpr int kNotStarted = 126;
constexpr unsigned kNobody = 65534;

struct Ended {
  int exit_code = -1;  // -1: by a signal
  std::string out, err;
  double peak_bytes = 0;
};

// Runs the program with at most so many processes and threads of its user; 0: as many as there are.
// Root, whom that does not bind, becomes nobody.
Ended run_with(const Folder& folder, const std::vector<std::string>& words, rlim_t processes = 0) {
  const Folder::Captured captured = folder.capture();
  const pid_t child = fork();
  if (child == 0) {
    dup2(open(captured.out.c_str(), O_WRONLY | O_CREAT, 0600), STDOUT_FILENO);
    dup2(open(captured.err.c_str(), O_WRONLY | O_CREAT, 0600), STDERR_FILENO);
    if (processes > 0) {
      if (geteuid() == 0 && (setgroups(0, nullptr) != 0 || setgid(kNobody) != 0 ||
                             setuid(kNobody) != 0 || chdir("/") != 0))
        _exit(kNotStarted);
      setenv("ASAN_OPTIONS", "detect_leaks=0", 1);  // looking for leaks takes a process of its own
      const rlimit limit{processes, processes};
      setrlimit(RLIMIT_NPROC, &limit);
    }
    std::vector<char*> arguments{const_cast<char*>(WEFT_PROGRAM)};
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    execv(WEFT_PROGRAM, arguments.data());
    _exit(kNotStarted);
  }
  int status = 0;
  rusage used{};
  wait4(child, &status, 0, &used);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, Folder::take(captured.out),
          Folder::take(captured.err), 1024.0 * double(used.ru_maxrss)};
}

std::string hash_in(const std::string& summary) {
  const std::size_t at = summary.find("hash ");
  return at == std::string::npos ? "" : summary.substr(at, summary.find('\n', at) - at);
}

// Where no more threads can be started, those that there are do the work, to the same bits.
TEST(CliLimits, FewerThreadsWhereTheSystemStartsNoMore) {
  const Folder folder;
  const std::vector<std::string> words{"run", "fold50", "--frames", "3", "--threads", "8"};
  const std::string hash = hash_in(run_with(folder, words).out);
  ASSERT_NE(hash, "");
  for (const rlim_t processes : {1, 2, 3, 6}) {
    const Ended ended = run_with(folder, words, processes);
    if (ended.exit_code == kNotStarted || ended.exit_code == 3)
      GTEST_SKIP() << "nobody may not look into this folder";
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_EQ(hash_in(ended.out), hash);
    EXPECT_NE(ended.out.find("of 8 threads (a limit on processes or memory)"), std::string::npos)
        << ended.out;
  }
}

// A scene in a file, with what its one cloth and its solver have beyond a sheet of springs.
std::string sheet(const Folder& folder, int points, const std::string& cloth,
                  const std::string& rest = "") {
  const std::string side = std::to_string(points * 0.01), n = std::to_string(points);
  return folder.write("sheet.json",
                      R"({"weft": 1, "time": {"substeps": 20}, "cloths": [{"grid": {"points": [)" +
                          n + ", " + n + R"(], "u": [)" + side + R"(, 0, 0], "v": [0, 0, )" + side +
                          R"(]}, "stiffness": {"structural": 20, "shear": 20, "bend": 4}, )" +
                          R"("pins": [[0, 0]])" + cloth + "}]" + rest + "}");
}

void expect_memory_within(const Ended& ended, const Scene& scene) {
  ASSERT_EQ(ended.exit_code, 0) << ended.err;
  const double estimated = estimate(scene).bytes;
  EXPECT_LT(ended.peak_bytes, kMemoryWithin * estimated);
  EXPECT_GT(ended.peak_bytes, estimated / kMemoryWithin);
}

TEST(CliLimits, MemoryIsWithinTheEstimate) {
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "the address sanitizer takes memory of its own";
#endif
  const Folder folder;
  const std::pair<std::string, std::string> features[] = {
      {"", ""},
      {"", R"(, "solver": {"method": "spring_friction"})"},
      {"", R"(, "solver": {"method": "positional", "sweep": "jacobi"})"},
      {"", R"(, "solver": {"method": "compliant", "sweep": "line", "order": 2, "tethers": true})"},
      {R"(, "tear_strain": 50, "bending": 1e-6, "strain_limit": 0.1)", ""},
      {R"(, "self_collision": {"mode": "particles", "thickness": 0.01})", ""},
      {R"(, "self_collision": {"mode": "surface", "thickness": 0.005})", ""}};
  for (const auto& [cloth, rest] : features) {
    SCOPED_TRACE(cloth + rest);
    const std::string path = sheet(folder, 300, cloth, rest);
    const Ended ended = run_with(folder, {"run", path, "--frames", "2", "--threads", "1"});
    expect_memory_within(ended, read_scene(path).scene);
  }
  const Ended folded = run_with(folder, {"run", "fold150", "--frames", "2", "--threads", "1"});
  expect_memory_within(folded, read_scene("fold150").scene);
}

TEST(CliLimits, CheckSaysWhatARunNeeds) {
  const Folder folder;
  const Ended small = run_with(folder, {"check", sheet(folder, 30, "")});
  EXPECT_EQ(small.exit_code, 0);
  EXPECT_NE(small.out.find(": ok, 900 particles\nneeds about "), std::string::npos) << small.out;
  EXPECT_NE(small.out.find(" a frame on one thread (20 substeps; a rough figure)\n"),
            std::string::npos)
      << small.out;
  EXPECT_EQ(small.out.find("note"), std::string::npos) << small.out;
}

// 16.7 million particles with contact and 100 000 substeps: years, and more memory than most have.
TEST(CliLimits, CheckSaysWhatTakesForEver) {
  const Folder folder;
  const std::string path = folder.write("forever.json", R"({
    "weft": 1, "time": {"substeps": 100000},
    "cloths": [{"grid": {"points": [4096, 4096], "u": [40.95, 0, 0], "v": [0, 0, 40.95]},
                "self_collision": {"mode": "surface", "thickness": 0.005}}]})");
  const Ended ended = run_with(folder, {"check", path});
  EXPECT_EQ(ended.exit_code, 0) << ended.err;
  EXPECT_NE(ended.out.find(" GB of memory and "), std::string::npos) << ended.out;
  EXPECT_NE(ended.out.find("note: its 300 frames take about "), std::string::npos) << ended.out;
  EXPECT_NE(ended.out.find(" years on one thread"), std::string::npos) << ended.out;
}

// Too little memory is told before the run starts, with what it needs and what there is.
TEST(CliLimits, ARunThatCannotFitIsRefused) {
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "the address sanitizer reserves more address space than any limit";
#endif
  const Folder folder;
  sheet(folder, 2000, "");
  for (const std::string command :
       {"run sheet.json --frames 1 --dump x.f64", "explain sheet.json",
        "run sheet.json --set /solver/method=compliant --tolerance 0.001"}) {
    const Outcome outcome = run_weft(folder, command, "ulimit -v 400000;");
    EXPECT_EQ(outcome.exit_code, 4) << command << outcome.err;
    EXPECT_NE(outcome.err.find("the scene needs about 1"), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("MB that are free)"), std::string::npos) << outcome.err;
    EXPECT_EQ(folder.files(), 1u);
  }
  EXPECT_EQ(run_weft(folder, "check sheet.json", "ulimit -v 400000;").exit_code, 0);
}

TEST(CliLimits, NamesFromOutsideStayOnOneLine) {
  const Folder folder;
  const Ended missing = run_with(folder, {"run", "no\nsuch\x1b[31m.json"});
  EXPECT_EQ(missing.exit_code, 3);
  EXPECT_EQ(missing.err.find('\n'), missing.err.size() - 1) << missing.err;
  EXPECT_EQ(missing.err.find('\x1b'), std::string::npos) << missing.err;
  folder.write("key.json", "{\"weft\": 1, \"cloths\": [{}], \"a\\nb\\u001b\": 1}");
  const Outcome key = run_weft(folder, "check key.json");
  EXPECT_EQ(key.exit_code, 3);
  EXPECT_NE(key.err.find("key.json:/a\\nb\\x1b: unknown key"), std::string::npos) << key.err;
  EXPECT_EQ(key.err.find('\n'), key.err.size() - 1) << key.err;
}

TEST(Estimate, WordsForBytesAndTime) {
  EXPECT_EQ(bytes_words(1), "1 MB");
  EXPECT_EQ(bytes_words(8.4e8), "840 MB");
  EXPECT_EQ(bytes_words(2.44e10), "24 GB");
  EXPECT_EQ(bytes_words(3e12), "3 TB");
  EXPECT_EQ(time_words(2e-5), "0.02 ms");
  EXPECT_EQ(time_words(3.14), "3.1 s");
  EXPECT_EQ(time_words(300), "5 min");
  EXPECT_EQ(time_words(4 * 3600.0), "4 h");
  EXPECT_EQ(time_words(10 * 86400.0), "10 days");
  EXPECT_EQ(time_words(7e9), "222 years");
}

// The substeps of the whole scene, from a cutting of it.
TEST(Estimate, TellsTheSubstepsOfTheRun) {
  for (const char* name : {"swing", "pinned2", "box_drape", "inextensible", "seed1_friction",
                           "seed2_positional", "pbr100", "flag", "cutter", "coat"}) {
    const Scene scene = read_scene(name).scene;
    const double substeps = Simulation(scene, {.threads = 1}).substeps();
    EXPECT_NEAR(estimate(scene).substeps, substeps, std::max(1.0, 0.1 * substeps)) << name;
  }
}

TEST(Estimate, FreeMemoryIsThatOfTheMachine) {
  EXPECT_GT(free_memory(), 1e6);
  EXPECT_LT(free_memory(), 1e15);
}

// A membrane that pins draw out stiffens as it does so.
TEST(Estimate, CountsWhatPinsStretch) {
  for (const double longer : {3.0, 10.0}) {
    Scene scene;
    Cloth& cloth = scene.cloths.emplace_back();
    cloth.grid.nx = cloth.grid.ny = 9;
    cloth.membrane = {.warp = 2000, .weft = 2000, .coupling = 100, .shear = 100};
    cloth.pins = {{0, 0, {}}, {1, 0, {}}};
    cloth.pins[1].keys = {{0, {0.125, 0, 0}}, {0.5, {0.125 * longer, 0, 0}}};
    scene.time.seconds = 0.6;
    Simulation simulation(scene);
    while (simulation.time() < scene.time.seconds - 1e-9) simulation.advance_frame();
    const double taken = simulation.substeps();
    EXPECT_GT(taken, 1.5 * longer);
    EXPECT_LT(estimate(scene).substeps, 1.5 * taken) << longer;
    EXPECT_GT(estimate(scene).substeps, taken / 1.5) << longer;
  }
}

}  // namespace
}  // namespace weft
