// Files appear complete under their name, or not at all.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <bit>
#include <csignal>
#include <cstring>
#include <optional>

#include "folder.h"
#include "weft/output.h"
#include "weft/printable.h"

namespace weft {
namespace {

TEST(OutputFile, HasItsNameOnlyAfterCommit) {
  const Folder folder;
  OutputFile file(folder / "a.bin");
  file.write("abc");
  EXPECT_FALSE(folder.has("a.bin"));
  file.commit();
  EXPECT_EQ(folder.read("a.bin"), "abc");
  EXPECT_EQ(folder.files(), 1U);
}

TEST(OutputFile, LeavesNothingWhenGivenUp) {
  const Folder folder;
  {
    OutputFile file(folder / "a.bin");
    file.write("abc");
  }
  EXPECT_EQ(folder.files(), 0U);
}

TEST(OutputFile, KeepsTheOldFileUntilCommit) {
  const Folder folder;
  folder.write("a.bin", "old");
  {
    OutputFile file(folder / "a.bin");
    file.write("new");
  }
  EXPECT_EQ(folder.read("a.bin"), "old");
  OutputFile file(folder / "a.bin");
  file.write("new");
  file.commit();
  EXPECT_EQ(folder.read("a.bin"), "new");
}

TEST(OutputFile, OverwritesInPlaceAndGoesOnAtTheEnd) {
  const Folder folder;
  OutputFile file(folder / "a.bin");
  file.write("0123456789");
  file.overwrite(2, "xy");
  file.write("end");
  file.commit();
  EXPECT_EQ(folder.read("a.bin"), "01xy456789end");
}

TEST(OutputFile, TwoOfOneNameDoNotDisturbEachOther) {
  const Folder folder;
  OutputFile first(folder / "a.bin");
  std::optional<OutputFile> second(folder / "a.bin");
  first.write("first");
  second->write("second");
  second.reset();
  first.commit();
  EXPECT_EQ(folder.read("a.bin"), "first");
  EXPECT_EQ(folder.files(), 1U);
}

TEST(OutputFile, FollowsALinkInsteadOfReplacingIt) {
  const Folder folder;
  folder.write("target", "old");
  std::filesystem::create_symlink("target", folder / "link");
  OutputFile file(folder / "link");
  file.write("new");
  file.commit();
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
  EXPECT_EQ(folder.read("target"), "new");
}

TEST(OutputFile, FollowsALinkToAFileThatIsNotThereYet) {
  const Folder folder;
  std::filesystem::create_directory(folder / "deep");
  std::filesystem::create_symlink("deep/second", folder / "link");
  std::filesystem::create_symlink("target", folder / "deep/second");
  OutputFile file(folder / "link");
  file.write("new");
  file.commit();
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "deep/second"));
  EXPECT_EQ(folder.read("deep/target"), "new");
}

TEST(OutputFile, RefusesLinksInACircle) {
  const Folder folder;
  std::filesystem::create_symlink("b", folder / "a");
  std::filesystem::create_symlink("a", folder / "b");
  EXPECT_THROW(OutputFile(folder / "a"), WriteError);
}

