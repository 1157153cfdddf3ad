// A run of `weft` that a signal ends, and what its files may hold: those of the run before, or of this
// one up to some frame.
#pragma once

#include <fcntl.h>
#include <sys/inotify.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <thread>
#include <vector>

#include "program.h"

namespace weft {

using Clock = std::chrono::steady_clock;

// Starts `weft` in a folder, as a terminal would: no signal ignored. What it says goes to a file.
inline pid_t start_weft(const Folder& folder, const std::vector<std::string>& words,
                        const std::string& said = "/dev/null") {
  const pid_t child = ::fork();
  if (child != 0) return child;
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  for (int signal = 1; signal < 32; ++signal) std::signal(signal, SIG_DFL);
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
  const int nowhere = ::open("/dev/null", O_RDWR);
  for (const int stream : {0, 1}) ::dup2(nowhere, stream);
  ::dup2(::open(said.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666), 2);
  std::vector<char*> arguments{const_cast<char*>(WEFT_PROGRAM)};
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  if (::chdir(folder.path().c_str()) == 0) ::execv(WEFT_PROGRAM, arguments.data());
  ::_exit(127);
}

inline int wait_for(pid_t child) {
  int status = 0;
  ::waitpid(child, &status, 0);
  return status;
}

// Tells when the first file of a folder takes its name.
class FirstRename {
 public:
  explicit FirstRename(const Folder& folder) : queue_(::inotify_init1(IN_NONBLOCK | IN_CLOEXEC)) {
    ::inotify_add_watch(queue_, folder.path().c_str(), IN_MOVED_TO);
  }
  ~FirstRename() { ::close(queue_); }
  FirstRename(const FirstRename&) = delete;
  FirstRename& operator=(const FirstRename&) = delete;

  // Until then, or the child has ended.
  void wait(pid_t child) const {
    char events[4096];
    siginfo_t ended{};
    while (::read(queue_, events, sizeof events) <= 0 && ended.si_pid == 0)
      ::waitid(P_PID, static_cast<id_t>(child), &ended, WEXITED | WNOHANG | WNOWAIT);
  }

 private:
  int queue_;
};

// All that a whole run wrote.
struct Truth {
  std::vector<std::vector<float>>
      samples;                         // x,y,z of every particle: at the start and after frames
  std::vector<std::string> recording;  // lines
  std::map<std::int64_t, std::string> hashes;  // of frames

  Truth(const std::string& pc2, const std::string& record) {
    std::int32_t points = 0, count = 0;
    std::memcpy(&points, pc2.data() + 16, 4);
    std::memcpy(&count, pc2.data() + 28, 4);
    for (std::int32_t s = 0; s < count; ++s) {
      samples.emplace_back(3 * static_cast<std::size_t>(points));
      std::memcpy(samples.back().data(), pc2.data() + 32 + std::size_t(s) * samples[0].size() * 4,
                  samples[0].size() * 4);
    }
    std::istringstream in(record);
    for (std::string line; std::getline(in, line);) {
      recording.push_back(line);
      const auto json = nlohmann::json::parse(line);
      if (json.contains("hash")) hashes[json["frame"]] = json["hash"];
    }
  }
};

// Whether a file is what a run writes that ends after some frame; "" or what is wrong.
class Judge {
 public:
  Judge(const Folder& folder, const Truth& truth) : folder_(folder), truth_(truth) {}

