// Which outputs would overwrite each other, or an input.
#include <algorithm>
#include <charconv>
#include <filesystem>
#include <map>
#include <utility>

#include "output/animation.h"
#include "output/gltf_pair.h"
#include "output/target.h"

namespace weft {

namespace fs = std::filesystem;

namespace {

// Whether run_0012.obj is one of so many samples of run.obj.
bool is_sample(const fs::path& sequence, const fs::path& file, std::int64_t samples) {
  const std::string start = sequence.stem().string() + "_", name = file.stem().string();
  if (file.extension() != ".obj" || !name.starts_with(start)) return false;
  std::int64_t number = 0;
  const char* const end = name.data() + name.size();
  const auto [stop, error] = std::from_chars(name.data() + start.size(), end, number);
  const std::size_t digits = name.size() - start.size();
  return error == std::errc() && stop == end && number >= 0 &&
         digits == std::max<std::size_t>(4, std::to_string(number).size()) &&
         (samples == 0 || number < samples);
}

// What cannot be found cannot be overwritten either; who opens it says why.
std::optional<Target> try_target(const std::string& path) {
  try {
    return find_target(path);
  } catch (const WriteError&) {
    return std::nullopt;
  }
}

std::vector<std::string> sequence_files(const fs::path& sequence, std::int64_t samples,
                                        const std::vector<std::string>& others) {
  std::vector<std::string> files;
  std::error_code error;
  const fs::path folder = fs::canonical(fs::absolute(sequence, error).parent_path(), error);
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error))
    if (is_sample(sequence, entry->path(), samples)) files.push_back(entry->path().string());
  for (const std::string& other : others)
    if (const auto target = try_target(other);
        target && target->folder == folder && is_sample(sequence, target->path, samples))
      files.push_back(target->path);
  return files;
}

// Files by path and, where they exist, by what they are on the disk.
class Known {
 public:
  // The option that names the file already, or nothing.
  std::optional<std::string> find(const Target& target) const {
    if (const auto same = paths_.find(target.path); same != paths_.end()) return same->second;
    if (!target.exists) return std::nullopt;
    const auto same = files_.find({target.status.st_dev, target.status.st_ino});
    return same == files_.end() ? std::nullopt : std::optional(same->second);
  }
  void add(const Target& target, const std::string& option) {
    paths_.emplace(target.path, option);
    if (target.exists)
      files_.emplace(std::pair{target.status.st_dev, target.status.st_ino}, option);
  }

 private:
  std::map<std::string, std::string> paths_;
  std::map<std::pair<dev_t, ino_t>, std::string> files_;
};

}  // namespace

std::vector<std::string> animation_files(const std::string& path, std::int64_t samples,
                                         const std::vector<std::string>& others) {
  const std::string extension = extension_of(path);
  if (extension == ".obj") return sequence_files(path, samples, others);
  if (extension == ".gltf") return GltfPair::names(path);
  return {path};
}

std::optional<Fault> find_clash(const std::vector<NamedFile>& outputs,
                                const std::vector<NamedFile>& inputs) {
  Known read, written;
  for (const NamedFile& file : inputs)
    if (const auto target = try_target(file.path);
        target && target->exists && S_ISREG(target->status.st_mode))
      read.add(*target, file.option);
  for (const NamedFile& file : outputs) {
    const std::optional<Target> target = try_target(file.path);
    if (!target || !target->replaceable()) continue;
    if (const auto input = read.find(*target))
      return Fault{file.path, file.option + " would overwrite " + *input, "another name"};
    if (const auto other = written.find(*target); other && *other != file.option)
      return Fault{file.path,
                   "two outputs would go to this file: " + *other + " and " + file.option,
                   "a name for each"};
    written.add(*target, file.option);
  }
  return std::nullopt;
}

}  // namespace weft
