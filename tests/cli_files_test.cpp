// The files of a run: none overwrites another or an input, any name will do, and what a signal leaves.
#include <array>
#include <nlohmann/json.hpp>
#include <vector>

#include "killed_run.h"

namespace weft {
namespace {

using Json = nlohmann::json;

TEST(CliFiles, NoOutputOverwritesAnotherOrAnInput) {
  const Folder folder;
  const std::string scene = folder.read(std::filesystem::path(small_scene(folder)).filename());
  ASSERT_EQ(run_weft(folder, "run small.json --frames 3 --record a.rec").exit_code, 0);
  const std::string recording = folder.read("a.rec");
  std::filesystem::create_hard_link(folder / "small.json", folder / "hard.json");
  std::filesystem::create_symlink("small.json", folder / "link.json");
  const std::size_t files = folder.files();
  for (const auto& [arguments, path, one, other] : std::vector<std::array<std::string, 4>>{
           {"--dump x --report ./x", "./x", "--dump", "--report"},
           {"--export c.gltf --dump c.bin", "c.bin", "--export", "--dump"},
           {"--export c.gltf --dump c.weft-new.bin", "c.weft-new.bin", "--export", "--dump"},
           {"--export c.obj --dump c_0001.obj", "c_0001.obj", "--export", "--dump"},
           {"--export c.pc2 --record ../" +
                std::filesystem::path(folder.path()).filename().string() + "/c.pc2",
            "c.pc2", "--export", "--record"},
           {"--dump small.json", "small.json", "--dump", "SCENE"},
           {"--report link.json", "link.json", "--report", "SCENE"},
           {"--record hard.json", "hard.json", "--record", "SCENE"},
           {"--replay a.rec --record a.rec", "a.rec", "--record", "--replay"}}) {
    const Outcome outcome = run_weft(folder, "run small.json --frames 3 " + arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments;
    for (const std::string& part : {path, one, other})
      EXPECT_NE(outcome.err.find(part), std::string::npos) << outcome.err;
    EXPECT_EQ(folder.files(), files) << arguments;
  }
  EXPECT_EQ(folder.read("small.json"), scene);
  EXPECT_EQ(folder.read("a.rec"), recording);
  // What is printed goes to a file of the same name.
  const std::string to_one = "cd '" + folder.path() +
                             "' && '" WEFT_PROGRAM
                             "' run small.json --frames 1 --dump out.txt >out.txt 2>/dev/null";
  EXPECT_EQ(WEXITSTATUS(std::system(to_one.c_str())), 2);
  EXPECT_EQ(
      run_weft(folder, "run small.json --frames 1 --dump /dev/null --report /dev/null").exit_code,
      0);
  EXPECT_EQ(
      run_weft(folder, "run small.json --frames 3 --export c.obj --dump c_0004.obj").exit_code, 0);
}

TEST(CliFiles, StandardOutputInAFileKeepsAll) {
  const Folder folder;
  small_scene(folder);
  const Outcome outcome = run_weft(folder, "run small.json --frames 1 --report /dev/stdout");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  const std::size_t end = outcome.out.find("\n}\n");
  ASSERT_NE(end, std::string::npos) << outcome.out;
  EXPECT_EQ(Json::parse(outcome.out.substr(0, end + 3))["frames"], 1);
  EXPECT_NE(outcome.out.find("wrote     /dev/stdout"), std::string::npos) << outcome.out;
}

TEST(CliFiles, AClosedStandardOutputIsNoOneElsesPlace) {
  const Folder folder;
  small_scene(folder);
  const std::string command = "cd '" + folder.path() +
                              "' && '" WEFT_PROGRAM
                              "' run small.json --frames 1 --dump d.f64 --report r.json >&- 2>&-";
  EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 5);
  EXPECT_EQ(folder.read("d.f64").size(), 48U * 24);
  EXPECT_EQ(Json::parse(folder.read("r.json"))["frames"], 1);
}

TEST(CliFiles, NamesOfAnyBytesAreWrittenAndShownInOneLine) {
  const Folder folder;
  small_scene(folder);
  const std::string name = "b\xff\nc";  // no UTF-8, and two lines
  const Outcome outcome =
      run_weft(folder, "run small.json --frames 2 --export '" + name + ".gltf' --dump '" + name +
                           ".f64' --report '" + name + ".json' --record '" + name + ".rec'");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  for (const char* extension : {".gltf", ".bin", ".f64", ".json", ".rec"})
    EXPECT_TRUE(folder.has(name + extension)) << extension;
  EXPECT_NE(outcome.out.find("b\\xff\\nc.f64"), std::string::npos) << outcome.out;
  std::filesystem::copy(folder / "small.json", folder / (name + "-scene.json"));
  EXPECT_EQ(run_weft(folder, "run '" + name + "-scene.json' --frames 1 --record a.rec").exit_code,
            0);
  const Outcome missing = run_weft(folder, "run '" + name + "'");
  EXPECT_EQ(missing.exit_code, 3);
  EXPECT_TRUE(missing.err.starts_with("weft: error: b\\xff\\nc: ")) << missing.err;
  EXPECT_EQ(missing.err.find('\n'), missing.err.size() - 1) << missing.err;
}

// Starts a run whose first frame takes many minutes, and sends it a signal in that frame.
int signal_in_a_frame(const Folder& folder, int signal, const std::string& said) {
  const pid_t child =
      start_weft(folder,
                 {"run", "small.json", "--set", "/cloths/0/grid/points=[400,400]", "--set",
                  "/time/substeps=100000", "--set", "/solver/method=compliant", "--export", "a.pc2",
                  "--record", "a.rec", "--dump", "d.f64", "--report", "r.json"},
                 said);
  const auto open = [&] {
    const std::filesystem::directory_iterator entries(folder.path());
    return std::count_if(begin(entries), end(entries),
                         [](const auto& entry) { return entry.path().extension() == ".tmp"; });
  };
  while (open() < 4) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  ::kill(child, signal);
  return wait_for(child);
}

TEST(CliFiles, AnInterruptDoesNotWaitForALongFrame) {
  const Folder folder;
  small_scene(folder);
  folder.write("d.f64", "old");
  const std::string said = folder.capture().err;
  const int status = signal_in_a_frame(folder, SIGINT, said);
  EXPECT_EQ(WEXITSTATUS(status), 130);
  const std::string text = Folder::take(said);
  EXPECT_NE(text.find("interrupted within frame 1 of"), std::string::npos) << text;
  EXPECT_NE(text.find("written: a.pc2, a.rec\n"), std::string::npos) << text;
  EXPECT_NE(text.find("end of the frame: d.f64, r.json"), std::string::npos) << text;
  EXPECT_EQ(folder.read("a.pc2").size(), 32U + 400 * 400 * 12);
  EXPECT_EQ(folder.read("d.f64"), "old");
  EXPECT_EQ(folder.files(), 4U);
}

// Signals that end a run where it stands.
TEST(CliFiles, QuitAndABrokenPipeLeaveNothing) {
  const Folder folder;
  small_scene(folder);
  for (const int signal : {SIGQUIT, SIGPIPE}) {
    const int status = signal_in_a_frame(folder, signal, "/dev/null");
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == signal) << status;
    EXPECT_EQ(folder.files(), 1U) << signal;
  }
  const std::string piped =
      "cd '" + folder.path() +
      "' && { '" WEFT_PROGRAM
      "' run small.json --frames 2 --set /cloths/0/grid/points=[99,99] --report "
      "r.json --dump /dev/stdout; echo $? >code; } 2>/dev/null | true";
  EXPECT_EQ(std::system(piped.c_str()), 0);
  EXPECT_EQ(folder.read("code"), "141\n");
  EXPECT_FALSE(folder.has("r.json"));
}

TEST(CliFiles, WhatIsToBeIgnoredIsIgnored) {
  const Folder folder;
  small_scene(folder);
  const std::string command = "cd '" + folder.path() +
                              "' && trap '' HUP && { '" WEFT_PROGRAM
                              "' run small.json --frames 20000 --report r.json >/dev/null & "
                              "sleep 0.1; kill -HUP $!; wait $!; }";
  EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 0);
  EXPECT_EQ(Json::parse(folder.read("r.json"))["status"], "ok");
}

}  // namespace
}  // namespace weft
