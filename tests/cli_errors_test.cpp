// What goes wrong on the command line, in scenes and in files: exit codes, error lines, no debris.
#include <gtest/gtest.h>

#include "program.h"

namespace weft {
namespace {

// One error line `weft: error: PLACE: …` that names what is allowed.
void expect_usage_error(const std::string& arguments, const std::string& place,
                        const std::string& part) {
  const Folder folder;
  small_scene(folder);
  const Outcome outcome = run_weft(folder, arguments);
  EXPECT_EQ(outcome.exit_code, 2) << arguments;
  EXPECT_EQ(outcome.out, "") << arguments;
  EXPECT_TRUE(outcome.err.starts_with("weft: error: " + place + ": ")) << outcome.err;
  EXPECT_NE(outcome.err.find(part), std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.err.find('\n'), outcome.err.size() - 1) << outcome.err;
  EXPECT_EQ(folder.files(), 1U);
}

TEST(CliErrors, CommandLineFaultsNameTheOptionAndWhatIsAllowed) {
  expect_usage_error("", "command line", "run, check, explain, scenes, ");
  expect_usage_error("jump", "jump", "run, check, explain, scenes, ");
  expect_usage_error("run", "command line", "SCENE is required");
  expect_usage_error("run small.json --frames x", "--frames", "a whole number");
  expect_usage_error("run small.json --frames -1", "--frames", "a whole number");
  expect_usage_error("run small.json --frames 1.5", "--frames", "a whole number");
  expect_usage_error("run small.json --frames", "--frames", "missing");
  expect_usage_error("run small.json --seconds -1", "--seconds", "0 to 1e9");
  expect_usage_error("run small.json --seconds nan", "--seconds", "0 to 1e9");
  expect_usage_error("run small.json --frames 1 --seconds 1", "command line", "--seconds");
  expect_usage_error("run small.json --threads 0", "--threads", "1 to 256");
  expect_usage_error("run small.json --simd mmx", "--simd", "scalar, sse2, avx2, avx512");
  expect_usage_error("run small.json --seed -3", "--seed", "a whole number");
  expect_usage_error("run small.json --set /a", "--set", "POINTER=VALUE");
  expect_usage_error("run small.json --set a=1", "--set", "POINTER=VALUE");
  expect_usage_error("run small.json twice.json", "twice.json", "one SCENE");
}

TEST(CliErrors, WhatCannotBeWrittenIsRefusedWithWhatCan) {
  expect_usage_error("run small.json --export a.abc", "--export",
                     "(.pc2, .mdd, .obj, .gltf, .glb, .usda)");
}

TEST(CliErrors, TwoOutputsToOneFileAreRefused) {
  expect_usage_error("run small.json --dump a --report a", "a", "two outputs");
}

TEST(CliErrors, AnUnknownSceneNamesTheNearest) {
  const Folder folder;
  for (const std::string command : {"run", "check", "explain"}) {
    const Outcome outcome = run_weft(folder, command + " Pined2");
    EXPECT_EQ(outcome.exit_code, 3);
    EXPECT_TRUE(outcome.err.starts_with("weft: error: Pined2: ")) << outcome.err;
    EXPECT_NE(outcome.err.find("pinned2"), std::string::npos) << outcome.err;
  }
}

TEST(CliErrors, CheckListsEveryFaultWithFileAndPointer) {
  const Folder folder;
  small_scene(folder);
  const Outcome outcome =
      run_weft(folder, "check small.json --set /solver/iterations=0 --set /time/frame=-1");
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_EQ(outcome.out, "");
  EXPECT_NE(outcome.err.find("weft: error: small.json:/solver/iterations: "), std::string::npos)
      << outcome.err;
  EXPECT_NE(outcome.err.find("weft: error: small.json:/time/frame: "), std::string::npos)
      << outcome.err;
}

TEST(CliErrors, TextThatIsNoJsonIsASceneError) {
  const Folder folder;
  folder.write("bad.json", "{\"weft\": 1,");
  const Outcome outcome = run_weft(folder, "run bad.json");
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_TRUE(outcome.err.starts_with("weft: error: bad.json")) << outcome.err;
}

TEST(CliErrors, APathThatCannotBeWrittenIsFoundBeforeSimulating) {
  const Folder folder;
  small_scene(folder);
  for (const std::string option : {"--report no/r.json", "--dump no/d.f64", "--export no/a.pc2",
                                   "--export no/a.obj", "--dump ."}) {
    // So long a run would not end within the test; a second output shows that nothing is left.
    std::string arguments = "run small.json --frames 1000000000 " + option;
    arguments += option.starts_with("--dump") ? " --report ok" : " --dump ok";
    const Outcome outcome = run_weft(folder, arguments, "timeout 20");
    EXPECT_EQ(outcome.exit_code, 5) << option;
    EXPECT_NE(outcome.err.find("cannot write"), std::string::npos) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(folder.files(), 1U) << option;
  }
}

TEST(CliErrors, ADiskThatFillsUpEndsTheRunWithoutDebris) {
  const Folder folder;
  small_scene(folder);
  const Outcome full = run_weft(folder, "run small.json --frames 1 --dump /dev/full");
  EXPECT_EQ(full.exit_code, 5);
  EXPECT_TRUE(full.err.starts_with("weft: error: /dev/full: writing failed")) << full.err;
  // ulimit -f: no file beyond 64 blocks.
  const Outcome limited =
      run_weft(folder, "run small.json --frames 1000000000 --export a.pc2 --report r.json",
               "ulimit -f 64; timeout 20");
  EXPECT_EQ(limited.exit_code, 5);
  EXPECT_TRUE(limited.err.starts_with("weft: error: a.pc2: writing failed")) << limited.err;
  EXPECT_EQ(folder.files(), 1U);
}

TEST(CliErrors, AFullStandardOutputIsAWriteError) {
  const Folder folder;
  small_scene(folder);
  const std::string command =
      "'" WEFT_PROGRAM "' run '" + folder.path() + "/small.json' --frames 1 >/dev/full 2>/dev/null";
  EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 5);
}

}  // namespace
}  // namespace weft
