#include "campaign.h"

#include <cctype>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>
#include <utility>

#include "failure.h"
#include "random_mesh.h"
#include "random_scene.h"
#include "weft/point_cache.h"
#include "weft/read_scene.h"

namespace fuzz {

namespace {

constexpr auto kPause = std::chrono::milliseconds(2);  // between looks at the children

std::string sixteen(std::uint64_t hash) {
  char text[17];
  std::snprintf(text, sizeof text, "%016" PRIx64, hash);
  return text;
}

std::uint64_t text_hash(const std::string& text) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return hash;
}

// What a child that ended early was at, and what sanitizers said of it.
std::string last_words(const std::string& path) {
  std::string place, summary;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("at: ")) place = " (" + line.substr(4) + ")";
    const bool told = line.starts_with("SUMMARY: ") || line.find("runtime error: ") != line.npos;
    if (told && summary.empty()) summary = " " + line;
  }
  return place + summary;
}

Entry entry_of(const std::string& answer, double seconds, const std::string& errors) {
  Entry e;
  e.ms = 1e3 * seconds;
  std::istringstream words(answer);
  if (words >> std::hex >> e.scene >> e.result >> std::ws)
    std::getline(words, e.answer);
  else
    e.scene = 0, e.answer = answer + last_words(errors);
  for (char& c : e.answer)
    if (!std::isprint(static_cast<unsigned char>(c))) c = ' ';
  return e;
}

}  // namespace

std::string examined(const Case& c, Variants variants, const std::string& folder) {
  std::string text = weft::write_scene_text(c.scene);
  weft::for_each_mesh(
      c.scene, [&](const auto& mesh, const std::string&) { text += weft::write_obj(*mesh.shape); });
  for (const weft::Collider& collider : c.scene.colliders)
    if (const auto* body = std::get_if<weft::MeshBody>(&collider.shape); body && body->motion)
      text += weft::mdd_bytes(*body->motion);
  const std::string scene = sixteen(text_hash(text));
  try {
    return scene + " " + sixteen(examine(c, variants, folder)) + " ok";
  } catch (const Failure& failure) {
    return scene + " 0 " + failure.what();
  } catch (const std::exception& error) {
    return scene + " 0 exception: " + error.what();
  }
}

Examination::Examination(const std::function<Case()>& make, std::uint64_t seed,
                         const Settings& settings)
    : seed_(seed),
      limit_(settings.limit),
      errors_(settings.folder + "/" + std::to_string(seed) + ".txt"),
      child_([&] { return examined(make(), settings.variants, settings.folder); }, errors_) {}

std::optional<Entry> Examination::answer() {
  const auto text = child_.answer(limit_);
  if (!text) return std::nullopt;
  Entry entry = entry_of(*text, child_.seconds(), errors_);
  if (entry.ok()) std::filesystem::remove(errors_);
  return entry;
}

Entry examined_apart(const Case& c, const Settings& settings) {
  Examination examination([&] { return c; }, c.seed, settings);
  while (true) {
    if (auto entry = examination.answer()) return *entry;
    std::this_thread::sleep_for(kPause);
  }
}

Campaign::Campaign(Settings settings)
    : settings_(std::move(settings)), log_(settings_.log), other_(read_log(settings_.compare)) {
  if (settings_.resume) done_ = read_log(settings_.log);
  for (const auto& [seed, entry] : done_) count(seed, entry);
  std::filesystem::create_directories(settings_.folder);
}

int Campaign::run() {
  std::uint64_t next = settings_.first;
  while (true) {
    for (; int(running_.size()) < settings_.jobs && more(next); ++next)
      running_.emplace_back([seed = next] { return case_of(seed); }, next, settings_);
    if (running_.empty()) break;
    collect();
  }
  std::printf("%d scenes, %d failed; %.1f a second; the slowest, %" PRIu64 ", took %.1f s\n", all_,
              failed_, fresh_ / elapsed(), slowest_, slowest_ms_ / 1e3);
  return failed_ > 0 ? 1 : 0;
}

double Campaign::elapsed() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

// Moves on to the next seed that is to be run, if any.
bool Campaign::more(std::uint64_t& next) const {
  if (settings_.seconds > 0 && elapsed() > settings_.seconds) return false;
  const auto wanted = [&] {
    if (done_.contains(next)) return false;
    const auto other = other_.find(next);
    return settings_.compare.empty() ||
           (other != other_.end() && other->second.ms < settings_.quick);
  };
  const std::uint64_t end = settings_.first + settings_.count;
  while (next < end && !wanted()) ++next;
  return next < end;
}

void Campaign::collect() {
  for (auto r = running_.begin(); r != running_.end();) {
    auto entry = r->answer();
    if (!entry) {
      ++r;
      continue;
    }
    compare(r->seed(), *entry);
    log_.add(r->seed(), *entry);
    ++fresh_;
    count(r->seed(), *entry);
    if (!entry->ok()) keep_failure(r->seed(), *entry);
    r = running_.erase(r);
  }
  std::this_thread::sleep_for(kPause);
}

void Campaign::compare(std::uint64_t seed, Entry& entry) const {
  const auto other = other_.find(seed);
  if (other == other_.end() || !entry.ok() || !other->second.ok()) return;
  if (other->second.scene != entry.scene)
    entry.answer = "difference: the scene is another one in " + settings_.compare;
  else if (other->second.result != entry.result)
    entry.answer = "difference: the result is another one in " + settings_.compare;
}

void Campaign::count(std::uint64_t seed, const Entry& entry) {
  ++all_;
  failed_ += !entry.ok();
  if (entry.ms > slowest_ms_) slowest_ = seed, slowest_ms_ = entry.ms;
}

// What it said is in a file of its own already.
void Campaign::keep_failure(std::uint64_t seed, const Entry& entry) const {
  std::printf("seed %" PRIu64 ": %s\n", seed, entry.answer.c_str());
  std::fflush(stdout);
  const std::string name = settings_.folder + "/" + std::to_string(seed);
  const weft::Scene scene = random_scene(seed);
  std::ofstream(name + ".json") << weft::write_scene_text(scene);
  write_meshes(scene, settings_.folder);
}

}  // namespace fuzz
