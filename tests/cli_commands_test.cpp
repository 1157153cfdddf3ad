// check, explain, scenes, view, --help and --version.
#include <gtest/gtest.h>

#include "program.h"

namespace weft {
namespace {

TEST(CliCommands, HelpNamesEveryCommandAndExitCode) {
  const Folder folder;
  const Outcome outcome = run_weft(folder, "--help");
  EXPECT_EQ(outcome.exit_code, 0);
  for (const char* part : {"run", "check", "explain", "scenes", "view", "Exit codes"}) {
    EXPECT_NE(outcome.out.find(part), std::string::npos) << part;
  }
}

TEST(CliCommands, HelpOfRunNamesEveryOption) {
  const Folder folder;
  const Outcome outcome = run_weft(folder, "run --help");
  EXPECT_EQ(outcome.exit_code, 0);
  for (const char* part : {"--seconds", "--frames", "--threads", "--set", "--report", "--dump",
                           "--export", "--seed", "--simd", "SCENE"}) {
    EXPECT_NE(outcome.out.find(part), std::string::npos) << part;
  }
}

TEST(CliCommands, VersionIsOneLine) {
  const Folder folder;
  const Outcome outcome = run_weft(folder, "--version");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_TRUE(outcome.out.starts_with("weft ")) << outcome.out;
}

TEST(CliCommands, CheckSaysOk) {
  const Folder folder;
  small_scene(folder);
  const Outcome outcome = run_weft(folder, "check small.json");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(outcome.out.starts_with("small.json: ok, 48 particles\nneeds about ")) << outcome.out;
  EXPECT_EQ(run_weft(folder, "check pinned2").exit_code, 0);
}

TEST(CliCommands, TellWhatOfACourseFileIsIgnored) {
  const Folder folder;
  folder.write("wild.json", R"({"cloth": {"num_width_points": 6, "num_height_points": 6, "depth": 2,
    "pinned": [[0, 0], [0, 0]]}, "sphere0": {"pinned": "no\u001b[31m"}})");
  for (const std::string command : {"check", "explain", "run --frames 1"}) {
    const Outcome outcome = run_weft(folder, command + " wild.json");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    for (const char* place : {"/cloth/depth ", "/sphere0/pinned ", "/cloth/pinned "})
      EXPECT_NE(outcome.out.find(place), std::string::npos) << command << outcome.out;
  }
}

TEST(CliCommands, ExplainPrintsThePlan) {
  const Folder folder;
  small_scene(folder);
  const Outcome outcome = run_weft(folder, "explain small.json");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(outcome.out.starts_with("small: ")) << outcome.out;
  EXPECT_NE(outcome.out.find("runs, in this order"), std::string::npos);
  EXPECT_NE(outcome.out.find("left out"), std::string::npos);
  EXPECT_NE(outcome.out.find("needs about "), std::string::npos);
}

TEST(CliCommands, ScenesListsTheShippedOnes) {
  const Folder folder;
  const Outcome outcome = run_weft(folder, "scenes");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("pinned2 "), std::string::npos) << outcome.out;
}

TEST(CliCommands, ViewStartsTheViewerBesideIt) {
  const Folder folder;
  std::filesystem::copy_file(WEFT_PROGRAM, folder / "weft");
  const std::string run = "cd '" + folder.path() + "' && ./weft view pinned2 --headless --frames 3";
  const int missing = std::system((run + " 2>err.txt").c_str());
  EXPECT_EQ(WEXITSTATUS(missing), 2);
  EXPECT_NE(folder.read("err.txt").find("weft-viewer is not installed"), std::string::npos);

  folder.write("weft-viewer", "#!/bin/sh\necho \"$@\" >viewed.txt\nexit 7\n");
  std::filesystem::permissions(folder / "weft-viewer", std::filesystem::perms::owner_all);
  EXPECT_EQ(WEXITSTATUS(std::system(run.c_str())), 7);
  EXPECT_EQ(folder.read("viewed.txt"), "pinned2 --headless --frames 3\n");
}

}  // namespace
}  // namespace weft
