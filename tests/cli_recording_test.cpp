// Recordings: a run told again gives the same bits, and a difference is named by its frame.
#include <tuple>

#include "program.h"

namespace weft {
namespace {

TEST(Recording, ReplaysToTheSameBits) {
  const Folder folder;
  const std::string scene = small_scene(folder);
  ASSERT_EQ(run_weft(folder, "run small.json --frames 9 --record a.rec").exit_code, 0);
  const Outcome again =
      run_weft(folder, "run --replay a.rec --record b.rec --threads 1 --simd scalar");
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(folder.read("a.rec"), folder.read("b.rec"));
  EXPECT_EQ(run_weft(folder, "run small.json --replay a.rec").exit_code, 0);
}

TEST(Recording, ADifferenceIsNamedByItsFrame) {
  const Folder folder;
  small_scene(folder);
  ASSERT_EQ(run_weft(folder, "run small.json --frames 9 --record a.rec").exit_code, 0);
  std::string text = folder.read("a.rec");
  const std::size_t at = text.find("\"hash\"", text.find("\"frame\":4"));
  char& digit = text[text.find_first_of("0123456789abcdef", at + 8)];
  digit = digit == '0' ? '1' : '0';
  folder.write("a.rec", text);
  const Outcome outcome = run_weft(folder, "run --replay a.rec");
  EXPECT_EQ(outcome.exit_code, 4);
  EXPECT_NE(outcome.err.find("frame 4 "), std::string::npos) << outcome.err;
}

TEST(Recording, AnotherSceneSeedOrLengthIsRefused) {
  const Folder folder;
  small_scene(folder);
  ASSERT_EQ(run_weft(folder, "run small.json --frames 6 --seed 5 --record a.rec").exit_code, 0);
  for (const auto& [arguments, code, why] :
       {std::tuple<std::string, int, std::string>{"--seed 6", 2, "seed 5"},
        {"--frames 7", 2, "only 6 frames"},
        {"--set /cloths/0/drag=1", 3, "differs first at /cloths/0"}}) {
    const Outcome outcome = run_weft(folder, "run small.json --replay a.rec " + arguments);
    EXPECT_EQ(outcome.exit_code, code) << arguments;
    EXPECT_NE(outcome.err.find(why), std::string::npos) << outcome.err;
  }
}

TEST(Recording, WhatIsNoneIsRefused) {
  const Folder folder;
  const std::string scene = small_scene(folder);
  EXPECT_EQ(run_weft(folder, "run --replay nowhere.rec").exit_code, 3);
  EXPECT_EQ(run_weft(folder, "run --replay small.json").exit_code, 3);
  EXPECT_EQ(run_weft(folder, "run").exit_code, 2);
  ASSERT_EQ(run_weft(folder, "run small.json --frames 2 --record a.rec").exit_code, 0);
  EXPECT_EQ(run_weft(folder, "run hello --replay a.rec").exit_code, 3);
}

}  // namespace
}  // namespace weft