TEST(OutputFile, KeepsTheModeOfTheFileThatItReplaces) {
  const Folder folder;
  for (const mode_t mode : {0600U, 0640U, 0666U}) {
    folder.write("a.bin", "old");
    ASSERT_EQ(::chmod((folder / "a.bin").c_str(), mode), 0);
    OutputFile file(folder / "a.bin");
    file.commit();
    struct stat status {};
    ASSERT_EQ(::stat((folder / "a.bin").c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 07777U, mode);
  }
}

// What a signal handler does before it ends the process.
TEST(OutputFile, TemporariesCanBeRemovedWhileTheyAreOpen) {
  const Folder folder;
  OutputFile first(folder / "a.bin"), second(folder / "b.bin", first), third(folder / "c.bin");
  EXPECT_GT(folder.files(), 0U);
  remove_temporaries();
  EXPECT_EQ(folder.files(), 0U);
  first.write("abc");
  EXPECT_THROW(first.commit(), WriteError);
}

// A process that is killed leaves its temporary files, and one that lives keeps them.
TEST(OutputFile, RemovesWhatAKilledProcessLeft) {
  const Folder folder;
  OutputFile alive(folder / "alive.bin");
  const pid_t child = ::fork();
  if (child == 0) {
    OutputFile first(folder / "a.bin"), second(folder / "b.bin", first);
    first.write("abc");
    ::kill(::getpid(), SIGKILL);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(folder.files(), 2U);
  std::filesystem::create_directory(folder / ".weft-mine.tmp");
  folder.write(".weft-mine.tmp/0", "a person's own");
  std::filesystem::create_directory(folder / "elsewhere");
  folder.write("elsewhere/0", "not ours");
  folder.write("elsewhere/lock", "");
  std::filesystem::create_symlink("elsewhere", folder / ".weft-1.tmp");
  OutputFile(folder / "c.bin").commit();
  EXPECT_EQ(folder.read("elsewhere/0"), "not ours");
  EXPECT_EQ(folder.files(), 5U);  // these two, c.bin, a person's own, and what is alive
  alive.write("alive");
  alive.commit();
  EXPECT_EQ(folder.read("alive.bin"), "alive");
  EXPECT_EQ(folder.read(".weft-mine.tmp/0"), "a person's own");
}

std::string clash(const Folder& folder, const std::vector<std::string>& outputs,
                  const std::vector<std::string>& inputs = {}) {
  std::vector<NamedFile> out, in;
  for (const std::string& name : outputs)
    out.push_back({"--" + std::to_string(out.size()), name[0] == '/' ? name : folder / name});
  for (const std::string& name : inputs) in.push_back({"SCENE", folder / name});
  const auto fault = find_clash(out, in);
  return fault ? fault->what : "";
}

TEST(Clash, IsFoundBehindLinksAndDetours) {
  const Folder folder;
  std::filesystem::create_directory(folder / "deep");
  folder.write("old", "old");
  std::filesystem::create_symlink("new", folder / "link");
  std::filesystem::create_symlink(folder.path(), folder / "deep/up");
  std::filesystem::create_hard_link(folder / "old", folder / "hard");
  const std::string both = "two outputs would go to this file: --0 and --1";
  EXPECT_EQ(clash(folder, {"a", "b"}), "");
  EXPECT_EQ(clash(folder, {"a", "./a"}), both);
  EXPECT_EQ(clash(folder, {"a", "deep/../a"}), both);
  EXPECT_EQ(clash(folder, {"a", "deep/up/a"}), both);
  EXPECT_EQ(clash(folder, {"new", "link"}), both);
  EXPECT_EQ(clash(folder, {"old", "hard"}), both);
  EXPECT_EQ(clash(folder, {"a", "hard"}, {"old"}), "--1 would overwrite SCENE");
  EXPECT_EQ(clash(folder, {"missing/a", "b"}), "");  // found when it is opened
  EXPECT_EQ(clash(folder, {"/dev/null", "/dev/null"}), "");
  EXPECT_EQ(clash(folder, {"/dev/stdout", "/dev/stdout"}), "");
}

TEST(Clash, KnowsEveryFileOfAnAnimation) {
  const Folder folder;
  folder.write("c_0002.obj", "old");
  std::filesystem::create_hard_link(folder / "c_0002.obj", folder / "hard");
  const auto with = [&](const std::string& animation, const std::string& other) {
    std::vector<NamedFile> out;
    for (const std::string& file : animation_files(folder / animation, 5, {folder / other}))
      out.push_back({"--export", file});
    out.push_back({"--dump", folder / other});
    return find_clash(out, {}).has_value();
  };
  for (const char* other : {"c_0000.obj", "c_0004.obj", "hard", "./c_0001.obj"})
    EXPECT_TRUE(with("c.obj", other)) << other;
  for (const char* other : {"c.obj", "c_0005.obj", "c_00001.obj", "c_1.obj", "c_x.obj"})
    EXPECT_FALSE(with("c.obj", other)) << other;
  EXPECT_TRUE(with("c.gltf", "c.bin"));
  EXPECT_TRUE(with("c.gltf", "c.weft-new.bin"));
  EXPECT_FALSE(with("c.glb", "c.bin"));
  EXPECT_TRUE(with("c.pc2", "./c.pc2"));
}

TEST(OutputFile, IsReadableByWhomTheUmaskAllows) {
  const Folder folder;
  const mode_t before = ::umask(022);
  OutputFile file(folder / "a.bin");
  ::umask(before);
  file.commit();
  struct stat status {};
  ASSERT_EQ(::stat((folder / "a.bin").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0644U);
}

TEST(OutputFile, NamesThePathThatCannotBeWritten) {
  const Folder folder;
  const std::string path = folder / "missing/a.bin";
  try {
    OutputFile file(path);
    FAIL() << "opened a file in a folder that does not exist";
  } catch (const WriteError& error) {
    EXPECT_EQ(error.path, path);
    EXPECT_NE(std::string(error.what()).find("No such file or directory"), std::string::npos);
  }
}

TEST(OutputFile, RefusesAFolderAndAnEmptyName) {
  const Folder folder;
  EXPECT_THROW(OutputFile(folder.path()), WriteError);
  EXPECT_THROW(OutputFile(""), WriteError);
}

TEST(OutputFile, WritesDevicesDirectly) {
  OutputFile file("/dev/null");
  file.write("abc");
  file.commit();
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

TEST(OutputFile, TellsWhenTheDiskIsFull) {
  OutputFile file("/dev/full");
  file.write("abc");  // into the buffer
  EXPECT_THROW(file.commit(), WriteError);
}

TEST(Printable, IsOneLineOfUtf8) {
  EXPECT_EQ(printable("größe … 𝄞.json"), "größe … 𝄞.json");
  EXPECT_EQ(printable("a\nb\tc\rd\x1b[31m\x7f"), "a\\nb\\tc\\rd\\x1b[31m\\x7f");
  // Lone, overlong, cut off, a surrogate, beyond Unicode, a control character of two bytes.
  EXPECT_EQ(printable("\xff \xc0\xaf \xe2\x80 \xed\xa0\x80 \xf4\x90\x80\x80 \xc2\x85"),
            "\\xff \\xc0\\xaf \\xe2\\x80 \\xed\\xa0\\x80 \\xf4\\x90\\x80\\x80 \\u{85}");
  EXPECT_EQ(printable(std::string_view("a\0b", 3)), "a\\x00b");
}

TEST(Dump, IsLittleEndianDoubles) {
  const Folder folder;
  const std::vector<double> positions{1.0, -2.5, 1e-300};
  write_dump(folder / "a.f64", positions);
  const std::string bytes = folder.read("a.f64");
  ASSERT_EQ(bytes.size(), 24U);
  for (std::size_t n = 0; n < positions.size(); ++n) {
    std::uint64_t bits = 0;
    for (std::size_t byte = 0; byte < 8; ++byte) {
      bits |= std::uint64_t{static_cast<unsigned char>(bytes[8 * n + byte])} << (8 * byte);
    }
    EXPECT_EQ(std::bit_cast<double>(bits), positions[n]);
  }
}

}  // namespace
}  // namespace weft