  bool pc2(const std::string& name) const {
    const std::string bytes = folder_.read(name);
    return bytes.size() >= 32 && same_samples(floats(bytes, 32, false), number(bytes, 28, false));
  }
  bool mdd(const std::string& name) const {
    const std::string bytes = folder_.read(name);
    if (bytes.size() < 8) return false;
    const std::size_t samples = number(bytes, 0, true);
    return same_samples(floats(bytes, 8 + 4 * samples, true), samples);
  }
  bool dump(const std::string& name) const {
    const std::string bytes = folder_.read(name);
    std::vector<float> last(bytes.size() / 8);
    for (std::size_t n = 0; n < last.size(); ++n) {
      double value = 0;
      std::memcpy(&value, bytes.data() + 8 * n, 8);
      last[n] = static_cast<float>(value);
    }
    return std::ranges::find(truth_.samples, last) != truth_.samples.end();
  }
  bool report(const std::string& name) const {
    const auto json = nlohmann::json::parse(folder_.read(name), nullptr, false);
    if (json.is_discarded()) return false;
    const auto hash = truth_.hashes.find(json["frames"]);
    return json["frames"] == 0 || (hash != truth_.hashes.end() && json["hash"] == hash->second);
  }
  bool record(const std::string& name) const {
    const std::string text = folder_.read(name);
    std::istringstream in(text);
    std::size_t n = 0;
    for (std::string line; std::getline(in, line); ++n)
      if (n >= truth_.recording.size() || line != truth_.recording[n]) return false;
    return n > 0 && text.back() == '\n';
  }
  bool obj(const std::string& name, std::size_t sample) const {
    if (sample >= truth_.samples.size()) return false;
    std::vector<float> positions;
    std::istringstream in(folder_.read(name));
    std::size_t faces = 0;
    for (std::string line; std::getline(in, line);) {
      faces += line.starts_with("f ");
      if (!line.starts_with("v ")) continue;
      char* at = line.data() + 1;
      for (int k = 0; k < 3; ++k) positions.push_back(std::strtof(at, &at));
    }
    return positions == truth_.samples[sample] && faces == kFaces;
  }
  bool usda(const std::string& name) const {
    const std::string text = folder_.read(name);
    std::istringstream in(text);
    std::vector<float> positions;
    std::size_t samples = 0;
    std::string line;
    while (std::getline(in, line) && !line.ends_with("points.timeSamples = {")) {
    }
    for (; std::getline(in, line) && line.ends_with("],"); ++samples) {
      std::ranges::replace_if(
          line, [](char c) { return c == '[' || c == '(' || c == ',' || c == ')'; }, ' ');
      char* at = line.data() + line.find(':') + 1;
      for (char* end = at;; at = end) {
        const float value = std::strtof(at, &end);
        if (end == at) break;
        positions.push_back(value);
      }
    }
    return line == "        }" && text.ends_with("\n}\n") && same_samples(positions, samples);
  }
  // A .glb, or a .gltf with the buffer that it refers to.
  bool gltf(const std::string& name) const {
    std::string text = folder_.read(name), buffer;
    if (name.ends_with(".glb")) {
      const std::size_t size = number(text, 12, false);
      if (number(text, 8, false) != text.size()) return false;
      buffer = text.substr(28 + size);
      text = text.substr(20, size);
    }
    const auto json = nlohmann::json::parse(text, nullptr, false);
    if (json.is_discarded()) return false;
    if (buffer.empty()) buffer = folder_.read(json["buffers"][0]["uri"]);
    return json["buffers"][0]["byteLength"] == buffer.size() && same_targets(json, buffer);
  }

  static constexpr std::size_t kFaces = 23 * 23;

 private:
  static std::uint32_t number(const std::string& bytes, std::size_t at, bool big) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + at, 4);
    return big ? __builtin_bswap32(value) : value;
  }
  static std::vector<float> floats(const std::string& bytes, std::size_t from, bool big) {
    std::vector<float> values;
    for (std::size_t at = from; at + 4 <= bytes.size(); at += 4)
      values.push_back(std::bit_cast<float>(number(bytes, at, big)));
    return values;
  }
  bool same_samples(const std::vector<float>& values, std::size_t samples) const {
    const std::size_t each = truth_.samples[0].size();
    if (samples == 0 || samples > truth_.samples.size() || values.size() != samples * each)
      return false;
    for (std::size_t s = 0; s < samples; ++s)
      if (!std::equal(truth_.samples[s].begin(), truth_.samples[s].end(),
                      values.begin() + std::ptrdiff_t(s * each)))
        return false;
    return true;
  }
  // The first sample, then what every other is away from it.
  bool same_targets(const nlohmann::json& json, const std::string& buffer) const {
    const auto& primitive = json["meshes"][0]["primitives"][0];
    const std::size_t targets = primitive.contains("targets") ? primitive["targets"].size() : 0;
    if (targets >= truth_.samples.size()) return false;
    for (std::size_t s = 0; s <= targets; ++s) {
      const auto& holder = s == 0 ? primitive["attributes"] : primitive["targets"][s - 1];
      const auto& accessor = json["accessors"][holder["POSITION"].get<std::size_t>()];
      const auto& view = json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
      const std::vector<float> values =
          floats(buffer.substr(view["byteOffset"], view["byteLength"]), 0, false);
      if (values.size() != truth_.samples[s].size()) return false;
      for (std::size_t n = 0; n < values.size(); ++n)
        if (values[n] != truth_.samples[s][n] - (s == 0 ? 0 : truth_.samples[0][n])) return false;
    }
    return true;
  }

  const Folder& folder_;
  const Truth& truth_;
};

}  // namespace weft
