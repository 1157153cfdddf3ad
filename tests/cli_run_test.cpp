// `weft run`: every option, and what it leaves behind.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "machines.h"
#include "program.h"

namespace weft {
namespace {

using Json = nlohmann::json;

Json report_of(const Folder& folder, const std::string& arguments) {
  const Outcome outcome = run_weft(folder, "run small.json --report r.json " + arguments);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  return Json::parse(folder.read("r.json"));
}

TEST(CliRun, PrintsASummaryAndNothingElseWhenPiped) {
  const Folder folder;
  small_scene(folder);
  const Outcome outcome = run_weft(folder, "run small.json --frames 5");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.err, "");
  EXPECT_TRUE(outcome.out.starts_with("scene     small\n")) << outcome.out;
  for (const char* part : {"48 particles", "5 frames", "real time", "energy", "strain", "hash"}) {
    EXPECT_NE(outcome.out.find(part), std::string::npos) << part << "\n" << outcome.out;
  }
  EXPECT_EQ(outcome.out.find(" of 5"), std::string::npos);  // no progress
}

TEST(CliRun, ShowsProgressOnATerminal) {
  const Folder folder;
  small_scene(folder);
  // script(1) of util-linux gives the program a terminal; the run is cut after 2.5 s.
  if (std::system("command -v script >/dev/null 2>&1") != 0) GTEST_SKIP() << "no script(1)";
  const std::string inner =
      "timeout -s INT 2.5 '" WEFT_PROGRAM "' run small.json --frames 1000000000";
  const std::string command = "cd '" + folder.path() + "' && script -qec \"" + inner +
                              "\" /dev/null >terminal.txt 2>&1 </dev/null";
  EXPECT_NE(std::system(command.c_str()), 0);
  const std::string text = folder.read("terminal.txt");
  EXPECT_NE(text.find(" of 1000000000"), std::string::npos) << text;
  EXPECT_NE(text.find("real time"), std::string::npos) << text;
}

TEST(CliRun, RunsForFramesOrSecondsOrTheScenesOwnTime) {
  const Folder folder;
  small_scene(folder);
  EXPECT_EQ(report_of(folder, "--frames 3")["frames"], 3);
  EXPECT_EQ(report_of(folder, "--frames 0")["frames"], 0);
  EXPECT_EQ(report_of(folder, "--seconds 0.1")["frames"], 5);
  EXPECT_EQ(report_of(folder, "")["frames"], 250);
  EXPECT_EQ(report_of(folder, "--set /time/seconds=0.2")["frames"], 10);
}

TEST(CliRun, ThreadsSimdAndSeedReachTheSimulation) {
  const Folder folder;
  small_scene(folder);
  const Json one = report_of(folder, "--frames 5 --threads 1 --simd scalar --seed 7");
  const std::string wide = simd_name(wide_simd());
  const Json two = report_of(folder, "--frames 5 --threads 2 --seed 7 --simd " + wide);
  EXPECT_EQ(one["threads"], 1);
  EXPECT_EQ(two["threads"], 2);
  EXPECT_EQ(one["build"]["simd"], "scalar");
  EXPECT_EQ(two["build"]["simd"], wide);
  EXPECT_EQ(one["hash"], two["hash"]);
}

TEST(CliRun, SetOverridesValuesRepeatedly) {
  const Folder folder;
  small_scene(folder);
  const Json report = report_of(
      folder,
      "--set /cloths/0/grid/points=[4,5] --set /cloths/0/pins=[] --set /name=other --frames 1");
  EXPECT_EQ(report["particles"], 20);
  EXPECT_EQ(report["scene"], "other");
}

TEST(CliRun, WritesReportDumpAndAnimation) {
  const Folder folder;
  small_scene(folder);
  const Outcome outcome =
      run_weft(folder, "run small.json --frames 4 --report r.json --dump d.f64 --export a.pc2");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(Json::parse(folder.read("r.json"))["status"], "ok");
  EXPECT_EQ(folder.read("d.f64").size(), 48U * 24);
  EXPECT_EQ(folder.read("a.pc2").size(), 32U + 5 * 48 * 12);  // the start and 4 frames
  EXPECT_NE(outcome.out.find("wrote     a.pc2, d.f64, r.json"), std::string::npos) << outcome.out;
  EXPECT_EQ(folder.files(), 4U);
}

TEST(CliRun, WritesAnObjSequence) {
  const Folder folder;
  small_scene(folder);
  EXPECT_EQ(run_weft(folder, "run small.json --frames 2 --export a.obj").exit_code, 0);
  EXPECT_TRUE(folder.has("a_0000.obj") && folder.has("a_0001.obj") && folder.has("a_0002.obj"));
  EXPECT_EQ(folder.files(), 4U);
}

TEST(CliRun, WritesEveryAnimationFormat) {
  const Folder folder;
  small_scene(folder);
  for (const char* name : {"a.mdd", "a.glb", "a.gltf", "a.usda"})
    EXPECT_EQ(run_weft(folder, std::string("run small.json --frames 2 --export ") + name).exit_code,
              0);
  EXPECT_EQ(folder.read("a.mdd").size(), 8U + 3 * 4 + 3 * 48 * 12);
  EXPECT_EQ(folder.read("a.glb").substr(0, 4), "glTF");
  EXPECT_TRUE(folder.has("a.bin"));
  EXPECT_EQ(folder.read("a.usda").substr(0, 10), "#usda 1.0\n");
  const Outcome outcome = run_weft(folder, "run small.json --frames 9000 --export b.glb");
  EXPECT_EQ(outcome.exit_code, 5);
  EXPECT_NE(outcome.err.find("do not fit morph targets"), std::string::npos) << outcome.err;
}

TEST(CliRun, WritesTheReportToAPipe) {
  const Folder folder;
  small_scene(folder);
  const Outcome outcome = run_weft(folder, "run small.json --frames 1 --report /dev/stderr");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(Json::parse(outcome.err)["frames"], 1);
}

TEST(CliRun, ASimulationThatStopsItselfSaysWhereAndKeepsWhatIsGood) {
  const Folder folder;
  small_scene(folder);
  // A sheet that falls for ever leaves the space in which positions mean anything.
  const Outcome outcome = run_weft(folder,
                                   "run small.json --set /cloths/0/pins=[] --set "
                                   "/gravity=[0,-10000,0] --frames 1000000 --export a.pc2 "
                                   "--dump d.f64 --report r.json",
                                   "timeout 60");
  EXPECT_EQ(outcome.exit_code, 4) << outcome.err;
  EXPECT_TRUE(outcome.err.starts_with("weft: error: small.json: the simulation stopped itself: "))
      << outcome.err;
  for (const char* part : {"frame ", "stage ", "particle "}) {
    EXPECT_NE(outcome.err.find(part), std::string::npos) << outcome.err;
  }
  const Json report = Json::parse(folder.read("r.json"));
  EXPECT_NE(report["status"], "ok");
  EXPECT_EQ(report["finite"], false);
  // The animation ends with the last good frame: the start and every frame that was completed.
  const std::string animation = folder.read("a.pc2");
  const auto frames = report["frames"].get<std::size_t>();
  EXPECT_EQ(animation.size(), 32U + (frames + 1) * 48 * 12);
  EXPECT_FALSE(folder.has("d.f64"));
  EXPECT_EQ(folder.files(), 3U);
}

TEST(CliRun, AnInterruptKeepsWhatWasDone) {
  const Folder folder;
  small_scene(folder);
  for (const auto& [signal, code] : {std::pair{"INT", 130}, std::pair{"TERM", 143}}) {
    const Outcome outcome =
        run_weft(folder,
                 "run small.json --frames 1000000000 --export a.pc2 --dump d.f64 --report r.json "
                 "--threads 1",
                 std::string("timeout --preserve-status -s ") + signal + " 0.5");
    EXPECT_EQ(outcome.exit_code, code);
    EXPECT_NE(outcome.err.find("interrupted after frame "), std::string::npos) << outcome.err;
    const Json report = Json::parse(folder.read("r.json"));
    const auto frames = report["frames"].get<std::size_t>();
    EXPECT_NE(report["status"].get<std::string>().find("interrupted"), std::string::npos);
    EXPECT_EQ(folder.read("a.pc2").size(), 32U + (frames + 1) * 48 * 12);
    EXPECT_EQ(folder.read("d.f64").size(), 48U * 24);
    EXPECT_EQ(folder.files(), 4U);
  }
}

}  // namespace
}  // namespace weft
