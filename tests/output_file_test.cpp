// Files appear complete under their name, or not at all.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <bit>
#include <cstring>
#include <optional>

#include "folder.h"
#include "weft/output.h"

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
