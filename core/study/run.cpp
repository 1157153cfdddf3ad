// One run of a study: values -> scene -> simulation -> row and chunks.
#include <zlib.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <limits>
#include <new>

#include "output/animation.h"
#include "study/study.h"
#include "weft/output.h"
#include "weft/printable.h"
#include "weft/read_scene.h"

namespace weft {

namespace {

constexpr int kDeflate = 1;  // HDF5's filter takes any level
constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();

// HDF5's shuffle (all first bytes, all second bytes, …), then deflate.
std::string pack(const std::vector<float>& values) {
  const auto* bytes = reinterpret_cast<const char*>(values.data());
  std::string shuffled(values.size() * 4, '\0');
  for (std::size_t b = 0; b < 4; ++b)
    for (std::size_t k = 0; k < values.size(); ++k)
      shuffled[b * values.size() + k] = bytes[4 * k + b];
  uLongf size = compressBound(shuffled.size());
  std::string packed(size, '\0');
  if (compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
                reinterpret_cast<const Bytef*>(shuffled.data()), shuffled.size(), kDeflate) != Z_OK)
    throw std::bad_alloc();
  packed.resize(size);
  return packed;
}

}  // namespace

// Fills chunks sample by sample, and packs those that are full.
class Study::Sampler {
 public:
  Sampler(const Chunks& chunks, std::uint64_t particles, Record& record)
      : chunks_(chunks),
        across_((particles + chunks.particles - 1) / chunks.particles),
        record_(record),
        open_(across_, std::vector<float>(chunks.values(), kNothing)) {}

  void frame(const Simulation& simulation) {
    if (next_ == chunks_.frames.size() || chunks_.frames[next_] != simulation.frame()) return;
    const std::size_t row = next_++ % chunks_.samples * chunks_.particles;
    std::size_t particle = 0;
    for_each_placed(simulation.view(), [&](const std::array<float, 3>& x) {
      std::vector<float>& chunk = open_[particle / chunks_.particles];
      std::copy_n(x.begin(), 3,
                  chunk.begin() + std::ptrdiff_t(3 * (row + particle % chunks_.particles)));
      ++particle;
    });
    if (next_ % chunks_.samples == 0) close();
  }
  void finish() {
    if (next_ % chunks_.samples != 0) close();
  }

 private:
  void close() {
    for (std::size_t k = 0; k < across_; ++k) {
      record_.chunks.push_back(
          {std::uint32_t((next_ - 1) / chunks_.samples), std::uint32_t(k), pack(open_[k])});
      std::ranges::fill(open_[k], kNothing);
    }
  }

  const Chunks& chunks_;
  std::size_t across_, next_ = 0;
  Record& record_;
  std::vector<std::vector<float>> open_;  // of the present samples, one after the other in the row
};

void Study::put(std::string& row, std::size_t column, const Json& value) const {
  const Column& c = columns_[column];
  if (c.kind == Column::Kind::text) {
    std::string text = value.is_string() ? value.get<std::string>() : value.dump();
    text.resize(std::min(text.size(), c.bytes));
    while (!is_utf8(text)) text.pop_back();  // cut within a character
    text.copy(row.data() + c.offset, text.size());
  } else if (c.kind == Column::Kind::whole) {
    const auto whole = value.get<std::uint64_t>();
    std::memcpy(row.data() + c.offset, &whole, 8);
  } else {
    const double number = value.is_null()      ? std::numeric_limits<double>::quiet_NaN()
                          : value.is_boolean() ? double(value.get<bool>())
                                               : value.get<double>();
    std::memcpy(row.data() + c.offset, &number, 8);
  }
}

// Fills in the measures; returns the outcome.
std::string Study::simulate(const std::vector<Json>& values, int threads,
                            const std::function<bool()>& keep_going, Record& record) const {
  std::vector<Override> overrides;
  for (std::size_t k = 0; k < values.size(); ++k)
    overrides.push_back({parameters_[k].pointer, values[k].dump()});
  const SceneFile file = read_scene_text(scene_, overrides);
  if (!file.faults.empty()) {
    const Fault& f = file.faults[0];
    return f.place + ": " + f.what + (f.allowed.empty() ? "" : " (" + f.allowed + ")");
  }
  const bool follows = std::ranges::count(measures_, "/strain/max_of_frames") > 0;
  Simulation simulation(file.scene, {.threads = threads, .seed = seed_, .follow_strain = follows});
  record.particles = std::uint64_t(particle_count(simulation.view()));
  Sampler sampler(chunks_, record.particles, record);
  sampler.frame(simulation);
  while (simulation.frame() < frames_ && simulation.status().ok) {
    if (!keep_going()) throw Abandoned();
    simulation.advance_frame();
    if (simulation.status().ok) sampler.frame(simulation);
  }
  sampler.finish();
  if (!measures_.empty()) {
    const Json report = Json::parse(to_json(simulation.report()));
    for (std::size_t k = 0; k < measures_.size(); ++k)
      put(record.row, 2 + parameters_.size() + k, report.at(Json::json_pointer(measures_[k])));
  }
  return simulation.status().text;
}

Record Study::run(std::uint64_t run, int threads, const std::function<bool()>& keep_going) const {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  Record record{run, 0, std::string(row_bytes(), '\0'), {}};
  const std::vector<Json> values = values_of(run);
  for (std::size_t k = 0; k < columns_.size(); ++k)
    if (columns_[k].kind == Column::Kind::number) put(record.row, k, nullptr);
  for (std::size_t k = 0; k < values.size(); ++k) put(record.row, 2 + k, values[k]);
  std::string outcome;
  try {
    outcome = simulate(values, threads, keep_going, record);
  } catch (const std::bad_alloc&) {
    outcome = "the system gives no more memory";
  } catch (const std::exception& error) {
    outcome = error.what();
  }
  put(record.row, 0, run);
  put(record.row, 1, record.particles);
  put(record.row, columns_.size() - 2, std::chrono::duration<double>(Clock::now() - start).count());
  put(record.row, columns_.size() - 1, outcome);
  return record;
}

namespace {

template <class T>
void append(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

struct Bytes {
  std::string_view rest;
  template <class T>
  T take() {
    T value;
    std::memcpy(&value, text(sizeof value).data(), sizeof value);
    return value;
  }
  std::string_view text(std::size_t size) {
    if (size > rest.size()) throw std::invalid_argument("this is no record of a study");
    const std::string_view part = rest.substr(0, size);
    rest.remove_prefix(size);
    return part;
  }
};

}  // namespace

std::string to_bytes(const Record& record) {
  std::string bytes;
  append(bytes, record.run);
  append(bytes, record.particles);
  append(bytes, std::uint64_t(record.row.size()));
  bytes += record.row;
  for (const Record::Chunk& c : record.chunks) {
    append(bytes, c.sample);
    append(bytes, c.particle);
    append(bytes, std::uint64_t(c.bytes.size()));
    bytes += c.bytes;
  }
  return bytes;
}

Record record_of(std::string_view bytes) {
  Bytes from{bytes};
  Record record;
  record.run = from.take<std::uint64_t>();
  record.particles = from.take<std::uint64_t>();
  record.row = from.text(from.take<std::uint64_t>());
  while (!from.rest.empty()) {
    Record::Chunk c;
    c.sample = from.take<std::uint32_t>();
    c.particle = from.take<std::uint32_t>();
    c.bytes = from.text(from.take<std::uint64_t>());
    record.chunks.push_back(std::move(c));
  }
  return record;
}

}  // namespace weft
