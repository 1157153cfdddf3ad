// Studies as the library runs them: draws, records, and one file for any jobs and shards.
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <mutex>
#include <set>

#include "folder.h"
#include "study/draws.h"
#include "study/results.h"

namespace {

// What a disk would have of a file if the machine stopped now: what the file held when it was last stored.
std::map<ino_t, std::string>* disk = nullptr;
std::mutex disk_mutex;

}  // namespace

// In the place of the system's own, so that a test sees what is stored, and when.
extern "C" int fdatasync(int file) {
  struct stat status {};
  if (disk != nullptr && ::fstat(file, &status) == 0 && S_ISREG(status.st_mode)) {
    std::string bytes(std::size_t(status.st_size), '\0');
    const ssize_t got = ::pread(file, bytes.data(), bytes.size(), 0);
    const std::lock_guard hold(disk_mutex);
    std::string& there = (*disk)[status.st_ino];
    if (std::size_t(got) > there.size()) there = bytes.substr(0, std::size_t(got));
  }
  return int(::syscall(SYS_fdatasync, file));
}

namespace weft {
namespace {

constexpr const char* kStudy = R"({"weft_study": 1, "frames": 6, "seed": 3,
  "scene": {"weft": 1, "time": {"substeps": 6},
            "cloths": [{"grid": {"points": [7, 5], "jitter": 0.001}, "pins": [[0, 0]]}]},
  "parameters": [{"pointer": "/gravity/1", "values": [-9.81, -3]},
                 {"pointer": "/cloths/0/density", "draw": {"from": 0.1, "to": 1, "scale": "log"}}],
  "draws": {"method": "sobol", "count": 8},
  "measures": ["/strain/max", "/hash"], "positions": {"every": 2}})";

// The table and the chunks of a file, but for the wall time of each run.
std::vector<std::string> contents(const Study& study, const std::string& path) {
  const TableFile file(path);
  std::vector<std::string> all;
  const Column& seconds = study.columns()[study.columns().size() - 2];
  EXPECT_EQ(seconds.name, "seconds");
  for (const Stored& stored : file.records(study)) {
    Record record = stored.read();
    std::fill_n(record.row.begin() + std::ptrdiff_t(seconds.offset), 8, '\0');
    all.push_back(to_bytes(record));
  }
  return all;
}

TEST(Studies, EveryLayerOfEveryDimensionHoldsOnePoint) {
  for (const Draw draw : {Draw::latin_hypercube, Draw::sobol})
    for (const std::size_t count : {1u, 2u, 64u, 1024u})
      for (const std::uint64_t seed : {0u, 1u, 99u}) {
        const std::vector<double> x = draw_points(draw, count, kSobolDimensions, seed);
        for (std::size_t d = 0; d < kSobolDimensions; ++d) {
          std::set<std::size_t> layers;
          for (std::size_t k = 0; k < count; ++k)
            layers.insert(std::size_t(x[k * kSobolDimensions + d] * double(count)));
          EXPECT_EQ(layers.size(), count) << int(draw) << " " << d << " " << seed;
          EXPECT_LT(*layers.rbegin(), count);
        }
      }
}

// The integral of the product of 2 x_d over the cube is 1: Sobol's points come far closer than
// independent ones, whose error is some sqrt((4/3)^6 - 1) / sqrt(n).
TEST(Studies, SobolPointsIntegrateBetterThanRandomOnes) {
  constexpr std::size_t kCount = 4096, kDimensions = 6;
  const auto error = [&](Draw draw, std::uint64_t seed) {
    const std::vector<double> x = draw_points(draw, kCount, kDimensions, seed);
    double sum = 0;
    for (std::size_t k = 0; k < kCount; ++k) {
      double product = 1;
      for (std::size_t d = 0; d < kDimensions; ++d) product *= 2 * x[k * kDimensions + d];
      sum += product;
    }
    return std::abs(sum / double(kCount) - 1);
  };
  double sobol = 0, random = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    sobol = std::max(sobol, error(Draw::sobol, seed));
    random = std::max(random, error(Draw::random, seed));
  }
  EXPECT_LT(sobol, random / 5);
}

TEST(Studies, ARecordIsItsBytes) {
  const Study study(kStudy, "");
  const std::string bytes = to_bytes(study.run(3, 1, [] { return true; }));
  EXPECT_EQ(to_bytes(record_of(bytes)), bytes);
  for (std::size_t cut = 0; cut < bytes.size(); cut += 7) try {
      EXPECT_LT(to_bytes(record_of(bytes.substr(0, cut))).size(), bytes.size());
    } catch (const std::invalid_argument&) {
    }
}

TEST(Studies, OneContentForAnyJobsAndShards) {
  const Folder folder;
  const Study study(kStudy, "");
  ASSERT_EQ(study.runs(), 16u);
  EXPECT_EQ(Study(study.text(), "").text(), study.text());
  std::vector<std::string> first;
  for (const int jobs : {1, 3, 32}) {
    const std::string path = folder / ("jobs" + std::to_string(jobs) + ".h5");
    ASSERT_TRUE(run_study(study, {.path = path, .jobs = jobs}));
    const auto found = contents(study, path);
    if (first.empty()) first = found;
    EXPECT_EQ(found, first) << jobs;
  }
  std::vector<std::string> shards;
  for (std::uint64_t k = 0; k < 5; ++k) {
    shards.push_back(folder / ("shard" + std::to_string(k) + ".h5"));
    ASSERT_TRUE(run_study(study, {.path = shards.back(), .shard = {k, 5}, .jobs = 2}));
  }
  std::ranges::reverse(shards);
  merge_study(shards, folder / "merged.h5");
  EXPECT_EQ(contents(study, folder / "merged.h5"), first);
  EXPECT_EQ(folder.read("merged.h5").size(), folder.read("jobs1.h5").size());
  shards.pop_back();
  EXPECT_THROW(merge_study(shards, folder / "less.h5"), StudyError);
  EXPECT_FALSE(folder.has("less.h5"));
}

TEST(Studies, APowerCutLosesNoRunThatWasToldOf) {
  const Folder folder;
  const Study study(kStudy, "");
  ASSERT_TRUE(run_study(study, {.path = folder / "whole.h5"}));
  for (const int jobs : {1, 3}) {
    std::map<ino_t, std::string> stored;
    std::vector<std::string> cuts;  // the journal on the disk whenever a run was told of
    StudyOptions options{.path = folder / "a.h5", .jobs = jobs};
    options.progress = [&](std::uint64_t, std::uint64_t, std::uint64_t) {
      struct stat status {};
      ASSERT_EQ(::stat((folder / "a.h5.runs").c_str(), &status), 0);
      const std::lock_guard hold(disk_mutex);
      cuts.push_back(stored[status.st_ino]);
    };
    disk = &stored;
    EXPECT_TRUE(run_study(study, options));
    disk = nullptr;
    ASSERT_EQ(cuts.size(), study.runs());
    for (std::size_t told = 1; told <= cuts.size(); told += 4) {
      const std::string path = folder / ("cut" + std::to_string(told) + ".h5");
      folder.write("cut" + std::to_string(told) + ".h5.runs", cuts[told - 1]);
      std::uint64_t before = 0;
      StudyOptions again{.path = path, .resume = true};
      again.progress = [&](std::uint64_t, std::uint64_t, std::uint64_t there) { before = there; };
      EXPECT_TRUE(run_study(study, again));
      EXPECT_GE(before, told);
      EXPECT_EQ(contents(study, path), contents(study, folder / "whole.h5"));
    }
  }
}

TEST(Studies, WhatIsFinishedStaysWhereItIsGivenUp) {
  const Folder folder;
  const Study study(kStudy, "");
  std::atomic<int> frames = 0;
  StudyOptions options{.path = folder / "a.h5", .jobs = 1};
  options.keep_going = [&] { return ++frames < 30; };
  EXPECT_FALSE(run_study(study, options));
  EXPECT_EQ(folder.files(), 1u);  // the journal
  EXPECT_THROW(run_study(study, {.path = folder / "a.h5"}), StudyError);
  std::uint64_t before = 0;
  options.resume = true;
  options.keep_going = [] { return true; };
  options.progress = [&](std::uint64_t, std::uint64_t, std::uint64_t there) { before = there; };
  EXPECT_TRUE(run_study(study, options));
  EXPECT_EQ(before, 4u);  // 29 frames are 4 runs of 6 and a part
  ASSERT_TRUE(run_study(study, {.path = folder / "b.h5"}));
  EXPECT_EQ(contents(study, folder / "a.h5"), contents(study, folder / "b.h5"));
  EXPECT_EQ(folder.files(), 2u);
}

}  // namespace
}  // namespace weft
